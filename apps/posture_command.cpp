#include <locograph/apps/about_file.h>
#include <locograph/apps/check_json.h>
#include <locograph/apps/common_options.h>
#include <locograph/apps/output.h>
#include <locograph/apps/posture_command.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/robot_files.h>
#include <locograph/common/deadline.h>
#include <locograph/common/stop_signals.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/scenario/contacts_file.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string robot, srdf, contacts, map, obstacles, output, state, torques = "enforce";
  std::uint64_t seed = 0;
  int restarts = PostureOptions().max_restarts;
  double deadline_ms = 0.0;
  int threads = 1;
  bool json = false;
};

/// The group state asked for; else the one that robots stand in by its usual names, else neutral.
Eigen::VectorXd preferred_state(const Robot& robot, const std::string& asked) {
  if (!asked.empty()) return robot.named_configuration(asked);
  const std::vector<std::string> names = robot.configuration_names();
  for (const char* usual : {"home", "standing"}) {
    if (std::find(names.begin(), names.end(), usual) != names.end()) {
      return robot.named_configuration(usual);
    }
  }
  return robot.neutral_configuration();
}

Json numbers(const Eigen::VectorXd& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

Json contacts_json(const PostureProblem& problem, const CheckReport& report) {
  Json all = Json::array();
  for (std::size_t i = 0; i < problem.stance.contacts.size(); ++i) {
    const Contact& contact = problem.stance.contacts[i];
    Json json = {{"link", contact.effector.link},
                 {"kind", contact_kind_name(contact.effector.kind)},
                 {"position", numbers(contact.position)},
                 {"bears_load", contact.bears_load}};
    if (contact.bears_load && report.balance) {
      json["wrench"] = numbers(report.balance->wrenches[i]);
    }
    all.push_back(std::move(json));
  }
  return all;
}

Json result_json(const Robot& robot, const PostureProblem& problem, const PostureResult& result,
                 const CommandOptions& options, double load_s, double total_s) {
  Json joints = Json::object();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    joints[robot.active_joint(i).name] = result.configuration[robot.base_configuration_size() + i];
  }
  Json violations = Json::array();
  for (const Violation& v : result.report.violations) {
    violations.push_back(violation_json(v));
  }
  const CheckReport& report = result.report;
  return {{"success", result.success()},
          {"status", planner_status_name(result.status)},
          {"reason", result.reason},
          {"robot", robot.name()},
          {"seed", options.seed},
          {"base", numbers(result.configuration.head(robot.base_configuration_size()))},
          {"joints", joints},
          {"contacts", contacts_json(problem, report)},
          {"violations", violations},
          {"min_balance_margin", number_json(report.min_balance_margin)},
          {"max_torque_ratio", number_json(report.max_torque_ratio)},
          {"limiting", report.balance ? Json(report.balance->limiting) : Json(nullptr)},
          {"trusted", report.trusted},
          {"links_without_collision", robot.links_without_collision()},
          {"restarts", result.statistics.restarts},
          {"iterations", result.statistics.iterations},
          {"time",
           {{"load", load_s},
            {"build", result.statistics.build_s},
            {"optimise", result.statistics.optimise_s},
            {"geometry", result.statistics.geometry_s},
            {"balance", result.statistics.balance_s},
            {"solve", result.statistics.total_s},
            {"total", total_s}}}};
}

void print_summary(const Robot& robot, const PostureResult& result, const CommandOptions& options) {
  std::string text = robot.name() + ": ";
  if (!result.success()) {
    text += result.reason + " (" + counted(result.statistics.restarts, "restart", "restarts") +
            ", " + short_number(1e3 * result.statistics.total_s) + " ms)\n";
    print_text(text);
    return;
  }
  const BalanceCertificate& balance = result.report.balance.value();
  text += "posture found in " + short_number(1e3 * result.statistics.total_s) + " ms, " +
          counted(result.statistics.restarts, "restart", "restarts") + "; balance margin " +
          short_number(balance.margin) + " (" + balance.limiting + "), torques up to " +
          short_number(100.0 * result.report.max_torque_ratio.value_or(0.0)) +
          " % of their limits\n" + shapeless_text(robot.links_without_collision());
  if (!options.output.empty()) text += "written: " + options.output + '\n';
  print_text(text);
}

