#include <locograph/check/limits.h>
#include <locograph/planners/offline/stance/transition_places.h>
#include <locograph/robots/contact_kinds/contact_kind_entry.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

/// As the judge: links that touch may be in the surfaces under their contact's area and in the box
/// with such a face, but for its faces so far away, or further than a sole's corners.
constexpr double kTouchedReach_m = 0.3, kOnSurface_m = 1e-3;
/// So deep below a plate a sphere is still above it; deeper, it is below.
constexpr double kPlateDepth_m = 0.15, kPlateDepthShare = 0.3;
/// How deep links may be in what they touch in both stances: what the judge allows, less what rows
/// may be off; and how far above it those of a contact that opens or closes are to be, but for the
/// contact's own.
constexpr double kTouchedDepth_m = 0.011, kTouchedAbove_m = 1e-3;
/// Places are looked for so far beyond what was asked for, for the next time.
constexpr double kAhead_m = 0.5;
constexpr double kEndless_m = std::numeric_limits<double>::infinity();

Eigen::AlignedBox3d bounds_of_bar(const Bar& bar) {
  Eigen::AlignedBox3d bounds = box_around(bar.from, bar.radius_m);
  return bounds.extend(box_around(bar.to, bar.radius_m));
}

bool is_on_bar(const Bar& bar, const Contact& contact) {
  const Eigen::Vector3d along = (bar.to - bar.from).normalized();
  const Eigen::Vector3d off = contact.position - bar.from;
  return (off - along * along.dot(off)).norm() <= bar.radius_m + kOnSurface_m;
}

}  // namespace

LinkShapes::LinkShapes(const Robot& robot, int link) {
  for (const CollisionShape& shape : robot.links()[static_cast<std::size_t>(link)].collision) {
    shapes.push_back(link_solid(robot, shape));
    link_from_shape.push_back(shape.link_from_shape);
  }
}

TransitionPlaces::TransitionPlaces(std::shared_ptr<const RobotParameter> robot, const World& world)
    : robot_(std::move(robot)),
      surfaces_(world.surfaces),
      bars_(world.bars),
      solids_(world.solids),
      first_solid_(static_cast<int>(surfaces_.size() + bars_.size())),
      shapes_(robot_->bounds.size()) {
  const std::vector<int> solids = solids_of_surfaces(world);
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const Surface& surface = surfaces_[s];
    const bool endless = std::isinf(surface.half_x_m) && std::isinf(surface.half_y_m);
    const double half = std::min(surface.half_x_m, surface.half_y_m);
    plates_.push_back({surface.world_from_surface.inverse(), surface.half_x_m, surface.half_y_m,
                       std::min(kPlateDepth_m, kPlateDepthShare * half), endless, solids[s]});
  }
  std::vector<Eigen::AlignedBox3d> bounds = bounds_of(surfaces_);
  for (const Bar& bar : bars_) bounds.push_back(bounds_of_bar(bar));
  for (const SolidBox& solid : solids_) {
    boxes_.push_back({solid.world_from_box, 0.5 * solid.size_m, ConvexShape::box(solid.size_m)});
    bounds.push_back(bounds_of(solid));
  }
  tree_ = BoxTree(bounds);
}

void TransitionPlaces::set_contacts(std::span<const Contact> closed, std::span<const Contact> held,
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

void TransitionPlaces::add_touch(const Contact& contact, bool is_closed, bool is_held,
                                 double above_m) {
  const Robot& model = *robot_->robot;
  const std::vector<int>& body_of = model.tree().body_of_link;
  const std::size_t bounds = robot_->bounds.size();
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
    const std::size_t touching = static_cast<std::size_t>(robot_->bounds[b].link);
    if (!links[touching]) continue;
    touch.bounds.push_back(static_cast<int>(b));
    touch.fixed[b] = body_of[touching] == body;
    touch.closed[b] = is_closed && touch.fixed[b] && !turns_freely;
  }
  touches_.push_back(std::move(touch));
}

