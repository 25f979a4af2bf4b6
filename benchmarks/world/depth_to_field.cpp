/// From a depth image to a distance field: a window of voxels that two cameras fill while they walk
/// through a room, at each level of vector instructions that this machine has.
///
///     depth_to_field [--seconds S] [--rounds N] [--octomap N] [--images N]
///
/// Prints one JSON object: milliseconds of processor time of one 640 x 480 image, the window's move
/// and the field included, the share of a core that two cameras at 30 images a second take,
/// OctoMap's insertPointCloud() on the same images, memory, and nanoseconds of a sample. --images:
/// so many small images on a small window besides, again and again the same walk, each time to the
/// same bits.

#include <locograph/common/simd_level.h>
#include <locograph/world/perception/local_map.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"
#include "world/measure.h"
#include "world/octomap_insertion.h"
#include "world/perception/room_camera.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kCameras = 2;
constexpr double kRate_Hz = 30.0;

struct View {
  Eigen::Isometry3d world_from_optical;
  DepthImage image;
};

std::vector<View> walk(const DepthCamera& camera, double seconds) {
  test::RoomCamera room(7);
  room.solids = test::furnished_room();
  std::vector<View> views;
  for (int frame = 0; frame < seconds * kRate_Hz; ++frame) {
    for (int i = 0; i < kCameras; ++i) {
      const double time_s = frame / kRate_Hz;
      const Eigen::Isometry3d pose = test::walking_camera(i, time_s);
      views.push_back({pose, room.take(camera, pose, time_s)});
    }
  }
  return views;
}

/// In the middle of the window's height the robot's waist.
Eigen::Vector3d centre_for(const View& view) {
  Eigen::Vector3d at = view.world_from_optical.translation();
  at.z() = 1.3;
  return at;
}

Json sampling(const LocalField& field) {
  constexpr int kSamples = 1'000'000;
  const Eigen::AlignedBox3d bounds = field.window().bounds();
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(0.02, 0.98);
  std::vector<Eigen::Vector3d> points(4096);
  for (Eigen::Vector3d& point : points) {
    const Eigen::Vector3d share(uniform(generator), uniform(generator), uniform(generator));
    point = bounds.min() + share.cwiseProduct(bounds.sizes());
  }
  double sum = 0.0;
  const double begin = processor_ms();
  for (int i = 0; i < kSamples; ++i) {
    const DistanceSample sample = field.sample(points[static_cast<std::size_t>(i) % points.size()]);
    sum += sample.distance + sample.gradient.x();
  }
  const double ns = (processor_ms() - begin) * 1e6 / kSamples;
  return {{"ns", ns}, {"sum", sum}};
}

Json at_level(const std::string& level, const LocalMapOptions& options, const DepthCamera& camera,
              const std::vector<View>& views, int rounds) {
  std::vector<double> all, still, moved, insertion, field_time;
  LocalMap map(options, level);
  std::shared_ptr<const LocalField> field;
  std::size_t occupied = 0;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      const View& view = views[i];
      DepthImage image = view.image;
      image.stamp_s += 1000.0 * round;
      const double begin = processor_ms();
      const Eigen::Vector3i first = map.window().first;
      map.move_to(centre_for(view));
      const bool moves = map.window().first != first;
      map.insert(camera, view.world_from_optical, image);
      const double inserted = processor_ms();
      field = map.field();
      const double end = processor_ms();
      if (round == 0 && i < 4) continue;
      all.push_back(end - begin);
      (moves ? moved : still).push_back(end - begin);
      insertion.push_back(inserted - begin);
      field_time.push_back(end - inserted);
    }
  }
  const VoxelWindow& window = field->window();
  for (int z = 0; z < window.size[2]; ++z)
    for (int y = 0; y < window.size[1]; ++y)
      for (int x = 0; x < window.size[0]; ++x)
        occupied += field->is_occupied(window.first + Eigen::Vector3i(x, y, z));
  const Json image_to_field = spread(all);
  return {{"image_to_field_ms", image_to_field},
          {"window_still_ms", spread(still)},
          {"window_moved_ms", spread(moved)},
          {"insertion_ms", spread(insertion)},
          {"field_ms", spread(field_time)},
          {"share_of_a_core", image_to_field["mean"].get<double>() * kCameras * kRate_Hz / 1000.0},
          {"memory_MB", static_cast<double>(map.memory_bytes()) / 1e6},
          {"occupied_voxels", occupied},
          {"sample", sampling(*field)}};
}

