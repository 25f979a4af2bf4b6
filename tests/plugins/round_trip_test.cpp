#include <locograph/common/input_file.h>

#include <cstring>

#include "core/cost_of.h"
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
    if (!original.wheels.empty()) {
      urdf = root / "robots/robot.urdf";
      srdf = root / "robots/robot one.srdf";  // a blank, which must be quoted
      fs::copy(original.robot->urdf, urdf);
      fs::copy(original.robot->srdf, srdf);
    } else {  // has meshes beside it
      urdf = original.robot->urdf;
      srdf = original.robot->srdf;
    }
    robot.robot = std::make_shared<const RobotParameter>(urdf, srdf, original.robot->options);
    robot.wheels = original.wheels;
    for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
      Contact& wheel = robot.wheels[i];
      wheel.effector.radius_m +=
          1e-17 * static_cast<double>(i) + 0.001 / 3.0 * static_cast<double>(i);
      wheel.position = {1.0 / 3.0, 0.1 * static_cast<double>(i), 1e-17};
      wheel.normal = {0.1, 1.0 / 7.0, 3.0};
      wheel.locked = i == 1;
      wheel.bears_load = i != 2;
      if (i == 3) wheel.forward = Eigen::Vector3d(1.0 / 9.0, 0.0, 0.0);
    }
    save_octree(*some_map(true), root / "maps/map.bt");
    save_obstacles(some_obstacles(), root / "maps/obstacles.xml");
  }

  /// Every vertex, edge and parameter, with numbers that need all their digits.
  Graph everything() const {
    Random random(41);
    const Robot& model = robot.model();
    Graph graph = graph_of(robot);
    graph.parameters().set(
        kWorld, std::make_shared<const WorldParameter>(
                    WorldFiles{root / "maps/map.bt", root / "maps/obstacles.xml"}, 0.1 / 3.0));
    auto scenario = std::make_shared<ScenarioParameter>();
    scenario->scenario = "a drive, \"quoted\"";
    graph.parameters().set(3, scenario);
    const auto plan = std::make_shared<PlanParameter>();
    plan->stances_only = true;
    plan->moves = {.most_m = 0.1 / 3.0, .seed = 1ULL << 63, .draws = 7};
    graph.parameters().set(kPlan, plan);
    const auto contacts = std::make_shared<ContactsParameter>();
    contacts->file = root / "maps/obstacles.xml";
    graph.parameters().set(8, contacts);
    graph.parameters().set(7, std::make_shared<const WorldParameter>(WorldFiles()));
    std::vector<VertexId<VertexConfiguration>> ids;
    for (int i = 0; i < 5; ++i) {
      ids.push_back(add_configuration(graph, robot, 10 * i, 0.1 * i + 1.0 / 3.0,
                                      random.configuration(model, 100.0, 0.0)));
      if (!robot.wheels.empty() && i != 2) graph.vertex(ids.back()).stance_number = kStance;
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
      if (!robot.wheels.empty()) {
        add(graph, random, i, wheel_contact(graph, i % 4), ids[i]);
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
      if (i > 1) {
        add(graph, random, i,
            EdgeAccelerationTracking(random.vector(model.tangent_size(), 1.0),
                                     random.weights(model.tangent_size())),
            ids[i - 2], ids[i - 1], ids[i]);
      }
      if (!robot.wheels.empty()) {
        add(graph, random, i, rolling_of(graph), ids[i - 1], ids[i]);
        add(graph, random, i, steering_slip_of(graph, 0.002), ids[i - 1], ids[i]);
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
      EXPECT_EQ(one.stance_number, other.stance_number);
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
    expect_same_edges<EdgeContact>(
        a, b, [](const auto& x, const auto& y) { return x.contact_number == y.contact_number; });
    expect_same_edges<EdgeRolling>(
        a, b, [](const auto& x, const auto& y) { return x.stance_number == y.stance_number; });
    expect_same_edges<EdgeSteeringSlip>(a, b, [](const auto& x, const auto& y) {
      return x.stance_number == y.stance_number && x.max_slip_m == y.max_slip_m;
    });
    expect_same_edges<EdgeVelocityLimits>(a, b, [](const auto& x, const auto& y) {
      return x.fraction == y.fraction && x.base_linear_m_s == y.base_linear_m_s &&
             x.base_angular_rad_s == y.base_angular_rad_s;
    });
    expect_same_edges<EdgeAccelerationTracking>(a, b, [](const auto& x, const auto& y) {
      expect_same_bits(x.acceleration, y.acceleration);
      return true;
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
    EXPECT_EQ(world_a->ground_z_m, world_b->ground_z_m);
    const WorldDistance &seen_a = world_a->snapshot->distance(),
                        &seen_b = world_b->snapshot->distance();
    EXPECT_EQ(seen_a.obstacles.size(), seen_b.obstacles.size());
    ASSERT_TRUE(seen_a.map && seen_b.map);
    EXPECT_TRUE(std::ranges::equal(seen_a.map->values(), seen_b.map->values()));
    EXPECT_EQ(a.parameters().get<ScenarioParameter>(3)->scenario,
              b.parameters().get<ScenarioParameter>(3)->scenario);
    EXPECT_TRUE(b.parameters().get<WorldParameter>(7)->snapshot->files().empty());
    EXPECT_TRUE(b.parameters().get<PlanParameter>(kPlan)->stances_only);
    const ContactMoves& moves = b.parameters().get<PlanParameter>(kPlan)->moves;
    EXPECT_EQ(moves.most_m, 0.1 / 3.0);
    EXPECT_EQ(moves.seed, 1ULL << 63);
    EXPECT_EQ(moves.draws, 7);
    // Relative to folders that may have moved meanwhile.
    EXPECT_EQ(a.parameters().get<ContactsParameter>(8)->file.filename(),
              b.parameters().get<ContactsParameter>(8)->file.filename());
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
  EXPECT_EQ(cost_of(graph).chi2, cost_of(again).chi2);
  EXPECT_GT(cost_of(graph).chi2, 0.0);
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

TEST(ScenarioInAFile, IsANameOrAPathRelativeToTheFile) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "plans");
  const auto written = [&](const std::string& scenario) {
    Graph graph;
    const auto parameter = std::make_shared<ScenarioParameter>();
    parameter->scenario = scenario;
    graph.parameters().set(3, parameter);
    const std::string text = write_graph_text(graph, folder.path() / "plans");
    const Graph again = read_graph_text(text, "plan.g2o", folder.path() / "plans", robot_types());
    return std::pair(text, again.parameters().get<ScenarioParameter>(3)->scenario);
  };
  EXPECT_EQ(written("centauro_drive"), std::pair(std::string("PARAMS_SCENARIO 3 centauro_drive\n"),
                                                 std::string("centauro_drive")));
  const std::string beside = folder.path() / "plans/hall.xml", above = folder.path() / "hall.xml";
  EXPECT_EQ(written(beside).first, "PARAMS_SCENARIO 3 ./hall.xml\n");
  EXPECT_EQ(fs::path(written(beside).second).lexically_normal(), beside);
  EXPECT_EQ(written(above).first, "PARAMS_SCENARIO 3 ../hall.xml\n");
  EXPECT_EQ(fs::path(written(above).second).lexically_normal(), above);
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
