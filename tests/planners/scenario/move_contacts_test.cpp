// Contacts moved at random on what they lie on, and tasks made of them.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/planners/offline/stance/started_task.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/move_contacts.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planners/stance_tasks.h"

namespace locograph::move_contacts_test {
namespace {

constexpr double kMost_m = 0.1;
constexpr int kDraws = 200;

/// A table of 1 m x 0.3 m that leans, and a bar of 1 m along y.
World table_and_bar() {
  Surface table;
  table.name = "table";
  table.world_from_surface.linear() =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 0.5, 0.2).normalized()).toRotationMatrix();
  table.world_from_surface.translation() = Eigen::Vector3d(0.3, -0.2, 0.7);
  table.half_x_m = 0.5;
  table.half_y_m = 0.15;
  Bar bar;
  bar.name = "bar";
  bar.from = Eigen::Vector3d(3.0, -0.5, 1.0);
  bar.to = Eigen::Vector3d(3.0, 0.5, 1.0);
  bar.radius_m = 0.02;
  World world;
  world.surfaces = {table};
  world.bars = {bar};
  return world;
}

const Surface& table() {
  static const World world = table_and_bar();
  return world.surfaces[0];
}

/// At a place of the table, in its frame.
Contact on_table(ContactKind kind, double x_m, double y_m, double yaw_rad = 0.0) {
  const Eigen::Isometry3d& pose = table().world_from_surface;
  Contact contact;
  contact.effector.name = "it";
  contact.effector.kind = kind;
  contact.effector.half_x_m = 0.08;
  contact.effector.half_y_m = 0.035;
  contact.position = pose * Eigen::Vector3d(x_m, y_m, 0.0);
  contact.normal = pose.linear().col(2);
  contact.forward = pose.linear() * Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  return contact;
}

Contact grasp_at(double y_m) {
  Contact contact;
  contact.effector.name = "it";
  contact.effector.kind = ContactKind::kGrasp;
  contact.position = {3.0, y_m, 1.0};
  contact.normal = Eigen::Vector3d::UnitZ();
  contact.forward = Eigen::Vector3d::UnitX();
  return contact;
}

/// Where it gets, again and again.
std::vector<Contact> moved(const Contact& contact) {
  std::mt19937_64 random(1);
  std::vector<Contact> all;
  for (int i = 0; i < kDraws; ++i) {
    Stance stance{{contact}};
    move_contacts(stance, table_and_bar(), kMost_m, random);
    EXPECT_EQ(stance.contacts[0].normal, contact.normal);
    EXPECT_EQ(stance.contacts[0].forward, contact.forward);
    all.push_back(stance.contacts[0]);
  }
  return all;
}

/// In the frame of the table.
std::vector<Eigen::Vector3d> places_on_table(const Contact& contact) {
  std::vector<Eigen::Vector3d> places;
  for (const Contact& one : moved(contact)) {
    EXPECT_TRUE(lies_on(table(), one));
    places.push_back(table().world_from_surface.inverse() * one.position);
    EXPECT_NEAR(places.back().z(), 0.0, 1e-12);
  }
  return places;
}

/// The least and the largest along an axis.
std::pair<double, double> extent(const std::vector<Eigen::Vector3d>& places, int axis) {
  const auto less = [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; };
  const auto [least, most] = std::ranges::minmax_element(places, less);
  return {(*least)[axis], (*most)[axis]};
}

/// Nearly all of the way is used, and no more.
void expect_extent(const std::vector<Eigen::Vector3d>& places, int axis, double least,
                   double most) {
  const auto [smallest, largest] = extent(places, axis);
  const double unused = 0.1 * (most - least);
  EXPECT_GE(smallest, least - 1e-12);
  EXPECT_LE(smallest, least + unused + 1e-12);
  EXPECT_LE(largest, most + 1e-12);
  EXPECT_GE(largest, most - unused - 1e-12);
}

TEST(MoveContacts, APointMovesAsFarAsAskedInBothDirections) {
  const std::vector<Eigen::Vector3d> places =
      places_on_table(on_table(ContactKind::kPoint, 0.1, -0.02));
  expect_extent(places, 0, 0.1 - kMost_m, 0.1 + kMost_m);
  expect_extent(places, 1, -0.02 - kMost_m, -0.02 + kMost_m);
}

TEST(MoveContacts, APointStaysWithinTheBorder) {
  const std::vector<Eigen::Vector3d> places =
      places_on_table(on_table(ContactKind::kPoint, 0.48, -0.15));
  expect_extent(places, 0, 0.48 - kMost_m, 0.5);
  expect_extent(places, 1, -0.15, -0.15 + kMost_m);
}

TEST(MoveContacts, ASoleStaysWholeOnItsSurface) {
  expect_extent(places_on_table(on_table(ContactKind::kSurface, 0.4, 0.1)), 0, 0.4 - kMost_m, 0.42);
  const double yaw_rad = std::numbers::pi / 2.0;
  const std::vector<Eigen::Vector3d> across =
      places_on_table(on_table(ContactKind::kSurface, 0.4, 0.0, yaw_rad));
  expect_extent(across, 0, 0.4 - kMost_m, 0.465);
  expect_extent(across, 1, -0.07, 0.07);
}

