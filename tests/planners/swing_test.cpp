// Arcs of what swings from one place to another.
#include <gtest/gtest.h>
#include <locograph/planners/offline/motion/swing.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "planners/segment_problems.h"

namespace locograph::swing_test {
namespace {

/// A foot of COMAN+ goes 0.3 m ahead, on to a place that is higher or not.
class SwingTest : public testing::Test {
 protected:
  explicit SwingTest(double up_m = 0.0) {
    task = test::stance_task("slanted_wall");
    before = test::contact_of(task.start, "right_foot");
    before.forward = Eigen::Vector3d::UnitX();
    after = before;
    after.position += Eigen::Vector3d(0.3, 0.0, up_m);
    swing.left = &before;
    swing.reached = &after;
    swing.from = link_at(before);
    swing.to = link_at(after);
  }

  static Eigen::Isometry3d link_at(const Contact& contact) {
    Eigen::Isometry3d link = Eigen::Isometry3d::Identity();
    link.linear() = axes_in_world(contact) * axes_in_link(contact.effector).transpose();
    link.translation() = contact.position - link.linear() * contact.effector.point;
    return link;
  }

  std::vector<Contact> places(double t, const ArcOptions& options) const {
    std::vector<Contact> places;
    swing.add_places(*task.robot->robot, t, options, places);
    return places;
  }

  /// At a time when there is one.
  Eigen::Vector3d place(double t, const ArcOptions& options) const {
    return places(t, options).at(0).position;
  }

  /// The least height of all that is between these parts of the way across.
  double least_height(double from, double to, const ArcOptions& options) const {
    double least = 1.0;
    for (int i = 0; i <= 1000; ++i) {
      const Eigen::Vector3d at = place(1e-3 * i, options);
      const double gone = (at.x() - before.position.x()) / 0.3;
      if (gone >= from && gone <= to) least = std::min(least, at.z());
    }
    return least;
  }

