#pragma once
/// Spatial poses, points, planes and lines, and their measurements.
///
///     TypeRegistry types;
///     add_slam3d_types(types);

#include <locograph/core/type_registry.h>

namespace locograph {

/// Everything in slam3d/.
void add_slam3d_types(TypeRegistry& types);

}  // namespace locograph
