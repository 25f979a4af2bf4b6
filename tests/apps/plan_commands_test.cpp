// `plan`, `refine` and `check`, one after the other, as a user runs them.
#include <apps/command_runner.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/types/standard_types.h>
#include <locograph/world/octree.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "apps/shipped_scenario.h"
#include "apps/standing_plan.h"
#include "planners/ball_in_the_way.h"

namespace locograph {
namespace {

const char kBoxOnThePath[] =
    "<obstacles version=\"1\">\n"
    "  <box name=\"box\" center=\"2 0 0.25\" size=\"0.5 0.5 0.5\"/>\n"
    "</obstacles>\n";
const char kWall[] =
    "<obstacles version=\"1\">\n"
    "  <box name=\"wall\" center=\"2.5 0 0.5\" size=\"0.2 8 1\"/>\n"
    "</obstacles>\n";

/// A folder with the shipped drive as plan.g2o.
class PlanRunner : public CommandRunner {
 public:
  PlanRunner() {
    const Outcome outcome = run("plan centauro_drive -o plan.g2o");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  void write_map(const std::string& name) const {
    Box box;
    box.world_from_box.translation() = Eigen::Vector3d(2.0, 0.0, 0.25);
    box.size.setConstant(0.5);
    save_octree(*octree_from_boxes({&box, 1}, 0.05), folder() / name);
  }
  /// The line number of the first line that begins so, 0 if there is none.
  int line_of(const std::string& file, const std::string& begin) const {
    std::istringstream in(read(file));
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.rfind(begin, 0) == 0) return number;
    }
    return 0;
  }
};

const nlohmann::json* constraint(const nlohmann::json& report, const std::string& name) {
  for (const nlohmann::json& violation : report["violations"]) {
    if (violation["constraint"] == name) return &violation;
  }
  return nullptr;
}

TEST(PlanCommands, PlanPrintsOneJsonObjectWithEveryField) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("plan centauro_drive -o plan.g2o --seed 7 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], true);
  EXPECT_EQ(json["status"], "solved");
  EXPECT_TRUE(json["reason"].is_string());
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["configurations"], 50);
  EXPECT_NEAR(json["duration_s"], 40.0 + 2.0 * 4.0 / 49.0 / 0.1, 1e-9);
  for (const char* field : {"stances", "vertices_in_tree", "iterations", "segments"}) {
    EXPECT_TRUE(json[field].is_number_integer()) << field;
  }
  for (const char* phase :
       {"stance_planner", "transitions", "whole_body", "timing", "judge", "total"}) {
    EXPECT_GE(json["time"][phase].get<double>(), 0.0) << phase;
  }
  EXPECT_TRUE(runner.exists("plan.g2o"));
}

TEST(PlanCommands, APlanIsFeasibleUntilSomethingStandsInTheWay) {
  const PlanRunner runner;
  const Outcome good = runner.run("check plan.g2o --json");
  ASSERT_EQ(good.exit_code, 0) << good.err << good.out;
  EXPECT_EQ(good.json()["feasible"], true);
  EXPECT_EQ(good.json()["configurations"], 50);
  runner.write("box.xml", kBoxOnThePath);
  const Outcome bad = runner.run("check plan.g2o --obstacles box.xml --json");
  EXPECT_EQ(bad.exit_code, 1) << bad.err;
  EXPECT_EQ(bad.json()["feasible"], false);
  const nlohmann::json json = bad.json();
  const nlohmann::json* distance = constraint(json, "obstacle_distance");
  ASSERT_NE(distance, nullptr);
  EXPECT_EQ((*distance)["violated"], true);
  EXPECT_LT((*distance)["worst"], 0.0);
  EXPECT_EQ((*distance)["unit"], "m");
  EXPECT_GT((*distance)["count"], 0);
  EXPECT_EQ(runner.run("check plan.g2o --obstacles box.xml").exit_code, 1);
}

