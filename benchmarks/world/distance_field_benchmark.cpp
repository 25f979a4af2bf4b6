#include <benchmark/benchmark.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/octree.h>

#include <filesystem>
#include <random>
#include <vector>

namespace {

// A 6 m x 4 m room with a floor, two walls, a table and a few boxes.
std::shared_ptr<octomap::OcTree> room(double resolution_m) {
  const auto box = [](double x, double y, double z, double sx, double sy, double sz) {
    locograph::Box out;
    out.world_from_box.translation() = Eigen::Vector3d(x, y, z);
    out.size = Eigen::Vector3d(sx, sy, sz);
    return out;
  };
  const std::vector<locograph::Box> boxes{
      box(3, 0, -0.05, 6, 4, 0.1),       box(3, 2, 1, 6, 0.1, 2),
      box(3, -2, 1, 6, 0.1, 2),          box(3, 1.5, 0.7, 1, 0.6, 0.05),
      box(2, -0.9, 0.25, 0.5, 0.5, 0.5), box(4.5, 0.8, 0.5, 0.4, 0.4, 1)};
  return locograph::octree_from_boxes(boxes, resolution_m);
}

locograph::DistanceFieldOptions room_options(double max_distance_m) {
  locograph::DistanceFieldOptions options;
  options.max_distance_m = max_distance_m;
  options.lower = Eigen::Vector3d(0, -2, 0);
  options.upper = Eigen::Vector3d(6, 2, 2);
  options.ground_z = 0.0;
  return options;
}

// Arguments: resolution and largest distance [mm].
void build(benchmark::State& state) {
  const std::shared_ptr<octomap::OcTree> tree = room(1e-3 * static_cast<double>(state.range(0)));
  const locograph::DistanceFieldOptions options =
      room_options(1e-3 * static_cast<double>(state.range(1)));
  std::size_t nodes = 0;
  for (auto _ : state) {
    const locograph::DistanceField field = locograph::DistanceField::from_octree(*tree, options);
    nodes = field.values().size();
    benchmark::DoNotOptimize(field.values().data());
  }
  state.counters["nodes"] = static_cast<double>(nodes);
}
BENCHMARK(build)->Args({50, 1000})->Args({50, 500})->Args({25, 500})->Unit(benchmark::kMillisecond);

void sample(benchmark::State& state) {
  const locograph::DistanceField field = locograph::DistanceField::from_octree(
      *room(1e-3 * static_cast<double>(state.range(0))), room_options(0.5));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4096; ++i)
    points.emplace_back(6 * uniform(random), 4 * uniform(random) - 2, 2 * uniform(random));
  std::size_t i = 0;
  for (auto _ : state) {
    const locograph::DistanceSample s = field.sample(points[i++ % points.size()]);
    benchmark::DoNotOptimize(s);
  }
}
BENCHMARK(sample)->Arg(50)->Arg(25);

// One configuration of a robot with 47 capsules, driving through the room.
void environment_and_self_distance(benchmark::State& state) {
  const std::filesystem::path folder = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "robots";
  if (!std::filesystem::exists(folder / "centauro_capsule.urdf")) {
    state.SkipWithError("centauro_capsule.urdf is missing");
    return;
  }
  locograph::RobotOptions robot_options;
  robot_options.lenient_srdf = true;
  const locograph::Robot robot = locograph::Robot::load(
      folder / "centauro_capsule.urdf", folder / "centauro_capsule.srdf", robot_options);
  locograph::RobotState robot_state(robot);
  Eigen::VectorXd q = robot.neutral_configuration();
  const locograph::CollisionWorld world(robot, room(1e-3 * static_cast<double>(state.range(0))),
                                        {});
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  double x = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    x = x > 6.0 ? 0.0 : x + 0.01;
    q[0] = x;
    q[2] = 0.9;
    robot_state.update(q.data());
    for (std::size_t link = 0; link < poses.size(); ++link)
      poses[link] = robot_state.world_from_link(static_cast<int>(link));
    state.ResumeTiming();
    benchmark::DoNotOptimize(world.environment_distance(poses, 0.0).distance_m);
    benchmark::DoNotOptimize(world.self_distance(poses).distance_m);
  }
}
BENCHMARK(environment_and_self_distance)->Arg(50)->Arg(25)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
