#pragma once
/// A robot and a world as a model of the physics engine MuJoCo, in its XML format (MJCF).
///
///     std::ofstream("coman_plus.xml") << mujoco_model(robot, effectors, world);
///
/// Lengths are metres, angles radians, axes those of robot.h and world.h. Bodies are those of
/// Robot::tree(): links that do not move against each other are one body. Nothing is added that
/// the URDF does not give: no damping, no armature.
///
///   body_B      body B of the tree; body_0 has the joint "base" if the base floats
///   axis_A      joint of axis A of Robot::axes(), with its limits
///   motor_J     torque [N m] or force [N] of active joint J, limited by its effort; none where the
///               effort is 0
///   effector_E  what end effector E touches with: a sole is a box 2 cm thick, a ball a sphere, a
///               bare point a sphere of 5 mm above it, a wheel a sphere of its radius (cylinders
///               give flickering contacts on boxes)
///   grasp_E_0, grasp_E_1
///               equalities that hold two points of the body of a grasp E at points of the world;
///               off until they are switched on. They are to be 2 kGraspHalf_m apart along the bar,
///               about which the hand turns freely; one, where the grasp bears no moments
///   obstacle_O  obstacle O; where it moves or is not always there also a body that is to be moved
///   map_M       cells of the map that reach into options.reach, in blocks, those side
///               by side as one box
///
///   shape_L_K   collision shape K of link L
///
/// A body with end effectors touches the world with these only; the others touch it with all their
/// collision shapes, of meshes with their convex hulls, flat ones 2 mm thick; meshes that were not
/// found are left out. The robot touches itself with the shapes of Robot::self_collision_pairs(),
/// but for those of two bodies with a joint between them.
/// Friction is that of the world, MuJoCo takes the larger one of two: of surfaces and bars their
/// own, of a box the least of its faces, and where none is stated the least of the end effectors. A
/// surface without any end is a plane, another one a box of 2 mm below it. A mimic joint is an
/// equality with the joint that it follows.
///
/// Errors: those of options, of body_inertias(), require_solid_bodies() and of
/// require_sound_effector(); links of bodies without mass or inertia; kinds of contact that are not
/// ours; meshes that mesh_vertices() cannot read.

#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <span>
#include <string>
#include <vector>

namespace locograph {

inline constexpr double kGraspHalf_m = 0.04;  ///< of the width of a hand round a bar

/// Whether an obstacle is at the same place all the time.
bool is_at_rest(const Obstacle& obstacle);

enum class Integrator { kEuler, kRungeKutta4 };  ///< semi-implicit Euler

struct MujocoModelOptions {
  double timestep_s = 0.001;
  Integrator integrator = Integrator::kEuler;
  bool constraints = true;       ///< false: neither contacts nor joint limits
  double friction_factor = 1.0;  ///< of all friction of the world
  /// Of masses and inertias, one for each link; none: as the URDF has them.
  std::vector<double> link_mass_factors = {};
  /// Cells of the map that do not reach into it are left out [m, world].
  Eigen::AlignedBox3d reach = {Eigen::Vector3d::Constant(-1e9), Eigen::Vector3d::Constant(1e9)};

  /// Throws Error for a time step that is not above 0, or longer than 0.1 s, and a factor of
  /// friction that is negative.
  void validate() const;
};

std::string mujoco_model(const Robot& robot, std::span<const EndEffector> effectors,
                         const World& world, const MujocoModelOptions& options = {});

}  // namespace locograph
