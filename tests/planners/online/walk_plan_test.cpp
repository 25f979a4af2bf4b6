#include <locograph/common/error.h>
#include <locograph/common/ranges.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/world/octree.h>

#include "common/sanitized.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace {

/// What the planner sees and what the checker checks against.
struct Surroundings {
  std::vector<Obstacle> obstacles;
  std::shared_ptr<const octomap::OcTree> map;

  std::shared_ptr<const WorldSnapshot> seen() const {
    return std::make_shared<const WorldSnapshot>(world_of(obstacles, map));
  }
  CheckReport check(const Graph& graph) const { return check_plan(graph, obstacles, map); }
};

WalkReport walk_in(Graph& graph, const Surroundings& surroundings, int horizon = 20) {
  const auto world = surroundings.seen();
  WalkOptions options;
  options.planner.horizon = horizon;
  const std::shared_ptr<const Robot> robot = plan_of(graph).robot->robot;
  options.verify = [&surroundings, robot](const Motion& step) {
    return check_step(robot, step, world_of(surroundings.obstacles, surroundings.map));
  };
  return walk_plan(
      graph, [&world](int executed) { return executed == 0 ? world : nullptr; }, options);
}

/// To the left of a configuration, and turned.
Eigen::VectorXd beside(const Robot& robot, const Eigen::VectorXd& q, double left_m,
                       double turned_rad) {
  Eigen::VectorXd off = Eigen::VectorXd::Zero(robot.tangent_size()), pushed(q.size());
  off[1] = left_m;
  off[5] = turned_rad;
  robot.integrate(q.data(), off.data(), pushed.data());
  return pushed;
}

Obstacle wall_ahead() { return box("wall", {2.5, 0.0, 0.5}, {0.2, 8.0, 1.0}); }

std::shared_ptr<const octomap::OcTree> map_of(const Obstacle& obstacle) {
  Box solid;
  solid.world_from_box = obstacle.world_from_obstacle;
  solid.size = obstacle.size;
  return octree_from_boxes({&solid, 1}, 0.05);
}

void expect_same(const Graph& a, const Graph& b, double tolerance) {
  const std::vector<Eigen::VectorXd> first = configurations(a), second = configurations(b);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_LE((first[i] - second[i]).cwiseAbs().maxCoeff(), tolerance) << i;
  }
}

TEST(WalkPlan, LeavesAPlanInAnEmptyWorldAsItIs) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const Surroundings nothing, empty_map{{}, std::make_shared<octomap::OcTree>(0.05)};
  for (const Surroundings& surroundings : {nothing, empty_map}) {
    for (const double curvature : {0.0, 0.3}) {
      Graph graph = planned_drive(centauro_drive(4.0, curvature));
      const WalkReport report = walk_in(graph, surroundings);
      EXPECT_TRUE(report.success()) << report.reason;
      EXPECT_EQ(report.cycles.size(), 49u);
      EXPECT_EQ(report.feasible_cycles, 49);
      EXPECT_EQ(report.dof, 30);
      expect_same(graph, planned_drive(centauro_drive(4.0, curvature)), 1e-3);
    }
  }
}

void expect_gets_past(const Surroundings& surroundings) {
  Graph graph = drive();
  EXPECT_TRUE(violated(surroundings.check(graph)).contains("obstacle_distance"));
  const WalkReport report = walk_in(graph, surroundings);
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_EQ(report.configurations, 50);
  const CheckReport check = surroundings.check(graph);
  expect_feasible(check);
  EXPECT_GT(check.min_clearance_m.value_or(0.0), 0.0);
  EXPECT_LT(check.max_contact_error_m.value_or(1.0), 1e-3);
  EXPECT_LT(check.constraint("lateral_slip").worst, 5e-3);
  EXPECT_LT(check.constraint("longitudinal_slip").worst, 5e-3);
  EXPECT_NEAR(configurations(graph).back()[0], 4.0, 0.3);
  EXPECT_LT(report.goal_distance_m, 0.25) << "in any direction";
  EXPECT_DOUBLE_EQ(
      report.goal_distance_m,
      (configurations(graph).back() - configurations(drive()).back()).head<3>().norm());
}

