// A whole motion as a graph: what `plan` writes of it.
#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>
#include <locograph/check/judge.h>
#include <locograph/common/uniform.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/core/violations.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/rolling/edge_ball_rolling.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_moving_balance.h>
#include <locograph/plugins/static_balance/edge_wrench_tracking.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>
#include <locograph/plugins/surface_distance/edge_surface_distance.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_tracking/edge_acceleration_tracking.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/solvers/linear_solvers.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/allocation_counter.h"
#include "planners/stance_tasks.h"

namespace locograph::test {
namespace {

/// COMAN+ stays at its start: in all contacts, then without the left hand, one second each.
class MotionGraph : public testing::Test {
 protected:
  static constexpr int kCount = 11, kChange = 5;

  MotionGraph() : scenario(changed_scenario("standing_up", {})) {
    task = started_task(scenario).task;
    task.moves = {.most_m = 0.02, .seed = 3, .draws = 1};
    plan.status = PlannerStatus::kSolved;
    Motion& motion = plan.motion;
    motion.stances = {task.start, without_contact(task.start, "left_hand")};
    for (int i = 0; i < kCount; ++i) {
      motion.time_s.push_back(0.2 * i);
      motion.configurations.push_back(task.start_configuration);
      motion.stance_from.push_back(i < kChange ? 0 : 1);
      const Stance& stance = motion.stances[static_cast<std::size_t>(motion.stance_from.back())];
      const BalanceCertificate certificate =
          certify_balance(*task.robot->robot, task.start_configuration, stance.contacts, {});
      motion.wrenches.push_back(certificate.wrenches);
    }
    for (int j = 0; j < 2; ++j) {
      SegmentRecord& segment = plan.segments.emplace_back();
      segment.stance = j;
      segment.first = j * kChange;
      segment.last = (j + 1) * kChange;
      segment.duration_s = 1.0;
      segment.planner = "interpolation";
    }
  }

  /// In all contacts.
  void balance_all_along() {
    plan.motion.stance_from.assign(kCount, 0);
    plan.motion.wrenches.assign(kCount, plan.motion.wrenches.front());
    plan.segments.resize(1);
    plan.segments.front().last = kCount - 1;
    plan.segments.front().duration_s = 2.0;
  }

  static TypeRegistry types() {
    TypeRegistry registry;
    add_robot_types(registry);
    return registry;
  }

