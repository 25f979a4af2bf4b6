// The shipped COMAN+ model against the published figures.
#include <locograph/robots/robot_state.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <fstream>
#include <map>

#include "robots/coman_plus_postures.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

Eigen::Vector3d mirrored(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

Eigen::Matrix3d mirrored(const Eigen::Matrix3d& m) {
  const Eigen::Matrix3d reflection = Eigen::Vector3d(1, -1, 1).asDiagonal();
  return reflection * m * reflection;
}

class ComanPlus : public testing::Test {
 protected:
  ComanPlus()
      : robot(
            Robot::load(model("coman_plus/coman_plus.urdf"), model("coman_plus/coman_plus.srdf"))),
        state(robot),
        home(robot.named_configuration("home")) {
    state.update(home.data());
  }

  const Link& link(const std::string& name) const {
    return robot.links()[static_cast<std::size_t>(robot.link_index(name))];
  }
  const Joint& joint(const std::string& name) const {
    return robot.joints()[static_cast<std::size_t>(robot.joint_index(name))];
  }
  Eigen::Isometry3d pose(const std::string& link) const {
    return state.world_from_link(robot.link_index(link));
  }
  Eigen::Vector3d position(const std::string& link) const { return pose(link).translation(); }

  Robot robot;
  RobotState state;
  Eigen::VectorXd home;
};

/// Line by line but for hands and names.
TEST(ComanPlusGrippers, AreThoseOfComanPlusWithOtherHands) {
  const auto lines_of = [](const std::string& name, const std::string& extension) {
    std::ifstream in(model(name + "/" + name + extension));
    std::vector<std::string> lines;
    bool hand = false;
    for (std::string line; std::getline(in, line);) {
      if (line.find("Ball_joint") != std::string::npos ||
          line.find("Gripper_joint") != std::string::npos) {
        hand = true;
      }
      if (line.find("arm_ft_joint") != std::string::npos) hand = false;
      for (const char* side : {"L", "R"}) {
        const std::string ball = std::string(side) + "Ball";
        if (const std::size_t at = line.find(ball); at != std::string::npos) {
          line.replace(at, ball.size(), std::string(side) + "Gripper");
        }
      }
      const bool named = line.starts_with("<robot") || line.starts_with("<!--");
      if (!hand && !named) lines.push_back(line);
    }
    return lines;
  };
  for (const std::string extension : {".urdf", ".srdf"}) {
    EXPECT_GT(lines_of("coman_plus", extension).size(), 100U);
    EXPECT_EQ(lines_of("coman_plus_grippers", extension), lines_of("coman_plus", extension));
  }
  const Robot robot = Robot::load(model("coman_plus_grippers/coman_plus_grippers.urdf"),
                                  model("coman_plus_grippers/coman_plus_grippers.srdf"));
  EXPECT_TRUE(robot.warnings().empty());
  RobotState state(robot);
  const Eigen::VectorXd home = robot.named_configuration("home");
  state.update(home.data());
  const auto grip = [&](const char* link) {
    return state.world_from_link(robot.link_index(link)).translation().eval();
  };
  EXPECT_LT((mirrored(grip("l_grip")) - grip("r_grip")).norm(), 1e-12);
}

TEST_F(ComanPlus, HasTwentyEightJointsInTheOrderOfThePublishedPostures) {
  const std::vector<std::string> expected = {
      "LHipLat", "LHipSag", "LHipYaw",    "LKneePitch",  "LAnklePitch",   "LAnkleRoll", "RHipLat",
      "RHipSag", "RHipYaw", "RKneePitch", "RAnklePitch", "RAnkleRoll",    "WaistLat",   "WaistYaw",
      "LShSag",  "LShLat",  "LShYaw",     "LElbj",       "LForearmPlate", "LWrj1",      "LWrj2",
      "RShSag",  "RShLat",  "RShYaw",     "RElbj",       "RForearmPlate", "RWrj1",      "RWrj2"};
  ASSERT_EQ(robot.active_joint_count(), 28);
  for (int i = 0; i < 28; ++i) {
    EXPECT_EQ(robot.active_joint(i).name, expected[static_cast<std::size_t>(i)]);
    EXPECT_EQ(robot.active_joint(i).type, JointType::kRevolute);
  }
  const std::map<std::string, std::size_t> groups = {
      {"left_leg", 6}, {"right_leg", 6}, {"legs", 12}, {"lower_body", 12}, {"torso", 2},
      {"left_arm", 7}, {"right_arm", 7}, {"arms", 14}, {"whole_body", 28}};
  for (const auto& [group, joints] : groups) {
    EXPECT_EQ(robot.group_joints(group).size(), joints) << group;
  }
}

TEST_F(ComanPlus, HasThePublishedLimits) {
  struct Limits {
    const char* joint;
    double lower, upper, velocity, effort;
  };
  const std::vector<Limits> table = {{"LHipLat", -0.5236, 1.6581, 7.4, 200},
                                     {"RHipLat", -1.6581, 0.5236, 7.4, 200},
                                     {"LHipSag", -1.9199, 1.5533, 7.4, 200},
                                     {"RHipSag", -1.9199, 1.5533, 7.4, 200},
                                     {"LHipYaw", -0.5585, 1.5708, 4.6, 120},
                                     {"RHipYaw", -1.5708, 0.5585, 4.9, 120},
                                     {"LKneePitch", 0, 2.4435, 5.5, 200},
                                     {"RKneePitch", 0, 2.4435, 5.5, 200},
                                     {"LAnklePitch", -0.8727, 0.6981, 4.9, 200},
                                     {"RAnklePitch", -0.8727, 0.6981, 4.9, 200},
                                     {"LAnkleRoll", -0.2618, 0.2618, 3.2, 60},
                                     {"RAnkleRoll", -0.2618, 0.2618, 3.2, 60},
                                     {"WaistLat", -0.5236, 0.5236, 7.4, 140},
                                     {"WaistYaw", -1.7453, 1.7453, 6.28, 120},
                                     {"LShSag", -3.352, 1.603, 6.28, 140},
                                     {"RShSag", -3.359, 1.606, 6.28, 140},
                                     {"LShLat", 0, 3.517, 6.28, 140},
                                     {"RShLat", -3.43, 0, 6.28, 140},
                                     {"LShYaw", -2.55, 2.55, 6.28, 120},
                                     {"RShYaw", -2.55, 2.55, 6.28, 120},
                                     {"LElbj", -2.492, 0.298, 6.28, 120},
                                     {"RElbj", -2.488, 0.292, 6.28, 120},
                                     {"LForearmPlate", -2.55, 2.55, 6.28, 35},
                                     {"RForearmPlate", -2.55, 2.55, 6.28, 35},
                                     {"LWrj1", -1.562, 1.478, 6.28, 35},
                                     {"RWrj1", -1.542, 1.508, 6.28, 35},
                                     {"LWrj2", -2.55, 2.55, 6.28, 20},
                                     {"RWrj2", -2.55, 2.55, 6.28, 20}};
  ASSERT_EQ(table.size(), 28u);
  for (const Limits& limits : table) {
    EXPECT_EQ(joint(limits.joint).lower, limits.lower) << limits.joint;
    EXPECT_EQ(joint(limits.joint).upper, limits.upper) << limits.joint;
    EXPECT_EQ(joint(limits.joint).max_velocity, limits.velocity) << limits.joint;
    EXPECT_EQ(joint(limits.joint).max_effort, limits.effort) << limits.joint;
  }
}

TEST_F(ComanPlus, HasThePublishedMassAndCentreOfMass) {
  EXPECT_NEAR(robot.total_mass(), 64.25, 0.005);
  EXPECT_NEAR(robot.total_mass() * 9.81, 630.3, 0.05);
  state.update(robot.named_configuration("published_home").data());
  EXPECT_LT(
      (state.center_of_mass() - Eigen::Vector3d(-0.0319, 0.0003, -0.0455)).cwiseAbs().maxCoeff(),
      1e-4);
}

TEST_F(ComanPlus, HasInertiasThatBodiesCanHave) {
  for (const Link& link : robot.links()) {
    if (link.mass == 0.0) continue;
    EXPECT_GT(link.mass, 0.0) << link.name;
    const Eigen::Vector3d principal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link.inertia).eigenvalues();
    EXPECT_GT(principal[0], 0.0) << link.name;
    EXPECT_GE(principal[0] + principal[1], principal[2]) << link.name;
  }
}

