#include <locograph/common/error.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/planners/online/free_drive.h>
#include <locograph/planners/online/local_planner.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>

#include "benchmarks/planners/crossing_cases.h"
#include "common/sanitized.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace local_planner_test {

/// Of what was executed of a plan.
void expect_feasible_until(const Graph& graph, int last, const std::vector<Obstacle>& obstacles) {
  Plan executed = plan_of(graph);
  executed.slots.resize(static_cast<std::size_t>(last) + 1);
  executed.stance_from.resize(executed.slots.size());
  expect_feasible(
      check_step(executed.robot->robot, motion_of(graph, executed), world_of(obstacles)));
}

TEST(LocalPlanner, NeverChangesWhatIsExecutedNorTheStart) {
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  planner.show(seeing({box_ahead()}));
  std::vector<Eigen::VectorXd> executed;
  for (int at = 0; at + 1 < planner.plan_size(); ++at) {
    executed.push_back(configurations(graph)[at]);
    ASSERT_TRUE(planner.cycle(at).next_feasible) << at;
    const std::vector<Eigen::VectorXd> now = configurations(graph);
    for (int i = 0; i <= at; ++i) ASSERT_EQ(now[i], executed[i]) << "in cycle " << at;
  }
  EXPECT_EQ(executed.front(), configurations(drive()).front());
}

TEST(LocalPlanner, ChangesNothingAfterTheWindow) {
  Graph graph = drive();
  LocalPlannerOptions options;
  options.horizon = 30;
  LocalPlanner planner(graph, options);
  planner.show(seeing({box_ahead()}));
  planner.cycle(0);
  const std::vector<Eigen::VectorXd> now = configurations(graph), before = configurations(drive());
  EXPECT_NE(now[25], before[25]);
  for (int i = 31; i < 50; ++i) EXPECT_EQ(now[i], before[i]) << i;
}

TEST(LocalPlanner, TakesItsHorizonInSecondsToo) {
  Graph graph = drive();
  LocalPlannerOptions options;
  const Plan plan = plan_of(graph);
  options.horizon_s = 1e-3 + graph.vertex(VertexId<VertexConfiguration>{plan.slots[4]}).time_s -
                      graph.vertex(VertexId<VertexConfiguration>{plan.slots[0]}).time_s;
  LocalPlanner planner(graph, options);
  EXPECT_EQ(planner.last_of_window(0), 4);
  EXPECT_EQ(planner.cycle(0).window, 4);
  options.horizon_s = -1.0;
  EXPECT_THROW(LocalPlanner(graph, options), Error);
}

TEST(LocalPlanner, RefusesAnExecutedConfigurationThatHasNoNext) {
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  EXPECT_THROW(planner.cycle(-1), Error);
  EXPECT_THROW(planner.cycle(49), Error);
  EXPECT_EQ(planner.cycle(48).window, 1);
}

