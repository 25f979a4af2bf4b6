#include <locograph/world/collision_world.h>

#include "plugins/jacobian_comparison.h"
#include "plugins/kink_distance.h"
#include "plugins/pair_distances.h"
#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

ConfigurationState state_of(const RobotCase& robot, const Eigen::VectorXd& q, double time_s = 0.0) {
  ConfigurationState state(robot.robot);
  state.time_s = time_s;
  state.update(q.data());
  return state;
}

class CollisionEdges : public RobotCaseTest {};

TEST_P(CollisionEdges, SelfCollisionIsWhatTheMarginLacksForEveryPair) {
  Random random(51);
  constexpr double kMargin = 0.06;
  const EdgeSelfCollision edge(*robot.robot, kMargin, 1.0);
  int violated = 0, rows = 0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    const Eigen::VectorXd e = error_of(robot, edge, q);
    const std::vector<PairDistance> distances = pair_distances(state_of(robot, q));
    ASSERT_EQ(e.size(), static_cast<Eigen::Index>(distances.size()));
    for (int p = 0; p < e.size(); ++p) {
      ASSERT_NEAR(e[p], std::max(0.0, kMargin - distances[p].value), 1e-9) << "pair " << p;
      violated += e[p] > 0.0;
    }
    rows += static_cast<int>(e.size());
  }
  EXPECT_GT(violated, 20);
  EXPECT_LT(violated, rows / 2);
}

TEST_P(CollisionEdges, SelfCollisionHasTheJacobianOfNumericDifferences) {
  Random random(52);
  constexpr double kMargin = 0.05;
  Graph graph = graph_of(robot);
  std::vector<std::vector<PairDistance>> distances;
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    graph.add_edge(EdgeSelfCollision(*robot.robot, kMargin, 1.0),
                   add_configuration(graph, robot, i, 0.0, q));
    distances.push_back(pair_distances(state_of(robot, q)));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    compare(
        evaluated, k, 0, [&](int row) { return distances[k][row].smooth(kMargin); }, compared);
  }
  EXPECT_GT(compared.nonzero, kStates);
  EXPECT_GT(compared.zero, 9 * kStates);
}

TEST_P(CollisionEdges, SelfCollisionHasAGradientJustInsideTheMargin) {
  Random random(53);
  constexpr double kBeyond = 1e-9, kMargin = 0.03;
  int compared = 0;
  for (int i = 0; i < kStates / 2; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    const std::vector<PairDistance> distances = pair_distances(state_of(robot, q));
    for (std::size_t p = 0; p < distances.size(); ++p) {
      if (!distances[p].smooth(kMargin) || distances[p].value > kMargin) continue;
      Graph graph = graph_of(robot);
      const auto id = add_configuration(graph, robot, 0, 0.0, q);
      graph.add_edge(EdgeSelfCollision(*robot.robot, kMargin, 1.0), id);
      graph.add_edge(EdgeSelfCollision(*robot.robot, distances[p].value + kBeyond, 1.0), id);
      Evaluated evaluated(graph);
      EXPECT_NEAR(evaluated.error(1)[p], kBeyond, 1e-12);
      const Eigen::MatrixXd numeric = evaluated.jacobian(0, 0, true);
      const Eigen::MatrixXd analytic = evaluated.jacobian(1, 0, false);
      EXPECT_LE((analytic.row(p) - numeric.row(p)).cwiseAbs().maxCoeff(), kTolerance);
      EXPECT_TRUE(analytic.row(p).head(robot.model().base_tangent_size()).isZero(0.0))
          << "moving the whole robot changes nothing";
      ++compared;
      break;
    }
  }
  EXPECT_GT(compared, kStates / 12);
}

/// Excess of every sphere on the way, and whether differences may be taken there.
struct SweptReference {
  double worst = 0.0, second = 0.0;  ///< lacks, below zero where there is room
  bool smooth = false;

