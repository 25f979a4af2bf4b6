#include <locograph/common/error.h>
#include <locograph/world/perception/depth_camera.h>

#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace locograph {
namespace {

/// Between the centre of an image and the edge of its last pixel lie pixels / 2.
double focal_length(int pixels, double fov_rad) { return 0.5 * pixels / std::tan(0.5 * fov_rad); }

}  // namespace

void DepthCamera::validate() const {
  const auto require = [&](bool good, const std::string& what, const std::string& expected) {
    if (!good) throw Error("camera '" + name + "': " + what, expected);
  };
  require(!name.empty(), "no name", "one");
  require(link >= 0, "link " + std::to_string(link), "a link of the robot");
  require(width >= 1 && width <= kMostPixels && height >= 1 && height <= kMostPixels,
          std::to_string(width) + " x " + std::to_string(height) + " pixels",
          "1 to " + std::to_string(kMostPixels) + " each way");
  require(fx > 0.0 && fy > 0.0 && std::isfinite(fx) && std::isfinite(fy),
          "focal lengths of " + std::to_string(fx) + " and " + std::to_string(fy) + " pixels",
          "positive numbers");
  require(std::isfinite(cx) && std::isfinite(cy), "no finite optical centre", "pixels");
  require(
      range_min_m >= 0.0 && range_min_m < range_max_m && std::isfinite(range_max_m),
      "depths from " + std::to_string(range_min_m) + " to " + std::to_string(range_max_m) + " m",
      "the first zero or more, and less than the second");
  const Eigen::Matrix3d rotation = link_from_optical.linear();
  require(link_from_optical.matrix().allFinite() && rotation.isUnitary(1e-6) &&
              rotation.determinant() > 0.0,
          "its place on the link is no pose", "a rotation and finite coordinates");
}

DepthCamera depth_camera(std::string name, int link, int width, int height, double fov_x_rad) {
  if (!(fov_x_rad > 0.0 && fov_x_rad < std::numbers::pi)) {
    throw Error("camera '" + name + "' sees " + std::to_string(fov_x_rad) + " rad",
                "an angle between 0 and pi");
  }
  DepthCamera camera;
  camera.name = std::move(name);
  camera.link = link;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_length(width, fov_x_rad);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  camera.validate();
  return camera;
}

Eigen::Isometry3d body_from_optical() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return pose;
}

std::vector<DepthCamera> cameras_of(const Robot& robot) {
  constexpr std::string_view kOptical = "_depth_optical_frame";
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::vector<DepthCamera> cameras;
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    const std::string& name = robot.links()[link].name;
    if (!name.ends_with(kOptical) || name.size() == kOptical.size()) continue;
    DepthCamera camera = depth_camera(name.substr(0, name.size() - kOptical.size()),
                                      static_cast<int>(link), 640, 480, 87.0 * kDegree);
    camera.fy = focal_length(camera.height, 58.0 * kDegree);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace locograph
