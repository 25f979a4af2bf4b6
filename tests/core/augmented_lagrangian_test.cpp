#include <gtest/gtest.h>
#include <locograph/core/augmented_lagrangian.h>

#include "common/allocation_counter.h"
#include "core/perturbed_states.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

/// Error (2): p − z.
struct Near : Edge<2, VertexXY> {
  Eigen::Vector2d target = Eigen::Vector2d::Zero();
  void error(const Eigen::Vector2d& p, Eigen::Ref<Eigen::Vector2d> e) const { e = p - target; }
  void jacobians(const Eigen::Vector2d&, JacobianRef<Near, 0> j) const { j.setIdentity(); }
};
LOCOGRAPH_REGISTER_EDGE("TEST_NEAR", Near)

/// Rosenbrock's function. Error (2): (1 − x, 10 (y − x²)).
struct Rosenbrock : Edge<2, VertexXY> {
  void error(const Eigen::Vector2d& p, Eigen::Ref<Eigen::Vector2d> e) const {
    e << 1.0 - p[0], 10.0 * (p[1] - p[0] * p[0]);
  }
  void jacobians(const Eigen::Vector2d& p, JacobianRef<Rosenbrock, 0> j) const {
    j << -1.0, 0.0, -20.0 * p[0], 10.0;
  }
};
LOCOGRAPH_REGISTER_EDGE("TEST_ROSENBROCK", Rosenbrock)

/// Error (1): |p|² − r².
struct Circle : Edge<1, VertexXY> {
  double radius = 1.0;
  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    e[0] = p.squaredNorm() - radius * radius;
  }
};
LOCOGRAPH_REGISTER_EDGE("TEST_CIRCLE", Circle)

/// Error (n): A p − b, negative inside a polygon.
struct HalfPlanes : WeightedEdge<Eigen::Dynamic, VertexXY> {
  Eigen::Matrix<double, Eigen::Dynamic, 2> a;
  Eigen::VectorXd b;
  HalfPlanes() = default;
  HalfPlanes(const Eigen::Matrix<double, Eigen::Dynamic, 2>& normals, const Eigen::VectorXd& sides)
      : a(normals), b(sides) {
    weights.setOnes(b.size());
  }
  void error(const Eigen::Vector2d& p, Eigen::Ref<Eigen::VectorXd> e) const { e = a * p - b; }
  void jacobians(const Eigen::Vector2d&, JacobianRef<HalfPlanes, 0> j) const { j = a; }
};
LOCOGRAPH_REGISTER_EDGE("TEST_HALF_PLANES", HalfPlanes)

/// Error (1): max(0, x − 1), hinged by the type itself.
struct HingedWall : WeightedEdge<1, VertexXY> {
  static constexpr bool kOneSided = true;
  void error(const Eigen::Vector2d& p, Eigen::Ref<Eigen::Matrix<double, 1, 1>> e) const {
    e[0] = std::max(0.0, p[0] - 1.0);
  }
  void jacobians(const Eigen::Vector2d& p, JacobianRef<HingedWall, 0> j) const {
    if (p[0] > 1.0) j(0, 0) = 1.0;
  }
};
LOCOGRAPH_REGISTER_EDGE("TEST_HINGED_WALL", HingedWall)

/// Error (2): Σ pᵢ − s of any number of points.
struct Sum : DynamicEdge<2, VertexXY> {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  template <class T>
  void error(std::span<const Eigen::Matrix<T, 2, 1>> points,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = -sum.template cast<T>();
    for (const Eigen::Matrix<T, 2, 1>& p : points) e += p;
  }
};
LOCOGRAPH_REGISTER_EDGE("TEST_SUM", Sum)

/// Down to the rounding of the cost: a gain of 1e-14 leaves its root, 1e-7, in the state.
ConstrainedOptions to_rounding() {
  ConstrainedOptions options;
  options.inner.gain = 1e-16;
  return options;
}

struct OnePoint {
  Graph graph;
  VertexId<VertexXY> point;
  explicit OnePoint(double x = 0.5, double y = 0.5)
      : point(graph.add_vertex(0, VertexXY({x, y}))) {}

