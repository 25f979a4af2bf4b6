#include <locograph/apps/refine_perception.h>
#include <locograph/apps/statistics.h>
#include <locograph/common/stop_signals.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace locograph {
namespace {

constexpr double kMostDistance_voxels = 98.0;  // a window's field reaches no further

UnknownSpace unknown_space(const std::string& name) {
  if (name == "occupied") return UnknownSpace::kOccupied;
  return name == "slow" ? UnknownSpace::kSlow : UnknownSpace::kFree;
}

/// Where the wheels stand: the ground, or, without one, what the first stance stands on.
double floor_of(const PlanFile& file, const World& world) {
  const double ground_m = ground_height(world);
  if (std::isfinite(ground_m) || file.plan.stance_from.empty()) return ground_m;
  const auto& first = file.plan.stance_from.front();
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const Contact& contact : first ? first->stance.contacts : std::vector<Contact>()) {
    lowest_m = std::min(lowest_m, contact.position.z());
  }
  return std::isfinite(lowest_m) ? lowest_m : ground_m;
}

PerceptionOptions options_of(const PlanFile& file, const World& world,
                             const PerceptionChoice& choice) {
  PerceptionOptions options;
  options.map.resolution_m = choice.voxel_m;
  options.map.size_m.head<2>().setConstant(choice.window_m);
  options.map.max_distance_m =
      std::min(options.map.max_distance_m, kMostDistance_voxels * choice.voxel_m);
  options.map.unknown = unknown_space(choice.unknown);
  options.map.floor_z_m = floor_of(file, world);
  options.keeps_map = !choice.save_map.empty();
  return options;
}

/// A map says nothing about its frame; that of another one is mostly somewhere else.
void require_on_the_way(const octomap::OcTree& map, const std::string& name, const PlanFile& file,
                        const Robot& robot, const LocalMapOptions& window) {
  const Eigen::AlignedBox3d known = octree_info(map).known_bounds;
  if (known.isEmpty()) return;
  RobotState state(robot);
  Eigen::AlignedBox3d reach;
  for (const int slot : file.plan.slots) {
    state.update(file.graph.vertex(VertexId<VertexConfiguration>{slot}).state.data());
    const Eigen::Vector3d base = state.world_from_link(robot.root_link()).translation();
    reach.extend(Eigen::Vector3d(base - 0.5 * window.size_m));
    reach.extend(Eigen::Vector3d(base + 0.5 * window.size_m));
  }
  if (reach.intersects(known)) return;
  const Eigen::Vector3d middle = known.center();
  throw Error(name, 0,
              "nothing of this map is near the robot's way; its middle is at " +
                  short_number(middle.x()) + ' ' + short_number(middle.y()) + ' ' +
                  short_number(middle.z()),
              "a map in the plan's frame");
}

World known_beforehand(const PlanFile& file, const Judging& judging, const PerceptionChoice& choice,
                       const LocalMapOptions& window) {
  World known = judging.world->world();
  if (choice.cameras) {
    known.map = choice.known_map.empty() ? nullptr : load_octree(choice.known_map);
    known.obstacles.clear();
  }
  if (!known.map) return known;
  const std::string given = choice.cameras ? choice.known_map : judging.world->files().map.string();
  const std::string& name = given.empty() ? file.name : given;
  const double voxel_m = known.map->getResolution();
  if (std::abs(voxel_m - choice.voxel_m) > 1e-9 * voxel_m) {
    throw Error(name, 0, "a map with voxels of " + short_number(voxel_m) + " m",
                "those of the window, --voxel " + short_number(choice.voxel_m));
  }
  require_on_the_way(*known.map, name, file, *judging.robot, window);
  return known;
}

std::unique_ptr<ImageSource> simulated_images(const PlanFile& file, const Judging& judging,
                                              const PerceptionChoice& choice,
                                              std::vector<DepthCamera> cameras) {
  // Some looks before it starts: one image alone says little.
  constexpr double kLooks = 5.0;
  const int first = file.plan.slots.front();
  const double start_s = file.graph.vertex(VertexId<VertexConfiguration>{first}).time_s;
  SimulatedImagesOptions options;
  options.rate_hz = choice.rate_hz;
  options.begin_s = start_s - (kLooks - 0.5) / choice.rate_hz;
  options.seed = choice.seed;
  return std::make_unique<SimulatedImages>(judging.robot, judging.world->world(),
                                           std::move(cameras), options);
}

