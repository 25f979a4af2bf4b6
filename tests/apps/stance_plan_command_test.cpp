// `plan --stances-only` and what `check` says of it, as a user runs them.
#include <apps/command_runner.h>

#include <algorithm>
#include <vector>

namespace locograph::stance_plan_command_test {
namespace {

std::string shipped(const std::string& scenario) {
  std::ifstream in(LOCOGRAPH_SOURCE_DIR "/planners/scenarios/" + scenario + ".xml");
  return std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
}

/// The text with every `find` replaced.
std::string with(std::string text, const std::string& find, const std::string& replace) {
  std::size_t at = text.find(find);
  if (at == std::string::npos) ADD_FAILURE() << "no " << find;
  for (; at != std::string::npos; at = text.find(find, at + replace.size())) {
    text.replace(at, find.size(), replace);
  }
  return text;
}

/// From the first `from` up to and with the next `to`.
std::string part(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  return text.substr(begin, text.find(to, begin) + to.size() - begin);
}

/// Number of the line that `what` is first on.
std::string line_of(const std::string& text, const std::string& what) {
  const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(text.find(what));
  return std::to_string(1 + std::count(text.begin(), text.begin() + at, '\n'));
}

const nlohmann::json* constraint(const nlohmann::json& report, const std::string& name) {
  for (const nlohmann::json& violation : report["violations"]) {
    if (violation["constraint"] == name) return &violation;
  }
  return nullptr;
}

/// standing_up with the left hand to go 50 m ahead, the other contacts where they are.
std::string out_of_reach() {
  const std::string text = shipped("standing_up");
  std::string goal = part(text, "<contact", "</start>");
  goal = with(with(goal, "</start>", "</goal>"), "1.7 0.1 0", "51 0.1 0");
  return with(with(text, part(text, "<goal>", "</goal>"), "<goal>" + goal), "</environment>",
              "<plane name=\"far\" center=\"51 0 0\" normal=\"0 0 1\" size=\"2 2\"/>\n"
              "</environment>");
}

TEST(StancePlanCommand, WritesAPlanThatCheckAccepts) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("plan standing_up --stances-only --seed 3 -o plan.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], true);
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
}

TEST(StancePlanCommand, TheSameSeedGivesTheSameFile) {
  const CommandRunner runner;
  const std::string call = "plan standing_up --stances-only --seed 4 -o ";
  ASSERT_EQ(runner.run(call + "a.g2o").exit_code, 0);
  ASSERT_EQ(runner.run(call + "b.g2o --threads 2").exit_code, 0);
  EXPECT_EQ(runner.read("a.g2o"), runner.read("b.g2o"));
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
  runner.write("far.xml", out_of_reach());
  const Outcome outcome = runner.run("plan far.xml --stances-only --timeout 1 -o part.g2o --json");
  ASSERT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], false);
  EXPECT_NE(json["reason"].get<std::string>().find("not reached"), std::string::npos)
      << json["reason"];
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
  expect_refusal(runner.run(plan), "standing_up:" + line_of(shipped("standing_up"), "<start"),
                 "--stances-only");
  expect_refusal(runner.run(plan + "--stances-only --timeout -1"), "", "--timeout");
  expect_refusal(runner.run(plan + "--stances-only --planner nosuch"), "", "nosuch");
  expect_refusal(runner.run("plan centauro_drive --stances-only -o out.g2o"), "", "no stances");
  EXPECT_EQ(runner.files(), 0);
}

/// A scenario that is refused, with the line of `blamed` in it, and the words of the refusal.
struct Spoilt {
  std::string text, blamed, words;
};

void expect_spoilt(const Spoilt& spoilt) {
  const CommandRunner runner;
  runner.write("bad.xml", spoilt.text);
  const Outcome outcome = runner.run("plan bad.xml --stances-only --timeout 5 -o out.g2o");
  expect_refusal(outcome, "", "bad.xml:" + line_of(spoilt.text, spoilt.blamed) + ": ");
  EXPECT_NE(outcome.err.find(spoilt.words), std::string::npos) << outcome.err;
  EXPECT_FALSE(runner.exists("out.g2o"));
}

std::string standing_on_one_hand() {
  const std::string text = shipped("standing_up"), start = part(text, "<contact", "</start>");
  return with(text, start,
              part(start.substr(start.find("\"left_hand")), "\"", "/>")
                      .insert(0, "<contact end_effector=") +
                  "\n</start>");
}

TEST(StancePlanCommand, RefusesScenariosThatMakeNoSenseWithTheLine) {
  const std::string text = shipped("standing_up");
  const std::vector<Spoilt> scenarios = {
      {with(text, part(text, "<goal>", "</goal>"), ""), "<start", "without a <goal>"},
      {with(text, "size=\"5 2\"", "size=\"0 2\""), "size=\"0 2\"", "size"},
      {with(text, "friction=\"0.5\"", "friction=\"-0.5\""), "friction=\"-0.5\"", "friction"},
      {with(text, "contact end_effector=\"left_hand\"", "contact end_effector=\"left_hnd\""),
       "\"left_hnd\"", "did you mean"},
      {standing_on_one_hand(), "<start", "balance"}};
  for (const Spoilt& spoilt : scenarios) expect_spoilt(spoilt);
}

TEST(StancePlanCommand, AnUnknownLinkOrJointIsRefusedWithItsOwnLine) {
  const std::string text = shipped("standing_up");
  expect_spoilt({with(text, "link=\"LBall\"", "link=\"LBal\""), "\"LBal\"", "LBal"});
  expect_spoilt({with(text, "\"LHipSag\"", "\"LHipSgg\""), "\"LHipSgg\"", "LHipSgg"});
}

TEST(StancePlanCommand, AStartThatCannotBeHeldIsRefusedWithTheAmount) {
  const std::string text = shipped("standing_up");
  const std::string start = part(text, "<start", "</start>");
  // The left hand 4.9 m aside, on a floor that is there.
  const std::string aside = with(start, "1.7 0.1 0", "1.7 5 0");
  expect_spoilt({with(with(text, start, aside), "size=\"5 2\"", "size=\"5 12\""), "<start",
                 "left_hand not closed by "});
}

// One hand holds nothing, and the answer says how far that is from balance.
TEST(StancePlanCommand, AStartThatDoesNotBalanceIsRefusedWithTheAmount) {
  const CommandRunner runner;
  runner.write("bad.xml", standing_on_one_hand());
  const Outcome outcome = runner.run("plan bad.xml --stances-only -o out.g2o");
  EXPECT_EQ(outcome.exit_code, 2);
  const std::size_t words = outcome.err.find("no configuration stands at the start");
  ASSERT_NE(words, std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find_first_of("0123456789", words), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace locograph::stance_plan_command_test
