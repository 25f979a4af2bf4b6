// Every unusable file is an Error that says where and what.
#include <locograph/common/error.h>
#include <locograph/robots/body_inertia.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/dynamics.h>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

class BadInput : public testing::Test {
 protected:
  /// Replaces `from` (which must be there) by `to` in the small robot's URDF.
  static std::string changed(const std::string& from, const std::string& to) {
    std::string text = small_robot_urdf();
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error("not in the file: " + from);
    return text.replace(at, from.size(), to);
  }

  void expect(const std::filesystem::path& urdf, const std::filesystem::path& srdf,
              const std::string& file, int line, const std::string& part,
              const RobotOptions& options = {}) {
    try {
      Robot::load(urdf, srdf, options);
      ADD_FAILURE() << "no error: " << part;
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.line(), line) << what;
      EXPECT_EQ(std::filesystem::path(error.file()).filename(), file) << what;
      EXPECT_NE(what.find(part), std::string::npos) << what << "\nlacks: " << part;
    }
  }
  void expect_urdf(const std::string& text, int line, const std::string& part,
                   const RobotOptions& options = {}) {
    expect(folder.write("bad.urdf", text), {}, "bad.urdf", line, part, options);
  }
  void expect_srdf(const std::string& text, int line, const std::string& part,
                   const RobotOptions& options = {}) {
    expect(folder.write("small.urdf", small_robot_urdf()), folder.write("bad.srdf", text),
           "bad.srdf", line, part, options);
  }

  TemporaryFolder folder;
};

TEST_F(BadInput, FileThatIsNotThere) {
  expect(folder.path() / "none.urdf", {}, "none.urdf", 0, "cannot be opened");
  const std::filesystem::path urdf = folder.write("small.urdf", small_robot_urdf());
  expect(urdf, folder.path() / "none.srdf", "none.srdf", 0, "cannot be opened");
}

TEST_F(BadInput, FolderInsteadOfAFile) {
  expect(folder.path(), {}, folder.path().filename(), 0, "is a folder");
}

TEST_F(BadInput, EmptyFile) {
  expect_urdf("", 0, "is empty");
  expect_urdf(" \n\n", 0, "is empty");
  expect_srdf("", 0, "is empty");
}

TEST_F(BadInput, FileThatIsNotXml) {
  expect_urdf("hello", 1, "not well-formed XML");
  expect_urdf("<robot name='r'>\n  <link name='a'>\n</robot>\n", 2, "not well-formed XML");
  expect_srdf("<robot>\n<group>\n</robot>", 2, "not well-formed XML");
}

TEST_F(BadInput, XmlThatIsNoRobot) {
  expect_urdf("<?xml version='1.0'?>\n<sdf/>", 2, "root element is <sdf>, expected <robot>");
  expect_urdf("<!-- nothing -->", 0, "no XML element");
}

TEST_F(BadInput, RobotWithoutLinks) { expect_urdf("\n<robot name='r'/>", 2, "no <link>"); }

TEST_F(BadInput, TwoRoots) {
  expect_urdf("<robot name='r'>\n<link name='a'/>\n<link name='b'/>\n</robot>", 3,
              "two root links, 'a' and 'b'");
}

TEST_F(BadInput, NoRoot) {
  expect_urdf(
      "<robot name='r'><link name='a'/><link name='b'/>\n"
      "<joint name='ab' type='fixed'><parent link='a'/><child link='b'/></joint>\n"
      "<joint name='ba' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
      1, "no root link");
}

TEST_F(BadInput, LoopBesideTheTree) {
  expect_urdf(
      "<robot name='r'><link name='root'/>\n<link name='a'/><link name='b'/>\n"
      "<joint name='ab' type='fixed'><parent link='a'/><child link='b'/></joint>\n"
      "<joint name='ba' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
      2, "link 'a' is part of a loop");
}

