#include <locograph/planners/scenario/camera_element.h>
#include <locograph/planners/scenario/effector_element.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace locograph {
namespace {

int read_pixels(const XmlFile& xml, const XmlFile::Element& camera, const char* name) {
  const double count = read_positive(xml, camera, name, DepthCamera::kMostPixels, 1.0);
  if (count == std::floor(count)) return static_cast<int>(count);
  throw xml.error(camera, std::string(name) + "=\"" + xml.attribute(camera, name) + "\"",
                  "a whole number of pixels");
}

ScenarioCamera read_camera(const XmlFile& xml, const XmlFile::Element& camera) {
  xml.allow(
      camera,
      {"name", "link", "position", "rpy", "width", "height", "fov_x", "range_min", "range_max"},
      {});
  ScenarioCamera read;
  const std::string name = xml.attribute(camera, "name");
  read.link = xml.attribute(camera, "link");
  read.line = camera.GetLineNum();
  const Eigen::Isometry3d link_from_body = read_pose(xml, camera);
  const int width = read_pixels(xml, camera, "width"), height = read_pixels(xml, camera, "height");
  const double fov = xml.number(camera, "fov_x");
  if (!(fov > 0.0 && fov < std::numbers::pi)) {
    throw xml.error(camera, "fov_x=\"" + xml.attribute(camera, "fov_x") + "\"",
                    "an angle between 0 and pi");
  }
  const double nearest = xml.number(camera, "range_min");
  const double farthest = read_size(xml, camera, "range_max");
  if (!(nearest >= 0.0 && nearest < farthest)) {
    throw xml.error(camera, "range_min=\"" + xml.attribute(camera, "range_min") + "\"",
                    "zero or more, less than range_max");
  }
  blame(xml, camera, [&] {
    read.camera = depth_camera(name, 0, width, height, fov);
    read.camera.range_min_m = nearest;
    read.camera.range_max_m = farthest;
    read.camera.link_from_optical = link_from_body * body_from_optical();
    read.camera.validate();
  });
  return read;
}

}  // namespace

std::vector<ScenarioCamera> read_cameras(const XmlFile& xml, const XmlFile::Element& robot) {
  std::vector<ScenarioCamera> cameras;
  std::set<std::string> names;
  for (const XmlFile::Element& element : xml.children(robot, "camera")) {
    ScenarioCamera camera = read_camera(xml, element);
    if (!names.insert(camera.camera.name).second) {
      throw xml.error(element, "a second camera '" + camera.camera.name + "'", "each name once");
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace locograph
