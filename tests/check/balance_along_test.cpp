// Balance along whole motions: the same report by all linear programmes, by those that are needed,
// and by any number of threads.
#include <gtest/gtest.h>
#include <locograph/robots/statics.h>

#include <cmath>

#include "check/centauro_on_wheels.h"
#include "check/coman_plus_standing.h"
#include "common/sanitized.h"

namespace locograph {
namespace {

using test::standing;

constexpr int kVertices = test::kSanitized ? 12 : 50;

/// Swings its arms by so much; with a second stance of the same feet from the middle on, and if it
/// is to fall over one foot only at the end.
Motion arms(int vertices, double amplitude, bool falls = false) {
  Motion motion;
  motion.stances = {standing().feet, standing().feet, standing().feet};
  motion.stances[2].contacts.pop_back();
  for (int i = 0; i < vertices; ++i) {
    const double time = 0.02 * i, angle = amplitude * std::pow(std::sin(2.0 * time), 2);
    motion.time_s.push_back(time);
    motion.stance_from.push_back(i < vertices / 2 ? 0 : i < vertices - 5 || !falls ? 1 : 2);
    motion.configurations.push_back(standing().home);
    for (const char* joint : {"LShSag", "RShSag", "WaistYaw"})
      motion.configurations.back()[standing().index(joint)] += angle;
  }
  return motion;
}

void expect_same(const CheckReport& one, const CheckReport& other) {
  EXPECT_EQ(one.feasible, other.feasible);
  EXPECT_EQ(one.samples, other.samples);
  EXPECT_EQ(one.min_balance_margin, other.min_balance_margin);
  EXPECT_EQ(one.max_torque_ratio, other.max_torque_ratio);
  EXPECT_EQ(one.min_clearance_m, other.min_clearance_m);
  EXPECT_EQ(one.min_self_clearance_m, other.min_self_clearance_m);
  ASSERT_EQ(one.violations.size(), other.violations.size());
  for (std::size_t i = 0; i < one.violations.size(); ++i) {
    const Violation &a = one.violations[i], &b = other.violations[i];
    EXPECT_EQ(a.worst, b.worst) << a.constraint;
    EXPECT_EQ(a.at_vertex, b.at_vertex) << a.constraint;
    EXPECT_EQ(a.count, b.count) << a.constraint;
    EXPECT_EQ(a.time_s, b.time_s) << a.constraint;
    EXPECT_EQ(a.at_point, b.at_point) << a.constraint;
    EXPECT_EQ(a.what, b.what) << a.constraint;
    EXPECT_EQ(a.violated, b.violated) << a.constraint;
    EXPECT_EQ(a.why_not, b.why_not) << a.constraint;
  }
  ASSERT_EQ(one.balance.has_value(), other.balance.has_value());
  if (!one.balance) return;
  EXPECT_EQ(one.balance->margin, other.balance->margin);
  EXPECT_EQ(one.balance->limiting, other.balance->limiting);
  EXPECT_EQ(one.balance->wrenches, other.balance->wrenches);
}

/// By several threads, and by all programmes.
void expect_one_report(const Judge& judge, const Motion& motion, CheckOptions options) {
  const CheckReport report = judge.check(motion, options);
  ASSERT_TRUE(report.constraint("static_balance").judged);
  options.prove_nearby = false;
  expect_same(report, judge.check(motion, options));
  for (const int threads : {2, 3}) {
    for (const bool prove_nearby : {true, false}) {
      options.threads = threads;
      options.prove_nearby = prove_nearby;
      expect_same(report, judge.check(motion, options));
    }
  }
}

TEST(BalanceAlong, ReportsTheSameWithoutTheProgrammesThatAreNotNeeded) {
  const Judge judge(standing().robot, standing().world());
  for (const bool falls : {false, true}) {
    for (const bool enforce : {true, false}) {
      CheckOptions options;
      options.enforce_torque_limits = enforce;
      const Motion motion = arms(kVertices, falls ? 1.0 : 0.01, falls);
      EXPECT_EQ(judge.check(motion, options).constraint("static_balance").violated, falls);
      expect_one_report(judge, motion, options);
    }
  }
}

TEST(BalanceAlong, ReportsTheSameOfWheelsAndOfLimitsOnlyJustKept) {
  const Motion drive = centauro().drive(test::kSanitized ? 8 : 40, 0.02, 0.1);
  World world;
  world.surfaces = {ground()};
  world.obstacles = {box("post", {0.9, 0.75, 0.5}, {0.1, 0.1, 1.0})};
  const Judge judge(centauro().shared, world);
  expect_one_report(judge, drive, {});
  CheckOptions options;
  options.min_balance_margin = judge.check(drive).min_balance_margin.value() + 1e-3;
  expect_one_report(judge, drive, options);
  options.min_balance_margin = 0.0;
  options.effort_scale = judge.check(drive).max_torque_ratio.value() * 0.999;
  expect_one_report(judge, drive, options);
}

TEST(BalanceAlong, TellsTheWrenchesOfEveryVertexInOrder) {
  const Judge judge(standing().robot, standing().world());
  const Motion motion = arms(50, 0.05);
  CheckOptions options;
  const CheckReport quiet = judge.check(motion, options);
  for (const int threads : {1, 3}) {
    int next = 0;
    options.threads = threads;
    options.on_balance = [&](int vertex, const StanceWrenches& wrenches) {
      EXPECT_EQ(vertex, next++);
      const int stance = motion.stance_from[std::size_t(vertex)];
      const std::vector<Contact>& contacts = motion.stances[std::size_t(stance)].contacts;
      ASSERT_EQ(wrenches.size(), contacts.size());
      double pressing_N = 0.0;
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        EXPECT_LE(wrenches[k].head<2>().norm(), contacts[k].effector.friction * wrenches[k][2]);
        pressing_N += wrenches[k][2];
      }
      const double weight_N = standing().robot->total_mass() * standard_gravity().norm();
      EXPECT_NEAR(pressing_N, weight_N, 0.05 * weight_N);
    };
    expect_same(quiet, judge.check(motion, options));
    EXPECT_EQ(next, 50);
  }
}

TEST(BalanceAlong, EndsWithItsJobOnSeveralThreads) {
  const Judge judge(standing().robot, standing().world());
  CheckOptions options;
  options.threads = 3;
  for (const std::string last :
       {"judging contacts", "judging self-collisions", "judging balance"}) {
    JobControl ended;
    ended.report = [&](std::string_view part, double) {
      if (part == last) ended.termination.deadline = Deadline::after(0.0);
    };
    EXPECT_FALSE(judge.check(arms(75, 0.05), options, ended)) << last;
  }
}

}  // namespace
}  // namespace locograph
