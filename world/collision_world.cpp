#include <locograph/common/error.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/require_metres.h>
#include <locograph/world/world_solids.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

namespace locograph {
namespace {

/// How exact the plane of a contact is: a solid that comes out of it by no more is below it, and a
/// link may be so deep in what it barely touches.
constexpr double kFlush_m = 1e-4;

struct Body {
  int link;
  ConvexShape shape;
  Eigen::Isometry3d link_from_shape;
};

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
  std::shared_ptr<const WorldSolids> solids;

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

CollisionWorld::CollisionWorld(const Robot& robot, std::shared_ptr<const WorldSolids> solids,
                               const CollisionWorldOptions& options)
    : parts_(std::make_unique<Parts>()) {
  require_metres(options.cutoff_m, "cutoff_m");
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
  parts_->solids = std::move(solids);
}

CollisionWorld::CollisionWorld(const Robot& robot, const World& world,
                               const CollisionWorldOptions& options)
    : CollisionWorld(robot, std::make_shared<const WorldSolids>(world), options) {}

CollisionWorld::CollisionWorld(const Robot& robot, std::shared_ptr<const octomap::OcTree> tree,
                               std::vector<Obstacle> obstacles,
                               const CollisionWorldOptions& options)
    : CollisionWorld(robot, World{.map = std::move(tree), .obstacles = std::move(obstacles)},
                     options) {}

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

  for (std::size_t o = 0; o < parts.solids->obstacles.size() && !done(); ++o) {
    if (!parts.solids->obstacles[o].is_there(time_s)) continue;
    const Eigen::Isometry3d world_from_obstacle = parts.solids->obstacles[o].pose_at(time_s);
    const ConvexShape& shape = parts.solids->obstacle_shapes[o];
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
  for (std::size_t b = 0; parts.solids->voxels && b < parts.bodies.size() && !done(); ++b) {
    const Body& body = parts.bodies[b];
    VoxelTree::Query query{body.shape, world_from_body[b]};
    if (parts.ignores_floor[body.link]) query.floor_z = parts.options.floor_z_m;
    query.stop_below = stop_below;
    query.best = best;
    if (!parts.solids->voxels->nearest(query)) continue;
    best = query.best;
    link = body.link;
    obstacle = -1;
  }

  Closest closest;
  closest.distance_m = best.distance;
  closest.link = link;
  if (link < 0) return closest;
  closest.point = best.on_first;
  closest.what = obstacle < 0 ? "voxel" : parts.solids->obstacles[obstacle].name;
  return closest;
}

namespace {

/// The parts of a query that what is touched depends on.
struct Touching {
  using Bits = std::uint64_t;  // one for each touch
  std::vector<Bits> of_link, of_obstacle, of_plate, of_rod, of_block;
  Bits barely = 0;

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
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of a ball around the robot
  double radius = 0.0;
  Touching touching;
  Surroundings found;

  Search(const Parts& parts, const Query& query)
      : parts(parts), query(query), world_from_body(parts.place(query.world_from_link)) {
    found.obstacle.distance_m = query.cutoff_m;
    found.surface.distance_m = std::min(query.cutoff_m, query.surface_cutoff_m);
    if (query.touches.size() > 64)
      throw Error(std::to_string(query.touches.size()) + " places to touch", "64 at most");
    touching.of_link.assign(parts.link_names.size(), 0);
    touching.of_obstacle.assign(obstacle_count(), 0);
    touching.of_plate.assign(parts.solids->plates.size(), 0);
    touching.of_rod.assign(parts.solids->rods.size(), 0);
    touching.of_block.assign(parts.solids->blocks.size(), 0);
    for (std::size_t t = 0; t < query.touches.size(); ++t) add(query.touches[t], Touching::bit(t));
    Eigen::AlignedBox3d box;
    for (std::size_t b = 0; b < parts.bodies.size(); ++b) box.extend(body_centre(b));
    if (!box.isEmpty()) centre = box.center();
    for (std::size_t b = 0; b < parts.bodies.size(); ++b)
      radius = std::max(radius,
                        (body_centre(b) - centre).norm() + parts.bodies[b].shape.bounding_radius());
  }

  std::size_t obstacle_count() const {
    return query.obstacles != nullptr ? query.obstacles->size() : parts.solids->obstacles.size();
  }
  /// Of World::obstacles, the k-th one that the query may mean.
  std::size_t obstacle_index(std::size_t k) const {
    return query.obstacles != nullptr ? (*query.obstacles)[k] : k;
  }

