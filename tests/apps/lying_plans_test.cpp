// Plan files that lie: `check` refuses each of them by the name of what it breaks.
#include <apps/command_runner.h>
#include <locograph/common/input_file.h>

#include <algorithm>
#include <cmath>

#include "apps/standing_plan.h"

namespace locograph {
namespace {

/// Whether `check` says no, and names this constraint.
::testing::AssertionResult refused(const CommandRunner& runner, const std::string& plan,
                                   const std::string& constraint) {
  runner.write("lie.g2o", plan);
  const Outcome outcome = runner.run("check lie.g2o --json");
  if (outcome.exit_code != 1) {
    return ::testing::AssertionFailure() << "exit code " << outcome.exit_code << outcome.err;
  }
  const nlohmann::json report = outcome.json();
  std::string violated;
  for (const nlohmann::json& violation : report["violations"]) {
    if (violation["violated"] != true) continue;
    if (violation["constraint"] == constraint) return ::testing::AssertionSuccess();
    violated += violation["constraint"].get<std::string>() + ' ';
  }
  return ::testing::AssertionFailure() << "refused for " << violated << "only";
}

class Drive : public CommandRunner {
 public:
  Drive() {
    const Outcome outcome = run("plan centauro_drive -o plan.g2o");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  PlanText plan() const { return PlanText(read("plan.g2o")); }
};

TEST(LyingPlan, TheHumanoidIsRaisedWithItsContactsStillInTheFile) {
  PlanText plan(squat("2 4 5"));
  plan.configurations[0].q[2] += 1.0;
  EXPECT_TRUE(refused(CommandRunner(), plan.text(), "contact_position"));
}

TEST(LyingPlan, SolesSlideAMetreWhileInContact) {
  PlanText plan(squat("2 4 5"));
  plan.repeat_first(21, 0.5);
  for (std::size_t i = 0; i < 21; ++i) plan.configurations[i].q[0] += 0.05 * static_cast<double>(i);
  EXPECT_TRUE(refused(CommandRunner(), plan.text(), "contact_motion"));
}

TEST(LyingPlan, ItFloatsAtFiftyMetresAndJumpsAHundredInAMillisecond) {
  PlanText plan(squat("2 4 5"));
  plan.repeat_first(2, 0.001);
  for (PlanText::Configuration& c : plan.configurations) c.q[2] += 50.0;
  plan.configurations[1].q[0] += 100.0;
  EXPECT_TRUE(refused(CommandRunner(), plan.text(), "contact_position"));
  for (PlanText::Configuration& c : plan.configurations) c.stance = "-";
  EXPECT_TRUE(refused(CommandRunner(), plan.text(), "stance"));
}

TEST(LyingPlan, TheRobotStandsOnWheelsThatAreAllBehindItsCentreOfMass) {
  const Drive runner;
  PlanText plan = runner.plan();
  bool found = false;
  for (std::string& line : plan.parameters) {
    std::istringstream fields(line);
    std::string tag, number, count, first, second, third, fourth;
    fields >> tag >> number >> count >> first >> second >> third >> fourth;
    if (tag != "PARAMS_STANCE") continue;
    EXPECT_EQ(count, "4");
    line = tag + ' ' + number + " 2 " + third + ' ' + fourth;
    found = true;
  }
  ASSERT_TRUE(found);
  EXPECT_TRUE(refused(runner, plan.text(), "static_balance"));
}

TEST(LyingPlan, WheelsThatDoNotTurnGoSidewaysInSmallSteps) {
  const Drive runner;
  PlanText plan = runner.plan();
  plan.repeat_first(1001, 0.1);
  for (std::size_t i = 0; i <= 1000; ++i)
    plan.configurations[i].q[1] += 4.9e-3 * static_cast<double>(i);
  EXPECT_TRUE(refused(runner, plan.text(), "lateral_slip"));
}

TEST(LyingPlan, WheelsThatDoNotTurnGoAt49MetresASecond) {
  const Drive runner;
  PlanText plan = runner.plan();
  plan.repeat_first(50, 1e-4);
  for (std::size_t i = 0; i < 50; ++i)
    plan.configurations[i].q[0] += 4.9e-3 * static_cast<double>(i);
  EXPECT_TRUE(refused(runner, plan.text(), "longitudinal_slip"));
}

TEST(LyingPlan, ItTurnsNineRadiansOnTheSpot) {
  const Drive runner;
  PlanText plan = runner.plan();
  plan.repeat_first(901, 0.1);
  for (std::size_t i = 0; i <= 900; ++i) {
    plan.configurations[i].q[5] = std::sin(0.005 * static_cast<double>(i));
    plan.configurations[i].q[6] = std::cos(0.005 * static_cast<double>(i));
  }
  EXPECT_TRUE(refused(runner, plan.text(), "lateral_slip"));
}

TEST(LyingPlan, ASecondWorldHidesTheBox) {
  const Drive runner;
  runner.write("box.xml",
               "<obstacles version=\"1\"><box name=\"box\" center=\"2 0 0.25\" size=\"0.5 0.5 "
               "0.5\"/></obstacles>\n");
  PlanText plan = runner.plan();
  for (std::string& line : plan.parameters)
    if (line.rfind("PARAMS_WORLD", 0) == 0) line = "PARAMS_WORLD 2 - box.xml";
  EXPECT_TRUE(refused(runner, plan.text(), "obstacle_distance"));
  plan.parameters.push_back("PARAMS_WORLD 90 - -");
  runner.write("lie.g2o", plan.text());
  const Outcome outcome = runner.run("check lie.g2o");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("a second PARAMS_WORLD"), std::string::npos) << outcome.err;
}

TEST(LyingPlan, ItsGroundIsHigherThanTheScenariosOne) {
  const Drive runner;
  PlanText plan = runner.plan();
  int line = 0;
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    if (plan.parameters[i].rfind("PARAMS_WORLD", 0) != 0) continue;
    plan.parameters[i] = "PARAMS_WORLD 2 - - ground 0.5";
    line = static_cast<int>(i) + 1;
  }
  runner.write("lie.g2o", plan.text());
  expect_refusal(runner.run("check lie.g2o"), "lie.g2o:" + std::to_string(line),
                 "a ground at 0.500000 m, expected that of the world in which the plan is judged, "
                 "a ground at 0.000000 m");
}

TEST(LyingPlan, AVertexThatIsFixedIsBeyondItsLimit) {
  const Drive runner;
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  const Robot robot =
      Robot::load(stem + ".urdf", stem + ".srdf", RobotOptions{.active_joints = {"lower_body"}});
  PlanText plan = runner.plan();
  PlanText::Configuration& vertex = plan.configurations[20];
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    if (robot.active_joint(i).name != "knee_pitch_1") continue;
    vertex.q[static_cast<std::size_t>(7 + i)] = robot.active_joint(i).upper + 0.47;
  }
  EXPECT_TRUE(
      refused(runner, plan.text() + "FIX " + std::to_string(vertex.id) + '\n', "joint_limits"));
}

