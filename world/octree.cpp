#include <locograph/common/atomic_file.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/ranges.h>
#include <locograph/world/octree.h>
#include <locograph/world/require_metres.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>

namespace locograph {
namespace {

constexpr std::string_view kBinaryFirstLine = "# Octomap OcTree binary file";
constexpr std::string_view kFullFirstLine = "# Octomap OcTree file";
constexpr int kMaxDepth = 16;

struct Header {
  bool binary = false;
  std::size_t nodes = 0;
  double resolution_m = 0.0;
  std::size_t data_begin = 0;
};

// OctoMap's header: a fixed first line, comments, then `id`, `size`, `res` in any order, `data`.
class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view content)
      : file_(file), content_(content) {}

  Header read() {
    Header header;
    const std::string_view first = next_line();
    header.binary = first.starts_with(kBinaryFirstLine);
    if (!header.binary && !first.starts_with(kFullFirstLine))
      fail("not an OctoMap file",
           "a first line '# Octomap OcTree binary file' (.bt) or "
           "'# Octomap OcTree file' (.ot)");
    bool has_id = false, has_size = false, has_resolution = false;
    for (;;) {
      const std::string_view line = next_line();
      if (line.empty() || line.front() == '#') continue;
      std::istringstream words{std::string(line)};
      std::string key;
      words >> key;
      if (key == "data") break;
      if (key == "id") {
        std::string id;
        words >> id;
        if (id != "OcTree") fail("the tree is of type '" + id + "'", "type 'OcTree'");
        has_id = true;
      } else if (key == "size") {
        if (!(words >> header.nodes)) fail("unreadable number of nodes", "size N");
        has_size = true;
      } else if (key == "res") {
        if (!(words >> header.resolution_m) || !(header.resolution_m >= ranges::kLeastVoxel_m) ||
            !(header.resolution_m <= ranges::kMostVoxel_m))
          fail("unusable resolution", "res followed by a number of metres from 0.0001 to 100");
        has_resolution = true;
      } else {
        fail("unknown header entry '" + printable(key) + "'", "id, size, res or data");
      }
    }
    if (!has_id) fail("no 'id' line in the header", "id OcTree");
    if (!has_size) fail("no 'size' line in the header", "size N");
    if (!has_resolution) fail("no 'res' line in the header", "res R");
    header.data_begin = position_;
    return header;
  }

 private:
  std::string_view next_line() {
    const std::size_t end = content_.find('\n', position_);
    if (end == std::string_view::npos) {
      if (line_ == 0) {
        ++line_;
        position_ = content_.size();
        return content_;
      }
      fail("truncated in the header", "a line 'data'");
    }
    std::string_view line = content_.substr(position_, end - position_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    position_ = end + 1;
    ++line_;
    return line;
  }

  static std::string printable(const std::string& text) {
    std::string out = text.substr(0, 40);
    std::replace_if(
        out.begin(), out.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
    return out;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
    throw Error(file_, line_, what, expected);
  }

  const std::string& file_;
  std::string_view content_;
  std::size_t position_ = 0;
  int line_ = 0;
};

// Walks the node records the way OctoMap's readers do, with the checks they do not make.
class DataWalk {
 public:
  DataWalk(const std::string& file, std::string_view data) : file_(file), data_(data) {}

  // .bt: two bits per child in two bytes; 3 means an inner node, whose record follows.
  void binary(int depth) {
    const std::size_t at = take(2);
    const unsigned bits = byte(at) | byte(at + 1) << 8;
    ++nodes_;
    for (int child = 0; child < 8; ++child) {
      const unsigned state = bits >> (2 * child) & 3u;
      if (state == 3u)
        binary(deeper(depth, kMaxDepth - 1));
      else if (state != 0u)
        ++nodes_;
    }
  }

  // .ot: log-odds as a float, then one bit per child, whose records follow.
  void full(int depth) {
    const std::size_t at = take(5);
    ++nodes_;
    float log_odds = 0.0f;
    std::memcpy(&log_odds, data_.data() + at, sizeof log_odds);
    if (!std::isfinite(log_odds))
      fail("a node's log-odds are not a finite number", "an intact file");
    const unsigned children = byte(at + 4);
    for (int child = 0; child < 8; ++child)
      if (children >> child & 1u) full(deeper(depth, kMaxDepth));
  }

  std::size_t nodes() const { return nodes_; }

 private:
  std::size_t take(std::size_t bytes) {
    if (data_.size() - position_ < bytes)
      fail("truncated after " + std::to_string(data_.size()) + " bytes of data",
           "the records of all nodes");
    const std::size_t at = position_;
    position_ += bytes;
    return at;
  }

  int deeper(int depth, int limit) const {
    if (depth + 1 > limit) fail("nodes are nested deeper than 16 levels", "an intact file");
    return depth + 1;
  }

  unsigned byte(std::size_t at) const { return static_cast<unsigned char>(data_[at]); }

  [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
    throw Error(file_, 0, what, expected);
  }

  const std::string& file_;
  std::string_view data_;
  std::size_t position_ = 0;
  std::size_t nodes_ = 0;
};

/// At this resolution, which is not coarser than the tree's.
double occupied_voxels(const octomap::OcTree& tree, double resolution_m) {
  double volume_m3 = 0.0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (tree.isNodeOccupied(*leaf)) volume_m3 += std::pow(leaf.getSize(), 3);
  }
  return volume_m3 / std::pow(resolution_m, 3);
}

}  // namespace

