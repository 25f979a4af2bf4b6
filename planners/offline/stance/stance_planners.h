#pragma once
/// The stance planners by their names.
///
///     for (const std::string& name : stance_planner_names()) std::cout << name << '\n';
///     const auto planner = make_stance_planner("guided");
///
///   guided   best-first search over moves of end effectors, guided by the distances to the goal
///            and by what has failed, begun anew while it does not arrive, then shortened; the
///            default
///   rrt      the published one: a random tree in contact space, on the same transitions

#include <locograph/planners/offline/stance/stance_planner.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// "guided", "rrt"
std::vector<std::string> stance_planner_names();
/// Throws Error for another name.
std::unique_ptr<const StancePlanner> make_stance_planner(const std::string& name);

}  // namespace locograph
