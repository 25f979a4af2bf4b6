#pragma once
/// A wheel on flat ground: how far it is from touching it, and how much it slips along the way.
///
///     locograph::WheelOnGround wheel(robot, {robot.link_index("wheel_1"), 0.078});
///     double gap = wheel.lowest_point(world_from_wheel).z() - ground_z;
///     locograph::WheelSlip slip;
///     slip = wheel.slip(previous_pose, pose, slip);  // sums up along samples
///
/// a is the axle, c the wheel's centre. Lateral slip is the integral of c' along the horizontal
/// direction of the axle. The wheel's spin w is the part along the axle of its angular velocity in
/// the world, so it does not matter which joint turns it; without slip c' h = r w, where
/// h = a x z / |a x z| is the direction in which a positive spin rolls. Longitudinal slip is the
/// integral of c' h - r w. Both integrals use the axle in the middle between two samples: exact to
/// second order in what happens between these; the spin must be less than half a turn.

#include <locograph/planners/plan/motion_interpolation.h>
#include <locograph/robots/robot.h>

#include <Eigen/Geometry>

namespace locograph {

struct WheelSlip {
  double lateral_m = 0.0, longitudinal_m = 0.0;
};

class WheelOnGround {
 public:
  /// Throws Error unless the link hangs on a revolute or continuous joint and the radius is
  /// positive.
  WheelOnGround(const Robot& robot, const RollingWheel& wheel);

  int link() const { return link_; }
  int mount_link() const { return mount_link_; }  ///< the parent of the wheel's joint
  /// Of the disc.
  Eigen::Vector3d lowest_point(const Eigen::Isometry3d& world_from_wheel) const;
  /// Angle between axle and horizontal, 0 to pi / 2 [rad].
  double tilt_rad(const Eigen::Isometry3d& world_from_wheel) const;
  /// `before` plus what happens between two samples. A vertical axle has no slip.
  WheelSlip slip(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                 const WheelSlip& before) const;

 private:
  int link_, mount_link_ = -1;
  double radius_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();  // link frame
};

}  // namespace locograph
