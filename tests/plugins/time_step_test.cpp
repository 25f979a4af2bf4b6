#include <locograph/core/augmented_lagrangian.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits_timed.h>
#include <locograph/plugins/time_step/edge_duration.h>
#include <locograph/plugins/time_step/edge_time_step_limits.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>
#include <locograph/solvers/linear_solvers.h>

#include <cstring>

#include "common/allocation_counter.h"
#include "core/perturbed_states.h"
#include "plugins/bad_line.h"
#include "plugins/jacobian_comparison.h"
#include "plugins/small_robot.h"

namespace locograph::test {
namespace {

using Configuration = VertexId<VertexConfiguration>;
using Step = VertexId<VertexTimeStep>;

/// Where signed errors are compared with differences, a base moves by more than this [m or rad]:
/// the norm bends as the inverse of its size.
constexpr double kBend = 2e-2;
constexpr double kFraction = 0.9, kLinear = 1.0, kAngular = 2.0;

class TimedLimits : public RobotCaseTest {
 protected:
  int joints() const { return robot.model().active_joint_count(); }

  Step add_step(Graph& graph, double seconds) const {
    return graph.add_vertex(1000 + graph.vertex_slots(), VertexTimeStep(seconds));
  }
  Configuration add_at(Graph& graph, const Eigen::VectorXd& q) const {
    // Time stamps are not read: all are the same.
    return add_configuration(graph, robot, graph.vertex_slots(), 5.0, q);
  }
  /// A tangent whose joints move by sizes[i], the base by sizes[n] and its angle by sizes[n + 1].
  Eigen::VectorXd tangent(Random& random, const Eigen::VectorXd& sizes) const {
    const Robot& model = robot.model();
    Eigen::VectorXd step(model.tangent_size());
    for (int i = 0; i < joints(); ++i) {
      step[model.base_tangent_size() + i] = random.sign() * sizes[i];
    }
    if (model.floating_base()) {
      step.head<3>() = sizes[joints()] * random.direction();
      step.segment<3>(3) = sizes[joints() + 1] * random.direction();
    }
    return step;
  }
  Eigen::VectorXd moved(const Eigen::VectorXd& from, const Eigen::VectorXd& step) const {
    Eigen::VectorXd to(from.size());
    robot.model().integrate(from.data(), step.data(), to.data());
    return to;
  }
  Eigen::VectorXd rates() const {
    Eigen::VectorXd all(joints() + 2);
    for (int i = 0; i < joints(); ++i) {
      all[i] = kFraction * robot.model().active_joint(i).max_velocity;
    }
    all.tail<2>() << kLinear, kAngular;
    return all;
  }
  /// Rows without a base, or without a limit, stay zero.
  bool limited(int row) const {
    if (row >= joints()) return robot.model().floating_base();
    return std::isfinite(robot.model().active_joint(row).max_velocity);
  }
  Eigen::VectorXd acceleration_limits(Random& random) const {
    return Eigen::VectorXd::NullaryExpr(joints() + 2,
                                        [&](Eigen::Index) { return random.uniform(2.0, 8.0); });
  }