TEST(LocalPlanner, RefusesMeasurementsThatAreNone) {
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  const Eigen::VectorXd q = configurations(graph)[3];
  const auto refused = [&](const Eigen::VectorXd& measured, const std::string& why) {
    try {
      planner.measure(measured);
      ADD_FAILURE() << "taken: " << why;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused(q.head(10), "of 10 numbers");
  Eigen::VectorXd wrong = q;
  wrong[8] = std::numeric_limits<double>::quiet_NaN();
  refused(wrong, "not finite");
  wrong = q;
  wrong.segment<4>(3).setZero();
  refused(wrong, "quaternion has the norm 0");
  wrong = q;
  wrong.segment<4>(3) *= 1.0 + 1e-5;  // as single precision gives it
  planner.measure(wrong);
  EXPECT_TRUE(planner.cycle(3).success());
  EXPECT_NEAR(configurations(graph)[3].segment<4>(3).norm(), 1.0, 1e-12);
}

TEST(LocalPlanner, RefusesAnOlderWorld) {
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  const auto of_time = [](double stamp_s) {
    return std::make_shared<const WorldSnapshot>(world_of({box_ahead()}), stamp_s);
  };
  planner.show(of_time(2.0));
  planner.show(of_time(2.0));
  EXPECT_THROW(planner.show(of_time(1.9)), Error);
  planner.show(of_time(2.1));
}

TEST(LocalPlanner, RestoresTheWeightsItRaised) {
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  // Nowhere to go: violated whatever is tried.
  planner.show(seeing({box("rock", {0.5, 0.0, 0.5}, {3.0, 3.0, 1.0})}));
  const CycleReport report = planner.cycle(0);
  EXPECT_FALSE(report.success());
  EXPECT_GT(report.statistics.rounds, 0);
  const Graph fresh = drive();
  ASSERT_EQ(graph.edge_pools().size(), fresh.edge_pools().size());
  for (std::size_t p = 0; p < graph.edge_pools().size(); ++p) {
    const EdgePool& pool = *graph.edge_pools()[p];
    for (int i = 0; i < pool.size(); ++i) {
      ASSERT_EQ(pool.information(i), fresh.edge_pools()[p]->information(i));
    }
  }
}

TEST(LocalPlanner, CompilesTheSameWindowForAShortAndALongPlanAndKeepsItsPattern) {
  Graph short_plan = planned_drive(centauro_drive(4.0, 0.0, 50));
  Graph long_plan = planned_drive(centauro_drive(160.0, 0.0, 2000));
  LocalPlanner near(short_plan, {}), far(long_plan, {});
  near.cycle(0);
  far.cycle(0);
  near.cycle(1);
  const BlockPattern pattern = near.compiled_window().pattern();
  const int edges = near.compiled_window().edge_count();
  EXPECT_EQ(pattern.size(), 20);
  EXPECT_EQ(pattern.scalar_size(), 20 * 30);
  EXPECT_EQ(pattern.blocks(), 20 + 19 + 18) << "neighbours, and theirs: accelerations";
  const auto expect_same_window = [&](LocalPlanner& planner, int executed) {
    const CycleReport report = planner.cycle(executed);
    const Problem& window = planner.compiled_window();
    EXPECT_TRUE(window.pattern() == pattern) << executed;
    EXPECT_EQ(window.edge_count(), edges);
    EXPECT_EQ(report.window, 20);
    std::size_t active = 0;
    for (const auto& pool : window.active()) active += pool.size();
    EXPECT_EQ(active, 22u) << "the window, the executed configuration and the one before";
  };
  for (int executed = 2; executed < 30; ++executed) expect_same_window(near, executed);
  for (int executed = 1; executed < 60; ++executed) expect_same_window(far, executed);
}

/// A constraint that the planners have never heard of, as a plug-in would bring it: the base stays
/// on this side of a fence.
struct EdgeFence : WeightedEdge<1, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr double kTolerance = 0.01;
  double x_m = 0.0;
  void error(const ConfigurationState& q, Eigen::Ref<Eigen::Matrix<double, 1, 1>> e) const {
    e[0] = std::max(0.0, q.base_position().x() - x_m);
  }
  RowLabel row_label(int) const { return {"beyond the fence", "m"}; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_FENCE", EdgeFence)

void add_fence(Graph& graph, double x_m) {
  EdgeFence fence;
  fence.x_m = x_m;
  fence.weights[0] = 1e2;  // far too little to hold by itself
  for (const int slot : plan_of(graph).slots) {
    graph.add_edge(fence, VertexId<VertexConfiguration>{slot});
  }
}

TEST(LocalPlanner, RaisesAConstraintOfAPlugInUntilItHolds) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  Graph graph = drive();
  add_fence(graph, 1.0);
  LocalPlanner planner(graph, {});
  int raised = 0;
  for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
    const CycleReport report = planner.cycle(executed);
    raised += report.statistics.rounds > 0 ? 1 : 0;
    if (!report.next_feasible) break;
    EXPECT_LE(configurations(graph)[executed + 1][0], 1.0 + EdgeFence::kTolerance + 1e-9);
  }
  EXPECT_GT(raised, 0);
}

TEST(LocalPlanner, SeesAConstraintThatAFixedConfigurationViolates) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  Graph graph = drive();
  add_fence(graph, 3.0);
  const Plan plan = plan_of(graph);
  graph.set_fixed(VertexId<VertexConfiguration>{plan.slots[45]}, true);  // at 3.67 m
  const Eigen::VectorXd before = configurations(graph)[45];
  LocalPlanner planner(graph, {});
  CycleReport report = planner.cycle(0);
  EXPECT_TRUE(report.success()) << "it is not in the window yet";
  for (int executed = 1; executed <= 30; ++executed) report = planner.cycle(executed);
  EXPECT_FALSE(report.success());
  EXPECT_EQ(configurations(graph)[45], before);
}

