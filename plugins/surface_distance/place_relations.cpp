#include <locograph/plugins/surface_distance/place_relations.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/kinematic_tree.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace locograph {
namespace {

/// As the judge: links that touch may be in the surfaces under their contact's area and in the box
/// with such a face, but for its faces so far away, or further than a sole's corners. A contact
/// lies in the plane of a surface where it is no further off it than that.
constexpr double kTouchedReach_m = 0.3, kOnSurface_m = 1e-3, kFlush_m = 1e-4, kFlush_rad = 1e-3;
/// How deep links may be in what they touch in both stances: what the judge allows, less what rows
/// may be off; and how far above it those of a contact that opens or closes are to be, but for the
/// contact's own.
constexpr double kTouchedDepth_m = 0.011, kTouchedAbove_m = 1e-3;
/// Places are looked for so far beyond what was asked for, for the next time.
constexpr double kAhead_m = 0.5;

bool is_on_bar(const Bar& bar, const Contact& contact) {
  const Eigen::Vector3d along = (bar.to - bar.from).normalized();
  const Eigen::Vector3d off = contact.position - bar.from;
  return (off - along * along.dot(off)).norm() <= bar.radius_m + kOnSurface_m;
}

}  // namespace

bool is_near(const Contact& contact, const Eigen::Vector3d& point) {
  constexpr double kNear_m = 0.1, kBelow_m = 2e-3;
  const EndEffector& of = contact.effector;
  const double radius_m = contact_kind_entry(of.kind).is_round() ? of.radius_m : 0.0;
  const Eigen::Vector3d normal = contact.normal.stableNormalized();
  const Eigen::Vector3d off = point - contact.position - radius_m * normal;
  return off.norm() < kNear_m && off.dot(normal) > -kBelow_m;
}

void PlaceRelations::set_contacts(std::span<const Contact> closed, std::span<const Contact> held,
                                  std::span<const Contact> near, double near_m) {
  touches_.clear();
  related_ = false;
  for (const Contact& contact : closed) {
    const bool is_held =
        held.empty() || std::ranges::find(held, contact.name(), &Contact::name) != held.end();
    add_touch(contact, true, is_held, 0.0);
  }
  for (const Contact& contact : near) add_touch(contact, false, false, near_m);
}

void PlaceRelations::set_places_known(bool known) {
  places_known_ = known;
  related_ = false;
}

void PlaceRelations::add_touch(const Contact& contact, bool is_closed, bool is_held,
                               double above_m) {
  const RobotParameter& robot = *places_->robot();
  const Robot& model = *robot.robot;
  const std::vector<int>& body_of = model.tree().body_of_link;
  const std::size_t bounds = robot.bounds.size();
  const EndEffector& effector = contact.effector;
  const int link = model.link_index(effector.link);
  Touch touch{contact,
              contact.normal.normalized(),
              std::max(kTouchedReach_m, std::hypot(effector.half_x_m, effector.half_y_m)),
              link,
              is_held,
              is_closed,
              above_m,
              {},
              std::vector<bool>(bounds, false),
              std::vector<bool>(bounds, false)};
  const int body = body_of[static_cast<std::size_t>(link)];
  const std::vector<bool> links = touching_links(model, {&contact, 1});
  const bool turns_freely = contact_kind_entry(effector.kind).turns_freely;
  for (std::size_t b = 0; b < bounds; ++b) {
    const std::size_t touching = static_cast<std::size_t>(robot.bounds[b].link);
    if (!links[touching]) continue;
    touch.bounds.push_back(static_cast<int>(b));
    touch.fixed[b] = body_of[touching] == body;
    touch.closed[b] = is_closed && touch.fixed[b] && !turns_freely;
  }
  touches_.push_back(std::move(touch));
}

const std::vector<int>& PlaceRelations::near(const Eigen::AlignedBox3d& robot) {
  if (!searched_.contains(robot)) {
    const Eigen::Vector3d ahead = Eigen::Vector3d::Constant(kAhead_m);
    searched_ = {robot.min() - ahead, robot.max() + ahead};
    near_ = places_->tree().touching(searched_);
    related_ = false;
  }
  if (!related_) find_relations();
  return near_;
}

void PlaceRelations::relate_all() {
  near_.resize(static_cast<std::size_t>(places_->size()));
  std::iota(near_.begin(), near_.end(), 0);
  searched_.setEmpty();
  find_relations();
  for (const Touch& touch : touches_) {
    for (const int bound : touch.bounds) places_->shapes_of(bound);
  }
}

bool PlaceRelations::touches(std::size_t bound) const {
  return std::ranges::any_of(touches_, [bound](const Touch& touch) {
    return std::ranges::find(touch.bounds, static_cast<int>(bound)) != touch.bounds.end();
  });
}

void PlaceRelations::find_relations() {
  related_ = true;
  const std::size_t bounds = places_->robot()->bounds.size();
  relations_.assign(near_.size() * bounds, Relation::kApart);
  deepest_m_.assign(relations_.size(), kTouchedDepth_m);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    if (!places_->is_surface(near_[i]) || places_->solid_of(near_[i]) < 0) continue;
    std::fill_n(relations_.begin() + static_cast<std::ptrdiff_t>(i * bounds), bounds,
                Relation::kNone);
  }
  for (const Touch& touch : touches_) relate(touch);
  if (places_known_) return;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    if (!places_->is_surface(near_[i]) && !places_->is_solid(near_[i])) continue;
    for (const Touch& touch : touches_) {
      for (const int bound : touch.bounds) {
        const std::size_t at = i * bounds + static_cast<std::size_t>(bound);
        if (relations_[at] != Relation::kApart) continue;
        relations_[at] = Relation::kTouches;
        deepest_m_[at] = -kBesideAbove_m;
      }
    }
  }
}

