#pragma once
/// The cost of a graph at the values that it holds.

#include <locograph/core/problem.h>
#include <locograph/core/workspace.h>

namespace locograph::test {

inline Cost cost_of(Graph& graph) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  return workspace.evaluate(workspace.state());
}

}  // namespace locograph::test
