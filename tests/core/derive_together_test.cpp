#include <gtest/gtest.h>

#include "core/toy_types.h"

namespace locograph::test {
namespace {

std::vector<std::size_t> groups;

/// A number whose square is derived, of several vertices at once.
struct VertexSquare : Vertex<1, 1> {
  struct Derived {
    double square = 0.0;
  };
  static void oplus(const double* s, const double* d, double* out) { out[0] = s[0] + d[0]; }
  Derived make_derived() const { return {}; }
  void derive(const double* s, Derived& derived) const { derived.square = s[0] * s[0]; }
  static void derive_together(std::span<const Derivation<VertexSquare>> vertices) {
    groups.push_back(vertices.size());
    for (const auto& [vertex, state, derived] : vertices) vertex->derive(state, *derived);
  }
};
LOCOGRAPH_REGISTER_VERTEX("SQUARE", VertexSquare)

/// Error (1): a square less another number.
struct SquareIs : Edge<1, VertexSquare> {
  double number = 0.0;
  void error(const VertexSquare::Derived& q, Eigen::Ref<Error> e) const {
    e[0] = q.square - number;
  }
};
LOCOGRAPH_REGISTER_EDGE("SQUARE_IS", SquareIs)

TEST(DeriveTogether, GivesEachVertexItsOwn) {
  constexpr int kVertices = 70;
  Graph graph;
  for (int i = 0; i < kVertices; ++i) {
    VertexSquare vertex;
    vertex.state[0] = 0.5 * i;
    SquareIs edge;
    edge.number = i;
    graph.add_edge(edge, graph.add_vertex(i, vertex));
  }
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  groups.clear();
  double expected = 0.0;
  for (int i = 0; i < kVertices; ++i) expected += (0.25 * i * i - i) * (0.25 * i * i - i);
  EXPECT_DOUBLE_EQ(workspace.evaluate(workspace.state()).chi2, expected);
  EXPECT_EQ(groups, (std::vector<std::size_t>{32, 32, 6}));
}

/// Of a window that slides, only what is new.
TEST(DeriveTogether, LeavesOutWhatIsKnown) {
  Graph graph;
  std::vector<int> slots;
  for (int i = 0; i < 8; ++i) {
    VertexSquare vertex;
    vertex.state[0] = i;
    const VertexId<VertexSquare> id = graph.add_vertex(i, vertex);
    graph.add_edge(SquareIs(), id);
    slots.push_back(id.slot);
  }
  const auto window = [&](int first, int count) {
    return std::vector<int>(slots.begin() + first, slots.begin() + first + count);
  };
  Problem problem;
  problem.compile(graph, window(0, 5), {});
  Workspace workspace;
  workspace.keep();
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());
  workspace.keep();
  problem.compile(graph, window(2, 6), {});
  workspace.allocate(problem);
  workspace.load_state();
  groups.clear();
  const double expected = 16.0 + 81.0 + 256.0 + 625.0 + 1296.0 + 2401.0;
  EXPECT_DOUBLE_EQ(workspace.evaluate(workspace.state()).chi2, expected);
  EXPECT_EQ(groups, (std::vector<std::size_t>{3}));
}

}  // namespace
}  // namespace locograph::test
