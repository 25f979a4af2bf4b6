#include <locograph/apps/gauge.h>
#include <locograph/apps/output.h>
#include <locograph/core/connectivity.h>

#include <algorithm>
#include <deque>

namespace locograph {
namespace {

/// A point does not fix the rotation of the poses around it: a vertex of the largest dimension
/// does.
int vertex_to_hold(const Graph& graph, int first) {
  std::vector<bool> seen(graph.vertex_slots(), false);
  std::deque<int> queue = {first};
  seen[first] = true;
  int best = first;
  while (!queue.empty()) {
    const int vertex = queue.front();
    queue.pop_front();
    const int gained = graph.dimension(vertex) - graph.dimension(best);
    if (gained > 0 || (gained == 0 && vertex < best)) best = vertex;
    for (const int edge : graph.incident_edges(vertex)) {
      for (const int neighbour : graph.edge_vertices(edge)) {
        if (!seen[neighbour]) queue.push_back(neighbour);
        seen[neighbour] = true;
      }
    }
  }
  return best;
}

Error disconnected(const Graph& graph, const std::string& file, const std::vector<Component>& parts,
                   std::size_t number) {
  const Graph::VertexRecord& first = graph.vertex_record(parts[number].first);
  return Error(file, first.line,
               "the graph is disconnected: vertex " + std::to_string(first.id) + " begins part " +
                   std::to_string(number + 1) + " of " + std::to_string(parts.size()) + " (" +
                   std::to_string(parts[number].vertices) + " of " +
                   counted(graph.vertex_count(), "vertex", "vertices") +
                   "), which nothing holds in place",
               "a connected graph (--lenient holds one vertex of each part)");
}

std::string held_text(const Graph& graph, const std::vector<int>& held) {
  if (held.empty()) return "held by the file";
  std::string text = held.size() == 1 ? "vertex" : "vertices";
  constexpr std::size_t kMost = 10;
  for (std::size_t i = 0; i < std::min(held.size(), kMost); ++i) {
    text += (i == 0 ? " " : ", ") + std::to_string(graph.vertex_record(held[i]).id);
  }
  if (held.size() > kMost) text += " and " + std::to_string(held.size() - kMost) + " more";
  return text + " held";
}

}  // namespace

Gauge hold_gauge(Graph& graph, const std::string& file, bool lenient) {
  const std::vector<Component> parts = components(graph);
  std::vector<std::size_t> floating;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].anchored) floating.push_back(i);
  }
  if (!lenient && parts.size() > 1 && !floating.empty()) {
    // The first part may well be the map itself: name one that hangs off it, if there is one.
    throw disconnected(graph, file, parts, floating.size() == 1 ? floating[0] : floating[1]);
  }
  Gauge gauge;
  for (const std::size_t i : floating) {
    gauge.held.push_back(vertex_to_hold(graph, parts[i].first));
  }
  for (const int slot : gauge.held) graph.set_fixed(slot, true);
  gauge.text = held_text(graph, gauge.held);
  if (parts.size() > 1 && !gauge.held.empty()) {
    print_warning(file + ": the graph is in " + std::to_string(parts.size()) +
                  " unconnected parts: " + gauge.text);
  }
  return gauge;
}

}  // namespace locograph
