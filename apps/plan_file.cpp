#include <locograph/apps/graph_types.h>
#include <locograph/apps/plan_file.h>
#include <locograph/world/octree.h>

#include <algorithm>

namespace locograph {
namespace {

/// How far from the plan the map still matters [m].
constexpr double kFieldMargin_m = 2.5;

/// What stands on the floor may touch it: the wheels, and the forks that carry them.
CollisionWorldOptions collision_options(const PlanFile& file) {
  CollisionWorldOptions collision;
  if (!file.plan.wheels) return collision;
  for (const Wheel& wheel : file.plan.wheels->wheels) {
    collision.ignore_floor_links.push_back(wheel.link);
    collision.ignore_floor_links.push_back(wheel.carrier);
  }
  return collision;
}

}  // namespace

PlanFile load_plan(const std::string& file, const std::vector<std::string>& plugins) {
  PlanFile result;
  result.name = file;
  result.graph = read_graph(file, graph_types(plugins));
  try {
    result.plan = plan_of(result.graph);
  } catch (const Error& error) {
    throw Error(file, 0, error.what(), "");
  }
  return result;
}

WorldFiles world_of(const PlanFile& file, const std::string& map, const std::string& obstacles) {
  if (map.empty() && obstacles.empty() && file.plan.world) {
    return {file.plan.world->map, file.plan.world->obstacles};
  }
  return {map, obstacles};
}

LoadedWorld load_world(const WorldFiles& files) {
  LoadedWorld world;
  if (!files.map.empty()) world.map = load_octree(files.map);
  if (!files.obstacles.empty()) world.obstacles = load_obstacles(files.obstacles);
  return world;
}

WorldDistance seen_world(const PlanFile& file, const LoadedWorld& world) {
  WorldDistance result;
  result.obstacles = world.obstacles;
  if (!world.map) return result;
  Eigen::AlignedBox3d box;
  for (const int slot : file.plan.slots) {
    box.extend(Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(file.graph.state(slot))));
  }
  DistanceFieldOptions options;
  options.lower = box.min().array() - kFieldMargin_m;
  options.upper = box.max().array() + kFieldMargin_m;
  options.lower->z() = std::min(box.min().z(), 0.0) - 0.5;
  options.upper->z() = box.max().z() + 1.5;
  options.ground_z = kGroundVoxelTop_m;
  result.map =
      std::make_shared<const DistanceField>(DistanceField::from_octree(*world.map, options));
  return result;
}

std::function<CheckReport(const Motion&)> step_check(const PlanFile& file,
                                                     const LoadedWorld& world) {
  const std::shared_ptr<const Robot> robot = file.plan.robot->robot;
  const auto collisions = std::make_shared<const CollisionWorld>(*robot, world.map, world.obstacles,
                                                                 collision_options(file));
  return [robot, collisions, obstacles = world.obstacles](const Motion& motion) {
    CheckOptions options;
    options.obstacles = obstacles;
    return check_motion(*robot, *collisions, motion, options);
  };
}

CheckReport check_plan(const PlanFile& file, const LoadedWorld& world, CheckOptions options) {
  const Robot& robot = *file.plan.robot->robot;
  const CollisionWorld collision_world(robot, world.map, world.obstacles, collision_options(file));
  options.obstacles = world.obstacles;
  return check_motion(robot, collision_world, motion_of(file.graph, file.plan), options);
}

}  // namespace locograph
