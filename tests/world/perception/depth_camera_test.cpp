#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/depth_camera.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

namespace locograph {
namespace {

TEST(DepthCamera, SeesItsAngleBetweenTheOuterEdgesOfItsImage) {
  const DepthCamera camera = depth_camera("head", 2, 640, 480, 1.2);
  EXPECT_EQ(camera.name, "head");
  EXPECT_EQ(camera.link, 2);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_EQ(camera.fx, camera.fy);
  const Eigen::Vector3d left = camera.point(-0.5, 239.5, 1.0),
                        right = camera.point(639.5, 0.0, 1.0);
  EXPECT_NEAR(std::atan(right.x()) - std::atan(left.x()), 1.2, 1e-12);
  EXPECT_EQ(left.y(), 0.0);
  EXPECT_LT(right.y(), 0.0) << "the first row is up, and y is down";
}

TEST(DepthCamera, LooksAlongTheForwardAxisOfItsBody) {
  const Eigen::Matrix3d body = body_from_optical().linear();
  EXPECT_EQ(Eigen::Vector3d(body.col(2)), Eigen::Vector3d::UnitX());
  EXPECT_EQ(Eigen::Vector3d(body.col(0)), Eigen::Vector3d(0, -1, 0)) << "x is right";
  EXPECT_EQ(Eigen::Vector3d(body.col(1)), Eigen::Vector3d(0, 0, -1)) << "y is down";
}

TEST(DepthCamera, OneThatCannotBeIsAnError) {
  for (const double fov : {0.0, -1.0, std::numbers::pi, 7.0, std::nan("")}) {
    EXPECT_THROW(depth_camera("a", 0, 64, 48, fov), Error) << fov;
  }
  EXPECT_THROW(depth_camera("", 0, 64, 48, 1.0), Error);
  EXPECT_THROW(depth_camera("a", -1, 64, 48, 1.0), Error);
  EXPECT_THROW(depth_camera("a", 0, 0, 48, 1.0), Error);
  EXPECT_THROW(depth_camera("a", 0, 64, 4097, 1.0), Error);
  const auto refused = [](auto&& change) {
    DepthCamera camera = depth_camera("a", 0, 64, 48, 1.0);
    change(camera);
    EXPECT_THROW(camera.validate(), Error);
  };
  const double infinity = std::numeric_limits<double>::infinity();
  refused([](DepthCamera& c) { c.fx = 0.0; });
  refused([&](DepthCamera& c) { c.fy = infinity; });
  refused([](DepthCamera& c) { c.cx = std::nan(""); });
  refused([](DepthCamera& c) { c.range_min_m = 6.0; });
  refused([](DepthCamera& c) { c.range_min_m = -0.1; });
  refused([&](DepthCamera& c) { c.range_max_m = infinity; });
  refused([](DepthCamera& c) { c.link_from_optical.linear() *= 2.0; });
  refused([](DepthCamera& c) { c.link_from_optical.linear().col(0) *= -1.0; });
  refused([](DepthCamera& c) { c.link_from_optical.translation().x() = std::nan(""); });
}

TEST(DepthCamera, CentauroHasOneOnItsHeadAndOneOnItsPelvis) {
  const auto models = std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models";
  const Robot centauro =
      Robot::load(models / "centauro/centauro.urdf", models / "centauro/centauro.srdf");
  const std::vector<DepthCamera> cameras = cameras_of(centauro);
  ASSERT_EQ(cameras.size(), 2u);
  std::vector<std::string> names = {cameras[0].name, cameras[1].name};
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"D435_head_camera", "D435i_camera"}));
  for (const DepthCamera& camera : cameras) {
    camera.validate();
    EXPECT_EQ(centauro.links()[static_cast<std::size_t>(camera.link)].name,
              camera.name + "_depth_optical_frame");
    EXPECT_TRUE(camera.link_from_optical.matrix().isIdentity());
    const double degree = std::numbers::pi / 180.0;
    EXPECT_NEAR(2.0 * std::atan(320.0 / camera.fx), 87.0 * degree, 1e-12);
    EXPECT_NEAR(2.0 * std::atan(240.0 / camera.fy), 58.0 * degree, 1e-12);
  }
  EXPECT_TRUE(cameras_of(Robot::load(models / "go2/go2.urdf")).empty());
}

}  // namespace
}  // namespace locograph
