#pragma once
/// What `locograph plan` is asked, and who plans each kind of scenario.

#include <locograph/apps/command.h>
#include <locograph/common/deadline.h>
#include <locograph/planners/offline/stance/stance_plan.h>
#include <locograph/planners/scenario/scenario.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

namespace locograph {

inline int processor_count() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

struct PlanOptions {
  std::string scenario, output, tree, torques, planner = "guided";
  std::vector<std::string> segment_planners;  ///< empty: all
  bool stances_only = false, improve = false;
  unsigned seed = 0;
  double timeout_s = 0.0;  ///< 0: no limit
  int max_transitions = StancePlannerOptions().max_transitions;
  double move_contacts_m = 0.0;
  double margin_factor = 1.0;  ///< of the scenario's execution margin
  int threads = processor_count();
  bool json = false;
};

/// Of a scenario with a <drive>. total: runs since before the scenario was read.
ExitCode plan_drive(const Scenario& scenario, const PlanOptions& options, const Stopwatch& total);

/// Of a scenario with <start> and <goal>s: the stances and, unless they are all that is asked for,
/// the motion.
ExitCode plan_contact_task(const Scenario& scenario, const PlanOptions& options);

}  // namespace locograph
