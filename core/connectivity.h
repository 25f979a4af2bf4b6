#pragma once
/// Connected components of a graph, and which of them nothing holds in place.
///
///     for (const Component& c : components(graph)) {
///       if (!c.anchored) graph.set_fixed(c.first, true);
///     }

#include <locograph/core/graph.h>

#include <vector>

namespace locograph {

struct Component {
  int first = -1;  ///< slot of its first vertex
  int vertices = 0;
  bool anchored = false;  ///< holds a fixed vertex, or an edge on a single vertex (a prior)
};

/// In order of their first vertex. Vertices without edges are components of their own.
std::vector<Component> components(const Graph& graph);

}  // namespace locograph
