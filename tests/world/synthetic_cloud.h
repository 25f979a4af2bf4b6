#pragma once
/// Clouds of points on rectangles, boxes and bars, a centimetre apart, with noise.
///
///     SyntheticCloud cloud(0.005);
///     cloud.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
///     cloud.bar({1, -0.3, 0.9}, {1, 0.3, 0.9}, 0.02);

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace locograph::test {

class SyntheticCloud {
 public:
  using Hidden = std::function<bool(const Eigen::Vector3d&)>;

  /// noise_m: standard deviation of each coordinate.
  explicit SyntheticCloud(double noise_m, double step_m = 0.01)
      : noise_m_(noise_m), step_m_(step_m) {}

  void rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                 const Hidden& hidden = nullptr) {
    const int rows = steps(a.norm()), columns = steps(b.norm());
    for (int i = 0; i <= rows; ++i)
      for (int j = 0; j <= columns; ++j) {
        add(corner + static_cast<double>(i) / rows * a + static_cast<double>(j) / columns * b,
            hidden);
      }
  }

  /// Top and sides.
  void box(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size) {
    const Eigen::Vector3d half = 0.5 * size;
    const Eigen::Vector3d x = pose.linear().col(0) * size.x(), y = pose.linear().col(1) * size.y(),
                          z = pose.linear().col(2) * size.z(), low = pose * -half;
    rectangle(low + z, x, y);
    rectangle(low, x, z);
    rectangle(low + y, x, z);
    rectangle(low, y, z);
    rectangle(low + x, y, z);
  }

  void bar(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m,
           const Hidden& hidden = nullptr) {
    const Eigen::Vector3d along = (to - from).normalized(), x = along.unitOrthogonal(),
                          y = along.cross(x);
    const int rings = steps((to - from).norm());
    constexpr int kAround = 16;
    for (int i = 0; i <= rings; ++i)
      for (int j = 0; j < kAround; ++j) {
        const double turn = 2.0 * std::numbers::pi * j / kAround;
        add(from + static_cast<double>(i) / rings * (to - from) +
                radius_m * (std::cos(turn) * x + std::sin(turn) * y),
            hidden);
      }
  }

  std::vector<Eigen::Vector3d> points;

 private:
  int steps(double length_m) const { return static_cast<int>(std::ceil(length_m / step_m_)); }

  void add(Eigen::Vector3d point, const Hidden& hidden) {
    if (hidden && hidden(point)) return;
    for (int axis = 0; axis < 3; ++axis) {
      double sum = -6.0;  // twelve uniform ones have a variance of 1
      for (int i = 0; i < 12; ++i) sum += static_cast<double>(random_()) / 4294967296.0;
      point[axis] += noise_m_ * sum;
    }
    points.push_back(point);
  }

  double noise_m_, step_m_;
  std::mt19937 random_{7};
};

}  // namespace locograph::test