TEST_F(ComanPlus, HasThePublishedFramesInThePublishedHome) {
  state.update(robot.named_configuration("published_home").data());
  const std::vector<std::pair<std::string, Eigen::Vector3d>> frames = {
      {"l_sole", {-0.0876, 0.1032, -0.9586}},
      {"r_sole", {-0.0876, -0.1032, -0.9586}},
      {"TCP_L", {0.2611, 0.1612, 0.0207}},
      {"TCP_R", {0.2611, -0.1612, 0.0207}},
      {"l_ball_tip_d", {0.2031, 0.1903, -0.0447}},
      {"r_ball_tip_d", {0.2031, -0.1903, -0.0447}},
      {"LFoot", {-0.0835, 0.1032, -0.8897}},
      {"LLowLeg", {0.0329, 0.1648, -0.4788}},
      {"LThighUpLeg", {-0.0435, 0.1906, -0.1685}},
      {"LElb", {-0.1335, 0.3669, 0.1943}},
      {"LBall", {0.1963, 0.1871, 0.0256}},
      {"DWYTorso", {-0.0421, 0, 0.2316}},
      {"Head", {-0.0421, 0, 0.4282}}};
  for (const auto& [name, expected] : frames) {
    EXPECT_LT((position(name) - expected).cwiseAbs().maxCoeff(), 1e-4) << name;
  }
}

