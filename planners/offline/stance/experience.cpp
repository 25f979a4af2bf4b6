#include <locograph/planners/offline/stance/experience.h>

#include <algorithm>
#include <cmath>

namespace locograph {

namespace {

constexpr double kLength = 0.125, kSide_m = 0.15;

}  // namespace

template <class F>
void Experience::each_side(const Footing& footing, int effector, int place, F&& f) const {
  const Eigen::Vector3d& at = space_.place(place).bearing.contact.position;
  for (std::size_t o = 0; o < footing.size(); ++o) {
    if (static_cast<int>(o) == effector || footing[o] == kFree) continue;
    const Eigen::Vector3d off = at - space_.place(footing[o]).bearing.contact.position;
    std::uint64_t key = 1 + static_cast<std::uint64_t>(effector) * footing.size() + o;
    for (int i = 0; i < 3; ++i) {
      key = key << 16 | (static_cast<std::uint64_t>(std::floor(off[i] / kSide_m)) & 0xffff);
    }
    f(key);
  }
}

template <class F>
void Experience::each_likeness(const Footing& footing, int effector, int place, double share,
                               F&& f) const {
  f(static_cast<std::uint64_t>(effector) << 32 |
    static_cast<std::uint64_t>(std::floor(share / kLength)));
  each_side(footing, effector, place, f);
}

void Experience::learn(const Footing& footing, int effector, int place, double share, bool found) {
  each_likeness(footing, effector, place, share,
                [&](std::uint64_t likeness) { moves_[likeness].add(found); });
}

double Experience::unlikelihood(const Footing& footing, int effector, int place,
                                double share) const {
  double least = 1.0;
  each_likeness(footing, effector, place, share, [&](std::uint64_t likeness) {
    const auto known = moves_.find(likeness);
    if (known != moves_.end()) least = std::min(least, known->second.share());
  });
  return -std::log(least);
}

void Experience::learn_lift(const Footing& footing, int effector, bool found) {
  each_side(footing, effector, footing[static_cast<std::size_t>(effector)],
            [&](std::uint64_t likeness) { lifts_[likeness].add(found); });
}

double Experience::lift_unlikelihood(const Footing& footing, int effector) const {
  double sum = 0.0;
  int others = 0;
  each_side(footing, effector, footing[static_cast<std::size_t>(effector)],
            [&](std::uint64_t likeness) {
              const auto known = lifts_.find(likeness);
              sum -= std::log(known == lifts_.end() ? Count().share() : known->second.share());
              ++others;
            });
  return others == 0 ? 0.0 : sum / others;
}

}  // namespace locograph
