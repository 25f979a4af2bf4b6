#include <locograph/common/error.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/voxel_tree.h>

#include <cmath>
#include <optional>
#include <utility>

namespace locograph {
namespace {

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

  std::vector<Eigen::Isometry3d> place(std::span<const Eigen::Isometry3d> world_from_link) const {
    if (world_from_link.size() != link_names.size())
      throw Error(std::to_string(world_from_link.size()) + " link poses",
                  std::to_string(link_names.size()) + ", one for each link of the robot");
    std::vector<Eigen::Isometry3d> world_from_body;
    world_from_body.reserve(bodies.size());
    for (const Body& body : bodies)
      world_from_body.push_back(world_from_link[std::size_t(body.link)] * body.link_from_shape);
    return world_from_body;
  }
};

CollisionWorld::CollisionWorld(const Robot& robot, std::shared_ptr<const octomap::OcTree> tree,
                               std::vector<Obstacle> obstacles,
                               const CollisionWorldOptions& options)
    : parts_(std::make_unique<Parts>()) {
  if (!std::isfinite(options.cutoff_m) || options.cutoff_m <= 0.0)
    throw Error("cutoff_m is " + std::to_string(options.cutoff_m), "a positive number of metres");
  if (!std::isfinite(options.floor_z_m)) throw Error("floor_z_m is not finite", "a height");
  parts_->options = options;
  for (const Link& link : robot.links()) {
    parts_->link_begin.push_back(parts_->bodies.size());
    const int index = int(parts_->link_names.size());
    for (const CollisionShape& shape : link.collision)
      parts_->bodies.push_back({index, link_solid(robot, shape), shape.link_from_shape});
    parts_->link_names.push_back(link.name);
  }
  parts_->link_begin.push_back(parts_->bodies.size());
  parts_->ignores_floor.assign(robot.links().size(), false);
  for (int link : options.ignore_floor_links) {
    if (link < 0 || std::size_t(link) >= robot.links().size())
      throw Error("ignore_floor_links names link " + std::to_string(link),
                  "an index below " + std::to_string(robot.links().size()));
    parts_->ignores_floor[std::size_t(link)] = true;
  }
  parts_->self_pairs = robot.self_collision_pairs();
  if (tree) parts_->voxels.emplace(*tree);
  for (const Obstacle& obstacle : obstacles) {
    obstacle.validate();
    parts_->obstacle_shapes.push_back(obstacle_solid(obstacle));
  }
  parts_->obstacles = std::move(obstacles);
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
      obstacle = int(o);
    }
  }
  for (std::size_t b = 0; parts.voxels && b < parts.bodies.size() && !done(); ++b) {
    const Body& body = parts.bodies[b];
    VoxelTree::Query query{body.shape, world_from_body[b]};
    if (parts.ignores_floor[std::size_t(body.link)]) query.floor_z = parts.options.floor_z_m;
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
  closest.what = obstacle < 0 ? "voxel" : parts.obstacles[std::size_t(obstacle)].name;
  return closest;
}

CollisionWorld::Closest CollisionWorld::self_distance(
    std::span<const Eigen::Isometry3d> world_from_link) const {
  const Parts& parts = *parts_;
  const std::vector<Eigen::Isometry3d> world_from_body = parts.place(world_from_link);
  ShapeDistance best{parts.options.cutoff_m, {}, {}};
  int first_link = -1, second_link = -1;
  for (const auto& [first, second] : parts.self_pairs) {
    for (std::size_t a = parts.link_begin[std::size_t(first)];
         a < parts.link_begin[std::size_t(first) + 1]; ++a) {
      for (std::size_t b = parts.link_begin[std::size_t(second)];
           b < parts.link_begin[std::size_t(second) + 1]; ++b) {
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
  closest.what = parts.link_names[std::size_t(second_link)];
  closest.point = best.on_first;
  return closest;
}

}  // namespace locograph
