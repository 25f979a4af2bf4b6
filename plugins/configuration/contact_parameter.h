#pragma once
/// PARAMS_CONTACT: an end effector of a robot at its place in the world, and what it can bear
/// there.
///
///     PARAMS_CONTACT n robot NAME link KIND  x y z  nx ny nz  tx ty tz
///                    at x y z  nx ny nz  tx ty tz|free  [unloaded] [locked] [bar R  ax ay az]
///                    [inner K|outer K]
///     PARAMS_CONTACT 4 0 left_foot l_sole surface 0.08 0.035 0.5 1000  0 0 0  0 0 1  1 0 0
///                    at 0 0.1 0  0 0 1  1 0 0                                       (one line)
///     PARAMS_CONTACT 5 0 hand TCP_L point 0 0.5 400  0 0 0  0 0 1  1 0 0  at 0.5 0 1  -1 0 0  free
///
/// All of a Contact (robots/contact.h): name of the end effector ("" for none), link, kind, and on
/// the link its point [m], normal and forward; `at`: position [m], normal and forward in the world,
/// `free` where it has no forward; `bar`, of a ball that touches one, its radius [m] and the
/// direction of its axis. KIND and its fields are those of the table of kinds
/// (robots/contact_kinds); here with the components of the wrench:
///
///   surface half_x half_y friction f_max   fx fy fz mx my mz   a rectangle about the point [m]
///   point radius friction f_max            fx fy fz            a ball, or a bare point: radius 0
///   rung f_max m_max                       fx fy fz mx mz      a bar along y, held by a grasp
///   wheel radius friction f_max            fx fy fz
///
/// f_max [N] bounds fz, for a rung each |component| of the force; m_max [N m] each |moment| of a
/// rung. Friction is a circular cone; `inner K` makes it the pyramid of K sides inside that cone,
/// `outer K` the one around it, for edges; the judge does not look at it.
///
/// Wrenches act on the robot, about the touching point, along the contact's axes. Those of surfaces
/// and rungs are fixed in the link, a sole's and a grasp's. Those of points and wheels are fixed in
/// the world, since these may turn on their contact: their force acts a radius below the ball's or
/// the wheel's centre, against the normal. Where a ball rolls about a bar, they turn about that
/// with the normal.

#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/robots/wrench_cone.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

namespace locograph {

struct ContactParameter final : Parameter {
  int robot_number = 0;
  Contact contact;
  FrictionModel friction;
  std::shared_ptr<const RobotParameter> robot;
  int link = -1;
  ContactClosure closure;
  bool axes_in_world = false;
  Eigen::Matrix3d axes;  ///< columns x, y, z: in the link frame or, axes_in_world, in the world
  /// From the effector's point to where its force acts, fixed in the world; zero where the axes
  /// are fixed in the link.
  Eigen::Vector3d touching_offset = Eigen::Vector3d::Zero();
  std::optional<BallTrack> about_bar;  ///< of a ball on a bar
  /// What it can bear: components of its wrench, rows of their limits.
  std::shared_ptr<const WrenchCone> cone;

  ContactParameter() = default;
  /// Throws Error for a contact that is not sound (robots/contact.h), and for a friction model that
  /// its kind cannot have.
  ContactParameter(std::shared_ptr<const RobotParameter> robot, int robot_number, Contact contact,
                   const FrictionModel& friction = {});

  ContactKind kind() const { return contact.effector.kind; }

  std::string_view tag() const override { return "PARAMS_CONTACT"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

using ContactList = std::vector<std::shared_ptr<const ContactParameter>>;

}  // namespace locograph
