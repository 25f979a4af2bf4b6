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
  if (!plan_.rolls(index - 1)) return led_back(index, planned[i]);
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
  roll_on(index, before, step, q);
  return q;
}

/// One step on wheels from the configuration before it.
void WarmStart::roll_on(int index, const Eigen::VectorXd& before, const Eigen::VectorXd& step,
                        Eigen::VectorXd& q) const {
  const Robot& robot = plan_.robot();
  robot.integrate(before.data(), step.data(), q.data());
  const auto from = static_cast<std::size_t>(index - 1);
  WheelMotion(robot, plan_.plan().stance_from[from]->stance).roll(before, q);
}

/// A configuration on legs, by as much of what the robot is off as it has left there.
Eigen::VectorXd WarmStart::led_back(int index, const Eigen::VectorXd& q) const {
  const double t = off_.size() == 0 ? 1.0 : (plan_.time_s(index) - off_since_s_) / back_s_;
  if (t >= 1.0) return q;
  const Eigen::VectorXd left = off_ * (1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t)));
  Eigen::VectorXd led(q.size());
  plan_.robot().integrate(q.data(), left.data(), led.data());
  return led;
}

/// Until the robot is back: less where it is to be at rest before, as at a change of contacts.
double WarmStart::time_to_lead_back(int executed) const {
  constexpr double kBack_s = 1.6, kLeast_s = 0.4;
  for (int i = executed + 1; i <= plan_.last(); ++i) {
    const double time_s = plan_.time_s(i) - plan_.time_s(executed);
    if (time_s > kBack_s) break;
    const Eigen::VectorXd& slope =
        plan_.graph().vertex(VertexId<VertexConfiguration>{plan_.slot(i)}).slopes;
    if (slope.size() > 0 && slope.isZero(0.0)) return std::max(kLeast_s, time_s);
  }
  return kBack_s;
}

/// The contacts that are closed at a configuration: at their places, balls where they have rolled
/// to from another configuration beside it.
void WarmStart::set_contacts(int index, int beside) {
  const auto& stance_from = plan_.plan().stance_from;
  const std::vector<int> numbers = contacts_at(stance_from, static_cast<std::size_t>(index));
  std::vector<Contact> contacts;
  for (const int number : numbers) {
    contacts.push_back(plan_.graph().parameters().get<ContactParameter>(number)->contact);
  }
  const auto& held =
      stance_from[static_cast<std::size_t>(std::min(index, beside))]->contact_numbers;
  RobotState state(plan_.robot());
  state.update(plan_.configuration(beside).data());
  contacts_.set(contacts, held_balls(state, contacts, [&](const Contact& contact) {
                  const int number = numbers[static_cast<std::size_t>(&contact - contacts.data())];
                  return std::ranges::find(held, number) != held.end();
                }));
}

/// Configurations that came before the executed one, on legs: on their contacts.
void WarmStart::close_before(const Window& window) {
  for (int i = window.executed() - 1; i >= window.first_held() && !plan_.rolls(i); --i) {
    set_contacts(i, i + 1);
    Eigen::VectorXd closed = plan_.configuration(i);
    if (contacts_.project(closed)) plan_.configuration(i) = closed;
  }
}

void WarmStart::lead_back(const Window& window, const Eigen::VectorXd& was) {
  const Robot& robot = plan_.robot();
  const int executed = window.executed();
  unfinished_end_ = 0;
  off_.resize(robot.tangent_size());
  off_since_s_ = plan_.time_s(executed);
  back_s_ = time_to_lead_back(executed);
  robot.difference(was.data(), plan_.configuration(executed).data(), off_.data());
  const bool rolls = plan_.rolls(executed);
  if (!rolls) close_before(window);
  Eigen::VectorXd was_before = was, step(robot.tangent_size());
  for (int i = window.first(); i < window.end(); ++i) {
    const Eigen::VectorXd was_here = plan_.configuration(i);
    if (!plan_.is_fixed(i)) {
      Eigen::VectorXd q = was_here;
      if (plan_.rolls(i - 1)) {
        robot.difference(was_before.data(), was_here.data(), step.data());
        roll_on(i, plan_.configuration(i - 1), step, q);
      } else {
        q = led_back(i, was_here);
        set_contacts(i, i - 1);
        Eigen::VectorXd closed = q;
        if (contacts_.project(closed)) q = closed;
      }
      plan_.configuration(i) = q;
    }
    was_before = was_here;
  }
  // How fast it passes goes with where it is, and what it comes from.
  plan_.follow_moved(rolls ? window.first() : executed, window.last());
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
