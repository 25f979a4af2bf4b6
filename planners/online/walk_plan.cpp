#include <locograph/check/limits.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/check_option.h>
#include <locograph/common/ranges.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/online/window_cause.h>
#include <locograph/planners/plan/slope_limits.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace locograph {
namespace {

/// The first violation for which the judge refused.
std::string describe(const CheckReport& check) {
  std::ostringstream text;
  for (const Violation& violation : check.violations) {
    if (!violation.violated) continue;
    text << violation.constraint << " " << violation.worst << " " << violation.unit << " (limit "
         << violation.limit << ") on the way to the next";
    break;
  }
  return text.str();
}

/// Steps before the executed one are judged with it, at most so many.
constexpr int kMostVerifiedSteps = 12;
/// Motions that come to rest within one to so many steps are tried.
constexpr int kMostBrakingSteps = 12;

/// How many times as fast as another one a slope is, along it; up to twice, as on any ramp.
double ratio(const Eigen::VectorXd& slope, const Eigen::VectorXd& along) {
  const double length = along.squaredNorm();
  return length > 0.0 ? std::clamp(slope.dot(along) / length, 0.0, 2.0) : 1.0;
}

/// Walks along the plan and keeps the report.
class Walk {
 public:
  Walk(Graph& graph, const WalkOptions& options)
      : graph_(graph),
        options_(options),
        planner_(graph, options.planner),
        model_(*planner_.plan().robot->robot),
        planned_(motion_of(graph, planner_.plan())) {
    const MotionCurve curve(model_, planned_);
    for (int i = 0; i < planner_.plan_size(); ++i) {
      vertex(i).slopes = curve.slope(i);
      const bool inside = i > 0 && i + 1 < planner_.plan_size();
      faster_.push_back(inside ? ratio(curve.slope(i), careful_slope(model_, planned_, i)) : 0.0);
    }
    if (options_.pace && !planner_.plan().segments.empty()) {
      throw Error("a plan that tells its segments and how long they take",
                  "one without, where steps may take longer");
    }
    report_.dof = model_.tangent_size();
    report_.status = PlannerStatus::kSolved;
    report_.reason = "every configuration is feasible";
    report_.configurations = planner_.plan_size();
  }

  WalkReport run(const WorldAt& world_at) {
    const Stopwatch watch;
    if (walk(world_at)) arrive();
    report_.statistics.iterations = static_cast<int>(report_.cycles.size());
    report_.statistics.total_s = watch.seconds();
    return std::move(report_);
  }

 private:
  /// Whether every step could be taken.
  bool walk(const WorldAt& world_at) {
    for (int executed = 0; executed + 1 < planner_.plan_size(); ++executed) {
      if (ends_at(executed) || !step(executed, world_at)) return false;
    }
    return true;
  }

  /// Whether the termination ends the walk, which then is where the robot is.
  bool ends_at(int executed) {
    const auto end = end_by(options_.termination, executed);
    if (end) end_at(executed, *end);
    return end.has_value();
  }

  bool step(int executed, const WorldAt& world_at) {
    const Stopwatch watch;
    if (auto world = world_at ? world_at(executed) : nullptr) planner_.show(std::move(world));
    report_.map_update_s.push_back(watch.seconds());
    if (ends_at(executed)) return false;  // meanwhile: to show the world takes its time
    if (options_.pace) {
      go_at(executed, options_.pace(executed));
      if (ends_too_late(executed)) return false;
    }
    const CycleReport cycle =
        planner_.cycle(executed, {.deadline = Deadline::of_limit(options_.cycle_deadline_s)});
    report_.cycles.push_back(cycle);
    report_.feasible_cycles += cycle.success() ? 1 : 0;
    report_.deadline_misses += cycle.deadline_missed ? 1 : 0;
    if (options_.on_cycle) options_.on_cycle(cycle);
    if (!cycle.next_feasible) {
      stop(executed, cycle.reason);
      return false;
    }
    pass_through(executed + 1);
    if (!options_.verify) return true;
    const Stopwatch verify_watch;
    const CheckReport check =
        options_.verify(motion_of(graph_, planner_.plan(), stretch_before(executed), executed + 1));
    report_.verify_s.push_back(verify_watch.seconds());
    if (!check.feasible) stop(executed, describe(check));
    return check.feasible;
  }

