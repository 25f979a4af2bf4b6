#include <locograph/common/error.h>
#include <locograph/world/box_tree.h>
#include <locograph/world/leftover_map.h>
#include <locograph/world/octree.h>
#include <locograph/world/point_grid.h>

#include <algorithm>
#include <tuple>

namespace locograph {
namespace {

/// Of the block in which points look for plates.
constexpr double kBlock_m = 0.5;
/// A plate's edge covers what is on it, whatever the rounding.
constexpr double kBorder_m = 1e-4;

bool near_bar(const Eigen::Vector3d& point, const Bar& bar, double tolerance_m) {
  const Eigen::Vector3d along = bar.to - bar.from;
  const double at = std::clamp((point - bar.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - bar.from - at * along).norm() <= bar.radius_m + tolerance_m;
}

/// Whether the plate covers the point. Moves it behind the plate if its voxel would stand out.
bool covered_or_moved(const Plate& plate, double voxel_m, Eigen::Vector3d& point) {
  const Eigen::Vector3d at = plate.surface_from_world * point;
  if (at.z() > plate.tolerance_m) return false;
  const Eigen::Vector3d normal = plate.surface_from_world.linear().row(2).transpose();
  const double thickness = voxel_m * normal.lpNorm<1>();  // of a voxel along the normal
  if (at.z() < -thickness) return false;
  const double out_x = std::abs(at.x()) - plate.half_x_m, out_y = std::abs(at.y()) - plate.half_y_m;
  if (out_x <= kBorder_m && out_y <= kBorder_m && at.z() >= -plate.tolerance_m) return true;
  if (out_x > 2.0 * voxel_m || out_y > 2.0 * voxel_m) return false;
  point -= (at.z() + 1.001 * thickness) * normal;
  return false;
}

/// Half of what a plate may have to do with, in its frame: a point moved for one plate may have
/// come to the next.
Eigen::Vector3d half_reach(const Plate& plate, double voxel_m) {
  return Eigen::Vector3d(plate.half_x_m, plate.half_y_m, 0.0) +
         Eigen::Vector3d::Constant(4.0 * voxel_m + plate.tolerance_m);
}

BoxTree tree_of(std::span<const Plate> plates, double voxel_m) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Plate& plate : plates) {
    const Eigen::Isometry3d world_from_surface = plate.surface_from_world.inverse();
    const Eigen::Vector3d centre = world_from_surface.translation();
    const Eigen::Vector3d half =
        world_from_surface.linear().cwiseAbs() * half_reach(plate, voxel_m);
    boxes.emplace_back(centre - half, centre + half);
  }
  return BoxTree(boxes);
}

/// Plates that may have to do with points of a block.
std::vector<int> plates_near(const Eigen::AlignedBox3d& block, std::span<const Plate> plates,
                             const BoxTree& tree, double voxel_m) {
  std::vector<int> near = tree.touching(block);
  const Eigen::Vector3d half = 0.5 * block.sizes();
  std::erase_if(near, [&](int p) {
    const Plate& plate = plates[static_cast<std::size_t>(p)];
    const Eigen::Vector3d centre = plate.surface_from_world * block.center();
    const Eigen::Vector3d reach =
        plate.surface_from_world.linear().cwiseAbs() * half + half_reach(plate, voxel_m);
    return !(centre.cwiseAbs().array() <= reach.array()).all();
  });
  return near;
}

}  // namespace

std::shared_ptr<const octomap::OcTree> with_leftovers(
    const std::shared_ptr<const octomap::OcTree>& map, std::span<const Eigen::Vector3d> points,
    std::span<const Plate> plates, std::span<const Bar> bars, double bar_tolerance_m,
    double voxel_m, const Deadline& deadline) {
  const auto tree = std::make_shared<octomap::OcTree>(voxel_m);
  const auto before = [](const octomap::OcTreeKey& a, const octomap::OcTreeKey& b) {
    return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
  };
  std::vector<octomap::OcTreeKey> keys;
  const PointGrid blocks(points, std::max(kBlock_m, 4.0 * voxel_m));
  const BoxTree plate_tree = tree_of(plates, voxel_m);
  for (int block = 0; block < blocks.size(); ++block) {
    deadline.require();
    Eigen::AlignedBox3d bounds;
    for (const std::uint32_t p : blocks.points_of(block)) bounds.extend(points[p]);
    const std::vector<int> near = plates_near(bounds, plates, plate_tree, voxel_m);
    for (const std::uint32_t p : blocks.points_of(block)) {
      Eigen::Vector3d point = points[p];
      const bool covered =
          std::any_of(near.begin(), near.end(),
                      [&](int plate) {
                        return covered_or_moved(plates[static_cast<std::size_t>(plate)], voxel_m,
                                                point);
                      }) ||
          std::any_of(bars.begin(), bars.end(),
                      [&](const Bar& bar) { return near_bar(points[p], bar, bar_tolerance_m); });
      if (covered) continue;
      octomap::OcTreeKey key;
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (!tree->coordToKeyChecked(point[static_cast<int>(axis)], key[axis])) {
          throw Error(
              "a point is too far away for a map with voxels of " + std::to_string(voxel_m) + " m",
              "coordinates within " + std::to_string(32768.0 * voxel_m) + " m");
        }
      }
      keys.push_back(key);
    }
  }
  if (keys.empty()) return map;
  std::sort(keys.begin(), keys.end(), before);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (const octomap::OcTreeKey& key : keys) {
    tree->setNodeValue(key, tree->getClampingThresMaxLog(), true);
  }
  tree->updateInnerOccupancy();
  tree->prune();
  if (map == nullptr) return tree;
  return joined(*map, *tree);
}

}  // namespace locograph
