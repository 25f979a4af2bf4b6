#include <locograph/check/judge.h>
#include <locograph/check/limits.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/online/continuation.h>
#include <locograph/planners/online/driven_way.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/resumed_drive.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/configuration/near_spheres.h>
#include <locograph/plugins/rolling/edge_rolling.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace locograph {
namespace {

using Eigen::Vector2d;

constexpr double kGrid_m = 0.1, kBeyond_m = 3.0;  // how far beyond start and goal is looked
constexpr double kFar_m = 50.0;                   // a million nodes
constexpr double kBetween_m = 0.05;               // places that are looked at on a straight line
constexpr double kNear_m = 0.3;                   // of start and goal, which may be less clear

/// Where the base may be, legs and heading as where the robot stands.
class FreePlaces {
 public:
  FreePlaces(std::shared_ptr<const RobotParameter> robot, const Eigen::VectorXd& stands,
             const Vector2d& goal, const WorldDistance& world, double clear_m)
      : robot_(*robot),
        world_(world),
        state_(std::move(robot)),
        start_(stands.head<2>()),
        goal_(goal),
        most_m_(clear_m) {
    state_.update(stands.data());
    at_start_m_ = clear(start_);
    at_goal_m_ = clear(goal_);
  }

  bool is_free(const Vector2d& at) {
    constexpr double kRounding_m = 1e-3;
    double needs_m = most_m_;
    if ((at - start_).norm() < kNear_m) needs_m = std::min(needs_m, at_start_m_ - kRounding_m);
    if ((at - goal_).norm() < kNear_m) needs_m = std::min(needs_m, at_goal_m_ - kRounding_m);
    return needs_m > 0.0 && clear(at) >= needs_m;
  }

  bool is_free_between(const Vector2d& from, const Vector2d& to) {
    const int parts = 1 + static_cast<int>((to - from).norm() / kBetween_m);
    for (int k = 0; k <= parts; ++k) {
      if (!is_free(from + (to - from) * k / parts)) return false;
    }
    return true;
  }

 private:
  /// How far its spheres are from the world, as far as that is asked for.
  double clear(const Vector2d& at) {
    double least_m = most_m_;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    shift.head<2>() = at - start_;
    each_near_sphere(robot_, {state_.bound_centres, state_.sphere_centres, shift}, world_, 0.0,
                     most_m_, [&](int i, double distance) {
                       const double radius = robot_.spheres[static_cast<std::size_t>(i)].radius;
                       least_m = std::min(least_m, distance - radius);
                     });
    return least_m;
  }

  const RobotParameter& robot_;
  const WorldDistance& world_;
  ConfigurationState state_;
  const Vector2d start_, goal_;
  double most_m_, at_start_m_ = 0.0, at_goal_m_ = 0.0;
};

/// A square of places around the start, by A*.
class Grid {
 public:
  Grid(FreePlaces& places, const Vector2d& start, const Vector2d& goal)
      : places_(places),
        start_(start),
        goal_(goal),
        half_(static_cast<int>(std::ceil(
            (std::min((goal - start).lpNorm<Eigen::Infinity>(), kFar_m) + kBeyond_m) / kGrid_m))) {}

