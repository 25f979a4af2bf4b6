#include <locograph/robots/triangle_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace locograph {
namespace {

constexpr int kMostInLeaf = 4;
constexpr int kDeepest = 64;  // median splits halve the number of triangles

double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).squaredNorm();
}

/// The plane's distance above the triangle, else that of its nearest side.
double squared_distance(const Eigen::Vector3d& p, const Eigen::Vector3d* c) {
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double squared = normal.squaredNorm();
  if (squared > 0.0 && (c[1] - c[0]).cross(p - c[0]).dot(normal) >= 0.0 &&
      (c[2] - c[1]).cross(p - c[1]).dot(normal) >= 0.0 &&
      (c[0] - c[2]).cross(p - c[2]).dot(normal) >= 0.0) {
    const double height = (p - c[0]).dot(normal);
    return height * height / squared;
  }
  return std::min({squared_distance_to_segment(p, c[0], c[1]),
                   squared_distance_to_segment(p, c[1], c[2]),
                   squared_distance_to_segment(p, c[2], c[0])});
}

/// A. Van Oosterom and J. Strackee, "The solid angle of a plane triangle", 1983.
double solid_angle(const Eigen::Vector3d& p, const Eigen::Vector3d* corners) {
  const Eigen::Vector3d a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// T. Möller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997; `most` where
/// the ray passes by or meets it later.
double ray_hits_triangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         const Eigen::Vector3d* c, double most) {
  const Eigen::Vector3d first = c[1] - c[0], second = c[2] - c[0];
  const Eigen::Vector3d across = direction.cross(second);
  const double volume = first.dot(across);
  if (volume == 0.0) return most;
  const Eigen::Vector3d from = origin - c[0];
  const double u = from.dot(across) / volume;
  if (!(u >= 0.0 && u <= 1.0)) return most;
  const Eigen::Vector3d other = from.cross(first);
  const double v = direction.dot(other) / volume;
  if (!(v >= 0.0 && u + v <= 1.0)) return most;
  const double t = second.dot(other) / volume;
  return t > 0.0 && t < most ? t : most;
}

/// Where a ray enters a box, infinity if it passes by; inverse: of its direction's entries.
double ray_enters(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                  const Eigen::Vector3d& inverse) {
  double in = 0.0, out = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min()[axis] - origin[axis]) * inverse[axis];
    const double b = (box.max()[axis] - origin[axis]) * inverse[axis];
    // Not a number on a face that the ray runs along: no bound.
    in = std::min(a, b) > in ? std::min(a, b) : in;
    out = std::max(a, b) < out ? std::max(a, b) : out;
  }
  constexpr double kRounding = 1.0 + 1e-12;
  return in <= out * kRounding ? in : std::numeric_limits<double>::infinity();
}

}  // namespace

TriangleTree::TriangleTree(std::vector<Eigen::Vector3d> corners) : corners_(std::move(corners)) {
  nodes_.reserve(corners_.size() / 3);
  build(0, static_cast<int>(corners_.size() / 3));
}

void TriangleTree::build(int begin, int end) {
  const std::size_t own = nodes_.size();
  Node node;
  node.begin = begin;
  node.end = end;
  double total = 0.0;
  Eigen::AlignedBox3d middles;
  for (int t = begin; t < end; ++t) {
    const Eigen::Vector3d* c = &corners_[3 * static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) node.box.extend(c[k]);
    const Eigen::Vector3d area = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    const Eigen::Vector3d middle = (c[0] + c[1] + c[2]) / 3.0;
    middles.extend(middle);
    node.area += area;
    node.centre += area.norm() * middle;
    total += area.norm();
  }
  node.centre = total > 0.0 ? Eigen::Vector3d(node.centre / total) : node.box.center();
  for (int i = 3 * begin; i < 3 * end; ++i) {
    const double far = (corners_[static_cast<std::size_t>(i)] - node.centre).norm();
    node.radius = std::max(node.radius, far);
  }
  nodes_.push_back(node);
  if (end - begin <= kMostInLeaf) return;

  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  using Triangle = std::array<Eigen::Vector3d, 3>;
  std::vector<Triangle> sorted;
  for (int t = begin; t < end; ++t) {
    const std::size_t at = 3 * static_cast<std::size_t>(t);
    sorted.push_back({corners_[at], corners_[at + 1], corners_[at + 2]});
  }
  const int half = (end - begin) / 2;
  std::nth_element(sorted.begin(), sorted.begin() + half, sorted.end(),
                   [axis](const Triangle& a, const Triangle& b) {
                     return a[0][axis] + a[1][axis] + a[2][axis] <
                            b[0][axis] + b[1][axis] + b[2][axis];
                   });
  std::size_t at = 3 * static_cast<std::size_t>(begin);
  for (const Triangle& triangle : sorted) {
    for (const Eigen::Vector3d& corner : triangle) corners_[at++] = corner;
  }
  build(begin, begin + half);
  nodes_[own].right = static_cast<int>(nodes_.size());
  build(begin + half, end);
}

