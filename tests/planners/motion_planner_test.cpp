// Whole motions: stances, paths and times, judged here by other means than the planner's.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/error.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/stance/stance_path.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/stance_space.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>

#include "common/sanitized.h"
#include "planners/segment_problems.h"
#include "planners/stance_tasks.h"

namespace locograph::motion_planner_test {
namespace {

const Task& standing_up() {
  static const Task task = test::stance_task("standing_up");
  return task;
}

MotionPlan plan_of(std::uint64_t seed, int threads, const MotionOptions& options = {}) {
  StancePlannerOptions stances;
  stances.seed = seed;
  stances.threads = threads;
  return plan_motion(standing_up(), stances, options);
}

constexpr std::size_t kSeeds = test::kSanitized ? 1 : 2;

const MotionPlan& plan_of_seed(std::size_t seed) {
  static std::array<std::optional<MotionPlan>, kSeeds> plans;
  if (!plans[seed]) plans[seed] = plan_of(seed, 1);
  return *plans[seed];
}

/// Rates at which a motion changes from a configuration to the next: of the base in the world,
/// along its own axes, and of the joints.
struct StepRates {
  Eigen::Vector3d linear, angular;
  Eigen::VectorXd joints;
};

StepRates rates_of(const Robot& robot, const Motion& motion, std::size_t step) {
  const Eigen::VectorXd &a = motion.configurations[step], &b = motion.configurations[step + 1];
  const double duration_s = motion.time_s[step + 1] - motion.time_s[step];
  const Eigen::Quaterniond from(a[6], a[3], a[4], a[5]), to(b[6], b[3], b[4], b[5]);
  const Eigen::AngleAxisd turn(from.conjugate() * to);
  const int joints = robot.active_joint_count();
  return {.linear = (b.head<3>() - a.head<3>()) / duration_s,
          .angular = turn.angle() * turn.axis() / duration_s,
          .joints = (b.tail(joints) - a.tail(joints)) / duration_s};
}

class MotionPlanTest : public testing::TestWithParam<std::size_t> {
 protected:
  MotionPlanTest()
      : plan(plan_of_seed(GetParam())), motion(plan.motion), robot(*standing_up().robot->robot) {}

  void SetUp() override { ASSERT_TRUE(plan.success()) << plan.reason; }

  /// Of joints, from vertex `step` to the next.
  Eigen::VectorXd joint_rates(int step) const {
    return rates_of(robot, motion, static_cast<std::size_t>(step)).joints;
  }

