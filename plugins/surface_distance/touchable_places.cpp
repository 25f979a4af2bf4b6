#include <locograph/plugins/surface_distance/touchable_places.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

/// So deep below a plate a sphere is still above it; deeper, it is below.
constexpr double kPlateDepth_m = 0.15, kPlateDepthShare = 0.3;
constexpr double kEndless_m = std::numeric_limits<double>::infinity();

Eigen::AlignedBox3d bounds_of_bar(const Bar& bar) {
  Eigen::AlignedBox3d bounds = box_around(bar.from, bar.radius_m);
  return bounds.extend(box_around(bar.to, bar.radius_m));
}

}  // namespace

LinkShapes::LinkShapes(const Robot& robot, int link) {
  for (const CollisionShape& shape : robot.links()[static_cast<std::size_t>(link)].collision) {
    shapes.push_back(link_solid(robot, shape));
    link_from_shape.push_back(shape.link_from_shape);
  }
}

TouchablePlaces::TouchablePlaces(std::shared_ptr<const RobotParameter> robot, const World& world)
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
                       std::min(kPlateDepth_m, kPlateDepthShare * half), endless,
                       solids[s] < 0 ? -1 : first_solid_ + solids[s]});
  }
  std::vector<Eigen::AlignedBox3d> bounds = bounds_of(surfaces_);
  for (const Bar& bar : bars_) bounds.push_back(bounds_of_bar(bar));
  for (const SolidBox& solid : solids_) {
    boxes_.push_back({solid.world_from_box, 0.5 * solid.size_m, ConvexShape::box(solid.size_m)});
    bounds.push_back(bounds_of(solid));
  }
  tree_ = BoxTree(bounds);
}

TouchablePlaces::Distance TouchablePlaces::distance(int place, const Eigen::Vector3d& centre,
                                                    double radius) const {
  const std::size_t number = static_cast<std::size_t>(place);
  if (is_surface(place)) return to_plate(plates_[number], centre, radius);
  if (is_solid(place)) return to_box(box(place), centre, radius);
  return to_bar(bar(place), centre, radius);
}

bool TouchablePlaces::is_far(int place, const Eigen::Vector3d& centre, double radius,
                             double limit) const {
  const double middle = distance(place, centre, 0.0).value;
  // A plate is thin: from deep below it nothing reaches into it.
  const bool thin = is_surface(place) && !plates_[static_cast<std::size_t>(place)].endless;
  return (thin ? std::abs(middle) : middle) - radius >= limit;
}

TouchablePlaces::Distance TouchablePlaces::to_plate(const Plate& plate,
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

TouchablePlaces::Distance TouchablePlaces::to_box(const Box& box, const Eigen::Vector3d& centre,
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

TouchablePlaces::Distance TouchablePlaces::to_bar(const Bar& bar, const Eigen::Vector3d& centre,
                                                  double radius) const {
  const Eigen::Vector3d way = bar.to - bar.from;
  const double along = std::clamp((centre - bar.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  const Eigen::Vector3d off = centre - bar.from - along * way;
  return {off.norm() - bar.radius_m - radius, off.stableNormalized()};
}

bool TouchablePlaces::is_out(int place, const Eigen::Vector3d& centre, double reach_m) const {
  if (is_solid(place)) return to_box(box(place), centre, reach_m).value >= 0.0;
  const Plate& plate = plates_[static_cast<std::size_t>(place)];
  const Eigen::Vector3d local = plate.surface_from_world * centre;
  return std::max({local.z(), std::abs(local.x()) - plate.half_x_m,
                   std::abs(local.y()) - plate.half_y_m}) >= reach_m;
}

const LinkShapes& TouchablePlaces::shapes_of(int bound) const {
  LoadedShapes& loaded = shapes_[static_cast<std::size_t>(bound)];
  std::call_once(loaded.once, [&] {
    loaded.shapes.emplace(*robot_->robot, robot_->bounds[static_cast<std::size_t>(bound)].link);
  });
  return *loaded.shapes;
}

std::optional<TouchablePlaces::Depth> TouchablePlaces::depth(
    int place, int bound, const Eigen::Isometry3d& world_from_link, double limit) const {
  const RobotParameter::LinkBound& all = robot_->bounds[static_cast<std::size_t>(bound)];
  if (is_out(place, world_from_link * all.center, all.radius + limit)) return std::nullopt;
  const LinkShapes& link = shapes_of(bound);
  const Depth depth = is_solid(place) ? into_box(box(place), link, world_from_link, limit)
                                      : into_plate(place, link, world_from_link);
  if (!(depth.value < limit)) return std::nullopt;
  return depth;
}

/// Out by the normal, or by one of the four sides: below a plate is in it, for what touches it.
TouchablePlaces::Depth TouchablePlaces::into_plate(int place, const LinkShapes& link,
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

TouchablePlaces::Depth TouchablePlaces::into_box(const Box& box, const LinkShapes& link,
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

const std::string& TouchablePlaces::name(int place) const {
  const std::size_t number = static_cast<std::size_t>(place);
  if (is_surface(place)) return surfaces_[number].name;
  if (is_solid(place)) return solids_[number - static_cast<std::size_t>(first_solid_)].name;
  return bar(place).name;
}

}  // namespace locograph
