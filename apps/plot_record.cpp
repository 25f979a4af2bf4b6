#include <locograph/apps/about_file.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plot_series.h>
#include <locograph/planners/plan/record.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace locograph {
namespace {

/// Of each active joint; of wheels and the like none.
std::vector<Series> joint_errors(const Robot& robot, const TrackingErrors& errors) {
  std::vector<Series> all;
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    const Joint& joint = robot.active_joint(j);
    if (joint.type == JointType::kContinuous) continue;
    std::vector<double> values;
    for (const Eigen::VectorXd& moment : errors.joints) values.push_back(1e3 * moment[j]);
    all.push_back(series_of(joint.name, std::move(values)));
  }
  return all;
}

std::vector<double> thousandfold(std::vector<double> values) {
  for (double& value : values) value *= 1e3;
  return values;
}

}  // namespace

PlotScript plot_record(const PlanFile& file) {
  const Robot& robot = *file.plan.robot->robot;
  const Record record = about_file(file.name, [&] { return record_of(file.graph, file.plan); });
  const Motion& motion = record.motion;
  if (motion.configurations.size() < 2) {
    throw Error(file.name, 0, "one moment is no record to draw", "two or more");
  }
  require_increasing_times(file);
  const TrackingErrors errors = tracking_errors(robot, record);
  const bool base = robot.floating_base();
  const int panels = base ? 4 : 3;
  PlotScript plot(1000, 340 * panels + 40);
  plot.line("set multiplot layout " + std::to_string(panels) + ",1 title " +
            PlotScript::label(std::filesystem::path(file.name).filename().string() + ": " +
                              robot.name() + ", what was measured, the largest in colour"));
  plot.line("set rmargin 26");
  plot.line("set lmargin 10");
  plot.line("set key outside right top invert font ',11'");
  plot.line("set xlabel 'time [s]'");
  plot.line("set xrange [" + short_number(motion.time_s.front()) + ":" +
            short_number(motion.time_s.back()) + "]");
  mark_stance_changes(plot, motion);
  if (base) {
    add_panel(plot, "base, off from the plan (lower is better)", "error [mm], [mrad]", "base",
              motion.time_s,
              {series_of("position, mm", thousandfold(errors.base_m)),
               series_of("rotation, mrad", thousandfold(errors.base_rad))},
              1e-3);
  }
  add_panel(plot, "joints, off from the plan (lower is better)", "|error| [mrad], [mm]", "joint",
            motion.time_s, joint_errors(robot, errors), 1e-3);
  add_panel(plot, "contact forces that were measured", "|force| / weight", "force", motion.time_s,
            force_shares(robot, motion), 1e-6);
  limit_line(plot, 1, 1.0);
  add_panel(plot, "joint torques (1 at the effort; lower is better)", "|torque| / effort", "torque",
            motion.time_s, torque_shares(robot, record.torques), 1.0);
  plot.line("unset multiplot");
  return plot;
}

}  // namespace locograph
