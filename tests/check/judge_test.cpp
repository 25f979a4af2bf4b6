#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/error.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/octree.h>

#include <cmath>

#include "check/centauro_on_wheels.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

KeyFrame key_frame(double time_s, const Eigen::Vector3d& position) {
  KeyFrame frame{time_s, Eigen::Isometry3d::Identity()};
  frame.pose.translation() = position;
  return frame;
}

TEST(Judge, AcceptsAStraightDriveOnRollingWheelsAndListsEveryConstraint) {
  const CheckReport report = check_with({}, centauro().drive(11, 0.08, 0.8));
  EXPECT_EQ(violated(report), std::set<std::string>{});
  EXPECT_EQ(report.configurations, 11);
  EXPECT_GT(report.samples, 80);
  const std::vector<std::string> names = {
      "not_finite",         "configuration_size",  "stance",
      "contact_claims",     "base_orientation",    "time_order",
      "step_size",          "joint_limits",        "velocity_limits",
      "base_velocity",      "acceleration_limits", "end_at_rest",
      "contact_position",   "contact_orientation", "contact_between",
      "contact_motion",     "contact_turn",        "contact_relabelled",
      "contact_on_surface", "lateral_slip",        "longitudinal_slip",
      "obstacle_distance",  "ground_penetration",  "touching_depth",
      "self_collision",     "static_balance",      "torque_limits",
      "plan_wrenches"};
  ASSERT_EQ(report.violations.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(report.violations[i].constraint, names[i]);
  EXPECT_NEAR(report.min_self_clearance_m.value(), 0.038, 1e-3);
  EXPECT_DOUBLE_EQ(report.min_clearance_m.value(), 0.5);
  EXPECT_NEAR(report.max_velocity_ratio.value(), 4.0 / 3.0 * 0.08 / kRadius / 0.8 / 20.0, 1e-9)
      << "from rest in one step";
  EXPECT_LT(report.max_contact_error_m.value(), 1e-4);
  EXPECT_LT(report.constraint("touching_depth").worst, 1e-4);
  EXPECT_LT(report.constraint("lateral_slip").worst, 1e-6);
  EXPECT_LT(report.constraint("longitudinal_slip").worst, 1e-6);
  EXPECT_GT(report.min_balance_margin.value(), 0.01);
  EXPECT_LT(report.max_torque_ratio.value(), 1.0);
  EXPECT_EQ(report.balance->wrenches.size(), 4u);
  // What nobody said is taken on trust, and what nothing limits is not judged.
  EXPECT_EQ(report.trusted,
            (std::vector<std::string>{"wheel_1: what it can bear", "wheel_2: what it can bear",
                                      "wheel_3: what it can bear", "wheel_4: what it can bear"}));
  for (const char* name : {"contact_claims", "base_velocity", "acceleration_limits",
                           "contact_motion", "contact_turn", "contact_relabelled"})
    EXPECT_FALSE(report.constraint(name).judged) << name;
}

/// A block that stands on the ground beside a wall that it may be in.
CheckReport beside_a_wall(const std::string& more) {
  const test::TemporaryFolder folder;
  const auto robot = std::make_shared<const Robot>(Robot::load(folder.write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><mass value='10'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial>" +
          more + "</link></robot>")));
  Contact sole;
  sole.effector = {.name = "sole",
                   .link = "block",
                   .half_x_m = 0.1,
                   .half_y_m = 0.1,
                   .friction = 0.5,
                   .max_force_N = 1000.0};
  World world;
  world.surfaces = {ground()};
  world.obstacles = {box("wall", {0.0, 0.0, 0.5}, {0.1, 4.0, 1.0})};
  return Judge(robot, std::move(world)).check(robot->neutral_configuration(), Stance{{sole}});
}

TEST(Judge, HasNoWordOnDistancesWithoutShapes) {
  const std::string seen = "<visual><geometry><box size='0.2 0.2 0.2'/></geometry></visual>";
  const std::string shape =
      "<collision><origin xyz='0 0 0.1'/><geometry><box size='0.2 0.2 0.2'/></geometry>"
      "</collision>";
  EXPECT_EQ(violated(beside_a_wall(shape)), std::set<std::string>{"obstacle_distance"});
  const CheckReport report = beside_a_wall(seen);
  EXPECT_EQ(violated(report), std::set<std::string>{});
  EXPECT_FALSE(report.feasible);
  for (const char* name :
       {"obstacle_distance", "ground_penetration", "touching_depth", "self_collision"}) {
    EXPECT_FALSE(report.constraint(name).judged) << name;
    EXPECT_EQ(report.constraint(name).why_not, "no link of the robot has a collision shape");
  }
  EXPECT_TRUE(report.constraint("static_balance").judged);
  EXPECT_FALSE(report.min_clearance_m.has_value());
  EXPECT_FALSE(report.min_self_clearance_m.has_value());
  EXPECT_EQ(violation_text(report.worst()),
            "obstacle_distance is not judged: no link of the robot has a collision shape");
}