  SweptReference(const WorldDistance& world, const ConfigurationState& a,
                 const ConfigurationState& b, int sphere, double margin, int samples) {
    const double rho = a.robot->spheres[sphere].radius + margin;
    const Eigen::Vector3d from = a.sphere_centre(sphere), to = b.sphere_centre(sphere);
    worst = second = -1e3;
    for (int k = 0; k < samples; ++k) {
      const double s = (2 * k + 1) / (2.0 * samples), t = (1.0 - s) * a.time_s + s * b.time_s;
      const Eigen::Vector3d c = (1.0 - s) * from + s * to;
      const auto take = [&](double distance, const Eigen::Vector3d& way, double turn, bool fine) {
        const double lack = std::hypot(rho, (way.norm() + turn) / (2.0 * samples)) - distance;
        second = std::max(second, std::min(lack, worst));
        if (lack <= worst) return;
        worst = lack;
        smooth = fine;
      };
      if (world.map) {
        take(world.map->distance(c), to - from, 0.0,
             kink_distance(*world.map, c) > kKink &&
                 world.map->distance(c) < world.map->max_distance() - kKink);
      }
      for (const Obstacle& obstacle : world.obstacles) {
        const Eigen::Isometry3d p = obstacle.pose_at(a.time_s), q = obstacle.pose_at(b.time_s);
        const double radius = obstacle.shape == Obstacle::Shape::kSphere ? 0.0
                              : obstacle.shape == Obstacle::Shape::kBox
                                  ? 0.5 * obstacle.size.norm()
                                  : std::hypot(obstacle.size[0], 0.5 * obstacle.size[1]);
        const double angle = obstacle.motion.empty()
                                 ? 0.0
                                 : Eigen::AngleAxisd(p.linear().transpose() * q.linear()).angle();
        take(obstacle.distance(c, t), to - from - (q.translation() - p.translation()),
             radius * angle, kink_distance(obstacle, c, t) > 0.01);
      }
    }
    for (const Obstacle& obstacle : world.obstacles) {
      if (obstacle.motion.empty()) continue;
      const double lack = rho - obstacle.distance(to, b.time_s);
      second = std::max(second, std::min(lack, worst));
      if (lack <= worst) continue;
      worst = lack;
      smooth = kink_distance(obstacle, to, b.time_s) > 0.01;
    }
    if (worst < -kKink) {
      smooth = true;
    } else if (worst < kKink || worst - second < kKink) {
      smooth = false;
    }
  }
};

void compare_sweeps(const RobotCase& robot, const std::shared_ptr<const WorldParameter>& world,
                    unsigned seed) {
  constexpr double kMargin = 0.1;
  Random random(seed);
  Graph graph = graph_of(robot);
  const WorldDistance& now = world->snapshot->distance();
  graph.parameters().set(kWorld, world);
  const Robot& model = robot.model();
  std::vector<ConfigurationState> from, to;
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd a = random.configuration(model, 1.0, 0.0);
    Eigen::VectorXd b(a.size()), step = random.vector(model.tangent_size(), 0.2);
    if (i % 10 == 0) step *= 1e-3;
    model.integrate(a.data(), step.data(), b.data());
    const double time_s = random.uniform(-1.0, 12.0);
    from.push_back(state_of(robot, a, time_s));
    to.push_back(state_of(robot, b, time_s + 0.3));
    graph.add_edge(EdgeSweptObstacleDistance(*robot.robot, kWorld, kMargin, 1 + i % 3, 1.0),
                   add_configuration(graph, robot, 2 * i, time_s, a),
                   add_configuration(graph, robot, 2 * i + 1, time_s + 0.3, b));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    std::vector<SweptReference> reference;
    const Eigen::VectorXd e = evaluated.error(k);
    for (int i = 0; i < e.size(); ++i) {
      reference.emplace_back(now, from[k], to[k], i, kMargin, 1 + k % 3);
      ASSERT_NEAR(e[i], std::max(0.0, reference[i].worst), 1e-9) << "edge " << k << " row " << i;
    }
    for (const int slot : {0, 1}) {
      compare(
          evaluated, k, slot, [&](int row) { return reference[row].smooth; }, compared);
    }
  }
  EXPECT_GT(compared.nonzero, 5 * kStates);
  EXPECT_GT(compared.zero, 5 * kStates);
}

TEST_P(CollisionEdges, SweptDistanceToPrimitivesHasTheJacobianOfNumericDifferences) {
  compare_sweeps(robot, world_of(some_obstacles()), 54);
}

TEST_P(CollisionEdges, SweptDistanceToAMapHasTheJacobianOfNumericDifferences) {
  compare_sweeps(robot, world_of({}, some_map(false)), 55);
}

INSTANTIATE_TEST_SUITE_P(Plugins, CollisionEdges, testing::ValuesIn(all_cases_and_coman_plus()),
                         robot_case_name);

