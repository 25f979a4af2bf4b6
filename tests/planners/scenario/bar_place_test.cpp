// Planners and the judge each work out for themselves where contacts touch bars: both say the same.
#include <gtest/gtest.h>
#include <locograph/check/bar_contact.h>
#include <locograph/check/limits.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/scenario/bar_place.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

namespace locograph {
namespace {

using Eigen::Vector3d;

constexpr int kContacts = 10000;

class BarContacts {
 public:
  Bar bar() {
    Bar bar{.name = "rail", .from = vector(1.0), .to = {}, .radius_m = between(0.005, 0.1)};
    bar.to = bar.from + between(0.05, 2.0) * direction();
    return bar;
  }

  /// On the bar, up to where nobody would call it so: turned, off its axis, past its ends.
  Contact near(const Bar& bar, ContactKind kind) {
    const Vector3d along = (bar.to - bar.from).normalized();
    const double length_m = (bar.to - bar.from).norm();
    const Vector3d out = Vector3d(along.cross(direction())).normalized();
    Contact contact;
    contact.effector.kind = kind;
    contact.effector.point = vector(0.1);
    contact.effector.normal = between(0.1, 3.0) * direction();
    contact.effector.forward = direction();
    contact.effector.half_x_m = between(0.01, 0.2);
    contact.effector.half_y_m = between(0.01, 0.2);
    const double at_m = length_m * between(-0.3, 1.3);
    contact.position = bar.from + at_m * along + amount() * direction();
    const Vector3d aside = along.cross(out);
    if (kind != ContactKind::kGrasp) contact.position += (bar.radius_m + amount()) * out;
    if (kind == ContactKind::kSurface) contact.position += between(-0.3, 0.3) * aside;
    contact.normal = between(0.1, 3.0) * turned(out);
    contact.forward = kind == ContactKind::kGrasp ? Vector3d(turned(aside)) : direction();
    if (kind == ContactKind::kGrasp && between(0.0, 1.0) < 0.5) *contact.forward *= -1.0;
    return contact;
  }

 private:
  double between(double lower, double upper) { return uniform(random_, lower, upper); }
  Vector3d vector(double most) {
    const double x = between(-most, most), y = between(-most, most);
    return {x, y, between(-most, most)};
  }
  Vector3d direction() {
    Vector3d v = vector(1.0);
    while (!(v.norm() > 0.1)) v = vector(1.0);
    return v.normalized();
  }
  /// About the size of tolerances, or nothing.
  double amount() {
    const double size = between(0.0, 1.0);
    return size < 0.3 ? 0.0 : std::pow(10.0, between(-6.0, size < 0.9 ? -2.5 : 0.0));
  }
  Vector3d turned(const Vector3d& v) { return Eigen::AngleAxisd(amount(), direction()) * v; }

