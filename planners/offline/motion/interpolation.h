#pragma once
/// The cheapest planner of segments: configurations half-way, again and again, by the solver of
/// transitions (posture/transition_solver.h).
///
/// What swings from one place to another follows an arc: up along the normal of the one, over, and
/// down along the normal of the other. Where configurations on that arc are not found, soles may
/// turn, then the arc is higher, and at last only its ends are asked for.

#include <locograph/planners/offline/motion/segment_planner.h>

#include <memory>

namespace locograph {

std::unique_ptr<SegmentPlanner> make_interpolation();

}  // namespace locograph
