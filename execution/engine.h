#pragma once
/// A robot in a world, moved by the physics engine MuJoCo.
///
///     Engine engine(robot, effectors, world);
///     engine.set_state(configuration, velocity);
///     engine.set_torques(torques);
///     engine.step();
///     const Eigen::Vector3d force = engine.contact_force(0);
///
/// Configurations, velocities and torques are those of robot.h and dynamics.h, whatever MuJoCo's
/// own order and axes; mimic joints move with the joints that they follow as an equality makes
/// them. What is read is that of the state now, but for contact forces, which are
/// those that the last step was made with. Quantities of motion (mass matrix, bias, Jacobians,
/// inverse dynamics) are computed by MuJoCo.
///
/// Keeps a pointer to the robot, which must outlive it. Errors: those of mujoco_model(), and Error
/// with MuJoCo's words for a model that it refuses, and for end effectors and links that are none.
/// Silences MuJoCo's warnings in the whole program, as it would write them to a file where the
/// program runs; diverged() tells of them. Thread-safety: one per thread.

#include <locograph/execution/mujoco_model.h>

#include <Eigen/Core>
#include <memory>
#include <span>

namespace locograph {

class Engine {
 public:
  Engine(const Robot& robot, std::span<const EndEffector> effectors, const World& world,
         const MujocoModelOptions& options = {});
  ~Engine();
  Engine(Engine&&) noexcept;
  Engine& operator=(Engine&&) noexcept;

  /// Throws Error for vectors of another size, numbers that are not finite, and a base whose
  /// quaternion is zero.
  void set_state(const Eigen::VectorXd& configuration, const Eigen::VectorXd& velocity);
  /// Of the active joints [N m or N], held until they are set again; MuJoCo keeps them within the
  /// efforts. Throws Error for a vector of another size and for numbers that are not finite, which
  /// MuJoCo would take for 0.
  void set_torques(const Eigen::VectorXd& torques);
  /// On the root link, at its centre of mass [N, world axes], until it is set again. All else that
  /// acts are torques, gravity and contacts.
  void set_push(const Eigen::Vector3d& force);
  /// Where obstacles that move are, or are not, at a time of theirs [s]; 0 until it is set.
  void set_obstacle_time(double time_s);
  /// From now on the hand of an end effector, a grasp, holds the bar where it is: its point at a
  /// point of the bar's axis, its own y along it, about which it turns freely. The world drags the
  /// hand there. It holds whatever the force. Throws Error for an end effector that is no grasp.
  void grasp(int effector, const Eigen::Vector3d& point, const Eigen::Vector3d& axis);
  void release(int effector);
  bool grasps(int effector) const;
  void step();

  double time_s() const;  ///< of all steps
  /// Whether MuJoCo gave up a step: numbers that are not finite or too large, after which its state
  /// is that of its beginning, or more contacts than it has memory for (200, or 600 rows), some of
  /// which it then leaves out.
  bool diverged() const;

  Eigen::VectorXd configuration() const;
  Eigen::VectorXd velocity() const;  ///< tangent of robot.h

  /// What the world does to the robot at an end effector [N, world axes], index as given.
  Eigen::Vector3d contact_force(int effector) const;
  /// The moment of these forces about the end effector's point [N m, world axes].
  Eigen::Vector3d contact_moment(int effector) const;
  /// The same of the whole robot.
  Eigen::Vector3d total_contact_force() const;

  /// The largest pressing force [N] on a part of the robot that is no end effector, or between two
  /// parts of it, and one of the links of that part; 0: nothing else touches.
  struct OtherTouch {
    double pressing_N = 0.0;
    int link = -1;
    int touched = -1;  ///< a link of the other part of the robot; -1: the world
  };
  OtherTouch other_touch() const;
  /// How deep the robot is in anything [m].
  double penetration_m() const;

  Eigen::MatrixXd mass_matrix() const;  ///< tangent_size x tangent_size
  Eigen::VectorXd bias_forces() const;  ///< h(q, v) of dynamics.h
  /// The torques that accelerate the robot like this without contacts, of dynamics.h.
  Eigen::VectorXd inverse_dynamics(const Eigen::VectorXd& acceleration) const;
  /// Of a point of a link [m, link frame]: as RobotState::frame_jacobian(), 6 x tangent_size.
  Eigen::MatrixXd frame_jacobian(int link, const Eigen::Vector3d& point) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace locograph
