#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/rolling_step.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeRolling>;

namespace {

/// A wheel as a configuration holds it, in the world frame.
struct RollingPose : WheelPose {
  Eigen::Vector3d upright, side;  ///< fixed to the carrier, as the axle
  /// Of ψ, the angle of `upright` from the plane's normal about the axle, ψ = atan2(y, x) with
  /// y = (n × u) · a = n · (u × a) and x = n · u.
  double x, y;
  double spin;  ///< of the wheel joint

  RollingPose(const ConfigurationState& q, const Wheel& wheel, const Eigen::Vector3d& normal)
      : WheelPose(q.kinematics, wheel),
        upright(q.kinematics.world_from_link(wheel.carrier).linear() * wheel.upright_in_carrier),
        side(upright.cross(axle)),
        x(normal.dot(upright)),
        y(normal.dot(side)),
        spin(wheel.joint < 0 ? 0.0 : q.joint(wheel.joint)) {}

  /// Of the carrier from here to another pose, the shorter way round.
  double pitched_to(const RollingPose& other) const {
    return std::atan2(x * other.y - y * other.x, x * other.x + y * other.y);
  }
  /// dψ by how the carrier turns.
  Eigen::Vector3d pitch_gradient(const Eigen::Vector3d& normal) const {
    // A wheel lying flat has no pitch, hence no gradient of it.
    const double squared = std::max(1e-12, x * x + y * y);
    return (x * side - y * upright).cross(normal) / squared;
  }
};

int rows_of(const StanceParameter::StandingWheel& standing) { return standing.locked ? 3 : 2; }

int rows_of(const StanceParameter& stance) {
  int rows = 0;
  for (const StanceParameter::StandingWheel& standing : stance.wheels) rows += rows_of(standing);
  return rows;
}

}  // namespace

EdgeRolling::EdgeRolling(const StanceParameter& some, int number, double weight)
    : stance_number(number) {
  weights.setConstant(rows_of(some), weight);
}

void EdgeRolling::bind(const Parameters& parameters) {
  stance = parameters.get<StanceParameter>(stance_number);
  if (stance->wheels.empty()) {
    throw locograph::Error(std::string(kTag) + " on a stance without wheels",
                           "a stance with wheels");
  }
  require_rows(kTag, dimension(), rows_of(*stance));
}

void EdgeRolling::error(const ConfigurationState& a, const ConfigurationState& b,
                        Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, a.robot, stance->robot);
  require_same_robot(kTag, b.robot, stance->robot);
  Eigen::Index row = 0;
  for (const StanceParameter::StandingWheel& standing : stance->wheels) {
    const Wheel& wheel = standing.wheel;
    const Eigen::Vector3d& normal = standing.normal;
    const RollingPose from(a, wheel, normal), to(b, wheel, normal);
    const RollingStep step(from, to, normal);
    const double turned = wheel.radius_m * (to.spin - from.spin + from.pitched_to(to));
    e[row++] =
        step.lateral + std::copysign(wheel.radius_m * step.beyond_quarter_turn(), step.lateral);
    if (standing.locked) {
      e[row++] = step.way;
      e[row++] = turned;
    } else {
      e[row++] = step.way - turned;
    }
  }
}

void EdgeRolling::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                            JacobianRef<EdgeRolling, 0> ja, JacobianRef<EdgeRolling, 1> jb) const {
  Eigen::Index row = 0;
  for (const StanceParameter::StandingWheel& standing : stance->wheels) {
    const Wheel& wheel = standing.wheel;
    const Eigen::Vector3d& normal = standing.normal;
    const RollingPose from(a, wheel, normal), to(b, wheel, normal);
    const RollingStep step(from, to, normal);
    const Eigen::Vector3d along = step.by_axle(step.moved);
    const double flip =
        step.beyond_quarter_turn() > 0.0
            ? std::copysign(1.0, step.lateral) * std::copysign(wheel.radius_m, step.sine)
            : 0.0;
    const auto rows = [&](const ConfigurationState& q, const RollingPose& pose, double sign,
                          double* lateral, std::ptrdiff_t stride) {
      const RobotState& kinematics = q.kinematics;
      WheelGradient sideways{sign * step.axle, pose.axle.cross(along)};
      if (flip != 0.0) sideways.by_turn += sign * flip * turn_gradient(pose, normal);
      sideways.add_to(kinematics, wheel, pose, lateral);
      double* turned = lateral + stride;
      WheelGradient forward = step.way_gradient(pose, normal, sign);
      if (standing.locked) {
        forward.add_to(kinematics, wheel, pose, turned);
        forward = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
        turned += stride;
      }
      const double scale = (standing.locked ? sign : -sign) * wheel.radius_m;
      forward.by_turn += scale * pose.pitch_gradient(normal);
      forward.add_to(kinematics, wheel, pose, turned);
      if (wheel.joint >= 0) turned[q.model().base_tangent_size() + wheel.joint] += scale;
    };
    rows(a, from, -1.0, ja.row(row).data(), ja.outerStride());
    rows(b, to, 1.0, jb.row(row).data(), jb.outerStride());
    row += rows_of(standing);
  }
}

RowLabel EdgeRolling::row_label(int row) const {
  for (const StanceParameter::StandingWheel& standing : stance->wheels) {
    static constexpr const char* kRows[] = {" lateral", " longitudinal", " turned"};
    if (row < rows_of(standing)) return {standing.wheel.name + kRows[row], "m"};
    row -= rows_of(standing);
  }
  return {};
}

}  // namespace locograph
