#include <gtest/gtest.h>
#include <locograph/core/diagnosis.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <atomic>

#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

bool names(const Diagnosis::Part& part, int vertex) {
  return std::any_of(part.loosest.begin(), part.loosest.end(),
                     [&](const auto& loose) { return loose.vertex == vertex; });
}

TEST(Diagnosis, FindsNothingInAHealthyGraph) {
  Graph graphs[] = {ring_2d(30), helix_3d(30)};
  for (Graph& graph : graphs) {
    const Diagnosis diagnosis = diagnose(graph);
    EXPECT_TRUE(diagnosis.healthy());
    EXPECT_EQ(diagnosis.text(graph), "");
    ASSERT_EQ(diagnosis.parts.size(), 1u);
    EXPECT_TRUE(diagnosis.parts[0].loosest.empty());
  }
}

TEST(Diagnosis, CountsTheFreeGaugeOfPlaneAndSpace) {
  Graph plane = ring_2d(50);
  plane.set_fixed(0, false);
  EXPECT_EQ(diagnose(plane).free_directions(), 3);
  Graph space = helix_3d(50);
  space.set_fixed(0, false);
  const Diagnosis diagnosis = diagnose(space);
  EXPECT_EQ(diagnosis.free_directions(), 6);
  EXPECT_FALSE(diagnosis.healthy());
  EXPECT_NE(diagnosis.text(space).find("6 directions are free, mostly at vertex"),
            std::string::npos)
      << diagnosis.text(space);
}

TEST(Diagnosis, TellsALongChainFromAFreeGauge) {
  // The smallest eigenvalue of the held chain is far below rounding.
  Graph graph;
  std::vector<VertexId<VertexSE2>> ids;
  for (int i = 0; i < 5000; ++i) {
    ids.push_back(graph.add_vertex(i, VertexSE2(SE2<double>(i, 0.0, 0.0))));
    if (i == 0) continue;
    EdgeSE2 edge;
    edge.measurement = SE2<double>(1.0, 0.0, 0.0);
    edge.information = Eigen::Vector3d(100.0, 100.0, 1000.0).asDiagonal();
    graph.add_edge(edge, ids[i - 1], ids[i]);
  }
  EXPECT_EQ(diagnose(graph).free_directions(), 3);
  graph.set_fixed(ids[2500], true);
  EXPECT_EQ(diagnose(graph).free_directions(), 0);
}

TEST(Diagnosis, NamesTheVertexThatIsNotMeasuredEnough) {
  Graph graph = ring_2d(20);
  const auto seen_once = graph.add_vertex(100, VertexXY({3.0, 3.0}));
  EdgeBearingSE2XY bearing;
  bearing.measurement = 0.5;
  graph.add_edge(bearing, VertexId<VertexSE2>{4}, seen_once);
  const auto seen_twice = graph.add_vertex(101, VertexXY({3.0, 4.0}));
  graph.add_edge(bearing, VertexId<VertexSE2>{4}, seen_twice);
  graph.add_edge(bearing, VertexId<VertexSE2>{9}, seen_twice);
  const Diagnosis diagnosis = diagnose(graph);
  EXPECT_EQ(diagnosis.free_directions(), 1);
  ASSERT_EQ(diagnosis.parts.size(), 1u);
  ASSERT_EQ(diagnosis.parts[0].loosest.size(), 1u);
  EXPECT_EQ(diagnosis.parts[0].loosest[0].vertex, seen_once.slot);
  EXPECT_NEAR(diagnosis.parts[0].loosest[0].share, 1.0, 1e-6);
  EXPECT_NE(diagnosis.text(graph).find("1 direction is free, mostly at vertex 100 (VERTEX_XY)"),
            std::string::npos)
      << diagnosis.text(graph);
}

