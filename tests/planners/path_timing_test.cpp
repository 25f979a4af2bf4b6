#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/common/error.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/offline/timing/effort_rows.h>
#include <locograph/planners/offline/timing/path_timing.h>
#include <locograph/robots/dynamics.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "common/sanitized.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::kSanitized;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kMillisecond = 1e-3;

/// Sliding joints on a row, and nothing else.
Robot slides(int joints, bool floating_base = false) {
  std::string urdf = "<robot name=\"slides\"><link name=\"l0\"/>";
  for (int i = 0; i < joints; ++i) {
    // Appended, as GCC 12 warns of `"l" + std::to_string(i)` (its bug 105651).
    std::string from("l"), to("l");
    from += std::to_string(i);
    to += std::to_string(i + 1);
    urdf += "<link name=\"" + to + "\"/><joint name=\"j" + std::to_string(i) +
            "\" type=\"prismatic\"><parent link=\"" + from + "\"/><child link=\"" + to +
            "\"/><limit lower=\"-100\" upper=\"100\" effort=\"1\" velocity=\"2\"/></joint>";
  }
  const test::TemporaryFolder folder;
  return Robot::load(folder.write("slides.urdf", urdf + "</robot>"), {},
                     {.floating_base = floating_base});
}

Eigen::VectorXd numbers(std::initializer_list<double> values) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

TimingLimits even_limits(const Robot& robot, double velocity, double acceleration) {
  return {Eigen::VectorXd::Constant(robot.tangent_size(), velocity),
          Eigen::VectorXd::Constant(robot.tangent_size(), acceleration)};
}

/// From rest to rest over a way.
double trapezoid_s(double way, double velocity, double acceleration) {
  if (way * acceleration < velocity * velocity) return 2.0 * std::sqrt(way / acceleration);
  return way / velocity + velocity / acceleration;
}

struct Extremes {
  double velocity = 0.0, acceleration = 0.0;  ///< the largest, as ratios of limits
};

/// What the judge sees of joints in configurations.
Extremes seen(const TimedPath& motion, const TimingLimits& limits) {
  Extremes result;
  const Eigen::Index joints = motion.configurations.front().size();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(joints), now;
  const std::size_t steps = motion.time_s.size() - 1;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double dt_s = motion.duration_s / static_cast<double>(steps);
    now.setZero(joints);
    if (i < steps) now = (motion.configurations[i + 1] - motion.configurations[i]) / dt_s;
    const double between_s = i == 0 || i == steps ? 0.5 * dt_s : dt_s;
    const auto ratio = [](const Eigen::VectorXd& values, const Eigen::VectorXd& most) {
      return values.cwiseAbs().cwiseQuotient(most).maxCoeff();
    };
    result.velocity = std::max(result.velocity, ratio(now, limits.velocity));
    result.acceleration =
        std::max(result.acceleration, ratio((now - before) / between_s, limits.acceleration));
    before = now;
  }
  return result;
}

/// Time-optimal parametrisation by itself: limits at the points of a fine grid and nowhere else,
/// controllable speeds found by bisection.
double reference_s(const PathSpline& path, const TimingLimits& limits, int intervals) {
  const double step = path.length() / intervals;
  const auto count = static_cast<std::size_t>(intervals);
  std::vector<PathPoint> points(count + 1);
  for (std::size_t i = 0; i <= count; ++i) path.at(step * static_cast<double>(i), points[i]);
  const auto range = [&](const PathPoint& point, double x) {
    std::pair<double, double> u{-kUnlimited, kUnlimited};
    for (Eigen::Index k = 0; k < point.first.size(); ++k) {
      const double rate = point.first[k], most = limits.acceleration[k], bend = x * point.second[k];
      if (std::abs(rate) < 1e-12) {
        if (std::abs(bend) > most) return std::pair(1.0, -1.0);
        continue;
      }
      const double at = -bend / rate, reach = most / std::abs(rate);
      u = {std::max(u.first, at - reach), std::min(u.second, at + reach)};
    }
    return u;
  };
  std::vector<double> most(count + 1, 0.0);
  for (std::size_t i = count; i-- > 0;) {
    const auto controllable = [&](double x) {
      const auto [least, largest] = range(points[i], x);
      const double needed = (most[i + 1] - x) / (2.0 * step);
      return least <= largest && least <= needed && largest >= -x / (2.0 * step);
    };
    double low = 0.0, high = 1e9;
    for (Eigen::Index k = 0; k < points[i].first.size(); ++k) {
      const double ratio = limits.velocity[k] / std::abs(points[i].first[k]);
      high = std::min(high, ratio * ratio);
    }
    for (int round = 0; round < 45 && !controllable(high); ++round) {
      const double middle = 0.5 * (low + high);
      (controllable(middle) ? low : high) = middle;
      if (round == 44) high = low;
    }
    most[i] = high;
  }
  double time = 0.0, x = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double next = std::clamp(x + 2.0 * step * range(points[i], x).second, 0.0, most[i + 1]);
    time += 2.0 * step / (std::sqrt(x) + std::sqrt(next));
    x = next;
  }
  return time;
}

