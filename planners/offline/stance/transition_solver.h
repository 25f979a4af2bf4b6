#pragma once
/// Finds configurations between two stances: the contacts of the larger one closed, in balance on
/// the smaller one, within joint limits, free of collisions.
///
///     TransitionSolver solver(robot, world);
///     const TransitionProblem problem{.closed = larger.contacts, .balance = &region_of_smaller,
///                                     .start = q, .preferred = home};
///     const TransitionResult result = solver.solve(problem);
///     if (!result.found) std::cerr << result.reason;
///
/// Wrenches are no unknowns: what a stance can balance is a polygon for the centre of mass
/// (balance_region.h), and what it asks of the joints one number with a gradient
/// (torque_programme.h). Each step minimises, over the tangent d of the configuration,
///
///   damping |d|² + pull to the preferred joints + 1e5 |c + J d|² + 1e3 Σ max(0, −(g + a d))²
///
/// with the closure c of the contacts (robots/contact_closure.h) and, linearised, everything that
/// has to be positive: distances less their margins, joints to their limits, the centre of mass to
/// the sides of the polygon. It is cut to a trust region, brought back to the contacts, and taken
/// when Σ |c| and Σ max(0, −g) come down together (an L1 merit). What is found is judged by who
/// asked (check/judge.h); this solver shares nothing with the judge.
///
/// Restarts begin from the start with what was violated moved at random. Deterministic for a seed.
/// The result depends on the arguments alone, not on what was solved before. One solver for each
/// thread; copies share what does not change.

#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/torque_programme.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace locograph {

struct TransitionOptions {
  int max_iterations = 40;  ///< of each attempt
  int patience = 12;        ///< iterations that have to bring the merit down by a tenth
  int restarts = 0;
  double joint_margin_rad = 2e-3;  ///< metres for prismatic joints
  double self_margin_m = 4e-3;
  double surface_margin_m = 8e-3;  ///< of links that do not touch, also to bars
  double obstacle_margin_m = 0.01;
  double balance_margin_m = 4e-3;  ///< of the centre of mass to the sides of the polygon
  double torque_margin = 0.03;     ///< the part of efforts left unused

  bool operator==(const TransitionOptions&) const = default;
};

struct TransitionProblem {
  std::span<const Contact> closed;
  const BalanceRegion* balance = nullptr;  ///< null: not asked for
  TorqueProgramme* torques = nullptr;      ///< of the contacts that balance; null: not limited
  Eigen::VectorXd start;
  Eigen::VectorXd preferred;  ///< a configuration whose joints the posture tends to
  std::uint64_t seed = 0;
  /// The contacts of the smaller stance: links of others may touch, and not reach into what they
  /// touch. Empty: those that are closed.
  std::span<const Contact> held = {};
  /// Contacts that are not closed, but whose links may be near what they touch: of what has just
  /// been lifted or is about to come down. near_m: how far above it, at least.
  std::span<const Contact> near = {};
  double near_m = 0.0;
};

/// What was violated most where no posture was found.
enum class TransitionFailure {
  kNone,
  kContact,
  kJoint,
  kSelf,
  kSurface,
  kObstacle,
  kBalance,
  kTorque
};
const std::string& transition_failure_name(TransitionFailure failure);

struct TransitionResult {
  bool found = false;
  Eigen::VectorXd configuration;  ///< the posture, or the best attempt
  int iterations = 0, restarts = 0;
  TransitionFailure failure = TransitionFailure::kNone;
  double amount = 0.0;  ///< of that violation, m or rad
  std::string reason;   ///< in words: link, joint or contact and amount
};

class TransitionSolver {
 public:
  /// Throws Error for a robot with a fixed base or without masses, and for collision shapes that
  /// cannot be used.
  TransitionSolver(std::shared_ptr<const RobotParameter> robot, World world);
  ~TransitionSolver();
  TransitionSolver(const TransitionSolver& other);
  TransitionSolver(TransitionSolver&&) noexcept;

  /// Throws Error for contacts that are not sound.
  TransitionResult solve(const TransitionProblem& problem, const TransitionOptions& options = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace locograph
