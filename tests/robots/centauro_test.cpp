// The shipped CENTAURO model against the published figures.
#include <locograph/common/error.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <limits>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

/// Distance of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
double segment_distance(const Eigen::Vector3d& p1, const Eigen::Vector3d& q1,
                        const Eigen::Vector3d& p2, const Eigen::Vector3d& q2) {
  const Eigen::Vector3d d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r);
  const double c = d1.dot(r), b = d1.dot(d2), denominator = a * e - b * b;
  double s = denominator > 1e-15 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  return (p1 + s * d1 - p2 - t * d2).norm();
}

/// A capsule that contains the shape; the shape itself if it is one.
struct EnclosingCapsule {
  Eigen::Vector3d start, end;
  double radius;
};

EnclosingCapsule enclosing_capsule(const CollisionShape& shape, const RobotState& state) {
  const Eigen::Isometry3d pose = state.world_from_link(shape.link) * shape.link_from_shape;
  Eigen::Vector3d half(0.0, 0.0, 0.5 * shape.length);
  double radius = shape.radius;
  if (shape.type == ShapeType::kBox) {
    Eigen::Index longest = 0;
    shape.size.maxCoeff(&longest);
    half = 0.5 * shape.size[longest] * Eigen::Vector3d::Unit(longest);
    radius = 0.5 * std::sqrt(shape.size.squaredNorm() - shape.size[longest] * shape.size[longest]);
  }
  return {pose * -half, pose * half, radius};
}

