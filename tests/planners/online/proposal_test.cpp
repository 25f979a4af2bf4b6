#include <locograph/common/error.h>
#include <locograph/planners/online/local_planner.h>

#include "planners/online/drive_past_box.h"

namespace locograph {
namespace proposal_test {

using Answer = Proposal::Answer;
using Indices = std::vector<int>;

/// The answers of a proposal, call after call and then kNone, and when it was asked.
struct Script {
  std::vector<Answer> answers = {};
  std::vector<Eigen::VectorXd> candidate = {};
  Indices asked = {};  ///< executed configurations
  int worlds = 0;
};

class ScriptedProposal : public Proposal {
 public:
  explicit ScriptedProposal(Script& script) : script_(script) {}

  Answer search(const OnlinePlan&, const Window& window, const Termination&,
                std::vector<Eigen::VectorXd>& candidate) override {
    const std::size_t call = script_.asked.size();
    script_.asked.push_back(window.executed());
    candidate = script_.candidate;
    return call < script_.answers.size() ? script_.answers[call] : Answer::kNone;
  }
  void world_changed() override { ++script_.worlds; }

 private:
  Script& script_;
};

ProposalFactory scripted(Script& script) {
  return [&script](const OnlinePlan&) { return std::make_unique<ScriptedProposal>(script); };
}

class Schedule : public testing::Test {
 protected:
  Answer ask(ProposalSchedule& schedule) {
    window_.move_to(executed_++);
    return schedule.ask(plan_, window_, {}, candidate_);
  }

