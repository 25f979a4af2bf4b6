#include <locograph/common/error.h>
#include <locograph/robots/stl_file.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

namespace locograph {
namespace {

// Binary STL: 80 bytes of header, the number of triangles, and per triangle normal and three
// vertices as 4-byte floats followed by two bytes.
constexpr std::size_t kHeader = 84, kTriangle = 50;

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

std::vector<Eigen::Vector3d> read_text(const std::string& bytes) {
  std::vector<Eigen::Vector3d> corners;
  std::istringstream words(bytes);
  std::string word;
  while (words >> word) {
    Eigen::Vector3d corner;
    if (word == "vertex" && words >> corner.x() >> corner.y() >> corner.z()) {
      corners.push_back(corner);
    }
  }
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
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file)) {
    throw Error(file.string(), 0, "cannot be read", "a readable STL file");
  }
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  const std::string bytes = buffer.str();
  std::vector<Eigen::Vector3d> corners;
  if (is_binary(bytes)) {
    corners = read_binary(bytes);
  } else if (bytes.starts_with("solid")) {
    corners = read_text(bytes);
  }
  if (corners.empty() || corners.size() % 3 != 0 || !all_finite(corners)) {
    throw Error(file.string(), 0, "no triangles of an STL mesh", "text or binary STL");
  }
  return corners;
}

}  // namespace locograph
