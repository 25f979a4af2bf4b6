#include <locograph/common/error.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/voxel_tree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace locograph {
namespace {

/// What links may touch at a place reaches no further out of its plane, and is no further away.
constexpr double kTouchedHeight_m = 0.012, kTouchedReach_m = 0.3;
/// Of surfaces and bars it matters whether links reach into them, not how far away they are.
constexpr double kSurfaceCutoff_m = 0.15;
constexpr double kPlate_m = 2e-4;      // thickness of a surface that ends
constexpr double kEndless_m = 1000.0;  // a side without an end of a surface that ends elsewhere

struct Body {
  int link;
  ConvexShape shape;
  Eigen::Isometry3d link_from_shape;
};

ConvexShape obstacle_solid(const Obstacle& obstacle) {
  switch (obstacle.shape) {
    case Obstacle::Shape::kSphere:
      return ConvexShape::sphere(obstacle.size[0]);
    case Obstacle::Shape::kCylinder:
      return ConvexShape::cylinder(obstacle.size[0], obstacle.size[1]);
    case Obstacle::Shape::kBox:
      break;
  }
  return ConvexShape::box(obstacle.size);
}

/// A surface as a solid: everything below it, or a plate just below it.
struct Plate {
  std::string name;
  Eigen::Vector3d point, normal;
  bool endless = false;
  std::optional<ConvexShape> shape;
  Eigen::Isometry3d world_from_shape = Eigen::Isometry3d::Identity();
  /// Normals and offsets of its sides, outwards: n . x <= d on the surface.
  std::vector<std::pair<Eigen::Vector3d, double>> sides;

  explicit Plate(const Surface& surface)
      : name(surface.name.empty() ? "surface" : surface.name),
        point(surface.world_from_surface.translation()),
        normal(surface.world_from_surface.linear().col(2)),
        endless(std::isinf(surface.half_x_m) && std::isinf(surface.half_y_m)) {
    const double half[] = {std::min(surface.half_x_m, kEndless_m),
                           std::min(surface.half_y_m, kEndless_m)};
    if (!surface.world_from_surface.matrix().allFinite() || !(half[0] > 0.0) || !(half[1] > 0.0))
      throw Error("surface " + name + " has a size that is not positive or a pose that is none",
                  "finite numbers");
    if (endless) return;
    shape = ConvexShape::box({2.0 * half[0], 2.0 * half[1], kPlate_m});
    world_from_shape = surface.world_from_surface * Eigen::Translation3d(0.0, 0.0, -0.5 * kPlate_m);
    for (int axis = 0; axis < 2; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector3d out = sign * surface.world_from_surface.linear().col(axis);
        sides.emplace_back(out, out.dot(point) + half[axis]);
      }
    }
  }
};

/// A bar as a solid.
struct Rod {
  std::string name;
  Eigen::Vector3d from, axis;  // axis: of length 1
  double length_m;
  ConvexShape shape;
  Eigen::Isometry3d world_from_shape;

  explicit Rod(const Bar& bar)
      : name(bar.name.empty() ? "bar" : bar.name),
        from(bar.from),
        axis(bar.to - bar.from),
        length_m(axis.norm()),
        shape(solid(name, bar.radius_m, length_m)),
        world_from_shape(Eigen::Translation3d(0.5 * (bar.from + bar.to))) {
    axis /= length_m;
    world_from_shape.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
  }

  static ConvexShape solid(const std::string& name, double radius_m, double length_m) {
    const auto is_size = [](double size) { return size > 0.0 && std::isfinite(size); };
    if (!is_size(radius_m) || !is_size(length_m))
      throw Error("bar " + name + " has a length or a radius that is not positive",
                  "finite numbers");
    return ConvexShape::cylinder(radius_m, length_m);
  }

  double distance_from_axis(const Eigen::Vector3d& point) const {
    const double along = std::clamp(axis.dot(point - from), 0.0, length_m);
    return (point - from - along * axis).norm();
  }
};

/// How far a shape reaches along a direction: the least n . x, and where.
double least_along(const ConvexShape& shape, const Eigen::Isometry3d& world_from_shape,
                   const Eigen::Vector3d& n, Eigen::Vector3d& where) {
  where = world_from_shape * shape.support(-(world_from_shape.linear().transpose() * n));
  return n.dot(where);
}

