#include <locograph/core/connectivity.h>

#include <numeric>

namespace locograph {

std::vector<Component> components(const Graph& graph) {
  std::vector<int> parent(graph.vertex_slots());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> anchored(graph.vertex_slots(), false);
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (!graph.edge_alive(e)) continue;
    const std::span<const int> vertices = graph.edge_vertices(e);
    if (vertices.size() == 1) anchored[vertices[0]] = true;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const int a = root(vertices[0]), b = root(vertices[i]);
      // The smaller slot is the root, so that a component's root is its first vertex.
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<Component> all;
  std::vector<int> component_of(graph.vertex_slots(), -1);
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (!graph.vertex_alive(v)) continue;
    int& component = component_of[root(v)];
    if (component < 0) {
      component = static_cast<int>(all.size());
      all.push_back({v, 0, false});
    }
    Component& c = all[component];
    ++c.vertices;
    c.anchored = c.anchored || anchored[v] || graph.vertex_record(v).fixed;
  }
  return all;
}

}  // namespace locograph