TEST_F(BadInput, LinkWithTwoParents) {
  expect_urdf(changed("</robot>",
                      "  <joint name=\"again\" type=\"fixed\"><parent link=\"base\"/>"
                      "<child link=\"tip\"/></joint>\n</robot>"),
              17, "link 'tip' has a second parent, joint 'again'");
}

TEST_F(BadInput, NamesUsedTwice) {
  expect_urdf(changed("<link name=\"tip\"/>", "<link name=\"arm\"/>"), 8, "second link 'arm'");
  expect_urdf(changed("<joint name=\"push\"", "<joint name=\"turn\""), 12, "second joint 'turn'");
}

TEST_F(BadInput, NamesThatAreMissing) {
  expect_urdf(changed("<link name=\"tip\"/>", "<link/>"), 8, "<link> without name");
  expect_urdf(changed("<parent link=\"arm\"/>", ""), 12, "joint 'push' has no <parent>");
}

TEST_F(BadInput, JointOfAnUnknownLink) {
  expect_urdf(changed("<child link=\"slide\"/>", "<child link=\"slied\"/>"), 12,
              "joint 'push' names unknown link 'slied', expected one like 'slide'");
}

TEST_F(BadInput, JointWithoutLimits) {
  expect_urdf(changed("<limit lower=\"0.5\" upper=\"2\" velocity=\"1.5\" effort=\"20\"/>", ""), 9,
              "revolute joint 'turn' has no <limit>");
  expect_urdf(changed("<limit lower=\"-0.2\" upper=\"0.4\" velocity=\"0.5\" effort=\"30\"/>", ""),
              12, "prismatic joint 'push' has no <limit>");
  expect_urdf(changed("lower=\"0.5\" upper=\"2\" velocity=\"1.5\"", "lower=\"0.5\" upper=\"2\""),
              11, "<limit> without velocity");
  expect_urdf(changed("lower=\"0.5\" upper=\"2\"", "lower=\"2.5\" upper=\"2\""), 11,
              "lower limit above the upper one");
}

TEST_F(BadInput, JointOfUnknownType) {
  expect_urdf(changed("type=\"prismatic\"", "type=\"helical\""), 12,
              "joint 'push' has unknown type 'helical'");
}

TEST_F(BadInput, FloatingJointInTheMiddle) {
  expect_urdf(changed("type=\"prismatic\"", "type=\"floating\""), 12,
              "joint 'push' has type 'floating'");
}

TEST_F(BadInput, NumbersThatAreNone) {
  expect_urdf(changed("xyz=\"0 0.4 0\"", "xyz=\"0 0.4\""), 13,
              "<origin> with xyz=\"0 0.4\", expected 3 finite numbers");
  expect_urdf(changed("value=\"2\"", "value=\"two\""), 4, "<mass> with value=\"two\"");
  expect_urdf(changed("value=\"2\"", "value=\"nan\""), 4, "1 finite number");
  expect_urdf(changed("xyz=\"0 3 4\"", "xyz=\"0 0 0\""), 10, "joint 'turn' has a zero axis");
}

TEST_F(BadInput, MassAndInertiaThatNoLinkHas) {
  expect_urdf(changed("<mass value=\"2\"/>", "<mass value=\"-2\"/>"), 4,
              "link 'arm' has a negative mass, expected 0 kg or more");
  expect_urdf(changed("<mass value=\"2\"/>", ""), 4, "link 'arm' has an <inertial> without mass");
  expect_urdf(
      changed("<inertia ixx=\"1\" ixy=\"0.1\" ixz=\"0\" iyy=\"2\" iyz=\"0\" izz=\"3\"/>", ""), 4,
      "link 'arm' has an <inertial> without inertia");
  expect_urdf(changed("iyy=\"2\" iyz=\"0\" izz=\"3\"", "iyy=\"2\" iyz=\"0\""), 5,
              "<inertia> without izz");
}

