#include <locograph/planners/online/refine.h>
#include <locograph/planners/online/window_cause.h>

#include <algorithm>
#include <sstream>

namespace locograph {
namespace {

/// What the local planner could not mend.
std::string describe(const ConstraintViolation& violation, int vertex) {
  std::ostringstream text;
  text << constraint_name(violation.tag);
  if (!violation.label.name.empty()) text << " (" << violation.label.name << ")";
  text << " violated by " << violation.amount << (violation.label.unit.empty() ? "" : " ")
       << violation.label.unit << " at vertex " << vertex;
  return text.str();
}

/// What the judge refused.
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

/// The motion from one configuration of the plan to the next, and the step before it: only now is
/// it known how the robot accelerates between the two.
Motion step_of(const Graph& graph, const Plan& plan, int executed) {
  Plan step = plan;
  step.slots.clear();
  step.stance_from.clear();
  for (int i = std::max(0, executed - 1); i <= executed + 1; ++i) {
    step.slots.push_back(plan.slots[static_cast<std::size_t>(i)]);
    step.stance_from.push_back(plan.stance_from[static_cast<std::size_t>(i)]);
  }
  return motion_of(graph, step);
}

/// Walks along the plan and keeps the report.
class Walk {
 public:
  Walk(Graph& graph, const RefineOptions& options)
      : graph_(graph), options_(options), planner_(graph, options.planner) {
    report_.dof = planner_.dimension_of_configuration();
    report_.success = true;
    report_.reason = "every configuration is feasible";
    report_.configurations = planner_.plan_size();
  }

  RefineReport run(const WorldAt& world_at) {
    for (int executed = 0; executed + 1 < planner_.plan_size(); ++executed) {
      if (options_.stop != nullptr && *options_.stop) {
        end_at(executed, "interrupted");
        return std::move(report_);
      }
      if (!step(executed, world_at)) return std::move(report_);
    }
    arrive();
    return std::move(report_);
  }

 private:
  int last_of_window(int executed) const {
    return std::min(executed + options_.planner.horizon, planner_.plan_size() - 1);
  }

  bool step(int executed, const WorldAt& world_at) {
    const Stopwatch watch;
    if (const WorldDistance* world = world_at ? world_at(executed) : nullptr) planner_.show(*world);
    report_.map_update_s.push_back(watch.seconds());
    const CycleReport cycle = planner_.cycle(executed);
    report_.cycles.push_back(cycle);
    report_.feasible_cycles += cycle.feasible ? 1 : 0;
    report_.deadline_misses += cycle.deadline_missed ? 1 : 0;
    if (options_.on_cycle) options_.on_cycle(cycle);
    if (!cycle.next_feasible) {
      const int slot = planner_.plan().slots[static_cast<std::size_t>(cycle.violated_at)];
      stop(executed, describe(*cycle.violation, graph_.vertex_record(slot).id));
      return false;
    }
    if (!options_.verify) return true;
    const Stopwatch verify_watch;
    const CheckReport check = options_.verify(step_of(graph_, planner_.plan(), executed));
    report_.verify_s.push_back(verify_watch.seconds());
    if (!check.feasible) stop(executed, describe(check));
    return check.feasible;
  }

  void measure_goal(int at) {
    const int slot = planner_.plan().slots[static_cast<std::size_t>(at)];
    const Eigen::Map<const Eigen::VectorXd> is(graph_.state(slot), graph_.state_size(slot));
    const Eigen::VectorXd& goal = planner_.planned().back();
    report_.goal_distance_m = (is.head<3>() - goal.head<3>()).norm();
    report_.goal_angle_rad =
        Eigen::Quaterniond(is.data() + 3).angularDistance(Eigen::Quaterniond(goal.data() + 3));
  }

  std::string goal_text() const {
    std::ostringstream text;
    text << report_.goal_distance_m << " m and " << report_.goal_angle_rad << " rad";
    return text.str();
  }

  std::string cause_behind(int executed) {
    const auto cause =
        find_cause(graph_, planner_.plan(), planner_.planned(), executed, last_of_window(executed));
    return cause ? cause->text : "";
  }

  void stop(int executed, const std::string& symptom) {
    const std::string cause = cause_behind(executed);
    end_at(executed, (cause.empty() ? "" : cause + "; what gave way is ") + symptom);
  }

  /// The rest of the plan is removed.
  void end_at(int executed, const std::string& why) {
    measure_goal(executed);
    report_.success = false;
    report_.reason = "stopped at configuration " + std::to_string(executed) + ": " + why +
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
    report_.short_of_goal_m = planner_.behind_m(last);
    measure_goal(last);
    if (report_.goal_distance_m <= options_.goal_tolerance_m &&
        report_.goal_angle_rad <= options_.goal_tolerance_rad) {
      if (report_.goal_distance_m > limits::kGoal_m || report_.goal_angle_rad > limits::kGoal_rad) {
        mark_incomplete(graph_);
      }
      return;
    }
    report_.success = false;
    mark_incomplete(graph_);
    const bool blocked = report_.short_of_goal_m > options_.goal_tolerance_m;
    report_.reason = std::string(blocked ? "blocked" : "beside the goal") +
                     ": feasible, but it ends " + goal_text() + " from the goal of the plan";
    const std::string cause = cause_behind(std::max(0, last - options_.planner.horizon));
    if (!cause.empty()) report_.reason += ", which meets " + cause;
  }

  Graph& graph_;
  const RefineOptions& options_;
  LocalPlanner planner_;
  RefineReport report_;
};

void require_tolerance(double tolerance) {
  if (!(tolerance >= 0.0)) throw Error("the tolerance of the goal is negative", "0 or more");
}

}  // namespace

RefineReport refine(Graph& graph, const WorldAt& world_at, const RefineOptions& options) {
  require_tolerance(options.goal_tolerance_m);
  require_tolerance(options.goal_tolerance_rad);
  return Walk(graph, options).run(world_at);
}

}  // namespace locograph
