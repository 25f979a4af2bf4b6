#include "planners/scenario_texts.h"

namespace locograph {
namespace {

TEST(Scenario, TheShippedDriveLoadsByName) {
  const DataFolder data;
  EXPECT_EQ(scenario_names(data.path()),
            (std::vector<std::string>{"centauro_drive", "centauro_platform", "gap_with_handrail",
                                      "ladder_climbing", "ladder_from_cloud", "ladder_rungs",
                                      "parallel_walls", "quadrupedal_walking", "slanted_wall",
                                      "standing_up", "stepping_stones", "walk_then_stand"}));
  const Scenario scenario = load_scenario("centauro_drive", data.path());
  EXPECT_EQ(scenario.name, "centauro_drive");
  EXPECT_EQ(scenario.source, "centauro_drive");
  EXPECT_TRUE(std::filesystem::equivalent(scenario.urdf, centauro_file("centauro.urdf")));
  EXPECT_TRUE(std::filesystem::equivalent(scenario.srdf, centauro_file("centauro.srdf")));
  EXPECT_EQ(scenario.robot.active_joints, std::vector<std::string>{"lower_body"});
  EXPECT_EQ(scenario.start_state, "home");
  ASSERT_EQ(scenario.end_effectors.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const EndEffector& wheel = scenario.end_effectors[i];
    EXPECT_EQ(wheel.kind, ContactKind::kWheel);
    EXPECT_EQ(wheel.link, "wheel_" + std::to_string(i + 1));
    EXPECT_EQ(wheel.name, wheel.link);
    EXPECT_EQ(wheel.radius_m, kRadius);
    EXPECT_EQ(wheel.friction, kWheelFriction);
    EXPECT_EQ(wheel.max_force_N, kWheelForce_N);
  }
  EXPECT_TRUE(scenario.enforce_torque_limits);
  EXPECT_EQ(scenario.limits.base_linear_m_s, 0.0);
  EXPECT_TRUE(scenario.map.empty());
  EXPECT_TRUE(scenario.obstacles.empty());
  ASSERT_TRUE(scenario.drive.has_value());
  EXPECT_EQ(scenario.drive->distance_m, 4.0);
  EXPECT_EQ(scenario.drive->curvature_1_m, 0.0);
  EXPECT_EQ(scenario.drive->speed_m_s, 0.1);
  EXPECT_EQ(scenario.drive->configurations, 50);
}

TEST(Scenario, FilesInAScenarioAreRelativeToItAndAbsoluteOnesStay) {
  const DataFolder data;
  const std::filesystem::path file =
      data.write("hall.xml",
                 "<scenario version=\"1\" name=\"hall\">\n"
                 "<robot urdf=\"robot/r.urdf\" srdf=\"/robots/r.srdf\" state=\"low\"/>\n"
                 "<wheels><wheel link=\"w\" radius=\"0.1\"/></wheels>\n"
                 "<environment map=\"hall.bt\" obstacles=\"/obstacles.xml\"/>\n"
                 "<drive distance=\"2\" curvature=\"-0.5\" speed=\"0.2\" configurations=\"2\"/>\n"
                 "</scenario>\n");
  const Scenario scenario = load_scenario(file.string(), data.path());
  EXPECT_EQ(scenario.source, file.string());
  EXPECT_EQ(scenario.urdf, data.path() / "robot/r.urdf");
  EXPECT_EQ(scenario.srdf, "/robots/r.srdf");
  EXPECT_EQ(scenario.map, data.path() / "hall.bt");
  EXPECT_EQ(scenario.obstacles, "/obstacles.xml");
  EXPECT_EQ(scenario.start_state, "low");
  EXPECT_EQ(scenario.robot.frozen_state, "low");
  EXPECT_TRUE(scenario.robot.active_joints.empty());
  EXPECT_EQ(scenario.drive->curvature_1_m, -0.5);
  EXPECT_EQ(scenario.drive->line, 5);
}

TEST(Scenario, OneThatIsNotThereIsRefusedNamingTheOnesThatAre) {
  const DataFolder data;
  const std::string longer_than_paths(5000, 'n');
  for (const std::string& name : {std::string("centauro_drve"), longer_than_paths}) {
    try {
      load_scenario(name, data.path());
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), name);
      EXPECT_EQ(error.line(), 0);
      EXPECT_NE(std::string(error.what()).find("one of centauro_drive"), std::string::npos)
          << error.what();
    }
  }
}