  /// Two configurations that move to 0 … 2 times each limit, `kink` or more off the limit and zero.
  template <class E>
  void add_velocities(Graph& graph, Random& random, double kink) const {
    const double dt_s = random.uniform(0.05, 0.5);
    Eigen::VectorXd sizes = rates();
    for (double& size : sizes) {
      size = away(random, (std::isfinite(size) ? size : 1.0) * dt_s, kink);
    }
    const Eigen::VectorXd from = random.configuration(robot.model(), 2.0, 0.0);
    const Configuration a = add_at(graph, from);
    const Configuration b = add_at(graph, moved(from, tangent(random, sizes)));
    graph.add_edge(E(robot.model(), kFraction, kLinear, kAngular, 1.0), a, b,
                   add_step(graph, dt_s));
  }
  template <class E>
  void add_rest(Graph& graph, Random& random, double kink) const {
    const double dt_s = random.uniform(0.2, 0.6);
    const Eigen::VectorXd limits = acceleration_limits(random);
    Eigen::VectorXd sizes = 0.5 * dt_s * dt_s * limits;
    for (double& size : sizes) size = away(random, size, kink);
    const Eigen::VectorXd from = random.configuration(robot.model(), 2.0, 0.0);
    const Configuration a = add_at(graph, from);
    const Configuration b = add_at(graph, moved(from, tangent(random, sizes)));
    graph.add_edge(E(limits, 1.0), a, b, add_step(graph, dt_s));
  }
  /// Three configurations whose accelerations are 0 … 2 times each limit.
  template <class E>
  void add_accelerations(Graph& graph, Random& random, double kink) const {
    const Eigen::VectorXd limits = acceleration_limits(random);
    Eigen::VectorXd sizes(limits.size());
    for (Eigen::Index r = 0; r < sizes.size(); ++r) sizes[r] = away(random, limits[r], kink);
    const double before_s = random.uniform(0.1, 0.4), after_s = random.uniform(0.1, 0.4);
    const Eigen::VectorXd velocity = random.vector(robot.model().tangent_size(), 1.0);
    const Eigen::VectorXd later = velocity + 0.5 * (before_s + after_s) * tangent(random, sizes);
    const Eigen::VectorXd here = random.configuration(robot.model(), 1.0, 0.0);
    Eigen::VectorXd from = moved(here, -before_s * velocity), to = moved(here, after_s * later);
    if (robot.model().floating_base()) {
      // integrate() moves along the base's own axes as it turns; what counts is the displacement.
      const Eigen::Quaterniond axes(here.segment<4>(3).data());
      from.head<3>() = here.head<3>() - before_s * (axes * velocity.head<3>());
      to.head<3>() = here.head<3>() + after_s * (axes * later.head<3>());
    }
    const Configuration a = add_at(graph, from), b = add_at(graph, here), c = add_at(graph, to);
    const Step first = add_step(graph, before_s), second = add_step(graph, after_s);
    graph.add_edge(E(limits, 1.0), a, b, c, first, second);
  }
  /// Four of every edge of this folder, hinged and signed, some vertices held.
  Graph every_edge(unsigned seed) const {
    Random random(seed);
    Graph graph = graph_of(robot);
    for (int i = 0; i < 4; ++i) {
      add_velocities<EdgeVelocityLimitsTimed>(graph, random, 0.0);
      add_velocities<EdgeVelocityLimitsTimedSigned>(graph, random, 0.0);
      add_accelerations<EdgeAccelerationLimitsTimed>(graph, random, 0.0);
      add_accelerations<EdgeAccelerationLimitsTimedSigned>(graph, random, 0.0);
      add_rest<EdgeRestAccelerationLimitsTimed>(graph, random, 0.0);
      add_rest<EdgeRestAccelerationLimitsTimedSigned>(graph, random, 0.0);
      const Step step = add_step(graph, random.uniform(0.1, 1.0));
      graph.add_edge(EdgeTimeStepLimits(0.5 / 3.0, 1.0 / 3.0, random.uniform(0.1, 9.0)), step);
      graph.add_edge(EdgeTimeStepLimitsSigned(0.5 / 3.0, 1.0 / 3.0, random.uniform(0.1, 9.0)),
                     step);
      graph.add_edge(EdgeDuration(random.uniform(0.1, 9.0)), step);
    }
    graph.set_fixed(0, true);
    graph.set_fixed(2, true);
    return graph;
  }
  static double away(Random& random, double limit, double kink) {
    const double size = random.uniform(kink, 2.0 * limit);
    return std::abs(size - limit) < kink ? limit + 2.0 * kink : size;
  }

