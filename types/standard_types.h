#pragma once
/// The types every graph file may use: planar and spatial poses, points and their measurements.
///
///     Graph graph = read_graph("sphere.g2o", standard_types());

#include <locograph/core/type_registry.h>

namespace locograph {

TypeRegistry standard_types();
void add_slam2d_types(TypeRegistry& types);
void add_slam3d_types(TypeRegistry& types);
void add_bundle_types(TypeRegistry& types);

}  // namespace locograph
