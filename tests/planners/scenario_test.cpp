#include <locograph/common/error.h>

#include "planners/planned_drive.h"

namespace locograph {
namespace {

TEST(Scenario, TheShippedDriveLoadsByName) {
  const DataFolder data;
  EXPECT_EQ(scenario_names(data.path()), std::vector<std::string>{"centauro_drive"});
  const Scenario scenario = load_scenario("centauro_drive", data.path());
  EXPECT_EQ(scenario.name, "centauro_drive");
  EXPECT_EQ(scenario.source, "centauro_drive");
  EXPECT_TRUE(std::filesystem::equivalent(scenario.urdf, centauro_file("centauro.urdf")));
  EXPECT_TRUE(std::filesystem::equivalent(scenario.srdf, centauro_file("centauro.srdf")));
  EXPECT_EQ(scenario.robot.active_joints, std::vector<std::string>{"lower_body"});
  EXPECT_EQ(scenario.start_state, "home");
  ASSERT_EQ(scenario.wheels.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(scenario.wheels[i].link, "wheel_" + std::to_string(i + 1));
    EXPECT_EQ(scenario.wheels[i].radius_m, kRadius);
  }
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
  try {
    load_scenario("centauro_drve", data.path());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "centauro_drve");
    EXPECT_EQ(error.line(), 0);
    EXPECT_NE(std::string(error.what()).find("centauro_drive"), std::string::npos) << error.what();
  }
}

struct Mistake {
  const char* name;
  const char* find;     ///< in kGood
  const char* replace;  ///< by this
  int line;
  const char* words;
};

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

TEST(Scenario, TheOneThatTheMistakesAreMadeInIsGood) {
  const DataFolder data;
  EXPECT_NO_THROW(load_scenario(data.write("s.xml", kGood).string(), data.path()));
}

TEST_P(BadScenario, IsRefusedWithFileAndLine) {
  const DataFolder data;
  std::string text = kGood;
  const std::size_t at = text.find(GetParam().find);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().find).size(), GetParam().replace);
  const std::filesystem::path file = data.write("s.xml", text);
  try {
    load_scenario(file.string(), data.path());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(error.line(), GetParam().line) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().words), std::string::npos) << error.what();
  }
}

const char kDrive[] =
    "<drive distance=\"4\" curvature=\"0\" speed=\"0.1\" configurations=\"50\"/>\n";

INSTANTIATE_TEST_SUITE_P(
    Scenario, BadScenario,
    testing::Values(
        Mistake{"UnknownElement", "<environment/>", "<enviroment/>", 6,
                "unknown element <enviroment>"},
        Mistake{"UnknownAttribute", "speed=", "pace=\"1\" speed=", 7, "unknown attribute 'pace'"},
        Mistake{"UnknownAttributeOfAWheel", "radius=", "width=\"1\" radius=", 4, "'width'"},
        Mistake{"MissingRobot", "<robot model=\"centauro\" active=\"lower_body\"/>", "", 1,
                "no <robot>"},
        Mistake{"RobotWithoutAName", "model=\"centauro\"", "", 2, "not named"},
        Mistake{"ModelAndUrdf", "model=\"centauro\"", "model=\"centauro\" urdf=\"r.urdf\"", 2,
                "either model"},
        Mistake{"UnknownModel", "\"centauro\"", "\"centaurus\"", 2,
                "unknown robot model 'centaurus'"},
        Mistake{"ZeroDistance", "distance=\"4\"", "distance=\"0\"", 7, "distance"},
        Mistake{"NegativeSpeed", "speed=\"0.1\"", "speed=\"-0.1\"", 7, "speed"},
        Mistake{"ZeroRadius", "0.078", "0", 4, "radius"},
        Mistake{"OneConfiguration", "\"50\"", "\"1\"", 7, "configurations"},
        Mistake{"HalfAConfiguration", "\"50\"", "\"2.5\"", 7, "configurations"},
        Mistake{"TooManyConfigurations", "\"50\"", "\"1e300\"", 7, "configurations"},
        Mistake{"NotANumber", "curvature=\"0\"", "curvature=\"nan\"", 7, "curvature"},
        Mistake{"MissingSpeed", "speed=\"0.1\"", "", 7, "speed"},
        Mistake{"SecondDrive", "</scenario>", "<drive/></scenario>", 8, "a second <drive>"},
        Mistake{"NoDrive", kDrive, "", 1, "no task"},
        Mistake{"NoWheels", "<wheel link=\"wheel_1\" radius=\"0.078\"/>", "", 1, "without wheels"},
        Mistake{"Version2", "version=\"1\"", "version=\"2\"", 1, "version '2'"},
        Mistake{"NoVersion", "version=\"1\"", "", 1, "version"},
        Mistake{"NotXml", "</wheels>", "</wheel>", 3, "not well-formed"}),
    [](const testing::TestParamInfo<Mistake>& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace locograph