// Distance of the bounding spheres: a lower bound of the signed distance.
double sphere_bound(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                    const ConvexShape& second, const Eigen::Isometry3d& world_from_second) {
  const Eigen::Vector3d between =
      world_from_first * first.center() - world_from_second * second.center();
  return between.norm() - first.bounding_radius() - second.bounding_radius();
}

}  // namespace

struct CollisionWorld::Parts {
  CollisionWorldOptions options;
  std::vector<std::string> link_names;
  std::vector<bool> ignores_floor;
  std::vector<Body> bodies;             // sorted by link
  std::vector<std::size_t> link_begin;  // links + 1 offsets into bodies
  std::vector<std::pair<int, int>> self_pairs;
  std::optional<VoxelTree> voxels;
  std::vector<Obstacle> obstacles;
  std::vector<ConvexShape> obstacle_shapes;
  std::vector<Plate> plates;
  std::vector<Rod> rods;
  double ground_z = -std::numeric_limits<double>::infinity();  // voxels up to here do not count

  struct Search;

  void take_robot(const Robot& robot);

  std::vector<Eigen::Isometry3d> place(std::span<const Eigen::Isometry3d> world_from_link) const {
    if (world_from_link.size() != link_names.size())
      throw Error(std::to_string(world_from_link.size()) + " link poses",
                  std::to_string(link_names.size()) + ", one for each link of the robot");
    std::vector<Eigen::Isometry3d> world_from_body;
    world_from_body.reserve(bodies.size());
    for (const Body& body : bodies)
      world_from_body.push_back(world_from_link[body.link] * body.link_from_shape);
    return world_from_body;
  }
};

void CollisionWorld::Parts::take_robot(const Robot& robot) {
  for (const Link& link : robot.links()) {
    link_begin.push_back(bodies.size());
    const int index = static_cast<int>(link_names.size());
    for (const CollisionShape& shape : link.collision)
      bodies.push_back({index, link_solid(robot, shape), shape.link_from_shape});
    link_names.push_back(link.name);
  }
  link_begin.push_back(bodies.size());
  self_pairs = robot.self_collision_pairs();
}

CollisionWorld::CollisionWorld(const Robot& robot, std::shared_ptr<const octomap::OcTree> tree,
                               std::vector<Obstacle> obstacles,
                               const CollisionWorldOptions& options)
    : parts_(std::make_unique<Parts>()) {
  if (!std::isfinite(options.cutoff_m) || options.cutoff_m <= 0.0)
    throw Error("cutoff_m is " + std::to_string(options.cutoff_m), "a positive number of metres");
  if (!std::isfinite(options.floor_z_m)) throw Error("floor_z_m is not finite", "a height");
  parts_->options = options;
  parts_->take_robot(robot);
  parts_->ignores_floor.assign(robot.links().size(), false);
  for (int link : options.ignore_floor_links) {
    if (link < 0 || static_cast<std::size_t>(link) >= robot.links().size())
      throw Error("ignore_floor_links names link " + std::to_string(link),
                  "an index below " + std::to_string(robot.links().size()));
    parts_->ignores_floor[link] = true;
  }
  if (tree) parts_->voxels.emplace(*tree);
  for (const Obstacle& obstacle : obstacles) {
    obstacle.validate();
    parts_->obstacle_shapes.push_back(obstacle_solid(obstacle));
  }
  parts_->obstacles = std::move(obstacles);
}

CollisionWorld::CollisionWorld(const Robot& robot, const World& world,
                               const CollisionWorldOptions& options)
    : CollisionWorld(robot, world.map, world.obstacles, options) {
  for (const Surface& surface : world.surfaces) parts_->plates.emplace_back(surface);
  for (const Bar& bar : world.bars) parts_->rods.emplace_back(bar);
  parts_->ground_z = ground_height(world);
}

CollisionWorld::~CollisionWorld() = default;
CollisionWorld::CollisionWorld(CollisionWorld&&) noexcept = default;
CollisionWorld& CollisionWorld::operator=(CollisionWorld&&) noexcept = default;