  /// The configuration from which the robot has gone the stretch within which slip of wheels
  /// counts.
  int stretch_before(int executed) {
    int first = executed;
    double way_m = 0.0;
    while (first > 0 && executed - first < kMostVerifiedSteps && way_m < limits::kSlipStretch_m) {
      way_m += (vertex(first).state - vertex(first - 1).state).head<3>().norm();
      --first;
    }
    return first;
  }

  VertexConfiguration& vertex(int i) {
    const int slot = planner_.plan().slots[static_cast<std::size_t>(i)];
    return graph_.vertex(VertexId<VertexConfiguration>{slot});
  }

  /// The steps from here on take as many times as long as they were planned.
  void go_at(int executed, double pace) {
    if (pace == pace_) return;
    double time_s = vertex(executed).time_s, before_s = time_s;
    for (int i = executed + 1; i < planner_.plan_size(); ++i) {
      const double duration_s = vertex(i).time_s - before_s;
      before_s = vertex(i).time_s;
      time_s += duration_s * pace / pace_;
      vertex(i).time_s = time_s;
      vertex(i).slopes *= pace_ / pace;
    }
    pace_ = pace;
  }

  /// Whether the walk ends because steps that are this slow end later than any file may say.
  bool ends_too_late(int executed) {
    const double end_s = vertex(planner_.plan_size() - 1).time_s;
    if (end_s <= ranges::kTime_s) return false;
    std::ostringstream text;
    text << std::setprecision(10) << "as slow as it goes now, the plan would end at " << end_s
         << " s, which is later than " << ranges::kTime_s << " s";
    end_at(executed, {PlannerStatus::kNotFound, text.str()});
    return true;
  }

  /// Decides how fast the robot passes a configuration: as fast as fits the window after it, and as
  /// fast as the plan did where nothing has moved. Later cycles change the window, but not this.
  void pass_through(int i) {
    if (i + 1 >= planner_.plan_size()) return;  // at rest
    const Motion around = motion_of(graph_, planner_.plan(), i - 1, i + 1);
    VertexConfiguration& here = vertex(i);
    here.slopes = careful_slope(model_, around, 1) * faster_[static_cast<std::size_t>(i)];
    const double before_s = here.time_s - around.time_s[0],
                 after_s = around.time_s[2] - here.time_s;
    keep_within_limits(model_, here.state, std::max(before_s, after_s), here.slopes);
  }

  /// Lets the robot come to rest at a configuration, over some steps: on the same way, slower and
  /// slower.
  void brake(int last, int steps) {
    double time_s = vertex(last - steps).time_s, before_s = time_s, faster = 1.0;
    for (int i = last - steps + 1; i <= last; ++i) {
      const double slower = std::sqrt(static_cast<double>(last - i) / steps);
      const double duration_s = vertex(i).time_s - before_s;
      before_s = vertex(i).time_s;
      time_s += duration_s * 2.0 / (faster + slower);
      vertex(i).time_s = time_s;
      vertex(i).slopes *= slower;
      faster = slower;
    }
  }

  /// The last configuration, up to `executed`, at which the robot can come to rest; it does so.
  int come_to_rest(int executed) {
    for (int last = executed; last > 0; --last) {
      if (vertex(last).slopes.isZero()) return last;
      for (int steps = 1; steps <= std::min(last, kMostBrakingSteps); ++steps) {
        const Motion moving = motion_of(graph_, planner_.plan(), last - steps, last);
        brake(last, steps);
        if (vertex(last).time_s <= ranges::kTime_s &&
            (!options_.verify ||
             options_.verify(motion_of(graph_, planner_.plan(), last - steps, last)).feasible)) {
          return last;
        }
        for (int i = 0; i <= steps; ++i) {
          vertex(last - steps + i).time_s = moving.time_s[static_cast<std::size_t>(i)];
          vertex(last - steps + i).slopes = moving.slopes[static_cast<std::size_t>(i)];
        }
      }
    }
    return 0;
  }

