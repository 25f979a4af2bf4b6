#include <locograph/check/limits.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/scenario/bar_place.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kQuantum = 1e-9;  ///< places nearer than this are one
/// Less area than this on a surface is none, as for the judge.
constexpr double kNoArea_m2 = 1e-8;
/// How far a ball comes along a normal, and in which steps.
constexpr double kApproach_m = 0.036, kApproachStep_m = 0.012;
/// Sides around a bar that grasps come from and points touch.
constexpr int kBarSides = 8;

/// The part of a convex polygon where n . x <= d.
std::vector<Eigen::Vector2d> cut(const std::vector<Eigen::Vector2d>& polygon,
                                 const Eigen::Vector2d& n, double d) {
  std::vector<Eigen::Vector2d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double here = n.dot(a) - d, there = n.dot(b) - d;
    if (here <= 0.0) inside.push_back(a);
    if ((here < 0.0) != (there < 0.0) && here != there) {
      inside.push_back(a + (b - a) * (here / (here - there)));
    }
  }
  return inside;
}

double area(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

TransitionOptions wide_margins() {
  TransitionOptions options;
  options.self_margin_m *= 2.0;
  options.surface_margin_m *= 2.0;
  options.obstacle_margin_m *= 2.0;
  options.balance_margin_m *= 2.0;
  return options;
}

StanceSpace::Attempt attempt_of(TransitionResult result) {
  return {result.success(), std::move(result.configuration), result.failure,
          std::move(result.reason)};
}

double distance_to(const Surface& surface, const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = surface.world_from_surface.inverse() * point;
  return Eigen::Vector3d(std::max(0.0, std::abs(local.x()) - surface.half_x_m),
                         std::max(0.0, std::abs(local.y()) - surface.half_y_m), local.z())
      .norm();
}

bool lies_in(const Surface& surface, const Contact& contact) {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d normal = pose.linear().col(2);
  return angle_between(normal, contact.normal) <= limits::kClosed_rad &&
         std::abs(normal.dot(contact.position - pose.translation())) <= limits::kClosed_m;
}

/// Length of the way along the joints from the robot's root to a link's point, what slides pulled
/// out.
double chain_length(const Robot& robot, const EndEffector& effector) {
  double length = effector.point.norm();
  int link = robot.link_index(effector.link);
  while (link > 0) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(
        robot.links()[static_cast<std::size_t>(link)].parent_joint)];
    length += joint.parent_from_joint.translation().norm();
    const double slide = std::max(std::abs(joint.lower), std::abs(joint.upper));
    if (joint.type == JointType::kPrismatic && std::isfinite(slide)) length += slide;
    link = joint.parent_link;
  }
  return length;
}

}  // namespace

StanceSpace::StanceSpace(const Task& task, const StancePlannerOptions& options)
    : task_(task),
      options_(options),
      regions_(task.robot->robot->total_mass()),
      solver_(task, regions_),
      state_(*task.robot->robot),
      after_(*task.robot->robot),
      surfaces_(bounds_of(task.world->world().surfaces)) {
  for (const EndEffector& effector : task.end_effectors()) {
    require_sound_effector(*task.robot->robot, effector);
    reach_m_.push_back(options.reach * chain_length(*task.robot->robot, effector));
  }
  if (task.margin == ExecutionMargin::none()) return;
  const auto give = [&](const Stance& stance) {
    const Footing given = footing(stance);
    given_shares_[given] =
        share_of_margin(state_.robot().total_mass(), bearing_contacts(given), task.margin);
  };
  give(task.start);
  for (const Stance& goal : task.goals) give(goal);
}

int StanceSpace::intern(int effector, const Contact& contact) {
  std::vector<long long> key = {effector};
  const auto add = [&key](const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) key.push_back(std::llround(v[i] / kQuantum));
  };
  add(contact.position);
  add(contact.normal.normalized());
  if (contact.forward) add(contact.forward->normalized());
  const auto [found, added] = numbers_.emplace(std::move(key), static_cast<int>(places_.size()));
  if (!added) return found->second;
  Place place{effector, {contact, area_on_surfaces(contact)}};
  place.bearing.contact.bar = bar_at(contact);
  place.bearing.contact.effector.friction = friction_at(contact);
  place.bearing.contact.locked = contact_kind_entry(contact.effector.kind).rolls;
  places_.push_back(std::move(place));
  return found->second;
}

