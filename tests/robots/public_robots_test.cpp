// Robots as they are published: with mimic joints, without limits, with inertias that no body has.
#include <locograph/common/error.h>
#include <locograph/robots/body_inertia.h>
#include <locograph/robots/dynamics.h>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

class RobotsInTheWild : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(public_robot("public"))) {
      GTEST_SKIP() << public_robot("public") << " is not on this machine";
    }
  }
  static std::filesystem::path file(const std::string& name) {
    return public_robot("public/" + name);
  }
};

TEST_F(RobotsInTheWild, Load) {
  const std::vector<std::pair<std::string, int>> joints = {
      {"baxter", 17}, {"icub", 32}, {"panda", 8}, {"quadruped", 8}, {"tiago_no_hand", 12}};
  for (const auto& [name, count] : joints) {
    EXPECT_EQ(Robot::load(file(name + ".urdf")).active_joint_count(), count) << name;
  }
}

TEST_F(RobotsInTheWild, CloseBothFingersOfAPanda) {
  const Robot robot = Robot::load(file("panda.urdf"), file("panda.srdf"), {.floating_base = false});
  RobotState state(robot);
  Eigen::VectorXd q = robot.neutral_configuration();
  q[robot.joints()[static_cast<std::size_t>(robot.joint_index("panda_finger_joint1"))].index] =
      0.03;
  state.update(q.data());
  const auto in_hand = [&](const std::string& link) {
    return Eigen::Vector3d((state.world_from_link(robot.link_index("panda_hand")).inverse() *
                            state.world_from_link(robot.link_index(link)))
                               .translation());
  };
  EXPECT_NEAR(in_hand("panda_leftfinger").y(), 0.03, 1e-12);
  EXPECT_NEAR(in_hand("panda_rightfinger").y(), -0.03, 1e-12);
  EXPECT_NEAR(in_hand("panda_leftfinger").z(), in_hand("panda_rightfinger").z(), 1e-12);
}

TEST_F(RobotsInTheWild, HoldJointsWithoutLimitsAtZero) {
  const Robot robot = Robot::load(file("quadruped.urdf"));
  const Joint& knee = robot.joints()[static_cast<std::size_t>(robot.joint_index("FL_KFE"))];
  EXPECT_EQ(knee.lower, 0.0);
  EXPECT_EQ(knee.upper, 0.0);
  ASSERT_EQ(robot.urdf_warnings().size(), 4u);
  EXPECT_NE(robot.urdf_warnings()[0].find("joint 'FL_KFE' cannot move"), std::string::npos);
}

TEST_F(RobotsInTheWild, MoveWithInertiasThatNoBodyHas) {
  const Robot robot = Robot::load(file("tiago_no_hand.urdf"));
  EXPECT_FALSE(robot.urdf_warnings().empty());
  const RobotState state(robot);
  Eigen::VectorXd torques(robot.tangent_size());
  gravity_torques(state, standard_gravity(), torques);
  EXPECT_TRUE(torques.allFinite());
  Eigen::MatrixXd mass(robot.tangent_size(), robot.tangent_size());
  RobotDynamics(robot).mass_matrix(state, mass);
  EXPECT_EQ(mass.llt().info(), Eigen::Success) << "equations of motion have a solution";
  EXPECT_THROW(require_solid_bodies(robot, body_inertias(robot)), Error);
}

}  // namespace
}  // namespace locograph::test
