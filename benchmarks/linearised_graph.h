#pragma once
/// A pose graph's normal equations at its initial values: what factorisations are timed on.
///
///     LinearisedGraph graph(file);
///     solver.analyse(graph.problem.pattern());
///     solver.factorise(graph.workspace.hessian().data(), graph.damping.data());

#include <locograph/core/graph_file.h>
#include <locograph/core/workspace.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace locograph {

struct LinearisedGraph {
  Graph graph;  ///< the vertex with id 0 is fixed
  Problem problem;
  Workspace workspace;
  std::vector<double> damping;

  explicit LinearisedGraph(const std::filesystem::path& file)
      : graph(read_graph(file, standard_types(), {.lenient = true})) {
    graph.set_fixed(0, true);
    problem.compile(graph);
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    workspace.linearise();
    std::vector<double> diagonal(problem.dimension());
    workspace.diagonal(diagonal);
    damping.assign(problem.dimension(), 1e-5 * *std::max_element(diagonal.begin(), diagonal.end()));
  }
};

}  // namespace locograph
