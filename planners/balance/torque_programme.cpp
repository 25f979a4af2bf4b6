#include <locograph/planners/balance/torque_programme.h>

#include <cmath>
#include <limits>

namespace locograph {

TorqueProgramme::TorqueProgramme(const Robot& robot, std::span<const BearingContact> contacts,
                                 double effort_scale, double margin)
    : robot_(robot),
      weight_N_(robot.total_mass() * standard_gravity().norm()),
      effort_scale_(effort_scale),
      gravity_(robot.tangent_size()),
      derivative_(robot.tangent_size(), robot.tangent_size()) {
  for (const BearingContact& bearing : contacts) add(bearing, margin);
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const double effort = robot.active_joint(i).max_effort;
    if (effort > 0.0 && std::isfinite(effort)) joints_.push_back(i);
  }
}

void TorqueProgramme::add(const BearingContact& bearing, double margin) {
  const Contact& contact = bearing.contact;
  if (!contact.bears_load) return;
  const int number = static_cast<int>(links_.size());
  links_.push_back(robot_.link_index(contact.effector.link));
  positions_.push_back(contact.position);
  if (is_ball(contact.effector)) {
    balls_.push_back({positions_.size() - 1, contact.effector, BallTrack(contact)});
  }
  most_.push_back(most_of_rays(contact, margin, weight_N_));
  least_.push_back(least_of_rays(bearing, weight_N_));
  for (const BearingRay& ray : bearing_rays(bearing, margin, weight_N_)) {
    rays_.push_back(
        {number, ray.at - contact.position, ray.force, ray.moment, ray.lower, ray.upper});
  }
}

double TorqueProgramme::solve(const RobotState& state, Eigen::VectorXd& gradient) {
  const int base = robot_.base_tangent_size(), size = robot_.tangent_size();
  const int rays = static_cast<int>(rays_.size()), torques = static_cast<int>(joints_.size());
  const int limits = static_cast<int>(most_.size());
  const int rows = base + 2 * torques + limits;
  for (const Ball& ball : balls_) {
    positions_[ball.contact] = ball.track.touching(BallPose(state, ball.effector).centre);
  }
  gravity_torques(state, standard_gravity(), gravity_);
  columns_.setZero(size, rays);
  for (int r = 0; r < rays; ++r) {
    const Ray& ray = rays_[static_cast<std::size_t>(r)];
    const std::size_t c = static_cast<std::size_t>(ray.contact);
    PointWrench wrench;
    wrench.link = links_[c];
    wrench.point = state.world_from_link(wrench.link).inverse() * (positions_[c] + ray.at);
    wrench.force = weight_N_ * ray.force;
    wrench.moment = weight_N_ * ray.moment;
    add_wrench_torques(state, wrench, 1.0, columns_.col(r));
  }
  const auto limit = [&](int i) {
    return effort_scale_ * robot_.active_joint(joints_[static_cast<std::size_t>(i)]).max_effort;
  };
  // Columns: the rays, then t.
  programme_.resize(rows, rays + 1);
  Eigen::MatrixXd& matrix = programme_.matrix();
  matrix.topLeftCorner(base, rays) = columns_.topRows(base) / weight_N_;
  matrix.col(rays).segment(base, 2 * torques).setConstant(-1.0);
  programme_.cost()[rays] = 1.0;
  for (int r = 0; r < rays; ++r) {
    const Ray& ray = rays_[static_cast<std::size_t>(r)];
    if (most_[static_cast<std::size_t>(ray.contact)] >= 0.0) {
      matrix(base + 2 * torques + ray.contact, r) = 1.0;
    }
    programme_.bound_column(r, ray.lower, ray.upper);
  }
  for (int i = 0; i < base; ++i) {
    programme_.bound_row(i, gravity_[i] / weight_N_, gravity_[i] / weight_N_);
  }
  for (int i = 0; i < torques; ++i) {
    const int joint = base + joints_[static_cast<std::size_t>(i)];
    matrix.row(base + 2 * i).head(rays) = -columns_.row(joint) / limit(i);
    matrix.row(base + 2 * i + 1).head(rays) = columns_.row(joint) / limit(i);
    const double share = gravity_[joint] / limit(i);
    programme_.bound_row(base + 2 * i, -kNoBound, -share);
    programme_.bound_row(base + 2 * i + 1, -kNoBound, share);
  }
  for (int c = 0; c < limits; ++c) {
    const double most = most_[static_cast<std::size_t>(c)];
    const double least = least_[static_cast<std::size_t>(c)];
    programme_.bound_row(base + 2 * torques + c, least > 0.0 ? least : -kNoBound,
                         most >= 0.0 ? most : kNoBound);
  }
  if (programme_.solve() != LinearAnswer::kOptimal) return std::numeric_limits<double>::infinity();

  const Eigen::VectorXd &solution = programme_.solution(), &prices = programme_.prices();
  std::vector<PointWrench> wrenches;
  for (int r = 0; r < rays; ++r) {
    if (solution[r] == 0.0) continue;
    const Ray& ray = rays_[static_cast<std::size_t>(r)];
    const std::size_t c = static_cast<std::size_t>(ray.contact);
    PointWrench wrench;
    wrench.link = links_[c];
    wrench.point = state.world_from_link(wrench.link).inverse() * (positions_[c] + ray.at);
    wrench.force = solution[r] * weight_N_ * ray.force;
    wrench.moment = solution[r] * weight_N_ * ray.moment;
    wrenches.push_back(wrench);
  }
  static_torque_derivative(state, standard_gravity(), wrenches, derivative_);
  gradient.setZero(size);
  for (int i = 0; i < base; ++i) {
    gradient += prices[i] / weight_N_ * derivative_.row(i).transpose();
  }
  double heaviest = 0.0;
  for (int i = 0; i < torques; ++i) {
    const double up = prices[base + 2 * i], down = prices[base + 2 * i + 1];
    const int joint = joints_[static_cast<std::size_t>(i)];
    gradient += (down - up) / limit(i) * derivative_.row(base + joint).transpose();
    if (-up - down > heaviest) {
      heaviest = -up - down;
      heaviest_ = joint;
    }
  }
  return programme_.value();
}

}  // namespace locograph
