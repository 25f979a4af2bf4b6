#include <apps/view_test_support.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace locograph {
namespace {

TEST_F(ViewPlan, PageHoldsTheWholePlan) {
  const nlohmann::json scene = view(runner, "p.g2o");
  EXPECT_LE(std::filesystem::file_size(runner.folder() / "page.html"), 3000000u);
  EXPECT_EQ(scene["version"], 1);
  EXPECT_EQ(scene["kind"], "plan");
  EXPECT_EQ(scene["title"], "p.g2o");
  const nlohmann::json& plan = scene["plan"];
  ASSERT_EQ(plan["times"].size(), 50u);
  EXPECT_EQ(plan["ids"].size(), 50u);
  EXPECT_EQ(plan["configuration_size"], 31);
  const std::vector<float> configurations = unpack<float>(plan["configurations"]);
  ASSERT_EQ(configurations.size(), 50u * 31u);
  // 4 m ahead at the end, and the offline plan is its own reference.
  EXPECT_NEAR(configurations[49 * 31] - configurations[0], 4.0, 1e-5);
  EXPECT_EQ(unpack<float>(plan["reference"]), configurations);
  EXPECT_TRUE(scene["check"]["feasible"]);
  EXPECT_GE(scene["check"]["violations"].size(), 24u);
  for (const nlohmann::json& violation : scene["check"]["violations"]) {
    EXPECT_TRUE(violation["judged"].is_boolean());
    EXPECT_EQ(violation["worst"].is_null(), !violation["judged"]) << violation["constraint"];
  }
}

TEST_F(ViewPlan, ContactsOfTheWheelsLieOnTheGround) {
  const nlohmann::json scene = view(runner, "p.g2o --no-check");
  EXPECT_FALSE(scene.contains("check"));
  ASSERT_EQ(scene["plan"]["contacts"].size(), 50u);
  for (const nlohmann::json& here : scene["plan"]["contacts"]) {
    ASSERT_EQ(here.size(), 4u);
    for (const nlohmann::json& contact : here) {
      EXPECT_NEAR(contact["position"][2].get<double>(), 0.0, 1e-3);
      EXPECT_EQ(contact["kind"], "wheel");
    }
  }
  EXPECT_EQ(scene["stances"][0]["contacts"].size(), 4u);
  EXPECT_EQ(scene["stances"][0]["to"], 49);
}

TEST_F(ViewPlan, RobotHasItsLinksJointsAndColours) {
  const nlohmann::json robot = view(runner, "p.g2o --no-check")["robot"];
  EXPECT_EQ(robot["name"], "centauro");
  EXPECT_EQ(robot["links"].size(), robot["joints"].size() + 1);
  int movable = 0, visuals = 0;
  for (const nlohmann::json& joint : robot["joints"]) movable += joint["index"] >= 0 ? 1 : 0;
  for (const nlohmann::json& link : robot["links"]) visuals += link["visual"].size();
  EXPECT_EQ(movable, 24);
  EXPECT_GT(visuals, 60);
  EXPECT_EQ(robot["missing"].size(), 0u);
  EXPECT_EQ(robot["links"][0]["visual"][0]["color"], nlohmann::json({0.8, 0.82, 0.85, 1.0}));
}

TEST_F(ViewPlan, ObstaclesKeepShapeAndMotion) {
  const nlohmann::json scene = view(runner, "p.g2o --obstacles box.xml --no-check");
  ASSERT_EQ(scene["obstacles"].size(), 2u);
  EXPECT_EQ(scene["obstacles"][0]["size"], nlohmann::json({0.4, 0.4, 0.5}));
  const nlohmann::json& roller = scene["obstacles"][1];
  EXPECT_EQ(roller["type"], "cylinder");
  EXPECT_EQ(roller["size"], nlohmann::json({0.2, 0.6}));
  EXPECT_EQ(roller["repeat"], 9.0);
  EXPECT_EQ(roller["keyframes"][0]["pose"], nlohmann::json({3, 2, 0.3, 0, 0, 0, 1}));
  EXPECT_FALSE(roller.contains("appears") || roller.contains("vanishes"));
}

TEST_F(ViewPlan, ObstaclesAreShownOnlyWhileTheyAreThere) {
  runner.write("passing.xml",
               "<obstacles version=\"1\"><sphere center=\"9 0 0\" radius=\"0.1\" appears=\"3\" "
               "vanishes=\"4.5\"/></obstacles>\n");
  const nlohmann::json scene = view(runner, "p.g2o --obstacles passing.xml --no-check");
  EXPECT_EQ(scene["obstacles"][0]["appears"], 3.0);
  EXPECT_EQ(scene["obstacles"][0]["vanishes"], 4.5);
}

TEST_F(ViewPlan, ViolationsSayWhereAndWhen) {
  runner.write("wall.xml",
               "<obstacles version=\"1\">\n"
               "<box name=\"wall\" center=\"2 0 1\" size=\"0.2 3 2\"/>\n</obstacles>\n");
  const nlohmann::json check = view(runner, "p.g2o --obstacles wall.xml")["check"];
  EXPECT_FALSE(check["feasible"]);
  bool found = false;
  for (const nlohmann::json& violation : check["violations"]) {
    if (violation["constraint"] != "obstacle_distance") continue;
    found = true;
    EXPECT_TRUE(violation["violated"]);
    EXPECT_GT(violation["index"], 0);
    EXPECT_LT(violation["worst"], 0.0);
    EXPECT_NEAR(violation["at_point"][0].get<double>(), 2.0, 0.6);
  }
  EXPECT_TRUE(found);
}

TEST_F(ViewPlan, MapIsShownVoxelByVoxel) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const nlohmann::json scene =
      view(runner, "p.g2o --no-check --map " + shared("octomap/geb079.bt"));
  const std::vector<float> voxels = unpack<float>(scene["map"]["voxels"]);
  EXPECT_GT(voxels.size(), 4000u);
  EXPECT_EQ(voxels.size() % 4, 0u);
  EXPECT_LE(voxels.size(), 400000u);
}

