// Plan time, loads, and contacts that are early, late or lost.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/execution/motion_player.h>

#include "execution/standing_coman.h"

namespace locograph::test {
namespace {

/// Both feet, the left one alone, both again; it stands half a second before the right foot opens
/// and after it closed.
class Step : public testing::Test {
 protected:
  StandingComan coman;
  const PlayerOptions options = {.settle_s = 0.1, .end_s = 0.2};
  std::vector<TouchMeasurement> measured = std::vector<TouchMeasurement>(2, {.pressing_N = 300.0});

  Motion step() const {
    const Eigen::VectorXd& q = coman.configuration;
    Eigen::VectorXd lifted = q;
    lifted[coman.robot.base_configuration_size()] += 0.1;
    return {.time_s = {0.0, 0.5, 1.0, 1.5, 2.0},
            .configurations = {q, q, lifted, q, q},
            .stances = {coman.both_feet(), coman.left_foot()},
            .stance_from = {0, 1, 1, 0, 0}};
  }
  /// Until plan time is this.
  void play(MotionPlayer& player, double until_s) {
    for (int i = 0; i < 20000 && player.plan_time_s() < until_s && !player.done(); ++i) {
      player.advance(measured);
    }
  }
};

TEST_F(Step, AContactIsUnloadedBeforeItOpensAndLoadedAfterItCloses) {
  MotionPlayer player(coman.robot, coman.effectors, coman.world, step(), options);
  EXPECT_EQ(player.contacts()[1].share, 1.0);
  play(player, 0.25);
  EXPECT_NEAR(player.contacts()[1].share, 0.5, 0.05);
  play(player, 0.499);
  EXPECT_LT(player.contacts()[1].share, 0.01);
  EXPECT_EQ(player.contacts()[0].share, 1.0);
  measured[1].pressing_N = 0.0;
  play(player, 1.0);
  EXPECT_EQ(player.contacts()[1].held, nullptr);
  EXPECT_EQ(player.stance(), 1);
  play(player, 1.499);
  measured[1].pressing_N = 300.0;
  play(player, 1.51);
  ASSERT_NE(player.contacts()[1].held, nullptr);
  EXPECT_LT(player.contacts()[1].share, 0.05);
  while (!player.done()) player.advance(measured);
  EXPECT_TRUE(player.at_end());
  EXPECT_EQ(player.contacts()[1].share, 1.0);
  EXPECT_EQ(player.plan_time_s(), 2.0);
}

TEST_F(Step, ALateContactIsWaitedForAndThenGivenUp) {
  MotionPlayer player(coman.robot, coman.effectors, coman.world, step(), options);
  play(player, 0.6);
  measured[1].pressing_N = 0.0;
  play(player, 1.49);
  for (int i = 0; i < 600; ++i) player.advance(measured);
  EXPECT_NEAR(player.plan_time_s(), 1.5, 0.002);
  EXPECT_FALSE(player.contacts()[1].touches);
  EXPECT_NE(player.contacts()[1].held, nullptr);
  EXPECT_TRUE(player.halted().empty());
  for (int i = 0; i < 1000; ++i) player.advance(measured);
  EXPECT_EQ(player.halted(), "right_foot finds no contact");
  EXPECT_TRUE(player.done());
  EXPECT_FALSE(player.at_end());
}

TEST_F(Step, AnEarlyContactIsTakenOnceItWasInTheAir) {
  MotionPlayer player(coman.robot, coman.effectors, coman.world, step(), options);
  play(player, 1.3);
  EXPECT_EQ(player.contacts()[1].held, nullptr) << "it never left the ground";
  MotionPlayer lifting(coman.robot, coman.effectors, coman.world, step(), options);
  play(lifting, 0.6);
  measured[1].pressing_N = 0.0;
  play(lifting, 1.3);
  measured[1].pressing_N = 50.0;
  play(lifting, 1.35);
  EXPECT_NE(lifting.contacts()[1].held, nullptr);
}

TEST_F(Step, PlanTimeStopsWhereAContactIsLostAndGoesOnWhereItIsBack) {
  MotionPlayer player(coman.robot, coman.effectors, coman.world, step(), options);
  play(player, 0.8);
  EXPECT_GT(player.reference().velocity.norm(), 0.0);
  measured[0].pressing_N = 0.0;
  for (int i = 0; i < 500; ++i) player.advance(measured);
  const double stopped_s = player.plan_time_s();
  EXPECT_LT(stopped_s, 1.1);
  EXPECT_EQ(player.reference().velocity.norm(), 0.0);
  measured[0].pressing_N = 300.0;
  for (int i = 0; i < 500; ++i) player.advance(measured);
  EXPECT_GT(player.plan_time_s(), stopped_s + 0.1);
}

TEST_F(Step, AContactThatSlipsIsGivenUp) {
  MotionPlayer player(coman.robot, coman.effectors, coman.world, step(), options);
  play(player, 0.2);
  measured[0].slip_m = 0.05;
  player.advance(measured);
  EXPECT_EQ(player.halted(), "left_foot slips");
  EXPECT_EQ(player.contacts()[0].held, nullptr);
}

TEST_F(Step, GoesOnAlongAnotherMotion) {
  const std::vector<Eigen::VectorXd> stops(5, Eigen::VectorXd::Zero(coman.robot.tangent_size()));
  Motion first = step();
  first.slopes = stops;
  MotionPlayer player(coman.robot, coman.effectors, coman.world, first, options);
  play(player, 0.7);
  const HeldContact* left = player.contacts()[0].held;
  const Eigen::VectorXd before = player.reference().configuration;
  Motion higher = first;
  higher.configurations[3][coman.robot.base_configuration_size()] += 0.05;
  player.follow(coman.world, higher);
  player.advance(measured);
  EXPECT_LT((player.reference().configuration - before).norm(), 1e-3) << "no jump";
  EXPECT_EQ(player.contacts()[0].held, left) << "the same contact";
  play(player, 1.4999);
  EXPECT_NEAR((player.reference().configuration - higher.configurations[3]).norm(), 0.0, 1e-3);
}

TEST_F(Step, HoldsWhatAnotherMotionHolds) {
  Motion first = step();
  first.stances = {coman.both_feet(), coman.left_foot(), coman.both_feet()};
  first.stance_from = {0, 1, 1, 2, 2};
  MotionPlayer player(coman.robot, coman.effectors, coman.world, first, options);
  play(player, 0.7);
  const HeldContact* left = player.contacts()[0].held;
  Motion other = first;
  other.stances[2].contacts[1].position.x() += 0.01;
  player.follow(coman.world, other);
  player.advance(measured);
  EXPECT_EQ(player.contacts()[0].held, left);
  play(player, 1.51);
  ASSERT_NE(player.contacts()[1].held, nullptr);
  EXPECT_EQ(player.contacts()[1].held->contact().position, other.stances[2].contacts[1].position);
}

TEST_F(Step, StopsWhereAnotherMotionEnds) {
  MotionPlayer player(coman.robot, coman.effectors, coman.world, step(), options);
  play(player, 0.7);
  Motion shorter = step();
  const auto cut = [&shorter](std::size_t size) {
    shorter.time_s.resize(size);
    shorter.configurations.resize(size);
    shorter.stance_from.resize(size);
  };
  cut(3);
  player.follow(coman.world, shorter);
  while (!player.done()) player.advance(measured);
  EXPECT_TRUE(player.at_end());
  EXPECT_EQ(player.plan_time_s(), 1.0);
  MotionPlayer late(coman.robot, coman.effectors, coman.world, step(), options);
  play(late, 0.7);
  cut(2);
  EXPECT_THROW(late.follow(coman.world, shorter), Error) << "it is beyond that";
}

TEST_F(Step, SlowsDownBeforeAnEndAtWhichTheMotionDoesNotRest) {
  Motion moving = step();
  moving.stance_from = {1, 1, 1, 1, 1};
  moving.slopes.resize(5);
  moving.slopes[4] = Eigen::VectorXd::Zero(coman.robot.tangent_size());
  moving.slopes[4][coman.robot.base_tangent_size()] = 0.3;
  MotionPlayer player(coman.robot, coman.effectors, coman.world, moving, options);
  double fastest = 0.0;
  while (!player.done()) {
    const double before = player.reference().velocity.norm();
    player.advance(measured);
    if (player.plan_time_s() > 1.6) {
      fastest = std::max(fastest, std::abs(player.reference().velocity.norm() - before));
    }
  }
  EXPECT_TRUE(player.at_end());
  EXPECT_EQ(player.reference().velocity.norm(), 0.0);
  EXPECT_LT(fastest, 0.02) << "it does not stop at once";
}

TEST_F(Step, WhereAPlanHasNoTimeToLoadItIsGivenSome) {
  Motion motion = step();
  motion.configurations[1] = motion.configurations[2];  // moves until the change
  motion.configurations[3] = motion.configurations[2];
  MotionPlayer player(coman.robot, coman.effectors, coman.world, motion, options);
  play(player, 0.4999);
  for (int i = 0; i < 100; ++i) player.advance(measured);
  EXPECT_NEAR(player.plan_time_s(), 0.5, 1e-9);
  EXPECT_LT(player.contacts()[1].share, 1.0);
  EXPECT_GT(player.contacts()[1].share, 0.0);
}

}  // namespace
}  // namespace locograph::test
