#include <locograph/planners/offline/stance/footing.h>

#include <algorithm>

namespace locograph {

std::size_t FootingHash::operator()(const Footing& footing) const {
  std::size_t hash = 1469598103934665603ULL;
  for (const int place : footing) {
    hash = (hash ^ (static_cast<std::size_t>(place) + 2)) * 1099511628211ULL;
  }
  return hash;
}

Footing with(Footing footing, int effector, int place) {
  footing[static_cast<std::size_t>(effector)] = place;
  return footing;
}

int contacts_of(const Footing& footing) {
  return static_cast<int>(
      std::count_if(footing.begin(), footing.end(), [](int place) { return place != kFree; }));
}

Footing joined(Footing from, const Footing& to) {
  from.insert(from.end(), to.begin(), to.end());
  return from;
}

int changed_effector(const Footing& before, const Footing& after) {
  const auto [changed, now] = std::mismatch(before.begin(), before.end(), after.begin());
  return static_cast<int>(changed - before.begin());
}

}  // namespace locograph
