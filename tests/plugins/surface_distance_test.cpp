// Surfaces, bars and boxes keep links away that do not touch them.
#include <locograph/plugins/surface_distance/touchable_places.h>

#include "plugins/plugin_test_support.h"
#include "plugins/small_robot.h"

namespace locograph::test {
namespace {

std::shared_ptr<const RobotParameter> cart(const TemporaryFolder& folder) {
  return std::make_shared<const RobotParameter>(
      folder.write("cart.urdf", kCartUrdf), folder.write("cart.srdf", kCartSrdf), RobotOptions());
}

Eigen::Isometry3d tilted(const Eigen::Vector3d& at, double angle) {
  return Eigen::Translation3d(at) *
         Eigen::AngleAxisd(angle, Eigen::Vector3d(0.36, 0.48, 0.8).normalized());
}

TEST(TouchablePlaces, DistancesToBarsAndBoxesAreThoseOfTheirShapes) {
  const TemporaryFolder folder;
  World world;
  world.bars = {
      {.name = "rail", .from = {0.5, -0.3, 0.2}, .to = {0.7, 0.4, 0.3}, .radius_m = 0.02}};
  world.solids = {{.name = "block",
                   .world_from_box = tilted({-0.4, 0.2, 0.1}, 0.7),
                   .size_m = {0.3, 0.2, 0.4}}};
  const TouchablePlaces places(cart(folder), world);
  const Bar& rail = world.bars[0];
  const Eigen::Isometry3d world_from_rail =
      Eigen::Translation3d(0.5 * (rail.from + rail.to)) *
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), rail.to - rail.from);
  const std::pair<ConvexShape, Eigen::Isometry3d> shapes[] = {
      {ConvexShape::capsule(rail.radius_m, (rail.to - rail.from).norm()), world_from_rail},
      {ConvexShape::box(world.solids[0].size_m), world.solids[0].world_from_box}};
  const ConvexShape ball = ConvexShape::sphere(0.03);
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const int place = i % 2;
    Eigen::Isometry3d pose = shapes[place].second;
    pose.translation() += random.vector(3, 0.4);
    const TouchablePlaces::Distance found = places.distance(place, pose.translation(), 0.03);
    const double exact =
        shape_distance(ball, pose, shapes[place].first, shapes[place].second).distance;
    EXPECT_NEAR(found.value, exact, 1e-9);
    EXPECT_NEAR(found.gradient.norm(), 1.0, 1e-9);
    EXPECT_EQ(places.name(place), place == 0 ? "rail" : "block");
  }
}

}  // namespace
}  // namespace locograph::test
