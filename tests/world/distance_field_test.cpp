#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>

#include <cmath>
#include <cstring>
#include <random>

namespace locograph {
namespace {

constexpr double kResolution = 0.05;

struct Cubes {
  std::vector<Eigen::Vector3d> occupied, free;  // centres, of all voxels of a block
};

double cube_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d excess =
      (p - centre).cwiseAbs() - Eigen::Vector3d::Constant(0.5 * kResolution);
  return excess.cwiseMax(0.0).norm();
}

// Signed distance to the union of the occupied cubes by looking at all of them.
double brute_force(const Cubes& cubes, const Eigen::Vector3d& p) {
  double outside = 1e9, inside = 1e9;
  for (const Eigen::Vector3d& c : cubes.occupied) outside = std::min(outside, cube_distance(p, c));
  if (outside > 0.0) return outside;
  for (const Eigen::Vector3d& c : cubes.free) inside = std::min(inside, cube_distance(p, c));
  return -inside;
}

std::shared_ptr<octomap::OcTree> voxels(const std::vector<Eigen::Vector3d>& centres) {
  std::shared_ptr<octomap::OcTree> tree = std::make_shared<octomap::OcTree>(kResolution);
  for (const Eigen::Vector3d& c : centres)
    tree->setNodeValue(c.x(), c.y(), c.z(), tree->getClampingThresMaxLog(), true);
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

// n^3 voxels about the origin, the first of `occupied(i, j, k)`, surrounded by free space.
template <class Predicate>
Cubes cubes_of(int n, Predicate occupied) {
  Cubes cubes;
  const int margin = 2;
  for (int i = -margin; i < n + margin; ++i)
    for (int j = -margin; j < n + margin; ++j)
      for (int k = -margin; k < n + margin; ++k) {
        const Eigen::Vector3d centre =
            kResolution * Eigen::Vector3d(i + 0.5 - n / 2, j + 0.5 - n / 2, k + 0.5 - n / 2);
        const bool within = std::min({i, j, k}) >= 0 && std::max({i, j, k}) < n;
        (within && occupied(i, j, k) ? cubes.occupied : cubes.free).push_back(centre);
      }
  return cubes;
}

struct Excess {
  double largest = -1e9, mean = 0.0;
};

// value - truth over random points, of which half lie near a voxel's corners, edges or faces.
Excess excess(const Cubes& cubes, double max_distance, int points, unsigned seed, double reach) {
  DistanceFieldOptions options;
  options.max_distance_m = max_distance;
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied), options);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  Excess result;
  for (int i = 0; i < points; ++i) {
    Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    if (i % 2) p = (p * (2.0 / kResolution)).array().round() * (0.5 * kResolution) + 1e-6;
    const double truth = std::min(brute_force(cubes, p), max_distance);
    const double difference = field.distance(p) - truth;
    result.largest = std::max(result.largest, difference);
    result.mean += difference / points;
  }
  return result;
}

TEST(DistanceField, IsNeverAboveTheTrueDistanceToRandomVoxels) {
  unsigned seed = 0;
  for (double density : {0.002, 0.02, 0.2, 0.5, 0.9}) {
    std::mt19937 random(++seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const Cubes cubes = cubes_of(14, [&](int, int, int) { return uniform(random) < density; });
    const Excess found = excess(cubes, 0.5, 3000, seed, 0.8);
    EXPECT_LE(found.largest, 1e-6) << "density " << density;
    EXPECT_GE(found.mean, -0.9 * kResolution) << "density " << density;
  }
}

TEST(DistanceField, IsNeverAboveTheTrueDistanceToSolidBodies) {
  unsigned seed = 10;
  const auto ball = [](int i, int j, int k) { return std::hypot(i - 6.5, j - 6.0, k - 7.0) < 5.5; };
  const auto slanted = [](int i, int j, int k) { return i + 2 * j + 3 * k < 40; };
  const auto shell = [](int i, int j, int k) {
    const double r = std::hypot(i - 6.5, j - 6.5, k - 6.5);
    return r < 7 && r > 4;
  };
  const auto slab = [](int i, int, int) { return i < 7; };
  for (const Cubes& cubes :
       {cubes_of(14, ball), cubes_of(14, slanted), cubes_of(14, shell), cubes_of(14, slab)}) {
    const Excess found = excess(cubes, 0.6, 3000, ++seed, 1.0);
    EXPECT_LE(found.largest, 1e-6) << "body " << seed;
    EXPECT_GE(found.mean, -0.9 * kResolution) << "body " << seed;
  }
}

TEST(DistanceField, StaysBelowTheTruthFarFromScatteredVoxels) {
  // Few voxels, long waves: where a propagated transform could hand on the wrong neighbour.
  for (unsigned seed = 30; seed < 36; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> coordinate(0, 39);
    std::vector<std::array<int, 3>> chosen(12);
    for (std::array<int, 3>& c : chosen)
      c = {coordinate(random), coordinate(random), coordinate(random)};
    const Cubes cubes = cubes_of(40, [&](int i, int j, int k) {
      return std::find(chosen.begin(), chosen.end(), std::array<int, 3>{i, j, k}) != chosen.end();
    });
    const Excess found = excess(cubes, 1.5, 4000, seed, 1.8);
    EXPECT_LE(found.largest, 1e-6) << "seed " << seed;
    EXPECT_GE(found.mean, -0.9 * kResolution) << "seed " << seed;
  }
}

TEST(DistanceField, SeesAFlatWallAConstantSixTenthsOfAVoxelTooEarly) {
  const Cubes cubes = cubes_of(16, [](int i, int, int) { return i < 8; });
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied));
  for (double x = -0.15; x < 0.3; x += 0.013) {
    const DistanceSample sample = field.sample(Eigen::Vector3d(x, 0.011, -0.023));
    EXPECT_NEAR(sample.distance, x - 0.6218 * kResolution, 1e-5);
    EXPECT_TRUE(sample.gradient.isApprox(Eigen::Vector3d::UnitX(), 1e-5));
  }
}

