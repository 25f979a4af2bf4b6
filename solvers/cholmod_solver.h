#pragma once
/// CHOLMOD behind our interface (Chen, Davis, Hager & Rajamanickam 2008): simplicial, supernodal,
/// or what it chooses. Optional; its supernodal half is GPL, so a program linked with it is too.
/// Allocates in solve(), unlike ours.
///
///     CholmodSolver solver(CholmodSolver::Mode::supernodal);

#include <locograph/core/linear_solver.h>
#include <locograph/solvers/scalar_matrix.h>

#include <memory>

namespace locograph {

class CholmodSolver final : public LinearSolver {
 public:
  enum class Mode { automatic, simplicial, supernodal };

  explicit CholmodSolver(Mode mode = Mode::automatic);
  ~CholmodSolver() override;

  std::string name() const override { return "cholmod"; }
  void analyse(const BlockPattern& pattern) override;
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

 private:
  struct Session;
  BlockPattern pattern_;
  ScalarMatrix matrix_;
  std::unique_ptr<Session> session_;
  int failed_row_ = -1;
};

}  // namespace locograph
