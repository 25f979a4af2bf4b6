#pragma once
/// The exact solid of one of a robot's collision shapes, in the shape's own frame.
///
///     for (const CollisionShape& shape : robot.links()[link].collision)
///       solids.push_back(link_solid(robot, shape));
///
/// A mesh (STL) counts as its convex hull, scaled as the URDF says. Throws Error for a mesh that
/// was not found or cannot be read.

#include <locograph/robots/robot.h>
#include <locograph/world/convex_shape.h>

namespace locograph {

ConvexShape link_solid(const Robot& robot, const CollisionShape& shape);

}  // namespace locograph
