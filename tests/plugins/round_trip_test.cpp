#include <locograph/common/atomic_file.h>

#include <cstring>

#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

namespace fs = std::filesystem;

/// A project folder: robots/, maps/ and plans/, all of which may move together.
class RoundTrip : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!available(GetParam())) GTEST_SKIP() << GetParam() << " is not tested here";
    for (const char* name : {"robots", "maps", "plans/deep"}) fs::create_directories(root / name);
    const RobotCase original = robot_case(GetParam());
    robot.name = original.name;
    fs::path urdf, srdf;
    if (original.wheels) {
      urdf = root / "robots/robot.urdf";
      srdf = root / "robots/robot one.srdf";  // a blank, which must be quoted
      fs::copy(original.robot->urdf, urdf);
      fs::copy(original.robot->srdf, srdf);
    } else {  // has meshes beside it
      urdf = original.robot->urdf;
      srdf = original.robot->srdf;
    }
    robot.robot = std::make_shared<const RobotParameter>(urdf, srdf, original.robot->options);
    if (original.wheels) {
      std::vector<Wheel> wheels(4);
      for (int i = 0; i < 4; ++i) {
        wheels[i].link_name = "wheel_" + std::to_string(i + 1);
        wheels[i].radius_m = 0.078 + 1e-17 * i + 0.001 * i;
      }
      robot.wheels = std::make_shared<const WheelsParameter>(robot.model(), kRobot, wheels);
    }
    save_octree(*some_map(true), root / "maps/map.bt");
    save_obstacles(some_obstacles(), root / "maps/obstacles.xml");
  }

  /// Every vertex, edge and parameter, with numbers that need all their digits.
  Graph everything() const {
    Random random(41);
    const Robot& model = robot.model();
    Graph graph = graph_of(robot);
    graph.parameters().set(kWorld, std::make_shared<const WorldParameter>(
                                       root / "maps/map.bt", root / "maps/obstacles.xml"));
    auto scenario = std::make_shared<ScenarioParameter>();
    scenario->scenario = "a drive, \"quoted\"";
    graph.parameters().set(3, scenario);
    graph.parameters().set(7, std::make_shared<const WorldParameter>(fs::path(), fs::path()));
    std::vector<VertexId<VertexConfiguration>> ids;
    for (int i = 0; i < 5; ++i) {
      ids.push_back(add_configuration(graph, robot, 10 * i, 0.1 * i + 1.0 / 3.0,
                                      random.configuration(model, 100.0, 0.0)));
    }
    graph.set_fixed(ids[1], true);
    for (int i = 0; i < 5; ++i) {
      add(graph, random, i, EdgeJointLimits(model, 0.1 / 3.0, 1.0), ids[i]);
      add(graph, random, i, EdgeObstacleDistance(*robot.robot, kWorld, 0.2 / 3.0, 1.0), ids[i]);
      add(graph, random, i, EdgeSelfCollision(*robot.robot, 0.1 / 3.0, 1.0), ids[i]);
      add(graph, random, i,
          EdgePlanTracking(random.configuration(model, 3.0, 0.0),
                           random.weights(model.tangent_size())),
          ids[i]);
      if (robot.wheels) {
        add(graph, random, i, EdgeWheelContact(*robot.wheels, kWheels, 1.0), ids[i]);
      }
      if (i == 0) continue;
      add(graph, random, i, EdgeSweptObstacleDistance(*robot.robot, kWorld, 0.2 / 3.0, 1 + i, 1.0),
          ids[i - 1], ids[i]);
      add(graph, random, i, EdgeVelocityLimits(model, 0.7 / 3.0, 0.1 / 3.0, 1e-17, 1.0), ids[i - 1],
          ids[i]);
      add(graph, random, i,
          EdgeVelocityTracking(random.vector(model.tangent_size(), 1.0),
                               random.weights(model.tangent_size())),
          ids[i - 1], ids[i]);
      if (robot.wheels) {
        add(graph, random, i, EdgeRolling(*robot.wheels, kWheels, 1.0), ids[i - 1], ids[i]);
      }
    }
    return graph;
  }
  /// Every other edge has `scalar` weights.
  template <class E, class... Ids>
  static void add(Graph& graph, Random& random, int i, E edge, Ids... ids) {
    if (i % 2 == 0) {
      edge.weights.setConstant(random.uniform(0.0, 1e6));
    } else {
      edge.weights = random.weights(edge.weights.size());
    }
    graph.add_edge(std::move(edge), ids...);
  }

  static void expect_same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(double) * a.size()), 0);
  }
  template <class E, class Same>
  static void expect_same_edges(const Graph& a, const Graph& b, Same same) {
    ASSERT_EQ(a.edges_of<E>().size(), b.edges_of<E>().size());
    for (std::size_t i = 0; i < a.edges_of<E>().size(); ++i) {
      const E &one = a.edges_of<E>()[i], &other = b.edges_of<E>()[i];
      EXPECT_TRUE(one.vertices == other.vertices);
      expect_same_bits(one.weights, other.weights);
      EXPECT_TRUE(same(one, other)) << E::kTag << " " << i;
    }
  }
  static void expect_same(const Graph& a, const Graph& b) {
    ASSERT_EQ(a.vertex_count(), b.vertex_count());
    ASSERT_EQ(a.edge_count(), b.edge_count());
    for (std::size_t i = 0; i < a.vertices_of<VertexConfiguration>().size(); ++i) {
      const VertexConfiguration& one = a.vertices_of<VertexConfiguration>()[i];
      const VertexConfiguration& other = b.vertices_of<VertexConfiguration>()[i];
      expect_same_bits(one.state, other.state);
      EXPECT_EQ(one.time_s, other.time_s);
      EXPECT_EQ(one.robot_number, other.robot_number);
    }
    for (int slot = 0; slot < a.vertex_slots(); ++slot) {
      EXPECT_EQ(a.vertex_record(slot).id, b.vertex_record(slot).id);
      EXPECT_EQ(a.vertex_record(slot).fixed, b.vertex_record(slot).fixed);
    }
    expect_same_edges<EdgeJointLimits>(
        a, b, [](const auto& x, const auto& y) { return x.margin == y.margin; });
    expect_same_edges<EdgeObstacleDistance>(a, b, [](const auto& x, const auto& y) {
      return x.margin_m == y.margin_m && x.world_number == y.world_number;
    });
    expect_same_edges<EdgeSelfCollision>(
        a, b, [](const auto& x, const auto& y) { return x.margin_m == y.margin_m; });
    expect_same_edges<EdgeSweptObstacleDistance>(a, b, [](const auto& x, const auto& y) {
      return x.margin_m == y.margin_m && x.world_number == y.world_number && x.samples == y.samples;
    });
    expect_same_edges<EdgePlanTracking>(a, b, [](const auto& x, const auto& y) {
      expect_same_bits(x.reference, y.reference);
      return true;
    });
    expect_same_edges<EdgeWheelContact>(
        a, b, [](const auto& x, const auto& y) { return x.wheels_number == y.wheels_number; });
    expect_same_edges<EdgeRolling>(
        a, b, [](const auto& x, const auto& y) { return x.wheels_number == y.wheels_number; });
    expect_same_edges<EdgeVelocityLimits>(a, b, [](const auto& x, const auto& y) {
      return x.fraction == y.fraction && x.base_linear_m_s == y.base_linear_m_s &&
             x.base_angular_rad_s == y.base_angular_rad_s;
    });
    expect_same_edges<EdgeVelocityTracking>(a, b, [](const auto& x, const auto& y) {
      expect_same_bits(x.step, y.step);
      return true;
    });
    const auto robot_a = a.parameters().get<RobotParameter>(kRobot);
    const auto robot_b = b.parameters().get<RobotParameter>(kRobot);
    EXPECT_EQ(robot_a->options.active_joints, robot_b->options.active_joints);
    EXPECT_EQ(robot_a->options.floating_base, robot_b->options.floating_base);
    EXPECT_EQ(robot_a->options.lenient_srdf, robot_b->options.lenient_srdf);
    EXPECT_EQ(robot_a->options.frozen_state, robot_b->options.frozen_state);
    EXPECT_EQ(robot_a->robot->tangent_size(), robot_b->robot->tangent_size());
    EXPECT_EQ(robot_a->spheres.size(), robot_b->spheres.size());
    const auto world_a = a.parameters().get<WorldParameter>(kWorld);
    const auto world_b = b.parameters().get<WorldParameter>(kWorld);
    EXPECT_EQ(world_a->now.obstacles.size(), world_b->now.obstacles.size());
    ASSERT_TRUE(world_a->now.map && world_b->now.map);
    EXPECT_TRUE(std::ranges::equal(world_a->now.map->values(), world_b->now.map->values()));
    EXPECT_EQ(a.parameters().get<ScenarioParameter>(3)->scenario,
              b.parameters().get<ScenarioParameter>(3)->scenario);
    EXPECT_TRUE(b.parameters().get<WorldParameter>(7)->map.empty());
  }
  static double chi2(Graph& graph) {
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    workspace.load_state();
    return workspace.evaluate(workspace.state()).chi2;
  }

  TemporaryFolder folder;
  fs::path root = folder.path() / "project";
  RobotCase robot;
};

