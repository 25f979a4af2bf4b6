#include <locograph/common/error.h>
#include <locograph/common/thread_pool.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/perception/image_bounds.h>
#include <locograph/world/perception/ray_caster.h>
#include <locograph/world/perception/ray_tile.h>
#include <locograph/world/world_solids.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace locograph {
namespace {

/// A solid in the optical frame that may show in an image.
struct CastSolid {
  ImageBounds bounds;
  std::int64_t who;
  Eigen::Isometry3d optical_from_shape;
  const ConvexShape* shape;  // null: a half space, below z = 0 of the shape's frame
  const TriangleTree* mesh;  // null: the shape itself
};

struct RobotPart {
  int link;
  Eigen::Isometry3d link_from_shape;
  ConvexShape shape;  // of a mesh: its hull
  std::optional<TriangleTree> mesh;
};

struct Names {
  Shown::Kind kind;
  std::vector<std::string> names;
};

bool holds_origin(const CastSolid& solid) {
  const Eigen::Vector3d origin = solid.optical_from_shape.inverse().translation();
  if (solid.shape == nullptr) return origin.z() <= 0.0;
  if (solid.mesh != nullptr) return solid.mesh->distance_outside(origin) == 0.0;
  const ConvexShape& shape = *solid.shape;
  if (shape.type() == ConvexShape::Type::kBox)
    return (origin.cwiseAbs() - shape.half_extents()).maxCoeff() <= 0.0;
  const double beyond = std::abs(origin.z()) - shape.half_length();
  if (shape.type() == ConvexShape::Type::kCylinder)
    return beyond <= 0.0 && origin.head<2>().norm() <= shape.radius();
  const double up = std::max(beyond, 0.0);
  return std::hypot(origin.x(), origin.y(), up) <= shape.radius();
}

ImageBounds bounds_of(const DepthCamera& camera, const CastSolid& solid) {
  const Eigen::Isometry3d& pose = solid.optical_from_shape;
  if (solid.shape == nullptr) return {0, camera.width, 0, camera.height, 0.0, camera.range_max_m};
  const ConvexShape& shape = *solid.shape;
  if (shape.type() == ConvexShape::Type::kBox)
    return image_bounds(camera, pose, shape.half_extents());
  return image_bounds(camera, {pose * Eigen::Vector3d(shape.center() - shape.bounding_axis()),
                               pose * Eigen::Vector3d(shape.center() + shape.bounding_axis()),
                               shape.bounding_capsule_radius()});
}

void meet_mesh(RayTile& tile, const CastSolid& solid) {
  const Eigen::Isometry3d shape_from_optical = solid.optical_from_shape.inverse();
  const Eigen::Vector3d origin = shape_from_optical.translation();
  for (int i = 0; i < RayTile::kRays; ++i) {
    const Eigen::Vector3d ray =
        shape_from_optical.linear() * Eigen::Vector3d(tile.x[i], tile.y[i], 1.0);
    const double met = solid.mesh->first_hit(origin, ray, tile.depth[i]);
    if (!(met < tile.depth[i])) continue;
    tile.depth[i] = met;
    tile.shows[i] = solid.who;
  }
  tile.look_how_far();
}

void meet(RayTile& tile, const CastSolid& solid) {
  const Eigen::Isometry3d& pose = solid.optical_from_shape;
  if (solid.mesh != nullptr) {
    meet_mesh(tile, solid);
  } else if (solid.shape == nullptr) {
    const Eigen::Vector3d normal = pose.linear().col(2);
    tile.meet(HalfSpaceEntry(normal, normal.dot(pose.translation())), solid.who);
  } else if (solid.shape->type() == ConvexShape::Type::kBox) {
    tile.meet(BoxEntry(pose, solid.shape->half_extents()), solid.who);
  } else if (solid.shape->type() == ConvexShape::Type::kCylinder) {
    tile.meet(CylinderEntry(pose, solid.shape->radius(), solid.shape->half_length()), solid.who);
  } else {
    tile.meet(CapsuleEntry(pose, solid.shape->radius(), solid.shape->half_length()), solid.who);
  }
}

/// The rays of a tile among the leaves of a map, which stand along the world's axes.
class VoxelRays {
 public:
  VoxelRays(const RayTile& tile, const Eigen::Isometry3d& world_from_optical)
      : origin_(world_from_optical.translation()), ahead_(world_from_optical.linear().col(2)) {
    const Eigen::Matrix3d& turn = world_from_optical.linear();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = turn(axis, 0), b = turn(axis, 1), c = turn(axis, 2);
      for (int i = 0; i < RayTile::kRays; ++i)
        inverse_[axis][i] = 1.0 / (a * tile.x[i] + b * tile.y[i] + c);
    }
    constexpr int kLast = RayTile::kRays - 1;
    sides_[0] = turn * Eigen::Vector3d(1.0, 0.0, -tile.x[0]);
    sides_[1] = turn * Eigen::Vector3d(-1.0, 0.0, tile.x[kLast]);
    sides_[2] = turn * Eigen::Vector3d(0.0, 1.0, -tile.y[0]);
    sides_[3] = turn * Eigen::Vector3d(0.0, -1.0, tile.y[kLast]);
  }

