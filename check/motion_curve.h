#pragma once
/// The one curve that a motion defines, and the robot anywhere on it.
///
///     locograph::MotionCurve curve(robot, motion);
///     CurvePoint point;
///     curve.step(0).at(0.5, point);                 // half-way between vertices 0 and 1
///     locograph::MotionSampler sampler(curve);
///     std::vector<Eigen::Isometry3d> world_from_link;
///     sampler.link_poses(0, 0.5, world_from_link);  // the links there
///
/// Over the fraction s of a step's time h, joints and the base's position are cubics through both
/// vertices with the slopes m there (Hermite):
///   x(s) = x_0 + h m_0 s + (3 d - 2 h m_0 - h m_1) s^2 + (h m_0 + h m_1 - 2 d) s^3,  d = x_1 - x_0
/// The base's rotation is R_0 exp(c(s)), c the same cubic from 0 to the rotation vector d of the
/// step (the short way round), with the slopes w_0 and Jr(d)^-1 w_1, Jr the right Jacobian of
/// SO(3): the base's angular velocity along its own axes is w_0 and w_1 at the ends. So velocities
/// are continuous, and accelerations linear but for the rotation.
///
/// Slopes are those of the motion. Where it has none they are (h_1 d_0 / h_0 + h_0 d_1 / h_1) /
/// (h_0 + h_1), of the parabola through three vertices (of the base's rotation, with the rotation
/// vectors of both steps), and zero at both ends and where the stance changes.
///
/// Every vertex at most Robot::configuration_size() numbers that are finite, else nothing may be
/// asked of the steps on both sides: usable() says so. Curves keep pointers to robot and motion,
/// which must not change; const members are thread-safe. A sampler is for one thread.

#include <locograph/check/motion.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace locograph {

/// A configuration on the curve, and how it moves: tangents of Robot::tangent_size(), the base's
/// along its own axes, and their derivatives.
struct CurvePoint {
  Eigen::VectorXd configuration, velocity, acceleration;
};

/// What a step changes at most, by its fraction: first and second derivatives over s.
struct StepBounds {
  double base_distance_m = 0.0, base_angle_rad = 0.0;
  double base_bend_m = 0.0, base_bend_rad = 0.0;
  Eigen::VectorXd joints, joint_bends;  ///< of each active joint, not negative
};

class CurveStep {
 public:
  /// Slopes as in Motion, both with all numbers; duration_s > 0, or 0 where nothing moves but s.
  CurveStep(const Robot& robot, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
            const Eigen::VectorXd& slope_from, const Eigen::VectorXd& slope_to, double duration_s);

  double duration_s() const { return duration_s_; }
  /// The quaternion of out has norm 1. At both ends those of the vertices, to the last bit.
  void configuration(double fraction, Eigen::VectorXd& out) const;
  void at(double fraction, CurvePoint& point) const;
  /// As Motion::slopes.
  Eigen::VectorXd slope(double fraction) const;

  /// Of coordinate k of the tangent: change since the first vertex is
  /// first s + second s^2 + third s^3 (of the base in the world, of its rotation vector c).
  Eigen::Vector3d cubic(int k) const { return cubics_.row(k); }
  StepBounds bounds() const;

 private:
  /// Of each coordinate of the tangent, as in cubic(), per second.
  Eigen::VectorXd rates(double s) const;

  const Robot* robot_;
  const Eigen::VectorXd *from_, *to_;
  double duration_s_;
  Eigen::Quaterniond rotation_;  // of the first vertex
  Eigen::Matrix<double, Eigen::Dynamic, 3> cubics_;
};

class MotionCurve {
 public:
  MotionCurve(const Robot& robot, const Motion& motion);

  const Robot& robot() const { return *robot_; }
  const Motion& motion() const { return *motion_; }
  /// The numbers of a vertex can be looked at.
  bool usable(int vertex) const { return usable_[static_cast<std::size_t>(vertex)]; }
  /// From a vertex to the next. Both must be usable.
  CurveStep step(int vertex) const;
  /// As Motion::slopes, by the rule where it has none; zero at a vertex that is not usable.
  const Eigen::VectorXd& slope(int vertex) const {
    return slopes_[static_cast<std::size_t>(vertex)];
  }
  double time_s(int vertex, double fraction) const;
  /// How it moves at a vertex: as the step from there begins, at the last one as the last step
  /// ends; a single vertex is at rest.
  CurvePoint at_vertex(int vertex) const;
  /// The same, with the mean of the accelerations before and after a vertex that has both.
  CurvePoint through_vertex(int vertex) const;

 private:
  Eigen::VectorXd three_point_slope(int vertex) const;

  const Robot* robot_;
  const Motion* motion_;
  std::vector<bool> usable_;
  std::vector<Eigen::VectorXd> slopes_;
};

/// The vertices from first to last with the slopes that they have in the whole motion.
Motion part_of(const MotionCurve& curve, int first, int last);

/// The same curve through other times: ascending, from the motion's first to its last; those of its
/// vertices at which stances change have to be among them.
Motion resampled(const MotionCurve& curve, const std::vector<double>& times_s);

class MotionSampler {
 public:
  explicit MotionSampler(const MotionCurve& curve) : curve_(&curve), state_(curve.robot()) {}

  /// Poses at `fraction` of the way from vertex `vertex` to the next; at fraction 0 the next one
  /// is not read. Vertices must be usable.
  void link_poses(int vertex, double fraction, std::vector<Eigen::Isometry3d>& world_from_link);
  /// Of the last link_poses().
  const RobotState& state() const { return state_; }
  const Eigen::VectorXd& configuration() const { return configuration_; }

 private:
  void move_to(int vertex, double fraction);

  const MotionCurve* curve_;
  int vertex_ = -1;  // where state_ is
  double fraction_ = 0.0;
  std::optional<CurveStep> step_;
  int step_from_ = -1;  // the vertex that step_ begins at
  RobotState state_;
  Eigen::VectorXd configuration_;
};

}  // namespace locograph
