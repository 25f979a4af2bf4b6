#include <locograph/apps/robot_files.h>
#include <locograph/apps/robot_skeleton.h>
#include <locograph/common/atomic_file.h>
#include <locograph/planners/posture/standing_start.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/world/bent_legs.h>
#include <locograph/world/left_out_pairs.h>
#include <locograph/world/proposed_effectors.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

namespace locograph {
namespace {

constexpr double kFriction = 0.7, kStep_m = 0.15;
constexpr double kNever_m = 0.1;  // what samples miss comes near far more often than it meets

/// Without the joints that cannot hold anything, as fingers without a limit of effort: they stay
/// where they are.
Robot driven_robot(const std::filesystem::path& urdf, RobotOptions& options) {
  const Robot whole = Robot::load(urdf);
  const int count = whole.active_joint_count();
  for (int i = 0; i < count; ++i) {
    const Joint& joint = whole.active_joint(i);
    if (joint.max_effort > 0.0 && joint.max_velocity > 0.0) {
      options.active_joints.push_back(joint.name);
    }
  }
  if (static_cast<int>(options.active_joints.size()) < count) return Robot::load(urdf, {}, options);
  options.active_joints.clear();
  return whole;
}

struct PairOff {
  int first, second;
  const char* reason;
};

std::vector<PairOff> pairs_off(const Robot& robot, const LinkPairs& sampled,
                               const Eigen::VectorXd& standing) {
  const auto overlapping = overlapping_as_it_stands(robot, standing);
  const std::set<std::pair<int, int>> overlap(overlapping.begin(), overlapping.end());
  std::vector<PairOff> off;
  for (const LinkPair& pair : sampled.pairs) {
    const char* reason = nullptr;
    if (pair.always_meets(sampled.samples)) {
      reason = "Always";
    } else if (pair.near == 0) {
      reason = "Never";
    } else if (overlap.contains({pair.first, pair.second})) {
      reason = "Default";
    }
    if (reason != nullptr) off.push_back({pair.first, pair.second, reason});
  }
  // Links that only joints move which are left out.
  const std::vector<int>& body = robot.tree().body_of_link;
  for (const auto& [first, second] : overlapping) {
    if (body[static_cast<std::size_t>(first)] == body[static_cast<std::size_t>(second)])
      off.push_back({first, second, "Always"});
  }
  return off;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.8g", std::abs(value) < 1e-9 ? 0.0 : value);
  return text;
}

template <class Vector>
std::string numbers(const Vector& values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ' ';
    text += number(value);
  }
  return text;
}

/// value: what the attribute with the position is called; null: names only.
void joints(tinyxml2::XMLPrinter& xml, const Robot& robot, const Eigen::VectorXd& configuration,
            const char* value) {
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    xml.OpenElement("joint");
    xml.PushAttribute("name", robot.active_joint(i).name.c_str());
    if (value != nullptr) {
      xml.PushAttribute(value, number(configuration[robot.base_configuration_size() + i]).c_str());
    }
    xml.CloseElement();
  }
}

std::string srdf_text(const Robot& robot, const std::vector<PairOff>& off,
                      const Eigen::VectorXd* standing) {
  tinyxml2::XMLPrinter xml;
  xml.PushHeader(false, true);
  xml.OpenElement("robot");
  xml.PushAttribute("name", robot.name().c_str());
  if (standing != nullptr) {
    xml.OpenElement("group");
    xml.PushAttribute("name", "whole_body");
    joints(xml, robot, *standing, nullptr);
    xml.CloseElement();
    xml.OpenElement("group_state");
    xml.PushAttribute("name", "standing");
    xml.PushAttribute("group", "whole_body");
    joints(xml, robot, *standing, "value");
    xml.CloseElement();
  }
  for (const PairOff& pair : off) {
    xml.OpenElement("disable_collisions");
    xml.PushAttribute("link1", robot.links()[static_cast<std::size_t>(pair.first)].name.c_str());
    xml.PushAttribute("link2", robot.links()[static_cast<std::size_t>(pair.second)].name.c_str());
    xml.PushAttribute("reason", pair.reason);
    xml.CloseElement();
  }
  xml.CloseElement();
  return xml.CStr();
}