TEST(DistanceField, HasAGradientDeepInsideAnObstacle) {
  const Cubes cubes = cubes_of(30, [](int, int, int) { return true; });  // a 1.5 m cube
  DistanceFieldOptions options;
  options.max_distance_m = 0.2;
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied), options);
  const DistanceSample sample = field.sample(Eigen::Vector3d(0.31, 0.02, -0.01));
  EXPECT_NEAR(sample.distance, -0.44, kResolution);
  EXPECT_TRUE(sample.gradient.isApprox(Eigen::Vector3d::UnitX(), 1e-5));
}

TEST(DistanceField, GradientIsTheDerivativeOfTheValue) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  const Cubes cubes = cubes_of(14, [&](int, int, int) { return unit(random) < 0.1; });
  DistanceFieldOptions options;
  options.max_distance_m = 0.3;
  options.lower = Eigen::Vector3d::Constant(-0.6);
  options.upper = Eigen::Vector3d::Constant(0.6);
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied), options);
  int inside = 0, outside = 0;
  const double step = 1e-6;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3d cell = (p - field.lower()) / kResolution;
    const Eigen::Vector3d off_face = cell - Eigen::Vector3d(cell.array().round());
    if (off_face.cwiseAbs().minCoeff() < 1e-3) continue;
    const DistanceSample sample = field.sample(p);
    EXPECT_EQ(sample.distance, field.distance(p));
    if (sample.distance > field.max_distance() - 1e-3) continue;
    (Eigen::AlignedBox3d(field.lower(), field.upper()).contains(p) ? inside : outside) += 1;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d h = step * Eigen::Vector3d::Unit(axis);
      const double numeric = (field.distance(p + h) - field.distance(p - h)) / (2 * step);
      EXPECT_NEAR(sample.gradient[axis], numeric, 1e-4) << p.transpose();
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

TEST(DistanceField, IsContinuousAcrossItsBorder) {
  const Cubes cubes = cubes_of(6, [](int i, int j, int) { return i + j < 7; });
  DistanceFieldOptions options;
  options.max_distance_m = 1.0;
  options.lower = Eigen::Vector3d::Constant(-0.2);
  options.upper = Eigen::Vector3d::Constant(0.2);
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied), options);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-0.22, 0.22);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    p[i % 3] = i % 2 ? field.upper()[i % 3] : field.lower()[i % 3];
    const Eigen::Vector3d step = 1e-7 * Eigen::Vector3d::Unit(i % 3);
    EXPECT_NEAR(field.distance(p + step), field.distance(p - step), 1e-6);
  }
}

TEST(DistanceField, SaturatesAtTheLargestDistanceWithoutGradient) {
  const Cubes cubes = cubes_of(2, [](int, int, int) { return true; });
  DistanceFieldOptions options;
  options.max_distance_m = 0.3;
  options.lower = Eigen::Vector3d::Constant(-1);
  options.upper = Eigen::Vector3d::Constant(1);
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied), options);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.7, 0, 0), Eigen::Vector3d(-5, 3, 2)}) {
    EXPECT_EQ(field.sample(p).distance, 0.3);
    EXPECT_EQ(field.sample(p).gradient, Eigen::Vector3d::Zero());
  }
  EXPECT_LT(field.distance(Eigen::Vector3d(0.2, 0, 0)), 0.2);
}

