// Which pairs of links meet in random postures.
#include <gtest/gtest.h>
#include <locograph/world/left_out_pairs.h>
#include <locograph/world/link_pairs.h>

#include <cmath>
#include <numbers>

#include "common/temporary_folder.h"

namespace locograph::test {
namespace {

constexpr int kPostures = 4000;

/// A ball that swings round the base on an arm of 0.5 m, through a second one, inside of a third
/// one, which hangs on it.
class SwingingBall : public testing::Test {
 protected:
  SwingingBall() {
    const auto ball = [](const std::string& link, const std::string& centre) {
      return "<link name='" + link + "'><collision><origin xyz='" + centre +
             "'/><geometry><sphere radius='0.1'/></geometry></collision></link>";
    };
    const auto joint = [](const std::string& child, const std::string& parent,
                          const std::string& origin) {
      return "<joint name='turn_" + child + "' type='continuous'><parent link='" + parent +
             "'/><child link='" + child + "'/><origin xyz='" + origin +
             "'/><axis xyz='0 0 1'/></joint>";
    };
    const std::filesystem::path urdf = folder.write(
        "balls.urdf", "<robot name='balls'>" + ball("base", "0 0 0") + ball("swing", "0.5 0 0") +
                          ball("post", "0 0 0") + ball("shell", "0 0 0.02") +
                          joint("swing", "base", "0 0 0") + joint("post", "base", "0.5 0 0") +
                          joint("shell", "swing", "0.5 0 0") + "</robot>");
    const std::filesystem::path srdf =
        folder.write("balls.srdf",
                     "<robot name='balls'><disable_collisions link1='swing' link2='post'/>"
                     "<disable_collisions link1='base' link2='shell'/></robot>");
    robot = std::make_unique<Robot>(Robot::load(urdf, srdf));
  }

  LinkPair pair(const LinkPairs& found, const std::string& one, const std::string& other) const {
    const auto [first, second] = std::minmax({robot->link_index(one), robot->link_index(other)});
    for (const LinkPair& pair : found.pairs) {
      if (pair.first == first && pair.second == second) return pair;
    }
    ADD_FAILURE() << "no pair " << one << ", " << other;
    return {};
  }

