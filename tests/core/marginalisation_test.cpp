#include <gtest/gtest.h>
#include <locograph/core/covariance.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/marginalisation.h>
#include <locograph/types/standard_types.h>

#include <random>

#include "common/allocation_counter.h"
#include "core/dense_system.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

/// Points in the plane tied by noisy differences: linear, however far one moves.
Graph linear_grid(int side) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal(0.0, 0.3);
  Graph graph;
  std::vector<VertexId<VertexXY>> ids;
  for (int i = 0; i < side * side; ++i) {
    ids.push_back(graph.add_vertex(i, VertexXY({normal(engine), normal(engine)})));
  }
  const auto tie = [&](int a, int b, const Eigen::Vector2d& z) {
    EdgePointXY edge;
    edge.measurement = z + Eigen::Vector2d(normal(engine), normal(engine));
    edge.information << 3.0, 0.5, 0.5, 2.0;
    graph.add_edge(edge, ids[a], ids[b]);
  };
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      if (c + 1 < side) tie(r * side + c, r * side + c + 1, {1.0, 0.0});
      if (r + 1 < side) tie(r * side + c, (r + 1) * side + c, {0.0, 1.0});
    }
  }
  graph.set_fixed(ids.back(), true);
  return graph;
}

TEST(Marginalisation, OfALinearProblemKeepsEstimateCovarianceAndChi2) {
  Graph whole = linear_grid(5), part = linear_grid(5);
  // Not at the optimum: the prior's gradient matters. One by one: priors are marginalised too.
  const Marginalised first = marginalise(part, {0, 6});
  const Marginalised second = marginalise(part, {1, 2});
  EXPECT_EQ(first.blanket, (std::vector<int>{1, 5, 7, 11}));
  EXPECT_EQ(first.edges_removed, 6);
  EXPECT_EQ(second.blanket, (std::vector<int>{3, 5, 7, 11}));
  EXPECT_EQ(part.vertex_count(), 21);
  OptimiserOptions undamped;
  undamped.algorithm = Algorithm::kGaussNewton;
  const OptimiserResult all = run(whole, undamped), rest = run(part, undamped);
  EXPECT_TRUE(rest.converged);
  EXPECT_LE(state_difference(whole, part), 1e-11);
  EXPECT_NEAR(rest.final.chi2 + first.constant + second.constant, all.final.chi2, 1e-10);
  const Covariance expected(whole, make_linear_solver("auto"));
  const Covariance got(part, make_linear_solver("auto"));
  for (const auto& [a, b] : {std::pair(3, 3), std::pair(5, 11), std::pair(20, 7)}) {
    EXPECT_LE(relative_difference(expected.block(a, b), got.block(a, b)), 1e-11);
  }
}

