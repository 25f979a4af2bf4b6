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

Eigen::VectorXd ContactProjection::step(const Eigen::VectorXd& rows) const {
  Eigen::MatrixXd gram = jacobian_ * jacobian_.transpose();
  gram.diagonal().array() += 1e-9;
  return jacobian_.transpose() * gram.llt().solve(rows);
}

bool ContactProjection::project(Eigen::VectorXd& q) {
  if (closures_.empty()) return true;
  for (int i = 0; i < kMostProjections; ++i) {
    closure(q, error_, jacobian_);
    if (error_.cwiseAbs().maxCoeff() < kProjected) return true;
    const Eigen::VectorXd back = -step(error_);
    if (!(back.cwiseAbs().maxCoeff() < kLongestProjection)) return false;
    robot().integrate(q.data(), back.data(), q.data());
  }
  return false;
}

void ContactProjection::project_rate(const Eigen::VectorXd& q, Eigen::VectorXd& rate) {
  if (closures_.empty()) return;
  closure(q, error_, jacobian_);
  rate -= step(jacobian_ * rate);
}

}  // namespace locograph
