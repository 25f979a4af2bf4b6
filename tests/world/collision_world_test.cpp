#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/octree.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

constexpr double kVoxel = 0.05;

// Five links hanging on the first one by joints: ball, rod (a capsule: cylinder and two spheres),
// can, box, wedge (a mesh).
std::string urdf() {
  const std::string head =
      "<link name='ball'><collision><geometry><sphere radius='0.1'/>"
      "</geometry></collision></link>";
  const std::string rod =
      "<link name='rod'><collision><geometry><cylinder radius='0.05' length='0.4'/></geometry>"
      "</collision><collision><origin xyz='0 0 0.2'/><geometry><sphere radius='0.05'/></geometry>"
      "</collision><collision><origin xyz='0 0 -0.2'/><geometry><sphere radius='0.05'/>"
      "</geometry></collision></link>";
  const std::string can =
      "<link name='can'><collision><geometry><cylinder radius='0.1' "
      "length='0.3'/></geometry></collision></link>";
  const std::string box =
      "<link name='box'><collision><geometry><box size='0.2 0.1 0.3'/>"
      "</geometry></collision></link>";
  const std::string wedge =
      "<link name='wedge'><collision><geometry><mesh filename='wedge.stl' "
      "scale='1 1 2'/></geometry></collision></link>";
  const auto joint = [](const std::string& child) {
    return "<joint name='to_" + child + "' type='revolute'><parent link='ball'/><child link='" +
           child +
           "'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='1'/>"
           "</joint>";
  };
  return "<?xml version='1.0'?><robot name='parts'>" + head + rod + can + box + wedge +
         joint("rod") + joint("can") + joint("box") + joint("wedge") + "</robot>";
}

const char* const kWedge =
    "solid w\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0.2 0 0\nvertex 0 0.2 0\n"
    "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0.2 0 0\n"
    "vertex 0 0 0.1\nendloop\nendfacet\nendsolid w\n";

class CollisionWorldTest : public testing::Test {
 protected:
  CollisionWorldTest()
      : wedge_(folder_.write("wedge.stl", kWedge)),
        robot_(Robot::load(folder_.write("parts.urdf", urdf()))),
        far_(robot_.links().size(), Eigen::Isometry3d(Eigen::Translation3d(50, 50, 50))) {
    // Apart from each other as well.
    for (std::size_t i = 0; i < far_.size(); ++i)
      far_[i].translation().x() += 5.0 * static_cast<double>(i);
  }

  int link(const char* name) const { return robot_.link_index(name); }

  std::vector<Eigen::Isometry3d> with(const char* name, const Eigen::Isometry3d& pose) const {
    std::vector<Eigen::Isometry3d> poses = far_;
    poses[link(name)] = pose;
    return poses;
  }
  std::vector<Eigen::Isometry3d> with(const char* name, double x, double y, double z) const {
    return with(name, Eigen::Isometry3d(Eigen::Translation3d(x, y, z)));
  }

  std::vector<ConvexShape> shapes() const {
    return {ConvexShape::sphere(0.1), ConvexShape::capsule(0.05, 0.4),
            ConvexShape::cylinder(0.1, 0.3), ConvexShape::box(Eigen::Vector3d(0.2, 0.1, 0.3)),
            ConvexShape::hull({{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}})};
  }
  const std::vector<const char*> names_{"ball", "rod", "can", "box", "wedge"};

  TemporaryFolder folder_;
  std::filesystem::path wedge_;
  Robot robot_;
  std::vector<Eigen::Isometry3d> far_;
};

std::shared_ptr<octomap::OcTree> block(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() = 0.5 * (lower + upper);
  boxes[0].size = upper - lower;
  return octree_from_boxes(boxes, kVoxel);
}

Eigen::Isometry3d random_pose(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector4d q(uniform(random), uniform(random), uniform(random), uniform(random));
  pose.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
  pose.translation() = reach * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  return pose;
}

