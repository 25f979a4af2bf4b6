#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/uniform.h>
#include <locograph/robots/triangle_tree.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/ray_caster.h>
#include <locograph/world/world_solids.h>

#include <cmath>
#include <random>
#include <set>

#include "world/perception/camera_support.h"

namespace locograph {
namespace {

using test::looking;
using test::ray_of;
using test::small_camera;
using test::TemporaryFolder;

Obstacle obstacle_at(Obstacle::Shape shape, const Eigen::Vector3d& size, double x, double y,
                     double z) {
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.size = size;
  obstacle.world_from_obstacle.translation() = Eigen::Vector3d(x, y, z);
  return obstacle;
}

/// One of everything, on the ground in front of x = 0.
World full_world() {
  World world;
  world.obstacles = {
      obstacle_at(Obstacle::Shape::kBox, {0.4, 0.3, 0.8}, 2.0, 0.6, 0.4),
      obstacle_at(Obstacle::Shape::kSphere, {0.3, 0.0, 0.0}, 1.6, -0.5, 0.7),
      obstacle_at(Obstacle::Shape::kCylinder, {0.1, 1.2, 0.0}, 2.4, -0.2, 0.6),
  };
  world.obstacles[0].name = "cart";
  world.obstacles[0].world_from_obstacle.rotate(
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.2, 0.1, 1.0).normalized()));
  world.obstacles[2].world_from_obstacle.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  Surface shelf{.name = "shelf", .half_x_m = 0.3, .half_y_m = 0.4};
  shelf.world_from_surface.translate(Eigen::Vector3d(3.0, 1.2, 0.6));
  shelf.world_from_surface.rotate(Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY()));
  world.surfaces = {ground(), shelf};
  world.bars = {
      {.name = "rail", .from = {2.5, -1.5, 0.9}, .to = {2.8, 1.5, 1.0}, .radius_m = 0.03}};
  SolidBox block{.name = "block", .size_m = {0.5, 0.6, 0.3}};
  block.world_from_box.translate(Eigen::Vector3d(1.8, -1.3, 0.15));
  block.world_from_box.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  world.solids = {block};
  Box wall;
  wall.world_from_box.translation() = Eigen::Vector3d(3.6, 0.1, 0.5);
  wall.size = Eigen::Vector3d(0.2, 1.5, 1.4);
  world.map = octree_from_boxes({&wall, 1}, 0.05);
  return world;
}

/// Of a tiny ball around the point from everything of a kind, as the judge measures it.
double distance_to_shape(const ConvexShape& shape, const Eigen::Isometry3d& pose,
                         const Eigen::Vector3d& point) {
  constexpr double kBall = 1e-5;
  const Eigen::Isometry3d at(Eigen::Translation3d(point.x(), point.y(), point.z()));
  return shape_distance(ConvexShape::sphere(kBall), at, shape, pose).distance + kBall;
}

struct Judge {
  const Robot& robot;
  const RobotState& state;
  const WorldSolids& solids;
  double time_s;

  double distance(const Shown& shown, const Eigen::Vector3d& point) const {
    const std::size_t index = static_cast<std::size_t>(shown.index);
    double least = std::numeric_limits<double>::infinity();
    switch (shown.kind) {
      case Shown::Kind::kLink:
        for (const CollisionShape& shape : robot.links()[index].collision) {
          least = std::min(
              least,
              distance_to_shape(link_solid(robot, shape),
                                state.world_from_link(shown.index) * shape.link_from_shape, point));
        }
        return least;
      case Shown::Kind::kObstacle:
        return solids.obstacles[index].distance(point, time_s);
      case Shown::Kind::kSurface: {
        const PlateSolid& plate = solids.plates[index];
        if (plate.endless) return plate.normal.dot(point - plate.point);
        return distance_to_shape(*plate.shape, plate.world_from_shape, point);
      }
      case Shown::Kind::kBar:
        return distance_to_shape(solids.rods[index].shape, solids.rods[index].world_from_shape,
                                 point);
      case Shown::Kind::kSolid:
        return distance_to_shape(solids.blocks[index].shape, solids.blocks[index].world_from_shape,
                                 point);
      case Shown::Kind::kMap: {
        const Eigen::Isometry3d at(Eigen::Translation3d(point.x(), point.y(), point.z()));
        const ConvexShape ball = ConvexShape::sphere(1e-5);
        VoxelTree::Query query{ball, at};
        solids.voxels->nearest(query);
        return query.best.distance + 1e-5;
      }
      case Shown::Kind::kNothing:
        break;
    }
    return least;
  }
};

