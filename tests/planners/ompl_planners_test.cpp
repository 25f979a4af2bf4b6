// Planners of segments by OMPL's random trees, on segments without a straight way.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <locograph/planners/offline/motion/ompl_manifold.h>
#include <locograph/planners/offline/motion/ompl_planners.h>
#include <locograph/planners/offline/motion/shorten_way.h>
#include <ompl/base/Constraint.h>
#include <ompl/util/RandomNumbers.h>

#include <Eigen/LU>
#include <string>
#include <thread>
#include <vector>

#include "common/sanitized.h"
#include "planners/segment_problems.h"

namespace locograph::ompl_planners_test {
namespace {

using test::segment_problem, test::SegmentProblem;

constexpr int kEnough = 40000;

SegmentOptions options_of(std::uint64_t seed, int max_states = kEnough) {
  SegmentOptions options;
  options.seed = seed;
  options.max_states = max_states;
  return options;
}

SegmentPath path_through(const SegmentPlanner& planner, const SegmentProblem& problem,
                         const SegmentOptions& options) {
  SegmentSpace space(problem.robot, problem.world);
  space.set_segment(problem.segment);
  return planner.plan(space, options);
}

std::unique_ptr<SegmentPlanner> planner_of(const std::string& name) {
  return name == "rrt_connect" ? make_rrt_connect() : make_atlas_rrt_star();
}

class TreePlannersTest : public testing::TestWithParam<std::string> {};

TEST_P(TreePlannersTest, FindWaysWhereNoneIsStraight) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const auto planner = planner_of(GetParam());
  EXPECT_EQ(planner->name(), GetParam());
  for (const std::string& name : test::segment_problem_names()) {
    SCOPED_TRACE(name);
    const auto problem = segment_problem(name);
    SegmentSpace space(problem->robot, problem->world);
    space.set_segment(problem->segment);
    EXPECT_FALSE(space.valid_between(problem->segment.from, problem->segment.to));
    const SegmentPath path = planner->plan(space, options_of(1));
    ASSERT_TRUE(path.success()) << path.reason;
    ASSERT_GE(path.waypoints.size(), 3U);
    EXPECT_EQ(path.waypoints.front(), problem->segment.from);
    EXPECT_EQ(path.waypoints.back(), problem->segment.to);
    Eigen::VectorXd error;
    for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
      const Eigen::VectorXd& q = path.waypoints[i];
      space.closure(q, error);
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-8) << i;
      EXPECT_NEAR(q.segment<4>(3).norm(), 1.0, 1e-12) << i;
      EXPECT_TRUE(space.valid(q)) << i << ": " << space.why_not();
      if (i == 0) continue;
      EXPECT_LE(space.distance(path.waypoints[i - 1], q), 0.15 + 1e-12) << i;
      EXPECT_TRUE(space.valid_between(path.waypoints[i - 1], q)) << i << ": " << space.why_not();
    }
    EXPECT_GT(path.first_length, 0.0);
    EXPECT_LE(path.tree_length, path.first_length);
    EXPECT_LT(way_length(space, path.waypoints), path.tree_length);
  }
}

/// Whatever draws its numbers from OMPL's own generator, and on another thread.
TEST_P(TreePlannersTest, GiveTheSameBitsForASeedWhateverOmplDidBefore) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const auto planner = planner_of(GetParam());
  const auto windows = segment_problem("windows"), other = segment_problem("windows_held");
  const SegmentPath once = path_through(*planner, *windows, options_of(3));
  ASSERT_TRUE(once.success()) << once.reason;
  path_through(*planner, *other, options_of(4));
  for (int i = 0; i < 17; ++i) ompl::RNG().uniform01();
  const SegmentPath again = path_through(*planner, *windows, options_of(3));
  SegmentPath elsewhere;
  std::thread([&] { elsewhere = path_through(*planner, *windows, options_of(3)); }).join();
  for (const SegmentPath& path : {again, elsewhere}) {
    EXPECT_EQ(path.waypoints, once.waypoints);
    EXPECT_EQ(path.first_length, once.first_length);
    EXPECT_EQ(path.tree_length, once.tree_length);
  }
  const SegmentPath different = path_through(*planner, *windows, options_of(5));
  EXPECT_NE(different.waypoints, once.waypoints) << "of another seed";
}