  Eigen::Vector3d body_centre(std::size_t b) const {
    return world_from_body[b] * parts.bodies[b].shape.center();
  }

  void add(const Touch& touch, Touching::Bits bit) {
    for (const int link : touch.links) touching.of_link[static_cast<std::size_t>(link)] |= bit;
    const double plane = touch.normal.dot(touch.position);
    const auto out_of_plane = [&](const ConvexShape& shape, const Eigen::Isometry3d& pose) {
      Eigen::Vector3d where;
      return -least_along(shape, pose, -touch.normal, where) - plane;
    };
    for (std::size_t k = 0; k < obstacle_count(); ++k) {
      const std::size_t o = obstacle_index(k);
      const Obstacle& obstacle = parts.solids->obstacles[o];
      if (!obstacle.motion.empty()) continue;
      if (obstacle.distance(touch.position, query.time_s) > touch.reach_m) continue;
      if (out_of_plane(parts.solids->obstacle_shapes[o], obstacle.world_from_obstacle) <= kFlush_m)
        touching.of_obstacle[k] |= bit;
    }
    for (const int surface : touch.surfaces) {
      touching.of_plate[static_cast<std::size_t>(surface)] |= bit;
      const int block = parts.solids->plates[static_cast<std::size_t>(surface)].block;
      if (block >= 0) touching.of_block[static_cast<std::size_t>(block)] |= bit;
    }
    for (const int bar : touch.bars) touching.of_rod[static_cast<std::size_t>(bar)] |= bit;
    // The faces of a touched box that lie behind the plane within reach, as its sides.
    for (std::size_t p = 0; p < parts.solids->plates.size(); ++p) {
      const PlateSolid& plate = parts.solids->plates[p];
      if (plate.block < 0 || (touching.of_block[static_cast<std::size_t>(plate.block)] & bit) == 0)
        continue;
      double away = std::abs(plate.normal.dot(touch.position - plate.point));
      for (const SolidSide& side : plate.sides)
        away = std::max(away, side.out.dot(touch.position) - side.offset);
      if (away > touch.reach_m) continue;
      if (out_of_plane(*plate.shape, plate.world_from_shape) <= kFlush_m)
        touching.of_plate[p] |= bit;
    }
    if (touch.barely) touching.barely |= bit;
  }

  /// Which touches let a link be in something; those that open or close here do not.
  Touching::Bits held(Touching::Bits touches) const { return touches & ~touching.barely; }
  /// How deep a link may be in what it touches barely, and in nothing else.
  double allowance(Touching::Bits touches) const {
    return touches != 0 && held(touches) == 0 ? kFlush_m : 0.0;
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
    for (std::size_t k = 0; k < obstacle_count(); ++k) {
      const std::size_t o = obstacle_index(k);
      if (query.obstacles == nullptr && !parts.solids->obstacles[o].is_there(query.time_s))
        continue;
      const Eigen::Isometry3d world_from_obstacle =
          parts.solids->obstacles[o].pose_at(query.time_s);
      const ConvexShape& shape = parts.solids->obstacle_shapes[o];
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Body& body = parts.bodies[b];
        const Touching::Bits all =
            touching.of_link[static_cast<std::size_t>(body.link)] & touching.of_obstacle[k];
        const Touching::Bits touches = held(all);
        const double nearest = touches != 0 ? 0.0 : found.obstacle.distance_m - allowance(all);
        if (sphere_bound(body.shape, world_from_body[b], shape, world_from_obstacle) >= nearest)
          continue;
        ShapeDistance distance =
            shape_distance(body.shape, world_from_body[b], shape, world_from_obstacle);
        if (distance.distance >= nearest) continue;
        if (touches != 0) {
          touch(b, touches, distance, shape, world_from_obstacle, parts.solids->obstacles[o].name);
          continue;
        }
        distance.distance += allowance(all);
        found.obstacle = closest_to(distance, body.link, parts.solids->obstacles[o].name);
      }
    }
  }