TEST(RayCaster, EndsWhereTheJudgeMeasuresNoDistance) {
  const Robot robot = test::shipped("centauro");
  RobotState state(robot);
  state.update(test::standing(robot, 0.7188).data());
  const World world = full_world();
  const WorldSolids solids(world);
  const Judge judge{robot, state, solids, 0.0};
  RayCaster rays(robot, world);
  DepthCamera camera = small_camera(160, 120);
  camera.link = 0;
  std::set<Shown::Kind> kinds;
  std::mt19937_64 random(9);
  for (const double down : {0.3, 1.0}) {
    camera.link_from_optical = looking({-0.1, 0.1, 1.1}, down);
    FirstHits hits;
    rays.cast(camera, state, 0.0, hits);
    ASSERT_EQ(hits.depth_m.size(), 160u * 120u);
    const Eigen::Isometry3d world_from_optical =
        state.world_from_link(0) * camera.link_from_optical;
    for (int pixel = 0; pixel < 160 * 120; pixel += 7) {
      const float depth = hits.depth_m[static_cast<std::size_t>(pixel)];
      const Shown shown = rays.shown(hits.shows[static_cast<std::size_t>(pixel)]);
      ASSERT_EQ(shown.kind == Shown::Kind::kNothing, std::isinf(depth));
      if (std::isinf(depth)) continue;
      kinds.insert(shown.kind);
      const Eigen::Vector3d ray = ray_of(camera, pixel);
      const Eigen::Vector3d hit = world_from_optical * Eigen::Vector3d(depth * ray);
      EXPECT_NEAR(judge.distance(shown, hit), 0.0, 1.2e-5) << pixel << " " << shown.name;
      // Nothing of the others comes before.
      const Eigen::Vector3d before =
          world_from_optical * Eigen::Vector3d(uniform(random, 0.5, 0.99) * depth * ray);
      for (int other = 0; rays.shown(other).kind != Shown::Kind::kNothing; ++other) {
        EXPECT_GT(judge.distance(rays.shown(other), before), -1e-6)
            << pixel << " " << rays.shown(other).name;
      }
    }
  }
  EXPECT_EQ(kinds.size(), 6u);
}

TEST(RayCaster, MeetsTheTrianglesOfAMesh) {
  const TemporaryFolder folder;
  folder.write("tetrahedron.stl", R"(solid t
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 3 0 vertex 3 0 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 3 0 0 vertex 0 0 3 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 3 vertex 0 3 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 3 0 0 vertex 0 3 0 vertex 0 0 3 endloop endfacet
endsolid
)");
  const Robot robot =
      test::robot_of_shapes(folder, R"(<mesh filename="tetrahedron.stl" scale="0.2 0.2 0.2"/>)");
  const RobotState state(robot);
  const int arm = robot.link_index("arm");
  const Eigen::Isometry3d world_from_shape =
      state.world_from_link(arm) *
      robot.links()[static_cast<std::size_t>(arm)].collision[0].link_from_shape;
  RayCaster rays(robot, {});
  DepthCamera camera = small_camera();
  camera.link_from_optical = looking({0.0, 0.0, 0.2}, 0.1);
  FirstHits hits;
  rays.cast(camera, state, 0.0, hits);
  int met = 0;
  for (std::size_t pixel = 0; pixel < hits.depth_m.size(); ++pixel) {
    if (std::isinf(hits.depth_m[pixel])) continue;
    ++met;
    EXPECT_EQ(hits.shows[pixel], arm);
    const Eigen::Vector3d ray = ray_of(camera, static_cast<int>(pixel));
    const Eigen::Vector3d p = world_from_shape.inverse() *
                              (state.world_from_link(0) * camera.link_from_optical *
                               Eigen::Vector3d(static_cast<double>(hits.depth_m[pixel]) * ray));
    EXPECT_NEAR(std::max(-p.minCoeff(), (p.sum() - 0.6) / std::sqrt(3.0)), 0.0, 1e-6) << pixel;
  }
  EXPECT_GT(met, 500);
}

