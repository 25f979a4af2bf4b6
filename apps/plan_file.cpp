#include <locograph/apps/graph_types.h>
#include <locograph/apps/plan_file.h>
#include <locograph/world/octree.h>

namespace locograph {

PlanFile load_plan(const std::string& file) {
  PlanFile result;
  result.name = file;
  result.graph = read_graph(file, graph_types());
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

CheckReport check_plan(const PlanFile& file, const LoadedWorld& world, CheckOptions options) {
  CollisionWorldOptions collision;
  if (file.plan.wheels) {
    for (const Wheel& wheel : file.plan.wheels->wheels) {
      // What stands on the floor, and the fork that carries it.
      collision.ignore_floor_links.push_back(wheel.link);
      collision.ignore_floor_links.push_back(wheel.carrier);
    }
  }
  const Robot& robot = *file.plan.robot->robot;
  const CollisionWorld collision_world(robot, world.map, world.obstacles, collision);
  options.obstacles = world.obstacles;
  return check_motion(robot, collision_world, motion_of(file.graph, file.plan), options);
}

}  // namespace locograph
