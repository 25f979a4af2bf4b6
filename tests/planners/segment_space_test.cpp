// What has to hold along a segment, and the tools that planners share.
#include <gtest/gtest.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/offline/motion/segment_space.h>

#include <random>

#include "planners/segment_problems.h"

namespace locograph::segment_space_test {
namespace {

/// A problem's space, set to its segment.
struct Set {
  explicit Set(std::unique_ptr<test::SegmentProblem> of)
      : problem(std::move(of)), space(problem->robot, problem->world) {
    space.set_segment(problem->segment);
  }
  const Segment& segment() const { return problem->segment; }

  std::unique_ptr<test::SegmentProblem> problem;
  SegmentSpace space;
};

Eigen::VectorXd moved(const Robot& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& by) {
  Eigen::VectorXd result(q.size());
  robot.integrate(q.data(), by.data(), result.data());
  return result;
}

Eigen::VectorXd shaken(const Robot& robot, const Eigen::VectorXd& q, double most,
                       std::mt19937_64& random) {
  Eigen::VectorXd by(robot.tangent_size());
  for (double& x : by) x = uniform(random, -most, most);
  return moved(robot, q, by);
}

Eigen::Vector3d point_at(SegmentSpace& space, const Eigen::VectorXd& q, const Contact& contact) {
  Eigen::VectorXd error;
  space.closure(q, error);
  const int link = space.robot().link_index(contact.effector.link);
  return space.state().world_from_link(link) * contact.effector.point;
}

/// The segment's `from` with what it has left this far above its place.
Eigen::VectorXd with_foot_at(const Set& of, double up_m) {
  Segment raised = of.segment();
  raised.held.push_back(raised.left[0]);
  raised.held.back().position += up_m * raised.held.back().normal;
  SegmentSpace space(of.problem->robot, of.problem->world);
  space.set_segment(raised);
  Eigen::VectorXd q = raised.from;
  if (!space.project(q)) throw std::runtime_error("the foot does not get there");
  return q;
}

TEST(SegmentSpaceTest, ClosureJacobianIsThatOfCentralDifferences) {
  constexpr double kStep = 1e-6;
  Set set(test::segment_problem("windows_held"));
  SegmentSpace& space = set.space;
  std::mt19937_64 random(3);
  for (const double far : {0.0, 0.1}) {
    const Eigen::VectorXd q = shaken(space.robot(), set.segment().from, far, random);
    Eigen::VectorXd error, after, before;
    Eigen::MatrixXd jacobian;
    space.closure(q, error, jacobian);
    ASSERT_EQ(jacobian.rows(), 6 + 6 + 3);
    ASSERT_EQ(jacobian.cols(), space.robot().tangent_size());
    for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(jacobian.cols(), i);
      space.closure(moved(space.robot(), q, step), after);
      space.closure(moved(space.robot(), q, -step), before);
      EXPECT_LT((jacobian.col(i) - (after - before) / (2.0 * kStep)).norm(), 1e-7) << i;
    }
  }
}

TEST(SegmentSpaceTest, ProjectionClosesContactsNearby) {
  Set set(test::segment_problem("windows_held"));
  SegmentSpace& space = set.space;
  std::mt19937_64 random(1);
  Eigen::VectorXd error;
  for (int draw = 0; draw < 20; ++draw) {
    const Eigen::VectorXd open = shaken(space.robot(), set.segment().from, 0.05, random);
    Eigen::VectorXd q = open;
    ASSERT_TRUE(space.project(q)) << draw;
    space.closure(q, error);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(q.segment<4>(3).norm(), 1.0, 1e-12);
    EXPECT_LT(space.distance(open, q), space.distance(open, set.segment().from));
  }
}

TEST(SegmentSpaceTest, ProjectionSaysThatContactsAreOutOfReach) {
  Set set(test::segment_problem("windows_held"));
  Segment apart = set.segment();
  apart.held[0].position.x() += 3.0;
  set.space.set_segment(apart);
  Eigen::VectorXd q = apart.from;
  EXPECT_FALSE(set.space.project(q));
}

TEST(SegmentSpaceTest, SaysWhatIsViolated) {
  Set set(test::segment_problem("board"));
  SegmentSpace& space = set.space;
  const Robot& robot = space.robot();
  const auto why_not = [&](const Eigen::VectorXd& q) -> std::string {
    return space.valid(q) ? "" : space.why_not();
  };
  const Eigen::VectorXd& good = set.segment().from;
  EXPECT_EQ(why_not(good), "");

  Eigen::VectorXd bent = good;
  const Joint& last = robot.active_joint(robot.active_joint_count() - 1);
  bent[bent.size() - 1] = last.upper + 0.2;
  EXPECT_NE(why_not(bent).find(last.name), std::string::npos) << why_not(bent);

  Eigen::VectorXd ahead = good;
  ahead.x() -= 0.4;
  EXPECT_NE(why_not(ahead).find("centre of mass"), std::string::npos) << why_not(ahead);

  Eigen::VectorXd raised = good, sunk = good;
  raised.z() += 0.02;
  EXPECT_EQ(why_not(raised), "") << "contacts are not looked at";
  sunk.z() -= 0.05;
  EXPECT_NE(why_not(sunk).find("ground"), std::string::npos) << why_not(sunk);

  test::SegmentProblem blocked = *set.problem;
  const int hand = robot.link_index("LBall");
  space.valid(good);
  Eigen::VectorXd error;
  space.closure(good, error);
  const Eigen::Vector3d at = space.state().world_from_link(hand).translation();
  blocked.world.solids = {test::box_between("crate", at.array() - 0.03, at.array() + 0.03)};
  SegmentSpace within(blocked.robot, blocked.world);
  within.set_segment(set.segment());
  EXPECT_FALSE(within.valid(good));
  EXPECT_NE(within.why_not().find("crate"), std::string::npos) << within.why_not();
}

TEST(SegmentSpaceTest, SeesAThinObstacleBetweenTwoValidEnds) {
  auto problem = test::segment_problem("board");
  const Eigen::VectorXd from = problem->segment.from, to = problem->segment.to;
  problem->world.solids.clear();
  {
    SegmentSpace open(problem->robot, problem->world);
    open.set_segment(problem->segment);
    EXPECT_TRUE(open.valid_between(from, to)) << open.why_not();
  }
  problem->world.solids = {test::box_between("sheet", {0.25, 0.2495, 0.6}, {0.9, 0.2505, 1.5})};
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  EXPECT_TRUE(space.valid(from)) << space.why_not();
  EXPECT_TRUE(space.valid(to)) << space.why_not();
  EXPECT_FALSE(space.valid_between(from, to));
  EXPECT_NE(space.why_not().find("sheet"), std::string::npos) << space.why_not();
}

TEST(SegmentSpaceTest, AFootThatSwingsMayBeNearItsPlaceButNotInIt) {
  const Set set(test::step_forward_problem());
  SegmentSpace space(set.problem->robot, set.problem->world);
  space.set_segment(set.segment());
  for (const double up_m : {0.0, 0.002, 0.02}) {
    EXPECT_TRUE(space.valid(with_foot_at(set, up_m), true)) << up_m << ": " << space.why_not();
  }
  const Eigen::VectorXd low = with_foot_at(set, 0.002);
  EXPECT_FALSE(space.valid(low)) << "trees begin and end higher";
  EXPECT_TRUE(space.valid(with_foot_at(set, 0.02))) << space.why_not();
  for (const double down_m : {0.004, 0.02}) {
    EXPECT_FALSE(space.valid(with_foot_at(set, -down_m), true)) << down_m;
  }
}

TEST(SegmentSpaceTest, LiftsOffAlongNormals) {
  Set set(test::step_forward_problem());
  SegmentSpace& space = set.space;
  ASSERT_TRUE(space.lift_off()) << space.why_not();
  const Eigen::Vector3d up = space.lift_off_m() * Eigen::Vector3d::UnitZ();
  const Contact &left = set.segment().left[0], &reached = set.segment().reached[0];
  EXPECT_LT((point_at(space, space.from(), left) - left.position - up).norm(), 1e-3);
  EXPECT_LT((point_at(space, space.to(), reached) - reached.position - up).norm(), 1e-3);
  EXPECT_EQ(space.lifted().front(), set.segment().from);
  EXPECT_EQ(space.landing().back(), set.segment().to);
  EXPECT_TRUE(space.valid(space.from())) << space.why_not();
  EXPECT_TRUE(space.valid(space.to())) << space.why_not();
  for (std::size_t i = 1; i < space.lifted().size(); ++i) {
    const Eigen::Vector3d before = point_at(space, space.lifted()[i - 1], left);
    const Eigen::Vector3d now = point_at(space, space.lifted()[i], left);
    EXPECT_GT(now.z(), before.z());
    EXPECT_LT((now - left.position).head<2>().norm(), 1e-3);
  }
}

TEST(SegmentSpaceTest, HasNothingToLiftWhereNothingSwings) {
  Set set(test::segment_problem("board"));
  ASSERT_TRUE(set.space.lift_off());
  EXPECT_EQ(set.space.from(), set.segment().from);
  EXPECT_EQ(set.space.to(), set.segment().to);
  EXPECT_EQ(set.space.lifted().size(), 1U);
  EXPECT_EQ(set.space.landing().size(), 1U);
}

TEST(SegmentSpaceTest, SaysThatAFootIsHeldDown) {
  Set set(test::step_forward_problem());
  auto& solids = set.problem->world.solids;
  // A lid above the foot, with room for it as it stands.
  const Eigen::Vector3d at = set.segment().left[0].position;
  solids = {test::box_between("lid", at + Eigen::Vector3d(0.06, -0.05, 0.05),
                              at + Eigen::Vector3d(0.3, 0.05, 0.07))};
  SegmentSpace space(set.problem->robot, set.problem->world);
  space.set_segment(set.segment());
  EXPECT_FALSE(space.lift_off());
  EXPECT_FALSE(space.why_not().empty());
}

TEST(SegmentSpaceTest, FindsAConfigurationWithMoreContacts) {
  Set set(test::step_forward_problem());
  const Contact& reached = set.segment().reached[0];
  Eigen::VectorXd q, error;
  ASSERT_TRUE(set.space.solve(set.segment().from, std::vector<Contact>{reached}, q))
      << set.space.why_not();
  EXPECT_LT((point_at(set.space, q, reached) - reached.position).norm(), 1e-6);
  set.space.closure(q, error);
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_TRUE(set.space.valid(q, true)) << set.space.why_not();

  Contact far = reached;
  far.position.x() += 1.5;
  EXPECT_FALSE(set.space.solve(set.segment().from, std::vector<Contact>{far}, q));
  EXPECT_NE(set.space.why_not().find("right_foot"), std::string::npos) << set.space.why_not();
}

}  // namespace
}  // namespace locograph::segment_space_test
