#pragma once
/// Plan files as the commands use them: read, put into a world, checked.
///
///     PlanFile file = load_plan("plan.g2o");
///     WorldOptions options;                                     // --map, --obstacles
///     Judging judging = judging_of(file, options);
///     CheckReport report = check_plan(file, judging);

#include <locograph/apps/option_parser.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>

#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

struct PlanFile {
  std::string name;
  Graph graph;
  Plan plan;
};

/// plan_of() of a graph that was read from a file, which errors name.
Plan plan_of_file(const Graph& graph, const std::string& file);

/// plugins: as graph_types(). Throws Error naming the file when it is unusable or holds no plan.
PlanFile load_plan(const std::string& file, const std::vector<std::string>& plugins = {});
/// The plan in a graph that was read from this file, likewise.
PlanFile plan_in(Graph graph, const std::string& file);

/// Throws Error naming the file when it is the record of a plan carried out, which is no plan.
void require_plan(const Plan& plan, const std::string& file);

/// Throws Error with the line of a configuration that is not after the one before.
void require_increasing_times(const PlanFile& file);

/// The files that it names: of its robot, its world, its scenario, its contacts.
std::vector<std::filesystem::path> files_of(const PlanFile& file);

/// What commands are told about the world: see JudgingRequest.
struct WorldOptions {
  std::string scenario, map, obstacles;
  bool given() const { return !map.empty() || !obstacles.empty(); }
};

/// Adds `--map` and `--obstacles`. options must outlive the parsing.
void add_world_options(OptionParser& parser, WorldOptions& options);

/// By whose word the plan is judged. Throws Error naming the file.
Judging judging_of(const PlanFile& file, const WorldOptions& options);

CheckReport check_plan(const PlanFile& file, const Judging& judging);

}  // namespace locograph
