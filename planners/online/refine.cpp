#include <locograph/planners/online/refine.h>

#include <sstream>

namespace locograph {
namespace {

std::string describe(const Graph& graph, const CycleReport& cycle) {
  std::ostringstream text;
  text << "stopped at configuration " << cycle.executed << ": " << cycle.violation.constraint
       << " violated by " << cycle.violation.worst << " " << cycle.violation.unit << " at vertex "
       << graph.vertex_record(cycle.violation.at_vertex).id;
  return text.str();
}

std::string describe(int executed, const CheckReport& check) {
  std::ostringstream text;
  text << "stopped at configuration " << executed << ":";
  for (const Violation& violation : check.violations) {
    if (!violation.violated) continue;
    text << " " << violation.constraint << " " << violation.worst << " " << violation.unit
         << " (limit " << violation.limit << ") on the way to the next";
    break;
  }
  return text.str();
}

/// The motion from one configuration of the plan to the next.
Motion step_of(const Graph& graph, const Plan& plan, int executed) {
  Plan step = plan;
  const auto i = static_cast<std::size_t>(executed);
  step.slots = {plan.slots[i], plan.slots[i + 1]};
  step.stance_from = {plan.stance_from[i], plan.stance_from[i + 1]};
  return motion_of(graph, step);
}

}  // namespace

RefineReport refine(Graph& graph, const WorldAt& world_at, const RefineOptions& options) {
  LocalPlanner planner(graph, options.planner);
  RefineReport report;
  report.dof = planner.dimension_of_configuration();
  report.success = true;
  report.reason = "every configuration is feasible";
  report.configurations = planner.plan_size();
  const auto stop = [&](int executed, const std::string& reason) {
    report.success = false;
    report.reason = reason;
    const Plan plan = planner.plan();
    for (int i = executed + 1; i < planner.plan_size(); ++i) graph.remove_vertex(plan.slots[i]);
    report.configurations = executed + 1;
  };
  for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
    const Stopwatch watch;
    if (const WorldDistance* world = world_at ? world_at(executed) : nullptr) planner.show(*world);
    report.map_update_s.push_back(watch.seconds());
    const CycleReport cycle = planner.cycle(executed);
    report.cycles.push_back(cycle);
    report.feasible_cycles += cycle.feasible ? 1 : 0;
    report.deadline_misses += cycle.deadline_missed ? 1 : 0;
    if (options.on_cycle) options.on_cycle(cycle);
    if (!cycle.next_feasible) {
      stop(executed, describe(graph, cycle));
      return report;
    }
    if (options.verify) {
      const Stopwatch verify_watch;
      const CheckReport check = options.verify(step_of(graph, planner.plan(), executed));
      report.verify_s.push_back(verify_watch.seconds());
      if (!check.feasible) {
        stop(executed, describe(executed, check));
        return report;
      }
    }
  }
  report.short_of_goal_m = planner.behind_m(planner.plan_size() - 1);
  if (report.short_of_goal_m > options.goal_tolerance_m) {
    report.success = false;
    std::ostringstream text;
    text << "blocked: feasible, but the goal of the plan is " << report.short_of_goal_m
         << " m ahead";
    report.reason = text.str();
  }
  return report;
}

}  // namespace locograph
