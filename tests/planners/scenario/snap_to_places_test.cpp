#include <gtest/gtest.h>
#include <locograph/check/bar_contact.h>
#include <locograph/check/limits.h>
#include <locograph/planners/scenario/snap_to_places.h>

#include <cmath>
#include <utility>

namespace locograph {
namespace {

const std::vector<std::string> kScan = {"scan"};

/// A floor 3 mm above zero that rises by 0.02 rad, a bar along y, and a stage that is exact.
World scanned_world() {
  Surface floor;
  floor.name = "scan 1";
  floor.world_from_surface.linear() =
      Eigen::AngleAxisd(-0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  floor.world_from_surface.translation().z() = 0.003;
  floor.half_x_m = floor.half_y_m = 1.0;
  Surface stage;
  stage.name = "stage";
  stage.world_from_surface.translation() = Eigen::Vector3d(5.0, 0.0, 0.0);
  stage.half_x_m = stage.half_y_m = 1.0;
  Bar bar;
  bar.name = "scan bar 12";
  bar.from = Eigen::Vector3d(1.0, -0.5, 1.0);
  bar.to = Eigen::Vector3d(1.02, 0.5, 1.01);
  bar.radius_m = 0.02;
  World world;
  world.surfaces = {floor, stage};
  world.bars = {bar};
  return world;
}

Contact contact_of(ContactKind kind, const Eigen::Vector3d& position,
                   const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ()) {
  Contact contact;
  contact.effector.name = "it";
  contact.effector.kind = kind;
  contact.effector.half_x_m = 0.08;
  contact.effector.half_y_m = 0.035;
  contact.position = position;
  contact.normal = normal;
  return contact;
}

Contact snapped(const Contact& contact, const World& world = scanned_world()) {
  Stance stance{{contact}};
  snap_to_places(stance, world, kScan);
  return stance.contacts.at(0);
}

void expect_as_it_was(const Contact& contact, const World& world = scanned_world()) {
  const Contact after = snapped(contact, world);
  EXPECT_EQ(after.position, contact.position);
  EXPECT_EQ(after.normal, contact.normal);
  EXPECT_EQ(after.forward, contact.forward);
}

TEST(SnapToPlaces, ASoleOnAScannedFloorComesToLieInItsPlane) {
  const Surface floor = scanned_world().surfaces[0];
  Contact sole = contact_of(ContactKind::kSurface, {0.4, 0.1, 0.0});
  sole.forward = Eigen::Vector3d::UnitX();
  const Contact after = snapped(sole);
  const Eigen::Vector3d normal = floor.world_from_surface.linear().col(2);
  EXPECT_LT((after.normal - normal).norm(), 1e-12);
  EXPECT_NEAR((floor.world_from_surface.inverse() * after.position).z(), 0.0, 1e-12);
  EXPECT_LT((after.position - sole.position).norm(), 0.012);
  ASSERT_TRUE(after.forward.has_value());
  EXPECT_NEAR(after.forward->dot(normal), 0.0, 1e-12) << "it turns with the normal";
  EXPECT_NEAR(after.forward->y(), 0.0, 1e-12);
}

TEST(SnapToPlaces, WhatWasSnappedStays) {
  for (const ContactKind kind : {ContactKind::kSurface, ContactKind::kPoint, ContactKind::kWheel}) {
    expect_as_it_was(snapped(contact_of(kind, {0.4, 0.1, 0.0})));
  }
}

TEST(SnapToPlaces, WhatIsFurtherAwayOrTurnedFurtherStays) {
  expect_as_it_was(contact_of(ContactKind::kPoint, {0.0, 0.0, 0.054}));
  expect_as_it_was(
      contact_of(ContactKind::kPoint, {0.0, 0.0, 0.0}, {std::sin(0.25), 0.0, std::cos(0.25)}));
  expect_as_it_was(contact_of(ContactKind::kPoint, {-1.06, 0.0, 0.0}));
}

TEST(SnapToPlaces, WhatIsJustBeyondTheBorderComesOntoIt) {
  const Contact after = snapped(contact_of(ContactKind::kPoint, {0.0, 1.03, 0.0}));
  EXPECT_NEAR(after.position.y(), 1.0, 1e-12);
}

TEST(SnapToPlaces, ExactSurfacesAndWhatIsOnThemStay) {
  expect_as_it_was(contact_of(ContactKind::kSurface, {5.0, 0.0, 0.0}));
  expect_as_it_was(contact_of(ContactKind::kSurface, {5.0, 0.0, 0.01}));
  World world = scanned_world();
  world.surfaces[0].world_from_surface.translation().x() = 5.0;
  expect_as_it_was(contact_of(ContactKind::kSurface, {5.0, 0.0, 0.0}), world);
}

TEST(SnapToPlaces, NamesThatOnlyBeginAlikeAreNotOfTheScan) {
  for (const char* name : {"scan", "scan x", "scanner 1", "scan 1 top", "scan bar"}) {
    World world = scanned_world();
    world.surfaces[0].name = name;
    expect_as_it_was(contact_of(ContactKind::kPoint, {0.0, 0.0, 0.0}), world);
  }
}

TEST(SnapToPlaces, TheNearestOfSeveralTakesTheContact) {
  World world = scanned_world();
  Surface step = world.surfaces[0];
  step.name = "scan 2";
  step.world_from_surface = Eigen::Isometry3d::Identity();
  step.world_from_surface.translation().z() = 0.04;
  world.surfaces.push_back(step);
  EXPECT_EQ(snapped(contact_of(ContactKind::kPoint, {0.0, 0.0, 0.03}), world).position.z(), 0.04);
  EXPECT_LT(snapped(contact_of(ContactKind::kPoint, {0.0, 0.0, 0.01}), world).position.z(), 0.01);
}

TEST(SnapToPlaces, PointsAndSolesComeOntoTheLineOfABarAlongTheirNormal) {
  const Bar bar = scanned_world().bars[0];
  for (const ContactKind kind : {ContactKind::kPoint, ContactKind::kSurface}) {
    const Contact after = snapped(contact_of(kind, {1.03, 0.2, 1.0}));
    EXPECT_LT(off_bar_m(after, bar), 1e-9);
    EXPECT_EQ(beyond_ends_m(bar, after.position), 0.0);
    EXPECT_GT(after.normal.z(), 0.99) << "from above as before";
    const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
    const Eigen::Vector3d off = after.position - bar.from;
    EXPECT_NEAR((off - axis * axis.dot(off)).norm(), 0.02, 1e-12);
    expect_as_it_was(after);
  }
}

TEST(SnapToPlaces, GraspsComeOntoTheAxisWithTheirBarAlongItInEitherSense) {
  const Bar bar = scanned_world().bars[0];
  for (const double sense : {1.0, -1.0}) {
    Contact grasp = contact_of(ContactKind::kGrasp, {1.02, 0.2, 1.02});
    grasp.forward = Eigen::Vector3d(sense, 0.0, 0.0);
    const Contact after = snapped(grasp);
    EXPECT_LT(off_bar_m(after, bar), 1e-9);
    EXPECT_GT(after.forward->x() * sense, 0.99);
    EXPECT_GT(after.normal.z(), 0.99);
  }
  Contact along = contact_of(ContactKind::kGrasp, {1.01, 0.0, 1.0});
  along.forward = Eigen::Vector3d::UnitY();
  expect_as_it_was(along);
}

TEST(SnapToPlaces, NormalsAlongABarAndWheelsOnItStay) {
  expect_as_it_was(contact_of(ContactKind::kPoint, {1.01, 0.0, 1.02}, Eigen::Vector3d::UnitY()));
  expect_as_it_was(contact_of(ContactKind::kWheel, {1.01, 0.0, 1.03}));
}

TEST(SnapToPlaces, TheNamesOfAScenarioAreThoseOfItsScans) {
  Scenario scenario;
  scenario.scanned.resize(2);
  scenario.scanned[0].name = "hall";
  scenario.scanned[1].name = "rocks";
  EXPECT_EQ(scanned_names(scenario), (std::vector<std::string>{"hall", "rocks"}));
}

}  // namespace
}  // namespace locograph
