#pragma once
/// VERTEX_CONFIGURATION: where a robot is, base pose and active joints, at one moment of a plan.
///
///     VERTEX_CONFIGURATION id robot time stance  x y z qx qy qz qw  joints…  slopes…  (m, rad, s)
///
/// time: 0 or later. slopes: all or none, of the curve that the plan defines
/// (check/motion_curve.h): of the base's position in the world [m/s], its angular velocity along
/// its own axes [rad/s], rates of the joints. Without them the curve has them by its rule. They are
/// those of the configuration as it is written: whoever moves it takes them away.
///
/// stance: number of the PARAMS_STANCE that is held from here to the next configuration, of the
/// last one the stance that the robot ends in; `-` where it is not known.
///
/// State: Robot::configuration_size() numbers. Tangent: Robot::tangent_size(): linear and angular
/// velocity of the base in the base frame, joint velocities; never Euler angles. Edges receive a
/// ConfigurationState: kinematics and collision spheres worked out once for each state, read by
/// all.

#include <locograph/core/vertex_pool.h>
#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

namespace locograph {

/// A configuration with everything derived from it.
struct ConfigurationState {
  std::shared_ptr<const RobotParameter> robot;
  RobotState kinematics;
  Eigen::VectorXd q;
  double time_s = 0.0;
  Eigen::MatrixX3d sphere_centres;  ///< by row, world frame, as RobotParameter::spheres
  Eigen::MatrixX3d bound_centres;   ///< likewise, as RobotParameter::bounds

  explicit ConfigurationState(std::shared_ptr<const RobotParameter> parameter);
  void update(const double* configuration);

  const Robot& model() const { return kinematics.robot(); }
  Eigen::Vector3d sphere_centre(Eigen::Index sphere) const {
    return sphere_centres.row(sphere).transpose();
  }
  Eigen::Vector3d bound_centre(std::size_t bound) const {
    return bound_centres.row(static_cast<Eigen::Index>(bound)).transpose();
  }
  double joint(int active) const { return q[model().base_configuration_size() + active]; }
  /// world_from_base, identity rotation and origin for a fixed base.
  Eigen::Vector3d base_position() const { return q.head<3>(); }
  Eigen::Quaterniond base_rotation() const { return Eigen::Quaterniond(q.segment<4>(3).data()); }
};

/// Rotation vector of Aᵀ B, A and B the bases' axes: in either base frame, as a rotation leaves its
/// own axis alone.
Eigen::Vector3d relative_base_rotation(const ConfigurationState& a, const ConfigurationState& b);

inline constexpr int kNoStance = -1;

struct VertexConfiguration : Vertex<Eigen::Dynamic, Eigen::Dynamic> {
  using Derived = ConfigurationState;

  int robot_number = 0;
  double time_s = 0.0;
  int stance_number = kNoStance;
  std::shared_ptr<const RobotParameter> robot;
  Eigen::VectorXd slopes;  ///< Robot::tangent_size() numbers, or none

  VertexConfiguration() = default;
  VertexConfiguration(int number, std::shared_ptr<const RobotParameter> parameter, double time,
                      const Eigen::VectorXd& q, int stance_number = kNoStance);

  int dimension() const { return robot ? robot->robot->tangent_size() : 0; }
  void oplus(const double* s, const double* d, double* out) const {
    robot->robot->integrate(s, d, out);
  }
  Derived make_derived() const { return ConfigurationState(robot); }
  void derive(const double* s, Derived& derived) const {
    const Derivation<VertexConfiguration> one{this, s, &derived};
    derive_together({&one, 1});
  }
  static void derive_together(std::span<const Derivation<VertexConfiguration>> vertices);

  void read(FieldReader& in);
  void write(FieldWriter& out) const;
};
/// Normalises the base quaternion of a configuration that was just read, unless it is normalised.
/// Throws Error when its length is zero.
void read_quaternion(const FieldReader& in, Eigen::VectorXd& configuration);

LOCOGRAPH_REGISTER_VERTEX("VERTEX_CONFIGURATION", VertexConfiguration)
extern template class TypedVertexPool<VertexConfiguration>;

}  // namespace locograph
