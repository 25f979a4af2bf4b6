// Every <collision> of a URDF is loaded, or the file is refused; who has none is named.
#include <locograph/common/error.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/names.h>

#include <regex>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

const std::string kBall = "<collision><geometry><sphere radius='0.1'/></geometry></collision>\n";
const std::string kSeen = "<visual><geometry><sphere radius='0.1'/></geometry>";

std::string link(const std::string& name, const std::string& content) {
  return "<link name='" + name + "'>\n" + content + "</link>\n";
}

/// The other links hang from the first.
std::string robot_of(const std::vector<std::pair<std::string, std::string>>& links,
                     const std::string& more = "") {
  std::string text = "<robot name='r'>\n" + more;
  for (const auto& [name, content] : links) {
    text += link(name, content);
    if (name == links.front().first) continue;
    text += "<joint name='" + name + "_joint' type='fixed'><parent link='" + links.front().first +
            "'/><child link='" + name + "'/></joint>\n";
  }
  return text + "</robot>\n";
}

int loaded_elements(const Robot& robot) {
  int count = 0;
  for (const Link& one : robot.links()) count += one.collision_elements;
  return count;
}

class UrdfShapes : public testing::Test {
 protected:
  Robot load(const std::string& text) const { return Robot::load(folder.write("r.urdf", text)); }
  std::string refusal(const std::string& text) const {
    try {
      load(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "taken";
  }

  TemporaryFolder folder;
};

TEST_F(UrdfShapes, AreLoadedBelowVisualsWhoseMaterialsHaveNoName) {
  const std::string seen = kSeen + "<material><color rgba='0.2 0.2 0.2 1'/></material></visual>\n" +
                           kSeen + "<material name=''/></visual>\n";
  const Robot robot = load(robot_of({{"base", seen + kBall}, {"arm", kBall + seen + kBall}}));
  ASSERT_EQ(robot.links()[0].collision.size(), 1u);
  ASSERT_EQ(robot.links()[1].collision.size(), 2u);
  EXPECT_EQ(robot.links()[1].collision[0].line, 8);
  EXPECT_EQ(robot.links()[1].collision[1].line, 11);
  EXPECT_EQ(loaded_elements(robot), 3);
  EXPECT_EQ(covering_spheres(robot).size(), 3u);
}

TEST_F(UrdfShapes, DoNotDependOnMaterialsOfTheWholeRobot) {
  const std::string grey = "<material name='grey'><color rgba='0.5 0.5 0.5 1'/></material>\n";
  for (const std::string& materials :
       {std::string("<material/>\n"), std::string("<material><color rgba='1 0 0 1'/></material>\n"),
        std::string("<material name='bare'/>\n"), grey + grey}) {
    EXPECT_EQ(loaded_elements(load(robot_of({{"base", kBall}}, materials))), 1) << materials;
  }
}

TEST_F(UrdfShapes, AndMassesAreReadWhateverBlanksTheirNumbersStandIn) {
  const Robot robot = load(robot_of(
      {{"base",
        "<inertial><mass value=' 2 '/><inertia ixx='1 ' iyy='1' izz='1' ixy='0' ixz='0' "
        "iyz='0'/></inertial><collision><origin xyz='0\t0\n 0.3 ' rpy=' 0 0\t0'/><geometry>"
        "<cylinder radius=' 0.1' length='0.2 '/></geometry></collision>"}}));
  EXPECT_EQ(robot.total_mass(), 2.0);
  ASSERT_EQ(robot.links()[0].collision.size(), 1u);
  EXPECT_EQ(robot.links()[0].collision[0].link_from_shape.translation().z(), 0.3);
  EXPECT_EQ(robot.links()[0].collision[0].length, 0.2);
}

TEST_F(UrdfShapes, ThatCannotBeReadAreRefusedByLineAndLink) {
  const auto expect = [&](const std::string& collision, const std::string& words) {
    const std::string text =
        robot_of({{"base", kBall}, {"hand", kBall + "<collision>" + collision + "</collision>"}});
    const std::string what = refusal(text);
    EXPECT_NE(what.find("r.urdf:7: "), std::string::npos) << what;
    EXPECT_NE(what.find(words), std::string::npos) << what;
  };
  const auto with = [](const std::string& shape) { return "<geometry>" + shape + "</geometry>"; };
  expect("", "link 'hand' has a <collision> with no geometry");
  expect(with(""), "link 'hand' has a <collision> with no geometry");
  expect(with("<cone radius='1'/>"), "link 'hand' has a <collision> with unknown geometry <cone>");
  expect(with("<sphere radius='1'/><sphere radius='2'/>"),
         "link 'hand' has a <collision> with more than one geometry");
  expect(with("<sphere radius='1'/>") + with("<sphere radius='2'/>"),
         "link 'hand' has a <collision> with more than one geometry");
  expect(with("<box size='1 1 -1'/>"), "<box> with size=\"1 1 -1\", expected a positive size");
  expect(with("<sphere radius='0'/>"), "<sphere> with radius=\"0\", expected a positive radius");
  expect(with("<sphere/>"), "<sphere> without radius");
  expect(with("<mesh/>"), "<mesh> without filename");
  expect("<origin xyz='0 0'/>" + with("<sphere radius='1'/>"), "expected 3 finite numbers");
}

TEST_F(UrdfShapes, CountEachPartOfACapsule) {
  const std::string capsule =
      "<collision><geometry><cylinder radius='0.1' length='0.4'/></geometry></collision>"
      "<collision><origin xyz='0 0 0.2'/><geometry><sphere radius='0.1'/></geometry></collision>"
      "<collision><origin xyz='0 0 -0.2'/><geometry><sphere radius='0.1'/></geometry></collision>";
  const Robot robot = load(robot_of({{"base", capsule}}));
  EXPECT_EQ(robot.links()[0].collision.size(), 1u);
  EXPECT_EQ(loaded_elements(robot), 3);
}

TEST_F(UrdfShapes, AreMissedWhereSomethingIsSeen) {
  const std::string seen = kSeen + "</visual>\n";
  const Robot robot =
      load(robot_of({{"base", seen + kBall}, {"lidar", seen}, {"frame", ""}, {"hand", kBall}}));
  EXPECT_TRUE(robot.has_collision_shapes());
  EXPECT_NO_THROW(robot.require_collision_shapes());
  EXPECT_EQ(robot.links_without_collision(), std::vector<std::string>{"lidar"});
}

TEST_F(UrdfShapes, AreRequiredOfWhoIsToBeJudged) {
  const Robot robot = load(robot_of({{"base", kSeen + "</visual>\n"}, {"frame", ""}}));
  EXPECT_FALSE(robot.has_collision_shapes());
  EXPECT_EQ(robot.links_without_collision(), std::vector<std::string>{"base"});
  try {
    robot.require_collision_shapes();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), robot.urdf_file().string());
    EXPECT_NE(std::string(error.what()).find("no link of the robot has a <collision>"),
              std::string::npos);
  }
}

