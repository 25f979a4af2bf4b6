// Threads within one search for stances. scripts/test.sh runs this under ThreadSanitizer, too.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/transition_ahead.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "common/sanitized.h"
#include "planners/stance_tasks.h"

namespace locograph::stance_threads_test {
namespace {

using test::stance_task;

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

void expect_same(const Stance& a, const Stance& b) {
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].name(), b.contacts[i].name());
    EXPECT_TRUE(same_bits(a.contacts[i].position, b.contacts[i].position));
  }
}

/// A plan and what was told on the way to it.
struct Told {
  StancePlan plan;
  std::vector<TransitionAttempt> attempts;
};

Told plan_on(int threads, const Task& task, StancePlannerOptions options) {
  Told told;
  options.threads = threads;
  options.keep_tree = true;
  options.observe = [&](const TransitionAttempt& attempt) { told.attempts.push_back(attempt); };
  told.plan = make_stance_planner("guided")->plan(task, options);
  return told;
}

void expect_same(const Told& a, const Told& b) {
  EXPECT_EQ(a.plan.success(), b.plan.success());
  EXPECT_EQ(a.plan.reason, b.plan.reason);
  EXPECT_EQ(a.plan.statistics.iterations, b.plan.statistics.iterations);
  EXPECT_EQ(a.plan.statistics.vertices_in_tree, b.plan.statistics.vertices_in_tree);
  EXPECT_EQ(a.plan.statistics.transitions, b.plan.statistics.transitions);
  EXPECT_EQ(a.plan.statistics.transitions_found, b.plan.statistics.transitions_found);
  ASSERT_EQ(a.plan.stances.size(), b.plan.stances.size());
  ASSERT_EQ(a.plan.configurations.size(), b.plan.configurations.size());
  for (std::size_t i = 0; i < a.plan.stances.size(); ++i) {
    expect_same(a.plan.stances[i], b.plan.stances[i]);
    EXPECT_TRUE(same_bits(a.plan.configurations[i], b.plan.configurations[i])) << "number " << i;
  }
  ASSERT_EQ(a.plan.failures.size(), b.plan.failures.size());
  for (std::size_t i = 0; i < a.plan.failures.size(); ++i) {
    EXPECT_EQ(a.plan.failures[i].end_effector, b.plan.failures[i].end_effector);
    EXPECT_EQ(a.plan.failures[i].what, b.plan.failures[i].what);
    EXPECT_EQ(a.plan.failures[i].count, b.plan.failures[i].count);
  }
  ASSERT_EQ(a.plan.tree.size(), b.plan.tree.size());
  for (std::size_t i = 0; i < a.plan.tree.size(); ++i) {
    expect_same(a.plan.tree[i].stance, b.plan.tree[i].stance);
    EXPECT_EQ(a.plan.tree[i].parent, b.plan.tree[i].parent);
    EXPECT_EQ(a.plan.tree[i].found, b.plan.tree[i].found);
  }
  ASSERT_EQ(a.attempts.size(), b.attempts.size());
  for (std::size_t i = 0; i < a.attempts.size(); ++i) {
    expect_same(a.attempts[i].from, b.attempts[i].from);
    expect_same(a.attempts[i].to, b.attempts[i].to);
    EXPECT_TRUE(same_bits(a.attempts[i].start, b.attempts[i].start)) << "attempt " << i;
    EXPECT_EQ(a.attempts[i].restarts, b.attempts[i].restarts);
    EXPECT_EQ(a.attempts[i].found, b.attempts[i].found);
  }
}

// Between the walls the budget is enough for a second tree, one of those that grow from both ends.
TEST(StanceThreads, GiveTheSamePlanAndReportToTheLastBit) {
  struct {
    std::string name;
    int transitions;
    bool enforced;
  } const tasks[] = {{"standing_up", test::kSanitized ? 20 : 3000, false},
                     {"ladder_climbing", test::kSanitized ? 10 : 300, true},
                     {"parallel_walls", test::kSanitized ? 90 : 300, false}};
  for (const auto& [name, transitions, enforced] : tasks) {
    Task task = stance_task(name);
    task.check.enforce_torque_limits = enforced;
    for (std::uint64_t seed = 0; seed < (test::kSanitized ? 1 : 2); ++seed) {
      StancePlannerOptions options;
      options.seed = seed;
      options.max_transitions = transitions;
      const Told alone = plan_on(1, task, options);
      EXPECT_GT(alone.plan.statistics.transitions, 0);
      for (const int threads : {2, 4}) {
        SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", " + std::to_string(threads));
        expect_same(alone, plan_on(threads, task, options));
      }
    }
  }
}

TEST(StanceThreads, EndWhenTheSearchIsStoppedOrOutOfTime) {
  const Task task = stance_task("ladder_climbing");
  std::atomic<bool> stop = false;
  StancePlannerOptions options;
  options.threads = 3;
  options.termination.stop = &stop;
  int told = 0;
  options.observe = [&](const TransitionAttempt&) { stop = ++told >= 5; };
  const StancePlan stopped = make_stance_planner("guided")->plan(task, options);
  EXPECT_FALSE(stopped.success());
  EXPECT_NE(stopped.reason.find("interrupted"), std::string::npos) << stopped.reason;
  EXPECT_GE(stopped.statistics.transitions, 5);
  EXPECT_LE(stopped.statistics.transitions, 6) << "putting down what was lifted";

  options.termination.stop = nullptr;
  options.termination.deadline = Deadline::after(0.05);
  const Deadline deadline = options.termination.deadline;
  options.observe = [&](const TransitionAttempt&) {
    while (!deadline.passed()) std::this_thread::yield();
  };
  const StancePlan late = make_stance_planner("guided")->plan(task, options);
  EXPECT_FALSE(late.success());
  EXPECT_NE(late.reason.find("time"), std::string::npos) << late.reason;
  EXPECT_LE(late.statistics.transitions, 2);
}

