// Fields of a local map beside those of OctoMaps, and OctoMaps in and out of a local map.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/local_map.h>
#include <locograph/world/world_snapshot.h>

#include <random>

#include "world/perception/each_voxel.h"

namespace locograph {
namespace {

using test::each_voxel;

LocalMapOptions box_window() {
  LocalMapOptions options;
  options.size_m = {4.8, 4.8, 3.2};
  options.max_distance_m = 0.5;
  return options;
}

Box box_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Box box;
  box.world_from_box.translation() = centre;
  box.size = size;
  return box;
}

/// A wall, a table and some dust, all of it farther than the field reaches from the window's sides.
std::shared_ptr<octomap::OcTree> cluttered(double resolution_m) {
  std::vector<Box> boxes = {box_at({0.5, 0.3, 0.0}, {0.2, 1.5, 1.0}),
                            box_at({-0.7, 0.0, 0.3}, {0.6, 0.6, 0.1})};
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-0.9, 0.9);
  for (int i = 0; i < 40; ++i) {
    const double x = uniform(generator), y = uniform(generator), z = 0.8 * uniform(generator);
    boxes.push_back(box_at({x, y, z}, Eigen::Vector3d::Constant(0.06)));
  }
  return octree_from_boxes(boxes, resolution_m);
}

Eigen::Vector3d centre_of(const VoxelWindow& window, const Eigen::Vector3i& index) {
  return (index.cast<double>() + Eigen::Vector3d::Constant(0.5)) * window.resolution_m;
}

bool occupied_in(const octomap::OcTree& tree, const Eigen::Vector3d& point) {
  const octomap::OcTreeNode* node = tree.search(point.x(), point.y(), point.z());
  return node != nullptr && tree.isNodeOccupied(node);
}

TEST(LocalField, ReadsWhatAFieldOfTheSameOctoMapReads) {
  const std::shared_ptr<const octomap::OcTree> tree = cluttered(0.05);
  DistanceFieldOptions options;
  options.max_distance_m = 0.5;
  options.lower = Eigen::Vector3d(-2.2, -2.2, -1.5);
  options.upper = Eigen::Vector3d(2.2, 2.2, 1.5);
  const DistanceField expected = DistanceField::from_octree(*tree, options);
  LocalMap map(box_window());
  map.move_to({0.3, -0.2, 0.1});
  map.load(*tree);
  const std::shared_ptr<const LocalField> field = map.field();
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1.3, 1.3);
  int compared = 0, different = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d point(uniform(generator), uniform(generator), uniform(generator));
    const DistanceSample one = expected.sample(point), other = field->sample(point);
    // Depths inside are not measured: only where no node of the cell is that deep.
    bool deep = false;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d side(corner & 1, corner >> 1 & 1, corner >> 2);
      const Eigen::Vector3d at = point + 0.05 * (side - Eigen::Vector3d::Constant(0.5));
      deep = deep ||
             expected.distance(centre_of(field->window(), field->window().index_at(at))) < -0.06;
    }
    if (deep) {
      EXPECT_LT(other.distance, 0.0);
      continue;
    }
    ++compared;
    // The grids begin elsewhere, so that a point's place in its cell is rounded differently.
    different += std::abs(one.distance - other.distance) > 1e-12 ||
                 (one.gradient - other.gradient).norm() > 1e-9;
  }
  EXPECT_GT(compared, 19000);
  EXPECT_EQ(different, 0);
}

TEST(LocalField, GradientIsTheDerivativeOfTheDistance) {
  LocalMap map(box_window());
  map.load(*cluttered(0.05));
  const std::shared_ptr<const LocalField> field = map.field();
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  constexpr double kStep = 1e-7;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point(uniform(generator), uniform(generator), 0.5 * uniform(generator));
    const DistanceSample sample = field->sample(point);
    // Not across the border between two cells.
    const Eigen::Array3d in_cell =
        (point.array() / 0.05 - 0.5) - (point.array() / 0.05 - 0.5).floor();
    if (in_cell.minCoeff() < 1e-4 || in_cell.maxCoeff() > 1.0 - 1e-4) continue;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d step = Eigen::Vector3d::Zero();
      step[axis] = kStep;
      const double slope =
          (field->distance(point + step) - field->distance(point - step)) / (2 * kStep);
      ASSERT_NEAR(sample.gradient[axis], slope, 1e-5) << point.transpose();
    }
  }
}

TEST(LocalField, IsWhatASnapshotOfAWorldShows) {
  LocalMap map(box_window());
  map.load(*cluttered(0.05));
  const std::shared_ptr<const LocalField> field = map.field();
  WorldDistance seen;
  seen.source = field;
  const WorldSnapshot snapshot(World{}, seen, 4.5);
  const WorldDistance& world = snapshot.distance();
  EXPECT_EQ(snapshot.stamp_s(), 4.5);
  EXPECT_TRUE(world.sees_map());
  EXPECT_EQ(world.max_distance(), 0.5);
  const Eigen::Vector3d near(0.2, 0.3, 0.1), unseen(1.5, 1.5, 1.0);
  EXPECT_EQ(world.distance(near, 0.0), field->distance(near));
  EXPECT_LT(world.distance(near, 0.0), 0.3);
  EXPECT_TRUE(world.is_known({0.5, 0.3, 0.0}));
  EXPECT_FALSE(world.is_known(unseen));
  EXPECT_TRUE(WorldDistance{}.is_known(unseen));
}

