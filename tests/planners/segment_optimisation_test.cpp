#include <gtest/gtest.h>
#include <locograph/planners/offline/motion/interpolation.h>
#include <locograph/planners/offline/motion/optimisation.h>

#include <algorithm>

#include "common/sanitized.h"
#include "planners/segment_problems.h"

namespace locograph {
namespace {

/// What every path promises, looked at more densely than the planner does.
void expect_optimised(SegmentSpace& space, const SegmentPath& path) {
  ASSERT_TRUE(path.success()) << path.reason;
  ASSERT_GE(path.waypoints.size(), 2u);
  EXPECT_EQ(path.waypoints.front(), space.segment().from);
  EXPECT_EQ(path.waypoints.back(), space.segment().to);
  Eigen::VectorXd error;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    const Eigen::VectorXd& q = path.waypoints[i];
    space.closure(q, error);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-8) << i;
    if (i + 1 < path.waypoints.size()) {
      EXPECT_TRUE(space.valid(q, true)) << i << ": " << space.why_not();
    }
    EXPECT_TRUE(space.valid_between(path.waypoints[i - 1], q, 0.02, true)) << space.why_not();
  }
}

double optimised_length(const SegmentSpace& space, const SegmentPath& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    sum += space.distance(path.waypoints[i - 1], path.waypoints[i]);
  }
  return sum;
}

TEST(SegmentOptimisation, GoesStraightWhereNothingIsInTheWay) {
  const auto problem = test::segment_problem("board");
  problem->world.solids.clear();
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  const SegmentPath path = make_optimisation()->plan(space, {});
  expect_optimised(space, path);
  EXPECT_LT(optimised_length(space, path),
            1.1 * space.distance(space.segment().from, space.segment().to));
}

TEST(SegmentOptimisation, GoesRoundABoardWhereInterpolationFindsNoWay) {
  const auto problem = test::segment_problem("board");
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  EXPECT_FALSE(make_interpolation()->plan(space, {}).success());
  const SegmentPath path = make_optimisation()->plan(space, {});
  expect_optimised(space, path);
  EXPECT_LT(optimised_length(space, path),
            4.0 * space.distance(space.segment().from, space.segment().to));
}

TEST(SegmentOptimisation, GoesOutOfOneWindowAndInAtTheOther) {
  const auto problem = test::segment_problem("windows");
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  expect_optimised(space, make_optimisation()->plan(space, {}));
}

TEST(SegmentOptimisation, WhatSwingsFollowsAnArc) {
  const auto problem = test::step_forward_problem();
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  const SegmentPath path = make_optimisation()->plan(space, {});
  expect_optimised(space, path);
  const EndEffector& foot = problem->segment.left.front().effector;
  RobotState state(space.robot());
  const auto place = [&](const Eigen::VectorXd& q) -> Eigen::Vector3d {
    state.update(q.data());
    return state.world_from_link(space.robot().link_index(foot.link)) * foot.point;
  };
  const Eigen::Vector3d from = place(path.waypoints.front()), to = place(path.waypoints.back());
  int in_the_air = 0;
  for (const Eigen::VectorXd& q : path.waypoints) {
    const Eigen::Vector3d at = place(q);
    const double gone = (at.x() - from.x()) / (to.x() - from.x());
    if (gone < 0.2 || gone > 0.8) continue;
    EXPECT_GT(at.z() - from.z(), 0.03) << gone;
    ++in_the_air;
  }
  EXPECT_GT(in_the_air, 5);
}

TEST(SegmentOptimisation, TheSamePathEveryTime) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const auto problem = test::segment_problem("board");
  SegmentSpace first(problem->robot, problem->world), second(problem->robot, problem->world);
  first.set_segment(problem->segment);
  second.set_segment(problem->segment);
  const auto planner = make_optimisation();
  const SegmentPath a = planner->plan(first, {}), b = planner->plan(second, {});
  const SegmentPath again = planner->plan(first, {});
  ASSERT_TRUE(a.success());
  EXPECT_EQ(a.waypoints, b.waypoints);
  EXPECT_EQ(a.waypoints, again.waypoints);
}

TEST(SegmentOptimisation, SaysWhyThereIsNoPath) {
  const auto problem = test::segment_problem("board");
  // Too long to go round.
  problem->world.solids = {test::box_between("board", {0.25, 0.235, 0.02}, {1.5, 0.265, 2.5}),
                           test::box_between("front", {0.23, 0.05, 0.6}, {0.26, 0.265, 1.3})};
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  const SegmentPath path = make_optimisation()->plan(space, {});
  EXPECT_FALSE(path.success());
  EXPECT_TRUE(path.waypoints.empty());
  EXPECT_NE(path.reason.find(" in "), std::string::npos) << path.reason;
}

TEST(SegmentOptimisation, EndsWithTheTimeAllowed) {
  const auto problem = test::segment_problem("board");
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  SegmentOptions options;
  options.termination.deadline = Deadline::after(0.0);
  const SegmentPath path = make_optimisation()->plan(space, options);
  EXPECT_FALSE(path.success());
  EXPECT_EQ(path.reason, "the time allowed is used up (allow more)");
}

}  // namespace
}  // namespace locograph
