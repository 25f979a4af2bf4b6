#pragma once
/// The edges of a plan, made from its stances: the only place that emits them.
///
///     graph.parameters().set(kRobotNumber, robot);
///     graph.parameters().set(kWorldNumber, world);
///     add_configurations(graph, motion, add_stances(graph, robot, motion.stances));
///     add_plan_edges(graph, drive_edges());
///
/// Each configuration gets tracking of the plan as it is, joint limits, the contacts of the stances
/// on both sides, where balls that were held before have rolled since, and distances of its links
/// to each other and, where the plan has a PARAMS_PLACES, to what they do not touch; each step
/// tracking of its length, velocity limits, rolling where it has wheels and distances to the world
/// on the way; each two steps acceleration limits; each configuration whose wrenches are known
/// balance, friction, the plan's wrenches and, where they are enforced, torque limits. A plan of
/// stances has no edges of steps but those of balls. A posture, a plan of one configuration, has
/// its distances to the world there.
///
/// So a feasible plan is the optimum of its graph, up to micrometres, and refining it needs nothing
/// added.

#include <locograph/check/check_report.h>
#include <locograph/check/motion.h>
#include <locograph/common/job_control.h>
#include <locograph/core/graph.h>
#include <locograph/planners/plan/plan.h>

#include <vector>

namespace locograph {

/// How strongly the edges of a plan hold. Weights are on squared errors in m, rad and shares of the
/// robot's weight; those of constraints are large against those of tracking, so that what tracking
/// wants bends constraints by micrometres only. Limits are what the edges keep, not what the judge
/// allows.
struct PlanEdgeOptions {
  double constraint_weight = 1e5;        ///< contacts, rolling
  double limit_weight = 1e4;             ///< joints, velocities, obstacles, the robot itself
  double acceleration_weight = 1e2;      ///< per (rad/s²)²
  double balance_weight = 1e4;           ///< forces and moments (N, N m over the robot's weight)
  double friction_weight = 1e3;          ///< what contacts can bear, likewise
  double torque_weight = 1e2;            ///< per share of a joint's effort limit
  double wrench_tracking_weight = 3e-3;  ///< the plan's, of all wrenches that balance; of moments
  double wrench_arm_m = 0.03;            ///< as of forces at this arm: soles may bear along a line

  double obstacle_margin_m = 0.05;
  int swept_samples = 4;  ///< between two configurations, see edge_swept_obstacle_distance.h
  /// Spheres that are nearer to the world than the margin in the plan itself have no weight: links
  /// that touch it. A drive touches with its wheels only, which the world's ground exempts.
  bool excuse_near_world = false;
  double surface_margin_m = 2e-3;  ///< to surfaces, bars and boxes that a link does not touch
  double self_margin_m = 0.01;
  double joint_margin_rad = 0.01;  ///< or what a configuration has, if that is less
  double velocity_fraction = 0.95;
  double base_linear_m_s = 0.5, base_angular_rad_s = 0.5;  ///< 0: no limit
  double joint_acceleration_rad_s2 = 10.0;                 ///< as MotionOptions has it; 0: no limit
  bool torque_limits = false;
  double effort_scale = 1.0;
  /// How far joints turn in one step [rad], or as far as the plan turns them: what closes contacts
  /// at both ends of a step has to do so between them too. 0: as far as their velocities allow.
  double leg_step_rad = 0.0, steering_step_rad = 0.0;
  /// How far a wheel may slip half-way of a step; 0: the edge is left out. The judge allows 5 mm
  /// within any 0.1 m of its way, and two steps may slip in opposite directions.
  double steering_slip_m = 0.0;

  // Tracking, of the plan and of its steps. Falling back weighs more than passing to the side: a
  // robot that stops in front of an obstacle is safe, but gets nowhere.
  double track_forward = 20.0, track_lateral = 0.5, track_height = 20.0;
  double track_tilt = 50.0, track_yaw = 5.0, track_joint = 1.0;
  double track_goal = 50.0;  ///< forward, lateral and yaw of the last configuration: to come back
  double step_base = 50.0, step_joint = 5.0, step_steering = 0.5;
  /// Above 0, in the place of tracking steps: how fast a detour is taken. Accelerations are
  /// tracked, with the weights of tracking times the fourth power of this, so that a detour takes
  /// about as long, however finely the plan is sampled; and the steps before and after a
  /// configuration at rest, as the motion comes to rest there, too.
  double smooth_over_s = 0.0;
  double rest_weight = 1e5;
};

/// Of a drive: wheels roll, and what stands beside the way is kept clear of.
PlanEdgeOptions drive_edges();
/// Of a contact task: as close to its limits and to the world as the judge allows.
PlanEdgeOptions motion_edges(const CheckOptions& check);

/// Of the stances before and after a configuration of a plan of stances, the one whose contacts
/// balance it: that with fewer, the later one of two with as many.
const Stance& bearing_stance(const Stance& before, const Stance& after);

/// Adds the configurations with their times, slopes and stances, the first one fixed. kRobotNumber
/// (plan.h) must be set; stance_numbers: of motion.stances, as add_stances() gives them. Throws
/// Error for a step whose stance is not known. Returns false when the job ended before.
bool add_configurations(Graph& graph, const Motion& motion, const std::vector<int>& stance_numbers,
                        const JobControl& job = {});

/// Adds the edges to a plan that has parameters and configurations. Pairs of links that the shapes
/// of EDGE_SELF_COLLISION see too near to each other in the plan already have no weight there, nor
/// have links that a configuration has too near to a surface, bar or box.
/// Joints that steer rolling wheels, and those wheels, are not tracked: rolling decides them.
/// wrenches: as Motion::wrenches; of a plan of stances those at the contacts of the smaller of the
/// two stances of a configuration. Throws Error for another number of them than there are
/// configurations or contacts. Returns false when the job ended before the plan was whole.
bool add_plan_edges(Graph& graph, const PlanEdgeOptions& options,
                    const std::vector<StanceWrenches>& wrenches = {}, const JobControl& job = {});

/// Ends a plan at one of its configurations, where it comes to rest: removes the later ones and
/// what bears them, and marks it incomplete. The plan is that of the graph as it was.
void cut_plan(Graph& graph, const Plan& plan, int last);

}  // namespace locograph
