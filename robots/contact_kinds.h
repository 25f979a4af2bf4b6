#pragma once
/// What the library knows of one kind of contact: an entry of the table of kinds.
///
///     const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
///     const bool stays = !kind.rolls || contact.locked;
///     const std::unique_ptr<const ClosureRows> rows = kind.closure(robot, contact);
///
/// The entry of a kind of contact_kind_table.h is a constant object in a file of its own,
/// NAME_contact.cpp. What is generic asks it and does not name kinds: ContactClosure,
/// PARAMS_CONTACT and its edges, scenarios and contacts files, linear programmes of balance,
/// places, scenes. What turns wheels names them, and so does the judge (check/), which shares no
/// rule with this table.

#include <locograph/robots/bearing_rays.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/robots/effector_field.h>
#include <locograph/robots/wrench_cone.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// How a kind touches a bar: not at all, its side with the point or across the area, or round it.
enum class BarTouch { kNone, kPoint, kArea, kGrasp };

struct ContactKindEntry {
  std::string name;                   ///< in files
  std::vector<EffectorField> fields;  ///< in the order of PARAMS_CONTACT; friction and force last

  // How it holds.
  /// The end effector's normal and forward say how its link is held. Its wrench turns with the
  /// link; without axes it is fixed in the world.
  bool axes_on_link = false;
  bool holds_normal = false;  ///< closed, the link's normal is the contact's
  bool turns_freely = false;  ///< closed, the link may turn in any way
  bool rolls = false;         ///< the touching point moves, unless the contact is locked
  bool stood_on = false;      ///< a robot is placed by it rather than by what it holds on to
  /// Of a contact that needs it, where `forward` points, for messages: "across the bar".
  std::string forward_needed = {};

  // What it bears: pressed on something, its rays add up to the limit of force at most.
  bool pressed = true;

  // Where it touches.
  bool touches_surfaces = true;
  BarTouch bar_touch = BarTouch::kNone;

  ContactKindEntry(std::string name, std::vector<EffectorField> fields);
  virtual ~ContactKindEntry() = default;

  // What it has follows from its fields.
  bool has_area() const { return has_area_; }  ///< a rectangle about its point
  bool is_round() const { return is_round_; }  ///< its point is a radius above the place
  bool has_friction() const { return has_friction_; }

  /// Throws Error for what is wrong beyond single numbers and axes.
  virtual void require_sound(const Robot& robot, const EndEffector& effector) const;

  /// The rows that hold it; the contact, a sound one, says all that they depend on.
  virtual std::unique_ptr<const ClosureRows> closure(const Robot& robot,
                                                     const Contact& contact) const = 0;

  /// Throws Error for a friction model that it cannot have.
  virtual std::unique_ptr<const WrenchCone> wrench_cone(const Contact& contact,
                                                        const FrictionModel& friction) const = 0;
  /// part: what may be used of friction, area and limits of force.
  virtual std::vector<BearingRay> rays(const BearingContact& bearing, double part,
                                       double weight_N) const = 0;

  /// How far from a surface's border, along its axes, an end effector is put where there is room.
  virtual Eigen::Vector2d inset_m(const EndEffector& effector) const;

  /// Where it is drawn: in the world, for the robot as it stands.
  virtual Eigen::Vector3d touching_point(const RobotState& state, const Contact& contact) const;

 private:
  bool has_area_, is_round_, has_friction_;
};

/// Throws Error for a number that is no kind's.
const ContactKindEntry& contact_kind_entry(ContactKind kind);

/// From its point to a corner of its area; 0 of a kind that has none.
double area_reach_m(const EndEffector& effector);

/// Adds a kind that is not in contact_kind_table.h, for a program of its own; the judge refuses it.
/// The entry must outlive all contacts. Not while other threads use contacts. Throws Error for a
/// name that another kind has, and when there are too many.
ContactKind add_contact_kind(const ContactKindEntry& entry);

#define LOCOGRAPH_CONTACT_ENTRY(enumerator, entry) const ContactKindEntry& entry();
LOCOGRAPH_CONTACT_KINDS(LOCOGRAPH_CONTACT_ENTRY)
#undef LOCOGRAPH_CONTACT_ENTRY

}  // namespace locograph
