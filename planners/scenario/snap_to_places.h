#pragma once
/// Moves contacts onto what was found in scans. Who writes a scenario knows where a floor in a
/// cloud is to a centimetre; a contact has to lie in the plane that was found to 0.1 mm.
///
///     const World world = world_of(scenario);
///     snap_to_places(task.start, world, scanned_names(scenario));
///     for (Stance& goal : task.goals) snap_to_places(goal, world, scanned_names(scenario));

#include <locograph/planners/scenario/scenario.h>
#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <span>
#include <string>
#include <vector>

namespace locograph {

/// How far contacts are moved and turned at most.
inline constexpr double kSnap_m = 0.05, kSnap_rad = 0.2;

/// Of the meshes, clouds and octrees of a scenario.
std::vector<std::string> scanned_names(const Scenario& scenario);

/// Surfaces and bars of the scans are those of the world that world_of() calls NAME 1, NAME bar 1
/// and so on. Of those within kSnap_m and kSnap_rad the one that is nearest to the contact's
/// position takes it: on a surface at its nearest point, with its normal; points and soles on a bar
/// on the line that lies furthest along their normal, which becomes normal to the bar; grasps on
/// its axis, their bar along it. `forward` turns with the normal. Contacts that lie on some surface
/// or bar as the judge asks, and those with nothing near, stay as they are to the last bit. Wheels
/// are moved onto surfaces only. The contacts must be sound.
void snap_to_places(Stance& stance, const World& world, std::span<const std::string> scanned_names);

}  // namespace locograph
