#include <locograph/apps/margin_json.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_scenario.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/robot_files.h>
#include <locograph/apps/stance_tree_file.h>
#include <locograph/apps/statistics.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/stop_signals.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/motion/segment_planners.h>
#include <locograph/planners/offline/stance/given_margins.h>
#include <locograph/planners/offline/stance/improve_stances.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/started_task.h>
#include <locograph/planners/offline/stance/unheld_goal.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

/// What became of a contact task.
struct ContactTaskPlan {
  /// Without a motion where only stances are asked for; success and reason are those of the whole.
  MotionPlan motion;
  std::optional<Graph> graph;  ///< nothing: the time was used up before the search began
  StartedTask started;
  std::optional<UnheldGoal> unheld;
  int improved = 0;
  double total_s = 0.0;

  const StancePlan& stances() const { return motion.stances; }
  std::vector<std::string> links_without_collision() const {
    const auto& robot = started.task.robot;  // null when the time was used up before
    return robot ? robot->robot->links_without_collision() : std::vector<std::string>();
  }
  std::vector<std::string> unknown_names() const {
    const auto& robot = started.task.robot;  // as above
    return robot ? robot->robot->warnings() : std::vector<std::string>();
  }
};

StancePlannerOptions stance_options(const PlanOptions& options) {
  StancePlannerOptions asked;
  asked.seed = options.seed;
  asked.max_transitions = options.max_transitions;
  asked.keep_tree = !options.tree.empty();
  asked.threads = std::min(options.threads, processor_count());
  asked.termination.deadline = Deadline::of_limit(options.timeout_s);
  return asked;
}

StartedTask asked_task(const Scenario& scenario, const PlanOptions& options,
                       const Deadline& deadline) {
  StartedTask started =
      started_task(scenario, {.most_m = options.move_contacts_m, .seed = options.seed}, deadline);
  if (!options.torques.empty()) {
    started.task.check.enforce_torque_limits = options.torques == "enforce";
  }
  return started;
}

void plan_stances_only(const PlanOptions& options, const StancePlannerOptions& asked,
                       ContactTaskPlan& plan) {
  const Task& task = plan.started.task;
  const auto planner = make_stance_planner(options.planner);
  StancePlan& stances = plan.motion.stances;
  stances = planner->plan(task, asked);
  if (options.improve) {
    plan.improved = improve_stances(*planner, task, asked, asked.threads, stances);
  }
  plan.motion.status = stances.status;
  plan.motion.reason = stances.reason;
  plan.graph = stance_graph(task, stances);
}

void plan_whole_motion(const PlanOptions& options, const StancePlannerOptions& asked,
                       ContactTaskPlan& plan) {
  const Task& task = plan.started.task;
  plan.motion = plan_motion(
      task, asked,
      {.stance_planner = options.planner, .segment_planners = options.segment_planners});
  plan.graph = motion_graph(task, plan.motion);
}

/// Transitions that are worth while towards a goal that no posture holds, for the part of the way
/// that there is: where it is the only one, and where others come before it.
constexpr int kTowardsUnheld = 250, kTowardsUnheldAfterOthers = 5000;

constexpr const char* kHeldButNotFound =
    "a way was not found, which proves nothing: postures that hold the goals exist";

/// finish: from when on there is something to keep when it is asked to stop.
ContactTaskPlan plan_of_task(const Scenario& scenario, const PlanOptions& options,
                             std::optional<FinishOnSignal>& finish) {
  const Stopwatch total;
  ContactTaskPlan plan;
  std::optional<Progress> progress("preparing " + options.scenario);
  StancePlannerOptions asked = stance_options(options);
  try {
    plan.started = asked_task(scenario, options, asked.termination.deadline);
  } catch (const OutOfTime&) {
    const PlannerAnswer end = end_by(asked.termination).value();
    plan.motion.status = end.status;
    plan.motion.reason = "before the search began, " + end.reason;
    plan.total_s = total.seconds();
    return plan;
  }
  finish.emplace();
  asked.termination.stop = &stop_flag();
  progress.emplace("planning " + options.scenario);
  plan.unheld = unheld_goal(plan.started.task, asked.termination.deadline);
  const bool goals_hold = !plan.unheld && !asked.termination.deadline.passed();
  if (plan.unheld) {
    if (plan.unheld->goal > 0)
      print_warning(plan.unheld->text + "; the way up to there is planned");
    const int worth_while = plan.unheld->goal == 0 ? kTowardsUnheld : kTowardsUnheldAfterOthers;
    asked.max_transitions =
        asked.max_transitions > 0 ? std::min(asked.max_transitions, worth_while) : worth_while;
  }
  if (options.stances_only) {
    plan_stances_only(options, asked, plan);
  } else {
    plan_whole_motion(options, asked, plan);
  }
  if (!plan.motion.success() && (plan.unheld || goals_hold)) {
    for (std::string* reason : {&plan.motion.reason, &plan.motion.stances.reason}) {
      *reason += "; " + (plan.unheld ? plan.unheld->text : kHeldButNotFound);
    }
  }
  plan.total_s = total.seconds();
  return plan;
}

