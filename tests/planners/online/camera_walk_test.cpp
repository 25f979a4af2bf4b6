#include <locograph/common/error.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/online/camera_walk.h>
#include <locograph/planners/online/walk_plan.h>

#include <cmath>
#include <numbers>

#include "common/sanitized.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace {

/// CENTAURO's own cameras, with fewer pixels.
std::vector<DepthCamera> few_pixels(const Robot& robot) {
  std::vector<DepthCamera> cameras = cameras_of(robot);
  for (DepthCamera& camera : cameras) {
    DepthCamera small =
        depth_camera(camera.name, camera.link, 160, 120, 87.0 * std::numbers::pi / 180.0);
    small.link_from_optical = camera.link_from_optical;
    camera = small;
  }
  return cameras;
}

/// A drive that is walked along by what the cameras show of a world.
struct Drive {
  Graph graph;
  World truth;
  Judging judging;
  std::optional<Perception> perception;
  std::optional<SimulatedImages> images;
  std::optional<CameraWalk> eyes;

  Drive(std::vector<Obstacle> obstacles, const PerceptionOptions& options = {},
        double distance_m = 2.4)
      : graph(planned_drive(
            centauro_drive(distance_m, 0.0, 1 + static_cast<int>(std::lround(distance_m / 0.08))))),
        truth(world_of(std::move(obstacles))) {
    judging.robot = plan_of(graph).robot->robot;
    judging.world = std::make_shared<const WorldSnapshot>(truth);
    judging.options = drive_options();
    const std::vector<DepthCamera> cameras = few_pixels(*judging.robot);
    PerceptionOptions seen = options;
    seen.map.floor_z_m = 0.0;
    seen.map.log_odds.least = -20;
    seen.map.least_pixels = 1;
    perception.emplace(judging.robot, cameras, World{.surfaces = {ground()}}, seen);
    images.emplace(judging.robot, truth, cameras,
                   SimulatedImagesOptions{.rate_hz = 5.0, .begin_s = -0.9, .seed = 3});
    eyes.emplace(graph, judging, *perception, *images);
  }

  WalkReport walk() {
    WalkOptions options;
    options.planner.fallbacks = camera_fallbacks();
    options.verify = [this](const Motion& step) { return eyes->check_step(step); };
    options.pace = [this](int executed) { return eyes->pace(executed); };
    return walk_plan(
        graph, [this](int executed) { return eyes->world_at(executed); }, options);
  }

  /// By the truth: also of a drive that stopped.
  CheckReport check() const {
    return Judge(judging.robot, truth).check(motion_of(graph, plan_of(graph)), drive_options());
  }
};

TEST(CameraWalk, ArrivesWhereNothingIsInTheWay) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Drive drive({});
  const WalkReport report = drive.walk();
  EXPECT_TRUE(report.success()) << report.reason;
  expect_feasible(drive.check());
  EXPECT_GT(drive.perception->images(), 200);
  EXPECT_EQ(drive.eyes->refused(), 0) << drive.eyes->last_refusal();
  EXPECT_EQ(static_cast<int>(drive.eyes->perception_s().size()), drive.perception->images());
}

// Beside each box there is 0.1 m more than the robot is wide on either side, and it is longer than
// what is between the two.
TEST(CameraWalk, TurnsBetweenBoxesAtOppositeWallsTheSecondOfWhichAppearsLate) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  std::vector<Obstacle> corridor = {box("right wall", {2.5, -0.85, 0.5}, {9.0, 0.2, 1.0}),
                                    box("left wall", {2.5, 0.85, 0.5}, {9.0, 0.2, 1.0}),
                                    box("first", {1.644, 0.583, 0.3}, {0.3, 0.333, 0.6}),
                                    box("second", {2.681, -0.583, 0.3}, {0.3, 0.333, 0.6})};
  corridor.back().appears_s = 13.49;
  Drive drive(std::move(corridor), {}, 4.0);
  const WalkReport report = drive.walk();
  EXPECT_TRUE(report.success()) << report.reason;
  expect_feasible(drive.check());
}

TEST(CameraWalk, StopsBeforeAWallThatOnlyTheCamerasShow) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Drive drive({box("wall", {2.6, 0.0, 0.75}, {0.2, 8.0, 1.5})});
  const WalkReport report = drive.walk();
  EXPECT_FALSE(report.success());
  EXPECT_NE(report.reason.find("the map"), std::string::npos) << report.reason;
  expect_feasible(drive.check());
}

TEST(CameraWalk, StopsBeforeAWallThatAppearsOnItsWay) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Obstacle wall = box("wall", {2.9, 0.0, 0.75}, {0.2, 8.0, 1.5});
  wall.appears_s = 8.0;
  Drive drive({wall});
  const WalkReport report = drive.walk();
  EXPECT_FALSE(report.success());
  expect_feasible(drive.check());
}

