#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/obstacle_way.h>
#include <locograph/world/obstacles.h>

#include <cmath>
#include <random>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

const char* const kGood = R"(<?xml version="1.0"?>
<obstacles version="1">
  <!-- one of each -->
  <box name="door" center="1 0 1" size="0.1 0.9 2" rpy="0 0 0.3"/>
  <sphere name="ball" center="2 0 0.2" radius="0.2"/>
  <cylinder center="3 1 1" radius="+0.15" height="2e0"/>
  <box name="cart" center="2 -1 0.5" size="0.6 0.4 1" repeat="10">
    <keyframe time="4" position="2 1 0.5" rpy="0 0 1.5707963267948966"/>
    <keyframe time="5" position="2 1 0.5"/>
  </box>
</obstacles>
)";

struct Bad {
  const char* what;
  int line;
  const char* content;
};

// Every content starts with the opening element on line 1.
const Bad kBad[] = {
    {"unknown element <cone>", 2, "\n<cone center='0 0 0'/>"},
    {"unknown attribute colour", 2, "\n<sphere center='0 0 0' radius='1' colour='red'/>"},
    {"unknown attribute size", 2, "\n<sphere center='0 0 0' radius='1' size='1 1 1'/>"},
    {"without radius", 2, "\n<sphere center='0 0 0'/>"},
    {"without center", 3, "\n\n<sphere radius='1'/>"},
    {"without size", 2, "\n<box center='0 0 0'/>"},
    {"without height", 2, "\n<cylinder center='0 0 0' radius='1'/>"},
    {"has 2 numbers", 2, "\n<sphere center='0 0' radius='1'/>"},
    {"has 4 numbers", 2, "\n<sphere center='0 0 0 0' radius='1'/>"},
    {"has 0 numbers", 2, "\n<sphere center='' radius='1'/>"},
    {"'abc' is not a finite number", 2, "\n<sphere center='0 abc 0' radius='1'/>"},
    {"'1,5' is not a finite number", 2, "\n<sphere center='0 1,5 0' radius='1'/>"},
    {"'nan' is not a finite number", 2, "\n<sphere center='0 nan 0' radius='1'/>"},
    {"'inf' is not a finite number", 2, "\n<sphere center='0 0 0' radius='inf'/>"},
    {"'1e999' is not a finite number", 2, "\n<sphere center='0 0 0' radius='1e999'/>"},
    {"radius=\"0\"", 2, "\n<sphere center='0 0 0' radius='0'/>"},
    {"radius=\"-1\"", 2, "\n<cylinder center='0 0 0' radius='-1' height='1'/>"},
    {"height=\"-1\"", 2, "\n<cylinder center='0 0 0' radius='1' height='-1'/>"},
    {"size=\"1 0 1\", expected metres from 1e-06 to 1e+06", 2,
     "\n<box center='0 0 0' size='1 0 1'/>"},
    {"size=\"1 1 1e7\"", 2, "\n<box center='0 0 0' size='1 1 1e7'/>"},
    {"radius=\"1e-300\"", 2, "\n<sphere center='0 0 0' radius='1e-300'/>"},
    {"height=\"1e300\"", 2, "\n<cylinder center='0 0 0' radius='1' height='1e300'/>"},
    {"center=\"0 1e16 0\", expected coordinates up to 1e+06 m", 2,
     "\n<sphere center='0 1e16 0' radius='1'/>"},
    {"position=\"-1e16 0 0\"", 3,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='1' position='-1e16 0 0'/></sphere>"},
    {"time=\"1e300\", expected seconds, at most 1e+06", 3,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='1e300' position='1 0 0'/></sphere>"},
    {"moves at up to 500 m/s, expected at most 100 m/s (positions are in metres)", 2,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='4' position='2000 0 0'/></sphere>"},
    {"moves at up to 1000 m/s", 2,
     "\n<sphere center='0 0 0' radius='1' repeat='21'>\n<keyframe time='20' position='1000 0 "
     "0'/></sphere>"},
    {"m/s", 2,
     "\n<box center='0 0 0' size='1000 1 1'>\n<keyframe time='1' position='0 0 0' rpy='0 0 "
     "1'/></box>"},
    {"second obstacle named 'a'", 3,
     "\n<sphere name='a' center='0 0 0' radius='1'/>\n<sphere name='a' center='0 0 0' "
     "radius='1'/>"},
    {"empty name", 2, "\n<sphere name='' center='0 0 0' radius='1'/>"},
    {"not well-formed", 2, "\n<sphere radius='1' center='0 0 0' radius='1'/>"},
    {"only one of the two", 2,
     "\n<sphere center='0 0 0' radius='1' rpy='0 0 0' rotation='1 0 0 0 1 0 0 0 1'/>"},
    {"not a rotation matrix", 2,
     "\n<sphere center='0 0 0' radius='1' rotation='1 0 0 0 1 0 0 0 -1'/>"},
    {"unknown element <frame>", 3, "\n<sphere center='0 0 0' radius='1'>\n<frame/></sphere>"},
    {"without time", 3,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe position='1 0 0'/></sphere>"},
    {"without position", 3, "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='1'/></sphere>"},
    {"key frame at 0 s", 3,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='0' position='1 0 0'/></sphere>"},
    {"key frame at 2 s", 4,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='2' position='1 0 0'/>\n<keyframe "
     "time='2' position='0 0 0'/></sphere>"},
    {"repeat without a key frame", 2, "\n<sphere center='0 0 0' radius='1' repeat='3'/>"},
    {"repeat=\"2\"", 2,
     "\n<sphere center='0 0 0' radius='1' repeat='2'>\n<keyframe time='2' position='1 0 "
     "0'/></sphere>"},
    {"appears=\"-1\", expected seconds from the start of the plan, 0 or more", 2,
     "\n<sphere center='0 0 0' radius='1' appears='-1'/>"},
    {"'soon' is not a finite number", 2, "\n<sphere center='0 0 0' radius='1' appears='soon'/>"},
    {"'inf' is not a finite number", 2, "\n<sphere center='0 0 0' radius='1' vanishes='inf'/>"},
    {"appears=\"1e300\", expected seconds, at most 1e+06", 2,
     "\n<sphere center='0 0 0' radius='1' appears='1e300'/>"},
    {"has 2 numbers", 2, "\n<sphere center='0 0 0' radius='1' appears='1 2'/>"},
    {"vanishes=\"3\", expected seconds, later than it appears (3)", 2,
     "\n<box center='0 0 0' size='1 1 1' appears='3' vanishes='3'/>"},
    {"vanishes=\"0\"", 2, "\n<cylinder center='0 0 0' radius='1' height='1' vanishes='0'/>"},
    {"unknown attribute appears of <keyframe>", 3,
     "\n<sphere center='0 0 0' radius='1'>\n<keyframe time='1' position='1 0 0' appears='2'/>"
     "</sphere>"},
    {"text inside <obstacles>", 2, "\nhello"},
    {"not well-formed", 2, "\n<sphere center='0 0 0' radius='1'>"},
};

TEST(Obstacles, AreReadFromAFile) {
  const TemporaryFolder folder;
  const std::vector<Obstacle> obstacles = load_obstacles(folder.write("good.xml", kGood));
  ASSERT_EQ(obstacles.size(), 4u);
  EXPECT_EQ(obstacles[0].name, "door");
  EXPECT_EQ(obstacles[0].shape, Obstacle::Shape::kBox);
  EXPECT_EQ(obstacles[0].size, Eigen::Vector3d(0.1, 0.9, 2));
  EXPECT_NEAR(obstacles[0].world_from_obstacle.linear()(1, 0), std::sin(0.3), 1e-15);
  EXPECT_EQ(obstacles[1].shape, Obstacle::Shape::kSphere);
  EXPECT_EQ(obstacles[1].size, Eigen::Vector3d(0.2, 0, 0));
  EXPECT_EQ(obstacles[2].name, "");
  EXPECT_EQ(obstacles[2].size, Eigen::Vector3d(0.15, 2, 0));
  ASSERT_EQ(obstacles[3].motion.size(), 2u);
  EXPECT_EQ(obstacles[3].repeat_s, 10.0);
}

TEST(Obstacles, EveryMistakeInAFileIsReportedWithItsLine) {
  const TemporaryFolder folder;
  for (const Bad& bad : kBad) {
    const std::filesystem::path path = folder.write(
        "bad.xml", "<obstacles version='1'>" + std::string(bad.content) + "\n</obstacles>\n");
    try {
      load_obstacles(path);
      ADD_FAILURE() << "accepted: " << bad.content;
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(bad.what), std::string::npos) << text << "\nfor " << bad.content;
      EXPECT_EQ(error.file(), path.string());
      EXPECT_EQ(error.line(), bad.line) << text;
    }
  }
}

TEST(Obstacles, FilesThatAreNoneAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_obstacles(folder.file("missing.xml")), Error);
  EXPECT_THROW(load_obstacles(folder.write("empty.xml", "")), Error);
  EXPECT_THROW(load_obstacles(folder.write("other.xml", "<scenario version='1'/>")), Error);
  EXPECT_THROW(load_obstacles(folder.write("new.xml", "<obstacles version='2'/>")), Error);
  EXPECT_THROW(load_obstacles(folder.write("bare.xml", "<obstacles/>")), Error);
  EXPECT_TRUE(load_obstacles(folder.write("none.xml", "<obstacles version='1'/>")).empty());
}

TEST(Obstacles, SurviveSavingAndLoadingBitByBit) {
  const TemporaryFolder folder;
  std::vector<Obstacle> obstacles = load_obstacles(folder.write("good.xml", kGood));
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    Obstacle obstacle;
    obstacle.name = "random & <" + std::to_string(i) + ">";
    obstacle.shape = Obstacle::Shape(i % 3);
    obstacle.size = i % 3 == 0   ? Eigen::Vector3d(0.1 + std::abs(normal(random)), 1.0 / 3.0, 0.7)
                    : i % 3 == 1 ? Eigen::Vector3d(1.0 / 7.0, 0, 0)
                                 : Eigen::Vector3d(1.0 / 7.0, 2.0 / 7.0, 0);
    const auto pose = [&] {
      Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
      const Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
      out.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
      out.translation() = Eigen::Vector3d(normal(random), normal(random), normal(random));
      return out;
    };
    obstacle.world_from_obstacle = pose();
    obstacle.motion.push_back({1.0 / 3.0, pose()});
    if (i % 2) obstacle.repeat_s = 0.9;
    if (i % 3 == 0) obstacle.appears_s = i / 7.0;
    if (i % 5 == 0) obstacle.vanishes_s = i / 7.0 + 1.0 / 3.0;
    obstacles.push_back(obstacle);
  }
  save_obstacles(obstacles, folder.file("saved.xml"));
  const std::vector<Obstacle> loaded = load_obstacles(folder.file("saved.xml"));
  ASSERT_EQ(loaded.size(), obstacles.size());
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    EXPECT_EQ(loaded[i].name, obstacles[i].name);
    EXPECT_EQ(loaded[i].shape, obstacles[i].shape);
    EXPECT_EQ(loaded[i].size, obstacles[i].size);
    EXPECT_EQ(loaded[i].repeat_s, obstacles[i].repeat_s);
    EXPECT_EQ(loaded[i].appears_s, obstacles[i].appears_s);
    EXPECT_EQ(loaded[i].vanishes_s, obstacles[i].vanishes_s);
    EXPECT_EQ(loaded[i].world_from_obstacle.matrix(), obstacles[i].world_from_obstacle.matrix());
    ASSERT_EQ(loaded[i].motion.size(), obstacles[i].motion.size());
    for (std::size_t k = 0; k < loaded[i].motion.size(); ++k) {
      EXPECT_EQ(loaded[i].motion[k].time_s, obstacles[i].motion[k].time_s);
      EXPECT_EQ(loaded[i].motion[k].pose.matrix(), obstacles[i].motion[k].pose.matrix());
    }
  }
}

TEST(Obstacles, MoveLinearlyBetweenKeyFramesAndComeBackWithARepeat) {
  const TemporaryFolder folder;
  Obstacle cart = load_obstacles(folder.write("good.xml", kGood))[3];
  const auto y = [&](double t) { return cart.pose_at(t).translation().y(); };
  const auto yaw = [&](double t) {
    const Eigen::Matrix3d r = cart.pose_at(t).linear();
    return std::atan2(r(1, 0), r(0, 0));
  };
  EXPECT_DOUBLE_EQ(y(-1), -1);
  EXPECT_DOUBLE_EQ(y(0), -1);
  EXPECT_DOUBLE_EQ(y(1), -0.5);
  EXPECT_NEAR(yaw(1), M_PI / 8, 1e-12);
  EXPECT_DOUBLE_EQ(y(4), 1);
  EXPECT_DOUBLE_EQ(y(4.5), 1);
  EXPECT_NEAR(yaw(4.5), M_PI / 2, 1e-12);
  EXPECT_NEAR(y(7.5), 0, 1e-12);
  EXPECT_NEAR(yaw(7.5), M_PI / 4, 1e-12);
  EXPECT_NEAR(y(11), -0.5, 1e-12);
  cart.repeat_s = 0.0;
  EXPECT_DOUBLE_EQ(y(100), 1);
}

TEST(Obstacles, AreThereFromWhenTheyAppearUntilTheyVanishBothIncluded) {
  const TemporaryFolder folder;
  const std::vector<Obstacle> obstacles = load_obstacles(folder.write(
      "passing.xml",
      "<obstacles version='1'><sphere center='0 0 0' radius='0.1' appears='3' vanishes='9'/>"
      "<sphere center='0 0 0' radius='0.1' appears='3'/>"
      "<sphere center='0 0 0' radius='0.1' vanishes='9'/></obstacles>"));
  const Eigen::Vector3d point(0.5, 0.0, 0.0);
  for (const Obstacle& ball : obstacles) {
    const bool early = &ball == &obstacles[2], late = &ball == &obstacles[1];
    for (const double time_s :
         {-1.0, 0.0, std::nextafter(3.0, 0.0), 3.0, 5.0, 9.0, std::nextafter(9.0, 10.0), 100.0}) {
      const bool there = (early || time_s >= 3.0) && (late || time_s <= 9.0);
      EXPECT_EQ(ball.is_there(time_s), there) << time_s;
      const DistanceSample sample = ball.sample(point, time_s);
      if (there) {
        EXPECT_DOUBLE_EQ(sample.distance, 0.4);
        continue;
      }
      EXPECT_TRUE(std::isinf(sample.distance) && sample.distance > 0.0) << time_s;
      EXPECT_EQ(sample.gradient, Eigen::Vector3d::Zero());
      EXPECT_DOUBLE_EQ(ball.sample_shape(point, time_s).distance, 0.4);
    }
    EXPECT_EQ(ball.is_there(0.0, 2.9), early);
    EXPECT_TRUE(ball.is_there(2.0, 3.0) && ball.is_there(9.0, 2.0));
    EXPECT_EQ(ball.is_there(10.0, 9.5), late);
    EXPECT_TRUE(all_along(ball, 0.1).front().is_there(0.0) &&
                all_along(ball, 0.1).front().is_there(100.0));
  }
  Obstacle never = obstacles[0];
  never.vanishes_s = never.appears_s;
  EXPECT_THROW(never.validate(), Error);
  EXPECT_THROW(save_obstacles({&never, 1}, folder.file("never.xml")), Error);
}

// Nearest of many points on the surface, and a membership test for the sign.
double brute_force_distance(const Obstacle& obstacle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = obstacle.world_from_obstacle.inverse() * point;
  const Eigen::Vector3d& s = obstacle.size;
  double nearest = 1e9;
  const int n = 300;
  const auto add = [&](const Eigen::Vector3d& q) { nearest = std::min(nearest, (p - q).norm()); };
  bool inside = false;
  if (obstacle.shape == Obstacle::Shape::kBox) {
    inside = (p.cwiseAbs().array() < 0.5 * s.array()).all();
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
          for (double side : {-0.5, 0.5}) {
            Eigen::Vector3d q;
            q[axis] = side * s[axis];
            q[(axis + 1) % 3] = (static_cast<double>(i) / n - 0.5) * s[(axis + 1) % 3];
            q[(axis + 2) % 3] = (static_cast<double>(j) / n - 0.5) * s[(axis + 2) % 3];
            add(q);
          }
  } else if (obstacle.shape == Obstacle::Shape::kSphere) {
    inside = p.norm() < s[0];
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j < 2 * n; ++j) {
        const double a = M_PI * i / n, b = M_PI * j / n;
        add(s[0] *
            Eigen::Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
      }
  } else {
    inside = std::hypot(p.x(), p.y()) < s[0] && std::abs(p.z()) < 0.5 * s[1];
    for (int j = 0; j < 2 * n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double b = M_PI * j / n;
        const Eigen::Vector3d rim(s[0] * std::cos(b), s[0] * std::sin(b), 0);
        add(rim + Eigen::Vector3d(0, 0, (static_cast<double>(i) / n - 0.5) * s[1]));
        for (double side : {-0.5, 0.5}) add(rim * i / n + Eigen::Vector3d(0, 0, side * s[1]));
      }
  }
  return inside ? -nearest : nearest;
}

TEST(Obstacles, DistanceIsExactAndItsGradientIsItsDerivative) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 45; ++i) {
    Obstacle obstacle;
    obstacle.shape = Obstacle::Shape(i % 3);
    obstacle.size = Eigen::Vector3d(0.3, 0.5, 0.4);
    const Eigen::Vector4d q(uniform(random), uniform(random), uniform(random), 1.0);
    obstacle.world_from_obstacle.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    obstacle.world_from_obstacle.translation() =
        0.3 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d offset(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d point =
        obstacle.world_from_obstacle.translation() + (i % 2 ? 0.6 : 0.2) * offset;
    const DistanceSample sample = obstacle.sample(point, 0.0);
    EXPECT_NEAR(sample.distance, brute_force_distance(obstacle, point), 2e-3);
    EXPECT_NEAR(sample.gradient.norm(), 1.0, 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 1e-7 * Eigen::Vector3d::Unit(axis);
      const double numeric =
          (obstacle.distance(point + step, 0) - obstacle.distance(point - step, 0)) / 2e-7;
      EXPECT_NEAR(sample.gradient[axis], numeric, 1e-6);
    }
  }
}

