// Every planner ends when it is told to, and says so in the same words.
#include <gtest/gtest.h>
#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/motion/segment_planners.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/timing/path_timing.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/posture/posture_solver.h>

#include "planners/online/drive_past_box.h"
#include "planners/segment_problems.h"

namespace locograph::planner_answer_test {
namespace {

using test::segment_problem;
using test::stance_task;

/// plan: a planner that the termination it is given ends; returns its answer.
template <class Plan>
void expect_ends(const Plan& plan) {
  const PlannerAnswer late = plan(Termination{.deadline = Deadline::after(0.0)});
  EXPECT_EQ(late.status, PlannerStatus::kDeadline) << late.reason;
  EXPECT_FALSE(late.success());
  EXPECT_NE(late.reason.find("the time allowed is used up (allow more)"), std::string::npos)
      << late.reason;
  const std::atomic<bool> stop = true;
  const PlannerAnswer stopped = plan(Termination{.stop = &stop});
  EXPECT_EQ(stopped.status, PlannerStatus::kStopped) << stopped.reason;
  EXPECT_NE(stopped.reason.find("interrupted (start again to go on)"), std::string::npos)
      << stopped.reason;
}

/// The same for a planner that iterates, after one iteration.
template <class Plan>
void expect_counts(const Plan& plan) {
  const auto answer = plan(Termination{.max_iterations = 1});
  EXPECT_EQ(answer.status, PlannerStatus::kNotFound) << answer.reason;
  EXPECT_NE(answer.reason.find("the iterations allowed are used up (allow more)"),
            std::string::npos)
      << answer.reason;
  EXPECT_EQ(answer.statistics.iterations, 1);
}

TEST(PlannerStatus, HasANameOfItsOwn) {
  EXPECT_EQ(planner_status_name(PlannerStatus::kSolved), "solved");
  EXPECT_EQ(planner_status_name(PlannerStatus::kInfeasible), "infeasible");
  EXPECT_EQ(planner_status_name(PlannerStatus::kNotFound), "not_found");
  EXPECT_EQ(planner_status_name(PlannerStatus::kDeadline), "deadline");
  EXPECT_EQ(planner_status_name(PlannerStatus::kStopped), "stopped");
}

TEST(PlannerAnswer, IsNoneWhileNothingEndsTheJob) {
  EXPECT_FALSE(end_by({}, 1000));
  EXPECT_FALSE(end_by({.max_iterations = 3}, 2));
  EXPECT_TRUE(end_by({.max_iterations = 3}, 3));
}

TEST(PlannerAnswer, OfPostures) {
  const Task task = stance_task("slanted_wall");
  const PostureSolver solver(task.robot);
  PostureProblem problem{.stance = task.start, .preferred = task.start_configuration};
  problem.stance.contacts[0].position.x() += 5.0;  // out of reach
  const auto solve = [&](const Termination& termination) {
    return solver.solve(problem, {.termination = termination});
  };
  expect_ends(solve);
  expect_counts(solve);
}

TEST(PlannerAnswer, OfDrives) {
  const Task task = task_of(centauro_drive(1.0, 0.0, 5));
  const auto plan = [&](const Termination& termination) {
    return plan_wheeled_drive(task, {.termination = termination});
  };
  expect_ends(plan);
  const DrivePlan whole = plan({});
  EXPECT_EQ(whole.status, PlannerStatus::kSolved);
  EXPECT_GT(whole.statistics.total_s, 0.0);
}

TEST(PlannerAnswer, OfTimings) {
  const Task task = stance_task("slanted_wall");
  const Robot& robot = *task.robot->robot;
  Eigen::VectorXd to = task.start_configuration;
  to[7] += 0.1;  // rad
  const TimingLimits limits = timing_limits(robot, {.joint_acceleration_rad_s2 = 10.0});
  struct Timed : PlannerAnswer {
    PlannerStatistics statistics = {};
  };
  const auto time = [&](const Termination& termination) {
    const PathTiming timing(robot, {task.start_configuration, to}, limits,
                            {.termination = termination});
    return Timed{timing.answer(), timing.statistics()};
  };
  expect_ends(time);
  expect_counts(time);
  EXPECT_EQ(time({}).status, PlannerStatus::kSolved);
}

TEST(PlannerAnswer, OfPathsOfSegments) {
  const auto problem = segment_problem("board");
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  for (const std::string& name : segment_planner_names()) {
    SCOPED_TRACE(name);
    const auto planner = make_segment_planner(name);
    const auto plan = [&](const Termination& termination) {
      return planner->plan(space, {.termination = termination});
    };
    expect_ends(plan);
    if (name == "optimisation") expect_counts(plan);
    EXPECT_THROW(planner->plan(space, {.max_states = 0}), Error);
  }
}

TEST(PlannerAnswer, OfMotionsOfSegments) {
  const Task task = stance_task("slanted_wall");
  const auto problem = segment_problem("board");
  const MotionOptions options;
  SegmentMover mover(task, options);
  std::vector<BearingContact> bearing;
  for (const Contact& contact : problem->segment.held) bearing.push_back({contact});
  expect_ends([&](const Termination& termination) {
    return mover.move(problem->segment, bearing, 0, mover.planners(), {.termination = termination});
  });
}

TEST(PlannerAnswer, OfTransitions) {
  const Task task = stance_task("slanted_wall");
  const Stance& stance = task.start;
  Stance out_of_reach = stance;
  out_of_reach.contacts[0].position.x() += 5.0;
  TransitionSolver solver(task.robot, task.world->world());
  TransitionProblem problem{.closed = out_of_reach.contacts,
                            .start = task.start_configuration,
                            .preferred = task.start_configuration};
  const auto solve = [&](const Termination& termination) {
    return solver.solve(problem, {.restarts = 3, .termination = termination});
  };
  expect_ends(solve);
  expect_counts(solve);
  const BalanceRegion nowhere;
  problem.balance = &nowhere;
  EXPECT_EQ(solve({}).status, PlannerStatus::kInfeasible);
}

TEST(PlannerAnswer, OfStances) {
  const Task task = stance_task("standing_up");
  for (const std::string& name : stance_planner_names()) {
    SCOPED_TRACE(name);
    const auto planner = make_stance_planner(name);
    const auto plan = [&](const Termination& termination) {
      return planner->plan(task, {.termination = termination});
    };
    expect_ends(plan);
    expect_counts(plan);
  }
}

TEST(PlannerAnswer, OfWholeMotions) {
  const Task task = stance_task("standing_up");
  const auto plan = [&](const Termination& termination) {
    return plan_motion(task, {.termination = termination});
  };
  expect_ends(plan);
  expect_counts(plan);
  EXPECT_THROW(plan_motion(task, {}, {.step_s = 0.0}), Error);
}

TEST(PlannerAnswer, OfWindows) {
  const auto cycle = [](const Termination& termination) {
    Graph graph = drive();
    LocalPlanner planner(graph, {});
    planner.show(seeing({box("rock", {0.5, 0.0, 0.5}, {3.0, 3.0, 1.0})}));  // nowhere to go
    CycleReport report = planner.cycle(0, termination);
    planner.explain(report);
    return report;
  };
  expect_ends(cycle);
  expect_counts(cycle);
  EXPECT_EQ(cycle({}).status, PlannerStatus::kNotFound);
}

TEST(PlannerAnswer, OfWalks) {
  const auto walk = [](const Termination& termination) {
    Graph graph = drive();
    return walk_plan(graph, {}, {.termination = termination});
  };
  expect_ends(walk);
  expect_counts(walk);
}

}  // namespace
}  // namespace locograph::planner_answer_test
