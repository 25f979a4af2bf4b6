#include <locograph/common/error.h>
#include <locograph/common/suggestion.h>
#include <locograph/solvers/banded_solver.h>
#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/dense_solver.h>
#include <locograph/solvers/eigen_solver.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/solvers/pcg_solver.h>
#include <locograph/solvers/schur_solver.h>
#if LOCOGRAPH_HAVE_CHOLMOD
#include <locograph/solvers/cholmod_solver.h>
#endif

#include <algorithm>

namespace locograph {
namespace {

/// The solver with the least estimated time. Sparse orders are only computed where they can pay.
/// before: the one of another pattern; a banded one is used again, as it has its memory.
std::unique_ptr<LinearSolver> cheapest(const BlockPattern& pattern,
                                       std::unique_ptr<LinearSolver> before) {
  const double dense = DenseSolver::seconds(pattern), banded = BandedSolver::seconds(pattern);
  const double simple = std::min(dense, banded);
  // Estimates are not better than this, and the others need no order.
  constexpr double kMargin = 0.8, kFactorisations = 10.0;
  if (kFactorisations * simple > ordering_seconds(pattern.size(), pattern.blocks())) {
    auto sparse = std::make_unique<BlockCholesky>();
    if (sparse->analyse_if_below(pattern, kMargin * simple)) return sparse;
  }
  if (dense <= banded) return std::make_unique<DenseSolver>();
  if (dynamic_cast<BandedSolver*>(before.get()) != nullptr) return before;
  return std::make_unique<BandedSolver>();
}

/// Chooses when it sees the pattern, and again when the pattern changes.
class AutoSolver final : public LinearSolver {
 public:
  std::string name() const override { return chosen_ ? chosen_->name() : "auto"; }

  void analyse(const BlockPattern& pattern) override {
    if (chosen_ && pattern == pattern_) return;
    pattern_ = {};  // until it is analysed
    if (!choose_schur(pattern)) {
      chosen_ = cheapest(pattern, std::move(chosen_));
      chosen_->use_threads(threads_);
      chosen_->analyse(pattern);
    }
    pattern_ = pattern;
  }
  void use_threads(ThreadPool* threads) override {
    threads_ = threads;
    if (chosen_) chosen_->use_threads(threads);
  }
  bool factorise(const double* values, const double* damping) override {
    return chosen_->factorise(values, damping);
  }
  void solve(const double* right_hand_side, double* x) const override {
    chosen_->solve(right_hand_side, x);
  }
  bool inverse_blocks(const BlockPattern& pattern, std::span<const std::pair<int, int>> blocks,
                      double* out) const override {
    return chosen_->inverse_blocks(pattern, blocks, out);
  }
  int failed_row() const override { return chosen_ ? chosen_->failed_row() : -1; }

 private:
  /// Vertices marked for elimination are eliminated when that costs little more than reading H, or
  /// less than a factor of the whole.
  bool choose_schur(const BlockPattern& pattern) {
    if (pattern.kept >= pattern.size() || tied_eliminated_rows(pattern).first >= 0) return false;
    auto schur = std::make_unique<SchurSolver>();
    schur->use_threads(threads_);
    schur->analyse(pattern);
    if (schur->cost() > 50.0 * static_cast<double>(pattern.values())) {
      BlockCholesky sparse;
      sparse.analyse(pattern);
      // Kernels of compile-time size run at twice the speed of a general factorisation.
      if (schur->cost() > 2.0 * sparse.multiply_adds()) return false;
    }
    chosen_ = std::move(schur);
    return true;
  }

  BlockPattern pattern_;
  std::unique_ptr<LinearSolver> chosen_;
  ThreadPool* threads_ = nullptr;
};

}  // namespace

std::vector<std::string> linear_solver_names() {
  return {
    "auto", "banded", "block-cholesky",
#if LOCOGRAPH_HAVE_CHOLMOD
        "cholmod",
#endif
        "dense", "eigen", "pcg", "schur", "schur-dense", "schur-pcg", "schur-sparse"
  };
}

std::unique_ptr<LinearSolver> make_linear_solver(const std::string& name) {
  if (name == "auto") return std::make_unique<AutoSolver>();
  if (name == "banded") return std::make_unique<BandedSolver>();
  if (name == "block-cholesky") return std::make_unique<BlockCholesky>();
#if LOCOGRAPH_HAVE_CHOLMOD
  if (name == "cholmod") return std::make_unique<CholmodSolver>();
#endif
  if (name == "eigen") return std::make_unique<EigenSolver>();
  if (name == "dense") return std::make_unique<DenseSolver>();
  if (name == "pcg") return std::make_unique<PcgSolver>();
  using Reduced = SchurSolver::Reduced;
  if (name == "schur") return std::make_unique<SchurSolver>();
  if (name == "schur-dense") return std::make_unique<SchurSolver>(Reduced::kDense);
  if (name == "schur-sparse") return std::make_unique<SchurSolver>(Reduced::kSparse);
  if (name == "schur-pcg") return std::make_unique<SchurSolver>(Reduced::kPcg);
  const std::vector<std::string> names = linear_solver_names();
  throw Error("unknown linear solver '" + name + "'",
              "one of " + joined_names(names) + did_you_mean(name, names));
}

}  // namespace locograph
