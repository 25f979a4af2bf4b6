#pragma once
/// The types that the commands know in a graph file.
///
///     Graph graph = read_graph("plan.g2o", graph_types());

#include <locograph/plugins/robot_types.h>
#include <locograph/types/standard_types.h>

namespace locograph {

inline TypeRegistry graph_types() {
  TypeRegistry types = standard_types();
  add_robot_types(types);
  return types;
}

}  // namespace locograph