/// Throws Error where not one of the clouds comes before the plan ends.
void require_in_time(const CloudsFolder& clouds, const PlanFile& file,
                     const PerceptionChoice& choice) {
  const auto time_s = [&](int slot) {
    return file.graph.vertex(VertexId<VertexConfiguration>{slot}).time_s;
  };
  const double begin_s = time_s(file.plan.slots.front()), end_s = time_s(file.plan.slots.back());
  const double slower = choice.unknown == "slow" ? CameraWalkOptions().slower : 1.0;
  const double first_s = clouds.stamp_s(0), latest_s = begin_s + slower * (end_s - begin_s);
  if (first_s <= latest_s) return;
  throw Error(clouds.files().front().string(), 0,
              "the first cloud is of " + short_number(first_s) + " s, after the end of the plan",
              "times of the plan's clock, which ends at " + short_number(latest_s) + " s");
}

Json window_json(const Perception& perception) {
  const LocalField& field = *perception.field();
  const VoxelWindow& window = field.window();
  std::size_t known = 0, occupied = 0;
  for (int k = 0; k < window.size.z(); ++k) {
    for (int j = 0; j < window.size.y(); ++j) {
      for (int i = 0; i < window.size.x(); ++i) {
        const Eigen::Vector3i index = window.first + Eigen::Vector3i(i, j, k);
        known += field.is_known(index) ? 1 : 0;
        occupied += field.is_occupied(index) ? 1 : 0;
      }
    }
  }
  const Eigen::Vector3d size = window.bounds().sizes();
  return {{"resolution_m", window.resolution_m},
          {"window_m", {size.x(), size.y(), size.z()}},
          {"occupied_voxels", occupied},
          {"known_share", static_cast<double>(known) / static_cast<double>(window.count())}};
}

}  // namespace

void add_perception_options(OptionParser& parser, PerceptionChoice& choice) {
  parser.add_flag("--cameras", choice.cameras,
                  "Know of the world what the robot's depth cameras, simulated, show of it");
  parser.add_option("--clouds", choice.clouds,
                    "Folder of recorded clouds to be shown at their times (clouds.csv)");
  parser.add_option("--camera-rate", choice.rate_hz, "Images of each simulated camera [1/s]")
      .between(0.1, 1000.0)
      .show_default();
  parser
      .add_option(
          "--unknown", choice.unknown,
          "What was never seen: free, occupied, or slow: free, and steps take twice as long")
      .one_of({"free", "occupied", "slow"})
      .show_default();
  parser.add_option("--known-map", choice.known_map,
                    "With --cameras: OctoMap of what is known beforehand");
  parser.add_option("--voxel", choice.voxel_m, "Voxels of the map around the robot [m]")
      .between(0.01, 1.0)
      .show_default();
  parser.add_option("--window", choice.window_m, "How long and wide that map is [m]")
      .between(1.0, 1000.0)
      .show_default();
  parser.add_option("--seed", choice.seed, "Of the noise of simulated cameras").show_default();
}

void check_perception_options(const OptionParser& parser, const PerceptionChoice& choice,
                              const std::vector<std::filesystem::path>& inputs) {
  if (choice.cameras && !choice.clouds.empty()) {
    throw Error("both --cameras and --clouds", "one of them");
  }
  if (!choice.cameras && !choice.known_map.empty()) {
    throw Error("--known-map without --cameras", "--map: with --clouds, that is known beforehand");
  }
  for (const std::string option : {"--save-map", "--unknown", "--voxel", "--window"}) {
    if (choice.given() || !parser.has_option(option) || !parser.given(option)) continue;
    throw Error(option + " without --cameras or --clouds", "one of them");
  }
  for (const std::string option : {"--camera-rate", "--seed"}) {
    if (choice.cameras || !parser.given(option)) continue;
    throw Error(option + " without --cameras", "simulated cameras");
  }
  if (choice.save_map.empty()) return;
  if (choice.save_map == "-") throw Error("a map to standard output", "a file");
  check_output(choice.save_map, inputs);
}