Json with_octomap(const DepthCamera& camera, const std::vector<View>& views, double resolution_m,
                  const OctomapInsertion& how, int images) {
  std::vector<double> times;
  octomap::OcTree tree(resolution_m);
  for (int i = 0; i < images && i < static_cast<int>(views.size()); ++i) {
    const View& view = views[static_cast<std::size_t>(i)];
    const double begin = processor_ms();
    insert_into(tree, camera, view.world_from_optical, view.image, how);
    times.push_back(processor_ms() - begin);
  }
  return spread(times);
}

/// The same short walk again and again: the field after each is the same from the third on, and
/// memory does not grow.
Json endurance(int images) {
  LocalMapOptions options;
  options.size_m = {3.2, 3.2, 1.6};
  options.forget_after_s = 2.0;
  options.floor_z_m = 0.0;
  const DepthCamera camera = test::room_camera(80, 60);
  const std::vector<View> views = walk(camera, 4.0);
  LocalMap map(options);
  std::vector<int> settled, now;
  double resident_before = 0.0;
  int different = 0, walks = 0, done = 0;
  const double period_s = 4.0;
  while (done < images) {
    for (const View& view : views) {
      DepthImage image = view.image;
      image.stamp_s += period_s * walks;
      Eigen::Vector3d centre = view.world_from_optical.translation();
      centre.z() = 0.6;
      map.move_to(centre);
      map.insert(camera, view.world_from_optical, image);
      map.field();
      ++done;
    }
    ++walks;
    const VoxelWindow& window = map.window();
    now.clear();
    for (int z = 0; z < window.size[2]; ++z)
      for (int y = 0; y < window.size[1]; ++y)
        for (int x = 0; x < window.size[0]; ++x)
          now.push_back(map.log_odds(window.first + Eigen::Vector3i(x, y, z)));
    if (walks == 3) {
      settled = now;
      resident_before = resident_megabytes();
    }
    if (walks > 3 && now != settled) ++different;
  }
  return {{"images", done},
          {"walks", walks},
          {"walks_that_end_differently", different},
          {"resident_growth_MB", resident_megabytes() - resident_before},
          {"map_memory_MB", static_cast<double>(map.memory_bytes()) / 1e6}};
}

void report(double seconds, int rounds, int octomap_images, int images) {
  const DepthCamera camera = test::room_camera();
  const std::vector<View> views = walk(camera, seconds);
  Json all = {{"unit", "ms of processor time"}, {"image", "640 x 480"}, {"images", views.size()}};
  LocalMapOptions large, small;
  small.size_m = {4.8, 4.8, 2.4};
  for (const auto& [name, options] :
       {std::pair("8 x 8 x 3 m", large), {"4.8 x 4.8 x 2.4 m", small}}) {
    for (const std::string& level : simd_levels())
      all[name][level] = at_level(level, options, camera, views, rounds);
  }
  if (octomap_images > 0) {
    for (const bool discretise : {false, true}) {
      all["octomap"][discretise ? "discretised" : "every ray"] =
          with_octomap(camera, views, large.resolution_m,
                       {.range_m = large.range_m, .discretised = discretise}, octomap_images);
    }
  }
  if (images > 0) all["endurance"] = endurance(images);
  std::cout << all.dump(2) << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("From a depth image to a distance field", "depth_to_field");
  double seconds = 3.0;
  int rounds = 3, octomap_images = 8, images = 0;
  app.add_option("--seconds", seconds, "Length of the walk").positive().show_default();
  app.add_option("--rounds", rounds, "Times that it is walked").positive().show_default();
  app.add_option("--octomap", octomap_images, "Images for OctoMap").not_negative().show_default();
  app.add_option("--images", images, "Small images on a small window").not_negative();
  return locograph::run_benchmark(
      app, argc, argv, [&] { locograph::report(seconds, rounds, octomap_images, images); });
}
