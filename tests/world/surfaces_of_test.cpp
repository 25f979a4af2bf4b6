#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/octree.h>
#include <locograph/world/surfaces_of.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "common/temporary_folder.h"
#include "world/synthetic_cloud.h"

namespace locograph {
namespace {

using test::SyntheticCloud;
using test::TemporaryFolder;

/// A tree of one leaf: all voxels of 0.1 m with x, y and z below 0, as far as keys go.
std::shared_ptr<octomap::OcTree> one_leaf(const TemporaryFolder& folder) {
  const std::string header = "# Octomap OcTree binary file\nid OcTree\nsize 2\nres 0.1\ndata\n";
  return load_octree(folder.write("leaf.bt", header + std::string("\2\0", 2)));
}

/// The highest point of occupied voxels over a place; -1 if there are none.
double height_over(const World& world, double x, double y) {
  double height = -1.0;
  if (world.map == nullptr) return height;
  for (auto leaf = world.map->begin_leafs(), end = world.map->end_leafs(); leaf != end; ++leaf) {
    const double half = 0.5 * leaf.getSize();
    if (world.map->isNodeOccupied(*leaf) && std::abs(leaf.getX() - x) < half &&
        std::abs(leaf.getY() - y) < half) {
      height = std::max(height, leaf.getZ() + half);
    }
  }
  return height;
}

TEST(SurfacesOf, ACloudIsRectanglesAndBarsAndAMapOfTheRest) {
  SyntheticCloud cloud(0.004);
  cloud.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  cloud.bar({0.5, -0.4, 0.9}, {0.5, 0.4, 0.9}, 0.02);
  for (int i = 0; i < 50; ++i) cloud.points.emplace_back(-0.52, 0.52 + 0.0001 * i, 0.31);
  World world;
  add_cloud(world, "scan", cloud.points, 0.6);
  ASSERT_FALSE(world.surfaces.empty());
  EXPECT_EQ(world.surfaces[0].name, "scan 1");
  EXPECT_EQ(world.surfaces[0].friction, 0.6);
  EXPECT_GT(4 * world.surfaces[0].half_x_m * world.surfaces[0].half_y_m, 3.5);
  ASSERT_EQ(world.bars.size(), 1u);
  EXPECT_EQ(world.bars[0].name, "scan bar 1");
  EXPECT_EQ(world.bars[0].friction, 0.6);
  ASSERT_NE(world.map, nullptr);
  EXPECT_NEAR(height_over(world, -0.52, 0.52), 0.35, 1e-6);
  const Eigen::AlignedBox3d bounds = octree_info(*world.map).occupied_bounds;
  EXPECT_NEAR(bounds.max().z(), 0.35, 1e-6) << "the bar is no voxel";
}

TEST(SurfacesOf, ALeafAsLargeAsAMapIsOneBox) {
  const TemporaryFolder folder;
  World world;
  add_octomap(world, "rock", one_leaf(folder), 0.6);
  ASSERT_EQ(world.surfaces.size(), 6u);
  int up = 0;
  for (const Surface& surface : world.surfaces) {
    EXPECT_NEAR(surface.half_x_m, 1638.4, 1e-6);
    EXPECT_NEAR(surface.half_y_m, 1638.4, 1e-6);
    if (surface.world_from_surface.linear()(2, 2) < 0.5) continue;
    ++up;
    EXPECT_TRUE(surface.world_from_surface.translation().isApprox(
        Eigen::Vector3d(-1638.4, -1638.4, 0.0), 1e-9));
  }
  EXPECT_EQ(up, 1);
}

TEST(SurfacesOf, ALeafThatIsHalfHiddenBySmallOnesShowsTheRest) {
  octomap::OcTree tree(0.1);
  // Four by four by four voxels, pruned to one leaf, and one voxel on top.
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) {
        tree.updateNode(octomap::OcTreeKey(static_cast<octomap::key_type>(32768 + x),
                                           static_cast<octomap::key_type>(32768 + y),
                                           static_cast<octomap::key_type>(32768 + z)),
                        true);
      }
  tree.updateNode(octomap::OcTreeKey(32768, 32768, 32772), true);
  tree.prune();
  World world;
  PatchOptions options;
  options.least_length_m = options.least_width_m = 0.09;
  add_octomap(world, "steps", std::make_shared<octomap::OcTree>(tree), 0.6, options);
  double top_m2 = 0.0;
  for (const Surface& surface : world.surfaces) {
    const Eigen::Isometry3d& pose = surface.world_from_surface;
    if (pose.linear()(2, 2) < 0.5 || pose.translation().z() > 0.45) continue;
    EXPECT_NEAR(pose.translation().z(), 0.4, 1e-9);
    const Eigen::Vector3d corner = pose.inverse() * Eigen::Vector3d(0.05, 0.05, 0.4);
    EXPECT_TRUE(std::abs(corner.x()) > surface.half_x_m || std::abs(corner.y()) > surface.half_y_m)
        << "the voxel is on it";
    top_m2 = std::max(top_m2, 4.0 * surface.half_x_m * surface.half_y_m);
  }
  EXPECT_NEAR(top_m2, 0.12, 1e-9);
}

TEST(SurfacesOf, MoreFacesOfVoxelsThanMemoryShouldHoldAreRefused) {
  const TemporaryFolder folder;
  const std::shared_ptr<octomap::OcTree> tree = one_leaf(folder);
  tree->updateNode(octomap::OcTreeKey(100, 100, 32768), true);  // a voxel on top of it
  World world;
  try {
    add_octomap(world, "rock", tree, 0.6);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("expected at most ten million"), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(world.surfaces.empty());
  EXPECT_EQ(world.map, nullptr);
}

TEST(SurfacesOf, EndsWithTheTimeAllowed) {
  SyntheticCloud cloud(0.003);
  cloud.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  const Deadline passed = Deadline::after(0.0);
  PatchOptions options;
  options.deadline = passed;
  World world;
  EXPECT_THROW(add_cloud(world, "scan", cloud.points, 0.6, options), OutOfTime);
  EXPECT_THROW(bars_in(cloud.points, {.deadline = passed}), OutOfTime);
  octomap::OcTree tree(0.1);
  tree.updateNode(octomap::point3d(0.05f, 0.05f, 0.05f), true);
  EXPECT_THROW(add_octomap(world, "map", std::make_shared<octomap::OcTree>(tree), 0.6, options),
               OutOfTime);
  const TemporaryFolder folder;
  const std::filesystem::path mesh = folder.write(
      "a.stl",
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid a\n");
  EXPECT_THROW(
      add_mesh(world, "mesh", mesh, Eigen::Isometry3d::Identity(), 1.0, 0.6, {.deadline = passed}),
      OutOfTime);
  EXPECT_TRUE(world.surfaces.empty());
  EXPECT_EQ(world.map, nullptr);
}

TEST(SurfacesOf, NoVoxelStandsOutOfThePlacesThatMayBeTouched) {
  // Heights that are no multiples of the voxel, a slope, and edges of which the rectangles stop
  // short.
  SyntheticCloud cloud(0.003);
  cloud.rectangle({-1.013, -1.022, 0.013}, {2, 0, 0}, {0, 2, 0});
  cloud.rectangle({1.4, -1, 0.2}, {1, 0, 0.4}, {0, 2, 0});
  World world;
  add_cloud(world, "scan", cloud.points, 0.6);
  ASSERT_GE(world.surfaces.size(), 2u);
  if (world.map == nullptr) return;
  for (const Surface& surface : world.surfaces) {
    const Eigen::Isometry3d surface_from_world = surface.world_from_surface.inverse();
    for (auto leaf = world.map->begin_leafs(), end = world.map->end_leafs(); leaf != end; ++leaf) {
      const Eigen::Vector3d at =
          surface_from_world * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ());
      const Eigen::Vector3d reach =
          0.5 * leaf.getSize() * surface_from_world.linear().cwiseAbs().rowwise().sum();
      const bool over = std::abs(at.x()) < surface.half_x_m + reach.x() &&
                        std::abs(at.y()) < surface.half_y_m + reach.y();
      EXPECT_FALSE(over && at.z() + reach.z() > 1e-3 && at.z() < 0.5) << at.transpose();
    }
  }
}

TEST(SurfacesOf, OctomapsHaveThemOnTheFacesOfTheirVoxels) {
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() = Eigen::Vector3d(1.0, 0.0, 0.5);
  boxes[0].size = Eigen::Vector3d(0.4, 0.8, 1.0);
  const auto tree = octree_from_boxes(boxes, 0.05);
  World world;
  add_octomap(world, "hall", tree, 0.5);
  ASSERT_EQ(world.surfaces.size(), 6u);
  EXPECT_EQ(world.map, tree);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Surface& surface : world.surfaces) {
    const Eigen::Vector3d n = surface.world_from_surface.linear().col(2);
    const Eigen::Vector3d from =
        surface.world_from_surface.translation() - Eigen::Vector3d(1, 0, 0.5);
    sum += n;
    EXPECT_EQ(n.cwiseAbs().sum(), 1.0);
    EXPECT_NEAR((from - 0.5 * boxes[0].size.cwiseProduct(n)).norm(), 0.0, 1e-9) << n.transpose();
    EXPECT_NEAR(surface.world_from_surface.linear().determinant(), 1.0, 1e-12);
    const Eigen::Vector3d size = surface.world_from_surface.linear() *
                                 Eigen::Vector3d(surface.half_x_m, surface.half_y_m, 0.0);
    EXPECT_NEAR(
        (size.cwiseAbs() + 0.5 * boxes[0].size.cwiseProduct(n.cwiseAbs()) - 0.5 * boxes[0].size)
            .norm(),
        0.0, 1e-9);
  }
  EXPECT_EQ(sum, Eigen::Vector3d::Zero());
  EXPECT_EQ(world.surfaces[0].name, "hall 1");
}

TEST(SurfacesOf, OctomapsThatKnowFreeSpaceHaveThemTowardsIt) {
  std::vector<Box> boxes(1);
  boxes[0].size = Eigen::Vector3d(0.4, 0.4, 0.4);
  const auto tree = octree_from_boxes(boxes, 0.05);
  for (double x = -0.275; x < 0.3; x += 0.05)
    for (double y = -0.275; y < 0.3; y += 0.05) {
      tree->updateNode(octomap::point3d(static_cast<float>(x), static_cast<float>(y), 0.225f),
                       false);
    }
  World world;
  add_octomap(world, "hall", tree, 0.5);
  ASSERT_EQ(world.surfaces.size(), 1u);
  EXPECT_EQ(world.surfaces[0].world_from_surface.linear().col(2), Eigen::Vector3d::UnitZ());
  EXPECT_THROW(add_octomap(world, "none", nullptr, 0.5), Error);
}

TEST(SurfacesOf, ThePublicBuildingHasFloors) {
  const std::filesystem::path path =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "octomap/geb079.bt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  World world;
  add_octomap(world, "geb079", load_octree(path), 0.7);
  ASSERT_FALSE(world.surfaces.empty());
  EXPECT_GT(4 * world.surfaces[0].half_x_m * world.surfaces[0].half_y_m, 2.0);
}

void triangle(std::ostream& out, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              const Eigen::Vector3d& c) {
  out << "facet normal 0 0 0\nouter loop\n";
  for (const Eigen::Vector3d& p : {a, b, c}) out << "vertex " << p.transpose() << "\n";
  out << "endloop\nendfacet\n";
}

void quad(std::ostream& out, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
          const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  triangle(out, a, b, c);
  triangle(out, a, c, d);
}

TEST(SurfacesOf, AMeshHasThemExactlyOnItsFaces) {
  // A box of 400 x 600 x 200 mm, in millimetres, without a bottom.
  std::ostringstream text;
  text << "solid box\n";
  const auto p = [](int x, int y, int z) { return Eigen::Vector3d(400 * x, 600 * y, 200 * z); };
  quad(text, p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  quad(text, p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  quad(text, p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  quad(text, p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1));
  quad(text, p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1));
  text << "endsolid box\n";
  const TemporaryFolder folder;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(2, 1, 0.3));
  pose.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()));
  World world;
  add_mesh(world, "box", folder.write("box.stl", text.str()), pose, 0.001, 0.4);
  ASSERT_EQ(world.surfaces.size(), 5u);
  const Surface& top = world.surfaces[0];
  EXPECT_EQ(top.name, "box 1");
  EXPECT_NEAR(4 * top.half_x_m * top.half_y_m, 0.24, 1e-6);
  EXPECT_LT((top.world_from_surface.translation() - pose * Eigen::Vector3d(0.2, 0.3, 0.2)).norm(),
            1e-6);
  EXPECT_LT((top.world_from_surface.linear().col(2) - pose.linear().col(2)).norm(), 1e-6);
  EXPECT_NEAR(4 * world.surfaces[4].half_x_m * world.surfaces[4].half_y_m, 0.08, 1e-6);
  EXPECT_EQ(world.map, nullptr) << "its rectangles are all there is";
}

