#pragma once
/// Distances of the links of a robot to each other, the slow and simple way.
///
///     const std::vector<PairDistance> distances = pair_distances(state);
///     if (distances[row].smooth(margin)) …        // differences may be taken there

#include "plugins/jacobian_comparison.h"

namespace locograph::test {

/// Distance of two segments by trying everything: each end against the other segment, and the two
/// lines against each other.
struct SegmentDistance {
  double value = std::numeric_limits<double>::infinity();
  double slack = 0.0;  ///< how far from where other features become nearest [m]

  SegmentDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& p_end, const Eigen::Vector3d& q,
                  const Eigen::Vector3d& q_end) {
    const Eigen::Vector3d a = p_end - p, b = q_end - q;
    const auto fraction = [](const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                             const Eigen::Vector3d& point) {
      return way.isZero(0.0) ? 0.0
                             : std::clamp(way.dot(point - from) / way.squaredNorm(), 0.0, 1.0);
    };
    consider(p, a, 0.0, q, b, fraction(q, b, p));
    consider(p, a, 1.0, q, b, fraction(q, b, p_end));
    consider(p, a, fraction(p, a, q), q, b, 0.0);
    consider(p, a, fraction(p, a, q_end), q, b, 1.0);
    const Eigen::Vector3d normal = a.cross(b);
    if (normal.norm() > 1e-6 * a.norm() * b.norm()) {
      Eigen::Matrix3d system;
      system << a, -b, normal;
      const Eigen::Vector3d x = system.inverse() * (q - p);
      if (x[0] >= 0.0 && x[0] <= 1.0 && x[1] >= 0.0 && x[1] <= 1.0) {
        consider(p, a, x[0], q, b, x[1]);
        // Nearly parallel axes: the nearest points run along them.
        if (normal.norm() < 0.1 * a.norm() * b.norm()) slack = 0.0;
      }
    }
  }

 private:
  void consider(const Eigen::Vector3d& p, const Eigen::Vector3d& a, double s,
                const Eigen::Vector3d& q, const Eigen::Vector3d& b, double t) {
    const Eigen::Vector3d way = q + t * b - p - s * a;
    if (way.norm() >= value) return;
    value = way.norm();
    const auto room = [&](const Eigen::Vector3d& axis, double where) {
      const double length = axis.norm();
      if (length == 0.0) return 1.0;
      return std::max(std::min(where, 1.0 - where) * length, std::abs(way.dot(axis)) / length);
    };
    slack = std::min(room(a, s), room(b, t));
  }
};

/// Signed distance of every pair of links, over all pairs of their capsules.
struct PairDistance {
  double value = std::numeric_limits<double>::infinity();
  double second = std::numeric_limits<double>::infinity();
  double axes = 0.0, slack = 0.0;

  bool smooth(double margin) const {
    return std::abs(margin - value) > kKink &&
           (value > margin || (second - value > kKink && axes > 0.02 && slack > kKink));
  }
};

inline std::vector<PairDistance> pair_distances(const ConfigurationState& q) {
  const SelfCollisionShapes& shapes = q.robot->self_collision;
  std::vector<PairDistance> result;
  for (const SelfCollisionShapes::Pair& pair : shapes.pairs) {
    PairDistance nearest;
    const auto& a = shapes.of_bound[pair.first];
    const auto& b = shapes.of_bound[pair.second];
    const Eigen::Isometry3d& first = q.kinematics.world_from_link(q.robot->bounds[pair.first].link);
    const Eigen::Isometry3d& second =
        q.kinematics.world_from_link(q.robot->bounds[pair.second].link);
    for (int i = a.begin; i < a.end; ++i) {
      for (int j = b.begin; j < b.end; ++j) {
        const auto &one = shapes.capsules[i], &other = shapes.capsules[j];
        const SegmentDistance axes(first * one.from, first * one.to, second * other.from,
                                   second * other.to);
        const double value = axes.value - one.radius - other.radius;
        nearest.second = std::min(nearest.second, std::max(value, nearest.value));
        if (value >= nearest.value) continue;
        nearest.value = value;
        nearest.axes = axes.value;
        nearest.slack = axes.slack;
      }
    }
    result.push_back(nearest);
  }
  return result;
}

}  // namespace locograph::test
