#include <dynamicEDT3D/dynamicEDT3D.h>
#include <locograph/common/error.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/node_distances.h>
#include <locograph/world/point_kernels.h>
#include <locograph/world/require_metres.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace locograph {
namespace {

constexpr int kKeyOffset = 1 << 15;  // OctoMap: key = index + 2^15
constexpr double kMaxVoxels = 1e8;

using Index3 = std::array<int, 3>;

// Voxel (i, j, k) of the world lattice spans [i, i + 1] h along x, ...
struct Block {
  Index3 first{}, size{};

  int last(int axis) const { return first[axis] + size[axis] - 1; }
  std::size_t count() const { return static_cast<std::size_t>(size[0]) * size[1] * size[2]; }
  std::size_t index(int x, int y, int z) const {  // relative to first
    return (static_cast<std::size_t>(x) * size[1] + y) * size[2] + z;
  }
};

struct Occupancy {
  Block block;
  std::vector<std::uint8_t> occupied;
  bool any = false;

  bool at(int x, int y, int z) const { return occupied[block.index(x, y, z)] != 0; }

  // Is a voxel of the other state among the 26 neighbours inside the block?
  bool on_border(int x, int y, int z) const {
    const bool state = at(x, y, z);
    for (int i = std::max(0, x - 1); i <= std::min(block.size[0] - 1, x + 1); ++i)
      for (int j = std::max(0, y - 1); j <= std::min(block.size[1] - 1, y + 1); ++j)
        for (int k = std::max(0, z - 1); k <= std::min(block.size[2] - 1, z + 1); ++k)
          if (at(i, j, k) != state) return true;
    return false;
  }
};

// Distances to the voxels of one state. Only those on the border are sources: the nearest one
// always is, and the wave need not run through the others.
class Transform : public DynamicEDT3D {
 public:
  Transform(const Occupancy& map, bool source_state, int max_squared) : DynamicEDT3D(max_squared) {
    const Index3& n = map.block.size;
    initializeEmpty(n[0], n[1], n[2]);
    for (int x = 0; x < n[0]; ++x)
      for (int y = 0; y < n[1]; ++y)
        for (int z = 0; z < n[2]; ++z) {
          if (map.at(x, y, z) != source_state) continue;
          if (map.on_border(x, y, z)) {
            occupyCell(x, y, z);
          } else {
            data[x][y][z].sqdist = 0;
            data[x][y][z].queueing = fwProcessed;
          }
        }
    update(false);
  }
};

struct Leaf {
  Index3 first, last;
  bool occupied;
};

Leaf leaf_voxels(const octomap::OcTree& tree, const octomap::OcTree::leaf_bbx_iterator& leaf) {
  const int extent = 1 << (tree.getTreeDepth() - leaf.getDepth());
  Leaf out;
  out.occupied = tree.isNodeOccupied(*leaf);
  for (unsigned axis = 0; axis < 3; ++axis) {
    out.first[axis] = (static_cast<int>(leaf.getKey()[axis]) & ~(extent - 1)) - kKeyOffset;
    out.last[axis] = out.first[axis] + extent - 1;
  }
  return out;
}

template <class Visit>
void for_each_leaf(const octomap::OcTree& tree, const Block& block, Visit visit) {
  octomap::OcTreeKey first, last;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    if (block.last(a) < -kKeyOffset || block.first[a] >= kKeyOffset) return;
    first[axis] = octomap::key_type(std::max(block.first[a], -kKeyOffset) + kKeyOffset);
    last[axis] = octomap::key_type(std::min(block.last(a), kKeyOffset - 1) + kKeyOffset);
  }
  for (octomap::OcTree::leaf_bbx_iterator leaf = tree.begin_leafs_bbx(first, last);
       leaf != tree.end_leafs_bbx(); ++leaf)
    visit(leaf_voxels(tree, leaf));
}

Occupancy rasterise(const octomap::OcTree& tree, const Block& block, bool unknown_is_occupied,
                    int first_layer_above_ground) {
  Occupancy map;
  map.block = block;
  map.occupied.assign(block.count(), unknown_is_occupied ? 1 : 0);
  const auto fill = [&](Index3 first, Index3 last, bool occupied) {
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = std::max(first[axis], block.first[axis]) - block.first[axis];
      last[axis] = std::min(last[axis], block.last(axis)) - block.first[axis];
    }
    for (int x = first[0]; x <= last[0]; ++x)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int z = first[2]; z <= last[2]; ++z)
          map.occupied[block.index(x, y, z)] = occupied ? 1 : 0;
  };
  for_each_leaf(tree, block, [&](const Leaf& leaf) {
    if (leaf.occupied != unknown_is_occupied) fill(leaf.first, leaf.last, leaf.occupied);
  });
  if (first_layer_above_ground > block.first[2])
    fill(block.first, {block.last(0), block.last(1), first_layer_above_ground - 1}, false);
  map.any = std::find(map.occupied.begin(), map.occupied.end(), 1) != map.occupied.end();
  return map;
}

