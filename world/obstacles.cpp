#include <locograph/common/error.h>
#include <locograph/world/obstacle_way.h>
#include <locograph/world/point_kernels.h>
#include <locograph/world/require_metres.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

Eigen::Isometry3d interpolate(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                              double fraction) {
  if (fraction <= 0.0) return from;
  if (fraction >= 1.0) return to;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = from.translation() + fraction * (to.translation() - from.translation());
  const Eigen::Quaterniond start(from.linear()), end(to.linear());
  pose.linear() = start.slerp(fraction, end).toRotationMatrix();
  return pose;
}

// Distances below are the usual closed forms for a box, a sphere and a cylinder centred at the
// origin: outside, the norm of the componentwise excess; inside, the nearest face.

DistanceSample box_sample(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
  const Eigen::Vector3d excess = p.cwiseAbs() - half;
  const Eigen::Vector3d sign(p.x() < 0 ? -1 : 1, p.y() < 0 ? -1 : 1, p.z() < 0 ? -1 : 1);
  DistanceSample sample;
  const Eigen::Vector3d outside = excess.cwiseMax(0.0);
  const double norm = outside.norm();
  if (norm > 0.0) {
    sample.distance = norm;
    sample.gradient = outside.cwiseProduct(sign) / norm;
    return sample;
  }
  int axis = 0;
  sample.distance = excess.maxCoeff(&axis);
  sample.gradient[axis] = sign[axis];
  return sample;
}

DistanceSample sphere_sample(const Eigen::Vector3d& p, double radius) {
  const double norm = p.norm();
  DistanceSample sample;
  sample.distance = norm - radius;
  sample.gradient = norm > 0.0 ? Eigen::Vector3d(p / norm) : Eigen::Vector3d::UnitZ();
  return sample;
}

DistanceSample cylinder_sample(const Eigen::Vector3d& p, double radius, double half_height) {
  const double rho = std::hypot(p.x(), p.y());
  const Eigen::Vector3d radial =
      rho > 0.0 ? Eigen::Vector3d(p.x() / rho, p.y() / rho, 0.0) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d axial(0.0, 0.0, p.z() < 0 ? -1.0 : 1.0);
  const double radial_excess = rho - radius, axial_excess = std::abs(p.z()) - half_height;
  DistanceSample sample;
  if (radial_excess > 0.0 && axial_excess > 0.0) {
    sample.distance = std::hypot(radial_excess, axial_excess);
    sample.gradient = (radial_excess * radial + axial_excess * axial) / sample.distance;
  } else if (radial_excess > axial_excess) {
    sample.distance = radial_excess;
    sample.gradient = radial;
  } else {
    sample.distance = axial_excess;
    sample.gradient = axial;
  }
  return sample;
}

/// Of the shape of an obstacle at a pose.
DistanceSample sample_at(const Obstacle& obstacle, const Eigen::Isometry3d& pose,
                         const Eigen::Vector3d& point) {
  using Shape = Obstacle::Shape;
  const Eigen::Vector3d& size = obstacle.size;
  const Eigen::Vector3d local = pose.linear().transpose() * (point - pose.translation());
  DistanceSample result;
  switch (obstacle.shape) {
    case Shape::kBox:
      result = box_sample(local, 0.5 * size);
      break;
    case Shape::kSphere:
      result = sphere_sample(local, size[0]);
      break;
    case Shape::kCylinder:
      result = cylinder_sample(local, size[0], 0.5 * size[1]);
      break;
  }
  result.gradient = pose.linear() * result.gradient;
  return result;
}

void require_pose(const Eigen::Isometry3d& pose, const std::string& owner) {
  if (!pose.matrix().allFinite()) throw Error(owner + ": pose is not finite", "finite numbers");
  const Eigen::Matrix3d rotation = pose.linear();
  const Eigen::Matrix3d product = rotation * rotation.transpose();
  if (!product.isIdentity(1e-6) || rotation.determinant() < 0.0)
    throw Error(owner + ": orientation is not a rotation", "orthonormal axes, right-handed");
}

}  // namespace

Eigen::Isometry3d Obstacle::pose_at(double time_s) const {
  if (motion.empty() || time_s <= 0.0) return world_from_obstacle;
  if (repeat_s > 0.0) time_s = std::fmod(time_s, repeat_s);
  const KeyFrame start{0.0, world_from_obstacle};
  const auto after =
      std::upper_bound(motion.begin(), motion.end(), time_s,
                       [](double time, const KeyFrame& frame) { return time < frame.time_s; });
  const KeyFrame* before = after == motion.begin() ? &start : &*(after - 1);
  if (after != motion.end())
    return interpolate(before->pose, after->pose,
                       (time_s - before->time_s) / (after->time_s - before->time_s));
  if (repeat_s <= 0.0) return before->pose;
  return interpolate(before->pose, world_from_obstacle,
                     (time_s - before->time_s) / (repeat_s - before->time_s));
}

