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
  PlannerAnswer answer = {};
  std::optional<Graph> graph = {};  ///< nothing: it ended before
  std::size_t configurations = 0;
  double duration_s = 0.0, whole_body_s = 0.0, judge_s = 0.0;
  std::vector<std::string> links_without_collision = {};
};

Planned plan_and_judge(const Scenario& scenario, const PlanOptions& options,
                       const JobControl& job) {
  Planned planned;
  Stopwatch watch;
  const auto task = std::make_shared<const Task>(task_of(scenario, job.termination.deadline));
  const DrivePlan drive = plan_wheeled_drive(*task, job);
  if (drive.success()) planned.graph = drive_graph(*task, drive.motion, job);
  planned.whole_body_s = watch.lap();
  planned.answer = planned.graph ? PlannerAnswer(drive) : end_by(job.termination).value();
  if (!planned.graph) return planned;
  const Motion& motion = drive.motion;
  planned.links_without_collision = task->robot->robot->links_without_collision();
  planned.configurations = motion.configurations.size();
  planned.duration_s = motion.time_s.back() - motion.time_s.front();
  Judging judging = judging_of(task);
  if (!options.torques.empty()) {
    judging.options.enforce_torque_limits = options.torques == "enforce";
  }
  const std::optional<CheckReport> report = judged(motion, judging, job);
  planned.judge_s = watch.lap();
  if (const auto end = end_by(job.termination)) {
    planned.answer = *end;
  } else if (!report->feasible) {
    planned.answer = {PlannerStatus::kNotFound, "refused: " + violation_text(report->worst())};
  }
  return planned;
}

}  // namespace

ExitCode plan_drive(const Scenario& scenario, const PlanOptions& options, const Stopwatch& total) {
  Planned planned;
  {
    Progress progress("planning " + options.scenario);
    JobControl job;
    job.termination.deadline = Deadline::of_limit(options.timeout_s);
    job.report = [&](std::string_view what, double fraction) {
      progress.show(fraction, [&] { return std::string(what); });
    };
    try {
      planned = plan_and_judge(scenario, options, job);
    } catch (const OutOfTime&) {
      planned = {.answer = end_by(job.termination).value()};
    }
  }
  if (planned.answer.success()) {
    const Progress progress("writing " + options.output);
    write_graph(*planned.graph, options.output);
  }
  const Json json = {
      {"success", planned.answer.success()},
      {"status", planner_status_name(planned.answer.status)},
      {"reason", planned.answer.reason},
      {"seed", options.seed},
      {"stances", 1},
      {"vertices_in_tree", 0},
      {"iterations", 0},
      {"configurations", planned.configurations},
      {"duration_s", planned.duration_s},
      {"segments", planned.answer.success() ? 1 : 0},
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
  } else if (planned.answer.success()) {
    print_text(
        scenario.name + ": " + counted(json["configurations"], "configuration", "configurations") +
        " in " + short_number(json["duration_s"]) + " s, planned in " +
        short_number(total.seconds()) + " s\n" + shapeless_text(planned.links_without_collision) +
        "written: " + options.output + '\n');
  } else {
    print_text(scenario.name + ": no plan: " + planned.answer.reason + '\n');
  }
  return planned.answer.success() ? kDone : kNo;
}

}  // namespace locograph
