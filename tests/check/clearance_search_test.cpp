#include <gtest/gtest.h>
#include <locograph/check/clearance_search.h>
#include <locograph/check/moving_shapes.h>
#include <locograph/check/obstacle_path.h>

#include <random>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

Robot load_centauro() {
  const std::string model = std::string(LOCOGRAPH_SOURCE_DIR) + "/robots/models/centauro/centauro.";
  return Robot::load(model + "urdf", model + "srdf");
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Eigen::Vector3d vector(double size) {
    return {in(-size, size), in(-size, size), in(-size, size)};
  }
  Eigen::Isometry3d pose(double distance, double angle) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = vector(distance);
    pose.linear() =
        Eigen::AngleAxisd(in(-angle, angle), vector(1.0).normalized()).toRotationMatrix();
    return pose;
  }
  /// Base and joints move at random about a posture.
  Eigen::VectorXd near(const Robot& robot, const Eigen::VectorXd& posture, double metres,
                       double radians) {
    Eigen::VectorXd step(robot.tangent_size()), out = posture;
    for (int i = 0; i < step.size(); ++i) step[i] = in(-1.0, 1.0) * (i < 3 ? metres : radians);
    robot.integrate(posture.data(), step.data(), out.data());
    return out;
  }

 private:
  std::mt19937 engine_;
};

Motion random_motion(const Robot& robot, Random& random, int vertices, double metres,
                     double radians) {
  Motion motion;
  const Eigen::VectorXd home = robot.named_configuration("home");
  for (int i = 0; i < vertices; ++i) {
    motion.time_s.push_back(0.7 * i);
    motion.configurations.push_back(random.near(robot, home, metres, radians));
  }
  return motion;
}

std::vector<Obstacle> random_obstacles(Random& random, int count, bool moving) {
  std::vector<Obstacle> obstacles(static_cast<std::size_t>(count));
  for (Obstacle& obstacle : obstacles) {
    obstacle.shape = Obstacle::Shape(int(random.in(0.0, 2.999)));
    obstacle.size = {random.in(0.02, 0.2), random.in(0.02, 0.4), random.in(0.02, 0.4)};
    obstacle.world_from_obstacle = random.pose(1.2, 3.0);
    if (!moving) continue;
    for (int k = 1; k <= 3; ++k) obstacle.motion.push_back({0.5 * k, random.pose(1.2, 3.0)});
    if (random.in(0.0, 1.0) < 0.5) obstacle.repeat_s = 1.9;
  }
  return obstacles;
}

/// What a search needs, with a world of obstacles.
struct Searched {
  Searched(const Robot& robot, std::vector<Obstacle> obstacles, const Motion& motion,
           double cutoff_m = 0.5)
      : world{nullptr, std::move(obstacles), {}, {}},
        exact(robot, world),
        shapes(robot),
        curve(robot, motion),
        context{.robot = robot,
                .world = world,
                .exact = exact,
                .motion = motion,
                .options = options,
                .shapes = &shapes,
                .curve = curve,
                .job = job,
                .cutoff_m = cutoff_m} {}

  World world;
  CollisionWorld exact;
  MovingShapes shapes;
  MotionCurve curve;
  CheckOptions options;
  JobControl job;
  CheckContext context;
};

enum class Kind { kObstacles, kSelf };

/// Returns the number of samples.
int search(Searched& searched, Kind kind, ViolationTally& tally) {
  ClearanceSearch search(searched.context);
  const std::size_t vertices = searched.context.vertices();
  ViolationTally surface("surface", "m", 0.0, Worse::kHigher, vertices), touching = surface;
  if (kind == Kind::kSelf)
    search.run_self(tally);
  else
    search.run_around(tally, surface, touching);
  return search.samples();
}

UsableParts everything(const Motion& motion) {
  UsableParts usable;
  usable.vertices.assign(motion.configurations.size(), true);
  usable.steps.assign(motion.configurations.size(), true);
  usable.steps.back() = false;
  return usable;
}

class SearchAgainstDenseSampling : public ::testing::TestWithParam<int> {};

