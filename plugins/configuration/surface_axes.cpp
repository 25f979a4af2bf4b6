#include <locograph/common/error.h>
#include <locograph/plugins/configuration/surface_axes.h>

#include <Eigen/Geometry>
#include <cmath>

namespace locograph {

Eigen::Matrix3d surface_axes(const std::string& contact, const Eigen::Vector3d& normal,
                             const Eigen::Vector3d& forward) {
  // stableNorm() neither overflows nor vanishes on the way, but may overlook NaN.
  const double length = normal.allFinite() ? normal.stableNorm() : 0.0;
  const double way = forward.allFinite() ? forward.stableNorm() : 0.0;
  if (!(length > 0.0 && std::isfinite(length))) {
    throw Error(contact + " has a normal of length zero or not finite",
                "a direction out of the surface");
  }
  if (!(way > 0.0 && std::isfinite(way))) {
    throw Error(contact + " has a forward direction that is zero or not finite",
                "a direction in the surface");
  }
  Eigen::Matrix3d axes;
  axes.col(2) = normal / length;
  const Eigen::Vector3d across = axes.col(2).cross(forward / way);
  if (!(across.norm() > 1e-9)) {
    throw Error(contact + " has a forward direction along its normal",
                "a direction in the surface");
  }
  axes.col(1) = across.normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

}  // namespace locograph