  const MotionPlan& plan;
  const Motion& motion;
  const Robot& robot;
};

TEST_P(MotionPlanTest, ComesFromTheStartToTheGoalAndIsJudgedFeasible) {
  EXPECT_TRUE(plan.report.feasible);
  EXPECT_EQ(motion.configurations.front(), standing_up().start_configuration);
  ASSERT_EQ(motion.stances.size(), plan.stances.stances.size());
  const auto stands_at = [](const Stance& stance, const Stance& wanted) {
    return std::ranges::all_of(wanted.contacts, [&](const Contact& contact) {
      return std::ranges::any_of(stance.contacts, [&](const Contact& other) {
        return other.name() == contact.name() && (other.position - contact.position).norm() < 1e-9;
      });
    });
  };
  EXPECT_TRUE(stands_at(motion.stances.front(), standing_up().start));
  EXPECT_TRUE(stands_at(motion.stances.back(), standing_up().goals.back()));
}

TEST_P(MotionPlanTest, EachStanceIsASegmentAndEachChangeIsATransition) {
  ASSERT_EQ(plan.segments.size() + 1, motion.stances.size());
  int vertex = 0;
  for (std::size_t j = 0; j < plan.segments.size(); ++j) {
    const SegmentRecord& segment = plan.segments[j];
    EXPECT_EQ(segment.stance, static_cast<int>(j));
    EXPECT_EQ(segment.first, vertex);
    EXPECT_GT(segment.last, segment.first);
    for (; vertex < segment.last; ++vertex) {
      EXPECT_EQ(motion.stance_from[static_cast<std::size_t>(vertex)], segment.stance);
    }
    const auto first = static_cast<std::size_t>(segment.first);
    const auto last = static_cast<std::size_t>(segment.last);
    EXPECT_EQ(motion.configurations[first], plan.stances.configurations[j]);
    EXPECT_EQ(motion.configurations[last], plan.stances.configurations[j + 1]);
    EXPECT_NEAR(motion.time_s[last] - motion.time_s[first], segment.duration_s, 1e-9);
    EXPECT_FALSE(segment.planner.empty());
    EXPECT_GE(segment.length, 0.999 * segment.straight);
  }
  EXPECT_EQ(vertex, static_cast<int>(motion.configurations.size()) - 1);
  EXPECT_EQ(motion.stance_from.back(), static_cast<int>(motion.stances.size()) - 1);
}

TEST_P(MotionPlanTest, TimesIncreaseEvenlyInSegments) {
  const MotionOptions options;
  EXPECT_EQ(motion.time_s.front(), 0.0);
  for (const SegmentRecord& segment : plan.segments) {
    const double step_s = segment.duration_s / (segment.last - segment.first);
    EXPECT_GT(step_s, 0.0);
    EXPECT_LE(step_s, options.step_s + 1e-12);
    for (int i = segment.first; i < segment.last; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_NEAR(motion.time_s[at + 1] - motion.time_s[at], step_s, 1e-9) << i;
    }
  }
}

TEST_P(MotionPlanTest, RestsWhereStancesChangeAndNowhereElse) {
  for (const SegmentRecord& segment : plan.segments) {
    if (segment.straight < 1e-6) continue;
    double fastest = 0.0, slowest = 1e9;
    const int steps = segment.last - segment.first;
    for (int i = segment.first; i < segment.last; ++i) {
      const double rate = joint_rates(i).norm();
      fastest = std::max(fastest, rate);
      const int from_end = std::min(i - segment.first, segment.last - 1 - i);
      if (10 * from_end > steps) slowest = std::min(slowest, rate);
    }
    EXPECT_LT(joint_rates(segment.first).norm(), 0.1 * fastest) << segment.stance;
    EXPECT_LT(joint_rates(segment.last - 1).norm(), 0.1 * fastest) << segment.stance;
    EXPECT_GT(slowest, 0.02 * fastest) << segment.stance;
  }
}

TEST_P(MotionPlanTest, JointsKeepToTheirLimits) {
  const MotionOptions options;
  for (const SegmentRecord& segment : plan.segments) {
    const double step_s = segment.duration_s / (segment.last - segment.first);
    // Nothing moves before the segment and after it.
    Eigen::VectorXd before = Eigen::VectorXd::Zero(robot.active_joint_count());
    for (int i = segment.first; i <= segment.last; ++i) {
      const Eigen::VectorXd rates =
          i < segment.last ? joint_rates(i) : Eigen::VectorXd::Zero(robot.active_joint_count());
      const Eigen::VectorXd acceleration = (rates - before) / step_s;
      const Eigen::VectorXd& q = motion.configurations[static_cast<std::size_t>(i)];
      for (int j = 0; j < robot.active_joint_count(); ++j) {
        const Joint& joint = robot.active_joint(j);
        const double at = q[robot.base_configuration_size() + j];
        EXPECT_GE(at, joint.lower - 1e-6) << joint.name;
        EXPECT_LE(at, joint.upper + 1e-6) << joint.name;
        EXPECT_LE(std::abs(rates[j]), joint.max_velocity * (1.0 + 1e-6)) << joint.name;
        EXPECT_LE(std::abs(acceleration[j]), options.joint_acceleration_rad_s2 * 1.02)
            << joint.name << " at " << i;
      }
      before = rates;
    }
  }
}

/// A jump from full acceleration to full braking within a step would be twice the limit.
TEST_P(MotionPlanTest, AccelerationsOfJointsDoNotJump) {
  const MotionOptions options;
  const double most =
      2.0 * options.joint_acceleration_rad_s2 * options.step_s / options.smoothing_s;
  double largest = 0.0;
  for (const SegmentRecord& segment : plan.segments) {
    const double step_s = segment.duration_s / (segment.last - segment.first);
    for (int i = segment.first; i + 2 < segment.last; ++i) {
      const Eigen::VectorXd change =
          (joint_rates(i + 2) - 2.0 * joint_rates(i + 1) + joint_rates(i)) / step_s;
      largest = std::max(largest, change.cwiseAbs().maxCoeff());
    }
  }
  EXPECT_LT(largest, most);
  EXPECT_GT(largest, 0.05 * most) << "nothing moves";
}

TEST_P(MotionPlanTest, ContactsHoldBetweenVertices) {
  const MotionCurve curve(robot, motion);
  MotionSampler sampler(curve);
  std::vector<Eigen::Isometry3d> poses;
  double most_m = 0.0, most_rad = 0.0, rolled_m = 0.0;
  for (int i = 0; i + 1 < static_cast<int>(motion.configurations.size()); ++i) {
    const int stance = motion.stance_from[static_cast<std::size_t>(i)];
    for (const double fraction : {0.0, 0.3, 0.5, 0.8}) {
      sampler.link_poses(i, fraction, poses);
      for (const Contact& contact : motion.stances[static_cast<std::size_t>(stance)].contacts) {
        const EndEffector& effector = contact.effector;
        const Eigen::Isometry3d& link =
            poses[static_cast<std::size_t>(robot.link_index(effector.link))];
        const Eigen::Vector3d off = link * effector.point - contact.position;
        if (is_ball(effector)) {  // the judge has looked at how it rolls
          const double height_m = off.dot(contact.normal.stableNormalized());
          most_m = std::max(most_m, std::abs(height_m - effector.radius_m));
          rolled_m = std::max(rolled_m, off.norm() - effector.radius_m);
          continue;
        }
        most_m = std::max(most_m, off.norm());
        if (effector.kind != ContactKind::kSurface) continue;
        const Eigen::Matrix3d axes = link.linear() * axes_in_link(effector);
        most_rad = std::max(most_rad, angle_between(axes.col(2), contact.normal));
      }
    }
  }
  EXPECT_LT(most_m, 1e-3);
  EXPECT_LT(most_rad, 5e-3);
  EXPECT_GT(rolled_m, 5e-3) << "no ball has rolled";
}

/// Without a dwell forces would have to jump.
TEST_P(MotionPlanTest, StatesNoWrenchesWithoutTimeToLoad) {
  EXPECT_TRUE(plan.motion.wrenches.empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, MotionPlanTest, testing::Range(std::size_t{0}, kSeeds));

TEST(MotionPlannerTest, GivesTheSameBitsWithAnyNumberOfThreads) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const MotionPlan &one = plan_of_seed(0), two = plan_of(0, 2);
  ASSERT_TRUE(two.success()) << two.reason;
  EXPECT_EQ(two.motion.time_s, one.motion.time_s);
  EXPECT_EQ(two.motion.stance_from, one.motion.stance_from);
  EXPECT_EQ(two.statistics.refused_segments, one.statistics.refused_segments);
  ASSERT_EQ(two.motion.configurations.size(), one.motion.configurations.size());
  for (std::size_t i = 0; i < one.motion.configurations.size(); ++i) {
    const Eigen::VectorXd &a = one.motion.configurations[i], &b = two.motion.configurations[i];
    const std::size_t bytes = static_cast<std::size_t>(a.size()) * sizeof(double);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), bytes), 0) << i;
  }
  EXPECT_EQ(two.motion.wrenches, one.motion.wrenches);
}

