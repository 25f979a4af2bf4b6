#pragma once
/// What the sensors on board read of the engine's true state.
///
///     SimulatedSensors sensors(robot, {.attitude_rad = 0.003}, seed);
///     const SensorReadings& readings = sensors.read(engine.configuration(), engine.velocity());
///
/// Drawn at random, the same for the same seed. Pressing forces are left to the caller. read() does
/// not allocate. Keeps a pointer to the robot, which must outlive it.

#include <locograph/execution/state_estimator.h>

#include <random>

namespace locograph {

/// How far sensors are off. Uniform up to the number, but for noise, which is its standard
/// deviation.
struct SensorErrors {
  double encoder_step_rad = 1e-4;  ///< to which encoders round; metres for prismatic joints
  double joint_rate_rad_s = 2e-3;  ///< noise of joint velocities
  double attitude_rad = 3e-3;      ///< about each axis, the same all the time
  double attitude_noise_rad = 2e-4;
  double gyro_rad_s = 2e-3;  ///< noise of angular velocities

  /// Throws Error naming the number that is negative or not finite.
  void validate() const;
};

class SimulatedSensors {
 public:
  /// Throws Error as SensorErrors::validate() does, and for a base that does not float.
  SimulatedSensors(const Robot& robot, const SensorErrors& errors, unsigned seed);

  /// Valid until the next call. pressing_N stays as it is.
  SensorReadings& read(const Eigen::VectorXd& configuration, const Eigen::VectorXd& velocity);

 private:
  double noise(double deviation) { return deviation * normal_(random_); }
  Eigen::Vector3d noise3(double deviation) {
    return {noise(deviation), noise(deviation), noise(deviation)};
  }

  const SensorErrors errors_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  Eigen::Quaterniond attitude_off_;
  SensorReadings readings_;
};

}  // namespace locograph
