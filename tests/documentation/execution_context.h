#pragma once
/// What the examples of execution/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

namespace locograph::documentation::in_execution {

/// COMAN+ above the ground.
struct Context {
  const Robot& robot = *coman_plus();
  const std::vector<EndEffector> effectors = {{.name = "left_foot",
                                               .link = "l_sole",
                                               .half_x_m = 0.08,
                                               .half_y_m = 0.035,
                                               .friction = 0.5,
                                               .max_force_N = 1000.0}};
  const World world = {.surfaces = {ground()}};
  const Eigen::VectorXd configuration = robot.named_configuration("home");
  const Eigen::VectorXd velocity = Eigen::VectorXd::Zero(robot.tangent_size());
  const Eigen::VectorXd torques = Eigen::VectorXd::Zero(robot.active_joint_count());
};

}  // namespace locograph::documentation::in_execution
