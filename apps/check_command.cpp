#include <locograph/apps/check_command.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/common/deadline.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string input, map, obstacles;
  double clearance_m = 0.0;
  std::vector<std::string> plugins;
  int threads = 1;
  bool json = false;
};

/// Vertices are named by their id in the file.
int id_of(const PlanFile& file, int at_vertex) {
  return file.graph.vertex_record(file.plan.slots.at(at_vertex)).id;
}

Json violations_json(const PlanFile& file, const CheckReport& report) {
  Json all = Json::array();
  for (const Violation& v : report.violations) {
    all.push_back({{"constraint", v.constraint},
                   {"violated", v.violated},
                   {"worst", v.worst},
                   {"unit", v.unit},
                   {"limit", v.limit},
                   {"at_vertex", id_of(file, v.at_vertex)},
                   {"count", v.count},
                   {"time", v.time_s},
                   {"at_point", {v.at_point.x(), v.at_point.y(), v.at_point.z()}},
                   {"what", v.what}});
  }
  return all;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

void print_summary(const PlanFile& file, const CheckReport& report) {
  std::string text = file.name + ": " + (report.feasible ? "feasible" : "NOT feasible") + ", " +
                     counted(report.configurations, "configuration", "configurations") + '\n';
  for (const Violation& v : report.violations) {
    if (!v.violated) continue;
    text += "violated: " + v.constraint + ", worst " + short_number(v.worst) + " " + v.unit +
            " (limit " + short_number(v.limit) + ") at vertex " +
            std::to_string(id_of(file, v.at_vertex)) + ", " +
            counted(v.count, "vertex", "vertices") + (v.what.empty() ? "" : ": " + v.what) + '\n';
  }
  text += "clearance " + short_number(report.min_clearance_m) + " m, to itself " +
          short_number(report.min_self_clearance_m) + " m, velocities up to " +
          short_number(100.0 * report.max_velocity_ratio) + " % of their limits, contacts within " +
          short_number(report.max_contact_error_m) + " m\n";
  if (report.min_balance_margin) {
    text += "balanced with a margin of " + short_number(*report.min_balance_margin) + '\n';
  }
  if (report.max_torque_ratio) {
    text += "torques up to " + short_number(100.0 * *report.max_torque_ratio) +
            " % of their limits hold the robot\n";
  }
  print_text(text);
}

ExitCode check(const CommandOptions& options) {
  const Stopwatch total;
  const PlanFile file = load_plan(options.input, options.plugins);
  const LoadedWorld world = load_world(world_of(file, options.map, options.obstacles));
  CheckOptions limits;
  limits.min_clearance_m = options.clearance_m;
  const CheckReport report = check_plan(file, world, limits);
  if (!options.json) {
    print_summary(file, report);
    return report.feasible ? kDone : kNo;
  }
  print_result({{"feasible", report.feasible},
                {"configurations", report.configurations},
                {"violations", violations_json(file, report)},
                {"min_clearance_m", report.min_clearance_m},
                {"min_self_clearance_m", report.min_self_clearance_m},
                {"min_balance_margin", or_null(report.min_balance_margin)},
                {"max_torque_ratio", or_null(report.max_torque_ratio)},
                {"max_velocity_ratio", report.max_velocity_ratio},
                {"max_contact_error_m", report.max_contact_error_m},
                {"time", {{"total", total.seconds()}}}},
               true);
  return report.feasible ? kDone : kNo;
}

}  // namespace

Command add_check(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("check", "Check a plan's feasibility, at every vertex and in between");
  parser.add_option("PLAN", o.input, "Plan file (.g2o)").required();
  parser.add_option("--map", o.map, "OctoMap to check against instead of the plan's own world");
  parser.add_option("--obstacles", o.obstacles, "Obstacle file (.xml); may go with --map");
  parser.add_option("--clearance", o.clearance_m, "Distance to keep to obstacles [m]")
      .between(0.0, 0.5)
      .show_default();
  parser.add_option("--threads", o.threads, "Most threads to use (this version uses one)")
      .positive()
      .show_default();
  add_plugin_option(parser, o.plugins);
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return check(*options); }};
}

}  // namespace locograph
