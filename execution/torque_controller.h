#pragma once
/// Torques with which a robot follows a motion: the interface of all controllers.
///
///     TorqueController& any = controller;  // one of several
///     engine.set_torques(any.torques(configuration, velocity, player.reference(),
///                                    player.contacts()));
///
/// A controller knows the robot, not the engine that moves it. It is asked once in each cycle of
/// 1 ms, and does not allocate then.

#include <locograph/check/motion_curve.h>
#include <locograph/execution/held_contact.h>

#include <Eigen/Core>
#include <span>

namespace locograph {

/// What one end effector has to do.
struct ContactCommand {
  const HeldContact* held = nullptr;  ///< null: it follows the reference
  bool touches = true;                ///< whether it bears by now: else it is moved towards it
  /// Of what it can bear, above 0, at most 1: less while it is loaded or unloaded.
  double share = 1.0;
  /// That the plan has it bear: as of StanceWrenches.
  Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
};

class TorqueController {
 public:
  virtual ~TorqueController() = default;

  /// Of the active joints [N m or N], within their efforts. contacts: one for each end effector of
  /// the constructor. Valid until the next call.
  virtual const Eigen::VectorXd& torques(const Eigen::VectorXd& configuration,
                                         const Eigen::VectorXd& velocity,
                                         const CurvePoint& reference,
                                         std::span<const ContactCommand> contacts) = 0;
};

}  // namespace locograph
