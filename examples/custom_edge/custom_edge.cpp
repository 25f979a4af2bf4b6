// An edge of your own: a robot in the plane measures its distance to beacons whose place it knows.
//
//     custom_edge out.g2o     # finds the robot, saves the graph, loads it again, times an edge
//
// doc/custom_types.md explains it.

#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/core/workspace.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace locograph;

/// Range between a planar pose and a point. Error (1): measured − predicted distance [m].
struct EdgeRange : Edge<1, VertexSE2, VertexXY> {
  double range_m = 0.0;
  auto fields() { return std::tie(range_m); }  // what is saved

  template <class T>
  void error(const SE2<T>& pose, const Eigen::Matrix<T, 2, 1>& point,
             Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    e[0] = range_m - (point - pose.translation()).norm();
  }
};
LOCOGRAPH_REGISTER_EDGE("RANGE_SE2_XY", EdgeRange)

/// Time to evaluate an edge, differentiate it and add it to the equations [ns], the best of some.
double time_of_an_edge_ns() {
  Graph graph;
  constexpr int kPoses = 1000;
  for (int i = 0; i < kPoses; ++i) {
    const SE2<double> pose(std::cos(i), std::sin(i), 0.1 * i);
    const VertexId<VertexSE2> robot = graph.add_vertex(2 * i, VertexSE2(pose));
    const VertexId<VertexXY> point = graph.add_vertex(2 * i + 1, VertexXY({5.0, 0.1 * i}));
    graph.add_edge(EdgeRange(), robot, point);
  }
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());
  double best_s = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 100; ++run) {
    const Stopwatch watch;
    workspace.linearise();
    best_s = std::min(best_s, watch.seconds());
  }
  return 1e9 * best_s / kPoses;
}

int main(int argc, char** argv) try {
  const std::string file = argc > 1 ? argv[1] : "custom_edge.g2o";
  const Eigen::Vector2d truth(1.0, 2.0);

  Graph graph;
  const VertexId<VertexSE2> robot = graph.add_vertex(0, VertexSE2(SE2<double>(0.5, 0.5, 0.0)));
  int id = 1;
  for (const Eigen::Vector2d& beacon :
       {Eigen::Vector2d(4, 0), Eigen::Vector2d(0, 5), Eigen::Vector2d(-3, -1)}) {
    const VertexId<VertexXY> point = graph.add_vertex(id++, VertexXY(beacon));
    graph.set_fixed(point, true);
    EdgeRange edge;
    edge.range_m = (beacon - truth).norm();
    edge.information(0, 0) = 1.0 / (0.1 * 0.1);  // standard deviation 0.1 m
    graph.add_edge(edge, robot, point);
  }
  // Ranges say nothing about the heading: a compass does.
  EdgePriorSE2 compass;
  compass.measurement = SE2<double>(0.0, 0.0, 0.3);
  compass.information = Eigen::Vector3d(0.0, 0.0, 100.0).asDiagonal();
  graph.add_edge(compass, robot);

  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  std::cout << result.reason_text() << "; robot at " << graph.vertex(robot).state.transpose()
            << ", chi2 " << result.final.chi2 << '\n';

  write_graph(graph, file);
  TypeRegistry types = standard_types();
  types.add_edge<EdgeRange>();
  const Graph again = read_graph(file, types);
  const bool same = write_graph_text(again) == write_graph_text(graph);
  std::cout << file << (same ? ": loaded as saved\n" : ": differs from what was saved\n");
  std::cout << "linearised in " << std::lround(time_of_an_edge_ns()) << " ns an edge\n";

  const bool found = (graph.vertex(robot).pose().translation() - truth).norm() < 1e-6;
  return result.converged && found && same ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
