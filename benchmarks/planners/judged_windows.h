#pragma once
/// What the judge says of windows on wheels that the local planner hands out, beside what it says
/// itself.
///
///     JudgedWindows windows(graph, judge, task.check, 10);
///     options.on_cycle = [&](const CycleReport& cycle) { windows.look(cycle); };
///     …
///     if (windows.counts().wrongly_feasible > 0) std::cerr << windows.counts().refused << '\n';

#include <locograph/check/judge.h>
#include <locograph/core/graph.h>
#include <locograph/planners/online/cycle_report.h>

#include <string>

namespace locograph {

struct WindowCounts {
  int windows = 0;           ///< judged
  int called_feasible = 0;   ///< by the planner
  int judged_feasible = 0;   ///< by the judge
  int agreed_feasible = 0;   ///< by both
  int wrongly_feasible = 0;  ///< by the planner alone
  std::string refused;       ///< what the judge said of the first window wrongly called feasible
};

class JudgedWindows {
 public:
  /// Graph and judge must outlive it. Looks at the window of every n-th cycle.
  JudgedWindows(const Graph& graph, const Judge& judge, CheckOptions options, int every);

  void look(const CycleReport& cycle);
  const WindowCounts& counts() const { return counts_; }

 private:
  const Graph& graph_;
  const Judge& judge_;
  CheckOptions options_;  ///< of a window: the plan goes on before and after it
  int every_, cycles_ = 0;
  WindowCounts counts_;
};

}  // namespace locograph
