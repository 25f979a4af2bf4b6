#include <locograph/apps/decimation.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <unordered_map>

namespace locograph {
namespace {

constexpr int kFinest = 1024, kCoarsest = 4;  // cells along the longest side
constexpr double kFiner = 0.8;

using Triangles = std::vector<Eigen::Vector3d>;

Triangles clustered(const Triangles& corners, const Eigen::AlignedBox3d& bounds, double cell) {
  std::unordered_map<std::uint64_t, int> cells;
  Triangles sums;
  std::vector<int> counts, ids;
  for (const Eigen::Vector3d& corner : corners) {
    std::uint64_t at = 0;
    for (int i = 0; i < 3; ++i) {
      at = (at << 16) | static_cast<std::uint64_t>((corner[i] - bounds.min()[i]) / cell);
    }
    const auto [found, added] = cells.emplace(at, static_cast<int>(sums.size()));
    if (added) {
      sums.push_back(Eigen::Vector3d::Zero());
      counts.push_back(0);
    }
    const auto id = static_cast<std::size_t>(found->second);
    sums[id] += corner;
    ++counts[id];
    ids.push_back(found->second);
  }
  Triangles result;
  std::set<std::array<int, 3>> seen;
  for (std::size_t t = 0; t + 2 < ids.size(); t += 3) {
    std::array<int, 3> triangle = {ids[t], ids[t + 1], ids[t + 2]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    // Rotated so that equal ones are equal, whose sides are told apart.
    while (triangle[0] > triangle[1] || triangle[0] > triangle[2]) {
      triangle = {triangle[1], triangle[2], triangle[0]};
    }
    if (!seen.insert(triangle).second) continue;
    for (const int id : triangle) {
      const auto at = static_cast<std::size_t>(id);
      result.push_back(sums[at] / counts[at]);
    }
  }
  return result;
}

}  // namespace

std::vector<Eigen::Vector3d> decimated(const std::vector<Eigen::Vector3d>& corners,
                                       std::size_t most_triangles) {
  if (corners.size() <= 3 * most_triangles) return corners;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& corner : corners) bounds.extend(corner);
  const double size = bounds.sizes().maxCoeff();
  Triangles result;
  for (double cells = kFinest; cells >= kCoarsest; cells *= kFiner) {
    result = clustered(corners, bounds, size / cells);
    if (result.size() <= 3 * most_triangles) break;
  }
  return result;
}

}  // namespace locograph
