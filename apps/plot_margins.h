#pragma once
/// What a plan leaves of its limits, over time, for its diagram.
///
///     const std::vector<Series> shares = torque_shares(robot, torques_along(robot, motion));
///     const PlanMargins margins = margins_along(motion, judging);

#include <locograph/apps/plan_file.h>
#include <locograph/apps/plot_series.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// Of the active joints at each configuration [N m, N], with the wrenches that the plan states and
/// its inertia; empty: it states none.
std::vector<Eigen::VectorXd> torques_along(const Robot& robot, const Motion& motion);

/// What the judge says of single configurations, each by itself, evenly chosen where there are
/// many.
struct PlanMargins {
  std::vector<double> time_s;
  std::vector<Series> distances;  ///< to obstacles and of links to each other, to 50 mm [mm]
  std::vector<Series> balance;    ///< of the robot at rest; none: nothing bears it
};
PlanMargins margins_along(const Motion& motion, const Judging& judging);

}  // namespace locograph
