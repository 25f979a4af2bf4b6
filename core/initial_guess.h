#pragma once
/// First values of vertices from the measurements on edges, by walking along edges that can predict
/// one vertex from another.
///
///     guess_from_spanning_tree(graph);
///
/// Fixed vertices are where the walk starts, or the first vertex of each component when none is.
/// Vertices that no such edge reaches keep their state; the number of them is returned.

#include <locograph/core/graph.h>

namespace locograph {

/// Breadth-first: every vertex by the fewest measurements from the start.
int guess_from_spanning_tree(Graph& graph);
/// Along consecutive ids first (the order of driving), the rest breadth-first.
int guess_from_odometry(Graph& graph);
/// For a graph whose vertices were made from its edges: the better of the two, by initial cost.
void initialise_from_edges(Graph& graph);

}  // namespace locograph
