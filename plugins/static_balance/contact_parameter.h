#pragma once
/// PARAMS_CONTACT: a place where a robot touches the world, and the wrenches it can bear there.
///
///     PARAMS_CONTACT n robot link  x y z  link|world nx ny nz tx ty tz  KIND  [inner K|outer K]
///     PARAMS_CONTACT 4 0 l_sole  0 0 0  link 0 0 1 1 0 0  surface 0.08 0.035 0.5 1000
///     PARAMS_CONTACT 5 0 TCP_L   0 0 0  world -1 0 0 0 0 1  point 0.5 1000 inner 8
///     PARAMS_CONTACT 6 0 TCP_R   0 0 0  link 0 0 1 1 0 0  rung 500 0
///
/// The contact point x y z [m] is fixed in the link. The contact's axes: z is the normal n, out of
/// the surface; x is t made normal to it; y completes them. They are fixed in the link (a sole), or
/// in the world (a ball or a wheel that may turn on its contact). Wrenches act on the robot, about
/// the contact point, along these axes. KIND, with the components of its wrench:
///
///     surface half_x half_y mu f_max   fx fy fz mx my mz   a rectangle about the point [m]
///     point mu f_max                   fx fy fz
///     rung f_max m_max                 fx fy fz mx mz      a bar along y, held by a grasp
///
/// mu: Coulomb's friction; f_max [N] bounds fz, for a rung each |component| of the force; m_max
/// [N m] bounds each |moment| of a rung. Friction is a circular cone; `inner K` makes it the
/// pyramid of K sides inside that cone, `outer K` the one around it.

#include <locograph/plugins/configuration/robot_parameters.h>

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace locograph {

enum class WrenchKind { kSurface, kPoint, kRung };
enum class FrictionCone { kCircle, kInner, kOuter };

/// What a PARAMS_CONTACT says.
struct ContactDescription {
  std::string link;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, link frame
  bool axes_in_world = false;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< of any length
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< of any length, not along the normal
  WrenchKind kind = WrenchKind::kSurface;
  double half_x_m = 0.0, half_y_m = 0.0;  ///< surface
  double mu = 0.0;                        ///< surface and point
  double max_force_N = 0.0;
  double max_moment_Nm = 0.0;  ///< rung
  FrictionCone cone = FrictionCone::kCircle;
  int facets = 0;  ///< of a cone that is no circle
};

struct ContactParameter final : Parameter {
  int robot_number = 0;
  ContactDescription given;
  std::shared_ptr<const RobotParameter> robot;
  int link = -1;
  Eigen::Matrix3d axes;  ///< columns x, y, z: in the link frame or, axes_in_world, in the world
  std::vector<Eigen::Vector2d> facets;  ///< outward unit normals of the pyramid's sides
  double facet_mu = 0.0;                ///< facet · (fx, fy) <= facet_mu fz
  /// Friction coefficient in the yaw rows of the contact wrench cone, which hold for corner forces
  /// in a pyramid of four sides: mu / √2 makes it an inner one.
  double yaw_mu = 0.0;

  ContactParameter() = default;
  /// Throws Error for an unknown link, a normal that is zero or along `forward`, and sizes,
  /// friction or limits that are not positive (m_max: negative).
  ContactParameter(std::shared_ptr<const RobotParameter> robot, int robot_number,
                   ContactDescription description);

  /// Components of its wrench: indices into fx fy fz mx my mz.
  std::span<const int> components() const;
  /// Rows of the limits on its wrench (edge_contact_wrench.h).
  int limit_rows() const;

  std::string_view tag() const override { return "PARAMS_CONTACT"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

}  // namespace locograph
