#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/solvers/schur_solver.h>
#include <locograph/types/bundle/bal_file.h>
#include <locograph/types/bundle/camera_bal.h>

#include <cstring>
#include <random>

#include "common/allocation_counter.h"
#include "solvers/expect_solution.h"

namespace locograph::test {
namespace {

constexpr double kSchurTolerance = 1e-11;  ///< of solutions, relative

using Reduced = SchurSolver::Reduced;

struct SchurCase {
  std::string name;
  int kept_size, eliminated_size;  ///< of the blocks; 0: mixed sizes
  int kept, eliminated, seen;      ///< each eliminated row touches `seen` kept ones
};
void PrintTo(const SchurCase& c, std::ostream* out) { *out << c.name; }

std::vector<SchurCase> schur_cases() {
  return {{"Bal", 9, 3, 12, 90, 4},
          {"Poses", 6, 3, 15, 60, 3},
          {"InverseDepth", 6, 1, 15, 60, 4},
          {"Planar", 3, 2, 20, 50, 3},
          {"Rare", 5, 4, 10, 40, 3},
          {"Mixed", 0, 0, 15, 60, 4},
          {"MixedPoints", 0, 3, 15, 60, 4},
          {"Wide", 30, 12, 6, 10, 2},
          {"OneKept", 6, 3, 1, 20, 1},
          {"OneEliminated", 6, 3, 9, 1, 9},
          {"NothingEliminated", 6, 3, 10, 0, 0},
          {"NothingKept", 6, 3, 0, 12, 0},
          {"Untouched", 6, 3, 5, 12, 0},
          {"ManyChunks", 3, 2, 20, 300, 3}};
}

RandomSystem make_system(const SchurCase& c, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<int> dimension;
  for (int i = 0; i < c.kept + c.eliminated; ++i) {
    const int size = i < c.kept ? c.kept_size : c.eliminated_size;
    dimension.push_back(size > 0 ? size : 1 + static_cast<int>(engine() % 9));
  }
  Pairs pairs = chain_pairs(c.kept, 1);
  for (int p = 0; p < c.eliminated; ++p) {
    for (int k = 0; k < c.seen; ++k) {
      // Neighbours, and now and then one that is far.
      const unsigned from = engine() % 8 == 0 ? engine() : static_cast<unsigned>(p / 3);
      const int row = static_cast<int>((from + engine() % 4) % static_cast<unsigned>(c.kept));
      pairs.emplace_back(row, c.kept + p);
    }
  }
  RandomSystem system(pairs, dimension, seed);
  system.pattern.kept = c.kept;
  return system;
}

PcgOptions tight() {
  PcgOptions options;
  options.relative_tolerance = 1e-14;
  return options;
}
std::unique_ptr<SchurSolver> make_schur(Reduced reduced) {
  return std::make_unique<SchurSolver>(reduced, tight());
}

class EverySchurSolver : public testing::TestWithParam<std::tuple<Reduced, SchurCase>> {
 protected:
  std::unique_ptr<SchurSolver> solver() const { return make_schur(std::get<0>(GetParam())); }
  RandomSystem system(unsigned seed = 1) const {
    return make_system(std::get<1>(GetParam()), seed);
  }
};
std::string test_name(const testing::TestParamInfo<std::tuple<Reduced, SchurCase>>& info) {
  const std::string names[] = {"Automatic", "Dense", "Sparse", "Pcg"};
  return names[static_cast<int>(std::get<0>(info.param))] + std::get<1>(info.param).name;
}
INSTANTIATE_TEST_SUITE_P(Schur, EverySchurSolver,
                         testing::Combine(testing::Values(Reduced::kAutomatic, Reduced::kDense,
                                                          Reduced::kSparse, Reduced::kPcg),
                                          testing::ValuesIn(schur_cases())),
                         test_name);

TEST_P(EverySchurSolver, AgreesWithDenseLdltDampingIncluded) {
  const std::unique_ptr<SchurSolver> s = solver();
  for (const unsigned seed : {1u, 2u}) {
    const RandomSystem a = system(seed);
    s->analyse(a.pattern);
    for (int again = 0; again < 2; ++again) {
      ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
      EXPECT_EQ(s->failed_row(), -1);
      expect_solution(*s, a, kSchurTolerance);
    }
  }
}

TEST_P(EverySchurSolver, GivesTheSameBitsOnTwoAndThreeThreads) {
  const RandomSystem a = system();
  const std::size_t n = a.right_hand_side.size();
  std::vector<double> alone(n), together(n);
  std::unique_ptr<SchurSolver> s = solver();
  s->analyse(a.pattern);
  ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
  s->solve(a.right_hand_side.data(), alone.data());
  for (const int count : {2, 3}) {
    ThreadPool threads(count);
    s = solver();
    s->use_threads(&threads);
    s->analyse(a.pattern);
    ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
    s->solve(a.right_hand_side.data(), together.data());
    EXPECT_EQ(std::memcmp(alone.data(), together.data(), n * sizeof(double)), 0);
  }
}

TEST_P(EverySchurSolver, FactorisesAndSolvesWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const RandomSystem a = system();
  std::vector<double> x(a.right_hand_side.size());
  for (const int count : {1, 2}) {
    ThreadPool threads(count);
    const std::unique_ptr<SchurSolver> s = solver();
    s->use_threads(&threads);
    s->analyse(a.pattern);
    const long before = allocation_count();
    s->analyse(a.pattern);
    const bool good = s->factorise(a.values.data(), a.damping.data());
    s->solve(a.right_hand_side.data(), x.data());
    const long after = allocation_count();
    EXPECT_TRUE(good);
    EXPECT_EQ(after - before, 0) << s->name() << " on " << count;
  }
}

TEST_P(EverySchurSolver, NamesTheBlockThatIsNotPositiveDefiniteAndRecovers) {
  const RandomSystem good = system();
  for (const int count : {1, 2}) {
    ThreadPool threads(count);
    const std::unique_ptr<SchurSolver> s = solver();
    s->use_threads(&threads);
    s->analyse(good.pattern);
    expect_bad_blocks_named(*s, good, kSchurTolerance);
  }
}

TEST(SchurSolver, RefusesTwoEliminatedRowsThatShareAnEdgeAndNamesThem) {
  RandomSystem a(Pairs{{0, 2}, {1, 3}, {2, 4}}, {6, 6, 3, 3, 3}, 1);
  a.pattern.kept = 2;
  EXPECT_EQ(tied_eliminated_rows(a.pattern).first, 2);
  EXPECT_EQ(tied_eliminated_rows(a.pattern).second, 4);
  for (const char* name : {"schur", "schur-dense", "schur-sparse", "schur-pcg"}) {
    try {
      make_linear_solver(name)->analyse(a.pattern);
      ADD_FAILURE() << name << " took it";
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("rows 2 and 4"), std::string::npos) << message;
    }
  }
  // Nothing is wrong with the system: a solver that ignores the marks takes it.
  const std::unique_ptr<LinearSolver> automatic = make_linear_solver("auto");
  automatic->analyse(a.pattern);
  ASSERT_TRUE(automatic->factorise(a.values.data(), a.damping.data()));
  expect_solution(*automatic, a, kSchurTolerance);
}

TEST(SchurSolver, IsAnalysedAgainWhenThePatternChanges) {
  for (const Reduced reduced :
       {Reduced::kAutomatic, Reduced::kDense, Reduced::kSparse, Reduced::kPcg}) {
    const std::unique_ptr<SchurSolver> s = make_schur(reduced);
    for (const SchurCase& c : schur_cases()) {
      const RandomSystem a = make_system(c, 5);
      s->analyse(a.pattern);
      ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data())) << c.name;
      expect_solution(*s, a, kSchurTolerance);
    }
  }
}

