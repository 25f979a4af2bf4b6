#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/plot.h>
#include <locograph/apps/plot_margins.h>
#include <locograph/apps/plot_series.h>
#include <locograph/check/motion_curve.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace locograph {
namespace {

/// Where the joints stand between their limits: −1 at the lower, 1 at the upper one.
std::vector<Series> positions(const Robot& robot, const Motion& motion) {
  std::vector<Series> all;
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    const Joint& joint = robot.active_joint(j);
    if (!std::isfinite(joint.lower) || !(joint.upper > joint.lower)) continue;
    Series series{joint.name, {}};
    for (const Eigen::VectorXd& q : motion.configurations) {
      const double value = q[robot.base_configuration_size() + j];
      series.values.push_back((2.0 * value - joint.lower - joint.upper) /
                              (joint.upper - joint.lower));
      series.peak = std::max(series.peak, std::abs(series.values.back()));
    }
    all.push_back(std::move(series));
  }
  return all;
}

/// |velocity| over its limit.
std::vector<Series> velocities(const MotionCurve& curve) {
  const Robot& robot = curve.robot();
  std::vector<Series> all;
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    const Joint& joint = robot.active_joint(j);
    if (!std::isfinite(joint.max_velocity) || joint.max_velocity <= 0.0) continue;
    Series series{joint.name, {}};
    for (int i = 0; i < static_cast<int>(curve.motion().configurations.size()); ++i) {
      const double velocity = curve.slope(i)[robot.base_tangent_size() + j];
      series.values.push_back(std::abs(velocity) / joint.max_velocity);
      series.peak = std::max(series.peak, series.values.back());
    }
    all.push_back(std::move(series));
  }
  return all;
}

/// |jerk| of each step's cubic, and what accelerations jump by at the vertex that begins it, over
/// the step's time: shown where it starts. The robot stands still before.
std::vector<Series> jerks(const MotionCurve& curve) {
  const Robot& robot = curve.robot();
  std::vector<Series> all;
  for (int j = 0; j < robot.active_joint_count(); ++j)
    all.push_back({robot.active_joint(j).name, {}});
  Eigen::VectorXd before = Eigen::VectorXd::Zero(robot.active_joint_count());
  for (int i = 0; i + 1 < static_cast<int>(curve.motion().configurations.size()); ++i) {
    const CurveStep step = curve.step(i);
    const double h = step.duration_s();
    for (int j = 0; j < robot.active_joint_count() && h > 0.0; ++j) {
      const Eigen::Vector3d cubic = step.cubic(robot.base_tangent_size() + j);
      const double begin = 2.0 * cubic[1] / (h * h), end = begin + 6.0 * cubic[2] / (h * h);
      Series& series = all[static_cast<std::size_t>(j)];
      series.values.push_back((std::abs(end - begin) + std::abs(begin - before[j])) / h);
      series.peak = std::max(series.peak, series.values.back());
      before[j] = end;
    }
  }
  return all;
}

void add_base_path(PlotScript& plot, const Motion& motion) {
  std::string rows;
  Eigen::AlignedBox2d box;
  for (const Eigen::VectorXd& q : motion.configurations) {
    box.extend(Eigen::Vector2d(q[0], q[1]));
    rows += short_number(q[0]) + ' ' + short_number(q[1]) + '\n';
  }
  const double room = 0.15 + 0.05 * box.diagonal().norm();
  plot.data("path", rows);
  plot.line("set title 'base path, seen from above' noenhanced");
  plot.line("set xlabel 'x [m]'");
  plot.line("set ylabel 'y [m]'");
  plot.line("set size ratio -1");
  plot.line("set xrange [" + short_number(box.min().x() - room) + ":" +
            short_number(box.max().x() + room) + "]");
  plot.line("set yrange [" + short_number(box.min().y() - room) + ":" +
            short_number(box.max().y() + room) + "]");
  plot.line(
      "plot $path with linespoints linewidth 1.6 pointtype 7 pointsize 0.35 linecolor "
      "'#2f6fb5' notitle, $path every ::0::0 with points pointtype 7 pointsize 1 linecolor "
      "'#3a9a5b' title 'start'");
}

/// None, and a warning, where nobody can say what is in the way: its scenario is gone.
PlanMargins margins_if_judged(const PlanFile& plan, const Motion& motion) {
  try {
    return margins_along(motion, judging_of(plan, {}));
  } catch (const Error& error) {
    print_warning(std::string("without distances and balance: ") + error.what());
    return {};
  }
}

