#pragma once
/// The types every graph file may use: planar and spatial poses, points, lines and planes, their
/// measurements, and what calibrates sensors.
///
///     Graph graph = read_graph("sphere.g2o", standard_types());

#include <locograph/core/type_registry.h>

namespace locograph {

TypeRegistry standard_types();

}  // namespace locograph
