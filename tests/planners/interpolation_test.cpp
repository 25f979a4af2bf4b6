// The planner of segments that halves the way again and again.
#include <gtest/gtest.h>
#include <locograph/planners/offline/motion/interpolation.h>

#include <algorithm>

#include "planners/segment_problems.h"

namespace locograph::interpolation_test {
namespace {

SegmentPath path_of(const test::SegmentProblem& problem, const SegmentOptions& options = {}) {
  SegmentSpace space(problem.robot, problem.world);
  space.set_segment(problem.segment);
  return make_interpolation()->plan(space, options);
}

/// Poses of links where a path is brought back to the contacts, several times from one waypoint to
/// the next.
class ClosedWay {
 public:
  explicit ClosedWay(const test::SegmentProblem& problem)
      : space_(problem.robot, problem.world), segment_(problem.segment) {
    space_.set_segment(segment_);
  }

  template <typename Look>
  void look(const SegmentPath& path, const Look& look) {
    constexpr int kParts = 5;
    Eigen::VectorXd error;
    for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
      for (int part = 0; part < kParts; ++part) {
        Eigen::VectorXd q = space_.half_way(path.waypoints[i - 1], path.waypoints[i],
                                            static_cast<double>(part) / kParts);
        if (part > 0) {
          ASSERT_TRUE(space_.project(q));
        }
        space_.closure(q, error);
        look(space_.state());
      }
    }
  }

 private:
  SegmentSpace space_;
  const Segment& segment_;
};

TEST(InterpolationTest, StepsForwardWithTheFootClearOfTheGround) {
  const auto problem = test::step_forward_problem();
  const SegmentPath path = path_of(*problem);
  ASSERT_TRUE(path.success()) << path.reason;
  EXPECT_EQ(path.waypoints.front(), problem->segment.from);
  EXPECT_EQ(path.waypoints.back(), problem->segment.to);
  const Robot& robot = *problem->robot->robot;
  const Contact& stands = problem->segment.held[0];
  const EndEffector& foot = problem->segment.left[0].effector;
  const double from = problem->segment.left[0].position.x();
  const double to = problem->segment.reached[0].position.x();
  int in_the_air = 0;
  ClosedWay(*problem).look(path, [&](const RobotState& state) {
    const Eigen::Isometry3d& sole = state.world_from_link(robot.link_index(stands.effector.link));
    EXPECT_LT((sole * stands.effector.point - stands.position).norm(), 1e-6);
    const Eigen::Matrix3d axes = sole.linear() * axes_in_link(stands.effector);
    EXPECT_LT((axes - axes_in_world(stands)).norm(), 1e-6);

    const Eigen::Isometry3d& swings = state.world_from_link(robot.link_index(foot.link));
    const double gone = ((swings * foot.point).x() - from) / (to - from);
    double lowest = 1.0;
    for (const double x : {-foot.half_x_m, foot.half_x_m}) {
      for (const double y : {-foot.half_y_m, foot.half_y_m}) {
        const Eigen::Vector3d corner = foot.point + axes_in_link(foot) * Eigen::Vector3d(x, y, 0.0);
        lowest = std::min(lowest, (swings * corner).z());
      }
    }
    EXPECT_GT(lowest, -1e-5) << gone;
    if (gone < 0.3 || gone > 0.7) return;
    EXPECT_GT(lowest, 0.02) << gone;
    ++in_the_air;
  });
  EXPECT_GT(in_the_air, 5);
}

TEST(InterpolationTest, EveryWaypointIsClosedAndTheWayBetweenIsValid) {
  const auto problem = test::step_forward_problem();
  const SegmentPath path = path_of(*problem);
  ASSERT_TRUE(path.success()) << path.reason;
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  Eigen::VectorXd error;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    space.closure(path.waypoints[i], error);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-8) << i;
    EXPECT_TRUE(space.valid_between(path.waypoints[i - 1], path.waypoints[i], 0.02, true))
        << i << ": " << space.why_not();
  }
}

double length_of(const SegmentPath& path, const SegmentSpace& space) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    length += space.distance(path.waypoints[i - 1], path.waypoints[i]);
  }
  return length;
}

