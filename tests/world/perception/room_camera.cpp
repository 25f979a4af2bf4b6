#include "world/perception/room_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph::test {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

/// First t > 0 with from + t * ray on the solid.
double hit(const RoomSolid& solid, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double enter = 0.01, leave = kNothing;
  const int axes = solid.kind == RoomSolid::Kind::kBox ? 0 : 2;
  for (int axis = axes; axis < 3; ++axis) {
    const double a = (solid.lower[axis] - from[axis]) / ray[axis];
    const double b = (solid.upper[axis] - from[axis]) / ray[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (solid.kind == RoomSolid::Kind::kUprightCylinder) {
    const Eigen::Vector2d middle = 0.5 * (solid.lower + solid.upper).head<2>();
    const double radius = 0.5 * (solid.upper - solid.lower).x();
    const Eigen::Vector2d away = from.head<2>() - middle, way = ray.head<2>();
    const double a = way.squaredNorm(), b = away.dot(way), c = away.squaredNorm() - radius * radius;
    const double inside = b * b - a * c;
    if (inside < 0.0) return kNothing;
    enter = std::max(enter, (-b - std::sqrt(inside)) / a);
    leave = std::min(leave, (-b + std::sqrt(inside)) / a);
  }
  return enter <= leave ? enter : kNothing;
}

/// Smooth noise: values on a grid of pixels, interpolated.
class Patches {
 public:
  Patches(int width, int height, int pixels, std::mt19937& generator)
      : pixels_(pixels), columns_(width / pixels + 2) {
    values_.resize(static_cast<std::size_t>(columns_) * (height / pixels + 2));
    std::normal_distribution<float> normal;
    for (float& value : values_) value = normal(generator);
  }
  float at(int u, int v) const {
    const int i = u / pixels_, j = v / pixels_;
    const float a = static_cast<float>(u % pixels_) / pixels_,
                b = static_cast<float>(v % pixels_) / pixels_;
    const float* row = values_.data() + static_cast<std::size_t>(j) * columns_ + i;
    return (1 - b) * ((1 - a) * row[0] + a * row[1]) +
           b * ((1 - a) * row[columns_] + a * row[columns_ + 1]);
  }

 private:
  int pixels_, columns_;
  std::vector<float> values_;
};

}  // namespace

double RoomSolid::distance(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  Eigen::Vector3d out = (point - middle).cwiseAbs() - half;
  if (kind == Kind::kUprightCylinder)
    out = {(point - middle).head<2>().norm() - half.x(), out.z(), -kNothing};
  const double outside = out.cwiseMax(0.0).norm();
  return outside > 0.0 ? outside : out.maxCoeff();
}

RoomSolid solid_box(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  return {RoomSolid::Kind::kBox, lower, upper};
}

RoomSolid upright_cylinder(double x, double y, double lower_z, double upper_z, double radius) {
  return {RoomSolid::Kind::kUprightCylinder,
          {x - radius, y - radius, lower_z},
          {x + radius, y + radius, upper_z}};
}

DepthCamera room_camera(int width, int height) {
  DepthCamera camera;
  camera.name = "room";
  camera.width = width;
  camera.height = height;
  camera.fx = 0.5 * width / std::tan(0.5 * 87.0 * M_PI / 180.0);
  camera.fy = 0.5 * height / std::tan(0.5 * 58.0 * M_PI / 180.0);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

Eigen::Isometry3d looking(const Eigen::Vector3d& from, double yaw_rad, double pitch_rad) {
  Eigen::Matrix3d forward_from_optical;
  forward_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()))
                      .toRotationMatrix() *
                  forward_from_optical;
  pose.translation() = from;
  return pose;
}

Eigen::Isometry3d walking_camera(int camera, double time_s) {
  const double x = 0.15 + 0.3 * time_s - 0.2 / 1.5 * (std::cos(1.5 * time_s) - 1.0),
               y = 0.1 * std::sin(0.7 * time_s),
               z = (camera == 0 ? 1.35 : 0.75) + 0.01 * std::sin(8.0 * time_s);
  return looking({x, y, z}, 0.3 * std::sin(0.9 * time_s),
                 (camera == 0 ? 0.40 : 0.15) + 0.02 * std::sin(6.0 * time_s));
}

