#pragma once
/// Joint impedance with feed-forward, the controller of Rossini et al.: the torques of the plan's
/// motion and wrenches, and a spring and a damper at each joint.
///
///     JointImpedanceController controller(robot, effectors);
///     engine.set_torques(controller.torques(configuration, velocity, player.reference(),
///                                           player.contacts()));
///
/// torques = M a + h - sum_c J_c' w_c, all of the plan, + K (q_planned - q) + D (v_planned - v).
/// Stiffness is in proportion to the joint's effort, as what a joint moves depends on where the
/// robot stands; damping is 2 damping_ratio K / joint_rate. They act implicitly in the cycle's
/// time, as light joints would swing otherwise (Tan, Liu & Turk, "Stable proportional-derivative
/// controllers", IEEE Computer Graphics and Applications 31, 2011). Nothing is fed back of the base
/// or of contacts: for comparison. A plan without wrenches has no feed-forward of contacts.
///
/// Throws Error for end effectors that are not sound, and as RobotDynamics does. Keeps a pointer to
/// the robot, which must outlive it. torques() does not allocate. Thread-safety: one per thread.

#include <locograph/execution/torque_controller.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Cholesky>
#include <span>
#include <vector>

namespace locograph {

struct JointImpedanceOptions {
  double cycle_s = 0.001;
  double joint_rate = 60.0;  ///< of each joint with what it moves [rad/s]
  double damping_ratio = 1.0;
  double effort_per_rad = 60.0;  ///< the most stiffness, in efforts
};

class JointImpedanceController final : public TorqueController {
 public:
  JointImpedanceController(const Robot& robot, std::span<const EndEffector> effectors,
                           const JointImpedanceOptions& options = {});

  const Eigen::VectorXd& torques(const Eigen::VectorXd& configuration,
                                 const Eigen::VectorXd& velocity, const CurvePoint& reference,
                                 std::span<const ContactCommand> contacts) override;

 private:
  void feed_forward(const CurvePoint& reference, std::span<const ContactCommand> contacts);

  const Robot& robot_;
  const JointImpedanceOptions options_;
  RobotState planned_;
  RobotDynamics dynamics_;
  std::vector<EndEffector> effectors_;
  std::vector<int> links_;
  Eigen::MatrixXd mass_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd stiffness_, damping_, error_, force_, full_, torques_;
};

}  // namespace locograph
