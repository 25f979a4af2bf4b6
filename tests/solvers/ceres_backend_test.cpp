#include <gtest/gtest.h>
#include <locograph/solvers/ceres_backend.h>
#include <locograph/types/standard_types.h>

#include "core/toy_graphs.h"
#include "types/random_lines.h"

namespace locograph::test {
namespace {

std::vector<std::string> edge_tags() {
  const TypeRegistry types = standard_types();
  std::vector<std::string> tags;
  for (const std::string& tag : types.tags()) {
    if (types.edge_type(tag) != nullptr) tags.push_back(tag);
  }
  return tags;
}
std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) == 0 ? '_' : c;
  return name;
}

/// Several edges of one type, with measurements that contradict each other, on the same vertices.
Graph contradicting_edges(const std::string& tag, unsigned seed) {
  RandomLines lines(standard_types(), seed);
  std::string text = lines.parameters();
  for (int i = 0; i < 8; ++i) {
    const std::vector<std::string> all = lines.edge(tag, 0);
    if (i == 0) {
      for (std::size_t v = 0; v + 1 < all.size(); ++v) text += all[v] + "\n";
    }
    text += all.back() + "\n";
  }
  Graph graph = read_graph_text(text, "random.g2o", {}, standard_types());
  if (graph.vertex_slots() > 1) graph.set_fixed(0, true);
  return graph;
}

void expect_the_same_cost_and_gradient(Graph& graph) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const Cost cost = workspace.evaluate(workspace.state());
  workspace.linearise();
  const CeresEvaluation theirs = evaluate_with_ceres(graph);
  EXPECT_NEAR(theirs.cost, cost.robust, 1e-12 * cost.robust);
  ASSERT_EQ(theirs.gradient.size(), workspace.gradient().size());
  double largest = 0.0;
  for (const double g : theirs.gradient) largest = std::max(largest, std::abs(g));
  EXPECT_GT(largest, 0.0);
  for (std::size_t i = 0; i < theirs.gradient.size(); ++i) {
    EXPECT_NEAR(theirs.gradient[i], workspace.gradient()[i], 1e-11 * largest);
  }
}

OptimiserOptions exact() {
  OptimiserOptions options;
  options.gain = 1e-14;
  options.max_iterations = 500;
  return options;
}

/// Moves every free vertex by a small step.
void disturb(Graph& graph, double size) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  std::mt19937 engine(5);
  std::normal_distribution<double> normal(0.0, size);
  for (double& d : workspace.step()) d = normal(engine);
  workspace.apply_step();
  workspace.accept_trial();
  workspace.store_state();
}

class EveryEdgeType : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(CeresBackend, EveryEdgeType, testing::ValuesIn(edge_tags()), test_name);

TEST_P(EveryEdgeType, HasTheCostAndGradientThatCeresComputes) {
  for (const char* kernel : {"none", "huber:0.5", "cauchy:2"}) {
    Graph graph = contradicting_edges(GetParam(), 1);
    graph.set_kernel(RobustKernel::parse(kernel));
    expect_the_same_cost_and_gradient(graph);
  }
}

/// A minimum where the cost is smooth, told by the cosine between errors and each column of their
/// Jacobian: measurements that contradict each other wildly can also leave the optimiser at a jump
/// of the cost, where a rotation error passes half a turn. Nor may it lie in a valley so flat that
/// the step to its bottom still lowers the cost: neither optimiser gets there in time. Nor at
/// infinity, where a camera that sees a point through contradicting images may go: the cost falls
/// with every step, and where to stop is a matter of rounding.
bool is_smooth_minimum(Graph& graph) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  constexpr double kFar = 1e4;  // measurements are of the size of one
  for (const double value : workspace.state()) {
    if (std::abs(value) > kFar) return false;
  }
  const double chi2 = workspace.evaluate(workspace.state()).chi2;
  workspace.linearise();
  std::vector<double> diagonal(problem.dimension());
  workspace.diagonal(diagonal);
  for (int i = 0; i < problem.dimension(); ++i) {
    if (std::abs(workspace.gradient()[i]) > 1e-7 * std::sqrt(diagonal[i] * chi2) + 1e-12) {
      return false;
    }
  }
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("dense");
  solver->analyse(problem.pattern());
  std::vector<double> damping(problem.dimension());  // for directions that nothing measures
  for (int i = 0; i < problem.dimension(); ++i) damping[i] = 1e-9 * diagonal[i] + 1e-12;
  if (!solver->factorise(workspace.hessian().data(), damping.data())) return false;
  Eigen::VectorXd step(problem.dimension());
  solver->solve(workspace.gradient().data(), step.data());
  const Eigen::Map<const Eigen::VectorXd> gradient(workspace.gradient().data(), step.size());
  return gradient.dot(step) <= 1e-10 * chi2 + 1e-15;
}

