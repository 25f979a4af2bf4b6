#include <locograph/common/ranges.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/planners/online/way_back.h>
#include <locograph/plugins/configuration/contact_parameter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace locograph {
namespace {

/// Of what a contact is at above what it touches [m]: of a sole's lowest corner.
double height(const ContactParameter& contact, const RobotState& state) {
  const ContactClosure& closure = contact.closure;
  Eigen::VectorXd error(closure.rows());
  closure.error(state, error.data());
  const EndEffector& effector = contact.contact.effector;
  double height_m = std::numeric_limits<double>::infinity(), lower_m = 0.0;
  for (int row = 0; row < closure.rows(); ++row) {
    const int held = closure.held()[static_cast<std::size_t>(row)];
    if (held == 2) height_m = error[row];
    if (effector.kind != ContactKind::kSurface) continue;
    if (held == 3) lower_m += effector.half_y_m * std::abs(error[row]);
    if (held == 4) lower_m += effector.half_x_m * std::abs(error[row]);
  }
  return height_m - lower_m;
}

}  // namespace

double least_time_back(const Robot& robot, const Eigen::VectorXd& off) {
  constexpr double kAcceleration_m_s2 = 0.15;
  const int base = robot.base_tangent_size();
  double off_m = kJoint_m * off.tail(off.size() - base).lpNorm<Eigen::Infinity>();
  if (base > 0) {
    off_m = std::max({off_m, off.head<3>().norm(), kTurn_m * off.segment<3>(3).norm()});
  }
  return std::sqrt(5.8 * off_m / kAcceleration_m_s2);
}

/// The configuration at which a robot that is off at the executed one is to be back: the last one
/// before contacts change, or, where that is too near, before another contact closes.
int WayBack::back_at(int executed) const {
  constexpr int kFewestSteps = 8;
  const auto& stance_from = plan_.plan().stance_from;
  const auto numbers = [&](int i) -> const std::vector<int>& {
    return stance_from[static_cast<std::size_t>(i)]->contact_numbers;
  };
  int at = executed;
  do {
    ++at;
    if (at == plan_.last() || plan_.rolls(at)) break;
    if (numbers(at) == numbers(executed)) continue;
    const bool closes = !std::ranges::all_of(numbers(at), [&](int number) {
      return std::ranges::find(numbers(at - 1), number) != numbers(at - 1).end();
    });
    if (closes || at - executed >= kFewestSteps) break;
  } while (true);
  return at;
}

