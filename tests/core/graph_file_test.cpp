#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/standard_types.h>

#include <cstring>

#include "common/temporary_folder.h"
#include "core/toy_types.h"

namespace locograph::test {
namespace {

TypeRegistry types_with_toys() {
  TypeRegistry types = standard_types();
  types.add_vertex<VertexJoints>();
  types.add_edge<ToyMoments<Derivatives::kDual>>();
  types.add_edge<ToyView<Derivatives::kDual>>();
  types.add_edge<ToySignal>();
  types.add_edge<ToyPosture>();
  return types;
}

Graph read(std::string_view text, ReadReport* report = nullptr) {
  return read_graph_text(text, "test.g2o", {}, types_with_toys(), {}, report);
}

void expect_same_states(const Graph& a, const Graph& b) {
  ASSERT_EQ(a.vertex_slots(), b.vertex_slots());
  for (int v = 0; v < a.vertex_slots(); ++v) {
    ASSERT_EQ(a.vertex_record(v).id, b.vertex_record(v).id);
    ASSERT_EQ(a.vertex_record(v).fixed, b.vertex_record(v).fixed);
    ASSERT_EQ(a.state_size(v), b.state_size(v));
    ASSERT_EQ(std::memcmp(a.state(v), b.state(v), sizeof(double) * a.state_size(v)), 0)
        << "vertex " << a.vertex_record(v).id;
  }
}

/// load → save → load → save: the same states and the same text.
void expect_round_trip(const Graph& graph) {
  const std::string first = write_graph_text(graph);
  const Graph again = read(first);
  expect_same_states(graph, again);
  EXPECT_EQ(again.edge_count(), graph.edge_count());
  EXPECT_EQ(write_graph_text(again), first);
}

TEST(GraphFile, IsReadWithCommentsBlanksAndLinesInAnyOrder) {
  const Graph graph = read(
      "# a comment line\n"
      "EDGE_SE2 0 7   1 0 0.1   1 0 0 1 0 1   # edges before vertices\n"
      "\n"
      "   \t \r\n"
      "FIX 0 7\n"
      "  VERTEX_SE2 0 0 0 0\r\n"
      "\tVERTEX_SE2\t7\t1 2 3#comment right behind\n"
      "#VERTEX_SE2 8 0 0 0\n"
      "EDGE_SE2 7 0   -1 0 -0.1   1 0 0 1 0 1");
  EXPECT_EQ(graph.vertex_count(), 2);
  EXPECT_EQ(graph.edge_count(), 2);
  EXPECT_EQ(graph.vertex(graph.find<VertexSE2>(7)).state, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(graph.vertex_record(graph.slot_of(0)).fixed);
  EXPECT_TRUE(graph.vertex_record(graph.slot_of(7)).fixed);
}

TEST(GraphFile, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(read("\xEF\xBB\xBFVERTEX_XY 4 1 2\n").vertex_count(), 1);
}

TEST(GraphFile, RemembersTheLineOfEveryVertexAndEdge) {
  const Graph graph = read("\nVERTEX_XY 4 1 2\n\nEDGE_POINTXY 4 5 0 0 1 0 1\nVERTEX_XY 5 1 2\n");
  EXPECT_EQ(graph.vertex_record(graph.slot_of(4)).line, 2);
  EXPECT_EQ(graph.vertex_record(graph.slot_of(5)).line, 5);
  EXPECT_EQ(graph.edge_record(0).line, 4);
}

TEST(GraphFile, InformationIsTheUpperTriangleRowByRow) {
  const Graph graph =
      read("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 11 1 2 22 3 33\n");
  Eigen::Matrix3d expected;
  expected << 11, 1, 2, 1, 22, 3, 2, 3, 33;
  EXPECT_EQ(graph.edges_of<EdgeSE2>()[0].information, expected);
}

TEST(GraphFile, QuaternionsAreWrittenVectorFirstAndNormalised) {
  const Graph graph = read("VERTEX_SE3:QUAT 0 1 2 3 0 0 3 4\n");
  const SE3<double> pose = graph.vertices_of<VertexSE3>()[0].pose();
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(pose.rotation().z(), 0.6, 1e-15);
  EXPECT_NEAR(pose.rotation().w(), 0.8, 1e-15);
}

TEST(GraphFile, WithoutVerticesGetsThemFromItsEdges) {
  ReadReport report;
  const Graph graph = read(
      "  EDGE_SE2 0 1 1 0 1.5707963267948966 1 0 0 1 0 1\n"
      "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
      "EDGE_SE2_XY 2 9 0.5 0 1 0 1\n"
      "FIX 0\n",
      &report);
  EXPECT_TRUE(report.vertices_from_edges);
  EXPECT_EQ(graph.vertex_count(), 4);
  EXPECT_TRUE(graph.vertex_record(graph.slot_of(0)).fixed);
  EXPECT_LE(
      (graph.vertex(graph.find<VertexSE2>(2)).state - Eigen::Vector3d(1.0, 1.0, 1.5707963267948966))
          .norm(),
      1e-15);
  EXPECT_LE((graph.vertex(graph.find<VertexXY>(9)).state - Eigen::Vector2d(1.0, 1.5)).norm(),
            1e-15);
}

TEST(GraphFile, AnAliasOfATagIsKept) {
  const std::string text = "VERTEX_POINT_XYZ 0 1 2 3\nVERTEX_TRACKXYZ 1 4 5 6\n";
  const Graph graph = read(text);
  EXPECT_EQ(graph.vertices_of<VertexPointXYZ>().size(), 2u);
  EXPECT_EQ(write_graph_text(graph), text);
}

TEST(GraphFile, ParametersOfEachKindAreReadUsedAndWritten) {
  const std::string text =
      "PARAMS_SE2OFFSET 0 0.5 0.25 1\n"
      "PARAMS_SE3OFFSET 3 1 2 3 0 0 0 1\n"
      "PARAMS_CAMERACALIB 7 0 0 0 0 0 0 1 500 510 320 240\n"
      "VERTEX_SE2 0 0 0 0\n"
      "FIX 0\n"
      "VERTEX_XY 1 1 1\n"
      "VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1\n"
      "VERTEX_TRACKXYZ 3 0 0 2\n"
      "EDGE_SE2_XY_OFFSET 0 1 0 0.5 0.5 1 0 1\n"
      "EDGE_SE3_TRACKXYZ 2 3 3 1 1 1 1 0 0 1 0 1\n"
      "EDGE_PROJECT_DEPTH 2 3 7 320 240 2 1 0 0 1 0 1\n"
      "EDGE_SE3_PRIOR 2 7 0 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n";
  const Graph graph = read(text);
  EXPECT_EQ(graph.edges_of<EdgeSE2XYOffset>()[0].offset.translation(), Eigen::Vector2d(0.5, 0.25));
  EXPECT_EQ(graph.edges_of<EdgeSE3PointXYZ>()[0].offset.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(graph.edges_of<EdgeProjectDepth>()[0].camera->fx, 500.0);
  EXPECT_EQ(write_graph_text(graph), text);
}

TEST(GraphFile, EdgesOfRunTimeArityAreReadAndWritten) {
  const std::string text =
      "VERTEX_XY 0 1 2\nVERTEX_XY 1 3 4\nVERTEX_XY 2 5 6\nVERTEX_SE2 9 0 0 0\n"
      "TOY_MOMENTS_DUAL 0 || 2 1 2 1 0 1\n"
      "TOY_MOMENTS_DUAL 2 0 1 || 2 1 2 1 0.5 1\n"
      "TOY_VIEW_DUAL 9 1 2 || 3 1 2 3 1 0 0 1 0 1\n";
  const Graph graph = read(text);
  EXPECT_EQ(graph.edge_vertices(0).size(), 1u);
  const std::vector<int> expected{graph.slot_of(2), graph.slot_of(0), graph.slot_of(1)};
  EXPECT_TRUE(std::ranges::equal(graph.edge_vertices(1), expected));
  EXPECT_EQ(graph.edge_vertices(2).size(), 3u);
  EXPECT_EQ(write_graph_text(graph), text);
}

TEST(GraphFile, ErrorsAndVerticesOfRunTimeSizeAreReadAndWritten) {
  const std::string text =
      "VERTEX_XY 0 1 2\nVERTEX_XY 1 3 4\nTOY_JOINTS 5 3 0.5 1 2\n"
      "TOY_SIGNAL 0 1 || 1 0.5 4\n"
      "TOY_SIGNAL 1 0 || 3 0.5 1 2 1 0 0 1 0 1\n"
      "TOY_POSTURE 5 3 0.5 1 2 1 0 0 1 0 1\n";
  const Graph graph = read(text);
  EXPECT_EQ(graph.edge_pools()[0]->dimension(0), 1);
  EXPECT_EQ(graph.edge_pools()[0]->dimension(1), 3);
  EXPECT_EQ(graph.vertices_of<VertexJoints>()[0].dimension(), 3);
  EXPECT_EQ(write_graph_text(graph), text);
}

TEST(GraphFile, OddNumbersComeBackBitForBit) {
  Graph graph;
  graph.add_vertex(0, VertexXY({0.1, 1.0 / 3.0}));
  graph.add_vertex(-3, VertexXY({-0.0, 5e-324}));
  graph.add_vertex(2147483647, VertexXY({1.7976931348623157e308, -2.2250738585072014e-308}));
  expect_round_trip(graph);
}

TEST(GraphFile, HoldsOnlyWhatIsLeftAfterEdits) {
  Graph graph = read(
      "VERTEX_XY 0 1 2\nVERTEX_XY 1 3 4\nVERTEX_XY 2 5 6\n"
      "EDGE_POINTXY 0 1 1 1 1 0 1\nEDGE_POINTXY 1 2 2 2 1 0 1\nEDGE_POINTXY 2 0 3 3 1 0 1\n");
  graph.remove_vertex(graph.slot_of(0));
  EXPECT_EQ(write_graph_text(graph),
            "VERTEX_XY 1 3 4\nVERTEX_XY 2 5 6\nEDGE_POINTXY 1 2 2 2 1 0 1\n");
}

TEST(GraphFile, LenientReadingReportsUnknownTagsAndProjectsInformation) {
  ReadReport report;
  const Graph graph = read_graph_text(
      "VERTEX_XY 0 1 2\nMYSTERY 1 2 3\nVERTEX_XY 1 3 4\n"
      "EDGE_POINTXY 0 1 1 1 1 2 1\nEDGE_POINTXY 0 1 1 1 1 0 1\nEDGE_POINTXY 0 1 1 1 1 3 1\n",
      "test.g2o", {}, standard_types(), {.lenient = true}, &report);
  ASSERT_EQ(report.unknown.size(), 1u);
  EXPECT_EQ(report.unknown[0].find("test.g2o:2: unknown tag 'MYSTERY'"), 0u) << report.unknown[0];
  EXPECT_EQ(report.indefinite_information, 2);
  EXPECT_EQ(report.first_indefinite_line, 4);
  // Eigenvalues 3 and −1 with eigenvectors (1, 1) and (1, −1): what is left is 3/2 everywhere.
  EXPECT_LE((graph.edges_of<EdgePointXY>()[0].information - Eigen::Matrix2d::Constant(1.5)).norm(),
            1e-14);
  EXPECT_EQ(graph.edges_of<EdgePointXY>()[1].information, Eigen::Matrix2d::Identity());
  // What was projected is accepted by a strict reader afterwards.
  expect_round_trip(graph);
}

TEST(GraphFile, IsWrittenWholeWithoutTemporaryFile) {
  const TemporaryFolder folder;
  const Graph graph = read("VERTEX_XY 0 1 2\n");
  write_graph(graph, folder.file("out.g2o"));
  write_graph(graph, folder.file("out.g2o"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.g2o"});
  expect_same_states(read_graph(folder.file("out.g2o"), standard_types()), graph);
}

TEST(GraphFile, IntoAMissingFolderIsAnErrorAndNothingIsWritten) {
  const TemporaryFolder folder;
  const Graph graph = read("VERTEX_XY 0 1 2\n");
  EXPECT_THROW(write_graph(graph, folder.file("missing") / "out.g2o"), Error);
  EXPECT_TRUE(folder.names().empty());
}

/// A parameter that holds a path, as robots and maps do.
struct PathParameter final : Parameter {
  std::string path;
  std::string_view tag() const override { return "PARAMS_PATH"; }
  void read(FieldReader& in) override { path = in.word(); }
  void write(FieldWriter& out) const override { out.word(path); }
};

TEST(GraphFile, AHashInsideAQuotedWordIsNoComment) {
  TypeRegistry types;
  types.add_parameter<PathParameter>("PARAMS_PATH");
  for (const char* path : {"my #1 map.bt", "a\"#b", "a\\#b", "\"", "a\\"}) {
    Graph graph;
    auto parameter = std::make_shared<PathParameter>();
    parameter->path = path;
    graph.parameters().set(0, parameter);
    const Graph again =
        read_graph_text(write_graph_text(graph) + "# \"comment\n", "test.g2o", {}, types);
    EXPECT_EQ(again.parameters().get<PathParameter>(0)->path, path);
  }
}

TEST(Parameters, AreListedByTheirType) {
  struct Other final : Parameter {
    std::string_view tag() const override { return "PARAMS_OTHER"; }
    void read(FieldReader&) override {}
    void write(FieldWriter&) const override {}
  };
  const std::set<int> none;
  Parameters parameters;
  EXPECT_EQ(parameters.numbers_of<PathParameter>(), none);
  EXPECT_FALSE(parameters.find<PathParameter>());
  for (const int number : {7, -2, 3}) parameters.set(number, std::make_shared<PathParameter>());
  parameters.set(1, std::make_shared<Other>());
  EXPECT_EQ(parameters.numbers_of<PathParameter>(), (std::set<int>{-2, 3, 7}));
  EXPECT_EQ(parameters.find<PathParameter>(), parameters.get<PathParameter>(-2));
  parameters.replace(-2, std::make_shared<Other>());
  parameters.remove(3);
  EXPECT_EQ(parameters.numbers_of<PathParameter>(), (std::set<int>{7}));
  EXPECT_EQ(parameters.number_of<Other>(), -2);
  EXPECT_THROW(parameters.set(7, std::make_shared<Other>()), Error);
  EXPECT_EQ(parameters.numbers_of<PathParameter>(), (std::set<int>{7}));
}

class EveryPoseGraph : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(GraphFile, EveryPoseGraph,
                         testing::Values("CSAIL", "cubicle", "intel", "kitti_00", "manhattan",
                                         "parking-garage", "sphere2500", "tinyGrid3D", "torus3D"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(EveryPoseGraph, ComesBackBitForBit) {
  const std::filesystem::path path = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" /
                                     (std::string(GetParam()) + ".g2o");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const bool lenient = std::string(GetParam()) == "cubicle";
  const Graph graph = read_graph(path, standard_types(), {.lenient = lenient});
  const TemporaryFolder folder;
  write_graph(graph, folder.file("first.g2o"));
  const Graph again = read_graph(folder.file("first.g2o"), standard_types());
  expect_same_states(graph, again);
  EXPECT_EQ(write_graph_text(again), write_graph_text(graph));
}

}  // namespace
}  // namespace locograph::test