Json failures_json(const StancePlan& plan) {
  Json all = Json::array();
  for (const StanceFailure& failure : plan.failures) {
    all.push_back(
        {{"end_effector", failure.end_effector}, {"what", failure.what}, {"count", failure.count}});
  }
  return all;
}

/// What start and goals have of the margin.
Json given_json(const Task& task, const StancePlan& plan) {
  Json all = Json::array();
  for (const GivenMargin& given : given_margins(task, plan)) {
    all.push_back({{"at", given.where},
                   {"share", given.share},
                   {"friction", given.margin.friction},
                   {"area", given.margin.area},
                   {"least_force", given.margin.least_force}});
  }
  return all;
}

/// Of each segment planner how many it solved, and the seconds that these took.
Json by_planner_json(const std::vector<SegmentRecord>& segments) {
  Json all = Json::object();
  for (const std::string& name : segment_planner_names()) {
    int count = 0;
    double seconds = 0.0;
    for (const SegmentRecord& segment : segments) {
      if (segment.planner != name) continue;
      ++count;
      seconds += segment.path_s;
    }
    all[name] = {{"count", count}, {"seconds", seconds}};
  }
  return all;
}

/// Length of the path of a segment to that of the straight one.
Json path_ratio_json(const std::vector<SegmentRecord>& segments) {
  std::vector<double> ratios;
  for (const SegmentRecord& segment : segments) {
    if (segment.straight > 0.0) ratios.push_back(segment.length / segment.straight);
  }
  if (ratios.empty()) return {{"median", nullptr}, {"worst", nullptr}};
  std::sort(ratios.begin(), ratios.end());
  return {{"median", percentile(ratios, 0.5)}, {"worst", ratios.back()}};
}

/// How far what swings gets from all else.
Json swing_clearance_json(const std::vector<SegmentRecord>& segments) {
  std::vector<double> clear_m;
  for (const SegmentRecord& segment : segments) {
    if (segment.clear_m) clear_m.push_back(*segment.clear_m);
  }
  if (clear_m.empty()) return {{"median_m", nullptr}, {"worst_m", nullptr}};
  std::sort(clear_m.begin(), clear_m.end());
  return {{"median_m", percentile(clear_m, 0.5)}, {"worst_m", clear_m.front()}};
}

double duration_s(const Motion& motion) {
  return motion.time_s.empty() ? 0.0 : motion.time_s.back() - motion.time_s.front();
}

/// The parts of a whole plan do not overlap: the stance planner waits while its way is moved along.
Json time_json(const PlanOptions& options, const ContactTaskPlan& plan) {
  const MotionStatistics& motion = plan.motion.statistics;
  const StanceStatistics& stances = plan.stances().statistics;
  double stances_s = stances.total_s, judge_s = stances.judge_s;
  if (!options.stances_only) {
    judge_s += motion.judge_s;
    stances_s = std::max(0.0, stances_s - motion.path_s - motion.timing_s - judge_s);
  }
  return {{"stance_planner", stances_s},
          {"transitions", stances.transitions_s},
          {"whole_body", motion.path_s},
          {"timing", motion.timing_s},
          {"judge", judge_s},
          {"total", plan.total_s}};
}

Json answer_json(const PlanOptions& options, const ContactTaskPlan& plan) {
  const MotionPlan& motion = plan.motion;
  const StancePlan& stances = plan.stances();
  const StanceStatistics& statistics = stances.statistics;
  const StartedTask& started = plan.started;
  Json json = {
      {"success", motion.success()},
      {"status", planner_status_name(motion.status)},
      {"reason", motion.reason},
      {"seed", options.seed},
      {"planner", options.planner},
      {"stances", stances.stances.size()},
      {"vertices_in_tree", statistics.vertices_in_tree},
      {"iterations", statistics.iterations},
      {"configurations",
       options.stances_only ? stances.configurations.size() : motion.motion.configurations.size()},
      {"duration_s", duration_s(motion.motion)},
      {"segments", std::ranges::count_if(motion.segments,
                                         [](const auto& one) { return one.planner != kDwell; })},
      {"goals_reached", stances.goals_reached},
      {"transitions", {{"tried", statistics.transitions}, {"found", statistics.transitions_found}}},
      {"start_moved", {{"base_m", started.moved_base_m}, {"joint_rad", started.moved_joint_rad}}},
      {"failures", failures_json(stances)},
      {"links_without_collision", plan.links_without_collision()},
      {"names_unknown_to_the_urdf", plan.unknown_names()},
      {"off_skin", off_skin_json(started.task.off_skin)},
      {"time", time_json(options, plan)},
  };
  if (!options.stances_only) {
    json["segments_by_planner"] = by_planner_json(motion.segments);
    json["path_ratio"] = path_ratio_json(motion.segments);
    json["swing_clearance"] = swing_clearance_json(motion.segments);
    json["refused_segments"] = motion.statistics.refused_segments;
  }
  json["execution_margin"] = margin_json(started.task.margin);
  json["execution_margin"]["given"] = given_json(started.task, stances);
  if (options.improve) json["improved"] = plan.improved;
  if (options.move_contacts_m > 0.0) {
    json["moved_contacts"] = {{"up_to_m", options.move_contacts_m},
                              {"start_draws", started.task.moves.draws}};
  }
  if (plan.unheld && !plan.unheld->contact.empty()) {
    const Eigen::Vector3d& by = plan.unheld->move_m;
    json["move"] = {{"contact", plan.unheld->contact},
                    {"by_m", {by.x(), by.y(), by.z()}},
                    {"touches", plan.unheld->touches}};
  }
  if (!motion.success()) {
    json["best"] = {{"stances", stances.stances.size()},
                    {"goal_contacts_reached", stances.best_contacts}};
  }
  return json;
}