TEST(Judge, FindsTheThinWallOnlyOnTheWay) {
  const std::vector<Obstacle> wall = {box("wall", {1.66, 0.0, 1.0}, {0.002, 4.0, 2.0})};
  Motion motion = centauro().drive(1, 0.08, 0.8);
  EXPECT_TRUE(check_with(wall, motion).feasible);
  motion.configurations[0] = centauro().at(3.24);
  EXPECT_TRUE(check_with(wall, motion).feasible);
}

TEST(Judge, TakesBothSignsOfAQuaternionForTheSameOrientation) {
  Motion motion = centauro().drive(4, 0.08, 0.8);
  motion.configurations[2].segment<4>(3) *= -1.0;
  EXPECT_TRUE(check_with({}, motion).feasible);
}

TEST(Judge, MeetsAnObstacleThatComesByWhenTheRobotDoesAndNotAtAnotherTime) {
  // Crosses the lane 2 m ahead between 4 s and 8 s.
  Obstacle cart = box("cart", {2.0, -3.0, 0.5}, {0.3, 0.3, 1.0});
  cart.motion = {key_frame(4.0, {2.0, -3.0, 0.5}), key_frame(8.0, {2.0, 3.0, 0.5})};
  Motion motion = centauro().drive(2, 4.0, 12.0);  // is at x = 2 after 6 s
  const CheckReport met = check_with({cart}, motion);
  EXPECT_EQ(violated(met), std::set<std::string>{"obstacle_distance"});
  EXPECT_NE(met.constraint("obstacle_distance").what.find("cart"), std::string::npos);
  EXPECT_NEAR(met.constraint("obstacle_distance").time_s, 6.0, 1.0);
  for (double& time : motion.time_s) time += 8.5;
  const CheckReport missed = check_with({cart}, motion);
  EXPECT_TRUE(missed.feasible) << missed.constraint("obstacle_distance").worst;
}

TEST(Judge, SeesAnObstacleRunThroughTheRobotThatStandsStill) {
  // 12 m/s: over in a tenth of a second of the ten that the step takes.
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.name = "ball";
  ball.size = {0.05, 0.0, 0.0};
  ball.world_from_obstacle.translation() << -3.0, 0.0, 0.8;
  ball.motion = {key_frame(7.31, {-3.0, 0.0, 0.8}), key_frame(7.81, {3.0, 0.0, 0.8})};
  const Motion motion = centauro().drive(2, 0.0, 10.0);
  EXPECT_EQ(violated(check_with({ball}, motion)), std::set<std::string>{"obstacle_distance"});
  ball.world_from_obstacle.translation().z() = 2.0;
  for (KeyFrame& frame : ball.motion) frame.pose.translation().z() = 2.0;
  EXPECT_TRUE(check_with({ball}, motion).feasible);
}

/// Across the robot's way; there from one time to another.
Obstacle wall_at(double x, double appears_s, double vanishes_s = kInfinity) {
  Obstacle wall = box("wall", {x, 0.0, 1.0}, {0.002, 4.0, 2.0});
  wall.appears_s = appears_s;
  wall.vanishes_s = vanishes_s;
  return wall;
}

TEST(Judge, RefusesAWallThatAppearsAsTheRobotIsInItAndAcceptsOneThatComesTooLate) {
  const Motion motion = centauro().drive(2, 4.0, 12.0);  // is at x = 2 after 6 s
  const auto violation = [&](double appears_s, double vanishes_s = kInfinity) {
    const CheckReport report = check_with({wall_at(2.0, appears_s, vanishes_s)}, motion);
    EXPECT_EQ(report.feasible, !report.constraint("obstacle_distance").violated);
    return report.constraint("obstacle_distance");
  };
  const Violation caught = violation(6.0);
  EXPECT_TRUE(caught.violated);
  EXPECT_GE(caught.time_s, 6.0);
  EXPECT_NE(caught.what.find("wall"), std::string::npos);
  const Violation left = violation(-kInfinity, 6.0);
  EXPECT_TRUE(left.violated);
  EXPECT_LE(left.time_s, 6.0);
  // However short it is there, and between which vertices.
  EXPECT_TRUE(violation(5.7, std::nextafter(5.7, 6.0)).violated);
  EXPECT_TRUE(violation(6.0, std::nextafter(6.0, 7.0)).violated);
  EXPECT_FALSE(violation(11.9).violated) << "it has passed";
  EXPECT_FALSE(violation(12.0).violated);
  EXPECT_FALSE(violation(-kInfinity, 0.1).violated) << "it has not come yet";
  EXPECT_FALSE(violation(20.0).violated) << "the motion is over";
}