// Parameter: seed. Small joint motions in narrow places, large ones in the open, obstacles at rest
// and moving, that are there or come and go, to them and of the robot to itself.
TEST_P(SearchAgainstDenseSampling, FindsTheSameMinimumAndTheSameViolatedSteps) {
  const Robot robot = load_centauro();
  Random random{unsigned(GetParam())};
  const double size = GetParam() % 2 == 0 ? 0.1 : 0.5;
  const Motion motion = random_motion(robot, random, 4, size, size);
  std::vector<Obstacle> obstacles = random_obstacles(random, 4, GetParam() % 3 == 0);
  for (Obstacle& obstacle : obstacles) {
    if (GetParam() % 4 < 2) continue;  // the others come and go
    obstacle.appears_s = random.in(0.0, 2.1);
    obstacle.vanishes_s = obstacle.appears_s + random.in(0.0, 2.1);
  }
  Searched searched(robot, std::move(obstacles), motion);
  searched.context.usable = everything(motion);
  const CollisionWorld& world = searched.exact;
  const CheckOptions& options = searched.options;
  for (const Kind kind : {Kind::kObstacles, Kind::kSelf}) {
    const auto distance = [&](const Poses& poses, double time_s) {
      return kind == Kind::kSelf ? world.self_distance(poses).distance_m
                                 : world.environment_distance(poses, time_s).distance_m;
    };
    ViolationTally tally("distance", "m", 0.0, Worse::kLower, motion.configurations.size());
    search(searched, kind, tally);

    MotionSampler sampler(searched.curve);
    Poses poses;
    double dense_minimum = 10.0;
    std::vector<double> minimum_of_step;
    constexpr int kDense = 500;
    for (int step = 0; step < 3; ++step) {
      minimum_of_step.push_back(10.0);
      for (int k = 0; k <= kDense; ++k) {
        const double fraction = double(k) / kDense;
        sampler.link_poses(step, fraction, poses);
        const double d = distance(poses, searched.curve.time_s(step, fraction));
        minimum_of_step.back() = std::min(minimum_of_step.back(), d);
      }
      dense_minimum = std::min(dense_minimum, minimum_of_step.back());
      if (minimum_of_step.back() < -options.clearance_resolution_m) {
        EXPECT_TRUE(tally.violated_at(step) || tally.violated_at(step + 1)) << step;
      }
    }
    // How deep shapes overlap does not change continuously by FCL's measure; distances do.
    if (dense_minimum > 0.0) {
      EXPECT_GT(dense_minimum, tally.worst() - options.clearance_resolution_m);
    } else {
      EXPECT_LT(tally.worst(), options.clearance_resolution_m);
    }

    // What is reported really is there.
    const Violation& worst = tally.result();
    const double begin = motion.time_s[std::size_t(worst.at_vertex)];
    sampler.link_poses(worst.at_vertex, (worst.time_s - begin) / 0.7, poses);
    // The time tells the fraction up to rounding, to which iterative distances are sensitive (2e-7
    // were seen), and FCL's depths more.
    const double repeatable = worst.worst > 0.0 ? 1e-6 : 1e-4;
    EXPECT_NEAR(distance(poses, worst.time_s), worst.worst, repeatable);
    EXPECT_EQ(worst.violated, worst.worst < 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(ClearanceSearch, SearchAgainstDenseSampling, ::testing::Range(0, 24));

// It runs past between the times 2 and 10 s; of a plan of stances nobody knows when that is.
TEST(ClearanceSearch, LooksAllAlongTheWayOfObstaclesInAPlanOfStances) {
  const Robot robot = load_centauro();
  const Eigen::VectorXd home = robot.named_configuration("home");
  Motion motion{{0.0, 1.0}, {home, home}, {}, {}};
  const auto ball_at = [](double x, double y) {
    return Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.1));
  };
  for (const double y : {0.0, 0.7}) {
    Obstacle ball;
    ball.shape = Obstacle::Shape::kSphere;
    ball.world_from_obstacle = ball_at(-5.0, y);
    ball.size = {0.1, 0.0, 0.0};
    ball.motion = {{2.0, ball_at(-5.0, y)}, {10.0, ball_at(5.0, y)}};
    for (const bool stances_only : {false, true}) {
      motion.stances_only = stances_only;
      Searched searched(robot, {ball}, motion);
      searched.context.usable.vertices = {true, true};
      searched.context.usable.steps = {!stances_only, false};
      ViolationTally tally("distance", "m", 0.0, Worse::kLower, 2);
      search(searched, Kind::kObstacles, tally);
      if (!stances_only) {
        EXPECT_EQ(tally.worst(), 0.5) << "it has not come yet";
        continue;
      }
      MotionSampler sampler(searched.curve);
      Poses poses;
      sampler.link_poses(0, 0.0, poses);
      double dense = 1.0;
      for (double time_s = 0.0; time_s <= 12.0; time_s += 2e-3) {
        dense = std::min(dense, searched.exact.environment_distance(poses, time_s).distance_m);
      }
      EXPECT_EQ(dense < 0.0, y == 0.0);
      EXPECT_EQ(tally.violated_at(0) && tally.violated_at(1), dense < 0.0);
      EXPECT_GT(tally.result().time_s, 2.0);
      EXPECT_LT(tally.result().time_s, 10.0);
      if (dense > 0.0) {
        EXPECT_LT(dense, 0.4);
        EXPECT_NEAR(tally.worst(), dense, searched.options.clearance_resolution_m);
      }
    }
  }
}

TEST(ClearanceSearch, FindsAnObstacleThatIsThereForAnInstantAlsoInAPlanOfStances) {
  const Robot robot = load_centauro();
  const Eigen::VectorXd home = robot.named_configuration("home");
  Motion motion{{0.0, 1.0}, {home, home}, {}, {}};
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size = {5.0, 0.0, 0.0};
  for (const double appears_s : {1.0 / 3.0, 1.0, 2.0}) {
    ball.appears_s = appears_s;
    ball.vanishes_s = std::nextafter(appears_s, 3.0);
    for (const bool stances_only : {false, true}) {
      motion.stances_only = stances_only;
      Searched searched(robot, {ball}, motion);
      searched.context.usable.vertices = {true, true};
      searched.context.usable.steps = {!stances_only, false};
      ViolationTally tally("distance", "m", 0.0, Worse::kLower, 2);
      search(searched, Kind::kObstacles, tally);
      ASSERT_EQ(tally.result().violated, stances_only || appears_s <= 1.0) << appears_s;
      if (tally.result().violated) {
        EXPECT_EQ(tally.result().time_s, appears_s);
      }
    }
  }
}

// Each is looked at while it is there, by itself: work that grows with the square of their number
// takes minutes.
TEST(ClearanceSearch, LooksAtThousandsOfObstaclesThatComeAndGoInOneStep) {
  const Robot robot = load_centauro();
  const Eigen::VectorXd home = robot.named_configuration("home");
  const Motion motion{{0.0, 1.0}, {home, home}, {}, {}};
  constexpr int kBalls = 20000, kMeets = 12345;
  std::vector<Obstacle> balls(kBalls);
  for (int k = 0; k < kBalls; ++k) {
    Obstacle& ball = balls[static_cast<std::size_t>(k)];
    ball.shape = Obstacle::Shape::kSphere;
    ball.size = {0.1, 0.0, 0.0};
    ball.world_from_obstacle.translation() << (k == kMeets ? 0.0 : 5.0), 0.0, 0.3;
    ball.appears_s = (k + 0.25) / kBalls;
    ball.vanishes_s = (k + 0.75) / kBalls;
  }
  Searched searched(robot, std::move(balls), motion);
  searched.context.usable = everything(motion);
  ViolationTally tally("distance", "m", 0.0, Worse::kLower, 2);
  EXPECT_EQ(search(searched, Kind::kObstacles, tally), 2 + 2 * kBalls);
  ASSERT_TRUE(tally.result().violated);
  EXPECT_EQ(tally.result().time_s, (kMeets + 0.25) / kBalls);
}

TEST(ClearanceSearch, LooksAtFewSamplesWhereNothingIsNear) {
  const Robot robot = load_centauro();
  Random random(1);
  const Motion motion = random_motion(robot, random, 5, 0.1, 0.0);
  Searched searched(robot, {}, motion);
  searched.context.usable = everything(motion);
  ViolationTally tally("distance", "m", 0.0, Worse::kLower, motion.configurations.size());
  // The base moves, the links do not against each other.
  EXPECT_EQ(search(searched, Kind::kSelf, tally), 5);
}

// Two balls run towards each other on the same circle and meet after a fifth of the step. A bound
// for one of them alone would stop the search at a quarter, where they are apart again.
TEST(ClearanceSearch, FindsPartsOfTheRobotThatMeetHeadOnBetweenVertices) {
  const test::TemporaryFolder folder;
  const std::string ball =
      R"(<collision><origin xyz="1 0 0"/><geometry><sphere radius="0.05"/></geometry></collision>)";
  const std::string joint =
      R"(<axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>)";
  const Robot robot =
      Robot::load(folder.write("balls.urdf", R"(<robot name="balls"><link name="base"/>
  <link name="one">)" + ball + R"(</link><link name="two">)" +
                                                 ball + R"(</link>
  <joint name="first" type="revolute"><parent link="base"/><child link="one"/>)" +
                                                 joint +
                                                 R"(
  <joint name="second" type="revolute"><parent link="base"/><child link="two"/>)" +
                                                 joint + "</robot>"),
                  {}, {.floating_base = false});
  for (const bool meet : {true, false}) {
    const Eigen::Vector2d from(0.5, -0.5), to = meet ? Eigen::Vector2d(-2.0, 2.0) : from;
    const Motion motion{{0.0, 1.0}, {from, to}, {}, {}};
    Searched searched(robot, {}, motion, 2.0);
    searched.context.usable = everything(motion);
    ViolationTally tally("distance", "m", 0.0, Worse::kLower, 2);
    search(searched, Kind::kSelf, tally);
    const double expected = meet ? -0.1 : 2.0 * std::sin(0.5) - 0.1;
    EXPECT_NEAR(tally.worst(), expected, 1e-3);
    EXPECT_EQ(tally.result().violated, meet);
  }
}

