#include <locograph/planners/online/detour_search.h>
#include <locograph/planners/online/heading.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kCoarse = 2;  // obstacle costs are worked out on every other offset

}  // namespace

DetourSearch::DetourSearch(std::shared_ptr<const RobotParameter> robot,
                           const DetourOptions& options)
    : robot_(std::move(robot)), options_(options), state_(*robot_->robot) {
  half_ = static_cast<int>(std::ceil(options.largest_offset_m / options.grid_m));
  half_ += half_ % kCoarse;
  slopes_ = 2 * options.steepest + 1;
  centres_.resize(robot_->spheres.size());
  bound_centres_.resize(robot_->bounds.size());
}

double DetourSearch::obstacle_cost(const WorldDistance& world, double time_s,
                                   const Eigen::Vector3d& shift) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
    const RobotParameter::LinkBound& bound = robot_->bounds[b];
    const double reach = bound.radius + options_.margin_m;
    if (reach < world.max_distance() && world.distance(bound_centres_[b] + shift, time_s) > reach) {
      continue;
    }
    for (int s = bound.begin; s < bound.end; ++s) {
      const double distance = world.distance(centres_[s] + shift, time_s);
      const double short_by = options_.margin_m + robot_->spheres[s].radius - distance;
      if (short_by > 0.0) sum += short_by * short_by;
    }
  }
  return options_.obstacle_weight * sum;
}

void DetourSearch::forget() { obstacle_.clear(); }

/// Of every offset.
void DetourSearch::fill_obstacle_costs(const double* configuration, const WorldDistance& world,
                                       double time_s, double* costs) {
  state_.update(configuration);
  for (std::size_t s = 0; s < centres_.size(); ++s) {
    const CollisionSphere& sphere = robot_->spheres[s];
    centres_[s] = state_.world_from_link(sphere.link) * sphere.center;
  }
  for (std::size_t b = 0; b < bound_centres_.size(); ++b) {
    const RobotParameter::LinkBound& bound = robot_->bounds[b];
    bound_centres_[b] = state_.world_from_link(bound.link) * bound.center;
  }
  const Eigen::Vector3d side = left_of(configuration);
  for (int o = -half_; o <= half_; o += kCoarse) {
    costs[o + half_] = obstacle_cost(world, time_s, o * options_.grid_m * side);
  }
  for (int o = -half_ + 1; o < half_; o += kCoarse) {
    costs[o + half_] = 0.5 * (costs[o + half_ - 1] + costs[o + half_ + 1]);
  }
}

std::vector<double> DetourSearch::find(int first_index, const std::vector<const double*>& plan,
                                       const std::vector<double>& time_s,
                                       const WorldDistance& world, double start_offset,
                                       double start_slope, const Termination& termination) {
  const int steps = static_cast<int>(plan.size());
  const int offsets = 2 * half_ + 1, states = offsets * slopes_, steepest = options_.steepest;
  const double grid2 = options_.grid_m * options_.grid_m;
  obstacle_.erase(obstacle_.begin(), obstacle_.lower_bound(first_index));
  bool added = false;
  for (int k = 0; k < steps; ++k) {
    std::vector<double>& costs = obstacle_[first_index + k];
    if (!costs.empty()) continue;
    if (added && termination.ended()) return {};
    costs.resize(offsets);
    fill_obstacle_costs(plan[k], world, time_s[k], costs.data());
    added = true;
  }
  // cost_[offset, slope] of the best way to come from the start; choice_ is the change of slope.
  cost_.assign(states, kInfinite);
  next_.resize(states);
  choice_.assign(static_cast<std::size_t>(steps) * states, 0);
  const int first =
      std::clamp(static_cast<int>(std::lround(start_offset / options_.grid_m)), -half_, half_);
  const int slope =
      std::clamp(static_cast<int>(std::lround(start_slope / options_.grid_m)), -steepest, steepest);
  cost_[(first + half_) * slopes_ + slope + steepest] = 0.0;
  for (int k = 0; k < steps; ++k) {
    std::fill(next_.begin(), next_.end(), kInfinite);
    const std::vector<double>& obstacle = obstacle_.at(first_index + k);
    std::int8_t* choice = choice_.data() + static_cast<std::size_t>(k) * states;
    for (int o = 0; o < offsets; ++o) {
      const double here = obstacle[o] + options_.lateral_weight * grid2 * (o - half_) * (o - half_);
      for (int s = -steepest; s <= steepest; ++s) {
        const int from = o - s;
        if (from < 0 || from >= offsets) continue;
        const int state = o * slopes_ + s + steepest;
        // Straight on first: equal costs are resolved in one fixed order.
        for (const int turn : {0, -1, 1}) {
          const int before = s - turn;
          if (before < -steepest || before > steepest) continue;
          const double cost = cost_[from * slopes_ + before + steepest] + here +
                              options_.step_weight * grid2 * s * s +
                              options_.turn_weight * grid2 * turn * turn;
          if (cost < next_[state]) {
            next_[state] = cost;
            choice[state] = static_cast<std::int8_t>(turn);
          }
        }
      }
    }
    cost_.swap(next_);
  }
  int state = static_cast<int>(std::min_element(cost_.begin(), cost_.end()) - cost_.begin());
  std::vector<double> result(steps);
  for (int k = steps - 1; k >= 0; --k) {
    const int o = state / slopes_, s = state % slopes_ - steepest;
    result[k] = (o - half_) * options_.grid_m;
    const int turn = choice_[static_cast<std::size_t>(k) * states + state];
    state = (o - s) * slopes_ + (s - turn) + steepest;
  }
  return result;
}

}  // namespace locograph
