#pragma once
/// The planner of segments by the graph optimiser: all configurations between the ends at once.
///
/// The configurations of one segment are the vertices of a graph, its ends are held. Edges close
/// the contacts, keep away from everything that TransitionRows knows (links, surfaces, bars, boxes,
/// map, joint limits, balance, torques), pull what swings to its arc, and pull neighbours together,
/// so that the way is short and even. Levenberg-Marquardt (core/optimiser.h) begins with the
/// straight way, then with ways that bend towards the robot's named configurations. Arcs are only
/// wished for: where one cannot be followed, the way that is nearest to it is found.

#include <locograph/planners/offline/motion/segment_planner.h>

#include <memory>

namespace locograph {

std::unique_ptr<SegmentPlanner> make_optimisation();

}  // namespace locograph
