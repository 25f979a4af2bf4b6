#pragma once
/// What the judge asks, in one place and not to be widened by anybody who calls it.

#include <numbers>

namespace locograph::limits {

// A contact at a vertex: position, and the directions that its kind holds.
inline constexpr double kClosed_m = 1e-4, kClosed_rad = 1e-3;
// A contact between vertices, and how far a held contact gets in total while it lasts.
inline constexpr double kHeld_m = 1e-3, kHeld_rad = 0.5 * std::numbers::pi / 180.0;
// A wheel, along and across its heading: within any stretch of its way, and in total.
inline constexpr double kSlip_m = 5e-3, kSlipStretch_m = 0.1, kSlipShare = 0.02;
// How deep a link may reach into the surface that it touches: round feet and hands are modelled by
// spheres, and forks by capsules, that reach past the point they touch with.
inline constexpr double kTouchingDepth_m = 0.012;
// A drive's goal: where its base may end, in any direction, and its heading.
inline constexpr double kGoal_m = 0.25, kGoal_rad = 0.25;
// What a whole plan begins and ends with may move no faster [m/s, rad/s]: for rounding.
inline constexpr double kAtRest = 1e-6;
// Wrenches that are stated: what is left over of the weight, and how fast the force of a contact
// changes [weights per second].
inline constexpr double kWrenchLeftOver = 1e-3, kForceRate = 2.5;
// How far what motion and gravity ask of all contacts may jump at a vertex [weights]: as far as the
// force of a contact may change in 20 ms.
inline constexpr double kForceJump = 0.02 * kForceRate;
// For rounding: of a depth, and of what linear programmes balance.
inline constexpr double kDepthRounding_m = 1e-6, kBalanceRounding = 1e-6;

}  // namespace locograph::limits
