#include <locograph/common/error.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/names.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/srdf_reader.h>
#include <locograph/robots/urdf_reader.h>

#include <algorithm>

namespace locograph {
namespace {

/// Joint and group names of RobotOptions::active_joints as a flag per joint; mimic joints have
/// none.
std::vector<bool> choose_active(const UrdfModel& urdf, const SrdfModel& srdf,
                                const std::vector<std::string>& names, const std::string& file) {
  std::vector<bool> active(urdf.joints.size(), false);
  if (names.empty()) {
    for (std::size_t j = 0; j < active.size(); ++j) {
      active[j] = urdf.joints[j].type != JointType::kFixed && urdf.joints[j].mimics < 0;
    }
  }
  std::vector<std::string> known;
  for (const Joint& joint : urdf.joints) {
    if (joint.type != JointType::kFixed) known.push_back(joint.name);
  }
  for (const JointGroup& group : srdf.groups) known.push_back(group.name);
  for (const std::string& name : names) {
    const auto joint = std::find_if(urdf.joints.begin(), urdf.joints.end(), [&](const Joint& j) {
      return j.name == name && j.type != JointType::kFixed;
    });
    const auto group = std::find_if(srdf.groups.begin(), srdf.groups.end(),
                                    [&](const JointGroup& g) { return g.name == name; });
    if (joint != urdf.joints.end()) {
      active[static_cast<std::size_t>(joint - urdf.joints.begin())] = true;
    } else if (group != srdf.groups.end()) {
      for (const int j : group->joints) active[static_cast<std::size_t>(j)] = true;
    } else {
      throw Error(file, 0, "no movable joint or group '" + name + "' to be active",
                  similar_names(name, known));
    }
  }
  for (std::size_t j = 0; j < active.size(); ++j) {
    if (urdf.joints[j].mimics >= 0) active[j] = false;
  }
  for (const std::string& name : names) {
    const auto joint = std::find_if(urdf.joints.begin(), urdf.joints.end(), [&](const Joint& j) {
      return j.name == name && j.mimics >= 0;
    });
    if (joint == urdf.joints.end() || active[static_cast<std::size_t>(joint->mimics)]) continue;
    throw Error(file, urdf.joint_lines[static_cast<std::size_t>(joint - urdf.joints.begin())],
                "mimic joint '" + name + "' is active, but not the joint that leads it",
                "'" + urdf.joints[static_cast<std::size_t>(joint->mimics)].name +
                    "' among the active joints");
  }
  return active;
}

/// Places the mimic joints of frozen leaders, and lists what moves with the active joints.
std::vector<Axis> place_mimic_joints(std::vector<Joint>& joints) {
  std::vector<Axis> axes;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    Joint& joint = joints[j];
    if (joint.index >= 0) axes.push_back({.joint = static_cast<int>(j), .active = joint.index});
    if (joint.mimics < 0) continue;
    const Joint& leader = joints[static_cast<std::size_t>(joint.mimics)];
    if (leader.index < 0) {
      joint.frozen_position = joint.multiplier * leader.frozen_position + joint.offset;
    } else {
      joint.frozen_position = 0.0;
      axes.push_back({static_cast<int>(j), leader.index, joint.multiplier, joint.offset});
    }
  }
  return axes;
}

/// Number of the group of links connected through fixed joints that each link belongs to.
std::vector<int> rigid_groups(const UrdfModel& urdf) {
  std::vector<int> group(urdf.links.size());
  for (std::size_t l = 0; l < group.size(); ++l) {
    const int joint = urdf.links[l].parent_joint;
    const bool fixed =
        joint >= 0 && urdf.joints[static_cast<std::size_t>(joint)].type == JointType::kFixed;
    group[l] = fixed ? group[static_cast<std::size_t>(
                           urdf.joints[static_cast<std::size_t>(joint)].parent_link)]
                     : static_cast<int>(l);
  }
  return group;
}

std::vector<std::pair<int, int>> collision_pairs(const UrdfModel& urdf, const SrdfModel& srdf) {
  const std::vector<int> rigid = rigid_groups(urdf);
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t a = 0; a < urdf.links.size(); ++a) {
    for (std::size_t b = a + 1; b < urdf.links.size(); ++b) {
      const int first = static_cast<int>(a), second = static_cast<int>(b);
      if (!urdf.links[a].collision.empty() && !urdf.links[b].collision.empty() &&
          rigid[a] != rigid[b] && !srdf.is_disabled(first, second)) {
        pairs.emplace_back(first, second);
      }
    }
  }
  return pairs;
}

}  // namespace

