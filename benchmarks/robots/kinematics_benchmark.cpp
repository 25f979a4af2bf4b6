// Kinematics of CENTAURO: 41 active joints, floating base, about 60 links.
#include <benchmark/benchmark.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/states_together.h>

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

/// Link poses and centres of covering spheres (20 mm) of `range(0)` configurations.
struct Window {
  explicit Window(benchmark::State& run)
      : states(static_cast<std::size_t>(run.range(0)), locograph::RobotState(robot)),
        q(states.size(), robot.named_configuration("home")),
        centres(states.size()) {
    for (const locograph::CollisionSphere& sphere : locograph::covering_spheres(robot, 0.02)) {
      points.push_back({sphere.link, {sphere.center[0], sphere.center[1], sphere.center[2]}});
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      centres[i].resize(static_cast<Eigen::Index>(points.size()), 3);
      updates.push_back({&states[i], q[i].data(), {centres[i].data()}});
    }
  }
  locograph::Robot robot = centauro();
  std::vector<locograph::RobotState> states;
  std::vector<Eigen::VectorXd> q;
  std::vector<Eigen::MatrixX3d> centres;
  std::vector<locograph::LinkPoint> points;
  std::vector<locograph::StateUpdate> updates;
};

void BM_OneByOne(benchmark::State& run) {
  Window window(run);
  for (auto _ : run) {
    for (std::size_t i = 0; i < window.states.size(); ++i) {
      window.q[i][8] += 1e-9;
      window.states[i].update(window.q[i].data());
      for (std::size_t k = 0; k < window.points.size(); ++k) {
        const locograph::LinkPoint& point = window.points[k];
        window.centres[i].row(static_cast<Eigen::Index>(k)) =
            (window.states[i].world_from_link(point.link) *
             Eigen::Vector3d(point.at[0], point.at[1], point.at[2]))
                .transpose();
      }
    }
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_OneByOne)->Arg(1)->Arg(20);

void BM_Together(benchmark::State& run) {
  Window window(run);
  for (auto _ : run) {
    for (Eigen::VectorXd& q : window.q) q[8] += 1e-9;
    locograph::update_together(window.updates, window.points, {});
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_Together)->Arg(1)->Arg(20);

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
