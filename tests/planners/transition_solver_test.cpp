// Configurations between two stances: what has to hold there, and the solver that finds them.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/common/error.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/posture/transition_rows.h>
#include <locograph/planners/posture/transition_solver.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "planners/stance_tasks.h"

namespace locograph::transition_solver_test {
namespace {

using test::contact_of, test::stance_task, test::without_contact;

/// Standing up: COMAN+ on all fours under the arch of quadrupedal_walking.
const Task& on_all_fours() {
  static const Task task = stance_task("standing_up");
  return task;
}

BalanceRegion region_of(const Task& task, const Stance& stance) {
  std::vector<BearingContact> bearing;
  for (const Contact& contact : stance.contacts) bearing.push_back({contact});
  return balance_region(task.robot->robot->total_mass(), bearing, 0.1);
}

Eigen::VectorXd moved(const Robot& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& by) {
  Eigen::VectorXd result(q.size());
  robot.integrate(q.data(), by.data(), result.data());
  return result;
}

/// The base moved by up to `base` (m, rad) and the joints by up to `joints` (rad).
Eigen::VectorXd at_random(const Robot& robot, const Eigen::VectorXd& q, double base, double joints,
                          std::mt19937_64& random) {
  Eigen::VectorXd by(robot.tangent_size());
  for (int i = 0; i < by.size(); ++i) {
    const double most = i < robot.base_tangent_size() ? base : joints;
    by[i] = uniform(random, -most, most);
  }
  return moved(robot, q, by);
}

TransitionProblem problem_of(const Stance& closed, const BalanceRegion* region,
                             const Eigen::VectorXd& start, const Task& task) {
  TransitionProblem problem;
  problem.closed = closed.contacts;
  problem.balance = region;
  problem.start = start;
  problem.preferred = task.start_configuration;
  return problem;
}

class TransitionRowsTest : public testing::Test {
 protected:
  TransitionRowsTest()
      : task(on_all_fours()),
        feet(without_contact(without_contact(task.start, "left_hand"), "right_hand")),
        region(region_of(task, task.start)),
        rows(task.robot, stance_task("quadrupedal_walking").world->world()) {
    // Hands are near the floor and not to touch it.
    rows.set_problem(problem_of(feet, &region, task.start_configuration, task), {});
  }
  const Robot& robot() const { return *task.robot->robot; }

  using Key = std::tuple<TransitionFailure, int, int>;
  std::map<Key, double> values_at(const Eigen::VectorXd& q) {
    rows.evaluate(q);
    std::map<Key, double> values;
    for (const TransitionRows::Row& row : rows.rows()) {
      EXPECT_TRUE(values.emplace(Key(row.kind, row.first, row.second), row.value).second)
          << "twice: " << rows.text(row);
    }
    return values;
  }