  EdgeId near(double x, double y) {
    Near edge;
    edge.target << x, y;
    return graph.add_edge(edge, point);
  }
  EdgeId circle(double radius, ConstraintKind kind) {
    Circle edge;
    edge.radius = radius;
    const EdgeId id = graph.add_edge(edge, point);
    graph.set_constraint(id, kind);
    return id;
  }
  EdgeId half_planes(const Eigen::Matrix<double, Eigen::Dynamic, 2>& a, const Eigen::VectorXd& b) {
    const EdgeId id = graph.add_edge(HalfPlanes(a, b), point);
    graph.set_constraint(id, ConstraintKind::kInequality);
    return id;
  }
  ConstrainedResult solve(const ConstrainedOptions& options = to_rounding()) {
    return optimise_constrained(graph, options, *make_linear_solver("auto"));
  }
  Eigen::Vector2d at() const { return graph.vertex(point).state; }
};

OnePoint closest_of_a_circle() {
  OnePoint problem;
  problem.near(3.0, 4.0);
  problem.circle(2.0, ConstraintKind::kEquality);
  return problem;
}

OnePoint rosenbrock_on_the_unit_disc() {
  OnePoint problem(0.0, 0.0);
  problem.graph.add_edge(Rosenbrock(), problem.point);
  problem.circle(1.0, ConstraintKind::kInequality);
  return problem;
}

/// Nocedal & Wright 2006, example 16.4.
OnePoint quadratic_programme() {
  OnePoint problem(2.0, 0.0);
  problem.near(1.0, 2.5);
  Eigen::Matrix<double, 5, 2> a;
  a << -1.0, 2.0, 1.0, 2.0, 1.0, -2.0, -1.0, 0.0, 0.0, -1.0;
  Eigen::VectorXd b(5);
  b << 2.0, 6.0, 2.0, 0.0, 0.0;
  problem.half_planes(a, b);
  return problem;
}

/// Three points whose sum is given, under full information.
const Eigen::Vector2d kTargets[] = {{1.0, 0.0}, {2.0, 1.0}, {0.0, 5.0}};
Graph points_of_a_sum() {
  Graph graph;
  std::vector<VertexId<VertexXY>> points;
  for (int i = 0; i < 3; ++i) {
    points.push_back(graph.add_vertex(i, VertexXY()));
    Near near;
    near.target = kTargets[i];
    graph.add_edge(near, points.back());
  }
  Sum sum;
  sum.sum << 6.0, 3.0;
  sum.information << 2.0, 1.0, 1.0, 3.0;
  graph.set_constraint(graph.add_dynamic_edge(sum, points), ConstraintKind::kEquality);
  return graph;
}

Graph ring_with_an_exact_chord() {
  Graph graph = ring_2d(20, 0.1);
  graph.set_constraint({20}, ConstraintKind::kEquality);
  return graph;
}

TEST(AugmentedLagrangian, FindsTheClosestPointOfACircle) {
  OnePoint problem = closest_of_a_circle();
  const ConstrainedResult result = problem.solve();
  ASSERT_TRUE(result.converged) << result.reason_text(problem.graph);
  EXPECT_NEAR((problem.at() - Eigen::Vector2d(1.2, 1.6)).norm(), 0.0, 1e-7);
  // 2 (p − z) + λ 2 p = 0.
  ASSERT_EQ(result.constraints.size(), 1u);
  EXPECT_EQ(result.constraints[0].edge, EdgeId{1});
  EXPECT_NEAR(result.constraints[0].multipliers[0], 1.5, 1e-6);
  EXPECT_LE(result.constraints[0].violation, 1e-8);
  EXPECT_NEAR(result.cost.chi2, 9.0, 1e-6);
}

TEST(AugmentedLagrangian, FindsRosenbrocksMinimumOnTheUnitDisc) {
  OnePoint problem = rosenbrock_on_the_unit_disc();
  const ConstrainedResult result = problem.solve();
  ASSERT_TRUE(result.converged) << result.reason_text(problem.graph);
  const double x = problem.at()[0], y = problem.at()[1];
  EXPECT_NEAR(x, 0.7864, 5e-5);
  EXPECT_NEAR(y, 0.6177, 5e-5);
  // ∇f + λ ∇c = 0 with λ > 0.
  const double multiplier = result.constraints[0].multipliers[0];
  EXPECT_GT(multiplier, 0.0);
  EXPECT_NEAR(-2.0 * (1.0 - x) - 400.0 * x * (y - x * x) + multiplier * 2.0 * x, 0.0, 1e-5);
  EXPECT_NEAR(200.0 * (y - x * x) + multiplier * 2.0 * y, 0.0, 1e-5);
}