DepthImage RoomCamera::take(const DepthCamera& camera, const Eigen::Isometry3d& world_from_optical,
                            double stamp_s) {
  const int width = camera.width, height = camera.height;
  const auto pixels = static_cast<std::size_t>(width) * height;
  DepthImage image{
      .stamp_s = stamp_s, .camera = 0, .width = width, .height = height, .depth_mm = {}};
  image.depth_mm.resize(pixels);
  depth_.resize(pixels);
  const Eigen::Vector3d from = world_from_optical.translation();
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d ray =
          world_from_optical.linear() *
          Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      double depth = has_floor && ray.z() < 0.0 ? -from.z() / ray.z() : kNothing;
      for (const RoomSolid& solid : solids) depth = std::min(depth, hit(solid, from, ray));
      depth_[static_cast<std::size_t>(v) * width + u] = static_cast<float>(depth);
    }
  }
  // Noise that grows with the square of the range, partly the same for pixels nearby; flying pixels
  // and drop-outs where depth jumps.
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform;
  const Patches slow(width, height, 8, generator_), holes(width, height, 16, generator_);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const std::size_t at = static_cast<std::size_t>(v) * width + u;
      const float depth = depth_[at];
      float seen = depth, beside = depth;
      bool lost = false;
      if (noise > 0.0) {
        for (int k : {-2, -1, 1, 2}) {
          const float other = depth_[at - u + std::clamp(u + k, 0, width - 1)];
          if (other < 7.0f && std::abs(other - depth) > 0.08f + 0.02f * depth) beside = other;
        }
        const float spread = 0.0025f * depth * depth * static_cast<float>(noise);
        seen += spread * (0.75f * normal(generator_) + 0.9f * slow.at(u, v));
        lost = uniform(generator_) < 0.01f || holes.at(u, v) > 1.9f;
        if (beside != depth && uniform(generator_) < 0.25f)
          seen = depth + (beside - depth) * uniform(generator_);
        if (beside != depth && uniform(generator_) < 0.25f) lost = true;
      }
      const bool in_range = seen > camera.range_min_m && seen < camera.range_max_m;
      image.depth_mm[at] =
          static_cast<std::uint16_t>(lost || !in_range ? 0 : std::lround(seen * 1000.0f));
    }
  }
  return image;
}

std::vector<RoomSolid> furnished_room() {
  std::vector<RoomSolid> solids = {solid_box({6.0, -5.0, 0.0}, {6.2, 5.0, 3.0}),
                                   solid_box({-4.0, 2.5, 0.0}, {6.0, 2.7, 3.0}),
                                   solid_box({-4.0, -3.2, 0.0}, {6.0, -3.0, 3.0}),
                                   solid_box({2.0, -0.83, 0.0}, {2.6, -0.22, 0.41}),
                                   solid_box({3.2, 0.4, 0.70}, {4.0, 1.4, 0.73}),
                                   solid_box({4.3, -1.5, 1.5}, {4.45, 1.5, 1.6}),
                                   solid_box({4.6, -3.0, 0.0}, {6.0, -1.5, 0.17}),
                                   solid_box({5.0, -3.0, 0.0}, {6.0, -1.5, 0.34}),
                                   upright_cylinder(2.02, 0.51, 0.0, 1.9, 0.01),
                                   upright_cylinder(3.01, -1.22, 0.0, 1.9, 0.01),
                                   upright_cylinder(4.3, -0.1, 0.0, 1.9, 0.01),
                                   upright_cylinder(1.63, -1.31, 0.0, 1.9, 0.025),
                                   upright_cylinder(2.5, 1.7, 0.65, 1.15, 0.25)};
  for (const double x : {3.25, 3.95}) {
    for (const double y : {0.45, 1.35}) solids.push_back(upright_cylinder(x, y, 0.0, 0.7, 0.02));
  }
  return solids;
}

}  // namespace locograph::test
