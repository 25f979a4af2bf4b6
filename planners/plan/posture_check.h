#pragma once
/// Judges one configuration on given contacts, without any of the code that found it.
///
///     PostureChecker checker(robot, load_octree("hall.bt"), obstacles);
///     PostureReport report = checker.check(q, contacts);
///     if (!report.feasible) std::cerr << violation_text(report.worst());
///
/// The constraints, in the order of the report (unit):
///
///     not_finite            numbers that are not finite, or too many, or too few (count)
///     base_orientation      | |quaternion| - 1 |
///     contact_position      of the contact farthest from its place (m)
///     contact_orientation   of the directions that its kind holds, the largest angle (rad)
///     joint_limits          excess over a limit (rad, m)
///     obstacle_distance     exact, to voxels and obstacles, of links that touch nothing (m)
///     touching_depth        of links at a contact in voxels, obstacles and the ground (m)
///     self_collision        exact, see Robot::self_collision_pairs() (m)
///     ground_penetration    depth of the lowest point of all other links (m)
///     balance               margin of the balance certificate (1)
///     torque_limits         largest torque over its limit in that certificate (ratio)
///
/// Links that touch are those of touching_links(). Voxels whose top is at z = 0 are the ground.
/// When a number is not finite nothing else is checked. Balance is a linear programme, see
/// balance_certificate.h: it counts the contacts that bear load.
/// Deterministic; thread-safe.

#include <locograph/planners/plan/balance_certificate.h>
#include <locograph/planners/plan/check_report.h>
#include <locograph/planners/plan/moving_shapes.h>
#include <locograph/planners/plan/placed_contact.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/collision_world.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace locograph {

struct PostureCheckOptions {
  double contact_tolerance_m = 1e-4;
  double contact_tolerance_rad = 1e-3;
  double joint_tolerance_rad = 1e-6;  ///< beyond a joint limit; metres for prismatic joints
  double quaternion_tolerance = 1e-6;
  double min_clearance_m = 0.0;  ///< to obstacles and voxels
  double min_self_clearance_m = 0.0;
  double ground_z_m = 0.0;           ///< -infinity: there is no ground
  double ground_tolerance_m = 1e-6;  ///< depth allowed to links that touch nothing
  /// Depth allowed to links at a contact: round feet and hands are modelled by spheres that reach
  /// past the point they touch with.
  double touching_depth_m = 0.012;
  double min_balance_margin = 0.0;
  bool enforce_torque_limits = true;
  /// The certificate is left out when something else is violated already.
  bool certify_only_if_rest_holds = false;
};

struct PostureReport {
  bool feasible = false;
  std::vector<Violation> violations;  ///< every constraint, also those that hold, in fixed order
  bool certified = false;             ///< the certificate was asked for
  BalanceCertificate balance;         ///< its wrenches: of the contacts that bear load
  double geometry_s = 0.0, balance_s = 0.0;  ///< what the checks took

  /// The one that is violated most, by its unit: 0.01 m, 0.1 rad and 0.1 of a ratio count alike.
  /// Where all hold, the first.
  const Violation& worst() const;
  /// Throws Error if there is no such constraint.
  const Violation& constraint(const std::string& name) const;
};

/// "contact_position: l_sole is 0.31 m away (limit 0.0001 m)"
std::string violation_text(const Violation& violation);

class PostureChecker {
 public:
  /// map may be null. Throws Error for collision shapes that cannot be used.
  PostureChecker(std::shared_ptr<const Robot> robot, std::shared_ptr<const octomap::OcTree> map,
                 std::vector<Obstacle> obstacles);

  /// Throws Error for contacts that are not sound (placed_contact.h) or cannot bear anything.
  PostureReport check(const Eigen::VectorXd& configuration, std::span<const PlacedContact> contacts,
                      const PostureCheckOptions& options = {}) const;

  /// Smallest distance of the robot's links to each other, exact up to 0.05 m.
  double self_distance_m(const RobotState& state) const;

 private:
  std::shared_ptr<const Robot> robot_;
  bool empty_;  ///< nothing but the ground around
  CollisionWorld world_;
  MovingShapes shapes_;
};

}  // namespace locograph
