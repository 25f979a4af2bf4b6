// Kinematics and centre of mass of the public robots against an independent library.
#include <console_bridge/console.h>
#include <locograph/robots/robot_state.h>
#include <urdf_parser/urdf_parser.h>

#include <kdl/frames.hpp>
#include <kdl/jacobian.hpp>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treejnttojacsolver.hpp>
#include <sstream>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

KDL::Frame to_kdl(const urdf::Pose& pose) {
  return KDL::Frame(
      KDL::Rotation::Quaternion(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w),
      KDL::Vector(pose.position.x, pose.position.y, pose.position.z));
}

KDL::Joint to_kdl(const urdf::Joint& joint, const KDL::Frame& origin) {
  const KDL::Vector axis = origin.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
    return KDL::Joint(joint.name, origin.p, axis, KDL::Joint::RotAxis);
  }
  if (joint.type == urdf::Joint::PRISMATIC) {
    return KDL::Joint(joint.name, origin.p, axis, KDL::Joint::TransAxis);
  }
  return KDL::Joint(joint.name, KDL::Joint::None);
}

/// Depth first: KDL's solvers copy the tree that way and number the joints anew.
void add_children(const urdf::Link& link, KDL::Tree& tree) {
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    const KDL::Frame origin = to_kdl(joint.parent_to_joint_origin_transform);
    tree.addSegment(KDL::Segment(child->name, to_kdl(joint, origin), origin), link.name);
    add_children(*child, tree);
  }
}

/// A robot twice: ours, and KDL's from urdfdom's model.
struct Twin {
  Twin(const std::filesystem::path& file, bool floating)
      : robot(Robot::load(file, {}, {.floating_base = floating})) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    console_bridge::noOutputHandler();
    source = urdf::parseURDF(text.str());
    console_bridge::restorePreviousOutputHandler();
    const std::string root = robot.links()[0].name;
    tree = KDL::Tree(root);
    add_children(*source->getLink(root), tree);
  }

  KDL::JntArray positions(const Eigen::VectorXd& q) const {
    KDL::JntArray result(tree.getNrOfJoints());
    for (const auto& [name, element] : tree.getSegments()) {
      const KDL::Joint& joint = element.segment.getJoint();
      if (joint.getType() == KDL::Joint::None) continue;
      const Joint& ours =
          robot.joints()[static_cast<std::size_t>(robot.joint_index(joint.getName()))];
      result(element.q_nr) = q[robot.base_configuration_size() + ours.index];
    }
    return result;
  }

  Eigen::Isometry3d world_from_base(const Eigen::VectorXd& q) const {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    if (robot.floating_base()) {
      result.linear() = Eigen::Quaterniond(q[6], q[3], q[4], q[5]).toRotationMatrix();
      result.translation() = q.head<3>();
    }
    return result;
  }

  Eigen::Isometry3d base_from_link(const KDL::JntArray& positions, const std::string& link) const {
    KDL::TreeFkSolverPos_recursive solver(tree);
    KDL::Frame frame;
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    if (solver.JntToCart(positions, frame, link) < 0) ADD_FAILURE() << "KDL knows no " << link;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) result(r, c) = frame.M(r, c);
      result(r, 3) = frame.p(r);
    }
    return result;
  }

  Robot robot;
  urdf::ModelInterfaceSharedPtr source;
  KDL::Tree tree;
};

class PublicRobot : public testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  void SetUp() override {
    const std::filesystem::path file = public_robot(std::get<0>(GetParam()) + ".urdf");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
    twin = std::make_unique<Twin>(file, std::get<1>(GetParam()));
    ASSERT_EQ(static_cast<int>(twin->tree.getNrOfJoints()), twin->robot.active_joint_count());
  }
  std::unique_ptr<Twin> twin;
};

