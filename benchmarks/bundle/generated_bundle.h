#pragma once
/// A seeded bundle adjustment problem of any size: a camera driven twice around a block of houses,
/// looking to the side at façades.
///
///     BundleProblem problem = generate_bundle({.cameras = 500, .points = 100'000});
///
/// Every point is seen by about `seen` cameras next to each other in one lap; some are found again
/// in the other lap and close loops. Measurements carry noise, and the start is perturbed.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace locograph {

struct BundleProblem {
  struct Observation {
    int camera, point;
    double x, y;
  };
  std::vector<Eigen::Matrix<double, 9, 1>> cameras;  ///< see types/bundle/camera_bal.h
  std::vector<Eigen::Vector3d> points;
  std::vector<Observation> observations;  ///< point by point
};

struct BundleOptions {
  int cameras = 500;
  int points = 100'000;
  double seen = 6.0;       ///< cameras that see a point, on average
  double revisited = 0.1;  ///< fraction of the points seen in both laps
  double noise_px = 0.5;
  double start_m = 0.1;     ///< standard deviation of the start's positions and points
  double start_rad = 0.01;  ///< and of its rotations
  unsigned seed = 1;
};

BundleProblem generate_bundle(const BundleOptions& options);
BundleProblem load_bundle(const std::filesystem::path& bal_file);

}  // namespace locograph