void effector(tinyxml2::XMLPrinter& xml, const EndEffector& one) {
  xml.OpenElement("end_effector");
  xml.PushAttribute("name", one.name.c_str());
  xml.PushAttribute("link", one.link.c_str());
  xml.PushAttribute("kind", contact_kind_name(one.kind).c_str());
  if (!one.point.isZero()) xml.PushAttribute("point", numbers(one.point).c_str());
  if (one.kind == ContactKind::kSurface) {
    xml.PushAttribute("half_x", number(one.half_x_m).c_str());
    xml.PushAttribute("half_y", number(one.half_y_m).c_str());
    xml.PushAttribute("link_normal", numbers(one.normal).c_str());
    xml.PushAttribute("link_forward", numbers(one.forward).c_str());
  }
  if (one.radius_m > 0.0) xml.PushAttribute("radius", number(one.radius_m).c_str());
  xml.PushAttribute("max_force", number(one.max_force_N).c_str());
  xml.CloseElement();
}

void contacts(tinyxml2::XMLPrinter& xml, const Stance& stance, double ahead_m) {
  for (const Contact& contact : stance.contacts) {
    xml.OpenElement("contact");
    xml.PushAttribute("end_effector", contact.name().c_str());
    xml.PushAttribute(
        "position",
        numbers(Eigen::Vector3d(contact.position + ahead_m * Eigen::Vector3d::UnitX())).c_str());
    xml.PushAttribute("normal", numbers(contact.normal).c_str());
    if (contact.forward) xml.PushAttribute("forward", numbers(*contact.forward).c_str());
    xml.CloseElement();
  }
}

/// A path as the scenario in `folder` may have it.
std::string seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  return std::filesystem::proximate(file, folder.empty() ? "." : folder).generic_string();
}

std::string scenario_text(const std::filesystem::path& folder, const std::filesystem::path& srdf,
                          const Robot& robot, const StandingStart& start,
                          const char* torque_limits) {
  const Eigen::VectorXd& q = start.answer.configuration;
  tinyxml2::XMLPrinter xml;
  xml.PushHeader(false, true);
  xml.PushComment(
      " To begin with: end effectors are what the shapes of the last links look like, "
      "friction is a guess. ");
  xml.OpenElement("scenario");
  xml.PushAttribute("version", 1);
  xml.PushAttribute("name", "step_ahead");
  xml.OpenElement("robot");
  xml.PushAttribute("urdf", seen_from(folder, robot.urdf_file()).c_str());
  xml.PushAttribute("srdf", seen_from(folder, srdf).c_str());
  if (!robot.options().active_joints.empty()) xml.PushAttribute("active", "whole_body");
  xml.PushAttribute("state", "standing");
  xml.CloseElement();
  xml.OpenElement("end_effectors");
  for (const Contact& contact : start.stance.contacts) effector(xml, contact.effector);
  xml.CloseElement();
  xml.OpenElement("environment");
  xml.PushAttribute("friction", number(kFriction).c_str());
  xml.OpenElement("plane");
  xml.PushAttribute("name", "floor");
  xml.PushAttribute("center", "0 0 0");
  xml.PushAttribute("normal", "0 0 1");
  xml.PushAttribute("size", "6 6");
  xml.CloseElement();
  xml.CloseElement();
  xml.OpenElement("start");
  xml.PushAttribute("base", numbers(Eigen::VectorXd(q.head<7>())).c_str());
  joints(xml, robot, q, "position");
  contacts(xml, start.stance, 0.0);
  xml.CloseElement();
  xml.OpenElement("goal");
  contacts(xml, start.stance, kStep_m);
  xml.CloseElement();
  xml.OpenElement("planner");
  xml.PushAttribute("torque_limits", torque_limits);
  xml.CloseElement();
  xml.CloseElement();
  return xml.CStr();
}

