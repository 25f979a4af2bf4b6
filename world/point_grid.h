#pragma once
/// Points sorted into the voxels of a sparse grid, with the moments of each voxel's points.
///
///     const PointGrid grid(points, 0.05);
///     Moments around;
///     grid.around(v, 1, [&](int other) { around.add(grid.moments(other)); });
///     const Principal axes = principal(around);  // axes.directions.col(0): the normal
///
/// Voxels are numbered in the order of their first points. Lengths in metres. Const members are
/// thread-safe. Throws Error for a voxel outside ranges.h, for coordinates that are not finite or
/// outside it, and for points spread over more than two million voxels along one axis.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace locograph {

/// Mean and covariance of what was added.
struct Moments {
  double weight = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< sum of squares about the mean

  void add(const Eigen::Vector3d& point);
  /// The other's distribution, with weight 1.
  void add(const Moments& other);
};

/// Standard deviations, ascending, and the directions in which they are.
struct Principal {
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
};
Principal principal(const Moments& moments);

class PointGrid {
 public:
  /// Keeps no reference to the points.
  PointGrid(std::span<const Eigen::Vector3d> points, double voxel_m);

  int size() const { return static_cast<int>(cells_.size()); }
  const Moments& moments(int voxel) const { return moments_[static_cast<std::size_t>(voxel)]; }
  /// Indices of the points in a voxel.
  std::span<const std::uint32_t> points_of(int voxel) const {
    const std::size_t v = static_cast<std::size_t>(voxel);
    return std::span(points_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

  /// Calls visit(voxel) for those no further than `reach` voxels along each axis, itself included.
  template <typename Visit>
  void around(int voxel, int reach, const Visit& visit) const {
    const std::array<int, 3> cell = cells_[static_cast<std::size_t>(voxel)];
    for (int x = cell[0] - reach; x <= cell[0] + reach; ++x)
      for (int y = cell[1] - reach; y <= cell[1] + reach; ++y)
        for (int z = cell[2] - reach; z <= cell[2] + reach; ++z)
          if (const int other = find({x, y, z}); other >= 0) visit(other);
  }

 private:
  int find(const std::array<int, 3>& cell) const;

  std::vector<std::array<int, 3>> cells_;
  std::vector<Moments> moments_;
  std::vector<std::uint32_t> points_, begin_;
  std::vector<int> slots_;  ///< open addressing by the cell; -1: free
};

}  // namespace locograph
