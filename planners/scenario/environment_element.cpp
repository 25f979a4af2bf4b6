#include <locograph/planners/scenario/effector_element.h>
#include <locograph/planners/scenario/environment_element.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace locograph {
namespace {

using Element = XmlFile::Element;

/// x laid into the surface, z where the normal is along x.
Eigen::Vector3d forward_in(const Eigen::Vector3d& normal) {
  constexpr double kAlong = 1e-6;
  const Eigen::Vector3d n = normal.stableNormalized();
  return n.tail<2>().norm() > kAlong ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
}

/// `count` sizes in one attribute.
std::vector<double> read_sizes(const XmlFile& xml, const Element& element, const char* name,
                               int count) {
  std::vector<double> sizes = xml.numbers(element, name, count);
  for (const double size : sizes) {
    if (size >= ranges::kLeastSize_m && size <= ranges::kMostSize_m) continue;
    throw xml.error(element, std::string(name) + "=\"" + xml.attribute(element, name) + "\"",
                    "numbers from 1e-06 to 1e+06");
  }
  return sizes;
}

class EnvironmentReader {
 public:
  explicit EnvironmentReader(const XmlFile& xml) : xml_(xml) {}

  Environment read(const Element& element) {
    xml_.allow(element, {"map", "obstacles", "friction"},
               {"plane", "box", "rung", "mesh", "cloud", "octomap"});
    if (element.Attribute("friction") != nullptr) {
      environment_.friction = read_positive(xml_, element, "friction", ranges::kFriction);
    }
    if (element.Attribute("map") != nullptr) environment_.map = xml_.attribute(element, "map");
    if (element.Attribute("obstacles") != nullptr) {
      environment_.obstacles = xml_.attribute(element, "obstacles");
    }
    for (const Element& child : xml_.children(element)) {
      const std::string kind = child.Name();
      if (kind == "plane") read_plane(child);
      if (kind == "box") read_box(child);
      if (kind == "rung") read_rung(child);
      if (kind == "mesh") read_mesh(child);
      if (kind == "cloud") read_cloud(child);
      if (kind == "octomap") read_octomap(child);
    }
    return std::move(environment_);
  }

 private:
  void read_plane(const Element& plane) {
    xml_.allow(plane, {"name", "center", "normal", "forward", "size", "friction"}, {});
    Surface surface;
    surface.name = read_name(plane);
    surface.friction = read_friction(plane);
    const Eigen::Vector3d normal = read_vector(xml_, plane, "normal");
    const Eigen::Vector3d forward = plane.Attribute("forward") != nullptr
                                        ? read_vector(xml_, plane, "forward")
                                        : forward_in(normal);
    blame(xml_, plane, [&] {
      surface.world_from_surface.linear() = contact_axes("plane " + surface.name, normal, forward);
    });
    surface.world_from_surface.translation() = read_vector(xml_, plane, "center");
    const std::vector<double> size = read_sizes(xml_, plane, "size", 2);
    surface.half_x_m = 0.5 * size[0];
    surface.half_y_m = 0.5 * size[1];
    environment_.surfaces.push_back(std::move(surface));
  }

  void read_box(const Element& box) {
    xml_.allow(box, {"name", "center", "size", "rpy", "friction"}, {});
    const std::string name = read_name(box);
    const double friction = read_friction(box);
    Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();
    world_from_box.translation() = read_vector(xml_, box, "center");
    world_from_box.linear() = read_rotation(xml_, box);
    const std::vector<double> size = read_sizes(xml_, box, "size", 3);
    const Eigen::Vector3d half(0.5 * size[0], 0.5 * size[1], 0.5 * size[2]);
    environment_.solids.push_back({name, world_from_box, 2.0 * half});
    const auto add_face = [&](const char* side, const Eigen::Vector3d& normal) {
      Surface face;
      face.name = name + " " + side;
      require_unique(box, face.name);
      face.friction = friction;
      Eigen::Isometry3d box_from_face = Eigen::Isometry3d::Identity();
      box_from_face.linear() = contact_axes(face.name, normal, forward_in(normal));
      box_from_face.translation() = half.cwiseProduct(normal);
      face.world_from_surface = world_from_box * box_from_face;
      face.half_x_m = half.dot(box_from_face.linear().col(0).cwiseAbs());
      face.half_y_m = half.dot(box_from_face.linear().col(1).cwiseAbs());
      environment_.surfaces.push_back(std::move(face));
    };
    add_face("top", Eigen::Vector3d::UnitZ());
    add_face("bottom", -Eigen::Vector3d::UnitZ());
    add_face("front", Eigen::Vector3d::UnitX());
    add_face("back", -Eigen::Vector3d::UnitX());
    add_face("left", Eigen::Vector3d::UnitY());
    add_face("right", -Eigen::Vector3d::UnitY());
  }