Block block_between(const Eigen::Vector3d& first, const Eigen::Vector3d& last) {
  Block block;
  if ((last - first + Eigen::Vector3d::Ones()).prod() > kMaxVoxels)
    throw Error("the box of interest has too many voxels", "at most 1e8; a smaller box");
  for (int axis = 0; axis < 3; ++axis) {
    block.first[axis] = static_cast<int>(first[axis]);
    block.size[axis] = static_cast<int>(last[axis]) - block.first[axis] + 1;
  }
  return block;
}

}  // namespace

void DistanceFieldOptions::validate() const {
  require_metres(max_distance_m, "max_distance_m");
  if (lower.has_value() != upper.has_value())
    throw Error("only one corner of the box of interest", "both lower and upper, or neither");
  if (lower &&
      (!lower->allFinite() || !upper->allFinite() || (lower->array() > upper->array()).any()))
    throw Error("the box of interest is not a box", "finite corners, lower <= upper");
  if (std::isnan(ground_z)) throw Error("ground_z is not a number", "a height in metres");
}

DistanceField DistanceField::from_octree(const octomap::OcTree& tree,
                                         const DistanceFieldOptions& options) {
  options.validate();
  const double h = tree.getResolution();
  DistanceField field;
  field.resolution_ = h;
  field.inverse_resolution_ = 1.0 / h;
  field.max_distance_ = options.max_distance_m;

  // Occupied voxels as far away as this can still lower a node's value.
  const int reach = static_cast<int>(std::ceil(options.max_distance_m / h + kNodeOffset)) + 1;
  const Block everything{{-kKeyOffset, -kKeyOffset, -kKeyOffset},
                         {2 * kKeyOffset, 2 * kKeyOffset, 2 * kKeyOffset}};
  const int first_layer =
      std::isinf(options.ground_z) && options.ground_z < 0
          ? -kKeyOffset
          : static_cast<int>(std::clamp(std::floor((options.ground_z + 1e-6) / h),
                                        static_cast<double>(-kKeyOffset),
                                        static_cast<double>(kKeyOffset)));

  Index3 occupied_first{kKeyOffset, kKeyOffset, kKeyOffset};
  Index3 occupied_last{-kKeyOffset, -kKeyOffset, -kKeyOffset};
  for_each_leaf(tree, everything, [&](const Leaf& leaf) {
    if (!leaf.occupied || leaf.last[2] < first_layer) return;
    for (int axis = 0; axis < 3; ++axis) {
      const int first = axis == 2 ? std::max(leaf.first[2], first_layer) : leaf.first[axis];
      occupied_first[axis] = std::min(occupied_first[axis], first);
      occupied_last[axis] = std::max(occupied_last[axis], leaf.last[axis]);
    }
  });
  const bool any = occupied_first[0] <= occupied_last[0];
  if (!any && (!options.unknown_is_occupied || !options.lower)) return field;

  Eigen::Vector3d first, last;  // nodes whose hull contains the box
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = options.lower ? (*options.lower)[axis] / h : occupied_first[axis] - reach;
    const double upper =
        options.upper ? (*options.upper)[axis] / h : occupied_last[axis] + 1.0 + reach;
    first[axis] = std::floor(lower - 0.5);
    last[axis] = std::max(std::ceil(upper - 0.5), first[axis] + 1.0);
  }
  if (first.minCoeff() < -kKeyOffset || last.maxCoeff() >= kKeyOffset)
    throw Error("the box of interest leaves the map's range",
                "coordinates within " + std::to_string(kKeyOffset * h) + " m");
  const Block nodes = block_between(first, last);

  // The transform also needs the surroundings, as far as anything is occupied there; one layer more
  // so that the boundary of the outermost voxels is known.
  Eigen::Vector3d wide_first, wide_last;
  for (int axis = 0; axis < 3; ++axis) {
    wide_first[axis] = first[axis] - reach;
    wide_last[axis] = last[axis] + reach;
    if (options.unknown_is_occupied) continue;
    wide_first[axis] =
        std::min(first[axis], std::max(wide_first[axis], occupied_first[axis] - 1.0));
    wide_last[axis] = std::max(last[axis], std::min(wide_last[axis], occupied_last[axis] + 1.0));
  }
  const Block wide = block_between(wide_first, wide_last);
  const Occupancy map = rasterise(tree, wide, options.unknown_is_occupied, first_layer);
  if (!map.any) return field;

  field.dimensions_ = nodes.size;
  for (int axis = 0; axis < 3; ++axis) {
    field.lower_[axis] = (nodes.first[axis] + 0.5) * h;
    field.upper_[axis] = (nodes.last(axis) + 0.5) * h;
  }
  field.values_.resize(nodes.count());
  const auto store = [&](const Transform& transform, bool occupied) {
    for (int x = 0; x < nodes.size[0]; ++x)
      for (int y = 0; y < nodes.size[1]; ++y)
        for (int z = 0; z < nodes.size[2]; ++z) {
          const int i = x + nodes.first[0] - wide.first[0];
          const int j = y + nodes.first[1] - wide.first[1];
          const int k = z + nodes.first[2] - wide.first[2];
          if (map.at(i, j, k) != occupied) continue;
          const double cells = std::sqrt(static_cast<double>(transform.getSQCellDistance(i, j, k)));
          const double value = ((occupied ? 1.0 - cells : cells) - kNodeOffset) * h;
          field.values_[nodes.index(x, y, z)] =
              static_cast<float>(std::min(value, options.max_distance_m));
        }
  };
  store(Transform(map, true, reach * reach), false);
  // Depth is not limited: the wave only runs through the inside. Where there is no free voxel at
  // all it is the diagonal of the block.
  int diagonal = 0;
  for (int size : wide.size) diagonal += size * size;
  store(Transform(map, false, diagonal), true);
  return field;
}