TEST(Scenario, KnowsWhatEveryKindOfEndEffectorCanBearAndTheLimitsOfTheMotion) {
  const Scenario scenario = scenario_of(
      "<scenario version=\"1\" name=\"all\">\n"
      "<robot model=\"centauro\"/>\n"
      "<wheels><wheel link=\"wheel_1\" radius=\"0.078\" friction=\"0.4\" max_force=\"900\"/>\n"
      "<wheel link=\"wheel_2\" radius=\"0.078\"/></wheels>\n"
      "<end_effectors>\n"
      "<end_effector name=\"foot\" link=\"ankle2_3\" kind=\"surface\" half_x=\"0.08\""
      " half_y=\"0.04\" max_force=\"1000\" point=\"0 0 -0.1\" link_normal=\"0 1 0\"/>\n"
      "<end_effector name=\"ball\" link=\"ball1_tip\" kind=\"point\" radius=\"0.03\""
      " max_force=\"400\"/>\n"
      "<end_effector name=\"grip\" link=\"ball2_tip\" kind=\"rung\" max_force=\"300\""
      " max_moment=\"5\"/>\n"
      "</end_effectors>\n"
      "<limits base_linear=\"0.5\" base_angular=\"1\" joint_acceleration=\"10\"/>\n"
      "<environment friction=\"0.6\"/>\n"
      "<drive distance=\"2\" speed=\"0.2\" configurations=\"2\"/>\n"
      "<planner torque_limits=\"report\"/>\n"
      "</scenario>\n");
  ASSERT_EQ(scenario.end_effectors.size(), 5u);
  EXPECT_EQ(scenario.end_effectors[0].friction, 0.4);
  EXPECT_EQ(scenario.end_effectors[0].max_force_N, 900.0);
  EXPECT_EQ(scenario.end_effectors[1].friction, 0.6) << "of the environment";
  const EndEffector& foot = scenario.end_effectors[2];
  EXPECT_EQ(foot.name, "foot");
  EXPECT_EQ(foot.kind, ContactKind::kSurface);
  EXPECT_EQ(foot.half_y_m, 0.04);
  EXPECT_EQ(foot.friction, 0.6);
  EXPECT_EQ(foot.point, Eigen::Vector3d(0.0, 0.0, -0.1));
  EXPECT_EQ(foot.normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(scenario.end_effectors[3].radius_m, 0.03);
  EXPECT_EQ(scenario.end_effectors[4].max_moment_Nm, 5.0);
  EXPECT_EQ(scenario.limits.base_linear_m_s, 0.5);
  EXPECT_EQ(scenario.limits.base_angular_rad_s, 1.0);
  EXPECT_EQ(scenario.limits.joint_acceleration_rad_s2, 10.0);
  EXPECT_FALSE(scenario.enforce_torque_limits);
  ASSERT_EQ(world_of(scenario).surfaces.size(), 1u) << "a drive stands on the ground";
}

TEST(Scenario, ADriveWithSurfacesStandsOnThoseOnly) {
  const World world =
      world_of(scenario_of(drive_in("<environment><plane name=\"bridge\" center=\"2 0 0\" "
                                    "normal=\"0 0 1\" size=\"6 1\"/></environment>")));
  ASSERT_EQ(world.surfaces.size(), 1u);
  EXPECT_EQ(world.surfaces[0].name, "bridge");
}

TEST(Scenario, AnExecutionMarginSaysWhatIsNotTheDefault) {
  EXPECT_EQ(scenario_of(drive_in("<environment/>")).margin, ExecutionMargin());
  const Scenario scenario =
      scenario_of(drive_in("<environment/><execution friction=\"0.8\" self_distance=\"0.02\" "
                           "least_force=\"0\" dwell=\"0.25\"/>"));
  EXPECT_EQ(scenario.margin.self_distance_m, 0.02);
  EXPECT_EQ(scenario.margin.friction, 0.8);
  EXPECT_EQ(scenario.margin.least_force, 0.0);
  EXPECT_EQ(scenario.margin.dwell_s, 0.25);
  EXPECT_EQ(scenario.margin.area, ExecutionMargin().area);
}

class BadScenario : public testing::TestWithParam<Mistake> {};

const std::string kGood =
    "<scenario version=\"1\" name=\"test\">\n"                                       // line 1
    "<robot model=\"centauro\" active=\"lower_body\"/>\n"                            // 2
    "<wheels>\n"                                                                     // 3
    "<wheel link=\"wheel_1\" radius=\"0.078\"/>\n"                                   // 4
    "</wheels>\n"                                                                    // 5
    "<environment/>\n"                                                               // 6
    "<drive distance=\"4\" curvature=\"0\" speed=\"0.1\" configurations=\"50\"/>\n"  // 7
    "</scenario>\n";

TEST(Scenario, TheOneThatTheMistakesAreMadeInIsGood) { EXPECT_NO_THROW(scenario_of(kGood)); }

TEST_P(BadScenario, IsRefusedWithFileAndLine) { expect_refused(kGood, GetParam()); }

const char kDrive[] =
    "<drive distance=\"4\" curvature=\"0\" speed=\"0.1\" configurations=\"50\"/>\n";

INSTANTIATE_TEST_SUITE_P(
    Scenario, BadScenario,
    testing::Values(
        Mistake{"UnknownElement", "<environment/>", "<enviroment/>", 6,
                "unknown element <enviroment>"},
        Mistake{"UnknownAttribute", "speed=", "pace=\"1\" speed=", 7, "unknown attribute 'pace'"},
        Mistake{"FrictionOfZero", "<environment/>", "<environment friction=\"0\"/>", 6, "friction"},
        Mistake{"NegativeForceOfAWheel", "radius=", "max_force=\"-1\" radius=", 4, "max_force"},
        Mistake{"TheSameWheelTwice", "</wheels>",
                "<wheel link=\"wheel_1\" radius=\"0.078\"/></wheels>", 5,
                "a second end effector wheel_1"},
        Mistake{"EndEffectorWithoutFriction", "<environment/>",
                "<end_effectors><end_effector name=\"f\" link=\"l\" kind=\"point\" "
                "max_force=\"1\"/></end_effectors>",
                6, "the friction of f is not known"},
        Mistake{"EndEffectorOfAnUnknownKind", "<environment/>",
                "<end_effectors><end_effector name=\"f\" link=\"l\" kind=\"hook\"/>"
                "</end_effectors>",
                6, "unknown kind of contact 'hook'"},
        Mistake{"EndEffectorWithASizeOfAnother", "<environment/>",
                "<end_effectors><end_effector name=\"f\" link=\"l\" kind=\"point\" half_x=\"1\" "
                "max_force=\"1\"/></end_effectors>",
                6, "unknown attribute 'half_x'"},
        Mistake{"EndEffectorWithoutAName", "<environment/>",
                "<end_effectors><end_effector link=\"l\" kind=\"point\" max_force=\"1\"/>"
                "</end_effectors>",
                6, "without name"},
        Mistake{"NegativeLimit", "<environment/>", "<limits base_linear=\"-1\"/>", 6,
                "base_linear"},
        Mistake{"UnknownLimit", "<environment/>", "<limits jerk=\"1\"/>", 6, "'jerk'"},
        Mistake{"TorqueLimitsThatAreNone", "<environment/>", "<planner torque_limits=\"no\"/>", 6,
                "torque_limits is 'no'"},
        Mistake{"ExecutionMarginBeyondOne", "<environment/>", "<execution friction=\"1.5\"/>", 6,
                "friction=\"1.5\", expected a share that is used, above 0, at most 1"},
        Mistake{"ExecutionMarginOfNothing", "<environment/>", "<execution area=\"0\"/>", 6, "area"},
        Mistake{"NegativeTorqueShare", "<environment/>", "<execution torque=\"-0.9\"/>", 6,
                "torque"},
        Mistake{"NegativeJointMargin", "<environment/>", "<execution joint=\"-0.02\"/>", 6,
                "joint"},
        Mistake{"NegativeSelfDistance", "<environment/>", "<execution self_distance=\"-0.01\"/>", 6,
                "self_distance"},
        Mistake{"LeastForceOfTheWholeWeight", "<environment/>", "<execution least_force=\"1\"/>", 6,
                "least_force"},
        Mistake{"DwellWithoutEnd", "<environment/>", "<execution dwell=\"1e9\"/>", 6,
                "expected 0 to 60 s"},
        Mistake{"NegativeDwell", "<environment/>", "<execution dwell=\"-0.5\"/>", 6, "dwell"},
        Mistake{"UnknownMargin", "<environment/>", "<execution mass=\"0.1\"/>", 6, "'mass'"},
        Mistake{"TwoMargins", "<environment/>", "<execution/><execution/>", 6,
                "a second <execution>"},
        Mistake{"TextThatNobodyReads", "<environment/>", "<execution>dwell 0.5</execution>", 6,
                "text in <execution>, expected attributes alone"},
        Mistake{"SomethingUnknownInTheEnvironment", "<environment/>",
                "<environment><pond name=\"p\"/></environment>", 6, "unknown element <pond>"},
        Mistake{"UnknownAttributeOfAWheel", "radius=", "width=\"1\" radius=", 4, "'width'"},
        Mistake{"MissingRobot", "<robot model=\"centauro\" active=\"lower_body\"/>", "", 1,
                "no <robot>"},
        Mistake{"RobotWithoutAName", "model=\"centauro\"", "", 2, "not named"},
        Mistake{"ModelAndUrdf", "model=\"centauro\"", "model=\"centauro\" urdf=\"r.urdf\"", 2,
                "either model"},
        Mistake{"UnknownModel", "\"centauro\"", "\"centaurus\"", 2,
                "unknown robot model 'centaurus'"},
        Mistake{"ZeroDistance", "distance=\"4\"", "distance=\"0\"", 7, "distance"},
        Mistake{"ADistanceBeyondAllDrives", "distance=\"4\"", "distance=\"4e3\"", 7,
                "distance is 4000, expected a number > 0 to 1000"},
        Mistake{"ASpeedThatNeverArrives", "speed=\"0.1\"", "speed=\"1e-300\"", 7,
                "speed is 1e-300, expected a number from 0.001 to 100"},
        Mistake{"ACurvatureBeyondAllCurves", "curvature=\"0\"", "curvature=\"1e16\"", 7,
                "curvature=\"1e16\""},
        Mistake{"AWheelBeyondAllWheels", "0.078", "1e16", 4, "radius is 1e+16"},
        Mistake{"AForceBeyondAllForces", "radius=", "max_force=\"1e300\" radius=", 4,
                "max_force is 1e+300"},
        Mistake{"FrictionBeyondAllFriction", "<environment/>", "<environment friction=\"1e9\"/>", 6,
                "friction is 1e+09"},
        Mistake{"APlaceOnALinkBeyondAllDistances", "<environment/>",
                "<end_effectors><end_effector name=\"f\" link=\"l\" kind=\"wheel\" radius=\"1\" "
                "max_force=\"1\" point=\"0 1e16 0\"/></end_effectors>",
                6, "point=\"0 1e16 0\""},
        Mistake{"NegativeSpeed", "speed=\"0.1\"", "speed=\"-0.1\"", 7, "speed"},
        Mistake{"ZeroRadius", "0.078", "0", 4, "radius"},
        Mistake{"OneConfiguration", "\"50\"", "\"1\"", 7, "configurations"},
        Mistake{"HalfAConfiguration", "\"50\"", "\"2.5\"", 7, "configurations"},
        Mistake{"TooManyConfigurations", "\"50\"", "\"1e300\"", 7, "configurations"},
        Mistake{"NotANumber", "curvature=\"0\"", "curvature=\"nan\"", 7, "curvature"},
        Mistake{"MissingSpeed", "speed=\"0.1\"", "", 7, "speed"},
        Mistake{"SecondDrive", "</scenario>", "<drive/></scenario>", 8, "a second <drive>"},
        Mistake{"NoDrive", kDrive, "", 1, "no task"},
        Mistake{"ADriveAndAContactTask", "</scenario>",
                "<start><contact end_effector=\"wheel_1\" position=\"0 0 0\" normal=\"0 0 1\"/>"
                "</start><goal><contact end_effector=\"wheel_1\" position=\"1 0 0\" "
                "normal=\"0 0 1\"/></goal></scenario>",
                8, "both a <drive> and a <start>"},
        Mistake{"NoWheels", "<wheel link=\"wheel_1\" radius=\"0.078\"/>", "", 1, "without wheels"},
        Mistake{"Version2", "version=\"1\"", "version=\"2\"", 1, "version '2'"},
        Mistake{"NoVersion", "version=\"1\"", "", 1, "version"},
        Mistake{"NotXml", "</wheels>", "</wheel>", 3, "not well-formed"}),
    mistake_name);

}  // namespace
}  // namespace locograph