  /// Corners from the start to the goal, both included; none where there is no way. Goals that are
  /// farther than kFar_m are reached in a straight line or not at all.
  std::vector<Vector2d> find(const Termination& termination) {
    if (places_.is_free_between(start_, goal_)) return {start_, goal_};
    if ((goal_ - start_).lpNorm<Eigen::Infinity>() > kFar_m) return {};
    nodes_.resize(static_cast<std::size_t>(side()) * static_cast<std::size_t>(side()));
    std::priority_queue<Open> open;
    const int first = index(half_, half_);
    node(first).way_m = 0.0;
    open.push({(goal_ - start_).norm(), first});
    while (!open.empty() && !termination.ended()) {
      const int here = open.top().node;
      open.pop();
      if (std::exchange(node(here).closed, true)) continue;
      const Vector2d at = place(here);
      if ((at - goal_).norm() <= 2.0 * kGrid_m && places_.is_free_between(at, goal_)) {
        return pulled_tight(here);
      }
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) try_neighbour(here, dx, dy, open);
      }
    }
    return {};
  }

 private:
  struct Node {
    double way_m = std::numeric_limits<double>::infinity();
    int from = -1;
    bool closed = false, looked_at = false, free = false;
  };
  struct Open {
    double estimate_m;
    int node;
    // The least first, of equal ones always the same.
    bool operator<(const Open& other) const {
      return std::pair(estimate_m, node) > std::pair(other.estimate_m, other.node);
    }
  };

  int side() const { return 2 * half_ + 1; }
  int index(int x, int y) const { return x * side() + y; }
  Node& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  Vector2d place(int i) const {
    return start_ + kGrid_m * Vector2d(i / side() - half_, i % side() - half_);
  }

  void try_neighbour(int here, int dx, int dy, std::priority_queue<Open>& open) {
    const int x = here / side() + dx, y = here % side() + dy;
    if ((dx == 0 && dy == 0) || std::min(x, y) < 0 || std::max(x, y) >= side()) return;
    const int there = index(x, y);
    Node& next = node(there);
    const double way_m = node(here).way_m + kGrid_m * std::hypot(dx, dy);
    if (next.closed || way_m >= next.way_m) return;
    if (!std::exchange(next.looked_at, true)) next.free = places_.is_free(place(there));
    if (!next.free || !places_.is_free_between(place(here), place(there))) return;
    next.way_m = way_m;
    next.from = here;
    open.push({way_m + (goal_ - place(there)).norm(), there});
  }

  /// From each corner as far as it goes in a straight line.
  std::vector<Vector2d> pulled_tight(int last) {
    std::vector<Vector2d> way = {goal_};
    for (int i = last; i >= 0; i = node(i).from) way.push_back(place(i));
    std::ranges::reverse(way);
    std::vector<Vector2d> corners = {way.front()};
    for (std::size_t k = 1; k < way.size(); ++k) {
      const bool ends = k + 1 == way.size();
      if (ends || !places_.is_free_between(corners.back(), way[k + 1])) corners.push_back(way[k]);
    }
    return corners;
  }

  FreePlaces& places_;
  const Vector2d start_, goal_;
  int half_;
  std::vector<Node> nodes_;
};

/// How far the base leans over, of another one.
double lean_rad(const Eigen::VectorXd& q, const Eigen::VectorXd& other) {
  const auto up = [](const Eigen::VectorXd& of) {
    return Eigen::Vector3d(Eigen::Quaterniond(of.data() + 3) * Eigen::Vector3d::UnitZ());
  };
  return std::acos(std::clamp(up(q).dot(up(other)), -1.0, 1.0));
}

/// The last configuration on this stance that leans over as the goal does, or its first one:
/// steering axes that lean take the wheels off the ground as they are turned far.
int upright_at(const Motion& executed, const Eigen::VectorXd& goal) {
  const std::vector<Eigen::VectorXd>& way = executed.configurations;
  const std::vector<int>& stances = executed.stance_from;
  constexpr double kMost_rad = 0.004;
  int at = static_cast<int>(way.size()) - 1;
  while (at > 0 && lean_rad(way[static_cast<std::size_t>(at)], goal) > kMost_rad &&
         stances[static_cast<std::size_t>(at) - 1] == stances.back()) {
    --at;
  }
  return at;
}

/// The configuration from which on slip of wheels counts at the end of a way.
int stretch_before_end(const std::vector<Eigen::VectorXd>& way) {
  auto first = way.size() - 1;
  for (double way_m = 0.0; first > 0 && way_m < limits::kSlipStretch_m; --first) {
    way_m += (way[first] - way[first - 1]).head<3>().norm();
  }
  return static_cast<int>(first);
}