TEST_F(CollisionWorldTest, DistancesToABlockOfVoxelsAreTheAnalyticOnes) {
  const CollisionWorld world(robot_, block({0, 0, 0}, {0.5, 0.5, 0.5}), {});
  const auto distance = [&](const std::vector<Eigen::Isometry3d>& poses) {
    return world.environment_distance(poses, 0.0).distance_m;
  };
  EXPECT_NEAR(distance(with("ball", -0.3, 0.2, 0.2)), 0.2, 1e-9);
  EXPECT_NEAR(distance(with("ball", -0.3, -0.4, 0.2)), 0.4, 1e-9);
  EXPECT_NEAR(distance(with("ball", -0.06, 0.23, 0.23)), -0.04, 1e-9);
  EXPECT_NEAR(distance(with("rod", 0.23, 0.23, 0.85)), 0.1, 1e-9);
  EXPECT_NEAR(distance(with("rod", -0.1, 0.23, 0.23)), 0.05, 1e-9);
  EXPECT_NEAR(distance(with("can", 0.23, 0.23, 0.75)), 0.1, 1e-5);
  EXPECT_NEAR(distance(with("can", -0.2, 0.23, 0.23)), 0.1, 1e-5);
  EXPECT_NEAR(distance(with("box", -0.2, 0.23, 0.23)), 0.1, 1e-5);
  EXPECT_NEAR(distance(with("box", -0.2, -0.15, 0.23)), std::hypot(0.1, 0.1), 1e-5);
  EXPECT_NEAR(distance(with("wedge", 0.13, 0.13, 0.6)), 0.1, 1e-5);
  EXPECT_NEAR(distance(with("wedge", 0.13, 0.13, -0.3)), 0.1, 1e-5);  // scaled to 0.2 high
}

TEST_F(CollisionWorldTest, SaysWhichLinkAndWhereItIsNearest) {
  const CollisionWorld world(robot_, block({0, 0, 0}, {0.5, 0.5, 0.5}), {});
  const CollisionWorld::Closest closest =
      world.environment_distance(with("rod", -0.25, 0.23, 0.9), 0.0);
  EXPECT_EQ(closest.link, link("rod"));
  EXPECT_EQ(closest.what, "voxel");
  const Eigen::Vector3d towards = Eigen::Vector3d(0.25, 0, -0.2).normalized();
  EXPECT_TRUE(closest.point.isApprox(Eigen::Vector3d(-0.25, 0.23, 0.7) + 0.05 * towards, 1e-9));
}

TEST_F(CollisionWorldTest, NothingWithinTheCutOffIsNoLink) {
  const CollisionWorld world(robot_, block({0, 0, 0}, {0.5, 0.5, 0.5}), {});
  const CollisionWorld::Closest closest = world.environment_distance(far_, 0.0);
  EXPECT_EQ(closest.distance_m, 0.5);
  EXPECT_EQ(closest.link, -1);
  EXPECT_EQ(closest.what, "");
  EXPECT_EQ(CollisionWorld(robot_, World()).environment_distance(far_, 0.0).link, -1);
  CollisionWorldOptions options;
  options.cutoff_m = 2.0;
  EXPECT_NEAR(CollisionWorld(robot_, block({0, 0, 0}, {0.5, 0.5, 0.5}), {}, options)
                  .environment_distance(with("ball", -1.6, 0.2, 0.2), 0.0)
                  .distance_m,
              1.5, 1e-9);
}

TEST_F(CollisionWorldTest, AgreesWithBruteForceOverAllVoxels) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.8, 0.8);
  octomap::OcTree scattered(kVoxel);
  for (int i = 0; i < 150; ++i)
    scattered.setNodeValue(uniform(random), uniform(random), uniform(random), 3.5f, true);
  for (int i = 0; i < 8; ++i)  // one larger leaf
    scattered.setNodeValue(0.225 + 0.05 * (i & 1), 0.225 + 0.05 * (i >> 1 & 1),
                           0.225 + 0.05 * (i >> 2), 3.5f, true);
  scattered.updateInnerOccupancy();
  scattered.prune();
  const std::shared_ptr<octomap::OcTree> tree = std::make_shared<octomap::OcTree>(scattered);
  std::vector<Eigen::Vector4d> leaves;
  for (octomap::OcTree::leaf_iterator leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf)
    leaves.emplace_back(leaf.getX(), leaf.getY(), leaf.getZ(), leaf.getSize());

  const CollisionWorld world(robot_, tree, {});
  const std::vector<ConvexShape> shapes = this->shapes();
  int apart = 0, touching = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t kind = static_cast<std::size_t>(i % 5);
    const Eigen::Isometry3d pose = random_pose(random, 1.0);
    double expected = 0.5;
    for (const Eigen::Vector4d& leaf : leaves) {
      const Eigen::Isometry3d at(Eigen::Translation3d(Eigen::Vector3d(leaf.head<3>())));
      const ConvexShape cube = ConvexShape::box(Eigen::Vector3d::Constant(leaf[3]));
      expected = std::min(expected, shape_distance(shapes[kind], pose, cube, at).distance);
    }
    const CollisionWorld::Closest found = world.environment_distance(with(names_[kind], pose), 0.0);
    (expected > 0.0 ? apart : touching) += 1;
    if (expected > 0.0 || kind < 2) {
      EXPECT_NEAR(found.distance_m, expected, 2e-5) << names_[kind];
    } else {  // FCL's depths depend on how the numbers round
      EXPECT_LT(found.distance_m, 0.0) << names_[kind];
    }
  }
  EXPECT_GT(apart, 200);
  EXPECT_GT(touching, 100);
}

