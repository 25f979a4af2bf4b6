#pragma once
/// Surfaces, bars and boxes of a world as the solids that collision_world.cpp measures.
///
///     const PlateSolid plate(world.surfaces[0]);
///     const BarSolid rod(world.bars[0]);
///     const BoxSolid block(world.solids[0]);
///
/// They throw Error for sizes that are not positive, and for what is not finite.

#include <locograph/common/error.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

/// Of a solid, in which out . x <= offset.
struct SolidSide {
  Eigen::Vector3d out;  ///< of length 1
  double offset;
};

/// A surface as a solid: everything below it, or a plate just below it.
struct PlateSolid {
  std::string name;
  Eigen::Vector3d point, normal;
  bool endless = false;
  std::optional<ConvexShape> shape;
  Eigen::Isometry3d world_from_shape = Eigen::Isometry3d::Identity();
  std::vector<SolidSide> sides;  ///< four; none of what is endless
  int block = -1;                ///< the box whose face it is

  static constexpr double kThickness_m = 2e-4;
  /// Half of a side without an end of a surface that ends elsewhere.
  static constexpr double kEndless_m = 1000.0;

  explicit PlateSolid(const Surface& surface)
      : name(surface.name.empty() ? "surface" : surface.name),
        point(surface.world_from_surface.translation()),
        normal(surface.world_from_surface.linear().col(2)),
        endless(std::isinf(surface.half_x_m) && std::isinf(surface.half_y_m)) {
    const double half[] = {std::min(surface.half_x_m, kEndless_m),
                           std::min(surface.half_y_m, kEndless_m)};
    if (!surface.world_from_surface.matrix().allFinite() || !(half[0] > 0.0) || !(half[1] > 0.0))
      throw Error("surface " + name + " has a size that is not positive or a pose that is none",
                  "finite numbers");
    if (endless) return;
    shape = ConvexShape::box({2.0 * half[0], 2.0 * half[1], kThickness_m});
    world_from_shape =
        surface.world_from_surface * Eigen::Translation3d(0.0, 0.0, -0.5 * kThickness_m);
    for (int axis = 0; axis < 2; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector3d out = sign * surface.world_from_surface.linear().col(axis);
        sides.push_back({out, out.dot(point) + half[axis]});
      }
    }
  }
};

/// A bar as a solid.
struct BarSolid {
  std::string name;
  Eigen::Vector3d from, axis;  // axis: of length 1
  double length_m;
  ConvexShape shape;
  Eigen::Isometry3d world_from_shape;

  explicit BarSolid(const Bar& bar)
      : name(bar.name.empty() ? "bar" : bar.name),
        from(bar.from),
        axis(bar.to - bar.from),
        length_m(axis.norm()),
        shape(solid(name, bar.radius_m, length_m)),
        world_from_shape(Eigen::Translation3d(0.5 * (bar.from + bar.to))) {
    axis /= length_m;
    world_from_shape.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
  }

  static ConvexShape solid(const std::string& name, double radius_m, double length_m) {
    const auto is_size = [](double size) { return size > 0.0 && std::isfinite(size); };
    if (!is_size(radius_m) || !is_size(length_m))
      throw Error("bar " + name + " has a length or a radius that is not positive",
                  "finite numbers");
    return ConvexShape::cylinder(radius_m, length_m);
  }

  double distance_from_axis(const Eigen::Vector3d& point) const {
    const double along = std::clamp(axis.dot(point - from), 0.0, length_m);
    return (point - from - along * axis).norm();
  }
};

/// A box through and through.
struct BoxSolid {
  std::string name;
  ConvexShape shape;
  Eigen::Isometry3d world_from_shape;
  std::array<SolidSide, 6> sides;

  explicit BoxSolid(const SolidBox& box)
      : name(box.name.empty() ? "box" : box.name),
        shape(ConvexShape::box(box.size_m)),
        world_from_shape(box.world_from_box) {
    if (!world_from_shape.matrix().allFinite())
      throw Error("box " + name + " has a pose that is none", "finite numbers");
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Eigen::Index axis = static_cast<Eigen::Index>(i / 2);
      const Eigen::Vector3d out = (i % 2 == 0 ? 1.0 : -1.0) * world_from_shape.linear().col(axis);
      sides[i] = {out, out.dot(world_from_shape.translation()) + 0.5 * box.size_m[axis]};
    }
  }

  /// At most the signed distance of the point; inside, that.
  double at_least(const Eigen::Vector3d& point) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const SolidSide& side : sides) most = std::max(most, side.out.dot(point) - side.offset);
    return most;
  }
};

/// How far a shape reaches along a direction: the least n . x, and where.
inline double least_along(const ConvexShape& shape, const Eigen::Isometry3d& world_from_shape,
                          const Eigen::Vector3d& n, Eigen::Vector3d& where) {
  where = world_from_shape * shape.support(-(world_from_shape.linear().transpose() * n));
  return n.dot(where);
}

}  // namespace locograph
