#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "common/allocation_counter.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

struct NamedGraph {
  const char* name;
  std::function<Graph()> build;
};
void PrintTo(const NamedGraph& graph, std::ostream* out) { *out << graph.name; }

class EveryGraphAndSolver
    : public testing::TestWithParam<std::tuple<NamedGraph, std::string, Algorithm>> {
 protected:
  OptimiserOptions options() const {
    OptimiserOptions options;
    options.algorithm = std::get<2>(GetParam());
    options.max_iterations = 20;
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(
    Optimiser, EveryGraphAndSolver,
    testing::Combine(
        testing::Values(NamedGraph{"Ring", [] { return ring_2d(40); }},
                        NamedGraph{"Helix", [] { return helix_3d(40); }},
                        NamedGraph{"ByHand", [] { return mixed_graph<Derivatives::kByHand>(); }},
                        NamedGraph{"Dual", [] { return mixed_graph<Derivatives::kDual>(); }},
                        NamedGraph{"Numeric", [] { return mixed_graph<Derivatives::kNumeric>(); }},
                        NamedGraph{"Sized", [] { return sized_graph(); }}),
        testing::Values("dense", "banded", "block-cholesky"), testing::ValuesIn(kAlgorithms)),
    [](const auto& info) {
      std::string name = std::get<1>(info.param);
      std::erase(name, '-');
      return std::get<0>(info.param).name + name + name_of(std::get<2>(info.param));
    });

TEST_P(EveryGraphAndSolver, IteratesWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = std::get<0>(GetParam()).build();
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const std::unique_ptr<LinearSolver> solver = make_linear_solver(std::get<1>(GetParam()));
  Optimiser optimiser(options());
  optimiser.start(workspace, *solver);
  const long before = allocation_count();
  while (optimiser.iterate()) {
  }
  const long after = allocation_count();
  EXPECT_EQ(after - before, 0);
  EXPECT_FALSE(optimiser.result().statistics.empty());
}

TEST_P(EveryGraphAndSolver, GivesTheSameBitsEveryTime) {
  const auto states = [&] {
    Graph graph = std::get<0>(GetParam()).build();
    run(graph, options(), std::get<1>(GetParam()));
    std::vector<double> all;
    for (int v = 0; v < graph.vertex_slots(); ++v) {
      all.insert(all.end(), graph.state(v), graph.state(v) + graph.state_size(v));
    }
    return all;
  };
  const std::vector<double> first = states(), second = states();
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

TEST(AllocationCounter, Counts) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const long before = allocation_count();
  const std::unique_ptr<std::vector<int>> numbers = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(numbers->size(), 100u);
  EXPECT_GE(allocation_count() - before, 2);
}

}  // namespace
}  // namespace locograph::test