/// The contacts that are closed at a configuration: at their places, balls where they have rolled
/// to from another configuration beside it.
void WayBack::set_contacts(int index, int beside) {
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

/// Moves q to the contacts of a configuration, from one beside it. Whether it could be.
bool WayBack::close_contacts(int index, int beside, Eigen::VectorXd& q) {
  set_contacts(index, beside);
  if (!contacts_.project(q)) return false;
  wheels_.at(plan_, std::min(index, beside)).hold(plan_.configuration(beside), q);
  return true;
}

/// Brings a configuration to its contacts, balls where they have rolled to; planned: where
/// it was planned, lifted: see lift().
void WayBack::close(int index, const Eigen::VectorXd& planned, double lifted) {
  Eigen::VectorXd closed = plan_.configuration(index);
  if (close_contacts(index, index - 1, closed)) plan_.configuration(index) = closed;
  if (lifted > 0.0) lift(index, planned, lifted);
  plan_.robot().difference(planned.data(), plan_.configuration(index).data(), off_.data());
  end_ = index + 1;
}

/// Ends of limbs that swing do not come nearer to what they have touched, or will, than planned by
/// all that they are off: h_p^2 / (h_p + d) instead of h_p - d above it, d how much lower they
/// would be than planned; more and more of that by `share`, 0 to 1.
void WayBack::lift(int index, const Eigen::VectorXd& planned, double share) {
  constexpr double kNear_m = 0.12;  // all of it, and none at twice as much
  const Robot& robot = plan_.robot();
  const auto& stance_from = plan_.plan().stance_from;
  const auto& here = stance_from[static_cast<std::size_t>(index)]->contacts;
  std::vector<bool> holds(robot.axes().size(), false);
  for (const auto& contact : here) {
    for (const int axis : robot.support(contact->link)) {
      holds[static_cast<std::size_t>(axis)] = true;
    }
  }
  const auto is_held = [&](const ContactParameter& contact) {
    return std::ranges::any_of(here, [&](const auto& c) { return c->link == contact.link; });
  };
  int before = index, after = index;
  while (before > 0 && stance_from[static_cast<std::size_t>(before)]->contacts == here) --before;
  while (after < plan_.last() && stance_from[static_cast<std::size_t>(after)]->contacts == here) {
    ++after;
  }
  RobotState was(robot), now(robot);
  was.update(planned.data());
  for (const int side : {before, after}) {
    for (const auto& contact : stance_from[static_cast<std::size_t>(side)]->contacts) {
      if (is_held(*contact) || contact->contact.bar ||
          contact->contact.effector.kind == ContactKind::kGrasp) {
        continue;
      }
      const double planned_m = height(*contact, was);
      const Eigen::Vector3d normal = axes_in_world(contact->contact).col(2);
      Eigen::Vector3d aside = was.world_from_link(contact->link) * contact->contact.effector.point -
                              contact->contact.position;
      aside -= aside.dot(normal) * normal;
      const double near = share_left((aside.norm() - kNear_m) / kNear_m);
      if (!(planned_m > 0.0 && near > 0.0)) continue;
      now.update(plan_.configuration(index).data());
      const double lower_m = planned_m - height(*contact, now);
      if (!(lower_m > 0.0)) continue;
      const double by_m = near * share * lower_m * lower_m / (planned_m + lower_m);
      Eigen::VectorXd row = Eigen::VectorXd::Zero(robot.tangent_size());
      now.add_point_gradient(contact->link,
                             now.world_from_link(contact->link) * contact->contact.effector.point,
                             normal, 1.0, row.data());
      row.head(robot.base_tangent_size()).setZero();
      for (std::size_t a = 0; a < holds.size(); ++a) {
        if (holds[a]) row[robot.base_tangent_size() + robot.axes()[a].active] = 0.0;
      }
      constexpr double kLeast = 1e-4;  // m²: no joint of the limb raises it
      const double length = row.squaredNorm();
      if (!(length > kLeast)) continue;
      row *= by_m / length;
      robot.integrate(plan_.configuration(index).data(), row.data(),
                      plan_.configuration(index).data());
    }
  }
}

/// The configuration at which the next contact closes, after one of the window's; -1: one opens
/// before.
int WayBack::closes_next(int index) const {
  const auto& stance_from = plan_.plan().stance_from;
  for (int i = index; i <= plan_.last(); ++i) {
    const std::vector<int>& before = stance_from[static_cast<std::size_t>(i - 1)]->contact_numbers;
    const std::vector<int>& here = stance_from[static_cast<std::size_t>(i)]->contact_numbers;
    if (here == before) continue;
    const bool opens = !std::ranges::all_of(
        before, [&](int number) { return std::ranges::find(here, number) != here.end(); });
    return opens ? -1 : i;
  }
  return -1;
}

/// On its contacts; what is off goes on as it does, and comes to where the next contact closes at
/// its place by then, or else, critically damped, towards nothing.
void WayBack::add(int index) {
  constexpr double kDamped_per_s = 6.0;
  const Eigen::VectorXd planned = plan_.configuration(index);
  const double from_s = plan_.time_s(index - 1), step_s = plan_.time_s(index) - from_s;
  Eigen::VectorXd here;
  if (const int closes = closes_next(index); closes > 0) {
    const double left_s = plan_.time_s(closes) - from_s, s = left_s > 0.0 ? step_s / left_s : 1.0;
    const Eigen::VectorXd way = least_off(closes, index - 1) - off_;
    here = off_ + s * (1.0 - s) * (1.0 - s) * left_s * off_rate_ + s * s * (3.0 - 2.0 * s) * way;
    off_rate_ *= (1.0 - s) * (1.0 - 3.0 * s);
    if (left_s > 0.0) off_rate_ += 6.0 * s * (1.0 - s) / left_s * way;
  } else {
    const double faster = std::exp(-kDamped_per_s * step_s);
    const Eigen::VectorXd turned = off_rate_ + kDamped_per_s * off_;
    here = faster * (off_ + step_s * turned);
    off_rate_ = faster * (off_rate_ - kDamped_per_s * step_s * turned);
  }
  plan_.robot().integrate(planned.data(), here.data(), plan_.configuration(index).data());
  close(index, planned, 0.0);
}

/// What a configuration further on is off at least, on its contacts; balls roll there from where
/// another configuration has them.
Eigen::VectorXd WayBack::least_off(int index, int from) {
  const Robot& robot = plan_.robot();
  Eigen::VectorXd q = plan_.configuration(index), off = off_;
  if (close_contacts(index, from, q)) {
    robot.difference(plan_.configuration(index).data(), q.data(), off.data());
  }
  return off;
}

/// Configurations that came before the executed one: on their contacts.
void WayBack::close_before(const Window& window) {
  for (int i = window.executed() - 1; i >= window.first_held() && !plan_.rolls(i); --i) {
    Eigen::VectorXd closed = plan_.configuration(i);
    if (close_contacts(i, i + 1, closed)) plan_.configuration(i) = closed;
  }
}

void WayBack::begin(const Window& window, const Eigen::VectorXd& was) {
  constexpr double kBack_s = 1.6;
  close_before(window);
  const Robot& robot = plan_.robot();
  const int executed = window.executed(), back = back_at(executed);
  Eigen::VectorXd off(robot.tangent_size());
  robot.difference(was.data(), plan_.configuration(executed).data(), off.data());
  const double from_s = plan_.time_s(executed),
               least_s = std::min(kBack_s, least_time_back(robot, off));
  const bool in_time = plan_.time_s(plan_.last()) + least_s <= ranges::kTime_s;
  if (plan_.time_s(back) - from_s < least_s && in_time) plan_.slow_down(executed, back, least_s);
  const double duration_s = std::min(kBack_s, plan_.time_s(back) - from_s);
  off_ = off_rate_ = Eigen::VectorXd::Zero(robot.tangent_size());
  Eigen::VectorXd there = least_off(back, executed);
  std::vector<Eigen::VectorXd> planned;
  for (int i = window.first(); i < window.end(); ++i) planned.push_back(plan_.configuration(i));
  const auto ends = [&](int i) { return i == window.end() || plan_.rolls(i - 1); };
  // Leads until the time is over; returns the first configuration after that.
  const auto lead = [&] {
    int i = window.first();
    for (; !ends(i); ++i) {
      if (plan_.is_fixed(i)) continue;
      const double share = duration_s > 0.0 ? (plan_.time_s(i) - from_s) / duration_s : 1.0;
      constexpr double kSame = 1e-9, kLifted = 2.5;
      if (share > 1.0 + kSame) break;
      const Eigen::VectorXd left = there + share_left(share) * (off - there);
      const Eigen::VectorXd& was_here = planned[static_cast<std::size_t>(i - window.first())];
      robot.integrate(was_here.data(), left.data(), plan_.configuration(i).data());
      close(i, was_here, 1.0 - share_left(kLifted * share));
    }
    return i;
  };
  int next = lead();
  // Where balls have rolled to on the way is known once it is gone: it ends there this time.
  there = next > back ? off_ : least_off(back, next - 1);
  next = lead();
  for (; !ends(next); ++next) {
    if (!plan_.is_fixed(next)) add(next);
  }
  int is_back = executed + 1;
  while (is_back < window.last() && plan_.time_s(is_back) < from_s + duration_s) ++is_back;
  follow(window, executed, is_back);
}

void WayBack::go_on(const Window& window) {
  follow(window, window.first_entering(), window.first_entering());
}

/// From one configuration on. One after the window comes nearer, too: how fast the last
/// one of the window is passed goes with it.
void WayBack::follow(const Window& window, int first, int back) {
  if (end_ != window.end() || first >= window.end()) return;
  const int after = window.end();
  if (after <= plan_.last() && !plan_.is_fixed(after) && !plan_.rolls(after - 1)) {
    add(after);
  }
  plan_.go_as_led({first, window.last()}, back);
}

}  // namespace locograph
