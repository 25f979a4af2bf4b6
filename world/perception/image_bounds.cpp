#include <locograph/world/perception/image_bounds.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace locograph {
namespace {

constexpr double kTooNear_m = 1e-3;

/// x / z and y / z of all that a shape may show.
struct Slopes {
  double least[2] = {std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
  double most[2] = {-std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};

  void add(int axis, double low, double high) {
    least[axis] = std::min(least[axis], low);
    most[axis] = std::max(most[axis], high);
  }
};

void columns(double least, double most, double focal, double centre, int count, int& begin,
             int& end) {
  constexpr double kRounding = 1e-6;  // pixels
  const double last = count;
  begin = static_cast<int>(std::clamp(std::ceil(least * focal + centre - kRounding), 0.0, last));
  end =
      static_cast<int>(std::clamp(std::floor(most * focal + centre + kRounding) + 1.0, 0.0, last));
}

ImageBounds bounds_of(const DepthCamera& camera, const Slopes& slopes, double near_m,
                      double far_m) {
  ImageBounds bounds{0, 0, 0, 0, near_m, far_m};
  columns(slopes.least[0], slopes.most[0], camera.fx, camera.cx, camera.width, bounds.u_begin,
          bounds.u_end);
  columns(slopes.least[1], slopes.most[1], camera.fy, camera.cy, camera.height, bounds.v_begin,
          bounds.v_end);
  return bounds;
}

/// Of a capsule that reaches behind the optical centre. What shows of it is at least as far from
/// there as the whole capsule, and so has a least depth.
ImageBounds bounds_beside(const DepthCamera& camera, const Capsule& capsule, double near_m,
                          double far_m) {
  const double distance = distance_to_axis(capsule, Eigen::Vector3d::Zero()) - capsule.radius;
  const double wide = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double high = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  const double least_depth = distance / std::sqrt(1.0 + wide * wide + high * high);
  if (least_depth <= kTooNear_m) return {0, camera.width, 0, camera.height, near_m, far_m};
  if (far_m <= least_depth) return {};
  // The axis where spheres around it reach that depth.
  Eigen::Vector3d from = capsule.from, to = capsule.to;
  const double cut = least_depth - capsule.radius;
  if (from.z() > to.z()) std::swap(from, to);
  if (from.z() < cut) from += (cut - from.z()) / (to.z() - from.z()) * (to - from);
  Slopes slopes;
  for (int axis = 0; axis < 2; ++axis) {
    const double least = std::min(from[axis], to[axis]) - capsule.radius;
    const double most = std::max(from[axis], to[axis]) + capsule.radius;
    slopes.add(axis, least / (least < 0.0 ? least_depth : far_m),
               most / (most < 0.0 ? far_m : least_depth));
  }
  return bounds_of(camera, slopes, least_depth, far_m);
}

}  // namespace

ImageBounds image_bounds(const DepthCamera& camera, const Capsule& capsule) {
  const double near_m = std::min(capsule.from.z(), capsule.to.z()) - capsule.radius;
  const double far_m = std::max(capsule.from.z(), capsule.to.z()) + capsule.radius;
  if (far_m <= 0.0) return {};
  if (near_m <= kTooNear_m) return bounds_beside(camera, capsule, near_m, far_m);
  Slopes slopes;
  for (const Eigen::Vector3d* end : {&capsule.from, &capsule.to}) {
    for (int axis = 0; axis < 2; ++axis) {
      // The lines through the origin that touch a circle of radius r about (x, z): their slopes k
      // solve (x - k z)^2 = r^2 (1 + k^2).
      const double x = (*end)[axis], z = end->z(), r = capsule.radius;
      const double wide = r * std::sqrt(x * x + z * z - r * r), deep = z * z - r * r;
      slopes.add(axis, (x * z - wide) / deep, (x * z + wide) / deep);
    }
  }
  return bounds_of(camera, slopes, near_m, far_m);
}

ImageBounds image_bounds(const DepthCamera& camera, const Eigen::Isometry3d& optical_from_box,
                         const Eigen::Vector3d& half_extents) {
  const double middle = optical_from_box.translation().z();
  const double reach = optical_from_box.linear().row(2).cwiseAbs().dot(half_extents);
  const double near_m = middle - reach, far_m = middle + reach;
  if (far_m <= 0.0) return {};
  if (near_m <= kTooNear_m) return {0, camera.width, 0, camera.height, near_m, far_m};
  Slopes slopes;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d point = half_extents;
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) point[axis] = -point[axis];
    }
    point = optical_from_box * point;
    for (int axis = 0; axis < 2; ++axis) {
      slopes.add(axis, point[axis] / point.z(), point[axis] / point.z());
    }
  }
  return bounds_of(camera, slopes, near_m, far_m);
}

}  // namespace locograph
