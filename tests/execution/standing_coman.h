#pragma once
/// COMAN+ on both feet, as the tests of controllers have it.

#include <locograph/check/motion.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/world.h>

#include "robots/robot_test_support.h"

namespace locograph::test {

struct StandingComan {
  const Robot robot =
      Robot::load(model("coman_plus/coman_plus.urdf"), model("coman_plus/coman_plus.srdf"));
  const std::vector<EndEffector> effectors = {foot("left_foot", "l_sole"),
                                              foot("right_foot", "r_sole")};
  const World world = {.surfaces = {ground()}};
  const Eigen::VectorXd configuration = on_the_ground();

  static EndEffector foot(const std::string& name, const std::string& link) {
    return {.name = name,
            .link = link,
            .half_x_m = 0.08,
            .half_y_m = 0.035,
            .friction = 0.6,
            .max_force_N = 1000.0};
  }
  double weight_N() const { return 9.81 * robot.total_mass(); }
  Eigen::Vector3d sole(std::size_t i, const Eigen::VectorXd& q) const {
    RobotState state(robot);
    state.update(q.data());
    return state.world_from_link(robot.link_index(effectors[i].link)).translation();
  }
  Contact contact(std::size_t i) const {
    return {.effector = effectors[i],
            .position = sole(i, configuration),
            .forward = Eigen::Vector3d::UnitX()};
  }
  Stance both_feet() const { return {.contacts = {contact(0), contact(1)}}; }
  Stance left_foot() const { return {.contacts = {contact(0)}}; }

  /// Knees bent, so that it can move up and down.
  Eigen::VectorXd on_the_ground() const {
    Eigen::VectorXd q = robot.named_configuration("home");
    q[2] -= sole(0, q).z();
    return q;
  }
  /// Stands for two seconds.
  Motion standing() const {
    return {.time_s = {0.0, 2.0},
            .configurations = {configuration, configuration},
            .stances = {both_feet()},
            .stance_from = {0, 0}};
  }
};

}  // namespace locograph::test
