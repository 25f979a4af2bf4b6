#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/planners/balance/reach_programme.h>
#include <locograph/planners/offline/timing/balance_rows.h>
#include <locograph/planners/offline/timing/speed_polygon.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// Pyramids of 8 edges on the cone, this much smaller, are inside the judge's of 16 sides.
constexpr double kOfPyramids = 0.02;
/// What every row leaves, in parts of the weight: no path is stopped by numbers.
constexpr double kLeastRoom = 1e-3;
/// Further outside, a posture is not balanced at rest either.
constexpr double kOutside = -1e-2;
/// More than anything has where accelerations have no limit [m/s^2, rad/s^2].
constexpr double kMostAcceleration = 1000.0;
constexpr int kMostProgrammesAtAPoint = 60;

/// What contacts can give: one ray a column.
struct Rays {
  Eigen::Matrix<double, 6, Eigen::Dynamic> wrenches;    ///< world, about the origin of the rows
  Eigen::Matrix<double, 6, Eigen::Dynamic> at_contact;  ///< the same about the contact's position
  std::vector<int> contact;
  std::vector<double> lower, upper;
  std::vector<double> least;  ///< by contact: sum of its rays; 0: none
  std::vector<double> most;   ///< likewise; negative: none

  Rays(std::span<const BearingContact> bearing, const Eigen::Vector3d& origin, double weight_N) {
    std::vector<BearingRay> rays;
    for (const BearingContact& one : bearing) {
      const auto number = static_cast<int>(most.size());
      for (const BearingRay& ray : bearing_rays(one, kOfPyramids, weight_N)) {
        rays.push_back(ray);
        contact.push_back(number);
        lower.push_back(ray.lower);
        upper.push_back(ray.upper);
      }
      least.push_back(least_of_rays(one, weight_N));
      most.push_back(most_of_rays(one.contact, kOfPyramids, weight_N));
    }
    wrenches.resize(6, static_cast<Eigen::Index>(rays.size()));
    at_contact.resize(6, wrenches.cols());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const BearingRay& ray = rays[i];
      const Eigen::Vector3d& position =
          bearing[static_cast<std::size_t>(contact[i])].contact.position;
      const auto k = static_cast<Eigen::Index>(i);
      wrenches.col(k) << ray.force, (ray.at - origin).cross(ray.force) + ray.moment;
      at_contact.col(k) << ray.force, (ray.at - position).cross(ray.force) + ray.moment;
    }
  }

  /// The most that y . (what forces do) can be; pull: y . column of each ray.
  double most_along(const Eigen::VectorXd& pull) const {
    double result = 0.0;
    std::vector<double> best(most.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < contact.size(); ++i) {
      const double value = pull[static_cast<Eigen::Index>(i)];
      const auto c = static_cast<std::size_t>(contact[i]);
      if (most[c] < 0.0) {
        result += std::max(value * lower[i], value * upper[i]);
      } else {
        best[c] = std::max(best[c], value);
      }
    }
    for (std::size_t c = 0; c < most.size(); ++c) {
      if (best[c] > 1e-9) result += most[c] * best[c];
      if (best[c] < 0.0 && least[c] > 0.0) result += least[c] * best[c];
    }
    return result;
  }

  /// Each contact pressed a little, or as much as it has to be, no torques of friction.
  Eigen::VectorXd gentle() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(wrenches.cols());
    for (std::size_t i = 0; i < contact.size(); ++i) {
      const auto c = static_cast<std::size_t>(contact[i]);
      if (most[c] < 0.0) continue;
      const auto many = std::count(contact.begin(), contact.end(), contact[i]);
      result[static_cast<Eigen::Index>(i)] =
          std::max(least[c], 0.5 * std::min(1.0, most[c])) / static_cast<double>(many);
    }
    return result;
  }
};

/// What a point of a path asks of the contacts, g + a u + b x: the base's wrench in parts of the
/// weight, then torques in parts of their limits.
struct Asked {
  double s = 0.0;
  Eigen::VectorXd g, a, b;
  Eigen::MatrixXd torques;                   ///< of each ray, where they are limited
  std::vector<BearingContact> bearing = {};  ///< where balls are, if any roll
  std::shared_ptr<const Rays> rays = {};
};

}  // namespace

