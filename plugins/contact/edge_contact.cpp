#include <locograph/plugins/configuration/orientation_error.h>
#include <locograph/plugins/configuration/surface_axes.h>
#include <locograph/plugins/contact/edge_contact.h>

#include <array>
#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeContact>;

namespace {

struct Kind {
  std::string_view name;
  std::array<int, 6> held;
  std::size_t rows;
};
constexpr Kind kKinds[] = {{"surface", {0, 1, 2, 3, 4, 5}, 6},
                           {"surface_free_yaw", {0, 1, 2, 3, 4}, 5},
                           {"point", {0, 1, 2}, 3},
                           {"rung", {0, 1, 2, 3, 5}, 5},
                           {"sliding_rung", {0, 2, 3, 5}, 4}};

const Kind& properties(ContactKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

/// Calls f with the error of orientation of this kind of contact; a point has none.
template <class F>
void with_orientation(ContactKind kind, const Eigen::Matrix3d& contact,
                      const Eigen::Matrix3d& frame, F&& f) {
  switch (kind) {
    case ContactKind::kSurface:
      return f(OrientationError(contact, frame));
    case ContactKind::kSurfaceFreeYaw:
      return f(TiltError(contact, frame, 2));
    case ContactKind::kRung:
    case ContactKind::kSlidingRung:
      return f(TiltError(contact, frame, 1));
    case ContactKind::kPoint:
      return;
  }
}

}  // namespace

std::span<const int> held_coordinates(ContactKind kind) {
  return {properties(kind).held.data(), properties(kind).rows};
}

std::string_view contact_name(ContactKind kind) { return properties(kind).name; }

void read_field(FieldReader& in, ContactKind& kind) {
  const std::string word = in.word();
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    if (kKinds[k].name != word) continue;
    kind = static_cast<ContactKind>(k);
    return;
  }
  std::string expected;
  for (const Kind& known : kKinds) {
    expected += (expected.empty() ? "'" : ", '") + std::string(known.name) + "'";
  }
  in.fail("contact of kind '" + word + "'", "one of " + expected);
}

void write_field(FieldWriter& out, ContactKind kind) { out.word(contact_name(kind)); }

Eigen::Isometry3d contact_pose(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& forward) {
  if (!point.allFinite()) throw Error("a contact whose point is not finite", "a point");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = point;
  pose.linear() = surface_axes("a contact", normal, forward);
  return pose;
}

EdgeContact::EdgeContact(int number, ContactKind kind_, const Eigen::Isometry3d& world_from_contact,
                         double weight)
    : frame_number(number), kind(kind_), contact(world_from_contact) {
  weights.setConstant(static_cast<Eigen::Index>(held_coordinates(kind).size()), weight);
}

void EdgeContact::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, q.robot, robot);
  const Eigen::Matrix3d axes = contact.rotation.toRotationMatrix();
  const Eigen::Isometry3d now = frame->world_from_frame(q.kinematics);
  Eigen::Matrix<double, 6, 1> all;
  all.head<3>() = axes.transpose() * (now.translation() - contact.position);
  with_orientation(kind, axes, now.linear(),
                   [&](const auto& turned) { all.tail<3>() = turned.vector; });
  const std::span<const int> held = held_coordinates(kind);
  for (std::size_t r = 0; r < held.size(); ++r) e[r] = all[held[r]];
}

void EdgeContact::jacobians(const ConfigurationState& q, JacobianRef<EdgeContact, 0> j) const {
  const Eigen::Matrix3d axes = contact.rotation.toRotationMatrix();
  const Eigen::Isometry3d now = frame->world_from_frame(q.kinematics);
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();
  with_orientation(kind, axes, now.linear(),
                   [&](const auto& turned) { turning = turned.derivative(); });
  const std::span<const int> held = held_coordinates(kind);
  for (std::size_t r = 0; r < held.size(); ++r) {
    const int c = held[r];
    double* row = j.row(r).data();
    if (c < 3) {
      q.kinematics.add_point_gradient(frame->link, now.translation(), axes.col(c), 1.0, row);
    } else {
      q.kinematics.add_rotation_gradient(frame->link, turning.row(c - 3).transpose(), 1.0, row);
    }
  }
}

}  // namespace locograph
