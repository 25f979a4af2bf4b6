#include <locograph/common/error.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/frame_closure.h>

namespace locograph {
namespace {

/// The bar lies along y: all but the moment about it, each component within its limit.
class GraspCone final : public WrenchCone {
 public:
  explicit GraspCone(const EndEffector& hand)
      : WrenchCone({0, 1, 2, 3, 5}, 5),
        max_force_N_(hand.max_force_N),
        max_moment_Nm_(hand.max_moment_Nm) {}

  WrenchRow row(int i, const double* w) const override {
    WrenchRow limit;
    limit.gradient[i] = w[i] < 0.0 ? -1.0 : 1.0;
    limit.offset = i < 3 ? -max_force_N_ : -max_moment_Nm_;
    return limit;
  }

  ContactRowLabel label(int i) const override {
    return i < 3 ? ContactRowLabel{"force", "N"} : ContactRowLabel{"moment", "N m"};
  }

 private:
  double max_force_N_, max_moment_Nm_;
};

/// A hand round a bar, a "rung" in files.
struct GraspContact final : ContactKindEntry {
  GraspContact()
      : ContactKindEntry("rung", {effector_fields::kMaxForce, effector_fields::kMaxMoment}) {
    axes_on_link = true;
    forward_needed = "across the bar";
    pressed = false;
    touches_surfaces = false;
    bar_touch = BarTouch::kGrasp;
  }

  std::unique_ptr<const ClosureRows> closure(const Robot& robot,
                                             const Contact& contact) const override {
    return std::make_unique<FrameClosure>(robot, contact, contact.position,
                                          FrameClosure::Held::kTiltOfY);
  }

  std::unique_ptr<const WrenchCone> wrench_cone(const Contact& contact,
                                                const FrictionModel& friction) const override {
    if (friction.cone != FrictionCone::kCircle) {
      throw Error("contact of " + contact.name() + " is a rung with a friction cone",
                  "none: it is held by a grasp");
    }
    return std::make_unique<GraspCone>(contact.effector);
  }

  std::vector<BearingRay> rays(const BearingContact& bearing, double part,
                               double weight_N) const override {
    const Contact& contact = bearing.contact;
    const Eigen::Matrix3d axes = axes_in_world(contact);
    const double force = part * contact.effector.max_force_N / weight_N;
    const double moment = part * contact.effector.max_moment_Nm / weight_N;
    std::vector<BearingRay> rays;
    for (int i = 0; i < 3; ++i) {
      rays.push_back({contact.position, axes.col(i), Eigen::Vector3d::Zero(), -force, force});
    }
    for (const int i : {0, 2}) {  // y is the bar
      if (!(moment > 0.0)) break;
      rays.push_back({contact.position, Eigen::Vector3d::Zero(), axes.col(i), -moment, moment});
    }
    return rays;
  }
};

}  // namespace

const ContactKindEntry& grasp_contact() {
  static const GraspContact entry;
  return entry;
}

}  // namespace locograph
