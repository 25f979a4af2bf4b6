#pragma once
/// What the examples of core/ take for granted.

// Not run: core/plugin_library.h: there is no librange.so; core_tests load plug-ins

#include <documentation/example_context.h>
#include <documentation/planar_map.h>
#include <locograph/core/edge.h>
#include <locograph/core/graph.h>
#include <locograph/core/optimiser.h>
#include <locograph/core/scratch.h>
#include <locograph/core/workspace.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/standard_types.h>

// As locograph_add_plugin() defines it.
#define LOCOGRAPH_HEADERS "headers"

namespace locograph {

/// The edge of the examples, as in edge.h.
struct EdgeRange : Edge<1, VertexSE2, VertexXY> {
  double range_m = 0.0;
  auto fields() { return std::tie(range_m); }
  template <class T>
  void error(const SE2<T>& pose, const Eigen::Matrix<T, 2, 1>& point,
             Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    e[0] = range_m - (point - pose.translation()).norm();
  }
};
LOCOGRAPH_REGISTER_EDGE("RANGE_SE2_XY", EdgeRange)

/// A vertex and a parameter of one's own.
struct VertexBeacon : VertexXY {};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_BEACON", VertexBeacon)
struct RangeOffset : Parameter {
  double offset_m = 0.0;
  std::string_view tag() const override { return "PARAMS_RANGE_OFFSET"; }
  void read(FieldReader& in) override { offset_m = in.number(); }
  void write(FieldWriter& out) const override { out.number(offset_m); }
};

}  // namespace locograph

namespace locograph::documentation::in_core {

/// A map that is being optimised. e: a measurement; b, a: poses.
struct Context {
  LinearisedMap map;
  Graph& graph = map.graph;
  const VertexId<VertexSE2> a = map.poses[1], b = map.poses[2];
  const EdgeId e = map.sights[0];
  const std::vector<int> window = {a.slot, b.slot}, trusted_edges = {map.odometry[0].slot};
  std::vector<int> rows;
  const BlockPattern& pattern = map.problem.pattern();
  const int c = 1, columns = 3;
  std::vector<double> right_hand_side = std::vector<double>(map.problem.dimension(), 1.0);
  std::vector<double> solution = right_hand_side;
  const double *H = map.workspace.hessian().data(), *damping = map.workspace.damping().data(),
               *rhs = right_hand_side.data();
  double* x = solution.data();
  Workspace& workspace = map.workspace;
  OptimiserOptions options;
  std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");

  Context() {
    for (const char* file : {"map.g2o", "beacons.g2o"}) write_example_file(file, kMapFile);
  }
};

namespace constraint_h {
/// An edge with a diagonal Ω of its own, as an inequality needs.
struct Context : in_core::Context {
  const EdgeId e = graph.add_edge(EdgePriorXY(), map.points[0]);
};
}  // namespace constraint_h
namespace bindings_h {
/// With a parameter in it.
struct Context : in_core::Context {
  Context() { graph.parameters().set(0, std::make_shared<RangeOffset>()); }
};
}  // namespace bindings_h
namespace edge_line_h {
struct Context : in_core::Context {
  const FileLine where{"beacons.g2o", 7, "."};
  FieldReader in{"2.5 100", where};
};
}  // namespace edge_line_h
namespace optimiser_h {
struct Context : in_core::Context {
  LinearSolver& solver = *in_core::Context::solver;
};
}  // namespace optimiser_h
namespace reference_cost_h {
struct Context : in_core::Context {
  const double cost = 5.0, trial_cost = 4.0, predicted = 1.5;
};
}  // namespace reference_cost_h
namespace weighted_square_h {
struct Context : in_core::Context {
  const EdgePool& pool = *graph.edge_pools()[graph.edge_record(e.slot).pool];
  const int index = graph.edge_record(e.slot).index;
  const Eigen::VectorXd error = Eigen::Vector2d(0.1, 0.2);
};
}  // namespace weighted_square_h
namespace scratch_h {
struct Context : in_core::Context {
  const int rows = 2;
  Scratch scratch;
  Context() { scratch.reserve(Scratch::bytes<double>(rows * columns)); }
};
}  // namespace scratch_h
namespace violations_h {
/// A run whose constraint does not hold yet.
struct Context : in_core::Context {
  Optimiser optimiser{options};
  Context() {
    graph.set_constraint(e, ConstraintKind::kEquality);
    map.problem.compile(graph);
    workspace.allocate(map.problem);
    workspace.load_state();
    optimiser.start(workspace, *solver);
  }
};
}  // namespace violations_h

}  // namespace locograph::documentation::in_core