std::vector<int> StanceSpace::surfaces_at(const Contact& contact) const {
  constexpr double kRound_m = 1e-3;
  return surfaces_.touching(
      box_around(contact.position, area_reach_m(contact.effector) + kRound_m));
}

double StanceSpace::friction_at(const Contact& contact) const {
  double friction = contact.effector.friction;
  for (const int s : surfaces_at(contact)) {
    const Surface& surface = task_.world->world().surfaces[static_cast<std::size_t>(s)];
    if (surface.friction > 0.0 && lies_in(surface, contact)) {
      friction = std::min(friction, surface.friction);
    }
  }
  for (const Bar& bar : task_.world->world().bars) {
    const Eigen::Vector3d way = bar.to - bar.from;
    const Eigen::Vector3d off = contact.position - bar.from;
    const double away = (off - way * (way.dot(off) / way.squaredNorm())).norm();
    if (bar.friction > 0.0 && away <= bar.radius_m + 2.0 * limits::kClosed_m) {
      friction = std::min(friction, bar.friction);
    }
  }
  return friction;
}

std::optional<RoundBar> StanceSpace::bar_at(const Contact& contact) const {
  if (!is_ball(contact.effector)) return std::nullopt;
  for (const Bar& bar : task_.world->world().bars) {
    if (gap_to_bar_m(bar, contact) > limits::kClosed_m) continue;
    return RoundBar{bar.to - bar.from, bar.radius_m};
  }
  return std::nullopt;
}

bool StanceSpace::has_balls(const Footing& footing) const {
  return std::ranges::any_of(footing, [this](int number) {
    return number != kFree && is_ball(place(number).bearing.contact.effector);
  });
}

double StanceSpace::slip_m(const Footing& from, const Eigen::VectorXd& before,
                           const Eigen::VectorXd& after) {
  if (!has_balls(from)) return 0.0;
  state_.update(before.data());
  after_.update(after.data());
  double most = 0.0;
  for (const int number : from) {
    if (number == kFree) continue;
    const Contact& contact = place(number).bearing.contact;
    if (!is_ball(contact.effector)) continue;
    const BallStep step(BallTrack(contact), BallPose(state_, contact.effector),
                        BallPose(after_, contact.effector));
    most = std::max(most, step.error.norm());
  }
  return most;
}

Stance StanceSpace::rolled_stance(const Footing& footing, const Footing& held,
                                  const Eigen::VectorXd& q) {
  Stance there = stance(footing);
  state_.update(q.data());
  for (Contact& contact : there.contacts) {
    const std::size_t e = static_cast<std::size_t>(effector_of(contact));
    if (held[e] == footing[e]) contact = rolled_to(state_, contact);
  }
  return there;
}

std::vector<Eigen::Vector2d> StanceSpace::area_on_surfaces(const Contact& contact) const {
  if (!contact_kind_entry(contact.effector.kind).has_area()) return {};
  Contact standing = contact;
  EndEffector& sole = standing.effector;
  if (!contact.forward) sole.half_x_m = sole.half_y_m = std::min(sole.half_x_m, sole.half_y_m);
  const Eigen::Matrix3d axes = axes_in_world(contact);
  std::vector<Eigen::Vector2d> all;
  const auto add = [&all](const std::vector<Eigen::Vector2d>& part) {
    all.insert(all.end(), part.begin(), part.end());
  };
  for (const int s : surfaces_at(contact)) {
    const Surface& surface = task_.world->world().surfaces[static_cast<std::size_t>(s)];
    if (!lies_in(surface, contact)) continue;
    const double x = sole.half_x_m, y = sole.half_y_m;
    std::vector<Eigen::Vector2d> part = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
    const Eigen::Vector3d centre = surface.world_from_surface.inverse() * contact.position;
    const double half[] = {surface.half_x_m, surface.half_y_m};
    for (int axis = 0; axis < 2; ++axis) {
      if (std::isinf(half[axis])) continue;
      const Eigen::Vector3d out = surface.world_from_surface.linear().col(axis);
      const Eigen::Vector2d across(out.dot(axes.col(0)), out.dot(axes.col(1)));
      part = cut(part, across, half[axis] - centre[axis]);
      part = cut(part, -across, half[axis] + centre[axis]);
    }
    if (area(part) > kNoArea_m2) add(part);
  }
  for (const Bar& bar : task_.world->world().bars) {
    if (gap_to_bar_m(bar, standing) <= limits::kClosed_m) add(line_on_bar(bar, standing));
  }
  return all;
}

