// Plans on legs under the online planner: left as they are, stopped before what is in the way, and
// planned on from there.
#include <gtest/gtest.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/online/ball_slip.h>
#include <locograph/planners/online/free_way.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/planners/posture/contact_projection.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

#include <algorithm>
#include <limits>

#include "common/sanitized.h"
#include "planners/ball_in_the_way.h"
#include "planners/stance_tasks.h"

namespace locograph::test {
namespace {

class WalkOnLegs : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (kSanitized) return;
    task_ = std::make_shared<const Task>(started_task(changed_scenario("standing_up", {})).task);
    plan_ = std::make_shared<const MotionPlan>(plan_motion(*task_, {.seed = 1}));
  }
  static void TearDownTestSuite() {
    plan_.reset();
    task_.reset();
  }
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "takes long there";
    ASSERT_TRUE(plan_->success()) << plan_->reason;
    graph_ = motion_graph(*task_, *plan_);
  }

  const Motion& planned() const { return plan_->motion; }
  Motion now() const { return motion_of(graph_, plan_of(graph_)); }

  /// It is seen when it appears.
  Obstacle in_the_way() {
    const Obstacle ball = ball_in_the_way(planned(), *task_->robot, 1.5);
    seen_s_ = ball.appears_s;
    return ball;
  }

  WalkReport walk(const std::vector<Obstacle>& obstacles, WalkOptions options = {}) {
    World seen, truth = task_->world->world();
    seen.obstacles = truth.obstacles = obstacles;
    for (Obstacle& obstacle : seen.obstacles) obstacle.appears_s = -1e9;
    judging_ = judging_of(task_);
    judging_.world = std::make_shared<const WorldSnapshot>(std::move(truth));
    options.planner.horizon_s = 2.0;
    options.cycle_iterations = 1;
    options.verify = step_check(judging_);
    DistanceFieldOptions view;
    if (const auto ground = plan_of(graph_).world->ground_z_m) view.ground_z = *ground;
    const auto known = std::make_shared<const WorldSnapshot>(seen, 0.0, WorldFiles(), view);
    bool shown = obstacles.empty();
    return walk_plan(
        graph_,
        [&](int executed) -> std::shared_ptr<const WorldSnapshot> {
          if (shown || planned().time_s[static_cast<std::size_t>(executed)] < seen_s_) return {};
          shown = true;
          return known;
        },
        options);
  }

  CheckReport check() {
    const Plan plan = plan_of(graph_);
    judging_.incomplete = plan.incomplete;
    return judged(graph_, plan, judging_);
  }

  static std::shared_ptr<const Task> task_;
  static std::shared_ptr<const MotionPlan> plan_;
  Graph graph_;
  Judging judging_;
  double seen_s_ = 0.0;
};

std::shared_ptr<const Task> WalkOnLegs::task_;
std::shared_ptr<const MotionPlan> WalkOnLegs::plan_;

TEST_F(WalkOnLegs, LeavesAPlanInAnEmptyWorldAsItIsAtAnyRate) {
  for (const double rate_hz : {0.0, 130.0}) {
    graph_ = motion_graph(*task_, *plan_);
    const WalkReport report = walk({}, {.rate_hz = rate_hz});
    ASSERT_TRUE(report.success()) << report.reason;
    const double steps = static_cast<double>(planned().configurations.size()) - 1.0;
    const double cycles = static_cast<double>(report.cycles.size());
    if (rate_hz > 0.0) {
      EXPECT_NEAR(cycles, rate_hz * planned().time_s.back(), 0.2 * cycles);
    } else {
      EXPECT_EQ(cycles, steps);
    }
    EXPECT_EQ(report.feasible_cycles, static_cast<int>(report.cycles.size()));
    const Motion after = now();
    ASSERT_EQ(after.configurations.size(), planned().configurations.size());
    for (std::size_t i = 0; i < after.configurations.size(); ++i) {
      EXPECT_EQ(after.time_s[i], planned().time_s[i]);
      EXPECT_LE((after.configurations[i] - planned().configurations[i]).lpNorm<Eigen::Infinity>(),
                1e-6);
      EXPECT_LE((after.slopes[i] - planned().slopes[i]).lpNorm<Eigen::Infinity>(), 1e-6);
    }
  }
}

