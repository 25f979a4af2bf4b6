#pragma once
/// A whole motion as a graph: what `locograph plan` writes.
///
///     Graph graph = motion_graph(scenario, problem, plan);
///     write_graph(graph, "plan.g2o");
///
/// One VERTEX_CONFIGURATION for each configuration with its time and the stance that it is left in,
/// the first one fixed; VERTEX_WRENCHES where wrenches are known; a PARAMS_SEGMENT for each
/// segment; and the edges that say what has to hold.

#include <locograph/core/graph.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/plan/balance_edges.h>
#include <locograph/planners/scenario/scenario.h>

#include <vector>

namespace locograph {

/// The plan is marked incomplete where it has no success. Throws Error for a motion without
/// configurations or with a step whose stance is not known.
Graph motion_graph(const Scenario& scenario, const StanceProblem& problem, const MotionPlan& plan);

/// Adds the edges to a plan that has parameters and configurations: contacts, those of both stances
/// where it changes, and rolling of wheels; limits of joints, their velocities and, where `check`
/// has them, those of the base and accelerations; distances of links to each other and, where
/// PARAMS_WORLD names something, on the way to what it names; balance where wrenches are given.
/// What the shapes of distance edges see too near in the motion already has no weight there.
/// wrenches: at the contacts of the stance that each configuration is left in, empty where they are
/// not known; or none at all.
void add_motion_edges(Graph& graph, const CheckOptions& check,
                      const std::vector<StanceWrenches>& wrenches = {});

}  // namespace locograph
