// Cameras and drives in threads of their own. scripts/test.sh runs this under ThreadSanitizer, too.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/perception_thread.h>

#include <atomic>
#include <limits>
#include <thread>

#include "common/sanitized.h"
#include "world/perception/small_camera_robot.h"

namespace locograph {
namespace perception_threads_test {

using test::camera_robot;
using test::small_camera;
using test::standing_at;
using test::wall_image;

constexpr int kImages = test::kSanitized ? 10 : 50;

std::unique_ptr<Perception> small_perception(const std::shared_ptr<const Robot>& robot) {
  PerceptionOptions options;
  options.map.size_m = {3.2, 3.2, 2.0};
  return std::make_unique<Perception>(robot, std::vector{small_camera(*robot)}, World(), options);
}

double x_at(double time_s) { return 0.1 * time_s; }

DepthImage image_at(double time_s) { return wall_image(time_s, 1.2 - x_at(time_s)); }

TEST(PerceptionThread, SeesInTheEndWhatPerceptionWithoutAThreadSees) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  const std::unique_ptr<Perception> alone = small_perception(robot);
  for (int k = 0; k <= kImages; ++k) {
    alone->configuration(0.02 * k, standing_at(*robot, x_at(0.02 * k)));
  }
  for (int k = 0; k < kImages; ++k) alone->image(image_at(0.02 * k + 0.01));

  std::atomic<int> shown = 0;
  PerceptionThread thread(small_perception(robot),
                          {.most_waiting = 1000, .on_snapshot = [&](auto) { ++shown; }});
  {
    const std::jthread drives([&] {
      for (int k = 0; k <= kImages; ++k) {
        thread.configuration(0.02 * k, standing_at(*robot, x_at(0.02 * k)));
      }
    });
    const std::jthread cameras([&] {
      for (int k = 0; k < kImages; ++k) thread.image(image_at(0.02 * k + 0.01));
    });
    const std::jthread planner([&] {
      // As long as images are taken in: some snapshots are held while others are made.
      double before_s = -std::numeric_limits<double>::infinity();
      std::shared_ptr<const WorldSnapshot> held = thread.newest();
      while (shown + thread.counts().refused < kImages) {
        std::shared_ptr<const WorldSnapshot> seen = thread.newest();
        EXPECT_GE(seen->stamp_s(), before_s) << "never back to an older world";
        before_s = seen->stamp_s();
        for (double x = -1.5; x < 1.5; x += 0.1) {
          seen->distance().distance({x, 0.0, 1.0}, 0.0);
          held->distance().distance({x, 0.0, 1.0}, 0.0);
        }
        if (seen != held) held = std::move(seen);
      }
    });
  }
  const std::unique_ptr<Perception> perception = thread.finish();
  const PerceptionCounts counts = thread.counts();
  EXPECT_EQ(counts.images, kImages);
  EXPECT_EQ(counts.refused, 0) << counts.last_refusal;
  EXPECT_EQ(counts.dropped, 0);
  EXPECT_EQ(shown, kImages);
  EXPECT_EQ(thread.newest(), perception->newest());
  EXPECT_EQ(perception->newest()->stamp_s(), alone->newest()->stamp_s());
  for (double x = -1.5; x < 1.5; x += 0.07) {
    const Eigen::Vector3d point(x, 0.01, 1.02);
    EXPECT_EQ(perception->newest()->distance().distance(point, 0.0),
              alone->newest()->distance().distance(point, 0.0))
        << x;
  }
}

TEST(PerceptionThread, KeepsAnImageUntilItsConfigurationIsKnown) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  std::atomic<int> shown = 0;
  PerceptionThread thread(small_perception(robot),
                          {.on_snapshot = [&](auto) { shown.fetch_add(1), shown.notify_all(); }});
  thread.configuration(0.0, standing_at(*robot, 0.0));
  thread.image(image_at(0.05));  // waits
  thread.image(image_at(0.0));   // need not
  shown.wait(0);
  EXPECT_EQ(thread.newest()->stamp_s(), 0.0);
  thread.configuration(0.1, standing_at(*robot, 0.0));
  shown.wait(1);
  EXPECT_EQ(thread.newest()->stamp_s(), 0.05);
  thread.image(image_at(0.2));
  thread.finish();
  EXPECT_EQ(thread.counts().refused, 1) << "nobody says where the robot was";
}

TEST(PerceptionThread, AConfigurationThatIsRefusedLetsNoImageGo) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  std::atomic<int> shown = 0;
  PerceptionThread thread(small_perception(robot),
                          {.on_snapshot = [&](auto) { shown.fetch_add(1), shown.notify_all(); }});
  thread.configuration(0.0, standing_at(*robot, 0.0));
  thread.configuration(std::numeric_limits<double>::infinity(), standing_at(*robot, 0.0));
  thread.image(image_at(0.05));  // waits
  thread.image(image_at(0.0));
  shown.wait(0);
  thread.configuration(0.1, standing_at(*robot, 0.0));
  shown.wait(1);
  EXPECT_EQ(thread.finish()->images(), 2);
  EXPECT_EQ(thread.counts().refused, 1) << "the configuration";
}

TEST(PerceptionThread, DropsTheOldestOfTooManyImages) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  PerceptionThread thread(small_perception(robot), {.most_waiting = 3});
  for (int k = 0; k < 10; ++k) thread.image(image_at(0.01 * k));  // nobody knows where it is
  EXPECT_EQ(thread.counts().dropped, 7);
  thread.configuration(0.0, standing_at(*robot, 0.0));
  thread.configuration(1.0, standing_at(*robot, 0.0));
  EXPECT_EQ(thread.finish()->images(), 3);
}

TEST(PerceptionThread, CountsWhatItRefusesAndGoesOn) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  PerceptionThread thread(small_perception(robot));
  thread.configuration(0.0, standing_at(*robot, 0.0));
  thread.configuration(0.0, standing_at(*robot, 0.0));
  thread.configuration(1.0, standing_at(*robot, 0.0));
  DepthImage unknown = image_at(0.1);
  unknown.camera = 3;
  thread.image(unknown);
  thread.image(image_at(0.2));
  EXPECT_EQ(thread.finish()->images(), 1);
  EXPECT_EQ(thread.counts().refused, 2);
  EXPECT_NE(thread.counts().last_refusal, "");
}

TEST(PerceptionThread, EndsInTheMiddleOfItsWork) {
  const std::shared_ptr<const Robot> robot = camera_robot();
  PerceptionThread thread(small_perception(robot), {.most_waiting = 1000});
  thread.configuration(0.0, standing_at(*robot, 0.0));
  thread.configuration(10.0, standing_at(*robot, 0.0));
  for (int k = 0; k < kImages; ++k) thread.image(image_at(0.01 * k));
  EXPECT_THROW(PerceptionThread(small_perception(robot), {.most_waiting = 0}), Error);
}

}  // namespace perception_threads_test
}  // namespace locograph
