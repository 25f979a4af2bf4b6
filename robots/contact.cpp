#include <locograph/common/error.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace locograph {
namespace {

constexpr double kSameDistance_m = 1e-4, kSameAngle_rad = 1e-3;
constexpr double kOnAxle_m = 1e-6;

const std::array<std::string, 4> kKindNames = {"surface", "point", "rung", "wheel"};

/// Any direction that is not along the normal.
Eigen::Vector3d some_forward(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = normal.stableNormalized();
  return std::abs(n.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
}

std::string contact_of(const EndEffector& effector) {
  return "contact of " + (effector.name.empty() ? effector.link : effector.name);
}

void require_positive(const EndEffector& effector, const char* what, double value) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw Error(contact_of(effector) + " has a " + what + " of " + std::to_string(value),
              "a positive number");
}

void require_not_negative(const EndEffector& effector, const char* what, double value) {
  if (value >= 0.0 && std::isfinite(value)) return;
  throw Error(contact_of(effector) + " has a " + what + " of " + std::to_string(value),
              "zero or more");
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
  const auto place = [](const Contact& c) {
    const bool ball = c.effector.kind == ContactKind::kPoint;
    return ball ? Eigen::Vector3d(c.position + c.effector.radius_m * c.normal.stableNormalized())
                : c.position;
  };
  const double asked = (place(a) - place(b)).norm();
  if (own <= kSameDistance_m && asked <= kSameDistance_m) {
    throw Error("contacts " + numbers + " are the same, of " + second.link, "each contact once");
  }
  // The touching point of a wheel is anywhere on its rim.
  if (first.kind == ContactKind::kWheel || second.kind == ContactKind::kWheel) return;
  const std::string names = "contacts " + numbers + ", of " + first.link + " and " + second.link +
                            ", contradict each other";
  if (!(std::abs(own - asked) <= kSameDistance_m)) {
    throw Error(names + ": " + std::to_string(asked) + " m apart, " + std::to_string(own) +
                    " m on the robot",
                "places that one rigid body can have");
  }
  if (first.kind != ContactKind::kSurface || second.kind != ContactKind::kSurface) return;
  const double between =
      angle_between(pose_a.linear() * first.normal, pose_b.linear() * second.normal);
  if (!(std::abs(between - angle_between(a.normal, b.normal)) <= kSameAngle_rad)) {
    throw Error(names + " in their normals", "directions that one rigid body can have");
  }
}

}  // namespace

const std::string& contact_kind_name(ContactKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::optional<ContactKind> contact_kind_of(const std::string& name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return std::nullopt;
  return static_cast<ContactKind>(found - kKindNames.begin());
}

Eigen::Matrix3d contact_axes(const std::string& contact, const Eigen::Vector3d& normal,
                             const Eigen::Vector3d& forward) {
  // Neither overflows nor vanishes on the way. The last bits of Eigen's stableNorm() depend on
  // where the vector lies in memory, and it may overlook NaN.
  const double length = std::hypot(normal.x(), normal.y(), normal.z());
  const double way = std::hypot(forward.x(), forward.y(), forward.z());
  if (!(length > 0.0 && std::isfinite(length))) {
    throw Error(contact + " has a normal of length zero or not finite",
                "a direction out of the surface");
  }
  if (!(way > 0.0 && std::isfinite(way))) {
    throw Error(contact + " has a forward direction that is zero or not finite",
                "a direction in the surface");
  }
  Eigen::Matrix3d axes;
  axes.col(2) = normal / length;
  const Eigen::Vector3d across = axes.col(2).cross(forward / way);
  if (!(across.norm() > 1e-9)) {
    throw Error(contact + " has a forward direction along its normal",
                "a direction in the surface");
  }
  axes.col(1) = across.normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

Eigen::Matrix3d axes_in_link(const EndEffector& effector) {
  return contact_axes(contact_of(effector) + " in its link", effector.normal, effector.forward);
}

Eigen::Matrix3d axes_in_world(const Contact& contact) {
  return contact_axes(contact_of(contact.effector), contact.normal,
                      contact.forward.value_or(some_forward(contact.normal)));
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void require_sound_effector(const Robot& robot, const EndEffector& effector) {
  const int link = robot.link_index(effector.link);
  const std::string name = contact_of(effector);
  if (!effector.point.allFinite()) {
    throw Error(name + " is at a place that is not finite", "finite numbers");
  }
  require_positive(effector, "force limit", effector.max_force_N);
  if (effector.kind == ContactKind::kSurface || effector.kind == ContactKind::kGrasp) {
    axes_in_link(effector);
  }
  if (effector.kind == ContactKind::kGrasp) {
    require_not_negative(effector, "moment limit", effector.max_moment_Nm);
    return;
  }
  require_positive(effector, "friction coefficient", effector.friction);
  if (effector.kind == ContactKind::kSurface) {
    require_positive(effector, "half size x", effector.half_x_m);
    require_positive(effector, "half size y", effector.half_y_m);
  } else if (effector.kind == ContactKind::kPoint) {
    require_not_negative(effector, "radius", effector.radius_m);
  } else {
    require_positive(effector, "radius", effector.radius_m);
    const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
    const JointType type =
        joint < 0 ? JointType::kFixed : robot.joints()[static_cast<std::size_t>(joint)].type;
    if (type != JointType::kRevolute && type != JointType::kContinuous) {
      throw Error(name + " is a wheel that no joint turns",
                  "a link below a revolute or continuous joint");
    }
    const Joint& axle = robot.joints()[static_cast<std::size_t>(joint)];
    if (axle.mimics >= 0) {
      throw Error(name + " is a wheel whose joint mimics '" +
                      robot.joints()[static_cast<std::size_t>(axle.mimics)].name + "'",
                  "a wheel that turns on its own");
    }
    const Eigen::Vector3d& axis = axle.axis;
    const double off_m = (effector.point - axis * axis.dot(effector.point)).norm();
    if (!(off_m <= kOnAxle_m)) {
      throw Error(name + " has its centre " + std::to_string(off_m) + " m beside its axle",
                  "a point on the axis that the joint turns about");
    }
  }
}

void require_sound_contact(const Robot& robot, const Contact& contact) {
  require_sound_effector(robot, contact.effector);
  const std::string name = contact_of(contact.effector);
  if (!contact.position.allFinite()) {
    throw Error(name + " is at a place that is not finite", "finite numbers");
  }
  if (contact.effector.kind == ContactKind::kGrasp && !contact.forward) {
    throw Error(name + " is a rung without forward", "a direction across the bar");
  }
  if (contact.locked && contact.effector.kind != ContactKind::kWheel) {
    throw Error(name + " is locked", "wheels only are");
  }
  axes_in_world(contact);
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
