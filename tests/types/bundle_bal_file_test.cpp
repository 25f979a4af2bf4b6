#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/bundle/bal_file.h>
#include <locograph/types/bundle/camera_bal.h>
#include <locograph/types/bundle/inverse_depth.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/standard_types.h>

#include <filesystem>

namespace locograph {
namespace {

const std::string kSmall =
    "2 1 2\n"
    "\n"
    "0 0     -1.5e+01 +2.25\n"
    "1 0 3 -4\n"
    "0.1\n0.2\n0.3\n1\n2\n3\n500\n-1e-7\n1e-13\n"
    "0\n0\n0\n0\n0\n0\n510\n0\n0\n"
    "7\n8\n-9.5\n";

TEST(BalFile, BecomesCamerasPointsAndObservations) {
  const Graph graph = read_bal_text(kSmall, "small.txt");
  ASSERT_EQ(graph.vertices_of<VertexCameraBAL>().size(), 2u);
  ASSERT_EQ(graph.vertices_of<VertexPointXYZ>().size(), 1u);
  ASSERT_EQ(graph.edges_of<EdgeProjectBAL>().size(), 2u);
  VertexCameraBAL::State camera;
  camera << 0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 500.0, -1e-7, 1e-13;
  EXPECT_EQ(graph.vertices_of<VertexCameraBAL>()[0].state, camera);
  EXPECT_EQ(graph.vertices_of<VertexPointXYZ>()[0].state, Eigen::Vector3d(7.0, 8.0, -9.5));
  EXPECT_EQ(graph.edges_of<EdgeProjectBAL>()[0].measurement, Eigen::Vector2d(-15.0, 2.25));
  EXPECT_EQ(graph.edges_of<EdgeProjectBAL>()[1].vertices,
            (std::array<int, 2>{graph.slot_of(1), graph.slot_of(2)}));
  EXPECT_FALSE(graph.vertex_record(graph.slot_of(1)).eliminate);
  EXPECT_TRUE(graph.vertex_record(graph.slot_of(2)).eliminate);
}

TEST(BalFile, IsSavedAsAGraphFileWithoutLoss) {
  const Graph graph = read_bal_text(kSmall, "small.txt");
  const std::string text = write_graph_text(graph);
  const Graph again = read_graph_text(text, "small.g2o", {}, standard_types());
  EXPECT_EQ(write_graph_text(again), text);
  EXPECT_EQ(again.vertices_of<VertexCameraBAL>()[0].state,
            graph.vertices_of<VertexCameraBAL>()[0].state);
}

TEST(BalFile, ThatIsDamagedIsAnErrorWithItsLine) {
  const auto expect_refused = [](std::string text, int line) {
    try {
      read_bal_text(text, "bad.txt");
      ADD_FAILURE() << "accepted:\n" << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), "bad.txt");
      EXPECT_EQ(error.line(), line) << error.what();
    }
  };
  const auto replaced = [](const std::string& from, const std::string& to) {
    std::string text = kSmall;
    return text.replace(text.find(from), from.size(), to);
  };
  expect_refused("", 1);
  expect_refused("2 1\n", 2);
  expect_refused("0 0 0\n", 1);
  expect_refused("-2 1 2\n", 1);
  expect_refused("2 1 99999999\n1 1", 1);
  expect_refused(replaced("2 1 2", "2 1.5 2"), 1);
  expect_refused(replaced("1 0 3 -4", "2 0 3 -4"), 4);   // no such camera
  expect_refused(replaced("1 0 3 -4", "1 -1 3 -4"), 4);  // no such point
  expect_refused(replaced("1 0 3 -4", "1 0 3 nan"), 4);
  expect_refused(replaced("1 0 3 -4", "1 0 x -4"), 4);
  expect_refused(replaced("0.3\n", "0.3f\n"), 7);
  expect_refused(replaced("0.3\n", "1e999\n"), 7);
  expect_refused(replaced("-9.5\n", ""), 25);
  expect_refused(kSmall + "1\n", 26);
}

TEST(BalFile, ThatIsMissingIsAnError) { EXPECT_THROW(read_bal("/no/such/file.txt"), Error); }

TEST(BalFile, IsToldFromOtherText) {
  EXPECT_TRUE(looks_like_bal(kSmall));
  EXPECT_TRUE(looks_like_bal("\n 3 7 19 \r\n0 0 1 1"));
  for (const char* other : {"", "\n", "3 7", "3 7 19 2\n", "3 7 -19\n", "VERTEX_SE2 0 1 2 3\n",
                            "# 1 2 3\n", "1.0 2 3\n"}) {
    EXPECT_FALSE(looks_like_bal(other)) << other;
  }
}

TEST(BalFile, OfTheSharedDataIsRead) {
  const std::filesystem::path file =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "bundle/dubrovnik-3-7-pre.txt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const Graph graph = read_bal(file);
  EXPECT_EQ(graph.vertex_count(), 10);
  EXPECT_EQ(graph.edge_count(), 19);
}

TEST(PointsOfAGraph, AreMarkedWhereThatPays) {
  const auto eliminated = [](const Graph& graph) {
    int count = 0;
    for (int v = 0; v < graph.vertex_slots(); ++v) count += graph.vertex_record(v).eliminate;
    return count;
  };
  const std::string pose = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n";
  const std::string points = "VERTEX_TRACKXYZ 1 1 0 0\nVERTEX_TRACKXYZ 2 0 1 0\n";
  Graph graph = read_graph_text(pose + points, "a.g2o", {}, standard_types());
  EXPECT_EQ(mark_points_for_elimination(graph), 2);
  EXPECT_EQ(eliminated(graph), 2);
  // As many poses as points; then points that are tied to each other.
  graph = read_graph_text(pose + "VERTEX_SE3:QUAT 5 0 0 0 0 0 0 1\n" + points, "b.g2o", {},
                          standard_types());
  EXPECT_EQ(mark_points_for_elimination(graph), 0);
  graph = read_graph_text(pose + points + "EDGE_POINT_XYZ 1 2 0 0 0 1 0 0 1 0 1\n", "c.g2o", {},
                          standard_types());
  EXPECT_EQ(mark_points_for_elimination(graph), 0);
  EXPECT_EQ(eliminated(graph), 0);
}

}  // namespace
}  // namespace locograph