TEST(WalkPlan, DrivesAroundABoxGivenAsAnObstacle) { expect_gets_past({{box_ahead()}, nullptr}); }

TEST(WalkPlan, DrivesAroundABoxGivenAsAMap) { expect_gets_past({{}, map_of(box_ahead())}); }

TEST(WalkPlan, DrivesAroundABoxThatShowsUpOnTheWay) {
  const Surroundings surroundings{{box_ahead()}, nullptr};
  const auto world = surroundings.seen();
  Graph graph = drive();
  const WalkReport report =
      walk_plan(graph, [&world](int executed) { return executed == 3 ? world : nullptr; }, {});
  EXPECT_TRUE(report.success()) << report.reason;
  expect_feasible(surroundings.check(graph));
}

TEST(WalkPlan, NeverCallsAStepFeasibleThatMeetsACartOnItsWay) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Obstacle cart = box("cart", {2.0, -3.0, 0.4}, {0.4, 0.4, 0.8});
  KeyFrame start{8.0, cart.world_from_obstacle}, end{32.0, cart.world_from_obstacle};
  end.pose.translation().y() = 3.0;
  cart.motion = {start, end};  // is at y = 0 after 20 s, as the robot
  const Surroundings surroundings{{cart}, nullptr};
  Graph graph = drive();
  EXPECT_TRUE(violated(surroundings.check(graph)).contains("obstacle_distance"));
  const WalkReport report = walk_in(graph, surroundings);
  expect_feasible(surroundings.check(graph));
  EXPECT_EQ(configurations(graph).size(), static_cast<std::size_t>(report.configurations));
  EXPECT_EQ(report.success(), report.configurations == 50) << report.reason;
}

void expect_stops(const Surroundings& surroundings) {
  Graph graph = drive();
  const WalkReport report = walk_in(graph, surroundings);
  EXPECT_FALSE(report.success());
  EXPECT_TRUE(report.reason.find("obstacle_distance") != std::string::npos ||
              report.reason.find("blocked") != std::string::npos)
      << report.reason;
  EXPECT_NE(report.reason.find(surroundings.map ? "the map" : "wall"), std::string::npos)
      << "the cause, not what gave way: " << report.reason;
  EXPECT_NE(report.reason.find("from the goal"), std::string::npos) << report.reason;
  EXPECT_GT(report.goal_distance_m, 1.0);
  EXPECT_EQ(configurations(graph).size(), static_cast<std::size_t>(report.configurations));
  expect_feasible(surroundings.check(graph));
  EXPECT_LT(configurations(graph).back()[0], 2.4) << "through the wall";
  EXPECT_GT(configurations(graph).back()[0], 1.0) << "stopped early";
}

TEST(WalkPlan, StopsInFrontOfAWallAndSaysSo) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  expect_stops({{wall_ahead()}, nullptr});
}

TEST(WalkPlan, StopsInFrontOfAWallInAMapAndSaysSo) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  expect_stops({{}, map_of(wall_ahead())});
}

TEST(WalkPlan, RemovesWhatCannotBeExecutedWhenThereIsNowhereToGo) {
  // Appears around the robot, which cannot get out of the way in one step.
  const Surroundings surroundings{{box("rock", {1.0, 0.0, 0.5}, {1.0, 0.5, 1.0})}, nullptr};
  const auto world = surroundings.seen();
  Graph graph = drive();
  const WalkReport report =
      walk_plan(graph, [&world](int executed) { return executed == 12 ? world : nullptr; }, {});
  EXPECT_EQ(report.status, PlannerStatus::kNotFound);
  EXPECT_EQ(report.reason.find("stopped at configuration 12: "), 0u) << report.reason;
  EXPECT_NE(report.reason.find("(rock)"), std::string::npos) << report.reason;
  EXPECT_NE(report.reason.find("after 12 of 49 steps"), std::string::npos) << report.reason;
  EXPECT_NEAR(report.goal_distance_m, 4.0 * 37 / 49, 1e-2);
  EXPECT_EQ(report.configurations, 13);
  EXPECT_EQ(configurations(graph).size(), 13u);
  EXPECT_FALSE(report.cycles.back().success());
  expect_feasible(check_plan(graph));
}

class WalkWithHorizon : public testing::TestWithParam<int> {};

