#pragma once
/// Where a robot touches the world: end effectors, contacts and stances, as plain values.
///
///     EndEffector foot{.name = "left_foot", .link = "l_sole", .kind = ContactKind::kSurface,
///                      .half_x_m = 0.08, .half_y_m = 0.04, .friction = 0.6,
///                      .max_force_N = 1000.0};
///     Contact standing{.effector = foot, .position = {0.0, 0.1, 0.0},
///                      .forward = Eigen::Vector3d::UnitX()};
///     Stance stance{.contacts = {standing}};
///     require_sound_stance(robot, stance);
///
/// An end effector is a place on the robot, its kind and what it can bear. A contact is an end
/// effector at its place in the world. A stance is the set of contacts that hold together.
///
/// The end effector's axes, fixed in its link: z is `normal`, which points out of the touched
/// surface into the robot; x is `forward` made normal to it; y completes them. Those of the contact
/// are made of its own normal and forward in the world. A contact is closed when:
///
///   surface   point, normal and forward of link and world coincide; without `forward`, yaw about
///             the normal is free
///   point     `point` is at `position`, or, with a radius (a ball) as it touches down, that far
///             above it along the normal; the link may turn in any way
///   rung      `point` is at `position` and the bar, normal × forward, has the world's direction;
///             turning round the bar is free
///   wheel     the disc of `radius_m` about `point`, normal to the axis of the joint above the
///             link, touches the plane through `position` along `normal`, and the axle lies along
///             that plane; the touching point may be anywhere in it, that of a locked wheel is at
///             `position`
///
/// While a stance is held its surfaces, bare points and rungs stay where they are. A ball rolls
/// (rolling_ball.h): its contact says where it has touched down. A wheel rolls, too: its
/// touching point moves along its heading only, as far as the disc turns. A locked wheel stands
/// still on the ground: its touching point stays, and its joint turns back what its carrier
/// pitches.

#include <locograph/robots/contact_kind_table.h>
#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

/// kSurface, kPoint, kGrasp, kWheel: the kinds of contact_kind_table.h, in its order.
enum class ContactKind {
#define LOCOGRAPH_CONTACT_ENUMERATOR(enumerator, entry) enumerator,
  LOCOGRAPH_CONTACT_KINDS(LOCOGRAPH_CONTACT_ENUMERATOR)
#undef LOCOGRAPH_CONTACT_ENUMERATOR
};

/// In files: "surface", "point", "rung", "wheel".
const std::string& contact_kind_name(ContactKind kind);
/// Nothing for another word.
std::optional<ContactKind> contact_kind_of(const std::string& name);
/// "surface, point, rung or wheel", each name between quotes.
std::string contact_kind_names(const std::string& quote = "");

struct EndEffector {
  std::string name = {};  ///< contacts files may leave it empty
  std::string link = {};
  ContactKind kind = ContactKind::kSurface;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< m, link frame; a wheel's centre
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< link frame, any length
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< link frame, any length
  double half_x_m = 0.0, half_y_m = 0.0;               ///< surface: a rectangle about the point
  double radius_m = 0.0;       ///< wheel: of the disc; point: of the ball, 0 for a bare point
  double friction = 0.0;       ///< Coulomb's coefficient; surface, point and wheel
  double max_force_N = 0.0;    ///< of the pressing force; rung: of each component
  double max_moment_Nm = 0.0;  ///< rung: of each component
};

/// The axis is a direction of any length, across the normal of the contact, which lies on the bar.
struct RoundBar {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double radius_m = 0.0;
};

struct Contact {
  EndEffector effector;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     ///< m, world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();      ///< world, out of the surface, any length
  std::optional<Eigen::Vector3d> forward = std::nullopt;  ///< world; a rung must have one
  bool bears_load = true;                      ///< false: closed, but balance does not count on it
  bool locked = false;                         ///< a wheel that stands still
  std::optional<RoundBar> bar = std::nullopt;  ///< that a ball touches; none: a plane

  /// The end effector's name, or its link's.
  const std::string& name() const { return effector.name.empty() ? effector.link : effector.name; }
};

/// What a row of a contact's closure or of its wrench cone is called.
struct ContactRowLabel {
  std::string name, unit;
};

struct Stance {
  std::vector<Contact> contacts = {};
};

/// fx fy fz mx my mz of each contact of a stance [N, N m]: on the robot, about the contact point,
/// along the contact's axes; zero for a contact that bears no load.
using StanceWrenches = std::vector<Eigen::Matrix<double, 6, 1>>;

/// Columns x, y, z: `forward` made normal to the normal, across, normal. Lengths do not matter.
/// Throws Error, in the name of the contact, if one of them is zero or not finite, or if they are
/// parallel.
Eigen::Matrix3d contact_axes(const std::string& contact, const Eigen::Vector3d& normal,
                             const Eigen::Vector3d& forward);

/// The end effector's axes in its link.
Eigen::Matrix3d axes_in_link(const EndEffector& effector);
/// The contact's axes in the world. Without `forward`, any direction across the normal is x.
Eigen::Matrix3d axes_in_world(const Contact& contact);

/// Of two vectors of any length [rad].
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Throws Error, naming the end effector, for an unknown link, numbers that are not finite, axes
/// that are none, sizes, friction or limits that are not positive (max_moment_Nm, a ball's radius:
/// negative), a wheel that no revolute or continuous joint turns, and one whose
/// centre is not on its axle.
void require_sound_effector(const Robot& robot, const EndEffector& effector);

/// Throws Error for a place that is not finite, a normal that is zero or along forward, a rung
/// without forward, a lock on what is no wheel, and a bar without axis or radius or whose axis is
/// not across the normal. Of the end effector nothing is asked.
void require_sound_place(const Contact& contact);

/// Both for a contact and its end effector.
void require_sound_contact(const Robot& robot, const Contact& contact);

/// The same for every contact, and throws Error for a stance without contacts or without one that
/// bears load, an end effector that touches twice, and contacts that contradict each other: points
/// fixed to each other in the robot whose places are not as far apart, or whose normals are not at
/// the same angle.
void require_sound_stance(const Robot& robot, const Stance& stance);

/// Links that touch something in a stance: those fixed to a contact's link, and those on the next
/// joint behind.
std::vector<bool> touching_links(const Robot& robot, std::span<const Contact> contacts);

}  // namespace locograph
