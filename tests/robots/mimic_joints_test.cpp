// Mimic joints: poses, Jacobians, torques and mass matrix against KDL, which knows none: there
// every joint moves on its own, and what ours should be follows from how its joints follow each
// other.
#include <locograph/robots/dynamics.h>

#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <kdl/treejnttojacsolver.hpp>
#include <map>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

constexpr double kMimicTolerance = 1e-12;  // of the largest entry

// KDL's matrices are aligned as its own compilation saw fit, which is less than ours: number by
// number.
Eigen::VectorXd numbers_of(const KDL::JntArray& array) {
  Eigen::VectorXd numbers(array.rows());
  for (unsigned i = 0; i < array.rows(); ++i) numbers[i] = array(i);
  return numbers;
}

Eigen::MatrixXd numbers_of(const KDL::Jacobian& jacobian) {
  Eigen::MatrixXd numbers(jacobian.rows(), jacobian.columns());
  for (unsigned c = 0; c < jacobian.columns(); ++c) {
    for (unsigned r = 0; r < jacobian.rows(); ++r) numbers(r, c) = jacobian(r, c);
  }
  return numbers;
}

void give_numbers(const Eigen::VectorXd& numbers, KDL::JntArray& array) {
  for (unsigned i = 0; i < array.rows(); ++i) array(i) = numbers[i];
}

/// mimic_robot_urdf(), written out joint by joint.
class HandWrittenGripper {
 public:
  HandWrittenGripper() : tree("base") {
    using KDL::Frame, KDL::Joint, KDL::Rotation, KDL::Vector;
    add("base", "upper", "shoulder", Frame(Rotation::RPY(0.1, 0.2, 0.3), Vector(0.1, 0, 0.2)),
        Vector(0, 1, 0), Joint::RotAxis, body(2, {0, 0.02, 0.15}, {0.2, 0.3, 0.2}));
    add("upper", "lower", "elbow", Frame(Rotation::RPY(0, -0.4, 0), Vector(0, 0, 0.3)),
        Vector(0, 0.6, 0.8), Joint::RotAxis, body(1.5, {0.12, 0, 0}, {0.1, 0.15, 0.12}));
    add("lower", "hand", "wrist", Frame(Rotation::RPY(0.5, 0, 0), Vector(0.25, 0, 0)),
        Vector(1, 0, 0), Joint::RotAxis, body(0.8, {0.05, 0.01, 0}, {0.02, 0.03, 0.02}));
    add("hand", "right", "slide_right", Frame(Vector(0.1, -0.02, 0)), Vector(0, 1, 0),
        Joint::TransAxis, body(0.2, {0.02, 0, 0}, {0.001, 0.001, 0.001}));
    add("hand", "left", "slide_left", Frame(Vector(0.1, 0.02, 0)), Vector(0, 1, 0),
        Joint::TransAxis, body(0.2, {0.02, 0, 0.01}, {0.001, 0.001, 0.001}));
    add("left", "thumb", "thumb_turn", Frame(Rotation::RPY(0, 0, 0.2), Vector(0.04, 0, 0)),
        Vector(0, 0, 1), Joint::RotAxis, body(0.1, {0.03, 0, 0}, {0.0005, 0.0006, 0.0007}));
  }

  /// Where the six joints stand when shoulder and slide_left stand at q.
  KDL::JntArray positions(const Eigen::Vector2d& q) const {
    const std::map<std::string, double> of_joint = {{"shoulder", q[0]},
                                                    {"elbow", 2.0 * q[0] + 0.1},
                                                    {"wrist", -0.5 * (2.0 * q[0] + 0.1) + 0.2},
                                                    {"slide_right", -q[1]},
                                                    {"slide_left", q[1]},
                                                    {"thumb_turn", 30.0 * q[1] - 0.5}};
    return in_kdl_order(of_joint);
  }

  /// How fast the six joints move for speeds of shoulder and slide_left: 6 x 2.
  Eigen::MatrixXd rates() const {
    Eigen::MatrixXd result(6, 2);
    result.col(0) = numbers_of(in_kdl_order({{"shoulder", 1.0}, {"elbow", 2.0}, {"wrist", -1.0}}));
    result.col(1) = numbers_of(
        in_kdl_order({{"slide_left", 1.0}, {"slide_right", -1.0}, {"thumb_turn", 30.0}}));
    return result;
  }

  KDL::Tree tree;

 private:
  static KDL::RigidBodyInertia body(double mass, const KDL::Vector& com,
                                    const KDL::Vector& inertia) {
    return KDL::Frame(com) *
           KDL::RigidBodyInertia(mass, KDL::Vector::Zero(),
                                 KDL::RotationalInertia(inertia.x(), inertia.y(), inertia.z()));
  }

  void add(const std::string& parent, const std::string& child, const std::string& joint,
           const KDL::Frame& origin, const KDL::Vector& axis, KDL::Joint::JointType type,
           const KDL::RigidBodyInertia& inertia) {
    tree.addSegment(
        KDL::Segment(child, KDL::Joint(joint, origin.p, origin.M * axis, type), origin, inertia),
        parent);
  }