  TemporaryFolder folder;
  std::unique_ptr<Robot> robot;
};

TEST_F(SwingingBall, MeetsTheSecondOneAsOftenAsItsAngleSays) {
  const LinkPairs found = sample_link_pairs(*robot, {.samples = kPostures, .seed = 3});
  EXPECT_EQ(found.pairs.size(), 6u);
  const LinkPair met = pair(found, "swing", "post");
  // Nearer than two radii: 2 * 0.5 m * sin(angle / 2) < 0.2 m, on either side.
  const double expected = 2.0 * std::asin(0.2) / std::numbers::pi;
  EXPECT_NEAR(static_cast<double>(met.meets) / kPostures, expected, 0.02);
  EXPECT_FALSE(met.on);
  EXPECT_FALSE(met.adjacent);
  EXPECT_FALSE(met.may_be_off(kPostures));
}

TEST_F(SwingingBall, MayIgnoreWhatItNeverOrAlwaysMeets) {
  const LinkPairs found = sample_link_pairs(*robot, {.samples = kPostures, .seed = 3});
  const LinkPair never = pair(found, "base", "shell"), always = pair(found, "swing", "shell");
  EXPECT_EQ(never.meets, 0);
  EXPECT_FALSE(never.on);
  EXPECT_TRUE(never.may_be_off(kPostures));
  EXPECT_EQ(always.meets, kPostures);
  EXPECT_TRUE(always.on);
  EXPECT_TRUE(always.always_meets(kPostures));
  EXPECT_TRUE(pair(found, "base", "swing").adjacent);
  EXPECT_TRUE(pair(found, "base", "post").adjacent);
}

TEST_F(SwingingBall, OverlapsWhatItIsInAndComesNearToTheBase) {
  const Eigen::VectorXd neutral = robot->neutral_configuration();
  Eigen::VectorXd away = neutral;
  away[robot->base_configuration_size()] = 1.0;
  const auto near = [&](const Eigen::VectorXd& configuration, double within_m) {
    return overlapping_links(*robot, configuration, within_m).size();
  };
  EXPECT_EQ(near(neutral, 0.0), 2u) << "the shell is in both others";
  EXPECT_EQ(near(neutral, 0.29), 2u);
  EXPECT_EQ(near(neutral, 0.31), 4u) << "and the base 0.3 m from two";
  EXPECT_EQ(near(away, 0.0), 1u) << "it has left the second one";
}

TEST_F(SwingingBall, ComesNearMoreOftenThanItMeets) {
  const LinkPairs found =
      sample_link_pairs(*robot, {.samples = kPostures, .seed = 3, .near_m = 0.1});
  const LinkPair met = pair(found, "swing", "post");
  EXPECT_EQ(
      met.meets,
      pair(sample_link_pairs(*robot, {.samples = kPostures, .seed = 3}), "swing", "post").meets);
  // Nearer than two radii and 0.1 m: 2 * 0.5 m * sin(angle / 2) < 0.3 m.
  EXPECT_NEAR(static_cast<double>(met.near) / kPostures, 2.0 * std::asin(0.3) / std::numbers::pi,
              0.02);
  EXPECT_EQ(pair(found, "base", "swing").near, 0) << "0.3 m away, always";
}

TEST_F(SwingingBall, StopsCountingWhatIsDecided) {
  LinkPairOptions options{.samples = kPostures, .seed = 3, .near_m = 0.1};
  const LinkPairs all = sample_link_pairs(*robot, options);
  options.stop_when_decided = true;
  const LinkPairs some = sample_link_pairs(*robot, options);
  ASSERT_EQ(some.pairs.size(), all.pairs.size());
  for (std::size_t i = 0; i < all.pairs.size(); ++i) {
    EXPECT_EQ(some.pairs[i].always_meets(kPostures), all.pairs[i].always_meets(kPostures)) << i;
    EXPECT_EQ(some.pairs[i].near == 0, all.pairs[i].near == 0) << i;
  }
  EXPECT_LT(pair(some, "swing", "post").near, pair(all, "swing", "post").near);
}

TEST_F(SwingingBall, AlwaysOverlapsItsShellAlone) {
  const std::vector<std::pair<int, int>> always = always_overlapping_links(*robot);
  ASSERT_EQ(always.size(), 1u);
  EXPECT_EQ(always[0], std::pair(robot->link_index("swing"), robot->link_index("shell")));
  const std::size_t before = robot->self_collision_pairs().size();
  robot->leave_out_pairs(always);
  EXPECT_EQ(robot->self_collision_pairs().size(), before - 1);
  EXPECT_EQ(robot->left_out_pairs(), always);
}

TEST(LinkPairs, OfAJointThatBendsThemIntoEachOtherMayNotBeOff) {
  const TemporaryFolder folder;
  const std::string ball =
      "<collision><origin xyz='0.5 0 0'/><geometry><sphere radius='0.1'/></geometry></collision>";
  const std::filesystem::path urdf = folder.write(
      "hinge.urdf",
      "<robot name='hinge'><link name='base'>" + ball + "</link><link name='arm'>" + ball +
          "</link><joint name='bend' type='continuous'><parent link='base'/><child link='arm'/>"
          "<axis xyz='0 0 1'/></joint></robot>");
  const std::filesystem::path srdf = folder.write(
      "hinge.srdf", "<robot name='hinge'><disable_collisions link1='base' link2='arm'/></robot>");
  const LinkPairs found = sample_link_pairs(Robot::load(urdf, srdf), {.samples = kPostures});
  ASSERT_EQ(found.pairs.size(), 1u);
  EXPECT_TRUE(found.pairs[0].adjacent);
  EXPECT_FALSE(found.pairs[0].on);
  EXPECT_GT(found.pairs[0].meets, 0);
  EXPECT_FALSE(found.pairs[0].may_be_off(kPostures));
}

TEST_F(SwingingBall, IsSeenTheSameByAnyNumberOfThreads) {
  const LinkPairs one = sample_link_pairs(*robot, {.samples = 777, .seed = 5, .threads = 1});
  const LinkPairs three = sample_link_pairs(*robot, {.samples = 777, .seed = 5, .threads = 3});
  const LinkPairs other = sample_link_pairs(*robot, {.samples = 777, .seed = 6, .threads = 3});
  int differences = 0;
  for (std::size_t p = 0; p < one.pairs.size(); ++p) {
    EXPECT_EQ(one.pairs[p].meets, three.pairs[p].meets);
    differences += one.pairs[p].meets == other.pairs[p].meets ? 0 : 1;
  }
  EXPECT_GT(differences, 0);
}

class ShippedRobots : public testing::TestWithParam<const char*> {};

TEST_P(ShippedRobots, LeaveOutOnlyPairsThatCannotMeetOrAlwaysDo) {
  const std::filesystem::path folder =
      std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models" / GetParam();
  const std::string name = GetParam();
  const Robot robot = Robot::load(folder / (name + ".urdf"), folder / (name + ".srdf"));
  const LinkPairs found = sample_link_pairs(robot, {.samples = 1000, .seed = 1, .threads = 2});
  for (const LinkPair& pair : found.pairs) {
    EXPECT_TRUE(pair.on || pair.may_be_off(found.samples))
        << robot.links()[static_cast<std::size_t>(pair.first)].name << " and "
        << robot.links()[static_cast<std::size_t>(pair.second)].name << " meet in " << pair.meets;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedRobots, testing::Values("centauro", "go2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace locograph::test
