#pragma once
/// Rows of timing that keep the joints' torques within their limits, for a robot whose base is
/// fixed to the world and that touches nothing.
///
///     PathTiming timing(robot, waypoints, limits, {}, effort_rows(robot));
///
/// With h of dynamics.h, torques are M (q' u + q'' x) + h(q, q' sqrt(x)), and h - g is quadratic in
/// velocity: a = M q', b = M q'' + h(q, q') - g, c = limit - g, and the same for -limit.

#include <locograph/planners/offline/timing/speed_profile.h>
#include <locograph/robots/statics.h>

namespace locograph {

/// effort_scale: of the efforts of the URDF. The robot must outlive what is returned, which one
/// thread may call at a time. Throws Error for a floating base, whose contacts have a share.
TimingRowsAt effort_rows(const Robot& robot, double effort_scale = 1.0,
                         const Eigen::Vector3d& gravity = standard_gravity());

}  // namespace locograph
