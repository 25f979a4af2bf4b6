#include <locograph/check/limits.h>
#include <locograph/planners/scenario/bar_place.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace locograph {

bool lies_on_something(const World& world, const Contact& contact) {
  const auto holds = [&](const auto& place) { return lies_on(place, contact); };
  return std::any_of(world.surfaces.begin(), world.surfaces.end(), holds) ||
         std::any_of(world.bars.begin(), world.bars.end(), holds);
}

std::string nearest_place(const World& world, const Contact& contact) {
  double least_m = std::numeric_limits<double>::infinity();
  std::string name, turned;
  const auto add = [&](const std::string& of, double away_m, double turned_rad) {
    if (away_m >= least_m) return;
    least_m = away_m;
    name = of;
    char text[64] = "";
    if (turned_rad > limits::kClosed_rad) {
      std::snprintf(text, sizeof text, ", its normal turned by %.3g rad", turned_rad);
    }
    turned = text;
  };
  for (const Surface& surface : world.surfaces) {
    const Eigen::Isometry3d& pose = surface.world_from_surface;
    const Eigen::Vector3d local = pose.inverse() * contact.position;
    add(surface.name, (nearest_point(surface, local) - local).norm(),
        angle_between(pose.linear().col(2), contact.normal));
  }
  for (const Bar& bar : world.bars) {
    const Eigen::Vector3d axis = bar.to - bar.from;
    const double share =
        std::clamp((contact.position - bar.from).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    const double off_axis_m = (contact.position - bar.from - share * axis).norm();
    add(bar.name, std::abs(off_axis_m - bar.radius_m), 0.0);
  }
  if (name.empty()) return "there is nothing to touch";
  char away[32];
  std::snprintf(away, sizeof away, "%.3g", least_m);
  return "the nearest, " + name + ", is " + away + " m away" + turned;
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
