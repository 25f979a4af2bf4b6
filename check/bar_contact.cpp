#include <locograph/check/bar_contact.h>
#include <locograph/check/limits.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace locograph {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

using Segment = std::array<Eigen::Vector2d, 2>;

/// The part of a segment in the rectangle |x|, |y| <= half. Liang and Barsky, A new concept and
/// method for line clipping, 1984.
std::optional<Segment> part_inside(const Segment& segment, const Eigen::Vector2d& half) {
  const Eigen::Vector2d way = segment[1] - segment[0];
  double from = 0.0, to = 1.0;
  for (const int axis : {0, 1}) {
    for (const double side : {1.0, -1.0}) {
      const double rate = side * way[axis], room = half[axis] - side * segment[0][axis];
      if (rate > 0.0) to = std::min(to, room / rate);
      if (rate < 0.0) from = std::max(from, room / rate);
      if (rate == 0.0 && room < 0.0) return std::nullopt;
    }
  }
  if (from > to) return std::nullopt;
  return Segment{segment[0] + from * way, segment[0] + to * way};
}

/// Of a segment and a rectangle that do not meet: the nearest points are an end or a corner.
double distance(const Segment& segment, const Eigen::Vector2d& half) {
  double least = kNowhere;
  for (const Eigen::Vector2d& end : segment)
    least = std::min(least, (end.cwiseAbs() - half).cwiseMax(0.0).norm());
  const Eigen::Vector2d way = segment[1] - segment[0];
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      const Eigen::Vector2d corner(x * half.x(), y * half.y());
      const double along = way.dot(corner - segment[0]) / std::max(way.squaredNorm(), 1e-300);
      const Eigen::Vector2d nearest = segment[0] + std::clamp(along, 0.0, 1.0) * way;
      least = std::min(least, (corner - nearest).norm());
    }
  }
  return least;
}

Eigen::Vector3d axis_of(const Bar& bar) { return (bar.to - bar.from).normalized(); }

}  // namespace

double off_bar_m(const Contact& contact, const Bar& bar) {
  const EndEffector& effector = contact.effector;
  const Eigen::Vector3d axis = axis_of(bar), normal = contact.normal.stableNormalized();
  const Eigen::Vector3d from_bar = contact.position - bar.from;
  const Eigen::Vector3d from_axis = from_bar - axis * axis.dot(from_bar);
  switch (effector.kind) {
    case ContactKind::kPoint:
      if (angle_between(from_axis, normal) > limits::kClosed_rad) return kNowhere;
      return std::abs(from_axis.norm() - bar.radius_m);
    case ContactKind::kSurface: {
      const double slope = std::abs(angle_between(axis, normal) - 0.5 * std::numbers::pi);
      if (slope > limits::kClosed_rad) return kNowhere;
      const double height = normal.dot(from_axis) - bar.radius_m;
      const double aside = std::abs(normal.cross(axis).dot(from_axis)) -
                           std::hypot(effector.half_x_m, effector.half_y_m);
      return std::hypot(height, std::max(0.0, aside));
    }
    case ContactKind::kGrasp: {
      const Eigen::Vector3d held = normal.cross(contact.forward->stableNormalized());
      const double turned = angle_between(held, axis);
      if (std::min(turned, std::numbers::pi - turned) > limits::kClosed_rad) return kNowhere;
      return from_axis.norm();
    }
    case ContactKind::kWheel:
      break;
  }
  return kNowhere;
}

double beyond_ends_m(const Bar& bar, const Eigen::Vector3d& point) {
  const double along = axis_of(bar).dot(point - bar.from);
  return std::max({0.0, -along, along - (bar.to - bar.from).norm()});
}

SoleOnBar sole_on_bar(const Bar& bar, const Contact& contact,
                      const Eigen::Isometry3d& world_from_link) {
  const EndEffector& sole = contact.effector;
  const Eigen::Matrix3d axes = world_from_link.linear() * axes_in_link(sole);
  const Eigen::Vector3d centre = world_from_link * sole.point;
  const Eigen::Vector3d out = bar.radius_m * contact.normal.stableNormalized();
  const auto in_sole = [&](const Eigen::Vector3d& point) -> Eigen::Vector2d {
    return axes.leftCols<2>().transpose() * (point + out - centre);
  };
  const Segment touching = {in_sole(bar.from), in_sole(bar.to)};
  const Eigen::Vector2d half(sole.half_x_m, sole.half_y_m);
  constexpr double kNoLine_m = 1e-4;
  const std::optional<Segment> line = part_inside(touching, half);
  if (line && ((*line)[1] - (*line)[0]).norm() > kNoLine_m)
    return {0.0, {line->begin(), line->end()}};
  return {std::max(line ? 0.0 : distance(touching, half), limits::kHeld_m), {}};
}

}  // namespace locograph
