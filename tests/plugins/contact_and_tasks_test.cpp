#include <Eigen/Dense>

#include "common/allocation_counter.h"
#include "plugins/jacobian_comparison.h"
#include "plugins/legged_cases.h"

namespace locograph::test {
namespace {

class ContactsAndTasks : public RobotCaseTest {};

Eigen::Isometry3d turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, axis));
}

/// From hardly turned to nearly half a turn, where the errors still are smooth.
double some_angle(Random& random, int i) {
  return i % 3 == 0 ? 1e-6 : i % 3 == 1 ? random.uniform(0.0, 2.0) : 3.0;
}

TEST_P(ContactsAndTasks, ContactHasTheJacobianOfNumericDifferences) {
  for (const HeldKind& held : kHeldKinds) {
    Random random(61 + static_cast<unsigned>(held.rows));
    Graph graph = graph_of(robot);
    add_frames(graph, robot, random);
    for (int i = 0; i < kStates; ++i) {
      const Eigen::VectorXd q = random.configuration(robot.model(), 2.0, 0.0);
      // About an axis in the surface or, a surface with a yaw of its own, about any.
      const bool all_held = held.rows == 6;
      const Eigen::Vector3d free =
          held.free_yaw ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
      const Eigen::Vector3d about =
          all_held ? random.direction() : free.cross(random.direction()).normalized();
      const Eigen::Isometry3d open =
          Eigen::Translation3d(random.vector(3, 0.5)) * turn(some_angle(random, i), about) *
          (all_held ? Eigen::Isometry3d::Identity() : turn(random.uniform(-3.0, 3.0), free));
      const Eigen::Isometry3d contact =
          frame_pose(graph, kFrame + i % 2, robot, q) * open.inverse();
      graph.add_edge(contact_edge(graph, robot, kFrame + i % 2, held, contact),
                     add_configuration(graph, robot, i, 0.0, q));
    }
    Evaluated evaluated(graph);
    Compared compared;
    for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
    EXPECT_EQ(compared.rows, kStates * held.rows);
    EXPECT_EQ(compared.zero, 0) << held.name;
  }
}

TEST_P(ContactsAndTasks, FramePoseHasTheJacobianOfNumericDifferences) {
  Random random(71);
  Graph graph = graph_of(robot);
  add_frames(graph, robot, random);
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 2.0, 0.0);
    const Eigen::Isometry3d off = Eigen::Translation3d(random.vector(3, 2.0)) *
                                  turn(some_angle(random, i), random.direction());
    graph.add_edge(
        EdgeFramePose(kFrame + i % 2, frame_pose(graph, kFrame + i % 2, robot, q) * off.inverse(),
                      Eigen::Matrix<double, 6, 1>::Ones()),
        add_configuration(graph, robot, i, 0.0, q));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
  EXPECT_EQ(compared.rows, kStates * 6);
  EXPECT_EQ(compared.zero, 0);
}