void PlaceRelations::relate(const Touch& touch) {
  const std::vector<RobotParameter::LinkBound>& bounds = places_->robot()->bounds;
  const auto set = [&](std::size_t i, Relation relation) {
    const bool touched = relation == Relation::kTouches;
    for (const int b : touch.bounds) {
      const std::size_t bound = static_cast<std::size_t>(b);
      const std::size_t at = i * bounds.size() + bound;
      relations_[at] = touched && touch.closed[bound] ? Relation::kNone : relation;
      if (touch.held) continue;
      const bool own = touch.is_closed ? bounds[bound].link == touch.link : touch.fixed[bound];
      deepest_m_[at] = (own && touched ? 0.0 : -kTouchedAbove_m) - touch.above_m;
    }
  };
  std::vector<std::size_t> far_faces;
  // Beside the contact's area the judge allows as much as a contact may be off, which a link that
  // is fixed to the plane keeps.
  const auto set_flush = [&](std::size_t i) {
    for (const int b : touch.bounds) {
      const std::size_t bound = static_cast<std::size_t>(b);
      if (touch.closed[bound]) relations_[i * bounds.size() + bound] = Relation::kNone;
    }
  };
  std::vector<int> touched_solids, flush_solids;  // with a face in the plane
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const int place = near_[i];
    if (places_->is_surface(place)) {
      const Surface& surface = places_->surface(place);
      const int of = places_->solid_of(place);
      const bool flush = in_plane(surface, touch), touched = flush && is_under(surface, touch);
      if (of < 0 && touched) set(i, Relation::kTouches);
      if (of < 0 && flush && !touched) set_flush(i);
      if (of >= 0 && flush) (touched ? touched_solids : flush_solids).push_back(of);
      if (of >= 0 && !flush && !is_below(surface, touch)) far_faces.push_back(i);
    } else if (places_->is_solid(place)) {
      if (std::ranges::find(touched_solids, place) == touched_solids.end()) {
        if (std::ranges::find(flush_solids, place) != flush_solids.end()) set_flush(i);
        continue;
      }
      set(i, Relation::kTouches);
      for (const std::size_t face : far_faces) {
        if (places_->solid_of(near_[face]) == place) set(face, Relation::kApart);
      }
    } else if (touch.above_m == 0.0 && is_on_bar(places_->bar(place), touch.contact)) {
      set(i, Relation::kNone);
    }
  }
}

bool PlaceRelations::in_plane(const Surface& surface, const Touch& touch) const {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d own = pose.linear().col(2);
  return angle_between(own, touch.normal) <= kFlush_rad &&
         std::abs(own.dot(touch.contact.position - pose.translation())) <= kFlush_m;
}

/// Two rectangles in a plane overlap unless one of their four directions separates them.
bool PlaceRelations::is_under(const Surface& surface, const Touch& touch) const {
  const EndEffector& effector = touch.contact.effector;
  const Eigen::Isometry3d surface_from_world = surface.world_from_surface.inverse();
  const Eigen::Vector3d at = surface_from_world * touch.contact.position;
  const double x_m = surface.half_x_m + kFlush_m, y_m = surface.half_y_m + kFlush_m;
  const bool has_area = contact_kind_entry(effector.kind).has_area();
  if (!has_area || !touch.contact.forward) {
    const double sole = has_area ? std::min(effector.half_x_m, effector.half_y_m) : kFlush_m;
    return std::abs(at.x()) <= x_m + sole && std::abs(at.y()) <= y_m + sole;
  }
  const Eigen::Matrix3d axes = surface_from_world.linear() * axes_in_world(touch.contact);
  const Eigen::Vector3d along = axes.col(0) * effector.half_x_m,
                        across = axes.col(1) * effector.half_y_m;
  const auto apart_along = [&](const Eigen::Vector3d& axis, double sole) {
    return std::abs(axis.dot(at)) > sole + x_m * std::abs(axis.x()) + y_m * std::abs(axis.y());
  };
  return std::abs(at.x()) <= x_m + std::abs(along.x()) + std::abs(across.x()) &&
         std::abs(at.y()) <= y_m + std::abs(along.y()) + std::abs(across.y()) &&
         !apart_along(axes.col(0), effector.half_x_m) &&
         !apart_along(axes.col(1), effector.half_y_m);
}

bool PlaceRelations::is_below(const Surface& surface, const Touch& touch) const {
  if (std::isinf(surface.half_x_m) || std::isinf(surface.half_y_m)) return false;
  for (const double x : {surface.half_x_m, -surface.half_x_m}) {
    for (const double y : {surface.half_y_m, -surface.half_y_m}) {
      const Eigen::Vector3d corner = surface.world_from_surface * Eigen::Vector3d(x, y, 0.0);
      if (touch.normal.dot(corner - touch.contact.position) > kOnSurface_m) return false;
    }
  }
  const Eigen::Vector3d local = surface.world_from_surface.inverse() * touch.contact.position;
  return std::abs(local.x()) - surface.half_x_m <= touch.reach_m &&
         std::abs(local.y()) - surface.half_y_m <= touch.reach_m &&
         std::abs(local.z()) <= touch.reach_m;
}

}  // namespace locograph