  const Task task;
  const Stance feet;
  const BalanceRegion region;
  TransitionRows rows;
};

TEST_F(TransitionRowsTest, GradientsAreThoseOfCentralDifferences) {
  constexpr double kStep = 1e-6, kKink = 1e-3;
  std::mt19937_64 random(3);
  std::map<TransitionFailure, int> compared;
  int all = 0, kinks = 0;
  for (int draw = 0; draw < 6; ++draw) {
    const Eigen::VectorXd q =
        at_random(robot(), task.start_configuration, 0.05, draw == 0 ? 0.02 : 0.3, random);
    const std::map<Key, double> here = values_at(q);
    const std::vector<TransitionRows::Row> all_rows = rows.rows();
    const Eigen::MatrixXd gradients = rows.gradients();
    ASSERT_EQ(gradients.rows(), static_cast<Eigen::Index>(all_rows.size()));
    for (int k = 0; k < robot().tangent_size(); ++k) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(robot().tangent_size(), k);
      const std::map<Key, double> after = values_at(moved(robot(), q, step));
      const std::map<Key, double> before = values_at(moved(robot(), q, -step));
      for (std::size_t i = 0; i < all_rows.size(); ++i) {
        const Key key(all_rows[i].kind, all_rows[i].first, all_rows[i].second);
        if (!after.contains(key) || !before.contains(key)) continue;
        ++all;
        const double forwards = (after.at(key) - here.at(key)) / kStep;
        const double backwards = (here.at(key) - before.at(key)) / kStep;
        if (std::abs(forwards - backwards) > kKink) {  // another sphere or capsule is the nearest
          ++kinks;
          continue;
        }
        ++compared[all_rows[i].kind];
        EXPECT_NEAR(gradients(static_cast<Eigen::Index>(i), k), 0.5 * (forwards + backwards), 1e-5)
            << rows.text(all_rows[i]) << ", coordinate " << k;
      }
    }
  }
  EXPECT_LT(kinks, all / 50);
  for (const TransitionFailure kind : {TransitionFailure::kJoint, TransitionFailure::kBalance,
                                       TransitionFailure::kSelf, TransitionFailure::kSurface}) {
    EXPECT_GT(compared[kind], 0) << transition_failure_name(kind);
  }
}

TEST_F(TransitionRowsTest, TheJacobianOfTheClosureIsThatOfCentralDifferences) {
  constexpr double kStep = 1e-6;
  rows.set_problem(problem_of(task.start, nullptr, task.start_configuration, task), {});
  std::mt19937_64 random(4);
  for (int draw = 0; draw < 5; ++draw) {
    const Eigen::VectorXd q = at_random(robot(), task.start_configuration, 0.1, 0.3, random);
    rows.evaluate(q);
    ASSERT_EQ(rows.closure().size(), 6 + 6 + 3 + 3);
    const Eigen::VectorXd here = rows.closure();
    const Eigen::MatrixXd jacobian = rows.closure_jacobian();
    Eigen::VectorXd after, before;
    for (int k = 0; k < robot().tangent_size(); ++k) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(robot().tangent_size(), k);
      rows.closure_at(moved(robot(), q, step), after);
      rows.closure_at(moved(robot(), q, -step), before);
      EXPECT_LT((jacobian.col(k) - (after - before) / (2.0 * kStep)).norm(), 1e-6)
          << "coordinate " << k;
    }
    EXPECT_EQ(rows.closure(), here) << "closure_at() leaves it as it is";
    EXPECT_EQ(rows.contact_name(0), "left_foot");
    EXPECT_EQ(rows.contact_name(static_cast<int>(here.size()) - 1), "right_hand");
  }
}

TEST_F(TransitionRowsTest, RowsSayWhatIsViolatedAndByHowMuch) {
  Eigen::VectorXd q = task.start_configuration;
  q[2] -= 0.05;  // the hands go into the floor
  values_at(q);
  int in_floor = 0;
  for (const TransitionRows::Row& row : rows.rows()) {
    if (row.kind != TransitionFailure::kSurface || row.value > -0.04) continue;
    ++in_floor;
    EXPECT_NE(rows.text(row).find(" in floor"), std::string::npos) << rows.text(row);
    const std::string& link = robot().links()[static_cast<std::size_t>(rows.links(row).first)].name;
    EXPECT_EQ(rows.text(row).find(link), 0U) << rows.text(row);
  }
  EXPECT_GE(in_floor, 2);

  q = task.start_configuration;
  q[0] += 5.0;
  values_at(q);
  double worst = 0.0;
  for (const TransitionRows::Row& row : rows.rows()) {
    if (row.kind == TransitionFailure::kBalance) worst = std::min(worst, row.value);
  }
  EXPECT_LT(worst, -4.0);
}