TEST(Marginalisation, AtTheOptimumKeepsPosesWhereTheyAre) {
  Graph graphs[] = {ring_2d(30), helix_3d(30)};
  for (Graph& graph : graphs) {
    OptimiserOptions exact;
    exact.gain = 1e-14;
    run(graph, exact);
    const auto joint = [](Graph& of) {
      return Covariance(of, make_linear_solver("auto")).joint(std::vector<int>{12, 25});
    };
    const Eigen::MatrixXd expected = joint(graph);
    Graph whole = read_graph_text(write_graph_text(graph), "", {}, standard_types());
    marginalise(graph, {3, 4, 5, 17});
    run(graph, exact);
    EXPECT_LE(state_difference(whole, graph), 1e-8);
    const Eigen::MatrixXd got = joint(graph);
    EXPECT_LE((got - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(Marginalisation, IsRightToFirstOrderAroundItsLinearisationPoint) {
  // New measurements pull the rest away: the error falls with the square of the pull. (Without
  // noise: residuals leave curvature in the edges that Gauss-Newton neglects.)
  const auto difference = [](double pull) {
    Graph whole = ring_2d(20, 0.0), part = ring_2d(20, 0.0);
    OptimiserOptions exact;
    exact.gain = 1e-14;
    for (Graph* graph : {&whole, &part}) run(*graph, exact);
    marginalise(part, {1, 2, 3});
    for (Graph* graph : {&whole, &part}) {
      EdgePriorSE2 prior;
      prior.measurement = graph->vertex(VertexId<VertexSE2>{4}).pose() * SE2<double>(pull, 0, pull);
      graph->add_edge(prior, VertexId<VertexSE2>{4});
      run(*graph, exact);
    }
    return state_difference(whole, part);
  };
  const double large = difference(0.04), small = difference(0.02);
  EXPECT_LT(large, 0.004);
  EXPECT_LT(small, large / 3.0);
}

TEST(Marginalisation, OfAFloatingGraphLeavesItsGaugeFree) {
  Graph graph = ring_2d(12);
  graph.set_fixed(0, false);
  const Marginalised result = marginalise(graph, {5});
  const Eigen::VectorXd eigenvalues =
      graph.dense_prior(result.prior).information.selfadjointView<Eigen::Upper>().eigenvalues();
  EXPECT_NEAR(eigenvalues.head(3).cwiseAbs().maxCoeff(), 0.0, 1e-10 * eigenvalues.maxCoeff());
  EXPECT_GT(eigenvalues[3], 1e-3 * eigenvalues.maxCoeff());
}

TEST(Marginalisation, OfAnAnchorLeavesItToTheNeighbours) {
  Graph whole = ring_2d(10), part = ring_2d(10);
  OptimiserOptions exact;
  exact.gain = 1e-14;
  run(whole, exact);
  run(part, exact);
  const Marginalised result = marginalise(part, {0});  // fixed
  EXPECT_EQ(result.blanket, (std::vector<int>{1, 5, 9}));
  EXPECT_TRUE(run(part, exact).converged);
  EXPECT_LE(state_difference(whole, part), 1e-8);
}

TEST(Marginalisation, OfAWholePartLeavesNothing) {
  Graph graph = ring_2d(4);
  const Marginalised result = marginalise(graph, {0, 1, 2, 3});
  EXPECT_EQ(result.prior.slot, -1);
  EXPECT_EQ(graph.vertex_count(), 0);
  EXPECT_EQ(graph.edge_count(), 0);
}

TEST(Marginalisation, TakesAnyTypesOfVertices) {
  Graph graph = sized_graph();
  const int arm = 2, point = 3;  // an arm with its posture free: a prior on it mixes sizes
  ToyMeet<Derivatives::kByHand> meet;
  graph.add_edge(meet, VertexId<VertexJoints>{0}, VertexId<VertexJoints>{arm});
  const Marginalised result = marginalise(graph, {point});
  EXPECT_EQ(result.blanket, (std::vector<int>{arm}));
  const Marginalised second = marginalise(graph, {arm});
  EXPECT_EQ(second.blanket, (std::vector<int>{0}));
  EXPECT_EQ(graph.dense_prior(second.prior).information.rows(), graph.dimension(0));
  const OptimiserResult rest = run(graph, {});
  EXPECT_TRUE(rest.converged) << rest.reason_text();
  EXPECT_LT(rest.final.robust, 1e-12 * rest.initial.robust) << "everything can be met";
}

TEST(Marginalisation, RefusesWhatItCannotTakeOut) {
  Graph graph = ring_2d(6);
  EXPECT_THROW(marginalise(graph, {99}), Error);
  EXPECT_THROW(marginalise(graph, {2, 2}), Error);
  graph.set_constraint({2}, ConstraintKind::kEquality);
  EXPECT_THROW(marginalise(graph, {2}), Error);
  EXPECT_EQ(graph.vertex_count(), 6) << "nothing is half done";
  EXPECT_NO_THROW(marginalise(graph, {5}));
}

Graph with_priors() {
  Graph graph = helix_3d(12);
  const auto point = graph.add_vertex(100, VertexPointXYZ(Eigen::Vector3d(1.0, 2.0, 3.0)));
  graph.set_fixed(0, false);
  DensePrior prior;
  prior.vertices = {3, point.slot};
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  for (const int v : {2, point.slot}) {
    prior.states.insert(prior.states.end(), graph.state(v), graph.state(v) + graph.state_size(v));
  }
  Eigen::MatrixXd a(9, 9);
  for (double& value : a.reshaped()) value = normal(engine);
  prior.information = a * a.transpose();
  prior.offset = Eigen::VectorXd::LinSpaced(9, -0.3, 0.4);
  graph.add_dense_prior(prior);
  marginalise(graph, {0, 1});
  return graph;
}

TEST(DensePrior, InABatchEqualsOneByOne) {
  Graph graph = with_priors();
  graph.set_kernel(RobustKernel::parse("cauchy:2"));
  for (const auto& pool : graph.edge_pools()) {
    if (pool->type() == typeid(DensePrior)) pool->kernel(0).second_order = true;
  }
  graph.set_fixed(4, true);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  std::mt19937 engine(3);
  std::normal_distribution<double> normal(0.0, 0.2);
  for (double& d : workspace.step()) d = normal(engine);
  workspace.apply_step();
  workspace.accept_trial();
  expect_batch_equals_one_by_one(workspace, 1e-12);
  const DenseSystem numeric = one_by_one(problem, workspace.state(), true);
  EXPECT_LE(relative_difference(dense_hessian(workspace), numeric.hessian), 1e-7);
}

TEST(DensePrior, ComesBackFromAFileBitForBit) {
  const Graph graph = with_priors();
  const std::string text = write_graph_text(graph);
  EXPECT_NE(text.find("PRIOR_DENSE"), std::string::npos);
  const Graph again = read_graph_text(text, "map.g2o", {}, standard_types());
  EXPECT_EQ(write_graph_text(again), text);
}

TEST(DensePrior, ThatDoesNotFitItsVerticesIsRefused) {
  Graph graph;
  const auto a = graph.add_vertex(0, VertexXY());
  DensePrior prior;
  prior.vertices = {a.slot};
  prior.states = {0.0, 0.0, 0.0};
  prior.offset = Eigen::Vector2d::Zero();
  prior.information = Eigen::Matrix2d::Identity();
  EXPECT_THROW(graph.add_dense_prior(prior), Error);
  prior.states.pop_back();
  prior.offset = Eigen::Vector3d::Zero();
  EXPECT_THROW(graph.add_dense_prior(prior), Error);
  prior.information = Eigen::Matrix3d::Identity();
  EXPECT_THROW(graph.add_dense_prior(prior), Error);
  try {
    read_graph_text("VERTEX_XY 0 0 0\nPRIOR_DENSE 0 || 3 0 0 0 0 0 1 0 0 1 0 1\n", "map.g2o", {},
                    standard_types());
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 2);
  }
}

TEST(DensePrior, IteratesWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = with_priors();
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const auto solver = make_linear_solver("block-cholesky");
  Optimiser optimiser({});
  optimiser.start(workspace, *solver);
  const long before = allocation_count();
  while (optimiser.iterate()) {
  }
  EXPECT_EQ(allocation_count() - before, 0);
  EXPECT_TRUE(optimiser.result().converged) << optimiser.result().reason_text();
}

/// The difference of states that a type without ominus() is solved for.
TEST(VertexDifference, SolvedNumericallyIsThatOfTheType) {
  std::mt19937 engine(6);
  std::normal_distribution<double> normal;
  Scratch scratch;
  scratch.reserve(detail::ominus_scratch_bytes(6, 7));
  for (int i = 0; i < 50; ++i) {
    Eigen::Matrix<double, 6, 1> d, own, solved;
    for (double& value : d) value = 0.7 * normal(engine);
    const VertexSE3 b(SE3<double>(Eigen::Vector3d(1.0, 2.0, 3.0),
                                  quaternion_exp<double>(Eigen::Vector3d(0.3, -2.0, 0.5))));
    Eigen::Matrix<double, 7, 1> a;
    VertexSE3::oplus(b.state.data(), d.data(), a.data());
    VertexSE3::ominus(a.data(), b.state.data(), own.data());
    EXPECT_LE((own - d).norm(), 1e-12);
    detail::solve_ominus(6, 7, VertexSE3::oplus<double>, a.data(), b.state.data(), solved.data(),
                         scratch);
    EXPECT_LE((solved - d).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace locograph::test
