#include <locograph/planners/online/detour_search.h>
#include <locograph/planners/online/heading.h>
#include <locograph/plugins/configuration/near_spheres.h>

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
    : robot_(std::move(robot)), options_(options), state_(robot_) {
  half_ = static_cast<int>(std::ceil(options.largest_offset_m / options.grid_m));
  half_ += half_ % kCoarse;
  slopes_ = 2 * options.steepest + 1;
}

double DetourSearch::obstacle_cost(const WorldDistance& world, double time_s,
                                   const Eigen::Vector3d& shift) const {
  double sum = 0.0;
  each_near_sphere(*robot_, {state_.bound_centres, state_.sphere_centres, shift}, world, time_s,
                   options_.margin_m, [&](int s, double distance) {
                     const double short_by =
                         options_.margin_m + robot_->spheres[s].radius - distance;
                     if (short_by > 0.0) sum += short_by * short_by;
                   });
  return options_.obstacle_weight * sum;
}

void DetourSearch::forget() {
  for (Costs& costs : obstacle_) costs.index = -1;
  progress_.first = -1;
}

/// A configuration with its base turned.
void DetourSearch::place(const double* planned, int yaw) {
  turned_ = Eigen::Map<const Eigen::VectorXd>(planned, robot_->robot->configuration_size());
  turn_base(yaw * options_.yaw_grid_rad, turned_.data());
  state_.update(turned_.data());
}

/// Whether the costs of a configuration are there.
bool DetourSearch::fill_obstacle_costs(int index, const double* planned, const WorldDistance& world,
                                       double time_s, Slice& slice) {
  Costs& costs = costs_of(index);
  if (costs.index != index) {
    costs.index = index;
    costs.done = 0;
  }
  const int in_row = half_ + 1, all = yaws() * in_row;  // of every other offset
  if (costs.of.empty()) costs.of.resize(static_cast<std::size_t>(yaws() * offsets()));
  const Eigen::Vector3d side = left_of(planned);
  for (bool placed = false; costs.done < all; ++slice.used) {
    if (slice.ended()) return false;
    const int yaw = costs.done / in_row, at = costs.done % in_row;
    if (!placed || at == 0) place(planned, yaw - options_.most_yaw);
    placed = true;
    double* row = costs.of.data() + static_cast<std::ptrdiff_t>(yaw) * offsets();
    const int offset = kCoarse * at;
    row[offset] = obstacle_cost(world, time_s, (offset - half_) * options_.grid_m * side);
    if (offset > 0) row[offset - 1] = 0.5 * (row[offset - kCoarse] + row[offset]);
    ++costs.done;
  }
  return true;
}

void DetourSearch::begin_ways(const Progress& from) {
  const auto on_grid = [](double value, double grid, int most) {
    return std::clamp(static_cast<int>(std::lround(value / grid)), -most, most);
  };
  progress_ = from;
  cost_.assign(static_cast<std::size_t>(states()), kInfinite);
  next_.assign(cost_.size(), kInfinite);
  choice_.assign(static_cast<std::size_t>(from.steps) * cost_.size(), 0);
  cost_[state_of(
      on_grid(from.start.yaw_rad, options_.yaw_grid_rad, options_.most_yaw) + options_.most_yaw,
      on_grid(from.start.offset_m, options_.grid_m, half_) + half_,
      on_grid(from.start_slope_m, options_.grid_m, options_.steepest))] = 0.0;
}

/// Ways to all offsets of a configuration, with one yaw.
void DetourSearch::go_on(int step, int y) {
  const int steepest = options_.steepest, most_yaw = options_.most_yaw;
  const double grid2 = options_.grid_m * options_.grid_m;
  const double yaw_grid2 = options_.yaw_grid_rad * options_.yaw_grid_rad;
  const std::vector<double>& obstacle = costs_of(progress_.first + step).of;
  std::int8_t* choice = choice_.data() + static_cast<std::size_t>(step) * cost_.size();
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

/// Whether all of them are found.
bool DetourSearch::find_ways(Slice& slice) {
  constexpr int kRow = 5;
  for (; progress_.step < progress_.steps; ++progress_.step) {
    for (; progress_.yaw < yaws(); ++progress_.yaw, slice.used += kRow) {
      if (slice.ended()) return false;
      go_on(progress_.step, progress_.yaw);
    }
    progress_.yaw = 0;
    cost_.swap(next_);
    std::fill(next_.begin(), next_.end(), kInfinite);
  }
  return true;
}

void DetourSearch::read_best_way() {
  const int steepest = options_.steepest, most_yaw = options_.most_yaw;
  int state = static_cast<int>(std::min_element(cost_.begin(), cost_.end()) - cost_.begin());
  found_.resize(static_cast<std::size_t>(progress_.steps));
  for (int k = progress_.steps - 1; k >= 0; --k) {
    const int s = state % slopes_ - steepest, o = state / slopes_ % offsets(),
              y = state / slopes_ / offsets();
    found_[static_cast<std::size_t>(k)] = {(o - half_) * options_.grid_m,
                                           (y - most_yaw) * options_.yaw_grid_rad};
    const int choice = choice_[static_cast<std::size_t>(k) * cost_.size() + state];
    const int turning = choice > 1 ? 1 : choice < -1 ? -1 : 0;
    state = state_of(y - turning, o - s, s - (choice - 3 * turning));
  }
}

const std::vector<Detour>& DetourSearch::find(int first, const std::vector<const double*>& plan,
                                              const std::vector<double>& time_s,
                                              const WorldDistance& world, const Detour& start,
                                              double start_slope_m,
                                              const Termination& termination) & {
  const int steps = static_cast<int>(plan.size());
  Slice slice{termination};
  found_.clear();
  if (obstacle_.size() < plan.size()) {
    obstacle_.resize(plan.size());
    forget();
  }
  for (int k = 0; k < steps; ++k) {
    if (!fill_obstacle_costs(first + k, plan[static_cast<std::size_t>(k)], world,
                             time_s[static_cast<std::size_t>(k)], slice)) {
      return found_;
    }
  }
  const bool goes_on = progress_.first == first && progress_.steps == steps &&
                       progress_.start.offset_m == start.offset_m &&
                       progress_.start.yaw_rad == start.yaw_rad &&
                       progress_.start_slope_m == start_slope_m;
  if (!goes_on) begin_ways({first, steps, start, start_slope_m});
  if (!find_ways(slice)) return found_;
  progress_.first = -1;
  read_best_way();
  return found_;
}

}  // namespace locograph
