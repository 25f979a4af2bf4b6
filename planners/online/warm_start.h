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
/// A robot that is elsewhere than its plan, by whatever pushed it, is led back: on wheels the
/// window makes the steps that it made, from where the robot is; on legs it comes back within 1.6
/// s, sooner if it is to be at rest before, at s(t) = 1 - 10 t^3 + 15 t^4 - 6 t^5 of what it is
/// off, so that it begins and ends without another velocity or acceleration.
///
/// An unfinished window is one beside that of the graph: not better yet, but worth another cycle.
/// It is extended in the same way until a cycle loads it or drops it.

#include <locograph/planners/online/window.h>
#include <locograph/planners/posture/contact_projection.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

class WarmStart {
 public:
  /// The plan must outlive it.
  explicit WarmStart(OnlinePlan& plan)
      : plan_(plan), contacts_(plan.robot()), unfinished_(plan.planned().size()) {}

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
  Eigen::VectorXd planned_step_with_drift(int index, const Eigen::VectorXd& before,
                                          const Eigen::VectorXd* before_that) const;
  void roll_on(int index, const Eigen::VectorXd& before, const Eigen::VectorXd& step,
               Eigen::VectorXd& q) const;
  Eigen::VectorXd led_back(int index, const Eigen::VectorXd& q) const;
  double time_to_lead_back(int executed) const;
  void set_contacts(int index, int beside);
  void close_before(const Window& window);

  OnlinePlan& plan_;
  ContactProjection contacts_;
  std::vector<Eigen::VectorXd> unfinished_;  ///< by index in the plan
  Eigen::VectorXd off_;                      ///< see lead_back(), tangent; empty: nothing
  double off_since_s_ = 0.0, back_s_ = 1.0;
  int unfinished_end_ = 0;  ///< index after its last configuration; 0: none
};

}  // namespace locograph
