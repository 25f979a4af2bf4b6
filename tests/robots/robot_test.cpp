// What a loaded robot says about itself.
#include <locograph/common/error.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

class SmallRobot : public testing::Test {
 protected:
  Robot load(const std::string& srdf, const RobotOptions& options = {}) {
    const std::filesystem::path urdf = folder.write("small.urdf", small_robot_urdf());
    return Robot::load(urdf, folder.write("small.srdf", srdf), options);
  }
  TemporaryFolder folder;
  const std::string groups = R"(<robot name="small">
    <virtual_joint name="world_joint" type="floating" parent_frame="world" child_link="base"/>
    <group name="arm"><chain base_link="base" tip_link="tip"/></group>
    <group name="turning"><joint name="turn"/><joint name="world_joint"/></group>
    <group name="both"><group name="turning"/><link name="slide"/></group>
    <group_state name="bent" group="arm">
      <joint name="turn" value="1.25"/><joint name="world_joint" value="0 0 1 0 0 0 1"/>
    </group_state>
    <group_state name="out" group="arm"><joint name="push" value="0.3"/></group_state>
  </robot>)";
};

TEST_F(SmallRobot, KeepsTheFiguresOfItsUrdf) {
  const Robot robot = load(groups);
  EXPECT_EQ(robot.name(), "small");
  ASSERT_EQ(robot.links().size(), 4u);
  ASSERT_EQ(robot.joints().size(), 3u);
  EXPECT_EQ(robot.links()[0].name, "base");
  EXPECT_DOUBLE_EQ(robot.total_mass(), 6.0);
  const Joint& turn = robot.active_joint(0);
  EXPECT_EQ(turn.name, "turn");
  EXPECT_LT((turn.axis - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_EQ(turn.lower, 0.5);
  EXPECT_EQ(turn.upper, 2.0);
  EXPECT_EQ(turn.max_velocity, 1.5);
  EXPECT_EQ(turn.max_effort, 20.0);
  EXPECT_EQ(robot.active_joint(1).type, JointType::kPrismatic);
  EXPECT_EQ(robot.joints()[2].index, -1);
  EXPECT_EQ(robot.configuration_size(), 9);
  EXPECT_EQ(robot.tangent_size(), 8);
}

TEST_F(SmallRobot, MayCallItsFloatingBaseRootJointAsPinocchioDoes) {
  const Robot robot = load(R"(<robot name="small">
    <group name="all"><joint name="root_joint"/><joint name="turn"/></group>
    <group_state name="bent" group="all">
      <joint name="root_joint" value="0 0 1 0 0 0 1"/><joint name="turn" value="1.25"/>
    </group_state></robot>)");
  EXPECT_EQ(robot.named_configuration("bent")[7], 1.25);
  EXPECT_THROW(load("<robot name='small'><group name='all'><joint name='root'/></group></robot>"),
               Error);
}

TEST_F(SmallRobot, TurnsInertiasIntoTheAxesOfTheirLinks) {
  const Robot robot = load(groups);
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  Eigen::Matrix3d inertia;
  inertia << 1, 0.1, 0, 0.1, 2, 0, 0, 0, 3;
  const Eigen::Matrix3d expected = rotation * inertia * rotation.transpose();
  EXPECT_LT((robot.links()[1].inertia - expected).norm(), 1e-12);
}

TEST_F(SmallRobot, ReadsGroupsOfJointsLinksChainsAndGroups) {
  const Robot robot = load(groups);
  EXPECT_EQ(robot.group_names(), (std::vector<std::string>{"arm", "both", "turning"}));
  EXPECT_EQ(robot.group_joints("arm"), (std::vector<int>{0, 1}));
  EXPECT_EQ(robot.group_joints("turning"), (std::vector<int>{0}));
  EXPECT_EQ(robot.group_joints("both"), (std::vector<int>{0, 1}));
}

TEST_F(SmallRobot, StandsNeutralAtTheLimitNearestToZero) {
  const Eigen::VectorXd q = load(groups).neutral_configuration();
  Eigen::VectorXd expected(9);
  expected << 0, 0, 0, 0, 0, 0, 1, 0.5, 0.0;
  EXPECT_EQ(q, expected);
}

TEST_F(SmallRobot, TakesNamedConfigurationsFromGroupStates) {
  const Robot robot = load(groups);
  EXPECT_EQ(robot.configuration_names(), (std::vector<std::string>{"bent", "out"}));
  Eigen::VectorXd expected(9);
  expected << 0, 0, 0, 0, 0, 0, 1, 1.25, 0.0;
  EXPECT_EQ(robot.named_configuration("bent"), expected);
  expected.tail<2>() << 0.5, 0.3;
  EXPECT_EQ(robot.named_configuration("out"), expected);
}

TEST_F(SmallRobot, FreezesTheJointsThatAreNotActiveAtTheFrozenState) {
  const Robot whole = load(groups);
  const Robot part = load(groups, {.active_joints = {"push"}, .frozen_state = "bent"});
  ASSERT_EQ(part.active_joint_count(), 1);
  EXPECT_EQ(part.active_joint(0).name, "push");
  const Joint& turn = part.joints()[static_cast<std::size_t>(part.joint_index("turn"))];
  EXPECT_EQ(turn.index, -1);
  EXPECT_EQ(turn.frozen_position, 1.25);

  RobotState whole_state(whole), part_state(part);
  Eigen::VectorXd q = whole.named_configuration("bent");
  q[8] = 0.2;
  whole_state.update(q.data());
  Eigen::VectorXd p = part.neutral_configuration();
  p[7] = 0.2;
  part_state.update(p.data());
  for (int link = 0; link < 4; ++link) {
    EXPECT_TRUE(part_state.world_from_link(link).isApprox(whole_state.world_from_link(link)));
  }
  EXPECT_LT((part_state.center_of_mass() - whole_state.center_of_mass()).norm(), 1e-12);
}

TEST_F(SmallRobot, AcceptsGroupsAsActiveJoints) {
  const Robot robot = load(groups, {.active_joints = {"turning"}});
  ASSERT_EQ(robot.active_joint_count(), 1);
  EXPECT_EQ(robot.active_joint(0).name, "turn");
}

TEST_F(SmallRobot, ListsTheJointsBetweenRootAndLink) {
  const Robot robot = load(groups);
  const auto support = [&](const char* link) {
    const std::span<const int> joints = robot.support(robot.link_index(link));
    return std::vector<int>(joints.begin(), joints.end());
  };
  EXPECT_EQ(support("base"), std::vector<int>{});
  EXPECT_EQ(support("arm"), std::vector<int>{0});
  EXPECT_EQ(support("tip"), (std::vector<int>{0, 1}));
}

TEST_F(SmallRobot, IsCopiedAsAWhole) {
  const Robot original = load(groups);
  const Robot copy = original;
  RobotState a(original), b(copy);
  EXPECT_TRUE(a.world_from_link(3).isApprox(b.world_from_link(3)));
}

TEST_F(SmallRobot, HasNoCentreOfMassWithoutAMass) {
  const Robot robot =
      Robot::load(folder.write("light.urdf", "<robot name='light'><link name='a'/></robot>"));
  RobotState state(robot);
  EXPECT_EQ(robot.total_mass(), 0.0);
  EXPECT_THROW(state.center_of_mass(), Error);
}

TEST(CollisionPairs, LeaveOutRigidDisabledAndBodilessLinks) {
  const TemporaryFolder folder;
  const std::string ball = "<collision><geometry><sphere radius='0.1'/></geometry></collision>";
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><axis xyz='0 0 1'/></joint>";
  };
  const std::filesystem::path urdf = folder.write(
      "r.urdf", "<robot name='r'><link name='a'>" + ball + "</link><link name='b'>" + ball +
                    "</link><link name='c'>" + ball + "</link><link name='d'/><link name='e'>" +
                    ball + "</link>" + joint("ab", "fixed", "a", "b") +
                    joint("bc", "continuous", "b", "c") + joint("cd", "continuous", "c", "d") +
                    joint("de", "fixed", "d", "e") + "</robot>");
  using Pairs = std::vector<std::pair<int, int>>;
  EXPECT_EQ(Robot::load(urdf).self_collision_pairs(),
            (Pairs{{0, 2}, {0, 4}, {1, 2}, {1, 4}, {2, 4}}));
  const std::filesystem::path srdf =
      folder.write("r.srdf",
                   "<robot name='r'><disable_collisions link1='e' link2='a'/>"
                   "<disable_default_collisions link='c'/><enable_collisions link1='b' link2='c'/>"
                   "</robot>");
  EXPECT_EQ(Robot::load(urdf, srdf).self_collision_pairs(), (Pairs{{1, 2}, {1, 4}}));
  // A frozen joint does not make its links rigid: which pairs are checked must not depend on it.
  EXPECT_EQ(Robot::load(urdf, {}, {.active_joints = {"bc"}}).self_collision_pairs().size(), 5u);
}

TEST(PublicRobots, LoadWithTheirSrdf) {
  const std::vector<std::pair<std::string, int>> joints = {
      {"centauro", 39}, {"centauro_capsule", 41}, {"cogimon", 28}, {"anymal", 12},
      {"go2", 12},      {"simple_humanoid", 29}};
  for (const auto& [name, count] : joints) {
    if (!std::filesystem::exists(public_robot(name + ".urdf"))) {
      GTEST_SKIP() << public_robot(name + ".urdf") << " is not on this machine";
    }
    const Robot robot = Robot::load(public_robot(name + ".urdf"), public_robot(name + ".srdf"),
                                    {.lenient_srdf = true});
    EXPECT_EQ(robot.active_joint_count(), count) << name;
    EXPECT_EQ(robot.configuration_names().size(), 1u) << name;
    EXPECT_EQ(robot.warnings().empty(), name != "centauro" && name != "simple_humanoid") << name;
  }
}

TEST(PublicRobots, MayHaveMeshesThatAreNotThere) {
  if (!std::filesystem::exists(public_robot("centauro.urdf"))) {
    GTEST_SKIP() << public_robot("centauro.urdf") << " is not on this machine";
  }
  const Robot centauro = Robot::load(public_robot("centauro.urdf"));
  const std::vector<std::string> missing = centauro.missing_meshes();
  const std::string pelvis = "package://centauro_urdf/meshes/simple/pelvis.stl";
  EXPECT_EQ(std::count(missing.begin(), missing.end(), pelvis), 1);
  EXPECT_TRUE(Robot::load(public_robot("go2.urdf")).missing_meshes().empty());
}

TEST(PublicRobots, LoadInSilence) {
  const std::filesystem::path file = public_robot("centauro.urdf");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Robot::load(file);  // urdfdom has four warnings about it
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(PublicRobots, TakeTheLinkBelowAFloatingJointAsTheirRoot) {
  if (!std::filesystem::exists(public_robot("centauro_capsule.urdf"))) {
    GTEST_SKIP() << public_robot("centauro_capsule.urdf") << " is not on this machine";
  }
  const Robot robot = Robot::load(public_robot("centauro_capsule.urdf"));
  EXPECT_EQ(robot.links()[0].name, "pelvis");
  EXPECT_EQ(robot.find_link("world"), -1);
}

}  // namespace
}  // namespace locograph::test
