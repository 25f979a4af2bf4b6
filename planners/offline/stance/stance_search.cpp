#include <locograph/planners/offline/stance/judged_path.h>
#include <locograph/planners/offline/stance/stance_search.h>
#include <locograph/planners/offline/stance/stance_tree.h>

#include <utility>

namespace locograph {
namespace {

const Task& require_sound(const Task& task, const StancePlannerOptions& options) {
  options.validate();
  const Robot& robot = *task.robot->robot;
  require_sound_stance(robot, task.start);
  for (const Stance& goal : task.goals) require_sound_stance(robot, goal);
  return task;
}

}  // namespace

StanceSearch::StanceSearch(const Task& task, const StancePlannerOptions& options)
    : task_(require_sound(task, options)),
      options_(options),
      space_(task_, options_),
      judge_(task.robot->robot, task.world) {
  taken_.append(space_.footing(task.start), task.start_configuration);
  if (!task.goals.empty()) begin_goal();
}

void StanceSearch::begin_goal() {
  next_goal_ = space_.footing(task_.goals[static_cast<std::size_t>(result_.goals_reached)]);
  first_node_ = result_.tree.size();
  result_.best_contacts = 0;
  result_.best = {};
  refused_ = 0;
  space_.begin_goal();
  candidate_ = taken_;
}

bool StanceSearch::next() {
  const std::size_t first = taken_.changes();
  while (!over_ && static_cast<std::size_t>(result_.goals_reached) < task_.goals.size()) {
    candidate_.footings.resize(first + 1);
    candidate_.configurations.resize(first + 1);
    over_ = !reach(next_goal_, candidate_);
    if (over_) break;
    if (const std::size_t slips = roll_on(space_, candidate_, first + 1); slips > 0) {
      refuse(slips, "a ball does not roll to where it is held");
      continue;
    }
    shorten(space_, candidate_, first);
    const Stopwatch judging;
    const JudgedPath judged = judge_path(space_, judge_, candidate_);
    result_.statistics.judge_s += judging.seconds();
    result_.report = judged.report;
    if (judged.report.feasible) return true;
    const std::string violation = violation_text(judged.report.worst());
    count_refused(violation);
    if (judged.refused == 0) {
      over_ = true;
      result_.reason = "refused: " + violation;
    }
  }
  return false;
}

void StanceSearch::take() {
  taken_ = std::move(candidate_);
  ++result_.goals_reached;
  if (static_cast<std::size_t>(result_.goals_reached) < task_.goals.size()) begin_goal();
}

void StanceSearch::refuse(std::size_t change, const std::string& reason) {
  space_.forbid(candidate_.footings.at(change - 1), candidate_.footings.at(change));
  count_refused(reason);
}

void StanceSearch::replace(std::vector<Eigen::VectorXd> configurations) {
  candidate_.configurations = std::move(configurations);
}

void StanceSearch::count_refused(const std::string& reason) {
  forget_way(result_, first_node_);
  ++refused_;
  last_refusal_ = reason;
}

void StanceSearch::note_best(const Footing& footing, const Footing& goal) {
  int reached = 0;
  for (std::size_t e = 0; e < footing.size(); ++e) {
    if (goal[e] != kFree && footing[e] == goal[e]) ++reached;
  }
  if (reached <= result_.best_contacts) return;
  result_.best_contacts = reached;
  result_.best = space_.stance(footing);
}

StancePlan StanceSearch::result() {
  StancePlan plan = result_;
  plan.failures = space_.failures();
  plan.statistics.iterations = space_.iterations;
  plan.statistics.transitions = space_.transitions;
  plan.statistics.transitions_found = space_.transitions_found;
  plan.statistics.transitions_s = space_.transitions_s;
  for (const Footing& footing : taken_.footings) plan.stances.push_back(space_.stance(footing));
  plan.configurations = taken_.configurations;
  if (static_cast<std::size_t>(plan.goals_reached) == task_.goals.size()) {
    plan.status = PlannerStatus::kSolved;
    plan.reason = "planned";
  } else if (plan.reason.empty()) {
    explain(plan);
  }
  plan.statistics.total_s = watch_.seconds();
  return plan;
}

void StanceSearch::explain(StancePlan& plan) {
  const std::size_t goals = task_.goals.size();
  std::string& reason = plan.reason;
  reason = goals > 1 ? "goal " + std::to_string(plan.goals_reached + 1) + " of " +
                           std::to_string(goals) + " is not reached"
                     : "the goal is not reached";
  if (const auto end = end_by(options_.termination, space_.iterations)) {
    plan.status = end->status;
    reason += ": " + end->reason;
  } else if (space_.tried_enough()) {
    reason += ": the transitions allowed are used up (allow more)";
  }
  if (refused_ > 0) {
    reason += "; refused: " + std::to_string(refused_) +
              (refused_ == 1 ? " way to it: " : " ways to it, the last one: ") + last_refusal_;
  }
  if (plan.failures.empty()) return;
  const StanceFailure& most = plan.failures.front();
  const int failed = plan.statistics.transitions - plan.statistics.transitions_found;
  reason += "; most often in the way: " + most.what + ", for " + most.end_effector + " (" +
            std::to_string(most.count) + " of " + std::to_string(failed) + " transitions)";
}

}  // namespace locograph
