#pragma once
/// The edges of a plan on wheels, made from its stances.
///
///     graph.parameters().set(kRobotNumber, robot);
///     graph.parameters().set(kWorldNumber, world);
///     add_wheeled_plan(graph, motion);

#include <locograph/check/motion.h>
#include <locograph/common/job_control.h>
#include <locograph/core/graph.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>

#include <memory>
#include <vector>

namespace locograph {

/// How strongly the edges of a new plan hold. Weights are on squared errors in m and rad; those of
/// constraints are large against those of tracking, so that what tracking wants bends constraints
/// by micrometres only.
struct PlanEdgeOptions {
  double constraint_weight = 1e5;    ///< contacts, rolling
  double limit_weight = 1e4;         ///< joints, velocities, obstacles, the robot itself
  double acceleration_weight = 1e2;  ///< per (rad/s²)²
  double obstacle_margin_m = 0.05;
  double joint_margin_rad = 0.01;
  double velocity_fraction = 0.95;
  double base_linear_m_s = 0.5;
  double base_angular_rad_s = 0.5;
  int swept_samples = 4;  ///< between two configurations, see edge_swept_obstacle_distance.h
  double self_margin_m = 0.01;
  double joint_acceleration_rad_s2 = 10.0;
  /// How far joints turn in one step [rad], or as far as the plan turns them: what closes contacts
  /// at both ends of a step has to do so between them too.
  double leg_step_rad = 0.035, steering_step_rad = 0.25;
  /// How far a wheel may slip half-way of a step. The judge allows 5 mm within any 0.1 m of its
  /// way, and two steps may slip in opposite directions.
  double steering_slip_m = 0.0018;

  // Tracking, of the plan and of its steps. Falling behind weighs more than passing to the side:
  // a robot that stops in front of an obstacle is safe, but gets nowhere.
  double track_forward = 20.0, track_lateral = 0.5, track_height = 20.0;
  double track_tilt = 50.0, track_yaw = 5.0, track_joint = 1.0;
  double track_goal = 50.0;  ///< forward, lateral and yaw of the last configuration: to come back
  double step_base = 50.0, step_joint = 5.0, step_steering = 0.5;
};

/// Adds the stances, the configurations, the first one fixed, and all edges: every contact of a
/// stance at the configurations at both ends of its steps, rolling and distances to the world on
/// the steps, their ends included. Parameters
/// kRobotNumber and kWorldNumber (plan.h) must be set. Pairs of links that the shapes of
/// EDGE_SELF_COLLISION see too near to each other in the motion already have no weight there.
/// Joints that steer (a carrier of a wheel turns about them) and wheels are not tracked: rolling
/// decides them. Throws Error for a motion whose stances are not known everywhere. Returns false
/// when the job ended before the plan was whole.
bool add_wheeled_plan(Graph& graph, const Motion& motion, const PlanEdgeOptions& options = {},
                      const JobControl& job = {});

/// Keeps links apart that the edge sees apart in every one of the configurations which the job lets
/// it look at: others have no weight.
EdgeSelfCollision self_collision_edge(const std::shared_ptr<const RobotParameter>& robot,
                                      const std::vector<Eigen::VectorXd>& configurations,
                                      double margin_m, double weight, const JobControl& job = {});

}  // namespace locograph
