#include <locograph/common/suggestion.h>
#include <locograph/planners/scenario/camera_element.h>
#include <locograph/planners/scenario/contact_task_element.h>
#include <locograph/planners/scenario/effector_element.h>
#include <locograph/planners/scenario/environment_element.h>
#include <locograph/planners/scenario/execution_element.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/shipped_robot.h>
#include <locograph/robots/xml_file.h>
#include <locograph/world/octree.h>
#include <locograph/world/point_cloud.h>
#include <locograph/world/surfaces_of.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace locograph {
namespace {

using Element = XmlFile::Element;

constexpr double kMostEffortScale = 1e3;

class ScenarioReader {
 public:
  ScenarioReader(const std::filesystem::path& file, const std::filesystem::path& data_folder)
      : file_(file), data_folder_(data_folder), xml_(file, "scenario") {}

  Scenario read() {
    const Element& root = xml_.root();
    xml_.allow(root, {"version", "name"},
               {"robot", "wheels", "end_effectors", "limits", "environment", "drive", "start",
                "goal", "planner", "execution"});
    if (const std::string version = xml_.attribute(root, "version"); version != "1") {
      throw xml_.error(root, "scenario version '" + version + "'", "version=\"1\"");
    }
    scenario_.name = xml_.attribute(root, "name");
    read_robot(only(root, "robot", true));
    take_environment(only(root, "environment", false));
    read_wheels(only(root, "wheels", false));
    read_end_effectors(only(root, "end_effectors", false));
    read_limits(only(root, "limits", false));
    read_drive(only(root, "drive", false));
    scenario_.contacts = read_contact_task(xml_, scenario_.end_effectors);
    read_planner(only(root, "planner", false));
    if (const Element* execution = only(root, "execution", false)) {
      scenario_.margin = read_execution_margin(xml_, *execution);
    }
    require_one_task(root);
    return std::move(scenario_);
  }

 private:
  void require_one_task(const Element& root) const {
    if (scenario_.drive && scenario_.contacts) {
      throw xml_.error(*only(root, "start", true), "a scenario with both a <drive> and a <start>",
                       "one of them");
    }
    if (scenario_.contacts) {
      if (has_places(environment_)) return;
      const Element* environment = only(root, "environment", false);
      throw xml_.error(
          environment != nullptr ? *environment : root, "nothing to stand on",
          "a <plane>, <box>, <rung>, <mesh>, <cloud> or <octomap> in the <environment>");
    }
    if (!scenario_.drive) {
      throw xml_.error(root, "the scenario has no task", "a <drive>, or a <start> and a <goal>");
    }
    if (std::none_of(scenario_.end_effectors.begin(), scenario_.end_effectors.end(),
                     [](const EndEffector& one) { return one.kind == ContactKind::kWheel; })) {
      throw xml_.error(root, "a drive without wheels", "a <wheels> element");
    }
  }

  const Element* only(const Element& parent, const char* name, bool required) const {
    const auto all = xml_.children(parent, name);
    if (all.size() > 1) {
      throw xml_.error(all[1], "a second <" + std::string(name) + ">", "one");
    }
    if (all.empty() && required) {
      throw xml_.error(parent, "no <" + std::string(name) + ">", "one");
    }
    return all.empty() ? nullptr : &all.front().get();
  }

  std::filesystem::path beside_file(const std::string& path) const {
    return std::filesystem::path(path).is_absolute() ? std::filesystem::path(path)
                                                     : file_.parent_path() / path;
  }