struct RandomTask {
  explicit RandomTask(unsigned seed) {
    std::mt19937_64 random(seed);
    const int joints = 1 + static_cast<int>(random() % 6);
    const int count = 2 + static_cast<int>(random() % 9);
    robot = std::make_unique<Robot>(slides(joints));
    limits = even_limits(*robot, 1.0, 1.0);
    for (int k = 0; k < joints; ++k) {
      limits.velocity[k] = uniform(random, 0.5, 3.0);
      limits.acceleration[k] = uniform(random, 1.0, 20.0);
    }
    for (int i = 0; i < count; ++i) {
      waypoints.emplace_back(joints);
      for (double& q : waypoints.back()) q = uniform(random, -1.0, 1.0);
    }
  }
  std::unique_ptr<Robot> robot;
  TimingLimits limits;
  std::vector<Eigen::VectorXd> waypoints;
};

TEST(PathTiming, IsTheTrapezoidOfASingleJoint) {
  const Robot robot = slides(1);
  const std::vector<Eigen::VectorXd> way{numbers({-0.5}), numbers({1.0})};
  for (const auto& [velocity, acceleration] : {std::pair(1.0, 2.0), std::pair(10.0, 2.0),
                                               std::pair(kUnlimited, 3.0), std::pair(0.1, 50.0)}) {
    const PathTiming timing(robot, way, even_limits(robot, velocity, acceleration));
    const double best = trapezoid_s(1.5, velocity, acceleration);
    EXPECT_NEAR(timing.duration_s(), best, 2e-3 * best) << velocity << " " << acceleration;
  }
}

TEST(PathTiming, BeginsAndEndsAtTheEndsAtRest) {
  const RandomTask task(3);
  for (const double smoothing_s : {0.0, 0.05}) {
    const PathTiming timing(*task.robot, task.waypoints, task.limits, {.smoothing_s = smoothing_s});
    const TimedPoint start = timing.at(0.0), end = timing.at(timing.duration_s());
    EXPECT_LT((start.configuration - task.waypoints.front()).norm(), 1e-12);
    EXPECT_LT((end.configuration - task.waypoints.back()).norm(), 1e-12);
    EXPECT_LT(start.velocity.norm(), 1e-12);
    EXPECT_LT(end.velocity.norm(), 1e-12);
  }
}

/// Waypoints along a line, not evenly spaced: as if there were two.
TEST(PathTiming, DoesNotSeeWaypointsOfAStraightWay) {
  const Robot robot = slides(2);
  std::vector<Eigen::VectorXd> way;
  for (const double at : {0.0, 0.1, 0.15, 0.6, 0.61, 1.0}) way.push_back(numbers({at, -2.0 * at}));
  const PathTiming timing(robot, way, even_limits(robot, 1.0, 4.0));
  const double best = trapezoid_s(2.0, 1.0, 4.0);
  EXPECT_NEAR(timing.duration_s(), best, 2e-3 * best);
}

/// A joint that moves on the first part of the way only.
TEST(PathTiming, LetsJointsStandStillOnAPart) {
  const Robot robot = slides(2);
  const TimingLimits limits = even_limits(robot, 1.0, 2.0);
  const PathTiming timing(robot,
                          {numbers({0, 0}), numbers({0.5, 0.3}), numbers({1, 0.3}),
                           numbers({1.5, 0.3}), numbers({2, 0.3})},
                          limits, {.max_deviation = 0.01});
  const Extremes found = seen(timing.sampled(kMillisecond), limits);
  EXPECT_LE(found.velocity, 1.0 + 1e-6);
  EXPECT_LE(found.acceleration, 1.0 + 1e-6);
  EXPECT_GE(timing.duration_s(), trapezoid_s(2.0, 1.0, 2.0));
}