TEST_F(ComanPlus, StandsOnLevelSolesWithItsCentreOfMassAboveThem) {
  double front = -1.0, rear = 1.0, left = -1.0, right = 1.0;
  for (const char side : {'l', 'r'}) {
    const std::string name(1, side);
    EXPECT_TRUE(pose(name + "_sole").linear().isIdentity(1e-5)) << "turned or tilted";
    const double ground = position(name + "_sole").z();
    EXPECT_NEAR(ground, position("l_sole").z(), 1e-12);
    for (const char* corner : {"upper_left", "upper_right", "lower_left", "lower_right"}) {
      const Eigen::Vector3d p = position(name + "_foot_" + corner + "_link");
      EXPECT_NEAR(p.z(), ground, 1e-5);
      front = std::max(front, p.x());
      rear = std::min(rear, p.x());
      left = std::max(left, p.y());
      right = std::min(right, p.y());
    }
    const Link& foot = link(side == 'l' ? "LFoot" : "RFoot");
    const CollisionShape& plate = foot.collision.at(0);
    EXPECT_EQ(plate.type, ShapeType::kBox);
    EXPECT_NEAR(plate.link_from_shape.translation().z() - 0.5 * plate.size.z(), -0.0685, 1e-9);
  }
  EXPECT_NEAR(front - rear, 0.2105, 1e-5);
  const Eigen::Vector3d com = state.center_of_mass();
  EXPECT_LT(com.x(), front - 0.04);
  EXPECT_GT(com.x(), rear + 0.04);
  EXPECT_LT(com.y(), left - 0.1);
  EXPECT_GT(com.y(), right + 0.1);
}

TEST_F(ComanPlus, BendsItsKneesForwardsAndItsElbowsBackwardsAtHome) {
  for (const std::string side : {"L", "R"}) {
    const Eigen::Vector3d hip = position(side + "ThighUpLeg"), ankle = position(side + "Foot");
    EXPECT_GT(position(side + "LowLeg").x(), std::max(hip.x(), ankle.x()) + 0.05);
    EXPECT_LT(position(side + "Elb").x(), position(side + "Shp").x() - 0.05);
    EXPECT_GT(position(side + "Ball").x(), position("DWYTorso").x() + 0.2);
  }
}

