// `posture` as a user runs it.
#include <apps/command_runner.h>

#include <cmath>

namespace locograph {
namespace {

const std::string kExamples = LOCOGRAPH_SOURCE_DIR "/examples/posture/";

std::string sole(const std::string& link, double y, const std::string& more = "") {
  return "<contact link=\"" + link + "\" kind=\"surface\" position=\"0 " + std::to_string(y) +
         " 0\" normal=\"0 0 1\" forward=\"1 0 0\" half_x=\"0.09\" half_y=\"0.045\" mu=\"0.6\" "
         "max_force=\"1000\"" +
         more + "/>\n";
}

std::string contacts(const std::string& lines) {
  return "<contacts version=\"1\">\n" + lines + "</contacts>\n";
}

/// Two spheres with a hinge: as small as a robot can be. shape: of each, if they are to have one.
std::string small_robot(const std::string& effort, const std::string& inertial,
                        const std::string& shape =
                            "<collision><origin xyz=\"0 0 0.1\"/><geometry>"
                            "<sphere radius=\"0.05\"/></geometry></collision>") {
  return "<robot name=\"small\">\n<link name=\"base\">" + inertial + shape +
         "</link>\n<link name=\"arm\">" + inertial + shape +
         "</link>\n<joint name=\"hinge\" type=\"revolute\"><parent link=\"base\"/>"
         "<child link=\"arm\"/><origin xyz=\"0 0 0.5\"/><axis xyz=\"0 1 0\"/>"
         "<limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"" +
         effort + "\"/></joint>\n</robot>\n";
}
const char kBody[] =
    "<inertial><mass value=\"2\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" "
    "ixz=\"0\" iyz=\"0\"/></inertial>";
const char kOnItsBase[] =
    "<contacts version=\"1\">\n"
    "<contact link=\"base\" kind=\"surface\" position=\"0 0 0\" normal=\"0 0 1\" half_x=\"0.1\" "
    "half_y=\"0.1\" mu=\"0.5\" max_force=\"100\"/>\n"
    "</contacts>\n";

TEST(PostureCommand, FindsTheExamplesThatComeAlong) {
  const CommandRunner runner;
  for (const char* robot : {"coman_plus", "centauro"}) {
    const std::string file =
        kExamples + (robot[1] == 'o' ? "coman_plus_wall.xml" : "centauro_step.xml");
    const Outcome outcome = runner.run(std::string("posture ") + robot + " --contacts '" + file +
                                       "' -o " + robot + ".g2o --json");
    ASSERT_EQ(outcome.exit_code, 0) << robot << ": " << outcome.out << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json["success"], true);
    EXPECT_EQ(json["robot"], robot);
    EXPECT_GE(json["min_balance_margin"].get<double>(), 0.0);
    EXPECT_LE(json["max_torque_ratio"].get<double>(), 1.0);
    EXPECT_EQ(json["base"].size(), 7U);
    EXPECT_GE(json["contacts"].size(), 3U);
    for (const auto& contact : json["contacts"]) EXPECT_EQ(contact["wrench"].size(), 6U);
    for (const auto& violation : json["violations"]) EXPECT_EQ(violation["violated"], false);
    for (const char* phase : {"load", "build", "optimise", "geometry", "balance", "solve"}) {
      EXPECT_GE(json["time"][phase].get<double>(), 0.0) << phase;
    }
    const Outcome info = runner.run(std::string("info ") + robot + ".g2o --json");
    EXPECT_EQ(info.exit_code, 0) << info.err;
    const Outcome optimised =
        runner.run(std::string("optimize ") + robot + ".g2o -o again.g2o --json");
    EXPECT_EQ(optimised.exit_code, 0) << optimised.err;
    EXPECT_LT(optimised.json()["initial_chi2"].get<double>(), 10.0);
    // What the solver accepted the judge accepts, in the same numbers.
    const Outcome checked = runner.run(std::string("check ") + robot + ".g2o --json");
    EXPECT_EQ(checked.exit_code, 0) << checked.out;
    EXPECT_EQ(checked.json()["min_balance_margin"], json["min_balance_margin"]);
  }
}

TEST(PostureCommand, SaysInWordsWhatItFound) {
  const CommandRunner runner;
  runner.write("feet.xml", contacts(sole("l_sole", 0.12) + sole("r_sole", -0.12)));
  const Outcome outcome = runner.run("posture coman_plus --contacts feet.xml -o out.g2o");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("posture found"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("written: out.g2o"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("without a collision shape: HeadHokuyo"), std::string::npos)
      << outcome.out;
  EXPECT_TRUE(runner.exists("out.g2o"));
}

TEST(PostureCommand, GivesTheSamePostureForTheSameSeed) {
  const CommandRunner runner;
  const std::string call =
      "posture coman_plus --contacts '" + kExamples + "coman_plus_wall.xml' --seed 4 -o ";
  ASSERT_EQ(runner.run(call + "a.g2o").exit_code, 0);
  ASSERT_EQ(runner.run(call + "b.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("a.g2o"), runner.read("b.g2o"));
}

TEST(PostureCommand, WhatCannotBeReachedIsAnswerNoAndWritesNothing) {
  const CommandRunner runner;
  runner.write("far.xml", contacts(sole("l_sole", 0.12) + sole("r_sole", -4.12)));
  const Outcome outcome =
      runner.run("posture coman_plus --contacts far.xml --restarts 1 -o out.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["success"], false);
  EXPECT_EQ(json["status"], "not_found");
  const std::string reason = json["reason"];
  EXPECT_NE(reason.find("contact_position"), std::string::npos) << reason;
  EXPECT_NE(reason.find(" m, limit"), std::string::npos) << reason;
  EXPECT_FALSE(runner.exists("out.g2o"));
}

TEST(PostureCommand, KeepsOutOfAMapAndObstacles) {
  const CommandRunner runner;
  runner.write("feet.xml", contacts(sole("l_sole", 0.12) + sole("r_sole", -0.12)));
  // A box that the robot's trunk cannot but be in.
  runner.write("box.xml",
               "<obstacles version=\"1\">\n"
               "  <box name=\"box\" center=\"0 0 1.05\" size=\"1.5 1.5 1.5\"/>\n"
               "</obstacles>\n");
  const Outcome outcome =
      runner.run("posture coman_plus --contacts feet.xml --obstacles box.xml --restarts 1 --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.json()["success"], false);
}

TEST(PostureCommand, ReadsARobotFromItsUrdf) {
  const CommandRunner runner;
  runner.write("small.urdf", small_robot("5", kBody));
  runner.write("base.xml", kOnItsBase);
  const Outcome outcome = runner.run("posture small.urdf --contacts base.xml --json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

// The shapes go from its file, for whatever reason, after there is a posture.
TEST(PostureCommand, IsNotBelievedByCheckOfARobotWithoutShapes) {
  const CommandRunner runner;
  runner.write("small.urdf", small_robot("5", kBody));
  runner.write("base.xml", kOnItsBase);
  ASSERT_EQ(runner.run("posture small.urdf --contacts base.xml -o out.g2o").exit_code, 0);
  EXPECT_EQ(runner.run("check out.g2o").exit_code, 0);
  runner.write("small.urdf", small_robot("5", kBody, ""));
  // Its edges say how many shapes there were; without them nothing does.
  EXPECT_EQ(runner.run("check out.g2o").exit_code, 2);
  std::istringstream posture(runner.read("out.g2o"));
  std::string rest;
  for (std::string line; std::getline(posture, line);) {
    const bool counts = line.starts_with("EDGE_SELF_") || line.starts_with("EDGE_SURFACE_");
    if (!counts) rest += line + '\n';
  }
  runner.write("out.g2o", rest);
  const Outcome checked = runner.run("check out.g2o");
  EXPECT_EQ(checked.exit_code, 1) << checked.err;
  EXPECT_NE(checked.out.find("NOT feasible"), std::string::npos) << checked.out;
  EXPECT_NE(checked.out.find("not judged: obstacle_distance, ground_penetration, touching_depth, "
                             "self_collision, because no link of the robot has a collision shape"),
            std::string::npos)
      << checked.out;
  const nlohmann::json json = runner.run("check out.g2o --json").json();
  EXPECT_EQ(json["feasible"], false);
  EXPECT_TRUE(json["min_clearance_m"].is_null());
  for (const auto& violation : json["violations"]) {
    if (violation["constraint"] != "obstacle_distance") continue;
    EXPECT_EQ(violation["judged"], false);
    EXPECT_TRUE(violation["worst"].is_null());
  }
}

// A hand in the wall is in the wall, whatever comes before its shape in the file.
TEST(PostureCommand, SeesShapesBelowVisualsWhoseMaterialsHaveNoName) {
  const CommandRunner runner;
  const std::string nameless =
      "<visual><geometry><sphere radius=\"0.05\"/></geometry><material><color rgba=\"1 0 0 1\"/>"
      "</material></visual><collision><origin xyz=\"0 0 0.1\"/><geometry><sphere "
      "radius=\"0.05\"/></geometry></collision>";
  runner.write("small.urdf", small_robot("5", kBody, nameless));
  runner.write("base.xml", kOnItsBase);
  runner.write("box.xml",
               "<obstacles version=\"1\">\n"
               "  <box name=\"box\" center=\"0 0 0.6\" size=\"1 1 0.5\"/>\n"
               "</obstacles>\n");
  EXPECT_EQ(runner.run("posture small.urdf --contacts base.xml").exit_code, 0);
  EXPECT_EQ(runner.run("posture small.urdf --contacts base.xml --obstacles box.xml").exit_code, 1);
}

// Statics asks for masses only.
TEST(PostureCommand, TakesARobotWithAnInertiaThatNoBodyHas) {
  const CommandRunner runner;
  runner.write("odd.urdf",
               small_robot("5",
                           "<inertial><mass value=\"2\"/><inertia ixx=\"-1\" iyy=\"0.01\" "
                           "izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"));
  runner.write("base.xml", kOnItsBase);
  const Outcome outcome = runner.run("posture odd.urdf --contacts base.xml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST(PostureCommand, RefusesBadInputOnOneLineAndWritesNothing) {
  const CommandRunner runner;
  runner.write("base.xml", kOnItsBase);
  runner.write("feet.xml", contacts(sole("l_sole", 0.12) + sole("r_sole", -0.12)));
  runner.write("weak.urdf", small_robot("0", kBody));
  runner.write("shapeless.urdf", small_robot("5", kBody, ""));
  runner.write("empty.urdf", small_robot("5", ""));
  runner.write("massless.urdf",
               small_robot("5",
                           "<inertial><mass value=\"-2\"/><inertia ixx=\"1\" iyy=\"1\" "
                           "izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"));
  runner.write("link.xml", contacts(sole("l_soul", 0.12)));
  runner.write("none.xml", contacts(""));
  runner.write("twice.xml", contacts(sole("l_sole", 0.12) + sole("l_sole", -0.12)));
  runner.write("nan.xml", contacts(sole("l_sole", std::nan(""))));
  const int before = runner.files();
  const auto refused = [&](const std::string& arguments, const std::string& place,
                           const std::string& words) {
    SCOPED_TRACE(arguments);
    expect_refusal(runner.run("posture " + arguments + " -o out.g2o"), place, words);
  };
  refused("weak.urdf --contacts base.xml", "weak.urdf", "effort limit of 0");
  refused("shapeless.urdf --contacts base.xml", "shapeless.urdf",
          "no link of the robot has a <collision>");
  refused("empty.urdf --contacts base.xml", "empty.urdf", "mass");
  refused("massless.urdf --contacts base.xml", "massless.urdf:2", "mass");
  refused("coman_minus --contacts base.xml", "coman_minus", "no such robot");
  refused("coman_plus --contacts missing.xml", "missing.xml", "cannot be opened");
  refused("coman_plus --contacts link.xml", "link.xml:2", "l_sole");
  refused("coman_plus --contacts none.xml", "none.xml:1", "no contacts");
  refused("coman_plus --contacts twice.xml", "twice.xml:3", "contradict");
  refused("coman_plus --contacts nan.xml", "nan.xml:2", "finite");
  refused("coman_plus --contacts feet.xml --state asleep", "", "asleep");
  refused("coman_plus --contacts feet.xml --map missing.bt", "missing.bt", "");
  refused("coman_plus --contacts feet.xml --torque-limits perhaps", "", "perhaps");
  EXPECT_EQ(runner.files(), before);
}

}  // namespace
}  // namespace locograph
