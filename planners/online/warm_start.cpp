#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/online/warm_start.h>

#include <algorithm>

namespace locograph {

/// A configuration from the two before it. The drift counts along the ground: forward, sideways and
/// in yaw; the wheels roll. Without before_that there is no drift.
Eigen::VectorXd WarmStart::planned_step_with_drift(int index, const Eigen::VectorXd& before,
                                                   const Eigen::VectorXd* before_that) const {
  const Robot& robot = plan_.robot();
  const std::vector<Eigen::VectorXd>& planned = plan_.planned();
  const auto i = static_cast<std::size_t>(index);
  if (!plan_.rolls(index - 1)) return planned[i];
  Eigen::VectorXd step(robot.tangent_size()), planned_before(robot.tangent_size());
  robot.difference(planned[i - 1].data(), planned[i].data(), step.data());
  if (before_that != nullptr) {
    Eigen::VectorXd made(robot.tangent_size());
    robot.difference(planned[i - 2].data(), planned[i - 1].data(), planned_before.data());
    robot.difference(before_that->data(), before.data(), made.data());
    for (const int along_the_ground : {0, 1, 5}) {
      step[along_the_ground] += made[along_the_ground] - planned_before[along_the_ground];
    }
  }
  Eigen::VectorXd q(before.size());
  robot.integrate(before.data(), step.data(), q.data());
  WheelMotion(robot, plan_.plan().stance_from[i - 1]->stance).roll(before, q);
  return q;
}

void WarmStart::enter(const Window& window) {
  for (int i = window.first_entering(); i < window.end(); ++i) {
    if (plan_.is_fixed(i)) continue;
    const Eigen::VectorXd before = plan_.configuration(i - 1);
    const Eigen::VectorXd before_that = plan_.configuration(std::max(0, i - 2));
    plan_.configuration(i) = planned_step_with_drift(i, before, i > 1 ? &before_that : nullptr);
  }
  if (unfinished_end_ <= window.first()) unfinished_end_ = 0;
  for (; unfinished_end_ > 0 && unfinished_end_ < window.end(); ++unfinished_end_) {
    const int index = unfinished_end_;
    const auto i = static_cast<std::size_t>(index);
    const Eigen::VectorXd before_that = window.contains(index - 2)
                                            ? unfinished_[i - 2]
                                            : plan_.configuration(std::max(0, index - 2));
    unfinished_[i] = plan_.is_fixed(index)
                         ? plan_.planned()[i]
                         : planned_step_with_drift(index, unfinished_[i - 1],
                                                   index > 1 ? &before_that : nullptr);
  }
}

void WarmStart::load_unfinished(const Window& window) {
  plan_.overwrite(window.first(), std::span(unfinished_)
                                      .subspan(static_cast<std::size_t>(window.first()),
                                               static_cast<std::size_t>(window.steps())));
}

void WarmStart::keep_unfinished(const Window& window) {
  unfinished_end_ = window.end();
  for (int i = window.first(); i < window.end(); ++i) {
    unfinished_[static_cast<std::size_t>(i)] = plan_.configuration(i);
  }
}

}  // namespace locograph
