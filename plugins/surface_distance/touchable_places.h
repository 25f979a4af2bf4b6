#pragma once
/// The surfaces, bars and solid boxes of a world: how far the links of a robot are from them, and
/// how deep in them.
///
///     const TouchablePlaces places(robot, world);
///     for (const int place : places.tree().touching(around_the_robot))
///       least_m = std::min(least_m, places.distance(place, centre, radius).value);
///
/// Places are numbered: World::surfaces, then bars, then solids. Which link may touch which of them
/// is known by place_relations.h. Thread-safe.

#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/world/box_tree.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// The collision shapes of a link as solids.
struct LinkShapes {
  std::vector<ConvexShape> shapes;
  std::vector<Eigen::Isometry3d> link_from_shape;

  /// Throws Error for a mesh that was not found or cannot be read.
  LinkShapes(const Robot& robot, int link);
};

class TouchablePlaces {
 public:
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

  TouchablePlaces(std::shared_ptr<const RobotParameter> robot, const World& world);
  TouchablePlaces(const TouchablePlaces&) = delete;
  TouchablePlaces& operator=(const TouchablePlaces&) = delete;

  const std::shared_ptr<const RobotParameter>& robot() const { return robot_; }
  int size() const { return first_solid_ + static_cast<int>(solids_.size()); }
  const BoxTree& tree() const { return tree_; }  ///< of all places
  bool is_surface(int place) const { return place < static_cast<int>(plates_.size()); }
  bool is_solid(int place) const { return place >= first_solid_; }
  const Surface& surface(int place) const { return surfaces_[static_cast<std::size_t>(place)]; }
  const Bar& bar(int place) const {
    return bars_[static_cast<std::size_t>(place) - plates_.size()];
  }
  /// The place of the solid whose face a surface is; -1: of none.
  int solid_of(int surface) const { return plates_[static_cast<std::size_t>(surface)].solid; }
  const std::string& name(int place) const;

  Distance distance(int place, const Eigen::Vector3d& centre, double radius) const;
  /// Everything in the sphere is further away than `limit`.
  bool is_far(int place, const Eigen::Vector3d& centre, double radius, double limit) const;
  /// Of a bound (RobotParameter::bounds): as the judge has it; nothing where it is `limit` or more.
  /// Of surfaces and solids only. Allocates while it loads the link's shapes, see shapes_of(), and
  /// where cylinders and meshes in a solid are left to FCL.
  std::optional<Depth> depth(int place, int bound, const Eigen::Isometry3d& world_from_link,
                             double limit) const;
  /// Loaded once, when they are asked for.
  const LinkShapes& shapes_of(int bound) const;

 private:
  struct Plate {
    Eigen::Isometry3d surface_from_world;
    double half_x_m, half_y_m, depth_m;
    bool endless;
    int solid;
  };
  struct Box {
    Eigen::Isometry3d world_from_box;
    Eigen::Vector3d half_m;
    ConvexShape shape;
  };
  struct LoadedShapes {
    std::once_flag once;
    std::optional<LinkShapes> shapes;
  };

  const Box& box(int place) const { return boxes_[static_cast<std::size_t>(place - first_solid_)]; }
  Distance to_plate(const Plate& plate, const Eigen::Vector3d& centre, double radius) const;
  Distance to_box(const Box& box, const Eigen::Vector3d& centre, double radius) const;
  Distance to_bar(const Bar& bar, const Eigen::Vector3d& centre, double radius) const;
  /// Nothing in the sphere is in a solid, or in or below a surface.
  bool is_out(int place, const Eigen::Vector3d& centre, double reach_m) const;
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
  BoxTree tree_;
  mutable std::vector<LoadedShapes> shapes_;  ///< by bound
};

}  // namespace locograph