  template <class Add>
  void compare_all(int slots, Add add) const {
    Random random(91);
    Graph graph = graph_of(robot);
    for (int i = 0; i < kStates; ++i) add(graph, random);
    Evaluated evaluated(graph);
    Compared compared;
    for (int k = 0; k < kStates; ++k) {
      for (int slot = 0; slot < slots; ++slot) compare(evaluated, k, slot, kEverywhere, compared);
    }
    EXPECT_EQ(compared.rows, slots * kStates * (joints() + 2));
    EXPECT_GT(compared.nonzero, compared.rows / 3);
  }
};

TEST_P(TimedLimits, OfVelocityHaveTheJacobianOfNumericDifferences) {
  compare_all(3, [this](Graph& graph, Random& random) {
    add_velocities<EdgeVelocityLimitsTimed>(graph, random, kKink);
  });
  compare_all(3, [this](Graph& graph, Random& random) {
    add_velocities<EdgeVelocityLimitsTimedSigned>(graph, random, kBend);
  });
}

TEST_P(TimedLimits, OfAccelerationHaveTheJacobianOfNumericDifferences) {
  constexpr double kKinkOfAcceleration = 1e-2;
  compare_all(5, [this](Graph& graph, Random& random) {
    add_accelerations<EdgeAccelerationLimitsTimed>(graph, random, kKinkOfAcceleration);
  });
  compare_all(5, [this](Graph& graph, Random& random) {
    add_accelerations<EdgeAccelerationLimitsTimedSigned>(graph, random, 0.3);  // as kBend
  });
}

TEST_P(TimedLimits, OfAccelerationFromRestHaveTheJacobianOfNumericDifferences) {
  compare_all(3, [this](Graph& graph, Random& random) {
    add_rest<EdgeRestAccelerationLimitsTimed>(graph, random, 1e-3);
  });
  compare_all(3, [this](Graph& graph, Random& random) {
    add_rest<EdgeRestAccelerationLimitsTimedSigned>(graph, random, kBend);
  });
}

TEST_P(TimedLimits, AreTheExcessBeyondTheLimitAndSignedInside) {
  Random random(92);
  for (const double beyond : {-1e-3, -1e-9, 1e-9, 1e-3}) {
    const double dt_s = 0.4;
    const Eigen::VectorXd from = random.configuration(robot.model(), 2.0, 0.0);
    Eigen::VectorXd velocity = rates();
    for (double& rate : velocity) rate = std::isfinite(rate) ? rate * dt_s + beyond : 0.5;
    const Eigen::VectorXd limits = acceleration_limits(random);
    const Eigen::VectorXd rest = 0.5 * dt_s * dt_s * (limits.array() + beyond).matrix();
    for (const bool at_rest : {false, true}) {
      Graph graph = graph_of(robot);
      const Configuration a = add_at(graph, from);
      const Configuration b =
          add_at(graph, moved(from, tangent(random, at_rest ? rest : velocity)));
      const Step step = add_step(graph, dt_s);
      if (at_rest) {
        graph.add_edge(EdgeRestAccelerationLimitsTimed(limits, 1.0), a, b, step);
        graph.add_edge(EdgeRestAccelerationLimitsTimedSigned(limits, 1.0), a, b, step);
      } else {
        graph.add_edge(EdgeVelocityLimitsTimed(robot.model(), kFraction, kLinear, kAngular, 1.0), a,
                       b, step);
        graph.add_edge(
            EdgeVelocityLimitsTimedSigned(robot.model(), kFraction, kLinear, kAngular, 1.0), a, b,
            step);
      }
      Evaluated evaluated(graph);
      const Eigen::VectorXd hinged = evaluated.error(0, 0), g = evaluated.error(0, 1);
      for (int r = 0; r < g.size(); ++r) {
        const bool counts = limited(r) || (at_rest && r < joints());
        EXPECT_NEAR(g[r], counts ? beyond : 0.0, 1e-12) << "row " << r;
        EXPECT_EQ(hinged[r], std::max(0.0, g[r])) << "row " << r;
        // The gradient does not vanish just beyond the limit; inside only that of the hinge does.
        for (const int slot : {0, 1, 2}) {
          const double size = evaluated.jacobian(0, slot, false, 0).row(r).norm();
          const double size_signed = evaluated.jacobian(0, slot, false, 1).row(r).norm();
          EXPECT_EQ(size > 0.1, counts && beyond > 0.0) << "row " << r << ", slot " << slot;
          EXPECT_EQ(size_signed > 0.1, counts) << "row " << r << ", slot " << slot;
        }
      }
    }
  }
}

TEST_P(TimedLimits, AreThoseOfTimeStampsWhereTheStepsAreTheSame) {
  Random random(93);
  const Robot& model = robot.model();
  const Eigen::VectorXd limits = acceleration_limits(random);
  Graph graph = graph_of(robot);
  Configuration q[3];
  const double times[] = {0.3, 0.5, 0.85};
  Eigen::VectorXd at = random.configuration(model, 1.0, 0.0);
  for (int i = 0; i < 3; ++i) {
    q[i] = add_configuration(graph, robot, i, times[i], at);
    at = moved(at, random.vector(model.tangent_size(), 1.0));
  }
  const Step first = add_step(graph, times[1] - times[0]);
  const Step second = add_step(graph, times[2] - times[1]);
  graph.add_edge(EdgeVelocityLimits(model, 0.2, 0.1, 0.1, 1.0), q[0], q[1]);
  graph.add_edge(EdgeVelocityLimitsTimed(model, 0.2, 0.1, 0.1, 1.0), q[0], q[1], first);
  graph.add_edge(EdgeAccelerationLimits(limits, 1.0), q[0], q[1], q[2]);
  graph.add_edge(EdgeAccelerationLimitsTimed(limits, 1.0), q[0], q[1], q[2], first, second);
  Evaluated evaluated(graph);
  for (const int pool : {0, 2}) {
    EXPECT_GT(evaluated.error(0, pool).norm(), 0.1);
    EXPECT_EQ(evaluated.error(0, pool), evaluated.error(0, pool + 1));
    for (const int slot : {0, 1}) {
      EXPECT_EQ(evaluated.jacobian(0, slot, false, pool),
                evaluated.jacobian(0, slot, false, pool + 1));
    }
  }
}

TEST_P(TimedLimits, AreTheSameInABatchAsOneByOne) {
  for (const bool kernels : {false, true}) {
    Graph graph = every_edge(94);
    if (kernels) graph.set_kernel(RobustKernel::parse("huber:0.5"));
    Loaded loaded(graph);
    EXPECT_GT(expect_batch_equals_one_by_one(loaded.workspace, 1e-12).gradient.norm(), 1.0);
  }
}

TEST_P(TimedLimits, DoNotAllocateWhereTheyAreEvaluated) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = every_edge(97);
  Loaded loaded(graph);
  const long before = allocation_count();
  loaded.workspace.evaluate(loaded.workspace.state());
  loaded.workspace.linearise();
  EXPECT_EQ(allocation_count(), before);
}

TEST_P(TimedLimits, KeepEveryBitInAFile) {
  const TemporaryFolder folder;
  Graph graph = every_edge(95);
  write_graph(graph, folder.file("plan.g2o"));
  Graph again = read_graph(folder.file("plan.g2o"), robot_types());
  EXPECT_EQ(write_graph_text(graph, folder.path()), write_graph_text(again, folder.path()));
  ASSERT_EQ(graph.vertices_of<VertexTimeStep>().size(), again.vertices_of<VertexTimeStep>().size());
  for (std::size_t i = 0; i < graph.vertices_of<VertexTimeStep>().size(); ++i) {
    EXPECT_EQ(graph.vertices_of<VertexTimeStep>()[i].seconds(),
              again.vertices_of<VertexTimeStep>()[i].seconds());
  }
  const auto expect_same = [&]<class E>(std::type_identity<E>, auto numbers) {
    ASSERT_EQ(graph.edges_of<E>().size(), 4u);
    ASSERT_EQ(again.edges_of<E>().size(), 4u);
    for (int i = 0; i < 4; ++i) {
      const E &one = graph.edges_of<E>()[i], &other = again.edges_of<E>()[i];
      EXPECT_TRUE(one.vertices == other.vertices);
      const Eigen::VectorXd x = numbers(one), y = numbers(other);
      ASSERT_EQ(x.size(), y.size());
      EXPECT_EQ(std::memcmp(x.data(), y.data(), sizeof(double) * x.size()), 0) << E::kTag;
    }
  };
  const auto velocity = [](const auto& e) {
    Eigen::VectorXd all(3 + e.weights.size());
    all << e.limits.fraction, e.limits.base_linear_m_s, e.limits.base_angular_rad_s, e.weights;
    return all;
  };
  const auto acceleration = [](const auto& e) {
    Eigen::VectorXd all(e.limits.size() + e.weights.size());
    all << e.limits, e.weights;
    return all;
  };
  const auto step = [](const auto& e) {
    return Eigen::VectorXd(Eigen::Vector4d(e.min_s, e.max_s, e.weights[0], e.weights[1]));
  };
  expect_same(std::type_identity<EdgeVelocityLimitsTimed>(), velocity);
  expect_same(std::type_identity<EdgeVelocityLimitsTimedSigned>(), velocity);
  expect_same(std::type_identity<EdgeAccelerationLimitsTimed>(), acceleration);
  expect_same(std::type_identity<EdgeAccelerationLimitsTimedSigned>(), acceleration);
  expect_same(std::type_identity<EdgeRestAccelerationLimitsTimed>(), acceleration);
  expect_same(std::type_identity<EdgeRestAccelerationLimitsTimedSigned>(), acceleration);
  expect_same(std::type_identity<EdgeTimeStepLimits>(), step);
  expect_same(std::type_identity<EdgeTimeStepLimitsSigned>(), step);
  expect_same(std::type_identity<EdgeDuration>(),
              [](const EdgeDuration& e) { return Eigen::VectorXd(e.information); });
}

INSTANTIATE_TEST_SUITE_P(Plugins, TimedLimits, testing::ValuesIn(all_cases_and_coman_plus()),
                         robot_case_name);

TEST(TimeStep, StaysPositiveWhateverTheStep) {
  for (const double d : {-300.0, -1.0, 0.0, 1.0, 300.0}) {
    const double before = 0.1;
    double after = 0.0, back = 0.0;
    VertexTimeStep::oplus(&before, &d, &after);
    EXPECT_GT(after, 0.0);
    VertexTimeStep::ominus(&after, &before, &back);
    EXPECT_NEAR(back, d, 1e-12 * std::max(1.0, std::abs(d)));
  }
  EXPECT_THROW(VertexTimeStep(0.0), Error);
  EXPECT_THROW(VertexTimeStep(-0.1), Error);
  EXPECT_THROW(VertexTimeStep(std::nan("")), Error);
  EXPECT_THROW(VertexTimeStep{std::numeric_limits<double>::infinity()}, Error);
}

TEST(TimeStep, EdgesHaveTheJacobianOfNumericDifferences) {
  Random random(96);
  Graph graph;
  for (int i = 0; i < kStates; ++i) {
    // From a thousandth of a second to many, on either side of both limits and just off them.
    double seconds = std::exp(random.uniform(std::log(1e-3), std::log(20.0)));
    if (i % 5 == 0) seconds = (i % 2 == 0 ? 0.05 : 0.5) * (1.0 + random.sign() * 1e-3);
    if (std::abs(seconds - 0.05) < 4e-5 || std::abs(seconds - 0.5) < 4e-4) seconds = 0.2;
    const Step step = graph.add_vertex(i, VertexTimeStep(seconds));
    graph.add_edge(EdgeTimeStepLimits(0.05, 0.5, 1.0), step);
    graph.add_edge(EdgeTimeStepLimitsSigned(0.05, 0.5, 1.0), step);
    graph.add_edge(EdgeDuration(1.0), step);
  }
  Evaluated evaluated(graph);
  Compared compared[3];
  for (int k = 0; k < kStates; ++k) {
    for (const int pool : {0, 1, 2}) {
      const Eigen::MatrixXd analytic = evaluated.jacobian(k, 0, false, pool);
      const Eigen::MatrixXd numeric = evaluated.jacobian(k, 0, true, pool);
      for (int r = 0; r < analytic.rows(); ++r) {
        EXPECT_NEAR(analytic(r, 0), numeric(r, 0),
                    kTolerance * std::max(1.0, std::abs(numeric(r, 0))));
        ++(analytic(r, 0) == 0.0 ? compared[pool].zero : compared[pool].nonzero);
      }
    }
  }
  EXPECT_GT(compared[0].zero, kStates / 4);
  EXPECT_GT(compared[0].nonzero, kStates / 4);
  EXPECT_EQ(compared[1].zero, 0);
  EXPECT_EQ(compared[2].zero, 0);
}

TEST(TimeStep, CostsItsWeightForEachSecondHoweverItIsDivided) {
  for (const std::vector<double>& steps :
       {std::vector<double>{2.0}, {0.5, 1.5}, {0.25, 0.25, 0.5, 1.0}}) {
    Graph graph;
    for (const double seconds : steps) {
      graph.add_edge(EdgeDuration(7.0),
                     graph.add_vertex(graph.vertex_slots(), VertexTimeStep(seconds)));
    }
    Loaded loaded(graph);
    EXPECT_NEAR(loaded.workspace.evaluate(loaded.workspace.state()).chi2, 14.0, 1e-13);
  }
}

// Two configurations of a cart, one of another, and steps; the bad line is behind them.
constexpr const char* kTimedPlan =
    "PARAMS_ROBOT 0 cart.urdf - floating 0\n"
    "VERTEX_CONFIGURATION 0 0 0 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_CONFIGURATION 1 0 1 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_CONFIGURATION 2 0 3 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_TIME_STEP 10 0.5\n"
    "VERTEX_TIME_STEP 11 0.25\n"
    "EDGE_DURATION 10 2\n"
    "EDGE_TIME_STEP_LIMITS 10 0.1 1 scalar 1\n"
    "EDGE_TIME_STEP_LIMITS_SIGNED 10 0 1 diagonal 0 1\n"
    "EDGE_VELOCITY_LIMITS_TIMED 0 1 10 5 1 0.5 0.5 scalar 1\n"
    "EDGE_VELOCITY_LIMITS_TIMED_SIGNED 0 1 10 5 1 0.5 0.5 scalar 1\n"
    "EDGE_ACCELERATION_LIMITS_TIMED 0 1 2 10 11 5 1 1 1 1 0 scalar 1\n"
    "EDGE_ACCELERATION_LIMITS_TIMED_SIGNED 0 1 2 10 11 5 1 1 1 1 0 scalar 1\n"
    "EDGE_REST_ACCELERATION_LIMITS_TIMED 0 1 10 5 1 1 1 1 0 scalar 1\n"
    "EDGE_REST_ACCELERATION_LIMITS_TIMED_SIGNED 0 1 10 5 1 1 1 1 0 scalar 1\n";

const BadLine kBadTimes[] = {
    {"StepOfNoTime", "VERTEX_TIME_STEP 20 0", "a time step of 0.000000 s, expected more than 0 s"},
    {"StepBackInTime", "VERTEX_TIME_STEP 20 -0.1", "expected more than 0 s"},
    {"StepThatIsNotANumber", "VERTEX_TIME_STEP 20 nan", "'nan' is not finite"},
    {"StepWithoutTime", "VERTEX_TIME_STEP 20", "too few fields"},
    {"StepWithTwoTimes", "VERTEX_TIME_STEP 20 1 2", "too many fields"},
    {"StepTwice", "VERTEX_TIME_STEP 10 1", "declared twice"},
    {"LimitsInTheWrongOrder", "EDGE_TIME_STEP_LIMITS 11 2 1 scalar 1",
     "EDGE_TIME_STEP_LIMITS from 2.000000 to 1.000000 s, expected 0 <= min <= max"},
    {"LimitsBelowZero", "EDGE_TIME_STEP_LIMITS_SIGNED 11 -1 1 scalar 1",
     "EDGE_TIME_STEP_LIMITS_SIGNED from -1.0"},
    {"LimitsThatAreNotNumbers", "EDGE_TIME_STEP_LIMITS 11 nan 1 scalar 1", "'nan' is not finite"},
    {"LimitsOfAConfiguration", "EDGE_TIME_STEP_LIMITS 0 1 2 scalar 1",
     "vertex 0 is a VERTEX_CONFIGURATION, expected a VERTEX_TIME_STEP"},
    {"DurationWithANegativeWeight", "EDGE_DURATION 11 -1", "positive semi-definite"},
    {"DurationOfAnUnknownStep", "EDGE_DURATION 12 1", "unknown vertex 12"},
    {"VelocityWithTooFewRows", "EDGE_VELOCITY_LIMITS_TIMED 0 1 10 3 1 0.5 0.5 scalar 1",
     "EDGE_VELOCITY_LIMITS_TIMED with n = 3, expected n = 5"},
    {"SignedVelocityWithTooManyRows",
     "EDGE_VELOCITY_LIMITS_TIMED_SIGNED 0 1 10 6 1 0.5 0.5 scalar 1",
     "EDGE_VELOCITY_LIMITS_TIMED_SIGNED with n = 6, expected n = 5"},
    {"VelocityWithoutStep", "EDGE_VELOCITY_LIMITS_TIMED 0 1 2 5 1 0.5 0.5 scalar 1",
     "vertex 2 is a VERTEX_CONFIGURATION, expected a VERTEX_TIME_STEP"},
    {"AccelerationOverOneStep", "EDGE_ACCELERATION_LIMITS_TIMED 0 1 2 10 10 5 1 1 1 1 0 scalar 1",
     "names vertex 10 twice"},
    {"AccelerationWithANegativeLimit",
     "EDGE_ACCELERATION_LIMITS_TIMED 0 1 2 10 11 5 1 1 -1 1 0 scalar 1",
     "a limit of acceleration of -1"},
    {"AccelerationWithTooFewRows", "EDGE_ACCELERATION_LIMITS_TIMED 0 1 2 10 11 3 1 1 1 scalar 1",
     "EDGE_ACCELERATION_LIMITS_TIMED with n = 3, expected n = 5"},
    {"RestWithANegativeLimit",
     "EDGE_REST_ACCELERATION_LIMITS_TIMED_SIGNED 0 1 10 5 1 1 1 -2 0 scalar 1",
     "a limit of acceleration of -2"},
    {"RestWithATruncatedLimit", "EDGE_REST_ACCELERATION_LIMITS_TIMED 0 1 10 5 1 1 1 1 scalar 1",
     "'scalar' is not a number"},
};

class BadTimes : public testing::TestWithParam<BadLine> {};

TEST_P(BadTimes, AreAnErrorWithFileAndLine) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  expect_bad_line(folder, kTimedPlan, GetParam());
}
INSTANTIATE_TEST_SUITE_P(Plugins, BadTimes, testing::ValuesIn(kBadTimes), bad_line_name);

