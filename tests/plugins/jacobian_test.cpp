#include "plugins/jacobian_comparison.h"
#include "plugins/kink_distance.h"
#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

class JacobianOf : public RobotCaseTest {
 protected:
  /// Vertices in pairs 0-1, 2-3, …: the second is `step` away from the first.
  std::vector<VertexId<VertexConfiguration>> pairs(Graph& graph, Random& random, double linear,
                                                   double angular, double joint, double dt_s) {
    std::vector<VertexId<VertexConfiguration>> ids;
    const Robot& model = robot.model();
    Eigen::VectorXd to(model.configuration_size());
    for (int i = 0; i < kStates; ++i) {
      const Eigen::VectorXd from = random.configuration(model, 2.0, 0.0);
      Eigen::VectorXd step = random.vector(model.tangent_size(), joint);
      if (model.floating_base()) {
        step.head<3>() = random.uniform(0.0, linear) * random.direction();
        step.segment<3>(3) = random.uniform(0.0, angular) * random.direction();
      }
      model.integrate(from.data(), step.data(), to.data());
      ids.push_back(add_configuration(graph, robot, 2 * i, 1.0, from));
      ids.push_back(add_configuration(graph, robot, 2 * i + 1, 1.0 + dt_s, to));
    }
    return ids;
  }
  template <class E>
  void compare_pairs(const E& edge, double linear, double angular, double joint) {
    Random random(3);
    Graph graph = graph_of(robot);
    const auto ids = pairs(graph, random, linear, angular, joint, 0.5);
    for (int i = 0; i < kStates; ++i) graph.add_edge(edge, ids[2 * i], ids[2 * i + 1]);
    Evaluated evaluated(graph);
    Compared compared;
    for (int k = 0; k < kStates; ++k) {
      for (const int slot : {0, 1}) compare(evaluated, k, slot, kEverywhere, compared);
    }
    EXPECT_EQ(compared.rows, 2 * kStates * edge.dimension());
    EXPECT_EQ(compared.zero, 0);
  }
};

TEST_P(JacobianOf, JointLimitsIsThatOfNumericDifferences) {
  Random random(1);
  const Robot& model = robot.model();
  Graph graph = graph_of(robot);
  // The second margin is wider than half the range of most joints: both limits are violated at
  // once, and the worse one counts.
  const double margins[] = {0.1, 2.5};
  for (int i = 0; i < kStates; ++i) {
    const double margin = margins[i % 2];
    Eigen::VectorXd q = random.configuration(model, 2.0, 0.4);
    for (int j = 0; j < model.active_joint_count(); ++j) {
      const Joint& joint = model.active_joint(j);
      const double kinks[] = {joint.lower + margin, joint.upper - margin,
                              0.5 * (joint.lower + joint.upper)};
      double& position = q[model.base_configuration_size() + j];
      for (const double kink : kinks) {
        if (std::abs(position - kink) < kKink) position = kink + 2.0 * kKink;
      }
    }
    graph.add_edge(EdgeJointLimits(model, margin, 1.0), add_configuration(graph, robot, i, 0.0, q));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
  EXPECT_GT(compared.nonzero, compared.rows / 10);
  EXPECT_GT(compared.zero, compared.rows / 10);
}

TEST_P(JacobianOf, VelocityLimitsIsThatOfNumericDifferences) {
  Random random(2);
  const Robot& model = robot.model();
  constexpr double kDt = 0.2, kFraction = 0.9, kLinear = 1.0, kAngular = 2.0;
  Graph graph = graph_of(robot);
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd from = random.configuration(model, 2.0, 0.0);
    Eigen::VectorXd step(model.tangent_size()), to(model.configuration_size());
    // Zero to twice the limit, off the limit itself.
    const auto away = [&](double limit) {
      const double size = random.uniform(kKink, 2.0 * limit);
      return std::abs(size - limit) < kKink ? limit + 2.0 * kKink : size;
    };
    if (model.floating_base()) {
      step.head<3>() = away(kLinear * kDt) * random.direction();
      step.segment<3>(3) = away(kAngular * kDt) * random.direction();
    }
    for (int j = 0; j < model.active_joint_count(); ++j) {
      step[model.base_tangent_size() + j] =
          random.sign() * away(kFraction * model.active_joint(j).max_velocity * kDt);
    }
    model.integrate(from.data(), step.data(), to.data());
    const auto a = add_configuration(graph, robot, 2 * i, 3.0, from);
    const auto b = add_configuration(graph, robot, 2 * i + 1, 3.0 + kDt, to);
    graph.add_edge(EdgeVelocityLimits(model, kFraction, kLinear, kAngular, 1.0), a, b);
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    for (const int slot : {0, 1}) compare(evaluated, k, slot, kEverywhere, compared);
  }
  EXPECT_GT(compared.nonzero, compared.rows / 3);
  EXPECT_GT(compared.zero, compared.rows / 3);
}

