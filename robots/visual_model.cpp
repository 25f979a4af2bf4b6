#include <locograph/common/error.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/urdf_reader.h>
#include <locograph/robots/visual_model.h>
#include <locograph/robots/xml_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace locograph {
namespace {

using Element = XmlFile::Element;

const Eigen::Vector4d kGrey(0.72, 0.74, 0.77, 1.0);
const Eigen::Vector4d kBone(0.45, 0.50, 0.58, 1.0);
constexpr double kBoneRadius_m = 0.02;

/// Colours by material name: what the robot defines counts before what a visual defines.
using Materials = std::map<std::string, Eigen::Vector4d>;

const Element* color_of(const Element& material) { return material.FirstChildElement("color"); }

Eigen::Vector4d read_color(const XmlFile& xml, const Element& color) {
  const std::vector<double> rgba = xml.numbers(color, "rgba", 4);
  for (const double value : rgba) {
    if (value < 0.0 || value > 1.0) {
      throw xml.error(color, std::string("<color> with rgba=\"") + color.Attribute("rgba") + "\"",
                      "four numbers from 0 to 1");
    }
  }
  return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

void collect(const XmlFile& xml, const Element& parent, Materials& materials) {
  for (const Element& material : xml.children(parent, "material")) {
    const char* name = material.Attribute("name");
    if (name == nullptr || *name == '\0' || color_of(material) == nullptr) continue;
    materials.emplace(name, read_color(xml, *color_of(material)));
  }
}

Materials read_materials(const XmlFile& xml) {
  Materials materials;
  collect(xml, xml.root(), materials);
  for (const Element& link : xml.children(xml.root(), "link")) {
    for (const Element& visual : xml.children(link, "visual")) collect(xml, visual, materials);
  }
  return materials;
}

Eigen::Vector4d visual_color(const XmlFile& xml, const Element& visual,
                             const Materials& materials) {
  const Element* material = visual.FirstChildElement("material");
  if (material == nullptr) return kGrey;
  if (const Element* color = color_of(*material)) return read_color(xml, *color);
  const char* name = material->Attribute("name");
  const auto found = materials.find(name == nullptr ? "" : name);
  return found == materials.end() ? kGrey : found->second;
}

Eigen::Isometry3d read_origin(const XmlFile& xml, const Element& visual) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Element* origin = visual.FirstChildElement("origin");
  if (origin == nullptr) return pose;
  if (origin->Attribute("xyz") != nullptr) {
    const std::vector<double> xyz = xml.numbers(*origin, "xyz", 3);
    pose.translation() << xyz[0], xyz[1], xyz[2];
  }
  if (origin->Attribute("rpy") != nullptr) {
    const std::vector<double> rpy = xml.numbers(*origin, "rpy", 3);
    pose.linear() = (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  }
  return pose;
}

bool can_be_read(const std::filesystem::path& mesh_file) {
  if (!is_mesh_file(mesh_file)) return false;
  try {
    mesh_parts(mesh_file);
    return true;
  } catch (const Error&) {
    return false;
  }
}

VisualShape read_visual(const XmlFile& xml, const Element& visual, int link,
                        const Materials& materials, const std::filesystem::path& urdf) {
  VisualShape shape;
  shape.link = link;
  shape.link_from_shape = read_origin(xml, visual);
  shape.color = visual_color(xml, visual, materials);
  const Element* geometry = visual.FirstChildElement("geometry");
  const Element* kind = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  const std::string name = kind == nullptr ? "" : kind->Name();
  if (name == "sphere" || name == "cylinder") {
    shape.type = name == "sphere" ? ShapeType::kSphere : ShapeType::kCylinder;
    shape.radius = xml.numbers(*kind, "radius", 1)[0];
    if (name == "cylinder") shape.length = xml.numbers(*kind, "length", 1)[0];
  } else if (name == "box" || name == "mesh") {
    shape.type = name == "box" ? ShapeType::kBox : ShapeType::kMesh;
    const char* size = name == "box" ? "size" : "scale";
    if (name == "box" || kind->Attribute(size) != nullptr) {
      const std::vector<double> xyz = xml.numbers(*kind, size, 3);
      shape.size << xyz[0], xyz[1], xyz[2];
    }
  } else {
    throw xml.error(visual, "<visual> without geometry", "sphere, cylinder, box or mesh");
  }
  shape.has_color = visual.FirstChildElement("material") != nullptr;
  if (name == "mesh") {
    const std::string reference = xml.attribute(*kind, "filename");
    shape.mesh_file = find_mesh(reference, urdf);
    shape.mesh_found = can_be_read(shape.mesh_file);
    if (!shape.mesh_found) shape.mesh_file = reference;
  }
  return shape;
}

/// A mesh without a colour of the URDF's has those of its own materials.
void add_parts(VisualShape shape, std::vector<VisualShape>& shapes) {
  if (shape.type != ShapeType::kMesh || !shape.mesh_found || shape.has_color) {
    shapes.push_back(std::move(shape));
    return;
  }
  const std::vector<MeshPart> parts = mesh_parts(shape.mesh_file);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    shape.mesh_part = static_cast<int>(i);
    if (parts[i].color) shape.color = *parts[i].color;
    shapes.push_back(shape);
  }
}

/// From a link's origin to the joints below it; a small sphere where there is none.
void add_bones(const Robot& robot, int link, std::vector<VisualShape>& shapes) {
  VisualShape bone;
  bone.link = link;
  bone.radius = kBoneRadius_m;
  bone.color = kBone;
  const std::size_t before = shapes.size();
  for (const Joint& joint : robot.joints()) {
    if (joint.parent_link != link) continue;
    const Eigen::Vector3d end = joint.parent_from_joint.translation();
    if (end.norm() < kBoneRadius_m) continue;
    bone.type = ShapeType::kCapsule;
    bone.length = end.norm();
    bone.link_from_shape = pose_between(Eigen::Vector3d::Zero(), end);
    shapes.push_back(bone);
  }
  if (shapes.size() > before) return;
  bone.type = ShapeType::kSphere;
  bone.radius = 1.5 * kBoneRadius_m;
  bone.link_from_shape = Eigen::Isometry3d::Identity();
  shapes.push_back(bone);
}

/// color: of what it stands in for.
void add_stand_ins(const Robot& robot, int link, const Eigen::Vector4d& color,
                   std::vector<VisualShape>& shapes) {
  const std::size_t before = shapes.size();
  for (const CollisionShape& shape : robot.links()[static_cast<std::size_t>(link)].collision) {
    const VisualShape stand_in = as_visual(shape, color);
    if (stand_in.drawable()) shapes.push_back(stand_in);
  }
  if (shapes.size() == before) add_bones(robot, link, shapes);
}

}  // namespace

