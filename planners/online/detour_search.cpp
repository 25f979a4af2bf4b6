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

void DetourSearch::fill_obstacle_costs(const Eigen::VectorXd& configuration,
                                       const Eigen::Vector3d& side, const WorldDistance& world,
                                       double time_s, double* costs) {
  state_.update(configuration.data());
  for (std::size_t s = 0; s < centres_.size(); ++s) {
    const CollisionSphere& sphere = robot_->spheres[s];
    centres_[s] = state_.world_from_link(sphere.link) * sphere.center;
  }
  for (std::size_t b = 0; b < bound_centres_.size(); ++b) {
    const RobotParameter::LinkBound& bound = robot_->bounds[b];
    bound_centres_[b] = state_.world_from_link(bound.link) * bound.center;
  }
  for (int o = -half_; o <= half_; o += kCoarse) {
    costs[o + half_] = obstacle_cost(world, time_s, o * options_.grid_m * side);
  }
  for (int o = -half_ + 1; o < half_; o += kCoarse) {
    costs[o + half_] = 0.5 * (costs[o + half_ - 1] + costs[o + half_ + 1]);
  }
}

std::vector<Detour> DetourSearch::find(int first_index, const std::vector<const double*>& plan,
                                       const std::vector<double>& time_s,
                                       const WorldDistance& world, const Detour& start,
                                       double start_slope_m, const Termination& termination) {
  const int steps = static_cast<int>(plan.size());
  const int states = yaws() * offsets() * slopes_, steepest = options_.steepest;
  const double grid2 = options_.grid_m * options_.grid_m;
  const double yaw_grid2 = options_.yaw_grid_rad * options_.yaw_grid_rad;
  const int most_yaw = options_.most_yaw;
  obstacle_.erase(obstacle_.begin(), obstacle_.lower_bound(first_index));
  bool added = false;
  for (int k = 0; k < steps; ++k) {
    std::vector<double>& costs = obstacle_[first_index + k];
    if (!costs.empty()) continue;
    if (added && termination.ended()) return {};
    costs.resize(static_cast<std::size_t>(yaws() * offsets()));
    const Eigen::VectorXd planned =
        Eigen::Map<const Eigen::VectorXd>(plan[k], robot_->robot->configuration_size());
    for (int y = -most_yaw; y <= most_yaw; ++y) {
      fill_obstacle_costs(turned(planned, y * options_.yaw_grid_rad), left_of(plan[k]), world,
                          time_s[k], costs.data() + (y + most_yaw) * offsets());
    }
    added = true;
  }
  // cost_[yaw, offset, slope] of the best way to come from the start; choice_ is how it came.
  cost_.assign(states, kInfinite);
  next_.resize(states);
  choice_.assign(static_cast<std::size_t>(steps) * states, 0);
  const auto on_grid = [](double value, double grid, int most) {
    return std::clamp(static_cast<int>(std::lround(value / grid)), -most, most);
  };
  const auto state_of = [&](int yaw, int offset, int slope) {
    return (yaw * offsets() + offset) * slopes_ + slope + steepest;
  };
  cost_[state_of(on_grid(start.yaw_rad, options_.yaw_grid_rad, most_yaw) + most_yaw,
                 on_grid(start.offset_m, options_.grid_m, half_) + half_,
                 on_grid(start_slope_m, options_.grid_m, steepest))] = 0.0;
  for (int k = 0; k < steps; ++k) {
    std::fill(next_.begin(), next_.end(), kInfinite);
    const std::vector<double>& obstacle = obstacle_.at(first_index + k);
    std::int8_t* choice = choice_.data() + static_cast<std::size_t>(k) * states;
    for (int y = 0; y < yaws(); ++y) {
      for (int o = 0; o < offsets(); ++o) {
        const double here = obstacle[y * offsets() + o] +
                            options_.lateral_weight * grid2 * (o - half_) * (o - half_) +
                            options_.yaw_weight * yaw_grid2 * (y - most_yaw) * (y - most_yaw);
        for (int s = -steepest; s <= steepest; ++s) {
          const int from = o - s;
          if (from < 0 || from >= offsets()) continue;
          const int state = state_of(y, o, s);
          // Straight on first: equal costs are resolved in one fixed order.
          for (const int turning : {0, -1, 1}) {
            if (y - turning < 0 || y - turning >= yaws()) continue;
            for (const int turn : {0, -1, 1}) {
              const int before = s - turn;
              if (before < -steepest || before > steepest) continue;
              const double cost = cost_[state_of(y - turning, from, before)] + here +
                                  options_.step_weight * grid2 * s * s +
                                  options_.turn_weight * grid2 * turn * turn +
                                  options_.turning_weight * yaw_grid2 * turning * turning;
              if (cost < next_[state]) {
                next_[state] = cost;
                choice[state] = static_cast<std::int8_t>(turn + 3 * turning);
              }
            }
          }
        }
      }
    }
    cost_.swap(next_);
  }
  int state = static_cast<int>(std::min_element(cost_.begin(), cost_.end()) - cost_.begin());
  std::vector<Detour> result(steps);
  for (int k = steps - 1; k >= 0; --k) {
    const int s = state % slopes_ - steepest, o = state / slopes_ % offsets(),
              y = state / slopes_ / offsets();
    result[k] = {(o - half_) * options_.grid_m, (y - most_yaw) * options_.yaw_grid_rad};
    const int choice = choice_[static_cast<std::size_t>(k) * states + state];
    const int turning = choice > 1 ? 1 : choice < -1 ? -1 : 0;
    state = state_of(y - turning, o - s, s - (choice - 3 * turning));
  }
  return result;
}

}  // namespace locograph
