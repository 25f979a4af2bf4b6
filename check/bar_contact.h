#pragma once
/// Contacts on round bars: whether one is on a bar, and what of it.
///
///     const bool somewhere_else = off_bar_m(contact, bar) > limits::kClosed_m;
///     SoleOnBar sole = sole_on_bar(bar, contact, world_from_link);
///     if (sole.outside_m == 0.0) std::cout << sole.line.size() << " corners\n";
///
/// A point is on a bar where its distance from the axis is the radius and its normal is radial. A
/// surface contact (a sole) is on one that its plane is tangent to: the axis is normal to the
/// contact's normal, and the radius below the plane; they touch along the axis moved by the radius
/// along the normal. A grasp (a rung) is on one whose axis goes through its position along normal x
/// forward, in either sense. Wheels are on none. Directions fit up to limits::kClosed_rad.
///
/// Bars have a positive length and radius. Pure functions.

#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <vector>

namespace locograph {

/// How far a sound contact is off a bar, as if the bar did not end; of a sole also how far its
/// place is aside of it, beyond what the sole reaches in any direction. Infinite if the directions
/// do not fit.
double off_bar_m(const Contact& contact, const Bar& bar);

/// How far a point is beyond the ends of a bar, along its axis.
double beyond_ends_m(const Bar& bar, const Eigen::Vector3d& point);

struct SoleOnBar {
  double outside_m = 0.0;  ///< from the line of touching to the sole's rectangle; 0: they meet
  /// Ends of what of the line is in the rectangle, about the sole's point in its axes; none if they
  /// do not meet.
  std::vector<Eigen::Vector2d> line;
};

/// Of a surface contact that is on the bar.
SoleOnBar sole_on_bar(const Bar& bar, const Contact& contact,
                      const Eigen::Isometry3d& world_from_link);

}  // namespace locograph