  void measure_goal(int at) {
    const int slot = planner_.plan().slots[static_cast<std::size_t>(at)];
    const Eigen::Map<const Eigen::VectorXd> is(graph_.state(slot), graph_.state_size(slot));
    const Eigen::VectorXd& goal = planner_.online_plan().planned().back();
    report_.goal_distance_m = (is.head<3>() - goal.head<3>()).norm();
    report_.goal_angle_rad =
        Eigen::Quaterniond(is.data() + 3).angularDistance(Eigen::Quaterniond(goal.data() + 3));
  }

  std::string goal_text() const {
    std::ostringstream text;
    text << report_.goal_distance_m << " m and " << report_.goal_angle_rad << " rad";
    return text.str();
  }

  std::string cause_after(int executed) {
    const auto cause =
        find_cause(planner_.online_plan(), executed, planner_.last_of_window(executed));
    return cause ? cause->text : "";
  }

  /// The first executed configuration whose window reaches the end of the plan.
  int first_to_see_the_end() const {
    int executed = 0;
    while (planner_.last_of_window(executed) + 1 < planner_.plan_size()) ++executed;
    return executed;
  }

  void stop(int executed, const std::string& symptom) {
    const std::string cause = cause_after(executed);
    end_at(executed, {PlannerStatus::kNotFound,
                      (cause.empty() ? "" : cause + "; what gave way is ") + symptom});
  }

  /// The rest of the plan is removed, and the robot comes to rest: where it is, or earlier.
  void end_at(int arrived, const PlannerAnswer& why) {
    const int executed = come_to_rest(arrived);
    measure_goal(executed);
    report_.status = why.status;
    report_.reason = "stopped at configuration " + std::to_string(executed) + ": " + why.reason +
                     "; after " + std::to_string(executed) + " of " +
                     std::to_string(planner_.plan_size() - 1) + " steps, " + goal_text() +
                     " from the goal";
    const Plan plan = planner_.plan();
    for (int i = executed + 1; i < planner_.plan_size(); ++i) graph_.remove_vertex(plan.slots[i]);
    report_.configurations = executed + 1;
    mark_incomplete(graph_);
  }

  void arrive() {
    const int last = planner_.plan_size() - 1;
    report_.short_of_goal_m = planner_.online_plan().behind_m(last);
    measure_goal(last);
    if (report_.goal_distance_m <= options_.goal_tolerance_m &&
        report_.goal_angle_rad <= options_.goal_tolerance_rad) {
      if (report_.goal_distance_m > limits::kGoal_m || report_.goal_angle_rad > limits::kGoal_rad) {
        mark_incomplete(graph_);
      }
      return;
    }
    report_.status = PlannerStatus::kNotFound;
    mark_incomplete(graph_);
    const bool blocked = report_.short_of_goal_m > options_.goal_tolerance_m;
    report_.reason = std::string(blocked ? "blocked" : "beside the goal") +
                     ": feasible, but it ends " + goal_text() + " from the goal of the plan";
    const std::string cause = cause_after(first_to_see_the_end());
    if (!cause.empty()) report_.reason += ", which meets " + cause;
  }

  Graph& graph_;
  const WalkOptions& options_;
  LocalPlanner planner_;
  const Robot& model_;
  const Motion planned_;
  std::vector<double> faster_;  // than careful, of slopes of the plan
  double pace_ = 1.0;           // how many times as long as planned steps take
  WalkReport report_;
};

}  // namespace

void WalkOptions::validate() const {
  planner.validate();
  check_option(goal_tolerance_m >= 0.0, "goal_tolerance_m", "0 or more");
  check_option(goal_tolerance_rad >= 0.0, "goal_tolerance_rad", "0 or more");
  check_option(cycle_deadline_s >= 0.0, "cycle_deadline_s", "0 (none) or more");
  termination.validate();
}

WalkReport walk_plan(Graph& graph, const WorldAt& world_at, const WalkOptions& options) {
  options.validate();
  return Walk(graph, options).run(world_at);
}

}  // namespace locograph
