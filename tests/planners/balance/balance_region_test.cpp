// Where the centre of mass may be: against polygons worked out by hand, and against the judge's
// certificate, which shares no code with it.
#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/balance/balance_region.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "common/sanitized.h"
#include "common/temporary_folder.h"

namespace locograph::balance_region_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMass_kg = 10.0, kWeight_N = kMass_kg * 9.81;
/// Margin of the regions, and what it leaves.
constexpr double kMargin = 0.1, kPart = 1.0 - kMargin;
/// Of linear programmes.
constexpr double kNear_m = 1e-5;

Contact contact_at(ContactKind kind, const Vector3d& position,
                   const Vector3d& normal = Vector3d::UnitZ(),
                   const Vector3d& forward = Vector3d::UnitX()) {
  Contact contact;
  contact.effector.link = "block";
  contact.effector.kind = kind;
  contact.effector.friction = 0.5;
  contact.effector.max_force_N = 1e4;
  if (kind == ContactKind::kSurface) {
    contact.effector.half_x_m = 0.1;
    contact.effector.half_y_m = 0.05;
  }
  contact.position = position;
  contact.normal = normal;
  if (kind != ContactKind::kPoint) contact.forward = forward;
  return contact;
}

Contact sole(const Vector3d& position) { return contact_at(ContactKind::kSurface, position); }

BalanceRegion region_of(const std::vector<Contact>& contacts, double margin = kMargin) {
  std::vector<BearingContact> bearing;
  for (const Contact& contact : contacts) bearing.push_back({contact});
  return balance_region(kMass_kg, bearing, margin);
}

/// One link of 10 kg whose centre of mass is its origin, and what the certificate says of it.
class Block {
 public:
  Block()
      : robot_(Robot::load(test::TemporaryFolder().write(
            "block.urdf",
            "<robot name='block'><link name='block'><inertial><mass value='10'/><inertia ixx='1' "
            "ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>"))) {}

  bool balances(std::vector<Contact> contacts, const Vector3d& centre_of_mass) const {
    Eigen::VectorXd q = robot_.neutral_configuration();
    q.head<3>() = centre_of_mass;
    for (Contact& contact : contacts) {
      contact.effector.point = contact.position - centre_of_mass;
      contact.effector.normal = contact.normal;
      if (contact.forward) contact.effector.forward = *contact.forward;
      if (!contact.forward) contact.effector.forward = contact.normal.unitOrthogonal();
    }
    return certify_balance(robot_, q, contacts, {.enforce_torque_limits = false}).balanced;
  }

 private:
  Robot robot_;
};

TEST(BalanceRegion, OneFootOnLevelGroundIsItsRectangleLessTheMargin) {
  const BalanceRegion region = region_of({sole({0.3, -0.2, 0.7})});
  const Vector2d middle(0.3, -0.2);
  EXPECT_FALSE(region.empty());
  EXPECT_NEAR(region.width_m, 2.0 * kPart * 0.05, kNear_m);
  EXPECT_NEAR(region.depth_m(middle), kPart * 0.05, kNear_m);
  for (const double x : {-1.0, 1.0}) {
    EXPECT_NEAR(region.depth_m(middle + Vector2d(x * 0.06, 0.0)), kPart * 0.1 - 0.06, kNear_m);
    EXPECT_NEAR(region.depth_m(middle + Vector2d(x * 0.1, 0.0)), kPart * 0.1 - 0.1, kNear_m);
    for (const double y : {-1.0, 1.0}) {
      EXPECT_NEAR(region.depth_m(middle + kPart * Vector2d(x * 0.1, y * 0.05)), 0.0, kNear_m);
    }
  }
}

TEST(BalanceRegion, AFootWhoseYawIsFreeBearsWithinTheCircleInIt) {
  Contact free = sole(Vector3d::Zero());
  free.forward.reset();
  const double radius = kPart * 0.05, depth = region_of({free}).depth_m(Vector2d::Zero());
  EXPECT_LE(depth, radius + kNear_m);
  EXPECT_GE(depth, radius * std::cos(std::numbers::pi / 8.0) - kNear_m) << "an octagon";
}

