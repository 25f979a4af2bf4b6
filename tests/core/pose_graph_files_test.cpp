#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/standard_types.h>

#include "core/best_known_chi2.h"

namespace locograph {
namespace {

class KnownPoseGraph : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(PoseGraphFiles, KnownPoseGraph,
                         testing::Values("tinyGrid3D", "CSAIL", "intel"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(KnownPoseGraph, IsOptimisedToTheBestKnownChi2) {
  const std::filesystem::path file = test::public_pose_graph(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const std::optional<double> best = test::best_known_chi2(GetParam());
  if (!best) GTEST_SKIP() << "no reference data, or nlohmann-json is not installed";
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  EXPECT_TRUE(result.converged) << result.reason_text();
  EXPECT_NEAR(result.final.chi2, *best, 1e-3 * *best);
}

}  // namespace
}  // namespace locograph