TEST(AugmentedLagrangian, LeavesAnInequalityAloneThatDoesNotBind) {
  OnePoint problem(-1.2, 1.0);
  problem.graph.add_edge(Rosenbrock(), problem.point);
  problem.circle(2.0, ConstraintKind::kInequality);
  const ConstrainedResult result = problem.solve();
  ASSERT_TRUE(result.converged) << result.reason_text(problem.graph);
  EXPECT_NEAR((problem.at() - Eigen::Vector2d(1.0, 1.0)).norm(), 0.0, 1e-6);
  EXPECT_EQ(result.constraints[0].multipliers[0], 0.0);
  EXPECT_EQ(result.constraints[0].violation, 0.0);
  EXPECT_EQ(result.rounds, 1);
}

TEST(AugmentedLagrangian, SolvesAQuadraticProgrammeAndTellsWhichSidesBind) {
  // The solution is (1.4, 1.7), the first side binds with λ = 0.8.
  OnePoint problem = quadratic_programme();
  const ConstrainedResult result = problem.solve();
  ASSERT_TRUE(result.converged) << result.reason_text(problem.graph);
  EXPECT_NEAR((problem.at() - Eigen::Vector2d(1.4, 1.7)).norm(), 0.0, 1e-7);
  EXPECT_NEAR(result.constraints[0].multipliers[0], 0.8, 1e-6);
  for (int r = 1; r < 5; ++r) EXPECT_EQ(result.constraints[0].multipliers[r], 0.0);
}

TEST(AugmentedLagrangian, TakesEdgesOfRunTimeArityAndFullInformation) {
  Graph graph = points_of_a_sum();
  const ConstrainedResult result =
      optimise_constrained(graph, {}, *make_linear_solver("block-cholesky"));
  ASSERT_TRUE(result.converged) << result.reason_text(graph);
  // Every point moves by a third of what the sum lacks, (3, −3); λ = −2 (p − z).
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d moved = graph.vertex(VertexId<VertexXY>{i}).state - kTargets[i];
    EXPECT_NEAR((moved - Eigen::Vector2d(1.0, -1.0)).norm(), 0.0, 1e-7);
  }
  EXPECT_NEAR(result.constraints[0].multipliers[0], -2.0, 1e-6);
  EXPECT_NEAR(result.constraints[0].multipliers[1], 2.0, 1e-6);
}

TEST(AugmentedLagrangian, ReportsAnInfeasibleProblemAndItsWorstConstraint) {
  OnePoint problem;
  problem.near(3.0, 4.0);
  Eigen::Matrix<double, 2, 2> a;
  a << 0.0, 1.0, -1.0, 0.0;
  problem.half_planes(a, Eigen::Vector2d(9.0, -2.0));  // y ≤ 9, x ≥ 2
  const EdgeId circle = problem.circle(1.0, ConstraintKind::kEquality);
  const ConstrainedResult result = problem.solve();
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, ConstrainedResult::Reason::kInfeasible);
  // min (x − 2)² + (x² − 1)² lies at 2x³ − x = 2, x = 1.1654.
  ASSERT_EQ(result.worst, 0);
  EXPECT_NEAR(result.constraints[0].violation, 0.8346, 1e-3);
  EXPECT_EQ(result.constraints[1].edge, circle);
  EXPECT_NEAR(result.constraints[1].violation, 0.3582, 1e-3);
  EXPECT_EQ(result.constraints[0].row, 1);
  const std::string text = result.reason_text(problem.graph);
  EXPECT_NE(text.find("infeasible"), std::string::npos) << text;
  EXPECT_NE(text.find("TEST_HALF_PLANES 0, row 1"), std::string::npos) << text;
}

TEST(AugmentedLagrangian, RaisesOnlyTheWeightOfTypesThatHingeThemselves) {
  OnePoint problem;
  problem.near(3.0, 4.0);
  const EdgeId wall = problem.graph.add_edge(HingedWall(), problem.point);
  problem.graph.set_constraint(wall, ConstraintKind::kInequality);
  ConstrainedOptions options;
  options.tolerance = 1e-6;
  const ConstrainedResult result = problem.solve(options);
  ASSERT_TRUE(result.converged) << result.reason_text(problem.graph);
  EXPECT_NEAR(problem.at()[0], 1.0, 1e-6);
  EXPECT_NEAR(problem.at()[1], 4.0, 1e-9);
  EXPECT_EQ(result.constraints[0].multipliers[0], 0.0);
  EXPECT_EQ(problem.graph.edge<HingedWall>(wall).weights[0], 1.0) << "the graph keeps its weights";
}