TEST_F(ComanPlus, IsWithinItsLimitsInEveryPublishedPosture) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> postures = {
      {"home", home}, {"published_home", robot.named_configuration("published_home")}};
  for (const ComanPosture& p : coman_postures()) postures.emplace_back(p.name, p.configuration());
  for (const auto& [name, q] : postures) {
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      const Joint& joint = robot.active_joint(i);
      EXPECT_GE(q[7 + i], joint.lower - 1e-12) << name << ", " << joint.name;
      EXPECT_LE(q[7 + i], joint.upper + 1e-12) << name << ", " << joint.name;
    }
  }
}

TEST_F(ComanPlus, ReproducesThePublishedContactsAndCentresOfMass) {
  for (const ComanPosture& posture : coman_postures()) {
    SCOPED_TRACE(posture.name);
    state.update(posture.configuration().data());
    for (const ComanContact& contact : posture.contacts) {
      EXPECT_LT((position(contact.frame) - contact.position).norm(), 1e-3) << contact.frame;
      const bool foot = contact.frame.ends_with("_sole");
      const Eigen::Vector3d normal = foot ? contact.normal : Eigen::Vector3d(-contact.normal);
      EXPECT_LT((pose(contact.frame).linear().col(2) - normal).norm(), 1e-3) << contact.frame;
    }
    EXPECT_LT((state.center_of_mass() - posture.com).norm(), 2e-3);
  }
}

TEST_F(ComanPlus, HasThePublishedFreeHandsAtTheStart) {
  const std::vector<std::tuple<std::string, std::string, Eigen::Vector3d>> hands = {
      {"A0", "TCP_L", {0.339, 0.036, 0.306}},
      {"A0", "TCP_R", {0.339, -0.242, 0.306}},
      {"B0", "TCP_L", {0.650, 0.149, 0.987}},
      {"B0", "TCP_R", {0.657, -0.174, 0.989}},
      {"C0", "l_ball_tip_d", {1.094, 0.176, 0.919}},
      {"C0", "r_ball_tip_d", {1.102, -0.205, 0.922}}};
  for (const ComanPosture& posture : coman_postures()) {
    state.update(posture.configuration().data());
    for (const auto& [name, frame, expected] : hands) {
      if (name != posture.name) continue;
      EXPECT_LT((position(frame) - expected).norm(), 1e-3) << name << ", " << frame;
    }
  }
}

TEST_F(ComanPlus, IsHeldByThePublishedWrenches) {
  int held = 0;
  for (const ComanPosture& posture : coman_postures()) {
    SCOPED_TRACE(posture.name);
    state.update(posture.configuration().data());
    const Eigen::Vector3d com = state.center_of_mass();
    Eigen::Vector3d force(0.0, 0.0, -9.81 * robot.total_mass()), moment = Eigen::Vector3d::Zero();
    for (const ComanContact& contact : posture.contacts) {
      force += contact.force;
      moment += contact.moment + (position(contact.frame) - com).cross(contact.force);
    }
    if (posture.contacts[0].force.isZero()) continue;
    ++held;
    EXPECT_LT(force.norm(), 0.1);
    EXPECT_LT(moment.norm(), 0.1);
  }
  EXPECT_EQ(held, 9);
}

