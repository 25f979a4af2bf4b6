#include <locograph/apps/camera_json.h>
#include <locograph/apps/describe.h>
#include <locograph/apps/margin_json.h>
#include <locograph/common/data_folder.h>
#include <locograph/planners/scenario/contacts_file.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/robots/contact_kinds.h>

namespace locograph {
namespace {

const char* kind_name(ScannedSurface::Kind kind) {
  if (kind == ScannedSurface::Kind::kMesh) return "mesh";
  return kind == ScannedSurface::Kind::kCloud ? "cloud" : "octomap";
}

Json direction_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// What it can bear, and where it is on the robot.
Json effector_json(const EndEffector& effector) {
  Json json = {{"name", effector.name.empty() ? effector.link : effector.name},
               {"link", effector.link},
               {"touches_as", contact_kind_name(effector.kind)}};
  for (const EffectorField& field : contact_kind_entry(effector.kind).fields) {
    const double value = effector.*field.value;
    const bool left_out = field.zero == EffectorField::Zero::kWhenLeftOut && value == 0.0;
    if (left_out || field.value == &EndEffector::max_force_N) continue;
    const std::string unit = field.unit;
    json[field.attribute + (unit.empty() ? "" : "_" + unit)] = value;
  }
  json["max_force_N"] = effector.max_force_N;
  return json;
}

Json drive_json(const DriveTask& drive) {
  return {{"distance_m", drive.distance_m},
          {"curvature_1_m", drive.curvature_1_m},
          {"speed_m_s", drive.speed_m_s},
          {"configurations", drive.configurations}};
}

/// Where an end effector touches.
Json contact_json(const Contact& contact) {
  return {{"end_effector", contact.name()},
          {"position_m", direction_json(contact.position)},
          {"normal", direction_json(contact.normal)},
          {"forward", contact.forward ? direction_json(*contact.forward) : Json(nullptr)}};
}

Json stance_json(const Stance& stance) {
  Json contacts = Json::array();
  for (const Contact& contact : stance.contacts) contacts.push_back(contact_json(contact));
  return contacts;
}

Json task_json(const ContactTask& task) {
  Json base = nullptr, joints = Json::object(), goals = Json::array();
  if (task.base) base = std::vector<double>(task.base->begin(), task.base->end());
  for (const auto& [name, position, line] : task.joints) joints[name] = position;
  for (const Stance& goal : task.goals)
    goals.push_back(Json::object({{"contacts", stance_json(goal)}}));
  return {{"start", {{"base", base}, {"joints", joints}, {"contacts", stance_json(task.start)}}},
          {"goals", std::move(goals)}};
}

/// null: what the end effector says.
Json friction_json(double friction) { return friction > 0.0 ? Json(friction) : Json(nullptr); }

Json surface_json(const Surface& surface) {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  return {{"name", surface.name},
          {"center_m", direction_json(pose.translation())},
          {"normal", direction_json(pose.linear().col(2))},
          {"forward", direction_json(pose.linear().col(0))},
          {"size_m", {2.0 * surface.half_x_m, 2.0 * surface.half_y_m}},
          {"friction", friction_json(surface.friction)}};
}

Json bar_json(const Bar& bar) {
  return {{"name", bar.name},
          {"from_m", direction_json(bar.from)},
          {"to_m", direction_json(bar.to)},
          {"radius_m", bar.radius_m},
          {"friction", friction_json(bar.friction)}};
}

/// The file, null if none is named; what is not there is added to missing.
Json file_json(const std::filesystem::path& file, Json& missing) {
  if (file.empty()) return nullptr;
  std::error_code too_long;
  if (!std::filesystem::exists(file, too_long)) missing.push_back(file.string());
  return file.string();
}

Json scanned_json(const ScannedSurface& scanned, Json& missing) {
  return {{"name", scanned.name},
          {"kind", kind_name(scanned.kind)},
          {"file", file_json(scanned.file, missing)},
          {"friction", friction_json(scanned.friction)}};
}

}  // namespace

Json describe_scenario(const std::filesystem::path& path) {
  const Scenario scenario = load_scenario(path.string(), data_folder());
  Json missing = Json::array(), effectors = Json::array();
  Json surfaces = Json::array(), bars = Json::array(), scanned = Json::array();
  for (const EndEffector& effector : scenario.end_effectors) {
    effectors.push_back(effector_json(effector));
  }
  Json json = {{"file", path.string()},
               {"kind", "scenario"},
               {"name", scenario.name},
               {"task", scenario.drive ? "drive" : "contacts"}};
  if (scenario.drive) json["drive"] = drive_json(*scenario.drive);
  if (scenario.contacts) json["contacts"] = task_json(*scenario.contacts);
  json["robot"] = {{"urdf", file_json(scenario.urdf, missing)},
                   {"srdf", file_json(scenario.srdf, missing)},
                   {"state", scenario.start_state},
                   {"effort_scale", scenario.effort_scale}};
  json["cameras"] = Json::array();
  for (const ScenarioCamera& one : scenario.cameras) {
    json["cameras"].push_back(camera_json(one.camera, one.link));
  }
  json["end_effectors"] = std::move(effectors);
  json["limits"] = {{"base_linear_m_s", scenario.limits.base_linear_m_s},
                    {"base_angular_rad_s", scenario.limits.base_angular_rad_s},
                    {"joint_acceleration_rad_s2", scenario.limits.joint_acceleration_rad_s2}};
  json["torque_limits"] = scenario.enforce_torque_limits ? "enforce" : "report";
  json["execution_margin"] = margin_json(scenario.margin);
  for (const Surface& surface : scenario.surfaces) surfaces.push_back(surface_json(surface));
  for (const Bar& bar : scenario.bars) bars.push_back(bar_json(bar));
  for (const ScannedSurface& one : scenario.scanned) {
    scanned.push_back(scanned_json(one, missing));
  }
  json["surfaces"] = std::move(surfaces);
  json["bars"] = std::move(bars);
  json["scanned"] = std::move(scanned);
  json["map"] = file_json(scenario.map, missing);
  json["obstacles"] = file_json(scenario.obstacles, missing);
  json["missing_files"] = std::move(missing);
  return json;
}

Json describe_contacts(const std::filesystem::path& path) {
  Json contacts = Json::array();
  for (const Contact& contact : load_contacts(path).contacts) {
    Json json = effector_json(contact.effector);
    json["position_m"] = direction_json(contact.position);
    json["normal"] = direction_json(contact.normal);
    json["forward"] = contact.forward ? direction_json(*contact.forward) : Json(nullptr);
    json["bears_load"] = contact.bears_load;
    contacts.push_back(std::move(json));
  }
  return {{"file", path.string()},
          {"kind", "contacts"},
          {"count", contacts.size()},
          {"contacts", std::move(contacts)}};
}

}  // namespace locograph
