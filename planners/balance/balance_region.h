#pragma once
/// Where the centre of mass of a robot at rest may be for its contacts to hold it: a convex
/// polygon, which depends on the contacts alone and not on the posture.
///
///     const BalanceRegion region = balance_region(robot.total_mass(), bearing, 0.1);
///     const bool hopeless = region.empty();             // nothing that stands like this balances
///     double room_m = region.depth_m(state.center_of_mass().head<2>());      // < 0: outside
///     const bool stands = balances(robot.total_mass(), bearing, 0.1,
///                                  state.center_of_mass().head<2>());        // that point alone
///
/// Bretl and Lall, "Testing static equilibrium for legged robots", IEEE Transactions on Robotics
/// 24(4), 2008: gravity has no moment about the vertical through the centre of mass, so that its
/// height does not matter, and the places that friction and the limits of force allow are convex.
/// Linear programmes find the leftmost and the rightmost point, then the furthest one across each
/// edge between two, until there is none. The polygon of these points lies inside the true region.
/// Torque limits are not in it.

#include <locograph/robots/bearing_rays.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

/// Of friction, areas and limits of force: what stances and motions leave unused.
inline constexpr double kRegionMargin = 0.1;

struct BalanceRegion {
  /// normal . (x, y) <= offset_m, world; the normal has length 1.
  struct Side {
    Eigen::Vector2d normal;
    double offset_m;
  };
  std::vector<Side> sides;
  double width_m = 0.0;  ///< of the narrowest way through

  bool empty() const { return sides.empty(); }
  double depth_m(const Eigen::Vector2d& centre_of_mass) const;
};

/// margin: the part of friction, areas and limits of force that is left unused. resolution_m:
/// corners that are nearer to each other, or less far out, are left out.
BalanceRegion balance_region(double mass_kg, std::span<const BearingContact> contacts,
                             double margin, double resolution_m = 1e-4);

/// Whether the region holds the centre of mass: one linear programme instead of those of all
/// corners.
bool balances(double mass_kg, std::span<const BearingContact> contacts, double margin,
              const Eigen::Vector2d& centre_of_mass);

}  // namespace locograph