TEST(CameraWalk, KnowsNothingOfWhatNoCameraShows) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  // It appears around the robot itself: whoever asked the truth beforehand would have stopped.
  Obstacle trap = box("trap", {1.0, 0.0, 1.0}, {0.05, 0.05, 0.05});
  trap.appears_s = 10.0;
  Drive drive({trap});
  drive.walk();
  EXPECT_TRUE(violated(drive.check()).contains("obstacle_distance"));
}

TEST(CameraWalk, GivesTheSameBitsAgain) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Drive first({box_ahead()}), second({box_ahead()});
  first.walk();
  second.walk();
  EXPECT_EQ(write_graph_text(first.graph), write_graph_text(second.graph));
}

TEST(CameraWalk, SeesAllImagesOfAStepThatTakesLongerThanConfigurationsAreKept) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  Drive drive({});
  for (const int slot : plan_of(drive.graph).slots)
    drive.graph.vertex(VertexId<VertexConfiguration>{slot}).time_s *= 10.0;
  const Motion step = motion_of(drive.graph, plan_of(drive.graph), 0, 1);
  ASSERT_GT(step.time_s[1], drive.perception->options().kept_s + 1.0);
  drive.eyes->world_at(0);
  drive.eyes->world_at(1);
  EXPECT_EQ(drive.eyes->refused(), 0) << drive.eyes->last_refusal();
  EXPECT_GE(drive.perception->images(), static_cast<int>(2 * 5.0 * step.time_s[1]));
}

/// Images of another source; with the k-th one somebody asks the walk to stop.
class StopsWithAnImage final : public ImageSource {
 public:
  StopsWithAnImage(ImageSource& images, int k) : images_(images), left_(k) {}

  double next_stamp_s() const override { return images_.next_stamp_s(); }
  DepthImage take(const RobotState& state) override {
    if (--left_ == 0) stop = true;
    return images_.take(state);
  }

  std::atomic<bool> stop = false;

 private:
  ImageSource& images_;
  int left_;
};

TEST(CameraWalk, IsAskedAgainWhereItWasPlannedOn) {
  Drive drive({box("wall", {2.6, 0.0, 0.75}, {0.2, 8.0, 1.5})});
  drive.eyes->world_at(0);
  const auto seen = drive.eyes->world_at(1);
  const int images = drive.perception->images();
  EXPECT_EQ(drive.eyes->world_at(1), seen);
  EXPECT_EQ(drive.perception->images(), images);
  drive.eyes->world_at(2);
  const World now = drive.eyes->seen();
  ASSERT_TRUE(now.map);
  EXPECT_GT(now.map->size(), 0u) << "the wall";
  EXPECT_EQ(now.surfaces.size(), 1u) << "the ground";
}

TEST(CameraWalk, StopsBetweenTwoImages) {
  for (const int images : {3, 40}) {  // standing, and on the way to a configuration
    Drive drive({});
    StopsWithAnImage source(*drive.images, images);
    CameraWalk eyes(drive.graph, drive.judging, *drive.perception, source, {.stop = &source.stop});
    WalkOptions options;
    options.termination.stop = &source.stop;
    const WalkReport report = walk_plan(
        drive.graph, [&](int executed) { return eyes.world_at(executed); }, options);
    EXPECT_EQ(report.status, PlannerStatus::kStopped);
    EXPECT_EQ(drive.perception->images(), images);
    EXPECT_EQ(report.cycles.size() > 0, images == 40);
    expect_feasible(drive.check());
  }
}

TEST(CameraWalk, TakesItsTimeWhereItHasNotSeen) {
  if (test::kSanitized) GTEST_SKIP() << "takes long there";
  PerceptionOptions options;
  options.map.unknown = UnknownSpace::kSlow;
  Drive hurried({}), slow({}, options);
  for (Drive* drive : {&hurried, &slow}) {
    EXPECT_TRUE(drive->walk().success());
    expect_feasible(drive->check());
  }
  const auto end_s = [](const Drive& drive) {
    return motion_of(drive.graph, plan_of(drive.graph)).time_s.back();
  };
  EXPECT_GT(end_s(slow), end_s(hurried) + 1.0);
  EXPECT_LE(end_s(slow), 2.0 * end_s(hurried) + 1e-9);
}

TEST(CameraWalk, RefusesOptionsThatMakeNoSense) {
  Drive drive({}, {}, 0.8);
  const auto make = [&](const CameraWalkOptions& options) {
    CameraWalk(drive.graph, drive.judging, *drive.perception, *drive.images, options);
  };
  EXPECT_NO_THROW(make({}));
  EXPECT_THROW(make({.slower = 0.5}), Error);
  EXPECT_THROW(make({.ahead_s = -1.0}), Error);
}

}  // namespace
}  // namespace locograph