// A joint goes from rest to rest as fast as its limits allow -------------------------------------

/// The shortest time over steps of h or less: with every acceleration at its limit the velocity of
/// step i, at the middle m_i of the step, is the trapezoid f(m_i) = min(a m_i, v, a (T − m_i)), and
/// the distance Σ f(m_i) Δt_i. That is the area of f, and more by a h²/8 for each corner in the
/// middle of a step of length h (by a h²/4 for the tip where v is not reached). A first step of
/// 2 v/a has its middle at full velocity: longer ones gain nothing.
double shortest_time(double distance, double v, double a, double h) {
  const bool cruises = distance > v * v / a;
  if (cruises) h = std::min(h, 2.0 * v / a);
  return cruises ? distance / v + v / a - a * h * h / (4.0 * v)
                 : std::sqrt(4.0 * distance / a - h * h);
}

struct FastMotion {
  const char* name;
  double distance, rate, acceleration;
};
void PrintTo(const FastMotion& motion, std::ostream* out) { *out << motion.name; }

class ShortestMotion : public testing::TestWithParam<FastMotion> {
 protected:
  /// A straight motion in even steps that take three times as long as they must.
  void build(int count) {
    const FastMotion& motion = GetParam();
    robot = centauro("Arm", {.floating_base = false, .active_joints = {"j_arm1_4"}});
    const Joint& joint = robot.model().active_joint(0);
    const double fraction = motion.rate / joint.max_velocity;
    const double start = 0.5 * (joint.lower + joint.upper) - 0.5 * motion.distance;
    longest_s = 2.0 * duration_of_trapezoid() / count;
    Eigen::Vector3d limits(motion.acceleration, 0.0, 0.0);
    graph = graph_of(robot);
    for (int i = 0; i <= count; ++i) {
      const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, start + motion.distance * i / count);
      at.push_back(add_configuration(graph, robot, i, 0.0, q));
    }
    for (int i = 0; i < count; ++i) {
      steps.push_back(
          graph.add_vertex(100 + i, VertexTimeStep(3.0 * duration_of_trapezoid() / count)));
      graph.add_edge(EdgeDuration(1.0), steps[i]);
      constrain(EdgeTimeStepLimitsSigned(0.1 * longest_s, longest_s, 10.0), steps[i]);
      constrain(EdgeVelocityLimitsTimedSigned(robot.model(), fraction, 0.0, 0.0, 100.0), at[i],
                at[i + 1], steps[i]);
      if (i > 0) {
        constrain(EdgeAccelerationLimitsTimedSigned(limits, 0.01), at[i - 1], at[i], at[i + 1],
                  steps[i - 1], steps[i]);
      }
    }
    graph.set_fixed(at.front(), true);
    graph.set_fixed(at.back(), true);
    constrain(EdgeRestAccelerationLimitsTimedSigned(limits, 0.01), at[0], at[1], steps[0]);
    constrain(EdgeRestAccelerationLimitsTimedSigned(limits, 0.01), at[count], at[count - 1],
              steps[count - 1]);
  }
  template <class E, class... Ids>
  void constrain(E edge, Ids... ids) {
    graph.set_constraint(graph.add_edge(std::move(edge), ids...), ConstraintKind::kInequality);
  }
  double duration_of_trapezoid() const {
    return shortest_time(GetParam().distance, GetParam().rate, GetParam().acceleration, 0.0);
  }
  double duration() const {
    double total = 0.0;
    for (const Step& step : steps) total += graph.vertex(step).seconds();
    return total;
  }
  double position(int i) const { return graph.vertex(at[i]).state[0]; }

  RobotCase robot;
  Graph graph;
  std::vector<Configuration> at;
  std::vector<Step> steps;
  double longest_s = 0.0;
};

