#include <gtest/gtest.h>
#include <locograph/common/uniform.h>
#include <locograph/world/perception/ray_entries.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

namespace locograph {
namespace {

/// A ray in the frame of a shape, and where it meets parts of the shape's surface.
struct Ray {
  Eigen::Vector3d origin, direction;

  Eigen::Vector3d at(double t) const { return origin + t * direction; }
  void meet_plane(int axis, double offset, std::vector<double>& met) const {
    met.push_back((offset - origin[axis]) / direction[axis]);
  }
  void solve(double a, double b, double c, std::vector<double>& met) const {
    const double root = b * b - 4.0 * a * c;
    if (root < 0.0) return;
    met.push_back((-b - std::sqrt(root)) / (2.0 * a));
    met.push_back((-b + std::sqrt(root)) / (2.0 * a));
  }
  void meet_sphere(const Eigen::Vector3d& centre, double radius, std::vector<double>& met) const {
    const Eigen::Vector3d from = origin - centre;
    solve(direction.squaredNorm(), 2.0 * from.dot(direction), from.squaredNorm() - radius * radius,
          met);
  }
  void meet_side(double radius, std::vector<double>& met) const {
    solve(direction.head<2>().squaredNorm(), 2.0 * origin.head<2>().dot(direction.head<2>()),
          origin.head<2>().squaredNorm() - radius * radius, met);
  }
};

/// The least of them ahead that is on the shape: no farther out of it than rounding.
double first(const Ray& ray, const std::vector<double>& met,
             const std::function<double(const Eigen::Vector3d&)>& outside) {
  double least = kNoEntry;
  if (outside(ray.origin) <= 0.0) return least;
  for (const double t : met) {
    if (t > 0.0 && t < least && outside(ray.at(t)) < 1e-9) least = t;
  }
  return least;
}

struct Drawn {
  Eigen::Isometry3d optical_from_shape;
  Ray ray;  // in the frame of the shape
  double x, y;
};

/// A shape in front of the camera or around it, and a ray near it.
Drawn drawn(std::mt19937_64& random) {
  const auto vector = [&random](double most) {
    const double x = uniform(random, -most, most), y = uniform(random, -most, most);
    return Eigen::Vector3d(x, y, uniform(random, -most, most));
  };
  Drawn it;
  it.optical_from_shape = Eigen::Translation3d(vector(1.0) + Eigen::Vector3d(0.0, 0.0, 1.0)) *
                          Eigen::AngleAxisd(uniform(random, 0.0, 3.1), vector(1.0).normalized());
  const Eigen::Vector3d aim = it.optical_from_shape * vector(0.4);
  const double depth = std::max(0.2, aim.z());
  it.x = aim.x() / depth;
  it.y = aim.y() / depth;
  const Eigen::Isometry3d shape_from_optical = it.optical_from_shape.inverse();
  it.ray = {shape_from_optical.translation(),
            shape_from_optical.linear() * Eigen::Vector3d(it.x, it.y, 1.0)};
  return it;
}

void expect_same(double depth, double expected, int trial) {
  if (std::isinf(expected) || std::isinf(depth)) {
    EXPECT_EQ(depth, expected) << trial;
  } else {
    EXPECT_NEAR(depth, expected, 1e-7 * (1.0 + expected)) << trial;
  }
}

constexpr int kTrials = 20000;
const double kRadius = 0.2, kHalf = 0.35;

TEST(RayEntries, OfCapsulesAreThoseOfTheSideAndTheEnds) {
  std::mt19937_64 random(1);
  int met = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Drawn it = drawn(random);
    const double half = trial % 4 == 0 ? 0.0 : kHalf;
    std::vector<double> candidates;
    if (half > 0.0) it.ray.meet_side(kRadius, candidates);
    it.ray.meet_sphere({0.0, 0.0, half}, kRadius, candidates);
    it.ray.meet_sphere({0.0, 0.0, -half}, kRadius, candidates);
    const auto outside = [&](const Eigen::Vector3d& p) {
      const double along = std::clamp(p.z(), -half, half);
      return (p - Eigen::Vector3d(0.0, 0.0, along)).norm() - kRadius;
    };
    if (outside(it.ray.origin) <= 0.0) continue;
    const double expected = first(it.ray, candidates, outside);
    const double depth = CapsuleEntry(it.optical_from_shape, kRadius, half)(it.x, it.y);
    expect_same(depth, expected, trial);
    met += std::isfinite(depth);
  }
  EXPECT_GT(met, kTrials / 4);
}

TEST(RayEntries, OfCylindersAreThoseOfTheSideAndTheFlatEnds) {
  std::mt19937_64 random(2);
  int met = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Drawn it = drawn(random);
    std::vector<double> candidates;
    it.ray.meet_side(kRadius, candidates);
    it.ray.meet_plane(2, kHalf, candidates);
    it.ray.meet_plane(2, -kHalf, candidates);
    const double expected = first(it.ray, candidates, [&](const Eigen::Vector3d& p) {
      return std::max(p.head<2>().norm() - kRadius, std::abs(p.z()) - kHalf);
    });
    const double depth = CylinderEntry(it.optical_from_shape, kRadius, kHalf)(it.x, it.y);
    expect_same(depth, expected, trial);
    met += std::isfinite(depth);
  }
  EXPECT_GT(met, kTrials / 4);
}

