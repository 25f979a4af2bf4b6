// What is said of a contact that lies on nothing.
#include <gtest/gtest.h>
#include <locograph/planners/scenario/contact_place.h>

#include <cmath>

namespace locograph {
namespace {

TEST(NearestPlace, IsNamedWithItsDistanceAndItsTurn) {
  World world;
  Contact contact;
  contact.effector.kind = ContactKind::kPoint;
  contact.position = {0.5, 0.0, 0.3};
  contact.normal = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(nearest_place(world, contact), "there is nothing to touch");

  Surface floor;
  floor.name = "floor";
  floor.half_x_m = floor.half_y_m = 0.4;
  world.surfaces.push_back(floor);
  EXPECT_EQ(nearest_place(world, contact), "the nearest, floor, is 0.316 m away")
      << "to its border, 0.1 m aside";
  EXPECT_FALSE(lies_on_something(world, contact));

  world.bars.push_back({.name = "rail", .from = {0, -1, 0.5}, .to = {0, 1, 0.5}, .radius_m = 0.02});
  contact.position = {0.1, 0.0, 0.5};
  EXPECT_EQ(nearest_place(world, contact), "the nearest, rail, is 0.08 m away");

  world.surfaces[0].world_from_surface.linear() =
      Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitX()).toRotationMatrix();
  contact.position.setZero();
  EXPECT_EQ(nearest_place(world, contact),
            "the nearest, floor, is 0 m away, its normal turned by 0.25 rad");
}

}  // namespace
}  // namespace locograph
