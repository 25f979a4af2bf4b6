#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/configuration_buffer.h>

#include <cmath>
#include <limits>

#include "common/allocation_counter.h"
#include "common/temporary_folder.h"
#include "plugins/small_robot.h"

namespace locograph {
namespace {

Robot small_cart(bool floating = true) {
  const test::TemporaryFolder folder;
  RobotOptions options;
  options.floating_base = floating;
  return Robot::load(folder.write("cart.urdf", test::kCartUrdf), {}, options);
}

/// The base is i metres ahead and turned by 0.2 i about z, the first joint at 0.1 i.
Eigen::VectorXd moved(const Robot& robot, double i) {
  Eigen::VectorXd q = robot.neutral_configuration();
  q[0] = i;
  q[5] = std::sin(0.1 * i);
  q[6] = std::cos(0.1 * i);
  q[7] = 0.1 * i;
  return q;
}

TEST(ConfigurationBuffer, KeepsWhatIsAddedAndGoesStraightInBetween) {
  const Robot robot = small_cart();
  ConfigurationBuffer buffer(robot);
  EXPECT_TRUE(buffer.empty());
  for (int i = 0; i < 40; ++i) buffer.add(0.1 * i, moved(robot, i));
  for (int i = 0; i < 40; ++i) {
    EXPECT_LT((buffer.at(0.1 * i) - moved(robot, i)).cwiseAbs().maxCoeff(), 1e-15) << i;
  }
  const Eigen::VectorXd q = buffer.at(0.125);
  EXPECT_NEAR(q[7], 0.125, 1e-15);
  EXPECT_NEAR(q[5], std::sin(0.125), 1e-12);
  EXPECT_NEAR(q[6], std::cos(0.125), 1e-12);
  EXPECT_NEAR(q.segment<4>(3).norm(), 1.0, 1e-15);
  Eigen::VectorXd tangent(robot.tangent_size()), whole(robot.tangent_size());
  robot.difference(moved(robot, 1).data(), q.data(), tangent.data());
  robot.difference(moved(robot, 1).data(), moved(robot, 2).data(), whole.data());
  EXPECT_LT((tangent - 0.25 * whole).norm(), 1e-12);
}

TEST(ConfigurationBuffer, AQuaternionAndItsNegativeAreTheSamePose) {
  const Robot robot = small_cart();
  ConfigurationBuffer buffer(robot);
  Eigen::VectorXd turned = moved(robot, 1.0);
  turned.segment<4>(3) *= -1.0;
  buffer.add(0.0, moved(robot, 0.0));
  buffer.add(1.0, turned);
  EXPECT_NEAR(std::abs(buffer.at(0.5)[5]), std::sin(0.05), 1e-12);
}

TEST(ConfigurationBuffer, ForgetsWhatIsOlderThanItKeeps) {
  const Robot robot = small_cart();
  ConfigurationBuffer buffer(robot, 1.0);
  for (int i = 0; i <= 1000; ++i) buffer.add(0.01 * i, moved(robot, 0.01 * i));
  EXPECT_EQ(buffer.newest_s(), 10.0);
  EXPECT_LE(buffer.oldest_s(), 9.0);
  EXPECT_GT(buffer.oldest_s(), 8.98);
  EXPECT_NEAR(buffer.at(9.0)[0], 9.0, 1e-12);
  EXPECT_THROW(buffer.at(8.9), Error);
}

TEST(ConfigurationBuffer, AllOfItsSpanIsAnsweredForWhateverTheStamps) {
  const Robot robot = small_cart();
  ConfigurationBuffer buffer(robot, 1.0);
  for (const double time : {0.0, 0.1, 0.7, 5.0, 5.5}) buffer.add(time, moved(robot, time));
  EXPECT_EQ(buffer.oldest_s(), 0.7);
  EXPECT_NEAR(buffer.at(4.6)[7], 0.46, 1e-12) << "between the last before the span and the next";
}

TEST(ConfigurationBuffer, ErrorsLeaveItAsItWas) {
  const Robot robot = small_cart();
  ConfigurationBuffer buffer(robot, 1.0);
  EXPECT_THROW(buffer.at(0.0), Error);
  buffer.add(1.0, moved(robot, 1));
  buffer.add(2.0, moved(robot, 2));
  const double nan = std::nan("");
  Eigen::VectorXd bad = moved(robot, 3);
  EXPECT_THROW(buffer.add(2.0, bad), Error);
  EXPECT_THROW(buffer.add(1.5, bad), Error);
  EXPECT_THROW(buffer.add(nan, bad), Error);
  EXPECT_THROW(buffer.add(std::numeric_limits<double>::infinity(), bad), Error);
  EXPECT_THROW(buffer.add(9.0, bad.head(5)), Error);
  bad[7] = nan;
  EXPECT_THROW(buffer.add(9.0, bad), Error);
  bad = moved(robot, 3);
  bad[6] = 0.5;
  EXPECT_THROW(buffer.add(9.0, bad), Error);
  for (const double time : {0.999, 2.001, nan}) EXPECT_THROW(buffer.at(time), Error) << time;
  EXPECT_EQ(buffer.oldest_s(), 1.0);
  EXPECT_EQ(buffer.newest_s(), 2.0);
  EXPECT_NEAR(buffer.at(1.5)[7], 0.15, 1e-12);
  buffer.add(2.5, moved(robot, 3));
  EXPECT_NEAR(buffer.at(2.5)[7], 0.3, 1e-15);
  EXPECT_THROW(ConfigurationBuffer(robot, 0.0), Error);
  EXPECT_THROW(ConfigurationBuffer(robot, nan), Error);
}

TEST(ConfigurationBuffer, ARobotWithoutAFloatingBaseHasJointsOnly) {
  const Robot robot = small_cart(false);
  ConfigurationBuffer buffer(robot);
  Eigen::VectorXd q = robot.neutral_configuration();
  buffer.add(0.0, q);
  q[0] += 0.5;
  buffer.add(1.0, q);
  EXPECT_NEAR(buffer.at(0.5)[0], q[0] - 0.25, 1e-15);
}

TEST(ConfigurationBuffer, DoesNotAllocateOnceItIsFull) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer counts its own";
  const Robot robot = small_cart();
  ConfigurationBuffer buffer(robot, 1.0);
  const Eigen::VectorXd q = moved(robot, 1.0);
  Eigen::VectorXd at = q;
  for (int i = 0; i < 300; ++i) buffer.add(0.01 * i, q);
  const long before = test::allocation_count();
  for (int i = 300; i < 1000; ++i) {
    buffer.add(0.01 * i, q);
    buffer.at(0.01 * i - 0.355, at);
  }
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace locograph
