#include <locograph/planners/online/warm_start.h>

#include <algorithm>

namespace locograph {

/// A configuration from the two before it. The drift counts along the ground: forward, sideways and
/// in yaw; the wheels roll. Without before_that there is no drift.
void WarmStart::planned_step_with_drift(int index, const Configuration& before,
                                        const double* before_that, Eigen::Ref<Eigen::VectorXd> q) {
  const Robot& robot = plan_.robot();
  const std::vector<Eigen::VectorXd>& planned = plan_.planned();
  const auto i = static_cast<std::size_t>(index);
  if (!plan_.rolls(index - 1)) {
    q = planned[i];
    return;
  }
  robot.difference(planned[i - 1].data(), planned[i].data(), step_.data());
  if (before_that != nullptr) {
    robot.difference(planned[i - 2].data(), planned[i - 1].data(), planned_before_.data());
    robot.difference(before_that, before.data(), made_.data());
    for (const int along_the_ground : {0, 1, 5}) {
      step_[along_the_ground] += made_[along_the_ground] - planned_before_[along_the_ground];
    }
  }
  roll_on(index, before, step_, q);
}

/// One step on wheels from the configuration before it.
void WarmStart::roll_on(int index, const Configuration& before, const Eigen::VectorXd& step,
                        Eigen::Ref<Eigen::VectorXd> q) {
  plan_.robot().integrate(before.data(), step.data(), q.data());
  wheels_.at(plan_, index - 1).roll(before, q);
}

void WarmStart::lead_back(const Window& window, const Eigen::VectorXd& was) {
  unfinished_end_ = 0;
  if (plan_.rolls(window.executed())) {
    on_wheels_.lead(window, was);
    roll_from(window, was);
  } else {
    on_legs_.begin(window, was);
  }
}

/// On wheels: the window makes the steps that it made, as long as it rolls.
void WarmStart::roll_from(const Window& window, const Eigen::VectorXd& was) {
  const Robot& robot = plan_.robot();
  Eigen::VectorXd was_before = was, step(robot.tangent_size());
  for (int i = window.first(); i < window.end() && plan_.rolls(i - 1); ++i) {
    const Eigen::VectorXd was_here = plan_.configuration(i);
    if (!plan_.is_fixed(i)) {
      robot.difference(was_before.data(), was_here.data(), step.data());
      Eigen::VectorXd q = was_here;
      roll_on(i, plan_.configuration(i - 1), step, q);
      plan_.configuration(i) = q;
    }
    was_before = was_here;
  }
  // How fast it passes goes with where it is, and what it comes from.
  plan_.follow_moved(window.first(), window.last());
}

void WarmStart::enter(const Window& window) {
  for (int i = std::max(window.first_entering(), on_legs_.end()); i < window.end(); ++i) {
    if (plan_.is_fixed(i)) continue;
    planned_step_with_drift(i, plan_.configuration(i - 1),
                            i > 1 ? plan_.configuration(i - 2).data() : nullptr,
                            plan_.configuration(i));
    if (on_legs_.end() == i && !plan_.rolls(i - 1)) on_legs_.add(i);
  }
  on_legs_.go_on(window);
  if (unfinished_end_ <= window.first()) unfinished_end_ = 0;
  for (; unfinished_end_ > 0 && unfinished_end_ < window.end(); ++unfinished_end_) {
    const int index = unfinished_end_;
    const auto i = static_cast<std::size_t>(index);
    if (plan_.is_fixed(index)) {
      unfinished_[i] = plan_.planned()[i];
      continue;
    }
    const double* before_that = nullptr;
    if (index > 1) {
      before_that = window.contains(index - 2) ? unfinished_[i - 2].data()
                                               : plan_.configuration(index - 2).data();
    }
    planned_step_with_drift(index, unfinished_[i - 1], before_that, unfinished_[i]);
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