TEST(PlanCommands, CheckListsEveryConstraintAlsoThoseThatHold) {
  const PlanRunner runner;
  const nlohmann::json json = runner.run("check plan.g2o --json").json();
  for (const char* name :
       {"not_finite",       "configuration_size", "time_order",          "step_size",
        "base_orientation", "joint_limits",       "velocity_limits",     "obstacle_distance",
        "self_collision",   "ground_penetration", "touching_depth",      "stance",
        "contact_claims",   "contact_position",   "contact_orientation", "contact_between",
        "contact_motion",   "contact_on_surface", "lateral_slip",        "longitudinal_slip",
        "static_balance",   "torque_limits"}) {
    const nlohmann::json* violation = constraint(json, name);
    ASSERT_NE(violation, nullptr) << name;
    for (const char* field : {"judged", "worst", "unit", "limit", "at_vertex", "count"}) {
      EXPECT_TRUE(violation->contains(field)) << name << ' ' << field;
    }
    EXPECT_EQ((*violation)["count"], 0) << name;
  }
  for (const char* field :
       {"min_clearance_m", "min_self_clearance_m", "max_velocity_ratio", "max_contact_error_m"}) {
    EXPECT_TRUE(json[field].is_number()) << field;
  }
  EXPECT_GT(json["min_balance_margin"].get<double>(), 0.0);
  EXPECT_LE(json["max_torque_ratio"].get<double>(), 1.0);
  for (const auto& what : json["trusted"]) {
    EXPECT_EQ(what.get<std::string>().find("what it can bear"), std::string::npos)
        << "the scenario knows: " << what;
  }
}

TEST(PlanCommands, CheckRefusesWrenchesThatDoNotBalance) {
  const CommandRunner runner;
  runner.write("none.g2o", squat("2 4 5"));
  const nlohmann::json none = runner.run("check none.g2o --json").json();
  EXPECT_EQ((*constraint(none, "plan_wrenches"))["judged"], false);
  const auto with = [&](const std::string& first) {
    runner.write("some.g2o", squat("2 4 5") + "VERTEX_WRENCHES 20 2 4 5 " + first +
                                 " 0 0 0 0 0 0 0 0 0 0 0\nEDGE_BALANCE 7 20 scalar 1\n");
    return runner.run("check some.g2o --json");
  };
  const Outcome zero = with("0");
  EXPECT_EQ(zero.exit_code, 1);
  const nlohmann::json wrenches = *constraint(zero.json(), "plan_wrenches");
  EXPECT_EQ(wrenches["violated"], true);
  // All of the weight is left over, a thousand times what may be.
  EXPECT_GE(wrenches["worst"].get<double>(), 1000.0);
  EXPECT_NE(wrenches["what"].get<std::string>().find("left over"), std::string::npos);
  const Outcome not_finite = with("nan");
  EXPECT_NE(not_finite.exit_code, 0);
}

TEST(PlanCommands, CheckTellsRobustnessWhereItIsAskedFor) {
  const CommandRunner runner;
  runner.write("both.g2o", squat("2 4 5"));
  const nlohmann::json plain = runner.run("check both.g2o --json").json();
  EXPECT_FALSE(plain.contains("robustness"));
  const Outcome asked = runner.run("check both.g2o --robustness --json");
  const nlohmann::json json = asked.json();
  EXPECT_EQ(json["feasible"], plain["feasible"]);
  EXPECT_EQ(json["violations"], plain["violations"]);
  for (const char* figure : {"friction", "area", "torque", "push_N", "mass"}) {
    EXPECT_GT(json["robustness"][figure].get<double>(), 0.0) << figure;
    EXPECT_EQ(json["robustness"]["by_stance"].at(0)[figure], json["robustness"][figure]);
  }
  EXPECT_LT(json["robustness"]["friction"].get<double>(), 1.0);
  EXPECT_NE(runner.run("check both.g2o --robustness").out.find("holds until friction"),
            std::string::npos);
}