const std::vector<int>& TransitionPlaces::near(const Eigen::AlignedBox3d& robot) {
  if (!searched_.contains(robot)) {
    const Eigen::Vector3d ahead = Eigen::Vector3d::Constant(kAhead_m);
    searched_ = {robot.min() - ahead, robot.max() + ahead};
    near_ = tree_.touching(searched_);
    related_ = false;
  }
  if (!related_) find_relations();
  return near_;
}

void TransitionPlaces::find_relations() {
  related_ = true;
  const std::size_t bounds = robot_->bounds.size();
  relations_.assign(near_.size() * bounds, Relation::kApart);
  deepest_m_.assign(relations_.size(), kTouchedDepth_m);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    if (!is_surface(near_[i]) || plates_[static_cast<std::size_t>(near_[i])].box < 0) continue;
    std::fill_n(relations_.begin() + static_cast<std::ptrdiff_t>(i * bounds), bounds,
                Relation::kNone);
  }
  for (const Touch& touch : touches_) relate(touch);
}

void TransitionPlaces::relate(const Touch& touch) {
  const auto set = [&](std::size_t i, Relation relation) {
    const bool touched = relation == Relation::kTouches;
    for (const int b : touch.bounds) {
      const std::size_t bound = static_cast<std::size_t>(b);
      const std::size_t at = i * robot_->bounds.size() + bound;
      relations_[at] = touched && touch.closed[bound] ? Relation::kNone : relation;
      if (touch.held) continue;
      const bool own =
          touch.is_closed ? robot_->bounds[bound].link == touch.link : touch.fixed[bound];
      deepest_m_[at] = (own && touched ? 0.0 : -kTouchedAbove_m) - touch.above_m;
    }
  };
  std::vector<std::size_t> far_faces;
  // Beside the contact's area the judge allows as much as a contact may be off, which a link that
  // is fixed to the plane keeps.
  const auto set_flush = [&](std::size_t i) {
    for (const int b : touch.bounds) {
      const std::size_t bound = static_cast<std::size_t>(b);
      if (touch.closed[bound]) relations_[i * robot_->bounds.size() + bound] = Relation::kNone;
    }
  };
  std::vector<int> touched_boxes, flush_boxes;  // with a face in the plane
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const int place = near_[i];
    if (is_surface(place)) {
      const Surface& surface = surfaces_[static_cast<std::size_t>(place)];
      const int of = plates_[static_cast<std::size_t>(place)].box;
      const bool flush = in_plane(surface, touch), touched = flush && is_under(surface, touch);
      if (of < 0 && touched) set(i, Relation::kTouches);
      if (of < 0 && flush && !touched) set_flush(i);
      if (of >= 0 && flush) (touched ? touched_boxes : flush_boxes).push_back(of);
      if (of >= 0 && !flush && !is_below(surface, touch)) far_faces.push_back(i);
    } else if (is_solid(place)) {
      const int number = place - first_solid_;
      if (std::ranges::find(touched_boxes, number) == touched_boxes.end()) {
        if (std::ranges::find(flush_boxes, number) != flush_boxes.end()) set_flush(i);
        continue;
      }
      set(i, Relation::kTouches);
      for (const std::size_t face : far_faces) {
        if (plates_[static_cast<std::size_t>(near_[face])].box == number) {
          set(face, Relation::kApart);
        }
      }
    } else if (touch.above_m == 0.0 &&
               is_on_bar(bars_[static_cast<std::size_t>(place) - plates_.size()], touch.contact)) {
      set(i, Relation::kNone);
    }
  }
}

bool TransitionPlaces::in_plane(const Surface& surface, const Touch& touch) const {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d own = pose.linear().col(2);
  return angle_between(own, touch.normal) <= limits::kClosed_rad &&
         std::abs(own.dot(touch.contact.position - pose.translation())) <= limits::kClosed_m;
}