double way_m(const Obstacle& obstacle, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  using Shape = Obstacle::Shape;
  const Eigen::Vector3d& size = obstacle.size;
  const double radius = obstacle.shape == Shape::kSphere     ? 0.0
                        : obstacle.shape == Shape::kCylinder ? std::hypot(size[0], 0.5 * size[1])
                                                             : 0.5 * size.norm();
  const Eigen::Quaterniond start(from.linear()), end(to.linear());
  return (to.translation() - from.translation()).norm() + start.angularDistance(end) * radius;
}

double fastest_m_s(const Obstacle& obstacle) {
  double fastest = 0.0;
  KeyFrame before{0.0, obstacle.world_from_obstacle};
  const auto move_to = [&](double time_s, const Eigen::Isometry3d& pose) {
    fastest = std::max(fastest, way_m(obstacle, before.pose, pose) / (time_s - before.time_s));
    before = {time_s, pose};
  };
  for (const KeyFrame& frame : obstacle.motion) move_to(frame.time_s, frame.pose);
  if (obstacle.repeat_s > 0.0) move_to(obstacle.repeat_s, obstacle.world_from_obstacle);
  return fastest;
}

std::vector<Obstacle> all_along(const Obstacle& obstacle, double apart_m) {
  constexpr double kMost = 500.0;
  std::vector<Eigen::Isometry3d> corners = {obstacle.world_from_obstacle};
  for (const KeyFrame& frame : obstacle.motion) corners.push_back(frame.pose);
  if (obstacle.repeat_s > 0.0) corners.push_back(corners.front());
  double way = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    way += way_m(obstacle, corners[i - 1], corners[i]);
  }
  apart_m = std::max(apart_m, way / kMost);
  Obstacle still = obstacle;
  still.motion.clear();
  still.repeat_s = 0.0;
  still.appears_s = Obstacle().appears_s;
  still.vanishes_s = Obstacle().vanishes_s;
  std::vector<Obstacle> all = {still};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const double steps = std::ceil(way_m(obstacle, corners[i - 1], corners[i]) / apart_m);
    for (double k = 1.0; k <= steps; ++k) {
      still.world_from_obstacle = interpolate(corners[i - 1], corners[i], k / steps);
      all.push_back(still);
    }
  }
  return all;
}

DistanceSample Obstacle::sample(const Eigen::Vector3d& point, double time_s) const {
  if (!is_there(time_s)) return {std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()};
  return sample_shape(point, time_s);
}

DistanceSample Obstacle::sample_shape(const Eigen::Vector3d& point, double time_s) const {
  return motion.empty() ? sample_at(*this, world_from_obstacle, point)
                        : sample_at(*this, pose_at(time_s), point);
}

void Obstacle::lower_to_shape(const PointList& points, double time_s, double* nearest) const {
  const Eigen::Isometry3d moved = motion.empty() ? Eigen::Isometry3d() : pose_at(time_s);
  const Eigen::Isometry3d& pose = motion.empty() ? world_from_obstacle : moved;
  PlacedShape placed;
  Eigen::Map<Eigen::Matrix3d>(placed.axes) = pose.linear();
  Eigen::Map<Eigen::Vector3d>(placed.origin) = pose.translation();
  Eigen::Map<Eigen::Vector3d> extents(placed.size);
  extents = size;
  const PointKernels& kernels = point_kernels();
  switch (shape) {
    case Shape::kBox:
      extents *= 0.5;
      kernels.box(placed, points, nearest);
      break;
    case Shape::kSphere:
      kernels.sphere(placed, points, nearest);
      break;
    case Shape::kCylinder:
      extents[1] *= 0.5;
      kernels.cylinder(placed, points, nearest);
      break;
  }
}

void Obstacle::validate() const {
  const std::string owner = name.empty() ? "obstacle" : "obstacle '" + name + "'";
  const int sizes = shape == Shape::kBox ? 3 : shape == Shape::kSphere ? 1 : 2;
  for (int i = 0; i < sizes; ++i) require_metres(size[i], (owner + ": size").c_str());
  require_pose(world_from_obstacle, owner);
  double last = 0.0;
  for (const KeyFrame& frame : motion) {
    require_pose(frame.pose, owner);
    if (!std::isfinite(frame.time_s) || frame.time_s <= last)
      throw Error(owner + ": key frame at " + std::to_string(frame.time_s) + " s",
                  "a time after " + std::to_string(last) + " s");
    last = frame.time_s;
  }
  if (repeat_s != 0.0 && (!std::isfinite(repeat_s) || repeat_s <= last || motion.empty()))
    throw Error(owner + ": period " + std::to_string(repeat_s) + " s",
                "key frames and a period longer than the last time");
  if (!(appears_s < vanishes_s))
    throw Error(owner + ": there from " + std::to_string(appears_s) + " s to " +
                    std::to_string(vanishes_s) + " s",
                "a time at which it vanishes after the one at which it appears");
}

}  // namespace locograph
