// Contact tasks that cannot be planned, with the whole answer to each.
#include <apps/command_runner.h>
#include <apps/shipped_scenario.h>

#include <vector>

namespace locograph::stance_bad_input_test {
namespace {

using test::goal_on_all_fours, test::line_of, test::part, test::shipped, test::standing_up_with,
    test::with, test::with_far_floor;

const char kFloor[] =
    "<plane name=\"floor\" center=\"0 0 0\" normal=\"0 0 1\" forward=\"1 0 0\" size=\"5 2\"/>";

std::string standing_up(const std::string& find, const std::string& replace) {
  return with(shipped("standing_up"), find, replace);
}

std::string standing_on_the_left_hand() {
  const std::string text = shipped("standing_up"), start = part(text, "<start", "</start>");
  const std::string hand = part(start, "<contact end_effector=\"left_hand\"", "/>");
  return with(text, start, with(start, part(start, "<contact", "</start>"), hand + "\n</start>"));
}

std::string with_goal_of_unknown_hand() {
  const std::string goal = part(shipped("standing_up"), "<goal>", "</goal>");
  return standing_up_with(with(goal, "\"left_hand\"", "\"left_hnd\""));
}

/// The floor of standing_up from x = -2.5 to 2.5 and y = -1 to 1, without this rectangle of it.
std::string floor_with_hole(double least_x, double most_x, double least_y, double most_y) {
  const double outer[4][2] = {{-2.5, -1.0}, {2.5, -1.0}, {2.5, 1.0}, {-2.5, 1.0}};
  const double inner[4][2] = {
      {least_x, least_y}, {most_x, least_y}, {most_x, most_y}, {least_x, most_y}};
  std::string stl = "solid floor\n";
  const auto corner = [&stl](const double* xy) {
    stl += "vertex " + std::to_string(xy[0]) + ' ' + std::to_string(xy[1]) + " 0\n";
  };
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    for (const bool first : {true, false}) {
      stl += "facet normal 0 0 1\nouter loop\n";
      corner(outer[i]);
      corner(first ? outer[next] : inner[next]);
      corner(first ? inner[next] : inner[i]);
      stl += "endloop\nendfacet\n";
    }
  }
  return stl + "endsolid floor\n";
}

const char kEmptyCloud[] =
    "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA ascii\n";

/// What is wrong, and the whole answer; * stands for what another solver may say differently.
struct BadTask {
  const char* name;
  std::string text;     ///< of bad.xml
  std::string blamed;   ///< what its line begins with or holds; empty: another file's line
  std::string message;  ///< behind bad.xml:LINE:
};

void PrintTo(const BadTask& bad, std::ostream* out) { *out << bad.name; }

std::vector<BadTask> bad_tasks() {
  const std::string known =
      ", expected one of left_foot, right_foot, left_hand, right_hand; did you mean 'left_hand'?";
  const std::string urdf = "robots/models/coman_plus/coman_plus.urdf: ";
  const std::string start = "no configuration stands at the start: ";
  const std::string held = ", expected contacts that can be held";
  return {
      {"NoGoal", standing_up_with(""), "<start", "a <start> without a <goal>, expected both"},
      {"AnUnknownEndEffectorAtTheStart",
       standing_up("contact end_effector=\"left_hand\"", "contact end_effector=\"left_hnd\""),
       "\"left_hnd\"", "unknown end effector 'left_hnd'" + known},
      {"AnUnknownEndEffectorAtTheGoal", with_goal_of_unknown_hand(), "\"left_hnd\"",
       "unknown end effector 'left_hnd'" + known},
      {"AGoalOnNothing", standing_up_with(goal_on_all_fours("1.7 0.1 0.3")), "<goal>",
       "the contact of left_hand touches nothing (the nearest, floor, is 0.3 m away), expected one "
       "on a surface or a bar of the environment"},
      {"AnUnknownLink", standing_up("link=\"LBall\"", "link=\"LBal\""), "\"LBal\"",
       urdf + "no link 'LBal', expected one like 'LBall', 'RBall', 'Head'"},
      {"ACameraOnAnUnknownLink",
       standing_up("<robot model=\"coman_plus\"/>",
                   "<robot model=\"coman_plus\">\n<camera name=\"eye\" link=\"Hed\" width=\"4\" "
                   "height=\"3\" fov_x=\"1\" range_min=\"0\" range_max=\"5\"/>\n</robot>"),
       "\"Hed\"", urdf + "no link 'Hed', expected one like *"},
      {"AnUnknownJoint", standing_up("\"LHipSag\"", "\"LHipSgg\""), "\"LHipSgg\"",
       urdf + "no joint 'LHipSgg', expected one like 'LHipSag', 'RHipSag', 'LHipLat'"},
      {"NegativeFrictionOfTheEnvironment", standing_up("friction=\"0.5\"", "friction=\"-0.5\""),
       "friction=\"-0.5\"", "friction is -0.5, expected a number > 0 to 1000"},
      {"NegativeFrictionOfAPlane", standing_up("name=\"floor\"", "name=\"floor\" friction=\"-1\""),
       "name=\"floor\"", "friction is -1, expected a number > 0 to 1000"},
      {"APlaneOfNoSize", standing_up("size=\"5 2\"", "size=\"0 2\""), "size=\"0 2\"",
       "size=\"0 2\", expected numbers from 1e-06 to 1e+06"},
      // 4.9 m aside, on a floor that is there.
      {"AStartThatDoesNotTouch",
       with(standing_up("size=\"5 2\"", "size=\"5 12\""), "1.7 0.1 0", "1.7 5 0"), "<start",
       start +
           "contact of left_hand not closed by *; as given, contact_position (left_hand) is "
           "4.9 m, limit 0.0001 m" +
           held},
      {"AStartThatDoesNotBalance", standing_on_the_left_hand(), "<start",
       start +
           "the contacts balance the robot nowhere; as given, static_balance (a moment on the "
           "base is left over) is -0.1*, limit 0" +
           held},
      {"AHoleUnderAFoot", standing_up(kFloor, "<mesh name=\"floor\" file=\"hole.stl\"/>"), "<start",
       start + "contact_on_surface (left_foot is beyond the border of floor *" + held},
      {"AnEmptyCloud", standing_up(kFloor, "<cloud name=\"floor\" file=\"empty.pcd\"/>"), "",
       "empty.pcd: holds no finite point, expected points"},
  };
}

class BadStanceTask : public testing::TestWithParam<BadTask> {};

TEST_P(BadStanceTask, IsRefusedWithItsLineAndNothingIsWritten) {
  const auto& [name, text, blamed, message] = GetParam();
  const CommandRunner runner;
  runner.write("bad.xml", text);
  runner.write("hole.stl", floor_with_hole(0.8, 1.2, -0.1, 0.2));
  runner.write("empty.pcd", kEmptyCloud);
  const Outcome outcome = runner.run("plan bad.xml --stances-only -o out.g2o");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(runner.exists("out.g2o"));
  std::string said = outcome.err;
  for (const std::string& folder : {runner.folder().string(), std::string(LOCOGRAPH_SOURCE_DIR)}) {
    if (said.find(folder + '/') != std::string::npos) said = with(said, folder + '/', "");
  }
  const std::string place = blamed.empty() ? "" : "bad.xml:" + line_of(text, blamed) + ": ";
  const std::string expected = "locograph: " + place + message + '\n';
  const std::size_t star = expected.find('*');
  if (star == std::string::npos) {
    EXPECT_EQ(said, expected);
  } else {
    EXPECT_EQ(said.substr(0, star), expected.substr(0, star)) << said;
    EXPECT_TRUE(said.ends_with(expected.substr(star + 1))) << said;
  }
}

INSTANTIATE_TEST_SUITE_P(StanceBadInput, BadStanceTask, testing::ValuesIn(bad_tasks()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(StanceBadInput, AMeshWithAHoleIsAFloorAroundIt) {
  const CommandRunner runner;
  runner.write("hole.stl", floor_with_hole(0.0, 0.5, -0.3, 0.3));
  runner.write("s.xml", standing_up(kFloor, "<mesh name=\"floor\" file=\"hole.stl\"/>"));
  const Outcome outcome = runner.run("plan s.xml --stances-only -o plan.g2o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  const Outcome checked = runner.run("check plan.g2o");
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
}

TEST(StanceBadInput, AStartThatIsNearlyRightIsMendedAndTheAnswerSaysByHowMuch) {
  const CommandRunner runner;
  runner.write("s.xml", standing_up_with(goal_on_all_fours("1.7 0.1 0")));
  const std::string plan = "plan s.xml --stances-only -o plan.g2o";
  const nlohmann::json moved = runner.run(plan + " --json").json()["start_moved"];
  EXPECT_GT(moved["base_m"], 1e-3) << "the published hands are inside the floor";
  EXPECT_LT(moved["base_m"], 0.05);
  EXPECT_GT(moved["joint_rad"], 1e-3);
  const std::string words = runner.run(plan).out;
  EXPECT_EQ(words.find("standing_up: the start is not feasible as given; the nearest is 0.0"), 0u)
      << words;
}

TEST(StanceBadInput, WhereTheSecondGoalIsOutOfReachTheWayToTheFirstIsKept) {
  const CommandRunner runner;
  const std::string first = part(shipped("standing_up"), "<goal>", "</goal>");
  runner.write("two.xml",
               with_far_floor(standing_up_with(first + '\n' + goal_on_all_fours("51 0.1 0"))));
  const Outcome outcome =
      runner.run("plan two.xml --stances-only --max-transitions 300 -o part.g2o --json");
  ASSERT_EQ(outcome.exit_code, 1) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err.find("the way up to there is planned"), std::string::npos) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], false);
  EXPECT_EQ(json["goals_reached"], 1);
  EXPECT_GE(json["best"]["stances"], 9) << "four end effectors were lifted and put down";
  const std::string reason = json["reason"];
  EXPECT_TRUE(reason.starts_with(
      "goal 2 of 2 is not reached: the transitions allowed are used up (allow more); "))
      << reason;
  EXPECT_NE(reason.find("left_hand"), std::string::npos) << reason;
  const Outcome checked = runner.run("check part.g2o --json");
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  EXPECT_EQ(checked.json()["incomplete"], true);
  EXPECT_EQ(checked.json()["configurations"], json["best"]["stances"]);
}

}  // namespace
}  // namespace locograph::stance_bad_input_test