TEST_F(BadInput, InertiaThatNoBodyHasIsOneWhereTheMassMatrixIsAskedFor) {
  for (const char* entries : {"ixx=\"-1\" ixy=\"0\"", "ixx=\"1\" ixy=\"1.5\""}) {
    const Robot robot =
        Robot::load(folder.write("bad.urdf", changed("ixx=\"1\" ixy=\"0.1\"", entries)), {},
                    {.floating_base = false});
    ASSERT_EQ(robot.urdf_warnings().size(), 1u);
    const std::string& warning = robot.urdf_warnings()[0];
    EXPECT_NE(warning.find("bad.urdf:5: link 'arm' has an inertia that no body has"),
              std::string::npos)
        << warning;
    Eigen::VectorXd torques(2);
    gravity_torques(RobotState(robot), standard_gravity(), torques);
    EXPECT_TRUE(torques.allFinite());
    EXPECT_THROW(RobotDynamics{robot}, Error);
  }
}

TEST_F(BadInput, InertiaThatIsRoundedIsNone) {
  for (const char* entries :
       {"ixx=\"-1e-35\" ixy=\"1e-35\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"",
        "ixx=\"0.999\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"2\"",
        "ixx=\"-1e-7\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\""}) {
    const Robot robot = Robot::load(folder.write(
        "rounded.urdf",
        changed("ixx=\"1\" ixy=\"0.1\" ixz=\"0\" iyy=\"2\" iyz=\"0\" izz=\"3\"", entries)));
    EXPECT_EQ(robot.urdf_warnings(), std::vector<std::string>{}) << entries;
  }
}

TEST_F(BadInput, MassesWithoutWhichThereIsNoMotion) {
  const auto expect_refused = [&](const std::string& text, int line, const std::string& part,
                                  bool floating) {
    const Robot robot =
        Robot::load(folder.write("bad.urdf", text), {}, {.floating_base = floating});
    try {
      RobotDynamics dynamics(robot);
      require_solid_bodies(robot, body_inertias(robot));
      ADD_FAILURE() << "no error: " << part;
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.line(), line) << what;
      EXPECT_EQ(std::filesystem::path(error.file()).filename(), "bad.urdf") << what;
      EXPECT_NE(what.find(part), std::string::npos) << what << "\nlacks: " << part;
    }
  };
  const std::string slide_inertial =
      "<inertial><mass value=\"1\"/><origin xyz=\"0 0 0.3\"/>\n"
      "    <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>";
  expect_refused(changed(slide_inertial, ""), 6, "joint 'push' moves no mass, only link 'slide'",
                 true);
  expect_refused(changed("ixx=\"1\" ixy=\"0.1\" ixz=\"0\" iyy=\"2\"",
                         "ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\""),
                 4, "link 'arm' gives its body the principal moments of inertia 1, 1 and 3 kg m^2",
                 false);
  expect_refused(changed("ixx=\"1\" ixy=\"0.1\" ixz=\"0\" iyy=\"2\"",
                         "ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"-1\""),
                 4, "expected none of them below zero", false);
  expect_refused("<robot name='r'>\n<link name='a'/></robot>", 2,
                 "robot 'r' has a floating base and no mass", true);
  const std::string wheel =
      "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' "
      "iyy='1' iyz='0' izz='1'/></inertial></link>\n<link name='b'>\n<inertial>"
      "<origin xyz='0 0.1 0'/><mass value='1'/><inertia ixx='IXX' ixy='0' ixz='0' iyy='0' iyz='0' "
      "izz='IXX'/></inertial></link><joint name='j' type='continuous'><parent link='a'/>"
      "<child link='b'/><axis xyz='0 1 0'/></joint></robot>";
  const auto with = [&](const std::string& inertia) {
    std::string text = wheel;
    for (std::size_t at = text.find("IXX"); at != std::string::npos; at = text.find("IXX")) {
      text.replace(at, 3, inertia);
    }
    return text;
  };
  expect_refused(with("0"), 3, "joint 'j' moves no inertia, only link 'b'", true);
  expect_refused(with("2"), 3, "joint 'j' moves no inertia, only link 'b'", true);
}