  Graph graph_ = drive();
  OnlinePlan plan_{graph_};
  Window window_{plan_, {.steps = 5}};
  std::vector<Eigen::VectorXd> candidate_;
  int executed_ = 0;
};

TEST_F(Schedule, AsksInTurnAndStaysWithAProposalThatIsUnfinished) {
  Script first{.answers = {Answer::kNone, Answer::kUnfinished}}, second;
  ProposalSchedule schedule({scripted(first), scripted(second)}, plan_, 4);
  ASSERT_EQ(schedule.size(), 2);
  EXPECT_EQ(ask(schedule), Answer::kNone);
  EXPECT_EQ(ask(schedule), Answer::kNone);
  EXPECT_EQ(ask(schedule), Answer::kUnfinished);
  EXPECT_EQ(ask(schedule), Answer::kNone);
  EXPECT_EQ(ask(schedule), Answer::kNone);
  EXPECT_EQ(first.asked, (Indices{0, 2, 3}));
  EXPECT_EQ(second.asked, (Indices{1, 4}));
}

TEST_F(Schedule, TellsASearchOfANewWorldWhenItIsOver) {
  Script script{.answers = {Answer::kUnfinished, Answer::kNone, Answer::kUnfinished}};
  ProposalSchedule schedule({scripted(script)}, plan_, 4);
  ask(schedule);
  schedule.world_changed();
  schedule.world_changed();
  EXPECT_EQ(script.worlds, 0);
  ask(schedule);
  EXPECT_EQ(script.worlds, 1);
  ask(schedule);
  schedule.world_changed();
  schedule.give_up();
  EXPECT_EQ(script.worlds, 2);
  schedule.world_changed();
  EXPECT_EQ(script.worlds, 3);
}

TEST_F(Schedule, PausesForSomeCycles) {
  ProposalSchedule schedule({}, plan_, 2);
  EXPECT_FALSE(schedule.paused_at(0));
  schedule.pause_after(7);
  EXPECT_TRUE(schedule.paused_at(8));
  EXPECT_TRUE(schedule.paused_at(9));
  EXPECT_FALSE(schedule.paused_at(10));
}

TEST_F(Schedule, RefusesACandidateThatDoesNotFitTheWindow) {
  Script script{.answers = {Answer::kFound, Answer::kFound, Answer::kFound}};
  ProposalSchedule schedule({scripted(script)}, plan_, 4);
  EXPECT_THROW(ask(schedule), Error) << "no configurations";
  script.candidate.assign(5, Eigen::VectorXd::Zero(3));
  EXPECT_THROW(ask(schedule), Error) << "too short ones";
  script.candidate.assign(5, plan_.planned()[0]);
  EXPECT_EQ(ask(schedule), Answer::kFound);
}

/// Asked whenever there is no pause.
LocalPlannerOptions always_asking(Script& script) {
  LocalPlannerOptions options;
  options.proposals = {scripted(script)};
  options.blocked_m = -1.0;
  return options;
}

TEST(Proposals, AreAskedAgainAfterAPauseWhereTheyDidNotHelp) {
  Script script;
  Graph graph = drive();
  const LocalPlannerOptions options = always_asking(script);
  ASSERT_EQ(options.proposal_pause, 4);
  LocalPlanner planner(graph, options);
  for (int executed = 0; executed <= 10; ++executed) {
    const CycleReport report = planner.cycle(executed);
    EXPECT_TRUE(report.success()) << executed;
    EXPECT_EQ(report.detour, executed % 5 == 0) << executed;
  }
  EXPECT_EQ(script.asked, (Indices{0, 5, 10}));
}

TEST(Proposals, ThatAreUnfinishedComeFirstInTheNextCycle) {
  Script script{.answers = {Answer::kUnfinished}};
  Graph graph = drive();
  LocalPlanner planner(graph, always_asking(script));
  planner.cycle(0);
  const CycleReport report = planner.cycle(1);
  EXPECT_TRUE(report.detour);
  planner.cycle(2);
  EXPECT_EQ(script.asked, (Indices{0, 1}));
}

TEST(Fallbacks, AreAskedWhereNoWindowIsFeasible) {
  Script first, second;
  LocalPlannerOptions options;
  options.proposals = {};
  options.fallbacks = {scripted(first), scripted(second)};
  Graph graph = drive();
  LocalPlanner planner(graph, options);
  std::vector<CycleReport> reports = {planner.cycle(0)};
  planner.show(seeing({box("rock", {0.5, 0.0, 0.5}, {3.0, 3.0, 1.0})}));
  for (int executed = 1; executed < 6; ++executed) reports.push_back(planner.cycle(executed));
  Indices infeasible;
  for (const CycleReport& report : reports) {
    EXPECT_EQ(report.detour, !report.success());
    if (!report.success()) infeasible.push_back(report.executed);
  }
  EXPECT_FALSE(infeasible.empty());
  EXPECT_EQ(first.asked, infeasible);
  EXPECT_EQ(second.asked, infeasible);
  EXPECT_EQ(first.worlds, 1);
}

TEST(Proposals, HearOfANewWorld) {
  Script script;
  Graph graph = drive();
  LocalPlanner planner(graph, always_asking(script));
  EXPECT_EQ(script.worlds, 0);
  planner.show(seeing({box_ahead()}));
  EXPECT_EQ(script.worlds, 0) << "a cycle may be running";
  planner.cycle(0);
  planner.cycle(1);
  EXPECT_EQ(script.worlds, 1);
}

TEST(Proposals, ThatOnlyATestRegistersHaveTheirBetterWindowTaken) {
  LocalPlannerOptions options;
  options.horizon = 30;
  Graph known = drive();
  LocalPlanner knows(known, options);
  knows.show(seeing({box_ahead()}));
  const CycleReport past_the_box = knows.cycle(0);
  ASSERT_TRUE(past_the_box.detour);
  const std::vector<Eigen::VectorXd> way = configurations(known);
  std::size_t farthest = 0;
  for (std::size_t i = 0; i <= 30; ++i) {
    if (std::abs(way[i][1]) > std::abs(way[farthest][1])) farthest = i;
  }
  ASSERT_GT(std::abs(way[farthest][1]), 0.3);

  // The window that the detour led to is all that is proposed to another planner.
  Script script{.answers = {Answer::kFound}, .candidate = {way.begin() + 1, way.begin() + 31}};
  options.proposals = {scripted(script)};
  Graph graph = drive();
  LocalPlanner planner(graph, options);
  planner.show(seeing({box_ahead()}));
  const CycleReport report = planner.cycle(0);
  EXPECT_EQ(script.asked, Indices{0});
  EXPECT_TRUE(report.detour);
  EXPECT_GE(report.feasible_steps, past_the_box.feasible_steps);
  EXPECT_TRUE(report.success() || !past_the_box.success());
  EXPECT_GT(configurations(graph)[farthest][1] / way[farthest][1], 0.5) << "the same way past it";
}

}  // namespace proposal_test
}  // namespace locograph
