#pragma once
/// Plan files as the commands use them: read, put into a world, checked.
///
///     PlanFile file = load_plan("plan.g2o");
///     WorldFiles files = world_of(file, "hall.bt", "");        // or the plan's own
///     CheckReport report = check_plan(file, load_world(files));

#include <locograph/core/graph_file.h>
#include <locograph/planners/plan/feasibility_checker.h>
#include <locograph/planners/plan/plan.h>
#include <octomap/OcTree.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

struct PlanFile {
  std::string name;
  Graph graph;
  Plan plan;
};

/// plugins: as graph_types(). Throws Error naming the file when it is unusable or holds no plan.
PlanFile load_plan(const std::string& file, const std::vector<std::string>& plugins = {});

/// Files that describe a world; empty: none.
struct WorldFiles {
  std::filesystem::path map, obstacles;
};

/// The files given on the command line or, when neither is, the plan's own.
WorldFiles world_of(const PlanFile& file, const std::string& map, const std::string& obstacles);

struct LoadedWorld {
  std::shared_ptr<const octomap::OcTree> map;  ///< null: none
  std::vector<Obstacle> obstacles;
};

LoadedWorld load_world(const WorldFiles& files);

/// The world as the local planner is shown it: exact obstacles, and the distance field of the map
/// around the plan.
WorldDistance seen_world(const PlanFile& file, const LoadedWorld& world);

CheckReport check_plan(const PlanFile& file, const LoadedWorld& world, CheckOptions options = {});

/// The check of single steps of a plan in one world, as refine() wants it.
std::function<CheckReport(const Motion&)> step_check(const PlanFile& file,
                                                     const LoadedWorld& world);

}  // namespace locograph