TEST_P(ContactsAndTasks, ComHasTheJacobianOfNumericDifferences) {
  Random random(72);
  Graph graph = graph_of(robot);
  for (int i = 0; i < kStates; ++i) {
    graph.add_edge(
        EdgeCom(random.vector(3, 1.0), Eigen::Vector3d::Ones()),
        add_configuration(graph, robot, i, 0.0, random.configuration(robot.model(), 2.0, 0.0)));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
  EXPECT_EQ(compared.rows, kStates * 3);
  EXPECT_EQ(compared.zero, 0);
}

TEST_P(ContactsAndTasks, ComIsTheMeanOfTheLinksByMass) {
  Random random(73);
  const Eigen::VectorXd q = random.configuration(robot.model(), 2.0, 0.0);
  const Eigen::Vector3d target = random.vector(3, 1.0);
  ConfigurationState state(robot.robot);
  state.update(q.data());
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double mass = 0.0;
  for (std::size_t i = 0; i < robot.model().links().size(); ++i) {
    const Link& link = robot.model().links()[i];
    moment += link.mass * (state.kinematics.world_from_link(static_cast<int>(i)) * link.com);
    mass += link.mass;
  }
  const Eigen::Vector3d e = error_of(robot, EdgeCom(target, Eigen::Vector3d::Ones()), q);
  EXPECT_LT((e - (moment / mass - target)).norm(), 1e-12);
}

/// Error of a contact of this kind when its frame is at `open` in the contact.
Eigen::VectorXd opened(const RobotCase& robot, const HeldKind& held,
                       const Eigen::Isometry3d& open) {
  Random random(74);
  Graph graph = graph_of(robot);
  add_frames(graph, robot, random);
  const Eigen::VectorXd q = random.configuration(robot.model(), 2.0, 0.0);
  graph.add_edge(contact_edge(graph, robot, kFrame, held,
                              frame_pose(graph, kFrame, robot, q) * open.inverse()),
                 add_configuration(graph, robot, 0, 0.0, q));
  Evaluated evaluated(graph);
  EXPECT_TRUE(evaluated.jacobian(0, 0, false).allFinite());
  return evaluated.error(0);
}
void expect_rows(const Eigen::VectorXd& e, std::initializer_list<double> expected) {
  ASSERT_EQ(e.size(), static_cast<Eigen::Index>(expected.size()));
  for (Eigen::Index r = 0; r < e.size(); ++r) {
    EXPECT_NEAR(e[r], expected.begin()[r], 1e-12) << "row " << r;
  }
}

TEST_P(ContactsAndTasks, ContactHoldsTheCoordinatesOfItsKind) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const Eigen::Translation3d off(0.1, -0.2, 0.3);
  const auto& [surface, free_yaw, point, rung] = kHeldKinds;
  expect_rows(opened(robot, surface, off * turn(-0.4, z)), {0.1, -0.2, 0.3, 0.0, 0.0, -0.4});
  expect_rows(opened(robot, surface, off * turn(0.5, Eigen::Vector3d(0.6, 0.0, 0.8))),
              {0.1, -0.2, 0.3, 0.3, 0.0, 0.4});
  // Its axes x and y are any in the surface.
  for (const auto& [tilt, about] : {std::pair(0.3, x), std::pair(-2.5, y)}) {
    const Eigen::VectorXd e = opened(robot, free_yaw, off * turn(tilt, about) * turn(2.9, z));
    ASSERT_EQ(e.size(), 5);
    EXPECT_NEAR(e.head<2>().norm(), std::hypot(0.1, 0.2), 1e-12);
    EXPECT_NEAR(e[2], 0.3, 1e-12);
    EXPECT_NEAR(e.tail<2>().norm(), std::abs(tilt), 1e-12);
    const double across = e.head<2>().dot(e.tail<2>()) / std::abs(tilt);
    EXPECT_NEAR(across, (about == x ? 0.1 : 0.2), 1e-12);
  }
  expect_rows(opened(robot, point, off * turn(3.1, x) * turn(-1.9, z)), {0.1, -0.2, 0.3});
  expect_rows(opened(robot, rung, off * turn(0.3, x) * turn(3.0, y)), {0.1, -0.2, 0.3, 0.3, 0.0});
  expect_rows(opened(robot, rung, off * turn(0.6, z) * turn(-3.1, y)), {0.1, -0.2, 0.3, 0.0, 0.6});
}

TEST_P(ContactsAndTasks, ContactIsClosedWhereItsFreeCoordinatesAreAnything) {
  Random random(75);
  for (const HeldKind& held : kHeldKinds) {
    for (int i = 0; i < 20; ++i) {
      const double angle = random.uniform(-3.1, 3.1);
      Eigen::Isometry3d open = Eigen::Isometry3d::Identity();
      if (held.free_yaw) open = turn(angle, Eigen::Vector3d::UnitZ());
      if (held.kind == ContactKind::kPoint) open = turn(angle, random.direction());
      if (held.kind == ContactKind::kGrasp) open = turn(angle, Eigen::Vector3d::UnitY());
      EXPECT_LT(opened(robot, held, open).norm(), 1e-12) << held.name;
    }
  }
}

TEST_P(ContactsAndTasks, ContactUpsideDownIsHalfATurnOpen) {
  for (const HeldKind& held : kHeldKinds) {
    if (held.kind == ContactKind::kPoint) continue;
    for (const double nearly : {0.0, 1e-12, 1e-8}) {
      const Eigen::VectorXd e =
          opened(robot, held, turn(EIGEN_PI - nearly, Eigen::Vector3d::UnitX()));
      EXPECT_NEAR(e.norm(), EIGEN_PI, 1e-7) << held.name;
    }
  }
}

/// A fixed base leaves some robots too few joints for all of it.
class ContactsAndTasksTogether : public ContactsAndTasks {};

