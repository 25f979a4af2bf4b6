// The feasibility checker judges balance and torques where a plan says what the robot stands on.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/planners/plan/feasibility_checker.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>

#include "common/temporary_folder.h"
#include "robots/coman_plus_postures.h"

namespace locograph::test {
namespace {

std::shared_ptr<const RobotParameter> coman_plus_parameter() {
  static const auto robot = std::make_shared<const RobotParameter>(
      LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus.urdf",
      LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus.srdf", RobotOptions{});
  return robot;
}

/// COMAN+ in its published posture A0, three times, with contacts at both soles: parameters 4, 5.
struct Squat {
  Squat() {
    graph.parameters().set(kRobotNumber, coman_plus_parameter());
    for (const int number : {4, 5}) {
      ContactDescription sole;
      sole.link = number == 4 ? "l_sole" : "r_sole";
      sole.half_x_m = 0.08;
      sole.half_y_m = 0.035;
      sole.mu = 0.5;
      sole.max_force_N = 1000.0;
      graph.parameters().set(number, std::make_shared<const ContactParameter>(
                                         coman_plus_parameter(), kRobotNumber, sole));
    }
    for (int i = 0; i < 3; ++i) {
      q.push_back(
          graph.add_vertex(10 * i, VertexConfiguration(kRobotNumber, coman_plus_parameter(), i,
                                                       coman_postures()[0].configuration())));
    }
  }
  VertexId<VertexWrenches> add_wrenches(int id, std::vector<int> contacts) {
    return graph.add_vertex(id, VertexWrenches(graph.parameters(), std::move(contacts)));
  }
  CheckReport check() {
    const CollisionWorld world(*coman_plus_parameter()->robot, nullptr, {});
    return check_motion(*coman_plus_parameter()->robot, world, motion_of(graph, plan_of(graph)));
  }

  Graph graph;
  std::vector<VertexId<VertexConfiguration>> q;
};

TEST(CheckedBalance, IsJudgedAtTheVerticesThatHaveWrenches) {
  Squat squat;
  squat.graph.add_edge(EdgeBalance(1.0, 1.0), squat.q[0], squat.add_wrenches(1, {4, 5}));
  CheckReport report = squat.check();
  EXPECT_NEAR(report.min_balance_margin.value(), 0.1968, 1e-4);
  EXPECT_NEAR(report.max_torque_ratio.value(), 0.4186, 1e-4);
  EXPECT_FALSE(report.constraint("static_balance").violated);
  EXPECT_FALSE(report.constraint("torque_limits").violated);
  EXPECT_EQ(report.constraint("torque_limits").limit, 1.0);

  // On one foot it falls. Any edge says which wrenches are whose.
  squat.graph.add_edge(EdgeTorqueLimits(*coman_plus_parameter()->robot, 1.0, 1.0), squat.q[2],
                       squat.add_wrenches(2, {5}));
  report = squat.check();
  const Violation& balance = report.constraint("static_balance");
  EXPECT_TRUE(balance.violated);
  EXPECT_FALSE(report.feasible);
  EXPECT_EQ(balance.at_vertex, 2);
  EXPECT_EQ(balance.count, 1);
  EXPECT_LT(balance.worst, -0.01);
  EXPECT_EQ(balance.worst, report.min_balance_margin.value());
  EXPECT_NE(balance.what.find("is left over"), std::string::npos) << balance.what;
  EXPECT_FALSE(report.constraint("torque_limits").violated) << "there are no wrenches to judge";
}

TEST(CheckedBalance, IsNotJudgedWithoutContacts) {
  Squat squat;
  const CheckReport report = squat.check();
  EXPECT_FALSE(report.min_balance_margin.has_value());
  EXPECT_FALSE(report.max_torque_ratio.has_value());
  EXPECT_EQ(report.constraint("static_balance").what, "nothing to check");
}

TEST(CheckedBalance, TakesOneSetOfWrenchesForAConfiguration) {
  Squat squat;
  squat.graph.add_edge(EdgeBalance(1.0, 1.0), squat.q[0], squat.add_wrenches(1, {4}));
  squat.graph.add_edge(EdgeBalance(1.0, 1.0), squat.q[0], squat.add_wrenches(2, {5}));
  EXPECT_THROW(squat.check(), Error);
}

/// An arm that holds 2 kg at 1 m, with half the torque that it needs.
struct WeakArm {
  WeakArm() {
    motion.time_s = {0.0};
    motion.configurations = {Eigen::VectorXd::Zero(8)};
    motion.configurations[0][6] = 1.0001;  // a norm that the checker lets pass by itself
    ContactDescription foot;
    foot.link = "foot";
    foot.half_x_m = foot.half_y_m = 2.0;
    foot.mu = 0.5;
    foot.max_force_N = 1000.0;
    motion.contacts = {{foot}};
    options.quaternion_tolerance = 1e-3;
  }
  CheckReport check() const {
    return check_motion(robot, CollisionWorld(robot, nullptr, {}), motion, options);
  }

  TemporaryFolder folder;
  Robot robot = Robot::load(folder.write(
      "arm.urdf",
      "<robot name='arm'><link name='foot'><inertial><mass value='1'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link><link name='arm'><inertial><origin "
      "xyz='1 0 0'/><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
      "</inertial></link><joint name='shoulder' type='revolute'><parent link='foot'/><child "
      "link='arm'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' velocity='1' effort='9.81'/>"
      "</joint></robot>"));
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

TEST(CheckedBalance, RefusesContactsAndOptionsThatMakeNoSense) {
  WeakArm arm;
  arm.options.min_balance_margin = 1.0;
  EXPECT_THROW(arm.check(), Error);
  arm.options.min_balance_margin = 0.0;
  arm.motion.contacts[0][0].normal.setZero();
  EXPECT_THROW(arm.check(), Error);
  arm.motion.contacts[0][0].normal = Eigen::Vector3d::UnitZ();
  EXPECT_NO_THROW(arm.check());
  arm.motion.contacts.push_back({});
  EXPECT_THROW(arm.check(), Error);
}

}  // namespace
}  // namespace locograph::test