TEST(Judge, KnowsToTheInstantWhenAPlaceHasToBeFree) {
  const Motion motion = centauro().drive(2, 4.0, 12.0);
  const auto feasible = [&](double appears_s) {
    return check_with({wall_at(2.0, appears_s)}, motion).feasible;
  };
  double caught_s = 6.0, free_s = 12.0;
  while (free_s - caught_s > 1e-7) {
    const double middle_s = 0.5 * (caught_s + free_s);
    (feasible(middle_s) ? free_s : caught_s) = middle_s;
  }
  // By a look at one instant after the other.
  const MotionCurve curve(centauro().robot, motion);
  const CollisionWorld exact(centauro().robot, nullptr, {wall_at(2.0, -kInfinity)});
  MotionSampler sampler(curve);
  std::vector<Eigen::Isometry3d> poses;
  const auto distance = [&](double time_s) {
    sampler.link_poses(0, time_s / 12.0, poses);
    return exact.environment_distance(poses, time_s).distance_m;
  };
  EXPECT_LT(distance(caught_s), 1e-5);
  EXPECT_GT(distance(free_s), -1e-5);
}

TEST(Judge, MeetsAWallThatAppearsWhereTheRobotStandsAndWaits) {
  Motion motion = centauro().drive(2, 4.0, 12.0);
  for (double& time : motion.time_s) time += 5.0;
  CheckOptions options;
  options.until_s = 30.0;
  const auto feasible = [&](const Obstacle& wall) {
    return check_with({wall}, motion, options).feasible;
  };
  EXPECT_FALSE(feasible(wall_at(0.0, 2.0, 3.0))) << "before it starts";
  EXPECT_TRUE(feasible(wall_at(0.0, 17.0)));
  EXPECT_FALSE(feasible(wall_at(4.0, 17.0))) << "as it arrives";
  EXPECT_FALSE(feasible(wall_at(4.0, 20.0, 20.1))) << "as it waits at the goal";
  EXPECT_FALSE(feasible(wall_at(4.0, 30.0)));
  EXPECT_TRUE(feasible(wall_at(4.0, 30.1)));
  EXPECT_TRUE(feasible(wall_at(4.0, 0.0, 5.1)));
  options.until_s.reset();
  EXPECT_TRUE(feasible(wall_at(4.0, 20.0, 20.1)));
}

/// Whoever stands for days is met by what repeats its way in its first round, or not at all:
/// looking at each of them would take minutes.
TEST(Judge, LooksAtWhatRepeatsItsWayOnceRoundWhereTheRobotStands) {
  Motion motion = centauro().drive(2, 4.0, 12.0);
  CheckOptions options;
  options.until_s = 1e6;
  const auto feasible = [&](double beside_m, double appears_s) {
    Obstacle ball;
    ball.name = "ball";
    ball.shape = Obstacle::Shape::kSphere;
    ball.size.setConstant(0.02);
    ball.world_from_obstacle.translation() = Eigen::Vector3d(4.0, 30.0, 0.7);
    KeyFrame there{1.0, ball.world_from_obstacle};
    there.pose.translation() = Eigen::Vector3d(4.0, beside_m, 0.7);
    ball.motion = {there};
    ball.repeat_s = 7.0;
    ball.appears_s = appears_s;
    return check_with({ball, wall_at(-3.0, 0.0)}, motion, options).feasible;
  };
  EXPECT_FALSE(feasible(-30.0, 999990.0));
  EXPECT_TRUE(feasible(10.0, 999990.0));
  EXPECT_FALSE(feasible(-30.0, 20.0));
  EXPECT_TRUE(feasible(10.0, 0.0));
  EXPECT_TRUE(feasible(-30.0, 999999.9)) << "it has not come by then";
  for (double& time : motion.time_s) time += 900000.0;
  EXPECT_FALSE(feasible(0.0, 0.0));
  EXPECT_TRUE(feasible(10.0, 899990.0));
}

TEST(Judge, DrivesOverAMappedFloorButNotThroughAMappedWall) {
  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation() << 1.0, 0.0, -0.025;
  boxes[0].size << 4.0, 2.0, 0.04;
  const Motion motion = centauro().drive(11, 0.08, 0.8);
  World world{octree_from_boxes(boxes, 0.05), {}, {ground()}, {}};
  const CheckReport floor = Judge(centauro().shared, world).check(motion);
  EXPECT_EQ(violated(floor), std::set<std::string>{});
  boxes.push_back({Eigen::Isometry3d::Identity(), {0.05, 2.0, 1.0}});
  boxes[1].world_from_box.translation() << 1.125, 0.0, 0.5;
  world.map = octree_from_boxes(boxes, 0.05);
  const CheckReport wall = Judge(centauro().shared, world).check(motion);
  EXPECT_TRUE(violated(wall).contains("obstacle_distance"));
  EXPECT_NE(wall.constraint("obstacle_distance").what.find("voxel"), std::string::npos);
}