TEST(PathTiming, KeepsLimitsEverywhereAndIsNearTheOptimumOnRandomPaths) {
  double worst = 0.0, sum = 0.0;
  constexpr unsigned kTasks = kSanitized ? 30 : 1000;
  for (unsigned seed = 0; seed < kTasks; ++seed) {
    const RandomTask task(seed);
    const PathTiming timing(*task.robot, task.waypoints, task.limits);
    ASSERT_TRUE(timing.answer().success());
    const TimedPath motion = timing.sampled(kMillisecond);
    const Extremes found = seen(motion, task.limits);
    EXPECT_LE(found.velocity, 1.0 + 1e-6) << seed;
    EXPECT_LE(found.acceleration, 1.0 + 1e-6) << seed;
    EXPECT_GT(std::max(found.velocity, found.acceleration), 0.98) << seed;
    for (std::size_t i = 1; i + 1 < motion.time_s.size(); ++i) {
      EXPECT_GT(motion.velocities[i].norm(), 0.0) << seed;
    }
    const double ratio = timing.duration_s() / reference_s(timing.path(), task.limits, 4000);
    EXPECT_LE(ratio, 1.05) << seed;
    EXPECT_GE(ratio, 0.99) << seed;
    worst = std::max(worst, ratio);
    sum += ratio;
  }
  RecordProperty("worst_ratio", std::to_string(worst));
  RecordProperty("mean_ratio", std::to_string(sum / kTasks));
}

/// Few grid points: what is between them is many milliseconds long.
TEST(PathTiming, KeepsLimitsBetweenThePointsOfACoarseGrid) {
  for (unsigned seed = 0; seed < (kSanitized ? 10 : 100); ++seed) {
    const RandomTask task(seed);
    const TimingOptions options{.intervals = 1, .intervals_per_step = seed % 2 == 0 ? 2 : 16};
    const PathTiming timing(*task.robot, task.waypoints, task.limits, options);
    const Extremes found = seen(timing.sampled(kMillisecond), task.limits);
    EXPECT_LE(found.velocity, 1.0 + 1e-6) << seed;
    EXPECT_LE(found.acceleration, 1.0 + 1e-6) << seed;
  }
}

TEST(PathTiming, KeepsLimitsWhenItSmooths) {
  for (unsigned seed = 0; seed < (kSanitized ? 20 : 200); ++seed) {
    const RandomTask task(seed);
    const double smoothing_s = seed % 2 == 0 ? 0.02 : 0.1;
    const PathTiming timing(*task.robot, task.waypoints, task.limits, {.smoothing_s = smoothing_s});
    ASSERT_TRUE(timing.answer().success());
    const Extremes found = seen(timing.sampled(kMillisecond), task.limits);
    EXPECT_LE(found.velocity, 1.0 + 1e-6) << seed;
    EXPECT_LE(found.acceleration, 1.0 + 1e-6) << seed;
    const PathTiming fastest(*task.robot, task.waypoints, task.limits);
    EXPECT_GE(timing.duration_s(), fastest.duration_s() + smoothing_s);
    EXPECT_LE(timing.duration_s(), 1.5 * (fastest.duration_s() + smoothing_s)) << seed;
  }
}

TEST(PathTiming, LimitsJerkBySmoothing) {
  const Robot robot = slides(1);
  const double acceleration = 4.0, smoothing_s = 0.1;
  const TimingLimits limits = even_limits(robot, 1.0, acceleration);
  const PathTiming timing(robot, {numbers({0}), numbers({1})}, limits,
                          {.smoothing_s = smoothing_s});
  const TimedPath motion = timing.sampled(kMillisecond);
  EXPECT_LT(motion.accelerations.front().norm(), 1e-9);
  EXPECT_LT(motion.accelerations.back().norm(), 1e-9);
  for (std::size_t i = 1; i < motion.time_s.size(); ++i) {
    const double change = (motion.accelerations[i] - motion.accelerations[i - 1]).norm();
    EXPECT_LE(change, 1.001 * acceleration / smoothing_s * kMillisecond);
  }
  EXPECT_NEAR(timing.duration_s(), trapezoid_s(1.0, 1.0, acceleration) + smoothing_s, 5e-3);
}

