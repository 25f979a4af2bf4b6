#pragma once
/// A world as edges see it: one distance to map and obstacles, with its gradient.
///
///     DistanceFieldOptions options;
///     options.max_distance_m = 0.5;
///     WorldDistance field = distance_view(world, options);
///     DistanceSample sample = field.sample(point, time_s);
///
/// The ground, a level surface without an end, is left out of the map: edges know it by other
/// means. Surfaces are not in the view. Without a box of interest, a map that reaches so far that a
/// field of all of it would have more than four million nodes is seen by its leaves.

#include <locograph/world/distance_field.h>
#include <locograph/world/world.h>

namespace locograph {

/// Throws Error as DistanceField::from_octree does.
WorldDistance distance_view(const World& world, DistanceFieldOptions options = {});

/// Height of the highest level surface without an end; minus infinity if there is none.
double ground_height(const World& world);

}  // namespace locograph