  Scenario scenario;
  Task task;
  MotionPlan plan;
};

TEST_F(MotionGraph, SaysAllThatThePlanKnows) {
  const std::string text = write_graph_text(motion_graph(task, plan));
  const Graph graph = read_graph_text(text, "plan.g2o", ".", types());
  const Plan read = plan_of(graph);
  EXPECT_FALSE(read.incomplete);
  EXPECT_EQ(read.moves.most_m, 0.02);
  ASSERT_EQ(read.segments.size(), 2U);
  EXPECT_EQ(read.segments[0].last, kChange);
  EXPECT_EQ(read.segments[1].first, kChange);
  EXPECT_EQ(read.segments[1].last, kCount - 1);
  EXPECT_EQ(read.segments[1].duration_s, 1.0);
  EXPECT_EQ(read.segments[1].planner, "interpolation");
  const Motion motion = motion_of(graph, read);
  EXPECT_EQ(motion.time_s, plan.motion.time_s);
  EXPECT_EQ(motion.stance_from, plan.motion.stance_from);
  for (std::size_t i = 0; i < motion.configurations.size(); ++i) {
    EXPECT_TRUE(motion.configurations[i] == plan.motion.configurations[i]) << i;
    EXPECT_EQ(motion.wrenches[i], plan.motion.wrenches[i]) << i;
  }
  EXPECT_TRUE(graph.vertex_record(read.slots.front()).fixed);
  EXPECT_FALSE(graph.vertex_record(read.slots.back()).fixed);
  // Again the same bytes: weights, too, whatever way they are written.
  EXPECT_EQ(write_graph_text(graph), text);
}

TEST_F(MotionGraph, BothStancesHoldWhereTheyChange) {
  const Graph graph = motion_graph(task, plan);
  const std::size_t all = plan.motion.stances[0].contacts.size();
  const Plan read = plan_of(graph);
  std::vector<std::size_t> contacts(static_cast<std::size_t>(kCount));
  for (const EdgeContact& edge : graph.edges_of<EdgeContact>()) {
    const auto at = std::ranges::find(read.slots, edge.vertices[0]);
    ++contacts[static_cast<std::size_t>(at - read.slots.begin())];
  }
  // Balls that were held before roll to where they are.
  for (const EdgeBallRolling& edge : graph.edges_of<EdgeBallRolling>()) {
    const auto at = std::ranges::find(read.slots, edge.vertices[1]);
    ++contacts[static_cast<std::size_t>(at - read.slots.begin())];
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    EXPECT_EQ(contacts[i], i <= kChange ? all : all - 1) << i;
  }
}

TEST_F(MotionGraph, ABallThatSlipsInThePlanMaySlipByAsMuch) {
  const auto slips = [&](double by_m, double lifted_m = 0.0) {
    MotionPlan moved = plan;
    moved.motion.configurations[3][2] += lifted_m;
    moved.motion.configurations[3].head<2>() += by_m * Eigen::Vector2d::Ones();
    Graph graph =
        read_graph_text(write_graph_text(motion_graph(task, moved)), "moved", ".", types());
    const std::vector<ConstraintViolation> off = violations(graph);
    return std::ranges::count(off, "EDGE_BALL_ROLLING", &ConstraintViolation::tag);
  };
  EXPECT_EQ(slips(0.0), 0);
  EXPECT_EQ(slips(3e-5), 0);
  EXPECT_EQ(slips(2e-4), 0) << "the judge lets it";
  EXPECT_GT(slips(2e-3), 0) << "he does not";
  EXPECT_GT(slips(2e-4, 1.5e-4), 0) << "nor a ball in the air";
}

TEST_F(MotionGraph, WrenchesBalanceEachConfigurationWhereTheyAreKnown) {
  const Graph graph = motion_graph(task, plan);
  EXPECT_EQ(graph.vertices_of<VertexWrenches>().size(), static_cast<std::size_t>(kCount));
  for (const VertexWrenches& wrenches : graph.vertices_of<VertexWrenches>()) {
    EXPECT_GT(wrenches.state.norm(), 100.0);
  }
  plan.motion.wrenches.clear();
  const Graph without = motion_graph(task, plan);
  EXPECT_TRUE(without.vertices_of<VertexWrenches>().empty());
  EXPECT_TRUE(without.edges_of<EdgeBalance>().empty());
}

TEST_F(MotionGraph, LinksThatLookTooNearHaveNoWeight) {
  const Graph graph = motion_graph(task, plan);
  ASSERT_EQ(graph.edges_of<EdgeSelfCollision>().size(), static_cast<std::size_t>(kCount));
  const EdgeSelfCollision& edge = graph.edges_of<EdgeSelfCollision>().front();
  ConfigurationState state(task.robot);
  state.update(task.start_configuration.data());
  EdgeSelfCollision weighted = edge;
  weighted.weights.setOnes();
  Eigen::VectorXd lack(edge.weights.size());
  weighted.error(state, lack);
  for (Eigen::Index p = 0; p < lack.size(); ++p) {
    EXPECT_EQ(edge.weights[p] > 0.0, lack[p] == 0.0) << p;
  }
}

TEST_F(MotionGraph, HasEveryConstraintAndEveryCost) {
  const Graph graph = motion_graph(task, plan);
  const auto count = static_cast<std::size_t>(kCount);
  EXPECT_EQ(graph.edges_of<EdgePlanTracking>().size(), count);
  EXPECT_EQ(graph.edges_of<EdgeJointLimits>().size(), count);
  EXPECT_EQ(graph.edges_of<EdgeSurfaceDistance>().size(), count);
  EXPECT_EQ(graph.edges_of<EdgeBalance>().size(), 2u);
  EXPECT_EQ(graph.edges_of<EdgeMovingBalance>().size(), count - 2);
  EXPECT_EQ(graph.edges_of<EdgeContactWrench>().size(), count);
  EXPECT_EQ(graph.edges_of<EdgeWrenchTracking>().size(), count);
  EXPECT_EQ(graph.edges_of<EdgeAccelerationTracking>().size(), count - 2);
  EXPECT_GE(graph.edges_of<EdgeVelocityTracking>().size(), 2u);  // next to rest
  EXPECT_EQ(graph.edges_of<EdgeVelocityLimits>().size(), count - 1);
  EXPECT_EQ(graph.edges_of<EdgeSweptObstacleDistance>().size(), count - 1);
  EXPECT_EQ(graph.edges_of<EdgeAccelerationLimits>().size(), count - 2);
}

TEST_F(MotionGraph, JointsKeepTheRoomThatTheyHaveWhereItIsLessThanTheMargin) {
  const Robot& robot = *task.robot->robot;
  const Joint& joint = robot.active_joint(0);
  ASSERT_TRUE(std::isfinite(joint.lower));
  const Eigen::Index at = robot.base_configuration_size();
  const std::vector<double> rooms = {2e-4, 0.0, -1e-5};
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    plan.motion.configurations[i + 1][at] = joint.lower + rooms[i];
  }
  const Graph graph = motion_graph(task, plan);
  const auto& edges = graph.edges_of<EdgeJointLimits>();
  EXPECT_DOUBLE_EQ(edges[0].margin, 1e-3);
  EXPECT_NEAR(edges[1].margin, 2e-4, 1e-12);
  EXPECT_NEAR(edges[2].margin, 0.0, 1e-12);
  EXPECT_EQ(edges[3].margin, 0.0);
}

double most_moved(const Graph& graph, const std::vector<Eigen::VectorXd>& from) {
  const Motion motion = motion_of(graph, plan_of(graph));
  double most = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    most = std::max(most, (motion.configurations[i] - from[i]).lpNorm<Eigen::Infinity>());
  }
  return most;
}

