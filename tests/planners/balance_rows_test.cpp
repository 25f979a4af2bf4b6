#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>
#include <locograph/common/error.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/offline/timing/balance_rows.h>
#include <locograph/planners/offline/timing/path_timing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "common/sanitized.h"
#include "common/temporary_folder.h"
#include "planners/stance_tasks.h"

namespace locograph {
namespace {

constexpr double kMastGravity = 9.81, kOnMast_kg = 10.0, kMast_m = 0.8;

/// A mass on a mast over a plate that slides along x below it.
struct Mast {
  explicit Mast(double friction, double half_m, double effort_N = 1e4)
      : robot(load(effort_N)),
        limits{Eigen::VectorXd::Constant(robot.tangent_size(), 5.0),
               Eigen::VectorXd::Constant(robot.tangent_size(), 50.0)} {
    Contact& contact = bearing.contact;
    contact.effector = {.link = "plate",
                        .kind = ContactKind::kSurface,
                        .half_x_m = half_m,
                        .half_y_m = half_m,
                        .friction = friction,
                        .max_force_N = 1000.0};
    contact.forward = contact.effector.forward = Eigen::Vector3d::UnitX();
    contact.normal = contact.effector.normal = Eigen::Vector3d::UnitZ();
  }

  static Robot load(double effort_N) {
    const test::TemporaryFolder folder;
    const std::string inertia =
        "<inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4' iyz='0' izz='1e-4'/>";
    const auto urdf = folder.write(
        "mast.urdf",
        "<robot name='mast'><link name='top'><inertial><mass value='10'/>" + inertia +
            "</inertial></link><link name='plate'><inertial><mass value='1e-3'/>" + inertia +
            "</inertial></link><joint name='slide' type='prismatic'><parent link='top'/><child "
            "link='plate'/><origin "
            "xyz='0 0 -0.8'/><axis xyz='1 0 0'/><limit lower='-9' upper='9' velocity='5' effort='" +
            std::to_string(effort_N) + "'/></joint></robot>");
    return Robot::load(urdf, {}, {});
  }

  /// The mass moves, the plate stays.
  std::vector<Eigen::VectorXd> way(double from_m, double to_m) const {
    std::vector<Eigen::VectorXd> result(2, robot.neutral_configuration());
    result[0].head<3>() << from_m, 0.0, kMast_m;
    result[1].head<3>() << to_m, 0.0, kMast_m;
    result[0][7] = -from_m;
    result[1][7] = -to_m;
    return result;
  }

  PathTiming timing(double from_m, double to_m, const BalanceRowsOptions& options = {}) const {
    BalanceRows balance(robot, std::span(&bearing, 1), options);
    const PathSpline path = timing_path(robot, way(from_m, to_m), limits);
    return {path, limits, {}, balance.along(path, limits)};
  }