TEST(LocalMap, OctoMapsComeInAndGoOutAgain) {
  octomap::OcTree tree(0.05);
  std::mt19937 generator(9);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (int i = 0; i < 20000; ++i) {
    const double x = uniform(generator), y = uniform(generator), z = uniform(generator);
    for (int votes = static_cast<int>(generator() % 4); votes >= 0; --votes)
      tree.updateNode(x, y, z, generator() % 3 == 0);
  }
  for (double x = -1.0; x < 0.6; x += 0.02)  // leaves of several sizes
    for (double y = -1.0; y < 0.6; y += 0.02)
      for (double z = -1.0; z < 0.6; z += 0.02) tree.updateNode(x, y, z, false);
  tree.prune();
  LocalMap map(box_window());
  map.move_to({0.4, 0.8, -0.4});
  map.load(tree);
  octomap::OcTree out(0.05);
  map.merge_into(out);
  int occupied = 0, free = 0, wrong = 0;
  each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
    const Eigen::Vector3d at = centre_of(map.window(), index);
    const octomap::OcTreeNode* before = tree.search(at.x(), at.y(), at.z());
    const octomap::OcTreeNode* after = out.search(at.x(), at.y(), at.z());
    if (before == nullptr || after == nullptr) {
      wrong += before != after;
      return;
    }
    const bool was = tree.isNodeOccupied(before);
    ++(was ? occupied : free);
    wrong += was != out.isNodeOccupied(after);
    wrong += std::abs(before->getLogOdds() - after->getLogOdds()) > 0.2f;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(occupied, 500);
  EXPECT_GT(free, 30000);

  // What is merged stands in the place of what the tree knew, and nothing else changes.
  octomap::OcTree other(0.05);
  other.updateNode(0.525, 0.525, 0.525, true);
  other.updateNode(9.025, 0.025, 0.025, true);
  LocalMap empty(box_window());
  empty.clear(Eigen::AlignedBox3d(Eigen::Vector3d::Constant(0.4), Eigen::Vector3d::Constant(0.7)));
  empty.field()->merge_into(other);
  EXPECT_FALSE(occupied_in(other, {0.525, 0.525, 0.525}));
  EXPECT_TRUE(occupied_in(other, {9.025, 0.025, 0.025}));
}

TEST(LocalMap, LoadFillsOnlyWhatWasNeverSeen) {
  const std::shared_ptr<const octomap::OcTree> tree = cluttered(0.05);
  LocalMap map(box_window());
  map.clear(Eigen::AlignedBox3d(Eigen::Vector3d(0.0, -0.5, -0.2), Eigen::Vector3d(1.0, 1.2, 0.2)));
  map.load(*tree);
  EXPECT_FALSE(map.field()->is_occupied(map.window().index_at({0.5, 0.3, 0.0})));
  EXPECT_TRUE(map.field()->is_occupied(map.window().index_at({0.5, 0.3, 0.4})));
}

TEST(LocalMap, TheFloorOfAMapIsNoObstacle) {
  const Box slab = box_at({0.0, 0.0, -0.05}, {2.0, 2.0, 0.2});  // up to z = 0.05
  LocalMapOptions options = box_window();
  options.floor_z_m = 0.0;
  LocalMap map(options);
  map.load(*octree_from_boxes(std::vector{slab}, 0.05));
  each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
    ASSERT_FALSE(map.field()->is_occupied(index)) << index.transpose();
  });
  EXPECT_TRUE(map.field()->is_known(Eigen::Vector3d(0.3, 0.3, 0.02)));
}

TEST(LocalMap, MapsOfAnotherResolutionAreOccupiedWhereTheirLeavesReach) {
  for (const double resolution_m : {0.02, 0.0333, 0.1, 0.2}) {
    const std::shared_ptr<const octomap::OcTree> tree = cluttered(resolution_m);
    LocalMap map(box_window());
    map.load(*tree);
    const std::shared_ptr<const LocalField> field = map.field();
    int occupied = 0, missed = 0, too_far = 0;
    each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
      const Eigen::Vector3d at = centre_of(map.window(), index);
      const bool here = field->is_occupied(index);
      occupied += here;
      missed += !here && occupied_in(*tree, at);
      if (!here) return;
      bool any = false;  // some leaf overlaps the voxel: looked for on a grid finer than both
      for (double dx = -0.0249; dx < 0.025 && !any; dx += 0.00711)
        for (double dy = -0.0249; dy < 0.025 && !any; dy += 0.00711)
          for (double dz = -0.0249; dz < 0.025 && !any; dz += 0.00711)
            any = occupied_in(*tree, at + Eigen::Vector3d(dx, dy, dz));
      too_far += !any;
    });
    EXPECT_GT(occupied, 500);
    EXPECT_EQ(missed, 0) << resolution_m;
    EXPECT_LE(too_far, occupied / 50) << resolution_m;
    octomap::OcTree same = *tree;
    EXPECT_THROW(map.merge_into(same), Error);
    EXPECT_EQ(same, *tree);
  }
}

}  // namespace
}  // namespace locograph
