#include <locograph/planners/plan/plan_index.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

#include <algorithm>

namespace locograph {

PlanIndex plan_index(const Graph& graph, const std::vector<int>& slots) {
  PlanIndex index;
  index.configuration.assign(static_cast<std::size_t>(graph.vertex_slots()), -1);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    index.configuration[static_cast<std::size_t>(slots[i])] = static_cast<int>(i);
  }
  index.wrenches.resize(slots.size());
  index.segment.assign(slots.size(), -1);
  for (int edge = 0; edge < graph.edge_slots(); ++edge) {
    if (!graph.edge_alive(edge)) continue;
    for (const int a : graph.edge_vertices(edge)) {
      if (!vertex_is<VertexWrenches>(graph, a)) continue;
      for (const int b : graph.edge_vertices(edge)) {
        const int i = index.configuration[static_cast<std::size_t>(b)];
        if (i < 0) continue;
        std::vector<int>& bearing = index.wrenches[static_cast<std::size_t>(i)];
        if (std::ranges::find(bearing, a) == bearing.end()) bearing.push_back(a);
        break;
      }
    }
  }
  return index;
}

}  // namespace locograph
