#include <apps/command_runner.h>

#include <cmath>

namespace locograph {
namespace {

const char kArm[] =
    "<robot name=\"arm\">\n"
    "  <link name=\"base\"><inertial><mass value=\"2\"/>\n"
    "    <inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n"
    "  <link name=\"hand\">\n"
    "    <collision><geometry><mesh filename=\"package://arm/hand.stl\"/></geometry></collision>\n"
    "  </link>\n"
    "  <joint name=\"elbow\" type=\"revolute\">\n"
    "    <parent link=\"base\"/><child link=\"hand\"/><axis xyz=\"0 0 1\"/>\n"
    "    <limit lower=\"-1\" upper=\"2\" velocity=\"3\" effort=\"4\"/>\n"
    "  </joint>\n"
    "</robot>\n";

std::string with(std::string text, const std::string& what, const std::string& instead) {
  text.replace(text.find(what), what.size(), instead);
  return text;
}

nlohmann::json info(const CommandRunner& runner, const std::string& file) {
  const Outcome outcome = runner.run("info " + file + " --json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return outcome.json();
}

/// Of a file that other commands refuse: it is described all the same, and refused in their words.
nlohmann::json refused_info(const CommandRunner& runner, const std::string& file,
                            const std::string& words) {
  const Outcome outcome = runner.run("info " + file + " --json");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  nlohmann::json json = outcome.json();
  EXPECT_NE(json["refused"].get<std::string>().find(words), std::string::npos) << json["refused"];
  return json;
}

TEST(Info, CountsWhatIsInAGraph) {
  const CommandRunner runner;
  runner.write("a.g2o",
               "VERTEX_SE2 3 0 0 0\nVERTEX_SE2 9 0 0 0\nVERTEX_XY 5 0 0\nFIX 3\n"
               "EDGE_SE2 3 9 1 0 0 2 0 0 3 0 4\nUNKNOWN 1\n");
  const nlohmann::json json = info(runner, "a.g2o");
  EXPECT_EQ(json["kind"], "graph");
  EXPECT_EQ(json["vertices"]["count"], 3);
  EXPECT_EQ(json["vertices"]["by_tag"]["VERTEX_SE2"], 2);
  EXPECT_EQ(json["vertices"]["ids"], nlohmann::json({3, 9}));
  EXPECT_EQ(json["vertices"]["dimension"], 8);
  EXPECT_EQ(json["vertices"]["fixed"], 1);
  EXPECT_EQ(json["edges"]["by_tag"]["EDGE_SE2"]["count"], 1);
  EXPECT_EQ(json["edges"]["by_tag"]["EDGE_SE2"]["smallest_information_eigenvalue"], 2.0);
  EXPECT_EQ(json["edges"]["by_tag"]["EDGE_SE2"]["largest_information_eigenvalue"], 4.0);
  EXPECT_EQ(json["connected_parts"], 2);
  EXPECT_EQ(json["parts_held_in_place"], 1);
  EXPECT_EQ(json["unknown_lines"], 1);
}

struct PublicGraph {
  const char* name;
  int vertices, edges, indefinite;
};
class PublicGraphInfo : public testing::TestWithParam<PublicGraph> {};

TEST_P(PublicGraphInfo, AgreesWithItsReference) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const nlohmann::json json =
      info(runner, shared(std::string("pose_graphs/") + GetParam().name + ".g2o"));
  EXPECT_EQ(json["vertices"]["count"], GetParam().vertices);
  EXPECT_EQ(json["edges"]["count"], GetParam().edges);
  EXPECT_EQ(json["indefinite_information"], GetParam().indefinite);
  EXPECT_EQ(json["connected_parts"], 1);
}

INSTANTIATE_TEST_SUITE_P(
    Info, PublicGraphInfo,
    testing::Values(PublicGraph{"tinyGrid3D", 9, 11, 0},
                    PublicGraph{"parking-garage", 1661, 6275, 0},
                    PublicGraph{"sphere2500", 2500, 4949, 0}, PublicGraph{"torus3D", 5000, 9048, 0},
                    PublicGraph{"cubicle", 5750, 16869, 5021}, PublicGraph{"intel", 1728, 2512, 0},
                    PublicGraph{"manhattan", 3500, 5453, 0}, PublicGraph{"CSAIL", 1045, 1172, 0},
                    PublicGraph{"kitti_00", 4541, 4677, 0}));

TEST(Info, DescribesARobotAndItsMissingMeshes) {
  const CommandRunner runner;
  runner.write("arm.urdf", kArm);
  const std::string words = "arm.urdf:5: collision mesh 'package://arm/hand.stl' not found";
  const nlohmann::json json = refused_info(runner, "arm.urdf", words);
  const Outcome posed = runner.run("posture arm.urdf --contacts none.xml");
  EXPECT_NE(posed.err.find(words), std::string::npos) << posed.err;
  EXPECT_EQ(json["kind"], "robot");
  EXPECT_EQ(json["name"], "arm");
  EXPECT_EQ(json["links"], 2);
  EXPECT_EQ(json["movable_joints"], 1);
  EXPECT_EQ(json["mass_kg"], 2.0);
  EXPECT_EQ(json["missing_meshes"], nlohmann::json({"package://arm/hand.stl"}));
  EXPECT_EQ(json["limits"]["elbow"]["lower"], -1.0);
  EXPECT_EQ(json["limits"]["elbow"]["max_effort"], 4.0);
  EXPECT_TRUE(json["srdf"].is_null());
  EXPECT_EQ(json["cameras"], nlohmann::json::array());
}

TEST(Info, DescribesTheRobotThatComesAlong) {
  const CommandRunner runner;
  const nlohmann::json json =
      info(runner, "'" LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro.urdf'");
  EXPECT_EQ(json["name"], "centauro");
  EXPECT_EQ(json["missing_meshes"], nlohmann::json::array());
  EXPECT_EQ(json["links_without_collision"], nlohmann::json::array());
  EXPECT_EQ(json["names_unknown_to_the_urdf"], nlohmann::json::array());
  EXPECT_EQ(json["configurations"], nlohmann::json({"home"}));
  ASSERT_EQ(json["cameras"].size(), 2u);
  for (const nlohmann::json& camera : json["cameras"]) {
    EXPECT_EQ(camera["link"], camera["name"].get<std::string>() + "_depth_optical_frame");
    EXPECT_EQ(camera["width"], 640);
    EXPECT_NEAR(camera["fov_x_rad"].get<double>(), 1.518, 1e-3);
  }
}

TEST(Info, NamesWhatIsSeenAndCannotCollide) {
  const CommandRunner runner;
  runner.write("arm.urdf", with(kArm, "<link name=\"base\">",
                                "<link name=\"base\"><visual><geometry><box size=\"1 1 1\"/>"
                                "</geometry><material/></visual>"));
  nlohmann::json json = refused_info(runner, "arm.urdf", "hand.stl' not found");
  EXPECT_EQ(json["collision_elements"], 1);
  EXPECT_EQ(json["collision_shapes"], 1);
  EXPECT_EQ(json["links_without_collision"], nlohmann::json({"base"}));
  EXPECT_FALSE(json.contains("warnings"));
  runner.write("bare.urdf", with(kArm,
                                 "<collision><geometry><mesh filename=\"package://arm/hand.stl\"/>"
                                 "</geometry></collision>",
                                 ""));
  json = refused_info(runner, "bare.urdf", "no link of the robot has a <collision>");
  EXPECT_EQ(json["collision_elements"], 0);
  ASSERT_EQ(json["warnings"].size(), 1u);
  EXPECT_NE(json["warnings"][0].get<std::string>().find("no link has a <collision>"),
            std::string::npos);
}

TEST(Info, TellsHowCloselyTheDistanceEdgesSeeEachLink) {
  const CommandRunner runner;
  runner.write("arm.urdf",
               with(kArm, "<mesh filename=\"package://arm/hand.stl\"/>", "<box size=\"1 1 1\"/>"));
  const nlohmann::json links = info(runner, "arm.urdf")["approximation"];
  ASSERT_EQ(links.size(), 1u);
  const nlohmann::json& hand = links["hand"];
  EXPECT_EQ(hand["shapes"], 1);
  EXPECT_EQ(hand["spheres"], 64);  // cells of 0.25 m
  EXPECT_NEAR(hand["spheres_over_mm"], 1e3 * 0.125 * (std::sqrt(3.0) - 1.0), 1.0);
  EXPECT_EQ(hand["spheres_under_mm"], 0.0);
  EXPECT_EQ(hand["capsules"], 64);
  EXPECT_EQ(hand["capsules_under_mm"], 0.0);
  const std::string text = runner.run("info arm.urdf").out;
  EXPECT_NE(text.find("  hand: shapes 1, spheres 64, spheres_over "), std::string::npos) << text;
}

TEST(Info, NamesTheMeshThatCannotBeRead) {
  const CommandRunner runner;
  runner.write("arm.urdf", with(kArm, "package://arm/hand.stl", "hand.stl"));
  runner.write("hand.stl", "solid hand\nvertex 0 0\n");
  const std::string unusable = refused_info(
      runner, "arm.urdf", "hand.stl:2: unreadable vertex")["approximation"]["hand"]["unusable"];
  EXPECT_NE(unusable.find("hand.stl:2: unreadable vertex"), std::string::npos) << unusable;
}

TEST(Info, RefusesUnusableRobots) {
  const CommandRunner runner;
  runner.write("rootless.urdf", with(kArm, "</robot>",
                                     "<joint name=\"back\" type=\"fixed\">\n"
                                     "<parent link=\"hand\"/><child link=\"base\"/></joint>\n"
                                     "</robot>"));
  const Outcome rootless = runner.run("info rootless.urdf");
  EXPECT_EQ(rootless.exit_code, 2);
  EXPECT_EQ(rootless.err.substr(0, 25), "locograph: rootless.urdf:") << rootless.err;
  runner.write("free.urdf",
               with(kArm, "<limit lower=\"-1\" upper=\"2\" velocity=\"3\" effort=\"4\"/>", ""));
  expect_refusal(runner.run("info free.urdf"), "free.urdf:7", "limit");
  runner.write("broken.urdf", std::string(kArm).substr(0, 300));
  const Outcome broken = runner.run("info broken.urdf");
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_EQ(broken.err.substr(0, 23), "locograph: broken.urdf:") << broken.err;
}

TEST(Info, DescribesAMap) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const nlohmann::json json = info(runner, shared("octomap/geb079.bt"));
  EXPECT_EQ(json["kind"], "map");
  EXPECT_NEAR(json["resolution_m"], 0.08, 1e-12);
  EXPECT_GT(json["occupied_leaves"], 1000);
  EXPECT_EQ(json["occupied_bounds"]["lower_m"].size(), 3u);
}

TEST(Info, RefusesUnusableMaps) {
  const CommandRunner runner;
  runner.write("colour.bt",
               "# Octomap OcTree binary file\nid ColorOcTree\nsize 1\nres 0.1\ndata\n....");
  const Outcome colour = runner.run("info colour.bt");
  EXPECT_EQ(colour.exit_code, 2);
  EXPECT_EQ(colour.err.substr(0, 20), "locograph: colour.bt") << colour.err;
  runner.write("short.bt", "# Octomap OcTree binary file\nid OcTree\nsize 100\nres 0.1\ndata\n.");
  const Outcome truncated = runner.run("info short.bt");
  EXPECT_EQ(truncated.exit_code, 2);
  EXPECT_EQ(truncated.err.substr(0, 19), "locograph: short.bt") << truncated.err;
}

TEST(Info, DescribesObstacles) {
  const CommandRunner runner;
  runner.write("o.xml",
               "<?xml version=\"1.0\"?>\n<!-- <robot> -->\n<obstacles version=\"1\">\n"
               "<box name=\"door\" center=\"1 0 1\" size=\"0.1 0.9 2\"/>\n</obstacles>\n");
  const nlohmann::json json = info(runner, "o.xml");
  EXPECT_EQ(json["kind"], "obstacles");
  EXPECT_EQ(json["obstacles"][0]["name"], "door");
  EXPECT_EQ(json["obstacles"][0]["extents_m"], nlohmann::json({0.1, 0.9, 2.0}));
  runner.write("bad.xml", "<obstacles version=\"1\">\n<box center=\"1 0\"/>\n</obstacles>\n");
  const Outcome bad = runner.run("info bad.xml");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.err.substr(0, 21), "locograph: bad.xml:2:") << bad.err;
}

TEST(Info, DescribesAScenario) {
  const CommandRunner runner;
  const nlohmann::json drive =
      info(runner, "'" LOCOGRAPH_SOURCE_DIR "/planners/scenarios/centauro_drive.xml'");
  EXPECT_EQ(drive["kind"], "scenario");
  EXPECT_EQ(drive["name"], "centauro_drive");
  EXPECT_EQ(drive["drive"]["distance_m"], 4.0);
  EXPECT_EQ(drive["end_effectors"].size(), 4u);
  EXPECT_EQ(drive["end_effectors"][0]["touches_as"], "wheel");
  EXPECT_EQ(drive["missing_files"], nlohmann::json::array());
  EXPECT_EQ(drive["cameras"], nlohmann::json::array());
  runner.write(
      "s.xml",
      "<scenario version=\"1\" name=\"s\">\n<robot urdf=\"arm.urdf\">"
      "<camera name=\"eye\" link=\"hand\" position=\"0 0 0.1\" rpy=\"0 0 0.5\" width=\"64\""
      " height=\"48\" fov_x=\"1.2\" range_min=\"0.2\" range_max=\"5\"/></robot>\n"
      "<wheels><wheel link=\"w\" radius=\"0.1\"/></wheels>\n"
      "<environment map=\"hall.bt\"/>\n"
      "<drive distance=\"2\" speed=\"0.1\" configurations=\"9\"/>\n</scenario>\n");
  const nlohmann::json other = refused_info(runner, "s.xml", "arm.urdf: cannot be opened");
  EXPECT_EQ(other["missing_files"].size(), 2u);
  ASSERT_EQ(other["cameras"].size(), 1u);
  const nlohmann::json& eye = other["cameras"][0];
  EXPECT_EQ(eye["name"], "eye");
  EXPECT_EQ(eye["link"], "hand");
  EXPECT_EQ(eye["position_m"], nlohmann::json({0.0, 0.0, 0.1}));
  EXPECT_NEAR(eye["forward"][0].get<double>(), std::cos(0.5), 1e-12);
  EXPECT_NEAR(eye["up"][2].get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(eye["fov_x_rad"].get<double>(), 1.2, 1e-12);
  EXPECT_EQ(eye["range_max_m"], 5.0);
  runner.write("bad.xml", "<scenario version=\"1\" name=\"s\">\n<robto/>\n</scenario>\n");
  expect_refusal(runner.run("info bad.xml"), "bad.xml:2", "robto");
}

TEST(Info, DescribesAContactTask) {
  const CommandRunner runner;
  const std::string longer_than_paths(5000, 'n');
  runner.write("s.xml",
               "<scenario version=\"1\" name=\"stairs\">\n"
               "<robot urdf=\"arm.urdf\" effort_scale=\"2\"/>\n"
               "<end_effectors>"
               "<end_effector name=\"foot\" link=\"sole\" kind=\"surface\" half_x=\"0.08\""
               " half_y=\"0.035\" max_force=\"1000\"/>"
               "<end_effector name=\"grip\" link=\"hand\" kind=\"rung\" max_force=\"400\""
               " max_moment=\"5\"/></end_effectors>\n"
               "<environment friction=\"0.8\">"
               "<plane name=\"floor\" center=\"1 2 0\" normal=\"0 0 2\" size=\"4 2\"/>"
               "<box name=\"step\" center=\"1 0 0.1\" size=\"0.4 0.3 0.2\" friction=\"0.6\"/>"
               "<rung name=\"rail\" from=\"1 -0.5 1\" to=\"1 0.5 1\" radius=\"0.02\"/>"
               "<mesh name=\"rocks\" file=\"" +
                   longer_than_paths +
                   "\"/></environment>\n"
                   "<start base=\"0 0 0.9 0 0 0 1\"><joint name=\"knee\" position=\"0.7\"/>"
                   "<contact end_effector=\"foot\" position=\"0 0 0\" normal=\"0 0 1\""
                   " forward=\"1 0 0\"/></start>\n"
                   "<goal><contact end_effector=\"foot\" position=\"1 0 0.2\" normal=\"0 0 1\"/>"
                   "</goal>\n"
                   "<goal><contact end_effector=\"grip\" position=\"1 0 1\" normal=\"0 0 1\""
                   " forward=\"1 0 0\"/></goal>\n"
                   "<planner torque_limits=\"report\"/>\n"
                   "</scenario>\n");
  const nlohmann::json json = refused_info(runner, "s.xml", "arm.urdf: cannot be opened");
  EXPECT_EQ(json["task"], "contacts");
  EXPECT_EQ(json["robot"]["effort_scale"], 2.0);
  EXPECT_EQ(json["torque_limits"], "report");

  ASSERT_EQ(json["end_effectors"].size(), 2u);
  const nlohmann::json &foot = json["end_effectors"][0], &grip = json["end_effectors"][1];
  EXPECT_EQ(foot["name"], "foot");
  EXPECT_EQ(foot["link"], "sole");
  EXPECT_EQ(foot["half_y_m"], 0.035);
  EXPECT_EQ(foot["friction"], 0.8);
  EXPECT_EQ(grip["touches_as"], "rung");
  EXPECT_EQ(grip["max_moment_Nm"], 5.0);
  EXPECT_EQ(grip["max_force_N"], 400.0);

  ASSERT_EQ(json["surfaces"].size(), 7u) << "the floor and the faces of the box";
  const nlohmann::json& floor = json["surfaces"][0];
  EXPECT_EQ(floor["name"], "floor");
  EXPECT_EQ(floor["center_m"], nlohmann::json({1.0, 2.0, 0.0}));
  EXPECT_EQ(floor["normal"], nlohmann::json({0.0, 0.0, 1.0}));
  EXPECT_EQ(floor["size_m"], nlohmann::json({4.0, 2.0}));
  EXPECT_TRUE(floor["friction"].is_null()) << "what the end effector says";
  EXPECT_EQ(json["surfaces"][1]["friction"], 0.6);
  EXPECT_EQ(json["bars"][0]["name"], "rail");
  EXPECT_EQ(json["bars"][0]["to_m"], nlohmann::json({1.0, 0.5, 1.0}));
  EXPECT_EQ(json["scanned"][0]["name"], "rocks");
  EXPECT_EQ(json["scanned"][0]["kind"], "mesh");
  EXPECT_EQ(json["missing_files"].size(), 2u) << "the robot's and the mesh";

  const nlohmann::json& task = json["contacts"];
  EXPECT_EQ(task["start"]["base"], nlohmann::json({0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(task["start"]["joints"]["knee"], 0.7);
  EXPECT_EQ(task["start"]["contacts"][0]["end_effector"], "foot");
  ASSERT_EQ(task["goals"].size(), 2u);
  EXPECT_EQ(task["goals"][0]["contacts"][0]["position_m"], nlohmann::json({1.0, 0.0, 0.2}));
  EXPECT_TRUE(task["goals"][0]["contacts"][0]["forward"].is_null()) << "its yaw is free";
  EXPECT_EQ(task["goals"][1]["contacts"][0]["end_effector"], "grip");
  const std::string text = runner.run("info s.xml").out;
  EXPECT_NE(text.find("end_effector: grip\n          position: 1, 0, 1 m\n"), std::string::npos)
      << text;
}

TEST(Info, DescribesContacts) {
  const CommandRunner runner;
  const std::string file = "'" LOCOGRAPH_SOURCE_DIR "/examples/posture/coman_plus_wall.xml'";
  const nlohmann::json json = info(runner, file);
  EXPECT_EQ(json["kind"], "contacts");
  EXPECT_EQ(json["count"], 3);
  EXPECT_EQ(json["contacts"][0]["link"], "l_sole");
  EXPECT_EQ(json["contacts"][0]["max_force_N"], 1000.0);
  EXPECT_EQ(json["contacts"][2]["touches_as"], "point");
  EXPECT_EQ(json["contacts"][2]["position_m"], nlohmann::json({0.55, 0.25, 1.1}));
  EXPECT_NE(runner.run("info " + file).out.find("max_force: 1000 N"), std::string::npos);
  runner.write("bad.xml", "<contacts version=\"1\">\n<contact kind=\"foot\"/>\n</contacts>\n");
  expect_refusal(runner.run("info bad.xml"), "bad.xml:2", "foot");
  runner.write("flat.xml",
               "<contacts version=\"1\">\n<contact link=\"foot\" kind=\"point\" mu=\"0.5\" "
               "max_force=\"1\" position=\"0 0 0\" normal=\"0 0 0\"/>\n</contacts>\n");
  expect_refusal(runner.run("info flat.xml"), "flat.xml:2", "normal of length zero");
}

TEST(Info, DescribesBundleAdjustment) {
  const CommandRunner runner;
  const nlohmann::json json = info(runner, "'" LOCOGRAPH_SOURCE_DIR "/examples/graphs/desk.txt'");
  EXPECT_EQ(json["kind"], "bundle adjustment");
  EXPECT_EQ(json["cameras"], 4);
  EXPECT_EQ(json["points"], 20);
  EXPECT_EQ(json["observations"], 80);
  EXPECT_EQ(json["dimension"], 4 * 9 + 20 * 3);
  runner.write("short.txt", "4 20 80\n0 0 1.0\n");
  const Outcome cut = runner.run("info short.txt");
  EXPECT_EQ(cut.exit_code, 2);
  EXPECT_EQ(cut.err.substr(0, 21), "locograph: short.txt:") << cut.err;
}

TEST(Info, TellsTheKindByContentWhenTheNameDoesNot) {
  const CommandRunner runner;
  runner.write("robot", kArm);
  EXPECT_EQ(refused_info(runner, "robot", "not found")["kind"], "robot");
  runner.write("graph.txt", "VERTEX_XY 0 0 0\n");
  EXPECT_EQ(info(runner, "graph.txt")["kind"], "graph");
}

TEST(Info, PrintsUnitsForPeople) {
  const CommandRunner runner;
  runner.write("arm.urdf", kArm);
  const Outcome outcome = runner.run("info arm.urdf");
  EXPECT_NE(outcome.out.find("mass: 2 kg\n"), std::string::npos) << outcome.out;
}

TEST(Info, RefusesWhatItDoesNotKnow) {
  const CommandRunner runner;
  runner.write("empty", "");
  runner.write("page.html", "<html></html>");
  runner.write("notes.txt", "shopping list\n");
  expect_refusal(runner.run("info none"), "none", "cannot be opened");
  expect_refusal(runner.run("info ."), ".", "is a folder");
  expect_refusal(runner.run("info empty"), "empty", "is empty");
  expect_refusal(runner.run("info page.html"), "page.html", "root element 'html'");
  expect_refusal(runner.run("info notes.txt"), "notes.txt", "unknown tag 'shopping'");
  expect_refusal(runner.run("info"), "", "FILE");
}

TEST(Info, WritesWhatARobotNeedsToBePlannedFor) {
  const CommandRunner runner;
  const std::string urdf = LOCOGRAPH_SOURCE_DIR "/robots/models/go2/go2.urdf";
  const Outcome skeleton =
      runner.run("info " + urdf + " --write-srdf dog.srdf --samples 200 --threads 1 --json");
  ASSERT_EQ(skeleton.exit_code, 0) << skeleton.err;
  const nlohmann::json told = skeleton.json();
  EXPECT_EQ(told["scenario"], "dog.scenario.xml");
  EXPECT_EQ(told["end_effectors"].size(), 4U);
  EXPECT_EQ(told["end_effectors"][0]["kind"], "point");
  EXPECT_EQ(told["samples"], 200);
  EXPECT_LE(told["never_meet"].get<int>() + told["always_meet"].get<int>(), told["pairs"]);
  const Outcome plan = runner.run("plan dog.scenario.xml --seed 1 -o dog.g2o --json");
  EXPECT_EQ(plan.exit_code, 0) << plan.out << plan.err;
  EXPECT_EQ(runner.run("check dog.g2o").exit_code, 0);
  expect_refusal(runner.run("info " + urdf + " --write-srdf dog.srdf"), "dog.scenario.xml",
                 "may have been worked on");
}

TEST(Info, SkeletonsAreRefusedBeforeAnythingIsWritten) {
  const CommandRunner runner;
  const std::string urdf = LOCOGRAPH_SOURCE_DIR "/robots/models/go2/go2.urdf";
  expect_refusal(runner.run("info " + urdf + " --write-srdf missing/dog.srdf"), "missing/dog.srdf",
                 "");
  expect_refusal(runner.run("info " + urdf + " --write-srdf -"), "",
                 "--write-srdf -, expected a file");
  runner.write("bare.urdf", "<robot name='bare'><link name='a'/></robot>");
  expect_refusal(runner.run("info bare.urdf --write-srdf bare.srdf"), "bare.urdf",
                 "no link of the robot has a <collision>");
  EXPECT_FALSE(runner.exists("bare.srdf"));
  expect_refusal(runner.run("info bare.urdf --write-srdf bare.urdf"), "bare.urdf", "");
}

}  // namespace
}  // namespace locograph
