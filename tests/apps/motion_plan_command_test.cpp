// `plan` of a whole motion, and what `check`, `view` and `plot` say of it, as a user runs them.
#include <apps/command_runner.h>
#include <apps/shipped_scenario.h>
#include <apps/view_test_support.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace locograph::motion_plan_command_test {
namespace {

using test::goal_on_all_fours, test::part, test::shipped, test::standing_up_with,
    test::with_far_floor;

/// standing_up, planned once.
class MotionPlan : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    planned_ = std::make_unique<CommandRunner>();
    outcome_ = planned_->run("plan standing_up --seed 3 --tree tree.json -o plan.g2o --json");
  }
  static void TearDownTestSuite() { planned_.reset(); }
  void SetUp() override { ASSERT_EQ(outcome_.exit_code, 0) << outcome_.out << outcome_.err; }

  static const CommandRunner& planned() { return *planned_; }
  static nlohmann::json answer() { return outcome_.json(); }

 private:
  static inline std::unique_ptr<CommandRunner> planned_;
  static inline Outcome outcome_;
};

TEST_F(MotionPlan, PrintsOneJsonObjectWithEveryField) {
  const nlohmann::json json = answer();
  EXPECT_EQ(json["success"], true);
  EXPECT_TRUE(json["reason"].is_string());
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["planner"], "guided");
  EXPECT_GE(json["stances"], 9) << "four end effectors are lifted and put down";
  EXPECT_EQ(json["segments"], json["stances"].get<int>() - 1);
  EXPECT_GE(json["configurations"], 20 * json["segments"].get<int>());
  EXPECT_GT(json["duration_s"], 0.1 * json["segments"].get<double>());
  EXPECT_LT(json["duration_s"], 60.0);
  EXPECT_FALSE(json.contains("best")) << "it is solved";
  int segments = 0;
  for (const auto& [name, by] : json["segments_by_planner"].items()) {
    segments += by["count"].get<int>();
    EXPECT_EQ(by["seconds"] > 0.0, by["count"] > 0) << name;
  }
  EXPECT_EQ(segments, json["segments"]);
  EXPECT_EQ(json["segments_by_planner"].size(), 4u);
  EXPECT_GE(json["path_ratio"]["median"].get<double>(), 1.0 - 1e-9);
  EXPECT_GE(json["path_ratio"]["worst"], json["path_ratio"]["median"]);
  EXPECT_GE(json["swing_clearance"]["worst_m"].get<double>(), 0.02);
  EXPECT_LE(json["swing_clearance"]["worst_m"], json["swing_clearance"]["median_m"]);
  EXPECT_GE(json["refused_segments"], 0);
  double parts_s = 0.0;
  for (const char* phase : {"stance_planner", "whole_body", "timing", "judge"}) {
    EXPECT_GT(json["time"][phase].get<double>(), 0.0) << phase;
    parts_s += json["time"][phase].get<double>();
  }
  EXPECT_LE(parts_s, json["time"]["total"]) << "no part is counted twice";
}

TEST_F(MotionPlan, CheckAcceptsWhatIsWritten) {
  const Outcome checked = planned().run("check plan.g2o --json");
  ASSERT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  const nlohmann::json report = checked.json();
  EXPECT_EQ(report["feasible"], true);
  EXPECT_FALSE(report.value("stances_only", false));
  EXPECT_EQ(report["incomplete"], false);
  EXPECT_EQ(report["configurations"], answer()["configurations"]);
  EXPECT_EQ(report["start"], true);
  EXPECT_EQ(report["goals_reached"], 1);
  for (const char* name : {"velocity_limits", "contact_between", "static_balance", "time_order",
                           "scenario_start", "scenario_goals"}) {
    const auto& all = report["violations"];
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const auto& v) { return v["constraint"] == name; });
    ASSERT_NE(found, all.end()) << name;
    EXPECT_EQ((*found)["judged"], true) << name;
  }
}

TEST_F(MotionPlan, WritesTheTreeOfItsStances) {
  const nlohmann::json tree = nlohmann::json::parse(planned().read("tree.json"));
  EXPECT_EQ(tree["scenario"], "standing_up");
  EXPECT_GE(tree["nodes"].size(), 5u);
}

TEST_F(MotionPlan, TheSameSeedGivesTheSameFile) {
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan standing_up --seed 3 --threads 1 -o again.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("again.g2o"), planned().read("plan.g2o"));
}

TEST_F(MotionPlan, ViewShowsTheContactsOfEveryMomentAndWhenTheyChange) {
  LOCOGRAPH_NEEDS_VIEWER();
  const nlohmann::json scene = view(planned(), "plan.g2o --no-check --tree tree.json");
  EXPECT_FALSE(scene["plan"].contains("stances_only"));
  EXPECT_TRUE(scene.contains("tree"));
  const nlohmann::json& stances = scene["stances"];
  EXPECT_EQ(stances.size(), answer()["stances"]);
  const nlohmann::json& contacts = scene["plan"]["contacts"];
  ASSERT_EQ(contacts.size(), answer()["configurations"]);
  bool forces = false;
  for (std::size_t s = 0; s < stances.size(); ++s) {
    const int from = stances[s]["from"], to = stances[s]["to"];
    EXPECT_EQ(from, s == 0 ? 0 : stances[s - 1]["to"].get<int>());
    if (s > 0) {
      const auto fewer = static_cast<int>(stances[s]["contacts"].size()),
                 before = static_cast<int>(stances[s - 1]["contacts"].size());
      EXPECT_EQ(std::abs(fewer - before), 1) << "one contact changes at a time";
    }
    for (int i = from; i < to; ++i) {
      std::vector<std::string> names;
      for (const nlohmann::json& contact : contacts[static_cast<std::size_t>(i)]) {
        names.push_back(contact["name"]);
        forces |= contact.contains("force");
      }
      EXPECT_EQ(nlohmann::json(names), stances[s]["contacts"]) << "configuration " << i;
    }
  }
  EXPECT_TRUE(forces);
  EXPECT_EQ(stances.back()["to"], answer()["configurations"].get<int>() - 1);
}

