// Which pairs of links of a robot without an SRDF overlap as it is built.
#include <gtest/gtest.h>
#include <locograph/world/left_out_pairs.h>
#include <locograph/world/link_pairs.h>

#include "common/temporary_folder.h"

namespace locograph::test::left_out_pairs_test {
namespace {

std::string ball(double radius, const std::string& centre) {
  return "<collision><origin xyz='" + centre + "'/><geometry><sphere radius='" +
         std::to_string(radius) + "'/></geometry></collision>";
}

/// On two legs, with a motor on each shank that is in the trunk unless the knee is bent far. The
/// motors are in each other, too.
std::filesystem::path two_legs(const TemporaryFolder& folder) {
  std::string text =
      "<robot name='two_legs'><link name='trunk'><inertial><mass value='10'/><inertia ixx='1' "
      "iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry>"
      "<box size='0.2 0.3 0.1'/></geometry></collision></link>";
  for (const auto& [side, y] : {std::pair("left", "0.12"), {"right", "-0.12"}}) {
    const std::string name = side;
    const auto joint = [&](const std::string& kind, const std::string& parent,
                           const std::string& child, const std::string& origin,
                           const std::string& limits) {
      return "<joint name='" + name + kind + "' type='revolute'><parent link='" + parent +
             "'/><child link='" + child + "'/><origin xyz='" + origin +
             "'/><axis xyz='0 1 0'/><limit " + limits + " effort='100' velocity='5'/></joint>";
    };
    text += "<link name='" + name + "_thigh'/><link name='" + name + "_shank'>" +
            ball(0.03, "0 0 -0.35") + ball(0.15, "0 0 0.35") + "</link>" +
            joint("_hip", "trunk", name + "_thigh", "0 " + std::string(y) + " 0",
                  "lower='-1' upper='1'") +
            joint("_knee", name + "_thigh", name + "_shank", "0 0 -0.35", "lower='0' upper='2.5'");
  }
  return folder.write("two_legs.urdf", text + "</robot>");
}

TEST(LeftOutPairs, LinksNearEachOtherThatOverlapAsTheRobotStands) {
  const TemporaryFolder folder;
  Robot robot = Robot::load(two_legs(folder));
  const int trunk = robot.link_index("trunk"), left = robot.link_index("left_shank"),
            right = robot.link_index("right_shank");
  EXPECT_TRUE(always_overlapping_links(robot).empty()) << "the knees bend the motors out of it";
  EXPECT_EQ(joints_between(robot, left, right), 4);
  leave_out_overlapping(robot);
  const std::vector<std::pair<int, int>> expected{std::minmax({trunk, left}),
                                                  std::minmax({trunk, right})};
  EXPECT_EQ(robot.left_out_pairs(), expected);
  EXPECT_EQ(overlapping_links(robot, robot.neutral_configuration()),
            (std::vector<std::pair<int, int>>{std::minmax({left, right})}))
      << "legs in each other are a collision";
}

TEST(LeftOutPairs, WithAnSrdfWhatItSaysCounts) {
  const TemporaryFolder folder;
  Robot robot =
      Robot::load(two_legs(folder), folder.write("two_legs.srdf", "<robot name='two_legs'/>"));
  leave_out_overlapping(robot);
  EXPECT_TRUE(robot.left_out_pairs().empty());
}

}  // namespace
}  // namespace locograph::test::left_out_pairs_test
