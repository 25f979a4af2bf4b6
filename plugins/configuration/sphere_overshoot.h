#pragma once
/// How far RobotParameter::spheres stick out of the shapes they cover.

namespace locograph {

/// More spheres cost time, larger ones cost free space.
inline constexpr double kSphereOvershoot_m = 0.02;

}  // namespace locograph
