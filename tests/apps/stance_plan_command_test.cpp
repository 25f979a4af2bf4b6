// `plan --stances-only` and what `check` says of it, as a user runs them.
#include <apps/command_runner.h>
#include <apps/shipped_scenario.h>

namespace locograph::stance_plan_command_test {
namespace {

using test::goal_on_all_fours, test::part, test::shipped, test::standing_up_with, test::with,
    test::with_far_floor;

const nlohmann::json* constraint(const nlohmann::json& report, const std::string& name) {
  for (const nlohmann::json& violation : report["violations"]) {
    if (violation["constraint"] == name) return &violation;
  }
  return nullptr;
}

TEST(StancePlanCommand, WritesAPlanThatCheckAccepts) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("plan standing_up --stances-only --seed 3 -o plan.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], true);
  EXPECT_EQ(json["status"], "solved");
  EXPECT_TRUE(json["reason"].is_string());
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["planner"], "guided");
  EXPECT_GE(json["stances"], 9) << "four end effectors are lifted and put down";
  EXPECT_EQ(json["configurations"], json["stances"]);
  EXPECT_GT(json["vertices_in_tree"], 0);
  EXPECT_GT(json["iterations"], 0);
  EXPECT_EQ(json["duration_s"], 0.0);
  EXPECT_TRUE(json["segments"].is_number_integer());
  EXPECT_FALSE(json.contains("best")) << "it is solved";
  for (const char* phase :
       {"stance_planner", "transitions", "whole_body", "timing", "judge", "total"}) {
    EXPECT_GE(json["time"][phase].get<double>(), 0.0) << phase;
  }

