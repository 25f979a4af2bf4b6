#include <locograph/apps/output.h>
#include <locograph/apps/plan_command.h>
#include <locograph/apps/progress.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/plan/judging.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

namespace locograph {
namespace {

struct PlanOptions {
  std::string scenario, output, torques;
  unsigned seed = 0;
  double timeout_s = 0.0;
  int threads = 1;
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
  Judging judging = judging_of(*planned.graph, plan, {.data_folder = data_folder()});
  if (!options.torques.empty()) {
    judging.options.enforce_torque_limits = options.torques == "enforce";
  }
  const std::optional<CheckReport> report = judged(motion, plan, judging, job);
  planned.judge_s = watch.lap();
  if (!report || job.deadline.passed()) return planned;
  planned.success = report->feasible;
  planned.reason = report->feasible ? "planned" : "refused: " + violation_text(report->worst());
  return planned;
}

ExitCode plan_scenario(const PlanOptions& options) {
  check_output(options.output, options.json);
  const Stopwatch total;
  const Scenario scenario = load_scenario(options.scenario, data_folder());
  Planned planned;
  {
    Progress progress("planning " + options.scenario);
    JobControl job;
    if (options.timeout_s > 0.0) job.deadline = Deadline::after(options.timeout_s);
    job.report = [&](std::string_view what, double fraction) {
      progress.show(fraction, [&] { return std::string(what); });
    };
    planned = plan_and_judge(scenario, options, job);
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

}  // namespace

Command add_plan(OptionParser& app) {
  const auto options = std::make_shared<PlanOptions>();
  PlanOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("plan", "Plan a scenario offline and emit the plan's graph");
  parser.add_option("SCENARIO", o.scenario, "File, or a name that `locograph list scenarios` gives")
      .required();
  parser.add_option("-o,--output", o.output, "Plan file to write (.g2o); - is standard output")
      .required();
  parser.add_option("--seed", o.seed, "Of everything random (a drive has nothing random)")
      .show_default();
  parser.add_option("--timeout", o.timeout_s, "Seconds the planner may take; 0: no limit")
      .not_negative();
  parser
      .add_option("--torque-limits", o.torques,
                  "enforce: the plan keeps to the URDF's efforts; report: only tell them (without "
                  "it, what the scenario says)")
      .one_of({"enforce", "report"});
  parser.add_option("--threads", o.threads, "Most threads to use (this version uses one)")
      .positive()
      .show_default();
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return plan_scenario(*options); }};
}

}  // namespace locograph