TEST(RayEntries, OfBoxesAreThoseOfTheirFaces) {
  std::mt19937_64 random(3);
  const Eigen::Vector3d half(0.2, 0.3, 0.1);
  int met = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Drawn it = drawn(random);
    std::vector<double> candidates;
    for (int axis = 0; axis < 3; ++axis) {
      it.ray.meet_plane(axis, half[axis], candidates);
      it.ray.meet_plane(axis, -half[axis], candidates);
    }
    const double expected = first(it.ray, candidates, [&](const Eigen::Vector3d& p) {
      return (p.cwiseAbs() - half).maxCoeff();
    });
    const double depth = BoxEntry(it.optical_from_shape, half)(it.x, it.y);
    expect_same(depth, expected, trial);
    met += std::isfinite(depth);
  }
  EXPECT_GT(met, kTrials / 4);
}

TEST(RayEntries, OfAHalfSpaceAreThoseOfItsPlaneFromOutside) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < kTrials; ++trial) {
    const Drawn it = drawn(random);
    const Eigen::Vector3d normal = it.optical_from_shape.linear().col(2);
    const double offset = normal.dot(it.optical_from_shape.translation());
    const double fall = -it.ray.direction.z(), height = it.ray.origin.z();
    const double expected = height > 0.0 && fall > 0.0 ? height / fall : kNoEntry;
    expect_same(HalfSpaceEntry(normal, offset)(it.x, it.y), expected, trial);
  }
}

TEST(RayEntries, RaysAlongAnAxisEnterTheEnd) {
  Eigen::Isometry3d ahead(Eigen::Translation3d(0.05, 0.0, 1.0));
  EXPECT_NEAR(CapsuleEntry(ahead, 0.1, 0.3)(0.0, 0.0), 0.7 - std::sqrt(0.01 - 0.0025), 1e-9);
  EXPECT_NEAR(CylinderEntry(ahead, 0.1, 0.3)(0.0, 0.0), 0.7, 1e-12);
  EXPECT_NEAR(BoxEntry(ahead, {0.1, 0.1, 0.3})(0.0, 0.0), 0.7, 1e-12);
  EXPECT_EQ(CapsuleEntry(ahead, 0.04, 0.3)(0.0, 0.0), kNoEntry);
  EXPECT_EQ(CylinderEntry(ahead, 0.04, 0.3)(0.0, 0.0), kNoEntry);
  EXPECT_EQ(BoxEntry(ahead, {0.04, 0.1, 0.3})(0.0, 0.0), kNoEntry);
  ahead.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()));
  const Eigen::Vector3d axis = ahead.linear().col(2);
  const Eigen::Isometry3d along(Eigen::Translation3d(2.0 * axis) *
                                Eigen::Quaterniond(ahead.linear()));
  for (const auto& entry :
       {CapsuleEntry(along, 0.1, 0.3)(axis.x() / axis.z(), axis.y() / axis.z()),
        CylinderEntry(along, 0.1, 0.4)(axis.x() / axis.z(), axis.y() / axis.z())}) {
    EXPECT_NEAR(entry, 1.6 * axis.z(), 1e-9);
  }
}

TEST(RayEntries, WhatIsBehindIsNotEntered) {
  const Eigen::Isometry3d behind(Eigen::Translation3d(0.0, 0.0, -1.0));
  EXPECT_EQ(CapsuleEntry(behind, 0.1, 0.3)(0.0, 0.0), kNoEntry);
  EXPECT_EQ(CylinderEntry(behind, 0.1, 0.3)(0.0, 0.0), kNoEntry);
  EXPECT_EQ(BoxEntry(behind, {0.1, 0.1, 0.3})(0.0, 0.0), kNoEntry);
}

}  // namespace
}  // namespace locograph
