#pragma once
/// The public pose graphs of the shared data.
///
///     Graph graph = read_graph(pose_graph_file("intel"), standard_types());

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

inline std::filesystem::path pose_graph_file(const std::string& name) {
  return std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" / (name + ".g2o");
}

/// All of them, sorted; none where there is no shared data.
inline std::vector<std::filesystem::path> pose_graph_files() {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder = pose_graph_file("").parent_path();
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".g2o") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace locograph