  void read_rung(const Element& rung) {
    xml_.allow(rung, {"name", "from", "to", "radius", "friction"}, {});
    Bar bar;
    bar.name = read_name(rung);
    bar.friction = read_friction(rung);
    bar.from = read_vector(xml_, rung, "from");
    bar.to = read_vector(xml_, rung, "to");
    bar.radius_m = read_size(xml_, rung, "radius");
    if (!((bar.to - bar.from).norm() >= ranges::kLeastSize_m)) {
      throw xml_.error(rung, "rung " + bar.name + " ends where it begins", "two places");
    }
    environment_.bars.push_back(std::move(bar));
  }

  void read_mesh(const Element& mesh) {
    xml_.allow(mesh, {"name", "file", "position", "rpy", "scale", "friction"}, {});
    ScannedSurface& scanned = read_scanned(mesh, ScannedSurface::Kind::kMesh);
    scanned.world_from_mesh = read_pose(xml_, mesh);
    if (mesh.Attribute("scale") != nullptr) scanned.scale = read_size(xml_, mesh, "scale");
  }

  void read_cloud(const Element& cloud) {
    xml_.allow(cloud, {"name", "file", "voxel", "friction"}, {});
    ScannedSurface& scanned = read_scanned(cloud, ScannedSurface::Kind::kCloud);
    if (cloud.Attribute("voxel") == nullptr) return;
    scanned.voxel_m =
        read_positive(xml_, cloud, "voxel", ranges::kMostVoxel_m, ranges::kLeastVoxel_m);
  }

  void read_octomap(const Element& octomap) {
    xml_.allow(octomap, {"name", "file", "friction"}, {});
    read_scanned(octomap, ScannedSurface::Kind::kOctomap);
  }

  ScannedSurface& read_scanned(const Element& element, ScannedSurface::Kind kind) {
    ScannedSurface scanned;
    scanned.kind = kind;
    scanned.name = read_name(element);
    scanned.file = xml_.attribute(element, "file");
    scanned.friction = read_friction(element);
    scanned.line = element.GetLineNum();
    return environment_.scanned.emplace_back(std::move(scanned));
  }

  std::string read_name(const Element& element) {
    std::string name = xml_.attribute(element, "name");
    require_unique(element, name);
    return name;
  }

  void require_unique(const Element& element, const std::string& name) {
    if (names_.insert(name).second) return;
    throw xml_.error(element, "a second '" + name + "' in the environment", "each name once");
  }

  /// 0: none of its own.
  double read_friction(const Element& element) {
    if (element.Attribute("friction") != nullptr) {
      return read_positive(xml_, element, "friction", ranges::kFriction);
    }
    if (environment_.without_friction == nullptr) environment_.without_friction = &element;
    return 0.0;
  }

  const XmlFile& xml_;
  Environment environment_;
  std::set<std::string> names_;
};

}  // namespace

Environment read_environment(const XmlFile& xml, const Element& environment) {
  return EnvironmentReader(xml).read(environment);
}

bool has_places(const Environment& environment) {
  return !environment.surfaces.empty() || !environment.bars.empty() || !environment.scanned.empty();
}

std::optional<double> effector_friction(const XmlFile& xml, const Environment& environment) {
  if (environment.friction) return environment.friction;
  if (!has_places(environment)) return std::nullopt;
  if (const Element* element = environment.without_friction) {
    throw xml.error(*element,
                    "the friction of '" + xml.attribute(*element, "name") + "' is not known",
                    "friction=\"…\" here or of the <environment>");
  }
  double most = 0.0;
  for (const Surface& surface : environment.surfaces) most = std::max(most, surface.friction);
  for (const Bar& bar : environment.bars) most = std::max(most, bar.friction);
  for (const ScannedSurface& scanned : environment.scanned) most = std::max(most, scanned.friction);
  return most;
}

}  // namespace locograph