/// Two capsules: one upright in the base, one along y that slides along x.
constexpr const char* kTwoCapsules = R"(<robot name="slider">
  <link name="base">
    <collision><geometry><cylinder radius="0.1" length="1"/></geometry></collision>
    <collision><origin xyz="0 0 0.5"/><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><origin xyz="0 0 -0.5"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="carriage">
    <collision><origin rpy="1.5707963267948966 0 0"/>
      <geometry><cylinder radius="0.05" length="0.6"/></geometry></collision>
    <collision><origin xyz="0 0.3 0"/><geometry><sphere radius="0.05"/></geometry></collision>
    <collision><origin xyz="0 -0.3 0"/><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="carriage"/>
    <origin xyz="0 0 0.2"/><axis xyz="1 0 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
</robot>
)";

class TwoCapsules : public testing::Test {
 protected:
  static constexpr double kMargin = 0.2;
  TemporaryFolder folder;
  RobotCase robot{"slider",
                  std::make_shared<const RobotParameter>(folder.write("slider.urdf", kTwoCapsules),
                                                         std::filesystem::path(),
                                                         RobotOptions{.floating_base = false}),
                  {}};
  std::pair<double, double> at(double slide) const {
    Graph graph = graph_of(robot);
    graph.add_edge(EdgeSelfCollision(*robot.robot, kMargin, 1.0),
                   add_configuration(graph, robot, 0, 0.0, Eigen::VectorXd::Constant(1, slide)));
    Evaluated evaluated(graph);
    return {evaluated.error(0)[0], evaluated.jacobian(0, 0, false)(0, 0)};
  }
};

TEST_F(TwoCapsules, ThatAlwaysOverlapAreLeftOutWithoutAnSrdf) {
  std::string urdf = kTwoCapsules;
  const std::string limits = R"(lower="-2" upper="2")";
  urdf.replace(urdf.find(limits), limits.size(), R"(lower="-0.01" upper="0.01")");
  const std::string apart = R"(<origin xyz="0 0 0.2"/>)";
  urdf.replace(urdf.find(apart), apart.size(), R"(<origin xyz="0 0 0.05"/>)");
  const auto load = [&](const std::filesystem::path& srdf) {
    return RobotParameter(folder.write("near.urdf", urdf), srdf, {.floating_base = false});
  };
  const RobotParameter without = load({});
  EXPECT_TRUE(without.robot->self_collision_pairs().empty());
  EXPECT_EQ(without.robot->left_out_pairs().size(), 1u);
  EXPECT_TRUE(without.self_collision.pairs.empty());
  const RobotParameter with = load(folder.write("near.srdf", "<robot name='slider'/>"));
  EXPECT_EQ(with.robot->self_collision_pairs().size(), 1u) << "an SRDF has the word";
  EXPECT_TRUE(with.robot->left_out_pairs().empty());
}

TEST_F(TwoCapsules, AtAKnownDistanceLackThatMuch) {
  ASSERT_EQ(robot.robot->self_collision.pairs.size(), 1u);
  ASSERT_EQ(robot.robot->self_collision.capsules.size(), 2u);
  for (const double slide : {0.34, 0.2, 0.15, 0.1, 1e-3, -0.05, -0.3}) {
    const auto [error, slope] = at(slide);
    EXPECT_NEAR(error, kMargin - (std::abs(slide) - 0.15), 1e-14) << slide;
    EXPECT_NEAR(slope, slide > 0.0 ? -1.0 : 1.0, 1e-12) << slide;
  }
  for (const double slide : {0.36, 1.0, -0.36}) {
    EXPECT_EQ(at(slide).first, 0.0);
    EXPECT_EQ(at(slide).second, 0.0);
  }
}

TEST_F(TwoCapsules, WhoseAxesMeetAreAsDeepAsTheyCanBeAndStillKnowAWayOut) {
  const auto [error, slope] = at(0.0);
  EXPECT_NEAR(error, kMargin + 0.15, 1e-14);
  EXPECT_NEAR(std::abs(slope), 1.0, 1e-12);
}

