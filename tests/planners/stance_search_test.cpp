// Searches for stances, candidate by candidate.
#include <gtest/gtest.h>
#include <locograph/planners/offline/stance/stance_planners.h>

#include <memory>
#include <utility>
#include <vector>

#include "planners/stance_tasks.h"

namespace locograph::stance_search_test {
namespace {

const Task& standing_up() {
  static const Task task = test::stance_task("standing_up");
  return task;
}

std::unique_ptr<StanceSearch> begun(const Task& task, const StancePlannerOptions& options = {}) {
  return make_stance_planner("guided")->begin(task, options);
}

/// What plan_motion() does with a segment that has no path.
TEST(StanceSearch, NoLaterCandidateHasAChangeThatIsRefused) {
  const auto search = begun(standing_up());
  std::vector<std::pair<Footing, Footing>> refused;
  const auto expect_none_refused = [&](const StancePath& path) {
    for (std::size_t i = 1; i < path.footings.size(); ++i) {
      for (const auto& [from, to] : refused) {
        EXPECT_FALSE(path.footings[i - 1] == from && path.footings[i] == to) << i;
      }
    }
  };
  for (const bool first : {true, false}) {
    ASSERT_TRUE(search->next());
    const StancePath& way = search->candidate();
    EXPECT_EQ(way.footings.size(), way.configurations.size());
    EXPECT_EQ(search->taken().changes(), 0U);
    expect_none_refused(way);
    const std::size_t number = first ? 1 : way.changes();
    refused.emplace_back(way.footings[number - 1], way.footings[number]);
    search->refuse(number, "for no reason");
  }
  ASSERT_TRUE(search->next());
  search->take();
  EXPECT_FALSE(search->next());
  expect_none_refused(search->taken());
  const StancePlan plan = search->result();
  ASSERT_TRUE(plan.success()) << plan.reason;
  EXPECT_EQ(plan.configurations, search->taken().configurations);
  EXPECT_EQ(plan.stances.size(), search->taken().footings.size());
}

TEST(StanceSearch, WhereAllCandidatesAreRefusedThereIsNoPlanAndTheReasonIsTold) {
  StancePlannerOptions options;
  options.max_transitions = 200;
  const auto search = begun(standing_up(), options);
  int candidates = 0;
  while (search->next()) {
    ++candidates;
    search->refuse(search->candidate().changes(), "nobody likes it");
  }
  EXPECT_GT(candidates, 0);
  const StancePlan plan = search->result();
  EXPECT_FALSE(plan.success());
  EXPECT_NE(plan.reason.find("nobody likes it"), std::string::npos) << plan.reason;
  EXPECT_EQ(plan.stances.size(), 1U);
}

TEST(StanceSearch, OtherConfigurationsTakeThePlaceOfThoseOfACandidate) {
  const auto search = begun(standing_up());
  ASSERT_TRUE(search->next());
  std::vector<Eigen::VectorXd> others = search->candidate().configurations;
  others.back().tail<1>()[0] += 1e-4;
  search->replace(others);
  search->take();
  EXPECT_FALSE(search->next());
  const StancePlan plan = search->result();
  ASSERT_TRUE(plan.success()) << plan.reason;
  EXPECT_EQ(plan.configurations, others);
}

TEST(StanceSearch, CandidatesLeadToOneGoalAfterTheOther) {
  Task task = standing_up();
  task.goals = {task.start, task.start};
  const auto search = begun(task);
  for (int goal = 0; goal < 2; ++goal) {
    ASSERT_TRUE(search->next());
    EXPECT_EQ(search->result().goals_reached, goal);
    search->take();
  }
  EXPECT_FALSE(search->next());
  EXPECT_TRUE(search->result().success());
}

TEST(StanceSearch, APlanIsTheFirstCandidates) {
  const auto search = begun(standing_up());
  while (search->next()) search->take();
  const StancePlan found = search->result();
  const StancePlan plan = make_stance_planner("guided")->plan(standing_up(), {});
  EXPECT_EQ(found.configurations, plan.configurations);
  EXPECT_EQ(found.statistics.transitions, plan.statistics.transitions);
  EXPECT_EQ(found.statistics.iterations, plan.statistics.iterations);
}

}  // namespace
}  // namespace locograph::stance_search_test
