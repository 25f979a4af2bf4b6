#pragma once
/// Where contacts touch round bars, as planners work it out.
///
///     const bool touches = gap_to_bar_m(bar, contact) < 1e-4;
///     const double beyond_m = past_ends_m(bar, contact.position);
///     for (const Eigen::Vector2d& end : line_on_bar(bar, contact)) std::cout << end.x() << '\n';
///
/// What is asked is what the judge asks, with its tolerances of directions: points touch a bar all
/// around along its radius, soles along a line that is parallel to its axis, grasps hold its axis;
/// wheels do neither. How it is worked out is not the judge's way, so that an error in one of the
/// two shows: from the ends of the axis, as seen from the contact, and from where the line of
/// touching cuts the border of a sole. The test of this file compares them.
///
/// Bars have a positive length and radius. Pure functions.

#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// From a sound contact to the bar, as if the bar did not end. A sole may be aside of it by as much
/// as it reaches in any direction. Infinite where the directions do not fit.
double gap_to_bar_m(const Bar& bar, const Contact& contact);

/// How far a point is past the ends of a bar, along it; 0 between them.
double past_ends_m(const Bar& bar, const Eigen::Vector3d& point);

/// The ends of the line along which a sole touches a bar that it has no gap to, along the contact's
/// axes about its position, in the bar's direction; none where it lies aside of the bar, beyond its
/// ends, or on hardly any of it.
std::vector<Eigen::Vector2d> line_on_bar(const Bar& bar, const Contact& contact);

}  // namespace locograph
