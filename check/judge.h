#pragma once
/// Judges motions and configurations of a robot on their stances, at the vertices and between them,
/// without any of the code that made them.
///
///     Judge judge(robot, load_world("hall.bt", "boxes.xml"));
///     CheckReport report = judge.check(motion);
///     if (!report.feasible) std::cerr << violation_text(report.worst()) << '\n';
///     CheckReport posture = judge.check(configuration, stance);   // the same check
///
/// The constraints, in the order of the report, with their units. Those marked * are judged of
/// motions only; + needs a contact, - a wheel that rolls. A constraint is judged, or says why not;
/// a motion with something violated, or with something that is required and not judged, is not
/// feasible.
///
///   not_finite             numbers of a vertex or its time that are not finite (count)
///   configuration_size     |size - Robot::configuration_size()| (count)
///   stance                 vertices that do not say where the robot stands, or steps (count)
///   contact_claims         contacts that claim more than CheckOptions::known (count)
///   base_orientation       | |quaternion| - 1 |
///   time_order           * time between vertices must be positive, and none before 0 (s)
///   step_size            * samples a step needs, see CheckOptions (count)
///   joint_limits           excess over a limit (rad, m)
///   velocity_limits      * joint velocity over its limit (ratio)
///   base_velocity        * of the base, linear or angular, over its limit (ratio)
///   acceleration_limits  * joint acceleration over its limit (ratio)
///   end_at_rest          * how fast a whole motion begins and ends (rad/s, m/s)
///   contact_position     + of a contact to its place, at vertices (m); of a ball that has touched
///                          down before, to what it rolls on
///   contact_orientation  + of the directions that its kind holds, at vertices (rad)
///   contact_between     *+ the worst of both between vertices; an angle counts as the length that
///                          is the same share of its limit (m)
///   contact_motion      *+ how far a held contact gets while it lasts, in total; how far the skin
///                          of a ball slips, see ball_rolling.h (m)
///   contact_turn        *+ how far it turns; a locked wheel, about its axle on the ground (rad)
///   contact_relabelled  *+ contacts whose place differs in stances that follow each other, and
///                          stances of a plan of stances that follow their like (count)
///   contact_on_surface   + of the contact to the surface or bar it lies on, or outside its border;
///                          of a grasp to the axis of its bar, or beyond its ends (m)
///   lateral_slip        *- across a wheel's heading, see wheel_rolling.h (m)
///   longitudinal_slip   *- along it (m)
///   obstacle_distance      to voxels and obstacles that the link does not touch; with a clearance
///                          that is asked for, also to surfaces, bars and solids (m)
///   ground_penetration     into surfaces, bars and solids that the link does not touch (m)
///   touching_depth         of links in what they touch (m)
///   self_collision         see Robot::self_collision_pairs() (m)
///   static_balance       + margin of balance_certificate.h, with the torque limits if they are
///                          enforced, and with inertial forces where the motion has times (1)
///   torque_limits        + largest |torque| / limit; of a motion: the least that balances (ratio)
///   plan_wrenches        + of wrenches that the motion states, see wrench_check.h: the largest
///                          share of what is allowed (ratio)
///
/// Distances, the four from obstacle_distance on, are required: of a robot without any collision
/// shape they are not judged. Links that have something to see and no shape are told as trusted,
/// as are Robot::left_out_pairs().
/// A vertex with a number that is not finite, of the wrong size, or with a quaternion near zero is
/// reported; nothing else is checked there and next to it. Configuration i is held against the
/// stances of the step before it and of the step after it. Between vertices the curve is judged
/// (motion_curve.h): limits exactly; distances as clearance_search.h says; balance, with inertia on
/// both sides of each vertex, as balance_along.h does; the rest is sampled as CheckOptions say. A
/// whole motion begins and ends at rest, balanced there; a part of one goes on at both ends.
///
/// Deterministic, with any number of CheckOptions::threads; const members may be called by several
/// threads at once.
/// Throws Error for an empty motion, as many times or stances as configurations missing, a stance
/// that does not exist or is not sound (robots/contact.h), and an option that makes no sense.

#include <locograph/check/check_report.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/job_control.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/world_snapshot.h>

#include <Eigen/Core>
#include <memory>
#include <optional>

namespace locograph {

class Judge {
 public:
  /// Throws Error for collision shapes, surfaces and bars that cannot be used.
  Judge(std::shared_ptr<const Robot> robot, std::shared_ptr<const WorldSnapshot> world);
  Judge(std::shared_ptr<const Robot> robot, World world);
  ~Judge();
  Judge(Judge&&) noexcept;
  Judge& operator=(Judge&&) noexcept;

  CheckReport check(const Motion& motion, const CheckOptions& options = {}) const;
  /// Nothing when the job, which is asked at every vertex and sample, by one thread at a time, ends
  /// before the check does.
  std::optional<CheckReport> check(const Motion& motion, const CheckOptions& options,
                                   const JobControl& job) const;
  /// Distances are looked for up to 0.05 m only. wrenches: that are stated; none: as in Motion.
  CheckReport check(const Eigen::VectorXd& configuration, const Stance& stance,
                    const CheckOptions& options = {}, const StanceWrenches& wrenches = {}) const;

  /// Smallest distance of the robot's links to each other, exact up to 0.05 m.
  double self_distance_m(const RobotState& state) const;

  const World& world() const;
  const Robot& robot() const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace locograph
