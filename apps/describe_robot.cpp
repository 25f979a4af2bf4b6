#include <locograph/apps/camera_json.h>
#include <locograph/apps/describe.h>
#include <locograph/apps/robot_files.h>
#include <locograph/apps/type_names.h>
#include <locograph/plugins/configuration/self_collision_shapes.h>
#include <locograph/plugins/configuration/sphere_overshoot.h>
#include <locograph/robots/approximation.h>
#include <locograph/world/left_out_pairs.h>

#include <cmath>
#include <string>
#include <vector>

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

/// To the micrometre.
double millimetres(double metres) { return 1e-3 * std::round(1e6 * metres); }

/// Link by link, the shapes that the distance edges see in place of the URDF's.
Json approximation_json(const Robot& robot) {
  Json links = Json::object();
  for (const LinkApproximation& link :
       approximations(robot, kSphereOvershoot_m, {.max_overshoot_m = kSelfOvershoot_m})) {
    Json& json = links[robot.links()[link.link].name];
    json["shapes"] = link.shapes;
    if (!link.unusable.empty()) {
      json["unusable"] = link.unusable;
      continue;
    }
    json["spheres"] = link.spheres.count;
    json["spheres_over_mm"] = millimetres(link.spheres.worst_over_m);
    json["spheres_under_mm"] = millimetres(link.spheres.worst_under_m);
    json["capsules"] = link.capsules.count;
    json["capsules_over_mm"] = millimetres(link.capsules.worst_over_m);
    json["capsules_under_mm"] = millimetres(link.capsules.worst_under_m);
  }
  return links;
}

}  // namespace

Json describe_robot(const std::filesystem::path& path) {
  const std::filesystem::path srdf = srdf_beside(path);
  RobotOptions options;
  options.lenient_srdf = true;
  Robot robot = Robot::load(path, srdf, options);
  try {
    leave_out_overlapping(robot);
  } catch (const Error&) {
    // A mesh that cannot be read: told with the approximation.
  }

  int elements = 0, shapes = 0;
  for (const Link& link : robot.links()) {
    elements += link.collision_elements;
    shapes += static_cast<int>(link.collision.size());
  }
  Json json = {
      {"file", path.string()},
      {"kind", "robot"},
      {"name", robot.name()},
      {"links", robot.links().size()},
      {"joints", robot.joints().size()},
      {"movable_joints", robot.active_joint_count()},
      {"root_link", robot.links()[robot.root_link()].name},
      {"mass_kg", robot.total_mass()},
      {"collision_elements", elements},
      {"collision_shapes", shapes},
      {"links_without_collision", robot.links_without_collision()},
      {"missing_meshes", robot.missing_meshes()},
  };
  json["srdf"] = srdf.empty() ? Json(nullptr) : Json(srdf.string());
  if (!srdf.empty()) {
    json["groups"] = robot.group_names();
    json["configurations"] = robot.configuration_names();
    json["names_unknown_to_the_urdf"] = robot.warnings();
  }
  json["self_collision_pairs"] = robot.self_collision_pairs().size();
  json["left_out_pairs"] = robot.left_out_pairs().size();
  json["cameras"] = Json::array();
  for (const DepthCamera& camera : cameras_of(robot)) {
    json["cameras"].push_back(
        camera_json(camera, robot.links()[static_cast<std::size_t>(camera.link)].name));
  }
  Json limits = Json::object();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    limits[robot.active_joint(i).name] = joint_json(robot.active_joint(i));
  }
  json["limits"] = limits;
  Json mimics = Json::object();
  for (const Joint& joint : robot.joints()) {
    if (joint.mimics < 0) continue;
    mimics[joint.name] = {{"leader", robot.joints()[static_cast<std::size_t>(joint.mimics)].name},
                          {"multiplier", joint.multiplier},
                          {"offset", joint.offset}};
  }
  if (!mimics.empty()) json["mimic_joints"] = mimics;
  std::vector<std::string> warnings = robot.urdf_warnings();
  if (!robot.has_collision_shapes()) {
    warnings.push_back(path.string() +
                       ": no link has a <collision>: distances cannot be judged, so that nothing "
                       "is feasible");
  }
  if (!warnings.empty()) json["warnings"] = warnings;
  json["approximation"] = approximation_json(robot);
  return json;
}

}  // namespace locograph
