// The controllers, without the engine and in it.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/execution/joint_impedance_controller.h>
#include <locograph/execution/simulation.h>
#include <locograph/execution/whole_body_controller.h>
#include <locograph/robots/statics.h>

#include "common/allocation_counter.h"
#include "execution/standing_coman.h"

namespace locograph::test {
namespace {

class Controllers : public testing::Test {
 protected:
  StandingComan coman;
  WholeBodyController whole_body{coman.robot, coman.effectors};
  const HeldContact left{coman.contact(0), {}}, right{coman.contact(1), {}};
  std::vector<ContactCommand> commands = {{.held = &left}, {.held = &right}};
  CurvePoint rest = {coman.configuration, zero(), zero()};

  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(coman.robot.tangent_size()); }
  const Eigen::VectorXd& torques() {
    return whole_body.torques(coman.configuration, zero(), rest, commands);
  }
};

TEST_F(Controllers, AtRestTheFeetBearTheWeightAndTorquesAreStatic) {
  const Eigen::VectorXd joints = torques();
  RobotState state(coman.robot);
  state.update(coman.configuration.data());
  Eigen::VectorXd expected(coman.robot.tangent_size());
  std::vector<PointWrench> wrenches;
  Eigen::Vector3d all = Eigen::Vector3d::Zero();
  for (int i = 0; i < 2; ++i) {
    const EndEffector& foot = coman.effectors[static_cast<std::size_t>(i)];
    const int link = coman.robot.link_index(foot.link);
    const Eigen::Matrix3d axes = state.world_from_link(link).linear() * axes_in_link(foot);
    wrenches.push_back({.link = link,
                        .force = axes * whole_body.wrench(i).head<3>(),
                        .moment = axes * whole_body.wrench(i).tail<3>()});
    all += wrenches.back().force;
  }
  EXPECT_NEAR(all.z(), coman.weight_N(), 0.01);
  EXPECT_LT(whole_body.missing_force_N(), 0.01);
  static_torques(state, standard_gravity(), wrenches, expected);
  EXPECT_LT((expected.tail(joints.size()) - joints).cwiseAbs().maxCoeff(), 0.05);
}

TEST_F(Controllers, AContactThatIsUnloadedBearsLess) {
  commands[1].share = 0.05;
  torques();
  EXPECT_LT(whole_body.wrench(1)[2], 0.1 * whole_body.wrench(0)[2] + 0.05 * coman.weight_N());
  commands[1].held = nullptr;
  torques();
  EXPECT_EQ(whole_body.wrench(1).norm(), 0.0);
}

TEST_F(Controllers, WrenchesStayInsideConesAndAreas) {
  CurvePoint fast = rest;
  fast.acceleration[0] = 20.0;  // far more than friction gives
  whole_body.torques(coman.configuration, zero(), fast, commands);
  EXPECT_GT(whole_body.missing_force_N(), 10.0);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Matrix<double, 6, 1>& w = whole_body.wrench(i);
    EXPECT_GE(w[2], 0.01 * coman.weight_N() - 1e-6);
    EXPECT_LE(w.head<2>().norm(), 0.6 * w[2] + 1e-6);
    EXPECT_LE(std::abs(w[4]), 0.08 * w[2] + 1e-6);
    EXPECT_LE(std::abs(w[3]), 0.035 * w[2] + 1e-6);
  }
}

TEST_F(Controllers, TakeMoreOfFrictionWhileTheRestWillNotDo) {
  constexpr double kSlippery = 0.1;
  const auto slippery = [&](std::size_t i) {
    Contact contact = coman.contact(i);
    contact.effector.friction = kSlippery;
    return HeldContact(contact, {});
  };
  const HeldContact one = slippery(0), other = slippery(1);
  commands = {{.held = &one}, {.held = &other}};
  CurvePoint fast = rest;
  fast.acceleration[0] = 3.0;
  const auto used_after = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      whole_body.torques(coman.configuration, zero(), fast, commands);
    }
    const auto share = [&](int foot) {
      return whole_body.wrench(foot).head<2>().norm() / whole_body.wrench(foot)[2] / kSlippery;
    };
    return std::max(share(0), share(1));
  };
  EXPECT_LE(used_after(1), 0.7 + 1e-6);
  const double all = used_after(30);
  EXPECT_GT(all, 0.85);
  EXPECT_LE(all, 1.0 + 1e-6);
  for (int i = 0; i < 600; ++i) torques();
  EXPECT_LE(used_after(1), 0.7 + 1e-6);
}