TEST_F(WalkOnLegs, StopsAtRestBeforeWhatIsInTheWay) {
  const WalkReport report = walk({in_the_way()});
  EXPECT_FALSE(report.success());
  EXPECT_NE(report.reason.find("near an obstacle on its way (ball)"), std::string::npos)
      << report.reason;
  const Motion stopped = now();
  EXPECT_EQ(report.configurations, static_cast<int>(stopped.configurations.size()));
  EXPECT_LT(report.configurations, static_cast<int>(planned().configurations.size()));
  EXPECT_GT(stopped.time_s.back(), seen_s_);
  EXPECT_TRUE(stopped.slopes.back().isZero(0.0));
  EXPECT_TRUE(plan_of(graph_).incomplete);
  const CheckReport report_of_judge = check();
  EXPECT_TRUE(report_of_judge.feasible) << violation_text(report_of_judge.worst());
  EXPECT_TRUE(report_of_judge.constraint("plan_wrenches").judged);
  EXPECT_GT(report_of_judge.min_clearance_m.value_or(0.0), 0.0);
  // What was executed before it was seen is as it was planned.
  for (std::size_t i = 0; i < stopped.time_s.size() && planned().time_s[i] < seen_s_; ++i) {
    EXPECT_EQ(stopped.configurations[i], planned().configurations[i]) << i;
    EXPECT_EQ(stopped.time_s[i], planned().time_s[i]) << i;
  }
}

TEST_F(WalkOnLegs, IsPlannedOnFromWhereItHasStopped) {
  const std::vector<Obstacle> obstacles = {in_the_way()};
  int asked = 0, executed = 0;
  Motion stopped;
  WalkOptions options;
  options.resume = [&](const Graph& cut) -> std::optional<Graph> {
    ++asked;
    const Plan plan = plan_of(cut);
    stopped = motion_of(cut, plan);
    executed = static_cast<int>(plan.slots.size());
    ResumedPlan resumed = resume_plan(cut, *task_,
                                      std::make_shared<const WorldSnapshot>(world_at_rest(
                                          judging_.world->world(), stopped.time_s.back())),
                                      {.seed = 1});
    EXPECT_TRUE(resumed.success()) << resumed.reason;
    return std::move(resumed.graph);
  };
  const WalkReport report = walk(obstacles, options);
  ASSERT_TRUE(report.success()) << report.reason;
  EXPECT_EQ(report.resumed, asked);
  EXPECT_GE(asked, 1);
  const CheckReport report_of_judge = check();
  EXPECT_TRUE(report_of_judge.feasible) << violation_text(report_of_judge.worst());
  EXPECT_EQ(report_of_judge.ends->goals_reached, report_of_judge.ends->goals);
  const Motion whole = now();
  ASSERT_GT(whole.configurations.size(), static_cast<std::size_t>(executed));
  for (std::size_t i = 0; i < static_cast<std::size_t>(executed); ++i) {
    EXPECT_EQ(whole.configurations[i], stopped.configurations[i]) << i;
  }
}

TEST_F(WalkOnLegs, IsPlannedOnFromWhereContactsChange) {
  const std::vector<int>& stance_from = planned().stance_from;
  std::size_t at = 1;
  while (stance_from[at] == stance_from[at - 1] || !planned().slopes[at].isZero(0.0)) ++at;
  Graph stopped = motion_graph(*task_, *plan_);
  cut_plan(stopped, plan_of(stopped), static_cast<int>(at));
  ASSERT_EQ(plan_of(stopped).segments.back().last, static_cast<int>(at));
  const ResumedPlan resumed = resume_plan(stopped, *task_, judging_of(task_).world, {.seed = 1});
  ASSERT_TRUE(resumed.success()) << resumed.reason;
  const Plan plan = plan_of(*resumed.graph);
  for (const PlanSegment& segment : plan.segments) {
    for (int i = segment.first; i < segment.last; ++i) {
      EXPECT_EQ(plan.stance_from[static_cast<std::size_t>(i)],
                plan.stance_from[static_cast<std::size_t>(segment.first)]);
    }
  }
}

