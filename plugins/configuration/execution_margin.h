#pragma once
/// What plans leave unused for whoever carries them out.
///
///     const ExecutionMargin margin{.friction = 0.7, .dwell_s = 0.3};
///     margin.validate();
///     const ExecutionMargin half = margin.scaled(0.5);      // friction 0.85, dwell 0.15 s
///     const bool none = margin.scaled(0.0) == ExecutionMargin::none();
///
/// Planners keep to it; the judge knows nothing of it. What a start or a goal does not have is not
/// asked of it.

namespace locograph {

struct ExecutionMargin {
  // Shares that plans use, above 0, at most 1.
  double friction = 0.65;  ///< of coefficients
  double area = 0.65;      ///< of lengths of the areas of contacts, about their middle
  double torque = 0.9;     ///< of efforts, where these are limits

  double joint_rad = 0.02;        ///< to joint limits; metres for prismatic joints
  double self_distance_m = 0.01;  ///< of links from each other, where they are not joined
  /// Pressing force of every contact that bears load, a part of the robot's weight, less than 1.
  /// Grasps need none. A contact that opens or closes has none then, and more as the dwell goes on.
  double least_force = 0.03;
  /// For how long the robot stands at each change of stance and at the end, while forces go over.
  double dwell_s = 0.5;

  static constexpr double kMostJoint_rad = 1.0, kMostSelfDistance_m = 0.2, kMostDwell_s = 60.0;

  static ExecutionMargin none();
  /// factor: 0: none, 1: this one.
  ExecutionMargin scaled(double factor) const;
  /// Throws Error naming the number that is out of range.
  void validate() const;
  bool operator==(const ExecutionMargin&) const = default;
};

}  // namespace locograph
