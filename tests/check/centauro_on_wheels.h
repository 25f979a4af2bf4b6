#pragma once
/// What the tests of the judge share: the robot on its wheels, driving straight.
///
///     Motion motion = centauro().drive(11, 0.08, 0.8);  // vertices, metres and seconds per step
///     EXPECT_TRUE(check_with({}, motion).feasible);

#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/robots/robot_state.h>

#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace locograph {

inline constexpr double kRadius = 0.078;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline std::string centauro_file(const std::string& name) {
  return std::string(LOCOGRAPH_SOURCE_DIR) + "/robots/models/centauro/" + name;
}

/// The whole robot, standing on its wheels.
class Centauro {
 public:
  Centauro()
      : shared(std::make_shared<const Robot>(
            Robot::load(centauro_file("centauro.urdf"), centauro_file("centauro.srdf")))),
        robot(*shared),
        home(robot.named_configuration("home")) {
    RobotState state(robot);
    state.update(home.data());
    home[2] = kRadius - state.world_from_link(robot.link_index("wheel_1")).translation().z();
    state.update(home.data());
    for (int i = 1; i <= 4; ++i) {
      const std::string number = std::to_string(i);
      const int link = robot.link_index("wheel_" + number);
      const Joint& joint = robot.joints()[robot.joint_index("j_wheel_" + number)];
      const Eigen::Vector3d axle = state.world_from_link(link).linear() * joint.axis;
      Contact wheel;
      wheel.effector = {.name = "wheel_" + number,
                        .link = "wheel_" + number,
                        .kind = ContactKind::kWheel,
                        .radius_m = kRadius,
                        .friction = 0.5,
                        .max_force_N = 2000.0};
      // The plane is what counts.
      wheel.position = state.world_from_link(link).translation() - Eigen::Vector3d(0, 0, kRadius);
      wheels.contacts.push_back(wheel);
      roll_joints.push_back(7 + joint.index);
      roll_signs.push_back(axle.y() > 0.0 ? 1.0 : -1.0);
      wheel_centres.push_back(state.world_from_link(link).translation() - home.head<3>());
    }
  }

  Eigen::VectorXd at(double x) const {
    Eigen::VectorXd q = home;
    q[0] += x;
    roll(q, x);
    return q;
  }
  void roll(Eigen::VectorXd& q, double distance) const {
    for (std::size_t w = 0; w < 4; ++w) q[roll_joints[w]] += roll_signs[w] * distance / kRadius;
  }
  int index(const std::string& joint) const {
    return 7 + robot.joints()[robot.joint_index(joint)].index;
  }
  Motion drive(int vertices, double step_m, double step_s) const {
    Motion motion;
    motion.stances = {wheels};
    motion.stance_from.assign(std::size_t(vertices), 0);
    for (int i = 0; i < vertices; ++i) {
      motion.time_s.push_back(step_s * i);
      motion.configurations.push_back(at(step_m * i));
    }
    return motion;
  }

  std::shared_ptr<const Robot> shared;
  const Robot& robot;
  Eigen::VectorXd home;
  Stance wheels;
  std::vector<int> roll_joints;
  std::vector<double> roll_signs;
  std::vector<Eigen::Vector3d> wheel_centres;  // from the pelvis
};

inline const Centauro& centauro() {
  static const Centauro instance;
  return instance;
}

inline Obstacle box(const std::string& name, const Eigen::Vector3d& centre,
                    const Eigen::Vector3d& size) {
  Obstacle obstacle;
  obstacle.name = name;
  obstacle.world_from_obstacle.translation() = centre;
  obstacle.size = size;
  return obstacle;
}

inline std::set<std::string> violated(const CheckReport& report) {
  std::set<std::string> names;
  for (const Violation& violation : report.violations) {
    EXPECT_EQ(violation.violated, violation.count > 0) << violation.constraint;
    EXPECT_TRUE(violation.judged || !violation.violated) << violation.constraint;
    EXPECT_EQ(violation.judged, violation.why_not.empty()) << violation.constraint;
    if (violation.violated) names.insert(violation.constraint);
  }
  EXPECT_EQ(report.feasible, names.empty() && report.constraint("obstacle_distance").judged &&
                                 report.constraint("static_balance").judged);
  return names;
}

/// On the ground, among obstacles.
inline CheckReport check_with(const std::vector<Obstacle>& obstacles, const Motion& motion,
                              const CheckOptions& options = {}) {
  World world;
  world.obstacles = obstacles;
  world.surfaces = {ground()};
  return Judge(centauro().shared, world).check(motion, options);
}

}  // namespace locograph