TEST_F(WalkOnLegs, WhatBallsSlipAddsUpSinceTheyTouchedDown) {
  constexpr int kSteps = 20;
  constexpr double kSlip_m = 1e-4, kMost_m = 9e-4;
  OnlinePlan online(graph_);
  const auto& stance_from = online.plan().stance_from;
  const auto has_ball = [&](int i) {
    return std::ranges::any_of(
        stance_from[static_cast<std::size_t>(i)]->contacts,
        [](const auto& contact) { return is_ball(contact->contact.effector); });
  };
  int at = 0;
  while (stance_from[static_cast<std::size_t>(at)] !=
             stance_from[static_cast<std::size_t>(at + kSteps)] ||
         !has_ball(at)) {
    ++at;
  }
  EXPECT_FALSE(most_slipped(online, at + kSteps, 0.0)) << "as planned, whatever it slips";
  for (int k = 1; k <= kSteps; ++k) {
    online.configuration(at + k).head<3>() += k * kSlip_m * Eigen::Vector3d::Ones();
  }
  EXPECT_FALSE(most_slipped(online, at + 1, kMost_m));
  const auto slipped = most_slipped(online, at + kSteps, kMost_m);
  ASSERT_TRUE(slipped.has_value());
  EXPECT_NEAR(slipped->slip_m, std::sqrt(2.0) * kSteps * kSlip_m, 1e-3);
  EXPECT_FALSE(slipped->ball.empty());
}

TEST_F(WalkOnLegs, WaitsUntilTheWayIsFree) {
  Obstacle ball = in_the_way();
  ball.vanishes_s = ball.appears_s + 6.0;
  const std::vector<PlanSegment> segments = plan_of(graph_).segments;
  double waits_s = 0.0;
  std::size_t executed = 0;
  WalkOptions options;
  options.resume = [&](const Graph& stopped) -> std::optional<Graph> {
    executed = plan_of(stopped).slots.size();
    ResumedPlan waited = wait_for_free_way(stopped, planned(), segments, *task_, judging_.world);
    EXPECT_TRUE(waited.success()) << waited.reason;
    waits_s = waited.waits_s;
    return std::move(waited.graph);
  };
  const WalkReport report = walk({ball}, options);
  ASSERT_TRUE(report.success()) << report.reason;
  EXPECT_EQ(report.resumed, 1);
  const CheckReport report_of_judge = check();
  EXPECT_TRUE(report_of_judge.feasible) << violation_text(report_of_judge.worst());
  EXPECT_EQ(report_of_judge.ends->goals_reached, report_of_judge.ends->goals);
  EXPECT_GT(waits_s, 0.5);
  // The way is that of the plan, after the first steps.
  constexpr std::size_t kSlow = 128;
  const Motion whole = now();
  const std::size_t left = planned().configurations.size() - executed - kSlow;
  for (std::size_t i = 1; i <= left; ++i) {
    EXPECT_EQ(whole.configurations.rbegin()[static_cast<long>(i) - 1],
              planned().configurations.rbegin()[static_cast<long>(i) - 1]);
  }
  // Nothing to wait for: it stays, or the robot is elsewhere.
  Graph stopped = motion_graph(*task_, *plan_);
  cut_plan(stopped, plan_of(stopped), static_cast<int>(executed) - 1);
  ball.vanishes_s = std::numeric_limits<double>::infinity();
  judging_ = judging_of(task_);
  World world = judging_.world->world();
  world.obstacles = {ball};
  const auto stays = std::make_shared<const WorldSnapshot>(world);
  const ResumedPlan refused = wait_for_free_way(stopped, planned(), segments, *task_, stays);
  EXPECT_FALSE(refused.success());
  EXPECT_EQ(refused.reason, "the way is not free within 20 s");
  // It stands where the ball is until that is gone.
  Obstacle on_it = ball;
  on_it.world_from_obstacle.translation() = planned().configurations[executed - 1].head<3>();
  on_it.appears_s = planned().time_s[executed - 1] - 1.0;
  on_it.vanishes_s = on_it.appears_s + 3.0;
  world.obstacles = {on_it};
  EXPECT_EQ(wait_for_free_way(stopped, planned(), segments, *task_,
                              std::make_shared<const WorldSnapshot>(world))
                .reason,
            "something meets the robot where it would wait");
  EXPECT_FALSE(wait_for_free_way(stopped, planned(), segments, *task_, judging_.world).success());
}

