#pragma once
/// The null space of H at the present state of a workspace: what its edges do not measure.
///
///     workspace.evaluate(workspace.state());
///     workspace.linearise();
///     NullSpace free(workspace);
///     for (int i = 0; i < free.dimension(); ++i) Eigen::VectorXd step = free.direction(i);
///
/// H, scaled to a unit diagonal, is factorised as LDLᵀ on a minimum-degree order (up-looking, Davis
/// 2005, "Algorithm 849"). A pivot below 1e-12 is one free direction: that row is anchored by
/// adding one to its pivot, so that no rounding spreads, and the solution for the unit vector of
/// the row is the direction. Pivots rather than eigenvalues: the smallest eigenvalue of a held
/// chain of n poses falls as n⁻⁴, its smallest pivot as n⁻³ at worst. An anchor that holds by less
/// than 1e-12 of what lies around it counts as none. Costs about as much as one iteration of a
/// general sparse solver.

#include <locograph/core/workspace.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace locograph {

class NullSpace {
 public:
  explicit NullSpace(Workspace& workspace);

  int dimension() const { return static_cast<int>(free_rows_.size()); }
  /// A step, in the unit of each tangent, that changes no error to first order; largest entry 1.
  Eigen::VectorXd direction(int i) const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;

  Sparse scaled_hessian(Workspace& workspace);
  void analyse(const Sparse& upper);
  void factorise(const Sparse& upper);

  Eigen::VectorXd scale_;  ///< D^-½
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order_;
  std::vector<int> parent_, column_size_, row_;
  std::vector<std::int64_t> column_begin_;
  std::vector<double> value_, pivot_;
  std::vector<int> free_rows_;  ///< in the order of the factorisation
};

}  // namespace locograph
