// Kinematics of CENTAURO: 41 active joints, floating base, about 60 links.
#include <benchmark/benchmark.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/robot_state.h>

#include <filesystem>

namespace {

locograph::Robot centauro() {
  const std::filesystem::path folder =
      std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/centauro";
  return locograph::Robot::load(folder / "centauro.urdf", folder / "centauro.srdf");
}

void BM_Update(benchmark::State& run) {
  const locograph::Robot robot = centauro();
  locograph::RobotState state(robot);
  Eigen::VectorXd q = robot.named_configuration("home");
  for (auto _ : run) {
    q[8] += 1e-9;
    state.update(q.data());
    benchmark::DoNotOptimize(state.world_from_link(0));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_Update);

/// One distance-gradient row for every covering sphere, with an overshoot of `range(0)` mm.
void BM_AllSphereGradients(benchmark::State& run) {
  const locograph::Robot robot = centauro();
  locograph::RobotState state(robot);
  state.update(robot.named_configuration("home").data());
  const std::vector<locograph::CollisionSphere> spheres =
      locograph::covering_spheres(robot, 1e-3 * static_cast<double>(run.range(0)));
  const Eigen::Vector3d direction(0.36, 0.48, 0.8);
  Eigen::VectorXd row(robot.tangent_size());
  for (auto _ : run) {
    for (const locograph::CollisionSphere& sphere : spheres) {
      row.setZero();
      const Eigen::Vector3d centre = state.world_from_link(sphere.link) * sphere.center;
      state.add_point_gradient(sphere.link, centre, direction, 1.0, row.data());
      benchmark::DoNotOptimize(row.data());
      benchmark::ClobberMemory();
    }
  }
  run.counters["spheres"] = static_cast<double>(spheres.size());
}
BENCHMARK(BM_AllSphereGradients)->Arg(10)->Arg(20)->Arg(40);

/// What all collision edges of one configuration need: link poses, and centre and Jacobian of every
/// covering sphere.
void BM_PosesAndAllSphereJacobians(benchmark::State& run) {
  using Jacobian3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  const locograph::Robot robot = centauro();
  locograph::RobotState state(robot);
  Eigen::VectorXd q = robot.named_configuration("home");
  const std::vector<locograph::CollisionSphere> spheres =
      locograph::covering_spheres(robot, 1e-3 * static_cast<double>(run.range(0)));
  std::vector<Jacobian3> jacobians(spheres.size(), Jacobian3::Zero(3, robot.tangent_size()));
  std::vector<Eigen::Vector3d> centres(spheres.size());
  for (auto _ : run) {
    q[8] += 1e-9;
    state.update(q.data());
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      centres[i] = state.world_from_link(spheres[i].link) * spheres[i].center;
      state.point_jacobian(spheres[i].link, centres[i], jacobians[i]);
    }
    benchmark::DoNotOptimize(jacobians.data());
    benchmark::ClobberMemory();
  }
  run.counters["spheres"] = static_cast<double>(spheres.size());
}
BENCHMARK(BM_PosesAndAllSphereJacobians)->Arg(10)->Arg(20)->Arg(40);

void BM_FrameJacobian(benchmark::State& run) {
  const locograph::Robot robot = centauro();
  locograph::RobotState state(robot);
  state.update(robot.named_configuration("home").data());
  const int wheel = robot.link_index("wheel_4");
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, robot.tangent_size());
  for (auto _ : run) {
    state.frame_jacobian(wheel, Eigen::Isometry3d::Identity(), jacobian);
    benchmark::DoNotOptimize(jacobian.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_FrameJacobian);

void BM_CenterOfMassJacobian(benchmark::State& run) {
  const locograph::Robot robot = centauro();
  locograph::RobotState state(robot);
  state.update(robot.named_configuration("home").data());
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian(3, robot.tangent_size());
  for (auto _ : run) {
    state.center_of_mass_jacobian(jacobian);
    benchmark::DoNotOptimize(jacobian.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_CenterOfMassJacobian);

}  // namespace

BENCHMARK_MAIN();
