#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/depth_image.h>

#include <algorithm>
#include <limits>

namespace locograph {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

DepthCamera small_camera() { return depth_camera("head", 0, 8, 6, 1.2); }

/// What the camera sees of a slanted plane, as an organised cloud.
PointCloud slanted_plane(const DepthCamera& camera) {
  PointCloud cloud;
  cloud.width = static_cast<std::size_t>(camera.width);
  cloud.height = static_cast<std::size_t>(camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      cloud.points.push_back(camera.point(u, v, 1.0 + 0.05 * u + 0.02 * v));
    }
  }
  return cloud;
}

PointCloud unorganised(std::vector<Eigen::Vector3d> points) {
  PointCloud cloud;
  cloud.width = points.size();
  cloud.height = 1;
  cloud.points = std::move(points);
  return cloud;
}

TEST(DepthImage, OfAnOrganisedCloudHasItsDepthsPixelByPixelAndItsHoles) {
  const DepthCamera camera = small_camera();
  PointCloud cloud = slanted_plane(camera);
  cloud.points[9] = {kHole, 0.0, 1.0};
  cloud.points[10] = Eigen::Vector3d::Constant(kHole);
  const DepthImage image = depth_image_of(cloud, camera);
  ASSERT_EQ(image.width, 8);
  ASSERT_EQ(image.height, 6);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const int u = static_cast<int>(i) % 8, v = static_cast<int>(i) / 8;
    const int expected = i == 9 || i == 10 ? 0 : 1000 + 50 * u + 20 * v;
    EXPECT_EQ(image.depth_mm[i], expected) << u << ' ' << v;
  }
  EXPECT_EQ(pixels_seen(image), 46);
}

TEST(DepthImage, PixelsThatAreHalfAPixelOffStayWhereTheyAre) {
  const DepthCamera camera = small_camera();
  DepthCamera other = camera;
  other.cx += 0.7;
  const PointCloud cloud = slanted_plane(other);
  EXPECT_EQ(pixels_seen(depth_image_of(cloud, camera)), 48);
}

TEST(DepthImage, AnOrganisedCloudOfAnotherLensIsProjectedNotBent) {
  const DepthCamera camera = small_camera();
  const DepthCamera narrow = depth_camera("other", 0, 8, 6, 0.6);
  const DepthImage image = depth_image_of(slanted_plane(narrow), camera);
  EXPECT_GT(pixels_seen(image), 4);
  EXPECT_LT(pixels_seen(image), 24) << "half the angle fills a quarter of the image";
  EXPECT_EQ(image.depth_mm[0], 0);
}

TEST(DepthImage, OfAnyOtherCloudHasTheNearestPointOfEachPixel) {
  const DepthCamera camera = small_camera();
  const DepthImage image = depth_image_of(unorganised({camera.point(3.4, 2.4, 2.0),
                                                       camera.point(2.6, 1.6, 1.5),
                                                       camera.point(3.0, 2.0, 1.7),
                                                       camera.point(-0.6, 2.0, 1.0),
                                                       camera.point(7.4, 5.4, 3.0),
                                                       camera.point(7.6, 5.0, 1.0),
                                                       camera.point(0.0, 0.0, -1.0),
                                                       camera.point(1.0, 1.0, 70.0),
                                                       {0.0, 0.0, 0.0},
                                                       {1e300, 0.0, 1e-300},
                                                       {0.0, kHole, 1.0}}),
                                          camera);
  EXPECT_EQ(image.depth_mm[2 * 8 + 3], 1500);
  EXPECT_EQ(image.depth_mm[5 * 8 + 7], 3000);
  EXPECT_EQ(pixels_seen(image), 2);
}

TEST(DepthImage, OfACloudOfHolesSeesNothing) {
  const DepthCamera camera = small_camera();
  PointCloud cloud = slanted_plane(camera);
  std::fill(cloud.points.begin(), cloud.points.end(), Eigen::Vector3d::Constant(kHole));
  const DepthImage image = depth_image_of(cloud, camera);
  EXPECT_EQ(image.depth_mm.size(), 48u);
  EXPECT_EQ(pixels_seen(image), 0);
}

TEST(DepthImage, ACloudWithAViewpointOfItsOwnIsRefused) {
  const DepthCamera camera = small_camera();
  PointCloud cloud = slanted_plane(camera);
  cloud.viewpoint.translation().z() = 1.2;
  EXPECT_THROW(depth_image_of(cloud, camera), Error);
  cloud.viewpoint = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  EXPECT_THROW(depth_image_of(cloud, camera), Error);
}

TEST(DepthImage, WhatIsNearerThanTheCamerasRangeIsNoise) {
  const DepthCamera camera = small_camera();  // from 0.3 m
  DepthImage image{.width = 5, .height = 1, .depth_mm = {0, 1, 299, 300, 9000}};
  remove_nearer_than_range(camera, image);
  EXPECT_EQ(image.depth_mm, (std::vector<std::uint16_t>{0, 0, 0, 300, 9000}));
}

}  // namespace
}  // namespace locograph