TEST(BalanceRegion, TwoFeetAreTheHullOfBoth) {
  const BalanceRegion region = region_of({sole({0.0, 0.12, 0.0}), sole({0.2, -0.12, 0.0})});
  for (const Vector2d& corner :
       {Vector2d(-0.09, 0.165), Vector2d(0.09, 0.165), Vector2d(0.29, -0.075),
        Vector2d(0.29, -0.165), Vector2d(0.11, -0.165), Vector2d(-0.09, 0.075)}) {
    EXPECT_NEAR(region.depth_m(corner), 0.0, kNear_m) << corner.transpose();
  }
  EXPECT_GT(region.depth_m({0.1, 0.0}), 0.05) << "between them";
  EXPECT_LT(region.depth_m({0.29, 0.165}), -0.05);
  EXPECT_LT(region.depth_m({-0.09, -0.165}), -0.05);
}

TEST(BalanceRegion, FrictionDoesNotMatterOnLevelGround) {
  std::vector<Contact> feet = {sole({0.0, 0.12, 0.0}), sole({0.2, -0.12, 0.0})};
  const BalanceRegion region = region_of(feet);
  for (const double friction : {0.05, 1.5}) {
    for (Contact& foot : feet) foot.effector.friction = friction;
    const BalanceRegion other = region_of(feet);
    for (double x = -0.2; x < 0.45; x += 0.1) {
      for (double y = -0.25; y < 0.3; y += 0.1) {
        EXPECT_NEAR(other.depth_m({x, y}), region.depth_m({x, y}), kNear_m) << x << ' ' << y;
      }
    }
  }
}

TEST(BalanceRegion, ASlopeWithinFrictionIsSeenFromAbove) {
  constexpr double kSlope_rad = 0.2;
  const Contact tilted = contact_at(ContactKind::kSurface, {0.3, -0.2, 0.7},
                                    {std::sin(kSlope_rad), 0.0, std::cos(kSlope_rad)},
                                    {std::cos(kSlope_rad), 0.0, -std::sin(kSlope_rad)});
  const BalanceRegion region = region_of({tilted});
  const double half_x = kPart * 0.1 * std::cos(kSlope_rad);
  EXPECT_NEAR(region.depth_m({0.3, -0.2}), kPart * 0.05, kNear_m);
  for (const double x : {-half_x, half_x}) {
    EXPECT_NEAR(region.depth_m({0.3 + x, -0.2}), 0.0, kNear_m);
  }
}

TEST(BalanceRegion, IsEmptyWhereNothingBalancesOrOnlyALineDoes) {
  const Vector3d slope(0.3, 0.0, 1.0), steep(0.7, 0.0, 1.0);  // friction 0.5
  Contact unloaded = sole(Vector3d::Zero());
  unloaded.bears_load = false;
  const std::vector<std::vector<Contact>> none = {
      {},
      {unloaded},
      {contact_at(ContactKind::kPoint, Vector3d::Zero())},
      {contact_at(ContactKind::kPoint, Vector3d::Zero(), slope)},
      {contact_at(ContactKind::kPoint, Vector3d::Zero()),
       contact_at(ContactKind::kPoint, Vector3d::UnitX())},
      {contact_at(ContactKind::kSurface, Vector3d::Zero(), steep)}};
  for (std::size_t i = 0; i < none.size(); ++i) {
    const BalanceRegion region = region_of(none[i]);
    EXPECT_TRUE(region.empty()) << i;
    EXPECT_EQ(region.depth_m(Vector2d::Zero()), -std::numeric_limits<double>::infinity()) << i;
  }
  EXPECT_FALSE(region_of({contact_at(ContactKind::kSurface, Vector3d::Zero(), slope)}).empty());
}

TEST(BalanceRegion, WhatBearsNoLoadAddsNothing) {
  Contact hand = contact_at(ContactKind::kPoint, {0.6, 0.0, 0.0});
  EXPECT_GT(region_of({sole(Vector3d::Zero()), hand}).depth_m({0.2, 0.0}), 0.0);
  hand.bears_load = false;
  EXPECT_LT(region_of({sole(Vector3d::Zero()), hand}).depth_m({0.2, 0.0}), -0.1);
}

