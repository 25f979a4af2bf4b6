// One value says what has to hold, to planners and to the judge.
#include <locograph/planners/task/task.h>

#include "planners/planned_drive.h"

namespace locograph::task_test {
namespace {

void expect_same(const CheckReport& a, const CheckReport& b) {
  EXPECT_EQ(a.feasible, b.feasible);
  EXPECT_EQ(a.samples, b.samples);
  ASSERT_EQ(a.violations.size(), b.violations.size());
  for (std::size_t i = 0; i < a.violations.size(); ++i) {
    EXPECT_EQ(a.violations[i].constraint, b.violations[i].constraint);
    EXPECT_EQ(a.violations[i].worst, b.violations[i].worst) << a.violations[i].constraint;
    EXPECT_EQ(a.violations[i].judged, b.violations[i].judged) << a.violations[i].constraint;
  }
}

TEST(Task, AsksTheJudgeForWhatTheScenarioSays) {
  Scenario scenario = centauro_drive();
  scenario.limits = {
      .base_linear_m_s = 0.5, .base_angular_rad_s = 1.0, .joint_acceleration_rad_s2 = 10.0};
  scenario.enforce_torque_limits = false;
  scenario.effort_scale = 2.0;
  const Task task = task_of(scenario);
  EXPECT_EQ(task.scenario, "centauro_drive");
  EXPECT_EQ(task.check.base_linear_m_s, 0.5);
  EXPECT_EQ(task.check.base_angular_rad_s, 1.0);
  EXPECT_EQ(task.check.joint_acceleration_rad_s2, 10.0);
  EXPECT_FALSE(task.check.enforce_torque_limits);
  EXPECT_EQ(task.check.effort_scale, 2.0);
  ASSERT_EQ(task.end_effectors().size(), 4U);
  EXPECT_EQ(task.end_effectors()[3].name, "wheel_4");
  EXPECT_EQ(task.world->world().surfaces.size(), 1U);
  EXPECT_EQ(task.ground_z_m, 0.0);
  ASSERT_TRUE(task.drive);
  EXPECT_TRUE(task.start.contacts.empty());
}

TEST(Task, JudgesAMotionAsItsPlanIsJudged) {
  const DataFolder data;
  const auto task = std::make_shared<const Task>(task_of(centauro_drive()));
  const Motion motion = plan_wheeled_drive(*task).motion;
  const Graph graph = drive_graph(*task, motion).value();
  const Plan plan = plan_of(graph);
  const CheckReport of_plan =
      judged(graph, plan, judging_of(graph, plan, {.data_folder = data.path()}));
  expect_same(judged(motion, judging_of(task), {}).value(), of_plan);
  // Known already: it is not looked for.
  const Judging known =
      judging_of(graph, plan, {.task = task, .data_folder = data.path() / "nowhere"});
  EXPECT_EQ(known.task, task);
  expect_same(judged(graph, plan, known), of_plan);
  EXPECT_TRUE(of_plan.feasible) << violation_text(of_plan.worst());
  EXPECT_EQ(missed_goals(motion, known), "");
}

TEST(Task, TellsThatAMotionEndsBeforeItsGoal) {
  const auto task = std::make_shared<const Task>(task_of(centauro_drive()));
  Motion motion = plan_wheeled_drive(*task).motion;
  const std::size_t half = motion.configurations.size() / 2;
  motion.time_s.resize(half);
  motion.configurations.resize(half);
  motion.stance_from.resize(half);
  const std::string why = missed_goals(motion, judging_of(task));
  EXPECT_TRUE(why.starts_with("the plan does not reach goal 1 of 1: the base")) << why;
}

}  // namespace
}  // namespace locograph::task_test
