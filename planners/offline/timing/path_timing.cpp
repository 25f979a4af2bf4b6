#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/planners/offline/timing/path_timing.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace locograph {
namespace {

/// Of s: a coordinate runs through its limits in about the same time as any other.
Eigen::VectorXd path_scale(const Robot& robot, const TimingLimits& limits) {
  check_limits(robot, limits);
  Eigen::VectorXd scale(robot.tangent_size());
  for (int k = 0; k < robot.tangent_size(); ++k) {
    double limit = limits.velocity[k];
    if (k < robot.base_tangent_size()) {
      limit = std::min(limit, k < 3 ? limits.base_linear_m_s : limits.base_angular_rad_s);
    }
    if (std::isinf(limit)) limit = limits.acceleration[k];
    scale[k] = std::isinf(limit) ? 1.0 : limit;
  }
  return scale;
}

/// How many times too large something gets, squared where it is a velocity: a motion k times slower
/// has velocities of 1 / k and all that is linear in (u, x) of 1 / k^2.
struct Excess {
  double least = 0.0, most = std::numeric_limits<double>::infinity();  ///< of k^2

  void add(double ratio) { least = std::max(least, ratio); }
  void add_row(double value, double c) {
    if (c < 0.0) most = std::min(most, value / c);
    if (c > 0.0) add(value / c);
    if (c == 0.0 && value > 0.0) most = 0.0;
  }
};

}  // namespace

void TimingOptions::validate() const {
  GridSize{intervals, intervals_per_step}.validate();
  check_option(smoothing_s >= 0.0 && !std::isinf(smoothing_s), "smoothing_s", "0 or more");
  termination.validate();
}

PathSpline timing_path(const Robot& robot, std::vector<Eigen::VectorXd> waypoints,
                       const TimingLimits& limits, double max_deviation) {
  return {robot, std::move(waypoints), path_scale(robot, limits), max_deviation};
}

PathTiming::PathTiming(const Robot& robot, std::vector<Eigen::VectorXd> waypoints,
                       const TimingLimits& limits, const TimingOptions& options,
                       const TimingRowsAt& rows)
    : PathTiming(timing_path(robot, std::move(waypoints), limits, options.max_deviation), limits,
                 options, rows) {}

PathTiming::PathTiming(PathSpline path, const TimingLimits& limits, const TimingOptions& options,
                       const TimingRowsAt& rows)
    : path_(std::move(path)), smoothing_s_(options.smoothing_s) {
  options.validate();
  const Stopwatch watch;
  FastestProfile fastest = fastest_profile(
      path_, limits, {options.intervals, options.intervals_per_step}, rows, options.termination);
  answer_ = fastest;
  statistics_ = fastest.statistics;
  if (!answer_.success()) return;
  profile_ = std::move(fastest.profile);
  time_s_.assign(1, 0.0);
  integral_.assign(1, 0.0L);
  for (std::size_t i = 0; i + 1 < profile_.s.size(); ++i) {
    const long double from = std::sqrt(profile_.squared[i]),
                      to = std::sqrt(profile_.squared[i + 1]);
    const double step = profile_.s[i + 1] - profile_.s[i];
    time_s_.push_back(time_s_.back() + static_cast<double>(2.0L * step / (from + to)));
    const long double time = static_cast<long double>(time_s_.back()) - time_s_[i];
    integral_.push_back(integral_.back() + time * profile_.s[i] +
                        time * time * (2.0L * from + to) / 6.0L);
  }
  if (smoothing_s_ != 0.0 && !slow_down(limits, rows)) {
    answer_ = {PlannerStatus::kInfeasible, "rows leave no motion that is smoothed over " +
                                               std::to_string(smoothing_s_) +
                                               " s (smooth over less, or loosen them)"};
  }
  statistics_.total_s = watch.seconds();
}

std::size_t PathTiming::interval(double time) const {
  const auto after = std::upper_bound(time_s_.begin() + 1, time_s_.end() - 1, time);
  return static_cast<std::size_t>(after - time_s_.begin()) - 1;
}

PathTiming::Progress PathTiming::raw(double time) const {
  if (time <= 0.0 && smoothing_s_ > 0.0) return {};
  if (time >= time_s_.back() && smoothing_s_ > 0.0) return {path_.length(), 0.0, 0.0};
  const std::size_t i = interval(time);
  const double u =
      0.5 * (profile_.squared[i + 1] - profile_.squared[i]) / (profile_.s[i + 1] - profile_.s[i]);
  // From the nearer end, so that both ends are met exactly.
  const std::size_t end = time - time_s_[i] < time_s_[i + 1] - time ? i : i + 1;
  const double since = time - time_s_[end], speed = std::sqrt(profile_.squared[end]);
  return {profile_.s[end] + since * (speed + 0.5 * u * since), speed + u * since, u};
}

/// The integral of s. In long double, as s is the difference of two of them over a short time.
long double PathTiming::integral(double time) const {
  if (time <= 0.0) return 0.0L;
  if (time >= time_s_.back()) {
    return integral_.back() + static_cast<long double>(path_.length()) * (time - time_s_.back());
  }
  const std::size_t i = interval(time);
  const double step = profile_.s[i + 1] - profile_.s[i];
  const long double u = 0.5 * (profile_.squared[i + 1] - profile_.squared[i]) / step;
  const long double speed = std::sqrt(profile_.squared[i]), since = time - time_s_[i];
  return integral_[i] + since * (profile_.s[i] + since * (0.5L * speed + since * u / 6.0L));
}

