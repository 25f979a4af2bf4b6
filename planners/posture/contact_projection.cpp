#include <locograph/planners/posture/contact_projection.h>

#include <Eigen/Cholesky>

namespace locograph {
namespace {

constexpr double kProjected = 1e-9;  // m, rad
constexpr int kMostProjections = 12;
constexpr double kLongestProjection = 0.3;

}  // namespace

void ContactProjection::set(std::span<const Contact> contacts, const HeldBalls& balls) {
  closures_.clear();
  rows_ = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    closures_.push_back(balls[i] ? ContactClosure(robot(), contacts[i], *balls[i])
                                 : ContactClosure(robot(), contacts[i]));
    rows_ += closures_.back().rows();
  }
}

void ContactProjection::closure(const Eigen::VectorXd& q, Eigen::VectorXd& error) {
  state_.update(q.data());
  error.resize(rows_);
  Eigen::Index row = 0;
  for (const ContactClosure& closure : closures_) {
    closure.error(state_, error.data() + row);
    row += closure.rows();
  }
}

void ContactProjection::closure(const Eigen::VectorXd& q, Eigen::VectorXd& error,
                                Eigen::MatrixXd& jacobian) {
  closure(q, error);
  const int size = robot().tangent_size();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows =
      Eigen::MatrixXd::Zero(rows_, size);
  Eigen::Index row = 0;
  for (const ContactClosure& closure : closures_) {
    closure.add_jacobian(state_, rows.data() + row * size, size);
    row += closure.rows();
  }
  jacobian = rows;
}

bool ContactProjection::project(Eigen::VectorXd& q) {
  if (closures_.empty()) return true;
  for (int i = 0; i < kMostProjections; ++i) {
    closure(q, error_, jacobian_);
    if (error_.cwiseAbs().maxCoeff() < kProjected) return true;
    Eigen::MatrixXd gram = jacobian_ * jacobian_.transpose();
    gram.diagonal().array() += 1e-9;
    const Eigen::VectorXd step = -(jacobian_.transpose() * gram.llt().solve(error_));
    if (!(step.cwiseAbs().maxCoeff() < kLongestProjection)) return false;
    robot().integrate(q.data(), step.data(), q.data());
  }
  return false;
}

}  // namespace locograph
