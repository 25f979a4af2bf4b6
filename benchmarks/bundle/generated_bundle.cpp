#include "generated_bundle.h"

#include <locograph/common/error.h>
#include <locograph/types/bundle/bal_file.h>
#include <locograph/types/bundle/camera_bal.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

namespace locograph {
namespace {

using Camera = Eigen::Matrix<double, 9, 1>;

constexpr double kSpacing_m = 1.0;  // between cameras along the street

/// camera_from_world of a camera at `centre` whose −z axis looks along `forward`, y up.
Camera make_camera(const Eigen::Vector3d& centre, const Eigen::Vector3d& forward) {
  Eigen::Matrix3d world_from_camera;
  world_from_camera.col(2) = -forward.normalized();
  world_from_camera.col(1) = Eigen::Vector3d::UnitZ();
  world_from_camera.col(0) = world_from_camera.col(1).cross(world_from_camera.col(2)).normalized();
  world_from_camera.col(1) = world_from_camera.col(2).cross(world_from_camera.col(0));
  const Eigen::Matrix3d rotation = world_from_camera.transpose();
  const Eigen::AngleAxisd turn(rotation);
  Camera camera;
  camera.head<3>() = turn.angle() * turn.axis();
  camera.segment<3>(3) = -rotation * centre;
  camera.tail<3>().setZero();
  return camera;
}

}  // namespace

BundleProblem generate_bundle(const BundleOptions& options) {
  if (options.cameras < 20 || options.points < 10 || options.seen < 2.0) {
    throw Error("a bundle of " + std::to_string(options.cameras) + " cameras and " +
                    std::to_string(options.points) + " points",
                "at least 20 cameras, 10 points, seen by 2 cameras each");
  }
  std::mt19937_64 engine(options.seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  const auto normal3 = [&](double deviation) {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = deviation * normal(engine);
    return v;
  };

  BundleProblem problem;
  const int n = options.cameras;
  const int lap = n / 2;
  const double radius = lap * kSpacing_m / (2.0 * std::numbers::pi);
  for (int c = 0; c < n; ++c) {
    const double angle = 2.0 * std::numbers::pi * c / lap;
    const Eigen::Vector3d outwards(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d centre =
        radius * outwards + Eigen::Vector3d(0.0, 0.0, 1.5) + normal3(0.1);
    Camera camera = make_camera(centre, outwards + normal3(0.05));
    camera[6] = 800.0 + 20.0 * normal(engine);
    camera[7] = -0.05 + 0.01 * normal(engine);
    camera[8] = 0.01 + 0.002 * normal(engine);
    problem.cameras.push_back(camera);
  }

  const VertexCameraBAL model;
  std::vector<VertexCameraBAL::Derived> derived(n);
  for (int c = 0; c < n; ++c) model.derive(problem.cameras[c].data(), derived[c]);
  EdgeProjectBAL zero;
  const auto observe = [&](int camera, int point) {
    const Eigen::Vector3d seen =
        derived[camera].rotation * problem.points[point] + derived[camera].translation;
    Eigen::Vector2d image;
    zero.error(derived[camera], problem.points[point], image);
    if (seen[2] > -1.0 || image.norm() > 900.0) return;
    problem.observations.push_back({camera, point, image[0] + options.noise_px * normal(engine),
                                    image[1] + options.noise_px * normal(engine)});
  };
  while (static_cast<int>(problem.points.size()) < options.points) {
    // On a façade 5 to 20 m outside the street, in front of a random camera.
    const double along = uniform(engine) * n;
    const double angle = 2.0 * std::numbers::pi * along / lap;
    const double depth = 5.0 + 15.0 * uniform(engine) * uniform(engine);
    const Eigen::Vector3d outwards(std::cos(angle), std::sin(angle), 0.0);
    problem.points.push_back((radius + depth) * outwards +
                             Eigen::Vector3d(0.0, 0.0, 6.0 * uniform(engine) - 1.0));
    const int point = static_cast<int>(problem.points.size()) - 1;
    // As many neighbours as make the average, with a few long tracks.
    const double spread = 0.5 + uniform(engine);
    const int count = std::max(2, static_cast<int>(std::lround(options.seen * spread)));
    const bool both = uniform(engine) < options.revisited;
    std::set<int> cameras;
    for (int k = 0; k < count; ++k) {
      const int from = both && k % 2 == 1 ? static_cast<int>(along) + lap - k / 2
                                          : static_cast<int>(along) + k - count / 2;
      cameras.insert((from % n + n) % n);
    }
    const std::size_t before = problem.observations.size();
    for (const int camera : cameras) observe(camera, point);
    if (problem.observations.size() < before + 2) {
      problem.observations.resize(before);
      problem.points.pop_back();
    }
  }

  for (Camera& camera : problem.cameras) {
    const Eigen::Vector3d turn = normal3(options.start_rad), shift = normal3(options.start_m);
    camera.head<3>() += turn;
    camera.segment<3>(3) += shift;
    camera[6] *= 1.0 + 0.01 * normal(engine);
    camera.tail<2>().setZero();
  }
  for (Eigen::Vector3d& point : problem.points) point += normal3(options.start_m);
  return problem;
}

BundleProblem load_bundle(const std::filesystem::path& bal_file) {
  const Graph graph = read_bal(bal_file);
  BundleProblem problem;
  for (const VertexCameraBAL& camera : graph.vertices_of<VertexCameraBAL>()) {
    problem.cameras.push_back(camera.state);
  }
  for (const VertexPointXYZ& point : graph.vertices_of<VertexPointXYZ>()) {
    problem.points.push_back(point.state);
  }
  const int cameras = static_cast<int>(problem.cameras.size());
  for (const EdgeProjectBAL& edge : graph.edges_of<EdgeProjectBAL>()) {
    problem.observations.push_back(
        {edge.vertices[0], edge.vertices[1] - cameras, edge.measurement[0], edge.measurement[1]});
  }
  return problem;
}

}  // namespace locograph
