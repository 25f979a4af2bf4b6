#include <gtest/gtest.h>
#include <locograph/core/connectivity.h>
#include <locograph/core/graph.h>
#include <locograph/types/slam2d/edges.h>

#include <algorithm>

#include "core/toy_types.h"

namespace locograph::test {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Five points in a row, an edge between neighbours whose measurement is its number.
struct Row {
  Graph graph;
  std::vector<VertexId<VertexXY>> points;
  std::vector<EdgeId> edges;

  Row() {
    for (int i = 0; i < 5; ++i) {
      points.push_back(graph.add_vertex(100 + i, VertexXY({1.0 * i, 0.5 * i})));
    }
    for (int i = 0; i + 1 < 5; ++i)
      edges.push_back(graph.add_edge(edge(i), points[i], points[i + 1]));
  }
  static EdgePointXY edge(int number) {
    EdgePointXY edge;
    edge.measurement = {1.0 * number, -1.0 * number};
    return edge;
  }
};

TEST(Graph, HoldsWhatWasAdded) {
  Row row;
  EXPECT_EQ(row.graph.vertex_count(), 5);
  EXPECT_EQ(row.graph.edge_count(), 4);
  EXPECT_EQ(row.graph.vertex(row.points[3]).state, Eigen::Vector2d(3.0, 1.5));
  EXPECT_EQ(row.graph.edge<EdgePointXY>(row.edges[2]).measurement, Eigen::Vector2d(2.0, -2.0));
  EXPECT_EQ(row.graph.find<VertexXY>(104), row.points[4]);
  EXPECT_EQ(row.graph.slot_of(99), -1);
  EXPECT_EQ(row.graph.vertices_of<VertexXY>().size(), 5u);
  EXPECT_EQ(row.graph.edges_of<EdgePointXY>().size(), 4u);
  EXPECT_TRUE(row.graph.vertices_of<VertexSE2>().empty());
  EXPECT_TRUE(row.graph.edges_of<EdgeSE2>().empty());
}

TEST(Graph, VerticesAreFixedAndFreed) {
  Row row;
  EXPECT_FALSE(row.graph.vertex_record(row.points[1].slot).fixed);
  row.graph.set_fixed(row.points[1], true);
  EXPECT_TRUE(row.graph.vertex_record(row.points[1].slot).fixed);
  row.graph.set_fixed(row.points[1], false);
  EXPECT_FALSE(row.graph.vertex_record(row.points[1].slot).fixed);
}

TEST(Graph, RemovingAVertexTakesItsEdgesAndLeavesAllOtherIdsValid) {
  Row row;
  row.graph.remove_vertex(row.points[1].slot);
  EXPECT_EQ(row.graph.vertex_count(), 4);
  EXPECT_EQ(row.graph.edge_count(), 2);
  EXPECT_EQ(row.graph.slot_of(101), -1);
  EXPECT_FALSE(row.graph.vertex_alive(row.points[1].slot));
  EXPECT_FALSE(row.graph.edge_alive(row.edges[0].slot));
  EXPECT_FALSE(row.graph.edge_alive(row.edges[1].slot));
  for (const int i : {0, 2, 3, 4}) {
    EXPECT_EQ(row.graph.vertex(row.points[i]).state, Eigen::Vector2d(1.0 * i, 0.5 * i));
    EXPECT_EQ(row.graph.find<VertexXY>(100 + i), row.points[i]);
  }
  for (const int i : {2, 3}) {
    EXPECT_EQ(row.graph.edge<EdgePointXY>(row.edges[i]).measurement,
              Eigen::Vector2d(1.0 * i, -1.0 * i));
    const std::span<const int> ends = row.graph.edge_vertices(row.edges[i].slot);
    EXPECT_EQ(ends[0], row.points[i].slot);
    EXPECT_EQ(ends[1], row.points[i + 1].slot);
  }
}

TEST(Graph, RemovingAnEdgeLeavesAllOtherIdsValid) {
  Row row;
  row.graph.remove_edge(row.edges[0]);
  EXPECT_EQ(row.graph.edge_count(), 3);
  for (const int i : {1, 2, 3}) {
    EXPECT_EQ(row.graph.edge<EdgePointXY>(row.edges[i]).measurement,
              Eigen::Vector2d(1.0 * i, -1.0 * i));
  }
  row.graph.remove_edge(row.edges[3]);
  EXPECT_EQ(row.graph.edge<EdgePointXY>(row.edges[2]).measurement, Eigen::Vector2d(2.0, -2.0));
  EXPECT_EQ(row.graph.vertex_count(), 5);
}

TEST(Graph, KeepsTheListsOfIncidentEdgesUpToDate) {
  Row row;
  const auto incident = [&](int i) { return row.graph.incident_edges(row.points[i].slot); };
  EXPECT_EQ(incident(2), (std::vector<int>{row.edges[1].slot, row.edges[2].slot}));
  row.graph.remove_edge(row.edges[1]);
  EXPECT_EQ(incident(2), std::vector<int>{row.edges[2].slot});
  EXPECT_EQ(incident(1), std::vector<int>{row.edges[0].slot});
  const VertexId<VertexXY> added = row.graph.add_vertex(7, VertexXY());
  EXPECT_TRUE(row.graph.incident_edges(added.slot).empty());
  const EdgeId e = row.graph.add_edge(Row::edge(9), added, row.points[2]);
  EXPECT_EQ(incident(2), (std::vector<int>{row.edges[2].slot, e.slot}));
  row.graph.remove_vertex(row.points[3].slot);
  EXPECT_EQ(incident(2), std::vector<int>{e.slot});
  EXPECT_TRUE(incident(4).empty());
}

TEST(Graph, AnIdMayBeUsedAgainAfterItsVertexWasRemoved) {
  Row row;
  row.graph.remove_vertex(row.points[2].slot);
  const VertexId<VertexXY> again = row.graph.add_vertex(102, VertexXY({8.0, 9.0}));
  EXPECT_NE(again, row.points[2]);
  EXPECT_EQ(row.graph.vertex(again).state, Eigen::Vector2d(8.0, 9.0));
  EXPECT_EQ(row.graph.vertex(row.points[4]).state, Eigen::Vector2d(4.0, 2.0));
}

TEST(Graph, SurvivesARandomSequenceOfEdits) {
  Graph graph;
  std::vector<std::pair<VertexId<VertexXY>, double>> vertices;
  std::vector<std::pair<EdgeId, double>> edges;
  unsigned state = 7;
  const auto random = [&state](std::size_t n) {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::size_t>(state >> 8) % n;
  };
  for (int step = 0; step < 3000; ++step) {
    const double value = step;
    if (vertices.size() < 3 || random(3) == 0) {
      vertices.emplace_back(graph.add_vertex(step, VertexXY({value, 0.0})), value);
    } else if (random(4) != 0) {
      const std::size_t a = random(vertices.size()), b = random(vertices.size());
      if (a == b) continue;
      EdgePointXY edge;
      edge.measurement[0] = value;
      edges.emplace_back(graph.add_edge(edge, vertices[a].first, vertices[b].first), value);
    } else if (random(2) == 0 && !edges.empty()) {
      const std::size_t e = random(edges.size());
      graph.remove_edge(edges[e].first);
      edges.erase(edges.begin() + static_cast<long>(e));
    } else {
      const std::size_t v = random(vertices.size());
      graph.remove_vertex(vertices[v].first.slot);
      vertices.erase(vertices.begin() + static_cast<long>(v));
      std::erase_if(edges, [&](const auto& e) { return !graph.edge_alive(e.first.slot); });
    }
  }
  ASSERT_EQ(graph.vertex_count(), static_cast<int>(vertices.size()));
  ASSERT_EQ(graph.edge_count(), static_cast<int>(edges.size()));
  ASSERT_GT(edges.size(), 20u);
  for (const auto& [id, value] : vertices) EXPECT_EQ(graph.vertex(id).state[0], value);
  for (const auto& [id, value] : edges) {
    EXPECT_EQ(graph.edge<EdgePointXY>(id).measurement[0], value);
    for (const int v : graph.edge_vertices(id.slot)) {
      const std::vector<int>& on_v = graph.incident_edges(v);
      EXPECT_EQ(std::count(on_v.begin(), on_v.end(), id.slot), 1);
    }
  }
}

TEST(Graph, RefusesAnIdThatIsTaken) {
  Row row;
  EXPECT_NE(message_of([&] { row.graph.add_vertex(103, VertexXY()); }).find("103"),
            std::string::npos);
  EXPECT_THROW(row.graph.add_vertex(103, VertexSE2()), Error);
  EXPECT_EQ(row.graph.vertex_count(), 5);
}

TEST(Graph, RefusesToFindAVertexOfAnotherType) {
  Row row;
  EXPECT_THROW(row.graph.find<VertexSE2>(103), Error);
  EXPECT_THROW(row.graph.find<VertexXY>(9), Error);
}

TEST(Graph, RefusesAnEdgeOnAVertexGivenTwice) {
  Row row;
  const std::string message =
      message_of([&] { row.graph.add_edge(Row::edge(0), row.points[1], row.points[1]); });
  EXPECT_NE(message.find("names vertex 101 twice"), std::string::npos) << message;
  EXPECT_THROW(row.graph.add_dynamic_edge(ToyMoments<Derivatives::kDual>(),
                                          {row.points[0], row.points[2], row.points[0]}),
               Error);
  EXPECT_EQ(row.graph.edge_count(), 4);
}

TEST(Graph, RefusesAnEdgeWithoutVerticesOrOnARemovedOne) {
  Row row;
  EXPECT_THROW(row.graph.add_dynamic_edge(ToyMoments<Derivatives::kDual>(), {}), Error);
  const VertexId<VertexSE2> pose = row.graph.add_vertex(7, VertexSE2());
  EXPECT_THROW(row.graph.add_dynamic_edge(ToyView<Derivatives::kDual>(), {}, pose), Error);
  row.graph.remove_vertex(row.points[2].slot);
  EXPECT_THROW(row.graph.add_edge(Row::edge(0), row.points[1], row.points[2]), Error);
  EXPECT_THROW(row.graph.add_edge(Row::edge(0), row.points[1], VertexId<VertexXY>{}), Error);
  EXPECT_THROW(row.graph.add_edge(Row::edge(0), row.points[1], VertexId<VertexXY>{77}), Error);
}

TEST(Graph, RefusesInformationThatIsNotSymmetricPositiveSemidefiniteFiniteAndOfTheRightSize) {
  Row row;
  const auto refusal = [&](const Eigen::Matrix2d& information) {
    EdgePointXY edge;
    edge.information = information;
    return message_of([&] { row.graph.add_edge(edge, row.points[0], row.points[2]); });
  };
  Eigen::Matrix2d m;
  m << 1.0, 0.5, 0.4, 1.0;
  EXPECT_NE(refusal(m).find("not symmetric"), std::string::npos) << refusal(m);
  m << 1.0, 2.0, 2.0, 1.0;
  EXPECT_NE(refusal(m).find("indefinite"), std::string::npos) << refusal(m);
  m << 1.0, 0.0, 0.0, std::nan("");
  EXPECT_NE(refusal(m).find("not finite"), std::string::npos) << refusal(m);
  m << 1.0, 0.0, 0.0, std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(m).find("not finite"), std::string::npos) << refusal(m);
  ToySignal signal;
  signal.resize(3);
  signal.information = Eigen::MatrixXd::Identity(3, 2);
  const std::string size = message_of([&] { row.graph.add_dynamic_edge(signal, row.points); });
  EXPECT_NE(size.find("size 3 x 2"), std::string::npos) << size;
  EXPECT_EQ(row.graph.edge_count(), 4);
}

