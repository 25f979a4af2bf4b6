#pragma once
/// Whether an end effector's frame lies on the skin of what it belongs to.
///
///     const std::optional<double> beyond_m = beyond_frame_m(robot, sole);
///     if (beyond_m > 0.0) std::cerr << "it would reach into what it stands on\n";

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

#include <optional>

namespace locograph {

/// How far the collision shapes of the links fixed to an end effector's reach beyond its plane,
/// against its normal, at most [m]; negative: the plane lies outside of them. Meshes that were not
/// found do not count. Nothing for other kinds than `surface`, and without a shape. Throws Error
/// for an unknown link and for a mesh that cannot be read.
std::optional<double> beyond_frame_m(const Robot& robot, const EndEffector& effector);

}  // namespace locograph
