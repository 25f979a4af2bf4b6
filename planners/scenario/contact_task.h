#pragma once
/// What a scenario of contacts asks for: where the robot starts, and where it goes.
///
///     ContactTask task{.start = start, .goals = {goal}};
///     task.joints.push_back({.name = "knee", .position = 0.4});

#include <locograph/robots/contact.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// Where a joint of the start stands [rad or m].
struct GivenJoint {
  std::string name;
  double position = 0.0;
  int line = 0;
};

/// From a start stance to goal stances, one after the other. Each stance is exactly its contacts.
struct ContactTask {
  /// Of the start: x y z qx qy qz qw, the quaternion normalised; none: wherever the posture solver
  /// finds it from the robot's state.
  std::optional<Eigen::Matrix<double, 7, 1>> base = std::nullopt;
  std::vector<GivenJoint> joints = {};  ///< that do not stand as in the robot's state
  Stance start;
  std::vector<Stance> goals;  ///< one or more
  int start_line = 0;
  std::vector<int> goal_lines = {};
};

}  // namespace locograph
