#include <locograph/world/node_distances.h>
#include <locograph/world/perception/local_field.h>
#include <locograph/world/perception/window_octree.h>

#include <algorithm>

namespace locograph {

DistanceSample LocalField::sample_inside(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d cell = (point - lowest_node_) * inverse_resolution_;
  // Steps in memory to the lower and the upper node on each axis.
  std::size_t lower[3], upper[3];
  double t[3];
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int size = window_.size[axis];
    const int node = std::clamp(static_cast<int>(cell[axis]), 0, size - 2);
    t[axis] = cell[axis] - node;
    int at = node + window_.ring[axis];
    if (at >= size) at -= size;
    lower[axis] = static_cast<std::size_t>(at) * stride;
    upper[axis] = at + 1 == size ? 0 : lower[axis] + stride;
    stride *= static_cast<std::size_t>(size);
  }
  const auto value = [this](std::size_t at) {
    return static_cast<double>(value_of_squared_[static_cast<std::size_t>(squared_[at])]);
  };
  const CellNodes nodes{
      value(lower[0] + lower[1] + lower[2]), value(lower[0] + lower[1] + upper[2]),
      value(lower[0] + upper[1] + lower[2]), value(lower[0] + upper[1] + upper[2]),
      value(upper[0] + lower[1] + lower[2]), value(upper[0] + lower[1] + upper[2]),
      value(upper[0] + upper[1] + lower[2]), value(upper[0] + upper[1] + upper[2])};
  return between_nodes(nodes, t[0], t[1], t[2], inverse_resolution_, max_distance_m_);
}

DistanceSample LocalField::sample(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d clamped = point.cwiseMax(lowest_node_).cwiseMin(highest_node_);
  DistanceSample sample = sample_inside(clamped);
  if (clamped == point) return sample;
  const Eigen::Vector3d out = point - clamped;
  if (unknown_ != UnknownSpace::kOccupied) return beyond_nodes(sample, out, max_distance_m_);
  const double depth = out.norm();
  sample.distance -= depth;
  for (int axis = 0; axis < 3; ++axis) {
    if (out[axis] != 0.0) sample.gradient[axis] = -out[axis] / depth;
  }
  return sample;
}

bool LocalField::is_known(const Eigen::Vector3d& point) const {
  return window_.bounds().contains(point) && window_.contains(window_.index_at(point)) &&
         is_known(window_.index_at(point));
}

void LocalField::merge_into(octomap::OcTree& tree) const {
  merge_window(window_, scale_, log_odds_, tree);
}

}  // namespace locograph
