#include <locograph/check/motion_rates.h>

namespace locograph {

MotionRates::MotionRates(const CheckContext& context)
    : robot_(context.robot),
      starts_at_rest_(context.options.starts_at_rest),
      ends_at_rest_(context.options.ends_at_rest) {
  if (!context.moves()) return;
  const Motion& motion = context.motion;
  Eigen::VectorXd from, to, tangent(robot_.tangent_size());
  for (std::size_t i = 0; i + 1 < context.vertices(); ++i) {
    Rate rate;
    const double duration = motion.time_s[i + 1] - motion.time_s[i];
    duration_.push_back(duration);
    rate.known = context.usable.vertices[i] && context.usable.vertices[i + 1] && duration > 0.0;
    if (rate.known) {
      from = motion.configurations[i];
      to = motion.configurations[i + 1];
      rate.joints = (to - from).tail(robot_.active_joint_count()) / duration;
      if (robot_.floating_base()) {
        from.segment<4>(3).normalize();
        to.segment<4>(3).normalize();
        robot_.difference(from.data(), to.data(), tangent.data());
        rate.linear = (to - from).head<3>() / duration;
        rate.angular = tangent.segment<3>(3) / duration;
      }
    }
    steps_.push_back(std::move(rate));
  }
}

MotionRates::Rate MotionRates::acceleration(int vertex) const {
  Rate result;
  const int last = int(steps_.size());
  Rate rest;
  rest.joints.setZero(robot_.active_joint_count());
  rest.known = true;
  if (vertex < 0 || vertex > last || last == 0) return result;
  if ((vertex == 0 && !starts_at_rest_) || (vertex == last && !ends_at_rest_)) return result;
  const Rate& before = vertex == 0 ? rest : steps_[std::size_t(vertex) - 1];
  const Rate& after = vertex == last ? rest : steps_[std::size_t(vertex)];
  if (!before.known || !after.known) return result;
  double time = 0.0;
  if (vertex > 0) time += 0.5 * duration_[std::size_t(vertex) - 1];
  if (vertex < last) time += 0.5 * duration_[std::size_t(vertex)];
  result.linear = (after.linear - before.linear) / time;
  result.angular = (after.angular - before.angular) / time;
  result.joints = (after.joints - before.joints) / time;
  result.known = true;
  return result;
}

Eigen::VectorXd MotionRates::joint_acceleration(int vertex) const {
  const Rate rate = acceleration(vertex);
  return rate.known ? rate.joints : Eigen::VectorXd();
}

BalanceMotion MotionRates::at(int vertex, const RobotState& state) const {
  if (vertex < int(steps_.size())) return at(vertex, 0.0, Half::kFirst, state);
  return at(vertex - 1, 1.0, Half::kSecond, state);
}

BalanceMotion MotionRates::at(int step, double fraction, Half half, const RobotState& state) const {
  BalanceMotion motion{Eigen::VectorXd::Zero(robot_.tangent_size()),
                       Eigen::VectorXd::Zero(robot_.tangent_size())};
  if (step < 0 || !steps_[std::size_t(step)].known) return motion;
  const Rate& middle = steps_[std::size_t(step)];
  const Rate change = acceleration(half == Half::kFirst ? step : step + 1);
  const double time = (fraction - 0.5) * duration_[std::size_t(step)];
  Eigen::Vector3d linear = middle.linear, angular = middle.angular;
  Eigen::VectorXd joints = middle.joints;
  if (change.known) {
    linear += time * change.linear;
    angular += time * change.angular;
    joints += time * change.joints;
  }
  const int base = robot_.base_tangent_size();
  motion.velocity.tail(joints.size()) = joints;
  if (change.known) motion.acceleration.tail(joints.size()) = change.joints;
  if (base == 0) return motion;
  // Along the base's own axes, which turn: d/dt (R^T u) = R^T u' - w x R^T u.
  const Eigen::Matrix3d base_from_world =
      state.world_from_link(robot_.root_link()).linear().transpose();
  const Eigen::Vector3d own = base_from_world * linear;
  motion.velocity.head<3>() = own;
  motion.velocity.segment<3>(3) = angular;
  motion.acceleration.head<3>() = -angular.cross(own);
  if (!change.known) return motion;
  motion.acceleration.head<3>() += base_from_world * change.linear;
  motion.acceleration.segment<3>(3) = change.angular;
  return motion;
}

}  // namespace locograph