std::shared_ptr<octomap::OcTree> load_octree(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::string content = read_file(path, kMostInputBytes, "an OctoMap file (.bt or .ot)");
  if (content.empty()) throw Error(file, 0, "is empty", "an OctoMap file (.bt or .ot)");

  const Header header = HeaderReader(file, content).read();
  if (header.nodes > 0) {
    DataWalk walk(file, std::string_view(content).substr(header.data_begin));
    header.binary ? walk.binary(0) : walk.full(0);
    if (walk.nodes() != header.nodes)
      throw Error(file, 0, "holds " + std::to_string(walk.nodes()) + " nodes",
                  "the " + std::to_string(header.nodes) + " of its header");
  }

  // OctoMap's own file functions chatter on stderr; those for the data alone do not.
  std::shared_ptr<octomap::OcTree> tree = std::make_shared<octomap::OcTree>(header.resolution_m);
  if (header.nodes == 0) return tree;
  std::istringstream data(std::move(content));
  data.seekg(static_cast<std::streamoff>(header.data_begin));
  if (header.binary)
    tree->readBinaryData(data);
  else
    tree->readData(data);
  return tree;
}

void save_octree(const octomap::OcTree& tree, const std::filesystem::path& path) {
  std::ostringstream out;
  out << kBinaryFirstLine << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
      << std::setprecision(17) << tree.getResolution() << "\ndata\n";
  if (tree.size() > 0) tree.writeBinaryData(out);
  write_file_atomically(path, out.str());
}

std::shared_ptr<octomap::OcTree> joined(const octomap::OcTree& a, const octomap::OcTree& b) {
  const double resolution = std::min(a.getResolution(), b.getResolution());
  const auto tree = std::make_shared<octomap::OcTree>(resolution);
  constexpr double kMostVoxels = 1e7;
  if (const double voxels = occupied_voxels(a, resolution) + occupied_voxels(b, resolution);
      voxels > kMostVoxels) {
    throw Error("two maps with " + std::to_string(static_cast<long>(voxels)) +
                    " occupied voxels of the finer resolution are not joined",
                "at most ten million; a map with larger voxels, or a part of it");
  }
  for (const octomap::OcTree* one : {&a, &b}) {
    for (auto leaf = one->begin_leafs(), end = one->end_leafs(); leaf != end; ++leaf) {
      if (!one->isNodeOccupied(*leaf)) continue;
      // Faces belong to the voxel inside, whatever their rounding.
      const double half = 0.5 * leaf.getSize() - 1e-6 * resolution;
      const octomap::point3d centre = leaf.getCoordinate();
      octomap::OcTreeKey first, last;
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (!tree->coordToKeyChecked(centre(axis) - half, first[axis]) ||
            !tree->coordToKeyChecked(centre(axis) + half, last[axis]))
          throw Error("two maps reach too far apart for their finer resolution", "nearer ones");
      }
      for (int x = first[0]; x <= last[0]; ++x)
        for (int y = first[1]; y <= last[1]; ++y)
          for (int z = first[2]; z <= last[2]; ++z)
            tree->updateNode(octomap::OcTreeKey(static_cast<octomap::key_type>(x),
                                                static_cast<octomap::key_type>(y),
                                                static_cast<octomap::key_type>(z)),
                             true, true);
    }
  }
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

