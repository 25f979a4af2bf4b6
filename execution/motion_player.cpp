#include <locograph/check/judged_stance.h>
#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/execution/motion_player.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace locograph {
namespace {

constexpr double kSamePlace_m = 1e-6;
constexpr double kAtRest = 1e-9;     // of slopes and differences
constexpr double kTouch_s = 0.003;   // in which a touch is believed, ...
constexpr double kRelease_s = 0.02;  // ... and that it is gone
constexpr double kCounts = 0.3;      // share of a contact that must not get lost

bool is_same(const Contact& a, const Contact& b) {
  return a.name() == b.name() && (a.position - b.position).norm() <= kSamePlace_m;
}

/// What is known of a stance that it still is.
bool is_held(const std::vector<HeldContact>& held, const Stance& stance) {
  return std::ranges::equal(
      held, stance.contacts,
      [](const HeldContact& one, const Contact& other) { return is_same(one.contact(), other); });
}

double smooth(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace

void PlayerOptions::validate() const {
  const auto seconds = [](double value, const char* name) {
    check_option(value >= 0.0 && std::isfinite(value), name, "0 or more");
  };
  check_option(cycle_s > 0.0 && cycle_s <= 0.1, "cycle_s", "above 0, up to 0.1 s");
  seconds(dwell_s, "dwell_s");
  seconds(settle_s, "settle_s");
  seconds(end_s, "end_s");
  seconds(patience_s, "patience_s");
  seconds(early_s, "early_s");
  shares.validate();
  check_option(touch >= 0.0 && touch < 1.0, "touch", "0 or more, below 1");
  seconds(most_slip_m, "most_slip_m");
  check_option(stopping_s > 0.0 && std::isfinite(stopping_s), "stopping_s", "above 0");
}

MotionPlayer::MotionPlayer(const Robot& robot, std::span<const EndEffector> effectors,
                           const World& world, Motion motion, const PlayerOptions& options)
    : robot_(robot),
      effectors_(effectors.begin(), effectors.end()),
      motion_(std::move(motion)),
      options_(options),
      touch_N_(options.touch * robot.total_mass() * standard_gravity().norm()),
      curve_(robot, motion_),
      touches_(effectors.size()),
      commands_(effectors.size()) {
  options.validate();
  for (const EndEffector& effector : effectors) names_.push_back(name_of(effector));
  take(world);
  time_s_ = motion_.time_s.front();
  reference_ = curve_.at_vertex(0);
  reference_.velocity.setZero();
  reference_.acceleration.setZero();
  set_commands();
}

void MotionPlayer::follow(const World& world, Motion motion) {
  const auto next = static_cast<std::size_t>(vertex_) + 1;
  if (motion.configurations.size() < std::min(next + 1, motion_.configurations.size())) {
    throw Error("a motion of " + std::to_string(motion.configurations.size()) +
                    " configurations, which ends before where the robot is",
                std::to_string(next + 1) + " at least");
  }
  motion_ = std::move(motion);
  curve_ = MotionCurve(robot_, motion_);
  take(world);
}

/// What is needed of the motion.
void MotionPlayer::take(const World& world) {
  const std::size_t count = motion_.configurations.size();
  if (motion_.stances_only) throw Error("a plan of stances has no times to carry it out in");
  if (count == 0 || motion_.time_s.size() != count || motion_.stance_from.size() != count) {
    throw Error("a motion without configurations, times or stances");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!curve_.usable(static_cast<int>(i))) {
      throw Error("configuration " + std::to_string(i) + " has numbers that are not finite");
    }
    if (motion_.stance_from[i] < 0) {
      throw Error("configuration " + std::to_string(i) + " has no stance");
    }
    if (i > 0 && !(motion_.time_s[i] > motion_.time_s[i - 1])) {
      throw Error("configuration " + std::to_string(i) + " is not after the one before");
    }
  }
  steps_.clear();
  for (std::size_t i = 0; i + 1 < count; ++i) steps_.push_back(curve_.step(static_cast<int>(i)));
  ends_at_rest_ = curve_.slope(static_cast<int>(count) - 1).cwiseAbs().maxCoeff() <= kAtRest;
  find_what_holds(world);
  find_intervals();
}

/// As a stance is where it is first held.
void MotionPlayer::find_what_holds(const World& world) {
  held_.resize(motion_.stances.size());
  std::vector<char> done(held_.size(), 0);
  RobotState state(robot_);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < motion_.configurations.size(); ++i) {
    const auto stance = static_cast<std::size_t>(motion_.stance_from[i]);
    if (std::exchange(done[stance], char{1}) || is_held(held_[stance], motion_.stances[stance])) {
      continue;
    }
    held_[stance].clear();
    state.update(motion_.configurations[i].data());
    poses.clear();
    for (std::size_t link = 0; link < robot_.links().size(); ++link) {
      poses.push_back(state.world_from_link(static_cast<int>(link)));
    }
    const JudgedStance judged(robot_, world, motion_.stances[stance], effectors_);
    for (std::size_t c = 0; c < judged.contacts.size(); ++c) {
      const JudgedBearing bearing = bearing_at(judged.contacts[c], world, poses);
      Contact contact = motion_.stances[stance].contacts[c];
      contact.effector.friction = bearing.contact.effector.friction;
      held_[stance].emplace_back(contact, bearing.area, options_.shares);
    }
  }
}

