#pragma once
/// Judges a motion of a robot, at its vertices and between them, without any of the code that made
/// it.
///
///     locograph::CollisionWorld world(robot, locograph::load_octree("hall.bt"), obstacles);
///     locograph::Motion motion{times, configurations, wheels};
///     locograph::CheckOptions options;
///     options.obstacles = obstacles;
///     locograph::CheckReport report = locograph::check_motion(robot, world, motion, options);
///     if (!report.feasible) return 1;
///
/// The constraints, in the order of the report (unit; "per step": from one vertex to the next):
///
///     not_finite               numbers of a vertex or its time that are not finite (count)
///     configuration_size       |size - Robot::configuration_size()| (count)
///     time_order               time between vertices must be positive (s)
///     step_size                samples a step needs, see CheckOptions (count)
///     base_orientation         | |quaternion| - 1 |
///     joint_limits             excess over a limit (rad, m)
///     velocity_limits          |change of a joint| / time over Joint::max_velocity (ratio)
///     obstacle_distance        exact, to voxels and obstacles at the time concerned (m)
///     self_collision           exact, see Robot::self_collision_pairs() (m)
///     ground_penetration       depth of the lowest point of any other collision shape (m)
///     wheel_ground_penetration the same for the shapes of wheels (m)
///     mount_ground_penetration the same for the links that carry wheels (m)
///     wheel_contact            height or depth of the lowest point of a wheel's disc (m)
///     wheel_tilt               of a wheel's axle to the horizontal (rad)
///     lateral_slip             largest anywhere within a step, see wheel_rolling.h (m)
///     longitudinal_slip        the same (m)
///     static_balance           margin of balance_certificate.h, without torque limits (1)
///     torque_limits            least largest |torque| / limit that balances (ratio)
///
/// A vertex with a number that is not finite, of the wrong size, or with a quaternion near zero is
/// reported; nothing else is checked there and next to it. Joint limits and velocities are exact
/// between vertices because joints are linear there; distances follow clearance_search.h; the rest
/// is sampled as CheckOptions say.
///
/// Balance and torques are judged at the vertices whose contacts the motion knows, not in between,
/// and by wrenches of the certificate's own: it is asked whether there are any.
/// Deterministic; const arguments may be shared between threads.
/// Throws Error for an empty motion, as many times as configurations missing, lists of contacts for
/// some configurations only, a contact that makes no sense (certify_balance()), a wheel that is
/// none, an option that makes no sense, and a world of another robot.

#include <locograph/planners/plan/check_report.h>
#include <locograph/planners/plan/motion_interpolation.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>

namespace locograph {

CheckReport check_motion(const Robot& robot, const CollisionWorld& world, const Motion& motion,
                         const CheckOptions& options = {});

}  // namespace locograph
