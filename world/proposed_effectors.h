#pragma once
/// What a robot can stand or roll on, by the shapes of its last links: end effectors to begin with
/// where nobody has named any.
///
///     for (const EndEffector& foot : proposed_effectors(robot)) std::cout << foot.link << '\n';
///
/// Looked at with joints at 0, or at the limit nearest to 0, and the base upright. Of the bodies
/// that move nothing further, those are taken whose lowest point is as low as the robot's, up to a
/// twentieth of its height:
///
///   wheel    its joint turns without an end about an axle that lies, and it is round about that:
///            its radius, and the middle of its axle
///   surface  the largest flat that looks down, within a millimetre: the largest rectangle in the
///            convex hull of the points there, at least 2 cm long and wide, along the flat's own
///            smallest frame. What is furthest out is the plane, so that nothing reaches beyond
///   point    the sphere or capsule's end that is lowest, or, of a mesh, the sphere that is nearest
///            to what it rolls on up to a slope of 40 degrees, within 1.5 mm and around it; else
///            the lowest point, without a radius
///
/// Names are those of the links. Largest forces are twice the robot's weight, in tens of newtons;
/// friction is left out (0). Throws Error for a mesh that is missing or cannot be read.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

#include <vector>

namespace locograph {

std::vector<EndEffector> proposed_effectors(const Robot& robot);

}  // namespace locograph
