#pragma once
/// How a robot comes to rest on the way that its plan has: on the same configurations, slower and
/// slower.
///
///     Braking braking(graph, online_plan, verify);
///     if (std::optional<int> rest = braking.come_to_rest(executed, executed)) {
///       cut_plan(graph, online_plan.plan(), *rest);
///     }
///
/// On wheels it brakes before the executed configuration, as if it had known; on legs as soon as it
/// can after it, as long as forces allow, with wrenches that bear it. It rests where nothing that
/// is known comes to it within kStands_s, if there is such a place.

#include <locograph/check/check_report.h>
#include <locograph/planners/online/changing_obstacles.h>
#include <locograph/planners/online/online_plan.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace locograph {

class Braking {
 public:
  /// The graph, which is the plan's, and the plan must outlive it. verify: see WalkOptions; empty:
  /// every motion holds.
  Braking(Graph& graph, const OnlinePlan& plan, std::function<CheckReport(const Motion&)> verify);

  bool rests(int configuration) const;

  /// What braking changes of a configuration.
  struct Passing {
    double time_s;
    Eigen::VectorXd slopes;
    std::vector<Eigen::VectorXd> wrenches;
  };
  Passing passing(int configuration) const;
  void restore(int configuration, const Passing& before);

  /// Lets the robot come to rest at the configuration that is returned: on legs as soon as it can
  /// after `executed`, up to `furthest`; else at the last one, up to `executed`, at which it can.
  /// Configurations up to `carried_out` stay as they are: nullopt where it cannot come to rest
  /// after them, and then nothing changes.
  std::optional<int> come_to_rest(int executed, int furthest, int carried_out = -1);

 private:
  VertexConfiguration& vertex(int i) const;
  const std::vector<int>& wrenches_at(int i) const;
  int last_rest_before(int i) const;
  bool may_stay(int at) const;
  std::optional<int> find_rest(int executed, int furthest, int carried_out);
  void brake(int last, int steps, bool wheels);
  bool comes_to_rest(int last, int steps, bool wheels);
  int stay(int at);
  Plan part(int first, int last) const;

  Graph& graph_;
  const OnlinePlan& plan_;
  std::function<CheckReport(const Motion&)> verify_;
  bool stays_ = true;  ///< only where it may stay
};

}  // namespace locograph
