#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/motion/rest_spline.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/motion/segment_planners.h>
#include <locograph/planners/offline/motion/swing.h>
#include <locograph/planners/offline/timing/balance_rows.h>
#include <locograph/planners/plan/slope_limits.h>
#include <locograph/robots/wheel.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace locograph {
namespace {

/// Of the spline, at three places between waypoints; it may be a little more beside them. The edges
/// of a plan tolerate 4e-5 m (edge_contact.h), the judge 1e-4 m.
constexpr double kClosedAlong = 3e-5;
constexpr int kMostRounds = 8;
/// Balls are followed in so many steps between two waypoints of a spline, a multiple of 4; until
/// they slip by less at waypoints, by moving these so often.
constexpr std::size_t kRollParts = 4;
constexpr double kRolledTo_m = 2e-6;
constexpr int kMostRollPasses = 8;
/// Between the first waypoints of a spline, and where no more are added [as
/// SegmentSpace::distance].
constexpr double kSparse = 0.35, kDense = 0.02;
constexpr std::size_t kFiner = 4;
constexpr double kSlowly = 2.0;
constexpr int kMostSampled = 4;
constexpr int kMostBroughtBack = 4;
constexpr int kOffGround = 3;  ///< more in the first and the last part
/// Both ends of a segment are the same: one contact more and another one less at once.
constexpr double kNoWay = 1e-6;
constexpr std::size_t kSwingSamples = 8;  ///< at what swings
constexpr double kRounding = 1e-9;

/// Splines may swing a little beyond limits. False: nothing was to be done.
bool bring_within_limits(const Robot& robot, Eigen::VectorXd& q) {
  constexpr double kMost_rad = 2e-3;
  bool moved = false;
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    double& x = q[robot.base_configuration_size() + i];
    const double within = std::clamp(x, joint.lower, joint.upper);
    if (within == x || std::abs(within - x) > kMost_rad) continue;
    x = within;
    moved = true;
  }
  return moved;
}

/// The slope of the curve at a point of a path: the base's velocity in the world.
Eigen::VectorXd slope_of(const Robot& robot, const TimedPoint& point) {
  Eigen::VectorXd slope = point.velocity;
  if (!robot.floating_base()) return slope;
  const Eigen::Quaterniond base(Eigen::Vector4d(point.configuration.segment<4>(3)));
  slope.head<3>() = base * Eigen::Vector3d(point.velocity.head<3>());
  return slope;
}

/// What the judge is asked, and a limit of accelerations where that has none.
CheckOptions with_accelerations(CheckOptions check, const MotionOptions& options) {
  if (!(check.joint_acceleration_rad_s2 > 0.0)) {
    check.joint_acceleration_rad_s2 = options.joint_acceleration_rad_s2;
  }
  return check;
}

/// SegmentPace::most_speed at a place of a path.
double most_speed_at(const std::vector<double>& most_speed, double share) {
  const double at = share * static_cast<double>(most_speed.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), most_speed.size() - 2);
  const double t = at - static_cast<double>(i);
  return (1.0 - t) * most_speed[i] + t * most_speed[i + 1];
}

void add_reason(const std::string& reason, SegmentMotion& motion) {
  motion.reason += (motion.reason.empty() ? "" : "; ") + reason;
}

}  // namespace

Motion as_motion(const SegmentMotion& way) {
  Motion motion;
  motion.configurations = way.configurations;
  motion.slopes = way.slopes;
  const double last = static_cast<double>(way.configurations.size() - 1);
  for (std::size_t i = 0; i < way.configurations.size(); ++i) {
    motion.time_s.push_back(way.duration_s * static_cast<double>(i) / last);
  }
  return motion;
}

