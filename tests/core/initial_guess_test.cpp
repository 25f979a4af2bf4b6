#include <gtest/gtest.h>
#include <locograph/core/initial_guess.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include <random>

namespace locograph {
namespace {

/// A square of side 1 driven twice around, its measurements without noise, all states at zero.
struct Square {
  Graph graph;
  std::vector<SE2<double>> truth;
  std::vector<VertexId<VertexSE2>> poses;

  Square() {
    SE2<double> pose(0.3, -0.2, 0.7);
    const SE2<double> motion(1.0, 0.0, std::numbers::pi / 2.0);
    for (int i = 0; i < 9; ++i) {
      truth.push_back(pose);
      poses.push_back(graph.add_vertex(10 * i, VertexSE2()));
      pose = pose * motion;
    }
    // Some edges point backwards.
    for (int i = 0; i + 1 < 9; ++i) {
      EdgeSE2 edge;
      edge.measurement = i % 2 == 0 ? motion : motion.inverse();
      if (i % 2 == 0) {
        graph.add_edge(edge, poses[i], poses[i + 1]);
      } else {
        graph.add_edge(edge, poses[i + 1], poses[i]);
      }
    }
    EdgeSE2 closure;
    closure.measurement = truth[0].inverse() * truth[4];
    graph.add_edge(closure, poses[0], poses[4]);
    graph.vertex(poses[0]) = VertexSE2(truth[0]);
    graph.set_fixed(poses[0], true);
  }
  void expect_truth() const {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const SE2<double> pose = graph.vertex(poses[i]).pose();
      EXPECT_LE((pose.translation() - truth[i].translation()).norm(), 1e-14) << i;
      EXPECT_LE(std::abs(wrap_angle(pose.angle() - truth[i].angle())), 1e-14) << i;
    }
  }
};

TEST(InitialGuess, FromTheSpanningTreeIsExactWithoutNoise) {
  Square square;
  EXPECT_EQ(guess_from_spanning_tree(square.graph), 0);
  square.expect_truth();
}

TEST(InitialGuess, FromOdometryIsExactWithoutNoise) {
  Square square;
  EXPECT_EQ(guess_from_odometry(square.graph), 0);
  square.expect_truth();
}

TEST(InitialGuess, StartsAtTheFixedVertexWhereverItIs) {
  Square square;
  square.graph.set_fixed(square.poses[0], false);
  square.graph.vertex(square.poses[0]) = VertexSE2();
  square.graph.vertex(square.poses[6]) = VertexSE2(square.truth[6]);
  square.graph.set_fixed(square.poses[6], true);
  EXPECT_EQ(guess_from_spanning_tree(square.graph), 0);
  square.expect_truth();
}

TEST(InitialGuess, CountsAndKeepsVerticesThatNothingPredicts) {
  Square square;
  const auto landmark = square.graph.add_vertex(1000, VertexXY({5.0, 6.0}));
  square.graph.add_edge(EdgeBearingSE2XY(), square.poses[2], landmark);
  EXPECT_EQ(guess_from_spanning_tree(square.graph), 1);
  EXPECT_EQ(square.graph.vertex(landmark).state, Eigen::Vector2d(5.0, 6.0));
  square.expect_truth();
}

TEST(InitialGuess, PredictsPointsFromPoses) {
  Square square;
  const auto landmark = square.graph.add_vertex(1000, VertexXY());
  EdgeSE2XY seen;
  seen.measurement = {0.5, 0.25};
  square.graph.add_edge(seen, square.poses[3], landmark);
  EXPECT_EQ(guess_from_odometry(square.graph), 0);
  EXPECT_LE((square.graph.vertex(landmark).state - square.truth[3] * seen.measurement).norm(),
            1e-14);
}

TEST(InitialGuess, IsExactInSpaceToo) {
  std::mt19937 engine(2);
  std::normal_distribution<double> normal;
  const auto random_pose = [&] {
    Eigen::Quaterniond q(normal(engine), normal(engine), normal(engine), normal(engine));
    return SE3<double>({normal(engine), normal(engine), normal(engine)}, q.normalized());
  };
  Graph graph;
  std::vector<VertexId<VertexSE3>> poses;
  std::vector<SE3<double>> truth;
  for (int i = 0; i < 20; ++i) {
    truth.push_back(i == 0 ? SE3<double>() : random_pose());
    poses.push_back(graph.add_vertex(i, VertexSE3()));
    if (i == 0) continue;
    EdgeSE3 edge;
    const int from = static_cast<int>(engine() % static_cast<unsigned>(i));
    if (i % 2 == 0) {
      edge.measurement = truth[from].inverse() * truth[i];
      graph.add_edge(edge, poses[from], poses[i]);
    } else {
      edge.measurement = truth[i].inverse() * truth[from];
      graph.add_edge(edge, poses[i], poses[from]);
    }
  }
  EXPECT_EQ(guess_from_spanning_tree(graph), 0);
  for (int i = 0; i < 20; ++i) {
    const SE3<double> pose = graph.vertex(poses[i]).pose();
    EXPECT_LE((pose.translation() - truth[i].translation()).norm(), 1e-12) << i;
    EXPECT_GE(std::abs(pose.rotation().dot(truth[i].rotation())), 1.0 - 1e-12) << i;
  }
}

}  // namespace
}  // namespace locograph
