#include <locograph/planners/offline/stance/stance_space.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kRegionMargin = 0.1;
constexpr double kSamePlane_m = 1e-4, kSamePlane_rad = 1e-3;
constexpr double kQuantum = 1e-9;  ///< places nearer than this are one
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

bool lies_in(const Surface& surface, const Contact& contact) {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d normal = pose.linear().col(2);
  return angle_between(normal, contact.normal) <= kSamePlane_rad &&
         std::abs(normal.dot(contact.position - pose.translation())) <= kSamePlane_m;
}

/// Length of the way along the joints from the robot's root to a link's point.
double chain_length(const Robot& robot, const EndEffector& effector) {
  double length = effector.point.norm();
  int link = robot.link_index(effector.link);
  while (link > 0) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(
        robot.links()[static_cast<std::size_t>(link)].parent_joint)];
    length += joint.parent_from_joint.translation().norm();
    link = joint.parent_link;
  }
  return length;
}

}  // namespace

std::size_t FootingHash::operator()(const Footing& footing) const {
  std::size_t hash = 1469598103934665603ULL;
  for (const int place : footing) {
    hash = (hash ^ (static_cast<std::size_t>(place) + 2)) * 1099511628211ULL;
  }
  return hash;
}

Footing with(Footing footing, int effector, int place) {
  footing[static_cast<std::size_t>(effector)] = place;
  return footing;
}

int contacts_of(const Footing& footing) {
  return static_cast<int>(
      std::count_if(footing.begin(), footing.end(), [](int place) { return place != kFree; }));
}

Footing joined(Footing from, const Footing& to) {
  from.insert(from.end(), to.begin(), to.end());
  return from;
}

int changed_effector(const Footing& before, const Footing& after) {
  const auto [changed, now] = std::mismatch(before.begin(), before.end(), after.begin());
  return static_cast<int>(changed - before.begin());
}

StanceSpace::StanceSpace(const StanceProblem& problem, const StancePlannerOptions& options)
    : problem_(problem),
      options_(options),
      solver_(problem.robot, problem.world),
      state_(*problem.robot->robot),
      mass_kg_(problem.robot->robot->total_mass()),
      preferred_(problem.start_configuration) {
  for (const EndEffector& effector : problem.end_effectors) {
    require_sound_effector(*problem.robot->robot, effector);
    reach_m_.push_back(options.reach * chain_length(*problem.robot->robot, effector));
  }
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
  place.bearing.contact.effector.friction = friction_at(contact);
  place.bearing.contact.locked = contact.effector.kind == ContactKind::kWheel;
  places_.push_back(std::move(place));
  return found->second;
}

double StanceSpace::friction_at(const Contact& contact) const {
  double friction = contact.effector.friction;
  for (const Surface& surface : problem_.world.surfaces) {
    if (surface.friction > 0.0 && lies_in(surface, contact)) {
      friction = std::min(friction, surface.friction);
    }
  }
  for (const Bar& bar : problem_.world.bars) {
    const Eigen::Vector3d way = bar.to - bar.from;
    const Eigen::Vector3d off = contact.position - bar.from;
    const double away = (off - way * (way.dot(off) / way.squaredNorm())).norm();
    if (bar.friction > 0.0 && away <= bar.radius_m + 2.0 * kSamePlane_m) {
      friction = std::min(friction, bar.friction);
    }
  }
  return friction;
}

