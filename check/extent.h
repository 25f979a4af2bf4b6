#pragma once
/// How far apart the farthest two of many points are, kept up to date point by point.
///
///     Extent extent;
///     for (const Eigen::Vector3d& point : path) extent.add(point);
///     double at_most_m = extent.size();
///
/// Keeps the two extreme points along each of 64 directions. Between the farthest two points and
/// one of the directions there are at most 0.25 rad, so that the extremes along it are at least
/// cos(0.25) of the true distance apart: size() is that much larger than what was found, never
/// smaller than the truth and at most 3.3 % larger.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace locograph {

class Extent {
 public:
  void add(const Eigen::Vector3d& point) {
    const auto& directions = half_sphere();
    if (empty_) {
      empty_ = false;
      for (std::size_t i = 0; i < kDirections; ++i) least_[i] = most_[i] = directions[i].dot(point);
      return;
    }
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double along = directions[i].dot(point);
      least_[i] = std::min(least_[i], along);
      most_[i] = std::max(most_[i], along);
      width_ = std::max(width_, most_[i] - least_[i]);
    }
  }
  double size() const { return width_ / std::cos(kCovering_rad); }

  static constexpr std::size_t kDirections = 64;
  static constexpr double kCovering_rad = 0.25;

  /// Points of a spiral on the half sphere, about as far from each other everywhere.
  static const std::array<Eigen::Vector3d, kDirections>& half_sphere() {
    static const std::array<Eigen::Vector3d, kDirections> directions = [] {
      std::array<Eigen::Vector3d, kDirections> all;
      const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
      for (std::size_t i = 0; i < kDirections; ++i) {
        const double z = (double(i) + 0.5) / double(kDirections), r = std::sqrt(1.0 - z * z);
        all[i] = {r * std::cos(golden * double(i)), r * std::sin(golden * double(i)), z};
      }
      return all;
    }();
    return directions;
  }

 private:
  bool empty_ = true;
  double width_ = 0.0;
  std::array<double, kDirections> least_{}, most_{};
};

}  // namespace locograph