CollisionWorld::Closest CollisionWorld::environment_distance(
    std::span<const Eigen::Isometry3d> world_from_link, double time_s, double stop_below) const {
  const Parts& parts = *parts_;
  const std::vector<Eigen::Isometry3d> world_from_body = parts.place(world_from_link);
  ShapeDistance best{parts.options.cutoff_m, {}, {}};
  int link = -1, obstacle = -1;
  const auto done = [&] { return best.distance < stop_below; };

  for (std::size_t o = 0; o < parts.obstacles.size() && !done(); ++o) {
    const Eigen::Isometry3d world_from_obstacle = parts.obstacles[o].pose_at(time_s);
    const ConvexShape& shape = parts.obstacle_shapes[o];
    for (std::size_t b = 0; b < parts.bodies.size() && !done(); ++b) {
      const Body& body = parts.bodies[b];
      if (sphere_bound(body.shape, world_from_body[b], shape, world_from_obstacle) >= best.distance)
        continue;
      const ShapeDistance distance =
          shape_distance(body.shape, world_from_body[b], shape, world_from_obstacle);
      if (distance.distance >= best.distance) continue;
      best = distance;
      link = body.link;
      obstacle = static_cast<int>(o);
    }
  }
  for (std::size_t b = 0; parts.voxels && b < parts.bodies.size() && !done(); ++b) {
    const Body& body = parts.bodies[b];
    VoxelTree::Query query{body.shape, world_from_body[b]};
    if (parts.ignores_floor[body.link]) query.floor_z = parts.options.floor_z_m;
    query.stop_below = stop_below;
    query.best = best;
    if (!parts.voxels->nearest(query)) continue;
    best = query.best;
    link = body.link;
    obstacle = -1;
  }

  Closest closest;
  closest.distance_m = best.distance;
  closest.link = link;
  if (link < 0) return closest;
  closest.point = best.on_first;
  closest.what = obstacle < 0 ? "voxel" : parts.obstacles[obstacle].name;
  return closest;
}

namespace {

/// The parts of a query that what is touched depends on.
struct Touching {
  using Bits = std::uint64_t;  // one for each touch
  std::vector<Bits> of_link, of_obstacle, of_plate, of_rod;

  static Bits bit(std::size_t touch) { return Bits{1} << touch; }
};

CollisionWorld::Closest closest_to(const ShapeDistance& distance, int link, std::string what) {
  CollisionWorld::Closest closest;
  closest.distance_m = distance.distance;
  closest.link = link;
  closest.point = distance.on_first;
  closest.what = std::move(what);
  return closest;
}

}  // namespace

/// One answer of surroundings() on its way.
struct CollisionWorld::Parts::Search {
  const Parts& parts;
  const Query& query;
  std::vector<Eigen::Isometry3d> world_from_body;
  Touching touching;
  Surroundings found;

  Search(const Parts& parts, const Query& query)
      : parts(parts), query(query), world_from_body(parts.place(query.world_from_link)) {
    found.obstacle.distance_m = query.cutoff_m;
    found.surface.distance_m = std::min(query.cutoff_m, kSurfaceCutoff_m);
    if (query.touches.size() > 64)
      throw Error(std::to_string(query.touches.size()) + " places to touch", "64 at most");
    touching.of_link.assign(parts.link_names.size(), 0);
    touching.of_obstacle.assign(parts.obstacles.size(), 0);
    touching.of_plate.assign(parts.plates.size(), 0);
    touching.of_rod.assign(parts.rods.size(), 0);
    for (std::size_t t = 0; t < query.touches.size(); ++t) add(query.touches[t], Touching::bit(t));
  }

  void add(const Touch& touch, Touching::Bits bit) {
    for (const int link : touch.links) touching.of_link[static_cast<std::size_t>(link)] |= bit;
    const double plane = touch.normal.dot(touch.position);
    const auto out_of_plane = [&](const ConvexShape& shape, const Eigen::Isometry3d& pose) {
      Eigen::Vector3d where;
      return -least_along(shape, pose, -touch.normal, where) - plane;
    };
    for (std::size_t o = 0; o < parts.obstacles.size(); ++o) {
      const Obstacle& obstacle = parts.obstacles[o];
      if (!obstacle.motion.empty()) continue;
      if (obstacle.distance(touch.position, query.time_s) > kTouchedReach_m) continue;
      if (out_of_plane(parts.obstacle_shapes[o], obstacle.world_from_obstacle) <= kTouchedHeight_m)
        touching.of_obstacle[o] |= bit;
    }
    for (const int surface : touch.surfaces)
      touching.of_plate[static_cast<std::size_t>(surface)] |= bit;
    for (const int bar : touch.bars) touching.of_rod[static_cast<std::size_t>(bar)] |= bit;
    // Surfaces below the plane, as the sides of a box that a foot stands on.
    for (std::size_t p = 0; p < parts.plates.size(); ++p) {
      const Plate& plate = parts.plates[p];
      if (plate.endless || out_of_plane(*plate.shape, plate.world_from_shape) > 1e-3) continue;
      double away = 0.0;
      for (const auto& [out, offset] : plate.sides)
        away = std::max(away, out.dot(touch.position) - offset);
      away = std::max(away, std::abs(plate.normal.dot(touch.position - plate.point)));
      if (away <= kTouchedReach_m) touching.of_plate[p] |= bit;
    }
  }

