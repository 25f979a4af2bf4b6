#include <locograph/check/limits.h>
#include <locograph/planners/scenario/bar_place.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <cmath>

namespace locograph {

bool lies_on_something(const World& world, const Contact& contact) {
  const auto holds = [&](const auto& place) { return lies_on(place, contact); };
  return std::any_of(world.surfaces.begin(), world.surfaces.end(), holds) ||
         std::any_of(world.bars.begin(), world.bars.end(), holds);
}

Eigen::Vector3d nearest_point(const Surface& surface, const Eigen::Vector3d& local) {
  return {std::clamp(local.x(), -surface.half_x_m, surface.half_x_m),
          std::clamp(local.y(), -surface.half_y_m, surface.half_y_m), 0.0};
}

bool lies_on(const Surface& surface, const Contact& contact) {
  if (!contact_kind_entry(contact.effector.kind).touches_surfaces) return false;
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  if (!(pose.linear().col(2).dot(contact.normal) > 0.0)) return false;  // cheap
  if (angle_between(pose.linear().col(2), contact.normal) > limits::kClosed_rad) return false;
  const Eigen::Vector3d local = pose.inverse() * contact.position;
  const double sole = area_reach_m(contact.effector);
  return std::abs(local.z()) <= limits::kClosed_m &&
         (nearest_point(surface, local) - local).norm() <= sole + limits::kClosed_m;
}

bool lies_on(const Bar& bar, const Contact& contact) {
  return gap_to_bar_m(bar, contact) <= limits::kClosed_m &&
         past_ends_m(bar, contact.position) <= limits::kClosed_m;
}

}  // namespace locograph