TEST_F(TransitionRowsTest, PairsThatAreNearAreLeftAsNear) {
  constexpr double kAsked_m = 0.1;
  TransitionOptions options;
  options.self_margin_m = kAsked_m;
  const auto self_values = [&](const Eigen::VectorXd& q) {
    rows.set_problem(problem_of(feet, &region, task.start_configuration, task), options);
    std::map<std::pair<int, int>, double> values;
    for (const auto& [key, value] : values_at(q)) {
      if (std::get<0>(key) == TransitionFailure::kSelf) {
        values[{std::get<1>(key), std::get<2>(key)}] = value;
      }
    }
    return values;
  };
  const auto before = self_values(task.start_configuration);
  rows.leave_as_near(task.start_configuration, kAsked_m);
  const auto after = self_values(task.start_configuration);
  ASSERT_EQ(before.size(), after.size());
  int near = 0;
  for (const auto& [pair, value] : before) {
    if (value >= 0.0) {
      EXPECT_EQ(after.at(pair), value) << "others are kept apart as asked";
      continue;
    }
    ++near;
    const double distance_m = value + kAsked_m;
    EXPECT_NEAR(after.at(pair), std::min(0.2 * distance_m, distance_m - 4e-3), 1e-12);
  }
  EXPECT_GT(near, 0);
}

/// A foot is lifted off all fours.
class TransitionSolverTest : public testing::Test {
 protected:
  TransitionSolverTest()
      : task(on_all_fours()),
        larger(task.start),
        smaller(without_contact(task.start, "left_foot")),
        region(region_of(task, smaller)) {}
  const Robot& robot() const { return *task.robot->robot; }
  TransitionProblem problem(const Eigen::VectorXd& start, std::uint64_t seed = 0) const {
    TransitionProblem asked = problem_of(larger, &region, start, task);
    asked.seed = seed;
    return asked;
  }
  TransitionProblem problem() const { return problem(task.start_configuration); }

  const Task task;
  const Stance larger, smaller;
  const BalanceRegion region;
};

TransitionOptions restarts(int count) {
  TransitionOptions options;
  options.restarts = count;
  return options;
}

TEST_F(TransitionSolverTest, WhatItFindsTheJudgeAcceptsOnBothStances) {
  TransitionSolver solver(task.robot, task.world->world());
  const TransitionResult result = solver.solve(problem(), restarts(2));
  ASSERT_TRUE(result.success()) << result.reason;
  EXPECT_EQ(result.failure, TransitionFailure::kNone);
  EXPECT_EQ(result.reason, "found");
  const Judge judge(task.robot->robot, task.world);
  for (const bool lifts : {true, false}) {
    Motion motion;
    motion.stances_only = true;
    motion.time_s = {0.0, 1.0};
    motion.configurations = {result.configuration, result.configuration};
    motion.stances = {lifts ? larger : smaller, lifts ? smaller : larger};
    motion.stance_from = {0, 1};
    const CheckReport report = judge.check(motion, task.check);
    EXPECT_TRUE(report.feasible) << violation_text(report.worst());
    ASSERT_TRUE(report.min_balance_margin);
    EXPECT_GT(*report.min_balance_margin, 0.0);
  }
  RobotState state(robot());
  state.update(result.configuration.data());
  EXPECT_GT(region.depth_m(state.center_of_mass().head<2>()), 0.0);
}

