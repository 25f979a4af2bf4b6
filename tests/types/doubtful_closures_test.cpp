#include <gtest/gtest.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/graph_file.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/doubtful_closures.h>
#include <locograph/types/standard_types.h>

#include <memory>
#include <random>

#include "benchmarks/core/false_loop_closures.h"
#include "core/dense_system.h"

namespace locograph {
namespace {

constexpr double kMetres = 0.01, kRadians = 0.02;  // noise: turning matters more than sliding

struct Plane {
  using V = VertexSE2;
  using E = EdgeSE2;
  using OffsetEdge = EdgeSE2Offset;
  using Offset = OffsetSE2;
  using Pose = SE2<double>;
  static Pose pose(double x, double y, double heading) { return {x, y, heading}; }
  static Pose noise(std::mt19937& engine) {
    std::normal_distribution<double> normal;
    const double x = normal(engine), y = normal(engine), turn = normal(engine);
    return {kMetres * x, kMetres * y, kRadians * turn};
  }
  static Eigen::Matrix3d information() {
    return Eigen::Vector3d(1.0 / (kMetres * kMetres), 1.0 / (kMetres * kMetres),
                           1.0 / (kRadians * kRadians))
        .asDiagonal();
  }
};

struct Space {
  using V = VertexSE3;
  using E = EdgeSE3;
  using OffsetEdge = EdgeSE3Offset;
  using Offset = OffsetSE3;
  using Pose = SE3<double>;
  static Pose pose(double x, double y, double heading) {
    const Eigen::Vector3d turn(0.1 * x, -0.2 * y, heading);
    return {{x, y, 0.3 * x * y}, quaternion_exp<double>(turn)};
  }
  static Pose noise(std::mt19937& engine) {
    std::normal_distribution<double> normal;
    Eigen::Matrix<double, 6, 1> e;
    for (double& number : e) number = normal(engine);
    return {kMetres * e.head<3>(), quaternion_exp<double>(kRadians * e.tail<3>())};
  }
  static Eigen::Matrix<double, 6, 6> information() {
    Eigen::Matrix<double, 6, 6> all = Eigen::Matrix<double, 6, 6>::Identity();
    all.diagonal().head<3>().setConstant(1.0 / (kMetres * kMetres));
    all.diagonal().tail<3>().setConstant(4.0 / (kRadians * kRadians));  // of half the angle
    return all;
  }
};

/// Up and down a field: odometry, and closures to the row before.
template <class S>
struct Field {
  using V = typename S::V;
  using Pose = typename S::Pose;
  static constexpr int kRows = 8, kColumns = 12;

  std::mt19937 engine;
  Graph graph;
  std::vector<Pose> truth;
  std::vector<VertexId<V>> poses;

  explicit Field(unsigned seed = 1, bool garbage = true) : engine(seed) {
    for (int row = 0; row < kRows; ++row) {
      for (int i = 0; i < kColumns; ++i) {
        const bool back = row % 2 == 1;
        truth.push_back(S::pose(back ? kColumns - 1 - i : i, row, back ? 3.0 : 0.0));
      }
    }
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const bool random = garbage && i > 0;
      poses.push_back(graph.add_vertex(static_cast<int>(i),
                                       V(random ? truth[engine() % truth.size()] : truth[i])));
    }
    graph.set_fixed(poses[0], true);
    for (int i = 0; i + 1 < size(); ++i) tie(i, i + 1);
    for (int i = kColumns; i < size(); ++i) {
      if (i % 3 != 0) tie(i, kColumns * (i / kColumns) - 1 - i % kColumns);
    }
  }
  int size() const { return static_cast<int>(truth.size()); }
  EdgeId tie(int a, int b) {
    typename S::E edge;
    edge.measurement = truth[a].inverse() * truth[b] * S::noise(engine);
    edge.information = S::information();
    return graph.add_edge(edge, poses[a], poses[b]);
  }
  std::vector<int> add_false(double fraction, unsigned seed) {
    std::vector<int> slots;
    const Field at_truth(1, false);
    for (const EdgeId edge :
         make_false_closures<typename S::E>(at_truth.graph, fraction, seed).add(graph)) {
      slots.push_back(edge.slot);
    }
    return slots;
  }
  std::vector<int> doubted() const { return doubtful_closures(graph, odometry_edges(graph)); }
};

template <class S>
class DoubtfulClosures : public testing::Test {};
using PlaneAndSpace = testing::Types<Plane, Space>;
TYPED_TEST_SUITE(DoubtfulClosures, PlaneAndSpace);

TYPED_TEST(DoubtfulClosures, AreTheFalseOnes) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Field<TypeParam> field(seed);
    const std::vector<int> wrong = field.add_false(0.3, seed);
    ASSERT_GT(wrong.size(), 20u);
    EXPECT_EQ(field.doubted(), wrong) << "seed " << seed;
  }
}

