#include "plugins/jacobian_comparison.h"
#include "plugins/legged_cases.h"

namespace locograph::test {
namespace {

constexpr double kBefore_s = 0.2, kAfter_s = 0.35;

class AccelerationLimits : public RobotCaseTest {
 protected:
  /// What is asked of every row: the acceleration of joint, base and rotation.
  struct Wanted {
    Eigen::VectorXd joints;
    Eigen::Vector3d linear, angular;
  };

  /// Three configurations with these accelerations, from random velocities; the edge between them.
  void add(Graph& graph, Random& random, int id, const Wanted& wanted,
           const EdgeAccelerationLimits& edge, double before_s = kBefore_s,
           double after_s = kAfter_s) const {
    const Robot& model = robot.model();
    const int base = robot.base();
    const double half = 0.5 * (before_s + after_s);
    const Eigen::VectorXd here = random.configuration(model, 1.0, 0.0);
    Eigen::VectorXd from = here, to = here;
    const auto split = [&](const Eigen::VectorXd& acceleration, const Eigen::VectorXd& velocity,
                           auto&& back, auto&& forth) {
      back = -before_s * velocity;
      forth = after_s * (velocity + half * acceleration);
    };
    Eigen::VectorXd back, forth;
    split(wanted.joints, random.vector(wanted.joints.size(), 1.0), back, forth);
    from.tail(back.size()) += back;
    to.tail(forth.size()) += forth;
    if (base > 0) {
      split(wanted.linear, random.vector(3, 1.0), back, forth);
      from.head<3>() += back;
      to.head<3>() += forth;
      split(wanted.angular, random.vector(3, 1.0), back, forth);
      const Eigen::Quaterniond rotation(here.segment<4>(3).data());
      const auto turned = [&](const Eigen::Vector3d& by) {
        return (rotation * Eigen::AngleAxisd(by.norm(), by.normalized())).normalized().coeffs();
      };
      from.segment<4>(3) = turned(back);
      to.segment<4>(3) = turned(forth);
    }
    graph.add_edge(edge, add_configuration(graph, robot, 3 * id, 1.0, from),
                   add_configuration(graph, robot, 3 * id + 1, 1.0 + before_s, here),
                   add_configuration(graph, robot, 3 * id + 2, 1.0 + before_s + after_s, to));
  }
  Eigen::VectorXd limits(Random& random) const {
    return Eigen::VectorXd::NullaryExpr(robot.model().active_joint_count() + 2,
                                        [&](Eigen::Index) { return random.uniform(2.0, 8.0); });
  }
  int joints() const { return robot.model().active_joint_count(); }
};

TEST_P(AccelerationLimits, HaveTheJacobianOfNumericDifferences) {
  constexpr double kKinkOfAcceleration = 1e-2;
  Random random(51);
  Graph graph = graph_of(robot);
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd limit = limits(random);
    // Zero to twice the limit, off the limit itself.
    const auto away = [&](double most) {
      const double size = random.uniform(0.1, 2.0 * most);
      return std::abs(size - most) < kKinkOfAcceleration ? most + 2.0 * kKinkOfAcceleration : size;
    };
    Wanted wanted{Eigen::VectorXd(joints()), away(limit[joints()]) * random.direction(),
                  away(limit[joints() + 1]) * random.direction()};
    for (int j = 0; j < joints(); ++j) wanted.joints[j] = random.sign() * away(limit[j]);
    add(graph, random, i, wanted, EdgeAccelerationLimits(limit, 1.0));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    for (const int slot : {0, 1, 2}) compare(evaluated, k, slot, kEverywhere, compared);
  }
  EXPECT_EQ(compared.rows, 3 * kStates * (joints() + 2));
  EXPECT_GT(compared.nonzero, compared.rows / 3);
  EXPECT_GT(compared.zero, compared.rows / 3);
}

TEST_P(AccelerationLimits, AreZeroInsideAndTheExcessOutsideWithUnevenTimeSteps) {
  Random random(52);
  const bool floating = robot.model().floating_base();
  for (const double beyond : {-1.0, -1e-6, 1e-6, 3.0}) {
    for (const double after_s : {0.05, 0.2, 0.7}) {
      Graph graph = graph_of(robot);
      const Eigen::VectorXd limit = limits(random);
      Wanted wanted{limit.head(joints()), (limit[joints()] + beyond) * random.direction(),
                    (limit[joints() + 1] + beyond) * random.direction()};
      for (double& joint : wanted.joints) joint = random.sign() * (joint + beyond);
      add(graph, random, 0, wanted, EdgeAccelerationLimits(limit, 1.0), 0.1, after_s);
      Evaluated evaluated(graph);
      const Eigen::VectorXd e = evaluated.error(0);
      for (int r = 0; r < e.size(); ++r) {
        const bool moves = r < joints() || floating;
        EXPECT_NEAR(e[r], moves ? std::max(0.0, beyond) : 0.0, 1e-11) << "row " << r;
      }
      if (beyond <= 0.0) continue;
      // The gradient does not vanish just beyond the limit.
      for (const int slot : {0, 1, 2}) {
        const Eigen::MatrixXd j = evaluated.jacobian(0, slot, false);
        for (int r = 0; r < (floating ? e.size() : joints()); ++r) EXPECT_GT(j.row(r).norm(), 1.0);
      }
    }
  }
}

TEST_P(AccelerationLimits, OfAParabolaAreThoseOfItsSecondDerivative) {
  // Base and joints at ½ a t², from rest, turning about one axis: sampled where one likes.
  Random random(53);
  const Robot& model = robot.model();
  const double times[] = {0.0, 0.13, 0.49};
  const Eigen::VectorXd start = random.configuration(model, 1.0, 0.0);
  Eigen::VectorXd acceleration(model.tangent_size());
  const Eigen::Vector3d axis = random.direction();
  for (int i = 0; i < model.tangent_size(); ++i) acceleration[i] = random.uniform(1.0, 2.0);
  Graph graph = graph_of(robot);
  std::vector<VertexId<VertexConfiguration>> ids;
  for (int i = 0; i < 3; ++i) {
    const double grown = 0.5 * times[i] * times[i];
    Eigen::VectorXd q = start;
    q.tail(joints()) += grown * acceleration.tail(joints());
    if (model.floating_base()) {
      q.head<3>() += grown * acceleration.head<3>();
      q.segment<4>(3) = (Eigen::Quaterniond(q.segment<4>(3).data()) *
                         Eigen::AngleAxisd(grown * acceleration[3], axis))
                            .coeffs();
    }
    ids.push_back(add_configuration(graph, robot, i, times[i], q));
  }
  constexpr double kLimit = 0.5;
  graph.add_edge(EdgeAccelerationLimits(model, kLimit, kLimit, kLimit, 1.0), ids[0], ids[1],
                 ids[2]);
  const Eigen::VectorXd e = Evaluated(graph).error(0);
  for (int i = 0; i < joints(); ++i) {
    EXPECT_NEAR(e[i], acceleration[model.base_tangent_size() + i] - kLimit, 1e-11);
  }
  if (!model.floating_base()) return;
  EXPECT_NEAR(e[joints()], acceleration.head<3>().norm() - kLimit, 1e-11);
  EXPECT_NEAR(e[joints() + 1], acceleration[3] - kLimit, 1e-11);
}

TEST_P(AccelerationLimits, OfZeroStandForNone) {
  Random random(54);
  Graph graph = graph_of(robot);
  const Wanted wanted{random.vector(joints(), 50.0), random.vector(3, 50.0), random.vector(3, 5.0)};
  add(graph, random, 0, wanted, EdgeAccelerationLimits(robot.model(), 0.0, 0.0, 0.0, 1.0));
  Evaluated evaluated(graph);
  EXPECT_TRUE(evaluated.error(0).isZero(0.0));
  for (const int slot : {0, 1, 2}) EXPECT_TRUE(evaluated.jacobian(0, slot, false).isZero(0.0));
}

TEST_P(AccelerationLimits, AreRefusedWhereTimeDoesNotIncrease) {
  Random random(55);
  const double steps[][2] = {{0.0, 1.0}, {1.0, 0.0}, {-1.0, 3.0}, {3.0, -1.0}};
  for (const auto& step : steps) {
    Graph graph = graph_of(robot);
    const Wanted wanted{random.vector(joints(), 1.0), random.vector(3, 1.0), random.vector(3, 1.0)};
    add(graph, random, 0, wanted, EdgeAccelerationLimits(robot.model(), 1.0, 1.0, 1.0, 1.0),
        step[0], step[1]);
    EXPECT_THROW(Evaluated(graph).error(0), Error);
  }
}

INSTANTIATE_TEST_SUITE_P(Plugins, AccelerationLimits, testing::ValuesIn(all_cases_and_coman_plus()),
                         robot_case_name);

}  // namespace
}  // namespace locograph::test