SegmentMover::SegmentMover(const Task& task, const MotionOptions& options)
    : task_(task),
      options_(options),
      space_(task.robot, task.world->world(), options.lift_off_m),
      limits_(timing_limits(*task.robot->robot, with_accelerations(task.check, options))) {
  const std::vector<std::string>& names =
      options.segment_planners.empty() ? segment_planner_names() : options.segment_planners;
  for (const std::string& name : names) planners_.push_back(make_segment_planner(name));
  if (task.margin.self_distance_m > 0.0) {
    space_.leave_as_near(task.start_configuration, task.margin.self_distance_m);
  }
}

SegmentMotion SegmentMover::move(const Segment& segment, std::span<const BearingContact> bearing,
                                 std::size_t first, std::size_t end,
                                 const SegmentOptions& options) {
  options.validate();
  const Stopwatch watch;
  SegmentMotion motion;
  space_.set_segment(segment);
  motion.straight = space_.distance(segment.from, segment.to);
  if (motion.straight <= kNoWay) {
    motion.status = PlannerStatus::kSolved;
    motion.planner = planners_.front()->name();
    motion.to = segment.to;
    motion.waypoints = motion.configurations = {segment.from, segment.to};
    motion.slopes.assign(2, Eigen::VectorXd::Zero(space_.robot().tangent_size()));
    motion.duration_s = options_.step_s;
    return motion;
  }
  for (std::size_t i = first; i < end && motion.status == PlannerStatus::kNotFound; ++i) {
    if (const auto ended = end_by(options.termination, motion.statistics.iterations)) {
      motion.status = ended->status;
      add_reason(ended->reason, motion);
      break;
    }
    SegmentOptions asked = options;
    asked.termination = options.termination.after(motion.statistics.iterations);
    SegmentPath path = planners_[i]->plan(space_, asked);
    motion.statistics.iterations += path.statistics.iterations;
    motion.statistics.path_s += path.statistics.total_s;
    motion.planner = planners_[i]->name();
    motion.no_arc = motion.no_arc || path.no_arc;
    motion.status = path.status;
    if (path.success()) {
      motion.waypoints = std::move(path.waypoints);
      motion.to.resize(0);
      shape(bearing, {}, motion);
      if (motion.success()) break;
      path.reason = motion.to.size() > 0 ? "no timing keeps it in balance"
                                         : "contacts do not close where balls roll to";
    }
    add_reason(motion.planner + ": " + path.reason, motion);
  }
  motion.statistics.total_s = watch.seconds();
  return motion;
}

void SegmentMover::retime(const Segment& segment, std::span<const BearingContact> bearing,
                          const SegmentPace& pace, SegmentMotion& motion) {
  space_.set_segment(segment);
  shape(bearing, pace, motion);
}

void SegmentMover::shape(std::span<const BearingContact> bearing, const SegmentPace& pace,
                         SegmentMotion& motion) {
  const Stopwatch closing;
  const std::optional<PathSpline> closed = close(motion.waypoints, pace.finer, motion.to);
  motion.statistics.path_s += closing.seconds();
  const Stopwatch timing;
  const bool timed = closed && time(*closed, bearing, pace, motion);
  motion.status = timed ? PlannerStatus::kSolved : PlannerStatus::kNotFound;
  motion.statistics.timing_s += timing.seconds();
  motion.clear_m = clear_of(motion);
}

std::optional<double> SegmentMover::clear_of(const SegmentMotion& motion) {
  if (!motion.success()) return std::nullopt;
  std::optional<double> least;
  RobotState state(space_.robot());
  for (const Swing& swing : swings_of(space_)) {
    if (swing.left == nullptr || swing.reached == nullptr) continue;
    const Contact& contact = swing.contact();
    const int link = space_.robot().link_index(contact.effector.link);
    double most = 0.0;
    for (std::size_t look = 1; look < kSwingSamples; ++look) {
      state.update(
          motion.configurations[motion.configurations.size() * look / kSwingSamples].data());
      most = std::max(most, space_.room_of(contact, state.world_from_link(link)));
    }
    least = std::min(least.value_or(most), most);
  }
  return least;
}

