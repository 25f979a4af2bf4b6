#pragma once
/// The proposals that come with locograph.
///
///     options.proposals = standard_proposals();
///
/// A line here for each; doc/window_proposals.md tells how one is added.

#include <locograph/planners/online/proposal.h>

#include <vector>

namespace locograph {

/// In the order in which they are asked.
std::vector<ProposalFactory> standard_proposals();

/// LocalPlannerOptions::fallbacks for worlds that depth cameras show: detours that turn the robot
/// as well. Of obstacles the map has the surfaces that were seen, between which no optimiser finds
/// out.
std::vector<ProposalFactory> camera_fallbacks();

}  // namespace locograph
