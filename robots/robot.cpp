#include <locograph/common/error.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/names.h>
#include <locograph/robots/robot.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

// sin(x) / x and its like lose no digits above this angle squared; below, the series is exact.
constexpr double kSmallAngleSquared = 1e-8;

/// Unit quaternion of the rotation vector omega.
Eigen::Quaterniond exponential(const Eigen::Vector3d& omega) {
  const double squared = omega.squaredNorm();
  if (squared < kSmallAngleSquared) {
    const Eigen::Vector3d half = (0.5 - squared / 48.0) * omega;
    return Eigen::Quaterniond(1.0 - squared / 8.0, half.x(), half.y(), half.z());
  }
  const double angle = std::sqrt(squared);
  const Eigen::Vector3d vector = std::sin(0.5 * angle) / angle * omega;
  return Eigen::Quaterniond(std::cos(0.5 * angle), vector.x(), vector.y(), vector.z());
}

/// Rotation vector of a unit quaternion, length <= pi.
Eigen::Vector3d logarithm(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  const double cosine = std::abs(q.w());
  if (sine * sine < kSmallAngleSquared) {
    return sign * (2.0 / cosine - 2.0 * sine * sine / (3.0 * cosine * cosine * cosine)) * q.vec();
  }
  return sign * 2.0 * std::atan2(sine, cosine) / sine * q.vec();
}

template <class Items>
int find_by_name(const Items& items, const std::string& name) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

template <class Items>
std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

template <class Items>
int require_by_name(const Items& items, const std::string& name, const std::string& kind,
                    const std::string& file) {
  const int index = find_by_name(items, name);
  if (index < 0) {
    throw Error(file, 0, "no " + kind + " '" + name + "'", similar_names(name, names_of(items)));
  }
  return index;
}

}  // namespace

int Robot::find_link(const std::string& name) const { return find_by_name(links_, name); }
int Robot::find_joint(const std::string& name) const { return find_by_name(joints_, name); }
int Robot::link_index(const std::string& name) const {
  return require_by_name(links_, name, "link", urdf_file_.string());
}
int Robot::joint_index(const std::string& name) const {
  return require_by_name(joints_, name, "joint", urdf_file_.string());
}

Eigen::VectorXd Robot::neutral_configuration() const {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(configuration_size());
  if (floating_base()) q[6] = 1.0;
  for (int i = 0; i < active_joint_count(); ++i) {
    q[base_configuration_size() + i] =
        std::clamp(0.0, active_joint(i).lower, active_joint(i).upper);
  }
  return q;
}

Eigen::VectorXd Robot::named_configuration(const std::string& group_state) const {
  const std::string& file = srdf_file_.empty() ? urdf_file_.string() : srdf_file_.string();
  const int state = require_by_name(states_, group_state, "group_state", file);
  Eigen::VectorXd q = neutral_configuration();
  for (const auto& [joint, position] : states_[static_cast<std::size_t>(state)].positions) {
    const int index = joints_[static_cast<std::size_t>(joint)].index;
    if (index >= 0) q[base_configuration_size() + index] = position;
  }
  return q;
}

double Robot::joint_room(const Eigen::VectorXd& configuration) const {
  double room = std::numeric_limits<double>::infinity();
  for (int i = 0; i < active_joint_count(); ++i) {
    const double at = configuration[base_configuration_size() + i];
    room = std::min({room, at - active_joint(i).lower, active_joint(i).upper - at});
  }
  return std::max(0.0, room);
}

std::vector<std::string> Robot::configuration_names() const { return names_of(states_); }
std::vector<std::string> Robot::group_names() const { return names_of(groups_); }

const std::vector<int>& Robot::group_joints(const std::string& group) const {
  const std::string& file = srdf_file_.empty() ? urdf_file_.string() : srdf_file_.string();
  return groups_[static_cast<std::size_t>(require_by_name(groups_, group, "group", file))].joints;
}

void Robot::integrate(const double* q, const double* tangent, double* out) const {
  if (floating_base()) {
    const Eigen::Quaterniond rotation(q[6], q[3], q[4], q[5]);
    const Eigen::Vector3d velocity(tangent[0], tangent[1], tangent[2]);
    const Eigen::Vector3d omega(tangent[3], tangent[4], tangent[5]);
    const Eigen::Vector3d moved = rotation * velocity;
    const Eigen::Quaterniond turned = (rotation * exponential(omega)).normalized();
    for (int k = 0; k < 3; ++k) out[k] = q[k] + moved[k];
    out[3] = turned.x();
    out[4] = turned.y();
    out[5] = turned.z();
    out[6] = turned.w();
    q += 7;
    tangent += 6;
    out += 7;
  }
  for (int i = 0; i < active_joint_count(); ++i) out[i] = q[i] + tangent[i];
}

void Robot::difference(const double* from, const double* to, double* tangent) const {
  if (floating_base()) {
    const Eigen::Quaterniond base_from_world =
        Eigen::Quaterniond(from[6], from[3], from[4], from[5]).conjugate();
    const Eigen::Vector3d step(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    const Eigen::Vector3d velocity = base_from_world * step;
    const Eigen::Vector3d omega =
        logarithm(base_from_world * Eigen::Quaterniond(to[6], to[3], to[4], to[5]));
    for (int k = 0; k < 3; ++k) {
      tangent[k] = velocity[k];
      tangent[3 + k] = omega[k];
    }
    from += 7;
    to += 7;
    tangent += 6;
  }
  for (int i = 0; i < active_joint_count(); ++i) tangent[i] = to[i] - from[i];
}

std::span<const int> Robot::support(int link) const {
  const std::vector<int>& begin = tree_->support_begin;
  const int first = begin[static_cast<std::size_t>(link)];
  return {tree_->support.data() + first,
          static_cast<std::size_t>(begin[static_cast<std::size_t>(link) + 1] - first)};
}

std::span<const int> Robot::axes_of(int active) const {
  return axes_of_active_[static_cast<std::size_t>(active)];
}

bool Robot::has_collision_shapes() const {
  return std::any_of(links_.begin(), links_.end(),
                     [](const Link& link) { return !link.collision.empty(); });
}

void Robot::require_collision_shapes() const {
  if (has_collision_shapes()) return;
  throw Error(urdf_file_.string(), 0, "no link of the robot has a <collision>",
              "collision shapes, which distances are judged by");
}

std::vector<std::string> Robot::links_without_collision() const {
  std::vector<std::string> names;
  for (const Link& link : links_) {
    if (link.visible && link.collision.empty()) names.push_back(link.name);
  }
  return names;
}

std::vector<std::string> Robot::missing_meshes() const {
  std::vector<std::string> missing;
  for (const Link& link : links_) {
    for (const CollisionShape& shape : link.collision) {
      const bool absent = shape.type == ShapeType::kMesh && !shape.mesh_found;
      const std::string file = shape.mesh_file.string();
      if (absent && std::find(missing.begin(), missing.end(), file) == missing.end()) {
        missing.push_back(file);
      }
    }
  }
  return missing;
}

}  // namespace locograph