TEST(Judge, ReportsTheClearanceOfADriveBesideAWall) {
  // 0.1 m beside the outermost point of the robot, which the left elbow or wheel is.
  double distance = 0.0;
  const std::vector<Obstacle> near = {box("wall", {0.5, 0.9, 1.0}, {6.0, 0.2, 2.0})};
  const CheckReport far = check_with(near, centauro().drive(2, 0.0, 1.0));
  distance = far.min_clearance_m.value();
  ASSERT_LT(distance, 0.5);
  ASSERT_GT(distance, 0.1);
  Obstacle wall = near[0];
  wall.world_from_obstacle.translation().y() -= distance - 0.1;
  const CheckReport report = check_with({wall}, centauro().drive(11, 0.08, 0.8));
  EXPECT_TRUE(report.feasible);
  EXPECT_NEAR(report.min_clearance_m.value(), 0.1, 1e-6);
  CheckOptions options;
  options.min_clearance_m = 0.101;
  EXPECT_EQ(violated(check_with({wall}, centauro().drive(11, 0.08, 0.8), options)),
            std::set<std::string>{"obstacle_distance"});
}

TEST(Judge, RefusesCallsThatMakeNoSense) {
  const Motion good = centauro().drive(3, 0.08, 0.8);
  const auto refused = [](const Motion& motion, const CheckOptions& options = {}) {
    EXPECT_THROW(check_with({}, motion, options), Error);
  };
  refused(Motion{});
  Motion bad = good;
  bad.time_s.pop_back();
  refused(bad);
  bad = good;
  bad.stance_from.pop_back();
  refused(bad);
  bad = good;
  bad.stance_from[1] = 1;
  refused(bad);
  bad = good;
  bad.stances[0].contacts[0].effector.link = "nowhere";
  refused(bad);
  bad = good;
  bad.stances[0].contacts[0].effector.link = "pelvis";  // no joint turns it
  refused(bad);
  bad = good;
  bad.stances[0].contacts[0].effector.radius_m = 0.0;
  refused(bad);
  CheckOptions options;
  options.max_step_m = 0.0;
  refused(good, options);
  options = {};
  options.min_clearance_m = kNaN;
  refused(good, options);
  options = {};
  options.min_balance_margin = 1.0;
  refused(good, options);
  options = {};
  for (const double until_s : {kInfinity, -1.0}) {
    options.until_s = until_s;
    refused(good, options);
  }
  options = {};
  options.threads = 0;
  refused(good, options);
  for (const double scale : {0.0, -1.0, kNaN, kInfinity}) {
    options = {};
    options.effort_scale = scale;
    refused(good, options);
  }
  EXPECT_THROW(check_with({}, good).constraint("beauty"), Error);
}

TEST(Judge, GivesTheSameBitsTwice) {
  const Obstacle post = box("post", {0.9, 0.75, 0.5}, {0.1, 0.1, 1.0});
  const Motion motion = centauro().drive(11, 0.08, 0.8);
  const CheckReport first = check_with({post}, motion), second = check_with({post}, motion);
  for (std::size_t i = 0; i < first.violations.size(); ++i) {
    EXPECT_EQ(first.violations[i].worst, second.violations[i].worst);
    EXPECT_EQ(first.violations[i].time_s, second.violations[i].time_s);
  }
}

TEST(Judge, SaysNothingWhenItsTimeIsUpWhereverThatHappens) {
  const Motion motion = centauro().drive(4, 0.08, 0.8);
  World world;
  world.surfaces = {ground()};
  const Judge judge(centauro().shared, world);
  std::set<std::string> parts;
  JobControl job;
  job.report = [&parts](std::string_view part, double) { parts.emplace(part); };
  const std::optional<CheckReport> whole = judge.check(motion, {}, job);
  ASSERT_TRUE(whole);
  EXPECT_TRUE(whole->feasible);
  EXPECT_EQ(parts, (std::set<std::string>{"judging numbers", "judging steps", "judging contacts",
                                          "judging distances", "judging self-collisions",
                                          "judging balance"}));
  for (const std::string& last : parts) {
    JobControl ended;
    ended.report = [&](std::string_view part, double) {
      if (part == last) ended.termination.deadline = Deadline::after(0.0);
    };
    EXPECT_FALSE(judge.check(motion, {}, ended)) << last;
  }
}

}  // namespace
}  // namespace locograph
