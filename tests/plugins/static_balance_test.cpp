// Static balance with contact wrenches: what statics.h says, and the four tests of each vertex and
// edge.
#include <locograph/robots/dynamics.h>
#include <locograph/robots/statics.h>

#include <cstring>

#include "common/allocation_counter.h"
#include "plugins/jacobian_comparison.h"
#include "plugins/static_balance_test_support.h"

namespace locograph::test::balance {
namespace {

/// A contact of each kind, with axes in the link and in the world, far out on different limbs.
std::vector<Contact> some_contacts(const RobotCase& robot, Random& random) {
  const std::vector<std::string> links =
      robot.name == "ComanPlus"
          ? std::vector<std::string>{"l_sole", "TCP_R", "l_ball_tip_d", "r_sole", "TCP_L"}
      : robot.name == "Gripper"
          ? std::vector<std::string>{"hand", "right", "thumb", "lower", "left"}
      : !robot.wheels.empty()
          ? std::vector<std::string>{"wheel_1", "wheel_2", "ankle2_3", "wheel_4", "wheel_3"}
          : std::vector<std::string>{"FL_foot", "FR_foot", "RL_calf", "RR_foot", "base"};
  std::vector<Contact> contacts(5);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Contact& contact = contacts[i];
    contact.effector.link = links[i];
    contact.effector.point = random.vector(3, 0.1);
    contact.effector.normal = random.vector(3, 2.0);
    contact.effector.forward = random.vector(3, 2.0);
    contact.effector.friction = 0.2 + 0.1 * static_cast<double>(i);
    contact.effector.max_force_N = 150.0;
    contact.effector.half_x_m = 0.08;
    contact.effector.half_y_m = 0.035;
    contact.normal = random.vector(3, 2.0);
    contact.forward = random.vector(3, 2.0);
  }
  contacts[1].effector.kind = ContactKind::kPoint;
  contacts[1].effector.radius_m = 0.03;
  contacts[2].effector.kind = ContactKind::kGrasp;
  contacts[2].effector.max_moment_Nm = 20.0;
  contacts[4].effector.kind = ContactKind::kPoint;
  if (!robot.wheels.empty()) {
    contacts[4].effector.kind = ContactKind::kWheel;
    contacts[4].effector.radius_m = 0.078;
    contacts[4].effector.point.setZero();
  }
  return contacts;
}

/// Of the fourth a pyramid inside the cone, of the last one around it.
std::vector<FrictionModel> some_cones() {
  return {{}, {}, {}, {FrictionCone::kInner, 8}, {FrictionCone::kOuter, 4}};
}

/// Random configurations with random wrenches: ids 2i and 2i + 1.
struct Standing {
  explicit Standing(const RobotCase& robot_, unsigned seed, int count) : robot(robot_) {
    Random random(seed);
    graph = graph_of(robot);
    const std::vector<int> numbers =
        add_contacts(graph, robot, some_contacts(robot, random), some_cones());
    for (int i = 0; i < count; ++i) {
      // At both limits of every joint, or anywhere between.
      Eigen::VectorXd configuration = random.configuration(robot.model(), 2.0, 0.0);
      for (int j = 0; i % 4 == 0 && j < robot.model().active_joint_count(); ++j) {
        const Joint& joint = robot.model().active_joint(j);
        if (joint.type == JointType::kContinuous) continue;
        configuration[robot.base() + j] = random.sign() < 0.0 ? joint.lower : joint.upper;
      }
      q.push_back(add_configuration(graph, robot, 2 * i, 0.0, configuration));
      Eigen::VectorXd components = random.vector(23, 30.0);
      for (const int force : {0, 1, 2, 6, 7, 8, 9, 10, 11, 14, 15, 16, 20, 21, 22}) {
        components[force] *= 10.0;
      }
      w.push_back(graph.add_vertex(2 * i + 1, wrenches_at(graph, numbers, components)));
    }
  }
  const ContactList& contacts() const { return *graph.vertex(w[0]).contacts; }

