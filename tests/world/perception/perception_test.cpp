#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/perception.h>
#include <locograph/world/voxel_tree.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "world/perception/small_camera_robot.h"

namespace locograph {
namespace {

using test::camera_robot;
using test::kHeight;
using test::kWidth;
using test::small_camera;
using test::standing_at;
using test::wall_image;

/// A perception whose robot stands at x = 0, z = 1 from 0 to 1 s.
struct Seeing {
  std::shared_ptr<const Robot> robot = camera_robot();
  Perception perception;

  explicit Seeing(World known = {}, const PerceptionOptions& options = {})
      : perception(robot, {small_camera(*robot)}, std::move(known), options) {
    perception.configuration(0.0, standing_at(*robot, 0.0));
    perception.configuration(1.0, standing_at(*robot, 0.0));
  }
  double distance(const Eigen::Vector3d& point) const {
    return perception.newest()->distance().distance(point, 0.0);
  }
};

std::shared_ptr<const octomap::OcTree> box_map(const Eigen::Vector3d& centre, double voxel_m) {
  Box box;
  box.world_from_box.translation() = centre;
  box.size.setConstant(0.3);
  return octree_from_boxes({&box, 1}, voxel_m);
}

Eigen::AlignedBox3d box_of(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  return {lower, upper};
}

/// The text of the Error that f throws.
std::string refusal(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Perception, SeesAWallAndForgetsItWhenItIsGone) {
  Seeing seeing;
  const Eigen::Vector3d at_wall(1.52, 0.0, 1.0), before(1.0, 0.0, 1.0);
  EXPECT_EQ(seeing.distance(at_wall), 1.0) << "nothing was seen yet";
  std::shared_ptr<const WorldSnapshot> seen;
  for (int k = 0; k < 5; ++k) seen = seeing.perception.image(wall_image(0.1 * k, 1.52));
  EXPECT_EQ(seen, seeing.perception.newest());
  EXPECT_DOUBLE_EQ(seen->stamp_s(), 0.4);
  EXPECT_LT(seeing.distance(at_wall), 0.0);
  EXPECT_NEAR(seeing.distance(before), 0.5, 0.1);
  EXPECT_LE(seeing.distance(before), 0.5 + 1e-9);
  EXPECT_TRUE(seen->distance().is_known(before));
  EXPECT_FALSE(seen->distance().is_known({2.0, 0.0, 1.0}));
  for (int k = 5; k < 10; ++k) seeing.perception.image(wall_image(0.1 * k, 3.0));
  EXPECT_GT(seeing.distance(at_wall), 0.9);
  EXPECT_LT(seen->distance().distance(at_wall, 0.0), 0.0) << "an older snapshot stays";
  EXPECT_EQ(seeing.perception.images(), 10);
}

/// A wall that is known by its shape: what is seen of it is in nobody's way, what stands before it
/// is.
TEST(Perception, KnownShapesAreNoObstacles) {
  const Eigen::Vector3d at_wall(1.52, 0.0, 1.0), before(1.22, 0.0, 1.0);
  World solid, plate, bar;
  solid.solids.push_back({.name = "wall", .size_m = {0.2, 3.0, 3.0}});
  solid.solids[0].world_from_box.translation() << 1.62, 0.0, 1.0;
  plate.surfaces.push_back({.name = "wall"});
  plate.surfaces[0].world_from_surface.translation() = at_wall;
  plate.surfaces[0].world_from_surface.linear() =
      Eigen::AngleAxisd(-0.5 * M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  bar.bars.push_back(
      {.name = "pole", .from = {1.55, 0.0, 0.0}, .to = {1.55, 0.0, 2.0}, .radius_m = 0.03});
  for (const auto& [known, beside] :
       {std::pair(solid, false), std::pair(plate, false), std::pair(bar, true)}) {
    Seeing seeing(known);
    for (int k = 0; k < 5; ++k) seeing.perception.image(wall_image(0.1 * k, 1.52));
    EXPECT_FALSE(seeing.perception.field()->is_occupied(
        seeing.perception.field()->window().index_at(at_wall)));
    EXPECT_EQ(seeing.distance({1.52, 0.5, 1.0}) < 0.0, beside) << "nobody knows of a wall there";
    for (int k = 0; k < 10; ++k) {
      seeing.perception.image(wall_image(0.5 + 0.04 * k, 1.22));
    }
    EXPECT_LT(seeing.distance(before), 0.0);
  }
}

TEST(Perception, UsesTheConfigurationAtTheStampOfTheImage) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  Perception perception(robot, {small_camera(*robot)}, {});
  perception.configuration(0.0, standing_at(*robot, 0.0));
  perception.configuration(1.0, standing_at(*robot, 1.0));
  // The wall stands at x = 2.02; the robot moves towards it.
  for (const double stamp_s : {0.2, 0.4, 0.6})
    perception.image(wall_image(stamp_s, 2.02 - stamp_s));
  const WorldDistance& seen = perception.newest()->distance();
  EXPECT_LT(seen.distance({2.02, 0.0, 1.0}, 0.0), 0.0);
  EXPECT_GT(seen.distance({1.7, 0.0, 1.0}, 0.0), 0.15);
}

TEST(Perception, LeavesOutWhatShowsTheRobotItself) {
  Seeing seeing;
  for (int k = 0; k < 5; ++k) seeing.perception.image(wall_image(0.1 * k, 0.08));
  EXPECT_EQ(seeing.distance({0.08, 0.0, 1.0}), 1.0);
}

TEST(Perception, HandsOutBothPartsOfEachImageThatItTakes) {
  std::vector<std::pair<int, int>> pixels;
  PerceptionOptions options;
  options.on_image = [&](const FilteredImage& image) {
    EXPECT_EQ(image.camera.name, "eye");
    EXPECT_NEAR(image.world_from_optical.translation().z(), 1.0, 1e-12);
    EXPECT_EQ(image.kept.stamp_s, 0.1 * static_cast<double>(pixels.size()));
    pixels.emplace_back(pixels_seen(image.kept), pixels_seen(image.taken));
  };
  Seeing seeing({}, options);
  const std::pair all_kept(kWidth * kHeight, 0), all_taken(0, kWidth * kHeight);
  seeing.perception.image(wall_image(0.0, 1.52));
  seeing.perception.image(wall_image(0.1, 0.08));
  EXPECT_NE(refusal([&] { seeing.perception.image(wall_image(0.1, 1.52)); }), "accepted");
  seeing.perception.image(wall_image(0.2, 1.52));
  EXPECT_EQ(pixels, (std::vector{all_kept, all_taken, all_kept}));
}

TEST(Perception, RefusesImagesThatCannotBeUsedAndStaysAsItIs) {
  Seeing seeing;
  Perception& perception = seeing.perception;
  for (int k = 0; k < 3; ++k) perception.image(wall_image(0.1 * k, 1.52));
  const auto before = perception.newest();
  const auto refused = [&](DepthImage image, const std::string& why) {
    const std::string text = refusal([&] { perception.image(std::move(image)); });
    EXPECT_NE(text.find(why), std::string::npos) << text;
    EXPECT_EQ(perception.newest(), before);
    EXPECT_EQ(perception.images(), 3);
  };
  DepthImage image = wall_image(0.5, 3.0);
  image.camera = 1;
  refused(image, "camera 1");
  image.camera = -1;
  refused(image, "camera -1");
  image = wall_image(0.5, 3.0);
  image.width = 40;
  refused(image, "40 x 60 pixels, expected 80 x 60 pixels");
  image = wall_image(0.5, 3.0);
  image.depth_mm.pop_back();
  refused(image, "with 4799 depths");
  refused(wall_image(0.2, 3.0), "a time after its last one");
  refused(wall_image(0.1, 3.0), "a time after its last one");
  refused(wall_image(std::numeric_limits<double>::quiet_NaN(), 3.0), "eye");
  refused(wall_image(1.5, 3.0), "");  // where the robot will be nobody knows
  perception.configuration(2.0, standing_at(*seeing.robot, 0.0));
  perception.configuration(3.0, standing_at(*seeing.robot, 1e4));
  refused(wall_image(3.0, 3.0), "the range of OctoMap's keys");
  EXPECT_EQ(perception.blind(), 0);
  EXPECT_NE(refusal([&] { perception.configuration(0.5, standing_at(*seeing.robot, 0.0)); }),
            "accepted");
  EXPECT_NE(refusal([&] { perception.stand(Eigen::VectorXd::Zero(3)); }), "accepted");
  perception.image(wall_image(0.3, 1.52));
  EXPECT_EQ(perception.images(), 4);
  EXPECT_DOUBLE_EQ(perception.newest()->stamp_s(), 0.3);
}

TEST(Perception, RefusesAnImageFromBeforeTheConfigurationsThatAreKept) {
  PerceptionOptions options;
  options.kept_s = 0.5;
  Seeing seeing({}, options);
  for (int k = 1; k < 20; ++k)
    seeing.perception.configuration(1.0 + 0.1 * k, standing_at(*seeing.robot, 0.0));
  EXPECT_NE(refusal([&] { seeing.perception.image(wall_image(0.5, 1.5)); }), "accepted");
  EXPECT_EQ(refusal([&] { seeing.perception.image(wall_image(2.8, 1.5)); }), "accepted");
}

TEST(Perception, CountsImagesInWhichNothingIsSeen) {
  Seeing seeing;
  for (int k = 0; k < 3; ++k) seeing.perception.image(wall_image(0.1 * k, 1.52));
  seeing.perception.image(wall_image(0.3, 0.0));
  EXPECT_EQ(seeing.perception.images(), 4);
  EXPECT_EQ(seeing.perception.blind(), 1);
  EXPECT_LT(seeing.distance({1.52, 0.0, 1.0}), 0.0) << "the wall is still there";
}

TEST(Perception, KnowsBeforehandWhatItIsTold) {
  World known;
  known.map = box_map({0.0, 1.5, 1.0}, 0.05);
  known.surfaces = {ground()};
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size[0] = 0.2;
  ball.world_from_obstacle.translation() << 0.0, -1.5, 1.0;
  known.obstacles = {ball};
  PerceptionOptions options;
  options.keeps_map = true;
  Seeing seeing(known, options);
  EXPECT_LT(seeing.distance({0.0, 1.5, 1.0}), 0.0);
  EXPECT_NEAR(seeing.distance({0.0, -1.2, 1.0}), 0.1, 1e-12);
  EXPECT_EQ(seeing.perception.newest()->world().surfaces.size(), 1u);
  for (int k = 0; k < 3; ++k) seeing.perception.image(wall_image(0.1 * k, 1.52));
  EXPECT_LT(seeing.distance({0.0, 1.5, 1.0}), 0.0) << "out of sight";
  const auto map = seeing.perception.map();
  for (const octomap::point3d& point :
       {octomap::point3d(0.01f, 1.51f, 1.01f), octomap::point3d(1.52f, 0.01f, 1.01f)}) {
    const octomap::OcTreeNode* node = map->search(point);
    ASSERT_NE(node, nullptr);
    EXPECT_TRUE(map->isNodeOccupied(node));
  }
  EXPECT_EQ(Seeing().perception.map(), nullptr);
}

TEST(Perception, KeepsInItsMapWhatTheWindowLeaves) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  PerceptionOptions options;
  options.keeps_map = true;
  options.map.size_m = {3.2, 3.2, 2.0};
  Perception perception(robot, {small_camera(*robot)}, {}, options);
  perception.configuration(0.0, standing_at(*robot, 0.0));
  perception.configuration(1.0, standing_at(*robot, 0.0));
  for (int k = 0; k < 4; ++k) perception.image(wall_image(0.1 * k, 1.22));
  perception.configuration(11.0, standing_at(*robot, 10.0));
  perception.image(wall_image(11.0, 0.0));
  EXPECT_EQ(perception.newest()->distance().distance({1.2, 0.0, 1.0}, 0.0), 1.0) << "far away";
  const auto map = perception.map();
  const octomap::OcTreeNode* node = map->search(1.22, 0.01, 1.01);
  ASSERT_NE(node, nullptr);
  EXPECT_TRUE(map->isNodeOccupied(node));
}

TEST(Perception, SeesTheSameWhetherItKeepsTheMapOrNot) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  World known;
  known.map = box_map({0.0, 1.2, 1.0}, 0.05);
  for (const World& beforehand : {World(), known}) {
    std::vector<double> seen;
    for (const bool keeps_map : {false, true}) {
      PerceptionOptions options;
      options.keeps_map = keeps_map;
      options.map.size_m = {3.2, 3.2, 2.0};
      Perception perception(robot, {small_camera(*robot)}, beforehand, options);
      double from_s = 0.0;
      for (const double x : {0.0, 10.0, 0.0}) {  // there and back, where it does not look any more
        perception.configuration(from_s, standing_at(*robot, x));
        perception.configuration(from_s + 1.0, standing_at(*robot, x));
        for (int k = 0; k < 4; ++k)
          perception.image(wall_image(from_s + 0.1 * k, from_s == 0.0 ? 1.22 : 0.0));
        from_s += 10.0;
        for (double ahead = -1.5; ahead < 1.5; ahead += 0.1) {
          for (const double y : {0.0, 1.2})
            seen.push_back(perception.newest()->distance().distance({x + ahead, y, 1.0}, 0.0));
        }
      }
    }
    const auto half = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
    EXPECT_TRUE(std::equal(seen.begin(), half, half, seen.end()));
  }
}

