#pragma once
/// Where the parts of a plan are in its graph, looked up once.
///
///     const PlanIndex index = plan_index(graph, slots);
///     int second = index.configuration[slots[1]];   // 1
///     bool is_borne = !index.wrenches[second].empty();

#include <locograph/core/graph.h>

#include <typeinfo>
#include <vector>

namespace locograph {

struct PlanIndex {
  /// By vertex slot: the place in Plan::slots; -1: a vertex of another type.
  std::vector<int> configuration;
  /// Of each configuration the slots of the VERTEX_WRENCHES that share an edge with it in which it
  /// is the first configuration.
  std::vector<std::vector<int>> wrenches;
  /// Of each configuration the last segment that holds it; -1: the plan has none.
  std::vector<int> segment;
};

/// Without segments, which parameters say. slots: of all configurations, in the order of the plan.
PlanIndex plan_index(const Graph& graph, const std::vector<int>& slots);

/// Whether a vertex or an edge that is alive has this type.
template <class V>
bool vertex_is(const Graph& graph, int slot) {
  return graph.vertex_pools()[graph.vertex_record(slot).pool]->type() == typeid(V);
}

template <class E>
bool edge_is(const Graph& graph, int slot) {
  return graph.edge_pools()[graph.edge_record(slot).pool]->type() == typeid(E);
}

}  // namespace locograph