TEST_F(TransitionSolverTest, AContactOutOfReachIsNamedWithTheAmount) {
  Stance far = larger;
  contact_of(far, "left_hand").position.x() += 5.0;
  TransitionProblem asked = problem();
  asked.closed = far.contacts;
  TransitionSolver solver(task.robot, task.world->world());
  const TransitionResult result = solver.solve(asked, restarts(1));
  EXPECT_FALSE(result.success());
  EXPECT_EQ(result.statistics.restarts, 1);
  EXPECT_EQ(result.failure, TransitionFailure::kContact);
  EXPECT_GT(result.amount, 1.0);
  EXPECT_NE(result.reason.find("left_hand"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find(" by "), std::string::npos) << result.reason;
  EXPECT_EQ(result.configuration.size(), robot().configuration_size());
  EXPECT_TRUE(result.configuration.allFinite());
}

TEST_F(TransitionSolverTest, AStanceThatBalancesNowhereIsRefusedAtOnce) {
  const BalanceRegion none;
  TransitionProblem asked = problem();
  asked.balance = &none;
  TransitionSolver solver(task.robot, task.world->world());
  const TransitionResult result = solver.solve(asked, restarts(5));
  EXPECT_FALSE(result.success());
  EXPECT_EQ(result.failure, TransitionFailure::kBalance);
  EXPECT_FALSE(result.reason.empty());
  EXPECT_EQ(result.statistics.iterations, 0);
  EXPECT_EQ(result.statistics.restarts, 0);
  asked.balance = nullptr;
  EXPECT_TRUE(solver.solve(asked, restarts(5)).success()) << "balance is not asked for";
}

TEST_F(TransitionSolverTest, ACentreOfMassThatCannotGetThereIsBalance) {
  BalanceRegion away = region;
  for (BalanceRegion::Side& side : away.sides) {
    side.offset_m += side.normal.dot(Eigen::Vector2d(5.0, 0.0));
  }
  TransitionProblem asked = problem();
  asked.balance = &away;
  TransitionSolver solver(task.robot, task.world->world());
  const TransitionResult result = solver.solve(asked);
  EXPECT_FALSE(result.success());
  EXPECT_NE(result.failure, TransitionFailure::kNone);
  EXPECT_GT(result.amount, 1.0);
}

TEST_F(TransitionSolverTest, GivesTheSameBitsForTheSameSeedWhateverItSolvedBefore) {
  std::mt19937_64 random(8);
  std::vector<Eigen::VectorXd> starts;
  for (int i = 0; i < 5; ++i) {
    starts.push_back(at_random(robot(), task.start_configuration, 0.1, 0.4, random));
  }
  TransitionSolver one(task.robot, task.world->world());
  std::vector<TransitionResult> results;
  for (const Eigen::VectorXd& start : starts) {
    results.push_back(one.solve(problem(start, 5), restarts(2)));
  }
  // Memory lies elsewhere, and the problems come in another order.
  for (std::size_t padding = 1; padding <= 3; ++padding) {
    const std::vector<double> elsewhere(1 + 7 * padding);
    TransitionSolver other(task.robot, task.world->world());
    for (std::size_t i = starts.size(); i-- > 0;) {
      const TransitionResult again = other.solve(problem(starts[i], 5), restarts(2));
      EXPECT_EQ(again.success(), results[i].success()) << i;
      EXPECT_EQ(again.statistics.iterations, results[i].statistics.iterations) << i;
      EXPECT_EQ(again.statistics.restarts, results[i].statistics.restarts) << i;
      EXPECT_EQ(again.configuration, results[i].configuration) << i << ": not the same bits";
      EXPECT_EQ(again.reason, results[i].reason) << i;
    }
  }
}

TEST_F(TransitionSolverTest, RestartsFindWhatOneAttemptDoesNot) {
  TransitionSolver solver(task.robot, task.world->world());
  std::mt19937_64 random(21);
  int lost = 0, found_after_all = 0;
  for (int i = 0; i < 60 && found_after_all == 0; ++i) {
    const Eigen::VectorXd start = at_random(robot(), task.start_configuration, 0.3, 0.8, random);
    if (solver.solve(problem(start), restarts(0)).success()) continue;
    ++lost;
    const TransitionResult again = solver.solve(problem(start), restarts(10));
    if (!again.success()) continue;
    ++found_after_all;
    EXPECT_GT(again.statistics.restarts, 0);
  }
  if (lost == 0) GTEST_SKIP() << "one attempt found all";
  EXPECT_GT(found_after_all, 0) << "of " << lost;
}

TEST_F(TransitionSolverTest, RefusesContactsAndRobotsThatMakeNoSense) {
  Stance unsound = larger;
  contact_of(unsound, "left_hand").effector.link = "nowhere";
  TransitionProblem asked = problem();
  asked.closed = unsound.contacts;
  TransitionSolver solver(task.robot, task.world->world());
  EXPECT_THROW(solver.solve(asked), Error);
  EXPECT_TRUE(solver.solve(problem(), restarts(2)).success()) << "it goes on as before";

  RobotOptions fixed;
  fixed.floating_base = false;
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus";
  const auto on_a_plinth =
      std::make_shared<const RobotParameter>(stem + ".urdf", stem + ".srdf", fixed);
  EXPECT_THROW(TransitionSolver(on_a_plinth, task.world->world()), Error);
}

}  // namespace
}  // namespace locograph::transition_solver_test