TEST(MoveContacts, ASoleThatReachesBeyondTheBorderGetsNoFurtherOut) {
  const std::vector<Eigen::Vector3d> places =
      places_on_table(on_table(ContactKind::kSurface, 0.47, 0.0));
  expect_extent(places, 0, 0.47 - kMost_m, 0.47);
}

TEST(MoveContacts, AGraspMovesAlongItsBarOnlyAndNotBeyondItsEnd) {
  std::vector<Eigen::Vector3d> places;
  for (const Contact& one : moved(grasp_at(0.45))) places.push_back(one.position);
  expect_extent(places, 1, 0.45 - kMost_m, 0.5);
  for (const int axis : {0, 2}) {
    const auto [least, most] = extent(places, axis);
    EXPECT_EQ(least, most);
    EXPECT_EQ(least, grasp_at(0.45).position[axis]);
  }
}

TEST(MoveContacts, WhatLiesOnNothingStays) {
  Contact lost = on_table(ContactKind::kPoint, 0.0, 0.0);
  lost.position.z() += 0.3;
  for (const Contact& one : moved(lost)) EXPECT_EQ(one.position, lost.position);
}

TEST(MoveContacts, EachContactMovesByItself) {
  Stance stance{
      {on_table(ContactKind::kPoint, -0.2, 0.0), on_table(ContactKind::kPoint, 0.2, 0.0)}};
  const Stance before = stance;
  std::mt19937_64 random(1);
  move_contacts(stance, table_and_bar(), kMost_m, random);
  const Eigen::Vector3d first = stance.contacts[0].position - before.contacts[0].position;
  const Eigen::Vector3d second = stance.contacts[1].position - before.contacts[1].position;
  EXPECT_GT((first - second).norm(), 1e-6);
}

/// How far contacts of the same end effectors are apart at most.
double furthest_m(const Stance& a, Stance b) {
  double most = 0.0;
  for (const Contact& contact : a.contacts) {
    most = std::max(most, (contact.position - test::contact_of(b, contact.name()).position).norm());
  }
  return most;
}

/// Else each transition would choose one, and a sole that is held turn meanwhile.
TEST(StartedTask, GivesSolesTheDirectionThatTheyHaveAtTheStart) {
  Scenario scenario = test::changed_scenario("standing_up", {});
  const Task given = started_task(scenario).task;
  for (Stance* stance : {&scenario.contacts->start, &scenario.contacts->goals.back()}) {
    for (Contact& contact : stance->contacts) contact.forward.reset();
  }
  const Task open = started_task(scenario).task;
  for (const char* foot : {"left_foot", "right_foot"}) {
    Stance start = open.start, goal = open.goals.back(), start_given = given.start;
    const auto forward = test::contact_of(start, foot).forward;
    ASSERT_TRUE(forward && test::contact_of(goal, foot).forward) << foot;
    EXPECT_LT(angle_between(*forward, *test::contact_of(start_given, foot).forward), 5e-3);
    EXPECT_LT(angle_between(*forward, *test::contact_of(goal, foot).forward), 1e-9);
  }
  Stance start = open.start;
  EXPECT_FALSE(test::contact_of(start, "left_hand").forward) << "a ball turns";
}

TEST(MovedTask, HasOtherContactsOnTheSameSurfacesAndAStartThatStands) {
  constexpr double kFar_m = 0.02;
  const Scenario scenario = test::changed_scenario("standing_up", {});
  const Task given = started_task(scenario).task;
  const StartedTask started = started_task(scenario, {.most_m = kFar_m, .seed = 3});
  const Task& task = started.task;
  EXPECT_GE(task.moves.draws, 1);
  ASSERT_EQ(task.goals.size(), given.goals.size());
  std::vector<std::pair<Stance, Stance>> stances = {{task.start, given.start}};
  for (std::size_t g = 0; g < task.goals.size(); ++g) {
    stances.emplace_back(task.goals[g], given.goals[g]);
  }
  for (const auto& [after, before] : stances) {
    EXPECT_GT(furthest_m(after, before), 1e-4);
    EXPECT_LE(furthest_m(after, before), std::numbers::sqrt2 * kFar_m + 1e-9);
    for (const Contact& contact : after.contacts) {
      EXPECT_TRUE(lies_on_something(task.world->world(), contact)) << contact.name();
    }
  }
  const Judge judge(task.robot->robot, task.world);
  const CheckReport report = judge.check(task.start_configuration, task.start, task.check);
  EXPECT_TRUE(report.feasible) << violation_text(report.worst());
}

TEST(MovedTask, IsTheSameForTheSameSeedOnly) {
  const Scenario scenario = test::changed_scenario("standing_up", {});
  const Task task = started_task(scenario, {.most_m = 0.02, .seed = 4}).task;
  const Task again = started_task(scenario, {.most_m = 0.02, .seed = 4}).task;
  const Task other = started_task(scenario, {.most_m = 0.02, .seed = 5}).task;
  EXPECT_EQ(furthest_m(task.start, again.start), 0.0);
  EXPECT_EQ(furthest_m(task.goals[0], again.goals[0]), 0.0);
  EXPECT_EQ(task.start_configuration, again.start_configuration);
  EXPECT_GT(furthest_m(task.start, other.start), 1e-4);
  EXPECT_GT(furthest_m(task.goals[0], other.goals[0]), 1e-4);
}

}  // namespace
}  // namespace locograph::move_contacts_test
