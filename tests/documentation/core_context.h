#pragma once
/// What the examples of core/ take for granted.

#include <locograph/core/edge.h>
#include <locograph/core/graph.h>
#include <locograph/core/optimiser.h>
#include <locograph/core/scratch.h>
#include <locograph/core/workspace.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/parameters.h>
#include <locograph/types/standard_types.h>

#include <memory>
#include <vector>

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

}  // namespace locograph

namespace locograph::documentation::in_core {

using PoseOffset = OffsetSE3;

extern Graph graph;
extern VertexId<VertexSE2> a, b;
extern VertexId<VertexXY> point;
extern EdgePriorXY on_circle;
extern EdgeId e, f;
extern std::vector<int> window, trusted_edges, rows;
extern const BlockPattern pattern;
extern const int c, columns;
extern const double *H, *damping, *rhs;
extern double* x;
extern Workspace workspace;
extern OptimiserOptions options;
extern std::unique_ptr<LinearSolver> solver;
extern FieldReader in;
extern Scratch scratch;

namespace optimiser_h {
extern LinearSolver& solver;
}
namespace reference_cost_h {
extern const double cost, trial_cost, predicted;
}
namespace weighted_square_h {
extern const EdgePool& pool;
extern const int index;
extern const Eigen::VectorXd error;
}  // namespace weighted_square_h
namespace scratch_h {
extern const int rows;
}
namespace violations_h {
extern Optimiser optimiser;
}

}  // namespace locograph::documentation::in_core
