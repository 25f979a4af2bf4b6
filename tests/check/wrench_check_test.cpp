// Wrenches that a motion states: what is left over, cones and areas, limits, and how fast they
// change.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/check/wrench_check.h>

#include <cmath>
#include <random>

#include "check/centauro_on_wheels.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Eigen::Vector3d;
using Wrench = Eigen::Matrix<double, 6, 1>;

constexpr double kWeight_N = 10.0 * 9.81;

Wrench pressing(double share, double x = 0.0, double y = 0.0) {
  Wrench wrench = Wrench::Zero();
  wrench[2] = share * kWeight_N;
  wrench[3] = y * wrench[2];
  wrench[4] = -x * wrench[2];
  return wrench;
}

/// A block of 10 kg that stands on three soles in a row along y, the middle one below its centre of
/// mass, and puts its weight on that before the others open.
class Stated : public ::testing::Test {
 protected:
  static Contact sole(const std::string& name, double y) {
    return {.effector = {.name = name,
                         .link = "block",
                         .point = {0.0, y, 0.0},
                         .half_x_m = 0.05,
                         .half_y_m = 0.02,
                         .friction = 0.5,
                         .max_force_N = 120.0},
            .position = {0.0, y, 0.0},
            .forward = Vector3d::UnitX()};
  }
  Motion motion() const {
    Motion motion;
    motion.stances = {{{sole("left", 0.3), sole("middle", 0.0), sole("right", -0.3)}},
                      {{sole("middle", 0.0)}}};
    for (int i = 0; i <= 4; ++i) {
      motion.time_s.push_back(0.25 * i);
      motion.configurations.push_back(robot_->neutral_configuration());
      motion.stance_from.push_back(i < 2 ? 0 : 1);
    }
    motion.wrenches = {{pressing(0.4), pressing(0.2), pressing(0.4)},
                       {pressing(0.2), pressing(0.6), pressing(0.2)},
                       {pressing(1.0)},
                       {pressing(1.0)},
                       {pressing(1.0)}};
    return motion;
  }
  Violation judged(const Motion& motion, const CheckOptions& options = {}) const {
    World world;
    world.surfaces = {ground()};
    const CheckReport report = Judge(robot_, world).check(motion, options);
    EXPECT_FALSE(report.constraint("static_balance").violated);
    return report.constraint("plan_wrenches");
  }
  void expect_refused(const Motion& motion, int vertex, double ratio, const std::string& what) {
    const Violation violation = judged(motion);
    EXPECT_TRUE(violation.violated);
    EXPECT_EQ(violation.at_vertex, vertex) << violation_text(violation);
    if (std::isinf(ratio)) {
      EXPECT_EQ(violation.worst, ratio) << violation_text(violation);
    } else {
      EXPECT_NEAR(violation.worst, ratio, 1e-6 * ratio) << violation_text(violation);
    }
    EXPECT_NE(violation.what.find(what), std::string::npos) << violation_text(violation);
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<const Robot> robot_ = std::make_shared<const Robot>(Robot::load(folder_.write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><origin xyz='0 0 0.4'/><mass value='10'/>"
      "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>")));
};

TEST_F(Stated, WrenchesThatHoldAreBelieved) {
  const Violation violation = judged(motion());
  EXPECT_TRUE(violation.judged);
  EXPECT_FALSE(violation.violated) << violation_text(violation);
  // The weight on one sole of 120 N; the force of the middle one changes by 1.6 of 2.5 a second.
  EXPECT_NEAR(violation.worst, kWeight_N / 120.0, 1e-9);
  EXPECT_NE(violation.what.find("force limit of middle"), std::string::npos);
}

TEST_F(Stated, PlansWithoutWrenchesAreNotRefused) {
  Motion none = motion();
  none.wrenches.clear();
  EXPECT_FALSE(judged(none).judged);
  EXPECT_EQ(judged(none).why_not, "no wrenches are stated");
}

TEST_F(Stated, OfAPartAreJudgedButForBalanceWhereItGoesOn) {
  CheckOptions part;
  part.starts_at_rest = part.ends_at_rest = false;
  Motion lies = motion();
  EXPECT_FALSE(judged(lies, part).violated);
  const std::size_t last = lies.wrenches.size() - 1;
  // Nobody knows how it moves on.
  lies.wrenches[0][0][2] *= 1.0 + 2e-3;
  lies.wrenches[last][0][2] *= 1.0 + 2e-3;
  EXPECT_TRUE(judged(lies).violated);
  EXPECT_TRUE(judged(lies, part).judged);
  EXPECT_FALSE(judged(lies, part).violated);
  lies.wrenches[3][0][2] *= 1.0 + 2e-3;
  EXPECT_EQ(judged(lies, part).at_vertex, 3);
  EXPECT_TRUE(judged(lies, part).violated);
}