void MotionPlayer::find_intervals() {
  intervals_.clear();
  const int last = static_cast<int>(motion_.configurations.size()) - 1;
  const auto stance_from = [&](int vertex) {
    return motion_.stance_from[static_cast<std::size_t>(vertex)];
  };
  for (int i = 0; i <= last; ++i) {
    if (i > 0 && stance_from(i) == stance_from(i - 1)) continue;
    if (i > 0) intervals_.back().last = i;
    Interval& interval = intervals_.emplace_back();
    interval.first = i;
    interval.last = last;
    interval.contact.assign(effectors_.size(), -1);
    interval.closes.assign(effectors_.size(), 0);
    interval.opens.assign(effectors_.size(), 0);
    const Stance& stance = motion_.stances[static_cast<std::size_t>(stance_from(i))];
    for (std::size_t c = 0; c < stance.contacts.size(); ++c) {
      const std::size_t effector = effector_of(effectors_, stance.contacts[c]);
      if (effector == effectors_.size()) {
        throw Error("contact of '" + stance.contacts[c].name() + "', which is no end effector");
      }
      interval.contact[effector] = static_cast<int>(c);
    }
  }
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    Interval& interval = intervals_[k];
    find_still_times(interval);
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      const HeldContact* held = contact_of(k, e);
      if (!held) continue;
      const HeldContact* before = k > 0 ? contact_of(k - 1, e) : held;
      const HeldContact* after = k + 1 < intervals_.size() ? contact_of(k + 1, e) : held;
      interval.closes[e] = !before || !is_same(before->contact(), held->contact());
      interval.opens[e] = !after || !is_same(after->contact(), held->contact());
    }
    const auto any = [](const std::vector<char>& flags) {
      return std::find(flags.begin(), flags.end(), char{1}) != flags.end();
    };
    if (any(interval.closes) && interval.still_before_s < options_.dwell_s) {
      interval.hold_before_s = options_.dwell_s;
    }
    if (any(interval.opens) && interval.still_after_s < options_.dwell_s) {
      interval.hold_after_s = options_.dwell_s;
    }
  }
}

void MotionPlayer::find_still_times(Interval& interval) const {
  const auto stands = [&](int vertex) {
    const auto at = static_cast<std::size_t>(vertex);
    const Eigen::VectorXd& from = motion_.configurations[at];
    return (motion_.configurations[at + 1] - from).cwiseAbs().maxCoeff() <= kAtRest &&
           curve_.slope(vertex).cwiseAbs().maxCoeff() <= kAtRest &&
           curve_.slope(vertex + 1).cwiseAbs().maxCoeff() <= kAtRest;
  };
  const auto time_s = [&](int vertex) { return motion_.time_s[static_cast<std::size_t>(vertex)]; };
  int first = interval.first, last = interval.last;
  while (first < interval.last && stands(first)) ++first;
  while (last > interval.first && stands(last - 1)) --last;
  interval.still_before_s = time_s(first) - time_s(interval.first);
  interval.still_after_s = time_s(interval.last) - time_s(last);
}

const HeldContact* MotionPlayer::contact_of(std::size_t interval, std::size_t effector) const {
  const Interval& of = intervals_[interval];
  const int contact = of.contact[effector];
  if (contact < 0) return nullptr;
  const int stance = motion_.stance_from[static_cast<std::size_t>(of.first)];
  return &held_[static_cast<std::size_t>(stance)][static_cast<std::size_t>(contact)];
}

