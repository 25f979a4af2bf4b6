#pragma once
/// The vertices, edges and parameters of robot plans.
///
///     TypeRegistry types = standard_types();
///     add_robot_types(types);
///     Graph plan = read_graph("plan.g2o", types);

#include <locograph/core/type_registry.h>

namespace locograph {

void add_robot_types(TypeRegistry& types);

}  // namespace locograph
