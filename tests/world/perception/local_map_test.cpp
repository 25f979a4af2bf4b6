// What a window of voxels keeps of depth images, of maps and of its moves.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/simd_level.h>
#include <locograph/world/perception/local_map.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <random>
#include <thread>

#include "common/allocation_counter.h"
#include "world/perception/each_voxel.h"
#include "world/perception/room_camera.h"

namespace locograph {
namespace {

using test::each_voxel;
using test::looking;
using test::room_camera;
using test::RoomCamera;
using test::solid_box;
using test::upright_cylinder;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LocalMapOptions small_window() {
  LocalMapOptions options;
  options.size_m = {4.8, 3.2, 1.6};
  return options;
}

Eigen::Vector3d centre_of(const LocalMap& map, const Eigen::Vector3i& index) {
  return (index.cast<double>() + Eigen::Vector3d::Constant(0.5)) * map.window().resolution_m;
}

bool is_occupied(const LocalMap& map, const Eigen::Vector3i& index) {
  return map.log_odds(index) >= map.options().log_odds.occupied_from;
}

/// Occupied voxels whose centres are so near to the solid.
int occupied_near(const LocalMap& map, const test::RoomSolid& solid, double reach_m) {
  int count = 0;
  each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
    count += is_occupied(map, index) && solid.distance(centre_of(map, index)) < reach_m;
  });
  return count;
}

std::vector<int> everything(LocalMap& map) {
  std::vector<int> all;
  const std::shared_ptr<const LocalField> field = map.field();
  each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
    all.push_back(map.log_odds(index));
    all.push_back(field->squared_distance(index));
  });
  return all;
}

/// Squared distances against brute force, over the voxels of a window that are occupied.
void expect_exact(LocalMap& map) {
  const std::shared_ptr<const LocalField> field = map.field();
  std::vector<Eigen::Vector3i> occupied;
  each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
    if (is_occupied(map, index)) occupied.push_back(index);
  });
  const int cap = map.options().cap();
  std::mt19937 generator(11);
  int different = 0;
  for (int i = 0; i < 500; ++i) {
    Eigen::Vector3i index;
    for (int axis = 0; axis < 3; ++axis) {
      index[axis] = map.window().first[axis] +
                    static_cast<int>(generator() % static_cast<unsigned>(map.window().size[axis]));
    }
    int least = cap * cap + 1;
    for (const Eigen::Vector3i& other : occupied)
      least = std::min(least, (other - index).squaredNorm());
    different += field->squared_distance(index) != least;
  }
  EXPECT_EQ(different, 0);
}

TEST(LocalMap, AThinPoleIsInTheMapWithinFiveImages) {
  LocalMap map(LocalMapOptions{});
  map.move_to({1.0, 0.0, 1.0});
  RoomCamera room(3);
  const test::RoomSolid pole = upright_cylinder(2.02, 0.13, 0.0, 1.9, 0.01);
  room.solids = {pole, solid_box({3.5, -2.0, 0.0}, {3.6, 2.0, 2.5})};
  const Eigen::Isometry3d from = looking({0.0, 0.0, 1.2}, 0.0, 0.2);
  for (int i = 0; i < 5; ++i)
    map.insert(room_camera(), from, room.take(room_camera(), from, 0.1 * i));
  // Between 0.5 and 1.5 m: twenty layers, none of which is without it.
  int layers = 0;
  for (int z = 10; z < 30; ++z) {
    bool here = false;
    for (int x = 39; x < 42; ++x)
      for (int y = 1; y < 4; ++y) here = here || is_occupied(map, {x, y, z});
    layers += here;
  }
  EXPECT_EQ(layers, 20);
  expect_exact(map);
}

TEST(LocalMap, AnObstacleThatIsTakenAwayIsGoneWithinFiveImages) {
  LocalMapOptions options;
  options.floor_z_m = 0.0;
  LocalMap map(options);
  map.move_to({1.0, 0.0, 1.0});
  RoomCamera room(5);
  const test::RoomSolid box = solid_box({1.5, -0.3, 0.0}, {1.9, 0.3, 0.8}),
                        wall = solid_box({3.2, -2.0, 0.0}, {3.3, 2.0, 2.5});
  const Eigen::Isometry3d from = looking({0.0, 0.0, 1.2}, 0.0, 0.35);
  room.solids = {wall, box};
  for (int i = 0; i < 10; ++i)
    map.insert(room_camera(), from, room.take(room_camera(), from, 0.1 * i));
  EXPECT_GT(occupied_near(map, box, 0.05), 150);
  room.solids = {wall};
  for (int i = 10; i < 15; ++i)
    map.insert(room_camera(), from, room.take(room_camera(), from, 0.1 * i));
  EXPECT_EQ(occupied_near(map, box, 0.05), 0);
  EXPECT_GT(occupied_near(map, wall, 0.05), 500);
  expect_exact(map);
}