std::shared_ptr<octomap::OcTree> octree_from_boxes(std::span<const Box> boxes,
                                                   double resolution_m) {
  require_metres(resolution_m, "resolution");
  std::shared_ptr<octomap::OcTree> tree = std::make_shared<octomap::OcTree>(resolution_m);
  constexpr int kOffset = 1 << (kMaxDepth - 1);
  // Centres on a face belong to the box, whatever the rounding of the transform.
  const double slack = 1e-9 * resolution_m;
  for (const Box& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) require_metres(box.size[axis], "size of a box");
    if (!box.world_from_box.matrix().allFinite())
      throw Error("the pose of a box is not finite", "a finite pose");
    const Eigen::Vector3d half = 0.5 * box.size;
    const Eigen::Vector3d reach = box.world_from_box.linear().cwiseAbs() * half;
    const Eigen::Vector3d lower = box.world_from_box.translation() - reach;
    const Eigen::Vector3d upper = box.world_from_box.translation() + reach;
    if ((lower.array() < -kOffset * resolution_m).any() ||
        (upper.array() > kOffset * resolution_m).any())
      throw Error("a box reaches outside the map's range",
                  "coordinates within " + std::to_string(kOffset * resolution_m) + " m");

    octomap::OcTreeKey first, last;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const int from = static_cast<int>(std::floor(lower[axis] / resolution_m)) + kOffset;
      const int to = static_cast<int>(std::floor(upper[axis] / resolution_m)) + kOffset;
      first[axis] = static_cast<octomap::key_type>(std::clamp(from, 0, 2 * kOffset - 1));
      last[axis] = static_cast<octomap::key_type>(std::clamp(to, 0, 2 * kOffset - 1));
    }
    const Eigen::Isometry3d box_from_world = box.world_from_box.inverse();
    for (int x = first[0]; x <= last[0]; ++x)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int z = first[2]; z <= last[2]; ++z) {
          const Eigen::Vector3d centre(x - kOffset + 0.5, y - kOffset + 0.5, z - kOffset + 0.5);
          const Eigen::Vector3d local = box_from_world * (centre * resolution_m);
          if ((local.cwiseAbs().array() > half.array() + slack).any()) continue;
          const octomap::OcTreeKey key(static_cast<octomap::key_type>(x),
                                       static_cast<octomap::key_type>(y),
                                       static_cast<octomap::key_type>(z));
          tree->setNodeValue(key, tree->getClampingThresMaxLog(), true);
        }
  }
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

OctreeInfo octree_info(const octomap::OcTree& tree) {
  OctreeInfo info;
  info.resolution_m = tree.getResolution();
  for (octomap::OcTree::leaf_iterator leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * leaf.getSize());
    const Eigen::AlignedBox3d cube(centre - half, centre + half);
    info.known_bounds.extend(cube);
    if (tree.isNodeOccupied(*leaf)) {
      ++info.occupied_leaves;
      info.occupied_bounds.extend(cube);
    } else {
      ++info.free_leaves;
    }
  }
  return info;
}

}  // namespace locograph
