#include <gtest/gtest.h>
#include <locograph/common/uniform.h>
#include <locograph/world/perception/image_bounds.h>

#include <random>

#include "world/perception/camera_support.h"

namespace locograph {
namespace {

Eigen::Vector3d drawn(std::mt19937_64& random, double low, double high) {
  const double x = uniform(random, low, high), y = uniform(random, low, high);
  return {x, y, uniform(random, low, high)};
}

/// Whether what shows at a point of a shape lies in the bounds.
bool holds(const ImageBounds& bounds, const DepthCamera& camera, const Eigen::Vector3d& point) {
  if (point.z() <= 1e-9) return true;
  const double u = point.x() / point.z() * camera.fx + camera.cx;
  const double v = point.y() / point.z() * camera.fy + camera.cy;
  if (u < 0.0 || u > camera.width - 1 || v < 0.0 || v > camera.height - 1) return true;
  // A pixel that shows it is within one of it.
  return bounds.near_m <= point.z() + 1e-12 && bounds.far_m >= point.z() - 1e-12 &&
         bounds.u_begin - 1 < u && u < bounds.u_end && bounds.v_begin - 1 < v && v < bounds.v_end;
}

TEST(ImageBounds, HoldAllThatShows) {
  const DepthCamera camera = test::small_camera();
  std::mt19937_64 random(4);
  int showing = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Eigen::Vector3d middle = drawn(random, -1.0, 1.0) + Eigen::Vector3d(0.0, 0.0, 0.8);
    const Capsule capsule{middle, middle + drawn(random, -0.3, 0.3), uniform(random, 0.01, 0.2)};
    const ImageBounds bounds = image_bounds(camera, capsule);
    Eigen::Isometry3d optical_from_box(Eigen::Translation3d(middle.x(), middle.y(), middle.z()));
    optical_from_box.rotate(
        Eigen::AngleAxisd(uniform(random, 0.0, 3.0), drawn(random, -1.0, 1.0).normalized()));
    const Eigen::Vector3d half = drawn(random, 0.01, 0.3);
    const ImageBounds box = image_bounds(camera, optical_from_box, half);
    showing += !bounds.empty() + !box.empty();
    for (int point = 0; point < 200; ++point) {
      const Eigen::Vector3d on_axis =
          capsule.from + uniform(random, 0.0, 1.0) * (capsule.to - capsule.from);
      ASSERT_TRUE(
          holds(bounds, camera, on_axis + capsule.radius * drawn(random, -1.0, 1.0).normalized()))
          << trial;
      const Eigen::Vector3d share = drawn(random, -1.0, 1.0).cwiseSign();
      ASSERT_TRUE(holds(box, camera,
                        optical_from_box * Eigen::Vector3d(half.cwiseProduct(
                                               point % 2 == 0 ? share : drawn(random, -1.0, 1.0)))))
          << trial;
    }
  }
  EXPECT_GT(showing, 300);
}

TEST(ImageBounds, OfASphereAheadAreTheRaysThatTouchIt) {
  const DepthCamera camera = test::small_camera(641, 481);
  const Eigen::Vector3d centre(0.0, 0.0, 1.0);
  const ImageBounds bounds = image_bounds(camera, {centre, centre, 0.5});
  // It is seen under asin(0.5) to all sides: a slope of 1 / sqrt(3).
  EXPECT_EQ(bounds.u_begin, static_cast<int>(std::ceil(camera.cx - camera.fx / std::sqrt(3.0))));
  EXPECT_EQ(bounds.u_end, static_cast<int>(std::floor(camera.cx + camera.fx / std::sqrt(3.0))) + 1);
  EXPECT_EQ(bounds.near_m, 0.5);
  EXPECT_EQ(bounds.far_m, 1.5);
}

TEST(ImageBounds, AreEmptyBehindAndBesideTheImage) {
  const DepthCamera camera = test::small_camera();
  const Eigen::Vector3d behind(0.0, 0.0, -1.0), beside(5.0, 0.0, 1.0), half(0.1, 0.1, 0.1);
  for (const Eigen::Vector3d& at : {behind, beside}) {
    EXPECT_TRUE(image_bounds(camera, {at, at, 0.2}).empty());
    EXPECT_TRUE(image_bounds(camera, Eigen::Isometry3d(Eigen::Translation3d(at)), half).empty());
  }
}

}  // namespace
}  // namespace locograph
