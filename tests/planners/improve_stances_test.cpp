// Plans that get better while there is time. scripts/test.sh runs this under ThreadSanitizer, too.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/common/error.h>
#include <locograph/planners/offline/stance/improve_stances.h>
#include <locograph/planners/offline/stance/stance_planners.h>

#include "common/sanitized.h"
#include "planners/stance_tasks.h"

namespace locograph::improve_stances_test {
namespace {

TEST(ImproveStances, FindsPlansWithNoMoreStancesOnTwoThreadsAndTheJudgeAccepts) {
  const Task task = test::stance_task("quadrupedal_walking");
  const auto planner = make_stance_planner("guided");
  StancePlannerOptions options;
  StancePlan plan = planner->plan(task, options);
  ASSERT_TRUE(plan.success()) << plan.reason;
  const std::size_t stances = plan.stances.size();
  const int transitions = plan.statistics.transitions;
  options.termination.deadline = Deadline::after(test::kSanitized ? 0.1 : 1.5);
  const int better = improve_stances(*planner, task, options, 2, plan);
  EXPECT_TRUE(plan.success());
  EXPECT_LE(plan.stances.size(), stances);
  EXPECT_EQ(plan.stances.size(), plan.configurations.size());
  EXPECT_GE(plan.statistics.transitions, transitions) << "of all plans together";
  EXPECT_TRUE(better > 0 || plan.stances.size() == stances);
  const CheckReport report =
      Judge(task.robot->robot, task.world).check(stances_motion(plan), task.check);
  EXPECT_TRUE(report.feasible) << violation_text(report.worst());
}

TEST(ImproveStances, LeavesAloneWhatDidNotSucceedAndNeedsAnEnd) {
  const Task task = test::stance_task("standing_up");
  const auto planner = make_stance_planner("guided");
  StancePlannerOptions options;
  StancePlan none;
  EXPECT_THROW(improve_stances(*planner, task, options, 1, none), Error);
  options.termination.deadline = Deadline::after(10.0);
  EXPECT_EQ(improve_stances(*planner, task, options, 1, none), 0);
  EXPECT_FALSE(none.success());
}

}  // namespace
}  // namespace locograph::improve_stances_test