Footing StanceSpace::footing(const Stance& stance) {
  Footing footing(task_.end_effectors().size(), kFree);
  for (const Contact& contact : stance.contacts) {
    const int effector = effector_of(contact);
    footing[static_cast<std::size_t>(effector)] = intern(effector, contact);
  }
  return footing;
}

int StanceSpace::effector_of(const Contact& contact) const {
  const auto found = std::ranges::find(task_.end_effectors(), contact.name(), &EndEffector::name);
  if (found == task_.end_effectors().end()) {
    throw Error("a contact of the unknown end effector " + contact.name(), "a known one");
  }
  return static_cast<int>(found - task_.end_effectors().begin());
}

Stance StanceSpace::stance(const Footing& footing) const {
  Stance stance;
  for (const int number : footing) {
    if (number == kFree) continue;
    stance.contacts.push_back(place(number).bearing.contact);
    const int effector = place(number).effector;
    stance.contacts.back().effector = task_.end_effectors()[static_cast<std::size_t>(effector)];
  }
  return stance;
}

Eigen::Vector3d StanceSpace::position(int effector, const Eigen::VectorXd& q) {
  const EndEffector& of = task_.end_effectors()[static_cast<std::size_t>(effector)];
  state_.update(q.data());
  return state_.world_from_link(state_.robot().link_index(of.link)) * of.point;
}

std::vector<int> StanceSpace::places_near(int effector, const Eigen::Vector3d& point,
                                          double reach_m) {
  std::vector<int> places;
  for (const int s : surfaces_.touching(box_around(point, reach_m))) {
    const Surface& surface = task_.world->world().surfaces[static_cast<std::size_t>(s)];
    places_on(effector, surface, point, reach_m, places);
  }
  for (const Bar& bar : task_.world->world().bars) places_on(effector, bar, point, reach_m, places);
  if (options_.approachable_only)
    std::erase_if(places, [this](int number) { return !has_room(number); });
  return places;
}

bool StanceSpace::has_room(int number) {
  const auto [found, fresh] = has_room_.emplace(number, true);
  const Contact& contact = place(number).bearing.contact;
  const double radius_m = contact.effector.radius_m;
  const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
  if (!fresh || !kind.is_round() || kind.rolls || !(radius_m > 0.0)) {
    return found->second;
  }
  const Eigen::Vector3d normal = contact.normal.stableNormalized();
  for (double off = kApproachStep_m; off < kApproach_m + kQuantum; off += kApproachStep_m) {
    const Eigen::Vector3d middle = contact.position + (radius_m + off) * normal;
    for (const int s : surfaces_.touching(box_around(middle, radius_m))) {
      const Surface& surface = task_.world->world().surfaces[static_cast<std::size_t>(s)];
      if (distance_to(surface, middle) < radius_m) return found->second = false;
    }
  }
  return true;
}

void StanceSpace::places_on(int effector, const Surface& surface, const Eigen::Vector3d& point,
                            double reach_m, std::vector<int>& places) {
  const EndEffector& of = task_.end_effectors()[static_cast<std::size_t>(effector)];
  const ContactKindEntry& kind = contact_kind_entry(of.kind);
  if (!kind.touches_surfaces) return;
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d local = pose.inverse() * point;
  const double off = std::abs(local.z());
  if (off >= reach_m) return;
  const double radius = std::sqrt(reach_m * reach_m - off * off);
  // A sole stays whole on the surface where that leaves it some room, else with its middle in the
  // inner half, as a larger one bears no less; wheels and balls a radius away from where they would
  // roll off, if they can.
  const Eigen::Vector2d inset = kind.inset_m(of);
  Contact contact;
  contact.effector = of;
  contact.normal = pose.linear().col(2);
  if (kind.axes_on_link) contact.forward = pose.linear().col(0);
  std::vector<double> along[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double half = axis == 0 ? surface.half_x_m : surface.half_y_m;
    const double least = kind.has_area() ? 0.5 * half : 0.0;
    const double most = std::max(least, half - inset[axis]);
    const double step = options_.grid_m;
    const double first = std::ceil((local[axis] - radius) / step);
    const double last = std::floor((local[axis] + radius) / step);
    for (double k = first; k <= last; ++k) {
      if (std::abs(k * step) <= most + 1e-9) along[axis].push_back(k * step);
    }
  }
  for (const double x : along[0]) {
    for (const double y : along[1]) {
      if (std::hypot(x - local.x(), y - local.y()) > radius) continue;
      contact.position = pose * Eigen::Vector3d(x, y, 0.0);
      places.push_back(intern(effector, contact));
    }
  }
}