TEST(DistanceField, CountsObstaclesOutsideTheBox) {
  DistanceFieldOptions options;
  options.lower = Eigen::Vector3d(0.5, -0.5, -0.5);
  options.upper = Eigen::Vector3d(1.5, 0.5, 0.5);
  const Cubes cubes = cubes_of(4, [](int, int, int) { return true; });  // up to x = 0.1
  const DistanceField field = DistanceField::from_octree(*voxels(cubes.occupied), options);
  ASSERT_FALSE(field.empty());
  const Eigen::Vector3d p(0.7, 0.01, 0.02);
  EXPECT_NEAR(field.distance(p), 0.6, 0.7 * kResolution);
  EXPECT_LE(field.distance(p), 0.6);
  options.lower->x() = 4.0;
  options.upper->x() = 5.0;
  EXPECT_TRUE(DistanceField::from_octree(*voxels(cubes.occupied), options).empty());
}

TEST(DistanceField, OfAnEmptyMapIsTheLargestDistanceEverywhere) {
  const DistanceField field = DistanceField::from_octree(octomap::OcTree(0.05));
  EXPECT_TRUE(field.empty());
  EXPECT_EQ(field.sample(Eigen::Vector3d(1, 2, 3)).distance, 1.0);
  EXPECT_EQ(field.sample(Eigen::Vector3d(1, 2, 3)).gradient, Eigen::Vector3d::Zero());
}

TEST(DistanceField, LeavesOutTheFloorBelowGroundHeight) {
  // A floor of two layers whose top is z = 0, and a block standing on it.
  std::vector<Box> boxes(2);
  boxes[0].world_from_box.translation().z() = -0.05;
  boxes[0].size = Eigen::Vector3d(3, 3, 0.1);
  boxes[1].world_from_box.translation() = Eigen::Vector3d(0.5, 0, 0.2);
  boxes[1].size = Eigen::Vector3d(0.2, 0.2, 0.4);
  const std::shared_ptr<octomap::OcTree> tree = octree_from_boxes(boxes, kResolution);
  DistanceFieldOptions options;
  const Eigen::Vector3d over_floor(-0.5, 0, 0.2), near_block(0.2, 0.01, 0.2);
  EXPECT_LT(DistanceField::from_octree(*tree, options).distance(over_floor), 0.2);
  options.ground_z = 0.0;
  const DistanceField field = DistanceField::from_octree(*tree, options);
  EXPECT_GT(field.distance(over_floor), 0.8);
  EXPECT_NEAR(field.distance(near_block), 0.2, 0.7 * kResolution);
  options.ground_z = 10.0;
  EXPECT_TRUE(DistanceField::from_octree(*tree, options).empty());
}

TEST(DistanceField, CanTakeUnknownSpaceAsOccupied) {
  octomap::OcTree tree(kResolution);
  for (int i = -10; i < 10; ++i)
    for (int j = -10; j < 10; ++j)
      for (int k = -10; k < 10; ++k)
        tree.updateNode((i + 0.5) * kResolution, (j + 0.5) * kResolution, (k + 0.5) * kResolution,
                        false);
  DistanceFieldOptions options;
  options.lower = Eigen::Vector3d::Constant(-0.6);
  options.upper = Eigen::Vector3d::Constant(0.6);
  EXPECT_TRUE(DistanceField::from_octree(tree, options).empty());
  options.unknown_is_occupied = true;
  const DistanceField field = DistanceField::from_octree(tree, options);
  EXPECT_NEAR(field.distance(Eigen::Vector3d(0.2, 0.01, 0.02)), 0.3, 0.7 * kResolution);
  EXPECT_LT(field.distance(Eigen::Vector3d(0.55, 0, 0)), -0.04);
}

TEST(DistanceField, IsTheSameBitByBitWhenBuiltTwice) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Cubes cubes = cubes_of(20, [&](int, int, int) { return uniform(random) < 0.1; });
  const DistanceField one = DistanceField::from_octree(*voxels(cubes.occupied));
  const DistanceField two = DistanceField::from_octree(*voxels(cubes.occupied));
  ASSERT_EQ(one.values().size(), two.values().size());
  EXPECT_EQ(std::memcmp(one.values().data(), two.values().data(), one.values().size_bytes()), 0);
}

TEST(DistanceField, RefusesOptionsThatMakeNoSense) {
  const octomap::OcTree tree(0.05);
  DistanceFieldOptions options;
  options.max_distance_m = 0.0;
  EXPECT_THROW(DistanceField::from_octree(tree, options), Error);
  options = {};
  options.lower = Eigen::Vector3d::Zero();
  EXPECT_THROW(DistanceField::from_octree(tree, options), Error);
  options.upper = Eigen::Vector3d(1, -1, 1);
  EXPECT_THROW(DistanceField::from_octree(tree, options), Error);
  options.upper = Eigen::Vector3d(1, std::nan(""), 1);
  EXPECT_THROW(DistanceField::from_octree(tree, options), Error);
  const Cubes cubes = cubes_of(2, [](int, int, int) { return true; });
  options.upper = Eigen::Vector3d(1000, 1000, 1000);
  EXPECT_THROW(DistanceField::from_octree(*voxels(cubes.occupied), options), Error);
}