TEST(InterpolationTest, GoesStraightWhereNothingSwings) {
  const auto problem = test::segment_problem("board");
  problem->world.solids.clear();
  const SegmentPath path = path_of(*problem);
  ASSERT_TRUE(path.success()) << path.reason;
  const SegmentSpace space(problem->robot, problem->world);
  EXPECT_LT(length_of(path, space),
            1.1 * space.distance(problem->segment.from, problem->segment.to));
}

/// Over 9 cm: 2.5 rad; 3.6 rad if what was found first were kept.
TEST(InterpolationTest, StraightensTheWayOverALowWall) {
  const auto problem = test::step_forward_problem(0.26);
  const Eigen::Vector3d from = problem->segment.left[0].position;
  const double x = from.x() + 0.13;
  problem->world.solids = {
      test::box_between("wall", {x - 0.01, from.y() - 0.3, 0.0}, {x + 0.01, from.y() + 0.1, 0.09})};
  const SegmentPath path = path_of(*problem);
  ASSERT_TRUE(path.success()) << path.reason;
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  EXPECT_LT(length_of(path, space), 3.0);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    EXPECT_TRUE(space.valid_between(path.waypoints[i - 1], path.waypoints[i], 0.02, true))
        << i << ": " << space.why_not();
  }
}

TEST(InterpolationTest, FindsNothingWhereAWallLeavesNoWay) {
  const auto problem = test::segment_problem("board");
  problem->world.solids = {test::box_between("wall", {0.25, 0.235, 0.02}, {1.5, 0.265, 2.5}),
                           test::box_between("front", {0.23, 0.05, 0.6}, {0.26, 0.265, 1.3})};
  const SegmentPath path = path_of(*problem);
  EXPECT_FALSE(path.success());
  EXPECT_TRUE(path.waypoints.empty());
  EXPECT_FALSE(path.reason.empty());
}

TEST(InterpolationTest, FindsNoStepThroughAWall) {
  const auto problem = test::step_forward_problem();
  const double x = problem->segment.left[0].position.x();
  const double y = problem->segment.left[0].position.y();
  // Between both places, as high as the knee: soles overlap it.
  problem->world.solids = {
      test::box_between("wall", {x + 0.11, y - 0.3, 0.0}, {x + 0.13, y + 0.1, 0.6})};
  const SegmentPath path = path_of(*problem);
  EXPECT_FALSE(path.success());
  EXPECT_FALSE(path.reason.empty());
}

TEST(InterpolationTest, TheSamePathEveryTime) {
  const auto problem = test::step_forward_problem();
  SegmentOptions other;
  other.seed = 5;
  const SegmentPath a = path_of(*problem), b = path_of(*problem, other);
  ASSERT_TRUE(a.success());
  EXPECT_EQ(a.waypoints, b.waypoints);
}

TEST(InterpolationTest, EndsWithTheTimeAllowed) {
  SegmentOptions late;
  late.termination.deadline = Deadline::after(0.0);
  EXPECT_FALSE(path_of(*test::step_forward_problem(), late).success());
}

/// Go2 on three feet, the front left one to go 0.08 m ahead.
TEST(InterpolationTest, SaysAtOnceThatABallHasNoWay) {
  Task task = test::stance_task("stepping_stones");
  Segment segment;
  segment.held = test::without_contact(task.start, "front_left_foot").contacts;
  const Contact before = test::contact_of(task.start, "front_left_foot");
  Contact after = before;
  after.position.x() += 0.08;
  segment.left = {before};
  segment.reached = {after};
  segment.from = segment.to = task.start_configuration;
  segment.to[0] += 0.08;
  World world = task.world->world();
  const auto plan = [&] {
    SegmentSpace space(task.robot, world);
    space.set_segment(segment);
    return make_interpolation()->plan(space, {});
  };
  EXPECT_FALSE(plan().no_arc) << "nothing is in the way of the foot, whatever the rest does";
  const double x = before.position.x() + 0.04;
  world.solids.push_back(test::box_between("wall", {x - 0.01, -2.0, -1.0}, {x + 0.01, 2.0, 2.0}));
  const SegmentPath path = plan();
  EXPECT_FALSE(path.success());
  EXPECT_TRUE(path.no_arc);
  EXPECT_TRUE(path.waypoints.empty());
  EXPECT_NE(path.reason.find("no way"), std::string::npos) << path.reason;
}

}  // namespace
}  // namespace locograph::interpolation_test