TEST(Graph, AcceptsSemidefiniteInformation) {
  Row row;
  EdgePointXY edge;
  edge.information << 1.0, 1.0, 1.0, 1.0;
  row.graph.add_edge(edge, row.points[0], row.points[2]);
  edge.information.setZero();
  row.graph.add_edge(edge, row.points[0], row.points[3]);
  EXPECT_EQ(row.graph.edge_count(), 6);
}

TEST(Graph, SetsTheKernelOfEveryEdge) {
  Row row;
  row.graph.set_kernel(RobustKernel::parse("cauchy:2"));
  for (const EdgePointXY& edge : row.graph.edges_of<EdgePointXY>()) {
    EXPECT_EQ(edge.kernel, RobustKernel(RobustKernel::Kind::kCauchy, 2.0));
  }
}

TEST(Components, AreFoundWithWhatHoldsThemInPlace) {
  Row row;
  row.graph.add_vertex(500, VertexXY());
  const VertexId<VertexXY> held = row.graph.add_vertex(501, VertexXY());
  row.graph.add_dynamic_edge(ToyMoments<Derivatives::kDual>(), {held});
  row.graph.remove_edge(row.edges[1]);
  row.graph.set_fixed(row.points[4], true);
  const std::vector<Component> all = components(row.graph);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].first, row.points[0].slot);
  EXPECT_EQ(all[0].vertices, 2);
  EXPECT_FALSE(all[0].anchored);
  EXPECT_EQ(all[1].first, row.points[2].slot);
  EXPECT_EQ(all[1].vertices, 3);
  EXPECT_TRUE(all[1].anchored);
  EXPECT_FALSE(all[2].anchored);
  EXPECT_TRUE(all[3].anchored);
}

}  // namespace
}  // namespace locograph::test
