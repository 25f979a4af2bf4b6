#pragma once
/// The planners of segments by their names, the cheapest first.
///
///     for (const std::string& name : segment_planner_names()) std::cout << name << '\n';
///     const auto planner = make_segment_planner("interpolation");
///
///   interpolation    configurations half-way, brought back to the contacts, again and again
///   optimisation     a graph of all configurations between the ends, by the graph optimiser
///   rrt_connect      OMPL's RRT-Connect on the manifold of closed contacts
///   atlas_rrt_star   OMPL's RRT* on an atlas of that manifold (Jaillet and Porta, "Asymptotically-
///                    optimal path planning on manifolds", RSS 2012), as in Rossini et al.

#include <locograph/planners/offline/motion/segment_planner.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// In the order in which they are tried.
const std::vector<std::string>& segment_planner_names();
/// Throws Error for an unknown name, with those that are known.
std::unique_ptr<SegmentPlanner> make_segment_planner(const std::string& name);

}  // namespace locograph
