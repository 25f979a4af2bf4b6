#include <locograph/common/error.h>
#include <locograph/planners/plan/placed_contact.h>
#include <locograph/plugins/configuration/surface_axes.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace locograph {
namespace {

constexpr double kSameDistance_m = 1e-4, kSameAngle_rad = 1e-3;

/// Any direction that is not along the normal.
Eigen::Vector3d some_forward(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = normal.stableNormalized();
  return std::abs(n.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
}

void require_sound(const Robot& robot, const PlacedContact& placed) {
  const ContactDescription& given = placed.contact;
  const std::string name = "contact of " + given.link;
  robot.link_index(given.link);
  if (!given.point.allFinite() || !placed.position.allFinite()) {
    throw Error(name + " is at a place that is not finite", "finite numbers");
  }
  if (given.kind == WrenchKind::kRung && !placed.forward) {
    throw Error(name + " is a rung without forward", "a direction across the bar");
  }
  surface_axes(name, placed.normal, placed.forward.value_or(some_forward(placed.normal)));
  if (given.kind != WrenchKind::kPoint) {
    surface_axes(name + " in its link", given.normal, given.forward);
  }
}

}  // namespace

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Matrix3d world_axes(const PlacedContact& placed) {
  return surface_axes("contact of " + placed.contact.link, placed.normal,
                      placed.forward.value_or(some_forward(placed.normal)));
}

ContactDescription wrench_description(const PlacedContact& placed) {
  ContactDescription description = placed.contact;
  if (description.kind == WrenchKind::kPoint) {
    description.axes_in_world = true;
    description.normal = placed.normal;
    description.forward = placed.forward.value_or(some_forward(placed.normal));
  }
  return description;
}

std::vector<ContactDescription> loaded_contacts(std::span<const PlacedContact> contacts) {
  std::vector<ContactDescription> loaded;
  for (const PlacedContact& placed : contacts) {
    if (placed.bears_load) loaded.push_back(wrench_description(placed));
  }
  return loaded;
}

void require_sound_contacts(const Robot& robot, std::span<const PlacedContact> contacts) {
  if (contacts.empty()) throw Error("no contacts", "one or more");
  for (const PlacedContact& placed : contacts) require_sound(robot, placed);
  if (std::none_of(contacts.begin(), contacts.end(),
                   [](const PlacedContact& placed) { return placed.bears_load; })) {
    throw Error("no contact bears load", "one or more that do");
  }
  // Two contacts of one rigid body: where they are to each other is fixed.
  const RobotState state(robot);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PlacedContact &a = contacts[j], &b = contacts[i];
      const int link_a = robot.link_index(a.contact.link),
                link_b = robot.link_index(b.contact.link);
      const std::vector<int>& body = robot.tree().body_of_link;
      if (body[static_cast<std::size_t>(link_a)] != body[static_cast<std::size_t>(link_b)]) {
        continue;
      }
      const Eigen::Isometry3d &pose_a = state.world_from_link(link_a),
                              &pose_b = state.world_from_link(link_b);
      const double own = (pose_a * a.contact.point - pose_b * b.contact.point).norm();
      const double asked = (a.position - b.position).norm();
      const std::string names = "contacts " + std::to_string(j + 1) + " and " +
                                std::to_string(i + 1) + ", of " + a.contact.link + " and " +
                                b.contact.link + ", contradict each other";
      if (own <= kSameDistance_m && asked <= kSameDistance_m) {
        throw Error("contacts " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                        " are the same, of " + b.contact.link,
                    "each contact once");
      }
      if (!(std::abs(own - asked) <= kSameDistance_m)) {
        throw Error(names + ": " + std::to_string(asked) + " m apart, " + std::to_string(own) +
                        " m on the robot",
                    "places that one rigid body can have");
      }
      if (a.contact.kind != WrenchKind::kSurface || b.contact.kind != WrenchKind::kSurface) {
        continue;
      }
      const double between =
          angle_between(pose_a.linear() * a.contact.normal, pose_b.linear() * b.contact.normal);
      if (!(std::abs(between - angle_between(a.normal, b.normal)) <= kSameAngle_rad)) {
        throw Error(names + " in their normals", "directions that one rigid body can have");
      }
    }
  }
}

std::vector<bool> touching_links(const Robot& robot, std::span<const PlacedContact> contacts) {
  const std::vector<int>& body_of = robot.tree().body_of_link;
  const auto body = [&](int link) { return body_of[static_cast<std::size_t>(link)]; };
  std::vector<bool> touching(robot.tree().bodies.size(), false);
  for (const PlacedContact& placed : contacts) {
    const int of = body(robot.link_index(placed.contact.link));
    touching[static_cast<std::size_t>(of)] = true;
    if (of == 0) continue;  // the root's body carries everything
    for (const Joint& joint : robot.joints()) {
      if (body(joint.parent_link) == of)
        touching[static_cast<std::size_t>(body(joint.child_link))] = true;
    }
  }
  std::vector<bool> links;
  for (const int of : body_of) links.push_back(touching[static_cast<std::size_t>(of)]);
  return links;
}

}  // namespace locograph