TEST(AugmentedLagrangian, ClosesALoopExactly) {
  Graph graph = ring_with_an_exact_chord();
  const ConstrainedResult result = optimise_constrained(graph, {}, *make_linear_solver("auto"));
  ASSERT_TRUE(result.converged) << result.reason_text(graph);
  Graph plain = ring_2d(20, 0.1);
  run(plain, {});
  const auto gap = [](const Graph& g) {
    Eigen::Vector3d e;
    const EdgeSE2& edge = g.edges_of<EdgeSE2>()[20];
    edge.error<double>(g.vertices_of<VertexSE2>()[0].pose(), g.vertices_of<VertexSE2>()[10].pose(),
                       e);
    return e.norm();
  };
  EXPECT_LE(gap(graph), 1e-8);
  EXPECT_GT(gap(plain), 1e-3);
}

void expect_one_optimum(Graph graph) {
  std::vector<double> first;
  optimise_from_perturbed_states(graph, to_rounding(),
                                 [&](const ConstrainedResult&, const std::vector<double>& state) {
                                   if (first.empty()) first = state;
                                   for (std::size_t i = 0; i < state.size(); ++i)
                                     EXPECT_NEAR(state[i], first[i], 1e-7);
                                 });
}

TEST(AugmentedLagrangian, FindsOneOptimumWhereverRoundingLeads) {
  expect_one_optimum(closest_of_a_circle().graph);
  expect_one_optimum(rosenbrock_on_the_unit_disc().graph);
  expect_one_optimum(quadratic_programme().graph);
  expect_one_optimum(points_of_a_sum());
  expect_one_optimum(ring_with_an_exact_chord());
}

TEST(AugmentedLagrangian, CutsAStepShortThatRunsIntoAStiffHinge) {
  const auto run_with = [](bool shorten_steps) {
    OnePoint problem(0.0, 0.0);
    problem.near(3.0, 4.0);
    HingedWall wall;
    wall.weights.setConstant(1e8);
    problem.graph.add_edge(wall, problem.point);
    OptimiserOptions options;
    options.shorten_steps = shorten_steps;
    const OptimiserResult result = run(problem.graph, options);
    EXPECT_TRUE(result.converged) << result.reason_text();
    EXPECT_NEAR(problem.at()[0], 1.0, 1e-7);
    EXPECT_NEAR(problem.at()[1], 4.0, 1e-4);
    return result;
  };
  const OptimiserResult damped = run_with(false), cut = run_with(true);
  EXPECT_GT(damped.statistics[0].refusals, 0);
  EXPECT_EQ(cut.statistics[0].refusals, 0);
}

