#pragma once
/// What is asked of a configuration between two stances, and what may be in its way.
///
///     const TransitionProblem problem{.closed = larger.contacts, .balance = &region_of_smaller,
///                                     .start = q, .preferred = home};
///     const std::string& name = transition_failure_name(TransitionFailure::kBalance);

#include <locograph/common/termination.h>
#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/torque_programme.h>
#include <locograph/robots/rolling_ball.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
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
  double border_margin_m = 2e-3;   ///< of balls that roll, to the border of what they roll on
  double balance_margin_m = 4e-3;  ///< of the centre of mass to the sides of the polygon
  double torque_margin = 0.03;     ///< the part of efforts left unused
  Termination termination = {};

  /// Throws Error naming the option that is out of range.
  void validate() const;
  bool operator==(const TransitionOptions&) const = default;
};

/// Of contacts: where each ball that is held is, to roll on from there; nothing for other contacts.
using HeldBalls = std::vector<std::optional<BallPose>>;
/// held: of each contact, whether it is.
HeldBalls held_balls(const RobotState& state, std::span<const Contact> contacts,
                     const std::function<bool(const Contact&)>& held);

struct TransitionProblem {
  std::span<const Contact> closed;
  /// Of each of them; of those beyond its end nothing: balls are at their places.
  std::span<const std::optional<BallPose>> rolled_from = {};
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
  /// False: contacts may be on what the world does not describe, as in contacts files.
  bool places_known = true;
  /// Whether links are kept apart by their exact shapes where the shapes that cover them cannot
  /// tell. False: not at all.
  bool exact_pairs = true;
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
  kTorque,
  kBorder
};
const std::string& transition_failure_name(TransitionFailure failure);

}  // namespace locograph
