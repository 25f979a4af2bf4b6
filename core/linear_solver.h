#pragma once
/// What an algorithm asks of a linear solver: (H + diag(damping)) x = right-hand side, H symmetric
/// positive definite and block-sparse.
///
///     std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");   // locograph/solvers
///     solver->analyse(pattern);          // symbolic; nothing happens if the pattern is the same
///     if (solver->factorise(H, damping)) solver->solve(rhs, x);
///
/// After analyse(), factorise() and solve() do not allocate. Not thread-safe.

#include <locograph/common/error.h>
#include <locograph/common/thread_pool.h>
#include <locograph/core/block_matrix.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

/// What analyse() throws when a Schur complement is to eliminate two block rows that share a block.
/// Problem::analyse() tells their vertices instead.
class TiedRowsError : public Error {
 public:
  TiedRowsError(int first_row, int second_row)
      : Error(
            "block rows " + std::to_string(first_row) + " and " + std::to_string(second_row) + kWhy,
            kExpected),
        first(first_row),
        second(second_row) {}

  static constexpr const char* kWhy = " are both marked for elimination and share an edge";
  static constexpr const char* kExpected =
      "no edge between two eliminated vertices in a Schur complement";
  int first, second;
};

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  virtual std::string name() const = 0;
  /// Threads to use from now on, null for the caller's alone. The bits of a result never depend on
  /// it. The pool must outlive the solver's use.
  virtual void use_threads(ThreadPool* /*threads*/) {}
  /// Ordering and symbolic factorisation; cheap when the pattern is the one it already has.
  virtual void analyse(const BlockPattern& pattern) = 0;
  /// values: as laid out by the pattern; damping: one number ≥ 0 for each scalar row. False when
  /// the matrix is not positive definite; failed_row() then says where.
  virtual bool factorise(const double* values, const double* damping) = 0;
  /// x may be the right-hand side itself.
  virtual void solve(const double* right_hand_side, double* x) const = 0;
  /// Blocks (r, c) of the inverse of the factored matrix, in any order and any triangle: each
  /// dimension[r] × dimension[c], column-major, one after the other. May allocate. False when a
  /// number is not finite. pattern: the one that was analysed.
  virtual bool inverse_blocks(const BlockPattern& pattern,
                              std::span<const std::pair<int, int>> blocks, double* out) const {
    return solve_for_inverse_blocks(pattern, blocks, out);
  }
  /// Block row at which the last factorisation failed, -1 when it did not.
  virtual int failed_row() const { return -1; }

 protected:
  /// The same, by one solution for each scalar column that is asked for.
  bool solve_for_inverse_blocks(const BlockPattern& pattern,
                                std::span<const std::pair<int, int>> blocks, double* out) const {
    std::vector<std::size_t> begin(blocks.size()), order(blocks.size());
    std::size_t size = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      order[i] = i;
      begin[i] = size;
      size += static_cast<std::size_t>(pattern.dimension[blocks[i].first]) *
              pattern.dimension[blocks[i].second];
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return blocks[a].second < blocks[b].second;
    });
    std::vector<double> column(pattern.scalar_size());
    for (std::size_t first = 0, end; first < order.size(); first = end) {
      const int c = blocks[order[first]].second;
      for (end = first; end < order.size() && blocks[order[end]].second == c;) ++end;
      for (int j = 0; j < pattern.dimension[c]; ++j) {
        std::fill(column.begin(), column.end(), 0.0);
        column[pattern.scalar_begin[c] + j] = 1.0;
        solve(column.data(), column.data());
        for (std::size_t k = first; k < end; ++k) {
          const int r = blocks[order[k]].first, rows = pattern.dimension[r];
          std::copy_n(column.data() + pattern.scalar_begin[r], rows,
                      out + begin[order[k]] + static_cast<std::size_t>(j) * rows);
        }
      }
    }
    return std::all_of(out, out + size, [](double v) { return std::isfinite(v); });
  }
};

}  // namespace locograph