// Dense polygonal path of the point, which is no longer than the path itself.
TEST(MovingShapes, BoundsTheTrueLengthOfEveryPath) {
  const Robot robot = load_centauro();
  MovingShapes shapes(robot);
  Random random(7);
  double tightest = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    const double size = trial % 2 == 0 ? 0.05 : 0.6;
    Motion motion = random_motion(robot, random, 2, size, size);
    for (int wheel = 1; wheel <= 4; ++wheel) {
      const std::string name = "j_wheel_" + std::to_string(wheel);
      motion.configurations[1][7 + robot.joints()[robot.joint_index(name)].index] += 3.0;
    }
    const MotionCurve curve(robot, motion);
    shapes.set_step(curve.step(0).bounds());
    const double begin = random.in(0.0, 0.5), end = begin + random.in(0.05, 0.5);
    MotionSampler sampler(curve);
    Poses from, to, before, after;
    sampler.link_poses(0, begin, from);
    sampler.link_poses(0, end, to);
    const double bound = shapes.path_bound(from, to, end - begin);
    const double relative = shapes.relative_path_bound(from, to, end - begin);
    EXPECT_LE(bound, shapes.step_length_bound() * (end - begin) + 1e-12);

    double longest = 0.0, longest_in_base = 0.0;
    for (const Link& link : robot.links()) {
      for (const CollisionShape& shape : link.collision) {
        const std::size_t index = std::size_t(shape.link);
        const Eigen::Vector3d tip =
            shape.link_from_shape * Eigen::Vector3d(0.0, 0.0, 0.5 * shape.length);
        double length = 0.0, length_in_base = 0.0;
        sampler.link_poses(0, begin, before);
        constexpr int kPieces = 60;
        for (int k = 1; k <= kPieces; ++k) {
          sampler.link_poses(0, begin + (end - begin) * k / kPieces, after);
          length += (after[index] * tip - before[index] * tip).norm();
          const Eigen::Vector3d base_after = after[0].inverse() * (after[index] * tip);
          const Eigen::Vector3d base_before = before[0].inverse() * (before[index] * tip);
          length_in_base += (base_after - base_before).norm();
          std::swap(before, after);
        }
        longest = std::max(longest, length);
        longest_in_base = std::max(longest_in_base, length_in_base);
      }
    }
    EXPECT_LE(longest, bound);
    EXPECT_LE(longest_in_base, relative);
    tightest = std::max(tightest, longest / bound);
  }
  EXPECT_GT(tightest, 0.7);  // a bound of infinity would be of no use
}

