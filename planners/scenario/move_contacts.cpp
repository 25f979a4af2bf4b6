#include <locograph/common/uniform.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/move_contacts.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// How far a contact reaches from its position along a direction of the world [m].
double reach_along(const Contact& contact, const Eigen::Vector3d& direction) {
  const EndEffector& effector = contact.effector;
  if (!contact_kind_entry(effector.kind).has_area()) return 0.0;
  if (!contact.forward) return area_reach_m(effector);  // in any yaw
  const Eigen::Matrix3d axes = axes_in_world(contact);
  return effector.half_x_m * std::abs(axes.col(0).dot(direction)) +
         effector.half_y_m * std::abs(axes.col(1).dot(direction));
}

/// Moves the contact along a line of length 2 half_m, from whose middle it is `at_m`.
void move_along(Contact& contact, const Eigen::Vector3d& direction, double at_m, double half_m,
                double most_m, std::mt19937_64& random) {
  const double free_m = std::max(0.0, half_m - reach_along(contact, direction));
  const double least = std::min(-free_m, at_m), most = std::max(free_m, at_m);
  contact.position +=
      uniform(random, std::max(least - at_m, -most_m), std::min(most - at_m, most_m)) * direction;
}

void move_on(const Surface& surface, Contact& contact, double most_m, std::mt19937_64& random) {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d local = pose.inverse() * contact.position;
  move_along(contact, pose.linear().col(0), local.x(), surface.half_x_m, most_m, random);
  move_along(contact, pose.linear().col(1), local.y(), surface.half_y_m, most_m, random);
}

void move_on(const Bar& bar, Contact& contact, double most_m, std::mt19937_64& random) {
  const Eigen::Vector3d way = bar.to - bar.from, direction = way.normalized();
  const double at_m = direction.dot(contact.position - 0.5 * (bar.from + bar.to));
  move_along(contact, direction, at_m, 0.5 * way.norm(), most_m, random);
}

/// Null: none.
const Surface* surface_under(const World& world, const Contact& contact) {
  const Surface* beside = nullptr;
  for (const Surface& surface : world.surfaces) {
    if (!lies_on(surface, contact)) continue;
    const Eigen::Vector3d local = surface.world_from_surface.inverse() * contact.position;
    if (std::abs(local.x()) <= surface.half_x_m && std::abs(local.y()) <= surface.half_y_m) {
      return &surface;
    }
    if (beside == nullptr) beside = &surface;
  }
  return beside;
}

}  // namespace

void move_contacts(Stance& stance, const World& world, double most_m, std::mt19937_64& random) {
  for (Contact& contact : stance.contacts) {
    if (const Surface* surface = surface_under(world, contact)) {
      move_on(*surface, contact, most_m, random);
      continue;
    }
    const auto bar = std::ranges::find_if(
        world.bars, [&](const Bar& candidate) { return lies_on(candidate, contact); });
    if (bar != world.bars.end()) move_on(*bar, contact, most_m, random);
  }
}

}  // namespace locograph
