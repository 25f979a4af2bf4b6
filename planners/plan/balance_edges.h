#pragma once
/// The wrenches that hold a configuration, and the edges that say so.
///
///     const auto q = graph.add_vertex(0, VertexConfiguration(0, robot, 0.0, configuration, 20));
///     add_balance_edges(graph, q, *stance, wrenches, 1, problem.check);

#include <locograph/check/check_report.h>
#include <locograph/core/graph.h>
#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

namespace locograph {

/// Adds a VERTEX_WRENCHES of this id for the contacts of a stance that bear load, with balance,
/// friction and, where they are enforced, torque limits. wrenches: one for each contact.
void add_balance_edges(Graph& graph, VertexId<VertexConfiguration> configuration,
                       const StanceParameter& bearing, const StanceWrenches& wrenches, int id,
                       const CheckOptions& check);

}  // namespace locograph