TEST(MotionPlannerTest, SaysWhyThereIsNoMotionAndGivesWhatThereIs) {
  StancePlannerOptions stances;
  stances.max_transitions = 1;
  const MotionPlan plan = plan_motion(standing_up(), stances);
  EXPECT_FALSE(plan.success());
  EXPECT_FALSE(plan.reason.empty());
  EXPECT_TRUE(plan.segments.empty());
  ASSERT_EQ(plan.motion.configurations.size(), 1U);
  EXPECT_EQ(plan.motion.configurations[0], standing_up().start_configuration);
  EXPECT_EQ(plan.motion.stances.size(), 1U);
}

TEST(MotionPlannerTest, RefusesASegmentPlannerThatNobodyKnows) {
  try {
    plan_of(0, 1, {.segment_planners = {"interpolation", "guessing"}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("guessing"), std::string::npos) << error.what();
  }
}

/// The right arm of COMAN+ is where nothing asks it to be.
TEST(NearbyPosturesTest, FreeArmsStayWhereTheyAre) {
  const Task task = test::stance_task("slanted_wall");
  const StancePlannerOptions options;
  StanceSpace space(task, options);
  const Footing both = space.footing(task.start);
  const Footing one = space.footing(test::without_contact(task.start, "right_foot"));
  const Robot& robot = *task.robot->robot;
  int elbow = -1;
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    if (robot.active_joint(i).name == "RElbj") elbow = robot.base_configuration_size() + i;
  }
  ASSERT_GE(elbow, 0);
  Eigen::VectorXd start = task.start_configuration;
  start[elbow] -= 0.4;
  const StanceSpace::Attempt near = space.try_nearby(both, one, start);
  const StanceSpace::Attempt usual = space.try_transition(both, one, start, 0);
  ASSERT_TRUE(near.found) << near.reason;
  ASSERT_TRUE(usual.found) << usual.reason;
  EXPECT_LT(std::abs(near.configuration[elbow] - start[elbow]), 0.02);
  EXPECT_GT(std::abs(usual.configuration[elbow] - start[elbow]), 0.1);
  const Judge judge(task.robot->robot, task.world);
  CheckOptions asked = task.check;
  asked.enforce_torque_limits = false;
  EXPECT_TRUE(judge
                  .check(stances_motion({space.stance(both), space.stance(one)},
                                        {near.configuration, near.configuration}),
                         asked)
                  .feasible);
}