TEST_F(BadInput, RobotWithoutMassUnderGravity) {
  const Robot robot =
      Robot::load(folder.write("bad.urdf", "<robot name='r'>\n<link name='a'/></robot>"));
  const RobotState state(robot);
  Eigen::VectorXd torques(6);
  Eigen::MatrixXd derivative(6, 6);
  EXPECT_THROW(gravity_torques(state, standard_gravity(), torques), Error);
  EXPECT_THROW(gravity_torque_derivative(state, standard_gravity(), derivative), Error);
}

TEST_F(BadInput, GeometryThatIsNone) {
  const auto with = [](const std::string& geometry) {
    return changed("<link name=\"tip\"/>", "<link name=\"tip\"><collision>\n<geometry>" + geometry +
                                               "</geometry></collision></link>");
  };
  expect_urdf(with("<cone/>"), 9, "unknown geometry <cone>");
  expect_urdf(with(""), 8, "link 'tip' has a <collision> with no geometry");
  expect_urdf(with("<sphere radius='0'/>"), 9, "expected a positive radius");
  expect_urdf(with("<box size='1 2'/>"), 9, "expected 3 finite numbers");
  expect_urdf(with("<mesh/>"), 9, "<mesh> without filename");
}

TEST_F(BadInput, WhatOnlyUrdfdomNotices) {
  expect_urdf(changed("<axis xyz=\"1 0 1\"/>", "<axis xyz=\"1 0 1\"/><safety_controller/>"), 0,
              "urdfdom refuses it: ");
}

TEST_F(BadInput, MimicJointThatNobodyLeads) {
  const auto with = [](const std::string& leader, const std::string& of_turn = "") {
    std::string text = changed("<axis xyz=\"1 0 1\"/>", "<axis xyz=\"1 0 1\"/>\n<mimic joint=\"" +
                                                            leader + "\" multiplier=\"2\"/>");
    return text.insert(text.find("<axis xyz=\"0 3 4\"/>"), of_turn);
  };
  expect_urdf(with("trun"), 14,
              "joint 'push' mimics unknown joint 'trun', expected one like 'turn'");
  expect_urdf(with("tip_joint"), 14, "joint 'push' mimics fixed joint 'tip_joint'");
  expect_urdf(with("push"), 14, "joint 'push' follows mimic joints that lead each other");
  expect_urdf(with("turn", "<mimic joint=\"push\"/>"), 10,
              "joint 'turn' follows mimic joints that lead each other");
  expect_urdf(with("turn"), 12,
              "mimic joint 'push' is active, but not the joint that leads it, "
              "expected 'turn' among the active joints",
              {.active_joints = {"push"}});
  expect_urdf(changed("<axis xyz=\"1 0 1\"/>", "<axis xyz=\"1 0 1\"/><mimic/>"), 13,
              "<mimic> without joint");
}

TEST_F(BadInput, UnknownActiveJoint) {
  expect_urdf(small_robot_urdf(), 0,
              "no movable joint or group 'trun' to be active, expected one "
              "like 'turn'",
              {.active_joints = {"trun"}});
  expect_urdf(small_robot_urdf(), 0, "no movable joint or group 'tip_joint'",
              {.active_joints = {"tip_joint"}});
}

TEST_F(BadInput, UnknownFrozenState) {
  expect_urdf(small_robot_urdf(), 0, "no group_state 'bent' for the frozen joints",
              {.frozen_state = "bent"});
}

