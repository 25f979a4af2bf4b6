#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/world/octree.h>
#include <octomap/ColorOcTree.h>

#include <set>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

std::shared_ptr<octomap::OcTree> two_boxes() {
  std::vector<Box> boxes(2);
  boxes[0].world_from_box.translation() = Eigen::Vector3d(1.0, 0.0, 0.5);
  boxes[0].size = Eigen::Vector3d(0.4, 1.0, 1.0);
  boxes[1].world_from_box.translation() = Eigen::Vector3d(-0.5, 0.3, 0.2);
  boxes[1].world_from_box.linear() =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  boxes[1].size = Eigen::Vector3d(0.5, 0.3, 0.2);
  return octree_from_boxes(boxes, 0.05);
}

std::string octree_error(const std::filesystem::path& path) {
  try {
    load_octree(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path.string());
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

TEST(Octree, FillsExactlyTheVoxelsWhoseCentreIsInABox) {
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
  boxes[0].world_from_box.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix();
  boxes[0].size = Eigen::Vector3d(0.6, 0.4, 0.3);
  const std::shared_ptr<octomap::OcTree> tree = octree_from_boxes(boxes, 0.05);
  int occupied = 0;
  for (int x = -12; x < 14; ++x)
    for (int y = -16; y < 12; ++y)
      for (int z = -8; z < 20; ++z) {
        const Eigen::Vector3d centre = 0.05 * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
        const Eigen::Vector3d local = boxes[0].world_from_box.inverse() * centre;
        const bool inside = (local.cwiseAbs().array() <= 0.5 * boxes[0].size.array()).all();
        const octomap::OcTreeNode* node = tree->search(centre.x(), centre.y(), centre.z());
        EXPECT_EQ(node != nullptr && tree->isNodeOccupied(node), inside) << centre.transpose();
        occupied += inside;
      }
  EXPECT_GT(occupied, 400);
}

TEST(Octree, IsPruned) {
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() = Eigen::Vector3d(0.4, 0.4, 0.4);
  boxes[0].size = Eigen::Vector3d::Constant(0.8);
  const std::shared_ptr<octomap::OcTree> tree = octree_from_boxes(boxes, 0.1);
  EXPECT_EQ(octree_info(*tree).occupied_leaves, 1u);  // 8 x 8 x 8 voxels, aligned
  EXPECT_NEAR(octree_info(*tree).occupied_bounds.volume(), 0.512, 1e-6);
}

TEST(Octree, RefusesBoxesAndResolutionsThatAreNone) {
  std::vector<Box> boxes(1);
  boxes[0].size = Eigen::Vector3d(1, 1, 1);
  EXPECT_THROW(octree_from_boxes(boxes, 0.0), Error);
  EXPECT_THROW(octree_from_boxes(boxes, std::nan("")), Error);
  boxes[0].size.y() = 0.0;
  EXPECT_THROW(octree_from_boxes(boxes, 0.1), Error);
  boxes[0].size.y() = 1.0;
  boxes[0].world_from_box.translation().x() = 4000.0;
  EXPECT_THROW(octree_from_boxes(boxes, 0.1), Error);
}

TEST(Octree, SurvivesSavingAndLoading) {
  const TemporaryFolder folder;
  const std::shared_ptr<octomap::OcTree> tree = two_boxes();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  save_octree(*tree, folder.file("map.bt"));
  const std::shared_ptr<octomap::OcTree> loaded = load_octree(folder.file("map.bt"));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");

  EXPECT_EQ(loaded->getResolution(), tree->getResolution());
  std::set<std::array<int, 4>> before, after;
  const auto collect = [](const octomap::OcTree& t, std::set<std::array<int, 4>>& keys) {
    for (octomap::OcTree::leaf_iterator leaf = t.begin_leafs(); leaf != t.end_leafs(); ++leaf)
      if (t.isNodeOccupied(*leaf))
        keys.insert({leaf.getKey()[0], leaf.getKey()[1], leaf.getKey()[2],
                     static_cast<int>(leaf.getDepth())});
  };
  collect(*tree, before);
  collect(*loaded, after);
  EXPECT_EQ(before, after);
  EXPECT_GT(before.size(), 100u);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"map.bt"}) << "something left beside it";

  octomap::OcTree theirs(1.0);
  ASSERT_TRUE(theirs.readBinary(folder.file("map.bt").string()));
  EXPECT_EQ(theirs.size(), tree->size());

  save_octree(*loaded, folder.file("again.bt"));
  EXPECT_EQ(read_file(folder.file("map.bt")), read_file(folder.file("again.bt")));
}

TEST(Octree, SavingIntoAMissingFolderIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(save_octree(*two_boxes(), folder.file("none/map.bt")), Error);
}

TEST(Octree, ReadsFullTreesToo) {
  const TemporaryFolder folder;
  const std::shared_ptr<octomap::OcTree> tree = two_boxes();
  ASSERT_TRUE(tree->write(folder.file("map.ot").string()));
  const std::shared_ptr<octomap::OcTree> loaded = load_octree(folder.file("map.ot"));
  EXPECT_EQ(loaded->size(), tree->size());
  EXPECT_EQ(octree_info(*loaded).occupied_leaves, octree_info(*tree).occupied_leaves);
}

TEST(Octree, AnEmptyTreeSurvivesToo) {
  const TemporaryFolder folder;
  save_octree(octomap::OcTree(0.1), folder.file("map.bt"));
  const OctreeInfo info = octree_info(*load_octree(folder.file("map.bt")));
  EXPECT_EQ(info.occupied_leaves, 0u);
  EXPECT_TRUE(info.occupied_bounds.isEmpty());
}

