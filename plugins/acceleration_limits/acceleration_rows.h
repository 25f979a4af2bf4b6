#pragma once
/// The rows of EDGE_ACCELERATION_LIMITS and of its kinds with time steps as vertices.
///
///     AccelerationRows rows("EDGE_ACCELERATION_LIMITS", limits, {a, b, c, {dt_1_s, dt_2_s}});
///     rows.error(LimitKind::kHinged, e);
///
/// Row: |acceleration| − limit, for each active joint [rad/s² or m/s²], and for the base linear
/// [m/s²] and angular [rad/s²]; a limit of 0 stands for none. What the acceleration is over three
/// configurations: edge_acceleration_limits.h. From rest it is that with a first step of no length
/// in no time: a = 2 Δ₂ / Δt₂².

#include <locograph/core/edge.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

namespace locograph {

/// Weights of two displacements, one after the other, in the second derivative.
struct SecondDifference {
  double dt_1 = 0.0, dt_2 = 0.0;      ///< s
  double step_1 = 0.0, step_2 = 0.0;  ///< a = step_2 Δ₂ − step_1 Δ₁

  SecondDifference(double dt_1_s, double dt_2_s);
  static SecondDifference from_rest(double dt_s);
  /// Throws Error, naming the tag, where time does not increase.
  void require_increasing(std::string_view tag) const;

 private:
  SecondDifference() = default;
};

class AccelerationRows {
 public:
  /// By a configuration: rows × tangent, zero before.
  using Jacobian =
      Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  using Column = Eigen::Ref<Eigen::VectorXd>;

  /// From rest in `here`: before is here.
  struct Motion {
    const ConfigurationState &before, &here, &after;
    SecondDifference difference;
  };

  /// How large a violation of a limit counts as none.
  static double tolerance(double limit) { return 1e-3 * limit; }
  static int count(const Robot& robot) { return robot.active_joint_count() + 2; }
  /// What bind() of an edge asks of its limits. Throws Error.
  static void check(std::string_view tag, const Eigen::VectorXd& limits, int rows,
                    const Parameters& parameters);

  AccelerationRows(std::string_view tag, const Eigen::VectorXd& limits, const Motion& motion)
      : tag_(tag), limits_(limits), m_(motion) {}

  /// Throws Error when e has another size, the robots differ, or time does not increase.
  void error(LimitKind kind, Eigen::Ref<Eigen::VectorXd> e) const;
  void by_configurations(LimitKind kind, Jacobian* before, Jacobian here, Jacobian after) const;
  /// By the logarithms of the two steps of time; before is null from rest.
  void by_log_steps(LimitKind kind, Column* before, Column after) const;

 private:
  double joint(int i) const;
  Eigen::Vector3d linear() const;
  Eigen::Vector3d angular() const;
  bool limited(int row) const;  ///< is not without a limit, or without a base that moves

  std::string_view tag_;
  const Eigen::VectorXd& limits_;
  Motion m_;
};

}  // namespace locograph
