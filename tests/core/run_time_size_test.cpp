// Edges whose arity or size is known at run time only, in files.

#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/slam2d/vertices.h>

#include <random>

namespace locograph::test {
namespace {

/// Any number of rows on any number of points, with one weight a row.
struct ToyRows : WeightedEdge<Eigen::Dynamic, VertexXY> {
  Eigen::VectorXd measurement;
  auto fields() { return std::tie(measurement); }
  void resize(int size) {
    measurement.setZero(size);
    weights.setOnes(size);
  }
  void error(const Eigen::Vector2d& p, Eigen::Ref<Eigen::VectorXd> e) const {
    e = p[0] * measurement.array() + p[1];
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_ROWS", ToyRows)

/// The sum of points. Error (2) [m].
struct ToySum : DynamicEdge<2, VertexXY> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }
  void error(std::span<const Eigen::Vector2d> points, Eigen::Ref<Eigen::Vector2d> e) const {
    e = -measurement;
    for (const Eigen::Vector2d& p : points) e += p;
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_SUM", ToySum)

Graph read(const std::string& text) {
  TypeRegistry types;
  types.add_vertex<VertexXY>();
  types.add_edge<ToyRows>();
  types.add_edge<ToySum>();
  return read_graph_text(text, "sizes.g2o", {}, types);
}

TEST(RunTimeSize, ComesBackFromAFileBitForBit) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  Graph graph;
  std::vector<VertexId<VertexXY>> points;
  for (int i = 0; i < 12; ++i) {
    points.push_back(graph.add_vertex(i, VertexXY({normal(engine), normal(engine)})));
  }
  for (int count = 1; count <= 12; ++count) {
    ToySum sum;
    sum.measurement << normal(engine) / 3.0, 1e-300 * normal(engine);
    sum.information << 2.0 / 3.0, 0.1, 0.1, 1.0 / 7.0;
    graph.add_dynamic_edge(sum, {points.begin(), points.begin() + count});
    ToyRows rows;
    rows.resize(count);
    for (int i = 0; i < count; ++i) rows.measurement[i] = normal(engine) * 1e17;
    for (int i = 0; i < count && count % 2 == 0; ++i) rows.weights[i] = std::abs(normal(engine));
    graph.add_edge(rows, points[0]);
  }
  const std::string text = write_graph_text(graph);
  const Graph again = read(text);
  EXPECT_EQ(write_graph_text(again), text);
  ASSERT_EQ(again.edges_of<ToySum>().size(), 12u);
  for (int i = 0; i < 12; ++i) {
    const ToySum &a = graph.edges_of<ToySum>()[i], &b = again.edges_of<ToySum>()[i];
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.measurement, b.measurement);
    EXPECT_EQ(a.information, b.information);
    EXPECT_EQ(graph.edges_of<ToyRows>()[i].measurement, again.edges_of<ToyRows>()[i].measurement);
    EXPECT_EQ(graph.edges_of<ToyRows>()[i].weights, again.edges_of<ToyRows>()[i].weights);
  }
}

TEST(RunTimeSize, BeyondWhatTheLineCanHoldIsAnErrorBeforeMemoryIsTaken) {
  for (const char* edge : {"TOY_ROWS 0 2000000000 1 2 scalar 1", "TOY_ROWS 0 2147483647 scalar 1",
                           "TOY_ROWS 0 70000 diagonal 1 1", "TOY_ROWS 0 3 1 2 scalar 1",
                           "TOY_ROWS 0 -1 scalar 1", "TOY_ROWS 0 99999999999 scalar 1",
                           "TOY_ROWS 0 65536 scalar 1", "TOY_SUM 0 || 2000000000 1 1 1 0 1"}) {
    try {
      read("VERTEX_XY 0 0 0\n" + std::string(edge) + "\n");
      ADD_FAILURE() << edge;
    } catch (const Error& error) {
      EXPECT_EQ(error.line(), 2) << error.what();
    }
  }
}

}  // namespace
}  // namespace locograph::test
