#pragma once
/// The rows of EDGE_VELOCITY_LIMITS and of its kind with the time step as a vertex.
///
///     const VelocityRows rows{1.0, 0.5, 1.0};
///     rows.error("EDGE_VELOCITY_LIMITS", LimitKind::kHinged, a, b, dt_s, e);
///
/// Row: |what moved from a to b| − rate · Δt, for each active joint [rad or m] and for the base's
/// distance [m] and angle [rad].

#include <locograph/core/edge.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

namespace locograph {

struct VelocityRows {
  double fraction = 1.0;  ///< of the joints' velocity limits
  double base_linear_m_s = 0.0;
  double base_angular_rad_s = 0.0;  ///< 0: no limit, as above

  /// By a configuration: rows × tangent, zero before.
  using Jacobian =
      Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

  /// How large a violation of a row counts as none: of a joint, nothing that its own limit does not
  /// leave room for.
  double tolerance(const Robot& robot, int row, double dt_s) const;
  static int count(const Robot& robot) { return robot.active_joint_count() + 2; }
  /// Throws Error when e has another size, or the robots differ.
  void error(std::string_view tag, LimitKind kind, const ConfigurationState& a,
             const ConfigurationState& b, double dt_s, Eigen::Ref<Eigen::VectorXd> e) const;
  /// by_dt: null where Δt is given; otherwise the derivative by it [per s], zero before.
  void jacobians(LimitKind kind, const ConfigurationState& a, const ConfigurationState& b,
                 double dt_s, Jacobian ja, Jacobian jb,
                 Eigen::Ref<Eigen::VectorXd>* by_dt = nullptr) const;

 private:
  /// Of a row that has a limit.
  double joint_rate(const Robot& robot, int joint) const {
    return fraction * robot.active_joint(joint).max_velocity;
  }
};

}  // namespace locograph
