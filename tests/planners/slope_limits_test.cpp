#include <gtest/gtest.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/plan/slope_limits.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planners/planned_drive.h"

namespace locograph {
namespace {

/// Cubics between configurations within limits, at random and at the limits themselves.
TEST(SlopeLimits, CubicsStayWithinLimitsOfJoints) {
  const Robot& robot = centauro().robot;
  const int base = robot.base_configuration_size();
  std::mt19937_64 random(1);
  int beyond = 0;
  for (int draw = 0; draw < 200; ++draw) {
    const double step_s = uniform(random, 0.1, 1.0);
    Motion motion;
    motion.time_s = {0.0, step_s};
    for (int end = 0; end < 2; ++end) {
      Eigen::VectorXd q = centauro().home;
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(robot.tangent_size());
      for (int j = 0; j < robot.active_joint_count(); ++j) {
        const Joint& joint = robot.active_joint(j);
        if (std::isinf(joint.lower)) continue;
        const double share = std::clamp(uniform(random, -0.2, 1.2), 0.0, 1.0);
        q[base + j] = joint.lower + share * (joint.upper - joint.lower);
        slope[robot.base_tangent_size() + j] = uniform(random, -10.0, 10.0);
      }
      motion.configurations.push_back(q);
      motion.slopes.push_back(slope);
    }
    const auto most_beyond = [&] {
      const MotionCurve curve(robot, motion);
      Eigen::VectorXd q;
      double most = 0.0;
      for (int i = 0; i <= 50; ++i) {
        curve.step(0).configuration(i / 50.0, q);
        for (int j = 0; j < robot.active_joint_count(); ++j) {
          const Joint& joint = robot.active_joint(j);
          most = std::max({most, joint.lower - q[base + j], q[base + j] - joint.upper});
        }
      }
      return most;
    };
    beyond += most_beyond() > 0.01 ? 1 : 0;
    for (std::size_t i = 0; i < 2; ++i) {
      keep_within_limits(robot, motion.configurations[i], step_s, motion.slopes[i]);
    }
    EXPECT_LT(most_beyond(), 1e-12) << draw;
  }
  EXPECT_GT(beyond, 150) << "without it";
}

TEST(SlopeLimits, SlopesFarFromLimitsAndOfTheBaseStay) {
  const Robot& robot = centauro().robot;
  const Eigen::VectorXd before = Eigen::VectorXd::Constant(robot.tangent_size(), 0.05);
  Eigen::VectorXd slope = before;
  keep_within_limits(robot, centauro().home, 0.1, slope);
  EXPECT_EQ(slope, before);
}

TEST(SlopeLimits, StraightOnAsByTheRuleAndAroundACornerSlower) {
  const Robot& robot = centauro().robot;
  Motion motion = centauro().drive(3, 0.08, 0.8);
  const MotionCurve straight(robot, motion);
  EXPECT_TRUE(careful_slope(robot, motion, 1).isApprox(straight.slope(1), 1e-12));
  motion.configurations[2] = motion.configurations[1];  // it stops
  EXPECT_TRUE(careful_slope(robot, motion, 1).isZero());
  motion.configurations[2][1] += 0.08;  // it goes on to the side
  const MotionCurve corner(robot, motion);
  const Eigen::VectorXd slower = careful_slope(robot, motion, 1);
  EXPECT_LT(slower.norm(), 0.95 * corner.slope(1).norm());
  EXPECT_GT(slower.norm(), 0.0);
  EXPECT_NEAR(slower.normalized().dot(corner.slope(1).normalized()), 1.0, 1e-12);
}

/// A drive whose curve has slopes of its own.
class CarriedSlopes : public testing::Test {
 protected:
  CarriedSlopes() : graph(planned_drive(centauro_drive(0.72, 0.0, 10))), plan(plan_of(graph)) {
    before = motion_of(graph, plan);
    before.slopes.clear();
    const MotionCurve curve(*plan.robot->robot, before);
    for (int i = 0; i < kCount; ++i) vertex(i).slopes = 0.9 * curve.slope(i);
    vertex(4).slopes.setZero();
    vertex(5).slopes.resize(0);
    before = motion_of(graph, plan);
  }

  VertexConfiguration& vertex(int i) {
    return graph.vertex(VertexId<VertexConfiguration>{plan.slots[static_cast<std::size_t>(i)]});
  }
  /// By the rule of the curve.
  Eigen::VectorXd rule(int i) const {
    Motion motion = motion_of(graph, plan);
    motion.slopes.clear();
    return MotionCurve(*plan.robot->robot, motion).slope(i);
  }

  static constexpr int kCount = 10;
  Graph graph;
  Plan plan;
  Motion before;
};

TEST_F(CarriedSlopes, StayWhereNothingMoves) {
  carry_slopes(before, plan, graph);
  EXPECT_EQ(motion_of(graph, plan).slopes, before.slopes);
}

TEST_F(CarriedSlopes, FollowTheRuleWhereConfigurationsMove) {
  const Eigen::VectorXd rule_2 = rule(2);
  vertex(3).state[1] += 0.02;
  carry_slopes(before, plan, graph);
  const Motion after = motion_of(graph, plan);
  for (const std::size_t i : {0, 1, 4, 5, 6, 7, 8, 9}) {
    EXPECT_EQ(after.slopes[i], before.slopes[i]) << i;
  }
  EXPECT_GT((after.slopes[2] - before.slopes[2]).norm(), 1e-3);
  EXPECT_TRUE(after.slopes[2].isApprox(before.slopes[2] + rule(2) - rule_2, 1e-12));
}

TEST_F(CarriedSlopes, AreThoseOfThePlanWhereConfigurationsWereDisturbed) {
  EXPECT_EQ(motion_of_slopes(graph, plan).configurations, before.configurations);
  std::mt19937_64 random(3);
  for (int i = 1; i + 1 < kCount; ++i) vertex(i).state[1] += uniform(random, -0.02, 0.02);
  EXPECT_EQ(motion_of_slopes(graph, plan).configurations, before.configurations);
  // Slopes that were made for them are theirs.
  for (int i = 1; i + 1 < kCount; ++i) vertex(i).slopes = rule(i);
  EXPECT_EQ(motion_of_slopes(graph, plan).configurations, motion_of(graph, plan).configurations);
}

TEST_F(CarriedSlopes, KeepJointsWithinLimits) {
  const Robot& robot = *plan.robot->robot;
  int joint = 0;
  while (std::isinf(robot.active_joint(joint).upper)) ++joint;
  vertex(3).state[robot.base_configuration_size() + joint] = robot.active_joint(joint).upper;
  carry_slopes(before, plan, graph);
  EXPECT_EQ(vertex(3).slopes[robot.base_tangent_size() + joint], 0.0);
}

}  // namespace
}  // namespace locograph