ExitCode posture(const CommandOptions& options) {
  const std::vector<std::filesystem::path> given = {options.contacts, options.map,
                                                    options.obstacles};
  if (!options.output.empty()) check_output(options.output, given, options.json);
  const Stopwatch total;
  std::optional<Progress> progress("finding a posture of " + options.robot);
  const RobotFiles files = robot_files(options.robot, options.srdf);
  if (!options.output.empty()) check_not_input(options.output, {files.urdf, files.srdf});
  const auto robot = std::make_shared<const RobotParameter>(
      files.urdf, files.srdf, RobotOptions{.active_joints = {}, .lenient_srdf = true});
  PostureProblem problem;
  problem.stance = load_contacts(options.contacts, *robot->robot);
  problem.file = options.contacts;
  PostureOptions solving;
  for (const Contact& contact : problem.stance.contacts) {
    solving.check.known.push_back(contact.effector);
  }
  const PostureSolver solver = about_file(files.urdf.string(), [&] {
    return PostureSolver(robot, posture_world(load_world(options.map, options.obstacles)),
                         {.map = options.map, .obstacles = options.obstacles});
  });
  const Robot& model = solver.robot();
  const Eigen::VectorXd state =
      about_file(files.srdf.string(), [&] { return preferred_state(model, options.state); });
  problem.preferred = placed_at(model, state, problem.stance);
  const double load_s = total.seconds();

  solving.seed = options.seed;
  solving.max_restarts = options.restarts;
  solving.enforce_torque_limits = solving.check.enforce_torque_limits =
      options.torques == "enforce";
  solving.termination.deadline = Deadline::of_limit(1e-3 * options.deadline_ms);
  solving.termination.stop = &stop_flag();
  const FinishOnSignal finish;
  const PostureResult result =
      about_file(files.urdf.string(), [&] { return solver.solve(problem, solving); });
  if (result.success() && !options.output.empty()) {
    write_graph(solver.graph(problem, result, solving), options.output);
  }
  progress.reset();
  if (options.json) {
    print_result(result_json(model, problem, result, options, load_s, total.seconds()), true);
  } else {
    print_summary(model, result, options);
  }
  return result.success() ? kDone : kNo;
}

}  // namespace

Command add_posture(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser = app.add_subcommand(
      "posture", "Find a balanced, collision-free configuration for given contacts");
  parser.add_option("ROBOT", o.robot, "URDF file, or a name that `locograph list robots` gives")
      .required();
  parser.add_option("--contacts", o.contacts, "File of the contacts (.xml), see doc/posture.md")
      .required();
  parser.add_option("--srdf", o.srdf, "SRDF file instead of the one beside the URDF");
  parser.add_option("--state", o.state,
                    "Group state of the SRDF to stay near (home, else standing, else neutral)");
  parser.add_option("--map", o.map, "OctoMap of what is around");
  parser.add_option("--obstacles", o.obstacles, "Obstacle file (.xml); may go with --map");
  parser.add_option("-o,--output", o.output, "Graph file to write (.g2o); - is standard output");
  parser.add_option("--seed", o.seed, "Of the restarts").show_default();
  parser.add_option("--restarts", o.restarts, "Most restarts").not_negative().show_default();
  parser.add_option("--deadline-ms", o.deadline_ms, "Time to find it in; 0: no limit")
      .not_negative();
  add_torque_limits_option(parser, o.torques,
                           "enforce: torques keep to the URDF's efforts; report: only tell them")
      .show_default();
  add_threads_option(parser, o.threads);
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return posture(*options); }};
}

}  // namespace locograph