/// Counter-clockwise, from where the robot stands to its goal, full turns of the plan included: the
/// judge counts them.
double turn_left(const Motion& planned, const Eigen::VectorXd& stands, int at) {
  const std::vector<Eigen::VectorXd>& way = planned.configurations;
  auto k = std::min(static_cast<std::size_t>(at), way.size() - 1);
  double turn_rad = turn_between(stands.data(), way[k].data());
  for (; k + 1 < way.size(); ++k) turn_rad += turn_between(way[k].data(), way[k + 1].data());
  return turn_rad;
}

/// A way from rest to rest: its speed grows as 3 t² − 2 t³ at first, and gets less so at the end.
class Cruise {
 public:
  Cruise(double way_m, double speed_m_s)
      : way_m_(way_m),
        ramp_s_(std::max(kRamp_s, kSteepest * speed_m_s / kDriveAcceleration_m_s2)),
        speed_m_s_(std::min(speed_m_s, way_m / ramp_s_)) {}

  double takes_s() const { return way_m_ / speed_m_s_ + ramp_s_; }
  double ramp_s() const { return ramp_s_; }
  /// The share of the way that is gone.
  double gone(double time_s) const {
    const double left_s = takes_s() - time_s;
    if (left_s < ramp_s_) return 1.0 - ramp(left_s / ramp_s_) / way_m_;
    if (time_s < ramp_s_) return ramp(time_s / ramp_s_) / way_m_;
    return speed_m_s_ * (time_s - 0.5 * ramp_s_) / way_m_;
  }

 private:
  static constexpr double kRamp_s = 1.0;
  static constexpr double kSteepest = 1.5;  // of 3 t² − 2 t³
  double ramp(double t) const { return speed_m_s_ * ramp_s_ * t * t * t * (1.0 - 0.5 * t); }

  double way_m_, ramp_s_, speed_m_s_;
};

/// Goes on with a motion that has come to rest, from corner to corner.
class Drive {
 public:
  Drive(const Task& task, const std::shared_ptr<const StanceParameter>& stance, Motion& motion,
        double step_s)
      : task_(task),
        robot_(*task.robot->robot),
        motion_(motion),
        stance_(motion.stance_from.back()),
        wheels_(robot_, motion.stances[static_cast<std::size_t>(stance_)]),
        step_s_(std::max(step_s, kLeastStep_s)),
        still_(Eigen::VectorXd::Zero(robot_.tangent_size())),
        rolling_(*stance, 0, 1.0),
        before_(task.robot),
        after_(task.robot) {
    rolling_.stance = stance;
    motion_.slopes.resize(motion_.configurations.size());
    motion_.slopes.back() = still_;
  }

  /// The way that it came, to one of its configurations, in the time that it took but for the end.
  void back_to(int configuration) {
    const std::vector<Eigen::VectorXd> way(motion_.configurations.begin() + configuration,
                                           motion_.configurations.end());
    const std::vector<double> times_s(motion_.time_s.begin() + configuration, motion_.time_s.end());
    const std::vector<Eigen::VectorXd> slopes(motion_.slopes.begin() + configuration,
                                              motion_.slopes.end());
    std::vector<double> left_m = {0.0};
    for (std::size_t k = 1; k < way.size(); ++k) {
      left_m.push_back(left_m.back() + wheels_.longest_way(way[k - 1], way[k]));
    }
    const auto share = [&](std::size_t k) {
      return share_of_speed(left_m[k], task_.drive->speed_m_s);
    };
    double time_s = motion_.time_s.back();
    for (std::size_t k = way.size() - 1; k > 0; --k) {
      if (way[k - 1] == way[k]) continue;  // it waited there
      time_s += (times_s[k] - times_s[k - 1]) * 2.0 / (share(k) + share(k - 1));
      const bool ends = k == 1 || slopes[k - 1].size() == 0;
      add(way[k - 1], time_s,
          ends ? Eigen::VectorXd() : Eigen::VectorXd(-share(k - 1) * slopes[k - 1]));
    }
    motion_.slopes.back() = still_;
  }

