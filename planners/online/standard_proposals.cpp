#include <locograph/planners/online/sideways_detour.h>
#include <locograph/planners/online/standard_proposals.h>

namespace locograph {

std::vector<ProposalFactory> standard_proposals() { return {sideways_detour()}; }

std::vector<ProposalFactory> camera_fallbacks() {
  DetourOptions slantwise;
  slantwise.largest_offset_m = 0.8;
  slantwise.most_yaw = 8;
  return {sideways_detour(slantwise)};
}

}  // namespace locograph
