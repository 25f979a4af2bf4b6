#include <locograph/common/error.h>
#include <locograph/common/stably_sorted.h>
#include <locograph/world/leftover_map.h>
#include <locograph/world/octree.h>
#include <locograph/world/rectangles.h>
#include <locograph/world/surfaces_of.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace locograph {
namespace {

double extent(const Surface& surface) { return surface.half_x_m * surface.half_y_m; }

using Keys = std::array<int, 3>;

/// Null for what is unknown, or off the map.
const octomap::OcTreeNode* node_at(const octomap::OcTree& tree, const Keys& keys) {
  for (const int key : keys) {
    if (key < 0 || key > 0xffff) return nullptr;
  }
  return tree.search(octomap::OcTreeKey(static_cast<octomap::key_type>(keys[0]),
                                        static_cast<octomap::key_type>(keys[1]),
                                        static_cast<octomap::key_type>(keys[2])));
}

/// Faces of voxels in one plane, towards one side: cells along the next two axes.
struct Layer {
  std::size_t axis = 0;
  int side = 1;
  int key = 0;  ///< of the occupied voxels along the axis
  auto operator<=>(const Layer&) const = default;
};

std::map<Layer, std::vector<Cell>> outer_faces(const octomap::OcTree& tree) {
  bool knows_free = false;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end && !knows_free; ++leaf) {
    knows_free = !tree.isNodeOccupied(*leaf);
  }
  std::map<Layer, std::vector<Cell>> layers;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int size = 1 << (tree.getTreeDepth() - leaf.getDepth());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
      for (const int side : {-1, 1}) {
        Keys keys{};
        const int key = first[static_cast<unsigned>(axis)] + (side > 0 ? size - 1 : 0);
        keys[axis] = key + side;
        std::vector<Cell>* cells = nullptr;
        for (int i = 0; i < size; ++i)
          for (int j = 0; j < size; ++j) {
            keys[next] = first[static_cast<unsigned>(next)] + i;
            keys[last] = first[static_cast<unsigned>(last)] + j;
            const octomap::OcTreeNode* node = node_at(tree, keys);
            if (node != nullptr ? tree.isNodeOccupied(node) : knows_free) continue;
            if (cells == nullptr) cells = &layers[{axis, side, key}];
            cells->push_back({keys[next], keys[last]});
          }
      }
    }
  }
  return layers;
}

Surface on_layer(const Layer& layer, const CellRectangle& cells, double voxel_m) {
  constexpr double kMiddle = 32768.0;
  const auto axis = [](std::size_t index) {
    return Eigen::Vector3d(Eigen::Vector3d::Unit(static_cast<Eigen::Index>(index % 3)));
  };
  Surface surface;
  const Eigen::Vector3d normal = layer.side * axis(layer.axis);
  surface.world_from_surface.linear() << axis(layer.axis + 1), normal.cross(axis(layer.axis + 1)),
      normal;
  surface.world_from_surface.translation() =
      voxel_m * ((layer.key + (layer.side > 0 ? 1 : 0) - kMiddle) * axis(layer.axis) +
                 (0.5 * (cells.from.x + cells.to.x + 1) - kMiddle) * axis(layer.axis + 1) +
                 (0.5 * (cells.from.y + cells.to.y + 1) - kMiddle) * axis(layer.axis + 2));
  surface.half_x_m = 0.5 * voxel_m * (cells.to.x - cells.from.x + 1);
  surface.half_y_m = 0.5 * voxel_m * (cells.to.y - cells.from.y + 1);
  return surface;
}

}  // namespace

void append_surfaces(World& world, const std::string& name, double friction,
                     std::vector<Surface> surfaces) {
  int number = 0;
  for (Surface& surface : stably_sorted(
           std::move(surfaces), [](const auto&a, const auto&b) { return extent(a) > extent(b); })) {
    surface.name = name + " " + std::to_string(++number);
    surface.friction = friction;
    world.surfaces.push_back(std::move(surface));
  }
}

void add_cloud(World& world, const std::string& name, std::span<const Eigen::Vector3d> points,
               double friction, const PatchOptions& options, const BarOptions& bar_options) {
  std::vector<char> flat(points.size(), 0);
  std::vector<Plate> plates;
  std::vector<Surface> surfaces;
  for (const PlanarRegion& region : planar_regions(points, options)) {
    for (const std::uint32_t p : region.points) flat[p] = 1;
    for (const Surface& surface : region.surfaces) {
      plates.emplace_back(surface, region.tolerance_m);
      surfaces.push_back(surface);
    }
  }
  std::vector<Eigen::Vector3d> others;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (flat[p] == 0) others.push_back(points[p]);
  }
  std::vector<Bar> bars = bars_in(others, bar_options);
  world.map = with_leftovers(world.map, points, plates, bars, 2.0 * bar_options.distance_m,
                             options.voxel_m);
  append_surfaces(world, name, friction, std::move(surfaces));
  int number = 0;
  for (Bar& bar : bars) {
    bar.name = name + " bar " + std::to_string(++number);
    bar.friction = friction;
    world.bars.push_back(std::move(bar));
  }
}

void add_octomap(World& world, const std::string& name,
                 const std::shared_ptr<const octomap::OcTree>& tree, double friction,
                 const PatchOptions& options) {
  if (tree == nullptr) throw Error("no octree '" + name + "'", "one");
  std::shared_ptr<const octomap::OcTree> map = tree;
  if (world.map != nullptr) map = joined(*world.map, *tree);
  const double voxel_m = tree->getResolution();
  std::vector<Surface> surfaces;
  for (auto& [layer, cells] : outer_faces(*tree)) {
    const CellSizes sizes{voxel_m, voxel_m, options.least_length_m, options.least_width_m};
    for (const CellRectangle& rectangle : cell_rectangles(std::move(cells), sizes)) {
      surfaces.push_back(on_layer(layer, rectangle, voxel_m));
    }
  }
  world.map = std::move(map);
  append_surfaces(world, name, friction, std::move(surfaces));
}

}  // namespace locograph
