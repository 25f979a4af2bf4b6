#pragma once
/// Pose graphs with false loop closures, for the robustness benchmark and its test.
///
///     Graph graph = read_graph(file, standard_types());       // at its optimum
///     FalseClosures wrong = make_false_closures<EdgeSE2>(graph, 0.1, 1);
///     std::vector<EdgeId> added = wrong.add(other_graph);      // the same file, read again
///
/// A false closure ties two poses that are far apart by the measurement and the information of a
/// true closure: what a place recogniser does when two places look alike.

#include <locograph/core/graph.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace locograph {

template <class E>
struct FalseClosures {
  std::vector<E> edges;

  std::vector<EdgeId> add(Graph& graph) const {
    using V = typename E::template VertexAt<0>;
    std::vector<EdgeId> added;
    for (const E& edge : edges) {
      added.push_back(
          graph.add_edge(edge, VertexId<V>{edge.vertices[0]}, VertexId<V>{edge.vertices[1]}));
    }
    return added;
  }
};

/// As many that they are `fraction` of all closures. Far apart is a quarter of the map's diagonal.
template <class E>
FalseClosures<E> make_false_closures(const Graph& graph, double fraction, unsigned seed) {
  constexpr int kAxes = E::kDimension == 3 ? 2 : 3;
  using Position = Eigen::Matrix<double, kAxes, 1>;
  const auto position = [&](int slot) {
    return Position(Eigen::Map<const Position>(graph.state(slot)));
  };
  std::vector<const E*> closures;
  for (const E& edge : graph.edges_of<E>()) {
    const int a = graph.vertex_record(edge.vertices[0]).id;
    const int b = graph.vertex_record(edge.vertices[1]).id;
    if (std::abs(a - b) > 1) closures.push_back(&edge);
  }
  Position low = position(0), high = low;
  const int n = graph.vertex_slots();
  for (int v = 0; v < n; ++v) {
    low = low.cwiseMin(position(v));
    high = high.cwiseMax(position(v));
  }
  const double far = 0.25 * (high - low).norm();
  const auto count = static_cast<std::size_t>(
      std::ceil(static_cast<double>(closures.size()) * fraction / (1.0 - fraction)));
  std::mt19937 engine(seed);
  FalseClosures<E> result;
  while (result.edges.size() < count) {
    const int a = static_cast<int>(engine() % static_cast<unsigned>(n));
    const int b = static_cast<int>(engine() % static_cast<unsigned>(n));
    const E& model = *closures[engine() % closures.size()];
    if ((position(a) - position(b)).norm() < far) continue;
    result.edges.push_back(model);
    result.edges.back().vertices = {a, b};
  }
  return result;
}

}  // namespace locograph
