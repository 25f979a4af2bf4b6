#pragma once
/// How far a frame is turned away from a target, and the derivative of that by its rotation.
///
///     OrientationError turned(world_from_target.linear(), world_from_frame.linear());
///     e.tail<3>() = turned.vector;                       // rad, along the target's axes
///     turned.derivative();                               // 3 × 3: by a world rotation vector
///
/// OrientationError measures the whole rotation by its rotation vector log(Tᵀ F). TiltError
/// measures one axis: the rotation vector that takes the target's axis onto the frame's the
/// shortest way. It does not change when either frame turns about that axis, and its component
/// along the axis is zero.
///
/// At half a turn both jump, the one of the tilt to every side: an axis that points exactly
/// backwards is taken to have turned about the next axis.

#include <Eigen/Core>

namespace locograph {

/// Inverse of the right Jacobian of SO(3): log(R exp(δ)) ≈ log R + J δ (Chirikjian 2012,
/// eq. 10.86).
Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& rotation_vector);

struct OrientationError {
  Eigen::Vector3d vector;

  OrientationError(const Eigen::Matrix3d& world_from_target,
                   const Eigen::Matrix3d& world_from_frame);
  Eigen::Matrix3d derivative() const;

 private:
  Eigen::Matrix3d target_from_world_;
};

struct TiltError {
  Eigen::Vector3d vector;

  /// axis: 0, 1 or 2.
  TiltError(const Eigen::Matrix3d& world_from_target, const Eigen::Matrix3d& world_from_frame,
            int axis);
  Eigen::Matrix3d derivative() const;

 private:
  Eigen::Matrix3d target_from_world_;
  int axis_;
  Eigen::Vector3d direction_;  ///< of the frame's axis, in the target's axes
  Eigen::Vector3d cross_;      ///< target's axis × direction_
  double sine_, angle_per_sine_;
};

}  // namespace locograph
