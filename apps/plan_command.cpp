#include <locograph/apps/common_options.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_command.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/stance_tree_file.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/deadline.h>
#include <locograph/common/stop_signals.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/offline/stance/improve_stances.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/offline/stance/stance_problem.h>
#include <locograph/planners/plan/judging.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace locograph {
namespace {

int cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

struct PlanOptions {
  std::string scenario, output, tree, torques, planner = "guided";
  bool stances_only = false, improve = false;
  unsigned seed = 0;
  double timeout_s = 0.0;
  double move_contacts_m = 0.0;
  int threads = cores();
  bool json = false;
};

/// What became of a scenario.
struct Planned {
  std::optional<Graph> graph;  ///< nothing: out of time
  std::size_t configurations = 0;
  double duration_s = 0.0, whole_body_s = 0.0, judge_s = 0.0;
  bool success = false;
  std::string reason = "the time allowed is used up";
};

Planned plan_and_judge(const Scenario& scenario, const PlanOptions& options,
                       const JobControl& job) {
  Planned planned;
  Stopwatch watch;
  planned.graph = plan_wheeled_drive(scenario, job);
  planned.whole_body_s = watch.lap();
  if (!planned.graph) return planned;
  const Plan plan = plan_of(*planned.graph);
  const Motion motion = motion_of(*planned.graph, plan);
  planned.configurations = motion.configurations.size();
  planned.duration_s = motion.time_s.back() - motion.time_s.front();
  Judging judging =
      judging_of(*planned.graph, plan, {.deadline = job.deadline, .data_folder = data_folder()});
  if (!options.torques.empty()) {
    judging.options.enforce_torque_limits = options.torques == "enforce";
  }
  const std::optional<CheckReport> report = judged(motion, judging, job);
  planned.judge_s = watch.lap();
  if (!report || job.deadline.passed()) return planned;
  planned.success = report->feasible;
  planned.reason = report->feasible ? "planned" : "refused: " + violation_text(report->worst());
  return planned;
}

ExitCode plan_drive(const Scenario& scenario, const PlanOptions& options, const Stopwatch& total) {
  Planned planned;
  {
    Progress progress("planning " + options.scenario);
    JobControl job;
    if (options.timeout_s > 0.0) job.deadline = Deadline::after(options.timeout_s);
    job.report = [&](std::string_view what, double fraction) {
      progress.show(fraction, [&] { return std::string(what); });
    };
    try {
      planned = plan_and_judge(scenario, options, job);
    } catch (const OutOfTime&) {
      planned = {};
    }
  }
  if (planned.success) {
    const Progress progress("writing " + options.output);
    write_graph(*planned.graph, options.output);
  }
  const Json json = {
      {"success", planned.success},
      {"reason", planned.reason},
      {"seed", options.seed},
      {"stances", 1},
      {"vertices_in_tree", 0},
      {"iterations", 0},
      {"configurations", planned.configurations},
      {"duration_s", planned.duration_s},
      {"time",
       {{"stance_planner", 0.0},
        {"transitions", 0.0},
        {"whole_body", planned.whole_body_s},
        {"timing", 0.0},
        {"judge", planned.judge_s},
        {"total", total.seconds()}}},
  };
  if (options.json) {
    print_result(json, true);
  } else if (planned.success) {
    print_text(scenario.name + ": " +
               counted(json["configurations"], "configuration", "configurations") + " in " +
               short_number(json["duration_s"]) + " s, planned in " +
               short_number(total.seconds()) + " s\nwritten: " + options.output + '\n');
  } else {
    print_text(scenario.name + ": no plan: " + planned.reason + '\n');
  }
  return planned.success ? kDone : kNo;
}

Json failures_json(const StancePlan& plan) {
  Json all = Json::array();
  for (const StanceFailure& failure : plan.failures) {
    all.push_back(
        {{"end_effector", failure.end_effector}, {"what", failure.what}, {"count", failure.count}});
  }
  return all;
}

/// Without a robot, and with the reason in the plan, if it is not ready in time.
StartedProblem started_problem(const Scenario& scenario, const PlanOptions& options,
                               const Deadline& deadline, StancePlan& plan) {
  StartedProblem started;
  try {
    started = stance_problem(scenario, {.most_m = options.move_contacts_m, .seed = options.seed},
                             deadline);
  } catch (const OutOfTime& late) {
    plan.reason = std::string("before the search began, ") + late.what();
    return {};
  }
  if (!options.torques.empty()) {
    started.problem.check.enforce_torque_limits = options.torques == "enforce";
  }
  return started;
}

ExitCode plan_stances_of(const Scenario& scenario, const PlanOptions& options) {
  const auto planner = make_stance_planner(options.planner);
  const Stopwatch total;
  StancePlannerOptions asked;
  asked.seed = options.seed;
  asked.keep_tree = !options.tree.empty();
  asked.threads = std::min(options.threads, cores());
  if (options.timeout_s > 0.0) asked.deadline = Deadline::after(options.timeout_s);
  StancePlan plan;
  int improved = 0;
  Graph graph;
  double total_s = 0.0;
  std::optional<Progress> progress("preparing " + options.scenario);
  const StartedProblem started = started_problem(scenario, options, asked.deadline, plan);
  const StanceProblem& problem = started.problem;
  const bool prepared = problem.robot != nullptr;
  std::optional<FinishOnSignal> finish;
  if (prepared) {
    finish.emplace();
    asked.stop = &stop_flag();
    progress.emplace("planning " + options.scenario);
    plan = planner->plan(problem, asked);
    if (options.improve) {
      improved = improve_stances(*planner, problem, asked, asked.threads, plan);
    }
    graph = stance_graph(scenario, problem, plan);
  }
  total_s = total.seconds();
  progress.reset();
  if (prepared) write_graph(graph, options.output);
  if (prepared && asked.keep_tree) {
    write_file_atomically(options.tree,
                          stance_tree_text(scenario.name, planner->name(), options.seed, plan));
  }
  Json json = {
      {"success", plan.success},
      {"reason", plan.reason},
      {"seed", options.seed},
      {"planner", planner->name()},
      {"stances", plan.stances.size()},
      {"vertices_in_tree", plan.vertices_in_tree},
      {"iterations", plan.iterations},
      {"configurations", plan.configurations.size()},
      {"duration_s", 0.0},
      {"segments", 0},
      {"goals_reached", plan.goals_reached},
      {"transitions", {{"tried", plan.transitions}, {"found", plan.transitions_found}}},
      {"start_moved", {{"base_m", started.moved_base_m}, {"joint_rad", started.moved_joint_rad}}},
      {"failures", failures_json(plan)},
      {"time",
       {{"stance_planner", plan.total_s},
        {"transitions", plan.transitions_s},
        {"whole_body", 0.0},
        {"timing", 0.0},
        {"judge", plan.judge_s},
        {"total", total_s}}},
  };
  if (options.improve) json["improved"] = improved;
  if (options.move_contacts_m > 0.0) {
    json["moved_contacts"] = {{"up_to_m", options.move_contacts_m},
                              {"start_draws", problem.moves.draws}};
  }
  if (!plan.success) {
    json["best"] = {{"stances", plan.stances.size()},
                    {"goal_contacts_reached", plan.best_contacts}};
  }
  if (options.json) {
    print_result(json, true);
    return plan.success ? kDone : kNo;
  }
  std::string text = scenario.name + ": ";
  if (options.move_contacts_m > 0.0) {
    text += "contacts of start and goals are moved by up to " +
            short_number(options.move_contacts_m) + " m\n" + scenario.name + ": ";
  }
  if (started.moved_base_m > 0.0 || started.moved_joint_rad > 0.0) {
    text += "the start is not feasible as given; the nearest is " +
            short_number(started.moved_base_m) + " m and " + short_number(started.moved_joint_rad) +
            " rad away\n" + scenario.name + ": ";
  }
  text += plan.success ? "" : "no plan: " + plan.reason + "; so far ";
  text += counted(json["stances"], "stance", "stances") + ", " +
          counted(json["transitions"]["tried"], "transition", "transitions") + " tried, in " +
          short_number(total_s) + " s\n";
  if (prepared) text += "written: " + options.output + '\n';
  if (options.improve) text += "improved " + counted(improved, "time", "times") + '\n';
  if (prepared && asked.keep_tree) text += "written: " + options.tree + '\n';
  print_text(text);
  return plan.success ? kDone : kNo;
}

ExitCode plan_scenario(const PlanOptions& options) {
  if (!options.tree.empty() && !options.stances_only) {
    throw Error("--tree has no search for stances to show", "--stances-only");
  }
  if (options.improve && !(options.stances_only && options.timeout_s > 0.0)) {
    throw Error("--improve goes on until the time is used up", "--stances-only and --timeout");
  }
  for (const std::string& file : {options.output, options.tree}) {
    if (!file.empty()) check_output(file, {}, options.json);
  }
  const Stopwatch total;
  const Scenario scenario = load_scenario(options.scenario, data_folder());
  for (const std::string& file : {options.output, options.tree}) {
    if (!file.empty()) check_not_input(file, files_of(scenario));
  }
  if (scenario.drive) {
    if (options.stances_only) {
      throw Error(scenario.source, scenario.drive->line, "a drive has no stances to plan",
                  "a scenario with <start> and <goal>, or no --stances-only");
    }
    if (options.move_contacts_m > 0.0) {
      throw Error(scenario.source, scenario.drive->line, "a drive has no contacts to move",
                  "a scenario with <start> and <goal>, or no --move-contacts");
    }
    return plan_drive(scenario, options, total);
  }
  if (!options.stances_only) {
    throw Error(scenario.source, scenario.contacts->start_line,
                "the motion between stances is not planned in this version", "--stances-only");
  }
  return plan_stances_of(scenario, options);
}

}  // namespace