DistanceSample DistanceField::sample_inside(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d cell = (point - lower_) * inverse_resolution_;
  const int x = std::clamp(static_cast<int>(cell.x()), 0, dimensions_[0] - 2);
  const int y = std::clamp(static_cast<int>(cell.y()), 0, dimensions_[1] - 2);
  const int z = std::clamp(static_cast<int>(cell.z()), 0, dimensions_[2] - 2);
  const double tx = cell.x() - x, ty = cell.y() - y, tz = cell.z() - z;

  const std::size_t dy = dimensions_[2], dx = dy * dimensions_[1];
  const float* v = values_.data() + x * dx + y * dy + z;
  const CellNodes nodes{v[0], v[1], v[dy], v[dy + 1], v[dx], v[dx + 1], v[dx + dy], v[dx + dy + 1]};
  return between_nodes(nodes, tx, ty, tz, inverse_resolution_, max_distance_);
}

DistanceSample DistanceField::sample(const Eigen::Vector3d& point) const {
  if (empty()) return {max_distance_, Eigen::Vector3d::Zero()};
  const Eigen::Vector3d clamped = point.cwiseMax(lower_).cwiseMin(upper_);
  const DistanceSample sample = sample_inside(clamped);
  return clamped == point ? sample : beyond_nodes(sample, point - clamped, max_distance_);
}

double DistanceField::distance(const Eigen::Vector3d& point) const {
  return sample(point).distance;
}

void DistanceField::lower(const PointList& points, double* nearest) const {
  if (empty()) {
    for (int i = 0; i < points.count; ++i) nearest[i] = std::min(nearest[i], max_distance_);
    return;
  }
  if (values_.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    for (int i = 0; i < points.count; ++i) {  // more nodes than the kernels can tell apart
      const Eigen::Vector3d point(points.x[i], points.y[i], points.z[i]);
      nearest[i] = std::min(nearest[i], distance(point));
    }
    return;
  }
  FieldNodes nodes{values_.data(), {}, {}, {}, inverse_resolution_, max_distance_};
  std::ranges::copy(dimensions_, nodes.dimensions);
  std::ranges::copy(lower_, nodes.lower);
  std::ranges::copy(upper_, nodes.upper);
  point_kernels().field(nodes, points, nearest);
}

DistanceSample WorldDistance::sample_map(const Eigen::Vector3d& point) const {
  if (map) return map->sample(point);
  if (source) return source->sample(point);
  DistanceSample sample{max_distance(), Eigen::Vector3d::Zero()};
  if (!leaves) return sample;
  constexpr double kDot_m = 1e-9;
  static const ConvexShape dot = ConvexShape::sphere(kDot_m);
  const Eigen::Isometry3d at{Eigen::Translation3d(point)};
  VoxelTree::Query query{dot, at};
  query.floor_z = leaves_floor_z;
  query.best.distance = sample.distance - kDot_m;
  if (!leaves->nearest(query)) return sample;
  sample.distance = query.best.distance + kDot_m;
  const Eigen::Vector3d out =
      sample.distance > 0.0 ? point - query.best.on_second : query.best.on_second - point;
  if (out.norm() > 10.0 * kDot_m) sample.gradient = out.normalized();
  return sample;
}

void WorldDistance::lower_to_map(const PointList& points, double* nearest) const {
  if (map) {
    map->lower(points, nearest);
    return;
  }
  for (int i = 0; i < points.count; ++i) {
    const Eigen::Vector3d point(points.x[i], points.y[i], points.z[i]);
    nearest[i] = std::min(nearest[i], sees_map() ? sample_map(point).distance : max_distance());
  }
}

void WorldDistance::distances(const PointList& points, double time_s, double* distances) const {
  std::fill_n(distances, points.count, std::numeric_limits<double>::infinity());
  lower_to_map(points, distances);
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.is_there(time_s)) obstacle.lower_to_shape(points, time_s, distances);
  }
}

DistanceSample WorldDistance::sample(const Eigen::Vector3d& point, double time_s) const {
  DistanceSample nearest = sample_map(point);
  for (const Obstacle& obstacle : obstacles) {
    const DistanceSample sample = obstacle.sample(point, time_s);
    if (sample.distance < nearest.distance) nearest = sample;
  }
  return nearest;
}

}  // namespace locograph