TEST_F(Controllers, TorquesKeepToTheEfforts) {
  CurvePoint fast = rest;
  fast.acceleration.tail(coman.robot.active_joint_count()).setConstant(500.0);
  const Eigen::VectorXd& joints = whole_body.torques(coman.configuration, zero(), fast, commands);
  ASSERT_TRUE(joints.allFinite());
  for (int i = 0; i < coman.robot.active_joint_count(); ++i) {
    EXPECT_LE(std::abs(joints[i]), coman.robot.active_joint(i).max_effort);
  }
}

TEST_F(Controllers, AJointThatRunsIntoItsLimitIsBraked) {
  const Joint& elbow =
      coman.robot.joints()[static_cast<std::size_t>(coman.robot.joint_index("LElbj"))];
  const int k = coman.robot.base_tangent_size() + elbow.index;
  Eigen::VectorXd q = coman.configuration, v = zero();
  q[coman.robot.base_configuration_size() + elbow.index] = elbow.upper - 0.01;
  v[k] = 1.0;
  const CurvePoint on = {q, v, zero()};  // the reference wants it to go on
  WholeBodyController without(coman.robot, coman.effectors, {.limit_weight = 0.0});
  const double free = without.torques(q, v, on, commands)[elbow.index];
  EXPECT_LT(whole_body.torques(q, v, on, commands)[elbow.index], free - 0.5);
}

TEST_F(Controllers, DoNotAllocate) {
  if (!allocations_are_counted()) GTEST_SKIP();
  JointImpedanceController impedance(coman.robot, coman.effectors);
  MotionPlayer player(coman.robot, coman.effectors, coman.world, coman.standing());
  const std::vector<TouchMeasurement> measured(2, {.pressing_N = 300.0});
  const Eigen::VectorXd still = zero();
  const auto cycle = [&] {
    player.advance(measured);
    whole_body.torques(coman.configuration, still, player.reference(), player.contacts());
    impedance.torques(coman.configuration, still, player.reference(), player.contacts());
  };
  cycle();
  const long before = allocation_count();
  for (int i = 0; i < 1000; ++i) cycle();
  EXPECT_EQ(allocation_count(), before);
}

TEST_F(Controllers, BothKeepTheRobotStandingInTheEngine) {
  Motion standing = coman.standing();
  torques();
  const StanceWrenches borne = {whole_body.wrench(0), whole_body.wrench(1)};
  standing.wrenches = {borne, borne};
  for (const std::string& name : controller_names()) {
    const SimulationResult result =
        simulate(coman.robot, coman.effectors, coman.world, standing,
                 {.controller = name, .initial_error_rad = 0.002, .seed = 5});
    EXPECT_TRUE(result.carried_out) << name << ": " << result.reason;
    EXPECT_LT(result.max_contact_slip_m, 5e-3) << name;
  }
}

TEST_F(Controllers, RefuseOptionsAndCommandsThatMakeNoSense) {
  EXPECT_THROW(WholeBodyController(coman.robot, coman.effectors, {.joint_weight = 0.0}), Error);
  EXPECT_THROW(WholeBodyController(coman.robot, coman.effectors, {.torque = 1.5}), Error);
  EXPECT_THROW(WholeBodyController(coman.robot, coman.effectors, {.swing_weight = -1.0}), Error);
  commands.pop_back();
  EXPECT_THROW(static_cast<void>(torques()), Error);
}

}  // namespace
}  // namespace locograph::test