  KDL::JntArray in_kdl_order(const std::map<std::string, double>& of_joint) const {
    KDL::JntArray result(tree.getNrOfJoints());
    for (const auto& [name, element] : tree.getSegments()) {
      const auto found = of_joint.find(element.segment.getJoint().getName());
      if (found != of_joint.end()) result(element.q_nr) = found->second;
    }
    return result;
  }
};

class MimicJoints : public testing::Test {
 protected:
  void SetUp() override {
    robot = std::make_unique<Robot>(
        Robot::load(folder.write("mimic.urdf", mimic_robot_urdf()), {}, {.floating_base = false}));
    state = std::make_unique<RobotState>(*robot);
    ASSERT_EQ(robot->active_joint_count(), 2);
  }

  /// A random configuration of ours, in which both robots stand afterwards.
  Eigen::Vector2d place() {
    const Eigen::Vector2d q = random_configuration(*robot, random);
    state->update(q.data());
    return q;
  }

  /// The six torques of KDL as two of ours: power is the same.
  Eigen::VectorXd torques(const Eigen::Vector2d& q, const Eigen::Vector2d& velocity,
                          const Eigen::Vector2d& acceleration, const Eigen::Vector3d& gravity) {
    KDL::TreeIdSolver_RNE solver(kdl.tree, KDL::Vector(gravity.x(), gravity.y(), gravity.z()));
    KDL::JntArray speeds(6), changes(6), result(6);
    give_numbers(kdl.rates() * velocity, speeds);
    give_numbers(kdl.rates() * acceleration, changes);
    if (solver.CartToJnt(kdl.positions(q), speeds, changes, {}, result) < 0) {
      ADD_FAILURE() << "KDL refuses";
    }
    return kdl.rates().transpose() * numbers_of(result);
  }

  void compare(const Eigen::MatrixXd& ours, const Eigen::MatrixXd& expected) {
    EXPECT_LT((ours - expected).cwiseAbs().maxCoeff(),
              kMimicTolerance * expected.cwiseAbs().maxCoeff());
  }

  TemporaryFolder folder;
  std::mt19937 random{50};
  HandWrittenGripper kdl;
  std::unique_ptr<Robot> robot;
  std::unique_ptr<RobotState> state;
  const Eigen::Vector3d gravity = Eigen::Vector3d(1.3, -2.1, -9.4);
};

TEST_F(MimicJoints, PutTheLinksWhereKdlDoes) {
  KDL::TreeFkSolverPos_recursive solver(kdl.tree);
  for (int sample = 0; sample < 10; ++sample) {
    const KDL::JntArray positions = kdl.positions(place());
    for (const Link& link : robot->links()) {
      KDL::Frame frame;
      ASSERT_GE(solver.JntToCart(positions, frame, link.name), 0);
      const Eigen::Isometry3d& pose = state->world_from_link(robot->link_index(link.name));
      for (int r = 0; r < 3; ++r) {
        EXPECT_NEAR(pose.translation()[r], frame.p[r], 1e-13);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pose.linear()(r, c), frame.M(r, c), 1e-13);
      }
    }
  }
}

TEST_F(MimicJoints, MoveTheLinksAsInKdl) {
  KDL::TreeJntToJacSolver solver(kdl.tree);
  Eigen::Matrix<double, 6, Eigen::Dynamic> ours(6, 2);
  for (int sample = 0; sample < 10; ++sample) {
    const KDL::JntArray positions = kdl.positions(place());
    for (const Link& link : robot->links()) {
      if (link.name == "base") continue;
      KDL::Jacobian theirs(6);
      ASSERT_GE(solver.JntToJac(positions, theirs, link.name), 0);
      state->frame_jacobian(robot->link_index(link.name), Eigen::Isometry3d::Identity(), ours);
      compare(ours, numbers_of(theirs) * kdl.rates());
    }
  }
}

TEST_F(MimicJoints, AddTheirGravityTorquesToTheLeader) {
  Eigen::VectorXd ours(2);
  for (int sample = 0; sample < 10; ++sample) {
    const Eigen::Vector2d q = place(), zero = Eigen::Vector2d::Zero();
    gravity_torques(*state, gravity, ours);
    compare(ours, torques(q, zero, zero, gravity));
  }
}

TEST_F(MimicJoints, AddTheirInertiaToTheLeader) {
  RobotDynamics dynamics(*robot, gravity);
  Eigen::MatrixXd ours(2, 2), expected(2, 2);
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  for (int sample = 0; sample < 10; ++sample) {
    const Eigen::Vector2d q = place();
    dynamics.mass_matrix(*state, ours);
    for (int k = 0; k < 2; ++k) {
      expected.col(k) = torques(q, zero, Eigen::Vector2d::Unit(k), Eigen::Vector3d::Zero());
    }
    compare(ours, expected);
  }
}