Command add_plan(OptionParser& app) {
  const auto options = std::make_shared<PlanOptions>();
  PlanOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("plan", "Plan a scenario offline and emit the plan's graph");
  add_scenario_argument(parser, o.scenario);
  parser.add_option("-o,--output", o.output, "Plan file to write (.g2o); - is standard output")
      .required();
  parser.add_flag("--stances-only", o.stances_only,
                  "Stances and the configurations between them, no motion");
  parser.add_flag("--improve", o.improve,
                  "Plan again with other seeds until --timeout and keep the plan with the fewest "
                  "stances, on --threads threads");
  parser.add_option("--tree", o.tree,
                    "File to write what the search for stances tried (.json), for `view --tree`");
  parser
      .add_option("--planner", o.planner, "Of stances; `locograph list planners` gives their names")
      .one_of(stance_planner_names())
      .show_default();
  parser.add_option("--seed", o.seed, "Of everything random (a drive has nothing random)")
      .show_default();
  parser.add_option("--timeout", o.timeout_s, "Seconds the planner may take; 0: no limit")
      .not_negative();
  add_torque_limits_option(parser, o.torques,
                           "enforce: the plan keeps to the URDF's efforts; report: only tell them "
                           "(without it, what the scenario says)");
  parser
      .add_option("--move-contacts", o.move_contacts_m,
                  "Another task of the kind: each contact of start and goals is moved on its "
                  "surface or bar at random, by the seed, up to so far along each axis [m]")
      .between(0.0, ContactMoves::kFurthest_m)
      .show_default();
  parser
      .add_option("--threads", o.threads,
                  "Most threads to use (all cores); without --improve and --timeout the plan does "
                  "not depend on it")
      .positive();
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return plan_scenario(*options); }};
}

}  // namespace locograph