TEST_F(WalkOnLegs, SaysWhyItIsNotPlannedOn) {
  // Where the robot is to put a foot.
  Obstacle block = in_the_way();
  block.name = "block";
  block.shape = Obstacle::Shape::kBox;
  block.size.setConstant(0.4);
  block.world_from_obstacle.translation() = task_->goals.back().contacts.front().position;
  WalkOptions options;
  PlannerAnswer answer;
  options.resume = [&](const Graph& cut) -> std::optional<Graph> {
    ResumedPlan resumed =
        resume_plan(cut, *task_,
                    std::make_shared<const WorldSnapshot>(
                        world_at_rest(judging_.world->world(), plan_->motion.time_s.back())),
                    {.seed = 1, .termination = {.max_iterations = 200}, .max_transitions = 50});
    answer = resumed;
    EXPECT_FALSE(resumed.graph.has_value());
    return std::move(resumed.graph);
  };
  const WalkReport report = walk({block}, options);
  EXPECT_FALSE(report.success());
  EXPECT_EQ(report.resumed, 0);
  EXPECT_FALSE(answer.success());
  EXPECT_FALSE(answer.reason.empty());
  EXPECT_TRUE(check().feasible);
}

/// A configuration of a plan that is off by as much in each coordinate, on its contacts, balls
/// where they have rolled to.
struct Off {
  std::vector<Contact> contacts;
  Eigen::VectorXd q;
};

/// aside_m: of contacts that do not roll, along what they are on.
Off put_off(const Robot& robot, const Motion& planned, int at, double by, double aside_m) {
  const auto i = static_cast<std::size_t>(at);
  const Eigen::VectorXd& was = planned.configurations[i];
  Off off;
  RobotState state(robot);
  state.update(was.data());
  off.contacts = planned.stances[planned.stance_from[i]].contacts;
  const HeldBalls balls = held_balls(state, off.contacts, [](const Contact&) { return true; });
  for (std::size_t k = 0; k < off.contacts.size(); ++k) {
    Contact& contact = off.contacts[k];
    if (!balls[k]) contact.position += aside_m * axes_in_world(contact).col(0);
  }
  Eigen::VectorXd step(robot.tangent_size());
  for (Eigen::Index k = 0; k < step.size(); ++k) step[k] = k % 2 == 0 ? by : -by;
  off.q.resize(robot.configuration_size());
  robot.integrate(was.data(), step.data(), off.q.data());
  ContactProjection closed(robot);
  closed.set(off.contacts, balls);
  EXPECT_TRUE(closed.project(off.q));
  return off;
}

class OffItsPlan : public WalkOnLegs {
 protected:
  void put_off(double by, double aside_m) {
    Off off = test::put_off(robot(), planned(), kAt, by, aside_m);
    contacts_ = std::move(off.contacts);
    q_ = std::move(off.q);
  }

  const Robot& robot() const { return *task_->robot->robot; }
  const Eigen::VectorXd& was() const { return planned().configurations[kAt]; }

  static constexpr int kAt = 300;
  std::vector<Contact> contacts_;
  Eigen::VectorXd q_;
};

TEST_F(OffItsPlan, IsLedBack) {
  put_off(0.003, 0.0);
  const std::vector<double>& time_s = planned().time_s;
  WalkOptions options = walk_options_for(plan_of(graph_));
  judging_ = judging_of(task_);
  options.verify = step_check(judging_);
  PlanWalk walk(graph_, {}, options, kAt);
  walk.measure(q_);
  while (walk.time_s(walk.executed()) < time_s[kAt] + 2.0) {
    ASSERT_TRUE(walk.step()) << walk.report().reason;
  }
  const Motion now = walk.motion();
  EXPECT_EQ(now.configurations[kAt], q_) << "the robot is where it is";
  const int there = walk.executed();
  Eigen::VectorXd left(robot().tangent_size());
  robot().difference(planned().configurations[there].data(), now.configurations[there].data(),
                     left.data());
  EXPECT_LT(left.lpNorm<Eigen::Infinity>(), 1e-3);
}

/// Contacts change too soon after it: the plan is slowed down, and its segments with it.
TEST_F(OffItsPlan, ByCentimetresIsLedBackToo) {
  put_off(0.01, 0.0);
  ASSERT_GT((q_ - was()).lpNorm<Eigen::Infinity>(), 0.009);
  const Motion before = planned();
  WalkOptions options = walk_options_for(plan_of(graph_));
  judging_ = judging_of(task_);
  options.verify = step_check(judging_);
  PlanWalk walk(graph_, {}, options, kAt);
  walk.measure(q_);
  while (walk.time_s(walk.executed()) < before.time_s[kAt] + 2.0) {
    ASSERT_TRUE(walk.step()) << walk.report().reason;
  }
  const Motion now = walk.motion();
  EXPECT_EQ(now.configurations[kAt], q_);
  Eigen::VectorXd left(robot().tangent_size());
  robot().difference(before.configurations[walk.executed()].data(),
                     now.configurations[walk.executed()].data(), left.data());
  EXPECT_LT(left.lpNorm<Eigen::Infinity>(), 2e-3);
  plan_of(graph_);  // holds segments against configurations, or throws
}