TEST(PlanCommands, CheckJudgesBalanceAndTorquesOnTheStanceOfAPlan) {
  const CommandRunner runner;
  runner.write("both.g2o", squat("2 4 5"));
  const nlohmann::json both = runner.run("check both.g2o --json").json();
  EXPECT_GT(both["min_balance_margin"].get<double>(), 0.19);
  EXPECT_LT(both["max_torque_ratio"].get<double>(), 0.9);
  EXPECT_EQ((*constraint(both, "static_balance"))["violated"], false);
  EXPECT_EQ((*constraint(both, "torque_limits"))["violated"], false);
  EXPECT_FALSE(both["trusted"].empty()) << "nobody but the plan says what the soles can bear";
  EXPECT_TRUE(both["scenario"].is_null());
  for (const char* unknown : {"start", "goals_reached", "goals"}) {
    EXPECT_TRUE(both[unknown].is_null()) << unknown;
  }
  EXPECT_EQ((*constraint(both, "scenario_goals"))["judged"], false);
  const std::string words = runner.run("check both.g2o").out;
  EXPECT_NE(words.find("\nscenario: none\n"), std::string::npos) << words;
  EXPECT_NE(words.find("balanced with a margin of "), std::string::npos) << words;
  EXPECT_NE(words.find("on trust: l_sole: what it can bear"), std::string::npos) << words;

  runner.write("one.g2o", squat("1 5"));
  const Outcome fallen = runner.run("check one.g2o --json");
  EXPECT_EQ(fallen.exit_code, 1);
  const nlohmann::json balance = *constraint(fallen.json(), "static_balance");
  EXPECT_EQ(balance["violated"], true);
  EXPECT_EQ(balance["at_vertex"], 7);
  EXPECT_EQ(balance["unit"], "1");
  EXPECT_LT(balance["worst"].get<double>(), 0.0);
}

