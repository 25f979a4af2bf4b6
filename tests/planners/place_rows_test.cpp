// What transitions call free of surfaces, bars and boxes, the judge accepts.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/posture/transition_rows.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planners/stance_tasks.h"

namespace locograph::place_rows_test {
namespace {

using test::stance_task;

/// Go2 on blocks.
const Task& on_stones() {
  static const Task task = stance_task("stepping_stones");
  return task;
}

bool is_free(TransitionRows& rows, const Eigen::VectorXd& q) {
  rows.evaluate(q);
  constexpr double kTolerance_m = 5e-4;  // as the solver's
  return std::ranges::none_of(rows.rows(), [](const TransitionRows::Row& row) {
    return row.kind == TransitionFailure::kSurface && row.value < -kTolerance_m;
  });
}

Eigen::VectorXd at_random(const Robot& robot, const Eigen::VectorXd& q, double base, double joints,
                          std::mt19937_64& random) {
  Eigen::VectorXd by(robot.tangent_size()), moved(q.size());
  for (int i = 0; i < by.size(); ++i) {
    const double most = i < robot.base_tangent_size() ? base : joints;
    by[i] = uniform(random, -most, most);
  }
  robot.integrate(q.data(), by.data(), moved.data());
  return moved;
}

/// Free of everything by the judge's word, and by the rows' that know which contacts are held.
struct Agreement {
  int free = 0, refused = 0, believed = 0;
  std::string last_believed;
};

Agreement compare(const Stance& closed, const Stance& held, int draws, std::uint64_t seed) {
  const Task& task = on_stones();
  const Robot& robot = *task.robot->robot;
  TransitionRows rows(task.robot, task.world->world());
  TransitionProblem problem;
  problem.closed = closed.contacts;
  problem.held = held.contacts;
  rows.set_problem(problem, {});
  const Judge judge(task.robot->robot, task.world);
  CheckOptions options = task.check;
  options.certify_only_if_rest_holds = true;
  std::mt19937_64 random(seed);
  Agreement agreement;
  for (int i = 0; i < draws; ++i) {
    // Up to the edge of the platform and the first stones, tilted and with bent legs.
    Eigen::VectorXd q = task.start_configuration;
    q[0] += uniform(random, 0.0, 0.5);
    q[2] += uniform(random, -0.12, 0.05);
    q = at_random(robot, q, 0.15, 0.8, random);
    const bool free = is_free(rows, q);
    bool accepted = true;
    std::string why;
    for (const Stance* stance : {&closed, &held}) {
      const CheckReport report = judge.check(q, *stance, options);
      for (const char* name : {"ground_penetration", "touching_depth"}) {
        if (report.constraint(name).violated) why = violation_text(report.constraint(name));
      }
      accepted = accepted && why.empty();
    }
    agreement.free += free ? 1 : 0;
    agreement.refused += accepted ? 0 : 1;
    // Feet that are off their contacts and beyond the platform are seen by rows of closure.
    const bool by_foot = std::ranges::any_of(closed.contacts, [&](const Contact& contact) {
      return why.find("(" + contact.effector.link + " and ") != std::string::npos;
    });
    if (!free || accepted || by_foot) continue;
    ++agreement.believed;
    agreement.last_believed = why;
  }
  return agreement;
}

TEST(PlaceRows, WhatIsFreeBesideBoxesTheJudgeAccepts) {
  const Stance& start = on_stones().start;
  const Agreement held = compare(start, start, 400, 1);
  EXPECT_GT(held.free, 20);
  EXPECT_GT(held.refused, 20);
  EXPECT_EQ(held.believed, 0) << held.last_believed;
  // A foot is lifted: its links reach into nothing.
  const Agreement lifted = compare(start, test::without_contact(start, "front_left_foot"), 400, 2);
  EXPECT_GT(lifted.free, 10);
  EXPECT_GT(lifted.refused, 20);
  EXPECT_EQ(lifted.believed, 0) << lifted.last_believed;
}

/// A calf in the stone that its own foot stands on: what rows did not see.
TEST(PlaceRows, ACalfInTheStoneOfItsFootIsSeen) {
  const Task& task = on_stones();
  TransitionRows rows(task.robot, task.world->world());
  TransitionProblem problem;
  problem.closed = task.start.contacts;
  rows.set_problem(problem, {});
  EXPECT_TRUE(is_free(rows, task.start_configuration));
  // The robot upside down about its feet: they touch, and the calves point down.
  Eigen::VectorXd q = task.start_configuration;
  q[2] = -q[2] + 0.02;
  q.segment<4>(3) = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())).coeffs();
  EXPECT_FALSE(is_free(rows, q));
  bool calf = false;
  for (const TransitionRows::Row& row : rows.rows()) {
    if (row.kind != TransitionFailure::kSurface || row.value > -0.02) continue;
    calf = calf || rows.text(row).find("calf in near_platform") != std::string::npos;
  }
  EXPECT_TRUE(calf);
}

TEST(PlaceRows, GradientsBesideBoxesAreThoseOfCentralDifferences) {
  constexpr double kStep = 1e-6, kKink = 1e-3;
  const Task& task = on_stones();
  const Robot& robot = *task.robot->robot;
  TransitionRows rows(task.robot, task.world->world());
  TransitionProblem problem;
  problem.closed = task.start.contacts;
  rows.set_problem(problem, {});
  std::mt19937_64 random(5);
  int compared = 0, kinks = 0, off = 0;
  for (int draw = 0; draw < 16; ++draw) {
    const Eigen::VectorXd q = at_random(robot, task.start_configuration, 0.1, 0.4, random);
    rows.evaluate(q);
    const std::vector<TransitionRows::Row> here = rows.rows();
    const Eigen::MatrixXd gradients = rows.gradients();
    const auto value = [&](const TransitionRows::Row& of, int k, double step) {
      Eigen::VectorXd by = step * Eigen::VectorXd::Unit(robot.tangent_size(), k), moved(q.size());
      robot.integrate(q.data(), by.data(), moved.data());
      rows.evaluate(moved);
      for (const TransitionRows::Row& row : rows.rows()) {
        if (row.kind == of.kind && row.first == of.first && row.second == of.second) {
          return row.value;
        }
      }
      return std::nan("");
    };
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (here[i].kind != TransitionFailure::kSurface) continue;
      for (int k = 0; k < robot.tangent_size(); ++k) {
        const double forwards = (value(here[i], k, kStep) - here[i].value) / kStep;
        const double backwards = (here[i].value - value(here[i], k, -kStep)) / kStep;
        if (!(std::abs(forwards - backwards) < kKink)) {
          ++kinks;
          continue;
        }
        ++compared;
        const double gradient = gradients(static_cast<Eigen::Index>(i), k);
        if (!(std::abs(gradient - 0.5 * (forwards + backwards)) < 1e-4)) ++off;
      }
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_LT(kinks, compared / 20);
  EXPECT_LT(off, compared / 40) << "distances of cylinders are certified to 1e-5 m only";
}

}  // namespace
}  // namespace locograph::place_rows_test
