// What a contact can bear where only a part of it lies on something.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/execution/held_contact.h>

#include <cmath>

namespace locograph {
namespace {

const Contact kSole{.effector = {.name = "foot",
                                 .link = "sole",
                                 .half_x_m = 0.1,
                                 .half_y_m = 0.05,
                                 .friction = 0.5,
                                 .max_force_N = 1000.0},
                    .forward = Eigen::Vector3d::UnitX()};

/// How far a wrench is beyond the cone; below 0: inside.
double beyond(const HeldContact& held, const Eigen::Matrix<double, 6, 1>& wrench) {
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < held.cone().rows(); ++i) {
    const WrenchRow limit = held.row(i);
    most = std::max(most, limit.gradient.dot(wrench) + limit.offset);
  }
  return most;
}

/// 100 N straight on the sole at a place on it.
Eigen::Matrix<double, 6, 1> pressed_at(double x, double y) {
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << 0.0, 0.0, 100.0, 100.0 * y, -100.0 * x, 0.0;
  return wrench;
}

TEST(HeldContact, BearsWhereItLiesOnSomethingOnly) {
  const std::vector<Eigen::Vector2d> front = {
      {0.02, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {0.02, 0.05}};
  const HeldContact part(kSole, front, {.friction = 1.0, .area = 1.0});
  const HeldContact whole(kSole, {}, {.friction = 1.0, .area = 1.0});
  EXPECT_LT(beyond(whole, pressed_at(-0.09, 0.04)), 0.0);
  EXPECT_GT(beyond(part, pressed_at(0.0, 0.0)), 0.0);
  EXPECT_LT(beyond(part, pressed_at(0.06, 0.0)), 0.0);
  EXPECT_LT(beyond(part, pressed_at(0.095, 0.04)), 0.0);
  EXPECT_LT(beyond(part, pressed_at(0.025, -0.045)), 0.0);
  EXPECT_GT(beyond(part, pressed_at(0.105, 0.0)), 0.0);
  // Sideways at the middle of what bears there is a yaw moment about the point, and none about it.
  Eigen::Matrix<double, 6, 1> sideways = pressed_at(0.06, 0.0);
  sideways[1] = 30.0;
  sideways[5] = 0.06 * 30.0;
  EXPECT_LT(beyond(part, sideways), 0.0);
}

TEST(HeldContact, AGraspMayBePulledAt) {
  const HoldingShares shares{.friction = 0.8};
  const HeldContact held({.effector = {.name = "hand",
                                       .link = "hand",
                                       .kind = ContactKind::kGrasp,
                                       .max_force_N = 200.0,
                                       .max_moment_Nm = 5.0},
                          .forward = Eigen::Vector3d::UnitX()},
                         {}, shares);
  EXPECT_FALSE(held.pressed());
  EXPECT_TRUE(HeldContact(kSole, {}).pressed());
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << -150.0, 0.0, -150.0, 3.9, 0.0, -3.9;
  EXPECT_LT(beyond(held, wrench), 0.0);
  EXPECT_LT(beyond(held, -wrench), 0.0);
  wrench[3] = 4.1;  // of 5 N m it counts on 80 %
  EXPECT_GT(std::max(beyond(held, wrench), beyond(held, -wrench)), 0.0);
}

TEST(HeldContact, OnALineItDoesNotTurnAboutIt) {
  const std::vector<Eigen::Vector2d> line = {{0.03, -0.05}, {0.03, 0.05}};
  const HeldContact held(kSole, line, {.friction = 1.0, .area = 1.0});
  EXPECT_LE(beyond(held, pressed_at(0.03, 0.02)), 1e-9);
  EXPECT_GT(beyond(held, pressed_at(0.031, 0.02)), 0.0);
}

TEST(HeldContact, SharesAreUsed) {
  const HeldContact held(kSole, {}, {.friction = 0.5, .area = 0.5});
  EXPECT_GT(beyond(held, pressed_at(0.06, 0.0)), 0.0);
  EXPECT_LT(beyond(held, pressed_at(0.04, 0.0)), 0.0);
  Eigen::Matrix<double, 6, 1> sliding = pressed_at(0.0, 0.0);
  sliding[0] = 30.0;
  EXPECT_GT(beyond(held, sliding), 0.0);
  // The reserve has all friction, and no more area.
  const auto with_reserve = [&](const Eigen::Matrix<double, 6, 1>& wrench) {
    double worst = -1e9;
    for (int i = 0; i < held.cone().rows(); ++i) {
      const WrenchRow row = held.row(i, 1.0);
      worst = std::max(worst, row.gradient.dot(wrench) + row.offset);
    }
    return worst;
  };
  EXPECT_LT(with_reserve(sliding), 0.0);
  EXPECT_GT(with_reserve(pressed_at(0.06, 0.0)), 0.0);
  EXPECT_THROW(HeldContact(kSole, {}, {.friction = 0.8, .most_friction = 0.7}), Error);
  EXPECT_THROW(HeldContact(kSole, {}, {.friction = 0.0}), Error);
  EXPECT_THROW(HeldContact(kSole, {}, {.area = 1.1}), Error);
}

TEST(InnerRectangle, IsTheLargestInside) {
  const std::vector<Eigen::Vector2d> skewed = {{0, 0}, {0.1, 0}, {0.12, 0.04}, {0.02, 0.04}};
  const InnerRectangle inner = inner_rectangle(skewed);
  EXPECT_GE(inner.lower.x(), 0.0199);
  EXPECT_LE(inner.upper.x(), 0.1001);
  EXPECT_NEAR(inner.upper.y() - inner.lower.y(), 0.04, 0.002);
  const std::vector<Eigen::Vector2d> triangle = {{0, 0}, {0.1, 0}, {0, 0.1}};
  const InnerRectangle half = inner_rectangle(triangle);
  EXPECT_NEAR((half.upper - half.lower).prod(), 0.0025, 1e-5);
  const std::vector<Eigen::Vector2d> point = {{0.01, 0.02}};
  EXPECT_EQ(inner_rectangle(point).lower, inner_rectangle(point).upper);
}

}  // namespace
}  // namespace locograph