TEST_P(JacobianOf, PlanTrackingIsThatOfNumericDifferences) {
  Random random(4);
  const Robot& model = robot.model();
  Graph graph = graph_of(robot);
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd reference = random.configuration(model, 2.0, 0.0);
    Eigen::VectorXd step = random.vector(model.tangent_size(), 1.0), q(reference.size());
    if (model.floating_base()) {
      // From hardly turned to nearly half a turn, where the logarithm still is smooth.
      const double angle = i % 3 == 0 ? 1e-6 : i % 3 == 1 ? random.uniform(0.0, 1.0) : 3.1;
      step.segment<3>(3) = angle * random.direction();
    }
    model.integrate(reference.data(), step.data(), q.data());
    graph.add_edge(EdgePlanTracking(reference, Eigen::VectorXd::Ones(model.tangent_size())),
                   add_configuration(graph, robot, i, 0.0, q));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
  EXPECT_EQ(compared.rows, kStates * model.tangent_size());
  EXPECT_EQ(compared.zero, 0);
}

TEST_P(JacobianOf, VelocityTrackingIsThatOfNumericDifferences) {
  Random random(5);
  const int n = robot.model().tangent_size();
  compare_pairs(EdgeVelocityTracking(random.vector(n, 0.3), Eigen::VectorXd::Ones(n)), 1.0, 3.0,
                0.5);
}

TEST_P(JacobianOf, AccelerationTrackingIsThatOfNumericDifferences) {
  Random random(15);
  const Robot& model = robot.model();
  const int n = model.tangent_size();
  Graph graph = graph_of(robot);
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd here = random.configuration(model, 2.0, 0.0);
    const auto near = [&](int id, double time_s) {
      Eigen::VectorXd moved(model.configuration_size());
      const Eigen::VectorXd by = random.vector(n, 0.3);
      model.integrate(here.data(), by.data(), moved.data());
      return add_configuration(graph, robot, id, time_s, moved);
    };
    const auto before = near(3 * i, 0.5), after = near(3 * i + 1, 1.4);
    graph.add_edge(EdgeAccelerationTracking(random.vector(n, 0.3), Eigen::VectorXd::Ones(n)),
                   before, add_configuration(graph, robot, 3 * i + 2, 1.0, here), after);
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    for (const int slot : {0, 1, 2}) compare(evaluated, k, slot, kEverywhere, compared);
  }
  EXPECT_EQ(compared.nonzero, 3 * n * kStates);
}

class WheelJacobianOf : public JacobianOf {};

