#pragma once
/// Whether a contact lies on a surface or a bar as closely as the judge asks.
///
///     const bool on_the_floor = lies_on(world.surfaces[0], contact);
///     const bool on_the_rail = lies_on(world.bars[0], contact);

#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <string>

namespace locograph {

/// In its plane, within its border; a sole may reach in from beyond it. Grasps lie on none.
bool lies_on(const Surface& surface, const Contact& contact);
/// See bar_place.h. Wheels lie on none.
bool lies_on(const Bar& bar, const Contact& contact);
/// On any of a world's surfaces and bars.
bool lies_on_something(const World& world, const Contact& contact);

/// What is nearest to a contact's place, how far away, and by how much its normal is turned from
/// the contact's, if it is: "the nearest, floor, is 0.12 m away".
std::string nearest_place(const World& world, const Contact& contact);

/// Of the surface, in its frame, to a point in its frame.
Eigen::Vector3d nearest_point(const Surface& surface, const Eigen::Vector3d& local);

}  // namespace locograph