TEST(SurfacesOf, HolesOfAMeshAreLeftOutAndWhatIsNotFlatIsInTheMap) {
  std::ostringstream text;
  text << "solid plate\n";
  const auto p = [](double x, double y) { return Eigen::Vector3d(x, y, 0.5); };
  // A square of 1 m with a hole of 0.3 m in its middle, of four trapezia.
  quad(text, p(0, 0), p(1, 0), p(0.65, 0.35), p(0.35, 0.35));
  quad(text, p(1, 0), p(1, 1), p(0.65, 0.65), p(0.65, 0.35));
  quad(text, p(1, 1), p(0, 1), p(0.35, 0.65), p(0.65, 0.65));
  quad(text, p(0, 1), p(0, 0), p(0.35, 0.35), p(0.35, 0.65));
  triangle(text, {2, 0, 0}, {2.05, 0, 0}, {2, 0, 1});  // too narrow
  text << "endsolid plate\n";
  const TemporaryFolder folder;
  World world;
  add_mesh(world, "plate", folder.write("plate.stl", text.str()), Eigen::Isometry3d::Identity(),
           1.0, 0.0);
  EXPECT_EQ(world.surfaces.size(), 4u);
  for (const Surface& surface : world.surfaces) {
    const Eigen::Vector3d centre = surface.world_from_surface.translation();
    EXPECT_NEAR(4 * surface.half_x_m * surface.half_y_m, 0.34, 0.02);
    EXPECT_GT((centre - Eigen::Vector3d(0.5, 0.5, 0.5)).cwiseAbs().maxCoeff(), 0.3);
  }
  EXPECT_GT(height_over(world, 2.005, 0.005), 0.9);
  EXPECT_THROW(
      add_mesh(world, "plate", folder.file("plate.stl"), Eigen::Isometry3d::Identity(), 0.0, 0.0),
      Error);
}

TEST(SurfacesOf, AreAddedToWhatIsThere) {
  SyntheticCloud cloud(0.0);
  for (int i = 0; i < 30; ++i) cloud.points.emplace_back(3.01, 0.01, 0.01 * i);
  std::vector<Box> boxes(1);
  boxes[0].size = Eigen::Vector3d(0.4, 0.4, 0.4);
  World world;
  add_octomap(world, "box", octree_from_boxes(boxes, 0.1), 0.5);
  add_cloud(world, "scan", cloud.points, 0.5);
  EXPECT_NEAR(height_over(world, 0.01, 0.01), 0.2, 1e-6);
  EXPECT_NEAR(height_over(world, 3.01, 0.01), 0.3, 1e-6);
  EXPECT_NEAR(world.map->getResolution(), 0.05, 1e-12);
  const std::vector<Eigen::Vector3d> far(20, Eigen::Vector3d(5000, 0, 0));
  const std::shared_ptr<const octomap::OcTree> before = world.map;
  EXPECT_THROW(add_cloud(world, "far", far, 0.5), Error);
  EXPECT_EQ(world.map, before);
}

}  // namespace
}  // namespace locograph
