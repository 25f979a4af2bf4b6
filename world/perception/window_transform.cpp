#include <locograph/world/perception/window_transform.h>

#include <algorithm>

namespace locograph {

WindowTransform::WindowTransform(const VoxelWindow& window, int cap, ObstacleRange obstacle,
                                 bool outside_is_obstacle, const WindowKernels& kernels)
    : cap_(cap), obstacle_(obstacle), outside_is_obstacle_(outside_is_obstacle), kernels_(kernels) {
  const auto [nx, ny, nz] = window.rings().size;
  const std::size_t rows = window.count() / kVoxelBlock, reach = static_cast<std::size_t>(cap) + 4,
                    wide = static_cast<std::size_t>(ny) + 2 * reach;
  const auto far = static_cast<std::int16_t>(cap * cap + 1);
  changed_columns_.assign(static_cast<std::size_t>(ny * window.blocks()), 1);
  changed_z_.assign(rows, 1);
  changed_y_.assign(rows, 1);
  reached_.assign(rows, 0);
  flags_.assign(2 * std::max(wide, static_cast<std::size_t>(window.blocks())), 0);
  along_z_.assign(window.count(), static_cast<std::uint8_t>(cap + 1));
  along_y_.assign(window.count(), far);
  squared_.assign(window.count(), far);
  column_.resize(static_cast<std::size_t>(nz) * kVoxelBlock);
  rows_.resize(wide * kVoxelBlock);
  line_.resize(static_cast<std::size_t>(nx) + 2 * (reach + kVoxelBlock));
}

void WindowTransform::change_everything() {
  std::ranges::fill(changed_columns_, std::uint8_t{1});
  std::ranges::fill(changed_z_, std::uint8_t{1});
  std::ranges::fill(changed_y_, std::uint8_t{1});
}

void WindowTransform::update(const VoxelWindow& window, std::span<const std::int8_t> log_odds) {
  const DistancePasses passes{.window = window.rings(),
                              .cap = cap_,
                              .outside_is_obstacle = outside_is_obstacle_,
                              .obstacle = obstacle_,
                              .log_odds = log_odds.data(),
                              .changed_columns = changed_columns_.data(),
                              .changed_z = changed_z_.data(),
                              .changed_y = changed_y_.data(),
                              .reached = reached_.data(),
                              .along_z = along_z_.data(),
                              .along_y = along_y_.data(),
                              .squared = squared_.data(),
                              .column = column_.data(),
                              .rows = rows_.data(),
                              .flags = flags_.data(),
                              .line = line_.data()};
  kernels_.along_z(passes);
  kernels_.along_y(passes);
  kernels_.along_x(passes);
}

std::size_t WindowTransform::memory_bytes() const {
  const auto bytes = [](const auto&... buffers) {
    return (... + (buffers.size() * sizeof(buffers[0])));
  };
  return bytes(changed_columns_, changed_z_, changed_y_, reached_, flags_, along_z_, column_,
               along_y_, squared_, rows_, line_);
}

}  // namespace locograph
