#include <locograph/planners/online/heading.h>

#include <Eigen/Geometry>

namespace locograph {

Eigen::Vector3d left_of(const double* configuration) {
  const Eigen::Quaterniond rotation(configuration + 3);
  Eigen::Vector3d side = rotation * Eigen::Vector3d::UnitY();
  side.z() = 0.0;
  return side.normalized();
}

Eigen::VectorXd turned(const Eigen::VectorXd& configuration, double yaw_rad) {
  Eigen::VectorXd result = configuration;
  if (yaw_rad == 0.0) return result;
  const Eigen::Quaterniond rotation(configuration.data() + 3);
  const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ());
  Eigen::Map<Eigen::Quaterniond>(result.data() + 3) = (yaw * rotation).normalized();
  return result;
}

}  // namespace locograph