TEST(Octree, EveryTruncationOfAFileIsAnError) {
  const TemporaryFolder folder;
  const std::shared_ptr<octomap::OcTree> tree = two_boxes();
  for (const char* name : {"map.bt", "map.ot"}) {
    if (name == std::string("map.bt"))
      save_octree(*tree, folder.file(name));
    else
      ASSERT_TRUE(tree->write(folder.file(name).string()));
    const std::string content = read_file(folder.file(name));
    for (std::size_t size = 1; size < content.size(); size += 1 + size / 16)
      octree_error(folder.write("cut", content.substr(0, size)));
    EXPECT_NE(
        octree_error(folder.write("cut", content.substr(0, content.size() - 1))).find("truncated"),
        std::string::npos);
  }
}

TEST(Octree, MissingEmptyAndForeignFilesAreErrors) {
  const TemporaryFolder folder;
  EXPECT_NE(octree_error(folder.file("none.bt")).find("cannot be opened"), std::string::npos);
  EXPECT_NE(octree_error(folder.write("empty.bt", "")).find("is empty"), std::string::npos);
  EXPECT_NE(octree_error(folder.write("text.bt", "hello\nworld\n")).find("not an OctoMap file"),
            std::string::npos);
  EXPECT_NE(octree_error(folder.file("")).find("is a folder"), std::string::npos);
}

TEST(Octree, ATreeOfAnotherTypeIsNamed) {
  const TemporaryFolder folder;
  octomap::ColorOcTree tree(0.1);
  tree.updateNode(octomap::point3d(0.1f, 0.2f, 0.3f), true);
  ASSERT_TRUE(tree.write(folder.file("color.ot").string()));
  const std::string full = octree_error(folder.file("color.ot"));
  EXPECT_NE(full.find("'ColorOcTree', expected type 'OcTree'"), std::string::npos) << full;
  EXPECT_NE(full.find(":4:"), std::string::npos) << full;
  ASSERT_TRUE(tree.writeBinary(folder.file("color.bt").string()));
  EXPECT_NE(octree_error(folder.file("color.bt")).find("'ColorOcTree'"), std::string::npos);
}

TEST(Octree, HeadersThatContradictTheDataAreErrors) {
  const TemporaryFolder folder;
  save_octree(*two_boxes(), folder.file("map.bt"));
  const std::string content = read_file(folder.file("map.bt"));
  const auto replaced = [&](const std::string& key, const std::string& by) {
    const std::size_t at = content.find("\n" + key);
    const std::size_t end = content.find('\n', at + 1);
    return folder.write("changed.bt", content.substr(0, at + 1) + by + content.substr(end));
  };
  EXPECT_NE(octree_error(replaced("size", "size 3")).find("of its header"), std::string::npos);
  EXPECT_NE(octree_error(replaced("res", "res -1")).find("resolution"), std::string::npos);
  EXPECT_NE(octree_error(replaced("res", "res nan")).find("resolution"), std::string::npos);
  EXPECT_NE(octree_error(replaced("res", "scale 2")).find("unknown header entry"),
            std::string::npos);
  EXPECT_NE(octree_error(replaced("id", "#")).find("no 'id' line"), std::string::npos);
}

TEST(Octree, OneLeafOfABillionVoxelsIsNotJoinedVoxelByVoxel) {
  const TemporaryFolder folder;
  const std::string header = "# Octomap OcTree binary file\nid OcTree\nsize 2\nres 0.1\ndata\n";
  const auto leaf = load_octree(folder.write("leaf.bt", header + std::string("\2\0", 2)));
  EXPECT_THROW(joined(*leaf, octomap::OcTree(0.1)), Error);
}

TEST(Octree, NodesNestedTooDeepAreAnErrorAndNotARecursionWithoutEnd) {
  const TemporaryFolder folder;
  const std::string header = "# Octomap OcTree binary file\nid OcTree\nsize 100\nres 0.1\ndata\n";
  EXPECT_NE(octree_error(folder.write("deep.bt", header + std::string(4000, '\xff')))
                .find("deeper than 16"),
            std::string::npos);
}

TEST(Octree, ReadsThePublicBuildingMap) {
  const std::filesystem::path path =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "octomap/geb079.bt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const std::shared_ptr<octomap::OcTree> tree = load_octree(path);
  EXPECT_EQ(tree->size(), 532566u);  // of the file's header

  // Counted over all nodes, not over leaves as octree_info does.
  std::size_t occupied = 0, free = 0;
  for (octomap::OcTree::tree_iterator node = tree->begin_tree(); node != tree->end_tree(); ++node) {
    if (!node.isLeaf()) continue;
    (tree->isNodeOccupied(*node) ? occupied : free) += 1;
  }
  const OctreeInfo info = octree_info(*tree);
  EXPECT_EQ(info.occupied_leaves, occupied);
  EXPECT_EQ(info.free_leaves, free);
  EXPECT_GT(occupied, 100000u);
  EXPECT_NEAR(info.resolution_m, 0.08, 1e-12);
  Eigen::Vector3d lower, upper;
  tree->getMetricMin(lower.x(), lower.y(), lower.z());
  tree->getMetricMax(upper.x(), upper.y(), upper.z());
  EXPECT_TRUE(info.known_bounds.min().isApprox(lower, 1e-6));
  EXPECT_TRUE(info.known_bounds.max().isApprox(upper, 1e-6));
  EXPECT_TRUE(info.known_bounds.contains(info.occupied_bounds));
}

}  // namespace
}  // namespace locograph