std::vector<Eigen::Vector2d> StanceSpace::area_on_surfaces(const Contact& contact) const {
  if (contact.effector.kind != ContactKind::kSurface) return {};
  const EndEffector& sole = contact.effector;
  const double half_x = contact.forward ? sole.half_x_m : std::min(sole.half_x_m, sole.half_y_m);
  const double half_y = contact.forward ? sole.half_y_m : half_x;
  const Eigen::Matrix3d axes = axes_in_world(contact);
  std::vector<Eigen::Vector2d> best;
  for (const Surface& surface : problem_.world.surfaces) {
    if (!lies_in(surface, contact)) continue;
    std::vector<Eigen::Vector2d> area_there = {
        {half_x, half_y}, {-half_x, half_y}, {-half_x, -half_y}, {half_x, -half_y}};
    const Eigen::Vector3d centre = surface.world_from_surface.inverse() * contact.position;
    const double half[] = {surface.half_x_m, surface.half_y_m};
    for (int axis = 0; axis < 2; ++axis) {
      if (std::isinf(half[axis])) continue;
      const Eigen::Vector3d out = surface.world_from_surface.linear().col(axis);
      const Eigen::Vector2d across(out.dot(axes.col(0)), out.dot(axes.col(1)));
      area_there = cut(area_there, across, half[axis] - centre[axis]);
      area_there = cut(area_there, -across, half[axis] + centre[axis]);
    }
    if (best.empty() || area(area_there) > area(best)) best = std::move(area_there);
  }
  for (const Bar& bar : problem_.world.bars) {
    if (!best.empty()) break;
    const Eigen::Vector3d way = (bar.to - bar.from).normalized();
    const Eigen::Vector3d off = contact.position - bar.from;
    const Eigen::Vector3d radial = off - way * way.dot(off);
    if (std::abs(radial.norm() - bar.radius_m) > 2.0 * kSamePlane_m) continue;
    const Eigen::Vector2d along(way.dot(axes.col(0)), way.dot(axes.col(1)));
    const double length = std::min(half_x / std::max(1e-9, std::abs(along.x())),
                                   half_y / std::max(1e-9, std::abs(along.y())));
    const double before = std::min(length, way.dot(off));
    const double after = std::min(length, (bar.to - bar.from).norm() - way.dot(off));
    best = {-before * along, after * along};
  }
  return best;
}

Footing StanceSpace::footing(const Stance& stance) {
  Footing footing(problem_.end_effectors.size(), kFree);
  for (const Contact& contact : stance.contacts) {
    const auto found =
        std::find_if(problem_.end_effectors.begin(), problem_.end_effectors.end(),
                     [&](const EndEffector& effector) { return effector.name == contact.name(); });
    if (found == problem_.end_effectors.end()) {
      throw Error("a contact of the unknown end effector " + contact.name(), "a known one");
    }
    const int effector = static_cast<int>(found - problem_.end_effectors.begin());
    footing[static_cast<std::size_t>(effector)] = intern(effector, contact);
  }
  return footing;
}

Stance StanceSpace::stance(const Footing& footing) const {
  Stance stance;
  for (const int number : footing) {
    if (number == kFree) continue;
    stance.contacts.push_back(place(number).bearing.contact);
    const int effector = place(number).effector;
    stance.contacts.back().effector = problem_.end_effectors[static_cast<std::size_t>(effector)];
  }
  return stance;
}

Eigen::Vector3d StanceSpace::position(int effector, const Eigen::VectorXd& q) {
  const EndEffector& of = problem_.end_effectors[static_cast<std::size_t>(effector)];
  state_.update(q.data());
  return state_.world_from_link(state_.robot().link_index(of.link)) * of.point;
}

std::vector<int> StanceSpace::places_near(int effector, const Eigen::Vector3d& point,
                                          double reach_m) {
  std::vector<int> places;
  for (const Surface& surface : problem_.world.surfaces) {
    places_on(effector, surface, point, reach_m, places);
  }
  for (const Bar& bar : problem_.world.bars) places_on(effector, bar, point, reach_m, places);
  return places;
}