TEST(LocalMap, TheFloorAtAGrazingAngleIsNotLost) {
  LocalMap map(LocalMapOptions{});
  map.move_to({2.0, 0.0, 1.0});
  RoomCamera room(7);
  room.noise = 0.5;
  const Eigen::Isometry3d from = looking({0.0, 0.0, 0.9}, 0.0, 0.1);
  for (int i = 0; i < 10; ++i)
    map.insert(room_camera(), from, room.take(room_camera(), from, 0.1 * i));
  int columns = 0, found = 0;  // from 2.5 to 3.8 m, where the floor is seen at 13 to 20 degrees
  for (int x = 50; x < 76; ++x) {
    for (int y = -20; y < 20; ++y) {
      ++columns;
      found += is_occupied(map, {x, y, -1}) || is_occupied(map, {x, y, 0}) ||
               is_occupied(map, {x, y, 1});
    }
  }
  EXPECT_GT(found, 0.98 * columns);
}

TEST(LocalMap, TheFloorIsNoObstacleWhereItIsToldOf) {
  LocalMapOptions options;
  options.floor_z_m = 0.0;
  LocalMap map(options);
  map.move_to({1.0, 0.0, 1.0});
  RoomCamera room(9);
  const test::RoomSolid brick = solid_box({1.5, -0.2, 0.0}, {1.8, 0.2, 0.12});
  room.solids = {brick};
  const Eigen::Isometry3d from = looking({0.0, 0.0, 1.2}, 0.0, 0.5);
  const auto look = [&](int images) {
    for (int i = 0; i < images; ++i)
      map.insert(room_camera(), from,
                 room.take(room_camera(), from, map.options().resolution_m * i));
  };
  look(6);
  int floor = 0, on_brick = 0, seen_free = 0;
  each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
    const bool near = brick.distance(centre_of(map, index)) < 0.08;
    if (is_occupied(map, index)) ++(near ? on_brick : floor);
    if (index[2] == 0 && index[0] > 20 && index[0] < 28 && std::abs(index[1]) < 10)
      seen_free += map.log_odds(index) != kNeverSeen;
  });
  EXPECT_EQ(floor, 0);
  EXPECT_GT(on_brick, 20);
  EXPECT_EQ(seen_free, 7 * 19);  // the floor's own voxels are known
  room.solids.clear();
  look(6);
  EXPECT_EQ(occupied_near(map, brick, 0.1), 0);
}

TEST(LocalMap, MovesKeepWhatStaysAndForgetWhatLeaves) {
  LocalMap map(small_window());
  map.move_to({1.0, 0.0, 0.5});
  RoomCamera room(13);
  room.solids = {solid_box({1.5, -0.5, 0.0}, {1.8, 0.5, 1.0})};
  const Eigen::Isometry3d from = looking({0.0, 0.0, 0.7}, 0.0, 0.2);
  const DepthCamera camera = room_camera(320, 240);
  for (int i = 0; i < 4; ++i) map.insert(camera, from, room.take(camera, from, 0.1 * i));
  expect_exact(map);

  std::mt19937 generator(17);
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  int moves = 0;
  for (int round = 0; round < 12; ++round) {
    const VoxelWindow window = map.window();
    std::vector<int> before(window.count());
    each_voxel(window, [&](const Eigen::Vector3i& index) {
      before[window.stored(index)] = map.log_odds(index);
    });
    map.move_to({1.0 + uniform(generator), uniform(generator), 0.5 + 0.5 * uniform(generator)});
    moves += map.window().first != window.first;
    int wrong = 0;
    each_voxel(map.window(), [&](const Eigen::Vector3i& index) {
      const int expected = window.contains(index) ? before[window.stored(index)] : kNeverSeen;
      wrong += map.log_odds(index) != expected;
    });
    ASSERT_EQ(wrong, 0) << round;
    expect_exact(map);
  }
  EXPECT_GT(moves, 6);
  map.move_to({40.0, 0.0, 0.0});  // farther than the window is long
  each_voxel(map.window(),
             [&](const Eigen::Vector3i& index) { ASSERT_EQ(map.log_odds(index), kNeverSeen); });
}

