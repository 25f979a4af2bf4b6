#pragma once
/// What the tests of the online planner share: the shipped drive, and a box on its way.
///
///     Graph graph = drive();
///     LocalPlanner planner(graph, {});
///     planner.show(seeing({box_ahead()}));

#include <locograph/world/world_snapshot.h>

#include <memory>
#include <utility>
#include <vector>

#include "planners/planned_drive.h"

namespace locograph {

inline Graph drive() { return planned_drive(centauro_drive()); }

inline Obstacle box_ahead() { return box("box", {2.0, 0.0, 0.25}, {0.5, 0.5, 0.5}); }

inline std::shared_ptr<const WorldSnapshot> seeing(const std::vector<Obstacle>& obstacles) {
  World world;
  world.obstacles = obstacles;
  return std::make_shared<const WorldSnapshot>(std::move(world));
}

}  // namespace locograph