TEST(UrdfNames, AreTakenAsTheyAreWritten) {
  const TemporaryFolder folder;
  const Robot robot = Robot::load(folder.write(
      "r.urdf",
      "<robot name='r'><link name='a &lt; &quot;b&quot; &amp; c'/><link name='d'/><joint "
      "name='&gt;'"
      " type='fixed'><parent link='a &lt; &quot;b&quot; &amp; c'/><child link='d'/></joint>"
      "</robot>"));
  EXPECT_EQ(robot.links()[0].name, "a < \"b\" & c");
  EXPECT_EQ(robot.joints()[0].name, ">");
}

TEST(ListedNames, NameAFewAndCountTheOthers) {
  EXPECT_EQ(listed_names({}), "");
  EXPECT_EQ(listed_names({"a"}), "a");
  EXPECT_EQ(listed_names({"a", "b", "c"}), "a, b and c");
  EXPECT_EQ(listed_names({"1", "2", "3", "4", "5", "6", "7", "8", "9", "10"}),
            "1, 2, 3, 4, 5, 6, 7, 8 and 2 more");
}

/// <collision> elements, but for those in comments.
int elements_of(const std::filesystem::path& urdf) {
  std::ifstream in(urdf);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t at = 0; (at = text.find("<!--", at)) != std::string::npos;) {
    const std::size_t end = text.find("-->", at);
    text.erase(at, end == std::string::npos ? end : end + 3 - at);
  }
  const std::regex element("<collision[\\s>]");
  return static_cast<int>(
      std::distance(std::sregex_iterator(text.begin(), text.end(), element), {}));
}

TEST(PublicRobots, HaveAllTheShapesThatTheirFilesName) {
  if (!std::filesystem::exists(public_robot("public"))) {
    GTEST_SKIP() << public_robot("public") << " is not on this machine";
  }
  int robots = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(public_robot("go2.urdf").parent_path())) {
    if (entry.path().extension() != ".urdf") continue;
    ++robots;
    const Robot robot = Robot::load(entry.path());
    EXPECT_EQ(loaded_elements(robot), elements_of(entry.path())) << entry.path();
  }
  EXPECT_GE(robots, 11);
}

}  // namespace
}  // namespace locograph::test