TEST_P(RoundTrip, KeepsEveryBitOfStatesAndEdges) {
  Graph graph = everything();
  write_graph(graph, root / "plans/plan.g2o");
  Graph again = read_graph(root / "plans/plan.g2o", robot_types());
  expect_same(graph, again);
  EXPECT_EQ(write_graph_text(graph, root / "plans"), write_graph_text(again, root / "plans"));
  EXPECT_EQ(read_file(root / "plans/plan.g2o"), write_graph_text(again, root / "plans"));
  EXPECT_EQ(chi2(graph), chi2(again));
  EXPECT_GT(chi2(graph), 0.0);
}

TEST_P(RoundTrip, FindsRobotAndMapFromWhateverFolderTheGraphIsWrittenTo) {
  Graph graph = everything();
  write_graph(graph, root / "plans/plan.g2o");
  Graph second = read_graph(root / "plans/plan.g2o", robot_types());
  write_graph(second, root / "plans/deep/plan.g2o");
  write_graph(second, root / "top.g2o");
  Graph deep = read_graph(root / "plans/deep/plan.g2o", robot_types());
  expect_same(graph, deep);
  Graph top = read_graph(root / "top.g2o", robot_types());
  expect_same(graph, top);
  EXPECT_NE(read_file(root / "plans/plan.g2o").find(" ../maps/map.bt"), std::string::npos);
  EXPECT_NE(read_file(root / "plans/deep/plan.g2o").find(" ../../maps/map.bt"), std::string::npos);
  EXPECT_NE(read_file(root / "top.g2o").find(" maps/map.bt"), std::string::npos);
  for (const char* name : {"plans/plan.g2o", "plans/deep/plan.g2o", "top.g2o"}) {
    EXPECT_EQ(read_file(root / name).find(root.string()), std::string::npos)
        << name << " holds an absolute path";
  }
}

