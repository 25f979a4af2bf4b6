#pragma once
/// A small dense quadratic programme: the least 1/2 x'H x + g'x with lower <= A x <= upper, H
/// positive definite. A row whose bounds are equal is an equality.
///
///     DenseQp qp(2, 1);                                  // variables, rows
///     qp.hessian().setIdentity();
///     qp.gradient() << -2.0, -2.0;
///     qp.row(0) << 1.0, 1.0;                             // x + y <= 1
///     qp.bound(0, -kUnbounded, 1.0);
///     if (qp.solve() == QpAnswer::kOptimal) std::cout << qp.solution().transpose() << '\n';
///
/// The dual active-set method of Goldfarb & Idnani, "A numerically stable dual method for solving
/// strictly convex quadratic programs", Mathematical Programming 27, 1983: it begins at the least
/// of the cost alone and takes in rows that are violated, so that nothing feasible has to be known.
/// Of the violated ones those come first that were active in the last solution: a row of similar
/// programmes costs a few steps each. The solution does not depend on that but for rounding.
///
/// Rows should be of the order of one. Nothing allocates after the constructor. Thread-safety: one
/// thread at a time.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <limits>
#include <vector>

namespace locograph {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

enum class QpAnswer {
  kOptimal,
  kInfeasible,
  kUnsolved,  ///< a numerical failure, or a Hessian that is not positive definite
};

class DenseQp {
 public:
  /// Hessian, gradient and rows are zero, rows without bounds.
  DenseQp(int variables, int rows);

  int variables() const { return static_cast<int>(gradient_.size()); }
  int rows() const { return static_cast<int>(lower_.size()); }

  /// Its lower triangle is read.
  Eigen::MatrixXd& hessian() { return hessian_; }
  Eigen::VectorXd& gradient() { return gradient_; }
  auto row(int i) { return rows_.row(i); }
  /// lower <= upper; infinities are no bounds.
  void bound(int i, double lower, double upper) {
    lower_[i] = lower;
    upper_[i] = upper;
  }

  QpAnswer solve();
  /// Of the last solve(), with success.
  const Eigen::VectorXd& solution() const { return x_; }
  /// Of each row: H x + g = A' multipliers; above 0 at its lower bound, below 0 at its upper one.
  const Eigen::VectorXd& multipliers() const { return multipliers_; }
  int steps() const { return steps_; }
  /// Nothing is known of a solution before.
  void forget() { was_active_.assign(was_active_.size(), false); }

 private:
  struct Violated {
    int row = -1;
    double sign = 0.0;  ///< 1: below its lower bound
  };

  bool begin();
  Violated most_violated() const;
  QpAnswer take_in(Violated violated);
  void find_directions();
  bool add(int row, double sign, double multiplier);
  void drop(int position);

  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows_;
  Eigen::VectorXd lower_, upper_, length_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd x_, multipliers_;
  std::vector<bool> was_active_;
  int steps_ = 0;

  // With the active rows N, signed so that N x >= b: J J' = H^-1 and J'N = (R; 0).
  int active_ = 0;
  std::vector<int> active_row_;
  std::vector<double> active_sign_;
  std::vector<bool> is_active_, is_dependent_;
  Eigen::MatrixXd j_, r_;
  Eigen::VectorXd dual_, normal_, d_, along_, change_;
};

}  // namespace locograph
