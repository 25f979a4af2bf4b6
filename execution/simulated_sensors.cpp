#include <locograph/common/check_option.h>
#include <locograph/execution/simulated_sensors.h>

#include <cmath>

namespace locograph {
namespace {

constexpr Eigen::Index kBaseTangent = 6;

Eigen::Quaterniond turned_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

}  // namespace

void SensorErrors::validate() const {
  const auto sane = [](double value, const char* name) {
    check_option(value >= 0.0 && std::isfinite(value), name, "0 or more");
  };
  sane(encoder_step_rad, "encoder_step_rad");
  sane(joint_rate_rad_s, "joint_rate_rad_s");
  sane(attitude_rad, "attitude_rad");
  sane(attitude_noise_rad, "attitude_noise_rad");
  sane(gyro_rad_s, "gyro_rad_s");
}

SimulatedSensors::SimulatedSensors(const Robot& robot, const SensorErrors& errors, unsigned seed)
    : errors_(errors), random_(seed) {
  errors_.validate();
  require_floating_base(robot);
  std::uniform_real_distribution<double> within(-errors_.attitude_rad, errors_.attitude_rad);
  Eigen::Vector3d off;
  for (double& about : off) about = within(random_);
  attitude_off_ = turned_by(off);
  readings_.joints.setZero(robot.active_joint_count());
  readings_.joint_velocities.setZero(robot.active_joint_count());
}

SensorReadings& SimulatedSensors::read(const Eigen::VectorXd& configuration,
                                       const Eigen::VectorXd& velocity) {
  const Eigen::Index joints = readings_.joints.size();
  for (Eigen::Index i = 0; i < joints; ++i) {
    const double at = configuration[configuration.size() - joints + i];
    const double step = errors_.encoder_step_rad;
    readings_.joints[i] = step > 0.0 ? step * std::round(at / step) : at;
    readings_.joint_velocities[i] = velocity[kBaseTangent + i] + noise(errors_.joint_rate_rad_s);
  }
  const Eigen::Quaterniond attitude(configuration.segment<4>(3));
  readings_.attitude =
      (attitude_off_ * attitude * turned_by(noise3(errors_.attitude_noise_rad))).normalized();
  readings_.angular_velocity = velocity.segment<3>(3) + noise3(errors_.gyro_rad_s);
  return readings_;
}

}  // namespace locograph
