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

/// The node of a cube of so many voxels along a side, or the leaf around it. Null for what is
/// unknown, or off the map.
const octomap::OcTreeNode* node_at(const octomap::OcTree& tree, const Keys& keys, int size) {
  for (const int key : keys) {
    if (key < 0 || key > 0xffff) return nullptr;
  }
  unsigned depth = tree.getTreeDepth();
  for (; size > 1; size /= 2) --depth;
  return tree.search(octomap::OcTreeKey(static_cast<octomap::key_type>(keys[0]),
                                        static_cast<octomap::key_type>(keys[1]),
                                        static_cast<octomap::key_type>(keys[2])),
                     depth);
}

/// Faces of voxels in one plane, towards one side: cells along the next two axes.
struct Layer {
  std::size_t axis = 0;
  int side = 1;
  int key = 0;  ///< of the occupied voxels along the axis
  auto operator<=>(const Layer&) const = default;
};

/// A square of cells, from the lowest on.
struct CellSquare {
  Cell from;
  int size = 1;
};
using Layers = std::map<Layer, std::vector<CellSquare>>;

bool knows_free(const octomap::OcTree& tree) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) return true;
  }
  return false;
}

/// The faces of leaves that nothing occupied is in front of, in squares as large as the leaves
/// there: as many as the tree has nodes, at most some hundred for each.
class OuterFaces {
 public:
  explicit OuterFaces(const octomap::OcTree& tree) : tree_(tree), free_only_(knows_free(tree)) {}

  Layers layers() {
    for (auto leaf = tree_.begin_leafs(), end = tree_.end_leafs(); leaf != end; ++leaf) {
      if (!tree_.isNodeOccupied(*leaf)) continue;
      const octomap::OcTreeKey first = leaf.getIndexKey();
      const int size = 1 << (tree_.getTreeDepth() - leaf.getDepth());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
          const Keys keys{first[0], first[1], first[2]};
          const Layer layer{axis, side, keys[axis] + (side > 0 ? size - 1 : 0)};
          const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
          add(layer, {{keys[next], keys[last]}, size});
        }
      }
    }
    return std::move(layers_);
  }

 private:
  /// What of a square of a layer is not hidden.
  void add(const Layer& layer, const CellSquare& square) {
    Keys keys{};
    keys[layer.axis] = layer.key + layer.side;
    keys[(layer.axis + 1) % 3] = square.from.x;
    keys[(layer.axis + 2) % 3] = square.from.y;
    const octomap::OcTreeNode* node = node_at(tree_, keys, square.size);
    if (node != nullptr && tree_.nodeHasChildren(node)) {
      const int half = square.size / 2;
      for (const int x : {0, half})
        for (const int y : {0, half}) {
          add(layer, {{square.from.x + x, square.from.y + y}, half});
        }
      return;
    }
    if (node != nullptr ? tree_.isNodeOccupied(node) : free_only_) return;
    layers_[layer].push_back(square);
  }

  const octomap::OcTree& tree_;
  bool free_only_;  ///< towards what is known to be free
  Layers layers_;
};

/// Rectangles of a layer, in voxels. Cells are as large as its smallest square, at whose multiples
/// all squares are.
std::vector<CellRectangle> rectangles_of(const std::vector<CellSquare>& squares, double voxel_m,
                                         const PatchOptions& options) {
  int unit = squares.front().size;
  for (const CellSquare& square : squares) unit = std::min(unit, square.size);
  std::vector<Cell> cells;
  for (const CellSquare& square : squares) {
    for (int x = 0; x < square.size / unit; ++x)
      for (int y = 0; y < square.size / unit; ++y) {
        cells.push_back({square.from.x / unit + x, square.from.y / unit + y});
      }
  }
  const double size_m = unit * voxel_m;
  std::vector<CellRectangle> rectangles = cell_rectangles(
      std::move(cells), {size_m, size_m, options.least_length_m, options.least_width_m},
      options.deadline);
  for (CellRectangle& r : rectangles) {
    r.from = {r.from.x * unit, r.from.y * unit};
    r.to = {(r.to.x + 1) * unit - 1, (r.to.y + 1) * unit - 1};
  }
  return rectangles;
}

/// Throws Error where rectangles_of() would take very many cells.
void require_few_cells(const Layers& layers) {
  constexpr double kMostCells = 1e7;
  double cells = 0.0;
  for (const auto& [layer, squares] : layers) {
    double area = 0.0;
    int unit = squares.front().size;
    for (const CellSquare& square : squares) {
      area += static_cast<double>(square.size) * square.size;
      unit = std::min(unit, square.size);
    }
    cells += area / (static_cast<double>(unit) * unit);
  }
  if (cells <= kMostCells) return;
  throw Error("the occupied voxels have " + std::to_string(static_cast<long>(cells)) + " faces",
              "at most ten million; larger voxels, or a part of the map");
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
                             options.voxel_m, options.deadline);
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
  const Layers layers = OuterFaces(*tree).layers();
  require_few_cells(layers);
  for (const auto& [layer, squares] : layers) {
    for (const CellRectangle& rectangle : rectangles_of(squares, voxel_m, options)) {
      surfaces.push_back(on_layer(layer, rectangle, voxel_m));
    }
  }
  world.map = std::move(map);
  append_surfaces(world, name, friction, std::move(surfaces));
}

}  // namespace locograph
