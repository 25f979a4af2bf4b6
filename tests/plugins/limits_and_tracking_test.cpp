#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

class LimitsOf : public RobotCaseTest {
 protected:
  Eigen::VectorXd mid_range() const {
    Eigen::VectorXd q = robot.model().neutral_configuration();
    for (int i = 0; i < robot.model().active_joint_count(); ++i) {
      const Joint& joint = robot.model().active_joint(i);
      if (joint.type != JointType::kContinuous) {
        q[robot.base() + i] = 0.5 * (joint.lower + joint.upper);
      }
    }
    return q;
  }
};

TEST_P(LimitsOf, JointsAreZeroInsideAndGrowLinearlyOutside) {
  const Robot& model = robot.model();
  constexpr double kMargin = 0.02;
  const EdgeJointLimits edge(model, kMargin, 1.0);
  EXPECT_TRUE(error_of(robot, edge, mid_range()).isZero(0.0));
  for (const double beyond : {0.001, 0.1, 1.0, 3.0}) {
    for (const bool above : {false, true}) {
      Eigen::VectorXd q = mid_range();
      for (int i = 0; i < model.active_joint_count(); ++i) {
        const Joint& joint = model.active_joint(i);
        if (joint.type == JointType::kContinuous) continue;
        q[robot.base() + i] =
            above ? joint.upper - kMargin + beyond : joint.lower + kMargin - beyond;
      }
      const Eigen::VectorXd e = error_of(robot, edge, q);
      for (int i = 0; i < model.active_joint_count(); ++i) {
        const bool limited = model.active_joint(i).type != JointType::kContinuous;
        EXPECT_NEAR(e[i], limited ? beyond : 0.0, 1e-12) << model.active_joint(i).name;
      }
    }
  }
}

TEST_P(LimitsOf, JointsAreZeroAtTheLimitItselfWithoutMargin) {
  const Robot& model = robot.model();
  Eigen::VectorXd q = mid_range();
  for (int i = 0; i < model.active_joint_count(); ++i) {
    const Joint& joint = model.active_joint(i);
    if (joint.type != JointType::kContinuous) q[robot.base() + i] = joint.upper;
  }
  EXPECT_TRUE(error_of(robot, EdgeJointLimits(model, 0.0, 1.0), q).isZero(0.0));
}

TEST_P(LimitsOf, VelocitiesAreZeroInsideAndTheExcessOfTheStepOutside) {
  Random random(11);
  const Robot& model = robot.model();
  const int n = model.active_joint_count(), base = model.base_tangent_size();
  constexpr double kDt = 0.25, kFraction = 0.8, kLinear = 0.5, kAngular = 0.9;
  const EdgeVelocityLimits edge(model, kFraction, kLinear, kAngular, 1.0);
  const Eigen::VectorXd from = random.configuration(model, 1.0, 0.0);
  Eigen::VectorXd to(from.size());
  EXPECT_TRUE(error_between(robot, edge, from, from, kDt).isZero(0.0));
  for (const double factor : {0.5, 0.99, 1.01, 1.5, 3.0}) {
    for (const double sign : {-1.0, 1.0}) {
      Eigen::VectorXd step(model.tangent_size());
      if (base > 0) {
        step.head<3>() = factor * kLinear * kDt * random.direction();
        step.segment<3>(3) = factor * kAngular * kDt * random.direction();
      }
      for (int i = 0; i < n; ++i) {
        step[base + i] = sign * factor * kFraction * model.active_joint(i).max_velocity * kDt;
      }
      model.integrate(from.data(), step.data(), to.data());
      const Eigen::VectorXd e = error_between(robot, edge, from, to, kDt);
      ASSERT_EQ(e.size(), n + 2);
      const double excess = std::max(0.0, factor - 1.0) * kDt;
      for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(e[i], excess * kFraction * model.active_joint(i).max_velocity, 1e-12);
      }
      EXPECT_NEAR(e[n], base > 0 ? excess * kLinear : 0.0, 1e-12);
      EXPECT_NEAR(e[n + 1], base > 0 ? excess * kAngular : 0.0, 1e-12);
    }
  }
}

