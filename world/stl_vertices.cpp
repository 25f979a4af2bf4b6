#include <locograph/common/error.h>
#include <locograph/world/stl_vertices.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <string>

namespace locograph {
namespace {

// 80 bytes of comment, a count, then per facet 12 floats (normal, three corners) and 2 bytes.
constexpr std::size_t kHeader = 84, kFacet = 50;

std::vector<Eigen::Vector3d> read_binary(const std::string& content, std::size_t facets) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(3 * facets);
  for (std::size_t facet = 0; facet < facets; ++facet) {
    float numbers[12];
    std::memcpy(numbers, content.data() + kHeader + facet * kFacet, sizeof numbers);
    for (int corner = 1; corner <= 3; ++corner)
      corners.emplace_back(numbers[3 * corner], numbers[3 * corner + 1], numbers[3 * corner + 2]);
  }
  return corners;
}

std::vector<Eigen::Vector3d> read_text(const std::string& file, const std::string& content) {
  std::vector<Eigen::Vector3d> corners;
  std::istringstream lines(content);
  std::string text;
  bool ended = false;
  for (int line = 1; std::getline(lines, text); ++line) {
    std::istringstream words(text);
    words.imbue(std::locale::classic());
    std::string key;
    words >> key;
    if (key == "endsolid") ended = true;
    if (key != "vertex") continue;
    Eigen::Vector3d corner;
    if (!(words >> corner.x() >> corner.y() >> corner.z()))
      throw Error(file, line, "unreadable vertex", "vertex x y z");
    corners.push_back(corner);
  }
  if (!ended) throw Error(file, 0, "truncated", "a line 'endsolid'");
  return corners;
}

}  // namespace

std::vector<Eigen::Vector3d> stl_vertices(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path))
    throw Error(file, 0, "cannot be opened", "an STL file");
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};

  std::uint32_t facets = 0;
  if (content.size() >= kHeader) std::memcpy(&facets, content.data() + 80, sizeof facets);
  const bool binary = content.size() >= kHeader && content.size() == kHeader + kFacet * facets;
  if (!binary && !content.starts_with("solid"))
    throw Error(file, 0, "is truncated or not an STL file", "binary or text STL");
  std::vector<Eigen::Vector3d> corners =
      binary ? read_binary(content, facets) : read_text(file, content);
  for (const Eigen::Vector3d& corner : corners)
    if (!corner.allFinite()) throw Error(file, 0, "a vertex is not finite", "finite coordinates");

  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(corners.begin(), corners.end(), less);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

}  // namespace locograph