double TriangleTree::distance(const Eigen::Vector3d& point, double most) const {
  double nearest = most * most;
  std::array<int, kDeepest> waiting;
  int count = 0;
  waiting[static_cast<std::size_t>(count++)] = 0;
  while (count > 0) {
    const int index = waiting[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.box.squaredExteriorDistance(point) >= nearest) continue;
    if (node.right < 0) {
      for (int t = node.begin; t < node.end; ++t) {
        nearest =
            std::min(nearest, squared_distance(point, &corners_[3 * static_cast<std::size_t>(t)]));
      }
      continue;
    }
    const Node& left = nodes_[static_cast<std::size_t>(index) + 1];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    const bool left_first =
        left.box.squaredExteriorDistance(point) <= right.box.squaredExteriorDistance(point);
    waiting[static_cast<std::size_t>(count++)] = left_first ? node.right : index + 1;
    waiting[static_cast<std::size_t>(count++)] = left_first ? index + 1 : node.right;
  }
  return std::sqrt(nearest);
}

double TriangleTree::winding_number(const Eigen::Vector3d& point) const {
  constexpr double kFar = 2.0;  // in radii; Barill et al., section 4
  double angle = 0.0;
  std::array<int, kDeepest> waiting;
  int count = 0;
  waiting[static_cast<std::size_t>(count++)] = 0;
  while (count > 0) {
    const int index = waiting[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    const Eigen::Vector3d to = node.centre - point;
    const double squared = to.squaredNorm();
    if (squared > kFar * kFar * node.radius * node.radius) {
      angle += node.area.dot(to) / (squared * std::sqrt(squared));
    } else if (node.right < 0) {
      for (int t = node.begin; t < node.end; ++t) {
        angle += solid_angle(point, &corners_[3 * static_cast<std::size_t>(t)]);
      }
    } else {
      waiting[static_cast<std::size_t>(count++)] = index + 1;
      waiting[static_cast<std::size_t>(count++)] = node.right;
    }
  }
  return angle / (4.0 * std::numbers::pi);
}

double TriangleTree::distance_outside(const Eigen::Vector3d& point) const {
  return std::abs(winding_number(point)) > 0.5 ? 0.0 : distance(point);
}

double TriangleTree::first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                               double most) const {
  const Eigen::Vector3d inverse = direction.cwiseInverse();
  std::array<int, kDeepest> waiting;
  int count = 0;
  waiting[static_cast<std::size_t>(count++)] = 0;
  while (count > 0) {
    const int index = waiting[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!(ray_enters(node.box, origin, inverse) < most)) continue;
    if (node.right < 0) {
      for (int t = node.begin; t < node.end; ++t) {
        most =
            ray_hits_triangle(origin, direction, &corners_[3 * static_cast<std::size_t>(t)], most);
      }
      continue;
    }
    const Node& left = nodes_[static_cast<std::size_t>(index) + 1];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    const bool left_first =
        ray_enters(left.box, origin, inverse) <= ray_enters(right.box, origin, inverse);
    waiting[static_cast<std::size_t>(count++)] = left_first ? node.right : index + 1;
    waiting[static_cast<std::size_t>(count++)] = left_first ? index + 1 : node.right;
  }
  return most;
}

}  // namespace locograph
