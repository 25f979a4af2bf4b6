#include <locograph/common/error.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kSameDistance_m = 1e-4, kSameAngle_rad = 1e-3;

/// Any direction that is not along the normal.
Eigen::Vector3d some_forward(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = normal.stableNormalized();
  return std::abs(n.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
}

std::string contact_of(const EndEffector& effector) {
  return "contact of " + (effector.name.empty() ? effector.link : effector.name);
}

void require_in_range(const EndEffector& effector, const EffectorField& field) {
  const double value = effector.*field.value;
  const bool positive = field.zero == EffectorField::Zero::kRefused;
  if ((positive ? value > 0.0 : value >= 0.0) && std::isfinite(value)) return;
  throw Error(contact_of(effector) + " has a " + field.description + " of " + std::to_string(value),
              positive ? "a positive number" : "zero or more");
}

void require_sound_bar(const std::string& name, const Contact& contact) {
  const RoundBar& bar = *contact.bar;
  if (!(bar.radius_m > 0.0 && std::isfinite(bar.radius_m))) {
    throw Error(name + " is on a bar with a radius of " + std::to_string(bar.radius_m),
                "a positive number");
  }
  const double length = std::hypot(bar.axis.x(), bar.axis.y(), bar.axis.z());
  const Eigen::Vector3d along = bar.axis / length;
  if (!(std::abs(along.dot(contact.normal.stableNormalized())) <= kSameAngle_rad)) {
    throw Error(name + " is on a bar whose axis is not across its normal", "a direction across it");
  }
}

/// Contacts of one rigid body: where they are to each other is fixed.
void require_consistent(const RobotState& state, const Contact& a, const Contact& b,
                        const std::string& numbers) {
  const Robot& robot = state.robot();
  const EndEffector &first = a.effector, &second = b.effector;
  const int link_a = robot.link_index(first.link), link_b = robot.link_index(second.link);
  const Eigen::Isometry3d &pose_a = state.world_from_link(link_a),
                          &pose_b = state.world_from_link(link_b);
  const double own = (pose_a * first.point - pose_b * second.point).norm();
  const ContactKindEntry &kind_a = contact_kind_entry(first.kind),
                         &kind_b = contact_kind_entry(second.kind);
  const auto place = [](const Contact& c) {
    const ContactKindEntry& kind = contact_kind_entry(c.effector.kind);
    return kind.is_round() && !kind.rolls
               ? Eigen::Vector3d(c.position + c.effector.radius_m * c.normal.stableNormalized())
               : c.position;
  };
  const double asked = (place(a) - place(b)).norm();
  if (own <= kSameDistance_m && asked <= kSameDistance_m) {
    throw Error("contacts " + numbers + " are the same, of " + second.link, "each contact once");
  }
  // The touching point of a wheel is anywhere on its rim.
  if (kind_a.rolls || kind_b.rolls) return;
  const std::string names = "contacts " + numbers + ", of " + first.link + " and " + second.link +
                            ", contradict each other";
  if (!(std::abs(own - asked) <= kSameDistance_m)) {
    throw Error(names + ": " + std::to_string(asked) + " m apart, " + std::to_string(own) +
                    " m on the robot",
                "places that one rigid body can have");
  }
  if (!kind_a.holds_normal || !kind_b.holds_normal) return;
  const double between =
      angle_between(pose_a.linear() * first.normal, pose_b.linear() * second.normal);
  if (!(std::abs(between - angle_between(a.normal, b.normal)) <= kSameAngle_rad)) {
    throw Error(names + " in their normals", "directions that one rigid body can have");
  }
}

/// name: of the contact, made for errors alone.
template <class Name>
Eigen::Matrix3d axes_of(Name&& name, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& forward) {
  // Neither overflows nor vanishes on the way. The last bits of Eigen's stableNorm() depend on
  // where the vector lies in memory, and it may overlook NaN.
  const double length = std::hypot(normal.x(), normal.y(), normal.z());
  const double way = std::hypot(forward.x(), forward.y(), forward.z());
  if (!(length > 0.0 && std::isfinite(length))) {
    throw Error(name() + " has a normal of length zero or not finite",
                "a direction out of the surface");
  }
  if (!(way > 0.0 && std::isfinite(way))) {
    throw Error(name() + " has a forward direction that is zero or not finite",
                "a direction in the surface");
  }
  Eigen::Matrix3d axes;
  axes.col(2) = normal / length;
  const Eigen::Vector3d across = axes.col(2).cross(forward / way);
  if (!(across.norm() > 1e-9)) {
    throw Error(name() + " has a forward direction along its normal", "a direction in the surface");
  }
  axes.col(1) = across.normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

}  // namespace

Eigen::Matrix3d contact_axes(const std::string& contact, const Eigen::Vector3d& normal,
                             const Eigen::Vector3d& forward) {
  return axes_of([&]() -> const std::string& { return contact; }, normal, forward);
}

Eigen::Matrix3d axes_in_link(const EndEffector& effector) {
  return axes_of([&] { return contact_of(effector) + " in its link"; }, effector.normal,
                 effector.forward);
}

Eigen::Matrix3d axes_in_world(const Contact& contact) {
  return axes_of([&] { return contact_of(contact.effector); }, contact.normal,
                 contact.forward.value_or(some_forward(contact.normal)));
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void require_sound_effector(const Robot& robot, const EndEffector& effector) {
  robot.link_index(effector.link);  // throws for an unknown one
  const ContactKindEntry& kind = contact_kind_entry(effector.kind);
  if (!effector.point.allFinite()) {
    throw Error(contact_of(effector) + " is at a place that is not finite", "finite numbers");
  }
  require_in_range(effector, effector_fields::kMaxForce);
  if (kind.axes_on_link) axes_in_link(effector);
  if (kind.has_friction()) require_in_range(effector, effector_fields::kFriction);
  for (const EffectorField& field : kind.fields) require_in_range(effector, field);
  kind.require_sound(robot, effector);
}

void require_sound_place(const Contact& contact) {
  const std::string name = contact_of(contact.effector);
  if (!contact.position.allFinite()) {
    throw Error(name + " is at a place that is not finite", "finite numbers");
  }
  const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
  if (!kind.forward_needed.empty() && !contact.forward) {
    throw Error(name + " is a " + kind.name + " without forward",
                "a direction " + kind.forward_needed);
  }
  if (contact.locked && !kind.rolls) {
    throw Error(name + " is locked", "wheels only are");
  }
  axes_in_world(contact);
  if (contact.bar) require_sound_bar(name, contact);
}

void require_sound_contact(const Robot& robot, const Contact& contact) {
  require_sound_effector(robot, contact.effector);
  require_sound_place(contact);
}

void require_sound_stance(const Robot& robot, const Stance& stance) {
  const std::vector<Contact>& contacts = stance.contacts;
  if (contacts.empty()) throw Error("no contacts", "one or more");
  for (const Contact& contact : contacts) require_sound_contact(robot, contact);
  if (std::none_of(contacts.begin(), contacts.end(),
                   [](const Contact& contact) { return contact.bears_load; })) {
    throw Error("no contact bears load", "one or more that do");
  }
  std::vector<int> bodies;
  for (const Contact& contact : contacts) {
    const int link = robot.link_index(contact.effector.link);
    bodies.push_back(robot.tree().body_of_link[static_cast<std::size_t>(link)]);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string numbers = std::to_string(j + 1) + " and " + std::to_string(i + 1);
      const std::string& name = contacts[i].effector.name;
      if (!name.empty() && name == contacts[j].effector.name) {
        throw Error("contacts " + numbers + " are both of " + name, "each end effector once");
      }
      if (bodies[i] == bodies[j])
        require_consistent(RobotState(robot), contacts[j], contacts[i], numbers);
    }
  }
}

std::vector<bool> touching_links(const Robot& robot, std::span<const Contact> contacts) {
  const std::vector<int>& body_of = robot.tree().body_of_link;
  const auto body = [&](int link) { return body_of[static_cast<std::size_t>(link)]; };
  std::vector<bool> touching(robot.tree().bodies.size(), false);
  for (const Contact& contact : contacts) {
    const int of = body(robot.link_index(contact.effector.link));
    touching[static_cast<std::size_t>(of)] = true;
    if (of == 0) continue;  // the root's body carries everything
    const int carrier = robot.tree().bodies[static_cast<std::size_t>(of)].parent;
    // The shapes of a fork reach round its wheel.
    if (contact.effector.kind == ContactKind::kWheel && carrier > 0) {
      touching[static_cast<std::size_t>(carrier)] = true;
    }
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
