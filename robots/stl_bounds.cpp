#include <locograph/common/error.h>
#include <locograph/robots/collision_model.h>

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

void extend_binary(const std::string& bytes, Eigen::AlignedBox3d& bounds) {
  for (std::size_t at = kHeader; at < bytes.size(); at += kTriangle) {
    std::array<float, 9> vertices;
    std::memcpy(vertices.data(), bytes.data() + at + 12, sizeof(vertices));
    for (std::size_t v = 0; v < 9; v += 3) {
      bounds.extend(Eigen::Vector3d(vertices[v], vertices[v + 1], vertices[v + 2]));
    }
  }
}

void extend_text(const std::string& bytes, Eigen::AlignedBox3d& bounds) {
  std::istringstream words(bytes);
  std::string word;
  while (words >> word) {
    Eigen::Vector3d vertex;
    if (word == "vertex" && words >> vertex.x() >> vertex.y() >> vertex.z()) bounds.extend(vertex);
  }
}

}  // namespace

Eigen::AlignedBox3d stl_bounds(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file)) {
    throw Error(file.string(), 0, "cannot be read", "a readable STL file");
  }
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  const std::string bytes = buffer.str();
  Eigen::AlignedBox3d bounds;
  if (is_binary(bytes)) {
    extend_binary(bytes, bounds);
  } else if (bytes.starts_with("solid")) {
    extend_text(bytes, bounds);
  }
  if (bounds.isEmpty() || !bounds.sizes().allFinite()) {
    throw Error(file.string(), 0, "no triangles of an STL mesh", "text or binary STL");
  }
  return bounds;
}

}  // namespace locograph