/// Robots whose files are in the project.
class ProjectRoundTrip : public RoundTrip {};

TEST_P(ProjectRoundTrip, SurvivesMovingTheWholeProject) {
  Graph graph = everything();
  write_graph(graph, root / "plans/plan.g2o");
  const fs::path moved = folder.path() / "elsewhere";
  fs::rename(root, moved);
  expect_same(graph, read_graph(moved / "plans/plan.g2o", robot_types()));
}

TEST_P(RoundTrip, WorksWithFileNamesRelativeToTheCurrentFolder) {
  Graph graph = everything();
  const fs::path before = fs::current_path();
  fs::current_path(root / "plans");
  write_graph(graph, "plan.g2o");
  Graph again = read_graph("plan.g2o", robot_types());
  write_graph(again, "deep/plan.g2o");
  Graph deep = read_graph("deep/plan.g2o", robot_types());
  fs::current_path(before);
  expect_same(graph, again);
  expect_same(graph, deep);
}

class FloatingRoundTrip : public RoundTrip {};

TEST_P(FloatingRoundTrip, NormalisesAQuaternionOnceAndThenKeepsItsBits) {
  Graph graph = graph_of(robot);
  Eigen::VectorXd q = robot.model().neutral_configuration();
  q.segment<4>(3) << 0.3, -0.5, 0.7, 2.1;
  add_configuration(graph, robot, 0, 0.0, q);
  write_graph(graph, root / "plans/once.g2o");
  const Graph once = read_graph(root / "plans/once.g2o", robot_types());
  const Eigen::VectorXd& state = once.vertices_of<VertexConfiguration>()[0].state;
  EXPECT_NEAR(state.segment<4>(3).norm(), 1.0, 1e-15);
  EXPECT_TRUE(state.segment<4>(3).isApprox(q.segment<4>(3).normalized(), 1e-15));
  write_graph(once, root / "plans/twice.g2o");
  const Graph twice = read_graph(root / "plans/twice.g2o", robot_types());
  expect_same_bits(state, twice.vertices_of<VertexConfiguration>()[0].state);
}

INSTANTIATE_TEST_SUITE_P(Plugins, RoundTrip, testing::ValuesIn(all_cases()), robot_case_name);
INSTANTIATE_TEST_SUITE_P(Plugins, ProjectRoundTrip, testing::ValuesIn(wheeled_cases()),
                         robot_case_name);
INSTANTIATE_TEST_SUITE_P(Plugins, FloatingRoundTrip,
                         testing::Values("CentauroLowerBody", "CentauroAllJoints",
                                         "Go2FloatingBase"),
                         robot_case_name);

}  // namespace
}  // namespace locograph::test