  const Outcome checked = runner.run("check plan.g2o --json");
  ASSERT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  const nlohmann::json report = checked.json();
  EXPECT_EQ(report["feasible"], true);
  EXPECT_EQ(report["stances_only"], true);
  EXPECT_EQ(report["incomplete"], false);
  EXPECT_EQ(report["configurations"], json["configurations"]);
  EXPECT_EQ(report["scenario"], "standing_up");
  EXPECT_EQ(report["start"], true);
  EXPECT_EQ(report["goals_reached"], 1);
  EXPECT_EQ(report["goals"], 1);
  EXPECT_FALSE(report.contains("moved_contacts"));
  for (const char* name : {"scenario_start", "scenario_goals"}) {
    ASSERT_NE(constraint(report, name), nullptr) << name;
    EXPECT_EQ((*constraint(report, name))["judged"], true);
  }
  const nlohmann::json* velocity = constraint(report, "velocity_limits");
  ASSERT_NE(velocity, nullptr);
  EXPECT_EQ((*velocity)["judged"], false) << "it has no motion";
  EXPECT_TRUE((*velocity)["worst"].is_null());
  const nlohmann::json* balance = constraint(report, "static_balance");
  ASSERT_NE(balance, nullptr);
  EXPECT_EQ((*balance)["judged"], true);
  const std::string words = runner.run("check plan.g2o").out;
  EXPECT_NE(words.find("of a plan of stances"), std::string::npos) << words;
  EXPECT_EQ(words.find("incomplete"), std::string::npos) << words;
  const std::string task =
      "\nscenario: standing_up; it begins at the start, and reaches 1 of 1 goal\n";
  EXPECT_NE(words.find(task), std::string::npos) << words;
}

TEST(StancePlanCommand, TheSameSeedGivesTheSameFile) {
  const CommandRunner runner;
  const std::string call = "plan standing_up --stances-only --seed 4 -o ";
  ASSERT_EQ(runner.run(call + "a.g2o").exit_code, 0);
  for (const std::string threads : {"1", "2", "4"}) {
    ASSERT_EQ(runner.run(call + "b.g2o --threads " + threads).exit_code, 0);
    EXPECT_EQ(runner.read("a.g2o"), runner.read("b.g2o")) << threads << " threads";
  }
}

TEST(StancePlanCommand, APlanWithMovedContactsHasItsOwnAndCheckAcceptsIt) {
  const CommandRunner runner;
  const std::string call = "plan standing_up --stances-only --seed 3 --json ";
  const Outcome outcome = runner.run(call + "--move-contacts 0.02 -o moved.g2o");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const nlohmann::json moved = outcome.json()["moved_contacts"];
  EXPECT_EQ(moved["up_to_m"], 0.02);
  EXPECT_GE(moved["start_draws"], 1);
  const Outcome checked = runner.run("check moved.g2o --json");
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;

  const Outcome unmoved = runner.run(call + "--move-contacts 0 -o unmoved.g2o");
  ASSERT_EQ(unmoved.exit_code, 0) << unmoved.out << unmoved.err;
  EXPECT_FALSE(unmoved.json().contains("moved_contacts"));
  const auto first_contact = [&](const std::string& file) {
    return part(runner.read(file), "PARAMS_CONTACT ", "\n");
  };
  EXPECT_NE(first_contact("moved.g2o"), first_contact("unmoved.g2o"));
}

TEST(StancePlanCommand, WhatMovesIsInTheWayWhereverItGetsTo) {
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan standing_up --stances-only --seed 3 -o plan.g2o").exit_code, 0);
  // It comes through the robot long after the number of the last stance.
  runner.write("ball.xml",
               "<obstacles version=\"1\"><sphere center=\"1.4 9 0.7\" radius=\"0.1\">"
               "<keyframe time=\"100\" position=\"1.4 9 0.7\"/>"
               "<keyframe time=\"110\" position=\"1.4 -9 0.7\"/></sphere></obstacles>");
  const Outcome outcome = runner.run("check plan.g2o --obstacles ball.xml --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json report = outcome.json();
  const nlohmann::json* distance = constraint(report, "obstacle_distance");
  ASSERT_NE(distance, nullptr);
  EXPECT_EQ((*distance)["violated"], true);
  EXPECT_GT((*distance)["time"], 100.0);
}

TEST(StancePlanCommand, AGoalThatHoldsAndIsNotFoundIsNoProof) {
  const CommandRunner runner;
  const Outcome outcome =
      runner.run("plan standing_up --stances-only --seed 3 --max-transitions 3 -o plan.g2o --json");
  ASSERT_EQ(outcome.exit_code, 1) << outcome.out << outcome.err;
  const std::string reason = outcome.json()["reason"];
  EXPECT_NE(reason.find("a way was not found, which proves nothing"), std::string::npos) << reason;
  EXPECT_FALSE(outcome.json().contains("move"));
}

TEST(StancePlanCommand, WritesTheTreeThatTheSearchTried) {
  const CommandRunner runner;
  const std::string call = "plan standing_up --stances-only --seed 3 ";
  const Outcome outcome = runner.run(call + "--tree tree.json -o plan.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const nlohmann::json tree = nlohmann::json::parse(runner.read("tree.json"));
  EXPECT_EQ(tree["scenario"], "standing_up");
  EXPECT_EQ(tree["planner"], "guided");
  EXPECT_EQ(tree["seed"], 3);
  const nlohmann::json& root = tree["nodes"][0];
  EXPECT_EQ(root["parent"], -1);
  EXPECT_EQ(root["found"], true);
  EXPECT_EQ(root["contacts"]["left_foot"].size(), 3u);
  int found = 0, on_way = 0;
  for (const nlohmann::json& node : tree["nodes"]) {
    found += node["found"].get<bool>();
    on_way += node["on_way"].get<bool>();
  }
  EXPECT_EQ(found, outcome.json()["vertices_in_tree"]);
  EXPECT_GE(on_way, 5) << "the start, and a move of each of four end effectors";

  ASSERT_EQ(runner.run(call + "--tree again.json -o again.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("again.json"), runner.read("tree.json"));
  ASSERT_EQ(runner.run(call + "-o without.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("without.g2o"), runner.read("plan.g2o"));
}

TEST(StancePlanCommand, CheckJudgesAPlanInTheScenarioItIsGiven) {
  const CommandRunner runner;
  const std::string walls = with(shipped("parallel_walls"), "\"enforce\"", "\"report\"");
  runner.write("walls.xml", walls);
  runner.write("slippery.xml", with(walls, "friction=\"0.8\"", "friction=\"0.05\""));
  const Outcome planned = runner.run("plan walls.xml --stances-only --seed 1 -o plan.g2o");
  ASSERT_EQ(planned.exit_code, 0) << planned.out << planned.err;
  EXPECT_EQ(runner.run("check plan.g2o").exit_code, 0);
  EXPECT_EQ(runner.run("check plan.g2o --scenario walls.xml").exit_code, 0);
  const Outcome refused = runner.run("check plan.g2o --scenario slippery.xml --json");
  EXPECT_EQ(refused.exit_code, 1) << refused.err;
  EXPECT_EQ(refused.json()["feasible"], false);
  const nlohmann::json report = refused.json();
  const nlohmann::json* balance = constraint(report, "static_balance");
  ASSERT_NE(balance, nullptr);
  EXPECT_EQ((*balance)["violated"], true);
  EXPECT_LT((*balance)["worst"].get<double>(), 0.0);
}

TEST(StancePlanCommand, AnIncompletePlanIsWrittenAndCheckSaysSo) {
  const CommandRunner runner;
  runner.write("far.xml", with_far_floor(standing_up_with(goal_on_all_fours("51 0.1 0"))));
  const Outcome outcome =
      runner.run("plan far.xml --stances-only --max-transitions 300 -o part.g2o --json");
  ASSERT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], false);
  EXPECT_EQ(json["status"], "not_found");
  const std::string reason = json["reason"];
  EXPECT_TRUE(reason.starts_with(
      "the goal is not reached: the transitions allowed are used up (allow more); "))
      << reason;
  EXPECT_NE(reason.find("left_hand"), std::string::npos) << reason;
  EXPECT_NE(reason.find("no posture is found that holds the goal ("), std::string::npos) << reason;
  EXPECT_EQ(json["move"]["contact"], "left_hand");
  EXPECT_EQ(json["move"]["by_m"].size(), 3u);
  EXPECT_TRUE(json["move"]["touches"].is_boolean());
  EXPECT_EQ(json["best"]["goal_contacts_reached"], 3);
  EXPECT_TRUE(json["best"]["stances"].is_number_integer());
  ASSERT_TRUE(runner.exists("part.g2o"));
  const Outcome checked = runner.run("check part.g2o --json");
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  EXPECT_EQ(checked.json()["incomplete"], true);
  const std::string words = runner.run("check part.g2o").out;
  EXPECT_NE(words.find("incomplete"), std::string::npos) << words;
}

TEST(StancePlanCommand, RefusesWrongUsageInOneLineAndWritesNothing) {
  const CommandRunner runner;
  const std::string plan = "plan standing_up -o out.g2o ";
  expect_refusal(runner.run(plan + "--stances-only --timeout -1"), "", "--timeout");
  expect_refusal(runner.run(plan + "--stances-only --max-transitions -1"), "", "--max-transitions");
  expect_refusal(runner.run("plan centauro_drive --max-transitions 9 -o out.g2o"), "",
                 "no stances to change");
  expect_refusal(runner.run(plan + "--stances-only --planner nosuch"), "", "nosuch");
  expect_refusal(runner.run("plan centauro_drive --stances-only -o out.g2o"), "", "no stances");
  expect_refusal(runner.run(plan + "--stances-only --move-contacts -0.1"), "", "--move-contacts");
  expect_refusal(runner.run("plan centauro_drive --move-contacts 0.1 -o out.g2o"), "",
                 "no contacts to move");
  expect_refusal(runner.run(plan + "--stances-only --tree no/such/t.json"), "no/such/t.json", "");
  EXPECT_EQ(runner.files(), 0);
}

}  // namespace
}  // namespace locograph::stance_plan_command_test