TEST(BalanceRegion, TwoWallsHoldWhatFrictionAndForceAllow) {
  const Block block;
  const auto walls = [](double friction, double max_force_N) {
    std::vector<Contact> soles;
    for (const double side : {-1.0, 1.0}) {
      soles.push_back(contact_at(ContactKind::kSurface, {0.4, side * 0.7, 1.0}, {0.0, -side, 0.0},
                                 Vector3d::UnitZ()));
      soles.back().effector.friction = friction;
      soles.back().effector.max_force_N = max_force_N;
    }
    return soles;
  };
  // 100 N on each: friction of 0.8 bears 160 N, of 0.3 only 60 N of the 98 N.
  const BalanceRegion rough = region_of(walls(0.8, 100.0));
  EXPECT_GT(rough.depth_m({0.4, 0.0}), 1e-3);
  EXPECT_LT(rough.depth_m({0.4, 0.5}), 0.0) << "more than one wall bears";
  EXPECT_LT(rough.depth_m({0.8, 0.0}), 0.0);
  EXPECT_TRUE(block.balances(walls(0.8, 100.0), {0.4, 0.0, 1.0}));
  EXPECT_TRUE(region_of(walls(0.3, 100.0)).empty());
  EXPECT_FALSE(block.balances(walls(0.3, 100.0), {0.4, 0.0, 1.0}));
  EXPECT_GT(region_of(walls(0.3, 1000.0)).depth_m({0.4, 0.0}), 1e-3) << "pressed harder";
}

TEST(BalanceRegion, GraspsPullAsWellAsTheyPush) {
  std::vector<Contact> grasps = {contact_at(ContactKind::kGrasp, {-0.3, 0.0, 1.0}),
                                 contact_at(ContactKind::kGrasp, {0.3, 0.0, 1.0})};
  for (Contact& grasp : grasps) {
    grasp.effector.max_force_N = 2.0 * kWeight_N;
    grasp.effector.max_moment_Nm = 0.05 * kWeight_N;
  }
  // One bears 2 kPart of the weight, the other pulls the rest; moments across the bars do for y.
  const double x = 0.3 * (4.0 * kPart - 1.0), y = 2.0 * kPart * 0.05;
  const BalanceRegion region = region_of(grasps);
  EXPECT_NEAR(region.depth_m({0.0, 0.0}), y, kNear_m);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(region.depth_m({side * x, 0.0}), 0.0, kNear_m);
    EXPECT_NEAR(region.depth_m({0.0, side * y}), 0.0, kNear_m);
    EXPECT_NEAR(region.depth_m({side * x, side * y}), 0.0, kNear_m);
  }
  EXPECT_GT(region.depth_m({0.5, 0.0}), 0.05) << "beyond the bars";
  for (Contact& grasp : grasps) grasp.effector.max_moment_Nm = 0.0;
  EXPECT_TRUE(region_of(grasps).empty()) << "a line";
}

TEST(BalanceRegion, LimitsOfForceKeepTheCentreOfMassFromOneFoot) {
  std::vector<Contact> feet = {sole({0.0, 0.2, 0.0}), sole({0.0, -0.2, 0.0})};
  const auto with_part_of_weight = [&](double part) {
    for (Contact& foot : feet) foot.effector.max_force_N = part / kPart * kWeight_N;
    return region_of(feet);
  };
  const double half = kPart * 0.05;
  const BalanceRegion region = with_part_of_weight(0.6);
  const double y = 0.6 * (0.2 + half) + 0.4 * (-0.2 + half);
  EXPECT_NEAR(region.depth_m({0.0, 0.0}), y, kNear_m);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(region.depth_m({0.0, side * y}), 0.0, kNear_m);
    EXPECT_NEAR(region.depth_m({side * kPart * 0.1, 0.0}), 0.0, kNear_m);
  }
  EXPECT_NEAR(with_part_of_weight(1.5).depth_m({0.0, 0.2 + half}), 0.0, kNear_m) << "no limit";
  EXPECT_TRUE(with_part_of_weight(0.45).empty()) << "both together are too weak";
}

