#pragma once
/// A contact as a controller counts on it: where it is, and what wrench it can bear.
///
///     const HeldContact held(motion.stances[0].contacts[0], {}, {.friction = 0.7, .area = 0.9});
///     const WrenchRow limit = held.row(0);            // gradient · wrench + offset <= 0
///
/// Of a surface contact only what lies on something bears: the largest rectangle along its axes
/// inside the area. Its wrench cone is that of a sole of this size about the rectangle's middle,
/// written for wrenches about the contact's point. Does not allocate after the constructor; const
/// functions may be shared between threads.

#include <locograph/robots/contact.h>
#include <locograph/robots/wrench_cone.h>

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>

namespace locograph {

/// Its name, or its link's, as Contact::name().
const std::string& name_of(const EndEffector& effector);
/// The one that a contact is of, by its name; their count: none is.
std::size_t effector_of(std::span<const EndEffector> effectors, const Contact& contact);

/// Of what rolls, a ball or a wheel; 0: it does not.
double rolling_radius_m(const EndEffector& effector);
/// Of what a contact touches where its end effector's point is: of a bar it goes along with a ball.
Eigen::Vector3d normal_at(const Contact& contact, const Eigen::Vector3d& point);

/// What is used of what contacts have.
struct HoldingShares {
  double friction = 0.7;       ///< and of the forces and moments of a grasp
  double area = 0.95;          ///< of lengths, about its middle
  double most_friction = 1.0;  ///< where that does not hold the robot

  /// Throws Error naming the share that is not above 0, or above 1.
  void validate() const;
};

class HeldContact {
 public:
  /// contact: with the friction of what it lies on. area: corners of what of a surface contact lies
  /// on something, about its point along its axes [m]; none: all of its rectangle.
  HeldContact(const Contact& contact, std::span<const Eigen::Vector2d> area,
              const HoldingShares& shares = {});

  const Contact& contact() const { return contact_; }
  const WrenchCone& cone() const { return *cone_; }
  /// Half of the sides of what of a surface contact is counted on, along its axes [m].
  const Eigen::Vector2d& half_m() const { return half_m_; }
  /// Of the cone, for a wrench about the contact's point along its axes. reserve: from 0, friction
  /// as it is used, to 1, the most of it. Of a contact that may pull, too, the same holds for the
  /// wrench with the other sign.
  WrenchRow row(int i, double reserve = 0.0) const;
  /// Whether it can only be pressed; a grasp may be pulled at.
  bool pressed() const { return pressed_; }

 private:
  Contact contact_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero(), half_m_ = Eigen::Vector2d::Zero();
  std::shared_ptr<const WrenchCone> cone_, widest_;
  bool pressed_;
};

/// The largest rectangle along the axes inside the convex hull of some points, as two opposite
/// corners: lower, upper. Of points on a line, what of it is along the axis nearer to it. At least
/// one point.
struct InnerRectangle {
  Eigen::Vector2d lower, upper;
};
InnerRectangle inner_rectangle(std::span<const Eigen::Vector2d> points);

}  // namespace locograph
