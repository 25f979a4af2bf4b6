#include <gtest/gtest.h>
#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/margin_contacts.h>

#include <vector>

namespace locograph::margin_contacts_test {
namespace {

constexpr double kMass_kg = 10.0, kWeight_N = kMass_kg * 9.81;

BearingContact sole() {
  BearingContact bearing;
  bearing.contact.effector.link = "block";
  bearing.contact.effector.half_x_m = 0.1;
  bearing.contact.effector.half_y_m = 0.05;
  bearing.contact.effector.friction = 0.5;
  bearing.contact.effector.max_force_N = 1e4;
  bearing.contact.forward = Eigen::Vector3d::UnitX();
  return bearing;
}

TEST(MarginContacts, WithoutAMarginAreTheSame) {
  BearingContact cut = sole();
  cut.area = {{0.1, 0.05}, {-0.1, 0.05}, {0.0, -0.05}};
  const std::vector<BearingContact> same =
      with_margin(std::vector{cut}, ExecutionMargin::none(), kWeight_N);
  EXPECT_EQ(same[0].contact.effector.friction, 0.5);
  EXPECT_EQ(same[0].contact.effector.half_x_m, 0.1);
  EXPECT_EQ(same[0].area, cut.area);
  EXPECT_EQ(same[0].least_N, 0.0);
}

TEST(MarginContacts, HaveLessFrictionSmallerAreasAndALeastForce) {
  BearingContact cut = sole();
  cut.area = {{0.1, 0.05}, {0.1, -0.05}, {0.0, -0.05}, {0.0, 0.05}};  // about x = 0.05
  const std::vector<BearingContact> counted =
      with_margin(std::vector{cut}, ExecutionMargin(), kWeight_N);
  EXPECT_DOUBLE_EQ(counted[0].contact.effector.friction, 0.325);
  EXPECT_DOUBLE_EQ(counted[0].contact.effector.half_y_m, 0.0325);
  EXPECT_NEAR(counted[0].area[0].x(), 0.05 + 0.65 * 0.05, 1e-12);
  EXPECT_NEAR(counted[0].area[2].x(), 0.05 - 0.65 * 0.05, 1e-12);
  EXPECT_DOUBLE_EQ(counted[0].least_N, 0.03 * kWeight_N);
}

TEST(MarginContacts, GraspsNeedNoLeastForce) {
  BearingContact grasp;
  grasp.contact.effector.kind = ContactKind::kGrasp;
  grasp.contact.effector.max_force_N = 500.0;
  grasp.contact.effector.max_moment_Nm = 10.0;
  const ExecutionMargin margin{.friction = 0.6, .area = 0.5};
  const BearingContact counted = with_margin(std::vector{grasp}, margin, kWeight_N)[0];
  EXPECT_EQ(counted.least_N, 0.0);
  EXPECT_EQ(counted.contact.effector.max_force_N, 300.0);
  EXPECT_EQ(counted.contact.effector.max_moment_Nm, 5.0);
}

/// A sole bears kPart of its half length in regions, and of that the share of the margin.
TEST(MarginContacts, TheShareIsWhatLeavesTheCentreOfMassInside) {
  const ExecutionMargin margin{.friction = 1.0, .area = 0.5, .least_force = 0.0};
  const auto share_at = [&](double x) {
    const Eigen::Vector2d centre(x, 0.0);
    return share_of_margin(kMass_kg, std::vector{sole()}, margin, {&centre, 1});
  };
  const double part = 1.0 - kRegionMargin;
  EXPECT_EQ(share_at(0.0), 1.0);
  EXPECT_NEAR(share_at(0.75 * part * 0.1), 0.5, 1.0 / 64.0);
  EXPECT_EQ(share_at(0.2), 0.0);
}

TEST(MarginContacts, AStanceHasTheShareThatLeavesRoom) {
  const ExecutionMargin margin{.area = 0.05};
  EXPECT_EQ(share_of_margin(kMass_kg, std::vector{sole()}, ExecutionMargin()), 1.0);
  const double share = share_of_margin(kMass_kg, std::vector{sole()}, margin);
  EXPECT_GT(share, 0.5);
  EXPECT_LT(share, 1.0);
}

}  // namespace
}  // namespace locograph::margin_contacts_test
