// The curve that a motion defines: through its vertices, with the slopes that it gives or the rule
// does, and its derivatives and bounds are those of the poses that it has.
#include <gtest/gtest.h>
#include <locograph/check/motion_curve.h>
#include <locograph/check/polynomial.h>

#include <numbers>
#include <random>

#include "check/centauro_on_wheels.h"

namespace locograph {
namespace {

struct RandomStep {
  Motion motion;

  RandomStep(int seed, double turn_rad) {
    std::mt19937 rng(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const Robot& robot = centauro().robot;
    motion.time_s = {1.0, 1.0 + 0.4};
    for (int i = 0; i < 2; ++i) {
      Eigen::VectorXd step(robot.tangent_size()), q(robot.configuration_size());
      for (double& x : step) x = 0.3 * unit(rng);
      Eigen::Vector3d axis(unit(rng), unit(rng), unit(rng));
      step.segment<3>(3) = turn_rad * axis.normalized();
      robot.integrate(i == 0 ? centauro().home.data() : motion.configurations[0].data(),
                      step.data(), q.data());
      motion.configurations.push_back(q);
      Eigen::VectorXd slope(robot.tangent_size());
      for (double& x : slope) x = unit(rng);
      motion.slopes.push_back(slope);
    }
  }
};

Eigen::Quaterniond rotation(const Eigen::VectorXd& q) {
  return Eigen::Quaterniond(Eigen::Vector4d(q.segment<4>(3)));
}

/// Of the tangent from one configuration to another one nearby, over dt.
Eigen::VectorXd rate(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double dt) {
  Eigen::VectorXd step(centauro().robot.tangent_size());
  centauro().robot.difference(from.data(), to.data(), step.data());
  return step / dt;
}

TEST(MotionCurve, GoesThroughTheVerticesToTheLastBit) {
  const RandomStep random(1, 1.0);
  const MotionCurve curve(centauro().robot, random.motion);
  Eigen::VectorXd q;
  for (const int end : {0, 1}) {
    curve.step(0).configuration(end, q);
    Eigen::VectorXd expected = random.motion.configurations[std::size_t(end)];
    expected.segment<4>(3).normalize();
    EXPECT_EQ(q, expected);
  }
  // What is next to the end is next to the vertex.
  curve.step(0).configuration(1.0 - 1e-12, q);
  EXPECT_LT(rate(q, random.motion.configurations[1], 1.0).norm(), 1e-10);
}

TEST(MotionCurve, HasTheSlopesThatItIsGiven) {
  for (const double turn : {1e-7, 0.02, 1.0, 3.0}) {
    const RandomStep random(2, turn);
    const MotionCurve curve(centauro().robot, random.motion);
    for (const int end : {0, 1}) {
      CurvePoint point;
      curve.step(0).at(end, point);
      Eigen::VectorXd expected = random.motion.slopes[std::size_t(end)];
      expected.head<3>() = rotation(point.configuration).conjugate() * expected.head<3>();
      EXPECT_LT((point.velocity - expected).norm(), 1e-9) << turn;
      EXPECT_LT((curve.step(0).slope(end) - random.motion.slopes[std::size_t(end)]).norm(), 1e-9);
    }
  }
}

TEST(MotionCurve, VelocitiesAndAccelerationsAreThoseOfItsConfigurations) {
  for (const double turn : {1e-3, 0.02, 0.5, 2.5}) {
    for (int seed = 0; seed < 5; ++seed) {
      const RandomStep random(10 + seed, turn);
      const MotionCurve curve(centauro().robot, random.motion);
      const CurveStep step = curve.step(0);
      for (const double s : {0.1, 0.3, 0.55, 0.9}) {
        constexpr double kStep = 1e-5;
        CurvePoint before, here, after;
        step.at(s - kStep, before);
        step.at(s, here);
        step.at(s + kStep, after);
        const double dt = kStep * step.duration_s();
        const Eigen::VectorXd velocity = 0.5 * (rate(here.configuration, after.configuration, dt) -
                                                rate(here.configuration, before.configuration, dt));
        EXPECT_LT((velocity - here.velocity).norm(), 1e-5 * (1.0 + here.velocity.norm()));
        const Eigen::VectorXd acceleration = (after.velocity - before.velocity) / (2.0 * dt);
        EXPECT_LT((acceleration - here.acceleration).norm(),
                  1e-5 * (1.0 + here.acceleration.norm()))
            << turn << ' ' << s;
      }
    }
  }
}

TEST(MotionCurve, AtAVertexItIsWhereTheNextStepBeginsAndAtTheLastWhereItEnds) {
  const RandomStep random(3, 0.5);
  const MotionCurve curve(centauro().robot, random.motion);
  for (const int end : {0, 1}) {
    CurvePoint expected;
    curve.step(0).at(end, expected);
    const CurvePoint here = curve.at_vertex(end);
    EXPECT_EQ(here.configuration, expected.configuration);
    EXPECT_EQ(here.velocity, expected.velocity);
    EXPECT_EQ(here.acceleration, expected.acceleration);
  }
  const Motion still{
      .time_s = {0.0}, .configurations = {centauro().home}, .stances = {}, .stance_from = {-1}};
  EXPECT_TRUE(MotionCurve(centauro().robot, still).at_vertex(0).velocity.isZero());
}

TEST(MotionCurve, NothingIsFasterThanItsBoundsAndSomethingAsFast) {
  for (int seed = 0; seed < 20; ++seed) {
    const RandomStep random(100 + seed, 0.5);
    const MotionCurve curve(centauro().robot, random.motion);
    const CurveStep step = curve.step(0);
    const StepBounds bounds = step.bounds();
    const double h = step.duration_s();
    double distance = 0.0, angle = 0.0, bend = 0.0, joint = 0.0, joint_bend = 0.0;
    for (int i = 0; i <= 2000; ++i) {
      CurvePoint point;
      step.at(i / 2000.0, point);
      distance = std::max(distance, h * point.velocity.head<3>().norm());
      angle = std::max(angle, h * point.velocity.segment<3>(3).norm());
      bend = std::max(bend, h * h * point.acceleration.segment<3>(3).norm());
      joint = std::max(joint, h * std::abs(point.velocity[8]));
      joint_bend = std::max(joint_bend, h * h * std::abs(point.acceleration[8]));
    }
    EXPECT_LE(distance, bounds.base_distance_m * (1.0 + 1e-12));
    EXPECT_GE(distance, bounds.base_distance_m * (1.0 - 1e-5));
    EXPECT_LE(angle, bounds.base_angle_rad * (1.0 + 1e-12));
    EXPECT_LE(bend, bounds.base_bend_rad * (1.0 + 1e-12));
    EXPECT_LE(joint, bounds.joints[2] * (1.0 + 1e-12));
    EXPECT_GE(joint, bounds.joints[2] * (1.0 - 1e-5));
    EXPECT_NEAR(joint_bend, bounds.joint_bends[2], 1e-9);
  }
}

TEST(MotionCurve, SlopesByTheRuleAreThoseOfAParabola) {
  Motion motion;
  motion.time_s = {0.0, 0.3, 1.0, 1.2};
  for (const double t : motion.time_s) motion.configurations.push_back(centauro().at(t * t));
  motion.stance_from = {0, 0, 0, 0};
  motion.stances = {centauro().wheels};
  const MotionCurve curve(centauro().robot, motion);
  EXPECT_TRUE(curve.slope(0).isZero());
  EXPECT_TRUE(curve.slope(3).isZero());
  for (const int i : {1, 2}) {
    EXPECT_NEAR(curve.slope(i)[0], 2.0 * motion.time_s[std::size_t(i)], 1e-12);
    const int wheel = centauro().roll_joints[0] - 1;
    EXPECT_NEAR(curve.slope(i)[wheel],
                centauro().roll_signs[0] * 2.0 * motion.time_s[std::size_t(i)] / kRadius, 1e-9);
  }
  // Where the stance changes the robot stands still.
  motion.stances.push_back(centauro().wheels);
  motion.stance_from = {0, 0, 1, 1};
  EXPECT_TRUE(MotionCurve(centauro().robot, motion).slope(2).isZero());
  EXPECT_FALSE(MotionCurve(centauro().robot, motion).slope(1).isZero());
}

TEST(MotionCurve, IsTheSameThroughOtherTimesAndInParts) {
  Motion motion = centauro().drive(5, 0.2, 0.5);
  for (std::size_t i = 0; i < 5; ++i) {
    const double yaw = 0.02 * static_cast<double>(i * i);
    motion.configurations[i].segment<4>(3) << 0, 0, std::sin(yaw), std::cos(yaw);
  }
  const MotionCurve curve(centauro().robot, motion);
  std::vector<double> times;
  for (int i = 0; i <= 400; ++i) times.push_back(2.0 * i / 400);
  const Motion finer = resampled(curve, times), part = part_of(curve, 1, 3);
  const MotionCurve fine(centauro().robot, finer), in_part(centauro().robot, part);
  Eigen::VectorXd q, again;
  for (int i = 0; i < 40; ++i) {
    const double time_s = 0.5 + 1.0 * (i + 0.37) / 40, at = time_s / 0.5;
    const int step = static_cast<int>(at), small = static_cast<int>(time_s / 0.005);
    curve.step(step).configuration(at - step, q);
    in_part.step(step - 1).configuration(at - step, again);
    EXPECT_LT(rate(q, again, 1.0).norm(), 1e-12);
    fine.step(small).configuration(time_s / 0.005 - small, again);
    EXPECT_LT(rate(q, again, 1.0).norm(), 1e-9);
  }
}

TEST(MotionCurve, SlopesOfAnotherSizeAreRefusedAndThoseThatAreNotFiniteAreNotUsed) {
  Motion motion = centauro().drive(3, 0.1, 0.5);
  motion.slopes.resize(2);
  EXPECT_THROW(MotionCurve(centauro().robot, motion), Error);
  motion.slopes.assign(3, {});
  motion.slopes[1] = Eigen::VectorXd::Zero(5);
  EXPECT_THROW(MotionCurve(centauro().robot, motion), Error);
  motion.slopes[1] = Eigen::VectorXd::Constant(centauro().robot.tangent_size(), kNaN);
  EXPECT_FALSE(MotionCurve(centauro().robot, motion).usable(1));
  const CheckReport report = check_with({}, motion);
  EXPECT_TRUE(report.constraint("not_finite").violated);
}

TEST(Polynomial, RootsAreFoundWhereTheSignChanges) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(-0.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    const std::array<double, 3> r = {unit(rng), unit(rng), unit(rng)};
    const UnitRoots roots = roots_in_unit(
        {-r[0] * r[1] * r[2], r[0] * r[1] + r[1] * r[2] + r[0] * r[2], -(r[0] + r[1] + r[2]), 1.0});
    for (const double root : r) {
      if (root < 1e-3 || root > 1.0 - 1e-3) continue;
      const auto nearest = std::ranges::min_element(
          roots, {}, [root](double found) { return std::abs(found - root); });
      ASSERT_NE(nearest, roots.end());
      EXPECT_NEAR(*nearest, root, 1e-6);
    }
  }
  EXPECT_EQ(roots_in_unit({1.0, 0.0, 0.0, 0.0}).count, 0);
  EXPECT_EQ(roots_in_unit({0.0, 0.0, 0.0, 0.0}).count, 0);
  EXPECT_EQ(roots_in_unit({-0.25, 0.0, 1.0, 0.0}).count, 1);
}

}  // namespace
}  // namespace locograph