TEST_P(LimitsOf, VelocitiesOfTheBaseAreFreeWhenTheirLimitIsZero) {
  const Robot& model = robot.model();
  const Eigen::VectorXd from = model.neutral_configuration();
  Eigen::VectorXd to = from, step = Eigen::VectorXd::Zero(model.tangent_size());
  if (model.floating_base()) step.head<6>().setOnes();
  model.integrate(from.data(), step.data(), to.data());
  EXPECT_TRUE(
      error_between(robot, EdgeVelocityLimits(model, 1.0, 0.0, 0.0, 1.0), from, to).isZero(0.0));
}

TEST_P(LimitsOf, PlanTrackingIsTheStepFromTheReference) {
  Random random(12);
  const Robot& model = robot.model();
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd reference = random.configuration(model, 1.0, 0.0);
    const Eigen::VectorXd step = random.vector(model.tangent_size(), 0.7);
    Eigen::VectorXd q(reference.size());
    const EdgePlanTracking edge(reference, Eigen::VectorXd::Ones(step.size()));
    EXPECT_LE(error_of(robot, edge, reference).cwiseAbs().maxCoeff(), 1e-15);
    model.integrate(reference.data(), step.data(), q.data());
    EXPECT_LE((error_of(robot, edge, q) - step).cwiseAbs().maxCoeff(), 1e-12);
    // The other quaternion of the same rotation is the same place.
    if (!model.floating_base()) continue;
    q.segment<4>(3) *= -1.0;
    EXPECT_LE((error_of(robot, edge, q) - step).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST_P(LimitsOf, AccelerationTrackingIsZeroAtConstantVelocityAndAtThePlansOwn) {
  Random random(17);
  const Robot& model = robot.model();
  const int n = model.tangent_size();
  const Eigen::VectorXd here = random.configuration(model, 2.0, 0.0), rate = random.vector(n, 0.3);
  const auto error = [&](double faster, const Eigen::VectorXd& acceleration) {
    Graph graph = graph_of(robot);
    const auto at = [&](int id, double from_here_s, double times) {
      Eigen::VectorXd q(model.configuration_size());
      const Eigen::VectorXd by = from_here_s * times * rate;
      model.integrate(here.data(), by.data(), q.data());
      return add_configuration(graph, robot, id, 1.0 + from_here_s, q);
    };
    const auto before = at(0, -0.2, 1.0), middle = at(1, 0.0, 1.0), after = at(2, 0.3, faster);
    graph.add_edge(EdgeAccelerationTracking(acceleration, Eigen::VectorXd::Ones(n)), before, middle,
                   after);
    return Evaluated(graph).error(0);
  };
  EXPECT_LT(error(1.0, Eigen::VectorXd::Zero(n)).norm(), 1e-12);
  // Twice as fast after 0.1 s before and 0.15 s after the middle.
  EXPECT_LT(error(2.0, rate / 0.25).norm(), 1e-12);
}

TEST_P(LimitsOf, VelocityTrackingIsZeroAtThePlansStepWhereverItStarts) {
  Random random(13);
  const Robot& model = robot.model();
  const Eigen::VectorXd step = random.vector(model.tangent_size(), 0.5);
  const EdgeVelocityTracking edge(step, Eigen::VectorXd::Ones(step.size()));
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd from = random.configuration(model, 3.0, 0.0);
    Eigen::VectorXd to(from.size());
    model.integrate(from.data(), step.data(), to.data());
    EXPECT_LE(error_between(robot, edge, from, to).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE((error_between(robot, edge, from, from) + step).cwiseAbs().maxCoeff(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Plugins, LimitsOf, testing::ValuesIn(all_cases()), robot_case_name);

}  // namespace
}  // namespace locograph::test