TEST(PathTiming, HasNoJumpsOfAccelerationWhenItSmooths) {
  for (unsigned seed = 0; seed < (kSanitized ? 2 : 20); ++seed) {
    const RandomTask task(seed);
    const PathTiming timing(*task.robot, task.waypoints, task.limits, {.smoothing_s = 0.05});
    const auto largest_change = [&](double step_s) {
      const TimedPath motion = timing.sampled(step_s);
      double result = 0.0;
      for (std::size_t i = 1; i < motion.time_s.size(); ++i) {
        result = std::max(result, (motion.accelerations[i] - motion.accelerations[i - 1]).norm());
      }
      return result;
    };
    EXPECT_LT(largest_change(1e-4), 0.2 * largest_change(1e-3)) << seed;
  }
}

/// Up against gravity, down is nowhere: force / mass within 10, gravity 6.
TEST(PathTiming, TakesRowsOfForces) {
  const Robot robot = slides(1);
  const auto rows = [](const PathPoint& point) {
    return TimingRows{numbers({point.first[0], -point.first[0]}),
                      numbers({point.second[0], -point.second[0]}), numbers({10 - 6, 10 + 6})};
  };
  const PathTiming timing(robot, {numbers({0}), numbers({1})},
                          even_limits(robot, kUnlimited, 100.0), {}, rows);
  const double best = std::sqrt(2.0 * (1.0 / 4.0 + 1.0 / 16.0));
  EXPECT_NEAR(timing.duration_s(), best, 2e-3 * best);
}

/// COMAN+ hung up by its base, arms and legs all over the place.
TEST(PathTiming, KeepsTorquesWithinEffortLimits) {
  const std::string model =
      std::string(LOCOGRAPH_SOURCE_DIR) + "/robots/models/coman_plus/coman_plus";
  const Robot robot = Robot::load(model + ".urdf", model + ".srdf", {.floating_base = false});
  const TimingLimits limits = timing_limits(robot, {.joint_acceleration_rad_s2 = 200.0});
  std::mt19937_64 random(5);
  std::vector<Eigen::VectorXd> way;
  for (int i = 0; i < 4; ++i) {
    way.push_back(robot.named_configuration("home"));
    for (double& q : way.back()) q += uniform(random, -0.5, 0.5);
  }
  const double scale = 0.6;
  const auto largest_torque = [&](const TimedPath& motion) {
    RobotState state(robot);
    RobotDynamics dynamics(robot);
    Eigen::VectorXd torques(robot.tangent_size());
    double result = 0.0;
    for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
      state.update(motion.configurations[i].data());
      dynamics.inverse_dynamics(state, motion.velocities[i], motion.accelerations[i], {}, torques);
      for (int k = 0; k < robot.active_joint_count(); ++k) {
        const double ratio = std::abs(torques[k]) / (scale * robot.active_joint(k).max_effort);
        result = std::max(result, ratio);
      }
    }
    return result;
  };
  const PathTiming free(robot, way, limits);
  EXPECT_GT(largest_torque(free.sampled(kMillisecond)), 1.2);
  for (const double smoothing_s : {0.0, 0.03}) {
    const PathTiming timing(robot, way, limits, {.smoothing_s = smoothing_s},
                            effort_rows(robot, scale));
    ASSERT_TRUE(timing.answer().success());
    const TimedPath motion = timing.sampled(kMillisecond);
    const double torque = largest_torque(motion);
    EXPECT_LE(torque, 1.0 + 1e-6);
    EXPECT_GT(torque, 0.9);
    EXPECT_GT(motion.duration_s, free.duration_s());
    EXPECT_LE(seen(motion, limits).acceleration, 1.0 + 1e-6);
  }
  EXPECT_FALSE(PathTiming(robot, way, limits, {}, effort_rows(robot, 0.01)).answer().success());
  EXPECT_THROW(effort_rows(robot, 0.0), Error);
  EXPECT_THROW(effort_rows(slides(1, true)), Error);
}