TEST(LocalPlanner, SeesAccelerationsAcrossTheSeam) {
  Graph graph = drive();
  const Plan plan = plan_of(graph);
  // Standing still until now, and no way to move on as fast as planned.
  for (int i = 0; i < 3; ++i) {
    const auto id = [&](int k) { return VertexId<VertexConfiguration>{plan.slots[k]}; };
    EdgeAccelerationLimits limit(*plan.robot->robot, 0.0, 0.0, 0.0, 1e4);
    limit.limits[plan.robot->robot->active_joint_count()] = 1e-3;
    graph.add_edge(limit, id(i), id(i + 1), id(i + 2));
  }
  graph.vertex(VertexId<VertexConfiguration>{plan.slots[1]}).state =
      graph.vertex(VertexId<VertexConfiguration>{plan.slots[0]}).state;
  LocalPlanner planner(graph, {});
  planner.cycle(1);
  const std::vector<Eigen::VectorXd> now = configurations(graph);
  const double step_s = 40.0 / 49.0;
  EXPECT_LT((now[2] - now[1]).head<3>().norm(), 1e-3 * step_s * step_s * 2.0);
}

TEST(LocalPlanner, NeverGivesUpAFeasibleWindowForADeadline) {
  for (const double deadline_s : {1e-6, 2e-4, 1e-3, 5e-3}) {
    Graph graph = drive();
    LocalPlanner planner(graph, LocalPlannerOptions());
    const auto in_time = [deadline_s] {
      return Termination{.deadline = Deadline::after(deadline_s)};
    };
    for (int executed = 0; executed < 10; ++executed) {
      ASSERT_TRUE(planner.cycle(executed, in_time()).success())
          << deadline_s << " s, cycle " << executed;
    }
    planner.show(seeing({box_ahead()}));
    int feasible_steps = 0, executed = 10;
    for (; executed + 1 < planner.plan_size(); ++executed) {
      const CycleReport report = planner.cycle(executed, in_time());
      EXPECT_GE(report.feasible_steps, feasible_steps - 1) << deadline_s << " s, " << executed;
      feasible_steps = report.feasible_steps;
      if (!report.next_feasible) break;
    }
    expect_feasible_until(graph, executed, {box_ahead()});
  }
}

TEST(LocalPlanner, MakesTheSamePlanWithADeadlineThatIsGenerous) {
  Graph without = drive(), with = drive();
  LocalPlanner free(without, LocalPlannerOptions()), bound(with, LocalPlannerOptions());
  for (LocalPlanner* planner : {&free, &bound}) planner->show(seeing({box_ahead()}));
  for (int executed = 0; executed < 25; ++executed) {
    free.cycle(executed);
    bound.cycle(executed, {.deadline = Deadline::after(1e4)});
  }
  EXPECT_EQ(write_graph_text(without), write_graph_text(with));
}

/// Until there is nothing left to do; the most that one of the cycles did.
struct Steps {
  int cycles = 0, iterations = 0;
  bool success = false;
};
Steps search_in_steps(LocalPlanner& planner, int executed) {
  Steps steps;
  for (; steps.cycles < 2000; ++steps.cycles) {
    const CycleReport report = planner.cycle(executed, {.max_iterations = 1});
    steps.iterations = std::max(steps.iterations, report.statistics.iterations);
    steps.success = report.success();
    const WindowStatistics& did = report.statistics;
    if (did.compile_s + did.optimise_s == 0.0 && !report.detour) break;
  }
  return steps;
}

TEST(LocalPlanner, FindsTheSameWayInCyclesOfOneStep) {
  Graph at_once = drive(), in_steps = drive();
  LocalPlannerOptions options;
  options.horizon = 30;
  LocalPlanner one(at_once, options), many(in_steps, options);
  for (LocalPlanner* planner : {&one, &many}) planner->show(seeing({box_ahead()}));
  const CycleReport report = one.cycle(0);
  ASSERT_TRUE(report.detour);
  const Steps steps = search_in_steps(many, 0);
  EXPECT_GT(steps.cycles, 10);
  EXPECT_EQ(steps.iterations, 1);
  EXPECT_EQ(steps.success, report.success());
  const auto farthest = [](const Graph& graph) {
    double most = 0.0;
    for (const Eigen::VectorXd& q : configurations(graph)) {
      if (std::abs(q[1]) > std::abs(most)) most = q[1];
    }
    return most;
  };
  ASSERT_GT(std::abs(farthest(at_once)), 0.3);
  EXPECT_NEAR(farthest(in_steps) / farthest(at_once), 1.0, 0.2) << "the same side, as far";
}

TEST(LocalPlanner, GoesOnWithItsSearchInAWorldThatChangesWithEveryCycle) {
  Graph graph = drive();
  LocalPlannerOptions options;
  options.horizon = 30;
  LocalPlanner planner(graph, options);
  CycleReport report;
  int cycles = 0;
  do {
    planner.show(seeing({box_ahead()}));
    report = planner.cycle(0, {.max_iterations = 1});
  } while (!report.success() && ++cycles < 300);
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_GT(cycles, 10);
}