void StanceSpace::places_on(int effector, const Bar& bar, const Eigen::Vector3d& point,
                            double reach_m, std::vector<int>& places) {
  const EndEffector& of = task_.end_effectors()[static_cast<std::size_t>(effector)];
  const ContactKindEntry& kind = contact_kind_entry(of.kind);
  if (kind.bar_touch == BarTouch::kNone) return;
  const double length = (bar.to - bar.from).norm();
  const Eigen::Vector3d way = (bar.to - bar.from) / length;
  const double at = way.dot(point - bar.from);
  const double off = (point - bar.from - at * way).norm();
  if (off >= reach_m) return;
  const double radius = std::sqrt(reach_m * reach_m - off * off);
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - way * way.z();
  if (!(up.norm() > 1e-3)) up = way.unitOrthogonal();
  up.normalize();
  const double middle = 0.5 * length, step = options_.grid_m;
  const bool across = kind.bar_touch == BarTouch::kArea;
  const int sides = across ? 1 : kBarSides;
  const double end = across ? std::min(of.half_y_m, 0.5 * middle) : 0.0;
  for (double k = std::ceil((at - radius - middle) / step); k * step <= at + radius - middle; ++k) {
    if (std::abs(k * step) > middle - end + 1e-9) continue;
    const Eigen::Vector3d on_axis = bar.from + (middle + k * step) * way;
    for (int side = 0; side < sides; ++side) {
      const double angle = side * 2.0 * M_PI / kBarSides;
      const Eigen::Vector3d normal = Eigen::AngleAxisd(angle, way) * up;
      Contact contact;
      contact.effector = of;
      contact.normal = normal;
      contact.position = on_axis;
      if (kind.bar_touch != BarTouch::kGrasp) contact.position += bar.radius_m * normal;
      if (kind.axes_on_link) contact.forward = way.cross(normal);
      places.push_back(intern(effector, contact));
    }
  }
}

std::vector<BearingContact> StanceSpace::bearing_contacts(const Footing& footing) const {
  std::vector<BearingContact> bearing;
  for (const int number : footing) {
    if (number != kFree) bearing.push_back(place(number).bearing);
  }
  return bearing;
}

double StanceSpace::margin_share(const Footing& footing) const {
  const auto given = given_shares_.find(footing);
  return given == given_shares_.end() ? 1.0 : given->second;
}

std::vector<BearingContact> StanceSpace::counted_contacts(const Footing& footing) const {
  const double weight_N = state_.robot().total_mass() * standard_gravity().norm();
  return with_margin(bearing_contacts(footing), task_.margin.scaled(margin_share(footing)),
                     weight_N);
}

TransitionTask StanceSpace::task_of(const Footing& from, const Footing& to,
                                    const Eigen::VectorXd& start, std::uint64_t seed,
                                    const TransitionOptions& options,
                                    const Eigen::VectorXd* before) const {
  const bool adds = contacts_of(to) > contacts_of(from);
  TransitionTask task{.larger = adds ? to : from, .smaller = adds ? from : to};
  task.closed = stance(task.larger).contacts;
  task.held = stance(task.smaller).contacts;
  task.bearing = counted_contacts(task.smaller);
  if (task_.margin.least_force > 0.0) task.all_bearing = counted_contacts(task.larger);
  task.start = start;
  task.seed = seed;
  task.options = options;
  task.opens = !adds;
  if (before != nullptr && has_balls(from)) task.before = *before;
  task.options.joint_margin_rad = std::max(options.joint_margin_rad, task_.margin.joint_rad);
  task.options.self_margin_m = std::max(options.self_margin_m, task_.margin.self_distance_m);
  return task;
}

StanceSpace::Attempt StanceSpace::solve(const TransitionTask& task) {
  std::optional<TransitionResult> ahead;
  if (ahead_) ahead = ahead_->take(task);
  return attempt_of(ahead ? std::move(*ahead) : solver_.solve(task));
}

