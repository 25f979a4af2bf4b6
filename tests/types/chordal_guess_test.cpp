#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/slam3d/priors.h>
#include <locograph/types/standard_types.h>

#include <memory>
#include <random>

#include "common/sanitized.h"
#include "core/best_known_chi2.h"

namespace locograph {
namespace {

int guess(Graph& graph) { return guess_chordal(graph, *make_linear_solver("auto")); }

SE2<double> random_pose(std::mt19937& engine, SE2<double>) {
  std::normal_distribution<double> normal(0.0, 3.0);
  return {normal(engine), normal(engine), wrap_angle(normal(engine))};
}
SE3<double> random_pose(std::mt19937& engine, SE3<double>) {
  std::normal_distribution<double> normal(0.0, 3.0);
  const Eigen::Vector4d q(normal(engine), normal(engine), normal(engine), normal(engine));
  return {{normal(engine), normal(engine), normal(engine)}, Eigen::Quaterniond(q.normalized())};
}
double angle(const SE2<double>& pose) { return std::abs(wrap_angle(pose.angle())); }
double angle(const SE3<double>& pose) { return 2.0 * pose.rotation().vec().norm(); }

/// Exact measurements between random poses whose states are garbage: a chain, and chords that point
/// backwards.
template <class V, class E, class Pose, class SensorOffset, class EdgeBetweenSensors>
struct Exact {
  using Vertex = V;
  using Offset = SensorOffset;
  using OffsetEdge = EdgeBetweenSensors;
  std::mt19937 engine{5};
  Graph graph;
  std::vector<Pose> truth;
  std::vector<VertexId<V>> poses;