void Robot::leave_out_pairs(const std::vector<std::pair<int, int>>& pairs) {
  std::erase_if(pairs_, [&](const std::pair<int, int>& pair) {
    const bool left_out = std::ranges::find(pairs, pair) != pairs.end();
    if (left_out) left_out_.push_back(pair);
    return left_out;
  });
}

Robot Robot::load(const std::filesystem::path& urdf_file, const std::filesystem::path& srdf_file,
                  const RobotOptions& options) {
  UrdfModel urdf = read_urdf(urdf_file);
  SrdfModel srdf;
  if (!srdf_file.empty()) srdf = read_srdf(srdf_file, urdf, options.lenient_srdf);
  const std::vector<bool> active =
      choose_active(urdf, srdf, options.active_joints, urdf_file.string());

  Robot robot;
  robot.name_ = urdf.name;
  robot.urdf_file_ = urdf_file;
  robot.srdf_file_ = srdf_file;
  robot.options_ = options;
  robot.pairs_ = collision_pairs(urdf, srdf);
  robot.warnings_ = srdf.warnings;
  robot.urdf_warnings_ = urdf.warnings;
  robot.links_ = std::move(urdf.links);
  robot.joints_ = std::move(urdf.joints);
  robot.groups_ = std::move(srdf.groups);
  robot.states_ = std::move(srdf.states);
  for (const Link& link : robot.links_) robot.total_mass_ += link.mass;

  for (std::size_t j = 0; j < robot.joints_.size(); ++j) {
    Joint& joint = robot.joints_[j];
    if (active[j]) {
      joint.index = static_cast<int>(robot.active_.size());
      robot.active_.push_back(static_cast<int>(j));
      joint.frozen_position = 0.0;
    } else if (joint.type != JointType::kFixed) {
      joint.frozen_position = std::clamp(0.0, joint.lower, joint.upper);
    }
  }
  const auto frozen =
      std::find_if(robot.states_.begin(), robot.states_.end(),
                   [&](const GroupState& state) { return state.name == options.frozen_state; });
  if (frozen != robot.states_.end()) {
    for (const auto& [index, position] : frozen->positions) {
      Joint& joint = robot.joints_[static_cast<std::size_t>(index)];
      if (joint.index < 0 && joint.type != JointType::kFixed) joint.frozen_position = position;
    }
  } else if (options.frozen_state != RobotOptions().frozen_state) {
    throw Error(srdf_file.empty() ? urdf_file.string() : srdf_file.string(), 0,
                "no group_state '" + options.frozen_state + "' for the frozen joints",
                similar_names(options.frozen_state, robot.configuration_names()));
  }
  robot.axes_ = place_mimic_joints(robot.joints_);
  robot.axes_of_active_.resize(robot.active_.size());
  for (std::size_t i = 0; i < robot.axes_.size(); ++i) {
    const Axis& axis = robot.axes_[i];
    std::vector<int>& axes = robot.axes_of_active_[static_cast<std::size_t>(axis.active)];
    const bool own = robot.joints_[static_cast<std::size_t>(axis.joint)].mimics < 0;
    axes.insert(own ? axes.begin() : axes.end(), static_cast<int>(i));
  }
  robot.tree_ = std::make_shared<const KinematicTree>(
      KinematicTree::build(robot.links_, robot.joints_, robot.axes_));
  return robot;
}

}  // namespace locograph
