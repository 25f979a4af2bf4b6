#pragma once
/// Covariances of chosen vertices at the optimum: blocks of (JᵀΩJ)⁻¹.
///
///     Covariance covariance(graph, make_linear_solver("auto"));   // linearises and factorises
///     if (!covariance.singular()) Eigen::Matrix3d sigma = covariance.block(a, a);
///     std::vector<std::pair<int, int>> pairs = {{a.slot, a.slot}, {a.slot, b.slot}};
///     std::vector<Eigen::MatrixXd> blocks = covariance.blocks(pairs);
///
/// A block is a dimension × dimension matrix in the tangents of its two vertices, for the free
/// vertices of the graph with the others held where they are. Ω is taken to be the inverse
/// covariance of the measurement, whose likelihood is exp(−½ eᵀΩe); robust kernels count with their
/// weight at the present state. Works with every linear solver, also one that eliminates vertices.
///
/// Ask for many blocks at once: they share the work (LinearSolver::inverse_blocks). A covariance
/// owns all it needs: the solver, which keeps the factorisation, and what it noted of the graph. It
/// is that of the graph as it was, whatever becomes of the graph.

#include <locograph/core/graph.h>
#include <locograph/core/linear_solver.h>

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

class Covariance {
 public:
  /// At the graph's present state, which stays. Throws Error without a solver.
  Covariance(Graph& graph, std::unique_ptr<LinearSolver> solver);

  /// Some direction is not measured (or no state is finite): there is no covariance.
  bool singular() const { return singular_; }
  /// Empty when it is not singular.
  const std::string& reason_text() const { return reason_; }

  /// By vertex slots. Throws Error when singular, and for vertices that were fixed or not there.
  Eigen::MatrixXd block(int a, int b) const;
  std::vector<Eigen::MatrixXd> blocks(std::span<const std::pair<int, int>> pairs) const;
  template <class A, class B>
  Eigen::MatrixXd block(VertexId<A> a, VertexId<B> b) const {
    return block(a.slot, b.slot);
  }
  /// Of several vertices together, in the order given.
  Eigen::MatrixXd joint(std::span<const int> vertices) const;

 private:
  struct VertexRow {
    int id;
    int row;  ///< in the pattern; or one of:
    static constexpr int kHeld = -1, kNotThere = -2;
  };

  int block_row(int slot) const;

  std::unique_ptr<LinearSolver> solver_;
  BlockPattern pattern_;
  std::vector<double> hessian_, damping_;  ///< conjugate gradients need them to solve
  std::vector<VertexRow> vertices_;        ///< by slot
  bool singular_ = false;
  std::string reason_;
};

}  // namespace locograph
