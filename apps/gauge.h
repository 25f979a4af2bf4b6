#pragma once
/// Holds what the measurements of a graph cannot place: one vertex of each part that floats freely.
///
///     Gauge gauge = hold_gauge(graph, "map.g2o", false);
///     optimise(graph, options, *solver);
///     gauge.release(graph);                 // so that no FIX line is written that was not read

#include <locograph/core/graph.h>

#include <string>
#include <vector>

namespace locograph {

struct Gauge {
  std::vector<int> held;  ///< slots
  std::string text;       ///< "vertex 0 held"

  void release(Graph& graph) const {
    for (const int slot : held) graph.set_fixed(slot, false);
  }
};

/// A connected graph without anchor (a fixed vertex, a prior) has one vertex held: its first one of
/// the largest dimension. A graph in several parts of which one is not anchored is an Error naming
/// file and line of that part's first vertex, unless lenient: then one vertex is held in each.
Gauge hold_gauge(Graph& graph, const std::string& file, bool lenient);

}  // namespace locograph