TEST_F(BadInput, SrdfThatNamesWhatTheUrdfDoesNotHave) {
  const auto robot = [](const std::string& content) {
    return "<robot name='small'>\n<group name='g'><joint name='turn'/></group>\n" + content +
           "\n</robot>";
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<group name='h'><joint name='trn'/></group>",
       "unknown joint 'trn', expected one like "
       "'turn'"},
      {"<group name='h'><link name='arn'/></group>", "unknown link 'arn'"},
      {"<group name='h'><chain base_link='base' tip_link='toe'/></group>", "unknown link 'toe'"},
      {"<group name='h'><group name='f'/></group>", "unknown group 'f', expected one like 'g'"},
      {"<group_state name='s' group='k'/>", "unknown group 'k'"},
      {"<group_state name='s' group='g'><joint name='x' value='1'/></group_state>",
       "unknown joint 'x'"},
      {"<disable_collisions link1='arm' link2='leg'/>", "unknown link 'leg'"},
      {"<virtual_joint name='v' child_link='nothing'/>", "unknown link 'nothing'"}};
  for (const auto& [content, part] : cases) {
    expect_srdf(robot(content), 3, part);
    const Robot lenient =
        Robot::load(folder.path() / "small.urdf", folder.write("bad.srdf", robot(content)),
                    {.lenient_srdf = true});
    ASSERT_EQ(lenient.warnings().size(), 1u);
    EXPECT_NE(lenient.warnings()[0].find("bad.srdf:3: " + part), std::string::npos)
        << lenient.warnings()[0];
  }
}

TEST_F(BadInput, SrdfGroupsThatMakeNoSense) {
  expect_srdf(
      "<robot>\n<group name='a'><group name='b'/></group>\n"
      "<group name='b'><group name='a'/></group></robot>",
      2, "group 'a' contains itself");
  expect_srdf("<robot><group name='a'>\n<chain base_link='tip' tip_link='base'/></group></robot>",
              2, "chain from 'tip' to 'base', expected a tip_link below the base_link");
  expect_srdf("<robot><group name='a'>\n<leg name='x'/></group></robot>", 2,
              "unknown member <leg> of a group");
  expect_srdf("<robot><group name='a'/>\n<group name='a'/></robot>", 2, "second group 'a'");
}

TEST_F(BadInput, SrdfStateWithoutANumber) {
  expect_srdf(
      "<robot><group name='a'/><group_state name='s' group='a'>\n"
      "<joint name='turn' value='up'/></group_state></robot>",
      2, "<joint> with value=\"up\", expected 1 finite number");
}

TEST_F(BadInput, NamesAskedForThatDoNotExist) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([&] { robot.link_index("whel_1"); })
                .find("no link 'whel_1', expected one like "
                      "'wheel_1'"),
            std::string::npos);
  EXPECT_NE(message([&] { robot.joint_index("knee_pich_2"); }).find("one like 'knee_pitch_2'"),
            std::string::npos);
  EXPECT_NE(message([&] { robot.named_configuration("hom"); }).find("one like 'home'"),
            std::string::npos);
  EXPECT_NE(message([&] { robot.group_joints("arm"); })
                .find("no group 'arm', expected one like "
                      "'arms'"),
            std::string::npos);
  EXPECT_EQ(robot.find_link("whel_1"), -1);
  EXPECT_EQ(robot.find_joint("knee_pich_2"), -1);
}

TEST_F(BadInput, MeshThatIsMissingWhenItsShapeIsNeeded) {
  const std::filesystem::path urdf = folder.write(
      "mesh.urdf",
      "<robot name='m'><link name='a'>\n<collision><geometry>"
      "<mesh filename='package://no/such.stl'/></geometry></collision></link></robot>");
  const Robot robot = Robot::load(urdf);
  EXPECT_EQ(robot.missing_meshes(), std::vector<std::string>{"package://no/such.stl"});
  try {
    covering_spheres(robot);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_EQ(error.file(), urdf.string());
    EXPECT_NE(std::string(error.what()).find("'package://no/such.stl' not found"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace locograph::test
