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

  std::vector<Capsule> capsules;  ///< ordered by link
  std::vector<OfBound> of_bound;
  /// Those of Robot::self_collision_pairs() that an active joint moves against each other, in the
  /// same order.
  std::vector<Pair> pairs;

  SelfCollisionShapes() = default;
  /// The robot, its spheres and bounds must be there.
  explicit SelfCollisionShapes(const RobotParameter& parameter);
};

}  // namespace locograph