TEST_P(WalkWithHorizon, NeverHandsOutAnInfeasiblePlan) {
  if (test::kSanitized && GetParam() < 20) GTEST_SKIP() << "takes long there";
  const Surroundings surroundings{{box_ahead()}, nullptr};
  Graph graph = drive();
  const WalkReport report = walk_in(graph, surroundings, GetParam());
  expect_feasible(surroundings.check(graph));
  EXPECT_EQ(configurations(graph).size(), static_cast<std::size_t>(report.configurations));
  for (const CycleReport& cycle : report.cycles) {
    EXPECT_EQ(cycle.window, std::min(GetParam(), 49 - cycle.executed));
  }
  if (report.success()) {
    EXPECT_EQ(report.configurations, 50);
    EXPECT_NEAR(configurations(graph).back()[0], 4.0, 0.3);
  }
  EXPECT_TRUE(report.success() || GetParam() < 20) << report.reason;
}

INSTANTIATE_TEST_SUITE_P(WalkPlan, WalkWithHorizon, testing::Values(1, 5, 20, 200));

void start_at(Graph& graph, double time_s) {
  for (const int slot : plan_of(graph).slots)
    graph.vertex(VertexId<VertexConfiguration>{slot}).time_s += time_s;
}

double end_s(const Graph& graph) { return motion_of(graph, plan_of(graph)).time_s.back(); }

TEST(WalkPlan, LeadsBackADriveThatIsOffItsWay) {
  Graph graph = drive();
  const std::vector<Eigen::VectorXd> planned = configurations(graph);
  const std::shared_ptr<const Robot> robot = plan_of(graph).robot->robot;
  const World nothing = world_of(std::vector<Obstacle>());
  WalkOptions options;
  options.verify = [&](const Motion& step) { return check_step(robot, step, nothing); };
  const int pushed = 10;
  PlanWalk walk(graph, {}, options, pushed);
  const Eigen::VectorXd q = beside(*robot, planned[pushed], 0.04, 0.03);
  walk.measure(q);
  while (walk.step()) {
  }
  const WalkReport report = walk.report();
  EXPECT_TRUE(report.success()) << report.reason;
  const std::vector<Eigen::VectorXd> now = configurations(graph);
  EXPECT_EQ(now[pushed], q) << "the robot is where it is";
  constexpr int kBack = 7;  // steps, of 8 cm each
  Eigen::VectorXd off(robot->tangent_size());
  for (std::size_t i = pushed + kBack; i < now.size(); ++i) {
    robot->difference(planned[i].data(), now[i].data(), off.data());
    EXPECT_LT(off.head<6>().lpNorm<Eigen::Infinity>(), 4e-3) << i;
  }
  EXPECT_THROW(PlanWalk(graph, {}, options, 50), Error);
}

/// Where too little of its way is left to come back on, tracking brings it nearer.
TEST(WalkPlan, ArrivesWhereItIsOffItsWayJustBeforeTheGoal) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const Graph planned = drive();
  const Plan plan = plan_of(planned);
  const Robot& robot = *plan.robot->robot;
  const World nothing = world_of(std::vector<Obstacle>());
  WalkOptions options;
  options.verify = [&](const Motion& step) { return check_step(plan.robot->robot, step, nothing); };
  for (int at = plan.slots.size() - 4; at + 1 < static_cast<int>(plan.slots.size()); ++at) {
    Graph graph = drive();
    constexpr double kOff_m = 0.02;
    PlanWalk walk(graph, {}, options, at);
    const Eigen::VectorXd was = configurations(planned)[static_cast<std::size_t>(at)];
    walk.measure(beside(robot, was, kOff_m, 0.01));
    while (walk.step()) {
    }
    EXPECT_TRUE(walk.report().success()) << at << ": " << walk.report().reason;
    EXPECT_LE(walk.report().goal_distance_m, kOff_m) << at;
  }
}