VisualShape as_visual(const CollisionShape& shape, const Eigen::Vector4d& color) {
  VisualShape result;
  result.link = shape.link;
  result.type = shape.type;
  result.link_from_shape = shape.link_from_shape;
  result.radius = shape.radius;
  result.length = shape.length;
  result.size = shape.size;
  result.color = color;
  result.mesh_file = shape.mesh_file;
  result.mesh_found = shape.mesh_found && is_mesh_file(shape.mesh_file);
  return result;
}

std::vector<VisualShape> load_visuals(const Robot& robot) {
  const XmlFile xml(robot.urdf_file(), "robot");
  const Materials materials = read_materials(xml);
  std::map<int, std::vector<VisualShape>> of_link;
  for (const Element& link : xml.children(xml.root(), "link")) {
    // The link above a floating joint at the root is not one of the robot's.
    const int index = robot.find_link(xml.attribute(link, "name"));
    if (index < 0) continue;
    std::vector<VisualShape>& shapes = of_link[index];
    for (const Element& visual : xml.children(link, "visual")) {
      add_parts(read_visual(xml, visual, index, materials, robot.urdf_file()), shapes);
    }
    const auto missing = std::find_if(shapes.begin(), shapes.end(),
                                      [](const VisualShape& s) { return !s.drawable(); });
    if (missing != shapes.end()) {
      add_stand_ins(robot, index, Eigen::Vector4d(missing->color), shapes);
    } else if (shapes.empty()) {
      // A link that only collides is drawn as what collides.
      const std::vector<CollisionShape>& collision =
          robot.links()[static_cast<std::size_t>(index)].collision;
      for (const CollisionShape& shape : collision) shapes.push_back(as_visual(shape, kGrey));
    }
  }
  std::vector<VisualShape> all;
  for (const auto& [link, shapes] : of_link) all.insert(all.end(), shapes.begin(), shapes.end());
  return all;
}

std::vector<std::string> missing_meshes(const std::vector<VisualShape>& shapes) {
  std::set<std::string> missing;
  for (const VisualShape& shape : shapes) {
    if (!shape.drawable()) missing.insert(shape.mesh_file.string());
  }
  return {missing.begin(), missing.end()};
}

double lowest_point(const VisualShape& shape, const Eigen::Isometry3d& world_from_link) {
  const Eigen::Isometry3d pose = world_from_link * shape.link_from_shape;
  const double z = pose.translation().z(), axis = std::abs(pose.linear()(2, 2));
  switch (shape.type) {
    case ShapeType::kSphere:
      return z - shape.radius;
    case ShapeType::kCapsule:
      return z - 0.5 * shape.length * axis - shape.radius;
    case ShapeType::kCylinder:
      return z - 0.5 * shape.length * axis -
             shape.radius * std::sqrt(std::max(0.0, 1.0 - axis * axis));
    case ShapeType::kBox:
      return z - 0.5 * pose.linear().row(2).cwiseAbs().dot(shape.size.transpose());
    case ShapeType::kMesh:
      break;
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : mesh_triangles(shape.mesh_file)) {  // of all parts
    lowest = std::min(lowest, (pose * shape.size.cwiseProduct(corner).eval()).z());
  }
  return lowest;
}

double lowest_point(const Robot& robot, const Eigen::VectorXd& q) {
  RobotState state(robot);
  state.update(q.data());
  double lowest = std::numeric_limits<double>::infinity();
  const auto lower = [&](const VisualShape& shape) {
    if (!shape.drawable()) return;
    lowest = std::min(lowest, lowest_point(shape, state.world_from_link(shape.link)));
  };
  for (const Link& link : robot.links()) {
    for (const CollisionShape& shape : link.collision) lower(as_visual(shape, kGrey));
  }
  if (std::isinf(lowest)) {
    for (const VisualShape& shape : load_visuals(robot)) lower(shape);
  }
  if (std::isfinite(lowest)) return lowest;
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    lowest = std::min(lowest, state.world_from_link(static_cast<int>(link)).translation().z());
  }
  return lowest;
}

Eigen::Isometry3d pose_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 0.5 * (from + to);
  const double length = (to - from).norm();
  if (length == 0.0) return pose;
  const Eigen::Vector3d z = (to - from) / length;
  // The shortest turn of e_z onto z is the quaternion (1 + e_z·z, e_z × z), normalised; upside down
  // every half turn is as short.
  const Eigen::Quaterniond turn = z.z() > -1.0 + 1e-12
                                      ? Eigen::Quaterniond(1.0 + z.z(), -z.y(), z.x(), 0.0)
                                      : Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  pose.linear() = turn.normalized().toRotationMatrix();
  return pose;
}

}  // namespace locograph
