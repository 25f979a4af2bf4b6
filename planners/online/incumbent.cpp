#include <locograph/planners/online/incumbent.h>

namespace locograph {
namespace {

/// In place: the memory of the state is kept.
void replace(WindowCandidate& candidate, const WindowQuality& quality,
             const std::vector<double>& state) {
  candidate.quality = quality;
  candidate.state = state;
}

}  // namespace

void Incumbent::clear() {
  best_.state.clear();
  least_violating_.state.clear();
}

bool Incumbent::offer(const WindowQuality& quality, const std::vector<double>& state) {
  if (least_violating_.state.empty() ||
      quality.worst.ratio < least_violating_.quality.worst.ratio) {
    replace(least_violating_, quality, state);
  }
  if (!best_.state.empty() && !quality.better_than(best_.quality)) return false;
  replace(best_, quality, state);
  return true;
}

const std::vector<double>* Incumbent::unfinished(const std::vector<double>* cut_short) const {
  if (cut_short == nullptr && best_.quality.feasible()) return nullptr;
  const std::vector<double>& state = cut_short != nullptr ? *cut_short : least_violating_.state;
  return state == best_.state ? nullptr : &state;
}

}  // namespace locograph