TEST_F(ViewPlan, ExecutedPartAndWindowAreMarked) {
  const nlohmann::json plan = view(runner, "p.g2o --no-check --executed 40")["plan"];
  EXPECT_EQ(plan["executed"], 40);
  EXPECT_EQ(plan["window"], 9) << "cut at the end of the plan";
  expect_refusal(runner.run("view p.g2o --executed 50 -o x.html"), "p.g2o", "configuration 50");
}

TEST_F(ViewPlan, TextOfAFileCannotEndTheScript) {
  runner.write(
      "evil.xml",
      "<obstacles version=\"1\">\n<box name=\"&lt;/script>&lt;script>alert(1)&lt;/script>\" "
      "center=\"9 9 1\" size=\"1 1 1\"/>\n</obstacles>\n");
  const nlohmann::json scene = view(runner, "p.g2o --no-check --obstacles evil.xml");
  EXPECT_EQ(scene["obstacles"][0]["name"], "</script><script>alert(1)</script>");
  EXPECT_EQ(runner.read("page.html").find("alert(1)</script>"), std::string::npos);
}

TEST_F(ViewPlan, RobotFileThatIsMissingIsNamed) {
  std::string text = runner.read("p.g2o");
  const std::size_t at = text.find("model centauro");
  ASSERT_NE(at, std::string::npos);
  runner.write("moved.g2o", text.replace(at, 14, "nowhere.urdf -"));
  const Outcome outcome = runner.run("view moved.g2o -o x.html");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("nowhere.urdf"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1);
  EXPECT_FALSE(runner.exists("x.html"));
}

TEST_F(ViewPlan, ScenarioThatIsMissingCostsTheVerdictOnly) {
  std::string text = runner.read("p.g2o");
  const std::size_t at = text.find("PARAMS_SCENARIO 3 centauro_drive");
  ASSERT_NE(at, std::string::npos);
  runner.write("moved.g2o", text.replace(at, 32, "PARAMS_SCENARIO 3 ./gone.xml"));
  const Outcome outcome = runner.run("view moved.g2o --obstacles box.xml -o page.html");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: neither judged"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("gone.xml"), std::string::npos) << outcome.err;
  const nlohmann::json scene = scene_of(runner.read("page.html"));
  EXPECT_EQ(scene["plan"]["times"].size(), 50u);
  EXPECT_EQ(scene["obstacles"].size(), 2u);
  EXPECT_FALSE(scene.contains("check"));
  // What the command line names must be there all the same.
  expect_refusal(runner.run("view moved.g2o --obstacles none.xml -o x.html"), "none.xml", "");
}