TEST(LocalMap, FollowsInStepsAndNotForSmallWays) {
  LocalMap map(small_window());
  map.move_to({10.0, 0.0, 0.0});
  const Eigen::Vector3i at = map.window().first;
  EXPECT_EQ(at.x() % 8, 0);
  EXPECT_NEAR(map.window().bounds().center().x(), 10.0, 0.2 + 1e-9);
  map.move_to({10.15, 0.15, 0.1});
  map.move_to({9.85, -0.15, -0.1});
  EXPECT_EQ(map.window().first, at);
  map.move_to({11.0, 0.0, 0.0});
  EXPECT_GT(map.window().first.x(), at.x());
}

TEST(LocalMap, TheSameBitsAtEachLevel) {
  RoomCamera room(19);
  room.solids = test::furnished_room();
  const DepthCamera camera = room_camera(318, 239);
  std::vector<std::vector<int>> results;
  LocalMapOptions options = small_window();
  options.forget_after_s = 0.5;
  options.unknown = UnknownSpace::kOccupied;
  std::vector<DepthImage> images;
  for (int i = 0; i < 16; ++i)
    images.push_back(room.take(camera, test::walking_camera(i % 2, 0.2 * i), 0.2 * i));
  for (const std::string& level : simd_levels()) {
    LocalMap map(options, level);
    for (int i = 0; i < 16; ++i) {
      const Eigen::Isometry3d pose = test::walking_camera(i % 2, 0.2 * i);
      map.move_to(pose.translation() + Eigen::Vector3d(1.5, 0.0, -0.3));
      map.insert(camera, pose, images[static_cast<std::size_t>(i)]);
      if (i % 3 == 0) map.field();
    }
    results.push_back(everything(map));
  }
  for (std::size_t i = 1; i < results.size(); ++i)
    EXPECT_TRUE(results[i] == results[0]) << simd_levels()[i];
}

TEST(LocalMap, ForgetsWhatIsNotSeenAnyMore) {
  LocalMapOptions options = small_window();
  options.forget_after_s = 2.0;
  LocalMap map(options);
  map.move_to({1.0, 0.0, 0.5});
  RoomCamera room(23);
  const test::RoomSolid left = solid_box({1.0, 0.6, 0.0}, {1.3, 0.9, 1.0});
  room.solids = {left};
  const DepthCamera camera = room_camera(160, 120);
  const Eigen::Isometry3d to_the_left = looking({0.0, 0.0, 0.7}, 0.6, 0.2),
                          away = looking({0.0, 0.0, 0.7}, -1.2, 0.2);
  for (int i = 0; i < 4; ++i)
    map.insert(camera, to_the_left, room.take(camera, to_the_left, 0.1 * i));
  const int seen = occupied_near(map, left, 0.05);
  EXPECT_GT(seen, 20);
  for (double time_s = 0.4; time_s < 2.2; time_s += 0.1)
    map.insert(camera, away, room.take(camera, away, time_s));
  EXPECT_EQ(occupied_near(map, left, 0.05), seen);
  for (double time_s = 2.2; time_s < 2.7; time_s += 0.1)
    map.insert(camera, away, room.take(camera, away, time_s));
  EXPECT_EQ(occupied_near(map, left, 0.05), 0);
  EXPECT_EQ(map.log_odds({22, 14, 8}), kNeverSeen);
  expect_exact(map);
}

TEST(LocalMap, UnknownSpaceIsFreeOrOccupiedOrSlow) {
  RoomCamera room(29);
  room.solids = {solid_box({1.5, -2.0, 0.0}, {1.6, 2.0, 2.0})};
  const Eigen::Isometry3d from = looking({0.0, 0.0, 0.7}, 0.0, 0.1);
  const DepthCamera camera = room_camera(160, 120);
  const Eigen::Vector3d seen(0.9, 0.0, 0.7), behind(2.4, 0.0, 0.7), outside(0.0, 5.0, 0.7);
  for (const UnknownSpace unknown :
       {UnknownSpace::kFree, UnknownSpace::kOccupied, UnknownSpace::kSlow}) {
    LocalMapOptions options = small_window();
    options.unknown = unknown;
    LocalMap map(options);
    map.move_to({1.0, 0.0, 0.5});
    for (int i = 0; i < 4; ++i) map.insert(camera, from, room.take(camera, from, 0.1 * i));
    const std::shared_ptr<const LocalField> field = map.field();
    EXPECT_TRUE(field->is_known(seen));
    EXPECT_FALSE(field->is_known(behind));
    EXPECT_FALSE(field->is_known(outside));
    EXPECT_GT(field->distance(seen), 0.1);
    const bool occupied = unknown == UnknownSpace::kOccupied;
    EXPECT_EQ(field->distance(behind) < 0.0, occupied);
    EXPECT_EQ(field->distance(outside) < 0.0, occupied);
    EXPECT_NEAR(field->distance(outside), occupied ? -3.4 : 1.0, 0.1);
    if (occupied) {
      // Towards the window, at any distance from it.
      EXPECT_LT((field->sample(outside).gradient - Eigen::Vector3d(0, -1, 0)).norm(), 1e-9);
      map.clear(
          Eigen::AlignedBox3d(Eigen::Vector3d(2.2, -0.2, 0.5), Eigen::Vector3d(2.6, 0.2, 0.9)));
      EXPECT_GT(map.field()->distance(behind), 0.05);
    }
  }
}

