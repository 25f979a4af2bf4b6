// The least wrenches of a block on contacts: by hand, and where linear programmes find none.
#include <gtest/gtest.h>
#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/robots/statics.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/allocation_counter.h"
#include "common/temporary_folder.h"

namespace locograph::least_wrenches_test {
namespace {

constexpr double kMass_kg = 10.0, kWeight_N = kMass_kg * 9.81;

/// One link of 10 kg whose centre of mass is its origin.
Robot block() {
  return Robot::load(test::TemporaryFolder().write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><mass value='10'/><inertia ixx='1' "
      "ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>"));
}

BearingContact point_at(double x, double y, double max_force_N = 1e3) {
  BearingContact bearing;
  bearing.contact.effector.link = "block";
  bearing.contact.effector.kind = ContactKind::kPoint;
  bearing.contact.effector.friction = 0.5;
  bearing.contact.effector.max_force_N = max_force_N;
  bearing.contact.effector.point = bearing.contact.position = {x, y, -0.5};
  return bearing;
}

class LeastWrenchesTest : public testing::Test {
 protected:
  LeastWrenchesTest() : robot(block()), state(robot), asked(6) {
    const Eigen::VectorXd q = robot.neutral_configuration();
    state.update(q.data());
    gravity_torques(state, standard_gravity(), asked);
  }

  Robot robot;
  RobotState state;
  Eigen::VectorXd asked;
};

TEST_F(LeastWrenchesTest, FourPointsShareTheWeight) {
  const std::vector<BearingContact> points = {point_at(1, 1), point_at(1, -1), point_at(-1, 1),
                                              point_at(-1, -1)};
  LeastWrenches least(robot, points, 0.0);
  ASSERT_TRUE(least.solve(state, asked));
  for (const auto& wrench : least.wrenches()) {
    EXPECT_NEAR(wrench[2], 0.25 * kWeight_N, 1e-6);
    EXPECT_LT(wrench.head<2>().norm(), 1e-6);
  }
}

TEST_F(LeastWrenchesTest, WhatBearsMoreCarriesMore) {
  const std::vector<BearingContact> points = {point_at(1, 0, 2e3), point_at(1, 0, 1e3),
                                              point_at(-1, 1), point_at(-1, -1)};
  LeastWrenches least(robot, points, 0.0);
  ASSERT_TRUE(least.solve(state, asked));
  EXPECT_NEAR(least.wrenches()[0][2], 4.0 * least.wrenches()[1][2], 1e-6);
}

TEST_F(LeastWrenchesTest, GraspsThatHaveTurnedAboutTheirBarAreLimitedAlongTheHand) {
  std::vector<BearingContact> hands(2);
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& contact = hands[i].contact;
    contact.effector = {.link = "block", .kind = ContactKind::kGrasp, .max_force_N = 40.0};
    contact.effector.point = contact.position = {0.0, i == 0 ? 1.0 : -1.0, 0.0};
    contact.forward = Eigen::Vector3d::UnitX();
  }
  LeastWrenches least(robot, hands, 0.0);
  EXPECT_FALSE(least.solve(state, asked));  // each bears half of 98.1 N
  Eigen::VectorXd q = robot.neutral_configuration();
  q.segment<4>(3) =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.25 * std::numbers::pi, Eigen::Vector3d::UnitY()))
          .coeffs();
  state.update(q.data());
  gravity_torques(state, standard_gravity(), asked);
  ASSERT_TRUE(least.solve(state, asked));
  for (const auto& wrench : least.wrenches()) {
    EXPECT_NEAR(std::abs(wrench[0]), 0.5 * kWeight_N * std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(wrench[2], 0.5 * kWeight_N * std::sqrt(0.5), 1e-6);
  }
}

TEST_F(LeastWrenchesTest, EachIsPressedByItsLeastForce) {
  std::vector<BearingContact> points = {point_at(1, 1), point_at(-1, -1), point_at(1, -1)};
  LeastWrenches bare(robot, points, 0.0);
  ASSERT_TRUE(bare.solve(state, asked));
  EXPECT_NEAR(bare.wrenches()[2][2], 0.0, 1e-6);  // the centre of mass is between the others
  points.push_back(point_at(-1, 1));
  for (BearingContact& point : points) point.least_N = 0.1 * kWeight_N;
  points[0].contact.position.x() = points[0].contact.effector.point.x() = 3.0;
  LeastWrenches least(robot, points, 0.0);
  ASSERT_TRUE(least.solve(state, asked));
  for (const auto& wrench : least.wrenches()) EXPECT_GE(wrench[2], 0.1 * kWeight_N - 1e-6);
}

TEST_F(LeastWrenchesTest, HoldExactlyWhereTheRegionOfBalanceHasTheCentreOfMass) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  int held = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<BearingContact> points;
    for (int k = 0; k < 4; ++k) points.push_back(point_at(place(random), place(random)));
    const std::vector<BearingContact> counted = with_margin(points, ExecutionMargin(), kWeight_N);
    const bool balanced = balances(kMass_kg, counted, 0.02, Eigen::Vector2d::Zero());
    LeastWrenches least(robot, counted, 0.0);
    EXPECT_EQ(least.solve(state, asked), balanced) << i;
    held += balanced ? 1 : 0;
  }
  EXPECT_GT(held, 20);
  EXPECT_LT(held, 180);
}

TEST_F(LeastWrenchesTest, ChangeLittleWhenLittleIsAskedOtherwise) {
  const std::vector<BearingContact> points = {point_at(1, 1), point_at(1, -1), point_at(-1, 0)};
  LeastWrenches least(robot, points, 0.0);
  StanceWrenches before;
  for (int i = 0; i <= 100; ++i) {
    Eigen::VectorXd pushed = asked;
    pushed[1] += 0.45 * kWeight_N * i / 100.0;  // up to where friction gives no more
    if (!least.solve(state, pushed)) break;
    for (std::size_t c = 0; i > 0 && c < points.size(); ++c) {
      EXPECT_LT((least.wrenches()[c] - before[c]).norm(), 0.03 * kWeight_N) << i;
    }
    before = least.wrenches();
  }
}

TEST_F(LeastWrenchesTest, DoNotAllocate) {
  const std::vector<BearingContact> points = {point_at(1, 1), point_at(1, -1), point_at(-1, 0)};
  LeastWrenches least(robot, points, 0.0);
  const long before = test::allocation_count();
  EXPECT_TRUE(least.solve(state, asked));
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace locograph::least_wrenches_test