TEST(RayCaster, EndsInTheVoxelOfOctoMapsOwnRay) {
  std::vector<Box> boxes(3);
  std::mt19937_64 random(8);
  for (Box& box : boxes) {
    box.world_from_box.translation() =
        Eigen::Vector3d(uniform(random, 1.5, 3.0), uniform(random, -1.0, 1.0), 0.3);
    box.world_from_box.rotate(
        Eigen::AngleAxisd(uniform(random, 0.0, 3.0), Eigen::Vector3d::UnitZ()));
    box.size = Eigen::Vector3d(0.8, 0.3, 1.0);
  }
  World world;
  world.map = octree_from_boxes(boxes, 0.05);
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.01"/>)");
  RobotState state(robot);
  RayCaster rays(robot, world);
  DepthCamera camera = small_camera();
  camera.link_from_optical = looking({0.013, 0.021, 0.517}, 0.2);
  const Eigen::Isometry3d world_from_optical = state.world_from_link(0) * camera.link_from_optical;
  FirstHits hits;
  rays.cast(camera, state, 0.0, hits);
  const Eigen::Vector3d origin = world_from_optical.translation();
  int met = 0, other_voxel = 0, map = 0;
  while (rays.shown(map).kind != Shown::Kind::kMap) ++map;
  for (int pixel = 0; pixel < 160 * 120; ++pixel) {
    const Eigen::Vector3d ray = world_from_optical.linear() * ray_of(camera, pixel);
    octomap::point3d end;
    const auto point = [](const Eigen::Vector3d& p) {
      return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()),
                              static_cast<float>(p.z()));
    };
    const bool theirs = world.map->castRay(point(origin), point(ray), end, true, 8.0);
    const std::size_t at = static_cast<std::size_t>(pixel);
    if (!theirs || hits.shows[at] != map) {
      other_voxel += theirs != (hits.shows[at] == map);
      continue;
    }
    ++met;
    const Eigen::Vector3d hit = origin + static_cast<double>(hits.depth_m[at]) * ray;
    const Eigen::Vector3d centre(end.x(), end.y(), end.z());
    // Theirs stops a voxel later where the ray passes an edge, up to rounding.
    const double out = (hit - centre).cwiseAbs().maxCoeff();
    other_voxel += out > 0.025 + 1e-5;
    EXPECT_LT(out, 0.075 + 1e-5) << pixel;
  }
  EXPECT_GT(met, 3000);
  EXPECT_LT(other_voxel, 6);
}

TEST(RayCaster, SeesAMovingObstacleWhereItIsThen) {
  World world;
  world.obstacles = {obstacle_at(Obstacle::Shape::kSphere, {0.2, 0.0, 0.0}, 2.0, 0.0, 0.5)};
  world.obstacles[0].motion = {
      {.time_s = 2.0, .pose = Eigen::Isometry3d(Eigen::Translation3d(4.0, 0.0, 0.5))}};
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.01"/>)");
  const RobotState state(robot);
  RayCaster rays(robot, world);
  DepthCamera camera = small_camera(161, 121);
  camera.link_from_optical = looking({0.0, 0.0, 0.5}, 0.0);
  camera.link = robot.link_index("base");
  FirstHits hits;
  for (const double time_s : {-1.0, 0.0, 0.7, 2.0, 9.0}) {
    rays.cast(camera, state, time_s, hits);
    EXPECT_NEAR(hits.depth_m[60 * 161 + 80], 1.8 + std::clamp(time_s, 0.0, 2.0), 1e-6);
  }
}