TEST(MotionPlanCommand, SaysInWordsHowItMoves) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("plan standing_up --seed 3 -o plan.g2o");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("standing_up: "), 0u) << outcome.out;
  EXPECT_NE(outcome.out.find(" configurations of "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(" segments: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("times as long as straight\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("without a collision shape: HeadHokuyo\n"), std::string::npos);
  EXPECT_TRUE(outcome.out.ends_with("written: plan.g2o\n")) << outcome.out;
}

TEST(MotionPlanCommand, TakesTheSegmentPlannersThatItIsGiven) {
  const CommandRunner runner;
  const Outcome outcome = runner.run(
      "plan standing_up --seed 3 --segment-planner interpolation --segment-planner rrt_connect "
      "-o plan.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const nlohmann::json by = outcome.json()["segments_by_planner"];
  EXPECT_GT(by["interpolation"]["count"], 0);
  EXPECT_EQ(by["optimisation"]["count"], 0);
  EXPECT_EQ(by["atlas_rrt_star"]["count"], 0);
}

TEST(MotionPlanCommand, WithoutTimeThereIsNoPlan) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("plan standing_up --timeout 1e-9 -o plan.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], false);
  EXPECT_NE(json["reason"].get<std::string>().find("time"), std::string::npos);
  EXPECT_EQ(json["segments"], 0);
  EXPECT_TRUE(json["path_ratio"]["median"].is_null());
  EXPECT_TRUE(json["swing_clearance"]["worst_m"].is_null());
}

TEST(MotionPlanCommand, APlanThatDoesNotArriveIsWrittenAsFarAsItIsFeasible) {
  const CommandRunner runner;
  const std::string first = part(shipped("standing_up"), "<goal>", "</goal>");
  runner.write("two.xml",
               with_far_floor(standing_up_with(first + '\n' + goal_on_all_fours("51 0.1 0"))));
  runner.write("far.xml", with_far_floor(standing_up_with(goal_on_all_fours("51 0.1 0"))));
  for (const std::string task : {"two", "far"}) {
    SCOPED_TRACE(task);
    const Outcome outcome =
        runner.run("plan " + task + ".xml --max-transitions 300 -o part.g2o --json");
    ASSERT_EQ(outcome.exit_code, 1) << outcome.err;
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json["success"], false);
    EXPECT_TRUE(json["best"]["stances"].is_number_integer());
    EXPECT_EQ(json["configurations"] > 1, task == "two") << "the first goal is reached";
    const Outcome checked = runner.run("check part.g2o --json");
    EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
    EXPECT_EQ(checked.json()["incomplete"], true);
    EXPECT_EQ(checked.json()["configurations"], json["configurations"]);
  }
}

TEST(MotionPlanCommand, RefusesWrongUsageInOneLineAndWritesNothing) {
  const CommandRunner runner;
  const std::string plan = "plan standing_up -o out.g2o ";
  expect_refusal(runner.run(plan + "--segment-planner nosuch"), "", "interpolation");
  expect_refusal(runner.run(plan + "--stances-only --segment-planner interpolation"), "",
                 "--segment-planner");
  expect_refusal(runner.run(plan + "--improve --timeout 1"), "", "--stances-only");
  expect_refusal(runner.run(plan + "--timeout -1"), "", "--timeout");
  expect_refusal(runner.run("plan centauro_drive --segment-planner interpolation -o out.g2o"), "",
                 "no --segment-planner");
  expect_refusal(runner.run("plan centauro_drive --tree t.json -o out.g2o"), "", "no --tree");
  EXPECT_EQ(runner.files(), 0);
}

TEST(MotionPlanCommand, CampaignTellsTheFiguresOfWholePlans) {
  const CommandRunner runner;
  const std::string campaign = "campaign standing_up --runs 1 --seed 3 --csv runs.csv --json";
  const Outcome outcome = runner.run(campaign);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_EQ(json["solved"], 1) << outcome.out;
  for (const char* quantity :
       {"planning_time", "total_time", "stance_planner_time", "whole_body_time", "timing_time",
        "judge_time", "duration_s", "segments", "path_ratio_median", "path_ratio_worst",
        "swing_clearance_median_m", "swing_clearance_worst_m"}) {
    EXPECT_GT(json[quantity]["mean"].get<double>(), 0.0) << quantity;
  }
  double by_planner = 0.0;
  for (const char* name : {"interpolation", "optimisation", "rrt_connect", "atlas_rrt_star"}) {
    by_planner += json[std::string(name) + "_segments"]["mean"].get<double>();
    EXPECT_TRUE(json[std::string(name) + "_time"]["mean"].is_number()) << name;
  }
  EXPECT_EQ(by_planner, json["segments"]["mean"]) << "every segment planner has its columns";
  const std::string table = runner.read("runs.csv");
  ASSERT_EQ(runner.run(campaign).exit_code, 0);
  EXPECT_EQ(runner.read("runs.csv"), table) << "it is run again";
  expect_refusal(runner.run(campaign + " --stances-only"), "runs.csv:2", "--stances-only");
  expect_refusal(runner.run(campaign + " --segment-planner interpolation"), "runs.csv:2",
                 "--segment-planner interpolation");
}

}  // namespace
}  // namespace locograph::motion_plan_command_test
