// Where a whole plan begins, and the goals that it gets to.
#include <gtest/gtest.h>
#include <locograph/check/plan_ends.h>

#include <cmath>

namespace locograph::plan_ends_test {
namespace {

Contact at(const std::string& name, double x) {
  return {
      .effector = {.name = name}, .position = {x, 0.0, 0.0}, .forward = Eigen::Vector3d::UnitX()};
}

const Stance kStart{{at("left", 0.0), at("right", 0.0)}};
const Stance kStep{{at("left", 0.0)}};
const Stance kMiddle{{at("left", 0.0), at("right", 0.5)}};
const Stance kEnd{{at("left", 0.5), at("right", 0.5)}};

Motion motion_of(std::vector<Stance> stances) {
  Motion motion;
  motion.stances = std::move(stances);
  for (std::size_t i = 0; i < motion.stances.size(); ++i) {
    motion.time_s.push_back(static_cast<double>(i));
    motion.configurations.push_back(Eigen::VectorXd::Zero(7));
    motion.stance_from.push_back(static_cast<int>(i));
  }
  return motion;
}

const PlannedTask kTask{.start = {.stance = kStart},
                        .goals = {{.stance = kMiddle}, {.stance = kEnd}}};

PlanEnds ends_of(std::vector<Stance> stances) {
  return plan_ends(motion_of(std::move(stances)), kTask);
}

Contact turned(Contact contact, double yaw) {
  contact.forward = Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0);
  return contact;
}

TEST(PlanEnds, GoalsAreReachedInTheirOrderAndTheLastOneIsTheEnd) {
  const PlanEnds all = ends_of({kStart, kStep, kMiddle, kEnd});
  EXPECT_TRUE(all.starts());
  EXPECT_EQ(all.goals_reached, 2);
  EXPECT_EQ(all.goals, 2);
  EXPECT_EQ(ends_of({kStart, kStep, kMiddle}).goals_reached, 1);
  EXPECT_EQ(ends_of({kStart, kStep, kEnd}).goals_reached, 0) << "the first one is left out";
  EXPECT_EQ(ends_of({kStart, kEnd, kMiddle}).goals_reached, 1) << "the wrong way round";
  EXPECT_EQ(ends_of({kStart, kMiddle, kEnd, kStep}).goals_reached, 1) << "it goes on";
  EXPECT_FALSE(ends_of({kMiddle, kEnd}).starts());
}

TEST(PlanEnds, AStanceHasAllTheContactsAndNoOthers) {
  EXPECT_EQ(ends_of({kStep, kStart}).off_start, "right does not touch");
  Stance more = kStart;
  more.contacts.push_back(at("hand", 1.0));
  EXPECT_EQ(ends_of({more}).off_start, "something else touches");
  Motion unknown = motion_of({kStart, kMiddle, kEnd});
  unknown.stance_from = {-1, 1, 2};
  EXPECT_FALSE(plan_ends(unknown, kTask).starts());
  EXPECT_EQ(plan_ends(unknown, kTask).goals_reached, 2);
  unknown.stance_from.clear();
  EXPECT_EQ(plan_ends(unknown, kTask).goals_reached, 0);
}

TEST(PlanEnds, ContactsMayBeOffAsMuchAsAContactMayBeOpen) {
  const auto off = [](Contact right) { return ends_of({Stance{{kStart.contacts[0], right}}}); };
  EXPECT_TRUE(off(at("right", 0.9e-4)).starts());
  EXPECT_EQ(off(at("right", 0.2)).off_start, "right is 0.2 m and 0 rad away");
  EXPECT_FALSE(off(at("right", 1.1e-4)).starts());
  EXPECT_TRUE(off(turned(at("right", 0.0), 0.9e-3)).starts());
  EXPECT_FALSE(off(turned(at("right", 0.0), 1.1e-3)).starts());
  Contact free = at("right", 0.0);
  free.forward.reset();
  EXPECT_FALSE(off(free).starts()) << "its yaw may be any";
  Contact tilted = at("right", 0.0);
  tilted.normal = {0.0, std::sin(0.01), std::cos(0.01)};
  EXPECT_FALSE(off(tilted).starts());
}

TEST(PlanEnds, OnlyDirectionsThatAKindHoldsCount) {
  const auto starts = [](const Contact& contact, const Contact& asked) {
    return plan_ends(motion_of({Stance{{contact}}}), {.start = {.stance = {{asked}}}, .goals = {}})
        .starts();
  };
  Contact asked = at("hand", 0.0);
  asked.forward.reset();
  EXPECT_TRUE(starts(turned(at("hand", 0.0), 1.0), asked)) << "a sole whose yaw is free";
  asked = at("hand", 0.0);
  asked.effector.kind = ContactKind::kGrasp;
  Contact round = asked;
  round.normal = Eigen::Vector3d::UnitX();
  round.forward = -Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(starts(round, asked)) << "turned round its bar";
  EXPECT_FALSE(starts(turned(asked, 0.1), asked)) << "along another bar";
}

TEST(PlanEnds, AWheelThatMayRollIsNowhere) {
  Contact wheel = at("wheel", 0.0);
  wheel.effector.kind = ContactKind::kWheel;
  const PlannedTask task{.start = {.stance = {{wheel}}}, .goals = {}};
  Motion motion = motion_of({Stance{{wheel}}});
  EXPECT_EQ(plan_ends(motion, task).off_start, "wheel is not locked and may be elsewhere");
  motion.stances_only = true;
  EXPECT_TRUE(plan_ends(motion, task).starts()) << "all wheels stand still";
  motion.stances_only = false;
  motion.stances[0].contacts[0].locked = true;
  EXPECT_TRUE(plan_ends(motion, task).starts());
}

TEST(PlanEnds, ADriveBeginsAndEndsWhereItsBaseIs) {
  const PlannedTask drive{
      .start = {}, .goals = {{.base = {2.0, 1.0, 3.1}, .within_m = 0.25, .within_rad = 0.25}}};
  Motion motion = motion_of({kStart, kStart});
  motion.configurations[0][6] = 1.0;
  motion.configurations[1] << 2.2, 1.1, 0.7, 0.0, 0.0, 1.0, 0.0;  // heading pi
  EXPECT_TRUE(plan_ends(motion, drive).starts());
  EXPECT_EQ(plan_ends(motion, drive).goals_reached, 1);
  motion.configurations[1][0] = 2.3;
  EXPECT_EQ(plan_ends(motion, drive).goals_reached, 0);
  motion.configurations[1] << 2.2, 1.1, 0.7, 0.0, 0.0, 0.0, 1.0;
  EXPECT_EQ(plan_ends(motion, drive).goals_reached, 0);
  motion.configurations[0][1] = 1e-3;
  EXPECT_FALSE(plan_ends(motion, drive).starts());
  motion.configurations[0][1] = std::nan("");
  EXPECT_FALSE(plan_ends(motion, drive).starts());
}

TEST(PlanEnds, ADriveRoundACircleIsNoRest) {
  const auto heading = [](double angle) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
    q[5] = std::sin(0.5 * angle);
    q[6] = std::cos(0.5 * angle);
    return q;
  };
  const PlannedTask round{
      .start = {},
      .goals = {{.base = {0.0, 0.0, 2.0 * M_PI}, .within_m = 0.25, .within_rad = 0.25}}};
  Motion motion = motion_of({kStart, kStart, kStart, kStart, kStart});
  for (std::size_t i = 0; i < 5; ++i) motion.configurations[i] = heading(0.0);
  EXPECT_EQ(plan_ends(motion, round).goals_reached, 0);
  EXPECT_EQ(plan_ends(motion, round).off_goal, "the base is 0 m and 6.28 rad away");
  for (int i = 0; i < 5; ++i) {
    motion.configurations[static_cast<std::size_t>(i)] = heading(0.5 * M_PI * i);
  }
  EXPECT_EQ(plan_ends(motion, round).goals_reached, 1);
  for (int i = 0; i < 5; ++i) {
    motion.configurations[static_cast<std::size_t>(i)] = heading(-0.5 * M_PI * i);
  }
  EXPECT_EQ(plan_ends(motion, round).goals_reached, 0) << "the wrong way round";
}

TEST(PlanEnds, AreConstraintsThatAreJudgedOrSayWhyNot) {
  const Motion motion = motion_of({kMiddle, kStart});
  const PlanEnds ends = plan_ends(motion, kTask);
  const std::vector<Violation> judged = end_violations(motion, ends, "", "");
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_EQ(judged[0].constraint, "scenario_start");
  EXPECT_TRUE(judged[0].violated);
  EXPECT_EQ(judged[1].constraint, "scenario_goals");
  EXPECT_EQ(judged[1].worst, 1.0);
  EXPECT_EQ(judged[1].at_vertex, 1);
  EXPECT_EQ(judged[1].what, "goal 2 of 2: left is 0.5 m and 0 rad away");
  for (const Violation& told : end_violations(motion, ends, "no scenario", "no scenario")) {
    EXPECT_FALSE(told.judged);
    EXPECT_FALSE(told.violated);
    EXPECT_EQ(told.count, 0);
    EXPECT_EQ(told.why_not, "no scenario");
  }
  const std::vector<Violation> part = end_violations(motion, ends, "", "it is incomplete");
  EXPECT_TRUE(part[0].violated);
  EXPECT_FALSE(part[1].judged);
}

}  // namespace
}  // namespace locograph::plan_ends_test
