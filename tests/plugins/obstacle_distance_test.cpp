#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

class ObstacleDistance : public testing::Test {
 protected:
  static constexpr double kMargin = 0.05;
  RobotCase robot = centauro_lower_body();
  std::shared_ptr<const WorldParameter> world = std::make_shared<const WorldParameter>();
  EdgeObstacleDistance edge{*robot.robot, kWorld, kMargin, 1.0};

  Eigen::VectorXd at(double x, double y, double time_s = 0.0) const {
    return error_of(robot, edge, home(robot, x, y), time_s, world);
  }
  ConfigurationState state(double x, double y) const {
    ConfigurationState result(robot.robot);
    result.update(home(robot, x, y).data());
    return result;
  }
};

TEST_F(ObstacleDistance, IsZeroInAnEmptyWorld) {
  const Eigen::VectorXd e = at(0.0, 0.0);
  EXPECT_EQ(e.size(), static_cast<Eigen::Index>(robot.robot->spheres.size()));
  EXPECT_TRUE(e.isZero(0.0));
}

TEST_F(ObstacleDistance, IsWhatTheMarginLacksForEverySphere) {
  world = world_of(some_obstacles());
  const Eigen::VectorXd e = at(0.2, -0.1, 4.0);
  const ConfigurationState q = state(0.2, -0.1);
  int violated = 0;
  for (int i = 0; i < e.size(); ++i) {
    double nearest = 1.0;
    for (const Obstacle& obstacle : world->snapshot->world().obstacles) {
      nearest = std::min(nearest, obstacle.distance(q.sphere_centre(i), 4.0));
    }
    const double lacks = kMargin - (nearest - robot.robot->spheres[i].radius);
    EXPECT_NEAR(e[i], std::max(0.0, lacks), 1e-14);
    violated += lacks > 0.0;
  }
  EXPECT_GT(violated, 5);
  EXPECT_LT(violated, e.size() - 5);
}

TEST_F(ObstacleDistance, GrowsWithTheDepthInsideAndPointsOutwards) {
  // A wall far wider than the robot, its face at x = 2: the way out is -x, however deep.
  world = world_of({box_obstacle({4.0, 0.0, 0.0}, {4.0, 20.0, 20.0})});
  const Eigen::VectorXd touching = at(1.5, 0.0);
  Eigen::VectorXd before = touching;
  for (double x = 1.6; x < 3.25; x += 0.1) {
    const Eigen::VectorXd e = at(x, 0.0);
    const ConfigurationState q = state(x, 0.0);
    for (int i = 0; i < e.size(); ++i) {
      const double depth = q.sphere_centre(i).x() - 2.0;
      EXPECT_NEAR(e[i], std::max(0.0, kMargin + robot.robot->spheres[i].radius + depth), 1e-12);
      if (before[i] > 0.0) {
        EXPECT_NEAR(e[i] - before[i], 0.1, 1e-12);
      }
    }
    before = e;
  }
  EXPECT_GT(before.minCoeff(), 0.5) << "every sphere is deep inside by now";

  Graph graph = graph_of(robot);
  graph.parameters().set(kWorld, world);
  Eigen::VectorXd q = home(robot);
  q[0] += 3.2;
  graph.add_edge(edge, add_configuration(graph, robot, 0, 0.0, q));
  Evaluated evaluated(graph);
  const Eigen::MatrixXd j = evaluated.jacobian(0, 0, false);
  for (int i = 0; i < j.rows(); ++i) {
    EXPECT_TRUE(j.row(i).head<3>().isApprox(Eigen::RowVector3d::UnitX(), 1e-12))
        << "moving back by -x lessens every error";
  }
}