  void read_robot(const Element* robot) {
    xml_.allow(*robot, {"model", "urdf", "srdf", "active", "state", "effort_scale"}, {"camera"});
    const bool by_model = robot->Attribute("model") != nullptr;
    if (by_model == (robot->Attribute("urdf") != nullptr)) {
      throw xml_.error(*robot, "the robot is not named", "either model=\"…\" or urdf=\"…\"");
    }
    if (by_model) {
      const std::string model = xml_.attribute(*robot, "model");
      const std::optional<RobotFiles> files = shipped_robot(model, data_folder_);
      if (!files) {
        throw xml_.error(*robot, "unknown robot model '" + model + "'",
                         "one that `locograph list robots` names" +
                             did_you_mean(model, robot_names(data_folder_)));
      }
      scenario_.urdf = files->urdf;
      scenario_.srdf = files->srdf;
    } else {
      scenario_.urdf = beside_file(xml_.attribute(*robot, "urdf"));
      if (robot->Attribute("srdf")) scenario_.srdf = beside_file(xml_.attribute(*robot, "srdf"));
      scenario_.robot.lenient_srdf = true;
    }
    if (robot->Attribute("active")) {
      scenario_.robot.active_joints = {xml_.attribute(*robot, "active")};
    }
    if (robot->Attribute("state")) scenario_.start_state = xml_.attribute(*robot, "state");
    scenario_.robot.frozen_state = scenario_.start_state;
    scenario_.effort_scale = positive_or(*robot, "effort_scale", 1.0, kMostEffortScale);
    scenario_.cameras = read_cameras(xml_, *robot);
  }

  void read_wheels(const Element* wheels) {
    if (wheels == nullptr) return;
    xml_.allow(*wheels, {}, {"wheel"});
    for (const Element& wheel : xml_.children(*wheels, "wheel")) {
      xml_.allow(wheel, {"link", "radius", "friction", "max_force"}, {});
      EndEffector effector;
      effector.name = effector.link = xml_.attribute(wheel, "link");
      effector.kind = ContactKind::kWheel;
      effector.radius_m = read_size(xml_, wheel, "radius");
      effector.friction = positive_or(
          wheel, "friction", environment_.friction.value_or(kWheelFriction), ranges::kFriction);
      effector.max_force_N = positive_or(wheel, "max_force", kWheelForce_N, ranges::kForce_N);
      add(wheel, std::move(effector));
    }
  }

  void read_end_effectors(const Element* all) {
    if (all == nullptr) return;
    xml_.allow(*all, {}, {"end_effector"});
    std::optional<double> friction;
    for (const Element& element : xml_.children(*all, "end_effector")) {
      const ContactKind kind = read_contact_kind(xml_, element);
      std::set<std::string> allowed = effector_attributes(kind);
      allowed.insert({"name", "kind"});
      xml_.allow(element, allowed, {});
      EndEffector effector = read_effector(xml_, element, kind);
      effector.name = xml_.attribute(element, "name");
      if (contact_kind_entry(kind).has_friction()) {
        if (!friction) friction = effector_friction(xml_, environment_);
        if (!friction) {
          throw xml_.error(element, "the friction of " + effector.name + " is not known",
                           "<environment friction=\"…\">");
        }
        effector.friction = *friction;
      }
      add(element, std::move(effector));
    }
  }

  void add(const Element& element, EndEffector effector) {
    if (scenario_.end_effectors.size() == ranges::kEndEffectors) {
      throw xml_.error(element,
                       "one end effector more than " + std::to_string(ranges::kEndEffectors),
                       "as many as a robot has");
    }
    for (const EndEffector& other : scenario_.end_effectors) {
      if (other.name == effector.name) {
        throw xml_.error(element, "a second end effector " + effector.name, "each once");
      }
    }
    scenario_.end_effectors.push_back(std::move(effector));
    scenario_.end_effector_lines.push_back(element.GetLineNum());
  }

  double positive_or(const Element& element, const char* name, double otherwise,
                     double most) const {
    if (element.Attribute(name) == nullptr) return otherwise;
    return read_positive(xml_, element, name, most);
  }

  void read_limits(const Element* limits) {
    if (limits == nullptr) return;
    constexpr double kMostLimit = 1e6;
    xml_.allow(*limits, {"base_linear", "base_angular", "joint_acceleration"}, {});
    scenario_.limits.base_linear_m_s = positive_or(*limits, "base_linear", 0.0, kMostLimit);
    scenario_.limits.base_angular_rad_s = positive_or(*limits, "base_angular", 0.0, kMostLimit);
    scenario_.limits.joint_acceleration_rad_s2 =
        positive_or(*limits, "joint_acceleration", 0.0, kMostLimit);
  }

