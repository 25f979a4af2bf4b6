#pragma once
/// A plan is a graph: what planners and checkers read out of it.
///
///     Graph graph = read_graph("plan.g2o", types);
///     Plan plan = plan_of(graph);
///     for (int slot : plan.slots) { … graph.state(slot) … }
///     CheckReport report = check_motion(*plan.robot->robot, world, motion_of(graph, plan));

#include <locograph/core/graph.h>
#include <locograph/planners/plan/motion_interpolation.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

#include <memory>
#include <vector>

namespace locograph {

struct Plan {
  std::vector<int> slots;  ///< the configuration vertices in order of time
  std::shared_ptr<const RobotParameter> robot;
  std::shared_ptr<const WheelsParameter> wheels;  ///< null: the robot has none
  std::shared_ptr<const WorldParameter> world;    ///< null: nothing around it
};

/// Throws Error when the graph holds no configuration, or configurations of several robots.
Plan plan_of(const Graph& graph);

/// With the contacts of the VERTEX_WRENCHES that an edge joins to a configuration, if there are
/// any. Throws Error for a configuration with several.
Motion motion_of(const Graph& graph, const Plan& plan);

/// How strongly the edges of a new plan hold. Weights are on squared errors in m and rad; those of
/// constraints are large against those of tracking, so that what tracking wants bends constraints
/// by micrometres only.
struct PlanEdgeOptions {
  double constraint_weight = 1e5;  ///< wheel contact, rolling
  double limit_weight = 1e4;       ///< joints, velocities, obstacles
  double obstacle_margin_m = 0.05;
  double joint_margin_rad = 0.01;
  double velocity_fraction = 0.95;
  double base_linear_m_s = 0.5;
  double base_angular_rad_s = 0.5;

  // Tracking, of the plan and of its steps. Falling behind weighs more than passing to the side:
  // a robot that stops in front of an obstacle is safe, but gets nowhere.
  double track_forward = 20.0, track_lateral = 0.5, track_height = 20.0;
  double track_tilt = 50.0, track_yaw = 5.0, track_joint = 1.0;
  double step_base = 50.0, step_joint = 5.0, step_steering = 0.5;
};

/// Numbers of the parameters in a plan file.
inline constexpr int kRobotNumber = 0, kWheelsNumber = 1, kWorldNumber = 2, kScenarioNumber = 3;

/// Adds the configurations, the first one fixed, and all edges of a wheeled plan. The graph's
/// parameters must be set. Joints that steer (a carrier of a wheel turns about them) and wheels are
/// not tracked: rolling decides them.
void add_wheeled_plan(Graph& graph, const std::vector<double>& time_s,
                      const std::vector<Eigen::VectorXd>& configurations,
                      const PlanEdgeOptions& options = {});

}  // namespace locograph