  explicit Exact(int size = 30) {
    for (int i = 0; i < size; ++i) {
      truth.push_back(any());
      poses.push_back(graph.add_vertex(10 * i, V(any())));
    }
    for (int i = 0; i + 1 < size; ++i) tie(i, i + 1);
    for (int i = 0; i + 7 < size; i += 3) tie(i + 7, i);
  }
  Pose any() { return random_pose(engine, Pose()); }
  void tie(int a, int b) {
    E edge;
    edge.measurement = truth[a].inverse() * truth[b];
    graph.add_edge(edge, poses[a], poses[b]);
  }
  void hold(int i) {
    graph.vertex(poses[i]) = V(truth[i]);
    graph.set_fixed(poses[i], true);
  }
  void expect_truth(double tolerance = 1e-10) const {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose off = truth[i].inverse() * graph.vertex(poses[i]).pose();
      EXPECT_LE(off.translation().norm(), tolerance) << i;
      EXPECT_LE(angle(off), 1e-11) << i;
    }
  }
};
using Planar = Exact<VertexSE2, EdgeSE2, SE2<double>, OffsetSE2, EdgeSE2Offset>;
using Spatial = Exact<VertexSE3, EdgeSE3, SE3<double>, OffsetSE3, EdgeSE3Offset>;

template <class T>
class ChordalGuess : public testing::Test {};
using PlanarAndSpatial = testing::Types<Planar, Spatial>;
TYPED_TEST_SUITE(ChordalGuess, PlanarAndSpatial);

TYPED_TEST(ChordalGuess, IsExactWithoutNoiseFromGarbage) {
  TypeParam exact;
  exact.hold(0);
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth();
}

TYPED_TEST(ChordalGuess, KeepsFixedVerticesWhereverTheyAre) {
  TypeParam exact;
  exact.hold(4);
  exact.hold(17);
  EXPECT_EQ(guess(exact.graph), 0);
  EXPECT_EQ(exact.graph.vertex(exact.poses[17]).pose().translation(),
            exact.truth[17].translation());
  EXPECT_TRUE(exact.graph.vertex_record(exact.poses[17].slot).fixed);
  EXPECT_FALSE(exact.graph.vertex_record(exact.poses[5].slot).fixed);
  exact.expect_truth();
}

TYPED_TEST(ChordalGuess, WithoutAnchorKeepsTheFirstVertex) {
  TypeParam exact;
  const auto first = exact.graph.vertex(exact.poses[0]).pose();
  EXPECT_EQ(guess(exact.graph), 0);
  const auto move = first * exact.truth[0].inverse();
  for (auto& pose : exact.truth) pose = move * pose;
  exact.expect_truth();
}

TYPED_TEST(ChordalGuess, PlacesTwoPartsIndependently) {
  TypeParam exact(20), other(12);
  for (std::size_t i = 0; i < other.poses.size(); ++i) {
    exact.truth.push_back(other.truth[i]);
    exact.poses.push_back(exact.graph.add_vertex(1000 + i, other.graph.vertex(other.poses[i])));
    if (i > 0) exact.tie(19 + i, 20 + i);
  }
  exact.hold(3);
  exact.hold(25);
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth();
}

TEST(ChordalGuess, HonoursPriorsInThePlane) {
  Planar exact;
  EdgePriorSE2 prior;
  prior.measurement = exact.truth[11];
  exact.graph.add_edge(prior, exact.poses[11]);
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth();
}

TEST(ChordalGuess, HonoursPriorsOfASensorInSpace) {
  Spatial exact;
  auto offset = std::make_shared<OffsetSE3>();
  offset->offset = exact.any();
  exact.graph.parameters().set(3, offset);
  EdgeSE3Prior prior;
  prior.offset_number = 3;
  prior.measurement = exact.truth[11] * offset->offset;
  exact.graph.add_edge(prior, exact.poses[11]);
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth();
}

TEST(ChordalGuess, MovesAFloatingPartOntoMeasuredPositions) {
  Planar exact;
  for (const int i : {3, 8, 20}) {
    EdgePriorSE2XY prior;
    prior.measurement = exact.truth[i].translation();
    exact.graph.add_edge(prior, exact.poses[i]);
  }
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth();
}

TYPED_TEST(ChordalGuess, KnowsOffsetsOfSensors) {
  using Offset = typename TypeParam::Offset;
  TypeParam exact;
  auto first = std::make_shared<Offset>(), second = std::make_shared<Offset>();
  first->offset = exact.any();
  second->offset = exact.any();
  exact.graph.parameters().set(1, first);
  exact.graph.parameters().set(2, second);
  exact.truth.push_back(exact.any());
  exact.poses.push_back(exact.graph.add_vertex(7777, typename TypeParam::Vertex()));
  typename TypeParam::OffsetEdge edge;
  edge.first_offset = 1;
  edge.second_offset = 2;
  edge.measurement =
      (exact.truth[6] * first->offset).inverse() * exact.truth.back() * second->offset;
  exact.graph.add_edge(edge, exact.poses[6], exact.poses.back());
  exact.hold(0);
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth();
}

TEST(ChordalGuess, PredictsPointsAndCountsWhatNothingReaches) {
  Planar exact;
  exact.hold(0);
  const auto seen = exact.graph.add_vertex(1000, VertexXY({9.0, 9.0}));
  const auto bearing_only = exact.graph.add_vertex(1001, VertexXY({5.0, 6.0}));
  EdgeSE2XY measured;
  measured.measurement = {0.5, 0.25};
  exact.graph.add_edge(measured, exact.poses[12], seen);
  exact.graph.add_edge(EdgeBearingSE2XY(), exact.poses[2], bearing_only);
  EXPECT_EQ(guess(exact.graph), 1);
  exact.expect_truth();
  EXPECT_LE((exact.graph.vertex(seen).state - exact.truth[12] * measured.measurement).norm(),
            1e-10);
  EXPECT_EQ(exact.graph.vertex(bearing_only).state, Eigen::Vector2d(5.0, 6.0));
}

TEST(ChordalGuess, LeavesAGraphWithoutPosesAlone) {
  Graph graph;
  const auto a = graph.add_vertex(0, VertexXY({1.0, 2.0}));
  const auto b = graph.add_vertex(1, VertexXY());
  EdgePointXY edge;
  edge.measurement = {1.0, 1.0};
  graph.add_edge(edge, a, b);
  EXPECT_EQ(guess(graph), 0);
  EXPECT_EQ(graph.vertex(b).state, Eigen::Vector2d(2.0, 3.0));
}

TEST(ChordalGuess, OfSemiDefiniteInformationIsFinite) {
  // Nothing measures the translation of the last pose: it is held by a little damping only, which
  // pulls the others by as little.
  Spatial exact;
  exact.hold(0);
  EdgeSE3 rotation_only;
  rotation_only.information.topLeftCorner<3, 3>().setZero();
  const auto last = exact.graph.add_vertex(1000, VertexSE3());
  exact.graph.add_edge(rotation_only, exact.poses[5], last);
  EXPECT_EQ(guess(exact.graph), 0);
  exact.expect_truth(1e-8);
  EXPECT_TRUE(exact.graph.vertex(last).state.allFinite());
}

class FromGarbage : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(PoseGraphFiles, FromGarbage,
                         testing::Values("tinyGrid3D", "parking_garage", "sphere2500", "torus3D",
                                         "intel", "manhattan", "CSAIL", "kitti_00"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(FromGarbage, TheChordalGuessLeadsToTheBestKnownChi2) {
  std::string name = GetParam();
  if (name == "parking_garage") name = "parking-garage";
  const std::filesystem::path file = test::public_pose_graph(name);
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  if (test::kSanitized && std::filesystem::file_size(file) > 1000000) {
    GTEST_SKIP() << "slow under sanitizers, and nothing in it that smaller files have not";
  }
  const std::optional<double> best = test::best_known_chi2(name);
  if (!best) GTEST_SKIP() << "no reference data, or nlohmann-json is not installed";
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  std::mt19937 engine(1);
  for (int v = 1; v < graph.vertex_slots(); ++v) {
    if (graph.state_size(v) == 3) {
      VertexSE2::store(random_pose(engine, SE2<double>()), graph.state(v));
    } else {
      VertexSE3::store(random_pose(engine, SE3<double>()), graph.state(v));
    }
  }
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  EXPECT_EQ(guess_chordal(graph, *solver), 0);
  const OptimiserResult result = optimise(graph, {}, *solver);
  EXPECT_TRUE(result.converged) << result.reason_text();
  EXPECT_NEAR(result.final.chi2, *best, 1e-4 * *best);
}

}  // namespace
}  // namespace locograph
