#include <locograph/common/check_option.h>
#include <locograph/planners/offline/timing/speed_polygon.h>
#include <locograph/planners/offline/timing/speed_profile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace locograph {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kMostTurnPerInterval_rad = 0.02;  // rotations are no quadratics

std::string coordinate_name(const Robot& robot, int k) {
  const int base = robot.base_tangent_size();
  if (k >= base) return "joint " + robot.active_joint(k - base).name;
  return "coordinate " + std::to_string(k) + " of the base";
}

void check_positive(double limit, const std::string& what) {
  if (limit > 0.0) return;
  throw Error("a limit of " + std::to_string(limit) + " for the " + what, "more than 0");
}

/// A quadratic over an interval: its Bernstein coefficient in the middle.
template <class Value>
Value middle(const Value& start, const Value& half_way, const Value& end) {
  return 2.0 * half_way - 0.5 * (start + end);
}

class Grid {
 public:
  Grid(const PathSpline& path, const TimingLimits& limits, const GridSize& size,
       const TimingRowsAt& rows, const Termination& termination)
      : limits_(limits), termination_(termination) {
    place(path, size);
    complete_ = look(path, rows);
    if (complete_) cap();
  }

  FastestProfile fastest() const {
    if (!complete_) return {end_by(termination_).value()};
    const std::size_t n = s_.size() - 1;
    FastestProfile result;
    int& done = result.statistics.iterations;
    std::vector<SpeedPolygon> polygons;
    polygons.reserve(n);
    std::pair<double, double> reached{0.0, 0.0};
    for (std::size_t i = n; i-- > 0; ++done) {
      if (const auto end = end_by(termination_, done)) return {*end, {}, result.statistics};
      SpeedPolygon polygon(0.0, i == 0 ? 0.0 : cap_[i], reached.first, reached.second);
      clip(polygon, i);
      if (polygon.empty()) return {no_motion_at(i), {}, result.statistics};
      reached = polygon.here();
      polygons.push_back(std::move(polygon));
    }
    SpeedProfile profile{s_, {0.0}};
    for (std::size_t i = 0; i < n; ++i) {
      const double next = polygons[n - 1 - i].most_next(profile.squared.back());
      if (i + 1 < n && !(next > 0.0)) return {no_motion_at(i), {}, result.statistics};
      profile.squared.push_back(i + 1 < n ? next : 0.0);
    }
    result.status = PlannerStatus::kSolved;
    result.reason = "timed";
    result.profile = std::move(profile);
    return result;
  }

 private:
  PlannerAnswer no_motion_at(std::size_t interval) const {
    return {PlannerStatus::kInfeasible,
            "rows leave no motion from rest to rest at s = " + std::to_string(s_[interval]) +
                " of " + std::to_string(s_.back()) + " (loosen them, or change the path there)"};
  }

