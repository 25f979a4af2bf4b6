// Goals that no posture holds are told at once, and what to move.
#include <gtest/gtest.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/posture/posture_solver.h>

#include "common/sanitized.h"
#include "planners/stance_tasks.h"

namespace locograph {
namespace {

/// By another solver of the same robot than the one that was asked.
bool posture_holds(const Task& task, const Stance& stance) {
  const PostureSolver solver(task.robot, task.world->world());
  const PostureProblem problem{
      .stance = stance, .preferred = placed_at(solver.robot(), task.start_configuration, stance)};
  PostureOptions options;
  options.check = task.check;
  options.max_restarts = 60;
  return solver.solve(problem, options).success();
}

void expect_told(Task task, const std::string& contact, const Eigen::Vector3d& far_away_m,
                 double most_m) {
  SCOPED_TRACE(contact);
  Stance& goal = task.goals.back();
  test::contact_of(goal, contact).position += far_away_m;
  const auto unheld = unheld_goal(task);
  ASSERT_TRUE(unheld);
  EXPECT_EQ(unheld->goal, 0);
  EXPECT_EQ(unheld->text.rfind("no posture is found that holds the goal (", 0), 0u);
  ASSERT_FALSE(unheld->contact.empty()) << unheld->text;
  EXPECT_LE(unheld->move_m.norm(), most_m);
  EXPECT_FALSE(posture_holds(task, goal));
  test::contact_of(goal, unheld->contact).position += unheld->move_m;
  EXPECT_FALSE(unheld_goal(task));
  EXPECT_TRUE(posture_holds(task, goal)) << unheld->text;
}

TEST(UnheldGoal, IsToldWithTheContactToMove) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const Task task = test::stance_task("standing_up");
  EXPECT_FALSE(unheld_goal(task));
  expect_told(task, "left_hand", {0.0, 0.0, 1.8}, 1.0);
  expect_told(task, "right_hand", {0.0, -0.65, 1.3}, 0.6);
  expect_told(task, "left_foot", {-1.3, 0.0, 0.0}, 0.3);
}

TEST(UnheldGoal, IsToldAsNumberOne) {
  Task task = test::stance_task("parallel_walls");
  ASSERT_EQ(task.goals.size(), 2u);
  for (const char* hand : {"left_hand", "right_hand"}) {
    test::contact_of(task.goals[1], hand).position.z() += 5.0;
  }
  const auto unheld = unheld_goal(task);
  ASSERT_TRUE(unheld);
  EXPECT_EQ(unheld->goal, 1);
  EXPECT_TRUE(unheld->contact.empty()) << "both hands would have to be moved";
  EXPECT_NE(unheld->text.find("goal 2 of 2"), std::string::npos) << unheld->text;
}

TEST(UnheldGoal, IsNotToldWhenTheTimeIsUsedUp) {
  Task task = test::stance_task("standing_up");
  test::contact_of(task.goals.back(), "left_hand").position.z() += 1.8;
  EXPECT_FALSE(unheld_goal(task, Deadline::after(0.0)));
}

}  // namespace
}  // namespace locograph
