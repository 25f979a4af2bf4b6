/// GTSAM on a pose graph file, for pose_graph_benchmark: prints `SECONDS CHI2` for the initial
/// values and after each step of Levenberg-Marquardt, the clock starting when the graph is loaded.
///
///     g++ -std=c++17 -O2 gtsam_pose_graph.cpp -lgtsam -o gtsam_pose_graph
///     pose_graph_benchmark --gtsam ./gtsam_pose_graph
///
/// Not part of the build: it needs an installed GTSAM (4.2 or later). chi2 is twice GTSAM's cost,
/// in its own convention (logarithm of the pose error), so only times are comparable.

#include <gtsam/nonlinear/LevenbergMarquardtOptimizer.h>
#include <gtsam/nonlinear/NonlinearFactorGraph.h>
#include <gtsam/slam/dataset.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string file = argv[1];
  bool spatial = false;
  std::ifstream in(file);
  // GTSAM's reader stops at a FIX line; a prior on the first pose, below, stands for it.
  const std::string copy = file + ".gtsam";
  {
    std::ofstream out(copy);
    for (std::string line; std::getline(in, line);) {
      spatial = spatial || line.find("SE3:QUAT") != std::string::npos;
      if (line.rfind("FIX", 0) != 0) out << line << "\n";
    }
  }
  const auto [graph, initial] = gtsam::readG2o(copy, spatial);
  std::filesystem::remove(copy);
  const gtsam::Key first = initial->keys().front();
  if (spatial) {
    graph->addPrior(first, initial->at<gtsam::Pose3>(first), gtsam::noiseModel::Unit::Create(6));
  } else {
    graph->addPrior(first, initial->at<gtsam::Pose2>(first), gtsam::noiseModel::Unit::Create(3));
  }
  const auto start = std::chrono::steady_clock::now();
  const auto report = [&](double cost) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    std::printf("%.9f %.17g\n", passed.count(), 2.0 * cost);
  };
  gtsam::LevenbergMarquardtParams parameters;
  gtsam::LevenbergMarquardtOptimizer optimiser(*graph, *initial, parameters);
  report(optimiser.error());
  for (int i = 0; i < 100; ++i) {
    const double before = optimiser.error();
    optimiser.iterate();
    report(optimiser.error());
    if (before - optimiser.error() <= 1e-7 * before) break;
  }
  return 0;
}
