#pragma once
/// Contacts as planners count on them: what they can bear, less the execution margin.
///
///     const double weight_N = robot.total_mass() * standard_gravity().norm();
///     const std::vector<BearingContact> counted = with_margin(bearing, task.margin, weight_N);
///     const BalanceRegion region = balance_region(robot.total_mass(), counted, kRegionMargin);
///     const double share = share_of_margin(robot.total_mass(), bearing, task.margin, com);

#include <locograph/plugins/configuration/execution_margin.h>
#include <locograph/robots/bearing_rays.h>

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace locograph {

/// Friction and areas smaller, areas about their middle; what is pressed has its least force.
/// Without a margin, the same to the last bit.
std::vector<BearingContact> with_margin(std::span<const BearingContact> contacts,
                                        const ExecutionMargin& margin, double weight_N);

/// Parts of a margin that are asked for one after the other where not all of it is there.
inline constexpr std::array kPartsOfMargin = {1.0, 0.75, 0.5, 0.25, 0.0};

/// What part of the margin contacts have that balance each of these centres of mass, 0 to 1, in
/// steps of 1/64; 0 also where they do not balance one at all.
double share_of_margin(double mass_kg, std::span<const BearingContact> contacts,
                       const ExecutionMargin& margin,
                       std::span<const Eigen::Vector2d> centres_of_mass);

/// The same where the centre of mass may be anywhere: what leaves a place for it that is 2 cm wide,
/// or half as wide as without a margin.
double share_of_margin(double mass_kg, std::span<const BearingContact> contacts,
                       const ExecutionMargin& margin);

}  // namespace locograph
