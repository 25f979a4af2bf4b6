// Statics and dynamics of CENTAURO: 41 active joints, floating base.
#include <benchmark/benchmark.h>
#include <locograph/robots/dynamics.h>

#include <filesystem>

namespace {

struct Standing {
  Standing() : robot(load()), state(robot), dynamics(robot), size(robot.tangent_size()) {
    state.update(robot.named_configuration("home").data());
    for (const char* wheel : {"wheel_1", "wheel_2", "wheel_3", "wheel_4"}) {
      wrenches.push_back({.link = robot.link_index(wheel),
                          .force = Eigen::Vector3d(10.0, -20.0, 280.0),
                          .moment = Eigen::Vector3d(1.0, 2.0, 3.0)});
    }
    torques.resize(size);
    matrix.resize(size, size);
    velocity = Eigen::VectorXd::LinSpaced(size, -1.0, 1.0);
  }

  static locograph::Robot load() {
    const std::filesystem::path folder =
        std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/centauro";
    return locograph::Robot::load(folder / "centauro.urdf", folder / "centauro.srdf");
  }

  locograph::Robot robot;
  locograph::RobotState state;
  locograph::RobotDynamics dynamics;
  int size;
  std::vector<locograph::PointWrench> wrenches;
  const Eigen::Vector3d gravity = locograph::standard_gravity();
  Eigen::VectorXd torques, velocity;
  Eigen::MatrixXd matrix;
};

template <class Function>
void measure(benchmark::State& run, const Function& function) {
  Standing robot;
  for (auto _ : run) {
    function(robot);
    benchmark::DoNotOptimize(robot.torques.data());
    benchmark::DoNotOptimize(robot.matrix.data());
    benchmark::ClobberMemory();
  }
}

void BM_GravityTorques(benchmark::State& run) {
  measure(run, [](Standing& r) { gravity_torques(r.state, r.gravity, r.torques); });
}
BENCHMARK(BM_GravityTorques);

void BM_GravityTorquesAndDerivative(benchmark::State& run) {
  measure(run, [](Standing& r) {
    gravity_torques(r.state, r.gravity, r.torques);
    gravity_torque_derivative(r.state, r.gravity, r.matrix);
  });
}
BENCHMARK(BM_GravityTorquesAndDerivative);

/// With a wrench at each wheel.
void BM_StaticTorquesAndDerivative(benchmark::State& run) {
  measure(run, [](Standing& r) {
    static_torques(r.state, r.gravity, r.wrenches, r.torques);
    static_torque_derivative(r.state, r.gravity, r.wrenches, r.matrix);
  });
}
BENCHMARK(BM_StaticTorquesAndDerivative);

void BM_MassMatrix(benchmark::State& run) {
  measure(run, [](Standing& r) { r.dynamics.mass_matrix(r.state, r.matrix); });
}
BENCHMARK(BM_MassMatrix);

void BM_InverseDynamics(benchmark::State& run) {
  measure(run, [](Standing& r) {
    r.dynamics.inverse_dynamics(r.state, r.velocity, r.velocity, r.wrenches, r.torques);
  });
}
BENCHMARK(BM_InverseDynamics);

}  // namespace

BENCHMARK_MAIN();
