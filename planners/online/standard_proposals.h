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

}  // namespace locograph
