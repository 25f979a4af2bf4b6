// Whole motions with an execution margin: dwells, and wrenches that can be carried out.
#include <gtest/gtest.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/stance/given_margins.h>
#include <locograph/robots/dynamics.h>

#include <algorithm>
#include <cmath>

#include "common/sanitized.h"
#include "planners/stance_tasks.h"

namespace locograph::loaded_motion_test {
namespace {

const Task& standing_up() {
  static const Task task = test::stance_task_with_margin("standing_up");
  return task;
}

const MotionPlan& plan() {
  static const MotionPlan plan = plan_motion(standing_up(), {.seed = 1});
  return plan;
}

class LoadedMotionTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "takes long there";
    ASSERT_TRUE(plan().success()) << plan().reason;
  }

  const Task& task = standing_up();
  const Robot& robot = *task.robot->robot;
  const Motion& motion = plan().motion;
  const double weight_N = robot.total_mass() * standard_gravity().norm();

  const std::vector<Contact>& contacts(std::size_t vertex) const {
    return motion.stances[static_cast<std::size_t>(motion.stance_from[vertex])].contacts;
  }
  /// The number of a contact in the stance that a vertex is left in; -1: not held there.
  int number_of(const std::string& name, std::size_t vertex) const {
    const auto found = std::ranges::find(contacts(vertex), name, &Contact::name);
    return found == contacts(vertex).end() ? -1
                                           : static_cast<int>(found - contacts(vertex).begin());
  }
  /// Seconds that the robot stands still before a vertex and after it.
  double still_s(std::size_t vertex) const {
    std::size_t from = vertex, to = vertex;
    while (from > 0 && motion.configurations[from - 1] == motion.configurations[vertex]) --from;
    while (to + 1 < motion.configurations.size() &&
           motion.configurations[to + 1] == motion.configurations[vertex]) {
      ++to;
    }
    return motion.time_s[to] - motion.time_s[from];
  }
};

TEST_F(LoadedMotionTest, StandsOnceAtEachChangeAndAtTheEnd) {
  int changes = 0;
  for (std::size_t i = 1; i < motion.configurations.size(); ++i) {
    if (motion.stance_from[i] == motion.stance_from[i - 1]) continue;
    ++changes;
    EXPECT_GE(still_s(i), task.margin.dwell_s - 1e-9) << i;
    EXPECT_LT(still_s(i), 1.5 * task.margin.dwell_s) << i;
  }
  EXPECT_EQ(changes + 1, static_cast<int>(motion.stances.size()));
  EXPECT_GE(still_s(motion.configurations.size() - 1), task.margin.dwell_s - 1e-9);
}

TEST_F(LoadedMotionTest, WrenchesBalanceGravityAndInertia) {
  RobotDynamics dynamics(robot);
  RobotState state(robot);
  const MotionCurve curve(robot, motion);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot.tangent_size());
  CurvePoint before{{}, still, still}, after = before;
  Eigen::VectorXd asked(robot.tangent_size());
  double inertia = 0.0;
  const std::size_t last = motion.configurations.size() - 1;
  ASSERT_EQ(motion.wrenches.size(), last + 1);
  for (std::size_t i = 0; i <= last; ++i) {
    before.velocity = before.acceleration = after.velocity = after.acceleration = still;
    if (i > 0) curve.step(static_cast<int>(i) - 1).at(1.0, before);
    if (i < last) curve.step(static_cast<int>(i)).at(0.0, after);
    const Eigen::VectorXd mean = 0.5 * (before.acceleration + after.acceleration);
    state.update(motion.configurations[i].data());
    dynamics.inverse_dynamics(state, after.velocity, mean, {}, asked);
    Eigen::VectorXd borne = Eigen::VectorXd::Zero(robot.tangent_size());
    for (std::size_t k = 0; k < contacts(i).size(); ++k) {
      const Contact& contact = contacts(i)[k];
      const int link = robot.link_index(contact.effector.link);
      const Eigen::Isometry3d& pose = state.world_from_link(link);
      const bool sole = contact.effector.kind == ContactKind::kSurface;
      const Eigen::Matrix3d axes =
          sole ? Eigen::Matrix3d(pose.linear() * axes_in_link(contact.effector))
               : axes_in_world(contact);
      Eigen::Vector3d at = pose * contact.effector.point;
      if (!sole) at -= contact.effector.radius_m * axes.col(2);
      add_wrench_torques(state,
                         {.link = link,
                          .point = pose.inverse() * at,
                          .force = axes * motion.wrenches[i][k].head<3>(),
                          .moment = axes * motion.wrenches[i][k].tail<3>()},
                         1.0, borne);
    }
    EXPECT_LT((asked - borne).head<6>().norm(), 1e-3 * weight_N) << i;
    inertia = std::max(inertia, std::abs(asked.head<3>().norm() - weight_N));
  }
  EXPECT_GT(inertia, 0.005 * weight_N) << "it is not at rest all the time";
}

