#include <locograph/planners/online/proposal.h>
#include <locograph/planners/online/sideways_detour.h>

namespace locograph {

std::vector<ProposalFactory> standard_proposals() { return {sideways_detour()}; }

}  // namespace locograph