  void read_planner(const Element* planner) {
    if (planner == nullptr) return;
    xml_.allow(*planner, {"torque_limits"}, {});
    if (planner->Attribute("torque_limits") == nullptr) return;
    const std::string torques = xml_.attribute(*planner, "torque_limits");
    if (torques != "enforce" && torques != "report") {
      throw xml_.error(*planner, "torque_limits is '" + torques + "'", "enforce or report");
    }
    scenario_.enforce_torque_limits = torques == "enforce";
  }

  void take_environment(const Element* element) {
    if (element == nullptr) return;
    environment_ = read_environment(xml_, *element);
    if (!environment_.map.empty()) scenario_.map = beside_file(environment_.map);
    if (!environment_.obstacles.empty()) scenario_.obstacles = beside_file(environment_.obstacles);
    scenario_.surfaces = environment_.surfaces;
    scenario_.bars = environment_.bars;
    scenario_.solids = environment_.solids;
    scenario_.scanned = environment_.scanned;
    for (ScannedSurface& scanned : scenario_.scanned) {
      scanned.file = beside_file(scanned.file.string());
    }
  }

  void read_drive(const Element* drive) {
    if (drive == nullptr) return;
    xml_.allow(*drive, {"distance", "curvature", "speed", "configurations"}, {});
    DriveTask task;
    task.line = drive->GetLineNum();
    task.distance_m = read_positive(xml_, *drive, "distance", ranges::kDrive_m);
    task.speed_m_s =
        read_positive(xml_, *drive, "speed", ranges::kMostSpeed_m_s, ranges::kLeastSpeed_m_s);
    if (drive->Attribute("curvature")) task.curvature_1_m = xml_.number(*drive, "curvature");
    if (!(std::abs(task.curvature_1_m) <= ranges::kCurvature_1_m)) {
      throw xml_.error(*drive, "curvature=\"" + xml_.attribute(*drive, "curvature") + "\"",
                       "1/m, at most 1000 either way");
    }
    const double count = xml_.number(*drive, "configurations");
    if (!(count >= 2.0 && count <= ranges::kConfigurations) || count != std::floor(count)) {
      throw xml_.error(*drive,
                       "configurations=\"" + xml_.attribute(*drive, "configurations") + "\"",
                       "a whole number from 2 to " + std::to_string(ranges::kConfigurations));
    }
    task.configurations = static_cast<int>(count);
    scenario_.drive = task;
  }

  std::filesystem::path file_, data_folder_;
  XmlFile xml_;
  Scenario scenario_;
  Environment environment_;
};

PatchOptions patch_options(const ScannedSurface& scanned, const Deadline& deadline) {
  PatchOptions options;
  options.deadline = deadline;
  options.voxel_m = scanned.voxel_m;
  options.least_length_m = 0.2;
  options.least_width_m = 0.1;
  return options;
}

/// Public clouds may have coordinates of a whole country; a scenario is no place for them.
std::vector<Eigen::Vector3d> points_near(const std::filesystem::path& file) {
  std::vector<Eigen::Vector3d> points = load_point_cloud(file);
  for (const Eigen::Vector3d& point : points) {
    if (point.cwiseAbs().maxCoeff() <= ranges::kCoordinate_m) continue;
    throw Error(file.string(), 0, "a point is further away than 1000000 m",
                "coordinates near the robot");
  }
  return points;
}

/// The voxels behind rectangles that are left out stay in the map.
void add_octomap_without_ceilings(World& world, const ScannedSurface& scanned,
                                  const Deadline& deadline) {
  constexpr double kDown = -0.5;
  const auto before = static_cast<std::ptrdiff_t>(world.surfaces.size());
  add_octomap(world, scanned.name, load_octree(scanned.file), scanned.friction,
              patch_options(scanned, deadline));
  const auto looks_down = [](const Surface& surface) {
    return surface.world_from_surface.linear()(2, 2) < kDown;
  };
  world.surfaces.erase(
      std::remove_if(world.surfaces.begin() + before, world.surfaces.end(), looks_down),
      world.surfaces.end());
}

void add_scanned(World& world, const ScannedSurface& scanned, const Deadline& deadline) {
  switch (scanned.kind) {
    case ScannedSurface::Kind::kMesh:
      return add_mesh(world, scanned.name, scanned.file, scanned.world_from_mesh, scanned.scale,
                      scanned.friction, {.deadline = deadline});
    case ScannedSurface::Kind::kCloud:
      // Of what is not steep, clouds have no rectangles that look down.
      return add_cloud(world, scanned.name, points_near(scanned.file), scanned.friction,
                       patch_options(scanned, deadline), {.deadline = deadline});
    case ScannedSurface::Kind::kOctomap:
      return add_octomap_without_ceilings(world, scanned, deadline);
  }
}

}  // namespace