class BalanceRows::Work {
 public:
  Work(const Robot& robot, std::span<const BearingContact> contacts,
       const BalanceRowsOptions& options)
      : robot_(robot),
        options_(options),
        bearing_(those_that_bear(contacts)),
        weight_N_(robot.total_mass() * standard_gravity().norm()),
        origin_(middle_of(bearing_)),
        rays_(std::make_shared<const Rays>(bearing_, origin_, weight_N_)),
        rolls_(std::ranges::any_of(bearing_,
                                   [](const auto& one) { return is_ball(one.contact.effector); })),
        state_(robot),
        dynamics_(robot) {
    for (int i = 0; options.effort_scale > 0.0 && i < robot.active_joint_count(); ++i) {
      const double effort = options.effort_scale * robot.active_joint(i).max_effort;
      if (!(effort > 0.0) || !std::isfinite(effort)) continue;
      joints_.push_back(i);
      efforts_.push_back(effort);
    }
  }

  TimingRowsAt along(const PathSpline& path, const TimingLimits& limits) {
    // Rows only make a motion slower, so that its speeds are bounds.
    const FastestProfile fastest = fastest_profile(path, limits, {1, 4});
    if (!fastest.success()) return {};
    if (!joints_.empty()) halfspaces_.clear();  // not tight on another path
    std::vector<double> places = places_on(path);
    std::vector<Asked> asked;
    PathPoint point;
    int looks = 0;
    for (const double s : places) {
      path.at(s, point);
      asked.push_back(ask(point));
      if (s < path.length() * looks / options_.looks) continue;
      ++looks;
      SpeedPolygon allowed = allowed_by(limits, point, fastest.profile);
      find_halfspaces(asked.back(), allowed);
    }
    return interpolated(asked);
  }

 private:
  static std::vector<BearingContact> those_that_bear(std::span<const BearingContact> contacts) {
    std::vector<BearingContact> result;
    for (const BearingContact& one : contacts) {
      if (one.contact.bears_load) result.push_back(one);
    }
    return result;
  }

  static Eigen::Vector3d middle_of(const std::vector<BearingContact>& bearing) {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (const BearingContact& one : bearing) {
      result += one.contact.position / static_cast<double>(bearing.size());
    }
    return result;
  }

  /// Ends and middles of pieces, of which none has a knot inside.
  std::vector<double> places_on(const PathSpline& path) const {
    std::vector<double> result = {0.0};
    for (std::size_t i = 1; i < path.knots().size(); ++i) {
      const double from = path.knots()[i - 1], h = path.knots()[i] - from;
      const double share = options_.pieces * h / path.length();
      const int parts = 2 * std::max(1, static_cast<int>(std::ceil(share)));
      for (int k = 1; k < parts; ++k) result.push_back(from + h * k / parts);
      result.push_back(path.knots()[i]);
    }
    return result;
  }