TEST(Perception, ShowsAJudgeTheVoxelsNearARobot) {
  World known;
  known.surfaces = {ground()};
  Seeing seeing(known);
  for (int k = 0; k < 5; ++k) seeing.perception.image(wall_image(0.1 * k, 1.52));
  const World seen = seeing.perception.seen_near(box_of({1.0, -0.2, 0.8}, {2.0, 0.2, 1.2}));
  EXPECT_EQ(seen.surfaces.size(), 1u);
  const OctreeInfo info = octree_info(*seen.map);
  ASSERT_GT(info.occupied_leaves, 0u);
  EXPECT_NEAR(info.occupied_bounds.min().x(), 1.5, 0.06);
  EXPECT_GE(info.occupied_bounds.min().y(), -0.25 - 1e-9);
  EXPECT_LE(info.occupied_bounds.max().z(), 1.25 + 1e-9);
  EXPECT_EQ(
      octree_info(*seeing.perception.seen_near(box_of({-1.0, -1.0, 0.5}, {0.5, 1.0, 1.5})).map)
          .occupied_leaves,
      0u);
  EXPECT_EQ(octree_info(*seeing.perception.seen_near(box_of({90, 90, 90}, {91, 91, 91})).map)
                .occupied_leaves,
            0u);
}

TEST(Perception, TakesWhatItHasNotSeenForOccupiedWhereItIsTold) {
  PerceptionOptions options;
  options.map.unknown = UnknownSpace::kOccupied;
  Seeing seeing({}, options);
  const Eigen::Vector3d beside(0.0, 0.25, 1.0);
  EXPECT_LT(seeing.distance(beside), 0.0);
  seeing.perception.stand(standing_at(*seeing.robot, 0.0));
  EXPECT_GT(seeing.distance({0.0, 0.0, 1.0}), 0.2) << "where it stands there is nothing else";
  EXPECT_GT(seeing.distance(beside), 0.0);
  EXPECT_LT(seeing.distance({0.0, 1.0, 1.0}), 0.0);
  EXPECT_GT(octree_info(*seeing.perception.seen_near(box_of({0.0, 0.9, 0.9}, {0.1, 1.0, 1.0})).map)
                .occupied_leaves,
            0u);
}

