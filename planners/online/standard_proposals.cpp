#include <locograph/planners/online/sideways_detour.h>
#include <locograph/planners/online/standard_proposals.h>

namespace locograph {

std::vector<ProposalFactory> standard_proposals() { return {sideways_detour()}; }

}  // namespace locograph
