// Slopes without jumps of acceleration, for a robot that floats and turns.
#include <gtest/gtest.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/motion/rest_spline.h>
#include <locograph/robots/robot.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/temporary_folder.h"

namespace locograph::rest_spline_test {
namespace {

constexpr double kStep_s = 0.02, kRamp_s = 0.13;

Robot arm() {
  return Robot::load(test::TemporaryFolder().write(
      "arm.urdf",
      "<robot name='arm'><link name='base'/><link name='hand'/><joint name='elbow' "
      "type='revolute'><parent link='base'/><child link='hand'/><axis xyz='0 1 0'/><limit "
      "lower='-3' upper='3' velocity='5' effort='10'/></joint></robot>"));
}

/// From rest to rest in 1 s, its jerk jumps in the middle of steps.
double progress(double t) {
  const auto integral = [](double s) {  // of a ramp up to 1 over kRamp_s, twice
    const double x = std::clamp(s, 0.0, kRamp_s);
    const double after = std::max(0.0, s - kRamp_s);
    return x * x * x / (6.0 * kRamp_s) + after * (kRamp_s / 2.0 + after / 2.0);
  };
  const double half = integral(0.5);
  return t <= 0.5 ? integral(t) / (2.0 * half) : 1.0 - integral(1.0 - t) / (2.0 * half);
}

TEST(RestSpline, HasNoJumpsOfAccelerationAndNoneAtItsEnds) {
  const Robot robot = arm();
  std::vector<Eigen::VectorXd> configurations, slopes;
  for (int i = 0; i <= 50; ++i) {
    const double s = progress(i * kStep_s);
    Eigen::VectorXd q = robot.neutral_configuration();
    q.head<3>() << 0.3 * s, 0.1 * s * s, 0.0;
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(0.8 * s, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(0.4 * std::sin(2.0 * s), Eigen::Vector3d::UnitX());
    q.segment<4>(3) = turn.coeffs();
    q[7] = 1.5 * s;
    configurations.push_back(q);
  }
  const std::vector<Eigen::VectorXd> given = configurations;
  rest_spline(robot, kStep_s, configurations, slopes);
  EXPECT_EQ(configurations.front(), given.front());
  EXPECT_EQ(configurations.back(), given.back());
  for (std::size_t i = 0; i < given.size(); ++i) {
    const double moved = (configurations[i] - given[i]).cwiseAbs().maxCoeff();
    if (i == 1 || i + 2 == given.size()) {
      EXPECT_LT(moved, 2e-5);
    } else {
      EXPECT_EQ(moved, 0.0);
    }
  }
  EXPECT_TRUE(slopes.front().isZero(0.0));
  EXPECT_TRUE(slopes.back().isZero(0.0));
  Motion motion;
  motion.configurations = configurations;
  motion.slopes = slopes;
  for (int i = 0; i <= 50; ++i) motion.time_s.push_back(i * kStep_s);
  const MotionCurve curve(robot, motion);
  CurvePoint before, after;
  double most = 0.0;
  for (int i = 1; i < 50; ++i) {
    curve.step(i - 1).at(1.0, before);
    curve.step(i).at(0.0, after);
    most = std::max(most, after.acceleration.cwiseAbs().maxCoeff());
    EXPECT_LT((after.acceleration - before.acceleration).cwiseAbs().maxCoeff(), 1e-3) << i;
  }
  EXPECT_GT(most, 1.0);
  curve.step(0).at(0.0, after);
  curve.step(49).at(1.0, before);
  EXPECT_LT(after.acceleration.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(before.acceleration.cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace locograph::rest_spline_test