TEST_P(TreePlannersTest, SayThatTheyFoundNothing) {
  const auto planner = planner_of(GetParam());
  const auto problem = segment_problem("board");
  const SegmentPath few = path_through(*planner, *problem, options_of(0, 20));
  EXPECT_FALSE(few.success());
  EXPECT_TRUE(few.waypoints.empty());
  EXPECT_NE(few.reason.find("states"), std::string::npos) << few.reason;

  SegmentOptions late = options_of(0);
  late.termination.deadline = Deadline::after(0.0);
  EXPECT_FALSE(path_through(*planner, *problem, late).success());
}

TEST_P(TreePlannersTest, PrintNothing) {
  const auto planner = planner_of(GetParam());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  path_through(*planner, *segment_problem("board"), options_of(0, 500));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

INSTANTIATE_TEST_SUITE_P(All, TreePlannersTest, testing::Values("rrt_connect", "atlas_rrt_star"),
                         [](const auto& planner) { return planner.param; });

/// Also where the quaternion's norm is not 1, and on either of its signs.
TEST(OmplManifoldTest, JacobianOfTheConstraintIsThatOfCentralDifferences) {
  constexpr double kStep = 1e-6;
  const auto problem = segment_problem("windows_held");
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  const Waypoints way = {problem->segment.from, problem->segment.to};
  const ompl::base::ConstraintPtr constraint = projected_manifold(space, way, 0)->getConstraint();
  const auto rows = static_cast<Eigen::Index>(constraint->getCoDimension());
  ASSERT_EQ(rows, 6 + 6 + 3 + 1);
  for (const double norm : {1.0, 0.9, -1.1}) {
    Eigen::VectorXd x = to_coordinates(way[0], way[0]);
    x.segment<4>(3) *= norm;
    x.tail<5>().array() += 0.1;
    Eigen::MatrixXd jacobian(rows, x.size());
    constraint->jacobian(x, jacobian);
    Eigen::VectorXd after(rows), before(rows);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
      constraint->function(x + step, after);
      constraint->function(x - step, before);
      EXPECT_LT((jacobian.col(i) - (after - before) / (2.0 * kStep)).norm(), 1e-7) << i;
    }
  }
}

TEST(AtlasRrtStarTest, ShortensTheFirstWay) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  const auto problem = segment_problem("windows_held");
  int shorter = 0;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const SegmentPath path = path_through(*make_atlas_rrt_star(), *problem, options_of(seed));
    if (path.success() && path.tree_length < 0.99 * path.first_length) ++shorter;
  }
  EXPECT_GT(shorter, 0);
}

/// Functions of Eigen that are compiled here, for other alignments, would free what those of OMPL
/// allocate.
TEST(OmplLibraryTest, FindsItsOwnEigen) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(40, 40);
  EXPECT_EQ(matrix.partialPivLu().determinant(), 1.0);
  void* const found = dlsym(
      RTLD_DEFAULT, "_ZN5Eigen12PartialPivLUINS_6MatrixIdLin1ELin1ELi0ELin1ELin1EEEE7computeEv");
  ASSERT_NE(found, nullptr);
  Dl_info where{};
  ASSERT_NE(dladdr(found, &where), 0);
  EXPECT_NE(std::string(where.dli_fname).find("libompl"), std::string::npos) << where.dli_fname;
}

TEST(ShortenWayTest, LeavesOutADetourAndKeepsTheEnds) {
  const auto problem = segment_problem("windows");
  World open = problem->world;
  open.solids.clear();
  SegmentSpace space(problem->robot, open);
  space.set_segment(problem->segment);
  const Eigen::VectorXd &from = problem->segment.from, &to = problem->segment.to;
  Eigen::VectorXd aside = space.half_way(from, to);
  aside.tail<1>()[0] += aside.tail<1>()[0] > 0.0 ? -0.4 : 0.4;
  ASSERT_TRUE(space.project(aside));
  std::vector<Eigen::VectorXd> way = {from};
  ASSERT_TRUE(join(space, way, aside)) << space.why_not();
  ASSERT_TRUE(join(space, way, to)) << space.why_not();
  EXPECT_GT(way_length(space, way), 1.2 * space.distance(from, to));
  shorten(space, way, 1, 0);
  EXPECT_LT(way_length(space, way), 1.1 * space.distance(from, to));
  EXPECT_EQ(way.front(), from);
  EXPECT_EQ(way.back(), to);
}

TEST(ShortenWayTest, DoesNotJoinThroughAWall) {
  const auto problem = segment_problem("windows");
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  std::vector<Eigen::VectorXd> way = {problem->segment.from};
  EXPECT_FALSE(join(space, way, problem->segment.to));
  EXPECT_EQ(way.size(), 1U) << "as before";
}

}  // namespace
}  // namespace locograph::ompl_planners_test
