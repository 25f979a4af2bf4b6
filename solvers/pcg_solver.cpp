#include <locograph/common/check_option.h>
#include <locograph/solvers/pcg_solver.h>

namespace locograph {

void PcgOptions::validate() const {
  check_option(relative_tolerance > 0.0 && relative_tolerance < 1.0, "relative_tolerance",
               "a number between 0 and 1");
  check_option(max_iterations >= 1, "max_iterations", "1 or more");
}

PcgSolver::PcgSolver(const PcgOptions& options) : options_(options) { options.validate(); }

void PcgSolver::analyse(const BlockPattern& pattern) {
  if (pattern == pattern_) return;
  pattern_ = pattern;
  product_.analyse(pattern_);
  preconditioner_.analyse(pattern_);
  iteration_.resize(pattern_.scalar_size());
}

bool PcgSolver::factorise(const double* values, const double* damping) {
  failed_row_ = -1;
  values_ = values;
  damping_ = damping;
  if (pattern_.size() == 0) return true;
  preconditioner_.load(values, damping);
  failed_row_ = preconditioner_.invert(threads_);
  return failed_row_ < 0;
}

void PcgSolver::solve(const double* right_hand_side, double* x) const {
  if (pattern_.size() == 0) return;
  iterations_ = iteration_.solve(
      options_, threads_, right_hand_side, x,
      [&](const double* v, double* out) { product_.apply(values_, damping_, v, out, threads_); },
      [&](const double* v, double* out) { preconditioner_.apply(v, out, threads_); });
}

}  // namespace locograph
