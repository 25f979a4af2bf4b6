#pragma once
/// What gravity and contact wrenches do to the base and to single joints, and the derivatives.
///
///     const AppliedWrench wrench(q.kinematics, contact, components);
///     add_wrench_on_base(q.kinematics, wrench, e);                 // 6 rows, base axes
///     add_wrench_gradient(q.kinematics, wrench, i, -1.0, row);     // one joint's row
///
/// The quantities of robots/statics.h in rows, for edges that want the base's six or a few joints'
/// and have no n × n memory; what is added here is that the axes of a wrench may turn with its
/// link.
///
/// Derivation. An axis k along a_k moves the contact point by d_k = a_k × (p − o_k), or a_k if
/// it slides, and turns axes fixed in the link: df = a_k × f, dm = a_k × m. The torque of axis i
/// is t_i = a_i · ((p − o_i) × f + m), or a_i · f. An axis below i changes it by
/// a_i · (d_k × f + (p − o_i) × df + dm), or a_i · df. The axis itself, one above it and the base
/// carry the whole chain along: seen from the chain only a wrench fixed in the world turns, back by
/// a_k, and t_i changes by a_k · (j_i × f + a_i × m), j_i = a_i × (p − o_i), or j_i = a_i without
/// the moment if i slides.
///
/// A ball and a wheel touch at p + r, p their centre, r fixed in the world: a force f there is the
/// force f at p and the moment r × f, which is fixed in the world as f is, and all of the above
/// holds for p. On a bar with the axis a, r and f turn with the normal, by dΦ = t · dp: f by
/// dΦ a × f and r × f by dΦ a × (r × f).

#include <locograph/plugins/configuration/contact_parameter.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

#include <Eigen/Core>
#include <string_view>

namespace locograph {

/// Force and moment on the base, along the base axes, about its origin.
using BaseWrench = Eigen::Ref<Eigen::Matrix<double, 6, 1>>;
/// Their derivatives: a column for each coordinate of the tangent or of the wrench.
using BaseWrenchGradient = Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>;

/// A contact's wrench where the robot now stands; world frame and axes.
struct AppliedWrench {
  AppliedWrench(const RobotState& state, const ContactParameter& contact, const double* components);

  const ContactParameter* contact;
  Eigen::Matrix3d axes;
  Eigen::Vector3d point;            ///< of the end effector, fixed in its link
  Eigen::Vector3d force, moment;    ///< about the point
  Eigen::Vector3d touching_offset;  ///< see ContactParameter
};

/// The six rows of the base. Only for robots with a floating base.
void add_gravity_on_base(const RobotState& state, BaseWrench wrench);
void add_gravity_on_base_gradient(const RobotState& state, BaseWrenchGradient gradient);
void add_wrench_on_base(const RobotState& state, const AppliedWrench& applied, BaseWrench wrench);
void add_wrench_on_base_gradient(const RobotState& state, const AppliedWrench& applied,
                                 BaseWrenchGradient gradient);
/// By the components of the wrench: columns first … first + contact.cone->components().size() − 1.
void add_wrench_on_base_by_components(const RobotState& state, const AppliedWrench& applied,
                                      int first, BaseWrenchGradient gradient);

/// The base rows of Σ J_iᵀ w_i − g(q). Throws Error, naming the tag, for a robot with a fixed base
/// and for wrenches on another robot.
void balance_of_base(std::string_view tag, const ConfigurationState& q,
                     const WrenchesState& wrenches, BaseWrench e);
/// Added to both; by_wrenches as add_wrench_on_base_by_components().
void balance_of_base_gradients(const ConfigurationState& q, const WrenchesState& wrenches,
                               BaseWrenchGradient by_q, BaseWrenchGradient by_wrenches);
/// What counts as balanced [N, N m]: a part of the robot's weight.
double balance_tolerance(const Robot& robot);

/// How axis i, above a point's link, moves the point, in the world [m for each rad or m].
Eigen::Vector3d point_column(const RobotState& state, int i, const Eigen::Vector3d& point);

/// The torque [N m] or force [N] that gravity asks of axis i of the robot (Robot::axes()), and its
/// derivative by the tangent: row += scale · gradient. An active joint bears the sum over its axes,
/// each times its multiplier.
double gravity_torque(const RobotState& state, int i);
void add_gravity_gradient(const RobotState& state, int i, double scale, double* row);
/// What the wrench asks of axis i, which must be in the support of the contact's link.
double wrench_torque(const RobotState& state, const AppliedWrench& applied, int i);
void add_wrench_gradient(const RobotState& state, const AppliedWrench& applied, int i, double scale,
                         double* row);
void add_wrench_gradient_by_components(const RobotState& state, const AppliedWrench& applied, int i,
                                       double scale, double* row);

/// Of all active joints, what holds the robot still: g(q) − Σ J_iᵀ w_i. Throws Error for a robot
/// without mass.
void static_torques(const RobotState& state, const WrenchesState& wrenches,
                    Eigen::Ref<Eigen::VectorXd> torques);

/// Whether axis i moves a link.
bool supports(const Robot& robot, int i, int link);

}  // namespace locograph
