#pragma once
/// Proposes to pass an obstacle on one side: the window as planned, moved sideways.
///
///     DetourOptions wide;
///     wide.largest_offset_m = 3.0;
///     options.proposals = {sideways_detour(wide)};
///
/// detour_search.h finds the offsets, and with DetourOptions::most_yaw how the robot turns on the
/// way. The wheels are steered along the way and turned to match.

#include <locograph/planners/online/detour_search.h>
#include <locograph/planners/online/proposal.h>

namespace locograph {

ProposalFactory sideways_detour(const DetourOptions& options = {});

}  // namespace locograph
