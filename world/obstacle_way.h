#pragma once
/// How far and how fast the points of an obstacle travel.
///
///     const Obstacle& cart = obstacles.front();
///     double way = way_m(cart, cart.world_from_obstacle, cart.motion[0].pose);
///     if (fastest_m_s(cart) > 100.0) throw Error("the cart is faster than any cart");
///
/// Along a key frame piece a point travels at most |dp| + |angle| * rho, with rho the distance of
/// the obstacle's farthest point from its origin (0 for a sphere, which looks the same turned).

#include <locograph/world/obstacles.h>

#include <vector>

namespace locograph {

/// At most, of any of its points on the way from one pose to the next [m].
double way_m(const Obstacle& obstacle, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// The obstacle at rest, at places all along its motion: no point of it travels further than
/// apart_m from one to the next, or than a 500th part of its way. One at rest is itself. All of
/// them are always there.
std::vector<Obstacle> all_along(const Obstacle& obstacle, double apart_m);

/// Of its fastest point, anywhere along its motion and back to its first pose; 0 at rest.
double fastest_m_s(const Obstacle& obstacle);

}  // namespace locograph
