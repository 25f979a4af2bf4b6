#pragma once
/// The shapes of a robot as capsules, and which of its links are kept apart.
///
///     for (const SelfCollisionShapes::Pair& pair : robot->self_collision.pairs) {
///       const RobotParameter::LinkBound& first = robot->bounds[pair.first];
///       first_capsules.push_back(robot->self_collision.of_bound[pair.first].begin);
///     }
///
/// A capsule or a sphere of the URDF is itself; any other shape becomes the spheres or, of a mesh,
/// the capsules that cover it and stick out of it by no more than kSelfOvershoot_m (see
/// robots/covering_capsules.h).

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace locograph {

struct RobotParameter;

inline constexpr double kSelfOvershoot_m = 0.01;

struct SelfCollisionShapes {
  /// Everything within `radius` of the segment; a sphere where from = to. Link frame, m.
  struct Capsule {
    Eigen::Vector3d from, to;
    double radius;
  };
  /// The capsules of one RobotParameter::bounds[i], all within `radius` of the bound's centre.
  struct OfBound {
    double radius;
    int begin, end;
  };
  /// Indices into RobotParameter::bounds, and the sum of the two radii.
  struct Pair {
    int first, second;
    double reach;
  };
  /// The pairs with the same first link, by RobotParameter::bounds [begin, end): where a bound is
  /// not the second of one, the reach is -inf and the number -1.
  struct PairsOf {
    int first, begin, end;
    std::vector<double> reach;
    std::vector<int> number;  ///< in `pairs`
  };

  std::vector<Capsule> capsules;  ///< ordered by link
  std::vector<OfBound> of_bound;
  /// Those of Robot::self_collision_pairs() that an active joint moves against each other, in the
  /// same order.
  std::vector<Pair> pairs;
  std::vector<PairsOf> by_first;

  SelfCollisionShapes() = default;
  /// The robot, its spheres and bounds must be there.
  explicit SelfCollisionShapes(const RobotParameter& parameter);

  /// Calls f(number) for the pairs whose bounds are nearer than limit_m, centres (of all bounds, by
  /// row) in any frame. Bounds are compared with a first one together, pairs or not: that is less
  /// work than looking up the second ones.
  template <class F>
  void each_near_pair(const Eigen::MatrixX3d& centres, double limit_m, F&& f) const {
    constexpr int kTogether = 64;
    const double *x = centres.col(0).data(), *y = centres.col(1).data(), *z = centres.col(2).data();
    for (const PairsOf& of : by_first) {
      const double first_x = x[of.first], first_y = y[of.first], first_z = z[of.first];
      for (int begin = of.begin; begin < of.end; begin += kTogether) {
        const int count = std::min(kTogether, of.end - begin);
        const double* reaches = of.reach.data() + (begin - of.begin);
        double beyond[kTogether];
        for (int k = 0; k < count; ++k) {
          const int i = begin + k;
          const double dx = x[i] - first_x, dy = y[i] - first_y, dz = z[i] - first_z;
          const double reach = std::max(0.0, reaches[k] + limit_m);
          beyond[k] = dx * dx + dy * dy + dz * dz - reach * reach;
        }
        // Mostly none is below 0: their signs together.
        std::int64_t signs = 0;
        for (int k = 0; k < count; ++k) signs |= std::bit_cast<std::int64_t>(beyond[k]);
        if (signs >= 0) continue;
        for (int k = 0; k < count; ++k) {
          if (beyond[k] < 0.0) f(of.number[static_cast<std::size_t>(begin - of.begin + k)]);
        }
      }
    }
  }
};

}  // namespace locograph