PathTiming::Progress PathTiming::smooth(double time) const {
  if (smoothing_s_ == 0.0) return raw(time);
  const double begin = time - smoothing_s_;
  const Progress from = raw(begin), to = raw(time);
  const long double mean =
      (integral(time) - integral(begin)) / (static_cast<long double>(time) - begin);
  return {static_cast<double>(mean), (to.s - from.s) / smoothing_s_,
          (to.speed - from.speed) / smoothing_s_};
}

/// Between two of them nothing of the motion bends: neither the acceleration of s, which is linear
/// in time, nor the path's second derivative.
std::vector<double> PathTiming::smooth_pieces() const {
  constexpr int kPiecesPerSmoothing = 16;
  constexpr int kNewtonSteps = 12;
  const double end = time_s_.back() + smoothing_s_;
  std::vector<double> times = time_s_;
  for (const double time : time_s_) times.push_back(time + smoothing_s_);
  for (int i = 1; i * smoothing_s_ < end * kPiecesPerSmoothing; ++i) {
    times.push_back(i * smoothing_s_ / kPiecesPerSmoothing);
  }
  for (const double knot : path_.knots()) {
    const auto at = std::lower_bound(profile_.s.begin(), profile_.s.end(), knot);
    double before = time_s_[static_cast<std::size_t>(at - profile_.s.begin())];
    double after = before + smoothing_s_, time = before;
    for (int i = 0; i < kNewtonSteps; ++i) {
      const Progress now = smooth(time);
      (now.s < knot ? before : after) = time;
      time += (knot - now.s) / now.speed;
      if (!(time > before && time < after)) time = 0.5 * (before + after);
    }
    times.push_back(time);
  }
  std::sort(times.begin(), times.end());
  const auto same = [end](double a, double b) { return b - a < 1e-12 * end; };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  return times;
}

/// Over each piece of time, what has a limit is bounded as over an interval of s, by the Bernstein
/// coefficients of a quadratic.
bool PathTiming::slow_down(const TimingLimits& limits, const TimingRowsAt& rows) {
  constexpr double kHigherOrders = 1.0 + 1e-4;  // of what is no quadratic; see the tests
  struct Look {
    Eigen::ArrayXd velocity, acceleration, rows, most;
  };
  const auto look = [&](double time) {
    PathPoint point;
    const Progress now = smooth(time);
    path_.at(now.s, point);
    const double x = now.speed * now.speed;
    Look result;
    result.velocity = now.speed * point.first;
    result.acceleration = now.acceleration * point.first + x * point.second;
    if (rows) {
      const TimingRows found = rows(point);
      result.rows = found.a * now.acceleration + found.b * x;
      result.most = found.c;
    }
    return result;
  };
  Excess excess;
  const auto add = [&](const Look& seen) {
    excess.add((seen.acceleration.abs() / limits.acceleration.array()).maxCoeff());
    excess.add((seen.velocity / limits.velocity.array()).square().maxCoeff());
    if (path_.robot().floating_base()) {
      const double linear = seen.velocity.head<3>().matrix().norm() / limits.base_linear_m_s;
      const double angular =
          seen.velocity.segment<3>(3).matrix().norm() / limits.base_angular_rad_s;
      excess.add(std::max(linear * linear, angular * angular));
    }
    for (Eigen::Index k = 0; k < seen.rows.size(); ++k) excess.add_row(seen.rows[k], seen.most[k]);
  };
  const std::vector<double> times = smooth_pieces();
  Look start = look(times.front());
  add(start);
  for (std::size_t i = 1; i < times.size(); ++i) {
    Look between = look(0.5 * (times[i - 1] + times[i])), end = look(times[i]);
    for (Eigen::ArrayXd Look::*part :
         {&Look::velocity, &Look::acceleration, &Look::rows, &Look::most}) {
      between.*part = 2.0 * (between.*part) - 0.5 * (start.*part + end.*part);
    }
    add(between);
    add(end);
    start = std::move(end);
  }
  const double slower = std::max(1.0, kHigherOrders * excess.least);
  slower_ = std::sqrt(slower);
  return slower <= excess.most;
}

double PathTiming::duration_s() const {
  if (!answer_.success()) throw Error("a path that is not timed: " + answer_.reason, "success");
  return slower_ * (time_s_.back() + smoothing_s_);
}

TimedPoint PathTiming::at(double time_s) const {
  time_s = std::clamp(time_s, 0.0, duration_s());
  const Progress now = smooth(time_s / slower_);
  PathPoint point;
  path_.at(now.s, point);
  const double speed = now.speed / slower_;
  return {point.configuration, speed * point.first,
          now.acceleration / (slower_ * slower_) * point.first + speed * speed * point.second,
          now.s, speed};
}

TimedPath PathTiming::sampled(double step_s) const {
  if (!(step_s > 0.0)) throw Error("a step of " + std::to_string(step_s) + " s", "more than 0");
  TimedPath result;
  result.duration_s = duration_s();
  const int steps = std::max(1, static_cast<int>(std::ceil(result.duration_s / step_s)));
  for (int i = 0; i <= steps; ++i) {
    const double time_s = result.duration_s * i / steps;
    TimedPoint point = at(time_s);
    result.time_s.push_back(time_s);
    result.configurations.push_back(std::move(point.configuration));
    result.velocities.push_back(std::move(point.velocity));
    result.accelerations.push_back(std::move(point.acceleration));
  }
  return result;
}

}  // namespace locograph
