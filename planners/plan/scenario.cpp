#include <locograph/planners/plan/scenario.h>
#include <locograph/robots/xml_file.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

using Element = XmlFile::Element;

class ScenarioReader {
 public:
  ScenarioReader(const std::filesystem::path& file, const std::filesystem::path& data_folder)
      : file_(file), data_folder_(data_folder), xml_(file, "scenario") {}

  Scenario read() {
    const Element& root = xml_.root();
    xml_.allow(root, {"version", "name"}, {"robot", "wheels", "environment", "drive"});
    if (const std::string version = xml_.attribute(root, "version"); version != "1") {
      throw xml_.error(root, "scenario version '" + version + "'", "version=\"1\"");
    }
    scenario_.name = xml_.attribute(root, "name");
    read_robot(only(root, "robot", true));
    read_wheels(only(root, "wheels", false));
    read_environment(only(root, "environment", false));
    read_drive(only(root, "drive", false));
    if (!scenario_.drive) {
      throw xml_.error(root, "the scenario has no task", "a <drive> element");
    }
    if (scenario_.wheels.empty()) {
      throw xml_.error(root, "a drive without wheels", "a <wheels> element");
    }
    return std::move(scenario_);
  }

 private:
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
    xml_.allow(*robot, {"model", "urdf", "srdf", "active", "state"}, {});
    const bool by_model = robot->Attribute("model") != nullptr;
    if (by_model == (robot->Attribute("urdf") != nullptr)) {
      throw xml_.error(*robot, "the robot is not named", "either model=\"…\" or urdf=\"…\"");
    }
    if (by_model) {
      const std::string model = xml_.attribute(*robot, "model");
      const std::filesystem::path folder = data_folder_ / "robots/models" / model;
      if (!std::filesystem::exists(folder / (model + ".urdf"))) {
        throw xml_.error(*robot, "unknown robot model '" + model + "'",
                         "one that `locograph list robots` names");
      }
      scenario_.urdf = std::filesystem::canonical(folder) / (model + ".urdf");
      scenario_.srdf = std::filesystem::canonical(folder) / (model + ".srdf");
    } else {
      scenario_.urdf = beside_file(xml_.attribute(*robot, "urdf"));
      if (robot->Attribute("srdf")) scenario_.srdf = beside_file(xml_.attribute(*robot, "srdf"));
    }
    if (robot->Attribute("active")) {
      scenario_.robot.active_joints = {xml_.attribute(*robot, "active")};
    }
    if (robot->Attribute("state")) scenario_.start_state = xml_.attribute(*robot, "state");
    scenario_.robot.frozen_state = scenario_.start_state;
  }

  void read_wheels(const Element* wheels) {
    if (wheels == nullptr) return;
    xml_.allow(*wheels, {}, {"wheel"});
    for (const Element& wheel : xml_.children(*wheels, "wheel")) {
      xml_.allow(wheel, {"link", "radius"}, {});
      scenario_.wheels.push_back({xml_.attribute(wheel, "link"), xml_.positive(wheel, "radius")});
    }
  }

  void read_environment(const Element* environment) {
    if (environment == nullptr) return;
    xml_.allow(*environment, {"map", "obstacles"}, {});
    if (environment->Attribute("map")) {
      scenario_.map = beside_file(xml_.attribute(*environment, "map"));
    }
    if (environment->Attribute("obstacles")) {
      scenario_.obstacles = beside_file(xml_.attribute(*environment, "obstacles"));
    }
  }

  void read_drive(const Element* drive) {
    if (drive == nullptr) return;
    xml_.allow(*drive, {"distance", "curvature", "speed", "configurations"}, {});
    DriveTask task;
    task.line = drive->GetLineNum();
    task.distance_m = xml_.positive(*drive, "distance");
    task.speed_m_s = xml_.positive(*drive, "speed");
    if (drive->Attribute("curvature")) task.curvature_1_m = xml_.number(*drive, "curvature");
    const double count = xml_.number(*drive, "configurations");
    if (!(count >= 2.0 && count <= 1e6) || count != std::floor(count)) {
      throw xml_.error(*drive, "configurations is " + std::to_string(count),
                       "a whole number from 2 to 1000000");
    }
    task.configurations = static_cast<int>(count);
    scenario_.drive = task;
  }

  std::filesystem::path file_, data_folder_;
  XmlFile xml_;
  Scenario scenario_;
};

}  // namespace

Scenario load_scenario(const std::string& name_or_file, const std::filesystem::path& data_folder) {
  const std::filesystem::path own = data_folder / "scenarios" / (name_or_file + ".xml");
  const bool by_name = name_or_file.find('/') == std::string::npos && std::filesystem::exists(own);
  const std::filesystem::path file = by_name ? own : std::filesystem::path(name_or_file);
  if (!by_name && !std::filesystem::exists(file)) {
    std::string names;
    for (const std::string& name : scenario_names(data_folder)) {
      names += (names.empty() ? "" : ", ") + name;
    }
    throw Error(name_or_file, 0, "no such scenario", "a file, or one of " + names);
  }
  Scenario scenario = ScenarioReader(file, data_folder).read();
  scenario.source = name_or_file;
  return scenario;
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

}  // namespace locograph