  void meet(RayTile& tile, const VoxelTree& voxels, std::int64_t who) const {
    voxels.visit(
        ahead_,
        [&](const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
          return may_show(lower, upper, tile.farthest);
        },
        [&](const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
          meet_box(tile, lower - origin_, upper - origin_, who);
        });
  }

 private:
  bool may_show(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double farthest) const {
    const Eigen::Vector3d middle = 0.5 * (lower + upper) - origin_, half = 0.5 * (upper - lower);
    const double reach = ahead_.cwiseAbs().dot(half), depth = ahead_.dot(middle);
    if (depth + reach <= 0.0 || depth - reach >= farthest) return false;
    for (const Eigen::Vector3d& side : sides_) {
      if (side.dot(middle) + side.cwiseAbs().dot(half) < 0.0) return false;
    }
    return true;
  }

  void meet_box(RayTile& tile, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper,
                std::int64_t who) const {
    using ray_entries_detail::larger;
    using ray_entries_detail::smaller;
    if ((lower.array() <= 0.0).all() && (upper.array() >= 0.0).all()) return;
    const double lx = lower.x(), ly = lower.y(), lz = lower.z();
    const double ux = upper.x(), uy = upper.y(), uz = upper.z();
    for (int i = 0; i < RayTile::kRays; ++i) {
      const double ax = lx * inverse_[0][i], bx = ux * inverse_[0][i];
      const double ay = ly * inverse_[1][i], by = uy * inverse_[1][i];
      const double az = lz * inverse_[2][i], bz = uz * inverse_[2][i];
      const double in = larger(smaller(ax, bx), larger(smaller(ay, by), smaller(az, bz)));
      const double out = smaller(larger(ax, bx), smaller(larger(ay, by), larger(az, bz)));
      const bool is_first = (in <= out) & (in > 0.0) & (in < tile.depth[i]);
      tile.shows[i] = is_first ? who : tile.shows[i];
      tile.depth[i] = is_first ? in : tile.depth[i];
    }
    tile.look_how_far();
  }

  Eigen::Vector3d origin_, ahead_, sides_[4];
  alignas(64) double inverse_[3][RayTile::kRays];
};

}  // namespace

struct RayCaster::Parts {
  WorldSolids solids;
  std::size_t links;
  std::vector<RobotPart> robot;
  std::vector<Names> names;  // of all kinds, in the order of their numbers
  ThreadPool threads;

  std::vector<CastSolid> cast;                        // of an image
  std::vector<const CastSolid*> nearest_first;        // those
  std::vector<std::vector<const CastSolid*>> in_row;  // of each row of tiles

  Parts(const Robot& robot_of, const World& world, int thread_count)
      : solids(world), links(robot_of.links().size()), threads(thread_count) {
    for (std::size_t l = 0; l < links; ++l) {
      for (const CollisionShape& shape : robot_of.links()[l].collision) {
        robot.push_back(
            {static_cast<int>(l), shape.link_from_shape, link_solid(robot_of, shape), {}});
        if (shape.type == ShapeType::kMesh) robot.back().mesh.emplace(collision_mesh(shape));
      }
    }
    name(Shown::Kind::kLink, robot_of.links());
    name(Shown::Kind::kObstacle, world.obstacles);
    name(Shown::Kind::kSurface, world.surfaces);
    name(Shown::Kind::kBar, world.bars);
    name(Shown::Kind::kSolid, world.solids);
    names.push_back({Shown::Kind::kMap, {"map"}});
    std::size_t count = 0;
    for (const Names& some : names) count += some.names.size();
    if (count > INT16_MAX)
      throw Error(std::to_string(count) + " links and solids in the view of a camera",
                  std::to_string(INT16_MAX) + " at most");
  }

  template <class Named>
  void name(Shown::Kind kind, const std::vector<Named>& all) {
    names.push_back({kind, {}});
    for (const Named& one : all) names.back().names.push_back(one.name);
  }

  std::int64_t first_of(Shown::Kind kind) const {
    std::int64_t first = 0;
    for (const Names& some : names) {
      if (some.kind == kind) break;
      first += static_cast<std::int64_t>(some.names.size());
    }
    return first;
  }

  void add(const DepthCamera& camera, std::int64_t who, const Eigen::Isometry3d& pose,
           const ConvexShape* shape, const TriangleTree* mesh = nullptr) {
    CastSolid solid{{}, who, pose, shape, mesh};
    solid.bounds = bounds_of(camera, solid);
    if (solid.bounds.empty() || solid.bounds.near_m >= camera.range_max_m || holds_origin(solid))
      return;
    cast.push_back(solid);
  }

  void place(const DepthCamera& camera, const RobotState& state,
             const Eigen::Isometry3d& optical_from_world, double time_s);
  void cast_row(const DepthCamera& camera, const Eigen::Isometry3d& world_from_optical, int row,
                FirstHits& hits) const;
};