/// What enters the window later is beside its plan by tenths of a millimetre, too.
TEST_F(OffItsPlan, GoesOnEvenlyWhereTheFirstWindowEnded) {
  put_off(0.01, 0.0);
  judging_ = judging_of(task_);
  LocalPlanner planner(graph_, walk_options_for(plan_of(graph_)).planner);
  planner.measure(q_);
  planner.begin_window(kAt);
  const int end = planner.last_of_window(kAt);
  for (int executed = kAt + 1; planner.last_of_window(executed) < end + 6; ++executed) {
    planner.begin_window(executed);
  }
  const CheckReport check =
      step_check(judging_)(motion_of(graph_, planner.plan(), end - 4, end + 4));
  for (const Violation& violation : check.violations) {
    EXPECT_FALSE(violation.violated) << violation_text(violation);
  }
}

/// A hand or a foot closes its contact just after the robot is back: where balls have rolled to by
/// then decides where the way leads to. Or soon, so that it is near its place while it is off.
TEST_F(OffItsPlan, ComesToAContactThatClosesFromOutside) {
  judging_ = judging_of(task_);
  const auto& stance_from = planned().stance_from;
  const auto contacts = [&](std::size_t i) {
    return planned().stances[static_cast<std::size_t>(stance_from[i])].contacts.size();
  };
  std::vector<int> closes;
  for (std::size_t i = 1; i < stance_from.size(); ++i) {
    if (contacts(i) > contacts(i - 1)) closes.push_back(static_cast<int>(i));
  }
  ASSERT_FALSE(closes.empty());
  constexpr double kOff = 0.03;
  int looked_at = 0;
  const auto look_at = [&](int close, double before_s, double by) {
    int at = close;
    while (at > 0 && planned().time_s[close] - planned().time_s[at] < before_s) --at;
    if (stance_from[at] != stance_from[close - 1]) return;
    ++looked_at;
    graph_ = motion_graph(*task_, *plan_);
    const Eigen::VectorXd q = test::put_off(robot(), planned(), at, by, 0.0).q;
    LocalPlanner planner(graph_, walk_options_for(plan_of(graph_)).planner);
    planner.measure(q);
    planner.begin_window(at);
    const CheckReport check = step_check(judging_)(
        motion_of(graph_, planner.plan(), close - 10, planner.last_of_window(at)));
    const Violation& deep = check.constraint("ground_penetration");
    EXPECT_FALSE(deep.violated) << close << ": " << violation_text(deep);
  };
  for (const int close : closes) {
    for (const double before_s : {1.64, 0.45}) {
      for (const double by : {kOff, -kOff}) look_at(close, before_s, by);
    }
  }
  // Every contact that closes is come to from near, where it is off.
  EXPECT_GE(looked_at, 2 * static_cast<int>(closes.size()));
}

TEST_F(OffItsPlan, IsPassedMoreSlowlyInTheMiddle) {
  OnlinePlan plan(graph_);
  const Motion before = planned();
  constexpr int kTo = kAt + 20;
  const double longer_s = 3.0 * (before.time_s[kTo] - before.time_s[kAt]);
  plan.slow_down(kAt, kTo, longer_s);
  const Motion now = motion_of(graph_, plan_of(graph_));
  EXPECT_EQ(now.time_s[kAt], before.time_s[kAt]);
  EXPECT_NEAR(now.time_s[kTo] - now.time_s[kAt], longer_s, 1e-9);
  EXPECT_EQ(now.slopes[kAt], before.slopes[kAt]);
  EXPECT_LT((now.slopes[kTo] - before.slopes[kTo]).norm(), 1e-12);
  const auto step_s = [&](const Motion& of, int i) { return of.time_s[i + 1] - of.time_s[i]; };
  for (int i = kAt; i < kTo; ++i) EXPECT_GE(step_s(now, i), step_s(before, i)) << i;
  EXPECT_GT(step_s(now, kAt + 10), 2.0 * step_s(now, kAt));
  for (int i = kTo; i + 1 < plan.size(); ++i) {
    EXPECT_NEAR(step_s(now, i), step_s(before, i), 1e-9) << i;
  }
}

