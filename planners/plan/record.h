#pragma once
/// What was measured when a plan was carried out, as a graph like a plan's.
///
///     write_graph(record_graph(plan_graph, plan, record), "result.g2o");
///     const Graph graph = read_graph("result.g2o", types);
///     const Record again = record_of(graph, plan_of(graph));
///     std::cout << tracking_errors(*plan.robot->robot, again).most_joint_rad << '\n';
///
/// The file has the robot, world and scenario of the plan, the word `recorded` in its PARAMS_PLAN
/// and a PARAMS_RECORD that names the plan's file. Of each moment it has a VERTEX_CONFIGURATION
/// with its velocity as slopes, a VERTEX_WRENCHES at the contacts of its stance, an
/// EDGE_PLAN_TRACKING with the configuration that the plan had it in then, and an EDGE_MEASUREMENT
/// with the time of the plan and the torques. Nothing in it has to hold: no constraints.

#include <locograph/planners/plan/plan.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

struct Record {
  Motion motion;  ///< measured; slopes, and wrenches at the contacts of each stance, of all moments
  std::vector<double> plan_time_s;       ///< of each moment
  std::vector<Eigen::VectorXd> planned;  ///< configurations where the plan had the robot then
  std::vector<Eigen::VectorXd> torques;  ///< of the active joints
  std::filesystem::path plan_file = {};  ///< empty: not known
};

/// graph, plan: what was carried out. Throws Error for a record without moments, of other numbers
/// of things than moments, and of a moment whose stance is not known or bears nothing.
Graph record_graph(const Graph& graph, const Plan& plan, const Record& record);

/// Throws Error, with the line if there is one, for a plan that is no record and a configuration
/// that lacks what it was to track, its wrenches or its torques.
Record record_of(const Graph& graph, const Plan& plan);

/// How far the robot was from where the plan had it. Joints that turn for ever, as wheels do, are
/// left out of the largest errors.
struct TrackingErrors {
  std::vector<double> base_m, base_rad;  ///< of each moment; zeros for a fixed base
  std::vector<Eigen::VectorXd> joints;   ///< |error| of each active joint
  double most_base_m = 0.0, most_base_rad = 0.0, most_joint_rad = 0.0;
  std::string worst_joint = {};
};
TrackingErrors tracking_errors(const Robot& robot, const Record& record);

/// The largest share of its effort that a joint gave; of joints that have one.
struct WorstTorque {
  double ratio = 0.0;
  std::string joint = {};
};
WorstTorque worst_torque(const Robot& robot, const Record& record);

}  // namespace locograph
