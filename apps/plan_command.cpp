#include <locograph/apps/common_options.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_command.h>
#include <locograph/apps/plan_scenario.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/suggestion.h>
#include <locograph/planners/offline/motion/segment_planners.h>
#include <locograph/planners/offline/stance/stance_planners.h>

#include <memory>
#include <string>

namespace locograph {
namespace {

ExitCode plan_scenario(const PlanOptions& options) {
  if (options.improve && !(options.stances_only && options.timeout_s > 0.0)) {
    throw Error("--improve goes on until the time is used up", "--stances-only and --timeout");
  }
  if (options.stances_only && !options.segment_planners.empty()) {
    throw Error("--segment-planner has no segments to plan", "it without --stances-only");
  }
  for (const std::string& file : {options.output, options.tree}) {
    if (!file.empty()) check_output(file, {}, options.json);
  }
  const Stopwatch total;
  Scenario scenario = load_scenario(options.scenario, data_folder());
  scenario.margin = scenario.margin.scaled(options.margin_factor);
  for (const std::string& file : {options.output, options.tree}) {
    if (!file.empty()) check_not_input(file, files_of(scenario));
  }
  if (scenario.drive) {
    const auto refuse = [&](const std::string& what, const std::string& option) {
      throw Error(scenario.source, scenario.drive->line, "a drive has no " + what,
                  "a scenario with <start> and <goal>, or no " + option);
    };
    if (options.stances_only) refuse("stances to plan", "--stances-only");
    if (options.move_contacts_m > 0.0) refuse("contacts to move", "--move-contacts");
    if (options.max_transitions != StancePlannerOptions().max_transitions) {
      refuse("stances to change", "--max-transitions");
    }
    if (!options.tree.empty()) refuse("search for stances to show", "--tree");
    if (!options.segment_planners.empty()) refuse("segments between stances", "--segment-planner");
    return plan_drive(scenario, options, total);
  }
  return plan_contact_task(scenario, options);
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
  parser
      .add_option("--segment-planner", o.segment_planners,
                  "Of the motion within a stance, the first to be tried first (all): " +
                      joined_names(segment_planner_names()))
      .one_of(segment_planner_names())
      .value_name("NAME")
      .one_at_a_time();
  parser.add_option("--seed", o.seed, "Of everything random (a drive has nothing random)")
      .show_default();
  parser
      .add_option("--timeout", o.timeout_s,
                  "Seconds that planning may take, judging included; 0: no limit")
      .not_negative();
  parser
      .add_option("--max-transitions", o.max_transitions,
                  "Changes of stance that may be tried for each goal; 0: no limit")
      .not_negative()
      .show_default();
  add_torque_limits_option(parser, o.torques,
                           "enforce: the plan keeps to the URDF's efforts; report: only tell them "
                           "(without it, what the scenario says)");
  add_execution_margin_option(parser, o.margin_factor,
                              "Of the scenario's execution margin: 1: as it is, 0: none");
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