/// Transitions from the start of a task: one contact less, or the same contact back.
class TransitionsAhead : public testing::Test {
 protected:
  const Task task_ = stance_task("standing_up");
  BalanceRegions regions_{task_.robot->robot->total_mass()};
  TaskSolver solver_{task_, regions_};

  TransitionTask task(int lifted, int restarts = 0) const {
    TransitionTask task;
    const std::vector<Contact>& contacts = task_.start.contacts;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const int place = static_cast<int>(c);
      task.larger.push_back(place);
      task.smaller.push_back(place == lifted ? kFree : place);
      task.closed.push_back(contacts[c]);
      if (place == lifted) continue;
      task.held.push_back(contacts[c]);
      task.bearing.push_back({contacts[c]});
    }
    task.start = task_.start_configuration;
    task.options.restarts = restarts;
    return task;
  }

  /// Expects until a thread has got to it, however long it gets no processor, and takes it.
  static std::optional<TransitionResult> taken(TransitionAhead& ahead,
                                               const TransitionAhead::Expected& expected,
                                               const TransitionTask& asked) {
    std::optional<TransitionResult> result;
    for (int i = 0; i < 600000 && !result; ++i) {
      ahead.expect({expected});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      result = ahead.take(asked);
    }
    return result;
  }
};

TEST_F(TransitionsAhead, AreThoseThatANewSolverFindsWhateverWasSolvedBefore) {
  const int contacts = static_cast<int>(task_.start.contacts.size());
  for (int lifted = 0; lifted < contacts; ++lifted) {
    const TransitionTask asked = task(lifted, 1);
    BalanceRegions regions(task_.robot->robot->total_mass());
    const TransitionResult fresh = TaskSolver(task_, regions).solve(asked);
    const TransitionResult used = solver_.solve(asked);
    EXPECT_EQ(used.success(), fresh.success());
    EXPECT_EQ(used.failure, fresh.failure);
    EXPECT_EQ(used.statistics.iterations, fresh.statistics.iterations);
    EXPECT_TRUE(same_bits(used.configuration, fresh.configuration)) << "lifted " << lifted;
    TransitionAhead ahead(solver_, 1);
    const std::optional<TransitionResult> given = taken(ahead, {asked}, asked);
    ASSERT_TRUE(given.has_value());
    EXPECT_EQ(given->success(), fresh.success());
    EXPECT_TRUE(same_bits(given->configuration, fresh.configuration)) << "lifted " << lifted;
  }
}

TEST_F(TransitionsAhead, AreGivenOnceAndForTheirExactArgumentsOnly) {
  TransitionAhead ahead(solver_, 1);
  const TransitionTask asked = task(0);
  EXPECT_FALSE(ahead.take(asked).has_value()) << "not expected";
  ASSERT_TRUE(taken(ahead, {asked}, asked).has_value());
  EXPECT_FALSE(ahead.take(asked).has_value()) << "given before";

  TransitionTask other_start = asked, other_seed = asked, other_restarts = task(0, 1);
  other_start.start[0] += 1e-12;
  other_seed.seed = 1;
  ahead.expect({{asked}});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  for (const TransitionTask& other : {other_start, other_seed, other_restarts, task(1)}) {
    EXPECT_FALSE(ahead.take(other).has_value());
  }
  ahead.forget();
  EXPECT_FALSE(ahead.take(asked).has_value());
}

TEST_F(TransitionsAhead, GoOnFromWhatWasFound) {
  int lifted = 0;
  while (!solver_.solve(task(lifted)).success()) ++lifted;
  TransitionTask put = task(lifted, 2);
  put.start = solver_.solve(task(lifted)).configuration;
  const TransitionResult expected = solver_.solve(put);
  TransitionAhead ahead(solver_, 2);
  const std::optional<TransitionResult> given = taken(ahead, {task(lifted), task(lifted, 2)}, put);
  ASSERT_TRUE(given.has_value());
  EXPECT_TRUE(same_bits(given->configuration, expected.configuration));
}

TEST_F(TransitionsAhead, ThatThrowAreLeftToWhoAsksAndOthersAreWorkedOut) {
  TransitionTask unsound = task(0);
  unsound.closed[1].effector.link = "no_such_link";
  EXPECT_THROW(solver_.solve(unsound), Error);
  TransitionAhead ahead(solver_, 1);
  const TransitionTask sound = task(0);
  for (int i = 0; i < 3; ++i) {
    TransitionTask wrong = unsound;
    wrong.seed = static_cast<std::uint64_t>(100 + i);
    ahead.expect({{wrong}});
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(ahead.take(wrong).has_value());
  }
  EXPECT_TRUE(taken(ahead, {sound}, sound).has_value());
}

}  // namespace
}  // namespace locograph::stance_threads_test
