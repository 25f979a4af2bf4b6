#pragma once
/// Footings: of each end effector the number of the place it touches.
///
///     const Footing lifted = without(footing, 0);
///     const Footing moved = with(lifted, 0, place);

#include <cstddef>
#include <utility>
#include <vector>

namespace locograph {

/// Of each end effector the place it touches; kFree: none.
using Footing = std::vector<int>;
inline constexpr int kFree = -1;

struct FootingHash {
  std::size_t operator()(const Footing& footing) const;
};

Footing with(Footing footing, int effector, int place);
inline Footing without(Footing footing, int effector) {
  return with(std::move(footing), effector, kFree);
}
int contacts_of(const Footing& footing);
/// Both, one behind the other: the key of a transition.
Footing joined(Footing from, const Footing& to);
/// The first end effector that two footings differ in; they must differ.
int changed_effector(const Footing& before, const Footing& after);

}  // namespace locograph
