#pragma once
/// The null space of H at the present state of a workspace: what its edges do not measure.
///
///     workspace.evaluate(workspace.state());
///     workspace.linearise();
///     NullSpace free(workspace);
///     free.dimension();                              // 3 for a planar map that nothing holds
///
/// Two steps, because a long trajectory is nearly free: the smallest eigenvalue of a held chain of
/// n poses falls as n⁻⁴. First H, scaled to a unit diagonal, is factorised as LDLᵀ on a
/// minimum-degree order (up-looking, Davis 2005, "Algorithm 849"). A row with a pivot below 1e-6 is
/// a candidate: it is anchored by adding one to the pivot, so that rounding cannot spread. With E
/// the unit vectors of the candidates, every null vector lies in the span of V = (H + EEᵀ)⁻¹E. Then
/// the energy of that span is summed edge by edge, VᵀJᵀΩJV, which squares the rounding of J instead
/// of suffering that of H; V is refined with residuals of the same kind. What stays below 1e-17 of
/// the scaled length is free. An anchor weaker than that counts as none.
///
/// Costs a few iterations of a general sparse solver; much more where many rows are candidates.

#include <locograph/common/termination.h>
#include <locograph/core/workspace.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

namespace locograph {

class NullSpace {
 public:
  /// Vertices that H ties together, with their free directions.
  struct Part {
    std::vector<int> blocks;     ///< block rows, ascending
    Eigen::MatrixXd directions;  ///< steps, one in each column; rows of the blocks in their order
  };

  explicit NullSpace(Workspace& workspace, const Termination& termination = {});

  /// False: the termination ended it, and it has no parts.
  bool complete() const { return complete_; }
  /// Those that have any.
  std::span<const Part> parts() const { return parts_; }
  int dimension() const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  /// The candidates among vertices that H ties together; V and what the edges make of it, scaled.
  struct Group {
    std::vector<int> blocks;             ///< block rows, ascending
    std::vector<int> rows;               ///< its rows in the order of the factorisation, ascending
    std::vector<int> position;           ///< of those rows in the matrices
    std::vector<int> anchors;            ///< positions of the candidates
    Eigen::MatrixXd v, product, energy;  ///< V, JᵀΩJV, VᵀJᵀΩJV
  };

  /// Whether the termination lets it; from the first time that it does not complete() is false.
  bool goes_on();
  Sparse scaled_hessian();
  void analyse(const Sparse& upper);
  void factorise(const Sparse& upper);
  std::vector<Group> make_groups();
  void solve(const Group& group, Eigen::Ref<Eigen::VectorXd> x, Eigen::VectorXd& scratch) const;
  void refine(std::vector<Group>& groups);
  void sum_edges(std::vector<Group>& groups);
  void keep_free(const Group& group);

  Workspace& workspace_;
  Termination termination_;
  bool complete_ = true;
  Eigen::VectorXd scale_;  ///< D^-½
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order_;
  std::vector<int> parent_, column_size_, row_;
  std::vector<std::int64_t> column_begin_;
  std::vector<double> value_, pivot_;
  std::vector<int> candidate_rows_;     ///< in the order of the factorisation
  std::vector<int> block_of_row_;       ///< by scalar row of H
  std::vector<int> group_of_block_;     ///< -1: no candidate near
  std::vector<int> position_of_block_;  ///< first row in the matrices of its group
  std::vector<Part> parts_;
};

}  // namespace locograph