  /// From where it stands now, and turns by so much at the end. False where wheels cannot be put on
  /// the ground.
  bool along(const std::vector<Vector2d>& corners, double turn_rad) {
    stands_ = motion_.configurations.back();
    turn_rad_ = turn_rad;
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const Vector2d from = corners[k - 1], way = corners[k] - from;
      const auto at = [&](double s) { return placed(from + s * way, 0.0); };
      if (!go(at, way.norm(), step_s_)) return false;
    }
    const auto at = [&](double s) { return placed(corners.back(), s); };
    // Wheels slip by the square of what they turn in a step.
    constexpr double kTurnStep_s = 0.2;
    return go(at, wheels_.longest_way(at(0.0), at(1.0)), std::min(step_s_, kTurnStep_s));
  }

 private:
  /// The robot as it stood there, by a share turned to its goal.
  Eigen::VectorXd placed(const Vector2d& at, double share) const {
    Eigen::VectorXd q = stands_;
    q.head<2>() = at;
    turn_base(share * turn_rad_, q.data());
    return q;
  }

  /// From rest to rest. at(s): the robot, but for wheels and what steers them; way_m: of what moves
  /// farthest; most_step_s: between two configurations.
  template <class At>
  bool go(At&& at, double way_m, double most_step_s) {
    constexpr double kLeast_m = 2e-3, kSeen_m = 5e-3;
    constexpr int kFewestSteps = 8;
    if (way_m < kLeast_m) return true;
    const double first = std::min(kSeen_m / way_m, 1.0);  // where it heads
    const Eigen::VectorXd rests = motion_.configurations.back();
    const auto with_wheels_of = [&](const Eigen::VectorXd& wheels, double s) {
      Eigen::VectorXd q = at(s);
      wheels_.keep(wheels, q);
      return q;
    };
    Eigen::VectorXd steered;
    if (!wheels_.steer_along({rests, with_wheels_of(rests, first)}, steered)) return false;
    const Cruise cruise(way_m, task_.drive->speed_m_s);
    const double takes_s = cruise.takes_s(), step_s = std::min(most_step_s, 0.5 * cruise.ramp_s());
    const int steps = std::max(kFewestSteps, static_cast<int>(std::ceil(takes_s / step_s)));
    std::vector<Eigen::VectorXd> way;
    const auto driven_from = [&](const Eigen::VectorXd& begins) {
      way = {begins};
      for (int k = 1; k <= steps; ++k) {
        way.push_back(with_wheels_of(begins, cruise.gone(takes_s * k / steps)));
      }
      return wheels_.drive(way);
    };
    if (!driven_from(steered)) return false;
    wheels_.steer_other_way(way, steered);
    if (!stand_and_steer(steered) || !driven_from(motion_.configurations.back())) return false;
    for (std::size_t k = 1; k < way.size(); ++k) roll(way[k - 1], way[k]);
    const double begin_s = motion_.time_s.back();
    for (int k = 1; k <= steps; ++k) {
      add(way[static_cast<std::size_t>(k)], begin_s + takes_s * k / steps,
          k == steps ? still_ : Eigen::VectorXd());
    }
    return true;
  }

  /// From rest to rest, as 10 t³ − 15 t⁴ + 6 t⁵. Between two configurations wheels leave the ground
  /// as they are steered about axes that are not upright, so the steps are short.
  bool stand_and_steer(const Eigen::VectorXd& steered) {
    constexpr double kStep_rad = 0.1, kLeast_rad = 1e-3;
    const Eigen::VectorXd rests = motion_.configurations.back();
    const double turn_rad = wheels_.largest_turn(rests, steered);
    if (turn_rad < kLeast_rad) return true;
    constexpr double kFastest = 1.875;  // of that
    constexpr double kSlower = 1.25;    // than what steering_s() reckons with
    const int steps = 2 + static_cast<int>(kFastest * turn_rad / kStep_rad);
    const double begin_s = motion_.time_s.back(),
                 takes_s = kSlower * steering_s(task_, rests, steered);
    for (int k = 1; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      Eigen::VectorXd q;
      const double gone = t * t * t * (10.0 + t * (6.0 * t - 15.0));
      if (!wheels_.steer_standing(rests, steered, gone, q)) return false;
      roll(motion_.configurations.back(), q);
      add(q, begin_s + takes_s * t, k == steps ? still_ : Eigen::VectorXd());
    }
    return true;
  }

  /// Wheels turn as far as EDGE_ROLLING asks for, which knows how their carriers turn.
  void roll(const Eigen::VectorXd& from, Eigen::VectorXd& to) {
    before_.update(from.data());
    after_.update(to.data());
    Eigen::VectorXd slip(rolling_.dimension());
    rolling_.error(before_, after_, slip);
    Eigen::Index row = 0;
    for (const StanceParameter::StandingWheel& standing : rolling_.stance->wheels) {
      if (!standing.locked && standing.wheel.joint >= 0) {
        to[robot_.base_configuration_size() + standing.wheel.joint] +=
            slip[row + 1] / standing.wheel.radius_m;
      }
      row += standing.locked ? 3 : 2;
    }
  }

  void add(const Eigen::VectorXd& q, double time_s, const Eigen::VectorXd& slope) {
    motion_.configurations.push_back(q);
    motion_.time_s.push_back(time_s);
    motion_.slopes.push_back(slope);
    motion_.stance_from.push_back(stance_);
  }

  const Task& task_;
  const Robot& robot_;
  Motion& motion_;
  const int stance_;
  DrivenWheels wheels_;
  static constexpr double kLeastStep_s = 0.05;
  const double step_s_;
  const Eigen::VectorXd still_;
  EdgeRolling rolling_;
  ConfigurationState before_, after_;
  Eigen::VectorXd stands_;  ///< where the way begins
  double turn_rad_ = 0.0;   ///< at the end
};

}  // namespace