Json effectors_json(const std::vector<EndEffector>& effectors) {
  Json all = Json::array();
  for (const EndEffector& one : effectors) {
    Json json = {{"link", one.link},
                 {"kind", contact_kind_name(one.kind)},
                 {"point", std::vector<double>(one.point.begin(), one.point.end())}};
    if (one.kind == ContactKind::kSurface) {
      json["half_x_m"] = one.half_x_m;
      json["half_y_m"] = one.half_y_m;
    }
    if (one.radius_m > 0.0) json["radius_m"] = one.radius_m;
    all.push_back(std::move(json));
  }
  return all;
}

Json left_out(const Robot& robot) {
  Json names = Json::array();
  for (const Joint& joint : robot.joints()) {
    const bool moves = joint.type != JointType::kFixed && joint.mimics < 0;
    if (moves && joint.index < 0) names.push_back(joint.name);
  }
  return names;
}

}  // namespace

Json write_skeleton(const std::string& name_or_file, const std::filesystem::path& srdf,
                    const LinkPairOptions& sampling) {
  if (srdf == "-") throw Error("--write-srdf -", "a file, as a scenario is written beside it");
  const RobotFiles files = robot_files(name_or_file, "");
  const std::filesystem::path scenario =
      std::filesystem::path(srdf).replace_extension(".scenario.xml");
  for (const std::filesystem::path& output : {srdf, scenario}) {
    check_output(output, {files.urdf, files.srdf});
  }
  std::error_code unreadable;
  if (std::filesystem::exists(scenario, unreadable)) {
    throw Error(scenario.string(), 0, "it is there already, and may have been worked on",
                "another name, or that it is removed first");
  }
  RobotOptions driven;
  const Robot robot = driven_robot(files.urdf, driven);
  robot.require_collision_shapes();
  const std::vector<EndEffector> effectors = proposed_effectors(robot);
  LinkPairOptions near = sampling;
  near.near_m = kNever_m;
  near.stop_when_decided = true;
  const LinkPairs sampled = sample_link_pairs(robot, near);
  const Eigen::VectorXd bent =
      effectors.empty() ? robot.neutral_configuration() : bent_legs(robot, effectors);
  const std::vector<PairOff> off = pairs_off(robot, sampled, bent);
  const auto count = [&](const std::string& reason) {
    return std::ranges::count_if(off, [&](const PairOff& pair) { return pair.reason == reason; });
  };
  Json json = {{"file", files.urdf.string()},
               {"srdf", srdf.string()},
               {"scenario", nullptr},
               {"samples", sampled.samples},
               {"seed", sampling.seed},
               {"pairs", sampled.pairs.size()},
               {"never_meet", count("Never")},
               {"always_meet", count("Always")},
               {"overlap_standing", count("Default")},
               {"joints_left_out", left_out(robot)},
               {"end_effectors", effectors_json(effectors)}};
  write_file_atomically(srdf, srdf_text(robot, off, nullptr));
  if (effectors.empty()) {
    json["reason"] = "no end effector is proposed: no last link is as low as the robot";
    return json;
  }
  const auto parameter = std::make_shared<const RobotParameter>(files.urdf, srdf, driven);
  StandingStart start = standing_start(parameter, effectors, kFriction);
  const char* torque_limits = "enforce";
  if (!start.answer.success()) {
    // Models give efforts of motors without their gears, and placeholders.
    PostureOptions any_torque;
    any_torque.enforce_torque_limits = any_torque.check.enforce_torque_limits = false;
    StandingStart strong = standing_start(parameter, effectors, kFriction, any_torque);
    if (strong.answer.success()) {
      json["torque_limits"] = "report";
      json["torque_ratio_standing"] = strong.answer.report.max_torque_ratio.value_or(0.0);
      start = std::move(strong);
      torque_limits = "report";
    }
  }
  if (!start.answer.success()) {
    json["reason"] = "no posture stands on them: " + start.answer.reason;
    return json;
  }
  write_file_atomically(srdf, srdf_text(robot, off, &start.answer.configuration));
  write_file_atomically(scenario,
                        scenario_text(scenario.parent_path(), srdf, robot, start, torque_limits));
  json["scenario"] = scenario.string();
  return json;
}

}  // namespace locograph
