#pragma once
/// Panels of diagrams over time that plans and records of plans share.
///
///     add_lines(plot, "force", motion.time_s, force_shares(robot, motion));

#include <locograph/apps/plan_file.h>
#include <locograph/apps/plot.h>

#include <span>
#include <string>
#include <vector>

namespace locograph {

/// One line of a panel: a joint's values over time, and the largest, by which lines are ranked.
struct Series {
  std::string name;
  std::vector<double> values;
  double peak = 0.0;
};

/// The lines that come nearest to a limit in colour and by name, the others in grey.
void add_lines(PlotScript& plot, const std::string& prefix, const std::vector<double>& time_s,
               std::vector<Series> series);

/// |force| at each contact that the plan states wrenches of, over the robot's weight; 0: not held.
std::vector<Series> force_shares(const Robot& robot, const Motion& motion);

/// Its peak is its largest value, or 0.
Series series_of(const std::string& name, std::vector<double> values);

/// |torque| over the effort, of each joint that has one; torques: of the active joints, over time.
std::vector<Series> torque_shares(const Robot& robot, std::span<const Eigen::VectorXd> torques);

/// The highest peak, or at_least.
double highest(const std::vector<Series>& all, double at_least);

/// A thin line where the stance changes, in this and the next panels; the tags of its arrows.
std::vector<int> mark_stance_changes(PlotScript& plot, const Motion& motion);

void limit_line(PlotScript& plot, int tag, double at);

/// From 0 up to what is highest, at_least or more.
void add_panel(PlotScript& plot, const std::string& title, const std::string& ylabel,
               const std::string& prefix, const std::vector<double>& time_s,
               const std::vector<Series>& series, double at_least);

/// The diagram of a plan carried out: how far it is off, forces and torques.
PlotScript plot_record(const PlanFile& file);

}  // namespace locograph
