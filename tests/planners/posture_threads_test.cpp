// Several threads share a PostureSolver. scripts/test.sh runs this under ThreadSanitizer, too.
#include <gtest/gtest.h>
#include <locograph/planners/posture/posture_solver.h>

#include <thread>
#include <vector>

#include "benchmarks/planners/random_contact_sets.h"
#include "common/sanitized.h"

namespace locograph::test {
namespace {

constexpr int kThreads = 3;
constexpr int kProblems = kSanitized ? 3 : 9;

std::vector<PostureProblem> random_problems(const PostureRobot& robot) {
  ContactSets sets(robot, 17);
  std::vector<PostureProblem> problems;
  for (int i = 0; i < kProblems; ++i) {
    const ContactSet set = sets.draw();
    problems.push_back({set.stance, placed_at(robot.model(), robot.home, set.stance)});
  }
  return problems;
}

// Each thread solves all problems, beginning with another one, so that they meet in the solver's
// memory of earlier solves at every stage. To rounding, as in posture_solver_test.cpp.
TEST(PostureSolverOnThreads, TakesTheSameStepsAsOnOne) {
  const PostureRobot robot = posture_robot("coman_plus", LOCOGRAPH_SOURCE_DIR, "");
  const std::vector<PostureProblem> problems = random_problems(robot);
  PostureOptions options;
  options.max_restarts = 2;
  options.max_iterations = kSanitized ? 15 : 60;

  std::vector<PostureResult> alone;
  const PostureSolver used_by_one(robot.robot);
  for (const PostureProblem& problem : problems) {
    alone.push_back(used_by_one.solve(problem, options));
  }

  const PostureSolver shared(robot.robot);
  std::vector<std::vector<PostureResult>> results(kThreads, std::vector<PostureResult>(kProblems));
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < kProblems; ++i) {
        const int p = (i + t) % kProblems;
        results[t][p] = shared.solve(problems[p], options);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();

  for (const std::vector<PostureResult>& of_thread : results) {
    for (int p = 0; p < kProblems; ++p) {
      EXPECT_EQ(of_thread[p].success(), alone[p].success()) << "problem " << p;
      EXPECT_EQ(of_thread[p].statistics.restarts, alone[p].statistics.restarts) << "problem " << p;
      EXPECT_EQ(of_thread[p].statistics.iterations, alone[p].statistics.iterations)
          << "problem " << p;
      const Eigen::VectorXd difference = of_thread[p].configuration - alone[p].configuration;
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << "problem " << p;
    }
  }
}

}  // namespace
}  // namespace locograph::test