  RobotCase robot;
  Graph graph;
  std::vector<VertexId<VertexConfiguration>> q;
  std::vector<VertexId<VertexWrenches>> w;
};

/// What statics.h makes of the same wrenches: g(q) − Σ Jᵀw, all entries of the tangent.
Eigen::VectorXd torques_by_statics(const Standing& standing, std::size_t i) {
  const Robot& robot = standing.robot.model();
  RobotState state(robot);
  state.update(standing.graph.vertex(standing.q[i]).state.data());
  std::vector<PointWrench> wrenches;
  const double* component = standing.graph.vertex(standing.w[i]).state.data();
  for (const auto& contact : standing.contacts()) {
    Eigen::Matrix3d axes = contact->axes;
    if (!contact->axes_in_world) axes = state.world_from_link(contact->link).linear() * axes;
    Eigen::Matrix<double, 6, 1> full = Eigen::Matrix<double, 6, 1>::Zero();
    for (const int c : contact->cone->components()) full[c] = *component++;
    // A ball and a wheel are pressed where they touch, a radius below their centre.
    const Eigen::Isometry3d& pose = state.world_from_link(contact->link);
    const EndEffector& effector = contact->contact.effector;
    Eigen::Vector3d touching = pose * effector.point;
    touching -= effector.radius_m * contact->contact.normal.normalized();
    touching = pose.inverse() * touching;
    wrenches.push_back({contact->link, touching, axes * full.head<3>(), axes * full.tail<3>()});
  }
  Eigen::VectorXd torques(robot.tangent_size());
  static_torques(state, standard_gravity(), wrenches, torques);
  return torques;
}

class StaticBalance : public RobotCaseTest {};

/// Robots that can lose their balance.
class FloatingBalance : public StaticBalance {};

TEST_P(FloatingBalance, IsWhatStaticsSayOfTheBase) {
  Standing standing(robot, 1, 20);
  for (std::size_t i = 0; i < standing.q.size(); ++i) {
    standing.graph.add_edge(EdgeBalance(1.0, 1.0), standing.q[i], standing.w[i]);
  }
  Evaluated evaluated(standing.graph);
  for (int k = 0; k < 20; ++k) {
    const Eigen::VectorXd expected =
        -torques_by_statics(standing, static_cast<std::size_t>(k)).head<6>();
    EXPECT_LT((evaluated.error(k) - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST_P(FloatingBalance, HasTheJacobianOfNumericDifferences) {
  Standing standing(robot, 2, kStates);
  for (std::size_t i = 0; i < standing.q.size(); ++i) {
    standing.graph.add_edge(EdgeBalance(1.0, 1.0), standing.q[i], standing.w[i]);
  }
  Evaluated evaluated(standing.graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    for (const int slot : {0, 1}) compare(evaluated, k, slot, kEverywhere, compared);
  }
  EXPECT_EQ(compared.nonzero, 2 * 6 * kStates);
}

/// Configurations before and after each of a few that stand, and the edge between the three.
struct Moving {
  explicit Moving(const RobotCase& robot, unsigned seed, int count, double far)
      : standing(robot, seed, count) {
    Random random(seed + 100);
    const Robot& model = robot.model();
    for (int i = 0; i < count; ++i) {
      const auto near = [&](int id, double time_s) {
        Eigen::VectorXd moved(model.configuration_size());
        const Eigen::VectorXd by = random.vector(model.tangent_size(), far);
        model.integrate(standing.graph.vertex(standing.q[static_cast<std::size_t>(i)]).state.data(),
                        by.data(), moved.data());
        return add_configuration(standing.graph, robot, id, time_s, moved);
      };
      const std::size_t at = static_cast<std::size_t>(i);
      standing.graph.vertex(standing.q[at]).time_s = 1.0;
      EdgeMovingBalance edge(1.0, 1.0);
      edge.load = random.vector(6, 10.0);
      before.push_back(near(1000 + 2 * i, 0.7));
      after.push_back(near(1001 + 2 * i, 1.2));
      standing.graph.add_edge(edge, standing.q[at], standing.w[at], before[at], after[at]);
    }
  }

  Standing standing;
  std::vector<VertexId<VertexConfiguration>> before, after;
};

TEST_P(FloatingBalance, OfARobotThatMovesAsAWholeIsInverseDynamics) {
  Moving moving(robot, 11, 10, 0.0);
  Graph& graph = moving.standing.graph;
  const Robot& model = robot.model();
  RobotDynamics dynamics(model);
  RobotState state(model);
  Random random(12);
  for (int i = 0; i < 10; ++i) {
    const std::size_t at = static_cast<std::size_t>(i);
    const Eigen::Vector3d back = random.vector(3, 0.1), on = random.vector(3, 0.1);
    graph.vertex(moving.before[at]).state.head<3>() -= back;
    graph.vertex(moving.after[at]).state.head<3>() += on;
    const Eigen::VectorXd q = graph.vertex(moving.standing.q[at]).state;
    state.update(q.data());
    // The base's acceleration along its own axes, turning not at all.
    Eigen::VectorXd velocity = Eigen::VectorXd::Zero(model.tangent_size()), acceleration = velocity;
    acceleration.head<3>() = state.world_from_link(0).linear().transpose() *
                             (2.0 * (on / 0.2 - back / 0.3) / (0.2 + 0.3));
    Eigen::VectorXd torques(model.tangent_size()), at_rest = torques;
    dynamics.inverse_dynamics(state, velocity, acceleration, {}, torques);
    dynamics.inverse_dynamics(state, velocity, velocity, {}, at_rest);
    const Eigen::VectorXd expected = -torques_by_statics(moving.standing, at).head<6>() -
                                     (torques - at_rest).head<6>() -
                                     graph.edges_of<EdgeMovingBalance>()[at].load;
    EXPECT_LT((Evaluated(graph).error(i) - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST_P(FloatingBalance, OfAMovingRobotHasTheJacobianOfNumericDifferences) {
  Moving moving(robot, 13, kStates, 0.05);
  Evaluated evaluated(moving.standing.graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    for (const int slot : {0, 1, 2, 3}) compare(evaluated, k, slot, kEverywhere, compared);
  }
  EXPECT_EQ(compared.nonzero, 4 * 6 * kStates);
}

TEST_P(FloatingBalance, OfAMovingRobotKeepsEveryBitInAFile) {
  Moving moving(robot, 14, 3, 0.05);
  const TemporaryFolder folder;
  write_graph(moving.standing.graph, folder.path() / "moving.g2o");
  Graph again = read_graph(folder.path() / "moving.g2o", robot_types());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.edges_of<EdgeMovingBalance>()[i].load,
              moving.standing.graph.edges_of<EdgeMovingBalance>()[i].load);
    EXPECT_EQ(Evaluated(again).error(static_cast<int>(i)),
              Evaluated(moving.standing.graph).error(static_cast<int>(i)));
  }
}

TEST(MovingBalance, RefusesTimesThatDoNotIncrease) {
  Moving moving(robot_case("Gripper"), 15, 1, 0.05);
  moving.standing.graph.vertex(moving.after[0]).time_s = 1.0;
  EXPECT_THROW(Evaluated(moving.standing.graph).error(0), Error);
}

TEST(FixedBase, HasNoBalance) {
  Standing standing(robot_case("CentauroFixedBase"), 3, 1);
  standing.graph.add_edge(EdgeBalance(1.0, 1.0), standing.q[0], standing.w[0]);
  Evaluated evaluated(standing.graph);
  EXPECT_THROW(evaluated.error(0), Error);
}

TEST_P(StaticBalance, HasTorqueLimitsThatAgreeWithStaticsAndWithNumericDifferences) {
  const Robot& model = robot.model();
  const int n = model.active_joint_count();
  for (const double fraction : {1.0, 1e-6}) {
    Standing standing(robot, 4, kStates);
    for (std::size_t i = 0; i < standing.q.size(); ++i) {
      standing.graph.add_edge(EdgeTorqueLimits(model, fraction, 1.0), standing.q[i], standing.w[i]);
    }
    Evaluated evaluated(standing.graph);
    Compared compared;
    for (int k = 0; k < kStates; ++k) {
      const Eigen::VectorXd torques =
          torques_by_statics(standing, static_cast<std::size_t>(k)).tail(n);
      const Eigen::VectorXd e = evaluated.error(k);
      for (int r = 0; r < n; ++r) {
        const double beyond = std::abs(torques[r]) - fraction * model.active_joint(r).max_effort;
        EXPECT_NEAR(e[r], std::max(0.0, beyond), 1e-10);
      }
      const auto smooth = [&](int r) {
        const double limit = fraction * model.active_joint(r).max_effort;
        return std::isinf(limit) || std::abs(std::abs(torques[r]) - limit) > 0.1;
      };
      for (const int slot : {0, 1}) compare(evaluated, k, slot, smooth, compared);
    }
    EXPECT_GT(compared.nonzero, fraction < 1.0 ? kStates * n / 2 : kStates);
    if (fraction == 1.0) {
      EXPECT_GT(compared.zero, kStates);
    }
  }
}

TEST_P(StaticBalance, HasContactLimitsWithTheJacobianOfNumericDifferences) {
  Standing standing(robot, 5, kStates);
  for (std::size_t i = 0; i < standing.w.size(); ++i) {
    standing.graph.add_edge(EdgeContactWrench(standing.contacts(), 1.0), standing.w[i]);
    standing.graph.add_edge(EdgeWrenchNorm(standing.graph.vertex(standing.w[i]), 1.0),
                            standing.w[i]);
    EdgeWrenchTracking tracking(standing.graph.vertex(standing.w[i]), 1.0);
    tracking.reference *= 0.75;
    standing.graph.add_edge(tracking, standing.w[i]);
  }
  Evaluated evaluated(standing.graph);
  Compared limits, norm;
  for (int k = 0; k < kStates; ++k) {
    compare(evaluated, k, 0, kEverywhere, limits);
    EXPECT_TRUE(evaluated.jacobian(k, 0, false, 1).isIdentity(0.0));
    EXPECT_EQ(evaluated.error(k, 1), standing.graph.vertex(standing.w[k]).state);
    EXPECT_TRUE(evaluated.jacobian(k, 0, false, 2).isIdentity(0.0));
    EXPECT_TRUE(evaluated.error(k, 2).isApprox(0.25 * evaluated.error(k, 1), 1e-14));
  }
  EXPECT_GT(limits.nonzero, 9 * kStates);
  EXPECT_GT(limits.zero, 9 * kStates);
}

TEST_P(StaticBalance, IsInABatchWhatItIsEdgeByEdge) {
  Standing standing(robot, 6, 12);
  Random random(7);
  Graph& graph = standing.graph;
  graph.set_fixed(standing.q[3], true);
  graph.set_fixed(standing.w[5], true);
  const auto dress = [&](auto edge) {
    edge.weights = random.weights(edge.weights.size());
    return edge;
  };
  for (std::size_t i = 0; i < standing.w.size(); ++i) {
    const auto q = standing.q[i];
    const auto w = standing.w[i];
    if (robot.model().floating_base()) graph.add_edge(dress(EdgeBalance(1.0, 1.0)), q, w);
    graph.add_edge(dress(EdgeTorqueLimits(robot.model(), 0.01, 1.0)), q, w);
    graph.add_edge(dress(EdgeContactWrench(standing.contacts(), 1.0)), w);
    graph.add_edge(dress(EdgeWrenchNorm(graph.vertex(w), 1.0)), w);
    graph.add_edge(dress(EdgeWrenchTracking(graph.vertex(w), 1.0)), w);
  }
  Loaded loaded(graph);
  const long before = allocation_count();
  loaded.workspace.evaluate(loaded.workspace.state());
  loaded.workspace.linearise();
  const long allocations = allocation_count() - before;
  if (allocations_are_counted()) {
    EXPECT_EQ(allocations, 0);
  }
  expect_batch_equals_one_by_one(loaded.workspace, 1e-12);
}

TEST_P(StaticBalance, KeepsEveryBitInAFile) {
  Standing standing(robot, 8, 4);
  Random random(9);
  Graph& graph = standing.graph;
  for (std::size_t i = 0; i < standing.w.size(); ++i) {
    if (robot.model().floating_base()) {
      graph.add_edge(EdgeBalance(1.0 / 3.0, 2.0 / 3.0), standing.q[i], standing.w[i]);
    }
    graph.add_edge(EdgeTorqueLimits(robot.model(), 0.7 / 3.0, 0.1), standing.q[i], standing.w[i]);
    EdgeContactWrench limits(standing.contacts(), 1.0);
    limits.weights = random.weights(limits.weights.size());
    graph.add_edge(limits, standing.w[i]);
    graph.add_edge(EdgeWrenchNorm(graph.vertex(standing.w[i]), 1e-17), standing.w[i]);
    graph.add_edge(EdgeWrenchTracking(graph.vertex(standing.w[i]), 0.1), standing.w[i]);
  }
  const TemporaryFolder folder;
  write_graph(graph, folder.path() / "balance.g2o");
  Graph again = read_graph(folder.path() / "balance.g2o", robot_types());
  EXPECT_EQ(write_graph_text(graph, folder.path()), write_graph_text(again, folder.path()));
  ASSERT_EQ(again.vertices_of<VertexWrenches>().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexWrenches &one = graph.vertices_of<VertexWrenches>()[i],
                         &other = again.vertices_of<VertexWrenches>()[i];
    EXPECT_EQ(one.contact_numbers, other.contact_numbers);
    ASSERT_EQ(one.state.size(), other.state.size());
    EXPECT_EQ(std::memcmp(one.state.data(), other.state.data(),
                          8 * static_cast<std::size_t>(one.state.size())),
              0);
    EXPECT_EQ(graph.edges_of<EdgeContactWrench>()[i].weights,
              again.edges_of<EdgeContactWrench>()[i].weights);
    EXPECT_EQ(graph.edges_of<EdgeTorqueLimits>()[i].fraction,
              again.edges_of<EdgeTorqueLimits>()[i].fraction);
  }
  Evaluated a(graph), b(again);
  for (std::size_t p = 0; p < graph.edge_pools().size(); ++p) {
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(a.error(k, static_cast<int>(p)), b.error(k, static_cast<int>(p)))
          << graph.edge_pools()[p]->tag();
  }
}

INSTANTIATE_TEST_SUITE_P(Plugins, StaticBalance,
                         testing::Values("CentauroAllJoints", "CentauroFixedBase", "ComanPlus",
                                         "Go2FloatingBase", "Gripper"),
                         robot_case_name);
INSTANTIATE_TEST_SUITE_P(Plugins, FloatingBalance,
                         testing::Values("CentauroAllJoints", "ComanPlus", "Go2FloatingBase",
                                         "Gripper"),
                         robot_case_name);

}  // namespace
}  // namespace locograph::test::balance
