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

/// What the two poses of a wheel have between them.
struct WheelStep {
  Eigen::Vector3d moved;     ///< of the centre, horizontal
  Eigen::Vector3d from, to;  ///< the axles' horizontal parts
  Eigen::Vector3d axle;      ///< midway between them, horizontal, unit
  double length;             ///< of the sum of `from` and `to`; 0: opposite, they have no middle
  double turned;             ///< the angle between them about ẑ
  double lateral;            ///< moved · axle
  double beyond_quarter_turn;

  WheelStep(const WheelPose& a, const WheelPose& b)
      : moved(b.centre - a.centre), from(a.axle), to(b.axle) {
    moved.z() = from.z() = to.z() = 0.0;
    const Eigen::Vector3d sum = from + to;
    length = sum.norm();
    constexpr double kOpposite = 1e-6;
    if (length < kOpposite) length = 0.0;
    axle = length > 0.0 ? Eigen::Vector3d(sum / length) : kUp.cross(from).stableNormalized();
    turned = std::atan2(kUp.dot(from.cross(to)), from.dot(to));
    lateral = moved.dot(axle);
    beyond_quarter_turn = std::max(0.0, std::abs(turned) - 0.5 * std::numbers::pi);
  }

  /// The derivative of v · axle by either axle.
  Eigen::Vector3d by_axle(const Eigen::Vector3d& v) const {
    if (length == 0.0) return Eigen::Vector3d::Zero();
    return (v - axle.dot(v) * axle) / length;
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
    const WheelStep step(from, to);
    const double rolled = to.spin - from.spin + nearest_turn(to.pitch - from.pitch);
    e[2 * w] =
        step.lateral + std::copysign(wheel.radius_m * step.beyond_quarter_turn, step.lateral);
    e[2 * w + 1] = step.moved.dot(step.axle.cross(kUp)) - wheel.radius_m * rolled;
  }
}

void EdgeRolling::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                            JacobianRef<EdgeRolling, 0> ja, JacobianRef<EdgeRolling, 1> jb) const {
  for (std::size_t w = 0; w < wheels->wheels.size(); ++w) {
    const Wheel& wheel = wheels->wheels[w];
    const WheelPose from(a, wheel), to(b, wheel);
    const WheelStep step(from, to);
    const Eigen::Vector3d heading = step.axle.cross(kUp);
    // Δc · (ā × ẑ) = ā · (ẑ × Δc)
    const Eigen::Vector3d along = step.by_axle(step.moved),
                          across = step.by_axle(kUp.cross(step.moved));
    const double flip =
        step.beyond_quarter_turn > 0.0
            ? std::copysign(1.0, step.lateral) * std::copysign(wheel.radius_m, step.turned)
            : 0.0;
    const auto rows = [&](const ConfigurationState& q, const WheelPose& pose, double sign,
                          double* lateral, double* longitudinal) {
      const RobotState& kinematics = q.kinematics;
      kinematics.add_point_gradient(wheel.carrier, pose.centre, step.axle, sign, lateral);
      kinematics.add_axis_gradient(wheel.carrier, pose.axle, along, 1.0, lateral);
      if (flip != 0.0) {
        // An angle θ about ẑ of a horizontal vector a changes by (ẑ × a) · da / |a|².
        const Eigen::Vector3d horizontal(pose.axle.x(), pose.axle.y(), 0.0);
        kinematics.add_axis_gradient(wheel.carrier, pose.axle, kUp.cross(horizontal),
                                     sign * flip / horizontal.squaredNorm(), lateral);
      }
      kinematics.add_point_gradient(wheel.carrier, pose.centre, heading, sign, longitudinal);
      kinematics.add_axis_gradient(wheel.carrier, pose.axle, across, 1.0, longitudinal);
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
