#include <cholmod.h>
#include <locograph/common/error.h>
#include <locograph/solvers/cholmod_solver.h>

#include <algorithm>

namespace locograph {

struct CholmodSolver::Session {
  cholmod_common common;
  cholmod_factor* factor = nullptr;

  explicit Session(Mode mode) {
    cholmod_start(&common);
    common.print = 0;
    common.final_ll = 1;
    if (mode == Mode::simplicial) common.supernodal = CHOLMOD_SIMPLICIAL;
    if (mode == Mode::supernodal) common.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~Session() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
};

namespace {

cholmod_sparse view(ScalarMatrix& m) {
  cholmod_sparse a{};
  a.nrow = a.ncol = static_cast<std::size_t>(m.size);
  a.nzmax = m.row.size();
  a.p = m.begin.data();
  a.i = m.row.data();
  a.x = m.value.data();
  a.stype = 1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = 1;
  a.packed = 1;
  return a;
}

}  // namespace

CholmodSolver::CholmodSolver(Mode mode) : session_(std::make_unique<Session>(mode)) {}
CholmodSolver::~CholmodSolver() = default;

void CholmodSolver::analyse(const BlockPattern& pattern) {
  if (pattern == pattern_) return;
  pattern_ = pattern;
  matrix_ = ScalarMatrix(pattern);
  cholmod_free_factor(&session_->factor, &session_->common);
  if (matrix_.size == 0) return;
  cholmod_sparse a = view(matrix_);
  session_->factor = cholmod_analyze(&a, &session_->common);
  if (!session_->factor) throw Error("CHOLMOD could not analyse the matrix", "enough memory");
}

bool CholmodSolver::factorise(const double* values, const double* damping) {
  failed_row_ = -1;
  if (matrix_.size == 0) return true;
  matrix_.set(pattern_, values, damping);
  cholmod_sparse a = view(matrix_);
  cholmod_factorize(&a, session_->factor, &session_->common);
  // The reciprocal condition number of a factor with NaN on its diagonal is 0.
  if (session_->common.status == CHOLMOD_OK &&
      cholmod_rcond(session_->factor, &session_->common) > 0.0) {
    return true;
  }
  failed_row_ = find_failed_row(pattern_, values, damping);
  return false;
}

void CholmodSolver::solve(const double* right_hand_side, double* x) const {
  if (matrix_.size == 0) return;
  cholmod_dense b{};
  b.nrow = b.d = b.nzmax = static_cast<std::size_t>(matrix_.size);
  b.ncol = 1;
  b.x = const_cast<double*>(right_hand_side);
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, session_->factor, &b, &session_->common);
  if (!solution) throw Error("CHOLMOD could not solve", "enough memory");
  std::copy_n(static_cast<const double*>(solution->x), matrix_.size, x);
  cholmod_free_dense(&solution, &session_->common);
}

}  // namespace locograph
