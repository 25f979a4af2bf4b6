// How far from falling a motion is: what is known in closed form, by stance, and that nothing else
// depends on it.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>

#include <cmath>
#include <numbers>

#include "check/centauro_on_wheels.h"
#include "check/coman_plus_standing.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

constexpr double kBlock_N = 98.1, kBisected = 1.0 / 1024.0;

/// A block of 10 kg whose centre of mass is 0.4 m high, on a sole and, where it has more, on
/// another one that is wider.
class Falling : public ::testing::Test {
 protected:
  explicit Falling(double x = 0.03)
      : robot_(std::make_shared<const Robot>(Robot::load(folder_.write(
            "block.urdf", "<robot name='block'><link name='block'><inertial><origin xyz='" +
                              std::to_string(x) +
                              " 0 0.4'/><mass value='10'/><inertia ixx='1' ixy='0' ixz='0' "
                              "iyy='1' iyz='0' izz='1'/></inertial></link></robot>")))) {}

  static Contact sole(double half_y = 0.02) {
    return {.effector = {.name = half_y > 0.02 ? "wide" : "narrow",
                         .link = "block",
                         .half_x_m = 0.05,
                         .half_y_m = half_y,
                         .friction = 0.5,
                         .max_force_N = 120.0},
            .forward = Eigen::Vector3d::UnitX()};
  }
  CheckReport check(const Motion& motion) const {
    World world;
    world.surfaces = {ground()};
    CheckOptions options;
    options.robustness = true;
    return Judge(robot_, world).check(motion, options);
  }
  Motion standing(const std::vector<Contact>& contacts) const {
    Motion motion;
    for (const Contact& contact : contacts) motion.stances.push_back({{contact}});
    for (std::size_t i = 0; i <= contacts.size(); ++i) {
      motion.time_s.push_back(double(i));
      motion.configurations.push_back(robot_->neutral_configuration());
      motion.stance_from.push_back(int(std::min(i, contacts.size() - 1)));
    }
    return motion;
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<const Robot> robot_;
};

TEST_F(Falling, IsToldByTheLeastChangeThatDoesNotHold) {
  const CheckReport report = check(standing({sole()}));
  ASSERT_TRUE(report.robustness);
  const Robustness& least = report.robustness->least;
  EXPECT_NEAR(least.area.value(), 0.4, kBisected);  // of 0.05 m, 0.03 are needed
  EXPECT_NEAR(least.push_N.value(), 0.02 / 0.4 * kBlock_N, kBisected * kBlock_N);
  EXPECT_NEAR(least.mass.value(), 120.0 / kBlock_N - 1.0, kBisected);
  EXPECT_NEAR(least.friction.value(), 0.999, kBisected);  // it stands on the level
  EXPECT_FALSE(least.torque) << "it has no joints";
}

TEST_F(Falling, FrictionIsWhatASlopeNeeds) {
  Motion motion = standing({sole()});
  const double slope = 0.1;
  const Eigen::AngleAxisd tilted(slope, Eigen::Vector3d::UnitX());
  for (Eigen::VectorXd& q : motion.configurations)
    q.segment<4>(3) = Eigen::Quaterniond(tilted).coeffs();
  Contact& contact = motion.stances[0].contacts[0];
  contact.effector.half_y_m = 0.1;
  contact.normal = tilted * Eigen::Vector3d::UnitZ();
  World world;
  world.surfaces = {ground()};
  world.surfaces[0].world_from_surface.linear() = tilted.toRotationMatrix();
  CheckOptions options;
  options.robustness = true;
  const CheckReport report = Judge(robot_, world).check(motion, options);
  const double pyramid = 0.5 * std::cos(std::numbers::pi / 16.0);
  EXPECT_NEAR(report.robustness->least.friction.value(), 1.0 - std::tan(slope) / pyramid,
              2.0 * kBisected);
}

TEST_F(Falling, IsToldByStanceAndTheLeastOfAll) {
  const CheckReport report = check(standing({sole(), sole(0.06)}));
  const RobustnessReport& all = report.robustness.value();
  ASSERT_EQ(all.by_stance.size(), 2u);
  EXPECT_EQ(all.by_stance[0].first_vertex, 0);
  EXPECT_EQ(all.by_stance[0].last_vertex, 1);
  EXPECT_EQ(all.by_stance[1].from_s, 1.0);
  EXPECT_EQ(all.by_stance[1].until_s, 2.0);
  // Along x there are 0.02 m on one side.
  EXPECT_NEAR(all.by_stance[1].least.push_N.value(), 0.02 / 0.4 * kBlock_N, kBisected * kBlock_N);
  EXPECT_EQ(all.least.push_N.value(),
            std::min(all.by_stance[0].least.push_N, all.by_stance[1].least.push_N).value());
  EXPECT_EQ(all.by_stance[0].stance, 0);
  EXPECT_EQ(all.by_stance[1].stance, 1);
}

TEST_F(Falling, WhatDoesNotHoldHasNothingLeft) {
  Motion motion = standing({sole()});
  motion.stances[0].contacts[0].effector.half_x_m = 0.02;
  const CheckReport report = check(motion);
  EXPECT_FALSE(report.feasible);
  const Robustness& least = report.robustness->least;
  for (const std::optional<double>& share : {least.friction, least.area, least.push_N, least.mass})
    EXPECT_EQ(share.value(), 0.0);
}

/// Its centre of mass is beyond the sole, over whose middle mass is added.
class FallingToTheSide : public Falling {
 protected:
  FallingToTheSide() : Falling(0.06) {}
};

TEST_F(FallingToTheSide, MassThatWouldBalanceItIsNoneThatItBears) {
  Motion motion = standing({sole()});
  motion.stances[0].contacts[0].effector.max_force_N = 1000.0;
  const CheckReport report = check(motion);
  EXPECT_FALSE(report.feasible);
  EXPECT_EQ(report.robustness->least.mass.value(), 0.0);
}

TEST(Robustness, ChangesNothingElseAndDependsOnNoThreads) {
  const Motion motion = test::standing().motion(5);
  const CheckReport plain = test::standing().check(motion);
  EXPECT_FALSE(plain.robustness);
  CheckOptions options;
  options.robustness = true;
  const CheckReport one = test::standing().check(motion, options);
  options.threads = 3;
  const CheckReport many = test::standing().check(motion, options);
  EXPECT_EQ(one.feasible, plain.feasible);
  EXPECT_EQ(one.min_balance_margin, plain.min_balance_margin);
  const Robustness &a = one.robustness->least, &b = many.robustness->least;
  for (const auto share : {&Robustness::friction, &Robustness::area, &Robustness::torque,
                           &Robustness::push_N, &Robustness::mass}) {
    EXPECT_EQ(a.*share, b.*share);
    EXPECT_GT((a.*share).value(), 0.0);
  }
  // The torques that stand are a share of what there is, by the programme of the check itself.
  EXPECT_NEAR(a.torque.value(), 1.0 - plain.max_torque_ratio.value(), 2.0 * kBisected);
}

}  // namespace
}  // namespace locograph
