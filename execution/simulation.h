#pragma once
/// A motion carried out in the physics engine: under a torque controller, with what may be other
/// than it was planned for.
///
///     const SimulationResult result = simulate(robot, effectors, world, motion, {.seed = 3});
///     if (!result.carried_out) std::cout << result.reason << '\n';
///
/// Joint torques within the efforts are all that moves the robot, but for the push that options
/// ask for. It begins in the motion's first configuration, at rest, each joint off by up to
/// initial_error_rad.
///
/// It falls when its base is further from the reference than kFallen_m or kFallen_rad, or when the
/// engine gives up. It has reached the goal when, at the end, every contact of the last stance
/// bears and touches within kThere_m of its place (of a ball or a wheel that rolls, of where the
/// last configuration has it), and the base is within
/// kBaseThere_m and kBaseThere_rad. The motion is carried out when it has reached the goal, no
/// contact ever slipped by more than kMostSlip_m while it was held, and nothing else has touched.

#include <locograph/check/motion.h>
#include <locograph/execution/joint_impedance_controller.h>
#include <locograph/execution/motion_player.h>
#include <locograph/execution/simulated_sensors.h>
#include <locograph/execution/whole_body_controller.h>
#include <locograph/robots/robot.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

inline constexpr double kFallen_m = 0.3, kFallen_rad = 0.8;
inline constexpr double kThere_m = 0.02, kBaseThere_m = 0.05, kBaseThere_rad = 0.1;
inline constexpr double kMostSlip_m = 0.01;

/// What goes on in a simulation, before a cycle.
struct SimulationMoment {
  /// Of the clock by which obstacles move: that of the plan, which the robot may be late by.
  double clock_s;
  double plan_time_s;
  const Eigen::VectorXd& configuration;  ///< where the robot thinks that it is
};

struct SimulationOptions {
  std::string controller = "whole_body";  ///< one of controller_names()
  WholeBodyOptions whole_body = {};
  JointImpedanceOptions joint_impedance = {};  ///< its cycle is the player's
  PlayerOptions player = {};
  double friction_factor = 1.0;    ///< of the world
  double mass_error = 0.0;         ///< each link's mass is off by up to this share
  double contact_error_m = 0.0;    ///< everything that may be touched is off along its normal
  double push_N = 0.0;             ///< at the root link, in a horizontal direction
  double push_s = 0.2;             ///< for how long
  double initial_error_rad = 0.0;  ///< of each joint; metres for prismatic joints
  unsigned seed = 0;               ///< of all that is drawn at random
  /// The controller gets what a StateEstimator makes of sensors with these errors; none: the truth.
  std::optional<SensorErrors> sensors = std::nullopt;
  double record_every_s = 0.0;  ///< 0: nothing is recorded
  /// How the motion goes on, asked before each cycle: as MotionPlayer::follow() wants it; nullopt:
  /// as before. May be empty.
  std::function<std::optional<Motion>(const SimulationMoment&)> revise = {};

  /// Throws Error naming the number that makes no sense.
  void validate() const;
};

/// Of a motion: those known, each with the least friction that it has in a contact of the motion,
/// then those of contacts that are not known.
std::vector<EndEffector> effectors_of(const Motion& motion, std::vector<EndEffector> known);

/// What controllers there are.
std::vector<std::string> controller_names();

struct SimulationSample {
  double time_s = 0.0, plan_time_s = 0.0;
  int stance = 0;
  Eigen::VectorXd configuration, velocity, torques;
  Eigen::VectorXd planned;               ///< where the reference is
  std::vector<Eigen::Vector3d> forces;   ///< on each end effector [N, world]
  std::vector<Eigen::Vector3d> moments;  ///< of them, about its point [N m, world]
};

struct SimulationResult {
  bool upright = true, reached_goal = false, carried_out = false;
  std::string reason = {};  ///< why it is not carried out
  double time_s = 0.0, plan_time_s = 0.0, waited_s = 0.0;
  double max_joint_error_rad = 0.0, max_base_error_m = 0.0, max_base_error_rad = 0.0;
  double max_contact_slip_m = 0.0, max_torque_ratio = 0.0, other_touch_N = 0.0;
  std::string slipping = {}, other_link = {};  ///< what did
  std::string touched_link = {};               ///< by other_link; empty: something in the world
  double max_estimate_error_m = 0.0, max_estimate_error_rad = 0.0;  ///< of the base
  double slip_at_s = -1.0, other_touch_at_s = -1.0;                 ///< of the plan; -1: never
  double pushed_at_s = -1.0;                                        ///< -1: it was not
  std::vector<double> controller_s;  ///< processor time of each cycle
  double processor_s = 0.0;          ///< of all of it
  std::vector<SimulationSample> samples;
};

/// effectors: those of the robot's task; where the motion has contacts of others, it is refused.
/// Throws Error for options that make no sense, as Engine, MotionPlayer and the controller do, and
/// for a motion that begins in penetration and collision meshes that were not found.
SimulationResult simulate(const Robot& robot, std::span<const EndEffector> effectors,
                          const World& world, const Motion& motion,
                          const SimulationOptions& options = {});

}  // namespace locograph
