#include <locograph/common/error.h>
#include <locograph/solvers/banded_solver.h>
#include <locograph/solvers/block_cholesky.h>
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

/// Chooses when it sees the pattern, and again when the pattern changes.
class AutoSolver final : public LinearSolver {
 public:
  std::string name() const override { return chosen_ ? chosen_->name() : "auto"; }

  void analyse(const BlockPattern& pattern) override {
    if (chosen_ && pattern == pattern_) return;
    pattern_ = pattern;
    const double n = pattern.scalar_size();
    const double dense = n * n * n / 6.0;
    const double banded = BandedSolver::cost(pattern);
    if (choose_schur(pattern)) return;
    if (dense <= 50e3 || (pattern.size() <= 2)) {
      chosen_ = std::make_unique<DenseSolver>();
    } else {
      auto sparse = std::make_unique<BlockCholesky>();
      sparse->analyse(pattern);
      // Panels run at several times the speed of small blocks: a band may cost twice the flops.
      if (banded <= 2.0 * sparse->multiply_adds()) {
        chosen_ = std::make_unique<BandedSolver>();
      } else {
        chosen_ = std::move(sparse);
      }
    }
    chosen_->use_threads(threads_);
    chosen_->analyse(pattern);
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
  std::string all;
  for (const std::string& known : linear_solver_names()) all += (all.empty() ? "" : ", ") + known;
  throw Error("unknown linear solver '" + name + "'", "one of " + all);
}

}  // namespace locograph