/// The plan's robot by these words instead of its own.
std::string with_robot(PlanText plan, const std::string& robot) {
  for (std::string& line : plan.parameters) {
    if (line.rfind("PARAMS_ROBOT", 0) != 0) continue;
    std::istringstream fields(line);
    std::string tag, number;
    fields >> tag >> number;
    line = tag + ' ' + number + ' ' + robot;
  }
  return plan.text();
}

TEST(LyingPlan, LinksMayMeetAndJointsMoveAsTheScenariosRobotSays) {
  const Drive runner;
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  std::ifstream in(stem + ".srdf");
  std::string srdf((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  srdf.insert(srdf.find("</robot>"),
              "<group name=\"fewer\"><joint name=\"knee_pitch_1\"/></group>\n");
  runner.write("other.srdf", srdf);
  // Another file with the same words: the scenario's is taken, and the plan is what it was.
  runner.write("same.g2o",
               with_robot(runner.plan(), stem + ".urdf other.srdf floating 1 lower_body"));
  EXPECT_EQ(runner.run("check same.g2o").exit_code, 0);
  PlanText fewer = runner.plan();
  fewer.without_slopes();
  for (PlanText::Configuration& c : fewer.configurations) c.q.resize(8);
  runner.write("fewer.g2o", with_robot(fewer, stem + ".urdf other.srdf floating 1 fewer"));
  const Outcome outcome = runner.run("check fewer.g2o");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_NE(outcome.err.find("moves other joints"), std::string::npos) << outcome.err;
}

TEST(LyingPlan, RefineJudgesEveryStepByTheScenariosRobot) {
  const Drive runner;
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  // No two links may meet, not even neighbours.
  std::istringstream srdf(read_file(stem + ".srdf"));
  std::string strict;
  for (std::string line; std::getline(srdf, line);) {
    if (line.find("disable_collisions") == std::string::npos) strict += line + '\n';
  }
  runner.write("strict.srdf", strict);
  runner.write("plan.g2o",
               with_robot(runner.plan(), stem + ".urdf strict.srdf floating 1 lower_body"));
  const Outcome outcome = runner.run("refine plan.g2o -o refined.g2o --json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.json()["configurations"], 50);
}

TEST(LyingPlan, ASecondScenarioIsKinder) {
  const Drive runner;
  PlanText plan = runner.plan();
  plan.parameters.push_back("PARAMS_SCENARIO 99 centauro_drive");
  runner.write("lie.g2o", plan.text());
  const Outcome outcome = runner.run("check lie.g2o");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("a second PARAMS_SCENARIO"), std::string::npos) << outcome.err;
}

TEST(LyingPlan, AWheelTouchesTwice) {
  const Drive runner;
  PlanText plan = runner.plan();
  // Without a name it is called as its link: the wheel that touches already.
  const std::string wheel = "PARAMS_CONTACT 10 0 wheel_1 ";
  std::string again;
  for (std::string& line : plan.parameters) {
    if (line.starts_with(wheel)) {
      again = "PARAMS_CONTACT 90 0 \"\" " + line.substr(wheel.size());
    }
    if (line == "PARAMS_STANCE 14 4 10 11 12 13") line = "PARAMS_STANCE 14 5 10 11 12 13 90";
  }
  ASSERT_NE(again.find(" at 0 0 0 "), std::string::npos) << again;
  plan.parameters.insert(plan.parameters.end() - 1, again);
  runner.write("same.g2o", plan.text());
  const Outcome same = runner.run("check same.g2o");
  EXPECT_EQ(same.exit_code, 2) << same.out;
  EXPECT_NE(same.err.find("are the same, of wheel_1"), std::string::npos) << same.err;
  // A rolling wheel touches anywhere in its plane: at another place it is another contact.
  std::string& second = *(plan.parameters.end() - 2);
  second.replace(second.find(" at 0 0 0 "), 10, " at 1 0 0 ");
  EXPECT_TRUE(refused(runner, plan.text(), "contact_claims"));
  EXPECT_NE(runner.run("check lie.g2o").out.find("wheel_1 touches twice"), std::string::npos);
}

TEST(LyingPlan, ADriveBeginsLaterOrEndsEarlier) {
  const Drive runner;
  PlanText late = runner.plan(), early = late;
  late.configurations.erase(late.configurations.begin(), late.configurations.begin() + 5);
  EXPECT_TRUE(refused(runner, late.text(), "scenario_start"));
  early.configurations.resize(40);
  EXPECT_TRUE(refused(runner, early.text(), "scenario_goals"));
  const nlohmann::json json = runner.run("check lie.g2o --json").json();
  EXPECT_EQ(json["start"], true);
  EXPECT_EQ(json["goals_reached"], 0);
  EXPECT_EQ(json["goals"], 1);
}

/// standing_up, planned with these options.
class StandingUp : public CommandRunner {
 public:
  explicit StandingUp(const std::string& options = "") {
    const Outcome outcome = run("plan standing_up --stances-only --seed 3 -o plan.g2o " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  }
  PlanText plan() const { return PlanText(read("plan.g2o")); }
  /// The plan with another PARAMS_PLAN.
  PlanText plan_that_says(const std::string& words) const {
    PlanText text = plan();
    for (std::string& line : text.parameters) {
      if (line.starts_with("PARAMS_PLAN ")) line = "PARAMS_PLAN 1 3 stances_only " + words;
    }
    return text;
  }
};

TEST(LyingPlan, APlanOfStancesBeginsElsewhereOrDoesNotArrive) {
  const StandingUp runner;
  PlanText late = runner.plan(), early = late;
  late.configurations.erase(late.configurations.begin());
  EXPECT_TRUE(refused(runner, late.text(), "scenario_start"));
  early.configurations.pop_back();
  EXPECT_TRUE(refused(runner, early.text(), "scenario_goals"));
  // What says that it is a part may end early, and begins at the start all the same.
  late = runner.plan_that_says("incomplete");
  late.configurations.erase(late.configurations.begin());
  EXPECT_TRUE(refused(runner, late.text(), "scenario_start"));
  early = runner.plan_that_says("incomplete");
  early.configurations.pop_back();
  runner.write("part.g2o", early.text());
  const Outcome part = runner.run("check part.g2o --json");
  EXPECT_EQ(part.exit_code, 0) << part.out;
  EXPECT_EQ(part.json()["start"], true);
  EXPECT_EQ(part.json()["goals_reached"], 0);
  EXPECT_EQ(part.json()["incomplete"], true);
  const std::string words = runner.run("check part.g2o").out;
  EXPECT_NE(words.find("begins at the start, and reaches 0 of 1 goal"), std::string::npos) << words;
  EXPECT_NE(words.find("not judged: scenario_goals"), std::string::npos) << words;
}

TEST(LyingPlan, APlanThatNamesNoScenarioMissesTheEndsOfTheOneGiven) {
  const StandingUp runner;
  PlanText plan = runner.plan();
  std::erase_if(plan.parameters,
                [](const std::string& line) { return line.starts_with("PARAMS_SCENARIO "); });
  plan.configurations.erase(plan.configurations.begin());
  runner.write("late.g2o", plan.text());
  const Outcome outcome = runner.run("check late.g2o --scenario standing_up");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("scenario_start"), std::string::npos) << outcome.out;
}

TEST(LyingPlan, AClearanceIsJudgedHoweverOftenAStanceComesBack) {
  const StandingUp runner;
  PlanText plan = runner.plan();
  // To and fro between the first two stances, the first one under another number each time.
  const std::string first = plan.configurations[0].stance;
  const auto stance = std::ranges::find_if(plan.parameters, [&](const std::string& line) {
    return line.starts_with("PARAMS_STANCE " + first + " ");
  });
  ASSERT_NE(stance, plan.parameters.end());
  const std::string contacts = stance->substr(("PARAMS_STANCE " + first).size());
  const PlanText::Configuration there = plan.configurations[1];
  for (int i = 0; i < 30; ++i) {
    const std::string number = std::to_string(1000 + i);
    plan.parameters.push_back("PARAMS_STANCE " + number + contacts);
    PlanText::Configuration back = there, again = there;
    back.id = 1000 + 2 * i;
    again.id = back.id + 1;
    back.stance = number;
    plan.configurations.insert(plan.configurations.begin() + 2, {back, again});
  }
  for (std::size_t i = 0; i < plan.configurations.size(); ++i) {
    plan.configurations[i].time_s = static_cast<double>(i);
  }
  runner.write("often.g2o", plan.text());
  EXPECT_EQ(runner.run("check often.g2o").exit_code, 0);
  const Outcome outcome = runner.run("check often.g2o --clearance 0.0001");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(LyingPlan, AnotherScenarioHasOtherGoals) {
  const StandingUp runner;
  std::ifstream in(LOCOGRAPH_SOURCE_DIR "/planners/scenarios/standing_up.xml");
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string goal = "position=\"1.4 0.1 0\"";
  ASSERT_NE(text.find(goal), std::string::npos);
  text.replace(text.find(goal), goal.size(), "position=\"1.4 0.15 0\"");
  runner.write("other.xml", text);
  const Outcome outcome = runner.run("check plan.g2o --scenario other.xml --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_TRUE(json["scenario"].get<std::string>().ends_with("/other.xml"));
  EXPECT_EQ(json["start"], true);
  EXPECT_EQ(json["goals_reached"], 0);
}

TEST(LyingPlan, ContactsAreMovedAsThePlanSaysAndNotOtherwise) {
  const StandingUp runner("--move-contacts 0.02");
  const Outcome honest = runner.run("check plan.g2o --json");
  EXPECT_EQ(honest.exit_code, 0) << honest.out;
  EXPECT_EQ(honest.json()["start"], true);
  EXPECT_EQ(honest.json()["goals_reached"], 1);
  EXPECT_EQ(honest.json()["moved_contacts"]["up_to_m"], 0.02);
  EXPECT_EQ(honest.json()["moved_contacts"]["seed"], 3);
  const std::string words = runner.run("check plan.g2o").out;
  EXPECT_NE(words.find("start and goals: that contacts are moved by up to 0.02 m"),
            std::string::npos)
      << words;
  EXPECT_TRUE(refused(runner, runner.plan_that_says("").text(), "scenario_goals"));
  EXPECT_TRUE(
      refused(runner, runner.plan_that_says("moved_contacts 0.02 4 1").text(), "scenario_goals"));
  EXPECT_TRUE(
      refused(runner, runner.plan_that_says("moved_contacts 0.5 3 1").text(), "scenario_start"));
}

TEST(LyingPlan, ARobotIsStrongerThanTheScenariosOne) {
  const Drive runner;
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  std::ifstream in(stem + ".urdf");
  std::string urdf((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t effort = urdf.find("effort=\"");
  ASSERT_NE(effort, std::string::npos);
  runner.write("strong.urdf", urdf.insert(effort + 8, "9"));
  PlanText plan = runner.plan();
  for (std::string& line : plan.parameters) {
    if (line.rfind("PARAMS_ROBOT", 0) != 0) continue;
    const std::string shipped = "model centauro";
    line.replace(line.find(shipped), shipped.size(), "strong.urdf " + stem + ".srdf");
  }
  runner.write("lie.g2o", plan.text());
  const Outcome outcome = runner.run("check lie.g2o");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_NE(outcome.err.find("is not the one of the scenario"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace locograph
