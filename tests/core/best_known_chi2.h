#pragma once
/// The lowest chi2 that is known of a public pose graph, from the shared reference data.
///
///     const std::optional<double> best = best_known_chi2("intel");
///     if (!best) GTEST_SKIP() << "no reference data, or nlohmann-json is not installed";

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#if __has_include(<nlohmann/json.hpp>)
#include <nlohmann/json.hpp>
#endif

namespace locograph::test {

inline std::filesystem::path public_pose_graph(const std::string& name) {
  return std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" / (name + ".g2o");
}

inline std::optional<double> best_known_chi2([[maybe_unused]] const std::string& name) {
#if __has_include(<nlohmann/json.hpp>)
  const std::filesystem::path reference =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / ".." / "reference" / "pose_graphs.json";
  if (std::filesystem::exists(reference)) {
    return nlohmann::json::parse(std::ifstream(reference))["graphs"][name]["chi2"].get<double>();
  }
#endif
  return std::nullopt;
}

}  // namespace locograph::test