Scenario load_scenario(const std::string& name_or_file, const std::filesystem::path& data_folder) {
  if (name_or_file == "-") {
    throw Error("standard input", 0, "is no scenario: a plan names the file of its own",
                "a scenario's file or name");
  }
  const std::filesystem::path own = data_folder / "scenarios" / (name_or_file + ".xml");
  std::error_code too_long;
  const bool by_name =
      name_or_file.find('/') == std::string::npos && std::filesystem::exists(own, too_long);
  const std::filesystem::path file = by_name ? own : std::filesystem::path(name_or_file);
  if (!by_name && !std::filesystem::exists(file, too_long)) {
    const std::vector<std::string> names = scenario_names(data_folder);
    throw Error(name_or_file, 0, "no such scenario",
                "a file, or one of " + joined_names(names) + did_you_mean(name_or_file, names));
  }
  Scenario scenario = ScenarioReader(file, data_folder).read();
  scenario.source = by_name ? name_or_file : std::filesystem::absolute(file).string();
  return scenario;
}

World world_of(const Scenario& scenario, const Deadline& deadline) {
  World world = load_world(scenario.map, scenario.obstacles);
  world.surfaces = scenario.surfaces;
  world.bars = scenario.bars;
  world.solids = scenario.solids;
  for (const ScannedSurface& scanned : scenario.scanned) {
    try {
      deadline.require();
      add_scanned(world, scanned, deadline);
    } catch (const Error& error) {
      if (!error.file().empty()) throw;
      // Of its options, as the voxel, or of the place where the scenario puts it.
      throw Error(scenario.source, scanned.line, scanned.file.string() + ": " + error.what(), "");
    }
  }
  if (!scenario.scanned.empty() && world.surfaces.empty() && world.bars.empty()) {
    const ScannedSurface& first = scenario.scanned.front();
    throw Error(scenario.source, first.line, "nothing to stand on in " + first.file.string(),
                "flat places or bars");
  }
  if (scenario.drive && world.surfaces.empty() && scenario.scanned.empty()) {
    world.surfaces.push_back(ground());
  }
  return world;
}

std::vector<DepthCamera> cameras_of(const Scenario& scenario, const Robot& robot) {
  if (scenario.cameras.empty()) return cameras_of(robot);
  std::vector<DepthCamera> cameras;
  for (const ScenarioCamera& one : scenario.cameras) {
    cameras.push_back(one.camera);
    try {
      cameras.back().link = robot.link_index(one.link);
    } catch (const Error& error) {
      throw Error(scenario.source, one.line, error.what(), "");
    }
  }
  return cameras;
}

std::vector<std::filesystem::path> files_of(const Scenario& scenario) {
  std::vector<std::filesystem::path> files = {scenario.urdf, scenario.srdf, scenario.map,
                                              scenario.obstacles};
  for (const ScannedSurface& scanned : scenario.scanned) files.push_back(scanned.file);
  const std::filesystem::path own = scenario.source;
  if (own.is_absolute()) files.push_back(own);
  std::erase(files, std::filesystem::path());
  return files;
}

std::vector<std::string> scenario_names(const std::filesystem::path& data_folder) {
  std::vector<std::string> names;
  const std::filesystem::path folder = data_folder / "scenarios";
  if (!std::filesystem::is_directory(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> robot_names(const std::filesystem::path& data_folder) {
  std::vector<std::string> names;
  const std::filesystem::path folder = data_folder / "robots/models";
  if (!std::filesystem::is_directory(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace locograph
