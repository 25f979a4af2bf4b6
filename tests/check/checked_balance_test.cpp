// The judge judges balance and torques on every stance, at vertices and between them.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/common/error.h>

#include "check/coman_plus.h"
#include "check/coman_plus_standing.h"
#include "check/given_contact.h"
#include "common/temporary_folder.h"
#include "robots/coman_plus_postures.h"

namespace locograph::test {
namespace {

/// COMAN+ in its published posture A0, on both soles wherever these are.
Motion squat(int vertices) {
  Motion motion;
  const Eigen::VectorXd q = coman_postures()[0].configuration();
  GivenContact sole{.link = "l_sole",
                    .half_x_m = 0.08,
                    .half_y_m = 0.035,
                    .friction = 0.5,
                    .max_force_N = 1000.0};
  GivenContact other = sole;
  other.link = "r_sole";
  motion.stances = {{contacts_at(coman_plus(), q, {sole, other})},
                    {contacts_at(coman_plus(), q, {other})}};
  for (int i = 0; i < vertices; ++i) {
    motion.time_s.push_back(i);
    motion.configurations.push_back(q);
    motion.stance_from.push_back(0);
  }
  return motion;
}

CheckReport check(const Motion& motion) { return Judge(standing().robot, World{}).check(motion); }

TEST(CheckedBalance, IsJudgedAtEveryVertexOnTheStancesOfBothSteps) {
  CheckReport report = check(squat(3));
  EXPECT_NEAR(report.min_balance_margin.value(), 0.1968, 1e-4);
  EXPECT_NEAR(report.max_torque_ratio.value(), 0.4186, 1e-4);
  EXPECT_FALSE(report.constraint("static_balance").violated);
  EXPECT_FALSE(report.constraint("torque_limits").violated);
  EXPECT_EQ(report.constraint("torque_limits").limit, 1.0);

  // On one foot it falls; the vertex before has to bear that stance, too.
  Motion motion = squat(3);
  motion.stance_from[2] = 1;
  report = check(motion);
  const Violation& balance = report.constraint("static_balance");
  EXPECT_TRUE(balance.violated);
  EXPECT_FALSE(report.feasible);
  EXPECT_EQ(balance.at_vertex, 2);
  EXPECT_EQ(balance.count, 1);
  EXPECT_LT(balance.worst, -0.01);
  EXPECT_EQ(balance.worst, report.min_balance_margin.value());
  EXPECT_NE(balance.what.find("is left over"), std::string::npos) << balance.what;
  EXPECT_EQ(report.balance->wrenches.size(), 1u);
}

TEST(CheckedBalance, IsNotJudgedWithoutStancesAndThenTheAnswerIsNo) {
  Motion motion = squat(2);
  motion.stance_from.clear();
  const CheckReport report = check(motion);
  EXPECT_FALSE(report.min_balance_margin.has_value());
  EXPECT_FALSE(report.max_torque_ratio.has_value());
  EXPECT_FALSE(report.constraint("static_balance").judged);
  EXPECT_EQ(report.constraint("static_balance").why_not, "no stance is known");
  EXPECT_FALSE(report.feasible);
}

TEST(CheckedBalance, CountsInertia) {
  // A quarter of a metre in three tenths of a second and back, with the base: soles stay, of
  // course, in no way; what is judged here is balance.
  Motion motion = squat(3);
  for (int i = 0; i < 3; ++i) motion.time_s[std::size_t(i)] = 0.3 * i;
  motion.configurations[1][0] += 0.1;
  CheckReport report = check(motion);
  EXPECT_TRUE(report.constraint("static_balance").violated);
  for (double& time : motion.time_s) time *= 100.0;
  report = check(motion);
  EXPECT_FALSE(report.constraint("static_balance").violated);
}

/// An arm that holds 2 kg at 1 m, with half the torque that it needs.
struct WeakArm {
  WeakArm() {
    motion.time_s = {0.0};
    motion.configurations = {Eigen::VectorXd::Zero(8)};
    motion.configurations[0][6] = 1.0001;  // a norm that the judge lets pass by itself
    Contact foot;
    foot.effector = {.name = "foot",
                     .link = "foot",
                     .half_x_m = 2.0,
                     .half_y_m = 2.0,
                     .friction = 0.5,
                     .max_force_N = 1000.0};
    motion.stances = {{{foot}}};
    motion.stance_from = {0};
    options.quaternion_tolerance = 1e-3;
  }
  CheckReport check() const { return Judge(robot, World{}).check(motion, options); }

  TemporaryFolder folder;
  std::shared_ptr<const Robot> robot = std::make_shared<const Robot>(Robot::load(folder.write(
      "arm.urdf",
      "<robot name='arm'><link name='foot'><inertial><mass value='1'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial><collision><geometry><sphere radius='0.05'/>"
      "</geometry></collision></link><link name='arm'><inertial><origin "
      "xyz='1 0 0'/><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
      "</inertial></link><joint name='shoulder' type='revolute'><parent link='foot'/><child "
      "link='arm'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' velocity='1' effort='9.81'/>"
      "</joint></robot>")));
  Motion motion;
  CheckOptions options;
};

TEST(CheckedBalance, TellsTorquesFromBalance) {
  WeakArm arm;
  CheckReport report = arm.check();
  EXPECT_GT(report.min_balance_margin.value(), 0.1);
  EXPECT_FALSE(report.constraint("static_balance").violated);
  EXPECT_TRUE(report.constraint("torque_limits").violated);
  EXPECT_NEAR(report.constraint("torque_limits").worst, 2.0, 1e-6);
  EXPECT_FALSE(report.feasible);

  arm.options.enforce_torque_limits = false;
  report = arm.check();
  EXPECT_TRUE(report.feasible);
  EXPECT_NEAR(report.max_torque_ratio.value(), 2.0, 1e-6);

  arm.options.min_balance_margin = 0.9;
  EXPECT_TRUE(arm.check().constraint("static_balance").violated);
}

TEST(CheckedBalance, TakesEffortsAsTheyAreScaled) {
  WeakArm arm;
  arm.options.effort_scale = 0.5;
  EXPECT_NEAR(arm.check().max_torque_ratio.value(), 4.0, 1e-6);
  arm.options.effort_scale = 4.0;
  const CheckReport report = arm.check();
  EXPECT_TRUE(report.feasible);
  EXPECT_NEAR(report.max_torque_ratio.value(), 0.5, 1e-5);
}

TEST(CheckedBalance, RefusesContactsAndOptionsThatMakeNoSense) {
  WeakArm arm;
  arm.options.min_balance_margin = 1.0;
  EXPECT_THROW(arm.check(), Error);
  arm.options.min_balance_margin = 0.0;
  arm.motion.stances[0].contacts[0].normal.setZero();
  EXPECT_THROW(arm.check(), Error);
  arm.motion.stances[0].contacts[0].normal = Eigen::Vector3d::UnitZ();
  EXPECT_NO_THROW(arm.check());
  arm.motion.stance_from.push_back(0);
  EXPECT_THROW(arm.check(), Error);
}

}  // namespace
}  // namespace locograph::test
