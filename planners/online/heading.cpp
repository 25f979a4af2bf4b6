#include <locograph/planners/online/heading.h>

#include <Eigen/Geometry>

namespace locograph {

Eigen::Vector3d left_of(const double* configuration) {
  const Eigen::Quaterniond rotation(configuration + 3);
  Eigen::Vector3d side = rotation * Eigen::Vector3d::UnitY();
  side.z() = 0.0;
  return side.normalized();
}

}  // namespace locograph
