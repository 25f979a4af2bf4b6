// A walk that something carries out.
#include <locograph/check/motion_curve.h>
#include <locograph/common/error.h>
#include <locograph/planners/online/walk_ahead.h>

#include <algorithm>

#include "common/sanitized.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace {

constexpr double kEvery_s = 0.25;

/// Carries the shipped drive out while a world shows up at a time of it.
class CarriedOut : public testing::Test {
 protected:
  Graph graph = drive();
  const std::shared_ptr<const Robot> robot = plan_of(graph).robot->robot;
  const Motion planned = motion_of(graph, plan_of(graph));
  Motion motion = planned;
  double now_s = 0.0;
  int changes = 0;

  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "takes long there";
  }

  WalkReport carry_out(const std::vector<Obstacle>& obstacles, double seen_at_s) {
    const auto world = seeing(obstacles);
    WalkOptions options = walk_options_for(plan_of(graph));
    options.verify = [&](const Motion& step) {
      return check_step(robot, step,
                        world_of(now_s < seen_at_s ? std::vector<Obstacle>() : obstacles, nullptr));
    };
    bool shown = false;
    WalkAhead walk(
        graph,
        [&](int) { return now_s < seen_at_s || std::exchange(shown, true) ? nullptr : world; },
        options);
    for (; now_s <= motion.time_s.back(); now_s += kEvery_s) {
      if (std::optional<Motion> changed = walk.at(now_s)) take(std::move(*changed));
    }
    EXPECT_TRUE(walk.over());
    return walk.report();
  }

 private:
  /// What was carried out is as it was, to the last bit: the curve up to now.
  void take(Motion changed) {
    const auto next = std::ranges::lower_bound(motion.time_s, now_s) - motion.time_s.begin();
    ASSERT_LT(next, std::ssize(changed.time_s));
    for (std::ptrdiff_t i = 0; i <= next; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_EQ(changed.time_s[at], motion.time_s[at]) << i << " at " << now_s;
      EXPECT_EQ(changed.configurations[at], motion.configurations[at]) << i << " at " << now_s;
      EXPECT_EQ(changed.slopes[at], motion.slopes[at]) << i << " at " << now_s;
    }
    motion = std::move(changed);
    ++changes;
  }
};

TEST_F(CarriedOut, ADriveInAnEmptyWorldArrives) {
  const WalkReport report = carry_out({}, 0.0);
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_EQ(motion.configurations.size(), planned.configurations.size());
}

TEST_F(CarriedOut, ADriveGetsPastABoxThatShowsUp) {
  const Obstacle obstacle = box("box", {2.3, 0.0, 0.25}, {0.5, 0.5, 0.5});
  const WalkReport report = carry_out({obstacle}, 2.0);
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_GT(changes, 10);
  expect_feasible(check_plan(graph, {obstacle}, nullptr));
}

TEST_F(CarriedOut, ARobotThatHasToStopBrakesAfterWhatItHasDone) {
  const Obstacle wall = box("wall", {3.2, 0.0, 0.5}, {0.2, 8.0, 1.0});
  const WalkReport report = carry_out({wall}, 14.0);
  EXPECT_FALSE(report.success());
  EXPECT_TRUE(report.at_rest) << report.reason;
  const MotionCurve curve(*robot, motion);
  const int last = static_cast<int>(motion.configurations.size()) - 1;
  EXPECT_LT(curve.slope(last).cwiseAbs().maxCoeff(), 1e-9);
  expect_feasible(check_plan(graph, {wall}, nullptr));
}

TEST_F(CarriedOut, ALeadIsAboveZero) { EXPECT_THROW(WalkAhead(graph, nullptr, {}, 0.0), Error); }

}  // namespace
}  // namespace locograph
