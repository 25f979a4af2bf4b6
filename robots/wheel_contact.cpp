#include <locograph/common/error.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/pressed_cone.h>
#include <locograph/robots/wheel.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kOnAxle_m = 1e-6;

/// √(1 − tilt²), never so small that its derivative is not finite.
double upright(double tilt) { return std::sqrt(std::max(1e-12, 1.0 - tilt * tilt)); }

/// Height and tilt, of a locked wheel the place of its centre before them.
class WheelClosure final : public ClosureRows {
 public:
  WheelClosure(const Wheel& wheel, const Contact& contact)
      : ClosureRows(contact.locked ? std::vector{0, 1, 2, 3} : std::vector{2, 3}, wheel.carrier),
        locked_(contact.locked),
        axes_(axes_in_world(contact)),
        place_(contact.position),
        wheel_(wheel) {}

  std::optional<ContactRowLabel> label(int row) const override {
    const int holds = held()[static_cast<std::size_t>(row)];
    if (holds < 2) return std::nullopt;
    // The sine of the tilt has no unit.
    return holds == 2 ? ContactRowLabel{"height", "m"} : ContactRowLabel{"axle tilt", ""};
  }

  void error(const RobotState& state, double* e) const override {
    const WheelPose pose(state, wheel_);
    const Eigen::Vector3d normal = axes_.col(2);
    const double tilt = normal.dot(pose.axle);
    for (int row = 0; locked_ && row < 2; ++row) *e++ = axes_.col(row).dot(pose.centre - place_);
    *e++ = normal.dot(pose.centre - place_) - wheel_.radius_m * upright(tilt);
    *e = tilt;
  }

  void add_jacobian(const RobotState& state, double* jacobian,
                    std::ptrdiff_t stride) const override {
    const WheelPose pose(state, wheel_);
    const Eigen::Vector3d normal = axes_.col(2);
    const double tilt = normal.dot(pose.axle);
    for (int row = 0; locked_ && row < 2; ++row) {
      state.add_point_gradient(wheel_.carrier, pose.centre, axes_.col(row), 1.0, jacobian);
      jacobian += stride;
    }
    const Eigen::Vector3d tilting = pose.axle.cross(normal);
    state.add_wrench_gradient(wheel_.carrier, pose.centre, normal,
                              wheel_.radius_m * tilt / upright(tilt) * tilting, jacobian);
    state.add_rotation_gradient(wheel_.carrier, tilting, 1.0, jacobian + stride);
  }

 private:
  bool locked_;
  Eigen::Matrix3d axes_;   ///< in the world
  Eigen::Vector3d place_;  ///< world
  Wheel wheel_;
};

/// A disc that a joint turns.
struct WheelContact final : ContactKindEntry {
  WheelContact()
      : ContactKindEntry("wheel", {effector_fields::kRadius, effector_fields::kFriction,
                                   effector_fields::kMaxForce}) {
    rolls = true;
    stood_on = true;
  }

  void require_sound(const Robot& robot, const EndEffector& effector) const override {
    const std::string name =
        "contact of " + (effector.name.empty() ? effector.link : effector.name);
    const int link = robot.link_index(effector.link);
    const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    const JointType type =
        joint < 0 ? JointType::kFixed : robot.joints()[static_cast<std::size_t>(joint)].type;
    if (type != JointType::kRevolute && type != JointType::kContinuous) {
      throw Error(name + " is a wheel that no joint turns",
                  "a link below a revolute or continuous joint");
    }
    const Joint& axle = robot.joints()[static_cast<std::size_t>(joint)];
    if (axle.mimics >= 0) {
      throw Error(name + " is a wheel whose joint mimics '" +
                      robot.joints()[static_cast<std::size_t>(axle.mimics)].name + "'",
                  "a wheel that turns on its own");
    }
    const Eigen::Vector3d& axis = axle.axis;
    const double off_m = (effector.point - axis * axis.dot(effector.point)).norm();
    if (!(off_m <= kOnAxle_m)) {
      throw Error(name + " has its centre " + std::to_string(off_m) + " m beside its axle",
                  "a point on the axis that the joint turns about");
    }
  }

  std::unique_ptr<const ClosureRows> closure(const Robot& robot,
                                             const Contact& contact) const override {
    return std::make_unique<WheelClosure>(wheel_of(robot, contact.effector), contact);
  }

  std::unique_ptr<const WrenchCone> wrench_cone(const Contact& contact,
                                                const FrictionModel& friction) const override {
    return std::make_unique<PressedCone>(contact, friction);
  }

  std::vector<BearingRay> rays(const BearingContact& bearing, double part, double) const override {
    return pressed_rays(bearing.contact, {Eigen::Vector2d::Zero()}, part);
  }

  /// A radius away from where it would roll off.
  Eigen::Vector2d inset_m(const EndEffector& effector) const override {
    return Eigen::Vector2d::Constant(effector.radius_m);
  }

  /// The lowest point of the disc.
  Eigen::Vector3d touching_point(const RobotState& state, const Contact& contact) const override {
    const WheelPose pose(state, wheel_of(state.robot(), contact.effector));
    return lowest_point(pose, contact.effector.radius_m, contact.normal);
  }
};

}  // namespace

const ContactKindEntry& wheel_contact() {
  static const WheelContact entry;
  return entry;
}

}  // namespace locograph
