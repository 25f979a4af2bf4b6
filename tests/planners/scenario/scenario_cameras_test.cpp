// Cameras of a scenario's robot.

#include <locograph/planners/scenario/scenario.h>

#include <cmath>

#include "planners/scenario_texts.h"
#include "plugins/small_robot.h"

namespace locograph {
namespace {

const std::string kWatched =
    "<scenario version=\"1\" name=\"watched\">\n"  // line 1
    "<robot urdf=\"cart.urdf\">\n"                 // 2
    "<camera name=\"front\" link=\"mast\" position=\"0.1 0 0.5\" rpy=\"0 0.5 0\" width=\"640\""
    " height=\"480\" fov_x=\"1.2\" range_min=\"0.2\" range_max=\"5\"/>\n"  // 3
    "<camera name=\"wrist\" link=\"arm\" width=\"64\" height=\"48\" fov_x=\"1\" range_min=\"0\""
    " range_max=\"2\"/>\n"                                       // 4
    "</robot>\n"                                                 // 5
    "<wheels><wheel link=\"wheel\" radius=\"0.1\"/></wheels>\n"  // 6
    "<drive distance=\"2\" speed=\"0.2\" configurations=\"2\"/>\n"
    "</scenario>\n";

Robot cart() {
  const TemporaryFolder folder;
  return Robot::load(folder.write("cart.urdf", test::kCartUrdf));
}

TEST(ScenarioCameras, AreOnTheirLinksAndLookForward) {
  const Robot robot = cart();
  const std::vector<DepthCamera> cameras = cameras_of(scenario_of(kWatched), robot);
  ASSERT_EQ(cameras.size(), 2u);
  const DepthCamera &front = cameras[0], &wrist = cameras[1];
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(front.link, robot.link_index("mast"));
  EXPECT_EQ(front.width, 640);
  EXPECT_EQ(front.height, 480);
  EXPECT_NEAR(2.0 * std::atan(320.0 / front.fx), 1.2, 1e-12);
  EXPECT_EQ(front.fy, front.fx);
  EXPECT_EQ(front.range_min_m, 0.2);
  EXPECT_EQ(front.range_max_m, 5.0);
  const Eigen::Isometry3d& pose = front.link_from_optical;
  EXPECT_EQ(Eigen::Vector3d(pose.translation()), Eigen::Vector3d(0.1, 0.0, 0.5));
  const Eigen::Vector3d down(std::cos(0.5), 0.0, -std::sin(0.5));
  EXPECT_LT((pose.linear().col(2) - down).norm(), 1e-12) << "a pitch of 0.5 looks down";
  EXPECT_LT((pose.linear().col(0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_EQ(wrist.link, robot.link_index("arm"));
  EXPECT_TRUE(wrist.link_from_optical.isApprox(body_from_optical()));
}

TEST(ScenarioCameras, AnOpticalFrameIsTurnedBackByTheRpyOfTheDocumentation) {
  const Scenario scenario = scenario_of(
      with(kWatched, "rpy=\"0 0.5 0\"", "rpy=\"1.5707963267948966 -1.5707963267948966 0\""));
  const Eigen::Matrix3d rotation = scenario.cameras[0].camera.link_from_optical.linear();
  EXPECT_LT((rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(ScenarioCameras, WithoutAnyTheRobotHasItsOwn) {
  std::string text = kWatched;
  const std::size_t first = text.find("<camera"), end = text.find("</robot>");
  text.erase(first, end - first);
  EXPECT_TRUE(cameras_of(scenario_of(text), cart()).empty());
  const auto models = std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/centauro";
  const Robot centauro = Robot::load(models / "centauro.urdf");
  EXPECT_EQ(cameras_of(scenario_of(text), centauro).size(), 2u);
}

TEST(ScenarioCameras, OneOnAnUnknownLinkIsRefusedWithItsLine) {
  const Scenario scenario = scenario_of(with(kWatched, "link=\"arm\"", "link=\"amr\""));
  try {
    cameras_of(scenario, cart());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 4);
    EXPECT_EQ(error.file(), scenario.source);
    EXPECT_NE(std::string(error.what()).find("no link 'amr'"), std::string::npos) << error.what();
  }
}

class BadCamera : public testing::TestWithParam<Mistake> {};
TEST_P(BadCamera, IsRefusedWithFileAndLine) { expect_refused(kWatched, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    All, BadCamera,
    testing::Values(
        Mistake{"WithoutALink", " link=\"mast\"", "", 3, "<camera> without link"},
        Mistake{"WithoutAName", "name=\"front\"", "name=\"\"", 3, "name"},
        Mistake{"OfTheSameName", "\"wrist\"", "\"front\"", 4, "a second camera 'front'"},
        Mistake{"WithAnUnknownAttribute", "fov_x=\"1.2\"", "fov=\"1.2\"", 3, "fov"},
        Mistake{"ThatSeesAllAround", "fov_x=\"1.2\"", "fov_x=\"6.28\"", 3,
                "fov_x=\"6.28\", expected an angle between 0 and pi"},
        Mistake{"ThatSeesNothing", "fov_x=\"1.2\"", "fov_x=\"0\"", 3, "fov_x=\"0\""},
        Mistake{"OfHalfAPixel", "width=\"64\"", "width=\"64.5\"", 4, "a whole number of pixels"},
        Mistake{"WithoutPixels", "width=\"64\"", "width=\"0\"", 4, "width is 0"},
        Mistake{"OfTooManyPixels", "height=\"48\"", "height=\"4097\"", 4,
                "height is 4097, expected a number from 1 to 4096"},
        Mistake{"WithItsRangesExchanged", "range_min=\"0.2\"", "range_min=\"5\"", 3,
                "range_min=\"5\", expected zero or more, less than range_max"},
        Mistake{"WithoutRange", "range_max=\"2\"", "range_max=\"0\"", 4, "range_max is 0"},
        Mistake{"BehindItself", "range_min=\"0\"", "range_min=\"-1\"", 4, "range_min=\"-1\""},
        Mistake{"FarAway", "position=\"0.1 0 0.5\"", "position=\"0.1 0 1e7\"", 3, "position="},
        Mistake{"TurnedByTwoAngles", "rpy=\"0 0.5 0\"", "rpy=\"0 0.5\"", 3, "rpy"}),
    mistake_name);

}  // namespace
}  // namespace locograph
