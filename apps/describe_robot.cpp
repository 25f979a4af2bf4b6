#include <locograph/apps/describe.h>
#include <locograph/apps/type_names.h>

namespace locograph {
namespace {

Json joint_json(const Joint& joint) {
  return {{"type", type_name(joint.type)},
          {"lower", limit_json(joint.lower)},
          {"upper", limit_json(joint.upper)},
          {"max_velocity", limit_json(joint.max_velocity)},
          {"max_effort", limit_json(joint.max_effort)},
          {"units", joint.type == JointType::kPrismatic ? "m, m/s, N" : "rad, rad/s, Nm"}};
}

}  // namespace

Json describe_robot(const std::filesystem::path& path) {
  std::filesystem::path srdf = path;
  srdf.replace_extension(".srdf");
  if (!std::filesystem::exists(srdf)) srdf.clear();
  RobotOptions options;
  options.lenient_srdf = true;
  const Robot robot = Robot::load(path, srdf, options);

  int shapes = 0;
  for (const Link& link : robot.links()) shapes += static_cast<int>(link.collision.size());
  Json json = {
      {"file", path.string()},
      {"kind", "robot"},
      {"name", robot.name()},
      {"links", robot.links().size()},
      {"joints", robot.joints().size()},
      {"movable_joints", robot.active_joint_count()},
      {"root_link", robot.links()[robot.root_link()].name},
      {"mass_kg", robot.total_mass()},
      {"collision_shapes", shapes},
      {"missing_meshes", robot.missing_meshes()},
  };
  json["srdf"] = srdf.empty() ? Json(nullptr) : Json(srdf.string());
  if (!srdf.empty()) {
    json["groups"] = robot.group_names();
    json["configurations"] = robot.configuration_names();
    json["names_unknown_to_the_urdf"] = robot.warnings();
  }
  json["self_collision_pairs"] = robot.self_collision_pairs().size();
  Json limits = Json::object();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    limits[robot.active_joint(i).name] = joint_json(robot.active_joint(i));
  }
  json["limits"] = limits;
  return json;
}

}  // namespace locograph