TEST(BalanceRegion, OneProgrammeSaysWhetherItHoldsAPoint) {
  const std::vector<BearingContact> feet = {{sole({0.0, 0.12, 0.0})}, {sole({0.2, -0.12, 0.1})}};
  const BalanceRegion region = balance_region(kMass_kg, feet, kMargin);
  int inside = 0, points = 0;
  for (double x = -0.3; x < 0.5; x += 0.037) {
    for (double y = -0.3; y < 0.3; y += 0.037) {
      const double depth_m = region.depth_m({x, y});
      if (std::abs(depth_m) < 1e-3) continue;
      ++points;
      inside += depth_m > 0.0;
      EXPECT_EQ(balances(kMass_kg, feet, kMargin, {x, y}), depth_m > 0.0) << x << ' ' << y;
    }
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(points - inside, 10);
  // Fewer corners lie inside.
  const BalanceRegion coarse = balance_region(kMass_kg, feet, kMargin, 0.02);
  EXPECT_LE(coarse.sides.size(), region.sides.size());
  EXPECT_LE(coarse.depth_m({0.1, 0.0}), region.depth_m({0.1, 0.0}) + kNear_m);
  EXPECT_GT(coarse.depth_m({0.1, 0.0}), region.depth_m({0.1, 0.0}) - 0.02);
}

TEST(BalanceRegion, OnlyWhatOfASoleLiesOnSomethingBears) {
  const BearingContact half = {sole(Vector3d::Zero()),
                               {{0.0, 0.05}, {0.1, 0.05}, {0.1, -0.05}, {0.0, -0.05}}};
  const BalanceRegion region = balance_region(kMass_kg, {&half, 1}, kMargin);
  // The tenth that is left unused is left on all sides of what bears.
  const double near = 0.05 - kPart * 0.05, far = 0.05 + kPart * 0.05;
  EXPECT_NEAR(region.depth_m({0.05, 0.0}), kPart * 0.05, kNear_m);
  EXPECT_NEAR(region.depth_m({-0.02, 0.0}), -0.02 - near, kNear_m);
  EXPECT_NEAR(region.depth_m({near, 0.0}), 0.0, kNear_m);
  EXPECT_NEAR(region.depth_m({far, 0.0}), 0.0, kNear_m);
}

TEST(BalanceRegion, AgreesWithTheCertificateAllOverLevelGround) {
  const Block block;
  const std::vector<Contact> contacts = {sole({0.0, 0.12, 0.0}), sole({0.2, -0.12, 0.0}),
                                         contact_at(ContactKind::kPoint, {0.5, 0.0, 0.0})};
  const BalanceRegion region = region_of(contacts, 0.0);
  int inside = 0, outside = 0;
  for (double x = -0.21; x < 0.6; x += 0.04) {
    for (double y = -0.29; y < 0.3; y += 0.04) {
      const double depth = region.depth_m({x, y});
      if (std::abs(depth) < 2e-3) continue;
      // Its height does not matter.
      EXPECT_EQ(block.balances(contacts, {x, y, depth > 0.05 ? 2.0 : 0.3}), depth > 0.0)
          << x << ' ' << y << ": " << depth;
      ++(depth > 0.0 ? inside : outside);
    }
  }
  EXPECT_GT(inside, 30);
  EXPECT_GT(outside, 100);
}

Contact random_contact(std::mt19937_64& random) {
  const double draw = uniform(random, 0.0, 1.0);
  const ContactKind kind = draw < 0.4   ? ContactKind::kSurface
                           : draw < 0.8 ? ContactKind::kPoint
                                        : ContactKind::kGrasp;
  const Vector3d position(uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5),
                          uniform(random, 0.0, 1.0));
  const double tilt = uniform(random, 0.0, 1.2), azimuth = uniform(random, -3.0, 3.0);
  const Vector3d normal(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                        std::cos(tilt));
  const double yaw = uniform(random, -3.0, 3.0);
  const Vector3d forward = Eigen::AngleAxisd(yaw, normal) * Vector3d(normal.unitOrthogonal());
  Contact contact = contact_at(kind, position, normal, forward);
  contact.effector.friction = uniform(random, 0.3, 1.0);
  contact.effector.max_force_N = uniform(random, 0.3, 3.0) * kWeight_N;
  if (kind == ContactKind::kGrasp) contact.effector.max_moment_Nm = uniform(random, 0.0, 10.0);
  if (kind == ContactKind::kSurface && uniform(random, 0.0, 1.0) < 0.3) contact.forward.reset();
  return contact;
}

TEST(BalanceRegion, HoldsOnlyWhatTheCertificateBalancesOnRandomContacts) {
  const Block block;
  std::mt19937_64 random(11);
  constexpr int kSets = test::kSanitized ? 12 : 60;
  int regions = 0, points = 0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<Contact> contacts(static_cast<std::size_t>(2 + set % 4));
    for (Contact& contact : contacts) contact = random_contact(random);
    const BalanceRegion region = region_of(contacts);
    if (region.empty()) continue;
    ++regions;
    for (int i = 0; i < 400; ++i) {
      const Vector3d at(uniform(random, -0.6, 0.6), uniform(random, -0.6, 0.6),
                        uniform(random, 0.0, 1.5));
      if (region.depth_m(at.head<2>()) < kNear_m) continue;
      ++points;
      EXPECT_TRUE(block.balances(contacts, at)) << set << ": " << at.transpose();
    }
  }
  EXPECT_GT(regions, kSets / 12);
  EXPECT_GT(points, kSets);
}

}  // namespace
}  // namespace locograph::balance_region_test