/// ": 7 by interpolation, 2 by rrt_connect", longer than straight by so much.
std::string segments_text(const Json& json) {
  std::string text = counted(json["segments"], "segment", "segments"), separator = ": ";
  for (const auto& [name, by] : json["segments_by_planner"].items()) {
    if (by["count"] == 0) continue;
    text += separator + std::to_string(by["count"].get<int>()) + " by " + name;
    separator = ", ";
  }
  const Json& worst = json["path_ratio"]["worst"];
  if (!worst.is_null()) {
    text += "; at worst " + short_number(worst) + " times as long as straight";
  }
  return text + '\n';
}

std::string answer_text(const std::string& scenario, const PlanOptions& options,
                        const ContactTaskPlan& plan, const Json& json) {
  std::string text = scenario + ": ";
  if (options.move_contacts_m > 0.0) {
    text += "contacts of start and goals are moved by up to " +
            short_number(options.move_contacts_m) + " m\n" + scenario + ": ";
  }
  const StartedTask& started = plan.started;
  if (started.moved_base_m > 0.0 || started.moved_joint_rad > 0.0) {
    text += "the start is not feasible as given; the nearest is " +
            short_number(started.moved_base_m) + " m and " + short_number(started.moved_joint_rad) +
            " rad away\n" + scenario + ": ";
  }
  text += plan.motion.success() ? "" : "no plan: " + plan.motion.reason + "; so far ";
  text += counted(json["stances"], "stance", "stances") + ", " +
          counted(json["transitions"]["tried"], "transition", "transitions") + " tried, ";
  if (!options.stances_only) {
    text += counted(json["configurations"], "configuration", "configurations") + " of " +
            short_number(json["duration_s"]) + " s, ";
  }
  text += "in " + short_number(plan.total_s) + " s\n";
  if (!options.stances_only && plan.graph) text += segments_text(json);
  for (const std::string& unknown : plan.unknown_names()) text += unknown + '\n';
  for (const SkinFrame& off : started.task.off_skin) {
    if (off.matters()) text += skin_text(off) + '\n';
  }
  text += margin_text(started.task.margin);
  for (const Json& given : json["execution_margin"]["given"]) {
    if (given["share"] == 1.0) continue;
    text += "at the " + given["at"].get<std::string>() + " only: friction " +
            short_number(given["friction"]) + ", areas " + short_number(given["area"]) +
            ", each contact pressed by " + short_number(given["least_force"]) + " of the weight\n";
  }
  text += shapeless_text(plan.links_without_collision());
  if (plan.graph) text += "written: " + options.output + '\n';
  if (options.improve) text += "improved " + counted(plan.improved, "time", "times") + '\n';
  if (plan.graph && !options.tree.empty()) text += "written: " + options.tree + '\n';
  return text;
}

}  // namespace

ExitCode plan_contact_task(const Scenario& scenario, const PlanOptions& options) {
  std::optional<FinishOnSignal> finish;
  const ContactTaskPlan plan = plan_of_task(scenario, options, finish);
  if (plan.graph) write_graph(*plan.graph, options.output);
  if (plan.graph && !options.tree.empty()) {
    write_file_atomically(options.tree, stance_tree_text(scenario.name, options.planner,
                                                         options.seed, plan.stances()));
  }
  const Json json = answer_json(options, plan);
  if (options.json) {
    print_result(json, true);
  } else {
    print_text(answer_text(scenario.name, options, plan, json));
  }
  return plan.motion.success() ? kDone : kNo;
}

}  // namespace locograph
