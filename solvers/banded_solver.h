#pragma once
/// Block-banded Cholesky in natural order, panel by panel: for trajectories and moving horizons.
///
/// Block column c is one dense panel over the rows from its diagonal block to the last block row
/// that its band or the fill reaches (the profile of the matrix), so products are large and nothing
/// is indexed inside them.
///
/// Blocks of the pattern whose values are all 0 count as none: most limits over three
/// configurations are not reached, and what they would tie together then costs nothing.

#include <locograph/core/linear_solver.h>
#include <locograph/solvers/aligned_memory.h>

#include <vector>

namespace locograph {

class BandedSolver final : public LinearSolver {
 public:
  std::string name() const override { return "banded"; }
  void analyse(const BlockPattern& pattern) override;
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

  /// Estimated seconds of one factorisation of this pattern.
  static double seconds(const BlockPattern& pattern);

 private:
  /// Last block row of each panel, fill included, of the blocks of the pattern that count.
  template <class Counts>
  static void find_panel_ends(const BlockPattern& pattern, Counts&& counts, std::vector<int>& last);
  void gather(const double* values);

  BlockPattern pattern_;
  std::vector<std::size_t> panel_begin_;
  std::vector<int> stride_;  ///< scalar rows of each panel, with all blocks of the pattern
  AlignedMemory panels_;
  // As it was factorised last.
  std::vector<char> counts_;  ///< by block of the pattern: not all 0
  std::vector<int> last_;     ///< last block row of each panel
  std::vector<int> height_;   ///< scalar rows of each panel
  std::vector<int> blocks_;   ///< of each panel that count
  int failed_row_ = -1;
};

}  // namespace locograph
