#pragma once
/// How a robot on wheels that is off its plan comes back to it.
///
///     DriveBack back(online_plan);
///     if (!back.begin(window, was)) roll_on_beside_the_plan();
///
/// What it is off gets less as 1 - 10 t^3 + 15 t^4 - 6 t^5 along the way that it drives: in 1.6 s
/// or, where that asks for more than 0.15 m/s² or is not eight times as far as it is off, in as
/// long as it takes; its wheels are steered along that way. It is what is planned from then on, and
/// what EDGE_PLAN_TRACKING and EDGE_VELOCITY_TRACKING track: these are weak to the side, so that
/// obstacles are passed, and would bring it back within tens of seconds.

#include <locograph/planners/online/driven_way.h>
#include <locograph/planners/online/plan_wheels.h>
#include <locograph/planners/online/window.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

namespace locograph {

class DriveBack {
 public:
  /// The plan must outlive it.
  explicit DriveBack(OnlinePlan& plan) : plan_(plan) {}

  /// The executed configuration, which was another one, has become what was measured. False: there
  /// is no such way, and nothing has changed: not all wheels can be steered, one would leave the
  /// ground, the robot drives nowhere, or a configuration of the window is fixed.
  bool begin(const Window& window, const Eigen::VectorXd& was);

 private:
  bool can_steer(int index);
  std::vector<double> shares_left(int executed, const Eigen::VectorXd& off) const;

  OnlinePlan& plan_;
  std::shared_ptr<const StanceParameter> stance_;  ///< of the wheels
  std::optional<DrivenWheels> wheels_;
  PlanWheels rolled_;
};

}  // namespace locograph
