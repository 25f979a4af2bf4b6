#pragma once
/// Eigen's dense decompositions of MatrixXd and Matrix3d, instantiated once for all of our own
/// libraries, tests and the command: each takes a compiler several seconds wherever it is used.
/// Read with the precompiled headers; nothing else needs to include it.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace Eigen {

extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
extern template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
extern template void HouseholderQR<MatrixXd>::computeInPlace();
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);

}  // namespace Eigen