/// A robot that tells where it is at each step, by micrometres off, does not wander.
TEST(WalkPlan, DrivesAsPlannedWhereItIsMeasuredAtEachStep) {
  Graph graph = planned_drive(centauro_drive(0.8, 0.0, 11));
  const std::vector<Eigen::VectorXd> planned = configurations(graph);
  const std::vector<Eigen::VectorXd> tracked = tracked_configurations(graph, plan_of(graph));
  WalkOptions options;
  PlanWalk walk(graph, {}, options);
  constexpr double kNoise_m = 1e-6;
  double sign = 1.0;
  do {
    Eigen::VectorXd q = walk.motion().configurations[static_cast<std::size_t>(walk.executed())];
    q[1] += sign * kNoise_m;
    sign = -sign;
    walk.measure(q);
  } while (walk.step());
  EXPECT_TRUE(walk.report().success()) << walk.report().reason;
  const std::vector<Eigen::VectorXd> now = configurations(graph);
  const std::vector<Eigen::VectorXd> tracks = tracked_configurations(graph, plan_of(graph));
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_LT((now[i] - planned[i]).head<7>().lpNorm<Eigen::Infinity>(), 10.0 * kNoise_m) << i;
    EXPECT_LT((tracks[i] - tracked[i]).head<7>().lpNorm<Eigen::Infinity>(), 10.0 * kNoise_m) << i;
  }
}

/// Past an obstacle it is not where it was planned, and its window is not either.
TEST(WalkPlan, PassesABoxWhereItIsMeasuredBesideItsWindowAtEachStep) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Graph graph = drive();
  const std::shared_ptr<const Robot> robot = plan_of(graph).robot->robot;
  const World world = world_of({box_ahead()});
  WalkOptions options = walk_options_for(plan_of(graph));
  options.verify = [&](const Motion& step) { return check_step(robot, step, world); };
  PlanWalk walk(
      graph, [](int executed) { return executed == 0 ? seeing({box_ahead()}) : nullptr; }, options);
  double sign = 1.0;
  while (walk.step()) {
    const auto executed = static_cast<std::size_t>(walk.executed());
    walk.measure(beside(*robot, walk.motion().configurations[executed], 0.01 * sign, 0.005 * sign));
    sign = -sign;
  }
  const WalkReport report = walk.report();
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_LT(report.goal_distance_m, 0.05);
}

/// Wheels that are turned off have to be turned back, and are steered as fast as edges let them:
/// that takes more iterations than other steps have.
TEST(WalkPlan, TakesMoreCyclesWhereTheNextStepIsNotFeasibleAfterAPush) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  constexpr int kPushed = 20;
  Graph graph = drive();
  const Plan plan = plan_of(graph);
  const Robot& robot = *plan.robot->robot;
  const World world = world_of({box_ahead()});
  WalkOptions options = walk_options_for(plan);
  options.verify = [&](const Motion& step) { return check_step(plan.robot->robot, step, world); };
  PlanWalk walk(
      graph, [](int executed) { return executed == 0 ? seeing({box_ahead()}) : nullptr; }, options);
  while (walk.executed() < kPushed) ASSERT_TRUE(walk.step()) << walk.report().reason;
  const Eigen::VectorXd was = walk.motion().configurations[kPushed];
  Eigen::VectorXd q = beside(robot, was, 0.03, 0.0);
  WheelMotion wheels(robot, plan.stance_from[kPushed]->stance);
  for (int w = 0; w < wheels.wheels(); ++w) {
    q[robot.base_configuration_size() + wheels.steering_joint(w)] += w % 2 == 0 ? 0.05 : -0.05;
  }
  walk.measure(q);
  while (walk.step()) {
  }
  EXPECT_TRUE(walk.report().success()) << walk.report().reason;
}

TEST(WalkPlan, EndsWhereSlowStepsWouldTakeLongerThanAFileMaySay) {
  Graph graph = planned_drive(centauro_drive(0.8, 0.0, 11));
  start_at(graph, ranges::kTime_s - 1.5 * end_s(graph));
  WalkOptions options;
  options.pace = [](int executed) { return executed < 3 ? 1.0 : 3.0; };
  const WalkReport report = walk_plan(graph, nullptr, options);
  EXPECT_EQ(report.status, PlannerStatus::kNotFound);
  EXPECT_NE(report.reason.find("later than 1000000 s"), std::string::npos) << report.reason;
  EXPECT_EQ(report.configurations, 4);
  EXPECT_LE(end_s(graph), ranges::kTime_s);
}