TEST(PathTiming, SaysWhenRowsLeaveNoMotion) {
  const Robot robot = slides(1);
  const std::vector<Eigen::VectorXd> way{numbers({0}), numbers({1})};
  const TimingLimits limits = even_limits(robot, 1.0, 1.0);
  const auto never = [](const PathPoint&) {
    return TimingRows{numbers({0}), numbers({0}), numbers({-1})};
  };
  const PathTiming timing(robot, way, limits, {}, never);
  EXPECT_EQ(timing.answer().status, PlannerStatus::kInfeasible);
  EXPECT_NE(timing.answer().reason.find("rows leave no motion"), std::string::npos);
  EXPECT_THROW(timing.duration_s(), Error);
  EXPECT_THROW(timing.at(0.0), Error);
  // Faster at the middle than the way to there allows.
  const auto too_fast = [](const PathPoint& point) {
    const bool middle = std::abs(point.first[0] * (point.s - 0.5)) < 0.1;
    return TimingRows{numbers({0}), numbers({-1}), numbers({middle ? -100.0 : 0.0})};
  };
  EXPECT_FALSE(PathTiming(robot, way, limits, {}, too_fast).answer().success());
}

TEST(PathTiming, StaysNearTheStraightWaysAndDoesNotStopAtCorners) {
  const Robot robot = slides(2);
  const TimingLimits limits = even_limits(robot, 1.0, 5.0);
  const std::vector<Eigen::VectorXd> corner{numbers({0, 0}), numbers({1, 0}), numbers({1, 1})};
  double before_s = 0.0;
  for (const double deviation : {0.1, 0.01, 0.001}) {
    const PathTiming timing(robot, corner, limits, {.max_deviation = deviation});
    const TimedPath motion = timing.sampled(kMillisecond);
    for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
      const Eigen::VectorXd& q = motion.configurations[i];
      EXPECT_LE(std::min(std::abs(q[1]), std::abs(q[0] - 1.0)), deviation + 1e-12);
      const bool end = i == 0 || i + 1 == motion.time_s.size();
      EXPECT_TRUE(end || motion.velocities[i].norm() > 0.0);
    }
    const Extremes found = seen(motion, limits);
    EXPECT_LE(found.velocity, 1.0 + 1e-6);
    EXPECT_LE(found.acceleration, 1.0 + 1e-6);
    EXPECT_GT(timing.duration_s(), before_s);
    before_s = timing.duration_s();
  }
  EXPECT_LT(before_s, 2.0 * trapezoid_s(1.0, 1.0, 5.0) + 1e-9);
}

// ---- with a floating base ----

Eigen::VectorXd somewhere(const Robot& robot, std::mt19937_64& random,
                          const Eigen::VectorXd& from) {
  Eigen::VectorXd step(robot.tangent_size()), result(robot.configuration_size());
  for (double& value : step) value = uniform(random, -0.6, 0.6);
  robot.integrate(from.data(), step.data(), result.data());
  if (random() % 2 == 0) result.segment<4>(3) *= -1.0;
  return result;
}

std::vector<Eigen::VectorXd> wandering(const Robot& robot, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<Eigen::VectorXd> way{robot.neutral_configuration()};
  for (int i = 0; i < 6; ++i) way.push_back(somewhere(robot, random, way.back()));
  return way;
}

TEST(PathSpline, HasDerivativesOfAFloatingBase) {
  const Robot robot = slides(2, true);
  const PathSpline path(robot, wandering(robot, 1), Eigen::VectorXd::Ones(robot.tangent_size()));
  PathPoint before, here, after;
  Eigen::VectorXd difference(robot.tangent_size());
  const double h = 1e-5;
  for (int i = 1; i < 50; ++i) {
    const double s = path.length() * i / 50.0;
    path.at(s - h, before);
    path.at(s, here);
    path.at(s + h, after);
    robot.difference(before.configuration.data(), after.configuration.data(), difference.data());
    // `difference` is in the axes of `before`, a half of it away.
    const Eigen::Vector3d half = 0.5 * difference.segment<3>(3);
    difference.head<3>() -= half.cross(difference.head<3>());
    EXPECT_LT((difference / (2.0 * h) - here.first).norm(), 1e-6);
    EXPECT_LT(((after.first - before.first) / (2.0 * h) - here.second).norm(), 1e-4);
    EXPECT_NEAR(here.configuration.segment<4>(3).norm(), 1.0, 1e-12);
  }
}