TYPED_TEST(DoubtfulClosures, DoNotExistInACleanGraph) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    EXPECT_EQ(Field<TypeParam>(seed).doubted(), std::vector<int>()) << "seed " << seed;
  }
}

TYPED_TEST(DoubtfulClosures, DoNotDependOnStates) {
  Field<TypeParam> garbage(7), good(7);
  garbage.add_false(0.2, 1);
  good.add_false(0.2, 1);
  for (int i = 0; i < good.size(); ++i) {
    good.graph.vertex(good.poses[i]) = typename TypeParam::V(good.truth[i]);
  }
  EXPECT_EQ(garbage.doubted(), good.doubted());
}

TYPED_TEST(DoubtfulClosures, LeftOutLeadFromGarbageToTheOptimumOfTheTrueOnes) {
  Field<TypeParam> clean(5), dirty(5);
  const std::vector<int> wrong = dirty.add_false(0.3, 2);
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  guess_chordal(clean.graph, *solver);
  const OptimiserResult best = optimise(clean.graph, {}, *solver);
  const std::vector<int> odometry = odometry_edges(dirty.graph), doubted = dirty.doubted();
  EXPECT_EQ(guess_chordal(dirty.graph, *solver, doubted), 0);
  GraduationOptions options;
  options.for_all = true;
  const GraduationResult result =
      optimise_graduated(dirty.graph, options, *solver, odometry, doubted);
  EXPECT_TRUE(result.optimiser.converged);
  EXPECT_EQ(result.rejected, static_cast<int>(wrong.size()));
  for (const int slot : wrong) EXPECT_EQ(result.weight[slot], 0.0);
  EXPECT_NEAR(result.optimiser.final.chi2, best.final.chi2, 1e-6 * best.final.chi2);
  EXPECT_LT(test::state_difference(clean.graph, dirty.graph), 1e-5);
}

TYPED_TEST(DoubtfulClosures, MayPointEitherWay) {
  Field<TypeParam> field;
  typename TypeParam::E turned;  // right, but against the direction of its neighbours
  turned.measurement = field.truth[8].inverse() * field.truth[15] * TypeParam::noise(field.engine);
  turned.information = TypeParam::information();
  const EdgeId right = field.graph.add_edge(turned, field.poses[8], field.poses[15]);
  turned.measurement = turned.measurement.inverse();
  const EdgeId wrong = field.graph.add_edge(turned, field.poses[8], field.poses[15]);
  EXPECT_EQ(field.doubted(), std::vector<int>{wrong.slot});
  EXPECT_TRUE(field.graph.edge_alive(right.slot));
}

TYPED_TEST(DoubtfulClosures, AreToldBetweenSensorsToo) {
  Field<TypeParam> field;
  for (const int number : {1, 2}) {
    auto offset = std::make_shared<typename TypeParam::Offset>();
    offset->offset = TypeParam::pose(0.3 * number, 0.7, 0.5 * number);
    field.graph.parameters().set(number, offset);
  }
  const auto tie = [&](int a, int b, double slip) {
    typename TypeParam::OffsetEdge edge;
    edge.first_offset = 1;
    edge.second_offset = 2;
    edge.measurement = TypeParam::pose(0.3, 0.7, 0.5).inverse() *
                       (field.truth[a].inverse() * field.truth[b]) *
                       TypeParam::pose(0.6, 0.7, 1.0) * TypeParam::pose(slip, 0.0, 0.0);
    edge.information = TypeParam::information();
    return field.graph.add_edge(edge, field.poses[a], field.poses[b]).slot;
  };
  tie(40, 55, 0.0);
  const int wrong = tie(30, 65, 2.0);
  EXPECT_EQ(field.doubted(), std::vector<int>{wrong});
}