TEST(SelfCollision, AgreesWithExactDistancesNearHome) {
  const RobotCase robot = robot_case("CentauroAllJoints");
  const CollisionWorld exact(robot.model(), World());
  Random random(56);
  constexpr double kMargin = 0.1;
  const EdgeSelfCollision edge(*robot.robot, kMargin, 1.0);
  int apart = 0, equal = 0;
  for (int i = 0; i < 100; ++i) {
    Eigen::VectorXd step = random.vector(robot.model().tangent_size(), 0.4), q = home(robot);
    robot.model().integrate(q.data(), step.data(), q.data());
    const ConfigurationState state = state_of(robot, q);
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t link = 0; link < robot.model().links().size(); ++link) {
      poses.push_back(state.kinematics.world_from_link(static_cast<int>(link)));
    }
    const double distance = exact.self_distance(poses).distance_m;
    if (distance < 1e-3 || distance > kMargin) continue;
    const double found = kMargin - error_of(robot, edge, q).maxCoeff();
    EXPECT_LE(found, distance + 1e-6);
    EXPECT_GE(found, distance - 2.0 * kSelfOvershoot_m - 1e-6);
    ++apart;
    equal += std::abs(found - distance) < 1e-6;
  }
  EXPECT_GT(apart, 20);
  EXPECT_GT(equal, 10) << "CENTAURO is made of capsules for the most part";
}

TEST(SelfCollision, LeavesOutPairsThatNoActiveJointMoves) {
  const RobotCase legs = robot_case("CentauroLowerBody"), all = robot_case("CentauroAllJoints");
  EXPECT_EQ(all.robot->self_collision.pairs.size(), all.model().self_collision_pairs().size());
  EXPECT_LT(legs.robot->self_collision.pairs.size(), legs.model().self_collision_pairs().size());
  for (const SelfCollisionShapes::Pair& pair : legs.robot->self_collision.pairs) {
    const auto a = legs.model().support(legs.robot->bounds[pair.first].link);
    const auto b = legs.model().support(legs.robot->bounds[pair.second].link);
    EXPECT_FALSE(std::ranges::equal(a, b));
  }
}

class SweptObstacleDistance : public testing::Test {
 protected:
  RobotCase robot = centauro_lower_body();
  std::shared_ptr<const WorldParameter> world = std::make_shared<const WorldParameter>();

  Eigen::VectorXd between(double from_x, double to_x, double margin = 0.05, int samples = 2,
                          double from_s = 0.0, double to_s = 1.0) const {
    Graph graph = graph_of(robot);
    graph.parameters().set(kWorld, world);
    graph.add_edge(EdgeSweptObstacleDistance(*robot.robot, kWorld, margin, samples, 1.0),
                   add_configuration(graph, robot, 0, from_s, home(robot, from_x, 0.0)),
                   add_configuration(graph, robot, 1, to_s, home(robot, to_x, 0.0)));
    return Evaluated(graph).error(0);
  }
  Eigen::VectorXd at(double x, double time_s = 0.0) const {
    return error_of(robot, EdgeObstacleDistance(*robot.robot, kWorld, 0.05, 1.0),
                    home(robot, x, 0.0), time_s, world);
  }
};

TEST_F(SweptObstacleDistance, NoticesAThinWallThoughBothEndsAreFree) {
  world = world_of({box_obstacle({0.0, 0.0, 1.0}, {0.01, 6.0, 4.0})});
  ASSERT_TRUE(at(-1.4).isZero(0.0));
  ASSERT_TRUE(at(1.4).isZero(0.0));
  for (const int samples : {1, 2, 3, 7, 40}) {
    EXPECT_GT(between(-1.4, 1.4, 0.05, samples).minCoeff(), 0.0)
        << "every sphere goes through it, samples " << samples;
  }
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() << 0.025, 0.0, 1.0;
  boxes[0].size << 0.02, 4.0, 3.0;
  world = world_of({}, octree_from_boxes(boxes, 0.05));
  ASSERT_TRUE(at(-1.4).isZero(0.0));
  ASSERT_TRUE(at(1.4).isZero(0.0));
  for (const int samples : {1, 2, 3, 7, 40}) {
    EXPECT_GT(between(-1.4, 1.4, 0.05, samples).minCoeff(), 0.0) << samples;
  }
}

TEST_F(SweptObstacleDistance, IsZeroWhereThereIsRoom) {
  EXPECT_TRUE(between(-1.0, 1.0).isZero(0.0)) << "an empty world";
  EXPECT_TRUE(between(-1.0, 1.0, 0.05, 1).isZero(0.0)) << "an empty world, one sample";
  world = world_of({box_obstacle({0.0, 2.5, 0.5}, {8.0, 0.3, 1.0}),
                    box_obstacle({0.0, -2.5, 0.5}, {8.0, 0.3, 1.0})});
  EXPECT_TRUE(between(-0.5, 0.5, 0.05, 2).isZero(0.0));
}