TEST_F(CollisionWorldTest, StopsEarlyOnlyBelowTheGivenDistance) {
  const CollisionWorld world(robot_, block({0, 0, 0}, {0.5, 0.5, 0.5}), {});
  const std::vector<Eigen::Isometry3d> poses = with("ball", -0.3, 0.2, 0.2);
  EXPECT_NEAR(world.environment_distance(poses, 0.0, 0.1).distance_m, 0.2, 1e-9);
  const double stopped = world.environment_distance(poses, 0.0, 0.4).distance_m;
  EXPECT_LT(stopped, 0.4);
  EXPECT_GE(stopped, 0.2 - 1e-9);
}

TEST_F(CollisionWorldTest, FollowsMovingObstacles) {
  Obstacle cart;
  cart.name = "cart";
  cart.size = Eigen::Vector3d(0.2, 0.4, 0.4);
  cart.world_from_obstacle.translation() = Eigen::Vector3d(1.0, 0, 0);
  cart.motion.push_back({2.0, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0, 0))});
  Obstacle ball;
  ball.name = "globe";
  ball.shape = Obstacle::Shape::kSphere;
  ball.size = Eigen::Vector3d(0.2, 0, 0);
  ball.world_from_obstacle.translation() = Eigen::Vector3d(0, 0.6, 0);
  Obstacle pillar;
  pillar.name = "pillar";
  pillar.shape = Obstacle::Shape::kCylinder;
  pillar.size = Eigen::Vector3d(0.1, 1.0, 0);
  pillar.world_from_obstacle.translation() = Eigen::Vector3d(0, -3, 0);
  const CollisionWorld world(robot_, nullptr, {cart, ball, pillar});
  const std::vector<Eigen::Isometry3d> poses = with("ball", 0.1, 0, 0);
  const CollisionWorld::Closest start = world.environment_distance(poses, 0.0);
  EXPECT_EQ(start.what, "globe");
  EXPECT_NEAR(start.distance_m, std::hypot(0.1, 0.6) - 0.3, 1e-9);
  const CollisionWorld::Closest later = world.environment_distance(poses, 1.2);
  EXPECT_EQ(later.what, "cart");
  EXPECT_NEAR(later.distance_m, 0.4 - 0.1 - 0.1 - 0.1, 1e-9);
  EXPECT_NEAR(world.environment_distance(poses, 1.5).distance_m, -0.05, 1e-9);
  EXPECT_NEAR(world.environment_distance(with("rod", 0.4, -3, 0), 0.0).distance_m, 0.25, 1e-5);
  EXPECT_EQ(world.environment_distance(with("rod", 0.4, -3, 0), 0.0).what, "pillar");
}

TEST_F(CollisionWorldTest, MeetsObstaclesOnlyWhileTheyAreThere) {
  Obstacle globe;
  globe.name = "globe";
  globe.shape = Obstacle::Shape::kSphere;
  globe.size = Eigen::Vector3d(0.2, 0, 0);
  globe.appears_s = 1.0;
  globe.vanishes_s = 2.0;
  const CollisionWorld world(robot_, nullptr, {globe});
  const std::vector<Eigen::Isometry3d> poses = with("ball", 0.1, 0, 0);
  for (const double time_s : {0.0, std::nextafter(1.0, 0.0), 1.0, 2.0, std::nextafter(2.0, 3.0)}) {
    const bool there = time_s >= 1.0 && time_s <= 2.0;
    EXPECT_EQ(world.environment_distance(poses, time_s).distance_m < 0.0, there) << time_s;
    const CollisionWorld::Surroundings around =
        world.surroundings({.world_from_link = poses, .time_s = time_s});
    EXPECT_EQ(around.obstacle.distance_m < 0.0, there) << time_s;
    EXPECT_EQ(around.obstacle.what, there ? "globe" : "");
  }
}