TYPED_TEST(DoubtfulClosures, NeverDisconnectTheGraph) {
  Field<TypeParam> field;
  const int n = field.size();
  // A second drive, tied to the first by one measurement that nothing confirms.
  for (int i = 0; i < 4; ++i) {
    field.truth.push_back(TypeParam::pose(i, -3.0, 0.0));
    field.poses.push_back(
        field.graph.add_vertex(1000 + i, typename TypeParam::V(field.truth.back())));
    if (i > 0) field.tie(n + i - 1, n + i);
  }
  field.tie(5, n + 2);
  EXPECT_EQ(field.doubted(), std::vector<int>());
}

TYPED_TEST(DoubtfulClosures, WithoutTrustedEdgesAreNone) {
  Field<TypeParam> field;
  field.add_false(0.2, 1);
  EXPECT_EQ(doubtful_closures(field.graph, {}), std::vector<int>());
}

TYPED_TEST(DoubtfulClosures, DoNotIncludeWhatMeasuresAPartOnly) {
  Field<TypeParam> field;
  typename TypeParam::E turn_only;  // wrong
  turn_only.information = TypeParam::information();
  turn_only.information.template topLeftCorner<2, 2>().setZero();
  field.graph.add_edge(turn_only, field.poses[3], field.poses[70]);
  EXPECT_EQ(field.doubted(), std::vector<int>());
}

TEST(ConsistencyOptions, OutOfRangeAreErrors) {
  const auto throws = [](auto&& change) {
    ConsistencyOptions options;
    change(options);
    EXPECT_THROW(doubtful_closures(Graph(), {}, options), Error);
  };
  throws([](ConsistencyOptions& o) { o.inlier_probability = 1.0; });
  throws([](ConsistencyOptions& o) { o.accident_probability = 0.0; });
  throws([](ConsistencyOptions& o) { o.pair_steps = -1; });
  throws([](ConsistencyOptions& o) { o.path_steps = 0; });
}

/// Real measurements: every tenth loop closure of a public file is false, all states are garbage.
class TenPercentFalse : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(PoseGraphFiles, TenPercentFalse, testing::Values("CSAIL", "manhattan"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(TenPercentFalse, LoopClosuresAreSurvivedFromGarbage) {
  const std::filesystem::path file = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" /
                                     (std::string(GetParam()) + ".g2o");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  Graph clean = read_graph(file, standard_types());
  clean.set_fixed(0, true);
  guess_chordal(clean, *solver);
  const double best = optimise(clean, {}, *solver).final.chi2;
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  const std::vector<EdgeId> wrong = make_false_closures<EdgeSE2>(clean, 0.1, 2).add(graph);
  std::mt19937 engine(1);
  for (int v = 1; v < graph.vertex_slots(); ++v) {
    for (int i = 0; i < 3; ++i) graph.state(v)[i] = static_cast<double>(engine() % 1000) / 160.0;
  }
  const std::vector<int> odometry = odometry_edges(graph);
  const std::vector<int> doubted = doubtful_closures(graph, odometry);
  guess_chordal(graph, *solver, doubted);
  GraduationOptions options;
  options.for_all = true;
  const GraduationResult result = optimise_graduated(graph, options, *solver, odometry, doubted);
  EXPECT_TRUE(result.optimiser.converged) << result.optimiser.reason_text();
  EXPECT_EQ(result.rejected, static_cast<int>(wrong.size()));
  for (const EdgeId edge : wrong) EXPECT_EQ(result.weight[edge.slot], 0.0);
  EXPECT_NEAR(result.optimiser.final.chi2, best, 1e-6 * best);
  EXPECT_LT(test::state_difference(clean, graph), 1e-3);
}

}  // namespace
}  // namespace locograph