TEST(Diagnosis, ListsUnconnectedPartsAndWhichOfThemFloats) {
  Graph graph = ring_2d(10);
  const auto a = graph.add_vertex(100, VertexSE2(SE2<double>(5.0, 0.0, 0.0)));
  const auto b = graph.add_vertex(101, VertexSE2(SE2<double>(6.0, 0.0, 0.0)));
  EdgeSE2 edge;
  edge.measurement = SE2<double>(1.0, 0.0, 0.0);
  graph.add_edge(edge, a, b);
  const auto alone = graph.add_vertex(200, VertexXY({1.0, 1.0}));
  const Diagnosis diagnosis = diagnose(graph);
  ASSERT_EQ(diagnosis.parts.size(), 3u);
  EXPECT_EQ(diagnosis.parts[0].free_directions, 0);
  EXPECT_EQ(diagnosis.parts[1].free_directions, 3);
  EXPECT_TRUE(names(diagnosis.parts[1], a.slot) && names(diagnosis.parts[1], b.slot));
  EXPECT_EQ(diagnosis.parts[2].free_directions, 2);
  ASSERT_EQ(diagnosis.parts[2].loosest.size(), 1u);
  EXPECT_EQ(diagnosis.parts[2].loosest[0].vertex, alone.slot);
  EXPECT_NEAR(diagnosis.parts[2].loosest[0].share, 2.0, 1e-9);
  const std::string text = diagnosis.text(graph);
  EXPECT_NE(text.find("3 unconnected parts"), std::string::npos) << text;
  EXPECT_NE(text.find("part 2: vertex 100 and 1 more, held by nothing"), std::string::npos) << text;
}

TEST(Diagnosis, NamesEdgeAndLineOfABadInformationMatrix) {
  Graph graph = read_graph_text(
      "VERTEX_XY 1 0 0\nVERTEX_XY 2 1 0\nFIX 1\n"
      "EDGE_POINTXY 1 2 1 0 2 0 2\nEDGE_POINTXY 1 2 1 0 1 1 1\n",
      "map.g2o", {}, standard_types());
  Diagnosis diagnosis = diagnose(graph);
  ASSERT_EQ(diagnosis.information.size(), 1u);
  EXPECT_EQ(diagnosis.information[0].smallest_eigenvalue, 0.0);
  EXPECT_TRUE(diagnosis.healthy()) << "a singular matrix is allowed";
  EXPECT_NE(diagnosis.text(graph).find("EDGE_POINTXY 1 2 (line 5) is singular"), std::string::npos)
      << diagnosis.text(graph);
  graph.edge<EdgePointXY>({1}).information << 1.0, 2.0, 2.0, 1.0;
  diagnosis = diagnose(graph);
  ASSERT_EQ(diagnosis.information.size(), 1u);
  EXPECT_NEAR(diagnosis.information[0].smallest_eigenvalue, -1.0, 1e-12);
  EXPECT_FALSE(diagnosis.healthy());
}

TEST(Diagnosis, NamesTheEdgeWhoseErrorIsNotANumber) {
  Graph graph;
  const auto p = graph.add_vertex(7, VertexXY());
  graph.add_edge(ToyArctan(), p);
  const EdgeId bad = graph.add_edge(ToyNotANumber(), p);
  const Diagnosis diagnosis = diagnose(graph);
  ASSERT_EQ(diagnosis.not_finite.size(), 1u);
  EXPECT_EQ(diagnosis.not_finite[0], bad);
  EXPECT_EQ(diagnosis.text(graph), "the error of TOY_NOT_A_NUMBER 7 is not a number\n");
}

TEST(Diagnosis, SaysThatItWasEndedBeforeItHadLookedAtEverything) {
  Graph graph = helix_3d(50);
  graph.set_fixed(0, false);
  const std::atomic<bool> stop = true;
  for (const Termination& termination :
       {Termination{.stop = &stop}, Termination{.deadline = Deadline::after(0.0)}}) {
    const Diagnosis diagnosis = diagnose(graph, {}, termination);
    EXPECT_FALSE(diagnosis.complete);
    EXPECT_FALSE(diagnosis.healthy());
    EXPECT_EQ(diagnosis.free_directions(), 0);
    EXPECT_NE(diagnosis.text(graph).find("ended before"), std::string::npos);
  }
  const std::atomic<bool> go_on = false;
  EXPECT_EQ(diagnose(graph, {}, {.stop = &go_on}).free_directions(), 6);
}

TEST(Diagnosis, FindsTheGaugeOfAPoseGraphFile) {
  const std::filesystem::path file =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" / "CSAIL.g2o";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  Graph graph = read_graph(file, standard_types());
  EXPECT_EQ(diagnose(graph).free_directions(), 3);
  graph.set_fixed(0, true);
  EXPECT_EQ(diagnose(graph).free_directions(), 0);
}

}  // namespace
}  // namespace locograph::test
