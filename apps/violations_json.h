#pragma once
/// The violated constraints of a graph as JSON.
///
///     add_violations(json, graph);     // "constraints": 210, "violated_rows": 3, "violations":
///     […]

#include <locograph/apps/output.h>
#include <locograph/core/graph.h>

namespace locograph {

/// Adds the number of constraint edges, of their rows that are violated, and the worst of these,
/// worst first. Nothing where the graph has no constraints.
void add_violations(Json& json, Graph& graph);

}  // namespace locograph