TEST_P(PublicRobot, HasTheLinkPosesOfKdl) {
  std::mt19937 random(1);
  RobotState state(twin->robot);
  for (int sample = 0; sample < 10; ++sample) {
    const Eigen::VectorXd q = random_configuration(twin->robot, random);
    const KDL::JntArray positions = twin->positions(q);
    state.update(q.data());
    for (std::size_t l = 0; l < twin->robot.links().size(); ++l) {
      const std::string& name = twin->robot.links()[l].name;
      const Eigen::Isometry3d expected =
          twin->world_from_base(q) * twin->base_from_link(positions, name);
      EXPECT_LT((state.world_from_link(static_cast<int>(l)).matrix() - expected.matrix())
                    .cwiseAbs()
                    .maxCoeff(),
                1e-9)
          << name;
    }
  }
}

TEST_P(PublicRobot, HasTheJacobiansOfKdl) {
  std::mt19937 random(2);
  const Robot& robot = twin->robot;
  const int base = robot.base_tangent_size();
  RobotState state(robot);
  KDL::TreeJntToJacSolver solver(twin->tree);
  KDL::Jacobian theirs(twin->tree.getNrOfJoints());
  Eigen::Matrix<double, 6, Eigen::Dynamic> ours(6, robot.tangent_size());
  for (int sample = 0; sample < 4; ++sample) {
    const Eigen::VectorXd q = random_configuration(robot, random);
    const KDL::JntArray positions = twin->positions(q);
    const Eigen::Matrix3d rotation = twin->world_from_base(q).linear();
    state.update(q.data());
    for (std::size_t l = 1; l < robot.links().size(); ++l) {
      const std::string& name = robot.links()[l].name;
      KDL::SetToZero(theirs);
      ASSERT_GE(solver.JntToJac(positions, theirs, name), 0);
      state.frame_jacobian(static_cast<int>(l), Eigen::Isometry3d::Identity(), ours);
      Eigen::Matrix<double, 6, Eigen::Dynamic> expected =
          Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, robot.tangent_size());
      for (const auto& [segment, element] : twin->tree.getSegments()) {
        const KDL::Joint& joint = element.segment.getJoint();
        if (joint.getType() == KDL::Joint::None) continue;
        const Joint& active =
            robot.joints()[static_cast<std::size_t>(robot.joint_index(joint.getName()))];
        expected.block<3, 1>(0, base + active.index) =
            rotation * theirs.data.col(element.q_nr).head<3>();
        expected.block<3, 1>(3, base + active.index) =
            rotation * theirs.data.col(element.q_nr).tail<3>();
      }
      if (base > 0) {  // v + omega x r in base axes, turned into the world
        const Eigen::Vector3d r = twin->base_from_link(positions, name).translation();
        Eigen::Matrix3d cross;
        cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
        expected.topLeftCorner<3, 3>() = rotation;
        expected.block<3, 3>(0, 3) = -rotation * cross;
        expected.block<3, 3>(3, 3) = rotation;
      }
      EXPECT_LT((ours - expected).cwiseAbs().maxCoeff(), 1e-9) << name;
    }
  }
}

TEST_P(PublicRobot, HasTheCentreOfMassOfKdlsLinkPoses) {
  std::mt19937 random(3);
  RobotState state(twin->robot);
  for (int sample = 0; sample < 10; ++sample) {
    const Eigen::VectorXd q = random_configuration(twin->robot, random);
    const KDL::JntArray positions = twin->positions(q);
    state.update(q.data());
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    double mass = 0.0;
    for (const auto& [name, link] : twin->source->links_) {
      if (!link->inertial || twin->robot.find_link(name) < 0) continue;
      const urdf::Vector3& com = link->inertial->origin.position;
      moment += link->inertial->mass *
                (twin->base_from_link(positions, name) * Eigen::Vector3d(com.x, com.y, com.z));
      mass += link->inertial->mass;
    }
    const Eigen::Vector3d expected = twin->world_from_base(q) * (moment / mass);
    EXPECT_NEAR(twin->robot.total_mass(), mass, 1e-9);
    EXPECT_LT((state.center_of_mass() - expected).norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PublicRobot,
                         testing::Combine(testing::ValuesIn(public_robots()), testing::Bool()),
                         [](const testing::TestParamInfo<PublicRobot::ParamType>& info) {
                           return std::get<0>(info.param) +
                                  (std::get<1>(info.param) ? "_floating" : "_fixed");
                         });

}  // namespace
}  // namespace locograph::test