TEST_F(LoadedMotionTest, ForcesGoOverSlowly) {
  double fastest = 0.0;
  for (std::size_t i = 1; i < motion.configurations.size(); ++i) {
    const double h = motion.time_s[i] - motion.time_s[i - 1];
    for (std::size_t k = 0; k < contacts(i - 1).size(); ++k) {
      const int there = number_of(contacts(i - 1)[k].name(), i);
      Eigen::Vector3d change = -motion.wrenches[i - 1][k].head<3>();
      if (there >= 0) change += motion.wrenches[i][static_cast<std::size_t>(there)].head<3>();
      fastest = std::max(fastest, change.norm() / (h * weight_N));
    }
    for (std::size_t k = 0; k < contacts(i).size(); ++k) {
      if (number_of(contacts(i)[k].name(), i - 1) >= 0) continue;
      EXPECT_TRUE(motion.wrenches[i][k].isZero(1e-9)) << "it closes here, " << i;
    }
  }
  EXPECT_LE(fastest, 2.5);
  EXPECT_GT(fastest, 0.5);
}

TEST_F(LoadedMotionTest, EveryContactIsPressedAndFarFromSlippingWhereItMoves) {
  const ExecutionMargin& margin = task.margin;
  for (const SegmentRecord& segment : plan().segments) {
    for (int i = segment.first; i < segment.last; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (still_s(at) > 0.0) continue;
      for (std::size_t k = 0; k < contacts(at).size(); ++k) {
        const auto& wrench = motion.wrenches[at][k];
        EXPECT_GE(wrench[2], margin.least_force * weight_N - 1e-4) << i;
        const double friction = contacts(at)[k].effector.friction;
        EXPECT_LE(wrench.head<2>().norm(), margin.friction * friction * wrench[2] + 1e-4) << i;
      }
    }
  }
}

TEST_F(LoadedMotionTest, JointsKeepTheirMargin) {
  for (const Eigen::VectorXd& q : motion.configurations) {
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      const Joint& joint = robot.active_joint(i);
      const double x = q[robot.base_configuration_size() + i];
      EXPECT_GE(std::min(x - joint.lower, joint.upper - x), 0.8 * task.margin.joint_rad)
          << joint.name;
    }
  }
}

/// Pairs that are nearer than that at the start are left so, less a fifth.
TEST_F(LoadedMotionTest, LinksKeepTheirDistanceFromEachOther) {
  const Judge judge(task.robot->robot, task.world);
  RobotState state(robot);
  const auto distance_m = [&](const Eigen::VectorXd& q) {
    state.update(q.data());
    return judge.self_distance_m(state);
  };
  const double kept =
      std::min(task.margin.self_distance_m, 0.8 * distance_m(task.start_configuration));
  ASSERT_GT(kept, 4e-3) << "less is kept without a margin";
  for (const Eigen::VectorXd& q : motion.configurations) EXPECT_GE(distance_m(q), 0.5 * kept);
  for (const SegmentRecord& segment : plan().segments) {
    const auto last = static_cast<std::size_t>(segment.last);
    EXPECT_GE(distance_m(motion.configurations[last]), kept - 1e-3) << last;
  }
}

TEST_F(LoadedMotionTest, TellsWhatStartAndGoalHaveOfTheMargin) {
  const std::vector<GivenMargin> given = given_margins(task, plan().stances);
  ASSERT_EQ(given.size(), 2U);
  EXPECT_EQ(given[0].where, "start");
  EXPECT_EQ(given[1].where, "goal 1");
  for (const GivenMargin& one : given) {
    EXPECT_GE(one.share, 0.0);
    EXPECT_LE(one.share, 1.0);
    EXPECT_GE(one.margin.friction, task.margin.friction);
  }
  Task bare = task;
  bare.margin = ExecutionMargin::none();
  EXPECT_TRUE(given_margins(bare, plan().stances).empty());
}

/// A dwell is as long as forces need to go over, if that is longer than it is asked to be.
TEST(LoadedMotion, ADwellThatIsTooShortForForcesIsLonger) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Task task = standing_up();
  task.margin.dwell_s = 0.01;
  const MotionPlan hasty = plan_motion(task, {.seed = 1});
  ASSERT_TRUE(hasty.success()) << hasty.reason;
  const double weight_N = task.robot->robot->total_mass() * standard_gravity().norm();
  const Motion& motion = hasty.motion;
  for (std::size_t i = 1; i < motion.configurations.size(); ++i) {
    if (motion.stance_from[i] != motion.stance_from[i - 1]) continue;
    for (std::size_t k = 0; k < motion.wrenches[i].size(); ++k) {
      const double change = (motion.wrenches[i][k] - motion.wrenches[i - 1][k]).head<3>().norm();
      EXPECT_LE(change, 2.5 * weight_N * (motion.time_s[i] - motion.time_s[i - 1])) << i;
    }
  }
}

}  // namespace
}  // namespace locograph::loaded_motion_test