  /// A depth counts as no more than how far the body would have to be moved along the normal of one
  /// of the touches to come free.
  void touch(std::size_t b, Touching::Bits touches, ShapeDistance distance,
             const ConvexShape& other, const Eigen::Isometry3d& world_from_other,
             const std::string& what) {
    for (std::size_t t = 0; t < query.touches.size(); ++t) {
      if ((touches & Touching::bit(t)) == 0) continue;
      const Eigen::Vector3d& n = query.touches[t].normal;
      Eigen::Vector3d lowest, highest;
      const double low = least_along(parts.bodies[b].shape, world_from_body[b], n, lowest);
      const double high = -least_along(other, world_from_other, -n, highest);
      if (low - high > distance.distance) {
        distance.distance = low - high;
        distance.on_first = lowest;
      }
    }
    if (distance.distance < found.touched.distance_m)
      found.touched = closest_to(distance, parts.bodies[b].link, what);
  }

  void obstacles() {
    for (std::size_t o = 0; o < parts.obstacles.size(); ++o) {
      const Eigen::Isometry3d world_from_obstacle = parts.obstacles[o].pose_at(query.time_s);
      const ConvexShape& shape = parts.obstacle_shapes[o];
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Body& body = parts.bodies[b];
        const Touching::Bits touches =
            touching.of_link[static_cast<std::size_t>(body.link)] & touching.of_obstacle[o];
        const double nearest = touches != 0 ? 0.0 : found.obstacle.distance_m;
        if (sphere_bound(body.shape, world_from_body[b], shape, world_from_obstacle) >= nearest)
          continue;
        const ShapeDistance distance =
            shape_distance(body.shape, world_from_body[b], shape, world_from_obstacle);
        if (distance.distance >= nearest) continue;
        if (touches != 0)
          touch(b, touches, distance, shape, world_from_obstacle, parts.obstacles[o].name);
        else
          found.obstacle = closest_to(distance, body.link, parts.obstacles[o].name);
      }
    }
  }

  void voxels() {
    for (std::size_t b = 0; parts.voxels && b < parts.bodies.size(); ++b) {
      const Body& body = parts.bodies[b];
      VoxelTree::Query voxel{body.shape, world_from_body[b]};
      voxel.floor_z = parts.ground_z;
      if (parts.ignores_floor[static_cast<std::size_t>(body.link)])
        voxel.floor_z = std::max(voxel.floor_z, parts.options.floor_z_m);
      for (std::size_t t = 0; t < query.touches.size(); ++t) {
        if ((touching.of_link[static_cast<std::size_t>(body.link)] & Touching::bit(t)) == 0)
          continue;
        const Touch& touch = query.touches[t];
        voxel.behind.push_back({touch.position, touch.normal, kTouchedHeight_m, kTouchedReach_m});
      }
      voxel.best.distance = found.obstacle.distance_m;
      if (parts.voxels->nearest(voxel)) found.obstacle = closest_to(voxel.best, body.link, "voxel");
      if (voxel.behind.empty()) continue;
      voxel.only_behind = true;
      voxel.best.distance = found.touched.distance_m;
      if (parts.voxels->nearest(voxel)) found.touched = closest_to(voxel.best, body.link, "voxel");
    }
  }

  void surfaces() {
    for (std::size_t p = 0; p < parts.plates.size(); ++p) {
      const Plate& plate = parts.plates[p];
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Touching::Bits touches =
            touching.of_link[static_cast<std::size_t>(parts.bodies[b].link)] & touching.of_plate[p];
        surface(plate, b, touches);
      }
    }
  }

  void bars() {
    for (std::size_t r = 0; r < parts.rods.size(); ++r) {
      const Rod& rod = parts.rods[r];
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Body& body = parts.bodies[b];
        const Touching::Bits touches =
            touching.of_link[static_cast<std::size_t>(body.link)] & touching.of_rod[r];
        const double nearest = touches != 0 ? 0.0 : found.surface.distance_m;
        // A lower bound: the bar is within a capsule, the body within a ball.
        const double least = rod.distance_from_axis(world_from_body[b] * body.shape.center()) -
                             rod.shape.radius() - body.shape.bounding_radius();
        if (least >= nearest) continue;
        const ShapeDistance distance =
            shape_distance(body.shape, world_from_body[b], rod.shape, rod.world_from_shape);
        if (distance.distance >= nearest) continue;
        if (touches != 0)
          touch(b, touches, distance, rod.shape, rod.world_from_shape, rod.name);
        else
          found.surface = closest_to(distance, body.link, rod.name);
      }
    }
  }

  void surface(const Plate& plate, std::size_t b, Touching::Bits touches) {
    const Body& body = parts.bodies[b];
    const Eigen::Isometry3d& pose = world_from_body[b];
    const double nearest = touches != 0 ? found.touched.distance_m : found.surface.distance_m;
    const double height = plate.normal.dot(pose * body.shape.center() - plate.point);
    const double radius = body.shape.bounding_radius();
    // A plate bounds from both sides, what is below an endless surface is in it.
    if ((plate.endless || touches != 0 ? height : std::abs(height)) - radius >= nearest) return;
    ShapeDistance distance;
    if (plate.endless || touches != 0) {
      distance.distance = least_along(body.shape, pose, plate.normal, distance.on_first) -
                          plate.normal.dot(plate.point);
      for (const auto& [out, offset] : plate.sides) {
        Eigen::Vector3d where;
        const double beside = least_along(body.shape, pose, out, where) - offset;
        if (beside > distance.distance) distance = {beside, where, {}};
      }
    } else {
      distance = shape_distance(body.shape, pose, *plate.shape, plate.world_from_shape);
    }
    if (distance.distance >= nearest) return;
    if (touches == 0) {
      found.surface = closest_to(distance, body.link, plate.name);
    } else if (plate.endless) {
      found.touched = closest_to(distance, body.link, plate.name);
    } else {
      touch(b, touches, distance, *plate.shape, plate.world_from_shape, plate.name);
    }
  }
};