/// Two rectangles in a plane overlap unless one of their four directions separates them.
bool TransitionPlaces::is_under(const Surface& surface, const Touch& touch) const {
  const EndEffector& effector = touch.contact.effector;
  const Eigen::Isometry3d surface_from_world = surface.world_from_surface.inverse();
  const Eigen::Vector3d at = surface_from_world * touch.contact.position;
  const double x_m = surface.half_x_m + limits::kClosed_m,
               y_m = surface.half_y_m + limits::kClosed_m;
  const bool has_area = contact_kind_entry(effector.kind).has_area();
  if (!has_area || !touch.contact.forward) {
    const double sole =
        has_area ? std::min(effector.half_x_m, effector.half_y_m) : limits::kClosed_m;
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

bool TransitionPlaces::is_below(const Surface& surface, const Touch& touch) const {
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

TransitionPlaces::Distance TransitionPlaces::distance(int place, const Eigen::Vector3d& centre,
                                                      double radius) const {
  const std::size_t number = static_cast<std::size_t>(place);
  if (is_surface(place)) return to_plate(plates_[number], centre, radius);
  if (is_solid(place)) return to_box(box(place), centre, radius);
  return to_bar(bars_[number - plates_.size()], centre, radius);
}

bool TransitionPlaces::is_far(int place, const Eigen::Vector3d& centre, double radius,
                              double limit) const {
  const double middle = distance(place, centre, 0.0).value;
  // A plate is thin: from deep below it nothing reaches into it.
  const bool thin = is_surface(place) && !plates_[static_cast<std::size_t>(place)].endless;
  return (thin ? std::abs(middle) : middle) - radius >= limit;
}

TransitionPlaces::Distance TransitionPlaces::to_plate(const Plate& plate,
                                                      const Eigen::Vector3d& centre,
                                                      double radius) const {
  const Eigen::Vector3d local = plate.surface_from_world * centre;
  const auto in_world = [&](const Eigen::Vector3d& way) -> Eigen::Vector3d {
    return plate.surface_from_world.linear().transpose() * way;
  };
  if (plate.endless) return {local.z() - radius, in_world(Eigen::Vector3d::UnitZ())};
  const auto beyond = [](double x, double half) {
    return x > half ? x - half : (x < -half ? x + half : 0.0);
  };
  const Eigen::Vector3d way(beyond(local.x(), plate.half_x_m), beyond(local.y(), plate.half_y_m),
                            local.z());
  if (way.x() == 0.0 && way.y() == 0.0) {
    const double side = local.z() >= -plate.depth_m ? 1.0 : -1.0;
    return {side * local.z() - radius, in_world(side * Eigen::Vector3d::UnitZ())};
  }
  const double length = way.norm();
  return {length - radius, in_world(way / length)};
}

TransitionPlaces::Distance TransitionPlaces::to_box(const Box& box, const Eigen::Vector3d& centre,
                                                    double radius) const {
  const Eigen::Vector3d local = box.world_from_box.inverse() * centre;
  const Eigen::Vector3d beyond = local.cwiseAbs() - box.half_m;
  Eigen::Vector3d way = beyond.cwiseMax(0.0);
  double length = way.norm();
  if (!(length > 0.0)) {
    Eigen::Index axis = 0;
    length = beyond.maxCoeff(&axis);
    way = Eigen::Vector3d::Unit(axis);
  }
  for (int axis = 0; axis < 3; ++axis) way[axis] = std::copysign(way[axis], local[axis]);
  return {length - radius, box.world_from_box.linear() * way.normalized()};
}

TransitionPlaces::Distance TransitionPlaces::to_bar(const Bar& bar, const Eigen::Vector3d& centre,
                                                    double radius) const {
  const Eigen::Vector3d way = bar.to - bar.from;
  const double along = std::clamp((centre - bar.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  const Eigen::Vector3d off = centre - bar.from - along * way;
  return {off.norm() - bar.radius_m - radius, off.stableNormalized()};
}

bool TransitionPlaces::is_out(int place, const Eigen::Vector3d& centre, double reach_m) const {
  if (is_solid(place)) return to_box(box(place), centre, reach_m).value >= 0.0;
  const Plate& plate = plates_[static_cast<std::size_t>(place)];
  const Eigen::Vector3d local = plate.surface_from_world * centre;
  return std::max({local.z(), std::abs(local.x()) - plate.half_x_m,
                   std::abs(local.y()) - plate.half_y_m}) >= reach_m;
}

const LinkShapes& TransitionPlaces::shapes_of(int bound) {
  std::optional<LinkShapes>& shapes = shapes_[static_cast<std::size_t>(bound)];
  if (!shapes) {
    shapes.emplace(*robot_->robot, robot_->bounds[static_cast<std::size_t>(bound)].link);
  }
  return *shapes;
}

std::optional<TransitionPlaces::Depth> TransitionPlaces::depth(
    int place, int bound, const Eigen::Isometry3d& world_from_link, double limit) {
  const RobotParameter::LinkBound& all = robot_->bounds[static_cast<std::size_t>(bound)];
  if (is_out(place, world_from_link * all.center, all.radius + limit)) return std::nullopt;
  const LinkShapes& link = shapes_of(bound);
  const Depth depth = is_solid(place) ? into_box(box(place), link, world_from_link, limit)
                                      : into_plate(place, link, world_from_link);
  if (!(depth.value < limit)) return std::nullopt;
  return depth;
}

/// Out by the normal, or by one of the four sides: below a plate is in it, for what touches it.
TransitionPlaces::Depth TransitionPlaces::into_plate(int place, const LinkShapes& link,
                                                     const Eigen::Isometry3d& pose) const {
  const Surface& surface = surfaces_[static_cast<std::size_t>(place)];
  const Eigen::Matrix3d axes = surface.world_from_surface.linear();
  const std::array<double, 5> beyond = {0.0, surface.half_x_m, surface.half_x_m, surface.half_y_m,
                                        surface.half_y_m};
  const std::array<Eigen::Vector3d, 5> outs = {axes.col(2), axes.col(0), -axes.col(0), axes.col(1),
                                               -axes.col(1)};
  Depth most{-kEndless_m, Eigen::Vector3d::Zero(), axes.col(2)};
  for (std::size_t side = 0; side < outs.size(); ++side) {
    if (std::isinf(beyond[side])) continue;
    const Eigen::Vector3d& out = outs[side];
    const double offset = out.dot(surface.world_from_surface.translation()) + beyond[side];
    Depth least{kEndless_m, Eigen::Vector3d::Zero(), out};
    for (std::size_t i = 0; i < link.shapes.size(); ++i) {
      const Eigen::Isometry3d world_from_shape = pose * link.link_from_shape[i];
      const Eigen::Vector3d point =
          world_from_shape * link.shapes[i].support(-(world_from_shape.linear().transpose() * out));
      const double value = out.dot(point) - offset;
      if (value < least.value) least = {value, point, out};
    }
    if (least.value > most.value) most = least;
  }
  return most;
}

TransitionPlaces::Depth TransitionPlaces::into_box(const Box& box, const LinkShapes& link,
                                                   const Eigen::Isometry3d& pose,
                                                   double limit) const {
  Depth least{limit, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  for (std::size_t i = 0; i < link.shapes.size(); ++i) {
    const ConvexShape& shape = link.shapes[i];
    const Eigen::Isometry3d world_from_shape = pose * link.link_from_shape[i];
    const Distance middle = to_box(box, world_from_shape * shape.center(), shape.bounding_radius());
    if (middle.value >= least.value) continue;
    const ShapeDistance found =
        shape_distance(shape, world_from_shape, box.shape, box.world_from_box);
    if (found.distance >= least.value) continue;
    Eigen::Vector3d out = found.on_first - found.on_second;
    if (found.distance < 0.0) out = -out;
    const bool has_way = out.norm() > 1e-9;
    least = {found.distance, found.on_first,
             has_way ? Eigen::Vector3d(out.normalized()) : middle.gradient};
  }
  return least;
}

const std::string& TransitionPlaces::name(int place) const {
  const std::size_t number = static_cast<std::size_t>(place);
  if (is_surface(place)) return surfaces_[number].name;
  if (is_solid(place)) return solids_[number - static_cast<std::size_t>(first_solid_)].name;
  return bars_[number - plates_.size()].name;
}

}  // namespace locograph
