#pragma once
/// Visits all voxels of a window.
///
///     each_voxel(map.window(), [&](const Eigen::Vector3i& index) { ++count; });

#include <locograph/world/perception/voxel_window.h>

namespace locograph::test {

template <class Visit>
void each_voxel(const VoxelWindow& window, Visit visit) {
  for (int z = 0; z < window.size[2]; ++z)
    for (int y = 0; y < window.size[1]; ++y)
      for (int x = 0; x < window.size[0]; ++x)
        visit(Eigen::Vector3i(window.first + Eigen::Vector3i(x, y, z)));
}

}  // namespace locograph::test
