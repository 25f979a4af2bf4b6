#pragma once
/// The types every graph file may use: planar and spatial poses, points, lines and planes, their
/// measurements, and what calibrates sensors.
///
///     Graph graph = read_graph("sphere.g2o", standard_types());

#include <locograph/core/type_registry.h>

namespace locograph {

TypeRegistry standard_types();

/// Everything in slam2d/, and parts of it.
void add_slam2d_types(TypeRegistry& types);
void add_slam2d_calibration_types(TypeRegistry& types);
void add_slam2d_line_types(TypeRegistry& types);

/// Everything in slam3d/, and parts of it.
void add_slam3d_types(TypeRegistry& types);
void add_slam3d_prior_types(TypeRegistry& types);
void add_slam3d_plane_and_line_types(TypeRegistry& types);
void add_slam3d_expmap_types(TypeRegistry& types);

/// Everything in bundle/.
void add_bundle_types(TypeRegistry& types);

}  // namespace locograph
