#pragma once
/// Which link of a robot may touch which surface, bar or solid box while contacts are closed, and
/// how deep it may be in it.
///
///     PlaceRelations relations(places);
///     relations.set_contacts(stance.contacts);
///     const std::vector<int>& near = relations.near(around_the_robot);
///     for (std::size_t i = 0; i < near.size(); ++i)
///       if (relations.relation(i, bound) == PlaceRelations::Relation::kApart)
///         least_m = std::min(least_m, places->distance(near[i], centre, radius).value);
///
/// The faces of a solid are places to keep away from only for links that touch the solid elsewhere,
/// as the judge has it.

#include <locograph/plugins/surface_distance/touchable_places.h>
#include <locograph/robots/contact.h>

#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

namespace locograph {

/// Whether an end effector whose point is there is near the place of a contact that is not closed,
/// as it has just left it or is about to come down: nearer than 0.1 m, and not below it. Others, on
/// other sides of what is touched as well, keep away as from anything else.
bool is_near(const Contact& contact, const Eigen::Vector3d& point);

class PlaceRelations {
 public:
  enum class Relation : char {
    kApart,    ///< the link keeps away
    kTouches,  ///< it is above the place, or reaches into it as deep as it may
    kNone      ///< it is what contact closure says, or something else stands for the place
  };

  explicit PlaceRelations(std::shared_ptr<const TouchablePlaces> places)
      : places_(std::move(places)) {}

  const TouchablePlaces& places() const { return *places_; }

  /// held: of the closed contacts, those that hold before and after; links of the others may touch,
  /// and not reach into what they touch; empty: all. near: contacts that are not closed, but whose
  /// links may be near what they touch, near_m above it at least.
  void set_contacts(std::span<const Contact> closed, std::span<const Contact> held = {},
                    std::span<const Contact> near = {}, double near_m = 0.0);
  /// False: contacts may be on what is none of the places. Their links come as near to surfaces and
  /// solids as kBesideAbove_m.
  void set_places_known(bool known);
  /// Ascending: all places that have to do with a robot in this box, and a few more. Valid until
  /// the next call.
  const std::vector<int>& near(const Eigen::AlignedBox3d& robot);
  /// Instead of near(): the i-th place is place i, wherever the robot is, and the shapes of the
  /// links that touch are loaded. Constant functions are thread-safe from then on.
  void relate_all();

  /// Of a bound (RobotParameter::bounds) and the i-th place.
  Relation relation(std::size_t i, std::size_t bound) const {
    return relations_[i * places_->robot()->bounds.size() + bound];
  }
  /// How deep a link that touches may be, less what rows may be off; negative: how far above [m].
  double deepest_m(std::size_t i, std::size_t bound) const {
    return deepest_m_[i * places_->robot()->bounds.size() + bound];
  }
  static constexpr double kBesideAbove_m = 2e-5;
  /// Whether the link may touch what is none of the places, beside this one.
  bool is_beside(std::size_t i, std::size_t bound) const {
    return deepest_m(i, bound) == -kBesideAbove_m;
  }
  /// Whether the link may touch something.
  bool touches(std::size_t bound) const;

 private:
  /// A contact, and the bounds of links that touch there.
  struct Touch {
    Contact contact;
    Eigen::Vector3d normal;  ///< of length 1
    double reach_m;
    int link;
    bool held;
    bool is_closed;
    double above_m;  ///< how far above it links are to be, of contacts that are not closed
    std::vector<int> bounds;
    std::vector<bool> fixed;  ///< by bound: to what touches
    std::vector<bool>
        closed;  ///< by bound: its place on the plane of the contact is always the same
  };

  void add_touch(const Contact& contact, bool is_closed, bool is_held, double above_m);
  void find_relations();
  void relate(const Touch& touch);
  bool in_plane(const Surface& surface, const Touch& touch) const;
  /// Something of the contact's area is over the surface.
  bool is_under(const Surface& surface, const Touch& touch) const;
  bool is_below(const Surface& surface, const Touch& touch) const;

  std::shared_ptr<const TouchablePlaces> places_;
  std::vector<Touch> touches_;
  Eigen::AlignedBox3d searched_;
  std::vector<int> near_;
  bool related_ = false, places_known_ = true;
  std::vector<Relation> relations_;  ///< near_ by bounds
  std::vector<double> deepest_m_;
};

}  // namespace locograph