TEST(LocalMap, SteadyStateAllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  RoomCamera room(31);
  room.solids = test::furnished_room();
  LocalMapOptions options = small_window();
  options.forget_after_s = 0.3;
  LocalMap map(options);
  const DepthCamera small = room_camera(160, 120), large = room_camera(320, 240);
  const DepthImage first = room.take(small, test::walking_camera(0, 0.0), 0.0),
                   second = room.take(large, test::walking_camera(1, 0.0), 0.0);
  std::shared_ptr<const LocalField> held;
  const auto run = [&](int images) {
    for (int i = 0; i < images; ++i) {
      map.move_to({1.0 + 0.1 * (i % 12), 0.0, 0.5});
      map.insert(small, test::walking_camera(0, 0.0), first);
      map.insert(large, test::walking_camera(1, 0.0), second);
      held = map.field();
    }
  };
  run(3);
  const long before = test::allocation_count();
  run(30);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(LocalMap, ReadersAndTheWriterDoNotWaitForEachOther) {
  RoomCamera room(37);
  room.solids = {solid_box({1.5, -0.5, 0.0}, {1.8, 0.5, 1.0})};
  LocalMap map(small_window());
  const DepthCamera camera = room_camera(80, 60);
  const Eigen::Isometry3d from = looking({0.0, 0.0, 0.7}, 0.0, 0.2);
  const DepthImage image = room.take(camera, from, 0.0);
  map.move_to({1.0, 0.0, 0.5});
  map.insert(camera, from, image);

  // The newest field changes hands under a lock; sampling it needs none.
  std::shared_ptr<const LocalField> newest = map.field();
  std::mutex hand_over;
  std::atomic<bool> done = false;
  std::atomic<int> torn = 0, read = 0;
  const auto reader = [&] {
    double last = -kInfinity;
    while (!done) {
      std::shared_ptr<const LocalField> field;
      {
        const std::lock_guard lock(hand_over);
        field = newest;
      }
      const double stamp = field->stamp_s();
      const DistanceSample one = field->sample({1.0, 0.1, 0.6});
      torn += stamp < last;
      last = stamp;
      const DistanceSample two = field->sample({1.0, 0.1, 0.6});
      torn += one.distance != two.distance || field->stamp_s() != stamp;
      ++read;
    }
  };
  std::thread first(reader), second(reader);
  for (int i = 1; i < 60 || read < 100; ++i) {
    DepthImage next = image;
    next.stamp_s = 0.1 * i;
    map.move_to({1.0 + 0.1 * (i % 8), 0.0, 0.5});
    map.insert(camera, from, next);
    std::shared_ptr<const LocalField> field = map.field();
    const std::lock_guard lock(hand_over);
    newest = std::move(field);
  }
  done = true;
  first.join();
  second.join();
  EXPECT_EQ(torn, 0);
}

TEST(LocalMap, AFieldThatIsHeldStaysAsItIs) {
  std::vector<std::shared_ptr<const LocalField>> held;
  {
    LocalMap map(small_window());
    map.move_to({1.0, 0.0, 0.5});
    RoomCamera room(41);
    const DepthCamera camera = room_camera(160, 120);
    const Eigen::Isometry3d from = looking({0.0, 0.0, 0.7}, 0.0, 0.2);
    for (int i = 0; i < 6; ++i) {
      room.solids = {solid_box({1.0 + 0.2 * i, -1.0, 0.0}, {3.0, 1.0, 1.5})};
      for (int k = 0; k < 6; ++k)
        map.insert(camera, from, room.take(camera, from, 0.1 * (6 * i + k)));
      held.push_back(map.field());
      EXPECT_EQ(held.back(), map.field());  // nothing new: the same one
    }
  }
  // All of them live longer than the map.
  for (std::size_t i = 0; i < held.size(); ++i) {
    EXPECT_EQ(held[i]->stamp_s(), 0.1 * (6.0 * static_cast<double>(i) + 5.0));
    const Eigen::Vector3i at_the_face =
        held[i]->window().index_at({1.02 + 0.2 * static_cast<double>(i), 0.0, 0.5});
    EXPECT_LE(held[i]->squared_distance(at_the_face), 2) << i;
  }
}

std::string message(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(LocalMap, RefusesBadInputAndStaysAsItWas) {
  LocalMap map(small_window());
  RoomCamera room(43);
  const DepthCamera camera = room_camera(80, 60);
  const Eigen::Isometry3d from = looking({0.0, 0.0, 0.7}, 0.0, 0.2);
  const DepthImage image = room.take(camera, from, 1.0);
  map.insert(camera, from, image);
  const std::shared_ptr<const LocalField> field = map.field();

  EXPECT_NE(message([&] { map.insert(room_camera(160, 120), from, image); }).find("160 x 120"),
            std::string::npos);
  DepthImage short_one = image;
  short_one.depth_mm.pop_back();
  EXPECT_NE(message([&] { map.insert(camera, from, short_one); }).find("4799 depths"),
            std::string::npos);
  DepthImage timeless = image;
  timeless.stamp_s = kInfinity;
  EXPECT_NE(message([&] { map.insert(camera, from, timeless); }).find("stamp"), std::string::npos);
  Eigen::Isometry3d nowhere = from;
  nowhere.translation().x() = std::nan("");
  EXPECT_NE(message([&] { map.insert(camera, nowhere, image); }).find("pose"), std::string::npos);
  Eigen::Isometry3d scaled = from;
  scaled.linear() *= 2.0;
  EXPECT_NE(message([&] { map.insert(camera, scaled, image); }).find("pose"), std::string::npos);
  DepthCamera blind = camera;
  blind.fx = 0.0;
  EXPECT_NE(message([&] { map.insert(blind, from, image); }).find("focal"), std::string::npos);
  EXPECT_NE(message([&] { map.move_to({kInfinity, 0.0, 0.0}); }), "");
  EXPECT_NE(message([&] { map.move_to({1e5, 0.0, 0.0}); }), "");
  EXPECT_EQ(map.field(), field);  // nothing has changed
  EXPECT_EQ(map.stamp_s(), 1.0);
}

TEST(LocalMap, OptionsOutOfRangeAreRefused) {
  const auto refused = [](const std::function<void(LocalMapOptions&)>& change) {
    LocalMapOptions options;
    change(options);
    return message([&] { LocalMap map(options); });
  };
  EXPECT_NE(refused([](auto& o) {
              o.size_m = {800.0, 800.0, 3.0};
            }).find("16000 x 16000 x 60 voxels, expected at most 2^25"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.size_m = {1e300, 1.0, 1.0}; }).find("2^25"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.resolution_m = 0.0; }), "");
  EXPECT_NE(refused([](auto& o) { o.resolution_m = std::nan(""); }), "");
  EXPECT_NE(refused([](auto& o) { o.max_distance_m = 10.0; }), "");
  EXPECT_NE(refused([](auto& o) { o.log_odds.occupied_from = 40; }), "");
  EXPECT_NE(refused([](auto& o) { o.log_odds.least = 1; }), "");
  EXPECT_NE(refused([](auto& o) { o.least_pixels = 0; }), "");
  EXPECT_NE(refused([](auto& o) { o.forget_after_s = 0.0; }), "");
  EXPECT_NE(refused([](auto& o) { o.floor_z_m = kInfinity; }), "");
  EXPECT_NE(message([] { LocalMap map({}, "v9"); }).find("no level is called 'v9'"),
            std::string::npos);
}

TEST(LocalMap, PixelsWithoutADepthChangeNothing) {
  LocalMap map(small_window());
  const DepthCamera camera = room_camera(80, 60);
  DepthImage dark{.stamp_s = 0.0, .camera = 0, .width = 80, .height = 60, .depth_mm = {}};
  dark.depth_mm.assign(80 * 60, 0);
  map.insert(camera, looking({0.0, 0.0, 0.7}, 0.0, 0.2), dark);
  each_voxel(map.window(),
             [&](const Eigen::Vector3i& index) { ASSERT_EQ(map.log_odds(index), kNeverSeen); });
}

}  // namespace
}  // namespace locograph