TEST(DistanceField, CoversPartOfThePublicBuildingMap) {
  const std::filesystem::path path =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "octomap/geb079.bt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const std::shared_ptr<octomap::OcTree> tree = load_octree(path);
  const Eigen::Vector3d middle = octree_info(*tree).occupied_bounds.center();
  DistanceFieldOptions options;
  options.lower = middle - Eigen::Vector3d(2, 2, 1);
  options.upper = middle + Eigen::Vector3d(2, 2, 1);
  const DistanceField field = DistanceField::from_octree(*tree, options);
  ASSERT_FALSE(field.empty());
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::AlignedBox3d> leaves;
  for (octomap::OcTree::leaf_iterator leaf = tree->begin_leafs(); leaf != tree->end_leafs();
       ++leaf) {
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * leaf.getSize());
    if (tree->isNodeOccupied(*leaf)) leaves.emplace_back(centre - half, centre + half);
  }
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p =
        middle + Eigen::Vector3d(2 * uniform(random), 2 * uniform(random), uniform(random));
    double truth = field.max_distance();
    for (const Eigen::AlignedBox3d& leaf : leaves)
      truth = std::min(truth, leaf.exteriorDistance(p));
    EXPECT_LE(field.distance(p), truth + 1e-6);
  }
}

TEST(WorldDistance, OfAMapTooLargeForAFieldIsThatToItsLeaves) {
  World world;
  const auto tree = std::make_shared<octomap::OcTree>(0.1);
  tree->updateNode(octomap::point3d(0.05f, 0.05f, 0.05f), true);
  world.map = tree;
  DistanceFieldOptions options;
  options.max_distance_m = 0.3;
  EXPECT_FALSE(distance_view(world, options).leaves);
  tree->updateNode(octomap::point3d(1000.05f, 1000.05f, 0.05f), true);
  const WorldDistance view = distance_view(world, options);
  EXPECT_FALSE(view.map);
  ASSERT_TRUE(view.leaves);
  EXPECT_TRUE(view.sees_map());
  const DistanceSample beside = view.sample({0.3, 0.05, 0.06}, 0.0);
  EXPECT_NEAR(beside.distance, 0.2, 1e-8);
  EXPECT_TRUE(beside.gradient.isApprox(Eigen::Vector3d::UnitX(), 1e-6));
  const DistanceSample inside = view.sample({0.06, 0.05, 0.01}, 0.0);
  EXPECT_NEAR(inside.distance, -0.01, 1e-8);
  EXPECT_TRUE(inside.gradient.isApprox(-Eigen::Vector3d::UnitZ(), 1e-6));
  const DistanceSample away = view.sample({0.5, 0.05, 0.06}, 0.0);
  EXPECT_EQ(away.distance, 0.3);
  EXPECT_EQ(away.gradient, Eigen::Vector3d::Zero());
  options.ground_z = 0.1;
  EXPECT_EQ(distance_view(world, options).distance({0.05, 0.05, 0.15}, 0.0), 0.3) << "the floor";
}

TEST(WorldDistance, IsTheSmallerOfMapAndObstacles) {
  const Cubes cubes = cubes_of(4, [](int, int, int) { return true; });
  WorldDistance world;
  world.map = std::make_shared<DistanceField>(DistanceField::from_octree(*voxels(cubes.occupied)));
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size = Eigen::Vector3d(0.1, 0, 0);
  ball.world_from_obstacle.translation() = Eigen::Vector3d(2, 0, 0);
  ball.motion.push_back({1.0, Eigen::Isometry3d(Eigen::Translation3d(0.6, 0, 0))});
  world.obstacles.push_back(ball);
  const Eigen::Vector3d p(0.4, 0.01, 0.01);
  EXPECT_EQ(world.distance(p, 0.0), world.map->distance(p));
  EXPECT_EQ(world.distance(p, 1.0), ball.distance(p, 1.0));
  EXPECT_EQ(world.sample(p, 1.0).gradient, ball.sample(p, 1.0).gradient);
  world.map.reset();
  EXPECT_EQ(world.distance(p, 0.0), 1.0);
  EXPECT_EQ(world.sample(p, 0.0).gradient, Eigen::Vector3d::Zero());
  EXPECT_EQ(world.distance(p, 1.0), ball.distance(p, 1.0));
  world.obstacles[0].vanishes_s = 0.9;
  EXPECT_EQ(world.distance(p, 1.0), 1.0);
  EXPECT_EQ(world.sample(p, 1.0).gradient, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace locograph
