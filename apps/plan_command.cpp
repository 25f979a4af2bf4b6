#include <locograph/apps/data_folder.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_command.h>
#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/plan/judging.h>

#include <memory>
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

ExitCode plan_scenario(const PlanOptions& options) {
  check_writable(options.output);
  const Stopwatch total;
  const Scenario scenario = load_scenario(options.scenario, data_folder());
  Stopwatch watch;
  Graph graph = plan_wheeled_drive(scenario);
  const double whole_body_s = watch.seconds();
  const Plan plan = plan_of(graph);
  const Motion motion = motion_of(graph, plan);
  watch.lap();
  Judging judging = judging_of(graph, plan, {.data_folder = data_folder()});
  if (!options.torques.empty()) {
    judging.options.enforce_torque_limits = options.torques == "enforce";
  }
  const CheckReport report = judged(graph, plan, judging);
  const double judge_s = watch.lap();
  const bool in_time = options.timeout_s <= 0.0 || total.seconds() <= options.timeout_s;
  const bool success = in_time && report.feasible;
  const std::string reason = !report.feasible ? "refused: " + violation_text(report.worst())
                             : !in_time       ? "the time allowed is used up"
                                              : "planned";
  if (success) write_graph(graph, options.output);
  const Json json = {
      {"success", success},
      {"reason", reason},
      {"seed", options.seed},
      {"stances", 1},
      {"vertices_in_tree", 0},
      {"iterations", 0},
      {"configurations", motion.configurations.size()},
      {"duration_s", motion.time_s.back() - motion.time_s.front()},
      {"time",
       {{"stance_planner", 0.0},
        {"transitions", 0.0},
        {"whole_body", whole_body_s},
        {"timing", 0.0},
        {"judge", judge_s},
        {"total", total.seconds()}}},
  };
  if (options.json) {
    print_result(json, true);
  } else if (success) {
    print_text(scenario.name + ": " +
               counted(json["configurations"], "configuration", "configurations") + " in " +
               short_number(json["duration_s"]) + " s, planned in " +
               short_number(total.seconds()) + " s\nwritten: " + options.output + '\n');
  } else {
    print_text(scenario.name + ": no plan: " + reason + '\n');
  }
  return success ? kDone : kNo;
}

}  // namespace

Command add_plan(OptionParser& app) {
  const auto options = std::make_shared<PlanOptions>();
  PlanOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("plan", "Plan a scenario offline and emit the plan's graph");
  parser.add_option("SCENARIO", o.scenario, "File, or a name that `locograph list scenarios` gives")
      .required();
  parser.add_option("-o,--output", o.output, "Plan file to write (.g2o)").required();
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