struct Swung {
  std::string name, geometry;
  double farthest_m;  // what runs along the longest arc, from the hinges: its set of points counts
  double bound_over_path;
};

// Two joints on one axis swing a shape whose centre is 1 m away.
TEST(MovingShapes, AreTightForAShapeOnTwoHinges) {
  const test::TemporaryFolder folder;
  for (const Swung& swung :
       {Swung{"sphere", R"(<sphere radius="0.3"/>)", 1.0, 1.01},
        Swung{"box", R"(<box size="0.6 0.8 0.02"/>)", 1.5, 1.1}}) {  // a corner points outwards
    const Robot robot = Robot::load(folder.write(swung.name + ".urdf", R"(<robot name="hinges">
  <link name="base"/><link name="upper"/>
  <link name="lower"><collision><origin xyz="1 0 0" rpy="0 0 0.9272952180016122"/>
    <geometry>)" + swung.geometry + R"(</geometry></collision></link>
  <joint name="first" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="second" type="revolute"><parent link="upper"/><child link="lower"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
</robot>)"),
                                    {}, {.floating_base = false});
    MovingShapes shapes(robot);
    for (const double angle : {0.01, 0.2, 0.7}) {
      Motion motion;
      motion.time_s = {0.0, 1.0};
      motion.configurations = {Eigen::Vector2d::Zero(), Eigen::Vector2d(angle, angle)};
      motion.slopes.assign(2, Eigen::Vector2d(angle, angle));
      const MotionCurve curve(robot, motion);
      shapes.set_step(curve.step(0).bounds());
      MotionSampler sampler(curve);
      Poses from, to;
      sampler.link_poses(0, 0.0, from);
      sampler.link_poses(0, 1.0, to);
      const double path = 2.0 * angle * swung.farthest_m, bound = shapes.path_bound(from, to, 1.0);
      EXPECT_GE(bound, path * (1.0 - 1e-9)) << swung.name << ' ' << angle;
      EXPECT_LE(bound, path * swung.bound_over_path) << swung.name << ' ' << angle;
    }
  }
}

