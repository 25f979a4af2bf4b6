#pragma once
/// Whether contacts can hold a robot still, how far it is from not being held, and the wrenches
/// that prove it: a linear programme of its own, which
/// shares no code with any edge.
///
///     BalanceCertificate certificate = certify_balance(robot, configuration, stance.contacts);
///     if (!certificate.balanced) std::cerr << certificate.limiting << '\n';
///
/// The unknowns are forces: one at a point contact and where a wheel touches, one at each corner of
/// a surface contact, each inside the pyramid of `facets` sides that is inscribed in Coulomb's
/// cone; force and moment at a rung (no moment about its bar). The axes of surfaces and rungs are
/// those of the end effector, those of points and wheels the contact's in the world. A ball bears
/// at its lowest point along the contact's normal, a wheel at that of its disc. W is the robot's
/// weight, J the contact Jacobian, g(q) what gravity asks for, s the margin. Largest s <= 1 with
///
///   equilibrium      (sum J^T w)_base = g_base                     (floating base only)
///   friction         n_k . f_t + s W / c <= mu cos(pi/facets) f_z  each force, c: corners
///   pressing limit   f_z <= (1 - s) f_max                          of the whole contact
///   rung             |component| <= (1 - s) limit                  of each force and moment
///   torque limits    |g - sum J^T w| <= (1 - s) tau_max            each active joint
///
/// tau_max is the URDF's effort times BalanceOptions::effort_scale.
///
/// So a margin of 0.1 says: with one and the same wrenches, every limit is used to 90 % at most and
/// every friction cone has a tenth of the weight in reserve (a surface as a whole; then its centre
/// of pressure, too, has a tenth of weight times half size to the edge, for mu <= 1). If nothing
/// balances, the same rows with s < 0 and
/// equilibrium within |s| W and |s| W times 1 m have the margin that is nearest to zero: the least
/// violation. Contacts that cannot hold the robot whatever the friction are no error but a negative
/// margin.
///
/// Forces at the corners are all that forces on a rectangle bear (a force inside it is a mixture of
/// the same force at the corners), so that centre of pressure and yaw need no rows of their own,
/// and at the corners the pyramid makes the result conservative: friction of at least
/// cos(pi/facets) mu in every direction, 0.98 mu for 16 sides, for yaw as well.
///
/// Where contacts are in the world is not compared with the configuration: they are taken to be
/// closed. Contacts that bear no load have no unknowns.
///
/// In motion, what equilibrium and torques have to hold is inverse dynamics M a + h instead of g;
/// loads are taken from it.
///
/// Deterministic; const arguments may be shared between threads. A joint without an effort in the
/// URDF (infinite) has no row; one whose effort is zero or less is an Error while torque limits are
/// enforced or least torques asked for: it cannot hold anything.
/// Throws Error for a configuration of another size, one that is not finite or has a quaternion
/// far from norm 1, an end effector that is not sound (robots/contact.h), axes that are none, fewer
/// than 3 facets, a scale of efforts that is not positive, and a robot without mass.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/statics.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

/// Velocity and acceleration of a configuration, in the order of Robot::tangent_size().
struct BalanceMotion {
  Eigen::VectorXd velocity, acceleration;
};

struct BalanceOptions {
  bool enforce_torque_limits = true;
  double effort_scale = 1.0;  ///< of the efforts of the URDF
  int facets = 16;            ///< sides of the friction pyramids, 3 to 64
  /// A second programme: max_torque_ratio becomes the least with which the contacts can balance the
  /// robot, at a margin of zero; at most one exactly if torque limits can be kept.
  bool least_torques = false;
  /// For each contact, the corners of the area that bears, in the axes of a surface contact about
  /// its point [m]; two are a line; none: its rectangle. No list at all: rectangles.
  std::vector<std::vector<Eigen::Vector2d>> areas = {};
  std::optional<BalanceMotion> motion = std::nullopt;  ///< none: at rest
  std::vector<PointWrench> loads = {};                 ///< that act on it besides gravity
  /// False: where nothing balances, the margin is minus infinity, and no violation is sought.
  bool least_violation = true;
};

struct BalanceCertificate {
  bool balanced = false;  ///< margin >= 0 up to 1e-6, and the wrenches were verified
  double margin = 0.0;    ///< at most 1; > 0 inside all limits, < 0 outside
  /// Largest |torque| / limit, joints without a positive finite limit left out: with these
  /// wrenches (which are for the margin's sake as large as 1 - margin allows), or
  /// BalanceOptions::least_torques. If no wrenches balance, of those that violate least.
  double max_torque_ratio = 0.0;
  /// On the robot, about the contact point, along the contact's axes; zero for one that bears no
  /// load.
  StanceWrenches wrenches;
  /// The same at each corner and point that bears, in the order of contacts and corners, about it:
  /// for nearby_balance.h. Of a negative margin none.
  StanceWrenches at_places;
  StanceWrenches least_at_places;  ///< with the least torques
  std::string limiting;            ///< what the margin depends on most, in words
};

BalanceCertificate certify_balance(const Robot& robot, const Eigen::VectorXd& configuration,
                                   std::span<const Contact> contacts,
                                   const BalanceOptions& options = {});

}  // namespace locograph