std::size_t SegmentMover::number_of(const std::string& planner) const {
  std::size_t i = 0;
  while (i < planners_.size() && planners_[i]->name() != planner) ++i;
  return i;
}

std::optional<PathSpline> SegmentMover::close(const std::vector<Eigen::VectorXd>& waypoints,
                                              bool finer, Eigen::VectorXd& to) {
  tracks_.clear();
  for (const Contact& contact : space_.segment().held) {
    if (is_ball(contact.effector)) tracks_.emplace_back(contact);
  }
  std::vector<Node> way = {{0.0, waypoints.front()}};
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const double apart = space_.distance(way.back().q, waypoints[i]);
    if (apart > kNoWay) way.push_back({way.back().at + apart, waypoints[i]});
  }
  const Segment& segment = space_.segment();
  const double length = way.back().at;
  const auto parts =
      (finer ? kFiner : 1) *
      std::max<std::size_t>(3, static_cast<std::size_t>(std::ceil(length / kSparse)));
  std::vector<Node> nodes = {on_way(way, 0.0)};
  // What lifts off and touches down keeps to its way there.
  for (int i = 1; i <= kOffGround && !segment.left.empty(); ++i) {
    nodes.push_back(on_way(way, length * i / (kOffGround + 1.0) / static_cast<double>(parts)));
  }
  for (std::size_t i = 1; i < parts; ++i) {
    nodes.push_back(on_way(way, length * static_cast<double>(i) / static_cast<double>(parts)));
  }
  for (int i = kOffGround; i >= 1 && !segment.reached.empty(); --i) {
    nodes.push_back(
        on_way(way, length - length * i / (kOffGround + 1.0) / static_cast<double>(parts)));
  }
  nodes.push_back(on_way(way, length));
  drop_repeated(nodes);
  const bool rolls = !tracks_.empty(), end_is_fixed = rolls && to.size() > 0;
  if (rolls) nodes.back().q = end_is_fixed ? to : segment.to;
  for (int round = 0;; ++round) {
    Slips slips;
    std::optional<PathSpline> path = roll(nodes, end_is_fixed, slips);
    if (!path) return path;
    std::vector<Node> more = {nodes.front()};
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      if (std::optional<Node> between = missing(*path, i, way, nodes, slips)) {
        more.push_back(std::move(*between));
      }
      more.push_back(nodes[i]);
    }
    drop_repeated(more);
    if (more.size() == nodes.size() || round == kMostRounds) {
      to = rolls ? nodes.back().q : segment.to;
      return path;
    }
    nodes = std::move(more);
  }
}

