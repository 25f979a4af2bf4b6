#include <locograph/common/error.h>
#include <locograph/common/ranges.h>
#include <locograph/world/point_grid.h>

#include <Eigen/Eigenvalues>
#include <bit>
#include <cmath>

namespace locograph {
namespace {

std::size_t slot_of(const std::array<int, 3>& cell, std::size_t slots) {
  std::uint64_t hash = 0;
  for (const int index : cell) {
    hash = (hash ^ static_cast<std::uint32_t>(index)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash) & (slots - 1);
}

}  // namespace

void Moments::add(const Eigen::Vector3d& point) {
  weight += 1.0;
  const Eigen::Vector3d before = point - mean;
  mean += before / weight;
  scatter += before * (point - mean).transpose();
}

void Moments::add(const Moments& other) {
  const Eigen::Vector3d apart = other.mean - mean;
  scatter += other.scatter / other.weight + weight / (weight + 1.0) * apart * apart.transpose();
  weight += 1.0;
  mean += apart / weight;
}

Principal principal(const Moments& moments) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.scatter / moments.weight);
  return {solver.eigenvalues().cwiseMax(0.0), solver.eigenvectors()};
}

PointGrid::PointGrid(std::span<const Eigen::Vector3d> points, double voxel_m) {
  if (!(voxel_m >= ranges::kLeastVoxel_m) || !(voxel_m <= ranges::kMostVoxel_m)) {
    throw Error("a voxel of " + std::to_string(voxel_m) + " m", "0.0001 to 100");
  }
  if (points.size() > 1u << 30) throw Error("more points than a grid takes", "a billion");
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = lower;
  if (!points.empty()) lower = upper = points[0];
  for (const Eigen::Vector3d& point : points) {
    if (!(point.cwiseAbs().maxCoeff() <= ranges::kCoordinate_m) || !point.allFinite()) {
      throw Error("a point is further away than " + std::to_string(ranges::kCoordinate_m) + " m",
                  "coordinates near the robot");
    }
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  if ((upper - lower).maxCoeff() / voxel_m > 2e6) {
    throw Error("a cloud spread over more than two million voxels", "larger voxels");
  }
  // Borders of voxels at multiples of their size, so that a cloud in parts has the same ones.
  const auto cell_of = [&](const Eigen::Vector3d& point) {
    std::array<int, 3> cell{};
    for (int axis = 0; axis < 3; ++axis) {
      cell[static_cast<std::size_t>(axis)] =
          static_cast<int>(std::floor(point[axis] / voxel_m) - std::floor(lower[axis] / voxel_m));
    }
    return cell;
  };

  slots_.assign(std::bit_ceil(2 * points.size() + 2), -1);
  std::vector<std::uint32_t> voxel_of(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::array<int, 3> cell = cell_of(points[p]);
    std::size_t slot = slot_of(cell, slots_.size());
    while (slots_[slot] >= 0 && cells_[static_cast<std::size_t>(slots_[slot])] != cell) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    if (slots_[slot] < 0) {
      slots_[slot] = size();
      cells_.push_back(cell);
      moments_.emplace_back();
    }
    voxel_of[p] = static_cast<std::uint32_t>(slots_[slot]);
    moments_[voxel_of[p]].add(points[p]);
  }
  // The table was as large as if every point had a voxel of its own.
  slots_.assign(std::bit_ceil(2 * cells_.size() + 2), -1);
  for (int voxel = 0; voxel < size(); ++voxel) {
    std::size_t slot = slot_of(cells_[static_cast<std::size_t>(voxel)], slots_.size());
    while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = voxel;
  }

  begin_.assign(cells_.size() + 1, 0);
  for (const std::uint32_t voxel : voxel_of) ++begin_[voxel + 1];
  for (std::size_t v = 0; v < cells_.size(); ++v) begin_[v + 1] += begin_[v];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  points_.resize(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    points_[next[voxel_of[p]]++] = static_cast<std::uint32_t>(p);
  }
}

int PointGrid::find(const std::array<int, 3>& cell) const {
  std::size_t slot = slot_of(cell, slots_.size());
  while (slots_[slot] >= 0 && cells_[static_cast<std::size_t>(slots_[slot])] != cell) {
    slot = (slot + 1) & (slots_.size() - 1);
  }
  return slots_[slot];
}

}  // namespace locograph
