#pragma once
/// H and gradient of a compiled problem, summed edge by edge into dense matrices: what the fused
/// batch is compared with.
///
///     const DenseSystem reference = one_by_one(problem, workspace.state());
///     EXPECT_LT(relative_difference(reference.hessian, dense_hessian(workspace)), 1e-12);
///
///     expect_batch_equals_one_by_one(workspace, 1e-13);   // that, the gradient and the costs

#include <locograph/core/workspace.h>

#include <Eigen/Dense>
#include <vector>

namespace locograph::test {

/// A graph compiled, and its states loaded.
struct Loaded {
  explicit Loaded(Graph& graph);
  Problem problem;
  Workspace workspace;
};

/// The evaluation of a state, with derived quantities and scratch memory of its own.
class StateEvaluation {
 public:
  StateEvaluation(const Problem& problem, const std::vector<double>& state);
  Evaluation get() { return {state_.data(), derived_, &scratch_}; }

 private:
  std::vector<double> state_;
  std::vector<std::unique_ptr<DerivedStore>> derived_;
  Scratch scratch_;
};

struct DenseSystem {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  Cost cost;
};

DenseSystem one_by_one(const Problem& problem, const std::vector<double>& state,
                       bool numeric = false);

/// The full symmetric matrix whose upper triangle the values are.
Eigen::MatrixXd dense(const BlockPattern& pattern, std::span<const double> values);
Eigen::MatrixXd dense_hessian(Workspace& workspace);
Eigen::VectorXd dense_gradient(Workspace& workspace);

/// Largest difference of the states of the vertices that b has.
double state_difference(const Graph& a, const Graph& b);

/// Largest difference relative to the largest entry (at least 1).
double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Evaluates and linearises at the state of the workspace. The costs agree to 1e-12 of themselves.
/// Returns the reference.
DenseSystem expect_batch_equals_one_by_one(Workspace& workspace, double tolerance);

}  // namespace locograph::test