  void place(const PathSpline& path, const GridSize& size) {
    const std::vector<double>& knots = path.knots();
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const double h = knots[i + 1] - knots[i];
      const auto turned = static_cast<int>(std::ceil(path.turn_rad(i) / kMostTurnPerInterval_rad));
      const auto share = static_cast<int>(std::ceil(size.intervals * (h / path.length())));
      const int parts = std::max({size.intervals_per_step, turned, share});
      for (int k = 0; k < parts; ++k) s_.push_back(knots[i] + h * k / parts);
    }
    s_.push_back(path.length());
  }

  /// Columns 2 i are grid points, those in between half-way. False: ended before.
  bool look(const PathSpline& path, const TimingRowsAt& rows) {
    const Eigen::Index columns = 2 * static_cast<Eigen::Index>(s_.size()) - 1;
    first_.resize(path.robot().tangent_size(), columns);
    second_.resize(path.robot().tangent_size(), columns);
    PathPoint point;
    for (Eigen::Index i = 0; i < columns; ++i) {
      if (termination_.ended()) return false;
      const auto grid = static_cast<std::size_t>(i / 2);
      path.at(i % 2 == 0 ? s_[grid] : 0.5 * (s_[grid] + s_[grid + 1]), point);
      first_.col(i) = point.first;
      second_.col(i) = point.second;
      if (!rows) continue;
      const TimingRows found = rows(point);
      if (i == 0) {
        for (Eigen::MatrixXd* matrix : {&a_, &b_, &c_}) matrix->resize(found.a.size(), columns);
      }
      if (found.a.size() != a_.rows() || found.b.size() != a_.rows() ||
          found.c.size() != a_.rows()) {
        throw Error("rows of timing of another number at s = " + std::to_string(point.s),
                    std::to_string(a_.rows()));
      }
      if (!found.a.allFinite() || !found.b.allFinite() || found.c.hasNaN()) {
        throw Error("rows of timing that are not finite at s = " + std::to_string(point.s),
                    "numbers");
      }
      a_.col(i) = found.a;
      b_.col(i) = found.b;
      c_.col(i) = found.c;
    }
    return true;
  }

  /// Limits of velocity, as those of x at grid points: x is linear between two of them, q' within
  /// its Bernstein coefficients. Where there is none, from rest to rest: d(v^2 / 2)/ds = q' dv/dt,
  /// so v^2 is at most the acceleration times the whole way of the coordinate.
  void cap() {
    const std::size_t n = s_.size() - 1;
    Eigen::MatrixXd most(first_.rows(), static_cast<Eigen::Index>(n));
    Eigen::VectorXd way = Eigen::VectorXd::Zero(first_.rows());
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      most.col(k) = most_over(i, 0, first_.rows());
      way += (s_[i + 1] - s_[i]) * most.col(k);
    }
    Eigen::VectorXd squared = limits_.velocity.cwiseAbs2();
    for (Eigen::Index k = 0; k < squared.size(); ++k) {
      if (way[k] > 0.0) squared[k] = std::min(squared[k], limits_.acceleration[k] * way[k]);
    }
    cap_.assign(n + 1, kNoLimit);
    for (std::size_t i = 0; i < n; ++i) {
      double cap = kNoLimit;
      for (Eigen::Index k = 0; k < squared.size(); ++k) {
        const double rate = most(k, static_cast<Eigen::Index>(i));
        if (rate > 0.0) cap = std::min(cap, squared[k] / (rate * rate));
      }
      for (const auto& [limit, row] :
           {std::pair(limits_.base_linear_m_s, 0), std::pair(limits_.base_angular_rad_s, 3)}) {
        if (!std::isfinite(limit)) continue;
        const double rate = norm_over(i, row);
        if (rate > 0.0) cap = std::min(cap, limit * limit / (rate * rate));
      }
      if (!std::isfinite(cap)) {
        throw Error("nothing limits what moves at s = " + std::to_string(s_[i]),
                    "a velocity or acceleration limit");
      }
      cap_[i] = std::min(cap_[i], cap);
      cap_[i + 1] = std::min(cap_[i + 1], cap);
    }
    for (std::size_t i = 0; limits_.path_speed && i <= n; ++i) {
      const double most = limits_.path_speed(s_[i]);
      cap_[i] = std::min(cap_[i], most * most);
    }
  }

  Eigen::VectorXd most_over(std::size_t interval, Eigen::Index row, Eigen::Index rows) const {
    const auto at = [&](Eigen::Index half) {
      return Eigen::VectorXd(
          first_.col(2 * static_cast<Eigen::Index>(interval) + half).segment(row, rows));
    };
    const Eigen::VectorXd start = at(0), end = at(2);
    const Eigen::VectorXd between = middle<Eigen::VectorXd>(start, at(1), end);
    return start.cwiseAbs().cwiseMax(end.cwiseAbs()).cwiseMax(between.cwiseAbs());
  }

  double norm_over(std::size_t interval, Eigen::Index row) const {
    const auto at = [&](Eigen::Index half) {
      return Eigen::Vector3d(
          first_.col(2 * static_cast<Eigen::Index>(interval) + half).segment<3>(row));
    };
    const Eigen::Vector3d start = at(0), end = at(2);
    return std::max({start.norm(), end.norm(), middle<Eigen::Vector3d>(start, at(1), end).norm()});
  }

  /// Limits of acceleration and rows, over a whole interval.
  void clip(SpeedPolygon& polygon, std::size_t interval) const {
    const double per_u = 0.5 / (s_[interval + 1] - s_[interval]);
    const auto i = 2 * static_cast<Eigen::Index>(interval);
    for (Eigen::Index k = 0; k < first_.rows(); ++k) {
      const double limit = limits_.acceleration[k];
      if (!std::isfinite(limit)) continue;
      for (const auto& [p, q] : coefficients(first_, second_, k, i, per_u)) {
        polygon.clip(p, q, limit);
        polygon.clip(-p, -q, limit);
      }
    }
    for (Eigen::Index k = 0; k < a_.rows(); ++k) {
      const std::array<double, 3> most = {c_(k, i), middle(c_(k, i), c_(k, i + 1), c_(k, i + 2)),
                                          c_(k, i + 2)};
      const auto rows = coefficients(a_, b_, k, i, per_u);
      for (std::size_t j = 0; j < 3; ++j) {
        if (most[j] < kNoLimit) polygon.clip(rows[j].first, rows[j].second, most[j]);
      }
    }
  }

  /// Bernstein coefficients of a u + b x, as factors of x at the ends of the interval.
  static std::array<std::pair<double, double>, 3> coefficients(const Eigen::MatrixXd& a,
                                                               const Eigen::MatrixXd& b,
                                                               Eigen::Index row, Eigen::Index i,
                                                               double per_u) {
    std::array<std::pair<double, double>, 3> result;
    for (const int half : {0, 1, 2}) {
      const double by_u = a(row, i + half) * per_u, by_x = b(row, i + half);
      result[static_cast<std::size_t>(half)] = {by_x * (1.0 - 0.5 * half) - by_u,
                                                by_x * 0.5 * half + by_u};
    }
    result[1] = {middle(result[0].first, result[1].first, result[2].first),
                 middle(result[0].second, result[1].second, result[2].second)};
    return result;
  }

  const TimingLimits& limits_;
  const Termination& termination_;
  bool complete_ = false;
  std::vector<double> s_, cap_;  // cap_: of x
  Eigen::MatrixXd first_, second_, a_, b_, c_;
};

}  // namespace