TEST_F(SweptObstacleDistance, IsTheKnownOneForASphereThatPassesABall) {
  const ConfigurationState middle = state_of(robot, home(robot, 0.0, 0.0));
  const double r = robot.robot->spheres[0].radius;
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size << 0.2, 0.0, 0.0;
  ball.world_from_obstacle.translation() =
      middle.sphere_centre(0) + (0.2 + r + 0.04) * Eigen::Vector3d::UnitZ();
  world = world_of({ball});
  // Three samples: the middle one is where the sphere is nearest, 0.04 m away; h = 0.1.
  EXPECT_NEAR(between(-0.3, 0.3, 0.05, 3)[0], std::hypot(r + 0.05, 0.1) - (r + 0.04), 1e-12);
  // Two samples: each 0.15 m beside it.
  EXPECT_NEAR(between(-0.3, 0.3, 0.05, 2)[0],
              std::hypot(r + 0.05, 0.15) - (std::hypot(0.2 + r + 0.04, 0.15) - 0.2), 1e-12);
}

TEST_F(SweptObstacleDistance, HasAGradientJustInsideTheMargin) {
  constexpr double kBeyond = 1e-9, kHalfGap = 0.3;
  const ConfigurationState middle = state_of(robot, home(robot, 0.0, 0.0));
  const double needed = std::hypot(robot.robot->spheres[0].radius + 0.05, kHalfGap);
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size << 0.2, 0.0, 0.0;
  ball.world_from_obstacle.translation() =
      middle.sphere_centre(0) + (0.2 + needed - kBeyond) * Eigen::Vector3d::UnitZ();
  world = world_of({ball});
  Graph graph = graph_of(robot);
  graph.parameters().set(kWorld, world);
  graph.add_edge(EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.05, 1, 1.0),
                 add_configuration(graph, robot, 0, 0.0, home(robot, -kHalfGap, 0.0)),
                 add_configuration(graph, robot, 1, 1.0, home(robot, kHalfGap, 0.0)));
  Evaluated evaluated(graph);
  EXPECT_NEAR(evaluated.error(0)[0], kBeyond, 1e-14);
  for (const int slot : {0, 1}) {
    // Half of the way up, and the padding √(ρ² + h²) by the length of the step.
    const Eigen::MatrixXd j = evaluated.jacobian(0, slot, false);
    EXPECT_NEAR(j(0, 2), 0.5, 1e-9);
    EXPECT_NEAR(j(0, 0), (slot == 0 ? -0.5 : 0.5) * kHalfGap / needed, 1e-9);
  }
}

TEST_F(SweptObstacleDistance, MeetsMovingObstaclesAtTheRightTime) {
  Obstacle cart = box_obstacle({0.0, -4.0, 0.7}, {0.2, 0.2, 0.2});
  KeyFrame there;
  there.time_s = 10.0;
  there.pose.translation() << 0.0, 4.0, 0.7;
  cart.motion.push_back(there);
  world = world_of({cart});
  // It crosses the robot's way at 5 s; the robot is far from there at either end of its step.
  ASSERT_TRUE(at(-1.5, 4.0).isZero(0.0));
  ASSERT_TRUE(at(1.5, 6.0).isZero(0.0));
  EXPECT_GT(between(-1.5, 1.5, 0.05, 4, 4.0, 6.0).maxCoeff(), 0.0);
  EXPECT_TRUE(between(-1.5, 1.5, 0.05, 4, 0.0, 2.0).isZero(0.0)) << "before it comes";
  EXPECT_TRUE(between(-1.5, 1.5, 0.05, 4, 8.0, 10.0).isZero(0.0)) << "after it has gone";
}

TEST_F(SweptObstacleDistance, CountsTheWayRelativeToAnObstacleThatMovesAlong) {
  Obstacle escort;
  escort.shape = Obstacle::Shape::kSphere;
  escort.size << 0.2, 0.0, 0.0;
  escort.world_from_obstacle.translation() << -1.0, 0.0, 1.6;
  KeyFrame there;
  there.time_s = 1.0;
  there.pose.translation() << 1.0, 0.0, 1.6;
  escort.motion.push_back(there);
  world = world_of({escort});
  const Eigen::VectorXd swept = between(-1.0, 1.0, 0.05, 1), middle = at(0.0, 0.5);
  ASSERT_GT(middle.maxCoeff(), 0.01);
  EXPECT_LT((swept - middle).cwiseAbs().maxCoeff(), 1e-12) << "relative to it the robot stands";
}

