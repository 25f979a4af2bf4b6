#pragma once
/// What is asked of a posture.
///
///     PostureProblem problem{.stance = stance, .preferred = q};
///     PostureOptions options{.seed = 7, .max_restarts = 2};
///     options.validate();

#include <locograph/check/judge.h>
#include <locograph/common/termination.h>
#include <locograph/robots/contact.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>

namespace locograph {

struct PostureProblem {
  Stance stance;
  /// The posture to stay near, and the first start: Robot::configuration_size() numbers.
  Eigen::VectorXd preferred = {};
  /// The contacts file the stance was read from: who judges a saved posture goes by it. Empty:
  /// none.
  std::filesystem::path file = {};
};

/// Contacts files do not say on what contacts are.
inline CheckOptions posture_check() {
  CheckOptions options;
  options.surfaces_known = false;
  return options;
}

struct PostureOptions {
  std::uint64_t seed = 0;
  int max_restarts = 8;
  int max_iterations = 40;  ///< of each attempt
  /// An attempt ends when this many iterations have not lowered the sum of its violations by a
  /// tenth.
  int patience = 12;
  Termination termination = {};
  /// Limits the torques to the efforts of the URDF; false: the result tells them.
  bool enforce_torque_limits = true;

  double joint_margin_rad = 1e-3;  ///< metres for prismatic joints
  double self_margin_m = 4e-3;
  double obstacle_margin_m = 0.01;
  double ground_margin_m = 4e-3;
  /// The part of friction, contact areas and force limits that is left as a margin.
  double wrench_margin = 0.1;
  double torque_margin = 0.05;
  /// What the judge is asked.
  CheckOptions check = posture_check();

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

}  // namespace locograph
