#include <locograph/plugins/rolling/edge_rolling.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {

template class TypedEdgePool<EdgeRolling>;

namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// A wheel as a configuration holds it, in the world frame.
struct WheelPose {
  Eigen::Vector3d centre, axle, upright;
  double pitch;  ///< angle of `upright` from the vertical, about the axle
  double spin;   ///< of the wheel joint

  WheelPose(const ConfigurationState& q, const Wheel& wheel) {
    const Eigen::Isometry3d& carrier = q.kinematics.world_from_link(wheel.carrier);
    centre = carrier * wheel.centre_in_carrier;
    axle = carrier.linear() * wheel.axle_in_carrier;
    upright = carrier.linear() * wheel.upright_in_carrier;
    pitch = std::atan2(kUp.cross(upright).dot(axle), kUp.dot(upright));
    spin = wheel.joint < 0 ? 0.0 : q.joint(wheel.joint);
  }
};

double nearest_turn(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

/// row += scale · dψ, ψ = atan2(y, x) with y = (ẑ × u) · a = ẑ · (u × a) and x = ẑ · u.
void add_pitch_gradient(const RobotState& kinematics, const Wheel& wheel, const WheelPose& pose,
                        double scale, double* row) {
  const Eigen::Vector3d side = pose.upright.cross(pose.axle);  // fixed to the carrier, as u and a
  const double x = pose.upright.z(), y = side.z();
  // A wheel lying flat has no pitch, hence no gradient of it.
  const double squared = std::max(1e-12, x * x + y * y);
  kinematics.add_axis_gradient(wheel.carrier, side, kUp, scale * x / squared, row);
  kinematics.add_axis_gradient(wheel.carrier, pose.upright, kUp, -scale * y / squared, row);
}

}  // namespace

void EdgeRolling::error(const ConfigurationState& a, const ConfigurationState& b,
                        Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, a.robot, robot);
  require_same_robot(kTag, b.robot, robot);
  for (std::size_t w = 0; w < wheels->wheels.size(); ++w) {
    const Wheel& wheel = wheels->wheels[w];
    const WheelPose from(a, wheel), to(b, wheel);
    Eigen::Vector3d moved = to.centre - from.centre;
    moved.z() = 0.0;
    const Eigen::Vector3d axle = 0.5 * (from.axle + to.axle);
    const double turned = to.spin - from.spin + nearest_turn(to.pitch - from.pitch);
    e[2 * w] = moved.dot(axle);
    e[2 * w + 1] = moved.dot(axle.cross(kUp)) - wheel.radius_m * turned;
  }
}

void EdgeRolling::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                            JacobianRef<EdgeRolling, 0> ja, JacobianRef<EdgeRolling, 1> jb) const {
  for (std::size_t w = 0; w < wheels->wheels.size(); ++w) {
    const Wheel& wheel = wheels->wheels[w];
    const WheelPose from(a, wheel), to(b, wheel);
    Eigen::Vector3d moved = to.centre - from.centre;
    moved.z() = 0.0;
    Eigen::Vector3d axle = 0.5 * (from.axle + to.axle);
    const Eigen::Vector3d heading = axle.cross(kUp);
    axle.z() = 0.0;  // Δc is horizontal: the axle's vertical part meets nothing
    // moved · (ā × ẑ) = ā · (ẑ × moved)
    const Eigen::Vector3d across = kUp.cross(moved);
    const auto rows = [&](const ConfigurationState& q, const WheelPose& pose, double sign,
                          double* lateral, double* longitudinal) {
      const RobotState& kinematics = q.kinematics;
      kinematics.add_point_gradient(wheel.carrier, pose.centre, axle, sign, lateral);
      kinematics.add_axis_gradient(wheel.carrier, pose.axle, moved, 0.5, lateral);
      kinematics.add_point_gradient(wheel.carrier, pose.centre, heading, sign, longitudinal);
      kinematics.add_axis_gradient(wheel.carrier, pose.axle, across, 0.5, longitudinal);
      add_pitch_gradient(kinematics, wheel, pose, -sign * wheel.radius_m, longitudinal);
      if (wheel.joint >= 0) {
        longitudinal[q.model().base_tangent_size() + wheel.joint] -= sign * wheel.radius_m;
      }
    };
    rows(a, from, -1.0, ja.row(2 * w).data(), ja.row(2 * w + 1).data());
    rows(b, to, 1.0, jb.row(2 * w).data(), jb.row(2 * w + 1).data());
  }
}

}  // namespace locograph