TEST_F(SweptObstacleDistance, MeetsWhatComesStraightTowardsItAtTheEndOfTheStep) {
  Obstacle cart = box_obstacle({-3.0, 0.0, 0.7}, {0.4, 0.4, 1.4});
  KeyFrame there;
  there.time_s = 1.0;
  there.pose.translation() << -0.4, 0.0, 0.7;
  cart.motion.push_back(there);
  world = world_of({cart});
  const Eigen::VectorXd end = at(0.0, 1.0);
  ASSERT_GT(end.maxCoeff(), 0.01);
  for (const int samples : {1, 2, 4}) {
    EXPECT_GE((between(0.0, 0.0, 0.05, samples) - end).minCoeff(), -1e-12) << samples;
  }
}

TEST_F(SweptObstacleDistance, CountsAnObstacleAllAlongAStepThatItIsThereForAPartOf) {
  Obstacle wall = box_obstacle({0.0, 0.0, 1.0}, {0.01, 6.0, 4.0});
  world = world_of({wall});
  const Eigen::VectorXd always = between(-1.4, 1.4, 0.05, 3, 4.0, 6.0);
  ASSERT_GT(always.maxCoeff(), 0.0);
  const auto error = [&](double appears_s, double vanishes_s) {
    wall.appears_s = appears_s;
    wall.vanishes_s = vanishes_s;
    world = world_of({wall});
    return between(-1.4, 1.4, 0.05, 3, 4.0, 6.0);
  };
  EXPECT_EQ(error(0.0, 10.0), always);
  EXPECT_EQ(error(5.9, 10.0), always) << "it appears after the last look at the way";
  EXPECT_EQ(error(6.0, 10.0), always);
  EXPECT_EQ(error(0.0, 4.0), always);
  EXPECT_EQ(error(4.9, 4.95), always) << "it is there between two looks";
  EXPECT_TRUE(error(6.1, 10.0).isZero(0.0));
  EXPECT_TRUE(error(0.0, 3.9).isZero(0.0));
}

TEST_F(SweptObstacleDistance, IsThatOfAWorldThatIsBoundAsIfItWereTheGraphsOwn) {
  Graph graph = graph_of(robot);
  graph.parameters().set(kWorld, world);
  graph.add_edge(EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.05, 2, 1.0),
                 add_configuration(graph, robot, 0, 0.0, home(robot, -1.4, 0.0)),
                 add_configuration(graph, robot, 1, 1.0, home(robot, 1.4, 0.0)));
  expect_bound_as_own(graph, world_of({box_obstacle({0.0, 0.0, 1.0}, {0.01, 6.0, 4.0})}));
}

TEST_F(SweptObstacleDistance, MissesNothingThatALookEverywhereFinds) {
  std::vector<Obstacle> obstacles = some_obstacles();
  for (Obstacle& obstacle : obstacles) {
    if (!obstacle.motion.empty()) obstacle.motion[0].pose.linear() = Eigen::Matrix3d::Identity();
  }
  world = world_of(obstacles);
  const WorldDistance& seen = world->snapshot->distance();
  Random random(57);
  const Robot& model = robot.model();
  constexpr int kRuns = kStates / 2;
  int found = 0;
  for (int i = 0; i < kRuns; ++i) {
    const Eigen::VectorXd q = random.configuration(model, 1.0, 0.0);
    Eigen::VectorXd step = random.vector(model.tangent_size(), 0.5), to(q.size());
    model.integrate(q.data(), step.data(), to.data());
    const ConfigurationState a = state_of(robot, q, 1.0), b = state_of(robot, to, 2.0);
    Graph graph = graph_of(robot);
    graph.parameters().set(kWorld, world);
    graph.add_edge(EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.05, 1 + i % 3, 1.0),
                   add_configuration(graph, robot, 0, 1.0, q),
                   add_configuration(graph, robot, 1, 2.0, to));
    const Eigen::VectorXd e = Evaluated(graph).error(0);
    for (int s = 0; s < e.size(); ++s) {
      const auto room = [&](double f) {
        return seen.distance((1.0 - f) * a.sphere_centre(s) + f * b.sphere_centre(s), 1.0 + f) -
               robot.robot->spheres[s].radius - 0.05;
      };
      double least = 0.0;
      for (int k = 1; k < 200; ++k) least = std::min(least, room(k / 200.0));
      if (least > -1e-4 || least >= std::min(room(0.0), room(1.0)) - 1e-4) continue;
      EXPECT_GT(e[s], 0.0) << "sphere " << s << " of step " << i;
      ++found;
    }
  }
  EXPECT_GT(found, 5 * kRuns / 3);
}

}  // namespace
}  // namespace locograph::test