void take_verdict(const CheckReport& check, WalkReport& report) {
  if (check.feasible) return;
  const std::string refused = "refused: " + violation_text(check.worst());
  report.reason = report.success() ? refused : refused + "; " + report.reason;
  report.status = PlannerStatus::kNotFound;
}

RefinePerception::RefinePerception(const PlanFile& file, const Judging& judging,
                                   const PerceptionChoice& choice,
                                   std::function<void(const FilteredImage&)> on_image)
    : choice_(choice) {
  if (choice.unknown == "slow" && !file.plan.segments.empty()) {
    throw Error(file.name, 0, "the plan tells its segments and how long they take",
                "--unknown free or occupied");
  }
  const World& world = judging.world->world();
  const std::vector<DepthCamera> cameras =
      judging.task ? judging.task->cameras : cameras_of(*judging.robot);
  PerceptionOptions options = options_of(file, world, choice);
  options.on_image = std::move(on_image);
  perception_ = std::make_unique<Perception>(
      judging.robot, cameras, known_beforehand(file, judging, choice, options.map), options);
  files_ = files_of(file);
  if (choice.cameras) {
    images_ = simulated_images(file, judging, choice, cameras);
  } else {
    CloudsFolder folder(choice.clouds, cameras);
    require_in_time(folder, file, choice);
    std::ranges::copy(folder.files(), std::back_inserter(files_));
    recorded_ = folder.size();
    images_ = std::make_unique<RecordedImages>(std::move(folder));
  }
  if (!choice.save_map.empty()) check_not_input(choice.save_map, files_);
  CameraWalkOptions walk;
  walk.stop = &stop_flag();
  walk_.emplace(file.graph, judging, *perception_, *images_, walk);
}

void RefinePerception::equip(WalkOptions& options) {
  options.planner.fallbacks = camera_fallbacks();
  options.verify = [this](const Motion& step) { return walk_->check_step(step); };
  if (choice_.unknown == "slow") {
    options.pace = [this](int executed) { return walk_->pace(executed); };
  }
}

WorldAt RefinePerception::world_at() {
  return [this](int executed) { return walk_->world_at(executed); };
}

void RefinePerception::tell(Json& result) const {
  Json cameras = Json::array();
  for (const DepthCamera& camera : perception_->cameras()) cameras.push_back(camera.name);
  result["cameras"] = std::move(cameras);
  result["images"] = perception_->images();
  result["blind_images"] = perception_->blind();
  result["refused_images"] = walk_->refused();
  if (!choice_.clouds.empty()) result["images_not_shown"] = not_shown();
  result["perception_time"] = statistics_json(walk_->perception_s());
  result["camera_time_s"] = walk_->images_s();
  result["map"] = window_json(*perception_);
  if (walk_->refused() > 0) result["refused_because"] = walk_->last_refusal();
  if (!choice_.save_map.empty()) result["map"]["file"] = choice_.save_map;
}

/// Of recorded images those of times at which the robot did not walk any more.
int RefinePerception::not_shown() const {
  return recorded_ == 0 ? 0 : recorded_ - perception_->images() - walk_->refused();
}

std::string RefinePerception::text() const {
  const Json times = statistics_json(walk_->perception_s());
  const auto ms = [&times](const char* which) {
    return short_number(1e3 * times[which].get<double>()) + " ms";
  };
  std::string text = counted(perception_->images(), "image", "images") + " seen, " + ms("mean") +
                     " each (p99 " + ms("p99") + ")";
  if (perception_->blind() > 0) {
    text += ", " + std::to_string(perception_->blind()) + " of them without anything to see";
  }
  if (walk_->refused() > 0) {
    text += ", " + std::to_string(walk_->refused()) + " refused: " + walk_->last_refusal();
  }
  if (not_shown() > 0) {
    text += ", " + std::to_string(not_shown()) + " not shown: of later times than the walk's";
  }
  return text + '\n';
}

void RefinePerception::save_map() const {
  if (!choice_.save_map.empty()) save_octree(*perception_->map(), choice_.save_map);
}

}  // namespace locograph