  Robot robot;
  TimingLimits limits;
  BearingContact bearing;
};

/// The least margin of the judge's programme, each millisecond.
double least_margin(const Robot& robot, const PathTiming& timing,
                    const std::vector<Contact>& contacts, double effort_scale, bool at_rest) {
  BalanceOptions options;
  options.enforce_torque_limits = effort_scale > 0.0;
  if (effort_scale > 0.0) options.effort_scale = effort_scale;
  const auto steps = static_cast<int>(std::ceil(timing.duration_s() / 1e-3));
  double result = 1.0;
  for (int i = 0; i <= steps; i += at_rest ? 50 : 1) {
    const TimedPoint now = timing.at(timing.duration_s() * i / steps);
    if (!at_rest) options.motion = BalanceMotion{now.velocity, now.acceleration};
    result = std::min(result, certify_balance(robot, now.configuration, contacts, options).margin);
  }
  return result;
}

/// From rest to rest with one and the same acceleration, there and back.
double shortest_s(double way_m, double acceleration) {
  return 2.0 * std::sqrt(way_m / acceleration);
}

TEST(BalanceRows, LeaveWhatFrictionLeaves) {
  const Mast mast(0.1, 1.0);
  const PathTiming timing = mast.timing(-0.25, 0.25);
  ASSERT_TRUE(timing.answer().success());
  EXPECT_GT(timing.duration_s(), shortest_s(0.5, 0.1 * kMastGravity));
  // The margin, and a pyramid of eight edges inside the cone.
  const double most = 0.9 * 0.98 * 0.1 * std::cos(std::numbers::pi / 8.0) * kMastGravity;
  EXPECT_NEAR(timing.duration_s(), shortest_s(0.5, most), 0.01 * timing.duration_s());
}

/// The mass must not tip over the edge: z x'' <= g (x + half) when it begins.
TEST(BalanceRows, LeaveWhatTheEdgesOfAPlateLeave) {
  const Mast mast(1.0, 0.1);
  const PathTiming timing = mast.timing(-0.02, 0.02);
  ASSERT_TRUE(timing.answer().success());
  EXPECT_LT(timing.duration_s(), shortest_s(0.04, kMastGravity / kMast_m * 0.9 * 0.08));
  EXPECT_GT(timing.duration_s(), shortest_s(0.04, kMastGravity / kMast_m * 0.12));
  EXPECT_GE(least_margin(mast.robot, timing, {mast.bearing.contact}, 0.0, false), 0.0);
}

TEST(BalanceRows, LeaveWhatEffortsLeave) {
  const Mast mast(1.0, 1.0, 5.0);
  const PathTiming timing = mast.timing(-0.1, 0.1, {.effort_scale = 0.8});
  ASSERT_TRUE(timing.answer().success());
  const double best = shortest_s(0.2, 0.9 * 0.8 * 5.0 / kOnMast_kg);
  EXPECT_NEAR(timing.duration_s(), best, 0.01 * best);
  EXPECT_LT(mast.timing(-0.1, 0.1).duration_s(), 0.5 * best);
}

TEST(BalanceRows, LeaveAWayWhereTheMarginIsUsedUpAtRest) {
  const Mast mast(1.0, 0.1);
  for (const double end_m : {0.05, 0.09, 0.095, 0.099}) {
    const PathTiming timing = mast.timing(0.0, end_m);
    ASSERT_TRUE(timing.answer().success()) << end_m;
    EXPECT_GE(least_margin(mast.robot, timing, {mast.bearing.contact}, 0.0, false), 0.0) << end_m;
    EXPECT_LT(timing.duration_s(), 5.0) << end_m;
  }
  EXPECT_FALSE(mast.timing(0.0, 0.15).answer().success());
}

TEST(BalanceRows, ServeOnePathAfterTheOther) {
  const Mast mast(0.1, 0.1);
  BalanceRows balance(mast.robot, std::span(&mast.bearing, 1));
  for (const double end_m : {0.01, 0.08, -0.05}) {
    const PathSpline path = timing_path(mast.robot, mast.way(0.0, end_m), mast.limits);
    const PathTiming again(path, mast.limits, {}, balance.along(path, mast.limits));
    const double alone_s = mast.timing(0.0, end_m).duration_s();
    EXPECT_NEAR(again.duration_s(), alone_s, 1e-3 * alone_s);
  }
}

/// COMAN+ on its feet, arms thrown about as fast as joints can: it falls, but for the rows.
TEST(BalanceRows, KeepAHumanoidBalancedThatThrowsItsArms) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const Task task = test::stance_task("quadrupedal_walking");
  const Robot& robot = *task.robot->robot;
  const TimingLimits limits = timing_limits(robot, {.joint_acceleration_rad_s2 = 20.0});
  std::vector<BearingContact> bearing;
  std::vector<bool> stands(static_cast<std::size_t>(robot.active_joint_count()), false);
  for (const Contact& contact : task.start.contacts) {
    bearing.push_back({contact});
    for (const int axis : robot.support(robot.link_index(contact.effector.link))) {
      const Axis& above = robot.axes()[static_cast<std::size_t>(axis)];
      stands[static_cast<std::size_t>(above.active)] = true;
    }
  }
  int judged = 0, fell = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<Eigen::VectorXd> way;
    for (int i = 0; i < 4; ++i) {
      way.push_back(task.start_configuration);
      for (int k = 0; k < robot.active_joint_count(); ++k) {
        if (stands[static_cast<std::size_t>(k)]) continue;
        way.back()[robot.base_configuration_size() + k] += i * uniform(random, -0.2, 0.2);
      }
    }
    const double effort_scale = seed % 2 == 0 ? 0.0 : 1.0;
    const TimingOptions options{.intervals = 200, .smoothing_s = seed % 4 < 2 ? 0.04 : 0.0};
    const PathSpline path = timing_path(robot, way, limits);
    const PathTiming free(path, limits, options);
    const auto margin = [&](const PathTiming& timing, bool at_rest) {
      return least_margin(robot, timing, task.start.contacts, effort_scale, at_rest);
    };
    if (margin(free, true) < 0.01) continue;  // not balanced at rest, or hardly
    ++judged;
    fell += margin(free, false) < 0.0;
    BalanceRows balance(robot, bearing, {.effort_scale = effort_scale});
    const PathTiming timing(path, limits, options, balance.along(path, limits));
    ASSERT_TRUE(timing.answer().success()) << seed;
    EXPECT_GE(margin(timing, false), 0.0) << seed;
    EXPECT_LT(timing.duration_s(), 3.0 * free.duration_s()) << seed;
  }
  EXPECT_GE(judged, 6);
  EXPECT_GE(fell, 3);
}

TEST(BalanceRows, RefuseWhatMakesNoSense) {
  const Mast mast(0.1, 0.1);
  const std::span<const BearingContact> bearing(&mast.bearing, 1);
  for (const double margin : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(BalanceRows(mast.robot, bearing, {.margin = margin}), Error) << margin;
  }
  EXPECT_THROW(BalanceRows(mast.robot, bearing, {.effort_scale = -1.0}), Error);
  EXPECT_THROW(BalanceRows(mast.robot, bearing, {.pieces = 0}), Error);
  EXPECT_THROW(BalanceRows(mast.robot, bearing, {.looks = 0}), Error);
  EXPECT_THROW(BalanceRows(mast.robot, {}), Error);
}

}  // namespace
}  // namespace locograph