TEST(View, PostureShowsTheForcesThatHoldTheRobot) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  const std::string file = "'" LOCOGRAPH_SOURCE_DIR "/examples/posture/coman_plus_wall.xml'";
  ASSERT_EQ(runner.run("posture coman_plus --contacts " + file + " -o p.g2o").exit_code, 0);
  const nlohmann::json scene = view(runner, "p.g2o");
  double weight_N = 0.0, lifted_N = 0.0;
  for (const nlohmann::json& link : scene["robot"]["links"]) {
    weight_N += 9.80665 * link["mass"].get<double>();
  }
  const nlohmann::json& contacts = scene["plan"]["contacts"][0];
  ASSERT_EQ(contacts.size(), 3u);
  for (const nlohmann::json& contact : contacts) {
    lifted_N += contact["force"][2].get<double>();
    EXPECT_GT(contact["friction"], 0.0);
    // A bare point bears no moment.
    EXPECT_EQ(contact.contains("moment"), contact["kind"] == "surface") << contact["name"];
  }
  EXPECT_NEAR(lifted_N, weight_N, 0.01 * weight_N);
  // The wall pushes back, along its normal.
  EXPECT_LE(contacts[2]["force"][0], 1e-6);
}

TEST(View, StancesShowWhatTheyStandOnAndWhatBears) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan ladder_climbing --stances-only -o s.g2o").exit_code, 0);
  const nlohmann::json scene = view(runner, "s.g2o");
  EXPECT_EQ(scene["plan"]["stances_only"], true);
  EXPECT_EQ(scene["stances"].size(), scene["plan"]["times"].size());
  EXPECT_GT(scene["surfaces"].size(), 10u) << "floor and rungs";
  double shortest_m = 1.0;
  for (const nlohmann::json& here : scene["plan"]["contacts"]) {
    for (const nlohmann::json& contact : here) {
      EXPECT_GT(contact["friction"], 0.0);
      ASSERT_EQ(contact.contains("area"), contact["kind"] == "surface") << contact["name"];
      if (contact["kind"] != "surface") continue;
      ASSERT_GE(contact["area"].size(), 4u);
      double first_m = 1e9, last_m = -1e9;
      for (const nlohmann::json& corner : contact["area"]) {
        EXPECT_NEAR(corner[2].get<double>(), contact["position"][2].get<double>(), 1e-3);
        first_m = std::min(first_m, corner[0].get<double>());
        last_m = std::max(last_m, corner[0].get<double>());
      }
      shortest_m = std::min(shortest_m, last_m - first_m);
    }
  }
  EXPECT_NEAR(shortest_m, 0.1, 1e-3) << "a rung is less deep than a sole is long";
}

TEST(View, BarsAreShown) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan gap_with_handrail --stances-only -o s.g2o").exit_code, 0);
  const nlohmann::json bars = view(runner, "s.g2o --no-check")["bars"];
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_GT(bars[0]["radius"], 0.0);
  EXPECT_NE(bars[0]["from"], bars[0]["to"]);
}

TEST(View, TheTreeOfStancesIsShownWhereItIsGiven) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  const Outcome planned = runner.run("plan standing_up --stances-only --tree t.json -o p.g2o");
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_FALSE(view(runner, "p.g2o --no-check").contains("tree"));
  const nlohmann::json tree = view(runner, "p.g2o --no-check --tree t.json")["tree"];
  const nlohmann::json nodes = nlohmann::json::parse(runner.read("t.json"))["nodes"];
  const std::vector<float> centres = unpack<float>(tree["centres"]);
  const std::vector<int> parents = unpack<int>(tree["parents"]);
  const std::vector<int> states = unpack<int>(tree["states"]);
  ASSERT_EQ(parents.size(), nodes.size());
  ASSERT_EQ(states.size(), nodes.size());
  ASSERT_EQ(centres.size(), 3 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_EQ(parents[i], nodes[i]["parent"]);
    EXPECT_EQ(states[i] > 0, nodes[i]["found"]);
    EXPECT_EQ(states[i] == 2, nodes[i]["on_way"]);
    double height = 0.0;
    for (const auto& [name, position] : nodes[i]["contacts"].items()) {
      height += position[2].get<double>() / static_cast<double>(nodes[i]["contacts"].size());
    }
    EXPECT_NEAR(centres[3 * i + 2], height, 1e-5);
  }
}