  Task task;
  Contact before, after;
  Swing swing;
};

TEST_F(SwingTest, BeginsAndEndsAtItsPlaces) {
  for (const bool climb_first : {false, true}) {
    for (const bool with_axes : {false, true}) {
      const ArcOptions arc{.with_axes = with_axes, .away_m = 0.1, .climb_first = climb_first};
      EXPECT_LT((place(0.0, arc) - before.position).norm(), 1e-12);
      EXPECT_LT((place(1.0, arc) - after.position).norm(), 1e-12);
      for (const double t : {0.0, 0.4, 1.0}) {
        const std::vector<Contact> at = places(t, arc);
        ASSERT_EQ(at.size(), 1U);
        EXPECT_EQ(at[0].name(), "right_foot");
        EXPECT_EQ(at[0].effector.kind, with_axes ? ContactKind::kSurface : ContactKind::kPoint);
      }
    }
  }
}

TEST_F(SwingTest, IsAboveFlatGroundInTheMiddleAndNeverBelow) {
  for (const double height_m : {0.05, 0.12}) {
    const ArcOptions arc{.height_m = height_m};
    EXPECT_GT(least_height(0.25, 0.75, arc), 0.6 * height_m);
    EXPECT_GE(least_height(0.0, 1.0, arc), 0.0);
    double highest = 0.0;
    for (int i = 0; i <= 100; ++i) highest = std::max(highest, place(0.01 * i, arc).z());
    EXPECT_LT(highest, height_m + 1e-9);
  }
}

TEST_F(SwingTest, SolesTurnEvenlyBetweenBothPlaces) {
  after.forward = Eigen::Vector3d(1.0, 1.0, 0.0);
  swing.to = link_at(after);
  const auto forward = [&](double t) { return places(t, {}).at(0).forward.value(); };
  EXPECT_LT(angle_between(forward(0.0), *before.forward), 1e-7);
  EXPECT_LT(angle_between(forward(1.0), *after.forward), 1e-7);
  EXPECT_NEAR(angle_between(forward(0.5), *before.forward), 0.5 * std::numbers::pi / 4.0, 1e-9);
}

TEST_F(SwingTest, BulgesToTheSideThatIsAskedFor) {
  // Both are as high: away from the place that it comes from.
  const Eigen::Vector3d bulge = place(0.5, {.away_m = 0.1}) - place(0.5, {});
  EXPECT_NEAR(bulge.norm(), 0.1, 1e-9);
  EXPECT_NEAR(bulge.x(), 0.1, 1e-9);
}

TEST_F(SwingTest, GoesUpOverWhatLiesBetween) {
  const ArcOptions arc{.up_m = 0.2};
  EXPECT_TRUE(swing.follows_arc(arc));
  const Eigen::Vector3d higher = place(0.5, arc) - place(0.5, {});
  EXPECT_LT((higher - Eigen::Vector3d(0.0, 0.0, 0.2)).norm(), 1e-9);
  EXPECT_LT((place(0.0, arc) - before.position).norm(), 1e-12);
  EXPECT_LT((place(1.0, arc) - after.position).norm(), 1e-12);
}

TEST_F(SwingTest, MovesAlongNormalsOnlyWhereNoMoreIsAskedFor) {
  const ArcOptions arc{.ends_only = true};
  for (const double t : {0.4, 0.5, 0.6}) EXPECT_TRUE(places(t, arc).empty()) << t;
  for (const double t : {0.05, 0.15, 0.25}) {
    const Eigen::Vector3d off = place(t, arc) - before.position;
    EXPECT_LT(off.head<2>().norm(), 1e-12);
    EXPECT_GT(off.z(), 0.0);
    const Eigen::Vector3d down = place(1.0 - t, arc) - after.position;
    EXPECT_NEAR((down - off).norm(), 0.0, 1e-12) << "the same backwards";
  }
  EXPECT_NEAR(place(0.3, arc).z(), arc.height_m, 1e-12);
}

TEST_F(SwingTest, WhatComesFromTheAirOnlyTouchesDown) {
  swing.left = nullptr;
  EXPECT_TRUE(places(0.0, {}).empty());
  EXPECT_TRUE(places(0.5, {}).empty());
  EXPECT_NEAR(place(0.75, {}).x(), after.position.x(), 1e-12);
  EXPECT_GT(place(0.75, {}).z(), 0.03);
  EXPECT_LT((place(1.0, {}) - after.position).norm(), 1e-12);
}

TEST_F(SwingTest, WhatStaysInTheAirOnlyLiftsOff) {
  swing.reached = nullptr;
  EXPECT_LT((place(0.0, {}) - before.position).norm(), 1e-12);
  EXPECT_NEAR(place(0.25, {}).x(), before.position.x(), 1e-12);
  EXPECT_GT(place(0.25, {}).z(), 0.03);
  EXPECT_TRUE(places(0.5, {}).empty());
  EXPECT_TRUE(places(1.0, {}).empty());
}

class SwingUpAStepTest : public SwingTest {
 protected:
  SwingUpAStepTest() : SwingTest(0.2) {}
};

TEST_F(SwingUpAStepTest, IsAboveItBeforeItHasGoneFarWhereItClimbsFirst) {
  EXPECT_GT(least_height(0.1, 0.999, {.climb_first = true}), 0.2);
  EXPECT_LT(least_height(0.1, 0.999, {}), 0.2) << "else both at once";
}

TEST_F(SwingUpAStepTest, ComesDownLastWhereItClimbsFirst) {
  std::swap(swing.left, swing.reached);
  std::swap(swing.from, swing.to);
  EXPECT_GT(least_height(1.0 / 3.0, 0.999, {.climb_first = true}), 0.2);
}

TEST(SwingsTest, AreOfAllThatLeavesOrReachesContacts) {
  const auto problem = test::step_forward_problem();
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  const std::vector<Swing> one = swings_of(space);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].left, problem->segment.left.data());
  EXPECT_EQ(one[0].reached, problem->segment.reached.data());
  for (const auto& [pose, contact] :
       {std::pair{one[0].from, one[0].left}, std::pair{one[0].to, one[0].reached}}) {
    EXPECT_LT((pose * contact->effector.point - contact->position).norm(), 1e-6);
  }

  // Of another end effector: they have nothing to do with each other.
  Segment segment = problem->segment;
  segment.reached[0].effector.name = "another";
  space.set_segment(segment);
  const std::vector<Swing> two = swings_of(space);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].reached, nullptr);
  EXPECT_EQ(two[1].left, nullptr);

  segment.left.clear();
  segment.reached.clear();
  EXPECT_TRUE(swings_of(space).empty());
}

}  // namespace
}  // namespace locograph::swing_test