/// COMAN+ stands up from all fours, and its hands roll.
TEST(RollingBallsTest, TransitionsRollFromTheOneBefore) {
  const Task task = test::stance_task("standing_up");
  const StancePlannerOptions options;
  const StancePlan plan = make_stance_planner("guided")->plan(task, options);
  ASSERT_TRUE(plan.success()) << plan.reason;
  StanceSpace space(task, options);
  double rolled_m = 0.0, slip_at_places_m = 0.0;
  for (std::size_t i = 1; i < plan.stances.size(); ++i) {
    const Footing from = space.footing(plan.stances[i - 1]), to = space.footing(plan.stances[i]);
    const Eigen::VectorXd &before = plan.configurations[i - 1], &q = plan.configurations[i];
    EXPECT_LT(space.slip_m(from, before, q), 1e-6) << i;
    const Stance there = space.rolled_stance(from, from, q);
    for (std::size_t k = 0; k < there.contacts.size(); ++k) {
      const Contact& touched = plan.stances[i - 1].contacts[k];
      rolled_m = std::max(rolled_m, (there.contacts[k].position - touched.position).norm());
    }
    // As if balls turned on the spot.
    const StanceSpace::Attempt at_places = space.try_transition(from, to, q, 0);
    if (!at_places.found) continue;
    const double slip_m = space.slip_m(from, before, at_places.configuration);
    slip_at_places_m = std::max(slip_at_places_m, slip_m);
    Eigen::VectorXd again = at_places.configuration;
    if (slip_m < 1e-6 || slip_m > 0.02) continue;
    ASSERT_TRUE(roll_to(space, from, to, before, again)) << i;
    EXPECT_LT(space.slip_m(from, before, again), 1e-6) << i;
  }
  EXPECT_GT(rolled_m, 0.01);
  EXPECT_GT(slip_at_places_m, 1e-3);
}

/// Stones of Go2 whose sides are 6 cm apart.
TEST(PlacesForMotionsTest, NoneIsInAGapThatABallCannotComeOutOf) {
  const Task task = test::stance_task("stepping_stones");
  const auto found =
      std::ranges::find(task.end_effectors(), "front_right_foot", &EndEffector::name);
  ASSERT_NE(found, task.end_effectors().end());
  const int foot = static_cast<int>(found - task.end_effectors().begin());
  const auto places = [&](bool for_motions) {
    StancePlannerOptions options;
    options.approachable_only = for_motions;
    StanceSpace space(task, options);
    int sides = 0, tops = 0;
    for (const int number : space.places_near(foot, {0.65, -0.15, 0.0}, 0.12)) {
      const Contact& contact = space.place(number).bearing.contact;
      const Eigen::Vector3d &at = contact.position, &normal = contact.normal;
      if (std::abs(normal.x()) > 0.9 && std::abs(at.z()) < 0.02) ++sides;
      if (normal.z() > 0.9) ++tops;
    }
    return std::pair(sides, tops);
  };
  const auto [sides, tops] = places(false);
  EXPECT_GT(sides, 0);
  EXPECT_GT(tops, 0);
  EXPECT_EQ(places(true), std::pair(0, tops));
}

/// A path is kept when it is timed again.
TEST(SegmentMoverTest, TheSamePathAtAnotherPace) {
  const auto step = test::step_forward_problem();
  Task task = test::stance_task("slanted_wall");
  task.world = std::make_shared<const WorldSnapshot>(step->world);
  const MotionOptions options;
  SegmentMover mover(task, options);
  const std::vector<BearingContact> bearing = {{step->segment.held[0]}};
  const SegmentMotion fast = mover.move(step->segment, bearing, 0, 1, {});
  ASSERT_TRUE(fast.success()) << fast.reason;
  SegmentMotion slow = fast;
  mover.retime(step->segment, bearing, {.slower = 2.0}, slow);
  ASSERT_TRUE(slow.success());
  EXPECT_NEAR(slow.duration_s, 2.0 * fast.duration_s, 1e-9);
  EXPECT_NEAR(slow.length, fast.length, 1e-2 * fast.length);
  SegmentMotion fine = fast;
  mover.retime(step->segment, bearing, {.finer = true}, fine);
  ASSERT_TRUE(fine.success());
  for (const SegmentMotion* motion : {&slow, &fine}) {
    EXPECT_EQ(motion->planner, fast.planner);
    EXPECT_EQ(motion->configurations.front(), step->segment.from);
    EXPECT_EQ(motion->configurations.back(), step->segment.to);
  }
  // As close to the path as its waypoints are.
  SegmentSpace space(task.robot, task.world->world());
  space.set_segment(step->segment);
  for (const Eigen::VectorXd& q : fine.configurations) {
    double least = 1.0;
    for (const Eigen::VectorXd& waypoint : fast.waypoints) {
      least = std::min(least, space.distance(q, waypoint));
    }
    EXPECT_LT(least, 0.15);
  }
}

}  // namespace
}  // namespace locograph::motion_planner_test