void RayCaster::Parts::place(const DepthCamera& camera, const RobotState& state,
                             const Eigen::Isometry3d& optical_from_world, double time_s) {
  cast.clear();
  for (const RobotPart& part : robot) {
    add(camera, part.link,
        optical_from_world * state.world_from_link(part.link) * part.link_from_shape, &part.shape,
        part.mesh ? &*part.mesh : nullptr);
  }
  std::int64_t who = first_of(Shown::Kind::kObstacle);
  for (std::size_t o = 0; o < solids.obstacles.size(); ++o, ++who) {
    if (!solids.obstacles[o].is_there(time_s)) continue;
    add(camera, who, optical_from_world * solids.obstacles[o].pose_at(time_s),
        &solids.obstacle_shapes[o]);
  }
  for (const PlateSolid& plate : solids.plates) {
    Eigen::Isometry3d pose = optical_from_world;
    if (plate.endless) {
      pose.translate(plate.point);
      pose.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), plate.normal));
    } else {
      pose = pose * plate.world_from_shape;
    }
    add(camera, who++, pose, plate.endless ? nullptr : &*plate.shape);
  }
  for (const BarSolid& bar : solids.rods)
    add(camera, who++, optical_from_world * bar.world_from_shape, &bar.shape);
  for (const BoxSolid& box : solids.blocks)
    add(camera, who++, optical_from_world * box.world_from_shape, &box.shape);
  nearest_first.clear();
  for (const CastSolid& solid : cast) nearest_first.push_back(&solid);
  std::ranges::sort(nearest_first, {},
                    [](const CastSolid* solid) { return std::pair(solid->bounds.near_m, solid); });
  const int rows = (camera.height + RayTile::kHigh - 1) / RayTile::kHigh;
  in_row.resize(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    std::vector<const CastSolid*>& here = in_row[static_cast<std::size_t>(row)];
    here.clear();
    for (const CastSolid* solid : nearest_first) {
      if (solid->bounds.v_begin < (row + 1) * RayTile::kHigh &&
          solid->bounds.v_end > row * RayTile::kHigh)
        here.push_back(solid);
    }
  }
}

void RayCaster::Parts::cast_row(const DepthCamera& camera,
                                const Eigen::Isometry3d& world_from_optical, int row,
                                FirstHits& hits) const {
  const int v = row * RayTile::kHigh, rows = std::min(RayTile::kHigh, camera.height - v);
  const std::int64_t map = first_of(Shown::Kind::kMap);
  RayTile tile;
  for (int u = 0; u < camera.width; u += RayTile::kWide) {
    const int columns = std::min(RayTile::kWide, camera.width - u);
    tile.start(camera, u, v);
    for (const CastSolid* solid : in_row[static_cast<std::size_t>(row)]) {
      if (solid->bounds.near_m >= tile.farthest) break;
      if (solid->bounds.u_begin < u + columns && solid->bounds.u_end > u) meet(tile, *solid);
    }
    if (solids.voxels) VoxelRays(tile, world_from_optical).meet(tile, *solids.voxels, map);
    for (int r = 0; r < rows; ++r) {
      const std::size_t to =
          static_cast<std::size_t>(v + r) * static_cast<std::size_t>(camera.width) +
          static_cast<std::size_t>(u);
      for (int i = 0; i < columns; ++i) {
        const int from = r * RayTile::kWide + i;
        hits.depth_m[to + static_cast<std::size_t>(i)] =
            tile.shows[from] < 0 ? INFINITY : static_cast<float>(tile.depth[from]);
        hits.shows[to + static_cast<std::size_t>(i)] = static_cast<std::int16_t>(tile.shows[from]);
      }
    }
  }
}

RayCaster::RayCaster(const Robot& robot, const World& world, int threads)
    : parts_(std::make_unique<Parts>(robot, world, threads)) {}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

void RayCaster::cast(const DepthCamera& camera, const RobotState& state, double time_s,
                     FirstHits& hits) {
  Parts& parts = *parts_;
  camera.validate();
  if (state.robot().links().size() != parts.links)
    throw Error(
        "a state of a robot with " + std::to_string(state.robot().links().size()) + " links",
        "one of the camera's robot, with " + std::to_string(parts.links));
  if (camera.link < 0 || static_cast<std::size_t>(camera.link) >= parts.links)
    throw Error("camera " + camera.name + " is on link " + std::to_string(camera.link),
                "a link of the robot, below " + std::to_string(parts.links));
  if (!std::isfinite(time_s)) throw Error("an image at a time that is not finite", "seconds");
  const Eigen::Isometry3d world_from_optical =
      state.world_from_link(camera.link) * camera.link_from_optical;
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  hits.depth_m.resize(pixels);
  hits.shows.resize(pixels);
  parts.place(camera, state, world_from_optical.inverse(), time_s);
  parts.threads.run(static_cast<int>(parts.in_row.size()),
                    [&](int row) { parts.cast_row(camera, world_from_optical, row, hits); });
}

Shown RayCaster::shown(int number) const {
  for (const Names& some : parts_->names) {
    if (number < 0) break;
    if (number < static_cast<int>(some.names.size()))
      return {some.kind, number, some.names[static_cast<std::size_t>(number)]};
    number -= static_cast<int>(some.names.size());
  }
  return {};
}

}  // namespace locograph