TEST(PlanCommands, CheckRefusesAPlanThatDoesNotSayWhereItStands) {
  const CommandRunner runner;
  std::string text = squat("2 4 5");
  text.replace(text.find("7 0 0.0 6"), 9, "7 0 0.0 -");
  runner.write("floating.g2o", text);
  const Outcome outcome = runner.run("check floating.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1);
  const nlohmann::json json = outcome.json();
  EXPECT_EQ((*constraint(json, "stance"))["violated"], true);
  const nlohmann::json balance = *constraint(json, "static_balance");
  EXPECT_EQ(balance["judged"], false);
  EXPECT_TRUE(balance["worst"].is_null());
  EXPECT_FALSE(balance["why"].get<std::string>().empty());
  const std::string words = runner.run("check floating.g2o").out;
  EXPECT_NE(words.find("not judged: static_balance"), std::string::npos) << words;
}

TEST(PlanCommands, CheckSaysWhatMattersFirstAndListsTheRestWhenAsked) {
  const PlanRunner runner;
  const std::string world = " --obstacles box.xml";
  runner.write("box.xml",
               "<obstacles version=\"1\"><box center=\"2 0 0.3\" size=\"1 1 0.6\"/></obstacles>");
  const std::string brief = runner.run("check plan.g2o" + world).out;
  const std::string whole = runner.run("check plan.g2o --all" + world).out;
  const auto lines_that_begin = [](const std::string& text, const std::string& begin) {
    int count = 0;
    for (std::size_t at = text.find('\n' + begin); at != std::string::npos;
         at = text.find('\n' + begin, at + 1)) {
      ++count;
    }
    return count;
  };
  EXPECT_LT(brief.find("NOT feasible"), brief.find("violated: obstacle_distance, worst -"));
  EXPECT_LT(brief.find("violated: "), brief.find("constraints hold (--all lists each)"));
  EXPECT_EQ(lines_that_begin(brief, "holds: "), 0);
  EXPECT_EQ(whole.find("constraints hold"), std::string::npos);
  const nlohmann::json json = runner.run("check plan.g2o --json" + world).json();
  const nlohmann::json& all = json["violations"];
  EXPECT_EQ(lines_that_begin(whole, "holds: "),
            std::ranges::count_if(all, [](const nlohmann::json& v) {
              return v["judged"].get<bool>() && !v["violated"].get<bool>();
            }));
}

TEST(PlanCommands, ASecondWorldRobotOrFormatInAPlanIsRefusedWithItsLine) {
  const PlanRunner runner;
  const std::string plan = runner.read("plan.g2o");
  const std::string place = std::to_string(std::ranges::count(plan, '\n') + 1);
  for (const char* line : {"PARAMS_WORLD 90 - -", "PARAMS_PLAN 90 2"}) {
    runner.write("two.g2o", plan + line + '\n');
    expect_refusal(runner.run("check two.g2o"), "two.g2o:" + place, "a second PARAMS_");
    expect_refusal(runner.run("refine two.g2o -o out.g2o"), "two.g2o:" + place, "a second PARAMS_");
  }
}

TEST(PlanCommands, APlanOfAnOlderFormatIsRefusedByName) {
  const CommandRunner runner;
  runner.write("old.g2o", "PARAMS_WHEELS 1 0 1 wheel 0.1\n");
  expect_refusal(runner.run("check old.g2o"), "old.g2o:1",
                 "PARAMS_WHEELS of an older format, expected a plan of format version 3");
}

TEST(PlanCommands, APlanDoesNotVouchForItself) {
  const PlanRunner runner;
  std::string plan = runner.read("plan.g2o");
  // More friction than the scenario says.
  std::string slippery = plan;
  const std::size_t friction = slippery.find(" 0.80000000000000004 5000 ");
  ASSERT_NE(friction, std::string::npos) << plan.substr(0, 600);
  slippery.replace(friction, 21, " 1.3 ");
  runner.write("claims.g2o", slippery);
  const Outcome claims = runner.run("check claims.g2o --json");
  EXPECT_EQ(claims.exit_code, 1);
  EXPECT_EQ((*constraint(claims.json(), "contact_claims"))["violated"], true) << claims.out;
  // A world that is not there hides nothing of the scenario's.
  runner.write("box.xml", kBoxOnThePath);
  std::ostringstream drive;
  drive << "<scenario version=\"1\" name=\"box\">\n<robot model=\"centauro\" "
           "active=\"lower_body\"/>\n<wheels>\n";
  for (int i = 1; i <= 4; ++i) drive << "<wheel link=\"wheel_" << i << "\" radius=\"0.078\"/>\n";
  drive << "</wheels>\n<environment obstacles=\"box.xml\"/>\n<drive distance=\"4\" speed=\"0.1\" "
           "configurations=\"50\"/>\n</scenario>\n";
  runner.write("box_drive.xml", drive.str());
  const std::size_t scenario = plan.find("PARAMS_SCENARIO 3 centauro_drive");
  ASSERT_NE(scenario, std::string::npos);
  plan.replace(scenario, 32, "PARAMS_SCENARIO 3 ./box_drive.xml");
  runner.write("blind.g2o", plan);
  const Outcome blind = runner.run("check blind.g2o --json");
  EXPECT_EQ(blind.exit_code, 1);
  EXPECT_EQ((*constraint(blind.json(), "obstacle_distance"))["violated"], true) << blind.out;
  // The same by the scenario's own word, and in another one's.
  EXPECT_EQ(runner.run("check plan.g2o --scenario box_drive.xml").exit_code, 1);
  EXPECT_EQ(runner.run("check claims.g2o --scenario centauro_drive").exit_code, 0);
}

TEST(PlanCommands, PlanSaysNoToWhatTheJudgeRefuses) {
  const CommandRunner runner;
  std::ostringstream drive;
  drive << "<scenario version=\"1\" name=\"fast\">\n<robot model=\"centauro\" "
           "active=\"lower_body\"/>\n<wheels>\n";
  for (int i = 1; i <= 4; ++i) drive << "<wheel link=\"wheel_" << i << "\" radius=\"0.078\"/>\n";
  drive << "</wheels>\n<limits base_linear=\"0.5\"/>\n"
           "<drive distance=\"4\" speed=\"10\" configurations=\"50\"/>\n"
           "</scenario>\n";
  runner.write("fast.xml", drive.str());
  const Outcome outcome = runner.run("plan fast.xml -o plan.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], false);
  EXPECT_NE(json["reason"].get<std::string>().find("refused: "), std::string::npos);
  EXPECT_GT(json["time"]["judge"].get<double>(), 0.0);
  EXPECT_FALSE(runner.exists("plan.g2o"));
}

/// The URDF of a robot that comes along, without its collision shapes.
std::string without_shapes(const std::string& robot) {
  std::ifstream in(LOCOGRAPH_SOURCE_DIR "/robots/models/" + robot + "/" + robot + ".urdf");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string end = "</collision>";
  for (std::size_t at = 0; (at = text.find("<collision", at)) != std::string::npos;) {
    text.erase(at, text.find(end, at) + end.size() - at);
  }
  return text;
}

TEST(PlanCommands, PlanRefusesARobotWithoutShapes) {
  const CommandRunner runner;
  for (const auto& [scenario, robot] :
       {std::pair<std::string, std::string>{"standing_up", "coman_plus"},
        {"centauro_drive", "centauro"}}) {
    const std::string srdf = LOCOGRAPH_SOURCE_DIR "/robots/models/" + robot + "/" + robot + ".srdf";
    runner.write("bare.urdf", without_shapes(robot));
    runner.write("bare.xml", test::with(test::shipped(scenario), "model=\"" + robot + "\"",
                                        "urdf=\"bare.urdf\" srdf=\"" + srdf + "\""));
    const int before = runner.files();
    expect_refusal(runner.run("plan bare.xml -o plan.g2o"), "bare.urdf",
                   "no link of the robot has a <collision>");
    EXPECT_EQ(runner.files(), before);
  }
}

TEST(PlanCommands, PlanNamesLinksThatTouchNothing) {
  const CommandRunner runner;
  const std::string call = "plan standing_up --stances-only --seed 3 -o plan.g2o";
  const Outcome planned = runner.run(call + " --json");
  EXPECT_EQ(planned.json()["links_without_collision"], nlohmann::json({"HeadHokuyo"}));
  const nlohmann::json trusted = runner.run("check plan.g2o --json").json()["trusted"];
  EXPECT_NE(std::find(trusted.begin(), trusted.end(),
                      "HeadHokuyo: that it touches nothing (no collision shape)"),
            trusted.end())
      << trusted;
}

TEST(PlanCommands, RefinePrintsOneJsonObjectWithEveryField) {
  const PlanRunner runner;
  const Outcome outcome =
      runner.run("refine plan.g2o -o refined.g2o --horizon 10 --rate 0.1 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], true);
  EXPECT_EQ(json["status"], "solved");
  EXPECT_TRUE(json["reason"].is_string());
  EXPECT_EQ(json["cycles"], 49);
  EXPECT_EQ(json["rate_hz"], 0.1);
  EXPECT_EQ(json["horizon"], 10);
  EXPECT_EQ(json["dof"], 30);
  EXPECT_EQ(json["feasible_cycles"], 49);
  EXPECT_EQ(json["deadline_misses"], 0);
  for (const char* times : {"cycle_time", "optimize_time", "map_update_time"}) {
    double before = 0.0;
    for (const char* figure : {"p50", "p95", "p99", "max"}) {
      EXPECT_GE(json[times][figure].get<double>(), before) << times << ' ' << figure;
      before = json[times][figure];
    }
    EXPECT_LE(json[times]["mean"].get<double>(), before) << times;
  }
}

TEST(PlanCommands, RefinePlansOnWhereARobotOnLegsHadToStop) {
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan standing_up --seed 9511 -o plan.g2o").exit_code, 0);
  TypeRegistry types = standard_types();
  add_robot_types(types);
  const Graph graph = read_graph((runner.folder() / "plan.g2o").string(), types);
  const Plan plan = plan_of(graph);
  const Obstacle ball = test::ball_in_the_way(motion_of(graph, plan), *plan.robot, 2.0);
  save_obstacles({&ball, 1}, runner.folder() / "ball.xml");
  const Outcome arrived =
      runner.run("refine plan.g2o --obstacles ball.xml --replan -o arrived.g2o --json");
  EXPECT_EQ(arrived.exit_code, 0) << arrived.err << arrived.out;
  EXPECT_GE(arrived.json()["resumed"], 1);
  EXPECT_EQ(runner.run("check arrived.g2o").exit_code, 0);
  const nlohmann::json stopped = runner
                                     .run(
                                         "refine plan.g2o --obstacles ball.xml --replan "
                                         "--replan-timeout 0.001 -o stopped.g2o --json")
                                     .json();
  EXPECT_EQ(stopped["resumed"], 0);
  EXPECT_NE(stopped["reason"].get<std::string>().find("; planning on: "), std::string::npos);
  EXPECT_EQ(runner.run("check stopped.g2o").exit_code, 0);
  EXPECT_EQ(runner.run("refine plan.g2o --replan-timeout 3 -o alone.g2o").exit_code, 2);
  EXPECT_FALSE(runner.exists("alone.g2o"));
}

TEST(PlanCommands, RefinePlansADriveOnAroundADeadEnd) {
  const PlanRunner runner;
  runner.write("dead_end.xml",
               "<obstacles version=\"1\">\n"
               "<box center=\"2.4 0 0.5\" size=\"0.2 2 1\"/>\n"
               "<box center=\"1.6 1.2 0.5\" size=\"1.6 0.2 1\"/>\n"
               "<box center=\"1.6 -1.2 0.5\" size=\"1.6 0.2 1\"/>\n"
               "</obstacles>\n");
  const std::string refine = "refine plan.g2o --obstacles dead_end.xml --json ";
  EXPECT_EQ(runner.run(refine + "-o blocked.g2o").exit_code, 1);
  const Outcome around = runner.run(refine + "--replan -o around.g2o");
  EXPECT_EQ(around.exit_code, 0) << around.err << around.out;
  EXPECT_EQ(around.json()["resumed"], 1);
  EXPECT_GT(around.json()["resume_s"], 0.0);
  EXPECT_EQ(runner.run("check around.g2o --obstacles dead_end.xml").exit_code, 0);
}

TEST(PlanCommands, ARefinedPlanPassesTheBoxAndTakesItsWorldAlong) {
  const PlanRunner runner;
  runner.write("box.xml", kBoxOnThePath);
  runner.write_map("box.bt");
  for (const char* world : {"--obstacles box.xml", "--map box.bt"}) {
    SCOPED_TRACE(world);
    const Outcome refined = runner.run(std::string("refine plan.g2o -o refined.g2o ") + world);
    ASSERT_EQ(refined.exit_code, 0) << refined.err << refined.out;
    EXPECT_EQ(runner.run(std::string("check refined.g2o ") + world).exit_code, 0);
    // Without options the world is that of the file.
    const Outcome own = runner.run("check refined.g2o --json");
    EXPECT_EQ(own.exit_code, 0) << own.out;
    EXPECT_LT(own.json()["min_clearance_m"], 0.3) << "the box is not seen";
    EXPECT_EQ(runner.run("refine refined.g2o -o again.g2o").exit_code, 0);
  }
}

TEST(PlanCommands, APlanOfARobotThatComesAlongOpensAnywhere) {
  const PlanRunner runner;
  const test::TemporaryFolder elsewhere;
  std::filesystem::copy(runner.folder() / "plan.g2o", elsewhere.file("copied.g2o"));
  EXPECT_EQ(runner.read("plan.g2o").find(LOCOGRAPH_SOURCE_DIR), std::string::npos);
  const std::string copied = "'" + elsewhere.file("copied.g2o").string() + "'";
  EXPECT_EQ(runner.run("check " + copied).exit_code, 0);
  const Outcome refined = runner.run("refine " + copied + " -o refined.g2o");
  ASSERT_EQ(refined.exit_code, 0) << refined.err;
  EXPECT_EQ(runner.run("check refined.g2o").exit_code, 0);
}

TEST(PlanCommands, APlanWithPathsOfItsOwnFindsThemFromWhereverItIsWritten) {
  const PlanRunner runner;
  for (const char* folder : {"maps", "out/deep"}) {
    std::filesystem::create_directories(runner.folder() / folder);
  }
  runner.write_map("maps/box.bt");
  const std::string model = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  for (const char* extension : {".urdf", ".srdf"}) {
    std::filesystem::copy(model + extension, runner.folder() / (std::string("own") + extension));
  }
  // As plans were written before robots had names.
  std::string text = runner.read("plan.g2o");
  text.replace(text.find("model centauro"), 14, "own.urdf own.srdf");
  runner.write("old.g2o", text);
  ASSERT_EQ(runner.run("refine old.g2o --map maps/box.bt -o out/deep/refined.g2o").exit_code, 0);
  EXPECT_NE(runner.read("out/deep/refined.g2o").find(" ../../own.urdf ../../own.srdf "),
            std::string::npos);
  const Outcome again = runner.run("refine out/deep/refined.g2o -o -");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const std::string absolute = std::filesystem::canonical(runner.folder()).string();
  EXPECT_NE(again.out.find(' ' + absolute + "/maps/box.bt"), std::string::npos);
}

TEST(PlanCommands, APlanBehindALinkFindsItsMap) {
  const PlanRunner runner;
  std::filesystem::create_directory(runner.folder() / "real");
  runner.write_map("real/box.bt");
  std::filesystem::create_symlink("real/refined.g2o", runner.folder() / "link.g2o");
  ASSERT_EQ(runner.run("refine plan.g2o --map real/box.bt -o link.g2o").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(runner.folder() / "link.g2o"));
  for (const char* name : {"link.g2o", "real/refined.g2o"}) {
    const Outcome outcome = runner.run(std::string("check --json ") + name);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_LT(outcome.json()["min_clearance_m"], 0.3) << "the map is not seen";
  }
}

TEST(PlanCommands, APlanMayMoveTogetherWithItsMap) {
  const PlanRunner runner;
  std::filesystem::create_directory(runner.folder() / "here");
  runner.write_map("here/box.bt");
  ASSERT_EQ(runner.run("refine plan.g2o --map here/box.bt -o here/refined.g2o").exit_code, 0);
  std::filesystem::rename(runner.folder() / "here", runner.folder() / "there");
  const Outcome outcome = runner.run("check there/refined.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LT(outcome.json()["min_clearance_m"], 0.3) << "the map is not seen";
}

TEST(PlanCommands, RefineSaysNoInFrontOfAWallAndWritesWhatIsFeasible) {
  const PlanRunner runner;
  runner.write("wall.xml", kWall);
  const Outcome outcome = runner.run("refine plan.g2o --obstacles wall.xml -o out.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.json()["success"], false);
  const Outcome check = runner.run("check out.g2o --json");
  EXPECT_EQ(check.exit_code, 0) << check.out;
  EXPECT_LT(check.json()["min_clearance_m"], 0.3) << "the wall is not seen";
  EXPECT_EQ(check.json()["incomplete"], true);
}

TEST(PlanCommands, GiveTheSameBitsAgain) {
  const PlanRunner runner;
  runner.write("box.xml", kBoxOnThePath);
  ASSERT_EQ(runner.run("plan centauro_drive -o again.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("again.g2o"), runner.read("plan.g2o"));
  ASSERT_EQ(runner.run("refine plan.g2o --obstacles box.xml -o a.g2o").exit_code, 0);
  ASSERT_EQ(runner.run("refine plan.g2o --obstacles box.xml -o b.g2o --threads 2").exit_code, 0);
  EXPECT_EQ(runner.read("a.g2o"), runner.read("b.g2o"));
}

TEST(PlanCommands, RefuseAPlanThatIsNotThereOrIsNone) {
  const PlanRunner runner;
  runner.write("pose.g2o",
               "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 "
               "1 0 0 1 0 1\n");
  for (const char* command : {"check", "refine -o out.g2o"}) {
    const std::string start = std::string(command) + ' ';
    expect_refusal(runner.run(start + "none.g2o"), "none.g2o", "cannot be opened");
    expect_refusal(runner.run(start + "pose.g2o --json"), "pose.g2o", "no plan");
  }
  EXPECT_EQ(runner.files(), 2);
}

TEST(PlanCommands, RefuseAPlanWhoseRobotIsNotThereNamingTheLine) {
  const PlanRunner runner;
  const std::string shipped = "model centauro";
  for (const std::string lost : {"model centaurus", "centaurus.urdf -"}) {
    std::string text = runner.read("plan.g2o");
    const std::size_t robot = text.find(shipped);
    ASSERT_NE(robot, std::string::npos);
    runner.write("lost.g2o", text.replace(robot, shipped.size(), lost));
    const std::string place =
        "lost.g2o:" + std::to_string(runner.line_of("lost.g2o", "PARAMS_ROBOT"));
    expect_refusal(runner.run("check lost.g2o"), place, "centaurus");
    expect_refusal(runner.run("refine lost.g2o -o out.g2o"), place, "centaurus");
  }
  EXPECT_EQ(runner.files(), 2);
}

TEST(PlanCommands, RefuseAMapOfAnotherTypeAndObstaclesThatAreNone) {
  const PlanRunner runner;
  runner.write("colour.bt", "# Octomap OcTree file\nid ColorOcTree\nsize 0\nres 0.05\ndata\n");
  runner.write("bad.xml", "<obstacles version=\"1\">\n<cone/>\n</obstacles>\n");
  for (const char* command : {"check plan.g2o", "refine plan.g2o -o out.g2o"}) {
    const std::string start = std::string(command) + ' ';
    expect_refusal(runner.run(start + "--map colour.bt"), "", "ColorOcTree");
    expect_refusal(runner.run(start + "--map none.bt"), "none.bt", "cannot be opened");
    expect_refusal(runner.run(start + "--obstacles bad.xml"), "bad.xml:2", "cone");
  }
  EXPECT_EQ(runner.files(), 3);
}

TEST(PlanCommands, RefuseWrongUsageInOneLineAndWriteNothing) {
  const PlanRunner runner;
  for (const char* usage : {"plan",
                            "plan centauro_drive",
                            "plan nonsense -o out.g2o",
                            "plan centauro_drive -o none/out.g2o",
                            "plan centauro_drive -o out.g2o --timeout -1",
                            "refine plan.g2o",
                            "refine plan.g2o -o none/out.g2o",
                            "refine plan.g2o -o out.g2o --horizon 0",
                            "refine plan.g2o -o out.g2o --horizon -3",
                            "refine plan.g2o -o out.g2o --horizon many",
                            "refine plan.g2o -o out.g2o --horizon -2s",
                            "refine plan.g2o -o out.g2o --horizon 1000s",
                            "refine plan.g2o -o out.g2o --horizon 50",
                            "refine plan.g2o -o out.g2o --rate 0",
                            "refine plan.g2o -o out.g2o --rate 1e9",
                            "refine plan.g2o -o out.g2o --rate nan",
                            "refine plan.g2o -o out.g2o --replan --cameras",
                            "refine plan.g2o -o out.g2o --deadline-ms -1",
                            "refine plan.g2o -o out.g2o --threads 0",
                            "check",
                            "check plan.g2o --clearance -1",
                            "check plan.g2o --bogus",
                            "check plan.g2o --torque-limits no",
                            "check plan.g2o --until soon",
                            "check plan.g2o --scenario nonsense"}) {
    SCOPED_TRACE(usage);
    expect_refusal(runner.run(usage), "", "");
  }
  expect_refusal(runner.run("plan nonsense -o out.g2o"), "nonsense", "centauro_drive");
  EXPECT_EQ(runner.files(), 1) << "only the plan";
}

/// A cup on the robot, mounted five degrees forwards.
const char kCrookedCup[] =
    "PARAMS_FRAME 90 0 pelvis 0 0 0.5 0 0.043619387365336 0 0.999048221581858\n";

/// Pitch of the base [rad] of every VERTEX_CONFIGURATION of a level drive along x.
std::vector<double> pitches(const std::string& plan) {
  std::vector<double> result;
  std::istringstream in(plan);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string tag;
    std::string stance;
    double id, robot, time, x, y, z, qx, qy, qz, qw;
    fields >> tag;
    if (tag != "VERTEX_CONFIGURATION") continue;
    fields >> id >> robot >> time >> stance >> x >> y >> z >> qx >> qy >> qz >> qw;
    result.push_back(2.0 * std::atan2(qy, qw));
  }
  return result;
}

TEST(PlanCommands, RefineKeepsAConstraintThatAPlugInBrings) {
  const PlanRunner runner;
  std::string plan = runner.read("plan.g2o") + kCrookedCup;
  for (int i = 10; i < 50; ++i)
    plan += "EDGE_CUP_TILT " + std::to_string(i) + " 90 0.05 scalar 1e5\n";
  runner.write("cup.g2o", plan);
  const Outcome without = runner.run("refine cup.g2o -o out.g2o");
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("EDGE_CUP_TILT"), std::string::npos) << without.err;

  const Outcome with = runner.run("refine cup.g2o --plugin level_cup -o out.g2o --json");
  ASSERT_EQ(with.exit_code, 0) << with.err << with.out;
  EXPECT_EQ(with.json()["success"], true);
  const std::vector<double> pitch = pitches(runner.read("out.g2o"));
  ASSERT_EQ(pitch.size(), 50u);
  EXPECT_NEAR(pitch[0], 0.0, 1e-6);
  // Five degrees are 0.0873 rad: the robot leans back by what is too much, and no further.
  for (std::size_t i = 10; i < pitch.size(); ++i) EXPECT_NEAR(pitch[i], -0.0373, 0.002) << i;
  const Outcome checked = runner.run("check out.g2o --plugin level_cup");
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
}

TEST(PlanCommands, RefineRefusesAPlugInsConstraintWhereItStands) {
  const PlanRunner runner;
  const std::string plan = runner.read("plan.g2o") + kCrookedCup;
  runner.write("cup.g2o", plan + "EDGE_CUP_TILT 10 90 0 scalar 1e5\n");
  const Outcome outcome = runner.run("refine cup.g2o --plugin level_cup -o out.g2o");
  EXPECT_EQ(outcome.exit_code, 2);
  const std::string line = std::to_string(std::ranges::count(plan, '\n') + 1);
  EXPECT_NE(outcome.err.find("cup.g2o:" + line + ": a cup that may not tilt at all"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(runner.exists("out.g2o"));
}

}  // namespace
}  // namespace locograph
