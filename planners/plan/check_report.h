#pragma once
/// What a feasibility check is asked and what it answers: options, violations, report.
///
///     locograph::CheckOptions options;
///     options.min_clearance_m = 0.01;
///     options.obstacles = obstacles;  // the ones the CollisionWorld was made with
///     options.validate();
///     for (const locograph::Violation& v : report.violations)
///       if (v.violated) std::cerr << v.constraint << ": " << v.what << '\n';

#include <locograph/world/obstacles.h>

#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct CheckOptions {
  /// Sampling between vertices, for everything but the distances to obstacles and to the robot
  /// itself: no point of a collision shape moves more than max_step_m from one sample to the next,
  /// and neither base nor joints turn more than max_step_rad (a wheel about its own axle: 0.25).
  double max_step_m = 0.01;
  double max_step_rad = std::numbers::pi / 180.0;
  /// A step between vertices that would need more samples than this violates `step_size`; nothing
  /// else is checked between its vertices.
  int max_samples_per_step = 20000;

  double min_clearance_m = 0.0;       ///< to obstacles and voxels
  double min_self_clearance_m = 0.0;  ///< of the pairs of Robot::self_collision_pairs()
  /// Distances are searched for between the vertices, too: nowhere along the motion is one smaller
  /// than the reported minimum by more than this, and a step on which one is smaller than required
  /// by more than this is counted as violated. A depth (a negative distance) is as exact as that of
  /// the CollisionWorld.
  double clearance_resolution_m = 1e-3;
  /// The obstacles of the world: how they move bounds what can happen between two samples. Not
  /// given: any of them may move at up to max_obstacle_speed_m_s at any time, which is safe up to
  /// that speed and slow for long motions.
  std::optional<std::vector<Obstacle>> obstacles = std::nullopt;
  double max_obstacle_speed_m_s = 1.0;

  double ground_z_m = 0.0;                       ///< -infinity: there is no ground
  double ground_tolerance_m = 1e-6;              ///< depth allowed to a shape
  double wheel_mount_ground_tolerance_m = 0.01;  ///< to a link that carries a wheel: capsules
                                                 ///< around a fork reach lower than the wheel
  double contact_tolerance_m = 2e-3;  ///< wheels: height above and depth below the ground
  double max_wheel_tilt_rad = 5.0 * std::numbers::pi / 180.0;  ///< of the axle to the horizontal
  double max_lateral_slip_m = 5e-3;                            ///< per step between vertices
  double max_longitudinal_slip_m = 5e-3;                       ///< per step between vertices

  double joint_tolerance_rad = 1e-6;  ///< beyond a joint limit; metres for prismatic joints
  double velocity_tolerance = 1e-6;   ///< of the ratio of velocity and limit, for rounding
  double quaternion_tolerance = 1e-6;

  double min_balance_margin = 0.0;    ///< of balance_certificate.h, below 1
  bool enforce_torque_limits = true;  ///< else torques are reported, and never too large

  /// Throws Error naming the option that makes no sense.
  void validate() const;
};

/// One constraint: where it is violated most or, if it holds, where it comes closest to that.
struct Violation {
  std::string constraint;
  double worst = 0.0;  ///< 0 if there was nothing to check; `what` says so
  std::string unit;
  double limit = 0.0;
  int at_vertex = 0;  ///< the earlier one if it happens between two
  int count = 0;      ///< vertices violated at, or on the way from them to the next
  double time_s = 0.0;
  Eigen::Vector3d at_point = Eigen::Vector3d::Zero();  ///< world; zero where there is no place
  std::string what;                                    ///< links, obstacle or joint concerned
  bool violated = false;
};

struct CheckReport {
  bool feasible = false;
  int configurations = 0;             ///< vertices
  int samples = 0;                    ///< configurations looked at, vertices included
  std::vector<Violation> violations;  ///< every constraint, also those that hold, in fixed order
  double min_clearance_m = 0.0;       ///< the world's cutoff if nothing is nearer
  double min_self_clearance_m = 0.0;
  /// Of the vertices whose contacts are known; nothing if there are none. The margin is that of the
  /// contacts alone, the ratio the least that the most loaded joint can be held with.
  std::optional<double> min_balance_margin, max_torque_ratio;
  double max_velocity_ratio = 0.0;
  double max_contact_error_m = 0.0;

  /// Throws Error if there is no such constraint.
  const Violation& constraint(const std::string& name) const;
};

}  // namespace locograph
