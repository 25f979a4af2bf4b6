#pragma once
/// Cameras and points of bundle adjustment.
///
///     TypeRegistry types;
///     add_bundle_types(types);

#include <locograph/core/type_registry.h>

namespace locograph {

/// Everything in bundle/.
void add_bundle_types(TypeRegistry& types);

}  // namespace locograph
