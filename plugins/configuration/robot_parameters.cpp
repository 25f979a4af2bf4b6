#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/plugins/configuration/sphere_overshoot.h>
#include <locograph/world/octree.h>

#include <algorithm>

namespace locograph {
namespace {

std::filesystem::path read_path(FieldReader& in) {
  const std::string word = in.word();
  if (word == "-") return {};
  const std::filesystem::path path(word);
  return path.is_absolute() ? path : in.where().folder / path;
}

void write_path(FieldWriter& out, const std::filesystem::path& path) {
  if (path.empty()) {
    out.word("-");
    return;
  }
  const std::filesystem::path folder =
      std::filesystem::absolute(out.folder().empty() ? "." : out.folder());
  out.word(std::filesystem::proximate(std::filesystem::absolute(path), folder).generic_string());
}

}  // namespace

RobotParameter::RobotParameter(std::filesystem::path urdf_file, std::filesystem::path srdf_file,
                               RobotOptions robot_options)
    : urdf(std::move(urdf_file)), srdf(std::move(srdf_file)), options(std::move(robot_options)) {
  load();
}

void RobotParameter::load() {
  robot = std::make_shared<const Robot>(Robot::load(urdf, srdf, options));
  spheres = covering_spheres(*robot, kSphereOvershoot_m);
  std::stable_sort(
      spheres.begin(), spheres.end(),
      [](const CollisionSphere& a, const CollisionSphere& b) { return a.link < b.link; });
  bounds.clear();
  for (int begin = 0, end = 0; begin < static_cast<int>(spheres.size()); begin = end) {
    Eigen::AlignedBox3d box;
    for (end = begin; end < static_cast<int>(spheres.size()); ++end) {
      if (spheres[end].link != spheres[begin].link) break;
      box.extend(spheres[end].center);
    }
    LinkBound bound{spheres[begin].link, box.center(), 0.0, begin, end};
    for (int i = begin; i < end; ++i) {
      const double reach = (spheres[i].center - bound.center).norm() + spheres[i].radius;
      bound.radius = std::max(bound.radius, reach);
    }
    bounds.push_back(bound);
  }
  self_collision = SelfCollisionShapes(*this);
}

void RobotParameter::read(FieldReader& in) {
  urdf = read_path(in);
  srdf = read_path(in);
  const std::string base = in.word();
  if (base != "floating" && base != "fixed") {
    in.fail("base '" + base + "'", "'floating' or 'fixed'");
  }
  options.floating_base = base == "floating";
  const int count = in.integer();
  if (count < 0) in.fail("number of active joints " + std::to_string(count), "0 (all) or more");
  for (int i = 0; i < count; ++i) options.active_joints.push_back(in.word());
  while (!in.at_end()) {
    const std::string option = in.word();
    if (option == "lenient") {
      options.lenient_srdf = true;
    } else if (option == "frozen") {
      options.frozen_state = in.word();
    } else {
      in.fail("'" + option + "'", "'lenient', 'frozen' or the end of the line");
    }
  }
  load();
}

void RobotParameter::write(FieldWriter& out) const {
  write_path(out, urdf);
  write_path(out, srdf);
  out.word(options.floating_base ? "floating" : "fixed");
  out.integer(static_cast<long>(options.active_joints.size()));
  for (const std::string& name : options.active_joints) out.word(name);
  if (options.lenient_srdf) out.word("lenient");
  if (options.frozen_state != RobotOptions().frozen_state) {
    out.word("frozen");
    out.word(options.frozen_state);
  }
}

WheelsParameter::WheelsParameter(const Robot& robot, int number, std::vector<Wheel> named)
    : robot_number(number), wheels(std::move(named)) {
  for (Wheel& wheel : wheels) {
    wheel.link = robot.link_index(wheel.link_name);
    if (!(wheel.radius_m > 0.0)) {
      throw Error("wheel " + wheel.link_name + " has radius " + std::to_string(wheel.radius_m),
                  "a radius > 0 m");
    }
    const int above = robot.links()[wheel.link].parent_joint;
    if (above < 0 || robot.joints()[above].type == JointType::kFixed ||
        robot.joints()[above].type == JointType::kPrismatic) {
      throw Error("wheel " + wheel.link_name + " cannot turn", "a link below a revolute joint");
    }
    const Joint& joint = robot.joints()[above];
    wheel.carrier = joint.parent_link;
    wheel.joint = joint.index;
    wheel.axle_in_carrier = joint.parent_from_joint.linear() * joint.axis;
    wheel.centre_in_carrier = joint.parent_from_joint.translation();
    // The carrier's axis that is most nearly normal to the axle, made normal to it.
    int axis = 0;
    wheel.axle_in_carrier.cwiseAbs().minCoeff(&axis);
    Eigen::Vector3d upright = Eigen::Vector3d::Unit(axis);
    upright -= wheel.axle_in_carrier * wheel.axle_in_carrier.dot(upright);
    wheel.upright_in_carrier = upright.normalized();
  }
}

void WheelsParameter::read(FieldReader& in) {
  const int number = in.integer();
  const int count = in.integer();
  if (count < 1) in.fail("number of wheels " + std::to_string(count), "at least one");
  std::vector<Wheel> named;
  for (int i = 0; i < count; ++i) {
    Wheel wheel;
    wheel.link_name = in.word();
    wheel.radius_m = in.number();
    named.push_back(std::move(wheel));
  }
  *this = WheelsParameter(*in.parameters()->get<RobotParameter>(number)->robot, number,
                          std::move(named));
}

void WheelsParameter::write(FieldWriter& out) const {
  out.integer(robot_number);
  out.integer(static_cast<long>(wheels.size()));
  for (const Wheel& wheel : wheels) {
    out.word(wheel.link_name);
    out.number(wheel.radius_m);
  }
}

WorldParameter::WorldParameter(std::filesystem::path map_file, std::filesystem::path obstacle_file)
    : map(std::move(map_file)), obstacles(std::move(obstacle_file)) {
  load();
}

void WorldParameter::load() {
  now = {};
  if (!map.empty()) {
    DistanceFieldOptions options;
    options.ground_z = kGroundVoxelTop_m;
    now.map = std::make_shared<const DistanceField>(
        DistanceField::from_octree(*load_octree(map), options));
  }
  if (!obstacles.empty()) now.obstacles = load_obstacles(obstacles);
}

void WorldParameter::read(FieldReader& in) {
  map = read_path(in);
  obstacles = read_path(in);
  load();
}

void WorldParameter::write(FieldWriter& out) const {
  write_path(out, map);
  write_path(out, obstacles);
}

}  // namespace locograph
