#pragma once
/// Torques that hold a robot still under gravity and contact wrenches, and their derivatives with
/// respect to the configuration.
///
///     locograph::RobotState state(robot);
///     state.update(robot.named_configuration("home").data());
///     const locograph::PointWrench wrenches[] = {
///         {.link = robot.link_index("wheel_1"), .force = Eigen::Vector3d(0.0, 0.0, 300.0)}};
///     Eigen::VectorXd torques(robot.tangent_size());
///     Eigen::MatrixXd derivative(robot.tangent_size(), robot.tangent_size());
///     locograph::static_torques(state, locograph::standard_gravity(), wrenches, torques);
///     locograph::static_torque_derivative(state, locograph::standard_gravity(), wrenches,
///                                         derivative);
///
/// Static balance: torques(q) = g(q) - sum_k J_k(q)^T w_k. Entries follow the tangent of robot.h:
/// with a floating base, 0-2 are the force [N] and 3-5 the moment about the base origin [N m], both
/// along the base axes, that hold the base (zero for a balanced robot); then one torque [N m] or
/// force [N] for each active joint.
///
/// Derivatives are tangent_size x tangent_size, row: torque, column: tangent, that is
/// d torques(q (+) delta) / d delta at 0 with the (+) of Robot::integrate(). World-frame wrenches
/// stay as they are while the robot moves. The block of the joints is symmetric for pure forces;
/// moments and the rows of the base make the rest unsymmetric, as their directions turn with the
/// base.
///
/// Nothing here allocates or keeps state. Thread-safety: freely called at once.
///
/// Derivation. The column of a joint with axis a through o is j = a x (p - o) for a point p, or
/// j = a for a prismatic one. Turning a joint b above it turns a, o and p together, dj = b x j;
/// turning a joint below it moves p alone, dj = a x j_below. Hence, with the force f and the moment
/// m, both derivatives of a pair of joints, the upper one with axis b, follow from the one vector
/// u = j x f of the lower one: d(lower)/d(upper) = b . (u + a x m), d(upper)/d(lower) = b . u.
/// Gravity is the force mass * gravity at the centre of mass of what the lower joint moves.

#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <span>

namespace locograph {

/// What the environment does to the robot at one point.
struct PointWrench {
  int link = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< m, link frame
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, along the world axes
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< N m, about the point, world axes
};

/// 9.81 m/s^2 downwards.
inline Eigen::Vector3d standard_gravity() { return {0.0, 0.0, -9.81}; }

/// g(q): the torques that hold the robot against gravity [m/s^2, world], the gradient of its
/// potential energy. Throws Error if no link has a mass.
void gravity_torques(const RobotState& state, const Eigen::Vector3d& gravity,
                     Eigen::Ref<Eigen::VectorXd> torques);

/// dg/dq. Overwrites all of it. Throws Error if no link has a mass.
void gravity_torque_derivative(const RobotState& state, const Eigen::Vector3d& gravity,
                               Eigen::Ref<Eigen::MatrixXd> derivative);

/// torques += scale * J^T w.
void add_wrench_torques(const RobotState& state, const PointWrench& wrench, double scale,
                        Eigen::Ref<Eigen::VectorXd> torques);

/// derivative += scale * d(J^T w)/dq, with the wrench fixed in the world and its point in the link.
/// Touches rows and columns of the base and of support(link) only.
void add_wrench_torque_derivative(const RobotState& state, const PointWrench& wrench, double scale,
                                  Eigen::Ref<Eigen::MatrixXd> derivative);

/// g(q) - sum_k J_k^T w_k.
void static_torques(const RobotState& state, const Eigen::Vector3d& gravity,
                    std::span<const PointWrench> wrenches, Eigen::Ref<Eigen::VectorXd> torques);

/// Its derivative with respect to q. Overwrites all of it.
void static_torque_derivative(const RobotState& state, const Eigen::Vector3d& gravity,
                              std::span<const PointWrench> wrenches,
                              Eigen::Ref<Eigen::MatrixXd> derivative);

}  // namespace locograph