void StanceSpace::places_on(int effector, const Surface& surface, const Eigen::Vector3d& point,
                            double reach_m, std::vector<int>& places) {
  const EndEffector& of = problem_.end_effectors[static_cast<std::size_t>(effector)];
  if (of.kind == ContactKind::kRung) return;
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d local = pose.inverse() * point;
  const double off = std::abs(local.z());
  if (off >= reach_m) return;
  const double radius = std::sqrt(reach_m * reach_m - off * off);
  // A sole stays whole on the surface where it can, else in its middle; a wheel a radius away from
  // where it would roll off.
  Eigen::Vector2d inset = Eigen::Vector2d::Zero();
  Contact contact;
  contact.effector = of;
  contact.normal = pose.linear().col(2);
  if (of.kind == ContactKind::kSurface) {
    contact.forward = pose.linear().col(0);
    inset << of.half_x_m, of.half_y_m;
  } else if (of.kind == ContactKind::kWheel) {
    inset.setConstant(of.radius_m);
  }
  std::vector<double> along[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double half = axis == 0 ? surface.half_x_m : surface.half_y_m;
    const double most = std::max(0.0, half - inset[axis]);
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
  const EndEffector& of = problem_.end_effectors[static_cast<std::size_t>(effector)];
  if (of.kind == ContactKind::kWheel) return;
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
  const int sides = of.kind == ContactKind::kSurface ? 1 : kBarSides;
  const double end = of.kind == ContactKind::kSurface ? std::min(of.half_y_m, middle) : 0.0;
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
      if (of.kind != ContactKind::kRung) contact.position += bar.radius_m * normal;
      if (of.kind != ContactKind::kPoint) contact.forward = way.cross(normal);
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

const BalanceRegion& StanceSpace::region(const Footing& footing) {
  const auto found = regions_.find(footing);
  if (found != regions_.end()) return found->second;
  const std::vector<BearingContact> bearing = bearing_contacts(footing);
  BalanceRegion region;
  if (!bearing.empty()) region = balance_region(mass_kg_, bearing, kRegionMargin);
  return regions_.emplace(footing, std::move(region)).first->second;
}

StanceSpace::Attempt StanceSpace::change(const Footing& from, const Footing& to,
                                         const Eigen::VectorXd& start,
                                         const TransitionOptions& options) {
  const bool adds = contacts_of(to) > contacts_of(from);
  const Stopwatch watch;
  Attempt attempt = solve(adds ? to : from, adds ? from : to, start, options_.seed, options);
  ++transitions;
  if (attempt.found) ++transitions_found;
  transitions_s += watch.seconds();
  return attempt;
}

StanceSpace::Attempt StanceSpace::solve(const Footing& larger, const Footing& smaller,
                                        const Eigen::VectorXd& start, std::uint64_t seed,
                                        const TransitionOptions& options) {
  const Stance closed = stance(larger);
  TransitionProblem problem;
  problem.closed = closed.contacts;
  problem.balance = &region(smaller);
  problem.start = start;
  problem.preferred = preferred_;
  problem.seed = seed;
  TransitionResult result = solver_.solve(problem, options);
  if (result.found && problem_.check.enforce_torque_limits) {
    ease_torques(smaller, problem, options, result);
  }
  return {result.found, std::move(result.configuration), result.failure, std::move(result.reason)};
}

StanceSpace::Attempt StanceSpace::stand(const Stance& stance, const Eigen::VectorXd& start,
                                        int attempt) {
  TransitionOptions options = attempt == 0 ? TransitionOptions() : wide_margins();
  options.max_iterations = 100;
  options.restarts = 10 * attempt;
  const Footing standing = footing(stance);
  return solve(standing, standing, start, static_cast<std::uint64_t>(attempt), options);
}

void StanceSpace::ease_torques(const Footing& smaller, TransitionProblem& problem,
                               const TransitionOptions& options, TransitionResult& result) {
  TorqueProgramme torques(state_.robot(), bearing_contacts(smaller), problem_.check.effort_scale,
                          kRegionMargin);
  state_.update(result.configuration.data());
  Eigen::VectorXd gradient;
  if (torques.solve(state_, gradient) <= 1.0 - options.torque_margin) return;
  problem.torques = &torques;
  problem.start = result.configuration;
  result = solver_.solve(problem, options);
}

StanceSpace::Attempt StanceSpace::try_transition(const Footing& from, const Footing& to,
                                                 const Eigen::VectorXd& start, int restarts) {
  if (refused_.contains(joined(from, to))) return {};
  TransitionOptions options;
  options.restarts = restarts;
  const Stopwatch watch;
  Attempt attempt = change(from, to, start, options);
  if (options_.observe) {
    options_.observe({stance(from), stance(to), start, restarts, attempt.found, watch.seconds()});
  }
  if (!attempt.found) {
    count_failure(changed_effector(from, to), transition_failure_name(attempt.failure));
  }
  return attempt;
}

StanceSpace::Attempt StanceSpace::try_harder(const Footing& from, const Footing& to,
                                             const Eigen::VectorXd& start) {
  TransitionOptions options = wide_margins();
  options.restarts = 10;
  return change(from, to, start, options);
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
        {problem_.end_effectors[static_cast<std::size_t>(key.first)].name, key.second, count});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  return all;
}

}  // namespace locograph
