#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/snap_to_places.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace locograph {
namespace {

/// A contact on a place, and how far it was moved there.
struct Snapped {
  Contact contact;
  double moved_m = 0.0;
};

bool all_digits(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_found_in(const std::string& place, std::span<const std::string> scanned_names) {
  return std::any_of(scanned_names.begin(), scanned_names.end(), [&](const std::string& name) {
    return (place.starts_with(name + " ") && all_digits(place.substr(name.size() + 1))) ||
           (place.starts_with(name + " bar ") && all_digits(place.substr(name.size() + 5)));
  });
}

void turn_to(const Eigen::Vector3d& normal, Contact& contact) {
  const Eigen::Vector3d from = contact.normal.stableNormalized();
  if (contact.forward) {
    contact.forward = Eigen::Quaterniond::FromTwoVectors(from, normal) * *contact.forward;
  }
  contact.normal = normal;
}

std::optional<Snapped> snapped(const Contact& contact, const Surface& surface) {
  if (!contact_kind_entry(contact.effector.kind).touches_surfaces) return std::nullopt;
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d normal = pose.linear().col(2);
  if (angle_between(normal, contact.normal) > kSnap_rad) return std::nullopt;
  Snapped result{contact};
  result.contact.position = pose * nearest_point(surface, pose.inverse() * contact.position);
  turn_to(normal, result.contact);
  return result;
}

/// The bar along the grasp, which holds it in either sense.
std::optional<Snapped> grasp(const Contact& contact, const Eigen::Vector3d& on_axis,
                             Eigen::Vector3d axis) {
  const Eigen::Matrix3d axes = axes_in_world(contact);
  const Eigen::Vector3d held = axes.col(1);
  if (held.dot(axis) < 0.0) axis = -axis;
  if (angle_between(held, axis) > kSnap_rad) return std::nullopt;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(held, axis);
  Snapped result{contact};
  result.contact.position = on_axis;
  result.contact.normal = turn * axes.col(2);
  result.contact.forward = turn * axes.col(0);
  return result;
}

std::optional<Snapped> snapped(const Contact& contact, const Bar& bar) {
  const BarTouch touch = contact_kind_entry(contact.effector.kind).bar_touch;
  if (touch == BarTouch::kNone) return std::nullopt;
  const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
  const double along =
      std::clamp(axis.dot(contact.position - bar.from), 0.0, (bar.to - bar.from).norm());
  const Eigen::Vector3d on_axis = bar.from + along * axis;
  if (touch == BarTouch::kGrasp) return grasp(contact, on_axis, axis);
  const Eigen::Vector3d radial = contact.normal.stableNormalized();
  if (std::abs(angle_between(axis, radial) - 0.5 * std::numbers::pi) > kSnap_rad) {
    return std::nullopt;
  }
  const Eigen::Vector3d normal = (radial - axis * axis.dot(radial)).normalized();
  Snapped result{contact};
  result.contact.position = on_axis + bar.radius_m * normal;
  turn_to(normal, result.contact);
  return result;
}

}  // namespace

std::vector<std::string> scanned_names(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const ScannedSurface& scanned : scenario.scanned) names.push_back(scanned.name);
  return names;
}

void snap_to_places(Stance& stance, const World& world,
                    std::span<const std::string> scanned_names) {
  for (Contact& contact : stance.contacts) {
    if (lies_on_something(world, contact)) continue;
    std::optional<Snapped> nearest;
    const auto consider = [&](const auto& place) {
      if (!is_found_in(place.name, scanned_names)) return;
      std::optional<Snapped> there = snapped(contact, place);
      if (!there) return;
      there->moved_m = (there->contact.position - contact.position).norm();
      if (there->moved_m > kSnap_m || (nearest && nearest->moved_m <= there->moved_m)) return;
      nearest = std::move(there);
    };
    for (const Surface& surface : world.surfaces) consider(surface);
    for (const Bar& bar : world.bars) consider(bar);
    if (nearest) contact = std::move(nearest->contact);
  }
}

}  // namespace locograph