TEST_P(ShortestMotion, IsFoundWithinAPercentOfTheAnalyticOptimum) {
  constexpr int kSteps = 24;
  build(kSteps);
  ConstrainedOptions options;
  options.tolerance = 1e-6;
  const ConstrainedResult result =
      optimise_constrained(graph, options, *make_linear_solver("auto"));
  EXPECT_TRUE(result.converged) << result.reason_text(graph);
  const double least =
      shortest_time(GetParam().distance, GetParam().rate, GetParam().acceleration, longest_s);
  EXPECT_NEAR(duration(), least, 0.01 * least);
  EXPECT_GT(duration(), least - 1e-4 * least) << "faster than is possible";
  // Its limits hold, recomputed here.
  double before = 0.0, velocity_before = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double step = graph.vertex(steps[i]).seconds();
    const double velocity = (position(i + 1) - position(i)) / step;
    EXPECT_LE(step, longest_s + 1e-5);
    EXPECT_LE(std::abs(velocity), GetParam().rate * (1.0 + 1e-3));
    EXPECT_LE(std::abs(velocity - velocity_before) / (0.5 * (step + before)),
              GetParam().acceleration * (1.0 + 1e-3));
    before = step;
    velocity_before = velocity;
  }
  EXPECT_LE(velocity_before / (0.5 * before), GetParam().acceleration * (1.0 + 1e-3));
}

TEST_P(ShortestMotion, IsTheOptimumWhereverRoundingLeads) {
  // The search starts from a motion symmetric in time. NeverAtFullSpeed's optimum is not symmetric:
  // rounding chooses between it and its mirror image.
  build(16);
  const double least =
      shortest_time(GetParam().distance, GetParam().rate, GetParam().acceleration, longest_s);
  ConstrainedOptions options;
  options.tolerance = 1e-6;
  optimise_from_perturbed_states(
      graph, options, [&](const ConstrainedResult& result, const std::vector<double>&) {
        EXPECT_NEAR(result.cost.chi2, least, 1e-6 * least) << "the sum of the time steps";
      });
}

INSTANTIATE_TEST_SUITE_P(Plugins, ShortestMotion,
                         testing::Values(FastMotion{"Cruising", 1.0, 0.8, 3.0},
                                         FastMotion{"NeverAtFullSpeed", 0.5, 2.0, 2.0},
                                         FastMotion{"LongCruise", 2.0, 0.5, 10.0}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace locograph::test