TEST_F(ObstacleDistance, GrowsWithTheDepthInsideAMapToo) {
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() << 2.5, 0.0, 0.5;
  boxes[0].size << 1.0, 3.0, 2.0;
  world = world_of({}, octree_from_boxes(boxes, 0.05));
  // One sphere of the pelvis, from outside to 0.4 m inside.
  const Eigen::Vector3d centre = state(0.0, 0.0).sphere_centre(0);
  double before = 0.0;
  for (double depth = 0.0; depth <= 0.4; depth += 0.05) {
    const double e = at(2.0 + depth - centre.x(), 0.0)[0];
    EXPECT_GT(e, before + 0.04) << "at depth " << depth;
    EXPECT_GE(e, kMargin + robot.robot->spheres[0].radius + depth) << "the map is conservative";
    EXPECT_LE(e, kMargin + robot.robot->spheres[0].radius + depth + 0.1);
    before = e;
  }
}

TEST_F(ObstacleDistance, SeesMovingObstaclesAtTheTimeOfTheConfiguration) {
  Obstacle cart = box_obstacle({5.0, 0.0, 0.7}, {0.2, 0.2, 0.2});
  KeyFrame here;
  here.time_s = 10.0;
  here.pose.translation() << 0.0, 0.0, 0.7;
  cart.motion.push_back(here);
  world = world_of({cart});
  EXPECT_TRUE(at(0.0, 0.0, 0.0).isZero(0.0));
  EXPECT_TRUE(at(0.0, 0.0, 5.0).isZero(0.0));
  EXPECT_GT(at(0.0, 0.0, 10.0).maxCoeff(), kMargin);
  EXPECT_GT(at(2.5, 0.0, 5.0).maxCoeff(), kMargin) << "it meets the cart half way";
}

TEST_F(ObstacleDistance, IsTheNearerOneOfMapAndObstacles) {
  world = world_of({}, some_map(false));
  const Eigen::VectorXd map_error = at(0.0, 0.0, 2.0);
  world = world_of(some_obstacles());
  const Eigen::VectorXd obstacle_error = at(0.0, 0.0, 2.0);
  world = world_of(some_obstacles(), some_map(false));
  const Eigen::VectorXd both = at(0.0, 0.0, 2.0);
  for (int i = 0; i < both.size(); ++i) {
    EXPECT_EQ(both[i], std::max(map_error[i], obstacle_error[i]));
  }
  EXPECT_GT(map_error.maxCoeff(), 0.0);
  EXPECT_GT(obstacle_error.maxCoeff(), 0.0);
}

TEST_F(ObstacleDistance, DoesNotTakeTheGroundThatTheWorldNamesForAnObstacle) {
  const TemporaryFolder folder;
  save_octree(*some_map(true), folder.file("floor.bt"));
  save_octree(*some_map(false), folder.file("no_floor.bt"));
  world = std::make_shared<const WorldParameter>(WorldFiles{.map = folder.file("floor.bt")}, 0.0);
  const Eigen::VectorXd with_floor = at(0.3, 0.1);
  world =
      std::make_shared<const WorldParameter>(WorldFiles{.map = folder.file("no_floor.bt")}, 0.0);
  const Eigen::VectorXd without_floor = at(0.3, 0.1);
  EXPECT_GT(without_floor.maxCoeff(), 0.0);
  EXPECT_TRUE(with_floor == without_floor);
  world = std::make_shared<const WorldParameter>(WorldFiles{.map = folder.file("floor.bt")});
  EXPECT_GT(at(0.3, 0.1).sum(), with_floor.sum()) << "a floor that is not named is in the way";
}

TEST_F(ObstacleDistance, IsThatOfAWorldThatIsBoundAsIfItWereTheGraphsOwn) {
  Graph graph = graph_of(robot);
  graph.parameters().set(kWorld, world);
  graph.add_edge(edge, add_configuration(graph, robot, 0, 0.0, home(robot)));
  const auto newer = world_of({box_obstacle({0.0, 0.0, 0.7}, {0.3, 0.3, 0.3})});
  expect_bound_as_own(graph, newer);
  graph.replace_parameter(kWorld, newer);
  EXPECT_GT(Evaluated(graph).error(0).maxCoeff(), kMargin);
}

}  // namespace
}  // namespace locograph::test
