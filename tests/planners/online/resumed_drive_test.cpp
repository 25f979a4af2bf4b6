#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/resumed_drive.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/world/octree.h>

#include <atomic>

#include "common/sanitized.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace resumed_drive_test {

/// The robot drives into it, and nothing is free to either side.
std::vector<Obstacle> trap() {
  return {box("ahead", {2.4, 0.0, 0.5}, {0.2, 2.0, 1.0}),
          box("left", {1.6, 1.2, 0.5}, {1.6, 0.2, 1.0}),
          box("right", {1.6, -1.2, 0.5}, {1.6, 0.2, 1.0})};
}

struct Drive {
  const Task task = task_of(centauro_drive());
  const Motion planned = plan_wheeled_drive(task).motion;

  Graph graph() const { return *drive_graph(task, planned); }
  Graph stopped_at(int configuration) const {
    Graph stopped = graph();
    cut_plan(stopped, plan_of(stopped), configuration);
    return stopped;
  }
  /// Along the ground: the robot keeps its height.
  double off_goal_m(const Graph& reached) const {
    return (configurations(reached).back() - planned.configurations.back()).head<2>().norm();
  }
};

/// `--replan` of refine.
WalkReport walk_in(const Drive& drive, Graph& graph, const std::vector<Obstacle>& obstacles) {
  WalkOptions options = walk_options_for(plan_of(graph));
  options.verify = [&](const Motion& step) {
    return check_step(drive.task.robot->robot, step, world_of(obstacles));
  };
  options.resume = [&](const Graph& stopped) -> std::optional<Graph> {
    ResumedPlan resumed = resume_drive(stopped, drive.planned, drive.task, seeing(obstacles));
    return std::move(resumed.graph);
  };
  const auto world = seeing(obstacles);
  return walk_plan(
      graph, [&world](int executed) { return executed == 0 ? world : nullptr; }, options);
}

TEST(ResumedDrive, GetsOutOfATrapAndToItsGoal) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  const Drive drive;
  Graph graph = drive.graph();
  const WalkReport report = walk_in(drive, graph, trap());
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_EQ(report.resumed, 1);
  EXPECT_LT(drive.off_goal_m(graph), 1e-3);
  expect_feasible(check_plan(graph, trap()));
}

TEST(ResumedDrive, GoesToTheGoalFromBesideIt) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  // It passes this one, and has no way left to come back on.
  const std::vector<Obstacle> late = {box("late", {3.0, 0.0, 0.5}, {0.4, 1.4, 1.0})};
  const Drive drive;
  Graph alone = drive.graph();
  const auto world = seeing(late);
  const WalkReport beside = walk_plan(
      alone, [&world](int executed) { return executed == 0 ? world : nullptr; },
      walk_options_for(plan_of(alone)));
  ASSERT_FALSE(beside.success());
  EXPECT_FALSE(beside.stopped_at.has_value()) << beside.reason;
  Graph graph = drive.graph();
  const WalkReport report = walk_in(drive, graph, late);
  EXPECT_TRUE(report.success()) << report.reason;
  EXPECT_GE(report.resumed, 1);
  EXPECT_LT(drive.off_goal_m(graph), 1e-3);
  expect_feasible(check_plan(graph, late));
}

TEST(ResumedDrive, BeginsAnywhereEvenBeforeTheFirstStep) {
  const Drive drive;
  for (const int at : {0, 20}) {
    const Graph stopped = drive.stopped_at(at);
    const ResumedPlan resumed = resume_drive(stopped, drive.planned, drive.task, seeing({}));
    ASSERT_TRUE(resumed.success()) << resumed.reason;
    EXPECT_LT(drive.off_goal_m(*resumed.graph), 1e-6);
    const std::vector<Eigen::VectorXd> before = configurations(stopped),
                                       after = configurations(*resumed.graph);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], before[i]) << i;
    expect_feasible(check_plan(*resumed.graph, {}));
  }
}

TEST(ResumedDrive, TurnsAsFarAsThePlanDoes) {
  const Task task = task_of(centauro_drive(4.0, 1.0));
  const Motion planned = plan_wheeled_drive(task).motion;
  Graph stopped = *drive_graph(task, planned);
  cut_plan(stopped, plan_of(stopped), 0);
  const ResumedPlan resumed = resume_drive(stopped, planned, task, seeing({}));
  ASSERT_TRUE(resumed.success()) << resumed.reason;
  // 4 rad: more than half round, which the judge of the drive counts.
  const std::vector<Eigen::VectorXd> all = configurations(*resumed.graph);
  double turned = 0.0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    turned += turn_between(all[i - 1].data(), all[i].data());
  }
  EXPECT_NEAR(turned, 4.0, 1e-6);
  EXPECT_LT((all.back() - planned.configurations.back()).head<2>().norm(), 1e-6);
}

TEST(ResumedDrive, GoesAroundWhatAMapShows) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  const Drive drive;
  std::vector<Box> boxes;
  for (const Obstacle& one : trap()) {
    boxes.emplace_back();
    boxes.back().world_from_box = one.world_from_obstacle;
    boxes.back().size = one.size;
  }
  World world;
  world.map = octree_from_boxes(boxes, 0.05);
  const auto seen = std::make_shared<const WorldSnapshot>(std::move(world));
  const ResumedPlan resumed = resume_drive(drive.stopped_at(12), drive.planned, drive.task, seen);
  ASSERT_TRUE(resumed.success()) << resumed.reason;
  EXPECT_LT(drive.off_goal_m(*resumed.graph), 1e-6);
  expect_feasible(check_plan(*resumed.graph, trap()));
}

TEST(ResumedDrive, SaysWhenThereIsNoWay) {
  const Drive drive;
  std::vector<Obstacle> around = trap();
  around.push_back(box("behind", {-1.2, 0.0, 0.5}, {0.2, 2.6, 1.0}));
  around.push_back(box("longer left", {0.0, 1.2, 0.5}, {2.6, 0.2, 1.0}));
  around.push_back(box("longer right", {0.0, -1.2, 0.5}, {2.6, 0.2, 1.0}));
  const ResumedPlan resumed =
      resume_drive(drive.stopped_at(5), drive.planned, drive.task, seeing(around));
  EXPECT_FALSE(resumed.success());
  EXPECT_EQ(resumed.reason, "there is no free way to the goal");
  EXPECT_FALSE(resumed.graph.has_value());
}

TEST(ResumedDrive, EndsWhenItIsToldTo) {
  const Drive drive;
  const std::atomic<bool> stop = true;
  const ResumedPlan resumed = resume_drive(drive.stopped_at(5), drive.planned, drive.task,
                                           seeing(trap()), {.deadline = {}, .stop = &stop});
  EXPECT_EQ(resumed.status, PlannerStatus::kStopped);
}

}  // namespace resumed_drive_test
}  // namespace locograph
