// Sequences of stances: on the tasks that come along, and on tasks that cannot be done.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/common/error.h>
#include <locograph/planners/offline/stance/stance_planners.h>

#include <atomic>
#include <limits>

#include "common/sanitized.h"
#include "planners/stance_tasks.h"

namespace locograph::stance_planner_test {
namespace {

using test::contact_of, test::stance_task;

/// A floor 50 m ahead.
const std::pair<std::string, std::string> kFarFloor = {
    "<plane name=\"arch_right\"",
    "<plane name=\"far\" center=\"51 0 0\" normal=\"0 0 1\" size=\"2 2\"/>"
    "<plane name=\"arch_right\""};

StancePlannerOptions at_most(int transitions, std::uint64_t seed = 0) {
  StancePlannerOptions options;
  options.seed = seed;
  options.max_transitions = transitions;
  return options;
}

StancePlan plan(const Task& task, const StancePlannerOptions& options) {
  return make_stance_planner("guided")->plan(task, options);
}

bool same_place(const Contact& a, const Contact& b, double within = 0.0) {
  return a.name() == b.name() && (a.position - b.position).norm() <= within &&
         (a.normal - b.normal).norm() <= within && a.forward.has_value() == b.forward.has_value() &&
         (!a.forward || (*a.forward - *b.forward).norm() <= within);
}

bool holds(const Stance& stance, const Contact& contact) {
  return std::ranges::any_of(stance.contacts,
                             [&](const Contact& own) { return same_place(own, contact); });
}

/// How many contacts of either stance the other one does not have.
int difference(const Stance& a, const Stance& b) {
  int count = 0;
  for (const Contact& contact : a.contacts) count += !holds(b, contact);
  for (const Contact& contact : b.contacts) count += !holds(a, contact);
  return count;
}

/// The same contacts, to rounding.
bool is_stance(const Stance& stance, const Stance& expected) {
  return stance.contacts.size() == expected.contacts.size() &&
         std::ranges::all_of(expected.contacts, [&](const Contact& wanted) {
           return std::ranges::any_of(
               stance.contacts, [&](const Contact& own) { return same_place(own, wanted, 1e-9); });
         });
}

void expect_judged_feasible(const Task& task, const StancePlan& plan) {
  const Judge judge(task.robot->robot, task.world);
  const CheckReport report = judge.check(stances_motion(plan), task.check);
  EXPECT_TRUE(report.feasible) << violation_text(report.worst());
}

bool names_an_end_effector(const Task& task, const std::string& text) {
  return std::ranges::any_of(task.end_effectors(), [&](const EndEffector& effector) {
    return text.find(effector.name) != std::string::npos;
  });
}

struct ShippedTask {
  std::string name;
  bool enforces_torque_limits;
  std::uint64_t seed;
};

class ShippedTasks : public testing::TestWithParam<ShippedTask> {};

TEST_P(ShippedTasks, ArePlannedOneContactAtATimeAndJudgedFeasible) {
  if (test::kSanitized && GetParam().name == "stepping_stones") {
    GTEST_SKIP() << "takes long there";
  }
  Task task = stance_task(GetParam().name);
  task.check.enforce_torque_limits = GetParam().enforces_torque_limits;
  const StancePlannerOptions options = at_most(3000, GetParam().seed);
  const StancePlan found = plan(task, options);
  ASSERT_TRUE(found.success()) << found.reason;
  EXPECT_EQ(found.goals_reached, static_cast<int>(task.goals.size()));
  EXPECT_TRUE(found.report.feasible);
  EXPECT_GE(found.statistics.transitions, found.statistics.transitions_found);
  EXPECT_GT(found.statistics.vertices_in_tree, 0);

  ASSERT_EQ(found.stances.size(), found.configurations.size());
  ASSERT_GT(found.stances.size(), 1U);
  EXPECT_TRUE(is_stance(found.stances.front(), task.start)) << "the start";
  EXPECT_EQ(found.configurations.front(), task.start_configuration);
  EXPECT_TRUE(is_stance(found.stances.back(), task.goals.back())) << "the goal";
  std::size_t next_goal = 0;
  for (std::size_t i = 1; i < found.stances.size(); ++i) {
    EXPECT_EQ(difference(found.stances[i - 1], found.stances[i]), 1) << "stance " << i;
    if (next_goal < task.goals.size() && is_stance(found.stances[i], task.goals[next_goal])) {
      ++next_goal;
    }
  }
  EXPECT_EQ(next_goal, task.goals.size()) << "goals passed in their order";
  expect_judged_feasible(task, found);

  if (test::kSanitized) return;
  const StancePlan again = plan(task, options);
  EXPECT_EQ(again.statistics.transitions, found.statistics.transitions);
  EXPECT_EQ(again.statistics.vertices_in_tree, found.statistics.vertices_in_tree);
  ASSERT_EQ(again.configurations.size(), found.configurations.size());
  for (std::size_t i = 0; i < found.configurations.size(); ++i) {
    EXPECT_EQ(again.configurations[i], found.configurations[i]) << "not the same bits: " << i;
    EXPECT_EQ(difference(again.stances[i], found.stances[i]), 0) << "stance " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, ShippedTasks,
                         testing::Values(ShippedTask{"quadrupedal_walking", true, 0},
                                         ShippedTask{"standing_up", true, 0},
                                         ShippedTask{"parallel_walls", false, 1},
                                         ShippedTask{"centauro_platform", true, 0},
                                         ShippedTask{"stepping_stones", true, 1}),
                         [](const auto& info) { return info.param.name; });

/// All fours of standing_up, with the left hand 50 m ahead.
Task out_of_reach() {
  Task task = stance_task("standing_up", {kFarFloor});
  task.goals = {task.start};
  contact_of(task.goals[0], "left_hand").position = {51.0, 0.1, 0.0};
  return task;
}

TEST(StancePlanner, AGoalOutOfReachIsAnswerNoWithWhatWasInTheWay) {
  const Task task = out_of_reach();
  const StancePlan found = plan(task, at_most(300));
  EXPECT_FALSE(found.success());
  EXPECT_EQ(found.goals_reached, 0);
  EXPECT_TRUE(names_an_end_effector(task, found.reason)) << found.reason;
  EXPECT_NE(found.reason.find("not reached: the transitions allowed are used up (allow more); "),
            std::string::npos)
      << found.reason;
  ASSERT_FALSE(found.failures.empty());
  for (std::size_t i = 1; i < found.failures.size(); ++i) {
    EXPECT_GE(found.failures[i - 1].count, found.failures[i].count);
  }
  // As far as it got: the start.
  ASSERT_EQ(found.stances.size(), 1U);
  ASSERT_EQ(found.configurations.size(), 1U);
  EXPECT_TRUE(is_stance(found.stances[0], task.start)) << "the start";
  EXPECT_EQ(found.best_contacts, 3);
  EXPECT_GE(found.best.contacts.size(), 3U);
  expect_judged_feasible(task, found);
}

TEST(StancePlanner, KeepsWhatLeadsToTheGoalsBeforeTheOneThatIsNotReached) {
  Task task = stance_task("standing_up", {kFarFloor});
  task.goals.push_back(out_of_reach().goals[0]);
  const StancePlan found = plan(task, at_most(300));
  EXPECT_FALSE(found.success());
  EXPECT_EQ(found.goals_reached, 1);
  EXPECT_NE(found.reason.find("goal 2 of 2"), std::string::npos) << found.reason;
  ASSERT_GT(found.stances.size(), 1U);
  ASSERT_EQ(found.stances.size(), found.configurations.size());
  EXPECT_TRUE(is_stance(found.stances.front(), task.start)) << "the start";
  EXPECT_TRUE(is_stance(found.stances.back(), task.goals[0])) << "the first goal";
  expect_judged_feasible(task, found);
}

// The judge refuses what torques forbid; the search goes on, but not for ever.
TEST(StancePlanner, TransitionsAreLimitedForAGoalHoweverOftenTheJudgeRefuses) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  const Task task = stance_task("parallel_walls");
  ASSERT_TRUE(task.check.enforce_torque_limits);
  StancePlannerOptions options = at_most(1000);
  // Of two goals, and what shortening and mending take.
  constexpr int kMost = 3000;
  int told = 0;
  std::atomic<bool> stop = false;  // so that a failure ends
  options.termination.stop = &stop;
  options.observe = [&](const TransitionAttempt&) { stop = ++told > kMost; };
  EXPECT_LE(plan(task, options).statistics.transitions, kMost);
  EXPECT_FALSE(stop);
}

TEST(StancePlanner, AGoalIsReachedWhereItIsNotWhereTheGridHasAPlaceNearby) {
  Task task = stance_task("standing_up");
  Stance higher = task.goals[0];
  Contact& hand = contact_of(higher, "right_hand");
  hand.position.z() += 0.05 + 4e-5;
  task.goals.push_back(higher);
  const StancePlan found = plan(task, at_most(3000));
  ASSERT_TRUE(found.success()) << found.reason;
  Stance last = found.stances.back();
  EXPECT_NEAR(contact_of(last, "right_hand").position.z(), hand.position.z(), 1e-9);
}

TEST(StancePlanner, TellsOfTheTransitionsItTriesAndPlansTheSame) {
  const Task task = stance_task("standing_up");
  StancePlannerOptions options = at_most(3000);
  int told = 0, told_found = 0;
  options.observe = [&](const TransitionAttempt& attempt) {
    ++told;
    told_found += attempt.found;
    EXPECT_EQ(difference(attempt.from, attempt.to), 1);
    EXPECT_EQ(attempt.start.size(), task.start_configuration.size());
    EXPECT_GE(attempt.restarts, 0);
    EXPECT_GT(attempt.waited_s, 0.0);
  };
  const StancePlan found = plan(task, options);
  ASSERT_TRUE(found.success()) << found.reason;
  EXPECT_GT(told_found, 0);
  // Not of those that mend what the judge refuses.
  EXPECT_LE(told, found.statistics.transitions);
  EXPECT_LE(told_found, found.statistics.transitions_found);
  const StancePlan unobserved = plan(task, at_most(3000));
  EXPECT_EQ(unobserved.statistics.transitions, found.statistics.transitions);
}

TEST(StancePlanner, KeepsTheTreeItTriedOnlyWhenAskedAndPlansTheSame) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const Task task = stance_task("standing_up");
  for (const std::string& name : stance_planner_names()) {
    StancePlannerOptions options = at_most(3000);
    const StancePlan without = make_stance_planner(name)->plan(task, options);
    EXPECT_TRUE(without.tree.empty()) << name;
    options.keep_tree = true;
    const StancePlan found = make_stance_planner(name)->plan(task, options);
    EXPECT_EQ(found.statistics.transitions, without.statistics.transitions) << name;
    ASSERT_FALSE(found.tree.empty()) << name;
    EXPECT_TRUE(is_stance(found.tree.front().stance, task.start)) << name;
    int count_found = 0, on_way = 0;
    for (std::size_t i = 0; i < found.tree.size(); ++i) {
      const StanceTreeNode& node = found.tree[i];
      ASSERT_LT(node.parent, static_cast<int>(i)) << name;
      ASSERT_GE(node.parent, -1) << name;
      count_found += node.found;
      on_way += node.on_way;
      if (node.parent < 0) continue;
      const StanceTreeNode& parent = found.tree[static_cast<std::size_t>(node.parent)];
      EXPECT_TRUE(parent.found) << name << ": what failed leads nowhere";
      // Lifted or put down; or, by `guided`, both in one move.
      EXPECT_GE(difference(parent.stance, node.stance), 1) << name;
      EXPECT_LE(difference(parent.stance, node.stance), 2) << name;
      EXPECT_TRUE(!node.on_way || (node.found && parent.on_way)) << name;
    }
    EXPECT_EQ(count_found, found.statistics.vertices_in_tree) << name;
    EXPECT_EQ(on_way > 0, found.goals_reached > 0) << name;
  }
}

TEST(StancePlanner, AGoalThatIsTheStartNeedsNothing) {
  Task task = stance_task("standing_up");
  task.goals = {task.start};
  const StancePlan found = plan(task, {});
  EXPECT_TRUE(found.success()) << found.reason;
  EXPECT_EQ(found.stances.size(), 1U);
  EXPECT_EQ(found.statistics.transitions, 0);
}

TEST(StancePlanner, AStartOnAFloorThatIsNotThereIsRefused) {
  const std::string floor =
      "<plane name=\"floor\" center=\"0 0 0\" normal=\"0 0 1\" forward=\"1 0 0\" size=\"5 2\"/>";
  try {
    stance_task("standing_up", {{floor, ""}});
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_GT(error.line(), 0);
    EXPECT_NE(std::string(error.what()).find("touches nothing"), std::string::npos) << error.what();
  }
  // Taken away afterwards, the judge finds it out.
  Task task = stance_task("standing_up");
  World world = task.world->world();
  std::erase_if(world.surfaces, [](const Surface& one) { return one.name == "floor"; });
  task.world = std::make_shared<const WorldSnapshot>(std::move(world));
  const StancePlan found = plan(task, at_most(300));
  EXPECT_FALSE(found.success());
  EXPECT_FALSE(found.reason.empty());
}

TEST(StancePlanner, EndsWhenItIsToldTo) {
  const Task task = stance_task("standing_up");
  const std::atomic<bool> stop = true;
  StancePlannerOptions stopped, late;
  stopped.termination.stop = &stop;
  late.termination.deadline = Deadline::after(0.0);
  for (const StancePlannerOptions& options : {stopped, late}) {
    const StancePlan found = plan(task, options);
    EXPECT_FALSE(found.success());
    EXPECT_FALSE(found.reason.empty());
    EXPECT_EQ(found.statistics.transitions, 0);
    ASSERT_EQ(found.stances.size(), 1U);
    EXPECT_TRUE(is_stance(found.stances[0], task.start)) << "the start";
  }
}

TEST(StancePlanner, RefusesNamesGoalsAndOptionsThatMakeNoSense) {
  for (const std::string& name : stance_planner_names()) {
    EXPECT_EQ(make_stance_planner(name)->name(), name);
  }
  try {
    make_stance_planner("guidd");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("guidd"), std::string::npos) << error.what();
  }

  const Task task = stance_task("standing_up");
  Task unknown = task;
  contact_of(unknown.goals[0], "left_hand").effector.name = "third_hand";
  EXPECT_THROW(plan(unknown, {}), Error);
  Task empty = task;
  empty.goals = {Stance{}};
  EXPECT_THROW(plan(empty, {}), Error);

  const auto refused = [&](auto&& spoil, const std::string& option) {
    StancePlannerOptions options;
    spoil(options);
    try {
      plan(task, options);
      ADD_FAILURE() << "accepted: " << option;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(option), std::string::npos) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& o) { o.grid_m = 0.0; }, "grid_m");
  refused([&](auto& o) { o.grid_m = nan; }, "grid_m");
  refused([](auto& o) { o.reach = -0.5; }, "reach");
  refused([&](auto& o) { o.reach = nan; }, "reach");
  refused([](auto& o) { o.max_transitions = -1; }, "max_transitions");
  refused([](auto& o) { o.threads = 0; }, "threads");
}

}  // namespace
}  // namespace locograph::stance_planner_test