TEST(PathSpline, IsContinuousToTheSecondDerivativeAndMeetsItsWaypoints) {
  const Robot robot = slides(2, true);
  const std::vector<Eigen::VectorXd> way = wandering(robot, 2);
  const PathSpline path(robot, way, Eigen::VectorXd::Ones(robot.tangent_size()));
  ASSERT_EQ(path.knots().size(), way.size());
  PathPoint before, after;
  Eigen::VectorXd difference(robot.tangent_size());
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    path.at(path.knots()[i] - 1e-9, before);
    path.at(path.knots()[i] + 1e-9, after);
    EXPECT_LT((before.first - after.first).norm(), 1e-6);
    EXPECT_LT((before.second - after.second).norm(), 1e-5);
    path.at(path.knots()[i], before);
    robot.difference(way[i].data(), before.configuration.data(), difference.data());
    EXPECT_LT(difference.norm(), 1e-9);
  }
}

/// Largest distance to a circle of radius 1 through which waypoints go, a turn of 1.5 rad in all.
double largest_distance_to_circle(int waypoints) {
  const Robot robot = slides(2);
  std::vector<Eigen::VectorXd> way;
  for (int i = 0; i < waypoints; ++i) {
    const double angle = 1.5 * i / (waypoints - 1);
    way.push_back(numbers({std::cos(angle), std::sin(angle)}));
  }
  const PathSpline path(robot, way, Eigen::VectorXd::Ones(robot.tangent_size()));
  PathPoint point;
  double result = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    path.at(path.length() * i / 1000.0, point);
    result = std::max(result, std::abs(point.configuration.norm() - 1.0));
  }
  return result;
}

/// An error of second order, as of ends that do not bend, would shrink by 4.
TEST(PathSpline, FollowsACurveToTheFourthOrderUpToItsEnds) {
  EXPECT_LT(largest_distance_to_circle(9), 1e-4);
  EXPECT_LT(largest_distance_to_circle(17), largest_distance_to_circle(9) / 12.0);
  EXPECT_LT(largest_distance_to_circle(33), largest_distance_to_circle(17) / 12.0);
}

TEST(PathSpline, IsStraightThroughTwoWaypointsAndAParabolaThroughThree) {
  const Robot robot = slides(1);
  PathPoint point;
  const PathSpline two(robot, {numbers({0}), numbers({2})}, numbers({1}));
  const PathSpline three(robot, {numbers({0}), numbers({2}), numbers({1})}, numbers({1}));
  for (const double s : {0.0, 0.7, 2.0, 2.9}) {
    two.at(s, point);
    EXPECT_NEAR(point.configuration[0], std::min(s, 2.0), 1e-12);
    three.at(s, point);
    EXPECT_NEAR(point.configuration[0], s - (s - 2.0) * s * 2.0 / 3.0, 1e-12);
  }
}

/// The judge's own word on velocities and accelerations, whatever it says of the rest. Only
/// smoothed timings: where an acceleration jumps within a step, the cubic of that step goes beyond
/// it. Where its slope jumps, the cubic of 1 ms goes beyond by up to 1e-4.
TEST(PathTiming, SatisfiesTheJudgeWithAFloatingBase) {
  const auto shared = std::make_shared<const Robot>(slides(2, true));
  const Robot& robot = *shared;
  const Judge judge(shared, World());
  CheckOptions options;
  options.base_linear_m_s = 0.4;
  options.base_angular_rad_s = 0.3;
  options.joint_acceleration_rad_s2 = 3.0;
  const TimingLimits limits = timing_limits(
      robot,
      {.base_linear_m_s = 0.4, .base_angular_rad_s = 0.3, .joint_acceleration_rad_s2 = 2.999});
  EXPECT_EQ(limits.velocity[6], 2.0);
  for (unsigned seed = 0; seed < (kSanitized ? 4 : 20); ++seed) {
    const double smoothing_s = seed % 2 == 0 ? 0.1 : 0.05;
    const PathTiming timing(robot, wandering(robot, seed), limits, {.smoothing_s = smoothing_s});
    TimedPath sampled = timing.sampled(kMillisecond);
    Motion motion;
    motion.time_s = sampled.time_s;
    motion.configurations = sampled.configurations;
    for (std::size_t i = 0; i < sampled.time_s.size(); ++i) {
      const Eigen::VectorXd& q = sampled.configurations[i];
      Eigen::VectorXd& slope = motion.slopes.emplace_back(sampled.velocities[i]);
      slope.head<3>() = Eigen::Quaterniond(Eigen::Vector4d(q.segment<4>(3))) *
                        Eigen::Vector3d(sampled.velocities[i].head<3>());
    }
    Contact somewhere;  // the judge asks for one
    somewhere.effector = {
        .link = "l1", .kind = ContactKind::kPoint, .friction = 1.0, .max_force_N = 1.0};
    motion.stances = {{{somewhere}}};
    motion.stance_from.assign(motion.time_s.size(), 0);
    const CheckReport report = judge.check(motion, options);
    double fastest = 0.0;
    for (const Violation& row : report.violations) {
      if (row.constraint != "velocity_limits" && row.constraint != "base_velocity" &&
          row.constraint != "acceleration_limits") {
        continue;
      }
      EXPECT_TRUE(row.judged) << row.constraint;
      EXPECT_FALSE(row.violated) << row.constraint << " " << row.worst << " seed " << seed;
      fastest = std::max(fastest, row.worst);
    }
    EXPECT_GT(fastest, 0.97) << seed;
  }
}

