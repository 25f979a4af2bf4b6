#pragma once
/// Planar poses, points and lines, their measurements, and what calibrates sensors.
///
///     TypeRegistry types;
///     add_slam2d_types(types);

#include <locograph/core/type_registry.h>

namespace locograph {

/// Everything in slam2d/.
void add_slam2d_types(TypeRegistry& types);

}  // namespace locograph