void check_limits(const Robot& robot, const TimingLimits& limits) {
  for (const Eigen::VectorXd* part : {&limits.velocity, &limits.acceleration}) {
    const std::string what = part == &limits.velocity ? "velocity" : "acceleration";
    if (part->size() != robot.tangent_size()) {
      throw Error(std::to_string(part->size()) + " limits of " + what,
                  std::to_string(robot.tangent_size()));
    }
    for (int k = 0; k < robot.tangent_size(); ++k) {
      check_positive((*part)[k], what + " of " + coordinate_name(robot, k));
    }
  }
  check_positive(limits.base_linear_m_s, "speed of the base");
  check_positive(limits.base_angular_rad_s, "turning of the base");
}

TimingLimits timing_limits(const Robot& robot, const CheckOptions& limits) {
  const auto or_none = [](double limit) { return limit > 0.0 ? limit : kNoLimit; };
  TimingLimits result;
  result.velocity.setConstant(robot.tangent_size(), kNoLimit);
  result.acceleration = result.velocity;
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const int k = robot.base_tangent_size() + i;
    result.velocity[k] = robot.active_joint(i).max_velocity;
    result.acceleration[k] = or_none(limits.joint_acceleration_rad_s2);
  }
  result.base_linear_m_s = or_none(limits.base_linear_m_s);
  result.base_angular_rad_s = or_none(limits.base_angular_rad_s);
  return result;
}

void GridSize::validate() const {
  check_option(intervals >= 1, "intervals", "1 or more");
  check_option(intervals_per_step >= 1, "intervals_per_step", "1 or more");
}

FastestProfile fastest_profile(const PathSpline& path, const TimingLimits& limits,
                               const GridSize& size, const TimingRowsAt& rows,
                               const Termination& termination) {
  const Stopwatch watch;
  check_limits(path.robot(), limits);
  size.validate();
  termination.validate();
  FastestProfile result = Grid(path, limits, size, rows, termination).fastest();
  result.statistics.total_s = watch.seconds();
  return result;
}

}  // namespace locograph
