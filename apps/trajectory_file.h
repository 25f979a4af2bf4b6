#pragma once
/// Plans as tables (.csv) and as JSON laid out like ROS's trajectory_msgs/JointTrajectory, and
/// back.
///
///     const PlanFile plan = load_plan("plan.g2o");
///     write_file_atomically("plan.csv", trajectory_csv(plan, folder));
///     const Graph again = read_trajectory_csv("plan.csv", graph_types());
///
/// Described in doc/files.md. All that a plan says is there, but for its edges: its parameters in
/// the words of a graph file, and of each configuration time, stance and numbers, to the last bit.
/// What can be worked out of these is there for who reads the file: a schedule of contacts and
/// segments that say otherwise are refused, velocities, accelerations and twists are not read.

#include <locograph/apps/plan_file.h>

#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

/// folder: what paths are relative to; empty: they are absolute. Throws Error for a plan of
/// stances, which has no motion.
std::string trajectory_csv(const PlanFile& file, const std::filesystem::path& folder);
std::string trajectory_json(const PlanFile& file, const std::filesystem::path& folder);

/// A plan as it was read: parameters and configurations, the first one fixed, and no edges.
struct ReadTrajectory {
  Graph graph;
  /// As add_plan_edges() takes them; none where the file has none.
  std::vector<StanceWrenches> wrenches;
};

/// Throws Error with file and line.
ReadTrajectory read_trajectory_csv(const std::string& file, const TypeRegistry& types);
ReadTrajectory read_trajectory_json(const std::string& file, const TypeRegistry& types);

/// The graph of a plan that was read: with the edges that `locograph plan` gives a plan of its
/// kind, and what may be touched, where the plan names a scenario that can tell it.
Graph with_edges(ReadTrajectory trajectory, const std::string& file);

}  // namespace locograph