TEST_F(OffItsPlan, HasItsContactsWhereTheyAre) {
  put_off(0.003, 0.01);
  LocalPlanner planner(graph_, walk_options_for(plan_of(graph_)).planner);
  planner.measure(q_);
  const CycleReport report = planner.cycle(kAt, {.max_iterations = 30});
  EXPECT_GE(report.feasible_steps, 1) << report.reason;
  const Motion now = motion_of(graph_, planner.plan());
  for (const int i : {kAt, kAt + 1}) {
    const Stance& stance = now.stances[now.stance_from[i]];
    ASSERT_EQ(stance.contacts.size(), contacts_.size());
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      EXPECT_LT((stance.contacts[c].position - contacts_[c].position).norm(), 1e-6) << c;
    }
  }
  // What is lifted and put down elsewhere goes to where it was planned.
  const Stance &last = now.stances[now.stance_from.back()],
               &goal = planned().stances[planned().stance_from.back()];
  for (std::size_t c = 0; c < last.contacts.size(); ++c) {
    const bool held = std::ranges::any_of(contacts_, [&](const Contact& contact) {
      return (contact.position - last.contacts[c].position).norm() < 1e-6;
    });
    if (!held) {
      EXPECT_EQ(last.contacts[c].position, goal.contacts[c].position) << c;
    }
  }
}

/// Legs that end in wheels: what their carriers pitch on the way back, wheels that stand turn back.
TEST_F(WalkOnLegs, WheelsThatStandDoNotTurnOnTheWayBack) {
  const auto task =
      std::make_shared<const Task>(started_task(changed_scenario("centauro_platform", {})).task);
  const MotionPlan plan = plan_motion(*task, {.seed = 1});
  ASSERT_TRUE(plan.success()) << plan.reason;
  Graph graph = motion_graph(*task, plan);
  const Motion& planned = plan.motion;
  const int at = static_cast<int>(planned.configurations.size() / 2);
  const Off off = put_off(*task->robot->robot, planned, at, 0.03, 0.0);
  WalkOptions options = walk_options_for(plan_of(graph));
  judging_ = judging_of(task);
  options.verify = step_check(judging_);
  PlanWalk walk(graph, {}, options, at);
  walk.measure(off.q);
  while (walk.time_s(walk.executed()) < planned.time_s[static_cast<std::size_t>(at)] + 2.0) {
    ASSERT_TRUE(walk.step()) << walk.report().reason;
  }
}

TEST_F(WalkOnLegs, PlansOfStancesAreRefused) {
  Graph stances = stance_graph(*task_, plan_->stances);
  EXPECT_THROW(LocalPlanner(stances, {}), Error);
}

TEST(WorldAtRest, IsWhatIsThereThenAndSoonAfter) {
  Obstacle cart, soon, later;
  cart.size.setConstant(0.1);
  cart.motion = {KeyFrame{2.0, Eigen::Isometry3d(Eigen::Translation3d(2.0, 0.0, 0.0))}};
  later.size.setConstant(0.1);
  later.appears_s = 15.0;
  soon = cart;
  soon.appears_s = 1.5;
  soon.vanishes_s = 9.0;
  World world;
  world.obstacles = {cart, soon, later};
  const World now = world_at_rest(world, 1.0);
  ASSERT_EQ(now.obstacles.size(), 2u);
  for (const Obstacle& obstacle : now.obstacles) {
    EXPECT_TRUE(obstacle.motion.empty());
    EXPECT_TRUE(obstacle.is_there(0.0, 100.0));
  }
  EXPECT_NEAR(now.obstacles[0].world_from_obstacle.translation().x(), 1.0, 1e-12);
  EXPECT_NEAR(now.obstacles[1].world_from_obstacle.translation().x(), 1.5, 1e-12);
  EXPECT_EQ(world_at_rest(world, 6.0).obstacles.size(), 3u);
  EXPECT_EQ(world_at_rest(world, 9.5).obstacles.size(), 2u);
}

}  // namespace
}  // namespace locograph::test
