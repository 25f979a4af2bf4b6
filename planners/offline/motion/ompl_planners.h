#pragma once
/// Planners of segments by OMPL's random trees, on the manifold of closed contacts.
///
/// Trees begin and end where nothing touches but what is held (SegmentSpace::lift_off). What they
/// find is made dense, shortened (shorten_way.h) and checked.
///
/// Deterministic for SegmentOptions::seed, whatever OMPL did before and on whatever thread. OMPL
/// prints nothing meanwhile.

#include <locograph/planners/offline/motion/segment_planner.h>

#include <memory>

namespace locograph {

/// Two trees, one from each end. Half of what they grow towards are configurations that are valid
/// as well as closed.
std::unique_ptr<SegmentPlanner> make_rrt_connect();

/// On an atlas, with one chart at each end to begin with and half of the samples from charts: two
/// trees find a way (AtlasRRT), then RRT* goes on from it, at most for as many states as
/// SegmentOptions::max_states again. SegmentPath tells what it gained.
std::unique_ptr<SegmentPlanner> make_atlas_rrt_star();

}  // namespace locograph
