#pragma once
/// The surfaces, bars and solid boxes that a robot is near to in a transition: how far its links
/// are from them, and how deep those that touch them are in them.
///
///     TransitionPlaces places(robot, world);
///     places.set_contacts(problem.closed, problem.held);
///     const std::vector<int>& near = places.near(around_the_robot);
///     for (std::size_t i = 0; i < near.size(); ++i)
///       if (places.relation(i, bound) == TransitionPlaces::Relation::kApart)
///         least_m = std::min(least_m, places.distance(near[i], centre, radius).value);
///
/// Places are numbered: World::surfaces, then bars, then solids. The faces of a solid are places to
/// keep away from only for links that touch the solid elsewhere, as the judge has it.

#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/contact.h>
#include <locograph/world/box_tree.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

/// The collision shapes of a link as solids.
struct LinkShapes {
  std::vector<ConvexShape> shapes;
  std::vector<Eigen::Isometry3d> link_from_shape;

  LinkShapes(const Robot& robot, int link);
};

class TransitionPlaces {
 public:
  enum class Relation : char {
    kApart,    ///< the link keeps away
    kTouches,  ///< it is above the place, or reaches into it as deep as it may
    kNone      ///< it is what contact closure says, or something else stands for the place
  };
  /// A signed distance, and its gradient by the sphere's centre in the world.
  struct Distance {
    double value;
    Eigen::Vector3d gradient;
  };
  /// Of a link: the signed distance of its shapes, the point of theirs that it is of, and the way
  /// out there, of length 1.
  struct Depth {
    double value;
    Eigen::Vector3d point, out;
  };

  TransitionPlaces(std::shared_ptr<const RobotParameter> robot, const World& world);

  /// held: contacts of the smaller stance, empty: all; near, near_m: not closed; see
  /// TransitionProblem.
  void set_contacts(std::span<const Contact> closed, std::span<const Contact> held,
                    std::span<const Contact> near = {}, double near_m = 0.0);
  /// Ascending: all that have to do with a robot in this box, and a few more. Valid until the next
  /// call.
  const std::vector<int>& near(const Eigen::AlignedBox3d& robot);
  /// Of a bound (RobotParameter::bounds) and the place that near() gave as number i.
  Relation relation(std::size_t i, std::size_t bound) const {
    return relations_[i * robot_->bounds.size() + bound];
  }
  /// How deep a link that touches may be, less what rows may be off; negative: how far above [m].
  double deepest_m(std::size_t i, std::size_t bound) const {
    return deepest_m_[i * robot_->bounds.size() + bound];
  }

  Distance distance(int place, const Eigen::Vector3d& centre, double radius) const;
  /// Everything in the sphere is further away than `limit`.
  bool is_far(int place, const Eigen::Vector3d& centre, double radius, double limit) const;
  /// As the judge has it; nothing where it is `limit` or more. Of surfaces and solids only.
  std::optional<Depth> depth(int place, int bound, const Eigen::Isometry3d& world_from_link,
                             double limit);
  const std::string& name(int place) const;

 private:
  struct Plate {
    Eigen::Isometry3d surface_from_world;
    double half_x_m, half_y_m, depth_m;
    bool endless;
    int box;  ///< of World::solids, whose face it is; -1: none
  };
  struct Box {
    Eigen::Isometry3d world_from_box;
    Eigen::Vector3d half_m;
    ConvexShape shape;
  };
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

  bool is_surface(int place) const { return place < static_cast<int>(plates_.size()); }
  bool is_solid(int place) const { return place >= first_solid_; }
  const Box& box(int place) const { return boxes_[static_cast<std::size_t>(place - first_solid_)]; }
  void add_touch(const Contact& contact, bool is_closed, bool is_held, double above_m);
  void find_relations();
  void relate(const Touch& touch);
  bool in_plane(const Surface& surface, const Touch& touch) const;
  /// Something of the contact's area is over the surface.
  bool is_under(const Surface& surface, const Touch& touch) const;
  bool is_below(const Surface& surface, const Touch& touch) const;
  Distance to_plate(const Plate& plate, const Eigen::Vector3d& centre, double radius) const;
  Distance to_box(const Box& box, const Eigen::Vector3d& centre, double radius) const;
  Distance to_bar(const Bar& bar, const Eigen::Vector3d& centre, double radius) const;
  /// Nothing in the sphere is in a solid, or in or below a surface.
  bool is_out(int place, const Eigen::Vector3d& centre, double reach_m) const;
  const LinkShapes& shapes_of(int bound);
  Depth into_plate(int place, const LinkShapes& link, const Eigen::Isometry3d& pose) const;
  Depth into_box(const Box& box, const LinkShapes& link, const Eigen::Isometry3d& pose,
                 double limit) const;

  std::shared_ptr<const RobotParameter> robot_;
  std::vector<Surface> surfaces_;
  std::vector<Bar> bars_;
  std::vector<SolidBox> solids_;
  std::vector<Plate> plates_;  ///< of the surfaces
  std::vector<Box> boxes_;     ///< of the solids
  int first_solid_;
  BoxTree tree_;                                   ///< of all places
  std::vector<std::optional<LinkShapes>> shapes_;  ///< by bound, of those that have touched

  std::vector<Touch> touches_;
  Eigen::AlignedBox3d searched_;
  std::vector<int> near_;
  bool related_ = false;
  std::vector<Relation> relations_;  ///< near_ by bounds
  std::vector<double> deepest_m_;
};

}  // namespace locograph