StanceSpace::Attempt StanceSpace::change(const TransitionTask& task) {
  const Stopwatch watch;
  Attempt attempt = solve(task);
  ++transitions;
  if (attempt.found) ++transitions_found;
  transitions_s += watch.seconds();
  return attempt;
}

void StanceSpace::tell(const TransitionTask& task, const Footing& from, const Footing& to,
                       bool found, double seconds) const {
  if (!options_.observe) return;
  options_.observe(
      {stance(from), stance(to), task.start, task.before, task.options.restarts, found, seconds});
}

StanceSpace::Attempt StanceSpace::stand(const Stance& stance, const Eigen::VectorXd& start,
                                        int attempt) {
  TransitionOptions options = attempt == 0 ? TransitionOptions() : wide_margins();
  options.max_iterations = 100;
  options.restarts = 10 * attempt;
  const Footing standing = footing(stance);
  return attempt_of(solver_.solve(
      task_of(standing, standing, start, static_cast<std::uint64_t>(attempt), options, nullptr)));
}

StanceSpace::Attempt StanceSpace::try_transition(const Footing& from, const Footing& to,
                                                 const Eigen::VectorXd& start, int restarts,
                                                 const Eigen::VectorXd* before) {
  if (refused_.contains(joined(from, to))) return {};
  const Stopwatch watch;
  const TransitionTask task =
      task_of(from, to, start, options_.seed, {.restarts = restarts}, before);
  Attempt attempt = change(task);
  tell(task, from, to, attempt.found, watch.seconds());
  if (!attempt.found) {
    count_failure(changed_effector(from, to), transition_failure_name(attempt.failure));
  }
  return attempt;
}

StanceSpace::Attempt StanceSpace::try_harder(const Footing& from, const Footing& to,
                                             const Eigen::VectorXd& start,
                                             const Eigen::VectorXd* before) {
  TransitionOptions options = wide_margins();
  options.restarts = 10;
  return change(task_of(from, to, start, options_.seed, options, before));
}

StanceSpace::Attempt StanceSpace::try_nearby(const Footing& from, const Footing& to,
                                             const Eigen::VectorXd& start,
                                             const Eigen::VectorXd* before) {
  TransitionTask task = task_of(from, to, start, options_.seed, {}, before);
  task.preferred = start;
  return solve(task);
}

StanceSpace::Attempt StanceSpace::try_again(const Footing& from, const Footing& to,
                                            const Eigen::VectorXd& start,
                                            const Eigen::VectorXd* before) {
  const Stopwatch watch;
  const TransitionTask task = task_of(from, to, start, options_.seed, {}, before);
  Attempt attempt = solve(task);
  tell(task, from, to, attempt.found, watch.seconds());
  return attempt;
}

void StanceSpace::expect(const std::vector<std::vector<Expected>>& chains) {
  if (threads() < 2) return;
  std::vector<TransitionAhead::Expected> tasks;
  for (const std::vector<Expected>& chain : chains) {
    if (refused_.contains(joined(chain[0].from, chain[0].to))) continue;
    const auto task = [&](const Expected& one) {
      return task_of(one.from, one.to, one.start, options_.seed, {.restarts = one.restarts},
                     one.before);
    };
    tasks.push_back({task(chain[0])});
    if (chain.size() > 1) tasks.back().then = task(chain[1]);
  }
  if (!ahead_) ahead_ = std::make_unique<TransitionAhead>(solver_, threads() - 1);
  ahead_->expect(std::move(tasks));
}

void StanceSpace::expect_nothing() {
  if (ahead_) ahead_->forget();
}

void StanceSpace::forbid(const Footing& from, const Footing& to) {
  refused_.insert(joined(from, to));
}

int StanceSpace::transitions_left() const {
  if (options_.max_transitions == 0) return std::numeric_limits<int>::max();
  return options_.max_transitions - (transitions - began_);
}

void StanceSpace::count_failure(int effector, const std::string& what) {
  ++failures_[{effector, what}];
}

std::vector<StanceFailure> StanceSpace::failures() const {
  std::vector<StanceFailure> all;
  for (const auto& [key, count] : failures_) {
    all.push_back(
        {task_.end_effectors()[static_cast<std::size_t>(key.first)].name, key.second, count});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  return all;
}

}  // namespace locograph
