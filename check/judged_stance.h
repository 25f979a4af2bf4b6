#pragma once
/// A stance as the judge takes it: with what is known of its end effectors, the surfaces and bars
/// that its contacts lie on, and the links that touch there.
///
///     JudgedStance stance(robot, world, motion.stances[0], options.known);
///     ContactError error = closure_error(stance.contacts[0], world_from_link);
///     Support support = support_of(stance.contacts[0], world, world_from_link);
///
/// Surface contacts, points and wheels lie on surfaces; surface contacts, points and grasps on
/// bars, see bar_contact.h.
///
/// A point with a radius is a ball: its contact's position is where it touched down, and from there
/// it rolls (ball_rolling.h) on the plane of that place or, where that is on no surface but on a
/// bar, round the bar. Where it bears is where it has got to, with the normal there.
///
/// Closure (robots/contact.h) is worked out here anew, from the poses of links: nothing is shared
/// with the rows that solvers close contacts with.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

struct JudgedContact {
  Contact contact;  ///< its end effector is the known one, if there is one of its name
  int link = -1, body = -1;
  Eigen::Vector3d normal;  ///< of the contact in the world, of length 1
  std::vector<int> links;  ///< that touch: its body and those below it; no fork beside a wheel
  /// Of World::surfaces: those in the plane of the contact; a grasp is on none.
  std::vector<int> surfaces;
  std::vector<int> bars;  ///< of World::bars: those it is on, or beyond an end of
  /// To the nearest plane that has its normal, or to a bar with a direction that fits; infinite if
  /// there is neither. 0 in a world without surfaces and bars.
  double off_surface_m = 0.0;
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();  ///< wheel: of its joint, link frame
  int wheel_joint = -1;                            ///< active joint that turns it; -1: none
  std::optional<Bar> rolls_round = std::nullopt;   ///< a ball on a bar

  /// Rolls while it is held.
  bool is_ball() const {
    return contact.effector.kind == ContactKind::kPoint && contact.effector.radius_m > 0.0;
  }
  bool is_wheel() const { return contact.effector.kind == ContactKind::kWheel; }
  bool is_grasp() const { return contact.effector.kind == ContactKind::kGrasp; }
  /// On something that the world has.
  bool is_placed() const { return !surfaces.empty() || !bars.empty(); }
  /// Stays where it is, or rolls by turning only: no wheel, or a locked one.
  bool is_held() const { return !is_wheel() || contact.locked; }
  const std::string& name() const { return contact.name(); }
};

/// The world says what there is to touch.
inline bool has_places(const World& world) {
  return !world.surfaces.empty() || !world.bars.empty() || !world.solids.empty();
}

struct JudgedStance {
  std::vector<JudgedContact> contacts;
  std::vector<bool> touching;  ///< links, all contacts together
  /// Contacts that claim more than is known; contacts that are something else than is known, so
  /// that they are judged as what they claim to be.
  std::vector<std::string> larger, other;
  std::vector<std::string> unknown;  ///< names that nothing is known of

  /// Throws Error for a stance that is not sound.
  JudgedStance(const Robot& robot, const World& world, const Stance& stance,
               std::span<const EndEffector> known, std::span<const Contact> places = {});

  /// Where links touch in a configuration, and which of the surfaces: those under the area of the
  /// contact; barely, those beside it in the same plane. In the order of the contacts.
  std::vector<CollisionWorld::Touch> touches(const World& world,
                                             std::span<const Eigen::Isometry3d> poses) const;
};

struct ContactError {
  double position_m = 0.0, angle_rad = 0.0;
  bool holds_direction = true;
};

/// Of a ball: how far it is above or in what it rolls on, wherever it has got to.
ContactError closure_error(const JudgedContact& contact,
                           std::span<const Eigen::Isometry3d> world_from_link);

/// The contact where it is: a ball's position, normal and forward are those of the place that it
/// has rolled to, on a bar turned about its axis with it. All others as they are.
Contact contact_at(const JudgedContact& contact,
                   std::span<const Eigen::Isometry3d> world_from_link);

/// The lowest point of a wheel's disc along its contact's normal, the centre of a disc that lies
/// flat; of a ball, the one towards what it rolls on; of other kinds, the point that is to be at
/// the contact's position.
Eigen::Vector3d touching_point(const JudgedContact& contact,
                               std::span<const Eigen::Isometry3d> world_from_link);

/// What of a contact lies on the surfaces and bars of the world.
struct Support {
  bool known = false;      ///< it is on something that the world has, or beyond its border
  double outside_m = 0.0;  ///< beyond the border of the nearest one; 0: some of it lies on one
  double friction = 0.0;   ///< the least of what it lies on, else the end effector's
  /// Corners of the area that bears, about the point in the end effector's axes; of a surface
  /// contact only. On a single bar they are the two ends of a line.
  std::vector<Eigen::Vector2d> area;
};

Support support_of(const JudgedContact& contact, const World& world,
                   std::span<const Eigen::Isometry3d> world_from_link);

/// A contact as it bears: where it is, with the friction of what it lies on. What is beyond the
/// border of its surface bears nothing.
struct JudgedBearing {
  Contact contact;
  std::vector<Eigen::Vector2d> area;  ///< as in Support
};

JudgedBearing bearing_at(const JudgedContact& contact, const World& world,
                         std::span<const Eigen::Isometry3d> world_from_link);

/// The same end effector: the same point of the same body, touching in the same way.
bool same_effector(const JudgedContact& a, const JudgedContact& b);
/// Of a stance, the contact with the same end effector; null: none.
const JudgedContact* contact_of(const JudgedStance& stance, const JudgedContact& contact);

}  // namespace locograph
