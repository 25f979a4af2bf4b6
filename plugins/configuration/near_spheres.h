#pragma once
/// The covering spheres of a robot that are near the world, found many at a time.
///
///     each_near_sphere(*q.robot, {q.bound_centres, q.sphere_centres}, world, q.time_s, margin_m,
///                      [&](int sphere, double distance_m) { e[sphere] = distance_m; });

#include <locograph/plugins/configuration/robot_parameters.h>

#include <Eigen/Core>
#include <algorithm>

namespace locograph {

/// Points of which so many are worked out together, on the stack.
class PointBuffer {
 public:
  static constexpr int kMost = 64;

  void set(int i, const Eigen::Vector3d& point) {
    x_[i] = point[0];
    y_[i] = point[1];
    z_[i] = point[2];
  }
  PointList first(int count) const { return {x_, y_, z_, count}; }

 private:
  double x_[kMost], y_[kMost], z_[kMost];
};

/// Calls f(begin, end) for parts of [begin, end) that a PointBuffer holds.
template <class F>
void in_parts(int begin, int end, F&& f) {
  for (; begin < end; begin += PointBuffer::kMost) {
    f(begin, std::min(end, begin + PointBuffer::kMost));
  }
}

/// Calls f(i, distance of the point i) for points that are added, as many at a time as a
/// PointBuffer holds; the last ones by flush().
template <class F>
class DistanceBatch {
 public:
  DistanceBatch(const WorldDistance& world, double time_s, F& f)
      : world_(world), time_s_(time_s), f_(f) {}

  void add(int i, const Eigen::Vector3d& point) {
    points_.set(count_, point);
    index_[count_++] = i;
    if (count_ == PointBuffer::kMost) flush();
  }
  void flush() {
    if (count_ == 0) return;
    double distances[PointBuffer::kMost];
    world_.distances(points_.first(count_), time_s_, distances);
    for (int k = 0; k < count_; ++k) f_(index_[k], distances[k]);
    count_ = 0;
  }

 private:
  const WorldDistance& world_;
  double time_s_;
  F& f_;
  PointBuffer points_;
  int index_[PointBuffer::kMost], count_ = 0;
};

/// Where RobotParameter::bounds and RobotParameter::spheres are, by row, before they are shifted.
struct SphereCentres {
  const Eigen::MatrixX3d& of_bounds;
  const Eigen::MatrixX3d& of_spheres;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Calls f(sphere, distance to the world) for the spheres of all links that are not wholly farther
/// than the margin.
template <class F>
void each_near_sphere(const RobotParameter& robot, const SphereCentres& centres,
                      const WorldDistance& world, double time_s, double margin_m, F&& f) {
  DistanceBatch spheres(world, time_s, f);
  const auto look_into = [&](int i, double distance) {
    const RobotParameter::LinkBound& bound = robot.bounds[static_cast<std::size_t>(i)];
    // The field changes by no more than the way, so nothing inside the bound can be nearer.
    const double reach = bound.radius + margin_m;
    if (reach < world.max_distance() && distance > reach) return;
    for (int s = bound.begin; s < bound.end; ++s) {
      spheres.add(s, centres.of_spheres.row(s).transpose() + centres.shift);
    }
  };
  DistanceBatch bounds(world, time_s, look_into);
  for (int b = 0; b < static_cast<int>(robot.bounds.size()); ++b) {
    bounds.add(b, centres.of_bounds.row(b).transpose() + centres.shift);
  }
  bounds.flush();
  spheres.flush();
}

}  // namespace locograph
