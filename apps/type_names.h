#pragma once
/// What kinds of joints and shapes are called in a command's JSON, and how its limits are written.
///
///     Json json = {{"type", type_name(joint.type)}, {"upper", limit_json(joint.upper)}};

#include <locograph/apps/output.h>
#include <locograph/robots/robot.h>
#include <locograph/world/obstacles.h>

namespace locograph {

const char* type_name(JointType type);
const char* type_name(ShapeType type);
const char* type_name(Obstacle::Shape shape);

/// JSON has no infinity: what is unlimited is null.
Json limit_json(double value);

}  // namespace locograph