TEST(WalkPlan, ComesToRestBeforeTheLastTimeThatAFileMaySay) {
  WalkOptions options;
  options.verify = [](const Motion& motion) {
    CheckReport report;
    report.feasible = motion.configurations.back()[0] < 0.5;
    return report;
  };
  const auto planned = [] { return planned_drive(centauro_drive(0.8, 0.0, 11)); };
  Graph graph = planned();
  const int stopped = walk_plan(graph, nullptr, options).configurations - 1;
  const double planned_s = motion_of(planned(), plan_of(planned()), 0, stopped).time_s.back();
  ASSERT_GT(end_s(graph), planned_s) << "it brakes";
  Graph late = planned();
  start_at(late, ranges::kTime_s - planned_s);
  EXPECT_LE(walk_plan(late, nullptr, options).configurations, stopped) << "it brakes earlier";
  EXPECT_LE(end_s(late), ranges::kTime_s);
}

TEST(WalkPlan, RefusesAHorizonOfNothingAndANegativeDeadline) {
  Graph graph = drive();
  EXPECT_THROW(walk_in(graph, {}, 0), Error);
  EXPECT_THROW(walk_in(graph, {}, -5), Error);
  WalkOptions options;
  options.cycle_deadline_s = -0.001;
  EXPECT_THROW(walk_plan(graph, {}, options), Error);
  options.cycle_deadline_s = kNaN;
  EXPECT_THROW(walk_plan(graph, {}, options), Error);
  expect_same(graph, drive(), 0.0);
}

TEST(WalkPlan, EndsWithWhatItHasWhenItIsInterrupted) {
  std::atomic<bool> stop{false};
  WalkOptions options;
  options.termination.stop = &stop;
  options.on_cycle = [&stop](const CycleReport& cycle) { stop = cycle.executed == 4; };
  Graph graph = drive();
  EXPECT_FALSE(plan_of(graph).incomplete);
  const WalkReport report = walk_plan(graph, {}, options);
  EXPECT_EQ(report.status, PlannerStatus::kStopped);
  EXPECT_EQ(report.statistics.iterations, 5);
  EXPECT_EQ(report.reason.find(
                "stopped at configuration 5: interrupted (start again to go on); after 5 of 49 "
                "steps"),
            0u)
      << report.reason;
  EXPECT_EQ(report.configurations, 6);
  EXPECT_EQ(configurations(graph).size(), 6u);
  EXPECT_TRUE(plan_of(graph).incomplete);
  expect_feasible(check_plan(graph));
}

TEST(WalkPlan, IsNoSuccessWhereItEndsTooFarFromTheGoal) {
  const Surroundings surroundings{{box_ahead()}, nullptr};
  const auto world = surroundings.seen();
  WalkOptions options;
  options.goal_tolerance_m = 1e-6;
  Graph graph = drive();
  const WalkReport report = walk_plan(
      graph, [&world](int executed) { return executed == 0 ? world : nullptr; }, options);
  EXPECT_FALSE(report.success());
  EXPECT_EQ(report.configurations, 50);
  EXPECT_NE(report.reason.find("from the goal"), std::string::npos) << report.reason;
  options.goal_tolerance_m = -1.0;
  EXPECT_THROW(walk_plan(graph, {}, options), Error);
}

TEST(WalkPlan, GivesTheSameBitsAgain) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const Surroundings surroundings{{}, map_of(box_ahead())};
  Graph first = drive(), second = drive();
  walk_in(first, surroundings);
  walk_in(second, surroundings);
  EXPECT_EQ(write_graph_text(first), write_graph_text(second));
}

TEST(WalkPlan, TellsAfterEveryCycleAndOnlyThen) {
  Graph graph = drive();
  WalkOptions options;
  std::vector<int> executed;
  options.on_cycle = [&executed](const CycleReport& cycle) { executed.push_back(cycle.executed); };
  const WalkReport report = walk_plan(graph, {}, options);
  ASSERT_EQ(executed.size(), 49u);
  for (int i = 0; i < 49; ++i) EXPECT_EQ(executed[i], i);
  EXPECT_EQ(report.map_update_s.size(), 49u);
}

}  // namespace
}  // namespace locograph