ResumedPlan resume_drive(const Graph& stopped, const Motion& planned, const Task& task,
                         std::shared_ptr<const WorldSnapshot> world,
                         const Termination& termination) {
  const Stopwatch watch;
  ResumedPlan resumed;
  resumed.status = PlannerStatus::kNotFound;
  resumed.reason = "there is no free way to the goal";
  const Plan plan = plan_of(stopped);
  const Motion executed = motion_of(stopped, plan);
  const Eigen::VectorXd& goal = planned.configurations.back();
  const int upright = upright_at(executed, goal);
  const Eigen::VectorXd& stands = executed.configurations[static_cast<std::size_t>(upright)];
  const Vector2d start = stands.head<2>(), end = goal.head<2>();
  const Judge judge(task.robot->robot, world);
  const int slipped_from = stretch_before_end(executed.configurations);
  for (const double clear_m : {0.15, 0.1, 0.06}) {
    if (termination.ended()) break;
    FreePlaces places(task.robot, stands, end, world->distance(), clear_m);
    const std::vector<Vector2d> corners = Grid(places, start, end).find(termination);
    if (corners.empty()) continue;
    Motion whole = executed;
    Drive drive(task, plan.stance_from.back(), whole, usual_step_s(planned));
    if (upright + 1 < static_cast<int>(executed.configurations.size())) drive.back_to(upright);
    if (!drive.along(corners, turn_left(planned, stands, upright))) {
      resumed.reason = "wheels do not stay on the ground on the way to the goal";
      continue;
    }
    std::optional<Graph> graph = drive_graph(task, whole);
    if (plan.world) graph->replace_parameter(kWorldNumber, plan.world);
    const CheckReport report =
        judged_from(slipped_from, last_configuration(*graph), *graph, judge, task.check);
    if (!report.feasible) {
      resumed.reason = "refused: " + violation_text(report.worst());
      continue;
    }
    resumed.graph = std::move(graph);
    resumed.status = PlannerStatus::kSolved;
    resumed.reason = "the rest is planned";
    break;
  }
  if (!resumed.success()) {
    if (const auto end = end_by(termination)) static_cast<PlannerAnswer&>(resumed) = *end;
  }
  resumed.total_s = watch.seconds();
  return resumed;
}

}  // namespace locograph
