#include <locograph/apps/output.h>
#include <locograph/apps/plan_scenario.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/robot_files.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/plan/judging.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace locograph {
namespace {

/// What became of a scenario.
struct Planned {
  std::optional<Graph> graph;  ///< nothing: out of time
  std::size_t configurations = 0;
  double duration_s = 0.0, whole_body_s = 0.0, judge_s = 0.0;
  bool success = false;
  std::string reason = "the time allowed is used up";
  std::vector<std::string> links_without_collision;
};

Planned plan_and_judge(const Scenario& scenario, const PlanOptions& options,
                       const JobControl& job) {
  Planned planned;
  Stopwatch watch;
  const auto task = std::make_shared<const Task>(task_of(scenario, job.deadline));
  const std::optional<Motion> motion = plan_wheeled_drive(*task, job);
  if (motion) planned.graph = drive_graph(*task, *motion, job);
  planned.whole_body_s = watch.lap();
  if (!planned.graph) return planned;
  planned.links_without_collision = task->robot->robot->links_without_collision();
  planned.configurations = motion->configurations.size();
  planned.duration_s = motion->time_s.back() - motion->time_s.front();
  Judging judging = judging_of(task);
  if (!options.torques.empty()) {
    judging.options.enforce_torque_limits = options.torques == "enforce";
  }
  const std::optional<CheckReport> report = judged(*motion, judging, job);
  planned.judge_s = watch.lap();
  if (!report || job.deadline.passed()) return planned;
  planned.success = report->feasible;
  planned.reason = report->feasible ? "planned" : "refused: " + violation_text(report->worst());
  return planned;
}

}  // namespace

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
      {"segments", planned.success ? 1 : 0},
      {"links_without_collision", planned.links_without_collision},
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
    print_text(
        scenario.name + ": " + counted(json["configurations"], "configuration", "configurations") +
        " in " + short_number(json["duration_s"]) + " s, planned in " +
        short_number(total.seconds()) + " s\n" + shapeless_text(planned.links_without_collision) +
        "written: " + options.output + '\n');
  } else {
    print_text(scenario.name + ": no plan: " + planned.reason + '\n');
  }
  return planned.success ? kDone : kNo;
}

}  // namespace locograph
