#pragma once
/// Checks and repairs of information matrices: symmetric and positive semi-definite, or refused.

#include <Eigen/Core>

namespace locograph {

/// Smallest eigenvalue a matrix may have relative to its largest absolute one and still count as
/// positive semi-definite: what rounding of a matrix with 17 digits can produce.
inline constexpr double kInformationTolerance = 1e-12;

bool is_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& information);
bool is_positive_semidefinite(const Eigen::Ref<const Eigen::MatrixXd>& information);
/// The nearest positive semi-definite matrix in the Frobenius norm: negative eigenvalues set to
/// zero (Higham 1988, theorem 2.1).
Eigen::MatrixXd nearest_positive_semidefinite(const Eigen::Ref<const Eigen::MatrixXd>& information);

}  // namespace locograph
