#pragma once
/// Finds on which side to pass an obstacle on the way, and how far to the side: the first guess
/// from which the graph optimiser reaches a detour.
///
///     DetourSearch search(robot, options);
///     std::vector<Detour> detours = search.find(first, window, times, world, {.offset_m = 0.1});
///
/// A local optimiser cannot tell left from right when an obstacle lies square across the plan.
/// Here the whole window is moved sideways as it is, legs and heading as planned, by an offset for
/// each of its configurations. Dynamic programming over (offset, change of offset) finds the
/// offsets that minimise
///   Σ w_lateral o² + w_step (Δo)² + w_turn (Δ²o)² + w_obstacle Σ_spheres max(0, margin + r − d)²
/// on a grid, Δ²o at most one grid step: the global optimum of that one-dimensional problem, left
/// and right alike.
///
/// With DetourOptions::most_yaw the configurations are turned about the vertical through their base
/// as well, by a yaw ψ that changes by one grid step at most, for
///   Σ w_yaw ψ² + w_turning (Δψ)²
/// more: a long robot gets slantwise between two obstacles that it does not get between head on.

#include <locograph/common/termination.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace locograph {

/// How a configuration is moved from where it was planned.
struct Detour {
  double offset_m = 0.0;  ///< to the left
  double yaw_rad = 0.0;   ///< counter-clockwise
};

struct DetourOptions {
  double grid_m = 0.02;
  double largest_offset_m = 1.6;
  int steepest = 4;  ///< change of offset from one configuration to the next, in grid steps
  double lateral_weight = 0.5, step_weight = 50.0, turn_weight = 300.0;
  double obstacle_weight = 1e4;
  double margin_m = 0.05;
  double yaw_grid_rad = 0.06;
  int most_yaw = 0;  ///< to either side, in grid steps; 0: heading as planned
  double yaw_weight = 0.5, turning_weight = 20.0;
};

class DetourSearch {
 public:
  DetourSearch(std::shared_ptr<const RobotParameter> robot, const DetourOptions& options);

  /// plan: the configurations of the window as planned. start and start_slope_m: where the executed
  /// configuration is, and how much its offset changed in the last step. first: index in the plan
  /// of the window's first configuration. Returns a detour for each configuration; none when the
  /// termination ends it. What has been worked out by then is kept for the next call, the costs of
  /// obstacles by index in the plan, and every call works out some more. Iterations of the
  /// termination: the costs of one configuration with one offset, or a fifth of a row of the
  /// dynamic programming. Does not allocate once plans of that size have been seen.
  const std::vector<Detour>& find(int first, const std::vector<const double*>& plan,
                                  const std::vector<double>& time_s, const WorldDistance& world,
                                  const Detour& start = {}, double start_slope_m = 0.0,
                                  const Termination& termination = {}) &;

  /// The world or the plan has changed: the costs that were kept do not hold any more.
  void forget();

 private:
  /// Of the obstacles for one configuration, [yaw][offset]; the first `done` of them are there, of
  /// every other offset.
  struct Costs {
    std::vector<double> of;
    int index = -1;  ///< of the configuration in the plan
    int done = 0;
  };
  /// What the dynamic programming is about, and how far it has come.
  struct Progress {
    int first = -1, steps = 0;
    Detour start;
    double start_slope_m = 0.0;
    int step = 0, yaw = 0;
  };
  /// Counts what a call works out.
  struct Slice {
    const Termination& termination;
    int used = 0;

    bool ended() const { return used > 0 && termination.ended(used); }
  };

  bool fill_obstacle_costs(int index, const double* planned, const WorldDistance& world,
                           double time_s, Slice& slice);
  void place(const double* planned, int yaw);
  double obstacle_cost(const WorldDistance& world, double time_s,
                       const Eigen::Vector3d& shift) const;
  void begin_ways(const Progress& from);
  bool find_ways(Slice& slice);
  void go_on(int step, int yaw);
  void read_best_way();
  Costs& costs_of(int index) {
    return obstacle_[static_cast<std::size_t>(index) % obstacle_.size()];
  }
  int state_of(int yaw, int offset, int slope) const {
    return (yaw * offsets() + offset) * slopes_ + slope + options_.steepest;
  }
  int states() const { return yaws() * offsets() * slopes_; }
  int offsets() const { return 2 * half_ + 1; }
  int yaws() const { return 2 * options_.most_yaw + 1; }

  std::shared_ptr<const RobotParameter> robot_;
  DetourOptions options_;
  ConfigurationState state_;
  int half_ = 0;    ///< offsets run from −half_ to half_ grid steps
  int slopes_ = 0;  ///< 2 · steepest + 1
  Eigen::VectorXd turned_;
  std::vector<Costs> obstacle_;  ///< as many as configurations: each has its place, by its index
  Progress progress_;
  /// [yaw, offset, slope]: of the best way from the start to there, a step further, and how it came
  /// there, by step: how the slope changed + 3 · how the yaw did.
  std::vector<double> cost_, next_;
  std::vector<std::int8_t> choice_;
  std::vector<Detour> found_;
};

}  // namespace locograph