  std::mt19937_64 random_{20};
};

/// The link's pose that closes a contact.
Eigen::Isometry3d closed(const Contact& contact) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = axes_in_world(contact) * axes_in_link(contact.effector).transpose();
  pose.translation() = contact.position - pose.linear() * contact.effector.point;
  return pose;
}

void expect_same_line(const std::vector<Eigen::Vector2d>& ours,
                      const std::vector<Eigen::Vector2d>& judged) {
  ASSERT_EQ(ours.size(), judged.size());
  for (std::size_t end = 0; end < ours.size(); ++end)
    EXPECT_LT((ours[end] - judged[end]).norm(), 1e-9);
}

void expect_agreement(ContactKind kind) {
  BarContacts random;
  int on = 0, off = 0, nowhere = 0, past = 0, lines = 0, aside = 0;
  for (int i = 0; i < kContacts; ++i) {
    SCOPED_TRACE(i);
    const Bar bar = random.bar();
    const Contact contact = random.near(bar, kind);
    const double ours_m = gap_to_bar_m(bar, contact), judged_m = off_bar_m(contact, bar);
    ASSERT_EQ(std::isinf(ours_m), std::isinf(judged_m));
    if (std::isinf(judged_m)) {
      ++nowhere;
      continue;
    }
    // Aside of a sole the judge measures across the bar, planners in the sole's plane: for as much
    // as that may be turned, half a millionth of a metre in a metre.
    ASSERT_NEAR(ours_m, judged_m, kind == ContactKind::kSurface ? 1e-6 : 1e-12);
    const bool touches = judged_m <= limits::kClosed_m;
    ++(touches ? on : off);
    const double past_m = beyond_ends_m(bar, contact.position);
    ASSERT_NEAR(past_ends_m(bar, contact.position), past_m, 1e-12);
    if (past_m > 0.0) ++past;
    if (kind != ContactKind::kSurface || !touches) continue;
    const SoleOnBar judged = sole_on_bar(bar, contact, closed(contact));
    expect_same_line(line_on_bar(bar, contact), judged.line);
    ++(judged.line.empty() ? aside : lines);
  }
  const int often = kContacts / 20;
  EXPECT_GT(on, often);
  EXPECT_GT(off, often);
  EXPECT_GT(nowhere, often);
  EXPECT_GT(past, often);
  if (kind != ContactKind::kSurface) return;
  EXPECT_GT(lines, often);
  EXPECT_GT(aside, often);
}

TEST(BarPlace, PlannersAndTheJudgeAgreeOnTenThousandPoints) {
  expect_agreement(ContactKind::kPoint);
}

TEST(BarPlace, PlannersAndTheJudgeAgreeOnTenThousandSoles) {
  expect_agreement(ContactKind::kSurface);
}

TEST(BarPlace, PlannersAndTheJudgeAgreeOnTenThousandGrasps) {
  expect_agreement(ContactKind::kGrasp);
}

TEST(BarPlace, WheelsTouchNoBar) {
  BarContacts random;
  const Bar bar = random.bar();
  const Contact wheel = random.near(bar, ContactKind::kWheel);
  EXPECT_TRUE(std::isinf(gap_to_bar_m(bar, wheel)));
  EXPECT_TRUE(std::isinf(off_bar_m(wheel, bar)));
}

/// A sole of 0.2 m x 0.1 m on a bar along y.
class SoleAcrossBar : public ::testing::Test {
 protected:
  SoleAcrossBar() {
    sole_.effector.half_x_m = 0.1;
    sole_.effector.half_y_m = 0.05;
    sole_.position = {0.0, 0.0, 0.02};
    sole_.forward = Vector3d::UnitX();
  }
  Bar bar_{.name = "rung", .from = {0.0, -1.0, 0.0}, .to = {0.0, 1.0, 0.0}, .radius_m = 0.02};
  Contact sole_;
};

TEST_F(SoleAcrossBar, TouchesItAllAcross) {
  EXPECT_EQ(gap_to_bar_m(bar_, sole_), 0.0);
  expect_same_line(line_on_bar(bar_, sole_), {{0.0, -0.05}, {0.0, 0.05}});
}

TEST_F(SoleAcrossBar, TouchesItAlongItsBorder) {
  sole_.position.x() = 0.1;
  expect_same_line(line_on_bar(bar_, sole_), {{-0.1, -0.05}, {-0.1, 0.05}});
}

TEST_F(SoleAcrossBar, TouchesItUpToItsEnd) {
  sole_.position.y() = 1.02;
  expect_same_line(line_on_bar(bar_, sole_), {{0.0, -0.05}, {0.0, -0.02}});
  EXPECT_NEAR(past_ends_m(bar_, sole_.position), 0.02, 1e-15);
  sole_.position.y() = 1.06;
  EXPECT_TRUE(line_on_bar(bar_, sole_).empty());
}

TEST_F(SoleAcrossBar, DoesNotTouchItAside) {
  sole_.position.x() = 0.105;
  EXPECT_EQ(gap_to_bar_m(bar_, sole_), 0.0);
  EXPECT_TRUE(line_on_bar(bar_, sole_).empty());
}

}  // namespace
}  // namespace locograph