TEST_P(EveryEdgeType, HasTheOptimumThatCeresFinds) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 40 && compared < 3; ++seed) {
    Graph graph = contradicting_edges(GetParam(), seed);
    const OptimiserResult ours = run(graph, exact());
    if (!ours.converged || !is_smooth_minimum(graph)) continue;
    ++compared;
    // From near by: contradicting measurements have more minima than one.
    disturb(graph, 1e-5);
    const OptimiserResult theirs = optimise_with_ceres(graph, exact());
    EXPECT_TRUE(theirs.converged) << theirs.reason_text();
    EXPECT_NEAR(theirs.final.chi2, ours.final.chi2, 1e-8 * ours.final.chi2 + 1e-15) << seed;
  }
  EXPECT_GT(compared, 0);
}

TEST(CeresBackend, AgreesOnSizesAndArityKnownAtRunTime) {
  Graph mixed = mixed_graph<Derivatives::kDual>();
  mixed.set_kernel(RobustKernel::parse("huber:1"));
  expect_the_same_cost_and_gradient(mixed);
  Graph sized = sized_graph();
  expect_the_same_cost_and_gradient(sized);
}

TEST(CeresBackend, AgreesUnderASchurComplement) {
  for (const Algorithm algorithm : {Algorithm::kLevenbergMarquardt, Algorithm::kDogleg}) {
    Graph poses;
    std::vector<VertexId<VertexSE2>> ids;
    for (int i = 0; i < 6; ++i) ids.push_back(poses.add_vertex(i, VertexSE2(SE2<double>(i, 0, 0))));
    for (int i = 0; i < 4; ++i) {
      const auto point = poses.add_vertex(10 + i, VertexXY({i + 0.5, 2.0}));
      poses.set_eliminate(point.slot, true);
      for (const VertexId<VertexSE2> pose : ids) {
        EdgeSE2XY edge;
        edge.measurement << i + 0.4 - 1.1 * pose.slot,
            2.1 + 0.1 * std::sin(3.0 * i + 5.0 * pose.slot);
        poses.add_edge(edge, pose, point);
      }
    }
    poses.set_fixed(ids[0].slot, true);
    OptimiserOptions options = exact();
    options.algorithm = algorithm;
    const OptimiserResult theirs = optimise_with_ceres(poses, options);
    EXPECT_TRUE(theirs.converged) << theirs.reason_text();
    disturb(poses, 1e-2);
    const OptimiserResult ours = run(poses, options, "block-cholesky");
    EXPECT_GT(ours.final.chi2, 1e-3);
    EXPECT_NEAR(theirs.final.chi2, ours.final.chi2, 1e-8 * ours.final.chi2);
  }
}

TEST(CeresBackend, CountsIterationsAndObeysTheCaller) {
  Graph graph = helix_3d(30, 0.2);
  OptimiserOptions options;
  const OptimiserResult result = optimise_with_ceres(graph, options);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.statistics.size(), static_cast<std::size_t>(result.iterations));
  EXPECT_NEAR(result.statistics.back().cost, result.final.robust, 1e-9 * result.final.robust);
  EXPECT_LT(result.final.chi2, result.initial.chi2);

  graph = helix_3d(30, 0.2);
  options.on_iteration = [](const OptimiserResult& so_far) { return so_far.iterations < 2; };
  EXPECT_EQ(optimise_with_ceres(graph, options).reason, OptimiserResult::Reason::kStopped);
  options = {};
  options.max_iterations = 1;
  graph = helix_3d(30, 0.2);
  EXPECT_EQ(optimise_with_ceres(graph, options).reason, OptimiserResult::Reason::kMaxIterations);
  options = {};
  options.deadline = Deadline::after(0.0);
  graph = helix_3d(30, 0.2);
  EXPECT_EQ(optimise_with_ceres(graph, options).reason, OptimiserResult::Reason::kDeadline);
}

TEST(CeresBackend, RefusesWhatItCannotSolve) {
  Graph graph = ring_2d(5);
  OptimiserOptions options;
  options.algorithm = Algorithm::kGaussNewton;
  EXPECT_THROW(optimise_with_ceres(graph, options), Error);
  graph.set_constraint({0}, ConstraintKind::kEquality);
  EXPECT_THROW(optimise_with_ceres(graph, {}), Error);
}

class PoseGraphFile : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(CeresBackend, PoseGraphFile,
                         testing::Values("tinyGrid3D", "CSAIL", "intel"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(PoseGraphFile, HasTheOptimumThatCeresFinds) {
  const std::filesystem::path file = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" /
                                     (std::string(GetParam()) + ".g2o");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  const OptimiserResult ours = run(graph, {});
  graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  const OptimiserResult theirs = optimise_with_ceres(graph, {});
  EXPECT_TRUE(theirs.converged) << theirs.reason_text();
  EXPECT_NEAR(theirs.initial.chi2, ours.initial.chi2, 1e-12 * ours.initial.chi2);
  EXPECT_NEAR(theirs.final.chi2, ours.final.chi2, 1e-6 * ours.final.chi2);
}

}  // namespace
}  // namespace locograph::test
