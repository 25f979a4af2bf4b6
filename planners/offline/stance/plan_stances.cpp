#include <locograph/planners/offline/stance/judged_path.h>
#include <locograph/planners/offline/stance/plan_stances.h>
#include <locograph/planners/offline/stance/stance_tree.h>

namespace locograph {
namespace {

/// Ways to a goal that the judge refused.
struct RefusedWays {
  int count = 0;
  std::string last_violation = {};
};

/// Why no posture was found in the goal's stance; empty: one was.
std::string why_none_stands(StanceSpace& space, const Stance& goal, const Eigen::VectorXd& from) {
  constexpr int kAttempts = 2;
  std::string reason;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const StanceSpace::Attempt found = space.stand(goal, from, attempt);
    if (found.found) return "";
    if (reason.empty()) reason = found.reason;
  }
  return reason;
}

std::string why_not_reached(const StancePlan& plan, const StanceSpace& space,
                            const RefusedWays& refused, std::size_t goals,
                            const std::string& none_stands) {
  std::string reason = goals > 1 ? "goal " + std::to_string(plan.goals_reached + 1) + " of " +
                                       std::to_string(goals) + " is not reached"
                                 : "the goal is not reached";
  if (space.ended()) {
    reason += space.stopped() ? ": interrupted" : ": the time allowed is used up";
  } else if (space.tried_enough()) {
    reason += ": the transitions allowed are used up";
  }
  if (!none_stands.empty()) {
    reason += "; no posture was found that holds the goal's contacts: " + none_stands;
  }
  if (refused.count > 0) {
    reason += "; refused: " + std::to_string(refused.count) +
              (refused.count == 1 ? " way to it: " : " ways to it, the last one: ") +
              refused.last_violation;
  }
  if (plan.failures.empty()) return reason;
  const StanceFailure& most = plan.failures.front();
  return reason + "; most often in the way: " + most.what + ", for " + most.end_effector + " (" +
         std::to_string(most.count) + " of " +
         std::to_string(plan.transitions - plan.transitions_found) + " transitions)";
}

/// See StancePlannerOptions::accept; the change is forbidden.
std::size_t not_accepted(StanceSpace& space, const StancePlannerOptions& options, StancePath& path,
                         std::size_t first) {
  if (!options.accept) return 0;
  std::vector<Stance> stances;
  for (const Footing& footing : path.footings) stances.push_back(space.stance(footing));
  const std::size_t refused = options.accept(stances, path.configurations, first);
  if (refused > 0) space.forbid(path.footings.at(refused - 1), path.footings[refused]);
  return refused;
}

}  // namespace

void note_best(StancePlan& plan, const StanceSpace& space, const Footing& footing,
               const Footing& goal) {
  int reached = 0;
  for (std::size_t e = 0; e < footing.size(); ++e) {
    if (goal[e] != kFree && footing[e] == goal[e]) ++reached;
  }
  if (reached <= plan.best_contacts) return;
  plan.best_contacts = reached;
  plan.best = space.stance(footing);
}

StancePlan plan_stances(const StanceProblem& problem, const StancePlannerOptions& options,
                        const MakeSearch& make_search) {
  options.validate();
  const Robot& robot = *problem.robot->robot;
  require_sound_stance(robot, problem.start);
  for (const Stance& goal : problem.goals) require_sound_stance(robot, goal);
  const Stopwatch watch;
  StancePlan plan;
  StanceSpace space(problem, options);
  const Judge judge(problem.robot->robot, problem.world);
  const ReachGoal reach = make_search(space, options, plan);
  StancePath path;
  path.append(space.footing(problem.start), problem.start_configuration);
  plan.success = true;
  RefusedWays refused;
  for (std::size_t g = 0; g < problem.goals.size() && plan.success; ++g) {
    const Footing goal = space.footing(problem.goals[g]);
    const std::size_t first = path.changes(), first_node = plan.tree.size();
    plan.best_contacts = 0;
    plan.best = {};
    refused = {};
    space.begin_goal();
    StancePath tried = path;
    for (;;) {
      tried.footings.resize(first + 1);
      tried.configurations.resize(first + 1);
      if (!reach(goal, tried)) {
        plan.success = false;
        break;
      }
      shorten(space, tried, first);
      const Stopwatch judging;
      const JudgedPath judged = judge_path(space, judge, tried);
      plan.judge_s += judging.seconds();
      plan.report = judged.report;
      std::size_t refused_change = judged.refused;
      if (judged.report.feasible) {
        refused_change = not_accepted(space, options, tried, first);
        if (refused_change == 0) break;
      }
      forget_way(plan, first_node);
      if (refused_change == 0) {
        plan.success = false;
        plan.reason = "refused: " + violation_text(judged.report.worst());
        break;
      }
      ++refused.count;
      refused.last_violation = judged.report.feasible ? "no motion for one of its stances"
                                                      : violation_text(judged.report.worst());
    }
    if (!plan.success) break;
    path = std::move(tried);
    ++plan.goals_reached;
  }
  plan.failures = space.failures();
  plan.transitions = space.transitions;
  plan.transitions_found = space.transitions_found;
  plan.transitions_s = space.transitions_s;
  for (const Footing& footing : path.footings) plan.stances.push_back(space.stance(footing));
  plan.configurations = path.configurations;
  if (plan.success) {
    plan.reason = "planned";
  } else if (plan.reason.empty()) {
    const Stance& goal = problem.goals[static_cast<std::size_t>(plan.goals_reached)];
    plan.reason = why_not_reached(plan, space, refused, problem.goals.size(),
                                  why_none_stands(space, goal, path.configurations.back()));
  }
  plan.total_s = watch.seconds();
  return plan;
}

}  // namespace locograph
