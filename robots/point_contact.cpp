#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/frame_closure.h>
#include <locograph/robots/pressed_cone.h>
#include <locograph/robots/rolling_ball.h>

namespace locograph {
namespace {

/// A ball, or a bare point.
struct PointContact final : ContactKindEntry {
  PointContact()
      : ContactKindEntry("point", {effector_fields::kBallRadius, effector_fields::kFriction,
                                   effector_fields::kMaxForce}) {
    turns_freely = true;
    bar_touch = BarTouch::kPoint;
  }

  std::unique_ptr<const ClosureRows> closure(const Robot& robot,
                                             const Contact& contact) const override {
    Eigen::Vector3d centre = contact.position;
    centre += contact.effector.radius_m * axes_in_world(contact).col(2);
    return std::make_unique<FrameClosure>(robot, contact, centre, FrameClosure::Held::kPosition);
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

  Eigen::Vector3d touching_point(const RobotState& state, const Contact& contact) const override {
    return rolled_to(state, contact).position;
  }
};

}  // namespace

const ContactKindEntry& point_contact() {
  static const PointContact entry;
  return entry;
}

}  // namespace locograph
