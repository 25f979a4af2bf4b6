#pragma once
/// A box of voxels that moves through the world, stored as a ring along each axis: a move touches
/// only what enters.
///
///     VoxelWindow window{.resolution_m = 0.05, .size = {160, 160, 60}};
///     window.place({-80, -80, -8});
///     const std::size_t at = window.stored(window.index_at({0.5, 0.0, 0.3}));
///
/// Voxel (i, j, k) of the world spans [i, i + 1] h along x, ..., as OctoMap's do. x is contiguous
/// in memory, then y, then z.

#include <locograph/world/perception/window_kernels.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

namespace locograph {

struct VoxelWindow {
  double resolution_m = 0.0;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();   ///< voxels; along x whole blocks
  Eigen::Vector3i first = Eigen::Vector3i::Zero();  ///< world index of the lowest voxel
  Eigen::Vector3i ring = Eigen::Vector3i::Zero();   ///< where that one is stored, on each axis

  std::size_t count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
  int blocks() const { return size[0] / kVoxelBlock; }
  RingWindow rings() const { return {{size[0], size[1], size[2]}, {ring[0], ring[1], ring[2]}}; }

  /// World indices of the voxel at a point, which is finite and not too far away for int.
  Eigen::Vector3i index_at(const Eigen::Vector3d& point) const {
    return (point / resolution_m).array().floor().cast<int>();
  }
  bool contains(const Eigen::Vector3i& index) const {
    return ((index - first).array() >= 0).all() && ((index - first).array() < size.array()).all();
  }
  std::size_t stored(const Eigen::Vector3i& index) const {
    Eigen::Vector3i at = index - first + ring;
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] >= size[axis]) at[axis] -= size[axis];
    }
    return (static_cast<std::size_t>(at[2]) * size[1] + at[1]) * size[0] + at[0];
  }
  Eigen::AlignedBox3d bounds() const {
    return {first.cast<double>() * resolution_m, (first + size).cast<double>() * resolution_m};
  }

  /// Calls visit with the world indices of its voxels that a box meets.
  template <class Visit>
  void each_in(const Eigen::AlignedBox3d& box, Visit&& visit) const {
    const Eigen::AlignedBox3d within = box.intersection(bounds());
    if (within.isEmpty()) return;
    const Eigen::Vector3i last = first + size - Eigen::Vector3i::Ones(),
                          from = index_at(within.min()).cwiseMax(first),
                          to = index_at(within.max()).cwiseMin(last);
    for (int k = from.z(); k <= to.z(); ++k) {
      for (int j = from.y(); j <= to.y(); ++j) {
        for (int i = from.x(); i <= to.x(); ++i) visit(Eigen::Vector3i(i, j, k));
      }
    }
  }

  /// So that its lowest voxel is the one with this world index.
  void place(const Eigen::Vector3i& lowest) {
    first = lowest;
    for (int axis = 0; axis < 3; ++axis) {
      const int rest = lowest[axis] % size[axis];
      ring[axis] = rest < 0 ? rest + size[axis] : rest;
    }
  }
};

}  // namespace locograph
