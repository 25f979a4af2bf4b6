#include <cstring>

#include "core/cost_of.h"
#include "plugins/bad_line.h"
#include "plugins/legged_cases.h"
#include "plugins/small_robot.h"

namespace locograph::test {
namespace {

class ContactsAndTasksInAFile : public RobotCaseTest {
 protected:
  template <class E, class... Ids>
  static void add(Graph& graph, Random& random, int i, E edge, Ids... ids) {
    if (i % 2 == 0) {
      edge.weights.setConstant(random.uniform(0.0, 1e6));
    } else {
      edge.weights = random.weights(edge.weights.size());
    }
    graph.add_edge(std::move(edge), ids...);
  }
  /// Every kind, with numbers that need all their digits; weights `scalar` and `diagonal`.
  Graph everything() const {
    Random random(81);
    const Robot& model = robot.model();
    Graph graph = graph_of(robot);
    add_frames(graph, robot, random);
    std::vector<VertexId<VertexConfiguration>> ids;
    for (int i = 0; i < 10; ++i) {
      ids.push_back(add_configuration(graph, robot, i, 0.1 * i + 1.0 / 3.0,
                                      random.configuration(model, 100.0, 0.0)));
    }
    for (int i = 0; i < 10; ++i) {
      const auto id = ids[i];
      add(graph, random, i,
          contact_edge(graph, robot, kFrame + i % 2, kHeldKinds[i % 4], random_pose(random, 9.0)),
          id);
      add(graph, random, i,
          EdgeFramePose(kFrame + i % 2, random_pose(random, 9.0),
                        Eigen::Matrix<double, 6, 1>::Ones()),
          id);
      add(graph, random, i, EdgeCom(random.vector(3, 1.0), Eigen::Vector3d::Ones()), id);
      if (i < 2) continue;
      const Eigen::VectorXd limits = random.weights(model.active_joint_count() + 2);
      add(graph, random, i, EdgeAccelerationLimits(limits, 1.0), ids[i - 2], ids[i - 1], id);
    }
    return graph;
  }
  template <class E, class Bits>
  static void expect_same_bits(const Graph& a, const Graph& b, Bits bits) {
    ASSERT_GT(a.edges_of<E>().size(), 0u);
    ASSERT_EQ(a.edges_of<E>().size(), b.edges_of<E>().size());
    for (std::size_t i = 0; i < a.edges_of<E>().size(); ++i) {
      const E &one = a.edges_of<E>()[i], &other = b.edges_of<E>()[i];
      EXPECT_TRUE(one.vertices == other.vertices);
      const Eigen::VectorXd x = bits(one), y = bits(other);
      ASSERT_EQ(x.size(), y.size());
      EXPECT_EQ(std::memcmp(x.data(), y.data(), sizeof(double) * x.size()), 0) << E::kTag << i;
      ASSERT_EQ(one.weights.size(), other.weights.size());
      EXPECT_EQ(std::memcmp(one.weights.data(), other.weights.data(),
                            sizeof(double) * one.weights.size()),
                0);
    }
  }
  static Eigen::VectorXd numbers(const SavedPose& pose) {
    Eigen::VectorXd all(7);
    all << pose.position, pose.rotation.coeffs();
    return all;
  }
};

TEST_P(ContactsAndTasksInAFile, KeepEveryBit) {
  const TemporaryFolder folder;
  Graph graph = everything();
  write_graph(graph, folder.file("plan.g2o"));
  Graph again = read_graph(folder.file("plan.g2o"), robot_types());
  EXPECT_EQ(write_graph_text(graph, folder.path()), write_graph_text(again, folder.path()));
  expect_same_bits<EdgeContact>(graph, again, [](const EdgeContact& e) {
    const Contact& contact = e.contact->contact;
    Eigen::VectorXd all(18);
    all << contact.effector.point, contact.effector.normal, contact.effector.forward,
        contact.position, contact.normal, contact.forward.value_or(Eigen::Vector3d::Zero());
    return all;
  });
  expect_same_bits<EdgeFramePose>(graph, again,
                                  [](const EdgeFramePose& e) { return numbers(e.target); });
  expect_same_bits<EdgeCom>(graph, again,
                            [](const EdgeCom& e) { return Eigen::VectorXd(e.target); });
  expect_same_bits<EdgeAccelerationLimits>(
      graph, again, [](const EdgeAccelerationLimits& e) { return e.limits; });
  for (std::size_t i = 0; i < graph.edges_of<EdgeContact>().size(); ++i) {
    EXPECT_EQ(graph.edges_of<EdgeContact>()[i].contact->kind(),
              again.edges_of<EdgeContact>()[i].contact->kind());
    EXPECT_EQ(graph.edges_of<EdgeContact>()[i].contact_number,
              again.edges_of<EdgeContact>()[i].contact_number);
  }
  for (const int number : {kFrame, kFrame + 1}) {
    const auto one = graph.parameters().get<FrameParameter>(number);
    const auto other = again.parameters().get<FrameParameter>(number);
    EXPECT_EQ(one->link, other->link);
    EXPECT_TRUE(numbers(one->link_from_frame) == numbers(other->link_from_frame));
  }
  EXPECT_EQ(cost_of(graph).chi2, cost_of(again).chi2);
  EXPECT_GT(cost_of(graph).chi2, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Plugins, ContactsAndTasksInAFile,
                         testing::ValuesIn(all_cases_and_coman_plus()), robot_case_name);

// Carts without a mass: three configurations of one, one of another.
constexpr const char* kCartsAndFrames =
    "PARAMS_ROBOT 0 cart.urdf - floating 0\n"
    "PARAMS_WORLD 2 - -\n"
    "PARAMS_PLAN 5 2\n"
    "PARAMS_FRAME 3 0 arm 0 0 0.1 0 0 0 1\n"
    "PARAMS_CONTACT 6 0 hand arm point 0 0.5 9 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free\n"
    "PARAMS_CONTACT 7 0 sole arm surface 0.1 0.1 0.5 9 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0\n"
    "PARAMS_CONTACT 8 0 turning arm surface 0.1 0.1 0.5 9 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free\n"
    "VERTEX_CONFIGURATION 0 0 0 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_CONFIGURATION 1 0 1 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_CONFIGURATION 2 0 3 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "PARAMS_ROBOT 4 cart.urdf - floating 1 arm_joint\n"
    "VERTEX_CONFIGURATION 3 4 0 - 0 0 0 0 0 0 1 0.1\n";

const BadLine kBadContactsAndTasks[] = {
    // PARAMS_FRAME
    {"FrameOfAnUnknownRobot", "PARAMS_FRAME 9 55 arm 0 0 0 0 0 0 1", "unknown parameter 55"},
    {"FrameOfAWorld", "PARAMS_FRAME 9 2 arm 0 0 0 0 0 0 1", "parameter 2 is a PARAMS_WORLD"},
    {"FrameOnALinkThatIsNotThere", "PARAMS_FRAME 9 0 amr 0 0 0 0 0 0 1", "amr"},
    {"FrameWithoutLink", "PARAMS_FRAME 9 0", "too few fields"},
    {"FrameWithoutRotation", "PARAMS_FRAME 9 0 arm 0 0 0", "too few fields"},
    {"FrameWithAZeroQuaternion", "PARAMS_FRAME 9 0 arm 0 0 0 0 0 0 0", "quaternion of length zero"},
    {"FrameWithANaN", "PARAMS_FRAME 9 0 arm 0 nan 0 0 0 0 1", "'nan' is not finite"},
    {"FrameWithTooManyFields", "PARAMS_FRAME 9 0 arm 0 0 0 0 0 0 1 7", "too many fields"},
    {"FrameWithATakenNumber", "PARAMS_FRAME 3 0 arm 0 0 0 0 0 0 1", "parameter 3 is given twice"},
    // EDGE_CONTACT
    {"ContactThatIsUnknown", "EDGE_CONTACT 0 3 88 scalar 1", "unknown parameter 88"},
    {"ContactOfARobot", "EDGE_CONTACT 0 3 0 scalar 1", "parameter 0 is a PARAMS_ROBOT"},
    {"ContactOfAFrame", "EDGE_CONTACT 0 3 3 scalar 1", "parameter 3 is a PARAMS_FRAME"},
    {"ContactOfAnOlderPlan", "EDGE_CONTACT 0 3 3 point 0 0 0 0 0 0 1 scalar 1",
     "weights begin with 'point'"},
    {"ContactOfASurfaceWithTheRowsOfAPoint", "EDGE_CONTACT 0 3 7 scalar 1",
     "EDGE_CONTACT with n = 3, expected n = 6"},
    {"ContactOfASurfaceWithFreeYawAndItsRow", "EDGE_CONTACT 0 6 8 scalar 1",
     "EDGE_CONTACT with n = 6, expected n = 5"},
    {"ContactOfAPointWithSixRows", "EDGE_CONTACT 0 6 6 scalar 1",
     "EDGE_CONTACT with n = 6, expected n = 3"},
    {"ContactWithANegativeWeight", "EDGE_CONTACT 0 3 6 diagonal 1 -1 1", "a negative weight"},
    {"ContactOfAnUnknownVertex", "EDGE_CONTACT 88 3 6 scalar 1", "unknown vertex 88"},
    // EDGE_FRAME_POSE
    {"FramePoseOfAnUnknownFrame", "EDGE_FRAME_POSE 0 88 0 0 0 0 0 0 1 scalar 1",
     "unknown parameter 88"},
    {"FramePoseOfAWorld", "EDGE_FRAME_POSE 0 2 0 0 0 0 0 0 1 scalar 1",
     "parameter 2 is a PARAMS_WORLD"},
    {"FramePoseWithAZeroQuaternion", "EDGE_FRAME_POSE 0 3 0 0 0 0 0 0 0 scalar 1",
     "quaternion of length zero"},
    {"FramePoseWithANaN", "EDGE_FRAME_POSE 0 3 nan 0 0 0 0 0 1 scalar 1", "'nan' is not finite"},
    {"FramePoseWithTooFewWeights", "EDGE_FRAME_POSE 0 3 0 0 0 0 0 0 1 diagonal 1 1 1",
     "too few fields"},
    {"FramePoseWithANegativeWeight", "EDGE_FRAME_POSE 0 3 0 0 0 0 0 0 1 scalar -1",
     "a negative weight"},
    // EDGE_COM
    {"ComOfARobotWithoutAMass", "EDGE_COM 0 0 0 0 scalar 1", "EDGE_COM for a robot without a mass"},
    {"ComWithANaN", "EDGE_COM 0 0 nan 0 scalar 1", "'nan' is not finite"},
    {"ComWithTooFewWeights", "EDGE_COM 0 0 0 0 diagonal 1 1", "too few fields"},
    {"ComWithANegativeWeight", "EDGE_COM 0 0 0 0 diagonal 1 1 -1", "a negative weight"},
    // EDGE_ACCELERATION_LIMITS
    {"AccelerationLimitsWithoutTheRowsOfTheBase",
     "EDGE_ACCELERATION_LIMITS 0 1 2 4 1 1 1 1 scalar 1",
     "EDGE_ACCELERATION_LIMITS with n = 4, expected n = 5 or 3"},
    {"AccelerationLimitsWithANegativeLimit", "EDGE_ACCELERATION_LIMITS 0 1 2 5 1 1 -1 1 1 scalar 1",
     "a limit of acceleration of -1"},
    {"AccelerationLimitsWithATruncatedLimit", "EDGE_ACCELERATION_LIMITS 0 1 2 5 1 1 1 1 scalar 1",
     "'scalar' is not a number"},
    {"AccelerationLimitsWithANaN", "EDGE_ACCELERATION_LIMITS 0 1 2 5 1 1 1 1 nan scalar 1",
     "'nan' is not finite"},
    {"AccelerationLimitsThatReturnToTheirVertex",
     "EDGE_ACCELERATION_LIMITS 0 1 0 5 1 1 1 1 1 scalar 1", "names vertex 0 twice"},
    {"AccelerationLimitsOnTwoVertices", "EDGE_ACCELERATION_LIMITS 0 1", "too few fields"},
};

class BadContactsAndTasks : public testing::TestWithParam<BadLine> {};

TEST_P(BadContactsAndTasks, AreAnErrorWithFileAndLine) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  expect_bad_line(folder, kCartsAndFrames, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Plugins, BadContactsAndTasks, testing::ValuesIn(kBadContactsAndTasks),
                         bad_line_name);

TEST(ContactsOfTwoRobots, AreNotMixedUp) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  const struct {
    const char *edge, *message;
  } cases[] = {
      {"EDGE_CONTACT 3 3 6 scalar 1", "configurations of different robots"},
      {"EDGE_FRAME_POSE 3 3 0 0 0 0 0 0 1 scalar 1", "configurations of different robots"},
      {"EDGE_ACCELERATION_LIMITS 0 1 3 5 1 1 1 1 1 scalar 1", "configurations of different robots"},
      {"EDGE_ACCELERATION_LIMITS 0 1 2 3 1 1 1 scalar 1", "EDGE_ACCELERATION_LIMITS with n = 3"},
      {"EDGE_ACCELERATION_LIMITS 2 1 0 5 1 1 1 1 1 scalar 1", "times that increase"}};
  const int line = 1 + static_cast<int>(std::ranges::count(std::string(kCartsAndFrames), '\n'));
  for (const auto& bad : cases) {
    Graph graph = read_graph(
        folder.write("plan.g2o", std::string(kCartsAndFrames) + bad.edge + "\n"), robot_types());
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    workspace.load_state();
    try {
      workspace.evaluate(workspace.state());
      FAIL() << "was evaluated: " << bad.edge;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos) << error.what();
      EXPECT_EQ(error.line(), line) << error.what();
    }
  }
}

TEST(ContactAxes, HaveTheNormalAsZAndForwardAsXInTheSurface) {
  Random random(82);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d normal = random.uniform(1e-8, 10.0) * random.direction();
    const Eigen::Vector3d forward = random.direction();
    const Eigen::Matrix3d axes = contact_axes("a contact", normal, forward);
    EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
    EXPECT_LT((axes.col(2) - normal.normalized()).norm(), 1e-12);
    EXPECT_GT(axes.col(0).dot(forward), 0.0);
    EXPECT_NEAR(axes.col(1).dot(forward), 0.0, 1e-12);
  }
}

