#pragma once
/// What the examples of execution/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <locograph/execution/engine.h>
#include <locograph/execution/simulation.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/world.h>

namespace locograph::documentation::in_execution {

/// COMAN+ stands on its left foot.
struct Context {
  const Robot& robot = *coman_plus();
  const std::vector<EndEffector> effectors = {{.name = "left_foot",
                                               .link = "l_sole",
                                               .half_x_m = 0.08,
                                               .half_y_m = 0.035,
                                               .friction = 0.5,
                                               .max_force_N = 1000.0}};
  const World world = {.surfaces = {ground()}};
  const Eigen::VectorXd configuration = on_the_ground();
  const Eigen::VectorXd velocity = Eigen::VectorXd::Zero(robot.tangent_size());
  const Eigen::VectorXd torques = Eigen::VectorXd::Zero(robot.active_joint_count());
  const Motion motion = standing();
  MotionPlayer player{robot, effectors, world, motion};
  WholeBodyController controller{robot, effectors};
  Engine engine{robot, effectors, world};
  const Eigen::VectorXd& start = configuration;
  const unsigned seed = 1;
  StateEstimator estimator{robot, effectors, start, 0.001};
  SimulatedSensors sensors{robot, {}, seed};
  const SensorReadings readings = standing_still();
  const std::vector<TouchMeasurement> measured = std::vector<TouchMeasurement>(1);

 private:
  Eigen::VectorXd on_the_ground() const {
    Eigen::VectorXd q = robot.named_configuration("home");
    q[2] -= foot(q).z();
    return q;
  }
  Eigen::Vector3d foot(const Eigen::VectorXd& q) const {
    RobotState state(robot);
    state.update(q.data());
    return state.world_from_link(robot.link_index("l_sole")).translation();
  }
  SensorReadings standing_still() {
    SensorReadings result = sensors.read(configuration, velocity);
    result.pressing_N = {0.0};
    return result;
  }
  Motion standing() const {
    const Contact contact{.effector = effectors.front(),
                          .position = foot(configuration),
                          .forward = Eigen::Vector3d::UnitX()};
    return {.time_s = {0.0, 0.1},
            .configurations = {configuration, configuration},
            .stances = {{.contacts = {contact}}},
            .stance_from = {0, 0}};
  }
};

}  // namespace locograph::documentation::in_execution