void add_margins(PlotScript& plot, const std::string& title, const std::string& ylabel,
                 const std::string& prefix, const std::vector<double>& time_s,
                 const std::vector<Series>& series) {
  plot.line("set title '" + title + "'");
  plot.line("set ylabel '" + ylabel + "'");
  add_lines(plot, prefix, time_s, series);
}

}  // namespace

PlotScript plot_plan(const std::filesystem::path& file, const std::vector<std::string>& plugins) {
  const PlanFile plan = load_plan(file.string(), plugins);
  if (plan.plan.recorded) return plot_record(plan);
  const Robot& robot = *plan.plan.robot->robot;
  const Motion motion = motion_of(plan.graph, plan.plan);
  if (motion.configurations.size() < 2) {
    throw Error(file.string(), 0, "one configuration is no motion", "two or more");
  }
  require_increasing_times(plan);
  const bool base = robot.floating_base(), moves = !motion.stances_only;
  const std::vector<Series> bears = force_shares(robot, motion);
  const std::vector<Series> torques = torque_shares(robot, torques_along(robot, motion));
  const PlanMargins margins = margins_if_judged(plan, motion);
  const auto some = [](const std::vector<Series>& series) { return series.empty() ? 0 : 1; };
  const int panels = 1 + (moves ? 2 : 0) + some(bears) + some(torques) + some(margins.distances) +
                     some(margins.balance) + (base ? 1 : 0);
  PlotScript plot(1000, 340 * panels + (base ? 0 : 40));
  plot.line("set multiplot layout " + std::to_string(panels) + ",1 title " +
            PlotScript::label(file.filename().string() + ": " + robot.name() +
                              ", joints nearest to their limits in colour"));
  plot.line("set rmargin 26");
  plot.line("set lmargin 10");
  plot.line("set key outside right top invert font ',11'");
  plot.line(moves ? "set xlabel 'time [s]'" : "set xlabel 'stance'");
  plot.line("set xrange [" + short_number(motion.time_s.front()) + ":" +
            short_number(motion.time_s.back()) + "]");
  plot.line("set title 'joint positions (-1 lower limit, 1 upper limit; far from both is better)'");
  plot.line("set ylabel 'position'");
  plot.line("set yrange [-1.1:1.1]");
  const std::vector<int> changes = mark_stance_changes(plot, motion);
  limit_line(plot, 1, -1.0);
  limit_line(plot, 2, 1.0);
  add_lines(plot, "position", motion.time_s, positions(robot, motion));
  plot.line("unset arrow 1");
  if (moves) {
    const MotionCurve curve(robot, motion);
    const std::vector<Series> speeds = velocities(curve), jerky = jerks(curve);
    plot.line("set title 'joint velocities (1 at the limit; lower is better)'");
    plot.line("set ylabel '|velocity| / limit'");
    plot.line("set yrange [0:" + short_number(1.1 * highest(speeds, 1.0)) + "]");
    add_lines(plot, "velocity", motion.time_s, speeds);
    plot.line("unset arrow 2");
    plot.line("set title 'joint jerk (not limited; lower is smoother)'");
    plot.line("set ylabel '|jerk| [rad/s^3]'");
    plot.line("set yrange [0:" + short_number(1.1 * highest(jerky, 1e-6)) + "]");
    add_lines(plot, "jerk", motion.time_s, jerky);
  }
  plot.line("unset arrow 2");
  if (!bears.empty()) {
    add_panel(plot, "contact forces that the plan states", "|force| / weight", "force",
              motion.time_s, bears, 1e-6);
  }
  if (!torques.empty()) {
    limit_line(plot, 1, 1.0);
    add_panel(plot, "joint torques under these forces (1 at the effort; lower is better)",
              "|torque| / effort", "torque", motion.time_s, torques, 1.0);
    plot.line("unset arrow 1");
  }
  if (!margins.distances.empty()) {
    plot.line("set yrange [*<0:55]");
    add_margins(plot, "distances (to 50 mm; higher is better)", "distance [mm]", "distance",
                margins.time_s, margins.distances);
  }
  if (!margins.balance.empty()) {
    plot.line("set yrange [*<0:1.05]");
    add_margins(plot, "static balance: what is left of all limits (higher is better)", "margin",
                "balance", margins.time_s, margins.balance);
  }
  for (const int tag : changes) plot.line("unset arrow " + std::to_string(tag));
  if (base) add_base_path(plot, motion);
  plot.line("unset multiplot");
  return plot;
}

}  // namespace locograph