TEST(SchurSolver, ChoosesHowToSolveWhatIsLeft) {
  SchurSolver s;
  EXPECT_EQ(s.name(), "schur");
  SchurCase c{"", 6, 3, 20, 300, 15};
  s.analyse(make_system(c, 1).pattern);
  EXPECT_EQ(s.name(), "schur-dense");
  Pairs street = chain_pairs(300, 1);
  for (int p = 0; p < 1200; ++p) {
    for (int k = 0; k < 4; ++k) street.emplace_back((p / 4 + k) % 300, 300 + p);
  }
  std::vector<int> sizes(300, 6);
  sizes.resize(1500, 3);
  BlockPattern pattern = make_pattern(street, sizes);
  pattern.kept = 300;
  s.analyse(pattern);
  EXPECT_EQ(s.name(), "schur-sparse");
}

TEST(AutoSolver, EliminatesWhatIsMarkedWhenThatIsCheaper) {
  const std::unique_ptr<LinearSolver> automatic = make_linear_solver("auto");
  const RandomSystem bundle = make_system({"", 9, 3, 12, 400, 4}, 1);
  automatic->analyse(bundle.pattern);
  EXPECT_EQ(automatic->name().substr(0, 5), "schur");
  ASSERT_TRUE(automatic->factorise(bundle.values.data(), bundle.damping.data()));
  expect_solution(*automatic, bundle, kSchurTolerance);
  // Marking the hub of a wheel fills in everything: not followed.
  Pairs wheel = arrow_pairs(301, 300);
  for (int i = 0; i + 1 < 300; ++i) wheel.emplace_back(i, i + 1);
  BlockPattern hub = make_pattern(wheel, std::vector<int>(301, 6));
  hub.kept = 300;
  automatic->analyse(hub);
  EXPECT_NE(automatic->name().substr(0, 5), "schur");
}

