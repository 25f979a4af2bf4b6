#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/robots/stl_file.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <locale>
#include <sstream>

namespace locograph {
namespace {

// Binary STL: 80 bytes of header, the number of triangles, and per triangle normal and three
// vertices as 4-byte floats followed by two bytes.
constexpr std::size_t kHeader = 84, kTriangle = 50;
constexpr std::uintmax_t kMostStlBytes = std::uintmax_t{256} << 20;  // five million triangles

bool is_binary(const std::string& bytes) {
  if (bytes.size() < kHeader) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  return bytes.size() == kHeader + kTriangle * static_cast<std::size_t>(count);
}

std::vector<Eigen::Vector3d> read_binary(const std::string& bytes) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(3 * (bytes.size() - kHeader) / kTriangle);
  for (std::size_t at = kHeader; at < bytes.size(); at += kTriangle) {
    std::array<float, 9> vertices;
    std::memcpy(vertices.data(), bytes.data() + at + 12, sizeof(vertices));
    for (std::size_t v = 0; v < 9; v += 3) {
      corners.emplace_back(vertices[v], vertices[v + 1], vertices[v + 2]);
    }
  }
  return corners;
}

std::vector<Eigen::Vector3d> read_text(const std::string& file, const std::string& text) {
  std::vector<Eigen::Vector3d> corners;
  std::istringstream lines(text);
  std::string content;
  bool ended = false;
  for (int line = 1; std::getline(lines, content); ++line) {
    std::istringstream words(content);
    words.imbue(std::locale::classic());
    for (std::string word; words >> word;) {
      if (word == "solid") break;  // a name follows
      if (word == "endsolid") {
        ended = true;
        break;
      }
      if (word != "vertex") continue;
      Eigen::Vector3d corner;
      if (!(words >> corner.x() >> corner.y() >> corner.z())) {
        throw Error(file, line, "unreadable vertex", "vertex x y z");
      }
      corners.push_back(corner);
    }
  }
  if (!ended) throw Error(file, 0, "truncated", "a line 'endsolid'");
  return corners;
}

bool all_finite(const std::vector<Eigen::Vector3d>& corners) {
  for (const Eigen::Vector3d& corner : corners) {
    if (!corner.allFinite()) return false;
  }
  return true;
}

}  // namespace

std::vector<Eigen::Vector3d> stl_triangles(const std::filesystem::path& file) {
  const std::string bytes = read_file(file, kMostStlBytes, "an STL file");
  std::vector<Eigen::Vector3d> corners;
  if (is_binary(bytes)) {
    corners = read_binary(bytes);
  } else if (bytes.starts_with("solid")) {
    corners = read_text(file.string(), bytes);
  }
  if (corners.empty() || corners.size() % 3 != 0 || !all_finite(corners)) {
    throw Error(file.string(), 0, "no triangles of an STL mesh", "text or binary STL");
  }
  return corners;
}

}  // namespace locograph