TEST(ObstacleWay, AllAlongIsNowhereFarFromWhereItIsAtAnyTime) {
  Obstacle cart;
  cart.size = {0.6, 0.4, 0.8};
  ASSERT_EQ(all_along(cart, 0.02).size(), 1u) << "at rest";
  KeyFrame there{3.0, Eigen::Isometry3d(Eigen::Translation3d(1.0, 0.5, 0.0))};
  there.pose.rotate(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  cart.motion = {there};
  for (const double repeat_s : {0.0, 4.0}) {
    cart.repeat_s = repeat_s;
    const std::vector<Obstacle> all = all_along(cart, 0.02);
    for (const Obstacle& one : all) EXPECT_TRUE(one.motion.empty() && one.repeat_s == 0.0);
    for (double time_s = 0.0; time_s <= 5.0; time_s += 0.037) {
      double nearest = 1.0;
      for (const Obstacle& one : all) {
        nearest = std::min(nearest, way_m(cart, one.world_from_obstacle, cart.pose_at(time_s)));
      }
      EXPECT_LE(nearest, 0.0101) << time_s;
    }
  }
  cart.motion.front().pose.translation().x() = 1e5;
  EXPECT_LE(all_along(cart, 0.02).size(), 503u);
}

}  // namespace
}  // namespace locograph