TEST(View, RefusesATreeThatIsNone) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan standing_up --stances-only -o p.g2o").exit_code, 0);
  const std::string found = "\"found\": true, \"contacts\": ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[1, 2", "is not JSON"},
      {"{\"nodes\": 3}", "has no nodes"},
      {"{\"nodes\": [3]}", "node 0 is no object"},
      {"{\"nodes\": [{\"parent\": 0, " + found + "{}}]}", "node 0 has the parent 0"},
      {"{\"nodes\": [{\"parent\": -1.5, " + found + "{}}]}", "node 0 has the parent -1.5"},
      {"{\"nodes\": [{\"parent\": -1}]}", "node 0 does not say what became of it"},
      {"{\"nodes\": [{\"parent\": -1, " + found + "7}]}", "node 0 has no contacts"},
      {"{\"nodes\": [{\"parent\": -1, " + found + "{\"foot\": [0, 1e9, 0]}}]}",
       "node 0 has the contact foot at [0,"},
  };
  for (const auto& [text, words] : cases) {
    runner.write("t.json", text);
    const Outcome outcome = runner.run("view p.g2o --tree t.json -o x.html");
    expect_refusal(outcome, text[0] == '[' ? "t.json:1" : "t.json", words);
  }
  // Found or not.
  const std::string plan = " --stances-only --max-transitions 20 -o other.g2o";
  ASSERT_LE(runner.run("plan ladder_climbing --tree other.json" + plan).exit_code, 1);
  expect_refusal(runner.run("view p.g2o --tree other.json -o x.html"), "other.json",
                 "is a tree of the scenario \"ladder_climbing\", expected one of the plan's");
  ASSERT_LE(runner.run("plan standing_up --move-contacts 0.05 --tree moved.json" + plan).exit_code,
            1);
  expect_refusal(runner.run("view p.g2o --tree moved.json -o x.html"), "moved.json",
                 "is the tree of another plan");
  runner.write("pose.g2o", "VERTEX_SE2 0 0 0 0\n");
  expect_refusal(runner.run("view pose.g2o --tree t.json -o x.html"), "pose.g2o", "--tree");
  EXPECT_FALSE(runner.exists("x.html"));
}

TEST(View, RefusesWhatItCannotShow) {
  const CommandRunner runner;
  expect_refusal(runner.run("view nothing.g2o -o x.html"), "nothing.g2o", "");
  runner.write("empty.g2o", "");
  expect_refusal(runner.run("view empty.g2o -o x.html"), "empty.g2o", "");
  runner.write("points.g2o", "VERTEX_XY 0 1 2\n");
  expect_refusal(runner.run("view points.g2o -o x.html"), "points.g2o", "nothing to show");
  runner.write("pose.g2o", "VERTEX_SE2 0 0 0 0\n");
  expect_refusal(runner.run("view pose.g2o"), "", "nothing to write");
  expect_refusal(runner.run("view pose.g2o -o no/such/folder.html"), "no/such/folder.html", "");
  EXPECT_FALSE(runner.exists("x.html"));
}

TEST(View, SphereHasAllItsPosesBeforeAndAfter) {
  LOCOGRAPH_NEEDS_VIEWER();
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const nlohmann::json scene = view(runner, shared("pose_graphs/sphere2500.g2o") + " --optimize");
  EXPECT_EQ(scene["kind"], "pose_graph");
  const nlohmann::json& graph = scene["graph"];
  EXPECT_EQ(graph["dimension"], 3);
  const std::vector<float> after = unpack<float>(graph["vertices"]);
  ASSERT_EQ(after.size(), 7u * 2500u);
  EXPECT_EQ(unpack<float>(graph["before"]).size(), after.size());
  EXPECT_EQ(unpack<std::int32_t>(graph["edges"]).size(), 2u * 4949u);
  EXPECT_LT(graph["chi2"][1], 0.01 * graph["chi2"][0].get<double>());
  // The file's own first guess is drawn without --optimize.
  const nlohmann::json raw = view(runner, shared("pose_graphs/sphere2500.g2o"))["graph"];
  EXPECT_EQ(raw["vertices"], graph["before"]);
  EXPECT_FALSE(raw.contains("before"));
}

TEST(View, PlanarPosesLieInThePlane) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  runner.write("a.g2o",
               "VERTEX_SE2 0 1 2 3.14159265358979\nVERTEX_SE2 1 2 2 0\nVERTEX_XY 2 5 6\n"
               "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const nlohmann::json graph = view(runner, "a.g2o")["graph"];
  EXPECT_EQ(graph["dimension"], 2);
  const std::vector<float> poses = unpack<float>(graph["vertices"]);
  ASSERT_EQ(poses.size(), 14u);
  EXPECT_EQ(poses[2], 0.0f);
  EXPECT_NEAR(poses[5], 1.0, 1e-6) << "half a turn about z";
  EXPECT_EQ(unpack<float>(graph["points"]), (std::vector<float>{5, 6, 0}));
  EXPECT_EQ(unpack<std::int32_t>(graph["edges"]), (std::vector<std::int32_t>{0, 1}));
}