TEST(AugmentedLagrangian, StartsWarmFromTheMultipliersOfTheLastCall) {
  OnePoint point;
  const EdgeId target = point.near(3.0, 4.0);
  point.circle(2.0, ConstraintKind::kEquality);
  Problem problem;
  problem.compile(point.graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const auto solver = make_linear_solver("auto");
  const ConstrainedResult cold = optimise_constrained(workspace, {}, *solver);
  point.graph.edge<Near>(target).target << 3.001, 4.0;
  const ConstrainedResult warm = optimise_constrained(workspace, {}, *solver, true);
  EXPECT_TRUE(warm.converged);
  EXPECT_LT(warm.rounds, cold.rounds);
  const Eigen::Vector2d expected = 2.0 * Eigen::Vector2d(3.001, 4.0).normalized();
  EXPECT_NEAR(workspace.state()[0], expected[0], 1e-7);
  EXPECT_NEAR(workspace.state()[1], expected[1], 1e-7);
}

TEST(AugmentedLagrangian, ChargesShiftedRowsWithTheGradientOfTheirCost) {
  OnePoint point(0.7, -0.4);
  point.near(3.0, 4.0);
  point.circle(2.0, ConstraintKind::kEquality);
  Eigen::Matrix<double, 3, 2> a;
  a << 1.0, 2.0, -1.0, 0.5, 0.0, 1.0;
  point.half_planes(a, Eigen::Vector3d(0.5, -0.6, 3.0));
  point.graph.set_kernel(RobustKernel::parse("huber:0.1"));
  point.graph.edge<Near>({0}).kernel = {};
  Problem problem;
  problem.compile(point.graph);
  ASSERT_EQ(problem.constraint_rows(), 4);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  for (int r = 0; r < 4; ++r) {
    workspace.constraint_rows()[r].shift = 0.3 * r - 0.2;
    workspace.constraint_rows()[r].scale = 1.0 + r;
  }
  workspace.evaluate(workspace.state());
  workspace.linearise();
  for (int d = 0; d < 2; ++d) {
    constexpr double kStep = 1e-5;
    std::vector<double> plus = workspace.state(), minus = plus;
    plus[d] += kStep;
    minus[d] -= kStep;
    const double slope =
        (workspace.evaluate(plus).robust - workspace.evaluate(minus).robust) / (2.0 * kStep);
    EXPECT_NEAR(2.0 * workspace.gradient()[d], slope, 1e-6);
  }
}

TEST(AugmentedLagrangian, DoesNotAllocateWhileItIterates) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  OnePoint point;
  point.near(3.0, 4.0);
  point.circle(2.0, ConstraintKind::kEquality);
  Problem problem;
  problem.compile(point.graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const auto solver = make_linear_solver("auto");
  Optimiser optimiser({});
  optimiser.start(workspace, *solver);
  optimiser.iterate();
  const long before = allocation_count();
  while (optimiser.iterate()) {
  }
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST(AugmentedLagrangian, WithoutConstraintsIsOneRun) {
  Graph graph = ring_2d(10), plain = ring_2d(10);
  ConstrainedOptions options;
  const ConstrainedResult result =
      optimise_constrained(graph, options, *make_linear_solver("auto"));
  const OptimiserResult expected = run(plain, options.inner);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.rounds, 1);
  EXPECT_EQ(result.worst, -1);
  EXPECT_NEAR(result.cost.chi2, expected.final.chi2, 1e-12 * expected.final.chi2);
  EXPECT_EQ(graph.vertex(VertexId<VertexSE2>{5}).state, plain.vertex(VertexId<VertexSE2>{5}).state);
}

TEST(AugmentedLagrangian, SaysWhyAnInnerRunFailed) {
  OnePoint problem;
  problem.circle(2.0, ConstraintKind::kEquality);  // one row for two unknowns
  ConstrainedOptions options;
  options.inner.algorithm = Algorithm::kGaussNewton;
  const ConstrainedResult result = problem.solve(options);
  EXPECT_EQ(result.reason, ConstrainedResult::Reason::kInnerFailed);
  EXPECT_NE(result.reason_text(problem.graph).find("singular"), std::string::npos);
}

TEST(AugmentedLagrangian, RefusesOptionsAndMatricesThatMakeNoSense) {
  ConstrainedOptions options;
  options.growth = 1.0;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.tolerance = 0.0;
  EXPECT_THROW(options.validate(), Error);
  OnePoint problem;
  Near near;
  near.information << 2.0, 1.0, 1.0, 2.0;
  const EdgeId full = problem.graph.add_edge(near, problem.point);
  EXPECT_THROW(problem.graph.set_constraint(full, ConstraintKind::kInequality), Error);
  EXPECT_NO_THROW(problem.graph.set_constraint(full, ConstraintKind::kEquality));
  near.information << 1.0, 1.0, 1.0, 1.0;
  const EdgeId singular = problem.graph.add_edge(near, problem.point);
  EXPECT_THROW(problem.graph.set_constraint(singular, ConstraintKind::kEquality), Error);
}

TEST(IterationCallback, SeesEveryIterationAndStopsTheRun) {
  Graph graph = helix_3d(30, 0.3);
  OptimiserOptions options;
  int calls = 0;
  options.on_iteration = [&](const OptimiserResult& so_far) {
    ++calls;
    EXPECT_EQ(so_far.statistics.size(), static_cast<std::size_t>(calls));
    return calls < 2;
  };
  const OptimiserResult result = run(graph, options);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, OptimiserResult::Reason::kStopped);
  EXPECT_EQ(result.reason_text(), "stopped by the caller");
}

}  // namespace
}  // namespace locograph::test
