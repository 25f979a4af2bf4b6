// The shipped Go2 model against the published figures.
#include <locograph/robots/robot_state.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

const std::vector<std::string> kLegs = {"FL", "FR", "RL", "RR"};

class Go2 : public testing::Test {
 protected:
  Go2()
      : robot(Robot::load(model("go2/go2.urdf"), model("go2/go2.srdf"))),
        state(robot),
        home(robot.named_configuration("home")) {
    state.update(home.data());
  }

  const Joint& joint(const std::string& name) const {
    return robot.joints()[static_cast<std::size_t>(robot.joint_index(name))];
  }
  Eigen::Vector3d position(const std::string& link) const {
    return state.world_from_link(robot.link_index(link)).translation();
  }

  Robot robot;
  RobotState state;
  Eigen::VectorXd home;
};

TEST_F(Go2, HasTwelveJointsLegByLeg) {
  ASSERT_EQ(robot.active_joint_count(), 12);
  int i = 0;
  for (const std::string& leg : kLegs) {
    for (const char* part : {"_hip_joint", "_thigh_joint", "_calf_joint"}) {
      EXPECT_EQ(robot.active_joint(i++).name, leg + part);
    }
  }
  EXPECT_EQ(robot.group_joints("front_left_leg").size(), 3u);
  EXPECT_EQ(robot.group_joints("legs").size(), 12u);
  EXPECT_EQ(robot.group_joints("whole_body").size(), 12u);
  EXPECT_TRUE(robot.warnings().empty());
}

TEST_F(Go2, HasThePublishedLimits) {
  for (const std::string& leg : kLegs) {
    const Joint &hip = joint(leg + "_hip_joint"), &thigh = joint(leg + "_thigh_joint"),
                &calf = joint(leg + "_calf_joint");
    EXPECT_EQ(hip.lower, -1.0472) << leg;
    EXPECT_EQ(hip.upper, 1.0472) << leg;
    EXPECT_EQ(thigh.lower, leg[0] == 'F' ? -1.5708 : -0.5236) << leg;
    EXPECT_EQ(thigh.upper, leg[0] == 'F' ? 3.4907 : 4.5379) << leg;
    EXPECT_EQ(calf.lower, -2.7227) << leg;
    EXPECT_EQ(calf.upper, -0.83776) << leg;
    for (const Joint* one : {&hip, &thigh, &calf}) {
      EXPECT_EQ(one->max_effort, one == &calf ? 45.43 : 23.7) << one->name;
      EXPECT_EQ(one->max_velocity, one == &calf ? 15.7 : 30.1) << one->name;
    }
  }
}

TEST_F(Go2, StandsAtHomeWithItsKneesBehindAndItsFeetBelowItsHips) {
  for (const std::string& leg : kLegs) {
    const Eigen::Vector3d hip = position(leg + "_hip"), foot = position(leg + "_foot");
    EXPECT_NEAR(foot.x(), hip.x(), 1e-9) << leg;
    EXPECT_NEAR(foot.z(), -2.0 * 0.213 * std::cos(0.72), 1e-9) << leg;
    EXPECT_NEAR(std::abs(foot.y()), 0.142, 1e-9) << leg;
    EXPECT_LT(position(leg + "_calf").x(), hip.x() - 0.1) << leg;
  }
  const Eigen::Vector3d com = state.center_of_mass();
  EXPECT_LT(std::abs(com.x()), 0.03);
  EXPECT_LT(std::abs(com.y()), 1e-3);
}

TEST_F(Go2, HasFeetThatAreBalls) {
  for (const std::string& leg : kLegs) {
    const Link& foot = robot.links()[static_cast<std::size_t>(robot.link_index(leg + "_foot"))];
    ASSERT_EQ(foot.collision.size(), 1u) << leg;
    EXPECT_EQ(foot.collision[0].type, ShapeType::kSphere) << leg;
    EXPECT_EQ(foot.collision[0].radius, 0.022) << leg;
    EXPECT_EQ(foot.collision[0].link_from_shape.translation(), Eigen::Vector3d(-0.002, 0.0, 0.0))
        << leg;
  }
}

TEST_F(Go2, HasTheFramesAndTheCentreOfMassOfThePublicDescription) {
  EXPECT_NEAR(robot.total_mass(), 16.085, 1e-9);
  if (!std::filesystem::exists(public_robot("go2.urdf"))) {
    GTEST_SKIP() << public_robot("go2.urdf") << " is not on this machine";
  }
  const Robot published = Robot::load(public_robot("go2.urdf"));
  ASSERT_EQ(published.configuration_size(), robot.configuration_size());
  EXPECT_NEAR(published.total_mass(), robot.total_mass(), 1e-9);
  RobotState expected(published);
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random_configuration(robot, random);
    state.update(q.data());
    expected.update(q.data());
    EXPECT_LT((state.center_of_mass() - expected.center_of_mass()).norm(), 1e-6);
    for (const Link& link : robot.links()) {
      const Eigen::Vector3d there =
          expected.world_from_link(published.link_index(link.name)).translation();
      EXPECT_LT((position(link.name) - there).norm(), 1e-9) << link.name;
    }
  }
}

}  // namespace
}  // namespace locograph::test