TEST(RayCaster, LooksToTheEndOfTheRangeAndNotFromInside) {
  World world;
  world.obstacles = {obstacle_at(Obstacle::Shape::kBox, {2.0, 2.0, 2.0}, 0.0, 0.0, 0.0),
                     obstacle_at(Obstacle::Shape::kBox, {0.1, 4.0, 4.0}, 5.0, 0.0, 0.0)};
  Surface ceiling = ground();
  ceiling.world_from_surface.translation().z() = 1.0;  // below which everything is solid
  world.surfaces = {ceiling};
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.01"/>)");
  const RobotState state(robot);
  RayCaster rays(robot, world);
  DepthCamera camera = small_camera(161, 121);
  camera.link_from_optical = looking({0.0, 0.0, 0.0}, 0.0);
  const std::size_t middle = 60 * 161 + 80;
  FirstHits hits;
  for (const double most : {4.9, 5.0}) {
    camera.range_max_m = most;
    rays.cast(camera, state, 0.0, hits);
    EXPECT_EQ(rays.shown(hits.shows[middle]).kind,
              most < 4.95 ? Shown::Kind::kNothing : Shown::Kind::kObstacle);
    if (most > 4.95) {
      EXPECT_NEAR(hits.depth_m[middle], 4.95, 1e-6);
    }
  }
}

TEST(RayCaster, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Robot robot = test::shipped("coman_plus");
  RobotState state(robot);
  state.update(test::standing(robot, 0.96).data());
  DepthCamera camera = small_camera(157, 119);  // no whole tiles
  camera.link = robot.link_index("DWYTorso");
  camera.link_from_optical = looking({0.3, 0.0, 0.2}, 0.9);
  const World world = full_world();
  FirstHits one, three;
  RayCaster(robot, world).cast(camera, state, 0.0, one);
  RayCaster(robot, world, 3).cast(camera, state, 0.0, three);
  EXPECT_EQ(one.depth_m, three.depth_m);
  EXPECT_EQ(one.shows, three.shows);
}

TEST(RayCaster, TellsWhatAPixelShows) {
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.3"/>)");
  const RayCaster rays(robot, full_world());
  EXPECT_EQ(rays.shown(robot.link_index("arm")).name, "arm");
  std::vector<std::string> names;
  for (int number = 2; rays.shown(number).kind != Shown::Kind::kNothing; ++number)
    names.push_back(rays.shown(number).name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"cart", "", "", "ground", "shelf", "rail", "block", "map"}));
  EXPECT_EQ(rays.shown(-1).kind, Shown::Kind::kNothing);
  EXPECT_EQ(rays.shown(3).index, 1);
}

TEST(RayCaster, RefusesCamerasAndStatesOfOthers) {
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.3"/>)");
  const RobotState state(robot);
  RayCaster rays(robot, full_world());
  FirstHits hits;
  DepthCamera camera = small_camera();
  camera.link = 2;
  EXPECT_THROW(rays.cast(camera, state, 0.0, hits), Error);
  camera.link = -1;
  EXPECT_THROW(rays.cast(camera, state, 0.0, hits), Error);
  camera.link = 0;
  EXPECT_THROW(rays.cast(camera, state, NAN, hits), Error);
  camera.fx = 0.0;
  EXPECT_THROW(rays.cast(camera, state, 0.0, hits), Error);
  const Robot centauro = test::shipped("centauro");
  EXPECT_THROW(rays.cast(small_camera(), RobotState(centauro), 0.0, hits), Error);
}

}  // namespace
}  // namespace locograph