TEST(MovingShapes, DoNotMoveWhenARoundWheelSpins) {
  const Robot robot = load_centauro();
  MovingShapes shapes(robot);
  const Eigen::VectorXd from = robot.named_configuration("home");
  Eigen::VectorXd to = from;
  const int wheel = robot.joints()[robot.joint_index("j_wheel_2")].index;
  to[7 + wheel] += 5.0;
  EXPECT_FALSE(shapes.joint_moves_shapes(wheel));
  const auto bounds = [&] {
    const Motion motion{{0.0, 1.0}, {from, to}, {}, {}};
    return MotionCurve(robot, motion).step(0).bounds();
  };
  shapes.set_step(bounds());
  EXPECT_EQ(shapes.step_length_bound(), 0.0);
  to[7 + robot.joints()[robot.joint_index("ankle_yaw_2")].index] += 0.1;
  shapes.set_step(bounds());
  EXPECT_GT(shapes.step_length_bound(), 0.1 * 0.055);
}

TEST(ObstaclePath, BoundsWhatEveryPointTravels) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Obstacle> obstacles = random_obstacles(random, 1, true);
    const ObstaclePath path(obstacles);
    const double begin = random.in(-0.5, 3.0), end = begin + random.in(0.0, 4.0);
    Eigen::Vector3d corner = 0.5 * obstacles[0].size;
    if (obstacles[0].shape == Obstacle::Shape::kSphere) corner.setZero();
    if (obstacles[0].shape == Obstacle::Shape::kCylinder)
      corner << obstacles[0].size[0], 0.0, 0.5 * obstacles[0].size[1];
    double length = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const double t0 = begin + (end - begin) * k / 2000.0;
      const double t1 = begin + (end - begin) * (k + 1) / 2000.0;
      length += (obstacles[0].pose_at(t1) * corner - obstacles[0].pose_at(t0) * corner).norm();
    }
    EXPECT_LE(length, path.bound(begin, end) + 1e-9);
    EXPECT_EQ(path.bound(begin, end), path.bound(end, begin));
    EXPECT_EQ(path.bound(0, begin, end), path.bound(begin, end)) << "there is no other";
  }
}

TEST(ObstaclePath, KnowsWhenAllObstaclesHaveBeenEverywhere) {
  Obstacle ball, other, cart;
  ball.appears_s = other.vanishes_s = 3.0;
  ball.vanishes_s = 9.0;
  EXPECT_EQ(ObstaclePath(std::vector{other}).end_s(), 0.0);
  EXPECT_EQ(ObstaclePath(std::vector{ball, other}).end_s(), 3.0);
  cart.size.setOnes();
  cart.motion = {{2.0, Eigen::Isometry3d::Identity()}};
  EXPECT_EQ(ObstaclePath(std::vector{ball, cart}).end_s(), 3.0);
  cart.repeat_s = 4.0;
  EXPECT_EQ(ObstaclePath(std::vector{cart}).end_s(), 4.0);
  cart.appears_s = 3.0;
  EXPECT_EQ(ObstaclePath(std::vector{cart}).end_s(), 7.0) << "once round since it appears";
}

TEST(ObstaclePath, IsZeroBeforeTheStartAndAfterTheEndOfAMotion) {
  Obstacle obstacle;
  obstacle.size.setOnes();
  KeyFrame frame{2.0, Eigen::Isometry3d::Identity()};
  frame.pose.translation().x() = 3.0;
  obstacle.motion = {frame};
  ObstaclePath once(std::vector<Obstacle>{obstacle});
  EXPECT_EQ(once.bound(-5.0, 0.0), 0.0);
  EXPECT_EQ(once.bound(2.0, 50.0), 0.0);
  EXPECT_DOUBLE_EQ(once.bound(0.5, 1.0), 0.75);
  obstacle.repeat_s = 3.0;
  ObstaclePath repeated(std::vector<Obstacle>{obstacle});
  EXPECT_DOUBLE_EQ(repeated.bound(0.0, 30.0), 60.0);
  EXPECT_DOUBLE_EQ(repeated.bound(5.0, 6.0), 3.0);  // the way back
}

}  // namespace
}  // namespace locograph