TEST(View, RobotStandsOnTheGround) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  const nlohmann::json scene =
      view(runner, "'" LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro.urdf'");
  EXPECT_EQ(scene["title"], "centauro.urdf, home");
  const std::vector<float> q = unpack<float>(scene["plan"]["configurations"]);
  ASSERT_EQ(q.size(), scene["plan"]["configuration_size"].get<std::size_t>());
  EXPECT_NEAR(q[2], 0.72, 0.02);
  expect_refusal(runner.run("view '" LOCOGRAPH_SOURCE_DIR
                            "/robots/models/centauro/centauro.urdf' --state hme -o x.html"),
                 LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro.srdf", "'home'");
}

TEST(View, RobotMayBeShownAsItsCapsules) {
  LOCOGRAPH_NEEDS_VIEWER();
  const CommandRunner runner;
  runner.write("arm.urdf",
               "<robot name=\"arm\"><link name=\"a\"><collision><origin xyz=\"1 2 3\"/>"
               "<geometry><mesh filename=\"rod.stl\"/></geometry></collision></link></robot>");
  runner.write("rod.stl",
               "solid rod\nvertex 0 0 0\nvertex 0.4 0 0\nvertex 0.4 0 0\nendsolid rod\n");
  const nlohmann::json link = view(runner, "arm.urdf --capsules")["robot"]["links"][0];
  EXPECT_TRUE(link["visual"].empty());
  ASSERT_EQ(link["collision"].size(), 1u);
  const nlohmann::json& capsule = link["collision"][0];
  EXPECT_EQ(capsule["type"], "capsule");
  EXPECT_NEAR(capsule["pose"][0], 1.2, 0.01);
  EXPECT_NEAR(capsule["pose"][2], 3.0, 0.01);
  EXPECT_NEAR(std::abs(capsule["pose"][4].get<double>()), std::sqrt(0.5), 0.02);  // z along x
  EXPECT_NEAR(capsule["length"].get<double>() + 2.0 * capsule["radius"].get<double>(), 0.4, 0.025);
}

TEST(View, MeshesThatAreMissingAreNamedOnStandardError) {
  LOCOGRAPH_NEEDS_VIEWER();
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const Outcome outcome = runner.run("view " + shared("robots/go2.urdf") + " -o go2.html");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("base.dae"), std::string::npos) << outcome.err;
  const nlohmann::json robot = scene_of(runner.read("go2.html"))["robot"];
  EXPECT_EQ(robot["missing"].size(), 7u);
  // Its collision meshes stand in.
  EXPECT_EQ(robot["meshes"].size(), 9u);
  EXPECT_GT(unpack<float>(robot["meshes"][0]["triangles"]).size(), 90u);
}

// Pictures -----------------------------------------------------------------------------------

bool on_path(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

TEST_F(ViewPlan, PictureIsAPngOfTheSizeAsked) {
  if (!on_path("chromium")) GTEST_SKIP() << "no chromium";
  const Outcome outcome = runner.run("view p.g2o --no-check --png frame.png --at 10");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string png = runner.read("frame.png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto number = [&png](std::size_t at) {
    return static_cast<unsigned char>(png[at + 2]) << 8 | static_cast<unsigned char>(png[at + 3]);
  };
  EXPECT_EQ(number(16), 1280);
  EXPECT_EQ(number(20), 720);
  // An empty page compresses to a few kilobytes; a robot on its ground does not.
  EXPECT_GT(png.size(), 30000u);
}

TEST_F(ViewPlan, WithoutChromiumThePictureIsRefused) {
  std::filesystem::create_directory(runner.folder() / "bin");
  const std::string line = "view p.g2o --png frame.png";
  ::setenv("LOCOGRAPH_TEST_PATH", ::getenv("PATH"), 1);
  ::setenv("PATH", (runner.folder() / "bin").c_str(), 1);
  const Outcome outcome = runner.run(line);
  ::setenv("PATH", ::getenv("LOCOGRAPH_TEST_PATH"), 1);
  std::filesystem::remove(runner.folder() / "bin");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("chromium"), std::string::npos) << outcome.err;
  EXPECT_FALSE(runner.exists("frame.png"));
}

}  // namespace
}  // namespace locograph
