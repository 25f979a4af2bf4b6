#pragma once
/// A kind of contact that exists in tests only: a straight edge along the end effector's y that
/// lies on a surface and may slide along itself, as a skate's does.
///
///     EndEffector skate{.link = "l_sole", .kind = blade(), .half_y_m = 0.1, .friction = 0.5,
///                       .max_force_N = 500.0};
///
/// Rows: across the blade and above the surface [m], the sine of its tilt to the surface. Wrench:
/// fx fz mx.

#include <locograph/robots/contact_kinds.h>

#include <limits>

namespace locograph::test {

class BladeClosure final : public ClosureRows {
 public:
  BladeClosure(const Robot& robot, const Contact& contact)
      : ClosureRows({0, 2, 3}, robot.link_index(contact.effector.link)),
        point_in_link_(contact.effector.point),
        edge_in_link_(axes_in_link(contact.effector).col(1)),
        axes_(axes_in_world(contact)),
        place_(contact.position) {}

  std::optional<ContactRowLabel> label(int row) const override {
    if (row < 2) return std::nullopt;
    return ContactRowLabel{"blade tilt", ""};
  }
  void error(const RobotState& state, double* e) const override {
    const Eigen::Vector3d off = state.world_from_link(link()) * point_in_link_ - place_;
    e[0] = axes_.col(0).dot(off);
    e[1] = axes_.col(2).dot(off);
    e[2] = axes_.col(2).dot(edge(state));
  }
  void add_jacobian(const RobotState& state, double* jacobian,
                    std::ptrdiff_t stride) const override {
    const Eigen::Vector3d point = state.world_from_link(link()) * point_in_link_;
    state.add_point_gradient(link(), point, axes_.col(0), 1.0, jacobian);
    state.add_point_gradient(link(), point, axes_.col(2), 1.0, jacobian + stride);
    state.add_axis_gradient(link(), edge(state), axes_.col(2), 1.0, jacobian + 2 * stride);
  }

 private:
  Eigen::Vector3d edge(const RobotState& state) const {
    return state.world_from_link(link()).linear() * edge_in_link_;
  }

  Eigen::Vector3d point_in_link_, edge_in_link_;
  Eigen::Matrix3d axes_;
  Eigen::Vector3d place_;
};

class BladeCone final : public WrenchCone {
 public:
  explicit BladeCone(const EndEffector& blade) : WrenchCone({0, 2, 3}, 6), blade_(blade) {}

  /// −fz, fz − f_max, ±fx − μ fz, ±mx − Y fz.
  WrenchRow row(int i, const double*) const override {
    WrenchRow limit;
    if (i < 2) {
      limit.gradient[1] = i == 0 ? -1.0 : 1.0;
      limit.offset = i == 0 ? 0.0 : -blade_.max_force_N;
      return limit;
    }
    limit.gradient[i < 4 ? 0 : 2] = i % 2 == 0 ? 1.0 : -1.0;
    limit.gradient[1] = i < 4 ? -blade_.friction : -blade_.half_y_m;
    return limit;
  }
  ContactRowLabel label(int i) const override {
    if (i >= 4) return {"centre of pressure", "N m"};
    return {i < 2 ? "normal force" : "friction", "N"};
  }

 private:
  EndEffector blade_;
};

struct BladeContact final : ContactKindEntry {
  BladeContact()
      : ContactKindEntry("blade", {effector_fields::kHalfY, effector_fields::kFriction,
                                   effector_fields::kMaxForce}) {
    axes_on_link = true;
    forward_needed = "across the blade";
  }

  std::unique_ptr<const ClosureRows> closure(const Robot& robot,
                                             const Contact& contact) const override {
    return std::make_unique<BladeClosure>(robot, contact);
  }
  std::unique_ptr<const WrenchCone> wrench_cone(const Contact& contact,
                                                const FrictionModel&) const override {
    return std::make_unique<BladeCone>(contact.effector);
  }
  /// Forces across the blade on both edges of the friction cone, at both ends.
  std::vector<BearingRay> rays(const BearingContact& bearing, double part, double) const override {
    const Contact& contact = bearing.contact;
    const Eigen::Matrix3d axes = axes_in_world(contact);
    std::vector<BearingRay> rays;
    for (const double end : {1.0, -1.0}) {
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d along(side * part * contact.effector.friction, 0.0, 1.0);
        rays.push_back({contact.position + end * part * contact.effector.half_y_m * axes.col(1),
                        axes * along, Eigen::Vector3d::Zero(), 0.0,
                        std::numeric_limits<double>::max()});
      }
    }
    return rays;
  }
};

/// Its number: it is added to the table of this program once.
inline ContactKind blade() {
  static const BladeContact entry;
  static const ContactKind kind = add_contact_kind(entry);
  return kind;
}

}  // namespace locograph::test
