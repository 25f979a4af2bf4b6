#include <locograph/planners/online/heading.h>

#include <Eigen/Geometry>
#include <cmath>

namespace locograph {

Eigen::Vector3d left_of(const double* configuration) {
  const Eigen::Quaterniond rotation(configuration + 3);
  Eigen::Vector3d side = rotation * Eigen::Vector3d::UnitY();
  side.z() = 0.0;
  return side.normalized();
}

double turn_between(const double* from, const double* to) {
  const Eigen::Vector3d left = left_of(from), left_then = left_of(to);
  return std::atan2(left.cross(left_then).z(), left.dot(left_then));
}

void turn_base(double yaw_rad, double* configuration) {
  if (yaw_rad == 0.0) return;
  Eigen::Map<Eigen::Quaterniond> rotation(configuration + 3);
  const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ());
  rotation = (yaw * rotation).normalized();
}

}  // namespace locograph
