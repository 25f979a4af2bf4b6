#include "core/dense_system.h"

#include <gtest/gtest.h>

namespace locograph::test {

Loaded::Loaded(Graph& graph) {
  problem.compile(graph);
  workspace.allocate(problem);
  workspace.load_state();
}

StateEvaluation::StateEvaluation(const Problem& problem, const std::vector<double>& state)
    : state_(state) {
  scratch_.reserve(problem.scratch_bytes());
  for (std::size_t p = 0; p < problem.active().size(); ++p) {
    const VertexPool& pool = *problem.graph().vertex_pools()[p];
    derived_.push_back(pool.make_derived(problem.active()[p]));
    if (derived_.back()) pool.derive(problem.active()[p], state_.data(), *derived_.back());
  }
}

namespace {

/// What edge k of pool p is to the problem.
ConstraintKind kind_of(const Problem& problem, std::size_t p, int k) {
  for (const CompiledConstraint& c : problem.constraints()) {
    if (c.pool == static_cast<int>(p) && c.k == k) return c.kind;
  }
  return ConstraintKind::kNone;
}

}  // namespace

DenseSystem one_by_one(const Problem& problem, const std::vector<double>& state, bool numeric) {
  const int n = problem.dimension();
  DenseSystem system{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), {}};
  StateEvaluation evaluation(problem, state);
  const Evaluation x = evaluation.get();
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    EdgePool& pool = *problem.graph().edge_pools()[p];
    const CompiledEdges& edges = problem.edges()[p];
    for (int k = 0; k < static_cast<int>(edges.edges.size()); ++k) {
      Eigen::VectorXd e(pool.dimension(edges.edges[k]));
      pool.error(edges, k, x, e.data());
      // Constraints have no kernel, and an inequality counts where it is violated only.
      const ConstraintKind kind = kind_of(problem, p, k);
      const RobustKernel kernel =
          kind == ConstraintKind::kNone ? pool.kernel(edges.edges[k]) : RobustKernel();
      const Eigen::VectorXd counts =
          kind == ConstraintKind::kInequality
              ? Eigen::VectorXd((e.array() > 0.0).cast<double>().matrix())
              : Eigen::VectorXd::Ones(e.size());
      e = counts.cwiseProduct(e);
      const Eigen::MatrixXd information = pool.information(edges.edges[k]);
      const double chi2 = e.dot(information * e);
      const RobustKernel::Weights robust = kernel.weights(chi2);
      const double beta = pool.has_weights() ? 0.0 : kernel.correction(chi2, robust);
      const Eigen::VectorXd along = information * e;
      const Eigen::MatrixXd bent = information + beta * along * along.transpose();
      system.cost += {robust.cost, chi2};
      const int begin = edges.slot_begin[k], count = edges.slot_begin[k + 1] - begin;
      for (int i = 0; i < count; ++i) {
        const int at_i = edges.slots[begin + i].tangent_offset;
        if (at_i < 0) continue;
        const Eigen::MatrixXd ji = counts.asDiagonal() * pool.jacobian(edges, k, i, x, numeric);
        system.gradient.segment(at_i, ji.cols()) +=
            robust.weight * ji.transpose() * information * e;
        for (int j = 0; j < count; ++j) {
          const int at_j = edges.slots[begin + j].tangent_offset;
          if (at_j < 0) continue;
          const Eigen::MatrixXd jj = counts.asDiagonal() * pool.jacobian(edges, k, j, x, numeric);
          system.hessian.block(at_i, at_j, ji.cols(), jj.cols()) +=
              robust.weight * ji.transpose() * bent * jj;
        }
      }
    }
  }
  return system;
}

Eigen::MatrixXd dense(const BlockPattern& pattern, std::span<const double> values) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(pattern.scalar_size(), pattern.scalar_size());
  for (int c = 0; c < pattern.size(); ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int r = pattern.row[k];
      const Eigen::Map<const Eigen::MatrixXd> block(values.data() + pattern.value_offset[k],
                                                    pattern.dimension[r], pattern.dimension[c]);
      matrix.block(pattern.scalar_begin[r], pattern.scalar_begin[c], block.rows(), block.cols()) =
          block;
      matrix.block(pattern.scalar_begin[c], pattern.scalar_begin[r], block.cols(), block.rows()) =
          block.transpose();
    }
  }
  return matrix;
}
Eigen::MatrixXd dense_hessian(Workspace& workspace) {
  return dense(workspace.problem().pattern(), workspace.hessian());
}
Eigen::VectorXd dense_gradient(Workspace& workspace) {
  return Eigen::Map<Eigen::VectorXd>(workspace.gradient().data(),
                                     static_cast<Eigen::Index>(workspace.gradient().size()));
}

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.size() == 0 && b.size() == 0) return 0.0;
  const double scale = std::max({1.0, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()});
  return (a - b).cwiseAbs().maxCoeff() / scale;
}

double state_difference(const Graph& a, const Graph& b) {
  double most = 0.0;
  for (int v = 0; v < b.vertex_slots(); ++v) {
    if (!b.vertex_alive(v)) continue;
    for (int i = 0; i < b.state_size(v); ++i) {
      most = std::max(most, std::abs(a.state(v)[i] - b.state(v)[i]));
    }
  }
  return most;
}

DenseSystem expect_batch_equals_one_by_one(Workspace& workspace, double tolerance) {
  const Cost evaluated = workspace.evaluate(workspace.state());
  const Cost linearised = workspace.linearise();
  DenseSystem reference = one_by_one(workspace.problem(), workspace.state());
  EXPECT_LE(relative_difference(dense_hessian(workspace), reference.hessian), tolerance);
  EXPECT_LE(relative_difference(dense_gradient(workspace), reference.gradient), tolerance);
  for (const Cost& cost : {evaluated, linearised}) {
    EXPECT_NEAR(cost.chi2, reference.cost.chi2, 1e-12 * reference.cost.chi2);
    EXPECT_NEAR(cost.robust, reference.cost.robust, 1e-12 * reference.cost.robust);
  }
  return reference;
}

}  // namespace locograph::test
