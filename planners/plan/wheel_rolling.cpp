#include <locograph/common/error.h>
#include <locograph/planners/plan/wheel_rolling.h>

#include <algorithm>
#include <cmath>

namespace locograph {

WheelOnGround::WheelOnGround(const Robot& robot, const RollingWheel& wheel)
    : link_(wheel.link), radius_(wheel.radius_m) {
  if (link_ < 0 || link_ >= int(robot.links().size()))
    throw Error("wheel on link " + std::to_string(link_),
                "an index below " + std::to_string(robot.links().size()));
  const Link& link = robot.links()[std::size_t(link_)];
  if (!(radius_ > 0.0) || !std::isfinite(radius_))
    throw Error("radius " + std::to_string(radius_) + " of wheel " + link.name,
                "a positive number of metres");
  const Joint* joint =
      link.parent_joint < 0 ? nullptr : &robot.joints()[std::size_t(link.parent_joint)];
  if (joint == nullptr ||
      (joint->type != JointType::kRevolute && joint->type != JointType::kContinuous))
    throw Error("wheel on link " + link.name, "a link below a revolute or continuous joint");
  axis_ = joint->axis;
  mount_link_ = joint->parent_link;
}

Eigen::Vector3d WheelOnGround::lowest_point(const Eigen::Isometry3d& world_from_wheel) const {
  const Eigen::Vector3d axle = world_from_wheel.linear() * axis_;
  const Eigen::Vector3d centre = world_from_wheel.translation();
  const Eigen::Vector3d up_in_disc = Eigen::Vector3d::UnitZ() - axle.z() * axle;
  const double norm = up_in_disc.norm();
  if (norm < 1e-12) return centre;
  return centre - up_in_disc * (radius_ / norm);
}

double WheelOnGround::tilt_rad(const Eigen::Isometry3d& world_from_wheel) const {
  const Eigen::Vector3d axle = world_from_wheel.linear() * axis_;
  return std::asin(std::min(1.0, std::abs(axle.z())));
}

WheelSlip WheelOnGround::slip(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                              const WheelSlip& before) const {
  const Eigen::Vector3d axle = (from.linear() * axis_ + to.linear() * axis_).normalized();
  const double across = std::hypot(axle.x(), axle.y());
  if (across < 1e-9) return before;
  const Eigen::Vector3d lateral(axle.x() / across, axle.y() / across, 0.0);
  const Eigen::Vector3d heading(lateral.y(), -lateral.x(), 0.0);
  const Eigen::Vector3d moved = to.translation() - from.translation();
  const Eigen::Matrix3d turn = to.linear() * from.linear().transpose();
  const Eigen::AngleAxisd turned(turn);
  const double spin = turned.angle() * turned.axis().dot(axle);
  return {before.lateral_m + moved.dot(lateral),
          before.longitudinal_m + moved.dot(heading) - radius_ * spin};
}

}  // namespace locograph