/// Cameras on a circle that look inwards at points near its centre, perturbed; seeded.
Graph small_bundle() {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  Graph graph;
  std::vector<VertexId<VertexCameraBAL>> cameras;
  std::vector<VertexCameraBAL::State> truth;
  for (int c = 0; c < 6; ++c) {
    VertexCameraBAL::State s;
    s << 0.0, 1.0 * c, 0.0, 0.0, 0.0, -5.0, 500.0, 0.01, 0.001;
    truth.push_back(s);
    for (int i = 0; i < 6; ++i) s[i] += 0.01 * normal(engine);
    cameras.push_back(graph.add_vertex(c, VertexCameraBAL(s)));
  }
  for (int p = 0; p < 60; ++p) {
    const Eigen::Vector3d point(normal(engine), normal(engine), normal(engine));
    const VertexId<VertexPointXYZ> id =
        graph.add_vertex(100 + p, VertexPointXYZ(point + 0.01 * Eigen::Vector3d::Ones()));
    graph.set_eliminate(id.slot, true);
    for (int c = 0; c < 6; ++c) {
      VertexCameraBAL::Derived derived;
      VertexCameraBAL().derive(truth[c].data(), derived);
      EdgeProjectBAL edge;
      Eigen::Vector2d seen;
      edge.error(derived, point, seen);
      edge.measurement = seen + 0.5 * Eigen::Vector2d(normal(engine), normal(engine));
      graph.add_edge(edge, cameras[c], id);
    }
  }
  return graph;
}

TEST(BundleAdjustment, ReachesTheSameOptimumWithEverySolverAndNothingFixed) {
  double reference = 0.0;
  for (const std::string name :
       {"block-cholesky", "auto", "schur", "schur-dense", "schur-sparse", "schur-pcg", "pcg"}) {
    Graph graph = small_bundle();
    OptimiserOptions options;
    options.gain = 1e-12;
    const OptimiserResult result = optimise(graph, options, *make_linear_solver(name));
    EXPECT_TRUE(result.converged) << name << ": " << result.reason_text();
    if (reference == 0.0) reference = result.final.chi2;
    EXPECT_NEAR(result.final.chi2, reference, 1e-6 * reference) << name;
  }
  // 0.25 px² for each of 720 coordinates less 7 · 6 + 180 − 7 unknowns that matter, give or take.
  EXPECT_LT(reference, 0.25 * 720);
  EXPECT_GT(reference, 0.25 * 400);
}

TEST(BundleAdjustment, HasTheSameBitsOnTwoThreads) {
  for (const char* name : {"schur-sparse", "schur-pcg"}) {
    std::vector<double> states[2];
    for (const int count : {1, 2}) {
      ThreadPool threads(count);
      Graph graph = small_bundle();
      const std::unique_ptr<LinearSolver> solver = make_linear_solver(name);
      solver->use_threads(&threads);
      OptimiserOptions options;
      options.max_iterations = 5;
      optimise(graph, options, *solver);
      for (int v = 0; v < graph.vertex_slots(); ++v) {
        states[count - 1].insert(states[count - 1].end(), graph.state(v),
                                 graph.state(v) + graph.state_size(v));
      }
    }
    EXPECT_EQ(states[0], states[1]) << name;
  }
}

}  // namespace
}  // namespace locograph::test