  void voxels() {
    for (std::size_t b = 0; parts.solids->voxels && b < parts.bodies.size(); ++b) {
      const Body& body = parts.bodies[b];
      VoxelTree::Query voxel{body.shape, world_from_body[b]};
      voxel.floor_z = parts.solids->ground_z;
      if (parts.ignores_floor[static_cast<std::size_t>(body.link)])
        voxel.floor_z = std::max(voxel.floor_z, parts.options.floor_z_m);
      std::vector<VoxelTree::Query::Behind> held, barely;
      for (std::size_t t = 0; t < query.touches.size(); ++t) {
        if ((touching.of_link[static_cast<std::size_t>(body.link)] & Touching::bit(t)) == 0)
          continue;
        const Touch& touch = query.touches[t];
        (touch.barely ? barely : held)
            .push_back({touch.position, touch.normal, kFlush_m, touch.reach_m});
      }
      voxel.behind = held;
      voxel.behind.insert(voxel.behind.end(), barely.begin(), barely.end());
      voxel.best.distance = found.obstacle.distance_m;
      if (parts.solids->voxels->nearest(voxel))
        found.obstacle = closest_to(voxel.best, body.link, "voxel");
      voxel.only_behind = true;
      voxel.behind = std::move(held);
      voxel.best.distance = found.touched.distance_m;
      if (!voxel.behind.empty() && parts.solids->voxels->nearest(voxel))
        found.touched = closest_to(voxel.best, body.link, "voxel");
      voxel.behind = std::move(barely);
      voxel.best.distance = found.obstacle.distance_m - kFlush_m;
      if (!voxel.behind.empty() && parts.solids->voxels->nearest(voxel)) {
        voxel.best.distance += kFlush_m;
        found.obstacle = closest_to(voxel.best, body.link, "voxel");
      }
    }
  }

  void surfaces() {
    for (std::size_t p = 0; p < parts.solids->plates.size(); ++p) {
      const PlateSolid& plate = parts.solids->plates[p];
      if (touching.of_plate[p] == 0 && !plate.endless &&
          (centre - plate.point).norm() - radius - plate.shape->bounding_radius() >=
              found.surface.distance_m)
        continue;
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Touching::Bits links =
            touching.of_link[static_cast<std::size_t>(parts.bodies[b].link)];
        const Touching::Bits touches = links & touching.of_plate[p];
        // The box that it is a face of counts instead, except for a link that touches the box, and
        // that elsewhere.
        if (plate.block >= 0 &&
            (touches != 0 ||
             (links & touching.of_block[static_cast<std::size_t>(plate.block)]) == 0))
          continue;
        surface(plate, b, touches);
      }
    }
  }

  void bars() {
    for (std::size_t r = 0; r < parts.solids->rods.size(); ++r) {
      const BarSolid& rod = parts.solids->rods[r];
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Body& body = parts.bodies[b];
        const Touching::Bits all =
            touching.of_link[static_cast<std::size_t>(body.link)] & touching.of_rod[r];
        const Touching::Bits touches = held(all);
        const double nearest = touches != 0 ? 0.0 : found.surface.distance_m - allowance(all);
        // A lower bound: the bar is within a capsule, the body within a ball.
        const double least = rod.distance_from_axis(world_from_body[b] * body.shape.center()) -
                             rod.shape.radius() - body.shape.bounding_radius();
        if (least >= nearest) continue;
        ShapeDistance distance =
            shape_distance(body.shape, world_from_body[b], rod.shape, rod.world_from_shape);
        if (distance.distance >= nearest) continue;
        if (touches != 0) {
          touch(b, touches, distance, rod.shape, rod.world_from_shape, rod.name);
          continue;
        }
        distance.distance += allowance(all);
        found.surface = closest_to(distance, body.link, rod.name);
      }
    }
  }