TEST(ContactAxes, AreRefusedWithoutDirections) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(),
                        z = Eigen::Vector3d::UnitZ(), nan = Eigen::Vector3d::Constant(std::nan(""));
  const auto axes = [](const Eigen::Vector3d& normal, const Eigen::Vector3d& forward) {
    return contact_axes("a contact", normal, forward);
  };
  EXPECT_THROW(axes(zero, x), Error) << "a surface with zero normal";
  EXPECT_THROW(axes(z, zero), Error);
  EXPECT_THROW(axes(z, -2.0 * z), Error) << "forward along the normal";
  EXPECT_THROW(axes(nan, x), Error);
  EXPECT_THROW(axes(z, nan), Error);
  EXPECT_THROW(axes(z * HUGE_VAL, x), Error);
  EXPECT_NO_THROW(axes(1e-200 * z, 1e200 * x));
}

TEST(EdgesOfContactsAndTasks, AreRefusedWhenAddedWithWhatMakesNoSense) {
  const RobotCase robot = centauro_lower_body();
  const Robot& model = robot.model();
  Graph graph = graph_of(robot);
  Random random(83);
  add_frames(graph, robot, random);
  const auto a = add_configuration(graph, robot, 0, 0.0, home(robot));
  const auto b = add_configuration(graph, robot, 1, 1.0, home(robot));
  const auto c = add_configuration(graph, robot, 2, 2.0, home(robot));
  const double nan = std::nan("");
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.linear()(0, 1) = 0.1;
  Eigen::Isometry3d mirrored = Eigen::Isometry3d::Identity();
  mirrored.linear()(2, 2) = -1.0;
  Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity();
  nowhere.translation()[1] = nan;
  Eigen::Isometry3d unturned = Eigen::Isometry3d::Identity();
  unturned.linear().setConstant(nan);
  for (const Eigen::Isometry3d& pose : {bent, mirrored, nowhere, unturned}) {
    EXPECT_THROW(EdgeFramePose(kFrame, pose, Eigen::Matrix<double, 6, 1>::Ones()), Error);
    EXPECT_THROW(FrameParameter(model, kRobot, "pelvis", pose), Error);
  }
  EXPECT_THROW(FrameParameter(model, kRobot, "left_foot"), Error);
  EdgeContact wrong =
      contact_edge(graph, robot, kFrame, kHeldKinds[2], Eigen::Isometry3d::Identity());
  wrong.weights.setOnes(6);
  EXPECT_THROW(graph.add_edge(wrong, a), Error);
  EXPECT_THROW(graph.add_edge(EdgeCom(Eigen::Vector3d(0.0, nan, 0.0), Eigen::Vector3d::Ones()), a),
               Error);
  EXPECT_THROW(graph.add_edge(EdgeAccelerationLimits(model, nan, 1.0, 1.0, 1.0), a, b, c), Error);
  EXPECT_THROW(graph.add_edge(EdgeAccelerationLimits(Eigen::VectorXd::Ones(24), 1.0), a, b, c),
               Error);
  EdgeAccelerationLimits torn(model, 1.0, 1.0, 1.0, 1.0);
  torn.limits.setOnes(3);
  EXPECT_THROW(graph.add_edge(torn, a, b, c), Error);
  EXPECT_EQ(graph.edge_count(), 0);
}

}  // namespace
}  // namespace locograph::test
