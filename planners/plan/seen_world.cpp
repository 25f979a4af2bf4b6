#include <locograph/planners/plan/seen_world.h>
#include <locograph/world/distance_view.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// How far from the plan the map still matters [m], beside it, below the lowest base or the ground
/// and above the highest base.
constexpr double kBeside_m = 2.5, kBelow_m = 0.5, kAbove_m = 1.5;

}  // namespace

std::shared_ptr<const WorldSnapshot> seen_world(const Graph& graph, const Plan& plan,
                                                const World& world) {
  if (!plan.robot->robot->floating_base()) return std::make_shared<const WorldSnapshot>(world);
  Eigen::AlignedBox3d box;
  for (const int slot : plan.slots) {
    box.extend(Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(graph.state(slot))));
  }
  DistanceFieldOptions options;
  options.lower = box.min().array() - kBeside_m;
  options.upper = box.max().array() + kBeside_m;
  double lowest = box.min().z();
  if (const double ground = ground_height(world); std::isfinite(ground)) {
    lowest = std::min(lowest, ground);
  }
  options.lower->z() = lowest - kBelow_m;
  options.upper->z() = box.max().z() + kAbove_m;
  return std::make_shared<const WorldSnapshot>(world, 0.0, WorldFiles(), options);
}

}  // namespace locograph
