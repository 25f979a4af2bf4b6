#include <locograph/plugins/rolling/edge_steering_slip.h>
#include <locograph/plugins/rolling/rolling_step.h>

namespace locograph {

template class TypedEdgePool<EdgeSteeringSlip>;

namespace {

/// Calls f(row, wheel).
template <class F>
void each_rolling_wheel(const StanceParameter& stance, F&& f) {
  Eigen::Index row = 0;
  for (const StanceParameter::StandingWheel& standing : stance.wheels) {
    if (!standing.locked) f(row++, standing);
  }
}

int rolling_rows(const StanceParameter& stance) {
  int rows = 0;
  each_rolling_wheel(stance, [&](Eigen::Index, const auto&) { ++rows; });
  return rows;
}

/// Of |s Δθ| / 8.
constexpr double kHalfWayShare = 0.125;

}  // namespace

EdgeSteeringSlip::EdgeSteeringSlip(const StanceParameter& some, int number, double max_slip,
                                   double weight)
    : stance_number(number), max_slip_m(max_slip) {
  weights.setConstant(rolling_rows(some), weight);
}

void EdgeSteeringSlip::bind(const Parameters& parameters) {
  if (!(max_slip_m >= 0.0)) {
    throw locograph::Error("max_slip " + std::to_string(max_slip_m), "0 m or more");
  }
  stance = parameters.get<StanceParameter>(stance_number);
  if (rolling_rows(*stance) == 0) {
    throw locograph::Error(std::string(kTag) + " on a stance without wheels that roll",
                           "a stance with such wheels");
  }
  require_rows(kTag, dimension(), rolling_rows(*stance));
}

void EdgeSteeringSlip::error(const ConfigurationState& a, const ConfigurationState& b,
                             Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, a.robot, stance->robot);
  require_same_robot(kTag, b.robot, stance->robot);
  each_rolling_wheel(*stance, [&](Eigen::Index row, const auto& standing) {
    const RollingStep step({a.kinematics, standing.wheel}, {b.kinematics, standing.wheel},
                           standing.normal);
    const double most = kHalfWayShare * std::abs(step.way) * step.turned_at_most() - max_slip_m;
    e[row] = most <= 0.0
                 ? 0.0
                 : std::max(0.0, kHalfWayShare * std::abs(step.way * step.turned()) - max_slip_m);
  });
}

void EdgeSteeringSlip::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                 JacobianRef<EdgeSteeringSlip, 0> ja,
                                 JacobianRef<EdgeSteeringSlip, 1> jb) const {
  each_rolling_wheel(*stance, [&](Eigen::Index row, const auto& standing) {
    const Wheel& wheel = standing.wheel;
    const Eigen::Vector3d& normal = standing.normal;
    const WheelPose from(a.kinematics, wheel), to(b.kinematics, wheel);
    const RollingStep step(from, to, normal);
    const double turned = step.turned();
    if (kHalfWayShare * std::abs(step.way * turned) <= max_slip_m) return;
    const double slope = std::copysign(kHalfWayShare, step.way * turned);
    const auto add = [&](const RobotState& kinematics, const WheelPose& pose, double sign,
                         double* entries) {
      WheelGradient gradient = step.way_gradient(pose, normal, sign);
      gradient.by_centre *= slope * turned;
      gradient.by_turn =
          slope * turned * gradient.by_turn + sign * slope * step.way * turn_gradient(pose, normal);
      gradient.add_to(kinematics, wheel, pose, entries);
    };
    add(a.kinematics, from, -1.0, ja.row(row).data());
    add(b.kinematics, to, 1.0, jb.row(row).data());
  });
}

RowLabel EdgeSteeringSlip::row_label(int row) const {
  RowLabel label;
  each_rolling_wheel(*stance, [&](Eigen::Index r, const auto& standing) {
    if (r == row) label = {standing.wheel.name + " half-way", "m"};
  });
  return label;
}

}  // namespace locograph