TEST_F(Stated, WhatDoesNotBalanceIsRefused) {
  Motion lies = motion();
  lies.wrenches[3][0][2] *= 1.0 + 2e-3;
  expect_refused(lies, 3, 2.0, "is left over");
  lies.wrenches[3][0] = pressing(1.0, 1.5e-3);
  expect_refused(lies, 3, 1.5, "is left over");
  lies.wrenches[3][0] = pressing(1.0, 0.9e-3);
  EXPECT_FALSE(judged(lies).violated);
}

TEST_F(Stated, ThatAreNotFiniteOrAtOtherContactsAreRefused) {
  Motion lies = motion();
  lies.wrenches[1][2][0] = kNaN;
  expect_refused(lies, 1, kInfinity, "not finite");
  lies = motion();
  lies.wrenches[1].pop_back();
  expect_refused(lies, 1, kInfinity, "other contacts");
  lies.wrenches[1].clear();
  expect_refused(lies, 1, kInfinity, "none are stated");
  lies.wrenches.pop_back();
  EXPECT_THROW(judged(lies), Error);
  // Stated in the file, but nowhere whole.
  lies = motion();
  for (StanceWrenches& wrenches : lies.wrenches) wrenches.clear();
  expect_refused(lies, 4, kInfinity, "none are stated");
}

TEST_F(Stated, ForcesThatJumpAreRefused) {
  Motion lies = motion();
  lies.wrenches[1] = lies.wrenches[0];
  // The middle sole takes 0.8 of the weight within a quarter of a second.
  expect_refused(lies, 1, 0.8 / 0.25 / 2.5, "middle changes by 3.2 weights per second");
  // In a plan of stances there is no time.
  lies.stances_only = true;
  EXPECT_FALSE(judged(lies).violated);
}

TEST_F(Stated, AContactThatClosesCarriesNothingYet) {
  Motion closes = motion();
  std::reverse(closes.wrenches.begin(), closes.wrenches.end());
  closes.stance_from = {1, 1, 0, 0, 0};
  closes.wrenches = {{pressing(1.0)},
                     {pressing(1.0)},
                     {pressing(0.0), pressing(1.0), pressing(0.0)},
                     {pressing(0.2), pressing(0.6), pressing(0.2)},
                     {pressing(0.4), pressing(0.2), pressing(0.4)}};
  EXPECT_FALSE(judged(closes).violated) << violation_text(judged(closes));
  closes.wrenches[2] = {pressing(0.1), pressing(0.8), pressing(0.1)};
  expect_refused(closes, 2, 100.0, "carries 0.1 of the weight where it closes");
  // And what it carries after it is a change from nothing.
  closes.wrenches[2] = {pressing(0.0), pressing(1.0), pressing(0.0)};
  closes.time_s = {0.0, 1.0, 2.0, 2.05, 3.0};
  expect_refused(closes, 2, 0.4 / 0.05 / 2.5, "middle changes");
}

TEST_F(Stated, FrictionAreaAndLimitsAreJudged) {
  const auto with = [&](const Wrench& left, const Wrench& right) {
    Motion motion = this->motion();
    motion.wrenches[0][0] += left;
    motion.wrenches[0][2] += right;
    return motion;
  };
  // Against each other they only squeeze.
  Wrench squeeze = Wrench::Zero();
  squeeze[1] = 0.21 * kWeight_N;
  expect_refused(with(squeeze, -squeeze), 0, 1.0 + 0.02, "friction or area of left");
  squeeze[1] = 0.19 * kWeight_N;
  EXPECT_FALSE(judged(with(squeeze, -squeeze)).violated);
  // Centres of pressure at the edges, and beyond.
  Wrench tip = Wrench::Zero();
  tip[4] = 0.049 * 0.4 * kWeight_N;
  EXPECT_FALSE(judged(with(tip, -tip)).violated);
  tip[4] = 0.06 * 0.4 * kWeight_N;
  EXPECT_TRUE(judged(with(tip, -tip)).violated);
  EXPECT_NE(judged(with(tip, -tip)).what.find("area of"), std::string::npos);
  // More than it may press.
  Motion heavy = motion();
  for (Contact& contact : heavy.stances[1].contacts) contact.effector.max_force_N = 90.0;
  for (Contact& contact : heavy.stances[0].contacts) contact.effector.max_force_N = 90.0;
  World world;
  world.surfaces = {ground()};
  const CheckReport report = Judge(robot_, world).check(heavy);
  EXPECT_NEAR(report.constraint("plan_wrenches").worst, kWeight_N / 90.0, 1e-9);
}