class Centauro : public testing::Test {
 protected:
  Centauro()
      : robot(Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"))),
        state(robot),
        home(robot.named_configuration("home")) {
    state.update(home.data());
  }

  Eigen::Vector3d position(const std::string& link) const {
    return state.world_from_link(robot.link_index(link)).translation();
  }

  double link_distance(int first, int second) const {
    double least = std::numeric_limits<double>::infinity();
    for (const CollisionShape& a : robot.links()[static_cast<std::size_t>(first)].collision) {
      for (const CollisionShape& b : robot.links()[static_cast<std::size_t>(second)].collision) {
        const EnclosingCapsule u = enclosing_capsule(a, state), v = enclosing_capsule(b, state);
        least =
            std::min(least, segment_distance(u.start, u.end, v.start, v.end) - u.radius - v.radius);
      }
    }
    return least;
  }
  double link_distance(const std::string& first, const std::string& second) const {
    return link_distance(robot.link_index(first), robot.link_index(second));
  }

  Robot robot;
  RobotState state;
  Eigen::VectorXd home;
};

TEST_F(Centauro, HasFortyOneJointsOfWhichTwentyFourInTheLowerBody) {
  EXPECT_EQ(robot.active_joint_count(), 41);
  EXPECT_EQ(robot.group_joints("lower_body").size(), 24u);
  EXPECT_EQ(robot.group_joints("legs").size(), 24u);
  EXPECT_EQ(robot.group_joints("arms").size(), 14u);
  EXPECT_EQ(robot.group_joints("torso").size(), 1u);
  EXPECT_EQ(robot.group_joints("whole_body").size(), 41u);
  const Robot lower =
      Robot::load(robot.urdf_file(), robot.srdf_file(), {.active_joints = {"lower_body"}});
  EXPECT_EQ(lower.tangent_size(), 30);
  const Joint& elbow = lower.joints()[static_cast<std::size_t>(lower.joint_index("j_arm1_4"))];
  EXPECT_EQ(elbow.frozen_position, -2.23604);
}

TEST_F(Centauro, HasThePublishedMassAndCentreOfMass) {
  EXPECT_NEAR(robot.total_mass(), 113.66, 0.005);
  EXPECT_LT(
      (state.center_of_mass() - Eigen::Vector3d(0.0946, 0.0014, -0.0192)).cwiseAbs().maxCoeff(),
      1e-4);
}

TEST_F(Centauro, HasThePublishedFramesAtHome) {
  const std::vector<std::pair<std::string, Eigen::Vector3d>> frames = {
      {"wheel_1", {0.3494, 0.3498, -0.6408}},
      {"wheel_2", {0.3494, -0.3498, -0.6408}},
      {"wheel_3", {-0.3494, 0.3498, -0.6408}},
      {"wheel_4", {-0.3494, -0.3498, -0.6408}},
      {"contact_1", {0.3494, 0.3498, -0.7185}},
      {"ankle2_1", {0.3494, 0.3498, -0.5425}},
      {"ankle1_1", {0.3500, 0.3491, -0.4035}},
      {"knee_1", {0.4616, 0.3160, -0.2125}},
      {"hip2_1", {0.1721, 0.2091, -0.1191}},
      {"torso_2", {0.2000, 0.0000, 0.2560}},
      {"ball1", {0.5338, 0.1795, 0.2984}},
      {"ball2", {0.5338, -0.1795, 0.2984}},
      {"ball1_tip", {0.5618, 0.1458, 0.3530}},
      {"ball2_tip", {0.5618, -0.1458, 0.3530}},
      {"D435i_camera_link", {0.2781, 0.0175, 0.0324}},
      {"D435i_camera_color_optical_frame", {0.2781, 0.0325, 0.0324}},
      {"D435i_camera_depth_optical_frame", {0.2781, 0.0175, 0.0324}},
      {"D435_head_camera_link", {0.2932, 0.0237, 0.5515}},
      {"D435_head_camera_color_optical_frame", {0.2932, 0.0387, 0.5515}},
      {"T265_camera_pose_frame", {0.2924, 0.0077, 0.0630}},
      {"velodyne_calib", {0.2853, 0.0062, 0.6937}}};
  for (const auto& [link, expected] : frames) {
    EXPECT_LT((position(link) - expected).cwiseAbs().maxCoeff(), 1e-4) << link;
  }
  const Eigen::Matrix3d optical =
      state.world_from_link(robot.link_index("D435i_camera_depth_optical_frame")).linear();
  EXPECT_LT((optical.col(2) - Eigen::Vector3d(0.8652, 0.0, -0.5013)).norm(), 1e-4);
}

TEST_F(Centauro, StandsOnFourUprightWheelsInARectangle) {
  for (const char leg : {'1', '2', '3', '4'}) {
    const int wheel = robot.link_index(std::string("wheel_") + leg);
    const Eigen::Vector3d axle = state.world_from_link(wheel).linear().col(2);
    EXPECT_NEAR(axle.z(), 0.0, 1e-4);
    EXPECT_NEAR(std::abs(axle.y()), 1.0, 1e-3) << "points ahead";
    EXPECT_NEAR(state.world_from_link(wheel).translation().z() - 0.078, -0.7188, 1e-4);
    const CollisionShape& shape = robot.links()[static_cast<std::size_t>(wheel)].collision.at(0);
    EXPECT_EQ(shape.type, ShapeType::kCylinder);
    EXPECT_EQ(shape.radius, 0.078);
  }
  EXPECT_NEAR((position("wheel_1") - position("wheel_3")).norm(), 0.6988, 1e-4);
  EXPECT_NEAR((position("wheel_2") - position("wheel_4")).norm(), 0.6988, 1e-4);
  EXPECT_NEAR((position("wheel_1") - position("wheel_2")).norm(), 0.6996, 1e-4);
  EXPECT_NEAR((position("wheel_3") - position("wheel_4")).norm(), 0.6996, 1e-4);
}

TEST_F(Centauro, HasWheelsWithoutLimits) {
  for (const char leg : {'1', '2', '3', '4'}) {
    const Joint& wheel =
        robot.joints()[static_cast<std::size_t>(robot.joint_index(std::string("j_wheel_") + leg))];
    EXPECT_EQ(wheel.type, JointType::kContinuous);
    EXPECT_EQ(wheel.lower, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(wheel.upper, std::numeric_limits<double>::infinity());
    EXPECT_EQ(wheel.max_velocity, 20.0);
    EXPECT_EQ(wheel.max_effort, 35.0);
  }
}

TEST_F(Centauro, HasForksThatEndAboveWhereWheelsTouch) {
  constexpr double kRadius = 0.078;
  for (const char* leg : {"1", "2", "3", "4"}) {
    const Link& fork =
        robot.links()[static_cast<std::size_t>(robot.link_index(std::string("ankle2_") + leg))];
    ASSERT_EQ(fork.collision.size(), 1u);
    const CollisionShape& capsule = fork.collision.front();
    ASSERT_EQ(capsule.type, ShapeType::kCapsule);
    const Joint& axle =
        robot.joints()[static_cast<std::size_t>(robot.joint_index(std::string("j_wheel_") + leg))];
    for (const double pitch : {0.0, 0.5, 1.05, -1.05}) {
      const Eigen::AngleAxisd turn(pitch, Eigen::Vector3d::UnitY());
      double lowest = std::numeric_limits<double>::infinity();
      for (const double end : {-0.5, 0.5}) {
        const Eigen::Vector3d centre =
            capsule.link_from_shape * Eigen::Vector3d(0.0, 0.0, end * capsule.length);
        const Eigen::Vector3d from_axle = turn * (centre - axle.parent_from_joint.translation());
        lowest = std::min(lowest, from_axle.z() - capsule.radius);
      }
      EXPECT_GT(lowest, -kRadius + 8e-4) << "leg " << leg << ", pitch " << pitch;
    }
  }
}

TEST_F(Centauro, IsWithinItsLimitsAtHome) {
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    EXPECT_GE(home[7 + i], joint.lower) << joint.name;
    EXPECT_LE(home[7 + i], joint.upper) << joint.name;
    EXPECT_GT(joint.max_velocity, 0.0) << joint.name;
    EXPECT_GT(joint.max_effort, 0.0) << joint.name;
  }
}

TEST_F(Centauro, CollidesWithItselfNowhereAtHome) {
  EXPECT_EQ(robot.self_collision_pairs().size(), 826u);
  for (const auto& [first, second] : robot.self_collision_pairs()) {
    EXPECT_GT(link_distance(first, second), 0.038)
        << robot.links()[static_cast<std::size_t>(first)].name << " and "
        << robot.links()[static_cast<std::size_t>(second)].name;
  }
  EXPECT_NEAR(link_distance("hip2_1", "ankle1_1"), 0.039, 1e-3);
  EXPECT_NEAR(link_distance("knee_1", "ankle2_1"), 0.052, 1e-3);
  EXPECT_NEAR(link_distance("pelvis", "hip2_1"), -0.052, 1e-3) << "excluded";
  EXPECT_NEAR(link_distance("torso_2", "arm1_2"), -0.016, 1e-3) << "excluded";
  EXPECT_NEAR(link_distance("arm2_3", "arm2_5"), -0.011, 1e-3) << "excluded";
}

TEST_F(Centauro, ChecksTheLowerBodyPairsOfThePublishedList) {
  std::vector<int> lower = {robot.link_index("pelvis"), robot.link_index("torso_2")};
  for (const int joint : robot.group_joints("lower_body")) {
    lower.push_back(robot.joints()[static_cast<std::size_t>(joint)].child_link);
  }
  const auto is_lower = [&](int link) {
    return std::find(lower.begin(), lower.end(), link) != lower.end();
  };
  const auto& pairs = robot.self_collision_pairs();
  EXPECT_EQ(std::count_if(pairs.begin(), pairs.end(),
                          [&](const std::pair<int, int>& pair) {
                            return is_lower(pair.first) && is_lower(pair.second);
                          }),
            262);
}

TEST_F(Centauro, HasOnlyPrimitiveShapes) {
  EXPECT_TRUE(robot.missing_meshes().empty());
  for (const Link& link : robot.links()) {
    EXPECT_LE(link.collision.size(), 1u) << link.name;
    for (const CollisionShape& shape : link.collision) EXPECT_NE(shape.type, ShapeType::kMesh);
  }
}

TEST_F(Centauro, IsThePublicRobot) {
  const std::filesystem::path file = public_robot("centauro_capsule.urdf");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
  const Robot other = Robot::load(file, public_robot("centauro_capsule.srdf"));
  RobotState other_state(other);
  std::mt19937 random(16);
  const Eigen::VectorXd q = random_configuration(robot, random);
  Eigen::VectorXd p = other.neutral_configuration();
  p.head<7>() = q.head<7>();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& ours = robot.active_joint(i);
    const Joint& theirs = other.joints()[static_cast<std::size_t>(other.joint_index(ours.name))];
    p[7 + theirs.index] = q[7 + i];
    EXPECT_EQ(ours.type, theirs.type) << ours.name;
    if (ours.type != JointType::kContinuous) {
      EXPECT_NEAR(ours.lower, theirs.lower, 1e-5) << ours.name;
      EXPECT_NEAR(ours.upper, theirs.upper, 1e-5) << ours.name;
    }
    EXPECT_EQ(ours.max_effort, theirs.max_effort) << ours.name;
    EXPECT_EQ(ours.max_velocity, theirs.max_velocity) << ours.name;
  }
  state.update(q.data());
  other_state.update(p.data());
  for (const Link& link : robot.links()) {
    const int theirs = other.find_link(link.name);
    ASSERT_GE(theirs, 0) << link.name;
    EXPECT_TRUE(state.world_from_link(robot.link_index(link.name))
                    .isApprox(other_state.world_from_link(theirs), 1e-6))
        << link.name;
    const Link& public_link = other.links()[static_cast<std::size_t>(theirs)];
    EXPECT_NEAR(link.mass, public_link.mass, 1e-6) << link.name;
    EXPECT_LT((link.inertia - public_link.inertia).norm(), 1e-5) << link.name;
  }
}

}  // namespace
}  // namespace locograph::test
