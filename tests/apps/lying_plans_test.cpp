// Plan files that lie: `check` refuses each of them by the name of what it breaks.
#include <apps/command_runner.h>

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
  for (PlanText::Configuration& c : fewer.configurations) c.q.resize(8);
  runner.write("fewer.g2o", with_robot(fewer, stem + ".urdf other.srdf floating 1 fewer"));
  const Outcome outcome = runner.run("check fewer.g2o");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_NE(outcome.err.find("moves other joints"), std::string::npos) << outcome.err;
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
