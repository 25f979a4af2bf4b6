#pragma once
/// What is planned for a robot on wheels that is off its plan, so that it comes back to it.
///
///     DriveBack back(online_plan);
///     back.lead(window, was);  // what is planned, and tracked, leads back from where the robot is
///
/// The robot would go on beside its plan by the steps that are planned; what that is off gets less
/// as 1 - 10 t^3 + 15 t^4 - 6 t^5 along the way that it drives: in 1.6 s or, where that asks for
/// more than 0.15 m/s² or is not eight times as far as it is off, in as long as it takes. Wheels
/// are steered along that way. EDGE_PLAN_TRACKING and EDGE_VELOCITY_TRACKING track it from then on:
/// they are weak to the side, so that obstacles are passed, and by the plan as it came would bring
/// the robot back within tens of seconds.

#include <locograph/planners/online/driven_way.h>
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

  /// The executed configuration, which was another one, has become what was measured. Nothing
  /// changes where there is no such way: not all wheels can be steered, one would leave the ground
  /// or turn round, the robot does not drive as far in this stance any more, or a configuration of
  /// the way is fixed.
  void lead(const Window& window, const Eigen::VectorXd& was);

 private:
  bool can_steer(int index, const Eigen::VectorXd& q);
  std::vector<double> share_gone(int executed, const Eigen::VectorXd& off) const;
  void make_way(int executed, const Eigen::VectorXd& was, const std::vector<double>& gone);
  bool steer(const Eigen::VectorXd& turned, const std::vector<double>& gone);

  OnlinePlan& plan_;
  std::shared_ptr<const StanceParameter> stance_;  ///< of the wheels
  std::optional<DrivenWheels> wheels_;
  std::vector<Eigen::VectorXd> before_, way_;  ///< from the executed configuration on
};

}  // namespace locograph