TEST_F(MimicJoints, AreMovedByTheTorquesOfKdl) {
  RobotDynamics dynamics(*robot, gravity);
  Eigen::VectorXd ours(2);
  for (int sample = 0; sample < 10; ++sample) {
    const Eigen::Vector2d q = place();
    const Eigen::Vector2d velocity = random_vector(2, 3.0, random);
    const Eigen::Vector2d acceleration = random_vector(2, 10.0, random);
    dynamics.inverse_dynamics(*state, velocity, acceleration, {}, ours);
    compare(ours, torques(q, velocity, acceleration, gravity));
  }
}

TEST_F(MimicJoints, FollowTheOneThatLeadsThemAll) {
  const Joint& wrist = robot->joints()[static_cast<std::size_t>(robot->joint_index("wrist"))];
  EXPECT_EQ(wrist.mimics, robot->joint_index("shoulder"));
  EXPECT_DOUBLE_EQ(wrist.multiplier, -1.0);
  EXPECT_DOUBLE_EQ(wrist.offset, 0.15);
  EXPECT_EQ(wrist.index, -1);
  EXPECT_EQ(robot->axes().size(), 6u);
  const std::span<const int> of_slide = robot->axes_of(1);
  EXPECT_EQ(std::vector<int>(of_slide.begin(), of_slide.end()), (std::vector<int>{4, 3, 5}));
}

TEST_F(MimicJoints, NarrowTheLimitsOfTheirLeader) {
  const Joint& shoulder = robot->active_joint(0);
  EXPECT_DOUBLE_EQ(shoulder.lower, -0.8);  // the elbow's -1.5 = 2 q + 0.1
  EXPECT_DOUBLE_EQ(shoulder.upper, 1.2);   // the elbow's 2.5
  EXPECT_DOUBLE_EQ(shoulder.max_velocity, 1.0);
  EXPECT_DOUBLE_EQ(shoulder.max_effort, 500.0);
  const Joint& slide = robot->active_joint(1);
  EXPECT_DOUBLE_EQ(slide.lower, 0.0);
  EXPECT_DOUBLE_EQ(slide.upper, 0.03);  // the right slide's -0.03 = -q
  EXPECT_TRUE(robot->urdf_warnings().empty());
}

TEST_F(MimicJoints, DoNotTakeTheirLeaderAllItsRoom) {
  std::string text = mimic_robot_urdf();
  const std::string limits = "lower=\"-0.03\" upper=\"0\"";
  text.replace(text.find(limits), limits.size(), "lower=\"0\" upper=\"0.03\"");
  const Robot contradictory = Robot::load(folder.write("contradictory.urdf", text));
  EXPECT_DOUBLE_EQ(contradictory.active_joint(1).upper, 0.05);
  ASSERT_EQ(contradictory.urdf_warnings().size(), 1u);
  EXPECT_NE(contradictory.urdf_warnings()[0].find(
                ":34: the limits of mimic joint 'slide_right' leave joint 'slide_left'"),
            std::string::npos)
      << contradictory.urdf_warnings()[0];
}

TEST_F(MimicJoints, LimitALeaderThatHasNoLimits) {
  std::string text = mimic_robot_urdf();
  const std::string revolute = "<joint name=\"shoulder\" type=\"revolute\">";
  text.replace(text.find(revolute), revolute.size(),
               "<joint name=\"shoulder\" type=\"continuous\">");
  const Robot turning = Robot::load(folder.write("turning.urdf", text));
  EXPECT_EQ(turning.active_joint(0).type, JointType::kRevolute);
  EXPECT_DOUBLE_EQ(turning.active_joint(0).lower, -0.8);
  EXPECT_DOUBLE_EQ(turning.active_joint(0).upper, 1.2);
}

TEST_F(MimicJoints, StandWhereTheirFrozenLeaderPutsThem) {
  const std::filesystem::path srdf = folder.write(
      "gripper.srdf",
      "<robot name='gripper'><group name='slide'><joint name='slide_left'/>"
      "<joint name='slide_right'/></group><group_state name='home' group='slide'>"
      "<joint name='shoulder' value='0.4'/><joint name='elbow' value='7'/></group_state></robot>");
  const Robot frozen = Robot::load(folder.path() / "mimic.urdf", srdf,
                                   {.floating_base = false, .active_joints = {"slide"}});
  ASSERT_EQ(frozen.active_joint_count(), 1);
  EXPECT_EQ(frozen.axes().size(), 3u);
  EXPECT_EQ(frozen.group_joints("slide").size(), 2u);
  const Eigen::Vector2d q(0.4, 0.02);
  state->update(q.data());
  RobotState other(frozen);
  other.update(q.data() + 1);
  for (int link = 0; link < static_cast<int>(robot->links().size()); ++link) {
    EXPECT_TRUE(other.world_from_link(link).isApprox(state->world_from_link(link), 1e-12))
        << robot->links()[static_cast<std::size_t>(link)].name;
  }
}

}  // namespace
}  // namespace locograph::test
