#include <locograph/check/motion.h>

namespace locograph {
namespace {

// Coefficients x y z w, normalised.
Eigen::Quaterniond base_orientation(const Eigen::VectorXd& configuration) {
  return Eigen::Quaterniond(Eigen::Vector4d(configuration.segment<4>(3))).normalized();
}

}  // namespace

ConfigurationStep configuration_step(const Robot& robot, const Eigen::VectorXd& from,
                                     const Eigen::VectorXd& to) {
  ConfigurationStep step;
  step.joints = to.tail(robot.active_joint_count()) - from.tail(robot.active_joint_count());
  if (!robot.floating_base()) return step;
  step.base_distance_m = (to.head<3>() - from.head<3>()).norm();
  step.base_angle_rad = base_orientation(from).angularDistance(base_orientation(to));
  return step;
}

void interpolate(const Robot& robot, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                 double fraction, Eigen::VectorXd& out) {
  out = (1.0 - fraction) * from + fraction * to;
  if (!robot.floating_base()) return;
  const Eigen::Quaterniond between = base_orientation(from).slerp(fraction, base_orientation(to));
  out.segment<4>(3) = between.coeffs().normalized();
}

void MotionSampler::link_poses(int vertex, double fraction,
                               std::vector<Eigen::Isometry3d>& world_from_link) {
  if (vertex != vertex_ || fraction != fraction_) move_to(vertex, fraction);
  world_from_link.resize(robot_->links().size());
  for (std::size_t link = 0; link < world_from_link.size(); ++link)
    world_from_link[link] = state_.world_from_link(int(link));
}

void MotionSampler::move_to(int vertex, double fraction) {
  const Eigen::VectorXd& from = motion_->configurations[std::size_t(vertex)];
  if (fraction == 0.0) {
    configuration_ = from;
    if (robot_->floating_base()) configuration_.segment<4>(3).normalize();
  } else {
    interpolate(*robot_, from, motion_->configurations[std::size_t(vertex) + 1], fraction,
                configuration_);
  }
  state_.update(configuration_.data());
  vertex_ = vertex;
  fraction_ = fraction;
}

double MotionSampler::time_s(int vertex, double fraction) const {
  const double from = motion_->time_s[std::size_t(vertex)];
  if (fraction == 0.0) return from;
  return from + fraction * (motion_->time_s[std::size_t(vertex) + 1] - from);
}

}  // namespace locograph