TEST_P(ContactsAndTasksTogether, AreMetByAFewGaussNewtonSteps) {
  // Both limb ends stay where they are, the centre of mass moves, the base tilts.
  Random random(76);
  const Robot& model = robot.model();
  Graph graph = graph_of(robot);
  add_frames(graph, robot, random);
  graph.parameters().set(
      kFrame + 2, std::make_shared<const FrameParameter>(model, kRobot, model.links()[0].name));
  Eigen::VectorXd q = model.neutral_configuration();
  for (int i = 0; i < model.active_joint_count(); ++i) {
    const Joint& joint = model.active_joint(i);
    if (joint.type == JointType::kContinuous) continue;
    q[robot.base() + i] = 0.6 * joint.lower + 0.4 * joint.upper;
  }
  ConfigurationState state(robot.robot);
  state.update(q.data());
  const auto id = add_configuration(graph, robot, 0, 0.0, q);
  for (const int i : {0, 1}) {
    EdgeContact closed = contact_edge(graph, robot, kFrame + i, kHeldKinds[2 + i],
                                      frame_pose(graph, kFrame + i, robot, q));
    closed.weights.setConstant(1e4);
    graph.add_edge(closed, id);
  }
  graph.add_edge(EdgeCom(state.kinematics.center_of_mass() + Eigen::Vector3d(0.01, -0.01, 0.0),
                         Eigen::Vector3d(1e3, 1e3, 0.0)),
                 id);
  Eigen::Matrix<double, 6, 1> level;
  level << 0, 0, 0, 1e2, 1e2, 0;
  graph.add_edge(EdgeFramePose(kFrame + 2,
                               turn(0.03, Eigen::Vector3d(0.6, 0.8, 0.0)) *
                                   frame_pose(graph, kFrame + 2, robot, q),
                               level),
                 id);
  Loaded loaded(graph);
  const double before = loaded.workspace.evaluate(loaded.workspace.state()).chi2;
  EXPECT_GT(before, 1e-2);
  for (int i = 0; i < 20; ++i) {
    loaded.workspace.evaluate(loaded.workspace.state());
    loaded.workspace.linearise();
    Eigen::MatrixXd h = dense_hessian(loaded.workspace);
    h.diagonal().array() += 1e-3;
    Eigen::Map<Eigen::VectorXd>(loaded.workspace.step().data(), h.rows()) =
        -h.ldlt().solve(dense_gradient(loaded.workspace));
    loaded.workspace.apply_step();
    loaded.workspace.accept_trial();
  }
  EXPECT_LT(loaded.workspace.evaluate(loaded.workspace.state()).chi2, 1e-14 * before);
}

/// 20 configurations with every edge of contacts, tasks and accelerations, two of them held.
Graph contacts_and_tasks(const RobotCase& robot, bool kernels) {
  Random random(77);
  const Robot& model = robot.model();
  Graph graph = graph_of(robot);
  add_frames(graph, robot, random);
  std::vector<VertexId<VertexConfiguration>> ids;
  Eigen::VectorXd q = random.configuration(model, 1.0, 0.0);
  double time_s = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd step = random.vector(model.tangent_size(), 0.3);
    model.integrate(q.data(), step.data(), q.data());
    ids.push_back(add_configuration(graph, robot, i, time_s, q));
    time_s += random.uniform(0.1, 0.4);
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
    graph.add_edge(dress(contact_edge(graph, robot, kFrame + static_cast<int>(i % 2),
                                      kHeldKinds[i % 4], random_pose(random, 1.0))),
                   ids[i]);
    graph.add_edge(dress(EdgeFramePose(kFrame + i % 2, random_pose(random, 1.0),
                                       Eigen::Matrix<double, 6, 1>::Ones())),
                   ids[i]);
    graph.add_edge(dress(EdgeCom(random.vector(3, 1.0), Eigen::Vector3d::Ones())), ids[i]);
    if (i < 2) continue;
    graph.add_edge(dress(EdgeAccelerationLimits(model, 8.0, 6.0, 5.0, 1.0)), ids[i - 2], ids[i - 1],
                   ids[i]);
  }
  return graph;
}

TEST_P(ContactsAndTasks, InABatchAreTheSumOverTheirEdgesOneByOne) {
  for (const bool kernels : {false, true}) {
    Graph graph = contacts_and_tasks(robot, kernels);
    ASSERT_EQ(graph.edge_pools().size(), 4u);
    Loaded loaded(graph);
    EXPECT_GT(expect_batch_equals_one_by_one(loaded.workspace, 1e-12).gradient.norm(), 1.0);
  }
}

TEST_P(ContactsAndTasks, DoNotAllocate) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = contacts_and_tasks(robot, true);
  Loaded loaded(graph);
  const long before = allocation_count();
  const Cost cost = loaded.workspace.evaluate(loaded.workspace.state());
  loaded.workspace.linearise();
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(std::isfinite(cost.chi2));
}

INSTANTIATE_TEST_SUITE_P(Plugins, ContactsAndTasksTogether,
                         testing::Values("CentauroLowerBody", "CentauroAllJoints",
                                         "Go2FloatingBase", "ComanPlus"),
                         robot_case_name);
INSTANTIATE_TEST_SUITE_P(Plugins, ContactsAndTasks, testing::ValuesIn(all_cases_and_coman_plus()),
                         robot_case_name);

}  // namespace
}  // namespace locograph::test
