#pragma once
/// The wheels that an online plan stands on, made again only where its stance is another one.
///
///     PlanWheels wheels;
///     wheels.at(online, index).roll(before, q);

#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/online/online_plan.h>

#include <memory>
#include <optional>

namespace locograph {

class PlanWheels {
 public:
  /// Of the stance that a configuration is in; it may have none.
  WheelMotion& at(const OnlinePlan& plan, int index) {
    const auto& stance = plan.plan().stance_from[static_cast<std::size_t>(index)];
    if (stance != stance_) {
      motion_.emplace(plan.robot(), stance->stance);
      stance_ = stance;
    }
    return *motion_;
  }

 private:
  std::shared_ptr<const StanceParameter> stance_;
  std::optional<WheelMotion> motion_;
};

}  // namespace locograph