TEST_F(MotionGraph, OptimisedItStaysWhereItIsAndDisturbedItComesBack) {
  balance_all_along();
  Graph graph = motion_graph(task, plan);
  const auto solver = make_linear_solver("auto");
  OptimiserOptions options = OptimiserOptions::for_any_start();
  options.max_iterations = 50;
  optimise(graph, options, *solver);
  EXPECT_LT(most_moved(graph, plan.motion.configurations), 1e-3);
  std::mt19937_64 random(7);
  for (int i = 1; i < kCount; ++i) {
    Eigen::VectorXd& q = graph.vertex(VertexId<VertexConfiguration>{graph.slot_of(i)}).state;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      if (k < 3 || k >= 7) q[k] += uniform(random, -5e-3, 5e-3);  // all but the quaternion
    }
  }
  ASSERT_GT(most_moved(graph, plan.motion.configurations), 4e-3);
  optimise(graph, options, *solver);
  EXPECT_LT(most_moved(graph, plan.motion.configurations), 1e-3);
}

TEST_F(MotionGraph, WrenchesAreCarriedToWhereConfigurationsMove) {
  balance_all_along();
  Graph graph = motion_graph(task, plan);
  const Plan in_graph = plan_of(graph);
  const Motion before = motion_of(graph, in_graph);
  const Judge judge(task.robot->robot, World{});
  const auto wrenches = [&] {
    return judge.check(motion_of(graph, in_graph), {}).constraint("plan_wrenches");
  };
  carry_wrenches(before, in_graph, graph);
  EXPECT_EQ(motion_of(graph, in_graph).wrenches, before.wrenches) << "nothing moved";

  for (int i = 1; i < kChange; ++i) {
    const double bump_m = 0.01 * std::pow(std::sin(std::numbers::pi * i / kChange), 2);
    graph.vertex(VertexId<VertexConfiguration>{graph.slot_of(i)}).state[0] += bump_m;
  }
  EXPECT_FALSE(judge.check(before, {}).constraint("plan_wrenches").violated);
  const Violation off = wrenches();
  EXPECT_TRUE(off.violated);
  EXPECT_TRUE(off.what.ends_with("of the weight is left over")) << off.what;
  carry_wrenches(before, in_graph, graph);
  EXPECT_FALSE(wrenches().violated) << violation_text(wrenches());
  const Motion after = motion_of(graph, in_graph);
  for (std::size_t i = kChange + 1; i < after.wrenches.size(); ++i) {
    EXPECT_EQ(after.wrenches[i], before.wrenches[i]) << "at rest as before, " << i;
  }
}