TEST_F(CollisionWorldTest, LinksThatMayTouchTheFloorSeeOnlyWhatRisesAboveIt) {
  std::vector<Box> boxes(2);
  boxes[0].world_from_box.translation().z() = -0.1;
  boxes[0].size = Eigen::Vector3d(3, 3, 0.2);
  boxes[1].world_from_box.translation() = Eigen::Vector3d(0.8, 0, 0);  // through the floor
  boxes[1].size = Eigen::Vector3d(0.4, 0.4, 0.8);
  const std::shared_ptr<octomap::OcTree> tree = octree_from_boxes(boxes, kVoxel);
  CollisionWorldOptions options;
  options.ignore_floor_links = {link("ball")};
  const CollisionWorld world(robot_, tree, {}, options);
  const auto distance = [&](const char* name, double x, double z) {
    return world.environment_distance(with(name, x, 0.02, z), 0.0).distance_m;
  };
  EXPECT_EQ(distance("ball", -0.5, 0.1), 0.5);
  EXPECT_NEAR(distance("ball", 0.4, 0.1), 0.1, 1e-9);
  // Beside the floor's edge the part of the block below z = 0 does not count either.
  EXPECT_NEAR(distance("ball", 0.4, -0.3), std::hypot(0.2, 0.3) - 0.1, 1e-9);
  EXPECT_NEAR(distance("rod", -0.5, 0.35), 0.1, 1e-9);
}

TEST_F(CollisionWorldTest, AFloorThatCutsThroughALargeLeafLeavesItsUpperPart) {
  const std::shared_ptr<octomap::OcTree> tree = block({0, 0, 0}, {0.4, 0.4, 0.4});
  ASSERT_EQ(octree_info(*tree).occupied_leaves, 1u);
  CollisionWorldOptions options;
  options.ignore_floor_links = {link("ball")};
  options.floor_z_m = 0.12;  // voxels end at 0.1 and 0.15
  const CollisionWorld world(robot_, tree, {}, options);
  EXPECT_NEAR(world.environment_distance(with("ball", -0.3, 0.2, -0.1), 0.0).distance_m,
              std::hypot(0.3, 0.2) - 0.1, 1e-9);
  EXPECT_NEAR(world.environment_distance(with("rod", -0.3, 0.2, -0.1), 0.0).distance_m, 0.25, 1e-9);
}

TEST_F(CollisionWorldTest, SelfDistanceIsTheNearestPairOfLinks) {
  const CollisionWorld world(robot_, World());
  EXPECT_EQ(world.self_distance(far_).link, -1);
  const std::vector<ConvexShape> shapes = this->shapes();
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t k = 0; k < far_.size(); ++k) poses.push_back(random_pose(random, 1.0));
    double expected = 0.5;
    int first = -1, second = -1;
    for (const auto& [a, b] : robot_.self_collision_pairs()) {
      const auto shape = [&](int l) {
        return shapes[static_cast<std::size_t>(
            std::find(names_.begin(), names_.end(), robot_.links()[l].name) - names_.begin())];
      };
      const double d = shape_distance(shape(a), poses[a], shape(b), poses[b]).distance;
      if (d >= expected) continue;
      expected = d;
      first = a;
      second = b;
    }
    const CollisionWorld::Closest found = world.self_distance(poses);
    EXPECT_NEAR(found.distance_m, expected, 1e-9);
    EXPECT_EQ(found.link, first);
    EXPECT_EQ(found.other_link, second);
    EXPECT_EQ(found.what, second < 0 ? "" : robot_.links()[second].name);
  }
}

TEST_F(CollisionWorldTest, WrongNumbersOfPosesAndMissingMeshesAreErrors) {
  const CollisionWorld world(robot_, World());
  EXPECT_THROW(world.environment_distance({}, 0.0), Error);
  EXPECT_THROW(world.self_distance(std::span(far_).first(2)), Error);
  CollisionWorldOptions options;
  options.ignore_floor_links = {99};
  EXPECT_THROW(CollisionWorld(robot_, World(), options), Error);
  options = {};
  options.cutoff_m = 0.0;
  EXPECT_THROW(CollisionWorld(robot_, World(), options), Error);

  std::filesystem::remove(wedge_);
  const Robot incomplete = Robot::load(folder_.file("parts.urdf"));
  try {
    const CollisionWorld none(incomplete, World());
    ADD_FAILURE() << "a missing mesh was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("wedge.stl"), std::string::npos);
    EXPECT_EQ(error.line(), 1);
  }
}

}  // namespace
}  // namespace locograph
