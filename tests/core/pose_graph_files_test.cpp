#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/standard_types.h>

#include <fstream>

#if __has_include(<nlohmann/json.hpp>)
#include <nlohmann/json.hpp>
#define LOCOGRAPH_TEST_HAS_JSON 1
#else
#define LOCOGRAPH_TEST_HAS_JSON 0
#endif

namespace locograph {
namespace {

class KnownPoseGraph : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(PoseGraphFiles, KnownPoseGraph,
                         testing::Values("tinyGrid3D", "CSAIL", "intel"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(KnownPoseGraph, IsOptimisedToTheBestKnownChi2) {
#if LOCOGRAPH_TEST_HAS_JSON
  const std::filesystem::path data = LOCOGRAPH_SHARED_DATA;
  const std::filesystem::path file = data / "pose_graphs" / (std::string(GetParam()) + ".g2o");
  const std::filesystem::path reference = data / ".." / "reference" / "pose_graphs.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  if (!std::filesystem::exists(reference)) GTEST_SKIP() << reference << " is not there";
  const double best =
      nlohmann::json::parse(std::ifstream(reference))["graphs"][GetParam()]["chi2"].get<double>();
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  EXPECT_TRUE(result.converged) << result.reason_text();
  EXPECT_NEAR(result.final.chi2, best, 1e-3 * best);
#else
  GTEST_SKIP() << "nlohmann-json is not installed";
#endif
}

}  // namespace
}  // namespace locograph