TEST_P(WheelJacobianOf, WheelContactIsThatOfNumericDifferences) {
  Random random(6);
  Graph graph = graph_of(robot);
  for (int i = 0; i < kStates; ++i) {
    graph.add_edge(
        wheel_contact(graph, i % 4),
        add_configuration(graph, robot, i, 0.0, random.configuration(robot.model(), 2.0, 0.0)));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
  EXPECT_EQ(compared.rows, kStates * 2);
  EXPECT_EQ(compared.zero, 0);
}

TEST_P(WheelJacobianOf, RollingIsThatOfNumericDifferences) {
  // Each on a plane of its own, one of them locked.
  Random random(7);
  for (Contact& wheel : robot.wheels) wheel.normal = Eigen::Vector3d(0, 0, 3) + random.direction();
  robot.wheels[2].locked = true;
  compare_pairs(rolling_of(graph_of(robot)), 0.5, 0.8, 0.4);
  compare_pairs(steering_slip_of(graph_of(robot), 0.0), 0.5, 0.8, 0.4);
}

void compare_distances(const RobotCase& robot, const std::shared_ptr<const WorldParameter>& world,
                       unsigned seed) {
  constexpr double kMargin = 0.15;
  Random random(seed);
  Graph graph = graph_of(robot);
  const WorldDistance& now = world->snapshot->distance();
  graph.parameters().set(kWorld, world);
  std::vector<ConfigurationState> states;
  for (int i = 0; i < kStates; ++i) {
    const double time_s = random.uniform(-1.0, 12.0);
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    graph.add_edge(EdgeObstacleDistance(*robot.robot, kWorld, kMargin, 1.0),
                   add_configuration(graph, robot, i, time_s, q));
    states.emplace_back(robot.robot);
    states.back().time_s = time_s;
    states.back().update(q.data());
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    const ConfigurationState& state = states[k];
    const auto smooth = [&](int row) {
      const Eigen::Vector3d& centre = state.sphere_centre(row);
      std::vector<double> distances = {now.max_distance()};
      if (now.map) {
        if (kink_distance(*now.map, centre) < kKink) return false;
        distances.push_back(now.map->distance(centre));
      }
      for (const Obstacle& obstacle : now.obstacles) {
        if (kink_distance(obstacle, centre, state.time_s) < 0.01) return false;
        distances.push_back(obstacle.distance(centre, state.time_s));
      }
      std::sort(distances.begin(), distances.end());
      const double hinge = kMargin + robot.robot->spheres[row].radius - distances[0];
      return distances[1] - distances[0] > kKink && std::abs(hinge) > kKink;
    };
    compare(evaluated, k, 0, smooth, compared);
  }
  const int all = kStates * static_cast<int>(robot.robot->spheres.size());
  EXPECT_GT(compared.rows, all / 2);
  EXPECT_GT(compared.nonzero, 5 * kStates);
  EXPECT_GT(compared.zero, 5 * kStates);
}

TEST_P(JacobianOf, DistanceToPrimitivesIsThatOfNumericDifferences) {
  compare_distances(robot, world_of(some_obstacles()), 7);
}

TEST_P(JacobianOf, DistanceToAMapIsThatOfNumericDifferences) {
  compare_distances(robot, world_of({}, some_map(false)), 8);
}

TEST_P(JacobianOf, DistanceToAMapAndPrimitivesIsThatOfNumericDifferences) {
  compare_distances(robot, world_of(some_obstacles(), some_map(false)), 9);
}

INSTANTIATE_TEST_SUITE_P(Plugins, JacobianOf, testing::ValuesIn(all_cases()), robot_case_name);
INSTANTIATE_TEST_SUITE_P(Plugins, WheelJacobianOf, testing::ValuesIn(wheeled_cases()),
                         robot_case_name);

TEST(HingeGradient, DoesNotVanishJustBeyondAJointLimit) {
  const RobotCase robot = centauro_lower_body();
  const Robot& model = robot.model();
  constexpr double kMargin = 0.05, kBeyond = 1e-9;
  Graph graph = graph_of(robot);
  for (int side = 0; side < 2; ++side) {
    Eigen::VectorXd q = home(robot);
    for (int i = 0; i < model.active_joint_count(); ++i) {
      const Joint& joint = model.active_joint(i);
      if (joint.type == JointType::kContinuous) continue;
      q[robot.base() + i] =
          side == 0 ? joint.lower + kMargin - kBeyond : joint.upper - kMargin + kBeyond;
    }
    graph.add_edge(EdgeJointLimits(model, kMargin, 1.0),
                   add_configuration(graph, robot, side, 0.0, q));
  }
  Evaluated evaluated(graph);
  for (int side = 0; side < 2; ++side) {
    const Eigen::VectorXd e = evaluated.error(side);
    const Eigen::MatrixXd j = evaluated.jacobian(side, 0, false);
    for (int i = 0; i < model.active_joint_count(); ++i) {
      const bool limited = model.active_joint(i).type != JointType::kContinuous;
      EXPECT_NEAR(e[i], limited ? kBeyond : 0.0, 1e-15);
      EXPECT_EQ(j(i, model.base_tangent_size() + i), !limited ? 0.0 : side == 0 ? -1.0 : 1.0);
    }
  }
}

TEST(HingeGradient, DoesNotVanishJustBeyondAVelocityLimit) {
  const RobotCase robot = centauro_lower_body();
  const Robot& model = robot.model();
  constexpr double kDt = 0.1, kBeyond = 1e-9;
  Eigen::VectorXd step(model.tangent_size()), to(model.configuration_size());
  step.head<6>() << 0.6 * (0.05 + kBeyond), 0.8 * (0.05 + kBeyond), 0.0, 0.0, 0.0, 0.1 + kBeyond;
  for (int i = 0; i < model.active_joint_count(); ++i) {
    step[6 + i] = (i % 2 == 0 ? 1.0 : -1.0) * (model.active_joint(i).max_velocity * kDt + kBeyond);
  }
  const Eigen::VectorXd from = home(robot);
  model.integrate(from.data(), step.data(), to.data());
  Graph graph = graph_of(robot);
  const auto a = add_configuration(graph, robot, 0, 0.0, from);
  const auto b = add_configuration(graph, robot, 1, kDt, to);
  graph.add_edge(EdgeVelocityLimits(model, 1.0, 0.5, 1.0, 1.0), a, b);
  Evaluated evaluated(graph);
  const Eigen::VectorXd e = evaluated.error(0);
  for (int r = 0; r < e.size(); ++r) EXPECT_NEAR(e[r], kBeyond, 1e-14) << r;
  for (const int slot : {0, 1}) {
    const Eigen::MatrixXd j = evaluated.jacobian(0, slot, false);
    for (int r = 0; r < e.size(); ++r) EXPECT_NEAR(j.row(r).norm(), 1.0, 1e-12) << r;
  }
}

TEST(HingeGradient, DoesNotVanishJustInsideTheMarginOfAnObstacle) {
  const RobotCase robot = centauro_lower_body();
  constexpr double kMargin = 0.05, kBeyond = 1e-9;
  ConfigurationState state(robot.robot);
  state.update(home(robot).data());
  Graph graph = graph_of(robot);
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size << 0.2, 0.0, 0.0;
  ball.world_from_obstacle.translation() =
      state.sphere_centre(0) +
      (0.2 + kMargin + robot.robot->spheres[0].radius - kBeyond) * Eigen::Vector3d::UnitX();
  graph.parameters().set(kWorld, world_of({ball}));
  graph.add_edge(EdgeObstacleDistance(*robot.robot, kWorld, kMargin, 1.0),
                 add_configuration(graph, robot, 0, 0.0, home(robot)));
  Evaluated evaluated(graph);
  EXPECT_NEAR(evaluated.error(0)[0], kBeyond, 1e-14);
  EXPECT_NEAR(evaluated.jacobian(0, 0, false)(0, 0), 1.0, 1e-12);
}

TEST(WheelLyingFlat, HasFiniteJacobians) {
  const RobotCase robot = centauro_lower_body();
  Eigen::VectorXd q = home(robot);
  // The axles point along y at home: a quarter turn about x stands them upright.
  const Eigen::Quaterniond flat(Eigen::AngleAxisd(0.5 * EIGEN_PI, Eigen::Vector3d::UnitX()));
  q.segment<4>(3) = flat.coeffs();
  Graph graph = graph_of(robot);
  const auto a = add_configuration(graph, robot, 0, 0.0, q);
  const auto b = add_configuration(graph, robot, 1, 1.0, q);
  graph.add_edge(rolling_of(graph), a, b);
  graph.add_edge(wheel_contact(graph, 0), a);
  Evaluated evaluated(graph);
  EXPECT_TRUE(evaluated.error(0, 0).allFinite());
  EXPECT_TRUE(evaluated.jacobian(0, 0, false, 0).allFinite());
  EXPECT_TRUE(evaluated.jacobian(0, 1, false, 0).allFinite());
  EXPECT_TRUE(evaluated.error(0, 1).allFinite());
  EXPECT_TRUE(evaluated.jacobian(0, 0, false, 1).allFinite());
}

}  // namespace
}  // namespace locograph::test
