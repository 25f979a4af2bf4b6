#pragma once
/// The tree that a search for stances has tried, as a file: `plan --tree` writes it, `view --tree`
/// shows it. doc/stance_planner.md describes the file.
///
///     write_file_atomically("tree.json", stance_tree_text(scenario.name, "guided", 7, plan));
///     scene["tree"] = tree_scene("tree.json", scenario.name, plan.stances.front());

#include <locograph/apps/output.h>
#include <locograph/planners/offline/stance/stance_plan.h>

namespace locograph {

/// A node a line.
std::string stance_tree_text(const std::string& scenario, const std::string& planner,
                             std::uint64_t seed, const StancePlan& plan);

/// The member `tree` of a scene: middles of the contacts, parents, what became of each. scenario:
/// the name of the plan's own, "" if it is not known. Throws Error for a file that is no such tree,
/// and for one of another task than the plan's: of another scenario, or without the plan's first
/// stance.
Json tree_scene(const std::string& file, const std::string& scenario, const Stance& first);

}  // namespace locograph
