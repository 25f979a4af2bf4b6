#include <locograph/apps/check_command.h>
#include <locograph/apps/check_json.h>
#include <locograph/apps/common_options.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/record_json.h>
#include <locograph/common/deadline.h>
#include <locograph/common/ranges.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

constexpr double kNotGiven = -std::numeric_limits<double>::infinity();

struct CommandOptions {
  std::string input, torques;
  WorldOptions world;
  double clearance_m = 0.0, until_s = kNotGiven;
  std::vector<std::string> plugins;
  int threads = 1;
  bool robustness = false, all = false, json = false;
};

/// "scenario: standing_up; it begins at the start, and reaches 1 of 1 goal", a line
std::string task_text(const Judging& judging, const CheckReport& report) {
  std::string text = "scenario: " + (judging.task ? judging.task->scenario : "none");
  if (!report.ends) return text + '\n';
  const PlanEnds& ends = *report.ends;
  text += ends.starts() ? "; it begins at the start"
                        : "; it does not begin at the start (" + ends.off_start + ")";
  return text + ", and reaches " + std::to_string(ends.goals_reached) + " of " +
         counted(ends.goals, "goal", "goals") + '\n';
}

/// What was measured is not judged by rules for plans.
ExitCode tell_record(const PlanFile& file, bool as_json) {
  const Json record = record_json(file);
  if (as_json) {
    print_result({{"recorded", true},
                  {"feasible", nullptr},
                  {"configurations", file.plan.slots.size()},
                  {"record", record}},
                 true);
  } else {
    const std::string plan =
        record["plan"].is_null() ? "a plan" : "the plan " + record["plan"].get<std::string>();
    print_text(
        file.name + ": NOT judged: the record of " + plan + " carried out, " +
        counted(static_cast<long>(file.plan.slots.size()), "configuration", "configurations") +
        "\n");
  }
  return kNo;
}

ExitCode check(const CommandOptions& options) {
  const Stopwatch total;
  std::optional<Progress> progress("reading " + options.input);
  const PlanFile file = load_plan(options.input, options.plugins);
  if (file.plan.recorded) {
    progress.reset();
    return tell_record(file, options.json);
  }
  progress.emplace("checking " + options.input);
  Judging judging = judging_of(file, options.world);
  judging.options.min_clearance_m = options.clearance_m;
  if (!options.torques.empty()) {
    judging.options.enforce_torque_limits = options.torques == "enforce";
  }
  if (options.until_s != kNotGiven) judging.options.until_s = options.until_s;
  judging.options.robustness = options.robustness;
  judging.options.threads = options.threads;
  const CheckReport report = check_plan(file, judging);
  progress.reset();
  // Vertices are named by their id in the file.
  const VertexIds ids = [&](int vertex) {
    return file.graph.vertex_record(file.plan.slots.at(static_cast<std::size_t>(vertex))).id;
  };
  if (options.json) {
    Json json = check_json(report, ids);
    json["scenario"] = judging.task ? Json(judging.task->scenario) : Json(nullptr);
    if (judging.moves.most_m > 0.0) {
      json["moved_contacts"] = {{"up_to_m", judging.moves.most_m},
                                {"seed", judging.moves.seed},
                                {"start_draws", judging.moves.draws}};
    }
    json["stances_only"] = file.plan.stances_only;
    json["says_stances_only"] = file.plan.says_stances_only;
    json["incomplete"] = file.plan.incomplete;
    json["time"] = {{"total", total.seconds()}};
    print_result(json, true);
  } else {
    const bool is_motion_after_all = file.plan.says_stances_only && !file.plan.stances_only;
    print_text(file.name + ": " + (report.feasible ? "feasible" : "NOT feasible") + ", " +
               counted(report.configurations, "configuration", "configurations") +
               (file.plan.stances_only ? " of a plan of stances" : "") +
               (is_motion_after_all ? ", judged as a motion: it says stances_only, but its times "
                                      "are not 0, 1, 2, …, it has segments, or a step does not "
                                      "change one contact"
                                    : "") +
               (file.plan.incomplete ? ", the first part of an incomplete plan" : "") + '\n' +
               task_text(judging, report) + check_text(report, ids, options.all));
  }
  return report.feasible ? kDone : kNo;
}

}  // namespace

Command add_check(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("check", "Check a plan's feasibility, at every vertex and in between");
  parser.add_option("PLAN", o.input, "Plan file (.g2o); - reads standard input").required();
  parser.add_option(
      "--scenario", o.world.scenario,
      "Scenario to judge in instead of the plan's own: its world, friction, limits, task");
  add_world_options(parser, o.world);
  parser
      .add_option(
          "--clearance", o.clearance_m,
          "Distance to keep to obstacles, and to surfaces, boxes and bars where a link does "
          "not touch them [m]")
      .between(0.0, 0.5)
      .show_default();
  add_torque_limits_option(parser, o.torques,
                           "enforce: torques keep to the URDF's efforts; report: only tell them "
                           "(without it, what the scenario says, else enforce)");
  parser
      .add_option("--until", o.until_s,
                  "Time [s] until which the robot stands on where the plan ends")
      .between(0.0, ranges::kTime_s);
  add_threads_option(parser, o.threads);
  add_plugin_option(parser, o.plugins);
  parser.add_flag("--robustness", o.robustness,
                  "Tell by what friction, contact areas and torques may shrink, how hard the robot "
                  "may be pushed, and what may be loaded on it, until it holds no longer");
  parser.add_flag("--all", o.all, "List every constraint, also those that hold, and every stance");
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return check(*options); }};
}

}  // namespace locograph