CollisionWorld::Surroundings CollisionWorld::surroundings(const Query& query) const {
  Parts::Search search(*parts_, query);
  search.obstacles();
  search.voxels();
  search.surfaces();
  search.bars();
  return std::move(search.found);
}

CollisionWorld::Closest CollisionWorld::self_distance(
    std::span<const Eigen::Isometry3d> world_from_link) const {
  return self_distance(world_from_link, parts_->options.cutoff_m);
}

CollisionWorld::Closest CollisionWorld::self_distance(
    std::span<const Eigen::Isometry3d> world_from_link, double cutoff_m) const {
  const Parts& parts = *parts_;
  const std::vector<Eigen::Isometry3d> world_from_body = parts.place(world_from_link);
  ShapeDistance best{cutoff_m, {}, {}};
  int first_link = -1, second_link = -1;
  for (const auto& [first, second] : parts.self_pairs) {
    for (std::size_t a = parts.link_begin[first]; a < parts.link_begin[first + 1]; ++a) {
      for (std::size_t b = parts.link_begin[second]; b < parts.link_begin[second + 1]; ++b) {
        const ConvexShape& one = parts.bodies[a].shape;
        const ConvexShape& other = parts.bodies[b].shape;
        if (sphere_bound(one, world_from_body[a], other, world_from_body[b]) >= best.distance)
          continue;
        const ShapeDistance distance =
            shape_distance(one, world_from_body[a], other, world_from_body[b]);
        if (distance.distance >= best.distance) continue;
        best = distance;
        first_link = first;
        second_link = second;
      }
    }
  }
  Closest closest;
  closest.distance_m = best.distance;
  closest.link = first_link;
  closest.other_link = second_link;
  if (first_link < 0) return closest;
  closest.what = parts.link_names[second_link];
  closest.point = best.on_first;
  return closest;
}

}  // namespace locograph
