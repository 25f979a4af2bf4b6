#pragma once
/// A whole-body torque controller: accelerations that follow the motion as well as all that has to
/// be followed allows, and the contact wrenches that bring them about.
///
///     WholeBodyController controller(robot, effectors);
///     engine.set_torques(controller.torques(configuration, velocity, player.reference(),
///                                           player.contacts()));
///
/// First the accelerations a0 of least cost, each task with a weight: contacts stay where they are
/// (a ball or a wheel rolls: c'' = w' x r n), the centre of mass, swinging end effectors, the
/// attitude of the base and the joints follow the reference. Then the wrenches w of the contacts:
/// the base is moved by them alone, M_b a + h_b = G w, so that what they cannot do is missing from
/// a0. With F = M_b a0 + h_b and the matrix Q of the first cost, the accelerations for wrenches w
/// are a = a0 + Q^-1 M_b' W (G w - F), W = (M_b Q^-1 M_b')^-1, and cost 1/2 |G w - F|^2_W more. So
/// the least
///
///   1/2 |G w - F|^2_W + 1/2 sum_c r / share_c^2 |w_c - planned_c|^2
///
/// over all wrenches within cones, areas, least and largest forces, and torques within the efforts
/// (with less friction than there is, as long as that will do) is a small quadratic programme
/// (solvers/dense_qp.h) of six unknowns a sole, three a ball. Joints that would get beyond their
/// limits, and torques that no wrench brings within the efforts, become tasks of the first cost,
/// and both steps are done again.
///
/// Throws Error for end effectors that are not sound, and as RobotDynamics does. Keeps a pointer to
/// the robot, which must outlive it. torques() does not allocate. Thread-safety: one per thread.

#include <locograph/execution/torque_controller.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/robot_state.h>
#include <locograph/solvers/dense_qp.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

namespace locograph {

struct WholeBodyOptions {
  // Weights of squared accelerations.
  double contact_weight = 1e4;
  double centre_weight = 1000.0;
  double swing_weight = 1000.0;
  double base_weight = 20.0;
  double joint_weight = 5.0;
  double wheel_weight = 100.0;  ///< of where wheels that roll are on their way
  double limit_weight = 1e4;

  // Of errors: acceleration = w^2 error + 2 w (its rate) [rad/s].
  double centre_rate = 8.0;
  double swing_rate = 20.0;
  double base_rate = 10.0;
  double joint_rate = 15.0;
  double wheel_rate = 8.0;
  double steering_per_m = 3.0;    ///< of a wheel that is beside its way [rad/m]
  double tilt_rate = 80.0;        ///< of soles that bear along a line
  double contact_damping = 30.0;  ///< of the velocity of what should stay [1/s]
  double seeking_m_s = 0.04;      ///< with which a contact that is late is looked for
  double seeking_rate = 200.0;    ///< of that velocity [1/s]; times it, what presses then

  double regularisation = 1e-6;   ///< of wrenches, in parts of what the base's force costs
  double least_force = 0.01;      ///< of the weight, on everything that is pressed
  double torque = 0.98;           ///< of the efforts
  double limit_horizon_s = 0.05;  ///< in which joints may get to their limits

  /// Throws Error naming the number that is negative, or a share that is 0 or above 1.
  void validate() const;
};

class WholeBodyController final : public TorqueController {
 public:
  WholeBodyController(const Robot& robot, std::span<const EndEffector> effectors,
                      const WholeBodyOptions& options = {});
  ~WholeBodyController() override;

  const Eigen::VectorXd& torques(const Eigen::VectorXd& configuration,
                                 const Eigen::VectorXd& velocity, const CurvePoint& reference,
                                 std::span<const ContactCommand> contacts) override;

  /// Of the last cycle: what an end effector was to bear, as of StanceWrenches.
  const Eigen::Matrix<double, 6, 1>& wrench(int effector) const;
  /// Of the last cycle: the force that the base misses [N].
  double missing_force_N() const { return missing_.head<3>().norm(); }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  struct Effector;

  void add_rows(const Eigen::Ref<const Eigen::Matrix<double, 3, Eigen::Dynamic>>& jacobian,
                const Eigen::Vector3d& acceleration, double weight);
  void add_row(const Eigen::Vector3d& direction,
               const Eigen::Ref<const Eigen::Matrix<double, 3, Eigen::Dynamic>>& jacobian,
               double acceleration, double weight);
  void collect_tasks(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                     const CurvePoint& reference, std::span<const ContactCommand> contacts);
  void follow_joints_and_base(const Eigen::VectorXd& v, const CurvePoint& reference);
  void follow_centre_of_mass(const Eigen::VectorXd& v, const CurvePoint& reference);
  void hold(Effector& effector, const ContactCommand& command, const CurvePoint& reference);
  void hold_bar(Effector& effector, bool closed, const CurvePoint& reference);
  void hold_against(Effector& effector, const ContactCommand& command,
                    const Eigen::Vector3d& normal, const Vector6& velocity, const Vector6& drift);
  Eigen::Vector3d upright(const Effector& effector, const HeldContact& held,
                          const Eigen::Vector3d& angular) const;
  void roll(Effector& effector, const Eigen::Vector3d& normal, const Eigen::Vector3d& off,
            const CurvePoint& reference);
  void swing(Effector& effector, const CurvePoint& reference);
  void solve_accelerations();
  void solve_wrenches(std::span<const ContactCommand> contacts);
  bool take_in_limits(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  const Robot& robot_;
  const WholeBodyOptions options_;
  const double weight_N_;
  RobotState state_, ahead_, planned_;
  RobotDynamics dynamics_;
  std::vector<Effector> effectors_;
  std::vector<double> effort_;  ///< of each joint; infinite: none

  // Of the tasks: rows, each multiplied by the root of its weight, and what they should be.
  Eigen::MatrixXd rows_;
  Eigen::VectorXd wanted_;
  int used_ = 0;
  Eigen::VectorXd diagonal_, gradient_;  ///< of what concerns single coordinates
  std::vector<char> joint_taken_, torque_taken_;

  Eigen::MatrixXd mass_, cost_, by_base_;    ///< by_base_: Q^-1 M_b'
  Eigen::MatrixXd by_wrench_, torque_rows_;  ///< G; torques by wrenches
  Eigen::VectorXd bias_, error_, planned_force_, acceleration_, torques_full_, torques_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd base_rows_, mass_by_base_, torque_by_base_;
  Eigen::VectorXd small_step_, ahead_configuration_;
  Eigen::Matrix3d base_from_world_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> centre_jacobian_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> three_rows_;
  Matrix6 base_cost_;
  Vector6 asked_ = Vector6::Zero(), missing_ = Vector6::Zero();
  std::unique_ptr<DenseQp> qp_;
  int torque_rows_from_ = 0;
  double reserve_ = 0.0;  ///< of friction that is used
};

}  // namespace locograph
