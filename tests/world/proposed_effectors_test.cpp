// What robots can stand on, found by the shapes of their last links.
#include <gtest/gtest.h>
#include <locograph/world/proposed_effectors.h>

#include <cmath>
#include <numbers>
#include <string>

#include "common/temporary_folder.h"

namespace locograph::test {
namespace {

using Eigen::Vector3d;

std::string collision(const std::string& at, const std::string& geometry,
                      const std::string& rpy = "0 0 0") {
  return "<collision><origin xyz='" + at + "' rpy='" + rpy + "'/><geometry>" + geometry +
         "</geometry></collision>";
}

/// A trunk of 10 kg with its lowest side 0.5 m above what one leg, of one joint, reaches.
std::string robot_with(const std::string& shapes, const std::string& type = "revolute") {
  return "<robot name='r'><link name='trunk'><inertial><mass value='10'/><inertia ixx='1' ixy='0' "
         "ixz='0' iyy='1' iyz='0' izz='1'/></inertial>" +
         collision("0 0 0.1", "<box size='0.4 0.3 0.2'/>") + "</link><link name='foot'>" + shapes +
         "</link><link name='hand'>" + collision("0 0 -0.1", "<sphere radius='0.05'/>") +
         "</link><joint name='hip' type='" + type +
         "'><parent link='trunk'/><child link='foot'/><origin xyz='0.1 0 -0.5'/><axis xyz='0 1 "
         "0'/><limit lower='-1' upper='1' effort='9' velocity='1'/></joint>"
         "<joint name='shoulder' type='revolute'><parent link='trunk'/><child link='hand'/><origin "
         "xyz='0 0.3 0.3'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='9' "
         "velocity='1'/></joint></robot>";
}

class ProposedEffectors : public testing::Test {
 protected:
  /// Of the foot: the hand is not low.
  EndEffector only(const std::string& urdf) {
    const auto found = proposed_effectors(Robot::load(folder.write("r.urdf", urdf)));
    if (found.size() != 1 || found.front().link != "foot") {
      ADD_FAILURE() << found.size() << " are proposed";
      return {};
    }
    return found.front();
  }

  TemporaryFolder folder;
};

TEST_F(ProposedEffectors, ASoleIsTheLargestFlatThatLooksDown) {
  // Turned by 0.2 rad about the vertical, with an ankle above it.
  const EndEffector sole =
      only(robot_with(collision("0.03 0.01 -0.02", "<box size='0.2 0.1 0.04'/>", "0 0 0.2") +
                      collision("0 0 0.05", "<sphere radius='0.04'/>")));
  EXPECT_EQ(sole.kind, ContactKind::kSurface);
  EXPECT_NEAR(sole.half_x_m, 0.1, 1e-6);
  EXPECT_NEAR(sole.half_y_m, 0.05, 1e-6);
  EXPECT_TRUE(sole.point.isApprox(Vector3d(0.03, 0.01, -0.04), 1e-6)) << sole.point.transpose();
  EXPECT_TRUE(sole.normal.isApprox(Vector3d::UnitZ(), 1e-9));
  EXPECT_TRUE(sole.forward.isApprox(Vector3d(std::cos(0.2), std::sin(0.2), 0.0), 1e-9));
  EXPECT_EQ(sole.max_force_N, 200.0);
}

TEST_F(ProposedEffectors, FourBallsAreASole) {
  std::string balls;
  for (const char* at : {"-0.05 0.025 0", "-0.05 -0.025 0", "0.12 0.03 0", "0.12 -0.03 0"})
    balls += collision(at, "<sphere radius='0.005'/>");
  const EndEffector sole = only(robot_with(balls));
  EXPECT_EQ(sole.kind, ContactKind::kSurface);
  EXPECT_NEAR(sole.half_x_m, 0.085, 1e-6);
  EXPECT_NEAR(sole.half_y_m, 0.025, 1e-6) << "inside the trapezium";
  EXPECT_NEAR(sole.point.z(), -0.005, 1e-9);
}

TEST_F(ProposedEffectors, ABallIsItself) {
  const EndEffector ball = only(robot_with(collision("0 0 0.1", "<box size='0.05 0.05 0.2'/>") +
                                           collision("0.01 0 0", "<sphere radius='0.03'/>")));
  EXPECT_EQ(ball.kind, ContactKind::kPoint);
  EXPECT_NEAR(ball.radius_m, 0.03, 1e-12);
  EXPECT_TRUE(ball.point.isApprox(Vector3d(0.01, 0.0, 0.0), 1e-9));
}

TEST_F(ProposedEffectors, ARoundMeshIsABallAroundIt) {
  // The lower half of a sphere of 3 cm in triangles.
  std::string obj;
  for (int i = 0; i <= 8; ++i) {
    for (int k = 0; k < 24; ++k) {
      const double tilt = 0.5 * std::numbers::pi * i / 8, turn = 2.0 * std::numbers::pi * k / 24;
      obj += "v " + std::to_string(0.03 * std::sin(tilt) * std::cos(turn)) + " " +
             std::to_string(0.03 * std::sin(tilt) * std::sin(turn)) + " " +
             std::to_string(-0.03 * std::cos(tilt)) + "\n";
    }
  }
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 24; ++k) {
      const int a = 24 * i + k + 1, b = 24 * i + (k + 1) % 24 + 1;
      obj += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(a + 24) +
             "\nf " + std::to_string(b) + " " + std::to_string(b + 24) + " " +
             std::to_string(a + 24) + "\n";
    }
  }
  folder.write("cap.obj", obj);
  const EndEffector ball = only(robot_with(collision("0 0 0", "<mesh filename='cap.obj'/>")));
  EXPECT_EQ(ball.kind, ContactKind::kPoint);
  EXPECT_NEAR(ball.radius_m, 0.03, 1e-3);
  EXPECT_LT(ball.point.norm(), 1e-3);
}

