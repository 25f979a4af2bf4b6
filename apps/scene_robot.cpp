#include <locograph/apps/decimation.h>
#include <locograph/apps/packed.h>
#include <locograph/apps/robot_files.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/type_names.h>
#include <locograph/plugins/configuration/self_collision_shapes.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/robots/visual_model.h>

#include <algorithm>
#include <map>
#include <utility>

namespace locograph {
namespace {

constexpr std::size_t kMostTriangles = 60000;  // of all meshes of a page: 3 MB of it

/// Each mesh, or part of it, once.
class Meshes {
 public:
  int index(const std::filesystem::path& file, int part) {
    const auto [found, added] =
        index_.emplace(std::pair(file, part), static_cast<int>(all_.size()));
    if (added) all_.push_back({file.filename().string(), corners_of(file, part)});
    return found->second;
  }

  /// Those that are larger than others are drawn with fewer triangles.
  Json list() const {
    const std::size_t most = most_of_each();
    Json list = Json::array();
    for (const Mesh& mesh : all_) {
      std::vector<float> numbers;
      for (const Eigen::Vector3d& corner : decimated(mesh.corners, most)) {
        for (int i = 0; i < 3; ++i) numbers.push_back(static_cast<float>(corner[i]));
      }
      list.push_back({{"name", mesh.name}, {"triangles", packed_floats(numbers)}});
    }
    return list;
  }

 private:
  struct Mesh {
    std::string name;
    std::vector<Eigen::Vector3d> corners;
  };

  std::vector<Eigen::Vector3d> corners_of(const std::filesystem::path& file, int part) {
    if (part < 0) return mesh_triangles(file);
    std::vector<MeshPart>& parts = parts_[file];
    if (parts.empty()) parts = mesh_parts(file);
    return std::move(parts[static_cast<std::size_t>(part)].corners);  // asked for once
  }

  /// So that all of them together have no more than kMostTriangles.
  std::size_t most_of_each() const {
    std::vector<std::size_t> sizes;
    for (const Mesh& mesh : all_) sizes.push_back(mesh.corners.size() / 3);
    std::sort(sizes.begin(), sizes.end());
    std::size_t left = kMostTriangles;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const std::size_t share = left / (sizes.size() - i);
      if (sizes[i] > share) return std::max<std::size_t>(share, 1);
      left -= sizes[i];
    }
    return kMostTriangles;
  }

  std::map<std::pair<std::filesystem::path, int>, int> index_;
  std::map<std::filesystem::path, std::vector<MeshPart>> parts_;
  std::vector<Mesh> all_;
};

Json shape_json(const VisualShape& shape, Meshes& meshes) {
  Json json = {{"type", type_name(shape.type)}, {"pose", pose_json(shape.link_from_shape)}};
  switch (shape.type) {
    case ShapeType::kCapsule:
    case ShapeType::kCylinder:
      json["length"] = shape.length;
      [[fallthrough]];
    case ShapeType::kSphere:
      json["radius"] = shape.radius;
      break;
    case ShapeType::kBox:
      json["size"] = vector_json(shape.size);
      break;
    case ShapeType::kMesh:
      json["mesh"] = meshes.index(shape.mesh_file, shape.mesh_part);
      json["scale"] = vector_json(shape.size);
      break;
  }
  json["color"] = {rounded(shape.color[0]), rounded(shape.color[1]), rounded(shape.color[2]),
                   rounded(shape.color[3])};
  return json;
}

Json joint_json(const Joint& joint) {
  Json json = {{"name", joint.name},
               {"type", type_name(joint.type)},
               {"parent", joint.parent_link},
               {"child", joint.child_link},
               {"origin", pose_json(joint.parent_from_joint)},
               {"axis", vector_json(joint.axis)},
               {"lower", limit_json(joint.lower)},
               {"upper", limit_json(joint.upper)},
               {"velocity", limit_json(joint.max_velocity)},
               {"effort", limit_json(joint.max_effort)},
               {"index", joint.index},
               {"frozen", joint.frozen_position}};
  if (joint.mimics >= 0) {
    json["mimics"] = joint.mimics;
    json["multiplier"] = joint.multiplier;
    json["offset"] = joint.offset;
  }
  return json;
}

}  // namespace

Json robot_scene(const Robot& robot) {
  const Eigen::Vector4d collision_color(0.95, 0.60, 0.20, 0.55);
  const std::vector<VisualShape> visuals = load_visuals(robot);
  Meshes meshes;
  Json links = Json::array(), joints = Json::array();
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    const Link& link = robot.links()[i];
    Json visual = Json::array(), collision = Json::array();
    for (const VisualShape& shape : visuals) {
      if (shape.link != static_cast<int>(i) || !shape.drawable()) continue;
      visual.push_back(shape_json(shape, meshes));
    }
    for (const CollisionShape& shape : link.collision) {
      const VisualShape drawn = as_visual(shape, collision_color);
      if (drawn.drawable()) collision.push_back(shape_json(drawn, meshes));
    }
    links.push_back({{"name", link.name},
                     {"mass", link.mass},
                     {"com", vector_json(link.com)},
                     {"visual", std::move(visual)},
                     {"collision", std::move(collision)}});
  }
  for (const Joint& joint : robot.joints()) joints.push_back(joint_json(joint));
  return {{"name", robot.name()},      {"floating_base", robot.floating_base()},
          {"links", std::move(links)}, {"joints", std::move(joints)},
          {"meshes", meshes.list()},   {"missing", missing_meshes(visuals)}};
}

Json capsule_scene(const Robot& robot) {
  Json scene = robot_scene(robot);
  scene["meshes"] = scene["missing"] = Json::array();
  for (Json& link : scene["links"]) link["visual"] = link["collision"] = Json::array();
  for (const CollisionCapsule& c :
       covering_capsules(robot, {.max_overshoot_m = kSelfOvershoot_m})) {
    scene["links"][c.link]["collision"].push_back(
        Json{{"type", type_name(ShapeType::kCapsule)},
             {"pose", pose_json(pose_between(c.capsule.from, c.capsule.to))},
             {"length", (c.capsule.to - c.capsule.from).norm()},
             {"radius", c.capsule.radius}});
  }
  return scene;
}

Json standing_scene(const std::string& urdf, const SceneOptions& options) {
  const std::filesystem::path srdf =
      options.srdf.empty() ? srdf_beside(urdf) : std::filesystem::path(options.srdf);
  RobotOptions robot_options;
  robot_options.lenient_srdf = true;
  const Robot robot = Robot::load(urdf, srdf, robot_options);
  std::string state = options.state;
  const std::vector<std::string> states = robot.configuration_names();
  for (const char* usual : {"home", "standing"}) {
    const bool known = std::find(states.begin(), states.end(), usual) != states.end();
    if (state.empty() && known) state = usual;
  }
  if (state.empty() && !states.empty()) state = states.front();
  Eigen::VectorXd q =
      state.empty() ? robot.neutral_configuration() : robot.named_configuration(state);
  q[2] -= lowest_point(robot, q);
  std::vector<float> numbers;
  for (const double value : q) numbers.push_back(static_cast<float>(value));
  const std::string title =
      std::filesystem::path(urdf).filename().string() + (state.empty() ? "" : ", " + state);
  return {{"version", 1},
          {"kind", "plan"},
          {"title", title},
          {"robot", options.capsules ? capsule_scene(robot) : robot_scene(robot)},
          {"plan",
           {{"times", {0.0}},
            {"configurations", packed_floats(numbers)},
            {"configuration_size", q.size()},
            {"ids", {0}}}}};
}

}  // namespace locograph
