// Robots stand as nobody has told them to.
#include <gtest/gtest.h>
#include <locograph/planners/posture/standing_start.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/proposed_effectors.h>

namespace locograph::standing_start_test {
namespace {

std::shared_ptr<const RobotParameter> shipped(const std::string& name) {
  const std::string file = LOCOGRAPH_SOURCE_DIR "/robots/models/" + name + "/" + name;
  return std::make_shared<const RobotParameter>(file + ".urdf", file + ".srdf", RobotOptions());
}

StandingStart stand(const std::shared_ptr<const RobotParameter>& robot) {
  return standing_start(robot, proposed_effectors(*robot->robot), 0.7);
}

double position(const Robot& robot, const Eigen::VectorXd& q, const std::string& joint) {
  const Joint& one = robot.joints()[static_cast<std::size_t>(robot.joint_index(joint))];
  return q[robot.base_configuration_size() + one.index];
}

TEST(StandingStart, AHumanoidStandsOnBothSolesWithItsKneesBent) {
  const auto parameter = shipped("coman_plus");
  const Robot& robot = *parameter->robot;
  const StandingStart start = stand(parameter);
  ASSERT_TRUE(start.answer.success()) << start.answer.reason;
  EXPECT_EQ(start.stance.contacts.size(), 2U);
  const Eigen::VectorXd& q = start.answer.configuration;
  EXPECT_GT(position(robot, q, "LKneePitch"), 0.2) << "to the side that its limits leave room";
  EXPECT_NEAR(position(robot, q, "LKneePitch"), position(robot, q, "RKneePitch"), 0.05);
  EXPECT_GT(q[6], 0.99) << "upright";
  const Judge judge(parameter->robot, posture_world());
  EXPECT_TRUE(judge.check(q, start.stance, posture_check()).feasible);
}

TEST(StandingStart, AQuadrupedStandsBelowItsHips) {
  const auto parameter = shipped("go2");
  const Robot& robot = *parameter->robot;
  const StandingStart start = stand(parameter);
  ASSERT_TRUE(start.answer.success()) << start.answer.reason;
  ASSERT_EQ(start.stance.contacts.size(), 4U);
  RobotState state(robot);
  state.update(start.answer.configuration.data());
  for (const Contact& contact : start.stance.contacts) {
    const int hip = robot.support(robot.link_index(contact.effector.link)).front();
    EXPECT_NEAR(contact.position.x(), state.joint_origin(hip).x(), 0.03) << contact.name();
    EXPECT_EQ(contact.position.z(), 0.0);
  }
}

TEST(StandingStart, OnNothingNobodyStands) {
  EXPECT_THROW(standing_start(shipped("go2"), {}, 0.7), Error);
}

}  // namespace
}  // namespace locograph::standing_start_test