TEST(LocalPlanner, DoesNothingWhereNothingHasChanged) {
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  planner.show(seeing({box_ahead()}));
  search_in_steps(planner, 0);
  const std::string found = write_graph_text(graph);
  const CycleReport again = planner.cycle(0);
  EXPECT_EQ(again.statistics.iterations, 0);
  EXPECT_EQ(again.statistics.compile_s, 0.0);
  EXPECT_EQ(write_graph_text(graph), found);
  planner.plan_changed();
  EXPECT_GT(planner.cycle(0).statistics.compile_s, 0.0);
  planner.show(seeing({}));
  EXPECT_GT(planner.cycle(0).statistics.iterations, 0) << "back to the plan";
}

// crossing_campaign counts those of 24 crossings.
TEST(LocalPlanner, WaitsForPersonsAndCallsFeasibleWhatTheJudgeAccepts) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  CrossingOptions options;
  options.every = 60;
  int arrived = 0, called = 0, wrongly = 0, judged = 0, agreed = 0;
  std::string refused;
  for (const Crossing& crossing : crossings(6)) {
    const CrossingResult result = run_crossing(centauro_drive(), crossing, options);
    arrived += result.arrived ? 1 : 0;
    EXPECT_TRUE(result.arrived || result.stopped_safely) << result.reason;
    called += result.called_feasible;
    wrongly += result.wrongly_feasible;
    judged += result.judged_feasible;
    agreed += result.agreed_feasible;
    if (!result.refused.empty()) refused += result.refused + "; ";
  }
  EXPECT_GE(arrived, 5);
  EXPECT_GT(judged, 20);
  EXPECT_GE(agreed, 0.95 * judged);
  EXPECT_GT(called, 20);
  EXPECT_EQ(wrongly, 0) << refused;
}

TEST(WaitForFreeDrive, LooksAtWhatMovesAsOftenAsThePlanDoes) {
  const auto task = std::make_shared<const Task>(task_of(centauro_drive()));
  const Motion planned = plan_wheeled_drive(*task).motion;
  Graph stopped = *drive_graph(*task, planned);
  constexpr int kAt = 6;
  cut_plan(stopped, plan_of(stopped), kAt);
  Obstacle person = box("person", {2.0, 4.0, 0.9}, {0.5, 0.5, 1.8});
  KeyFrame there;
  there.time_s = 30.0;
  there.pose.translation() << 2.0, -4.0, 0.9;
  person.motion.push_back(there);
  const auto world = std::make_shared<const WorldSnapshot>(world_of({person}));
  const ResumedPlan waited = wait_for_free_drive(stopped, planned, *task, world);
  ASSERT_TRUE(waited.success()) << waited.reason;
  const double usual_s = planned.time_s[11] - planned.time_s[10];
  EXPECT_GT(waited.waits_s, 4.0 * usual_s);
  const Motion goes_on = motion_of(*waited.graph, plan_of(*waited.graph));
  for (std::size_t i = kAt + 1; i < goes_on.time_s.size(); ++i) {
    EXPECT_LE(goes_on.time_s[i] - goes_on.time_s[i - 1], 2.0 * usual_s + 1e-9) << i;
  }
  const Eigen::VectorXd off = goes_on.configurations.back() - planned.configurations.back();
  EXPECT_LT(off.lpNorm<Eigen::Infinity>(), 1e-4);
}

TEST(WaitForFreeDrive, LooksAtWhatIsThereForLessThanAStep) {
  const auto task = std::make_shared<const Task>(task_of(centauro_drive()));
  const Motion planned = plan_wheeled_drive(*task).motion;
  Graph stopped = *drive_graph(*task, planned);
  constexpr int kAt = 20, kThere = 32;
  cut_plan(stopped, plan_of(stopped), kAt);
  Obstacle flash = box("flash", {planned.configurations[kThere][0], 0.0, 0.7}, {0.3, 0.3, 0.3});
  flash.appears_s = 0.5 * (planned.time_s[kThere] + planned.time_s[kThere + 1]);
  flash.vanishes_s = flash.appears_s + 1e-3;
  const auto world = std::make_shared<const WorldSnapshot>(world_of({flash}));
  const ResumedPlan waited = wait_for_free_drive(stopped, planned, *task, world);
  ASSERT_TRUE(waited.success()) << waited.reason;
  EXPECT_GT(waited.waits_s, 0.0);
  const Motion goes_on = motion_of(*waited.graph, plan_of(*waited.graph));
  EXPECT_TRUE(check_step(task->robot->robot, goes_on, world->world()).feasible);
}

}  // namespace local_planner_test
}  // namespace locograph
