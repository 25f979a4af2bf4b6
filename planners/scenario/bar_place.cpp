#include <locograph/check/limits.h>
#include <locograph/planners/scenario/bar_place.h>
#include <locograph/robots/contact_kinds.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();
/// A shorter line bears nothing.
constexpr double kNoLine_m = 1e-4;

/// The ends of a bar's axis as seen from a point.
struct SeenBar {
  SeenBar(const Bar& bar, const Eigen::Vector3d& point)
      : from(bar.from - point), to(bar.to - point), length_m((bar.to - bar.from).norm()) {}

  /// From the end `from` to where the point is nearest, by the law of cosines.
  double along_m() const {
    return 0.5 * length_m + (from.squaredNorm() - to.squaredNorm()) / (2.0 * length_m);
  }
  Eigen::Vector3d nearest() const { return from + along_m() / length_m * (to - from); }
  /// Of the axis without ends: the height of the triangle of the point and the ends.
  double distance_m() const { return from.cross(to).norm() / length_m; }

  Eigen::Vector3d from, to;
  double length_m;
};

double gap_of_point(const SeenBar& seen, double radius_m, const Eigen::Vector3d& normal) {
  const double distance_m = seen.distance_m();
  const Eigen::Vector3d out = -seen.nearest() / distance_m;
  // The chord of an angle; not a number where the point is on the axis.
  if (!((out - normal).norm() <= 2.0 * std::sin(0.5 * limits::kClosed_rad))) return kNowhere;
  return std::abs(distance_m - radius_m);
}

double gap_of_sole(const SeenBar& seen, double radius_m, const Eigen::Vector3d& normal,
                   const EndEffector& sole) {
  // How deep the ends are below the sole's plane.
  const double from_m = -normal.dot(seen.from), to_m = -normal.dot(seen.to);
  if (std::abs(to_m - from_m) > std::sin(limits::kClosed_rad) * seen.length_m) return kNowhere;
  const double share = seen.along_m() / seen.length_m;
  const double depth_m = (1.0 - share) * from_m + share * to_m;
  const Eigen::Vector3d from = seen.from + from_m * normal, to = seen.to + to_m * normal;
  const double aside_m = from.cross(to).norm() / (to - from).norm();
  const double reach_m = std::hypot(sole.half_x_m, sole.half_y_m);
  return std::hypot(depth_m - radius_m, std::max(0.0, aside_m - reach_m));
}

double gap_of_grasp(const SeenBar& seen, const Eigen::Vector3d& held) {
  const double across = held.cross(seen.to - seen.from).norm();
  if (across > std::sin(limits::kClosed_rad) * held.norm() * seen.length_m) return kNowhere;
  return seen.distance_m();
}

}  // namespace

double gap_to_bar_m(const Bar& bar, const Contact& contact) {
  const SeenBar seen(bar, contact.position);
  const Eigen::Vector3d normal = contact.normal.stableNormalized();
  switch (contact_kind_entry(contact.effector.kind).bar_touch) {
    case BarTouch::kPoint:
      return gap_of_point(seen, bar.radius_m, normal);
    case BarTouch::kArea:
      return gap_of_sole(seen, bar.radius_m, normal, contact.effector);
    case BarTouch::kGrasp:
      return gap_of_grasp(seen, normal.cross(contact.forward->stableNormalized()));
    case BarTouch::kNone:
      break;
  }
  return kNowhere;
}

double past_ends_m(const Bar& bar, const Eigen::Vector3d& point) {
  const SeenBar seen(bar, point);
  return std::max(0.0, std::abs(seen.along_m() - 0.5 * seen.length_m) - 0.5 * seen.length_m);
}

std::vector<Eigen::Vector2d> line_on_bar(const Bar& bar, const Contact& contact) {
  const SeenBar seen(bar, contact.position);
  const Eigen::Matrix3d axes = axes_in_world(contact);
  const Eigen::Vector2d from = axes.leftCols<2>().transpose() * seen.from;
  const Eigen::Vector2d to = axes.leftCols<2>().transpose() * seen.to;
  const double length_m = (to - from).norm();
  const Eigen::Vector2d way = (to - from) / length_m;
  // Across the line, away from the sole's middle.
  Eigen::Vector2d across(-way.y(), way.x());
  double middle_m = across.dot(from);
  if (middle_m < 0.0) {
    across = -across;
    middle_m = -middle_m;
  }
  // The line cuts the border where one corner of a side is beyond it and the other one is not.
  const double x = contact.effector.half_x_m, y = contact.effector.half_y_m;
  const std::array<Eigen::Vector2d, 4> corners = {{Eigen::Vector2d(x, y), Eigen::Vector2d(-x, y),
                                                   Eigen::Vector2d(-x, -y),
                                                   Eigen::Vector2d(x, -y)}};
  double first_m = kNowhere, last_m = -kNowhere;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double a_m = across.dot(a) - middle_m, b_m = across.dot(b) - middle_m;
    if ((a_m >= 0.0) == (b_m >= 0.0)) continue;
    const double at_m = way.dot((b_m * a - a_m * b) / (b_m - a_m) - from);
    first_m = std::min(first_m, at_m);
    last_m = std::max(last_m, at_m);
  }
  first_m = std::max(first_m, 0.0);
  last_m = std::min(last_m, length_m);
  if (!(last_m - first_m > kNoLine_m)) return {};
  return {from + first_m * way, from + last_m * way};
}

}  // namespace locograph
