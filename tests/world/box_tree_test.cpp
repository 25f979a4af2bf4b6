#include <gtest/gtest.h>
#include <locograph/common/uniform.h>
#include <locograph/world/box_tree.h>

#include <algorithm>
#include <random>

namespace locograph {
namespace {

Eigen::AlignedBox3d random_box(std::mt19937_64& random, double most_m) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 2; ++corner) {
    const double x = uniform(random, -5.0, 5.0), y = uniform(random, -5.0, 5.0);
    const Eigen::Vector3d point(x, y, uniform(random, -1.0, 1.0));
    if (corner == 0) {
      box.extend(point);
    } else {
      box.extend(Eigen::Vector3d(box.min() + most_m * (point - box.min()) / 10.0));
    }
  }
  return box;
}

TEST(BoxTree, FindsTheBoxesThatTouchInTheirOrder) {
  std::mt19937_64 random(3);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(random_box(random, 0.5));
  const BoxTree tree(boxes);
  std::size_t found = 0;
  for (int query = 0; query < 300; ++query) {
    const Eigen::AlignedBox3d box = random_box(random, 2.0);
    std::vector<int> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i].intersects(box)) expected.push_back(static_cast<int>(i));
    }
    EXPECT_EQ(tree.touching(box), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 50u);
}

TEST(BoxTree, FindsTheFirstThatTouchesAndIsWhatIsAskedFor) {
  std::mt19937_64 random(4);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(random_box(random, 2.0));
  const BoxTree tree(boxes);
  const auto is = [](int number) { return number % 3 == 1; };
  int found = 0;
  for (int query = 0; query < 300; ++query) {
    const Eigen::AlignedBox3d box = random_box(random, 2.0);
    const std::vector<int> touching = tree.touching(box);
    const auto expected = std::ranges::find_if(touching, is);
    EXPECT_EQ(tree.first_touching(box, is), expected == touching.end() ? -1 : *expected);
    found += expected == touching.end() ? 0 : 1;
  }
  EXPECT_GT(found, 20);
}

TEST(BoxTree, AsksForTheFirstOfManyBoxesAtOnePlaceOnly) {
  const BoxTree tree(std::vector<Eigen::AlignedBox3d>(1000, box_around({0, 0, 0}, 1.0)));
  int asked = 0;
  EXPECT_EQ(tree.first_touching(box_around({0, 0, 0}, 0.1), [&](int) { return ++asked > 0; }), 0);
  EXPECT_EQ(asked, 1);
}

TEST(BoxTree, OfNothingFindsNothing) {
  EXPECT_TRUE(BoxTree().touching(box_around({0, 0, 0}, 1e9)).empty());
}

TEST(BoxTree, SurfacesWithoutAnEndAreNearEverywhere) {
  std::vector<Surface> surfaces(3, ground());
  surfaces[0].half_x_m = surfaces[0].half_y_m = 1.0;
  surfaces[1].half_x_m = 1.0;
  const BoxTree tree(bounds_of(surfaces));
  EXPECT_EQ(tree.touching(box_around({1.5, 0.0, 0.4}, 0.6)), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(tree.touching(box_around({1.5, 0.0, 0.4}, 0.3)), (std::vector<int>{1, 2}));
}

TEST(BoxTree, TheBoundsOfASurfaceTurnWithIt) {
  Surface surface;
  surface.half_x_m = 2.0;
  surface.half_y_m = 1.0;
  surface.world_from_surface.translate(Eigen::Vector3d(1.0, 2.0, 3.0));
  surface.world_from_surface.rotate(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitY()));
  const Eigen::AlignedBox3d bounds = bounds_of(surface);
  EXPECT_TRUE(bounds.min().isApprox(Eigen::Vector3d(1.0, 1.0, 1.0), 1e-12));
  EXPECT_TRUE(bounds.max().isApprox(Eigen::Vector3d(1.0, 3.0, 5.0), 1e-12));
}

}  // namespace
}  // namespace locograph