const Contact* MotionPlayer::next_contact(std::size_t effector) const {
  const HeldContact* next = now_ + 1 < intervals_.size() ? contact_of(now_ + 1, effector) : nullptr;
  return next ? &next->contact() : nullptr;
}

int MotionPlayer::stance() const {
  return motion_.stance_from[static_cast<std::size_t>(intervals_[now_].first)];
}

/// Whether everything bears that should.
bool MotionPlayer::measure(std::span<const TouchMeasurement> measured) {
  const Interval& interval = intervals_[now_];
  bool all = true;
  for (std::size_t e = 0; e < touches_.size(); ++e) {
    Touch& touch = touches_[e];
    const double step = measured[e].pressing_N > touch_N_ ? options_.cycle_s / kTouch_s
                                                          : -options_.cycle_s / kRelease_s;
    touch.presence = std::clamp(touch.presence + step, 0.0, 1.0);
    if (touch.presence >= 0.99) touch.touches = true;
    if (touch.presence <= 0.01) touch.touches = false;
    if (touch.touches) {
      touch.loaded_s += options_.cycle_s;
    } else {
      touch.loaded_s = 0.0;
      touch.was_lifted = true;
    }
    const HeldContact* held = contact_of(now_, e);
    if (!held || touch.given_up || !held->contact().bears_load) continue;
    // What is being unloaded may lift a little earlier.
    const bool counts = !interval.opens[e] || opening_share(interval) > kCounts;
    if (!touch.touches && counts && settled_s_ >= options_.settle_s) {
      all = false;
      touch.absent_s += options_.cycle_s;
    } else {
      touch.absent_s = 0.0;
    }
    const bool lost = touch.absent_s > options_.patience_s;
    if (!lost && !(measured[e].slip_m > options_.most_slip_m)) continue;
    touch.given_up = true;
    if (halted_.empty()) {
      halted_ = names_[e] + (lost ? (interval.closes[e] ? " finds no contact" : " lost its contact")
                                  : " slips");
    }
  }
  return all;
}

void MotionPlayer::move_on(bool all_bear) {
  const double cycle = options_.cycle_s;
  if (settled_s_ < options_.settle_s) {
    settled_s_ += cycle;
    return;
  }
  const bool stops = !all_bear || !halted_.empty();
  const double left_s = motion_.time_s.back() - time_s_;
  const double most_rate =
      ends_at_rest_ ? 1.0 : std::min(1.0, std::sqrt(2.0 * left_s / options_.stopping_s));
  const double wanted = stops ? 0.0 : most_rate;
  const double most = cycle / options_.stopping_s;
  const double before = rate_;
  if (stops && !all_bear) waited_s_ += cycle;
  rate_ = std::clamp(wanted, rate_ - most, rate_ + most);
  change_of_rate_ = (rate_ - before) / cycle;
  if (!halted_.empty()) {
    if (rate_ == 0.0) stood_s_ += cycle;
    if (rate_ == 0.0) return;
  }
  const Interval& interval = intervals_[now_];
  if (held_before_s_ < interval.hold_before_s) {
    if (!stops) held_before_s_ += cycle;
    rate_ = change_of_rate_ = 0.0;
    return;
  }
  const bool is_last = now_ + 1 == intervals_.size();
  const double end_s = motion_.time_s[static_cast<std::size_t>(interval.last)];
  time_s_ = std::min(time_s_ + rate_ * cycle, end_s);
  while (vertex_ + 1 < interval.last &&
         time_s_ >= motion_.time_s[static_cast<std::size_t>(vertex_) + 1]) {
    ++vertex_;
  }
  if (time_s_ < end_s) return;
  rate_ = change_of_rate_ = 0.0;
  if (held_after_s_ < interval.hold_after_s) {
    held_after_s_ += cycle;
    return;
  }
  if (is_last) {
    at_end_ = true;
    stood_s_ += cycle;
    return;
  }
  ++now_;
  vertex_ = intervals_[now_].first;
  held_before_s_ = held_after_s_ = 0.0;
  for (std::size_t e = 0; e < touches_.size(); ++e) {
    Touch& touch = touches_[e];
    if (intervals_[now_].closes[e]) touch.absent_s = 0.0;
    if (!contact_of(now_, e)) touch.was_lifted = false;
  }
}