  Asked ask(const PathPoint& point) {
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot_.tangent_size());
    state_.update(point.configuration.data());
    Asked result;
    result.s = point.s;
    result.rays = rays_;
    if (rolls_) {
      result.bearing = rolled_to(state_, bearing_);
      result.rays = std::make_shared<const Rays>(result.bearing, origin_, weight_N_);
    }
    result.g = needed(point, still, still);
    result.a = needed(point, still, point.first) - result.g;
    result.b = needed(point, point.first, point.second) - result.g;
    if (!joints_.empty()) add_torques(result);
    return result;
  }

  Eigen::VectorXd needed(const PathPoint& point, const Eigen::VectorXd& velocity,
                         const Eigen::VectorXd& acceleration) {
    Eigen::VectorXd torques(robot_.tangent_size());
    dynamics_.inverse_dynamics(state_, velocity, acceleration, {}, torques);
    const Eigen::VectorXd& q = point.configuration;
    const Eigen::Matrix3d axes = Eigen::Quaterniond(q[6], q[3], q[4], q[5]).toRotationMatrix();
    const Eigen::Vector3d force = axes * torques.head<3>();
    Eigen::VectorXd result(6 + static_cast<Eigen::Index>(joints_.size()));
    result.head<3>() = force / weight_N_;
    result.segment<3>(3) =
        (axes * torques.segment<3>(3) + (q.head<3>() - origin_).cross(force)) / weight_N_;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      result[6 + static_cast<Eigen::Index>(j)] =
          torques[robot_.base_tangent_size() + joints_[j]] / efforts_[j];
    }
    return result;
  }

  void add_torques(Asked& asked) const {
    const auto joints = static_cast<Eigen::Index>(joints_.size());
    const Rays& rays = *asked.rays;
    const std::vector<BearingContact>& bearing = rolls_ ? asked.bearing : bearing_;
    asked.torques.resize(joints, rays.wrenches.cols());
    Eigen::VectorXd torques(robot_.tangent_size());
    Eigen::MatrixXd of_contact(joints, 6);
    for (std::size_t c = 0; c < bearing.size(); ++c) {
      const Contact& contact = bearing[c].contact;
      PointWrench wrench;
      wrench.link = robot_.link_index(contact.effector.link);
      wrench.point = state_.world_from_link(wrench.link).inverse() * contact.position;
      for (Eigen::Index i = 0; i < 6; ++i) {
        torques.setZero();
        wrench.force = i < 3 ? Eigen::Vector3d(weight_N_ * Eigen::Vector3d::Unit(i))
                             : Eigen::Vector3d::Zero().eval();
        wrench.moment = i < 3 ? Eigen::Vector3d::Zero().eval()
                              : Eigen::Vector3d(weight_N_ * Eigen::Vector3d::Unit(i - 3));
        add_wrench_torques(state_, wrench, 1.0, torques);
        for (std::size_t j = 0; j < joints_.size(); ++j) {
          of_contact(static_cast<Eigen::Index>(j), i) =
              torques[robot_.base_tangent_size() + joints_[j]] / efforts_[j];
        }
      }
      for (std::size_t i = 0; i < rays.contact.size(); ++i) {
        if (rays.contact[i] != static_cast<int>(c)) continue;
        const auto k = static_cast<Eigen::Index>(i);
        asked.torques.col(k) = of_contact * rays.at_contact.col(k);
      }
    }
  }

  /// Here u, next x: what limits leave at a point.
  static SpeedPolygon allowed_by(const TimingLimits& limits, const PathPoint& point,
                                 const SpeedProfile& fastest) {
    const auto after = std::upper_bound(fastest.s.begin() + 1, fastest.s.end() - 1, point.s);
    const auto i = static_cast<std::size_t>(after - fastest.s.begin()) - 1;
    const double most_x = std::max(fastest.squared[i], fastest.squared[i + 1]);
    const double most_u = kMostAcceleration / point.first.cwiseAbs().maxCoeff();
    SpeedPolygon polygon(-most_u, most_u, 0.0, most_x);
    for (Eigen::Index k = 0; k < point.first.size(); ++k) {
      if (!std::isfinite(limits.acceleration[k])) continue;
      polygon.clip(point.first[k], point.second[k], limits.acceleration[k]);
      polygon.clip(-point.first[k], -point.second[k], limits.acceleration[k]);
    }
    return polygon;
  }

  struct Row {
    double a, b, c;
  };

  Row row(const Asked& asked, const Eigen::VectorXd& y) const {
    const auto joints = static_cast<Eigen::Index>(joints_.size());
    Eigen::VectorXd pull = asked.rays->wrenches.transpose() * y.head<6>();
    if (joints > 0) pull += asked.torques.transpose() * y.tail(joints);
    const double all = asked.rays->most_along(pull) + y.tail(joints).lpNorm<1>() - y.dot(asked.g);
    const double c = all < kOutside ? all : std::max((1.0 - options_.margin) * all, kLeastRoom);
    return {y.dot(asked.a), y.dot(asked.b), c};
  }

  /// Until contacts can give what the corners ask for.
  void find_halfspaces(const Asked& asked, SpeedPolygon& polygon) {
    for (const Eigen::VectorXd& y : halfspaces_) {
      const Row known = row(asked, y);
      polygon.clip(known.a, known.b, known.c);
    }
    if (!programme_ || !joints_.empty() || rolls_) load(asked);
    std::vector<SpeedPolygon::Corner> reached;
    const auto is_reached = [&](const SpeedPolygon::Corner& corner) {
      return std::ranges::any_of(reached, [&](const SpeedPolygon::Corner& other) {
        return corner.here == other.here && corner.next == other.next;
      });
    };
    for (int i = 0; i < kMostProgrammesAtAPoint; ++i) {
      const auto corner = std::ranges::find_if_not(polygon.corners(), is_reached);
      if (corner == polygon.corners().end()) return;
      const Eigen::VectorXd target = asked.g + corner->here * asked.a + corner->next * asked.b;
      reached.push_back(*corner);
      const std::optional<Eigen::VectorXd> y = programme_->halfspace_before(target);
      if (!y) continue;
      halfspaces_.push_back(*y);
      const Row found = row(asked, *y);
      polygon.clip(found.a, found.b, found.c);
    }
  }

  void load(const Asked& asked) {
    const auto joints = static_cast<Eigen::Index>(joints_.size());
    const Rays& rays = *asked.rays;
    Eigen::MatrixXd columns(6 + joints, rays.wrenches.cols());
    columns.topRows<6>() = rays.wrenches;
    if (joints > 0) columns.bottomRows(joints) = asked.torques;
    Eigen::VectorXd within = Eigen::VectorXd::Zero(6 + joints);
    within.tail(joints).setOnes();
    programme_ = std::make_unique<ReachProgramme>(
        columns, within, rays.gentle(),
        ReachProgramme::Bounds{rays.contact, rays.lower, rays.upper, rays.least, rays.most});
  }

  TimingRowsAt interpolated(const std::vector<Asked>& asked) const {
    struct Table {
      std::vector<double> s;
      Eigen::MatrixXd a, b, c;  ///< a column for each place
    };
    const auto table = std::make_shared<Table>();
    const auto count = static_cast<Eigen::Index>(halfspaces_.size());
    for (Eigen::MatrixXd* part : {&table->a, &table->b, &table->c}) {
      part->resize(count, static_cast<Eigen::Index>(asked.size()));
    }
    for (std::size_t i = 0; i < asked.size(); ++i) {
      table->s.push_back(asked[i].s);
      for (Eigen::Index k = 0; k < count; ++k) {
        const Row found = row(asked[i], halfspaces_[static_cast<std::size_t>(k)]);
        const auto column = static_cast<Eigen::Index>(i);
        table->a(k, column) = found.a;
        table->b(k, column) = found.b;
        table->c(k, column) = found.c;
      }
    }
    return [table](const PathPoint& point) {
      const std::vector<double>& s = table->s;
      const auto after = std::upper_bound(s.begin() + 1, s.end() - 1, point.s);
      const Eigen::Index i = (after - s.begin() - 1) / 2 * 2;
      const auto k = static_cast<std::size_t>(i);
      const double t = (point.s - s[k]) / (s[k + 2] - s[k]);
      const Eigen::Vector3d weights((1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t),
                                    t * (2.0 * t - 1.0));
      return TimingRows{table->a.middleCols<3>(i) * weights, table->b.middleCols<3>(i) * weights,
                        table->c.middleCols<3>(i) * weights};
    };
  }

  const Robot& robot_;
  BalanceRowsOptions options_;
  std::vector<BearingContact> bearing_;
  double weight_N_;
  Eigen::Vector3d origin_;
  std::shared_ptr<const Rays> rays_;  ///< with balls as they touched down
  bool rolls_;                        ///< there are some
  std::vector<int> joints_;           // whose torques are limited
  std::vector<double> efforts_;
  RobotState state_;
  RobotDynamics dynamics_;
  std::unique_ptr<ReachProgramme> programme_;
  std::vector<Eigen::VectorXd> halfspaces_;  // y of length 1
};

void BalanceRowsOptions::validate() const {
  check_option(margin >= 0.0 && margin < 1.0, "margin", "a part in [0, 1)");
  check_option(effort_scale >= 0.0, "effort_scale", "0 or more");
  check_option(pieces >= 1, "pieces", "1 or more");
  check_option(looks >= 1, "looks", "1 or more");
}

BalanceRows::BalanceRows(const Robot& robot, std::span<const BearingContact> contacts,
                         const BalanceRowsOptions& options) {
  if (!robot.floating_base()) throw Error("balance of a fixed base", "a floating base");
  options.validate();
  if (std::ranges::none_of(contacts, [](const auto& one) { return one.contact.bears_load; })) {
    throw Error("balance without a contact that bears", "one at least");
  }
  work_ = std::make_unique<Work>(robot, contacts, options);
}

BalanceRows::~BalanceRows() = default;
BalanceRows::BalanceRows(BalanceRows&&) noexcept = default;

TimingRowsAt BalanceRows::along(const PathSpline& path, const TimingLimits& limits) {
  return work_->along(path, limits);
}

}  // namespace locograph