// The robot is pushed off: what is stated fits the accelerations on either side, and in between.
TEST_F(Stated, InertiaCountsOnBothSidesOfAVertex) {
  Motion moves = motion();
  moves.stance_from.assign(5, 1);
  const MotionCurve curve(*robot_, moves);
  moves.slopes.assign(5, Eigen::VectorXd::Zero(6));
  // Half a millimetre upwards within the second step and back in the third.
  moves.configurations[2][2] = 4e-4;
  const double up = 6.0 * 4e-4 / (0.25 * 0.25), share = up / 9.81;  // at both ends, with signs
  moves.wrenches = {{pressing(1.0)},
                    {pressing(1.0 + 0.5 * share)},
                    {pressing(1.0 - share)},
                    {pressing(1.0 + share)},
                    {pressing(1.0)}};
  World world;
  world.surfaces = {ground()};
  const auto judge = [&] { return Judge(robot_, world).check(moves).constraint("plan_wrenches"); };
  EXPECT_FALSE(judge().violated) << violation_text(judge());
  moves.wrenches[2] = {pressing(1.0)};
  EXPECT_NEAR(judge().worst, 1e3 * share, 1e-6);
  moves.wrenches[2] = {pressing(1.0 - share)};
  moves.wrenches[3] = {pressing(1.0 - 2e-3)};
  EXPECT_NEAR(judge().worst, 2.0, 1e-6);
}

// Wrenches between what both sides of a vertex ask would hide that no force follows.
TEST_F(Stated, MotionsThatAskForJumpsOfForcesAreRefused) {
  Motion jerks = motion();
  jerks.stance_from.assign(5, 1);
  jerks.slopes.assign(5, Eigen::VectorXd::Zero(6));
  const double up = 0.01, share = 6.0 * up / (0.25 * 0.25) / 9.81;
  jerks.configurations[2][2] = up;
  jerks.wrenches = {{pressing(1.0)},
                    {pressing(1.0 + 0.5 * share)},
                    {pressing(1.0 - share)},
                    {pressing(1.0 + 0.5 * share)},
                    {pressing(1.0)}};
  expect_refused(jerks, 1, share / 0.05, "forces would have to jump by");
}

TEST(OutsideCones, AreThoseOfForcesAtTheCorners) {
  const EndEffector sole = {.half_x_m = 0.1, .half_y_m = 0.05, .friction = 0.5};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0.0, 1.0), angle(0.0, 2.0 * M_PI);
  for (int round = 0; round < 200; ++round) {
    // Forces at the corners, all in their cones or one of them pulling.
    Wrench inside = Wrench::Zero();
    for (const Eigen::Vector2d& corner : corners_of(sole, {})) {
      const double press = share(random), slide = 0.499 * press * share(random);
      const double way = angle(random);
      const Vector3d force(slide * std::cos(way), slide * std::sin(way), press);
      inside.head<3>() += force;
      inside.tail<3>() += Vector3d(corner.x(), corner.y(), 0.0).cross(force);
    }
    EXPECT_LT(outside_cones(sole, {}, inside, 1.0), 1e-8);
    Wrench outside = inside;
    outside[5] = 0.5 * inside[2] * std::hypot(0.1, 0.05) * 1.01 * (round % 2 == 0 ? 1.0 : -1.0);
    EXPECT_GT(outside_cones(sole, {}, outside, 1.0), 0.0);
  }
  EXPECT_NEAR(outside_cones(sole, {}, Wrench::Unit(2) * -0.2, 1.0), 0.2, 1e-9);
  // A line bears no moment about itself.
  Wrench tips = Wrench::Unit(2);
  tips[4] = 1e-3;
  const std::vector<Eigen::Vector2d> line = {{0.0, -0.05}, {0.0, 0.05}};
  EXPECT_GT(outside_cones(sole, line, tips, 1.0), 1.0);
  // It is known to a tenth of a millimetre where the line is.
  tips[4] = 0.99e-4;
  EXPECT_LT(outside_cones(sole, line, tips, 1.0), 1e-8);
  tips[4] = 1.01e-4;
  EXPECT_GT(outside_cones(sole, line, tips, 1.0), 1.0);
  const std::vector<Eigen::Vector2d> slanted = {{0.03, -0.04}, {0.07, 0.02}};
  Wrench beside = Wrench::Unit(2);
  beside.tail<3>() = Vector3d(0.05 + 5e-5, -0.01, 0.0).cross(Vector3d::UnitZ());
  EXPECT_LT(outside_cones(sole, slanted, beside, 1.0), 1e-8);
}

}  // namespace
}  // namespace locograph
