// Files that would take all memory, all time or the stack if they were believed.
#include <locograph/common/error.h>
#include <locograph/robots/urdf_reader.h>
#include <sys/stat.h>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

std::string chain_urdf(int links) {
  std::string text = "<robot name='chain'>\n<link name='l0'/>\n";
  for (int i = 1; i < links; ++i) {
    const std::string number = std::to_string(i);
    text += "<link name='l" + number + "'/><joint name='j" + number +
            "' type='continuous'><parent link='l" + std::to_string(i - 1) + "'/><child link='l" +
            number + "'/></joint>\n";
  }
  return text + "</robot>\n";
}

class HostileRobot : public testing::Test {
 protected:
  std::string refusal(const std::filesystem::path& urdf, const std::filesystem::path& srdf = {}) {
    try {
      Robot::load(urdf, srdf);
    } catch (const Error& error) {
      return error.what();
    }
    return "not refused";
  }
  void expect_refusal(const std::string& part, const std::filesystem::path& urdf,
                      const std::filesystem::path& srdf = {}) {
    const std::string what = refusal(urdf, srdf);
    EXPECT_NE(what.find(part), std::string::npos) << what;
  }
  std::filesystem::path pipe() {
    EXPECT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    return folder.file("pipe");
  }

  TemporaryFolder folder;
};

TEST_F(HostileRobot, IsAChainAsLongAsChainsMayBe) {
  const Robot robot = Robot::load(folder.write("long.urdf", chain_urdf(kMostLinks)));
  EXPECT_EQ(robot.active_joint_count(), static_cast<int>(kMostLinks) - 1);
  EXPECT_EQ(robot.support(static_cast<int>(kMostLinks) - 1).size(), kMostLinks - 1);
}

TEST_F(HostileRobot, IsALongerChain) {
  expect_refusal("long.urdf:2002: more than 2000 links",
                 folder.write("long.urdf", chain_urdf(kMostLinks + 2)));
  expect_refusal("long.urdf: has ", folder.write("long.urdf", chain_urdf(200000)));
}

// urdfdom would take a bare & and what follows for something else than we do.
TEST_F(HostileRobot, HasNamesThatAreNoText) {
  const auto robot = [](const std::string& joint) {
    return "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='" + joint +
           "' type='fixed'><parent link='a'/><child link='b'/></joint></robot>";
  };
  EXPECT_EQ(Robot::load(folder.write("names.urdf", robot("ma&st_joint"))).joints()[0].name,
            "ma&st_joint");
  for (const char* name : {"&#0;", "a\xff\xff\xff\xff", "\xf4\xff\xff"}) {
    const std::string what = refusal(folder.write("names.urdf", robot(name)));
    EXPECT_TRUE(what == "not refused" || what.find("names.urdf:2: ") != std::string::npos) << what;
  }
}

TEST_F(HostileRobot, IsMoreShapesThanAnyoneCanKeepApart) {
  std::string text = "<robot name='r'>\n<link name='a'>";
  for (int i = 0; i < 2001; ++i) {
    text += "<collision><geometry><sphere radius='1'/></geometry></collision>";
  }
  expect_refusal("many.urdf:2: more than 2000 collision shapes",
                 folder.write("many.urdf", text + "</link></robot>"));
}

TEST_F(HostileRobot, IsAPipeADeviceOrAFolder) {
  const std::filesystem::path urdf = folder.write("small.urdf", small_robot_urdf()), fifo = pipe();
  expect_refusal("pipe: is a pipe", fifo);
  expect_refusal("pipe: is a pipe", urdf, fifo);
  expect_refusal("/dev/zero: is a device", "/dev/zero");
  expect_refusal(": is a folder", folder.path());
}

TEST_F(HostileRobot, IsDeeplyNestedXml) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "<robot>";
  expect_refusal("nested.urdf:1: not well-formed XML", folder.write("nested.urdf", text));
}

TEST_F(HostileRobot, HasGroupsThatDoubleTheNextOne) {
  std::string text = "<robot name='small'><group name='g0'><joint name='turn'/></group>\n";
  for (int i = 1; i <= 500; ++i) {
    const std::string member = "<group name='g" + std::to_string(i - 1) + "'/>";
    text += "<group name='g" + std::to_string(i) + "'>" + member + member + member + "</group>\n";
  }
  const Robot robot = Robot::load(folder.write("small.urdf", small_robot_urdf()),
                                  folder.write("groups.srdf", text + "</robot>"));
  EXPECT_EQ(robot.group_joints("g500"), std::vector<int>{0});
}

TEST_F(HostileRobot, HasGroupsThatContainEachOtherFarDown) {
  std::string text = "<robot name='small'>\n";
  for (int i = 0; i < 300; ++i) {
    text += "<group name='g" + std::to_string(i) + "'><group name='g" +
            std::to_string(i < 299 ? i + 1 : 290) + "'/></group>\n";
  }
  expect_refusal("groups.srdf:292: group 'g290' contains itself",
                 folder.write("small.urdf", small_robot_urdf()),
                 folder.write("groups.srdf", text + "</robot>"));
}

TEST_F(HostileRobot, HasNamesThatNobodyKnows) {
  std::string text = "<robot name='small'><group name='g'>";
  for (int i = 0; i < 20000; ++i) text += "<joint name='none" + std::to_string(i) + "'/>";
  const Robot robot =
      Robot::load(folder.write("chain.urdf", chain_urdf(kMostLinks)),
                  folder.write("names.srdf", text + "</group></robot>"), {.lenient_srdf = true});
  EXPECT_EQ(robot.warnings().size(), 20000u);
}

}  // namespace
}  // namespace locograph::test