TEST(Perception, StandsBesideWhatIsKnownWithoutForgettingIt) {
  World known;
  known.map = box_map({0.0, 0.5, 1.0}, 0.05);  // 0.25 m beside the robot's skin
  Seeing seeing(known);
  seeing.perception.stand(standing_at(*seeing.robot, 0.0));
  EXPECT_LT(seeing.distance({0.0, 0.45, 1.0}), 0.0);
}

TEST(Perception, RefusesRobotsWithoutCamerasAndMapsAndWindowsThatItCannotUse) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  const DepthCamera camera = small_camera(*robot);
  const auto why = [&](std::vector<DepthCamera> cameras, const World& known,
                       const PerceptionOptions& options) {
    return refusal([&] { Perception(robot, cameras, known, options); });
  };
  EXPECT_NE(why({}, {}, {}).find("the robot ball has no depth camera"), std::string::npos);
  DepthCamera elsewhere = camera;
  elsewhere.link = 7;
  EXPECT_NE(why({elsewhere}, {}, {}).find("link 7"), std::string::npos);
  DepthCamera line = camera;
  line.height = 1;
  EXPECT_NE(why({line}, {}, {}).find("one row or column"), std::string::npos);
  World coarse;
  coarse.map = box_map({0.0, 1.0, 1.0}, 0.1);
  const std::string resolution = why({camera}, coarse, {});
  EXPECT_NE(resolution.find("those of the window, 0.05"), std::string::npos) << resolution;
  PerceptionOptions large;
  large.map.size_m = {1000.0, 1000.0, 3.0};
  EXPECT_NE(why({camera}, {}, large), "accepted");
  PerceptionOptions options;
  options.kept_s = 0.0;
  EXPECT_NE(why({camera}, {}, options).find("kept_s"), std::string::npos);
  options = {};
  options.around_m = -1.0;
  EXPECT_NE(why({camera}, {}, options).find("around_m"), std::string::npos);
  EXPECT_EQ(why({camera}, {}, {}), "accepted");
}

}  // namespace
}  // namespace locograph