/// A spline needs a way between its waypoints.
void SegmentMover::drop_repeated(std::vector<Node>& nodes) const {
  for (std::size_t i = 1; i + 1 < nodes.size();) {
    const bool is_last = i + 2 == nodes.size();
    const bool repeated = space_.distance(nodes[i - 1].q, nodes[i].q) <= kNoWay ||
                          (is_last && space_.distance(nodes[i].q, nodes.back().q) <= kNoWay);
    if (repeated) {
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

PathSpline SegmentMover::spline_through(const std::vector<Node>& nodes) const {
  std::vector<Eigen::VectorXd> sparse;
  for (const Node& node : nodes) sparse.push_back(node.q);
  return timing_path(space_.robot(), sparse, limits_);
}

SegmentMover::Slips SegmentMover::slips_along(const PathSpline& path) {
  Slips slips;
  if (tracks_.empty()) return slips;
  slips.emplace_back(tracks_.size(), Eigen::Vector2d::Zero());
  HeldBalls before = space_.balls_at(space_.segment().from);
  PathPoint point;
  for (std::size_t i = 1; i < path.knots().size(); ++i) {
    const double from = path.knots()[i - 1], to = path.knots()[i];
    for (std::size_t part = 1; part <= kRollParts; ++part) {
      const double share = static_cast<double>(part) / static_cast<double>(kRollParts);
      path.at(from + share * (to - from), point);
      HeldBalls here = space_.balls_at(point.configuration);
      std::vector<Eigen::Vector2d> slipped = slips.back();
      std::size_t ball = 0;
      for (std::size_t c = 0; c < here.size(); ++c) {
        if (!here[c]) continue;
        const BallStep step(tracks_[ball], *before[c], *here[c]);
        slipped[ball++] += step.error.head<2>();
      }
      slips.push_back(std::move(slipped));
      before = std::move(here);
    }
  }
  return slips;
}

void SegmentMover::roll_from(const Eigen::VectorXd& q, const std::vector<Eigen::Vector2d>& slips) {
  HeldBalls balls = space_.balls_at(q);
  std::size_t ball = 0;
  for (std::optional<BallPose>& pose : balls) {
    if (!pose) continue;
    pose = tracks_[ball].moved(*pose, -slips[ball]);
    ++ball;
  }
  space_.roll_from(std::move(balls));
}

std::optional<PathSpline> SegmentMover::roll(std::vector<Node>& nodes, bool end_is_fixed,
                                             Slips& slips) {
  const auto longest = [](const std::vector<Eigen::Vector2d>& of_balls) {
    double most = 0.0;
    for (const Eigen::Vector2d& slip : of_balls) most = std::max(most, slip.norm());
    return most;
  };
  const std::size_t last = nodes.size() - 1;
  for (int pass = 0;; ++pass) {
    PathSpline path = spline_through(nodes);
    slips = slips_along(path);
    double most = 0.0;
    for (std::size_t i = 1; i < (end_is_fixed ? last : nodes.size()) && !slips.empty(); ++i) {
      most = std::max(most, longest(slips[i * kRollParts]));
    }
    if (most <= kRolledTo_m || pass == kMostRollPasses) return path;
    // What touches down at the end comes to it as before: all moves as the end does, in proportion.
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(space_.robot().tangent_size());
    if (!end_is_fixed) {
      const Eigen::VectorXd before = nodes.back().q;
      roll_from(before, slips.back());
      if (!space_.project_end(nodes.back().q)) return std::nullopt;
      space_.robot().difference(before.data(), nodes.back().q.data(), moved.data());
    }
    const double at_end = longest(slips.back());
    for (std::size_t i = 1; i < last; ++i) {
      Eigen::VectorXd& q = nodes[i].q;
      const std::vector<Eigen::Vector2d>& here = slips[i * kRollParts];
      roll_from(q, here);
      const double share = at_end > 0.0 ? std::min(1.0, longest(here) / at_end) : 0.0;
      const Eigen::VectorXd step = share * moved;
      space_.robot().integrate(q.data(), step.data(), q.data());
      if (!space_.project(q)) return std::nullopt;
    }
  }
}

SegmentMover::Node SegmentMover::on_way(const std::vector<Node>& way, double at) {
  std::size_t i = 1;
  while (i + 1 < way.size() && way[i].at < at) ++i;
  const double share = (at - way[i - 1].at) / (way[i].at - way[i - 1].at);
  if (!tracks_.empty()) space_.roll_from(space_.balls_at(space_.segment().from));
  Node node{at, way[share < 0.5 ? i - 1 : i].q};
  if (share > kNoWay && share < 1.0 - kNoWay) {
    Eigen::VectorXd between = space_.half_way(way[i - 1].q, way[i].q, share);
    if (space_.project(between)) node.q = std::move(between);
  }
  return node;
}

std::optional<SegmentMover::Node> SegmentMover::missing(const PathSpline& path, std::size_t i,
                                                        const std::vector<Node>& way,
                                                        const std::vector<Node>& nodes,
                                                        const Slips& slips) {
  const double before = path.knots()[i - 1], after = path.knots()[i];
  const double at = 0.5 * (nodes[i - 1].at + nodes[i].at);
  PathPoint point;
  Eigen::VectorXd error;
  bool open = false;
  for (const double share : {0.25, 0.75, 0.5}) {
    path.at(before + share * (after - before), point);
    if (!slips.empty()) {
      const auto part = static_cast<std::size_t>(share * static_cast<double>(kRollParts));
      roll_from(point.configuration, slips[(i - 1) * kRollParts + part]);
    }
    space_.closure(point.configuration, error);
    open = open || (error.size() > 0 && error.cwiseAbs().maxCoeff() > kClosedAlong);
    if (nodes[i].at - nodes[i - 1].at > kDense && !space_.valid(point.configuration, true)) {
      return on_way(way, at);
    }
  }
  if (open && space_.project(point.configuration)) return Node{at, point.configuration};
  return std::nullopt;
}

bool SegmentMover::time(const PathSpline& path, std::span<const BearingContact> bearing,
                        const SegmentPace& pace, SegmentMotion& motion) {
  double slower = pace.slower;
  const double effort_scale = task_.check.enforce_torque_limits
                                  ? task_.check.effort_scale * space_.segment().torque_share
                                  : 0.0;
  BalanceRows balance(space_.robot(), bearing, {.effort_scale = effort_scale});
  TimingOptions options;
  options.smoothing_s = bears_on() ? options_.loaded_smoothing_s : options_.smoothing_s;
  options.intervals = 100;
  options.intervals_per_step = 4;
  TimingLimits limits = limits_;
  if (!pace.most_speed.empty()) {
    limits.path_speed = [&pace, length = path.length()](double s) {
      return length * most_speed_at(pace.most_speed, s / length);
    };
  }
  std::optional<PathTiming> timing(std::in_place, path, limits, options,
                                   balance.along(path, limits_));
  // Where rows leave nothing, which is for rounding only: slowly, as the judge will say.
  if (!timing->answer().success()) {
    timing.emplace(path, limits, options);
    slower *= kSlowly;
  }
  if (!timing->answer().success()) return false;
  const double duration_s = slower * timing->duration_s();
  const auto steps_in = [&](double seconds) {
    const int least = bears_on() ? static_cast<int>(kLeastOfRestSpline) - 1 : 2;
    return std::max(least, static_cast<int>(std::ceil(seconds / options_.step_s)));
  };
  int steps = steps_in(duration_s);
  // Where the cubics through the samples have to be slower, there are more of them.
  for (int i = 0; i < kMostSampled; ++i) {
    sample(*timing, slower, steps, motion);
    keep_limits(motion);
    if (steps >= steps_in(motion.duration_s)) break;
    steps = steps_in(motion.duration_s);
  }
  return true;
}

void SegmentMover::sample(const PathTiming& timing, double slower, int steps,
                          SegmentMotion& motion) {
  motion.duration_s = slower * timing.duration_s();
  motion.configurations.clear();
  motion.slopes.clear();
  motion.share.clear();
  motion.speed.clear();
  motion.length = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const TimedPoint point = timing.at(timing.duration_s() * i / steps);
    motion.configurations.push_back(point.configuration);
    motion.slopes.push_back(slope_of(space_.robot(), point) / slower);
    motion.share.push_back(point.s / timing.path().length());
    motion.speed.push_back(point.speed / timing.path().length() / slower);
    if (i == 0) continue;
    motion.length += space_.distance(motion.configurations[static_cast<std::size_t>(i) - 1],
                                     motion.configurations.back());
  }
  motion.configurations.front() = space_.segment().from;
  motion.configurations.back() = motion.to;
  motion.slopes.front().setZero();
  motion.slopes.back().setZero();
  hold_wheels(motion.configurations);
  std::vector<bool> moved;
  for (Eigen::VectorXd& q : motion.configurations) {
    bool within = true;
    if (!tracks_.empty()) space_.roll_from(space_.balls_at(q));
    for (int i = 0; i < kMostBroughtBack && bring_within_limits(space_.robot(), q); ++i) {
      space_.project(q);
      within = false;
    }
    moved.push_back(!within);
  }
  if (!bears_on()) {
    take_slopes(moved, motion);
    return;
  }
  const double step_s = motion.duration_s / steps;
  rest_spline(space_.robot(), step_s, motion.configurations, motion.slopes);
  for (std::size_t i = 1; i + 1 < motion.configurations.size(); ++i) {
    keep_within_limits(space_.robot(), motion.configurations[i], step_s, motion.slopes[i]);
  }
}

/// Of what was moved after it was timed, by the rule of the curve: of wheels in contact, and of
/// configurations that were brought within limits.
void SegmentMover::take_slopes(const std::vector<bool>& moved, SegmentMotion& motion) {
  const Robot& robot = space_.robot();
  std::vector<int> turned;
  for (const Contact& contact : space_.segment().held) {
    if (contact.effector.kind != ContactKind::kWheel) continue;
    const Wheel wheel = wheel_of(robot, contact.effector);
    if (wheel.joint >= 0) turned.push_back(robot.base_tangent_size() + wheel.joint);
  }
  Motion plain = as_motion(motion);
  plain.slopes.clear();
  const MotionCurve curve(robot, plain);
  const double step_s = plain.time_s[1] - plain.time_s[0];
  for (std::size_t i = 1; i + 1 < motion.configurations.size(); ++i) {
    const Eigen::VectorXd& by_rule = curve.slope(static_cast<int>(i));
    if (moved[i]) {
      motion.slopes[i] = by_rule;
      keep_within_limits(robot, motion.configurations[i], step_s, motion.slopes[i]);
    }
    for (const int k : turned) motion.slopes[i][k] = by_rule[k];
  }
}

/// Limits hold on the path; accelerations of the cubics through its samples are a little larger.
void SegmentMover::keep_limits(SegmentMotion& motion) {
  const Motion timed = as_motion(motion);
  const MotionCurve curve(space_.robot(), timed);
  double most = 1.0;  // of accelerations, and of velocities squared
  const auto squared = [](double ratio) { return ratio * ratio; };
  for (std::size_t i = 0; i + 1 < timed.time_s.size(); ++i) {
    const CurveStep step = curve.step(static_cast<int>(i));
    const StepBounds bounds = step.bounds();
    const double h = step.duration_s();
    const int base = space_.robot().base_tangent_size();
    for (Eigen::Index j = 0; j < bounds.joints.size(); ++j) {
      most = std::max({most, bounds.joint_bends[j] / (h * h * limits_.acceleration[base + j]),
                       squared(bounds.joints[j] / (h * limits_.velocity[base + j]))});
    }
    most = std::max({most, squared(bounds.base_distance_m / (h * limits_.base_linear_m_s)),
                     squared(bounds.base_angle_rad / (h * limits_.base_angular_rad_s))});
  }
  if (most == 1.0) return;
  const double slower = std::sqrt(most * (1.0 + kRounding));
  motion.duration_s *= slower;
  for (Eigen::VectorXd& slope : motion.slopes) slope /= slower;
  for (double& speed : motion.speed) speed /= slower;
}

/// A wheel in contact stands still: what its carrier pitches, its joint turns back.
void SegmentMover::hold_wheels(std::vector<Eigen::VectorXd>& configurations) {
  const Robot& robot = space_.robot();
  RobotState state(robot);
  for (const Contact& contact : space_.segment().held) {
    if (contact.effector.kind != ContactKind::kWheel) continue;
    const Wheel wheel = wheel_of(robot, contact.effector);
    if (wheel.joint < 0) continue;
    const int joint = robot.base_configuration_size() + wheel.joint;
    const Eigen::Vector3d normal = contact.normal.stableNormalized();
    state.update(configurations.front().data());
    double pitch = carrier_pitch(state, wheel, normal);
    for (std::size_t i = 1; i + 1 < configurations.size(); ++i) {
      state.update(configurations[i].data());
      const double now = carrier_pitch(state, wheel, normal);
      configurations[i][joint] = held_wheel_joint(configurations[i - 1][joint], pitch, now);
      pitch = now;
    }
  }
}

}  // namespace locograph
