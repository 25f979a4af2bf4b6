#pragma once
/// The tree that a search for stances has tried, as a file: `plan --tree` writes it, `view --tree`
/// shows it. doc/stance_planner.md describes the file.
///
///     write_file_atomically("tree.json", stance_tree_text(scenario.name, "guided", 7, plan));
///     scene["tree"] = tree_scene("tree.json");

#include <locograph/apps/output.h>
#include <locograph/planners/offline/stance/stance_planner.h>

namespace locograph {

/// A node a line.
std::string stance_tree_text(const std::string& scenario, const std::string& planner,
                             std::uint64_t seed, const StancePlan& plan);

/// The member `tree` of a scene: middles of the contacts, parents, what became of each. Throws
/// Error for a file that is no such tree.
Json tree_scene(const std::string& file);

}  // namespace locograph
