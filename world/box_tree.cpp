#include <locograph/world/box_tree.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace locograph {

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool ends = boxes[i].min().allFinite() && boxes[i].max().allFinite();
    (ends ? numbers : endless_).push_back(static_cast<int>(i));
  }
  if (numbers.empty()) return;
  nodes_.reserve(2 * numbers.size() - 1);
  build(boxes, numbers);
}

void BoxTree::build(const std::vector<Eigen::AlignedBox3d>& boxes, std::span<int> numbers) {
  const auto box = [&](int number) -> const Eigen::AlignedBox3d& {
    return boxes[static_cast<std::size_t>(number)];
  };
  const std::size_t node = nodes_.size();
  Eigen::AlignedBox3d bounds, centres;
  for (const int number : numbers) {
    bounds.extend(box(number));
    centres.extend(box(number).center());
  }
  nodes_.push_back({bounds, -1, *std::ranges::min_element(numbers)});
  if (numbers.size() == 1) return;
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::size_t half = numbers.size() / 2;
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(half),
                   numbers.end(),
                   [&](int a, int b) { return box(a).center()[axis] < box(b).center()[axis]; });
  build(boxes, numbers.first(half));
  nodes_[node].right = static_cast<int>(nodes_.size());
  build(boxes, numbers.subspan(half));
}

std::vector<int> BoxTree::touching(const Eigen::AlignedBox3d& box) const {
  std::vector<int> found;
  each_touching(box, [&found](int number) { found.push_back(number); });
  std::sort(found.begin(), found.end());
  return found;
}

Eigen::AlignedBox3d box_around(const Eigen::Vector3d& point, double reach_m) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m);
  return {point - reach, point + reach};
}

Eigen::AlignedBox3d bounds_of(const Surface& surface) {
  if (std::isinf(surface.half_x_m) || std::isinf(surface.half_y_m)) {
    return box_around(Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity());
  }
  const Eigen::Matrix3d axes = surface.world_from_surface.linear().cwiseAbs();
  const Eigen::Vector3d half = surface.half_x_m * axes.col(0) + surface.half_y_m * axes.col(1);
  const Eigen::Vector3d centre = surface.world_from_surface.translation();
  return {centre - half, centre + half};
}

std::vector<Eigen::AlignedBox3d> bounds_of(std::span<const Surface> surfaces) {
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const Surface& surface : surfaces) bounds.push_back(bounds_of(surface));
  return bounds;
}

Eigen::AlignedBox3d bounds_of(const SolidBox& box) {
  const Eigen::Vector3d reach = 0.5 * (box.world_from_box.linear().cwiseAbs() * box.size_m);
  const Eigen::Vector3d middle = box.world_from_box.translation();
  return {middle - reach, middle + reach};
}

std::vector<int> solids_of_surfaces(const World& world) {
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const SolidBox& box : world.solids) bounds.push_back(bounds_of(box));
  const BoxTree tree(bounds);
  constexpr double kRounding_m = 1e-6;
  std::vector<int> solids;
  for (const Surface& surface : world.surfaces) {
    solids.push_back(tree.first_touching(
        box_around(surface.world_from_surface.translation(), kRounding_m), [&](int number) {
          return is_part_of(world.solids[static_cast<std::size_t>(number)], surface);
        }));
  }
  return solids;
}

}  // namespace locograph
