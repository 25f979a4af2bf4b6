#include "ceres_pose_graph.h"

#include <ceres/ceres.h>
#include <locograph/common/deadline.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include <Eigen/Eigenvalues>

namespace locograph {
namespace {

/// A matrix S with SᵀS = Ω; Ω may be semi-definite.
template <int N>
Eigen::Matrix<double, N, N> square_root(const Eigen::Matrix<double, N, N>& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// locograph's error of edge type E, for Ceres.
template <class E, class V>
struct Residual {
  const E* edge;
  Eigen::Matrix<double, E::kDimension, E::kDimension> root;

  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    Eigen::Matrix<T, E::kDimension, 1> e;
    edge->template error<T>(V::template view<T>(a), V::template view<T>(b), e);
    Eigen::Map<Eigen::Matrix<T, E::kDimension, 1>> weighted(residual);
    weighted = root.template cast<T>() * e;
    return true;
  }
};

template <class E, class V>
void add_edges(Graph& graph, std::vector<typename V::State>& states, ceres::Problem& problem,
               std::vector<double*>& place) {
  for (const V& vertex : graph.vertices_of<V>()) states.push_back(vertex.state);
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    place.push_back(states[graph.vertex_record(slot).index].data());
  }
  for (const E& edge : graph.edges_of<E>()) {
    using Function = Residual<E, V>;
    using Cost = ceres::AutoDiffCostFunction<Function, E::kDimension, V::kStateSize, V::kStateSize>;
    problem.AddResidualBlock(new Cost(new Function{&edge, square_root(edge.information)}), nullptr,
                             place[edge.vertices[0]], place[edge.vertices[1]]);
  }
}

}  // namespace

PoseGraphRun run_ceres(const Graph& start, const CeresOptions& asked) {
  Graph graph = copy_of(start);
  const Stopwatch build;
  ceres::Problem problem;
  std::vector<double*> place;
  std::vector<Eigen::Vector3d> planar;
  std::vector<VertexSE3::State> spatial;
  if (!graph.edges_of<EdgeSE3>().empty()) {
    spatial.reserve(graph.vertex_count());
    add_edges<EdgeSE3, VertexSE3>(graph, spatial, problem, place);
    using Manifold =
        ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>;
    auto* manifold = new Manifold();  // owned by the problem
    for (double* block : place) {
      if (problem.HasParameterBlock(block)) problem.SetManifold(block, manifold);
    }
  } else {
    planar.reserve(graph.vertex_count());
    add_edges<EdgeSE2, VertexSE2>(graph, planar, problem, place);
  }
  problem.SetParameterBlockConstant(place[0]);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.num_threads = 1;
  options.use_nonmonotonic_steps = asked.nonmonotonic;
  options.max_num_iterations = asked.max_iterations;
  options.max_solver_time_in_seconds = asked.max_seconds;
  options.function_tolerance = 1e-7;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  const double build_s = build.seconds();
  const Stopwatch watch;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const double total_s = watch.seconds();
  std::vector<std::pair<double, double>> history;
  for (const ceres::IterationSummary& iteration : summary.iterations) {
    history.emplace_back(iteration.cumulative_time_in_seconds,
                         iteration.step_is_successful || iteration.iteration == 0
                             ? 2.0 * iteration.cost
                             : history.back().second);
  }
  history.emplace_back(total_s, 2.0 * summary.final_cost);
  PoseGraphRun run = finished_run(history);
  run.build_s = build_s;
  run.iterations = summary.num_successful_steps;
  run.reason = summary.message;
  run.ended = summary.termination_type == ceres::CONVERGENCE;
  return run;
}

}  // namespace locograph
