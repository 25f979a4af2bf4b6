#include "common/allocation_counter.h"
#include "common/sanitized.h"
#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

/// A plan with every edge on 20 configurations that violate some of everything; the first fixed.
/// backwards: half of the binary edges name the later configuration first.
Graph plan_with_everything(const RobotCase& robot,
                           const std::shared_ptr<const WorldParameter>& world, bool backwards,
                           bool kernels) {
  Random random(31);
  const Robot& model = robot.model();
  const int tangent = model.tangent_size();
  Graph graph = graph_of(robot);
  graph.parameters().set(kWorld, world);
  std::vector<VertexId<VertexConfiguration>> ids;
  Eigen::VectorXd q = model.floating_base() ? home(robot) : model.named_configuration("home");
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd step = random.vector(tangent, 0.3);
    if (model.floating_base()) step.head<6>() *= 0.3;
    model.integrate(q.data(), step.data(), q.data());
    ids.push_back(add_configuration(graph, robot, i, 0.1 * i, q));
  }
  graph.set_fixed(ids[0], true);
  graph.set_fixed(ids[7], true);
  const char* names[] = {"none", "huber:0.5", "cauchy:1"};
  int next = 0;
  const auto dress = [&](auto edge) {
    edge.weights = random.weights(edge.weights.size());
    edge.weights[random.uniform(0.0, 1.0) < 0.5 ? 0 : edge.weights.size() - 1] = 0.0;
    if (kernels) edge.kernel = RobustKernel::parse(names[next++ % 3]);
    return edge;
  };
  for (std::size_t i = 0; i < ids.size(); ++i) {
    graph.add_edge(dress(EdgeJointLimits(model, 0.5, 1.0)), ids[i]);
    graph.add_edge(dress(EdgeObstacleDistance(*robot.robot, kWorld, 0.1, 1.0)), ids[i]);
    graph.add_edge(dress(EdgeSelfCollision(*robot.robot, 0.05, 1.0)), ids[i]);
    for (int w = 0; w < 4; ++w) graph.add_edge(dress(wheel_contact(graph, w)), ids[i]);
    graph.add_edge(dress(EdgePlanTracking(random.configuration(model, 1.0, 0.0),
                                          Eigen::VectorXd::Ones(tangent))),
                   ids[i]);
    if (i == 0) continue;
    const bool swap = backwards && i % 2 == 0;
    const auto a = ids[swap ? i : i - 1], b = ids[swap ? i - 1 : i];
    graph.add_edge(dress(EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.1, 3, 1.0)), a, b);
    graph.add_edge(dress(rolling_of(graph)), a, b);
    // From far enough away that it counts.
    graph.add_edge(dress(steering_slip_of(graph, 0.0)), ids[swap ? i : 0], ids[swap ? 0 : i]);
    graph.add_edge(
        dress(EdgeVelocityTracking(random.vector(tangent, 0.1), Eigen::VectorXd::Ones(tangent))), a,
        b);
    if (i > 1) {
      graph.add_edge(dress(EdgeAccelerationTracking(random.vector(tangent, 0.1),
                                                    Eigen::VectorXd::Ones(tangent))),
                     ids[i - 2], ids[i - 1], ids[i]);
    }
    // Velocity limits follow the time.
    graph.add_edge(dress(EdgeVelocityLimits(model, 0.3, 0.2, 0.2, 1.0)), ids[i - 1], ids[i]);
  }
  return graph;
}

std::shared_ptr<const WorldParameter> everything_around() {
  return world_of(some_obstacles(), some_map(false));
}

class Batch : public testing::TestWithParam<std::string> {};

TEST_P(Batch, IsTheSumOverItsEdgesOneByOne) {
  const RobotCase robot = robot_case(GetParam());
  for (const bool kernels : {false, true}) {
    if (kSanitized && !kernels) continue;
    Graph graph = plan_with_everything(robot, everything_around(), true, kernels);
    ASSERT_EQ(graph.edge_pools().size(), 11u);
    Problem problem;
    problem.compile(graph);
    ASSERT_EQ(problem.dimension(), 18 * robot.model().tangent_size());
    Workspace workspace;
    workspace.allocate(problem);
    workspace.load_state();
    EXPECT_GT(expect_batch_equals_one_by_one(workspace, 1e-12).gradient.norm(), 1.0);
    // Every kind of edge has something to say here.
    for (std::size_t p = 0; p < problem.edges().size(); ++p) {
      double squared = 0.0;
      for (std::size_t k = 0; k < problem.edges()[p].edges.size(); ++k) {
        Eigen::VectorXd e(graph.edge_pools()[p]->dimension(problem.edges()[p].edges[k]));
        workspace.error(static_cast<int>(p), static_cast<int>(k), e.data());
        squared += e.squaredNorm();
      }
      EXPECT_GT(squared, 1e-3) << graph.edge_pools()[p]->tag();
    }
  }
}

