#pragma once
/// EDGE_CONTACT: contact closure: a frame of the robot stays on the contact it has in the world.
///
///     EDGE_CONTACT id  n frame kind x y z qx qy qz qw  weights
///
///     const Eigen::Isometry3d contact = contact_pose(point, normal, forward);
///     graph.add_edge(EdgeContact(3, ContactKind::kSurface, contact, 1e6), configuration);
///
/// The contact's axes: z is the surface normal, out of the surface; x is forward; y, across, is
/// the direction of a bar. The contact is closed when the frame, a PARAMS_FRAME, coincides with it
/// in the coordinates that its kind holds. Error (n), along the contact's axes:
///
///     kind                n  rows
///     surface             6  x y z [m], rotation vector about x y z [rad]
///     surface_free_yaw    5  x y z [m], tilt of the normal about x y [rad]; yaw is free
///     point               3  x y z [m]; the frame may point anywhere
///     rung                5  x y z [m], tilt of the bar about x z [rad]; turning round it is free
///     sliding_rung        4  x z [m], tilt of the bar about x z [rad]; so is sliding along it
///
/// The rotation vector is that of log(Cᵀ F), C and F being the axes of contact and frame; for the
/// tilt see orientation_error.h. Wheels have an edge of their own, EDGE_WHEEL_CONTACT.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/frame_parameter.h>
#include <locograph/plugins/configuration/row_labels.h>

#include <span>

namespace locograph {

enum class ContactKind { kSurface, kSurfaceFreeYaw, kPoint, kRung, kSlidingRung };

/// What it holds, a row of the error each: 0-2 position, 3-5 rotation.
std::span<const int> held_coordinates(ContactKind kind);
std::string_view contact_name(ContactKind kind);
void read_field(FieldReader& in, ContactKind& kind);
void write_field(FieldWriter& out, ContactKind kind);

/// The contact at a point of a surface. `forward` is made normal to the normal; its length does not
/// matter, nor does that of the normal. Throws Error if one of them is zero or not finite, or if
/// they are parallel.
Eigen::Isometry3d contact_pose(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& forward);

struct EdgeContact : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_CONTACT";
  int frame_number = 0;
  ContactKind kind = ContactKind::kSurface;
  SavedPose contact;                            ///< world_from_contact
  std::shared_ptr<const FrameParameter> frame;  ///< looked up by bind()
  std::shared_ptr<const RobotParameter> robot;  ///< whose frame it is, likewise
  auto fields() { return std::tie(frame_number, kind, contact); }
  void bind(const Parameters& parameters) {
    frame = parameters.get<FrameParameter>(frame_number);
    robot = parameters.get<RobotParameter>(frame->robot_number);
    require_rows(kTag, dimension(), static_cast<long>(held_coordinates(kind).size()));
  }

  EdgeContact() = default;
  EdgeContact(int frame_number, ContactKind kind, const Eigen::Isometry3d& world_from_contact,
              double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeContact, 0> j) const;
  RowLabel row_label(int row) const {
    RowLabel label = pose_row(held_coordinates(kind)[row]);
    label.name = frame->link_name + " " + label.name;
    return label;
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeContact::kTag, EdgeContact)
extern template class TypedEdgePool<EdgeContact>;

}  // namespace locograph
