#pragma once
/// Equations of motion of a robot: mass matrix, bias forces, inverse dynamics.
///
///     locograph::RobotState state(robot);
///     locograph::RobotDynamics dynamics(robot);
///     const int size = robot.tangent_size();
///     const Eigen::VectorXd velocity = Eigen::VectorXd::Zero(size), acceleration = velocity;
///     Eigen::VectorXd torques(size);
///     Eigen::MatrixXd mass(size, size);
///     state.update(robot.named_configuration("home").data());
///     dynamics.inverse_dynamics(state, velocity, acceleration, {}, torques);
///     dynamics.mass_matrix(state, mass);
///
/// M(q) a + h(q, v) = torques + sum_k J_k(q)^T w_k. Vectors have tangent_size() entries in the
/// order of robot.h: v is the velocity of Robot::integrate(), a its time derivative entry by entry
/// (for the base: of the velocities along its own axes, so v = const is a steady screw motion);
/// torques are their duals, v . torques is power [W]: force [N] and moment about the base origin
/// [N m] along the base axes, then one torque [N m] or force [N] for each active joint. At rest,
/// h = g(q) of statics.h.
///
/// Source: Featherstone, Rigid Body Dynamics Algorithms (2008): recursive Newton-Euler algorithm,
/// table 5.1, with the floating base of section 9.4; composite rigid body algorithm, table 6.2 and
/// section 9.3. All spatial vectors are written along the world axes and about the point where the
/// base origin is now, so that nothing has to be transformed between bodies.
///
/// The constructor allocates all memory, no other function allocates. Keeps a pointer to the robot,
/// which must outlive it; states given must be of the same robot.
/// Errors: the constructor throws those of body_inertias().
/// Thread-safety: one per thread.

#include <locograph/robots/body_inertia.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/statics.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

class RobotDynamics {
 public:
  /// gravity [m/s^2] along the world axes.
  explicit RobotDynamics(const Robot& robot, const Eigen::Vector3d& gravity = standard_gravity());

  const Robot& robot() const { return *robot_; }
  const Eigen::Vector3d& gravity() const { return gravity_; }

  /// M(q), tangent_size x tangent_size, symmetric; overwrites all of it. Joints on different
  /// branches have no entry in common.
  void mass_matrix(const RobotState& state, Eigen::Ref<Eigen::MatrixXd> mass);

  /// The torques that accelerate the robot by `acceleration` at `velocity`, against gravity and
  /// with the help of the wrenches.
  void inverse_dynamics(const RobotState& state, const Eigen::Ref<const Eigen::VectorXd>& velocity,
                        const Eigen::Ref<const Eigen::VectorXd>& acceleration,
                        std::span<const PointWrench> wrenches, Eigen::Ref<Eigen::VectorXd> torques);

  /// h(q, v): Coriolis, centrifugal and gravity torques.
  void bias_forces(const RobotState& state, const Eigen::Ref<const Eigen::VectorXd>& velocity,
                   Eigen::Ref<Eigen::VectorXd> torques);

 private:
  struct Motion {
    Eigen::Vector3d angular, linear;
  };
  struct Force {
    Eigen::Vector3d moment, force;
  };
  /// Mass, mass * com, and inertia about the reference point.
  struct Composite {
    double mass;
    Eigen::Vector3d moment;
    Eigen::Matrix3d inertia;
  };

  void recurse(const RobotState& state, const double* velocity, const double* acceleration,
               std::span<const PointWrench> wrenches, Eigen::Ref<Eigen::VectorXd> torques);
  Motion axis_motion(const RobotState& state, int axis) const;
  int entry_of_body(std::size_t b) const;

  const Robot* robot_;
  const KinematicTree* tree_;
  Eigen::Vector3d gravity_;
  std::vector<BodyInertia> inertias_;
  std::vector<Motion> velocities_, accelerations_, motions_;
  std::vector<Force> forces_;
  std::vector<Composite> composites_;
};

}  // namespace locograph
