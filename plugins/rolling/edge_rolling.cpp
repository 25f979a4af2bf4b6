#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/rolling_step.h>

#include <cmath>
#include <numbers>

namespace locograph {

template class TypedEdgePool<EdgeRolling>;

namespace {

/// A wheel as a configuration holds it, in the world frame.
struct RollingPose : WheelPose {
  Eigen::Vector3d upright;
  double pitch;  ///< angle of `upright` from the plane's normal, about the axle
  double spin;   ///< of the wheel joint

  RollingPose(const ConfigurationState& q, const Wheel& wheel, const Eigen::Vector3d& normal)
      : WheelPose(q.kinematics, wheel),
        upright(q.kinematics.world_from_link(wheel.carrier).linear() * wheel.upright_in_carrier),
        pitch(std::atan2(normal.cross(upright).dot(axle), normal.dot(upright))),
        spin(wheel.joint < 0 ? 0.0 : q.joint(wheel.joint)) {}
};

double nearest_turn(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

/// row += scale · dψ, ψ = atan2(y, x) with y = (n × u) · a = n · (u × a) and x = n · u.
void add_pitch_gradient(const RobotState& kinematics, const Wheel& wheel, const RollingPose& pose,
                        const Eigen::Vector3d& normal, double scale, double* row) {
  const Eigen::Vector3d side = pose.upright.cross(pose.axle);  // fixed to the carrier, as u and a
  const double x = normal.dot(pose.upright), y = normal.dot(side);
  // A wheel lying flat has no pitch, hence no gradient of it.
  const double squared = std::max(1e-12, x * x + y * y);
  kinematics.add_axis_gradient(wheel.carrier, side, normal, scale * x / squared, row);
  kinematics.add_axis_gradient(wheel.carrier, pose.upright, normal, -scale * y / squared, row);
}

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
    const double turned =
        wheel.radius_m * (to.spin - from.spin + nearest_turn(to.pitch - from.pitch));
    e[row++] =
        step.lateral + std::copysign(wheel.radius_m * step.beyond_quarter_turn, step.lateral);
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
        step.beyond_quarter_turn > 0.0
            ? std::copysign(1.0, step.lateral) * std::copysign(wheel.radius_m, step.turned)
            : 0.0;
    const auto rows = [&](const ConfigurationState& q, const RollingPose& pose, double sign,
                          double* lateral, std::ptrdiff_t stride) {
      const RobotState& kinematics = q.kinematics;
      double* longitudinal = lateral + stride;
      kinematics.add_point_gradient(wheel.carrier, pose.centre, step.axle, sign, lateral);
      kinematics.add_axis_gradient(wheel.carrier, pose.axle, along, 1.0, lateral);
      if (flip != 0.0) {
        add_turn_gradient(kinematics, wheel, pose, normal, sign * flip, lateral);
      }
      step.add_way_gradient(kinematics, wheel, pose, normal, sign, 1.0, longitudinal);
      double* turned = standing.locked ? longitudinal + stride : longitudinal;
      const double scale = (standing.locked ? sign : -sign) * wheel.radius_m;
      add_pitch_gradient(kinematics, wheel, pose, normal, scale, turned);
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
