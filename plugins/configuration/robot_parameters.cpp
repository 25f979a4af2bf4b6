#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/path_field.h>
#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/plugins/configuration/sphere_overshoot.h>
#include <locograph/robots/shipped_robot.h>
#include <locograph/world/left_out_pairs.h>

#include <algorithm>

namespace locograph {
namespace {

constexpr std::string_view kModel = "model";

}  // namespace

RobotParameter::RobotParameter(std::filesystem::path urdf_file, std::filesystem::path srdf_file,
                               RobotOptions robot_options)
    : urdf(std::move(urdf_file)), srdf(std::move(srdf_file)), options(std::move(robot_options)) {
  load();
}

void RobotParameter::load() {
  Robot loaded = Robot::load(urdf, srdf, options);
  leave_out_overlapping(loaded);
  robot = std::make_shared<const Robot>(std::move(loaded));
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
  const auto point = [](const auto& of) {
    return LinkPoint{of.link, {of.center[0], of.center[1], of.center[2]}};
  };
  sphere_points.clear();
  bound_points.clear();
  for (const CollisionSphere& sphere : spheres) sphere_points.push_back(point(sphere));
  for (const LinkBound& bound : bounds) bound_points.push_back(point(bound));
  self_collision = SelfCollisionShapes(*this);
}

void RobotParameter::read(FieldReader& in) {
  // Each line takes as long as loading its robot does.
  int robots = 1;
  for (const auto& [number, parameter] : in.parameters()->all()) {
    if (parameter->tag() == tag()) ++robots;
  }
  if (robots > ranges::kRobots) {
    in.fail("one robot more than " + std::to_string(ranges::kRobots), "fewer robots in one graph");
  }
  if (in.peek() == kModel) {
    in.word();
    const std::string name = in.word();
    const auto files = shipped_robot(name);
    if (!files) {
      in.fail("unknown robot model '" + name + "'", "one that `locograph list robots` names");
    }
    urdf = files->urdf;
    srdf = files->srdf;
  } else {
    urdf = read_path(in);
    srdf = read_path(in);
  }
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
  if (const std::string name = shipped_robot_name(urdf, srdf); !name.empty()) {
    out.word(kModel);
    out.word(name);
  } else {
    write_path(out, urdf);
    write_path(out, srdf);
  }
  out.word(options.floating_base ? "floating" : "fixed");
  out.integer(static_cast<long>(options.active_joints.size()));
  for (const std::string& name : options.active_joints) out.word(name);
  if (options.lenient_srdf) out.word("lenient");
  if (options.frozen_state != RobotOptions().frozen_state) {
    out.word("frozen");
    out.word(options.frozen_state);
  }
}

WorldParameter::WorldParameter() : WorldParameter(std::make_shared<const WorldSnapshot>(World())) {}

WorldParameter::WorldParameter(std::shared_ptr<const WorldSnapshot> world,
                               std::optional<double> ground)
    : snapshot(std::move(world)), ground_z_m(ground) {}

WorldParameter::WorldParameter(const WorldFiles& files, std::optional<double> ground)
    : ground_z_m(ground) {
  DistanceFieldOptions view;
  if (ground_z_m) view.ground_z = *ground_z_m;
  snapshot = std::make_shared<const WorldSnapshot>(load_world(files.map, files.obstacles), 0.0,
                                                   files, view);
}

void WorldParameter::read(FieldReader& in) {
  WorldFiles files;
  files.map = read_path(in);
  files.obstacles = read_path(in);
  std::optional<double> ground;
  if (!in.at_end()) {
    if (const std::string word = in.word(); word != "ground") {
      in.fail("'" + word + "'", "'ground' and its height, or the end of the line");
    }
    ground = in.number();
  }
  *this = WorldParameter(files, ground);
}

void WorldParameter::write(FieldWriter& out) const {
  write_path(out, snapshot->files().map);
  write_path(out, snapshot->files().obstacles);
  if (!ground_z_m) return;
  out.word("ground");
  out.number(*ground_z_m);
}

}  // namespace locograph