TEST_F(ComanPlus, IsTheSameOnTheLeftAndOnTheRight) {
  int sides = 0;
  for (const Joint& left : robot.joints()) {
    if (left.type == JointType::kFixed || left.name[0] != 'L') continue;
    SCOPED_TRACE(left.name);
    ++sides;
    std::string name = left.name;
    name[0] = 'R';
    const Joint& right = joint(name);
    EXPECT_TRUE(left.axis.isApprox(right.axis));
    EXPECT_TRUE(mirrored(Eigen::Vector3d(left.parent_from_joint.translation()))
                    .isApprox(right.parent_from_joint.translation(), 1e-12));
    EXPECT_TRUE(mirrored(Eigen::Matrix3d(left.parent_from_joint.linear()))
                    .isApprox(right.parent_from_joint.linear(), 1e-12));
    const bool same_sign = left.axis.y() == 1.0;
    EXPECT_NEAR(left.lower, same_sign ? right.lower : -right.upper, 0.09);
    EXPECT_NEAR(left.upper, same_sign ? right.upper : -right.lower, 0.09);
    EXPECT_EQ(left.max_effort, right.max_effort);
    const Link& a = robot.links()[static_cast<std::size_t>(left.child_link)];
    const Link& b = robot.links()[static_cast<std::size_t>(right.child_link)];
    EXPECT_EQ(a.mass, b.mass);
    // Published as the same part on both sides.
    const bool same_part = a.name == "LFootmot" || a.name == "LFoot" || a.name == "LWrMot3";
    EXPECT_LT(((same_part ? a.com : mirrored(a.com)) - b.com).norm(), 1e-9);
    EXPECT_LT(((same_part ? a.inertia : mirrored(a.inertia)) - b.inertia).norm(), 1e-9);
    ASSERT_EQ(a.collision.size(), b.collision.size());
    for (std::size_t i = 0; i < a.collision.size(); ++i) {
      const CollisionShape &u = a.collision[i], &v = b.collision[i];
      EXPECT_EQ(u.type, v.type);
      EXPECT_EQ(u.radius, v.radius);
      EXPECT_EQ(u.length, v.length);
      EXPECT_EQ(u.size, v.size);
      const Eigen::Vector3d axis = mirrored(Eigen::Vector3d(u.link_from_shape.linear().col(2)));
      EXPECT_LT((mirrored(Eigen::Vector3d(u.link_from_shape.translation())) -
                 v.link_from_shape.translation())
                    .norm(),
                1e-5);
      EXPECT_LT(axis.cross(v.link_from_shape.linear().col(2)).norm(), 1e-5);
    }
  }
  EXPECT_EQ(sides, 13);
}

TEST_F(ComanPlus, HasOnlyPrimitiveShapes) {
  EXPECT_TRUE(robot.missing_meshes().empty());
  for (const Link& link : robot.links()) {
    EXPECT_LE(link.collision.size(), 3u) << link.name;
    for (const CollisionShape& shape : link.collision) EXPECT_NE(shape.type, ShapeType::kMesh);
  }
  const CollisionShape& ball = link("LBall").collision.at(0);
  EXPECT_EQ(ball.type, ShapeType::kSphere);
  EXPECT_EQ(ball.radius, 0.071);
}

TEST_F(ComanPlus, HasTheKinematicsAndMassesOfThePublicRobotExceptHeadAndHands) {
  const std::filesystem::path file = public_robot("cogimon.urdf");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
  const Robot other = Robot::load(file);
  RobotState other_state(other);
  std::mt19937 random(16);
  const Eigen::VectorXd q = random_configuration(robot, random);
  Eigen::VectorXd p = other.neutral_configuration();
  p.head<7>() = q.head<7>();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& ours = robot.active_joint(i);
    const Joint& theirs = other.joints()[static_cast<std::size_t>(other.joint_index(ours.name))];
    p[7 + theirs.index] = q[7 + i];
    EXPECT_NEAR(ours.lower, theirs.lower, 5e-5) << ours.name;
    EXPECT_NEAR(ours.upper, theirs.upper, 5e-5) << ours.name;
    EXPECT_NEAR(ours.max_velocity, theirs.max_velocity, 5e-3) << ours.name;
    EXPECT_EQ(ours.max_effort, theirs.max_effort) << ours.name;
  }
  state.update(q.data());
  other_state.update(p.data());
  int moving = 0;
  for (const Joint& joint : robot.joints()) {
    if (joint.type == JointType::kFixed) continue;
    ++moving;
    const Link& ours = robot.links()[static_cast<std::size_t>(joint.child_link)];
    const int index = other.link_index(ours.name);
    const Link& theirs = other.links()[static_cast<std::size_t>(index)];
    EXPECT_TRUE(
        state.world_from_link(joint.child_link).isApprox(other_state.world_from_link(index), 1e-5))
        << ours.name;
    EXPECT_NEAR(ours.mass, theirs.mass, 1e-6) << ours.name;
    EXPECT_LT((ours.inertia - theirs.inertia).norm(), 1e-5) << ours.name;
  }
  EXPECT_EQ(moving, 28);
}

}  // namespace
}  // namespace locograph::test
