#pragma once
/// Whether forces within bounds do what is asked of them, and if not, a half-space between.
///
///     ReachProgramme programme(columns, within, inside, bounds);
///     if (const auto y = programme.halfspace_before(target)) std::cout << y->transpose() << '\n';
///
/// A linear programme: with f_0 forces inside all bounds and m_0 = C f_0, the largest t <= 1 for
/// which C f is within a box about m_0 + t (m - m_0). The dual variables of C are the half-space.
/// Thread-safety: one thread at a time.

#include <locograph/planners/balance/linear_programme.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace locograph {

class ReachProgramme {
 public:
  struct Bounds {
    std::vector<int> group;            ///< of each force
    std::vector<double> lower, upper;  ///< of each force
    std::vector<double> least;         ///< of the sum of each group; 0: none
    std::vector<double> most;          ///< of the sum of each group; negative: none
  };

  /// columns: what each force does. within: half the size of the box, row by row. inside: f_0.
  ReachProgramme(const Eigen::MatrixXd& columns, const Eigen::VectorXd& within,
                 const Eigen::VectorXd& inside, const Bounds& bounds);

  /// y of length 1 with y . m larger than forces allow; nothing when they reach m.
  std::optional<Eigen::VectorXd> halfspace_before(const Eigen::VectorXd& target);

 private:
  Eigen::VectorXd middle_;
  int way_;  ///< the column of t
  LinearProgramme programme_;
};

}  // namespace locograph