TEST_F(MotionGraph, TwentyIterationsAllocateNothing) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  // In two stances, and disturbed, so that there is work for twenty iterations.
  Graph graph = motion_graph(task, plan);
  for (int i = 1; i < kCount; ++i) {
    graph.vertex(VertexId<VertexConfiguration>{graph.slot_of(i)}).state[2] += 2e-3 * (i % 3);
  }
  Problem compiled;
  compiled.compile(graph);
  Workspace workspace;
  workspace.allocate(compiled);
  const auto solver = make_linear_solver("auto");
  OptimiserOptions options = OptimiserOptions::for_any_start();
  options.max_iterations = 20;
  options.gain = 0.0;
  int iterations = 0;
  long allocations = 0;
  for (int start = 0; start < 20 && iterations < 20; ++start) {
    workspace.load_state();
    Optimiser optimiser(options);
    optimiser.start(workspace, *solver);
    const long before = allocation_count();
    while (optimiser.iterate()) {
    }
    allocations += allocation_count() - before;
    iterations += optimiser.result().iterations;
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GE(iterations, 20);
}

TEST_F(MotionGraph, AnIndexTellsWhereEverythingIs) {
  const Graph graph = motion_graph(task, plan);
  const Plan read = plan_of(graph);
  for (int i = 0; i < kCount; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const int slot = read.slots[k];
    EXPECT_EQ(read.index.configuration[static_cast<std::size_t>(slot)], i);
    EXPECT_EQ(read.index.segment[k], i < kChange ? 0 : 1);
    ASSERT_EQ(read.index.wrenches[k].size(), 1U);
    const int wrenches = read.index.wrenches[k].front();
    EXPECT_EQ(read.index.configuration[static_cast<std::size_t>(wrenches)], -1);
    EXPECT_EQ(graph.vertex(VertexId<VertexWrenches>{wrenches}).contact_numbers,
              read.stance_from[k]->contact_numbers);
  }
}

TEST_F(MotionGraph, WrenchesAtFewerContactsThanBearAreNotKnown) {
  Graph graph = motion_graph(task, plan);
  const Plan read = plan_of(graph);
  // Configuration kChange is left without the left hand; the one before stands on all.
  const int some = read.index.wrenches[kChange].front(), slot = read.index.wrenches[0].front();
  const VertexWrenches few = graph.vertex(VertexId<VertexWrenches>{some});
  const int id = graph.vertex_record(slot).id;
  graph.remove_vertex(slot);
  const auto forces = graph.add_vertex(id, few);
  graph.add_edge(EdgeBalance(1.0, 1.0), VertexId<VertexConfiguration>{read.slots[0]}, forces);
  const Motion motion = motion_of(graph, plan_of(graph));
  EXPECT_TRUE(motion.wrenches[0].empty());
  EXPECT_FALSE(motion.wrenches[1].empty());
}

TEST_F(MotionGraph, RefusesWrenchesThatDoNotFit) {
  plan.motion.wrenches.pop_back();
  EXPECT_THROW(motion_graph(task, plan), Error);
  plan.motion.wrenches.push_back({Eigen::Matrix<double, 6, 1>::Zero()});
  EXPECT_THROW(motion_graph(task, plan), Error);
}

TEST_F(MotionGraph, TakesSomeThousandCharactersForEachConfiguration) {
  const double text = static_cast<double>(write_graph_text(motion_graph(task, plan)).size());
  EXPECT_LT(text / kCount, 4800.0);
}

TEST_F(MotionGraph, APlanThatIsCutEndsItsSegments) {
  Graph graph = motion_graph(task, plan);
  for (int i = 8; i < kCount; ++i) graph.remove_vertex(graph.slot_of(i));
  EXPECT_THROW(plan_of(graph), Error);
  mark_incomplete(graph);
  Plan read = plan_of(graph);
  ASSERT_EQ(read.segments.size(), 2U);
  EXPECT_EQ(read.segments[1].last, 7);
  EXPECT_NEAR(read.segments[1].duration_s, 0.4, 1e-12);
  for (int i = kChange + 1; i < 8; ++i) graph.remove_vertex(graph.slot_of(i));
  mark_incomplete(graph);
  read = plan_of(graph);
  ASSERT_EQ(read.segments.size(), 1U);
  EXPECT_EQ(read.segments[0].last, kChange);
}

TEST_F(MotionGraph, RefusesAMotionThatItCannotSay) {
  plan.motion.stance_from[3] = -1;
  EXPECT_THROW(motion_graph(task, plan), Error);
  plan.motion = {};
  EXPECT_THROW(motion_graph(task, plan), Error);
}

}  // namespace
}  // namespace locograph::test