TEST(PathTiming, KeepsLimitsOfTheBaseInItsOwnAxes) {
  const Robot robot = slides(1, true);
  TimingLimits limits = even_limits(robot, 0.5, 0.7);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const PathTiming timing(robot, wandering(robot, seed), limits);
    const TimedPath motion = timing.sampled(kMillisecond);
    for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
      EXPECT_LE(motion.velocities[i].cwiseAbs().maxCoeff(), 0.5 * (1.0 + 1e-6)) << seed;
      EXPECT_LE(motion.accelerations[i].cwiseAbs().maxCoeff(), 0.7 * (1.0 + 1e-6)) << seed;
    }
  }
}

// ---- mistakes ----

template <class Call>
void expect_timing_error(const std::string& words, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "no Error about " << words;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(PathTiming, RefusesWhatMakesNoSense) {
  const Robot robot = slides(2);
  const TimingLimits good = even_limits(robot, 1.0, 1.0);
  const std::vector<Eigen::VectorXd> way{numbers({0, 0}), numbers({1, 1})};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto time = [&](std::vector<Eigen::VectorXd> waypoints, const TimingLimits& limits,
                        const TimingOptions& options = {}, const TimingRowsAt& rows = {}) {
    return [=, &robot] { PathTiming(robot, waypoints, limits, options, rows); };
  };
  expect_timing_error("a path of 0 waypoints", time({}, good));
  expect_timing_error("a path of 1 waypoints", time({way[0]}, good));
  expect_timing_error("waypoints 1 and 2 are equal", time({way[0], way[1], way[1]}, good));
  expect_timing_error("waypoint 1 is not finite", time({way[0], numbers({nan, 0})}, good));
  expect_timing_error("waypoint 0 has 1 numbers", time({numbers({1}), way[1]}, good));
  for (const double bad : {0.0, -1.0, nan}) {
    TimingLimits limits = good;
    limits.velocity[1] = bad;
    expect_timing_error("velocity of joint j1", time(way, limits));
    limits = good;
    limits.acceleration[0] = bad;
    expect_timing_error("acceleration of joint j0", time(way, limits));
    expect_timing_error("a deviation of", time(way, good, {.max_deviation = bad}));
  }
  TimingLimits none = even_limits(robot, kUnlimited, kUnlimited);
  expect_timing_error("nothing limits what moves at s = 0", time(way, none));
  none.velocity.resize(1);
  expect_timing_error("1 limits of velocity, expected 2", time(way, none));
  expect_timing_error("option intervals is", time(way, good, {.intervals = 0}));
  expect_timing_error("option intervals_per_step", time(way, good, {.intervals_per_step = 0}));
  expect_timing_error("smoothing_s", time(way, good, {.smoothing_s = -1.0}));
  expect_timing_error("rows of timing of another number",
                      time(way, good, {}, [](const auto& point) {
                        return TimingRows{numbers({1}), numbers({1}),
                                          point.s > 0.0 ? numbers({1, 1}) : numbers({1})};
                      }));
  expect_timing_error("rows of timing that are not finite", time(way, good, {}, [&](const auto&) {
                        return TimingRows{numbers({nan}), numbers({1}), numbers({1})};
                      }));
  const Robot floating = slides(0, true);
  Eigen::VectorXd q = floating.neutral_configuration(), there = q;
  there.segment<4>(3).setZero();
  expect_timing_error("waypoint 1 has no orientation", [&] {
    PathTiming(floating, {q, there}, even_limits(floating, 1.0, 1.0));
  });
  expect_timing_error("a step of 0", [&] { PathTiming(robot, way, good).sampled(0.0); });
}

}  // namespace
}  // namespace locograph