TEST_P(Batch, HasTheGradientOfItsCost) {
  const RobotCase robot = robot_case(GetParam());
  Graph graph = plan_with_everything(robot, everything_around(), false, false);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());
  workspace.linearise();
  const Eigen::VectorXd gradient = dense_gradient(workspace);
  Random random(32);
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd direction = random.vector(problem.dimension(), 1.0).normalized();
    constexpr double kStep = 1e-5;
    double cost[2];
    for (const int side : {0, 1}) {
      Eigen::Map<Eigen::VectorXd>(workspace.step().data(), direction.size()) =
          (side == 0 ? -kStep : kStep) * direction;
      workspace.apply_step();
      cost[side] = workspace.evaluate(workspace.trial()).chi2;
    }
    // χ² = eᵀΩe: its slope is 2 JᵀΩe. Kinks of hinges within the step leave a trace.
    EXPECT_NEAR((cost[1] - cost[0]) / (2.0 * kStep), 2.0 * gradient.dot(direction),
                1e-4 * gradient.norm());
  }
}

TEST_P(Batch, DoesNotAllocateOverAWindowOfTwentyConfigurations) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const RobotCase robot = robot_case(GetParam());
  Graph graph = plan_with_everything(robot, everything_around(), true, true);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  Eigen::Map<Eigen::VectorXd>(workspace.step().data(), problem.dimension()).setConstant(1e-3);
  workspace.evaluate(workspace.state());  // as Optimiser::start() does: views of worlds are made
  const long before = allocation_count();
  workspace.evaluate(workspace.state());
  workspace.linearise();
  workspace.apply_step();
  const Cost cost = workspace.evaluate(workspace.trial());
  workspace.accept_trial();
  workspace.linearise();
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(std::isfinite(cost.chi2));
}

TEST_P(Batch, IsTheSameBitsEveryTime) {
  const RobotCase robot = robot_case(GetParam());
  std::vector<double> hessian, gradient;
  for (int i = 0; i < 2; ++i) {
    Graph graph = plan_with_everything(robot, everything_around(), true, true);
    Loaded loaded(graph);
    loaded.workspace.evaluate(loaded.workspace.state());
    loaded.workspace.linearise();
    if (i == 0) {
      hessian.assign(loaded.workspace.hessian().begin(), loaded.workspace.hessian().end());
      gradient.assign(loaded.workspace.gradient().begin(), loaded.workspace.gradient().end());
    } else {
      EXPECT_TRUE(std::ranges::equal(hessian, loaded.workspace.hessian()));
      EXPECT_TRUE(std::ranges::equal(gradient, loaded.workspace.gradient()));
    }
  }
}

TEST(Window, TakesTheRobotOfEachConfigurationWhenItSlidesFromOneRobotToAnother) {
  // Two robots with as many joints, but not the same ones.
  const RobotCase robots[] = {
      centauro("FrontLeg", {.active_joints = {"knee_pitch_1", "j_wheel_1"}}),
      centauro("RearLeg", {.active_joints = {"knee_pitch_4", "j_wheel_4"}})};
  ASSERT_EQ(robots[0].model().tangent_size(), robots[1].model().tangent_size());
  Graph graph;
  std::vector<int> slots;
  for (int r : {0, 1}) {
    graph.parameters().set(10 * r, robots[r].robot);
    const auto parameter = std::make_shared<const ContactParameter>(
        robots[r].robot, 10 * r, wheel_on_ground(r == 0 ? "wheel_1" : "wheel_4", 0.078));
    graph.parameters().set(10 * r + 1, parameter);
    Eigen::VectorXd q = home(robots[r]);
    q[7] += 0.3;
    const auto id = graph.add_vertex(r, VertexConfiguration(10 * r, robots[r].robot, 0.0, q));
    graph.add_edge(EdgeContact(*parameter, 10 * r + 1, 1.0), id);
    slots.push_back(id.slot);
  }
  Problem problem;
  Workspace sliding;
  for (int r : {0, 1, 0}) {
    problem.compile(graph, std::span<const int>(slots).subspan(r, 1));
    sliding.allocate(problem);
    sliding.load_state();
    const double chi2 = sliding.evaluate(sliding.state()).chi2;
    Workspace fresh;
    fresh.allocate(problem);
    fresh.load_state();
    EXPECT_EQ(chi2, fresh.evaluate(fresh.state()).chi2) << "robot " << r;
    EXPECT_GT(chi2, 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Plugins, Batch, testing::ValuesIn(wheeled_cases()), robot_case_name);

}  // namespace
}  // namespace locograph::test