  void blocks() {
    for (std::size_t s = 0; s < parts.solids->blocks.size(); ++s) {
      const BoxSolid& block = parts.solids->blocks[s];
      if (block.at_least(centre) - radius >= std::max(0.0, found.surface.distance_m)) continue;
      for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
        const Body& body = parts.bodies[b];
        const Eigen::Isometry3d& pose = world_from_body[b];
        const Touching::Bits all =
            touching.of_link[static_cast<std::size_t>(body.link)] & touching.of_block[s];
        const Touching::Bits touches = held(all);
        const double nearest =
            touches != 0 ? found.touched.distance_m : found.surface.distance_m - allowance(all);
        if (block.at_least(pose * body.shape.center()) - body.shape.bounding_radius() >= nearest)
          continue;
        ShapeDistance distance =
            shape_distance(body.shape, pose, block.shape, block.world_from_shape);
        if (distance.distance >= nearest) continue;
        if (touches != 0) {
          touch(b, touches, distance, block.shape, block.world_from_shape, block.name);
          continue;
        }
        distance.distance += allowance(all);
        found.surface = closest_to(distance, body.link, block.name);
      }
    }
  }

  /// `distance` becomes how far the shape is out of a side if that is more.
  static void move_out(const SolidSide& side, const ConvexShape& shape,
                       const Eigen::Isometry3d& pose, ShapeDistance& distance) {
    Eigen::Vector3d where;
    const double out = least_along(shape, pose, side.out, where) - side.offset;
    if (out > distance.distance) distance = {out, where, {}};
  }

  void surface(const PlateSolid& plate, std::size_t b, Touching::Bits all) {
    const Body& body = parts.bodies[b];
    const Eigen::Isometry3d& pose = world_from_body[b];
    const Touching::Bits touches = held(all);
    const double nearest =
        touches != 0 ? found.touched.distance_m : found.surface.distance_m - allowance(all);
    const double height = plate.normal.dot(pose * body.shape.center() - plate.point);
    const double radius = body.shape.bounding_radius();
    // A plate bounds from both sides, what is below an endless surface is in it.
    if ((plate.endless || touches != 0 ? height : std::abs(height)) - radius >= nearest) return;
    ShapeDistance distance;
    if (plate.endless || touches != 0) {
      distance.distance = least_along(body.shape, pose, plate.normal, distance.on_first) -
                          plate.normal.dot(plate.point);
      for (const SolidSide& side : plate.sides) move_out(side, body.shape, pose, distance);
    } else {
      distance = shape_distance(body.shape, pose, *plate.shape, plate.world_from_shape);
    }
    if (distance.distance >= nearest) return;
    if (touches == 0) {
      distance.distance += allowance(all);
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
  search.blocks();
  return std::move(search.found);
}

CollisionWorld::Surroundings CollisionWorld::obstacles(const Query& query) const {
  Parts::Search search(*parts_, query);
  search.obstacles();
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
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(parts.bodies.size());
  for (std::size_t b = 0; b < parts.bodies.size(); ++b)
    centres.push_back(world_from_body[b] * parts.bodies[b].shape.center());
  // What may be nearest comes first: of all that is farther away the bounds are enough.
  struct Pair {
    double at_least;
    std::size_t first, second;  // bodies
    bool of_capsules;
    auto operator<=>(const Pair&) const = default;
  };
  std::vector<Pair> pairs;
  for (const auto& [first, second] : parts.self_pairs) {
    for (std::size_t a = parts.link_begin[first]; a < parts.link_begin[first + 1]; ++a) {
      for (std::size_t b = parts.link_begin[second]; b < parts.link_begin[second + 1]; ++b) {
        const double spheres = (centres[a] - centres[b]).norm() -
                               parts.bodies[a].shape.bounding_radius() -
                               parts.bodies[b].shape.bounding_radius();
        if (spheres < cutoff_m) pairs.push_back({spheres, a, b, false});
      }
    }
  }
  std::ranges::make_heap(pairs, std::greater());
  Closest closest;
  closest.distance_m = cutoff_m;
  while (!pairs.empty() && pairs.front().at_least < closest.distance_m) {
    std::ranges::pop_heap(pairs, std::greater());
    Pair& pair = pairs.back();
    const Body &one = parts.bodies[pair.first], &other = parts.bodies[pair.second];
    const Eigen::Isometry3d& one_pose = world_from_body[pair.first];
    const Eigen::Isometry3d& other_pose = world_from_body[pair.second];
    if (!pair.of_capsules) {
      const double between = capsule_distance(one.shape, one_pose, other.shape, other_pose);
      if (between > 0.0) pair.at_least = std::max(pair.at_least, between);
      pair.of_capsules = true;
      std::ranges::push_heap(pairs, std::greater());
      continue;
    }
    const ShapeDistance distance = shape_distance(one.shape, one_pose, other.shape, other_pose);
    pairs.pop_back();
    if (distance.distance >= closest.distance_m) continue;
    closest.distance_m = distance.distance;
    closest.link = one.link;
    closest.other_link = other.link;
    closest.point = distance.on_first;
  }
  if (closest.other_link >= 0) closest.what = parts.link_names[closest.other_link];
  return closest;
}

}  // namespace locograph
