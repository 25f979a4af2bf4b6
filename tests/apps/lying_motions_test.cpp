// Motions that lie about their segments, times and stances: `check` refuses each of them.
#include <apps/command_runner.h>

#include <algorithm>

#include "apps/standing_plan.h"

namespace locograph {
namespace {

/// The line of a plan's text that begins with these words, from 1.
int line_of(const PlanText& plan, const std::string& words) {
  const auto found = std::ranges::find_if(
      plan.parameters, [&](const std::string& line) { return line.starts_with(words); });
  return 1 + static_cast<int>(found - plan.parameters.begin());
}

/// Puts other words in place of the line that begins with these.
void replace_line(PlanText& plan, const std::string& words, const std::string& instead) {
  plan.parameters.at(static_cast<std::size_t>(line_of(plan, words) - 1)) = instead;
}

/// `check` takes it for no plan at all, and names a line that begins with `words`.
void expect_no_plan(const PlanText& plan, const std::string& words, const std::string& why) {
  const CommandRunner runner;
  runner.write("lie.g2o", plan.text());
  expect_refusal(runner.run("check lie.g2o"), "lie.g2o:" + std::to_string(line_of(plan, words)),
                 why);
}

/// The constraints that `check` finds violated.
std::string violated_by(const PlanText& plan) {
  const CommandRunner runner;
  runner.write("lie.g2o", plan.text());
  const Outcome outcome = runner.run("check lie.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json report = outcome.json();
  std::string names = " ";
  for (const nlohmann::json& violation : report["violations"]) {
    if (violation["violated"] == true) names += violation["constraint"].get<std::string>() + ' ';
  }
  return names;
}

TEST(LyingMotion, TheHonestOneIsFeasible) {
  const CommandRunner runner;
  runner.write("plan.g2o", standing_segments().text());
  const Outcome outcome = runner.run("check plan.g2o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(LyingMotion, ASegmentIsMissing) {
  PlanText plan = standing_segments();
  std::erase_if(plan.parameters,
                [](const std::string& line) { return line.starts_with("PARAMS_SEGMENT 20"); });
  expect_no_plan(plan, "PARAMS_SEGMENT 21", "segment 1 without those before it");
  plan = standing_segments();
  plan.parameters.pop_back();
  expect_no_plan(plan, "PARAMS_SEGMENT 20",
                 "segment 0 is the last one and ends at 1.000000 s, expected segments until the "
                 "plan ends, 2.000000 s");
}

TEST(LyingMotion, TheConfigurationsOfASegmentAreMissing) {
  PlanText plan = standing_segments();
  plan.configurations.resize(3);
  expect_no_plan(plan, "PARAMS_SEGMENT 21",
                 "segment 1 ends at 2.000000 s, where no configuration is");
  plan = standing_segments();
  plan.configurations.erase(plan.configurations.begin(), plan.configurations.begin() + 2);
  expect_no_plan(plan, "PARAMS_SEGMENT 20",
                 "segment 0 begins at 0.000000 s, expected the plan's beginning, 1.000000 s");
}

TEST(LyingMotion, ASegmentIsThereTwice) {
  PlanText plan = standing_segments();
  plan.parameters.push_back("PARAMS_SEGMENT 22 1 8 1 1 again");
  expect_no_plan(plan, "PARAMS_SEGMENT 22", "segment 1 is there twice");
}

TEST(LyingMotion, ASegmentTakesAnotherTimeThanItsConfigurations) {
  PlanText plan = standing_segments();
  replace_line(plan, "PARAMS_SEGMENT 21", "PARAMS_SEGMENT 21 1 8 1 0.9 x");
  expect_no_plan(plan, "PARAMS_SEGMENT 21",
                 "segment 1 ends at 1.900000 s, where no configuration is");
  replace_line(plan, "PARAMS_SEGMENT 21", "PARAMS_SEGMENT 21 1 8 1.1 0.9 x");
  expect_no_plan(plan, "PARAMS_SEGMENT 21",
                 "segment 1 begins at 1.100000 s, expected the end of the segment before, "
                 "1.000000 s");
  replace_line(plan, "PARAMS_SEGMENT 21", "PARAMS_SEGMENT 21 1 8 1 0 x");
  expect_no_plan(plan, "PARAMS_SEGMENT 21", "a duration of 0.000000 s");
}

TEST(LyingMotion, ASegmentIsInAnotherStanceThanItsConfigurations) {
  PlanText plan = standing_segments();
  replace_line(plan, "PARAMS_SEGMENT 21", "PARAMS_SEGMENT 21 1 6 1 1 x");
  expect_no_plan(plan, "PARAMS_SEGMENT 21", "segment 1 is in stance 6");
  replace_line(plan, "PARAMS_SEGMENT 21", "PARAMS_SEGMENT 21 1 5 1 1 x");
  expect_no_plan(plan, "PARAMS_SEGMENT 21", "PARAMS_CONTACT");
}

TEST(LyingMotion, ASegmentTakesNoTime) {
  PlanText plan = standing_segments();
  replace_line(plan, "PARAMS_SEGMENT 21", "PARAMS_SEGMENT 21 1 6 0 1 x");
  replace_line(plan, "PARAMS_SEGMENT 20", "PARAMS_SEGMENT 20 0 8 0 1e-9 lie");
  plan.parameters.push_back("PARAMS_SEGMENT 22 2 8 1 1 x");
  expect_no_plan(plan, "PARAMS_SEGMENT 20", "segment 0 takes no time");
}

TEST(LyingMotion, APlanOfStancesHasSegments) {
  // It is a motion, then, and judged as one.
  PlanText plan = standing_segments();
  replace_line(plan, "PARAMS_PLAN", "PARAMS_PLAN 1 3 stances_only");
  plan.configurations[3].time_s = plan.configurations[2].time_s + 1e-3;
  plan.configurations[3].q[20] += 0.3;
  EXPECT_NE(violated_by(plan).find(" velocity_limits "), std::string::npos);
  // And it is told so.
  const CommandRunner runner;
  runner.write("plan.g2o", plan.text());
  const Outcome text = runner.run("check plan.g2o"), json = runner.run("check plan.g2o --json");
  EXPECT_NE(text.out.find("judged as a motion: it says stances_only"), std::string::npos)
      << text.out;
  EXPECT_EQ(json.json()["stances_only"], false);
  EXPECT_EQ(json.json()["says_stances_only"], true);
}

TEST(LyingMotion, WrenchesActWhereNoStanceIs) {
  PlanText plan = standing_segments();
  std::erase_if(plan.parameters,
                [](const std::string& line) { return line.starts_with("PARAMS_SEGMENT"); });
  for (std::string& line : plan.parameters) {
    if (line.starts_with("PARAMS_STANCE 6")) line = "PARAMS_STANCE 6 1 4";
    if (line.starts_with("PARAMS_STANCE 8")) line = "PARAMS_STANCE 8 1 4";
  }
  const std::size_t lines = plan.parameters.size() + plan.configurations.size();
  const CommandRunner runner;
  runner.write("lie.g2o", plan.text() +
                              "VERTEX_WRENCHES 20 2 4 5 0 0 0 0 0 0 0 0 0 0 0 0\n"
                              "EDGE_BALANCE 7 20 scalar 1\n");
  expect_refusal(runner.run("check lie.g2o"), "lie.g2o:" + std::to_string(lines + 1),
                 "configuration 7 has wrenches at contact 5, which no stance of it has");
  runner.write("twice.g2o", plan.text() +
                                "VERTEX_WRENCHES 20 1 4 0 0 0 0 0 0\n"
                                "VERTEX_WRENCHES 21 1 4 0 0 0 0 0 0\n"
                                "EDGE_BALANCE 7 20 scalar 1\n"
                                "EDGE_BALANCE 7 21 scalar 1\n");
  expect_refusal(runner.run("check twice.g2o"), "twice.g2o:" + std::to_string(lines + 2),
                 "configuration 7 has wrenches twice");
}

TEST(LyingMotion, NamesAScenarioThatIsNone) {
  PlanText plan = standing_segments();
  plan.parameters.push_back("PARAMS_SCENARIO 3 stadning_up");
  const CommandRunner runner;
  runner.write("lie.g2o", plan.text());
  expect_refusal(runner.run("check lie.g2o"), "lie.g2o:" + std::to_string(plan.parameters.size()),
                 "stadning_up: no such scenario");
}

TEST(LyingMotion, TimesStandStill) {
  PlanText plan = standing_segments();
  std::erase_if(plan.parameters,
                [](const std::string& line) { return line.starts_with("PARAMS_SEGMENT"); });
  plan.configurations[3].time_s = plan.configurations[2].time_s;
  EXPECT_NE(violated_by(plan).find(" time_order "), std::string::npos);
  const CommandRunner runner;
  // An edge over them that needs a duration: for who evaluates it, it is the one that is wrong.
  runner.write("lie.g2o", plan.text() + "EDGE_ACCELERATION_LIMITS 8 9 10 30" +
                              " 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1"
                              " scalar 1\n");
  const std::string line =
      "lie.g2o:" + std::to_string(plan.parameters.size() + plan.configurations.size() + 1);
  for (const char* command : {"optimize lie.g2o --lenient --quiet", "info lie.g2o"}) {
    expect_refusal(runner.run(command), line, "expected times that increase");
  }
}

TEST(LyingMotion, AConfigurationThatWasEditedMissesItsContacts) {
  PlanText plan = standing_segments();
  plan.configurations[1].q[2] += 0.002;
  EXPECT_NE(violated_by(plan).find(" contact_position "), std::string::npos);
}

TEST(LyingMotion, ATransitionIsNotBalancedOnTheStanceAfterIt) {
  PlanText plan = standing_segments();
  // The robot lifts its right foot at once: its weight is between its feet.
  replace_line(plan, "PARAMS_STANCE 8", "PARAMS_STANCE 8 1 4");
  EXPECT_EQ(violated_by(plan), " static_balance ");
  // In the stance that it ends in, too.
  plan = standing_segments();
  plan.parameters.insert(plan.parameters.end() - 2, "PARAMS_STANCE 9 1 4");
  plan.configurations.back().stance = "9";
  EXPECT_EQ(violated_by(plan), " static_balance ");
}

TEST(LyingMotion, ATransitionIsNotWhereTheStanceAfterItStands) {
  PlanText plan = standing_segments();
  // The left sole again, one centimetre ahead.
  std::istringstream fields(
      plan.parameters.at(static_cast<std::size_t>(line_of(plan, "PARAMS_CONTACT 4 ") - 1)));
  std::string moved, word;
  for (int i = 0; fields >> word; ++i) {
    if (i == 1) word = "14";
    if (i == 20) {
      ASSERT_EQ(moved.substr(moved.size() - 4), " at ");
      std::ostringstream ahead;
      ahead.precision(17);
      ahead << std::stod(word) + 0.01;
      word = ahead.str();
    }
    moved += word + ' ';
  }
  plan.parameters.insert(plan.parameters.begin() + line_of(plan, "PARAMS_CONTACT 5 "), moved);
  replace_line(plan, "PARAMS_STANCE 8", "PARAMS_STANCE 8 2 5 14");
  EXPECT_NE(violated_by(plan).find(" contact_position "), std::string::npos);
}

}  // namespace
}  // namespace locograph