TEST_F(ProposedEffectors, ATipIsAPointWithoutARadius) {
  const EndEffector tip =
      only(robot_with(collision("0 0 0", "<box size='0.06 0.06 0.06'/>", "0.785398 0.61548 0")));
  EXPECT_EQ(tip.kind, ContactKind::kPoint);
  EXPECT_EQ(tip.radius_m, 0.0);
  EXPECT_NEAR(tip.point.z(), -0.03 * std::sqrt(3.0), 1e-4) << "the corner of the box";
}

TEST_F(ProposedEffectors, AWheelTurnsWithoutAnEnd) {
  const std::string tyre =
      collision("0 0.02 0", "<cylinder radius='0.1' length='0.06'/>", "1.5707963267948966 0 0");
  const EndEffector wheel = only(robot_with(tyre, "continuous"));
  EXPECT_EQ(wheel.kind, ContactKind::kWheel);
  EXPECT_NEAR(wheel.radius_m, 0.1, 1e-9);
  EXPECT_TRUE(wheel.point.isApprox(Vector3d(0.0, 0.02, 0.0), 1e-9)) << wheel.point.transpose();
  EXPECT_NE(only(robot_with(tyre, "revolute")).kind, ContactKind::kWheel);
}

TEST(ProposedEffectorsOf, RobotsThatComeAlong) {
  const auto of = [](const std::string& name) {
    return proposed_effectors(Robot::load(std::string(LOCOGRAPH_SOURCE_DIR "/robots/models/") +
                                          name + "/" + name + ".urdf"));
  };
  const auto coman = of("coman_plus");
  ASSERT_EQ(coman.size(), 2U);
  for (const EndEffector& sole : coman) {
    EXPECT_EQ(sole.kind, ContactKind::kSurface);
    EXPECT_GT(sole.half_x_m, 0.07);
    EXPECT_LT(sole.half_x_m, 0.14);
  }
  const auto centauro = of("centauro");
  ASSERT_EQ(centauro.size(), 4U);
  for (const EndEffector& wheel : centauro) {
    EXPECT_EQ(wheel.kind, ContactKind::kWheel);
    EXPECT_NEAR(wheel.radius_m, 0.078, 1e-3);
  }
  const auto go2 = of("go2");
  ASSERT_EQ(go2.size(), 4U);
  for (const EndEffector& foot : go2) {
    EXPECT_EQ(foot.kind, ContactKind::kPoint);
    EXPECT_NEAR(foot.radius_m, 0.022, 2e-3);
  }
}

}  // namespace
}  // namespace locograph::test
