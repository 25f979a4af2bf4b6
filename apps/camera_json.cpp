#include <locograph/apps/camera_json.h>

#include <cmath>

namespace locograph {

Json camera_json(const DepthCamera& camera, const std::string& link) {
  const auto vector = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  const auto angle = [](int pixels, double focal) { return 2.0 * std::atan(0.5 * pixels / focal); };
  const Eigen::Isometry3d& pose = camera.link_from_optical;
  return {{"name", camera.name},
          {"link", link},
          {"position_m", vector(pose.translation())},
          {"forward", vector(pose.linear().col(2))},
          {"up", vector(-pose.linear().col(1))},
          {"width", camera.width},
          {"height", camera.height},
          {"fov_x_rad", angle(camera.width, camera.fx)},
          {"fov_y_rad", angle(camera.height, camera.fy)},
          {"range_min_m", camera.range_min_m},
          {"range_max_m", camera.range_max_m}};
}

}  // namespace locograph
