#pragma once
/// Where the optimisation of a window begins: at the window of the last cycle, extended by the
/// configurations that enter.
///
///     WarmStart warm_start(online);
///     window.move_to(executed);
///     warm_start.enter(window);            // initialises new configurations, in the graph
///     // … the deadline passes before the result is better than the last one:
///     warm_start.keep_unfinished(window);  // the next cycle continues from there
///
/// A configuration that enters makes the step that the plan makes there from the configuration
/// before it, plus the drift from the plan that the step before had: steered wheels cannot return
/// to the plan within one step.
///
/// A robot that is elsewhere than its plan, by whatever pushed it, is led back. On legs see
/// way_back.h. On wheels the window makes the steps that it made, from where the robot is, and what
/// it tracks leads back, see drive_back.h.
///
/// An unfinished window is one beside that of the graph: not better yet, but worth another cycle.
/// It is extended in the same way until a cycle loads it or drops it.

#include <locograph/planners/online/drive_back.h>
#include <locograph/planners/online/plan_wheels.h>
#include <locograph/planners/online/way_back.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

class WarmStart {
 public:
  /// The plan must outlive it.
  explicit WarmStart(OnlinePlan& plan)
      : plan_(plan),
        on_legs_(plan),
        on_wheels_(plan),
        step_(plan.robot().tangent_size()),
        unfinished_(plan.planned()) {
    made_ = planned_before_ = step_;
  }

  /// Initialises the configurations that have entered the window, but for fixed ones: those of the
  /// graph, and those of an unfinished window.
  void enter(const Window& window);

  /// The executed configuration, which was another one, has become what was measured. Initialises
  /// the whole window, in the graph, and drops what was unfinished.
  void lead_back(const Window& window, const Eigen::VectorXd& was);

  bool has_unfinished() const { return unfinished_end_ > 0; }
  /// Writes the unfinished window, which there must be, into the graph.
  void load_unfinished(const Window& window);
  /// Keeps the configurations that the graph has now.
  void keep_unfinished(const Window& window);
  void drop_unfinished() { unfinished_end_ = 0; }

 private:
  using Configuration = Eigen::Ref<const Eigen::VectorXd>;
  void planned_step_with_drift(int index, const Configuration& before, const double* before_that,
                               Eigen::Ref<Eigen::VectorXd> q);
  void roll_on(int index, const Configuration& before, const Eigen::VectorXd& step,
               Eigen::Ref<Eigen::VectorXd> q);
  void roll_from(const Window& window, const Eigen::VectorXd& was);

  OnlinePlan& plan_;
  WayBack on_legs_;
  DriveBack on_wheels_;
  PlanWheels wheels_;
  Eigen::VectorXd step_, made_, planned_before_;
  std::vector<Eigen::VectorXd> unfinished_;  ///< by index in the plan
  int unfinished_end_ = 0;                   ///< index after its last configuration; 0: none
};

}  // namespace locograph