void MotionPlayer::set_reference() {
  const auto at = static_cast<std::size_t>(vertex_);
  if (vertex_ < static_cast<int>(steps_.size())) {
    const double from = motion_.time_s[at], to = motion_.time_s[at + 1];
    steps_[at].at(std::clamp((time_s_ - from) / (to - from), 0.0, 1.0), reference_);
  } else {
    reference_.configuration = motion_.configurations[at];
    reference_.velocity.setZero();
    reference_.acceleration.setZero();
  }
  // By the chain rule, where plan time does not go on as time does.
  reference_.acceleration *= rate_ * rate_;
  reference_.acceleration += change_of_rate_ * reference_.velocity;
  reference_.velocity *= rate_;
}

double MotionPlayer::closing_share(const Interval& interval, std::size_t effector) const {
  const double within =
      interval.hold_before_s > 0.0 ? interval.hold_before_s : interval.still_before_s;
  const double since_s =
      time_s_ - motion_.time_s[static_cast<std::size_t>(interval.first)] + held_before_s_;
  return smooth(std::min(since_s, touches_[effector].loaded_s) / std::max(within, 1e-3));
}

double MotionPlayer::opening_share(const Interval& interval) const {
  const double within =
      interval.hold_after_s > 0.0 ? interval.hold_after_s : interval.still_after_s;
  const double left_s = motion_.time_s[static_cast<std::size_t>(interval.last)] - time_s_ +
                        interval.hold_after_s - held_after_s_;
  return smooth(left_s / std::max(within, 1e-3));
}

/// Linear between vertices; at a change of stance those of the stance before.
void MotionPlayer::set_wrench(std::size_t effector) {
  ContactCommand& command = commands_[effector];
  command.wrench.setZero();
  if (motion_.wrenches.empty()) return;
  const Interval& interval = intervals_[now_];
  const auto at = static_cast<std::size_t>(vertex_);
  const auto contact = static_cast<std::size_t>(interval.contact[effector]);
  const auto borne = [&](std::size_t vertex, std::size_t of) {
    const StanceWrenches& wrenches = motion_.wrenches[vertex];
    return of < wrenches.size() ? wrenches[of] : StanceWrenches::value_type::Zero().eval();
  };
  command.wrench = borne(at, contact);
  if (vertex_ >= static_cast<int>(steps_.size())) return;
  StanceWrenches::value_type next = StanceWrenches::value_type::Zero();
  if (vertex_ + 1 < interval.last || now_ + 1 == intervals_.size()) {
    next = borne(at + 1, contact);
  } else if (!interval.opens[effector]) {
    next = borne(at + 1, static_cast<std::size_t>(intervals_[now_ + 1].contact[effector]));
  }
  const double from = motion_.time_s[at], to = motion_.time_s[at + 1];
  const double share = std::clamp((time_s_ - from) / (to - from), 0.0, 1.0);
  command.wrench += share * (next - command.wrench);
}

void MotionPlayer::set_commands() {
  const Interval& interval = intervals_[now_];
  for (std::size_t e = 0; e < commands_.size(); ++e) {
    ContactCommand& command = commands_[e];
    const Touch& touch = touches_[e];
    command = {};
    command.touches = touch.touches || settled_s_ < options_.settle_s;
    const HeldContact* held = contact_of(now_, e);
    if (touch.given_up) continue;
    if (held && held->contact().bears_load) {
      command.held = held;
      if (interval.closes[e]) command.share = closing_share(interval, e);
      if (interval.opens[e]) command.share = std::min(command.share, opening_share(interval));
      set_wrench(e);
      continue;
    }
    if (held || now_ + 1 == intervals_.size()) continue;
    // Early: it touched before it should, after it was in the air.
    const double left_s = motion_.time_s[static_cast<std::size_t>(interval.last)] - time_s_;
    const HeldContact* next = contact_of(now_ + 1, e);
    if (next && next->contact().bears_load && touch.was_lifted && touch.touches &&
        left_s < options_.early_s) {
      command.held = next;
      command.share = 0.0;
    }
  }
}

void MotionPlayer::advance(std::span<const TouchMeasurement> measured) {
  if (measured.size() != touches_.size()) {
    throw Error("measurements of " + std::to_string(measured.size()) + " end effectors",
                std::to_string(touches_.size()));
  }
  move_on(measure(measured));
  set_reference();
  set_commands();
}

}  // namespace locograph
