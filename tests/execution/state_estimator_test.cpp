// What a robot makes of its own sensors: against the truth of bodies that move as they should.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/execution/simulated_sensors.h>
#include <locograph/execution/simulation.h>
#include <locograph/execution/state_estimator.h>

#include <cmath>

#include "common/allocation_counter.h"
#include "execution/standing_coman.h"

namespace locograph::test {
namespace {

constexpr double kCycle_s = 0.001;
constexpr SensorErrors kExact = {.encoder_step_rad = 0.0,
                                 .joint_rate_rad_s = 0.0,
                                 .attitude_rad = 0.0,
                                 .attitude_noise_rad = 0.0,
                                 .gyro_rad_s = 0.0};

class Estimates : public testing::Test {
 protected:
  StandingComan coman;
  const HeldContact left{coman.contact(0), {}}, right{coman.contact(1), {}};
  const std::vector<ContactCommand> commands = {{.held = &left}, {.held = &right}};

  /// The base at a place such that the left sole stays where it was.
  void keep_left_sole(Eigen::VectorXd& q) const {
    q.head<3>() += left.contact().position - coman.sole(0, q);
  }
};

TEST_F(Estimates, TheBaseFollowsFromASoleThatStays) {
  SimulatedSensors sensors(coman.robot, kExact, 1);
  StateEstimator estimator(coman.robot, coman.effectors, coman.configuration, kCycle_s);
  const int knee =
      coman.robot.base_configuration_size() +
      coman.robot.joints()[static_cast<std::size_t>(coman.robot.joint_index("LKneePitch"))].index;
  Eigen::VectorXd q = coman.configuration, before = q;
  Eigen::VectorXd v = Eigen::VectorXd::Zero(coman.robot.tangent_size());
  for (int i = 0; i < 500; ++i) {
    before = q;
    q[knee] = coman.configuration[knee] + 0.2 * std::sin(kCycle_s * i);
    const Eigen::Quaterniond turned(
        Eigen::AngleAxisd(0.1 * std::sin(2.0 * kCycle_s * i), Eigen::Vector3d(0.6, 0.8, 0.0)));
    q.segment<4>(3) = (turned * Eigen::Quaterniond(coman.configuration.segment<4>(3))).coeffs();
    keep_left_sole(q);
    coman.robot.difference(before.data(), q.data(), v.data());
    v /= kCycle_s;
    SensorReadings& readings = sensors.read(q, v);
    readings.pressing_N = {600.0, 0.0};
    estimator.update(readings, commands);
  }
  EXPECT_LT((estimator.configuration() - q).head<3>().norm(), 1e-4);
  EXPECT_LT((estimator.velocity() - v).head<3>().norm(), 1e-3);
  EXPECT_GT((q - coman.configuration).head<3>().norm(), 0.02);
}

TEST_F(Estimates, AContactThatSlipsIsOutvoted) {
  SimulatedSensors sensors(coman.robot, kExact, 1);
  std::vector<EndEffector> three = coman.effectors;
  three.push_back(StandingComan::foot("left_heel", "l_sole"));
  StateEstimator estimator(coman.robot, three, coman.configuration, kCycle_s);
  const std::vector<ContactCommand> all = {commands[0], commands[1], commands[0]};
  // The right leg moves as if the right sole slid on the ground, at 0.3 m/s.
  Eigen::VectorXd v = Eigen::VectorXd::Zero(coman.robot.tangent_size());
  v[coman.robot.base_tangent_size() +
    coman.robot.joints()[static_cast<std::size_t>(coman.robot.joint_index("RHipSag"))].index] = 0.4;
  SensorReadings& readings = sensors.read(coman.configuration, v);
  readings.pressing_N = {300.0, 300.0, 300.0};
  estimator.update(readings, all);
  EXPECT_LT(estimator.velocity().head<3>().norm(), 0.02);
}

TEST_F(Estimates, AtTheStartContactsAreWhereThePlanHasThem) {
  SimulatedSensors sensors(coman.robot, kExact, 1);
  StateEstimator estimator(coman.robot, coman.effectors, coman.configuration, kCycle_s);
  Eigen::VectorXd q = coman.configuration;
  q.tail(coman.robot.active_joint_count()).array() += 0.02;
  keep_left_sole(q);
  ASSERT_GT((q - coman.configuration).head<3>().norm(), 0.005);
  for (int i = 0; i < 300; ++i) {
    SensorReadings& readings = sensors.read(q, Eigen::VectorXd::Zero(coman.robot.tangent_size()));
    readings.pressing_N = {600.0, 0.0};
    estimator.update(readings, commands);
  }
  EXPECT_LT((estimator.configuration() - q).head<3>().norm(), 1e-6);
}

TEST_F(Estimates, DoNotAllocate) {
  if (!allocations_are_counted()) GTEST_SKIP();
  SimulatedSensors sensors(coman.robot, {}, 1);
  StateEstimator estimator(coman.robot, coman.effectors, coman.configuration, kCycle_s);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(coman.robot.tangent_size());
  sensors.read(coman.configuration, still).pressing_N = {300.0, 300.0};
  const long before = allocation_count();
  for (int i = 0; i < 100; ++i) {
    estimator.update(sensors.read(coman.configuration, still), commands);
  }
  EXPECT_EQ(allocation_count(), before);
}

TEST_F(Estimates, SensorsThatMakeNoSenseAreRefused) {
  EXPECT_THROW(SimulatedSensors(coman.robot, {.gyro_rad_s = -1.0}, 1), Error);
  EXPECT_THROW(SimulatedSensors(coman.robot, {.attitude_rad = std::nan("")}, 1), Error);
  const Robot fixed =
      Robot::load(model("coman_plus/coman_plus.urdf"), {}, {.floating_base = false});
  EXPECT_THROW(SimulatedSensors(fixed, {}, 1), Error);
  EXPECT_THROW(StateEstimator(fixed, {}, fixed.neutral_configuration(), kCycle_s), Error);
}

TEST_F(Estimates, ARobotThatKnowsItsSensorsOnlyKeepsStanding) {
  SimulationOptions options = {.initial_error_rad = 0.005, .seed = 5};
  options.sensors.emplace();
  const SimulationResult result =
      simulate(coman.robot, coman.effectors, coman.world, coman.standing(), options);
  EXPECT_TRUE(result.carried_out) << result.reason;
  EXPECT_GT(result.max_estimate_error_m, 1e-5);
  EXPECT_LT(result.max_estimate_error_m, 0.01);
  EXPECT_LT(result.max_estimate_error_rad, 0.01);
}

}  // namespace
}  // namespace locograph::test
