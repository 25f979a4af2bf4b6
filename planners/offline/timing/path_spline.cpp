#include <locograph/common/error.h>
#include <locograph/planners/offline/timing/path_spline.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace locograph {
namespace {

/// Far more than corners need that come within a deviation of any use.
constexpr int kDeviationRounds = 40;
/// Of the base's rotation, at any rate: it keeps the splines of quaternions away from 0.
constexpr double kMostTurn = 1.0;
constexpr double kMostStepRatio = 4.0;

std::string waypoint(std::size_t number) { return "waypoint " + std::to_string(number); }

void check_waypoint(const Robot& robot, const Eigen::VectorXd& q, std::size_t number) {
  if (q.size() != robot.configuration_size()) {
    throw Error(waypoint(number) + " has " + std::to_string(q.size()) + " numbers",
                std::to_string(robot.configuration_size()));
  }
  if (!q.allFinite()) throw Error(waypoint(number) + " is not finite", "finite numbers");
  if (robot.floating_base() && q.segment<4>(3).norm() < 1e-3) {
    throw Error(waypoint(number) + " has no orientation", "a quaternion of norm 1");
  }
}

/// From a point to the segment from 0 to `chord`.
double distance_to_chord(const Eigen::VectorXd& point, const Eigen::VectorXd& chord) {
  const double squared = chord.squaredNorm();
  const double share = squared > 0.0 ? std::clamp(point.dot(chord) / squared, 0.0, 1.0) : 0.0;
  return (point - share * chord).norm();
}

/// vec(a* b) of quaternions x y z w.
Eigen::Vector3d turn(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return a[3] * b.head<3>() - b[3] * a.head<3>() - a.head<3>().cross(b.head<3>());
}

}  // namespace

PathSpline::PathSpline(const Robot& robot, std::vector<Eigen::VectorXd> waypoints,
                       Eigen::VectorXd scale, double max_deviation)
    : robot_(&robot), scale_(std::move(scale)), waypoints_(std::move(waypoints)) {
  if (waypoints_.size() < 2) {
    throw Error("a path of " + std::to_string(waypoints_.size()) + " waypoints", "two or more");
  }
  if (!(max_deviation > 0.0)) {
    throw Error("a deviation of " + std::to_string(max_deviation), "more than 0");
  }
  if (scale_.size() != robot.tangent_size() || !scale_.allFinite() ||
      !(scale_.array() > 0.0).all()) {
    throw Error("a scale of the path that is not above 0 everywhere",
                std::to_string(robot.tangent_size()) + " numbers above 0");
  }
  for (std::size_t i = 0; i < waypoints_.size(); ++i) {
    Eigen::VectorXd& q = waypoints_[i];
    check_waypoint(robot, q, i);
    if (robot.floating_base()) q.segment<4>(3).normalize();
  }
  place_knots();
  solve();
  for (int round = 0; round < kDeviationRounds && add_waypoints(max_deviation); ++round) {
    place_knots();
    solve();
  }
}

void PathSpline::place_knots() {
  knots_.assign(1, 0.0);
  Eigen::VectorXd step(robot_->tangent_size());
  for (std::size_t i = 1; i < waypoints_.size(); ++i) {
    Eigen::VectorXd& q = waypoints_[i];
    const Eigen::VectorXd& before = waypoints_[i - 1];
    if (robot_->floating_base() && q.segment<4>(3).dot(before.segment<4>(3)) < 0.0) {
      q.segment<4>(3) *= -1.0;
    }
    robot_->difference(before.data(), q.data(), step.data());
    if (!(step.cwiseAbs().maxCoeff() > 1e-12)) {
      throw Error("waypoints " + std::to_string(i - 1) + " and " + std::to_string(i) + " are equal",
                  "a way between them");
    }
    knots_.push_back(knots_.back() + step.cwiseQuotient(scale_).norm());
  }
}

/// With h the steps of s and d the slopes of the chords, second derivatives m of a cubic spline
/// solve h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (d[i] - d[i-1]). The third
/// derivative does not jump at the second waypoint, m[0] = m[1] + r (m[1] - m[2]) with r = h[0] /
/// h[1], which takes m[0] out of the first row, nor at the last but one. A long step beside a short
/// one would swing out, so r is bounded.
void PathSpline::solve() {
  const std::size_t n = waypoints_.size();
  bends_.assign(n, Eigen::VectorXd::Zero(robot_->configuration_size()));
  if (n == 2) return;
  std::vector<double> above(n, 0.0);
  const auto step = [&](std::size_t i) { return knots_[i + 1] - knots_[i]; };
  const auto slope = [&](std::size_t i) { return (waypoints_[i + 1] - waypoints_[i]) / step(i); };
  const auto ratio = [](double h, double other) { return std::min(h / other, kMostStepRatio); };
  if (n == 3) {
    bends_.assign(n, 2.0 / knots_.back() * (slope(1) - slope(0)));
    return;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h = step(i - 1), next = step(i);
    double before = h, here = 2.0 * (h + next), after = next;
    if (i == 1) {
      here += h * (1.0 + ratio(h, next));
      after -= h * ratio(h, next);
    }
    if (i + 2 == n) {
      here += next * (1.0 + ratio(next, h));
      before -= next * ratio(next, h);
    }
    const double pivot = here - (i > 1 ? before * above[i - 1] : 0.0);
    above[i] = after / pivot;
    bends_[i] = 6.0 * (slope(i) - slope(i - 1));
    if (i > 1) bends_[i] -= before * bends_[i - 1];
    bends_[i] /= pivot;
  }
  for (std::size_t i = n - 2; i-- > 1;) bends_[i] -= above[i] * bends_[i + 1];
  const auto beyond = [&](std::size_t i, std::size_t other, double r) {
    return Eigen::VectorXd(bends_[i] + r * (bends_[i] - bends_[other]));
  };
  bends_[0] = beyond(1, 2, ratio(step(0), step(1)));
  bends_[n - 1] = beyond(n - 2, n - 3, ratio(step(n - 2), step(n - 3)));
}

/// A cubic is a mean of its four control points in which the inner two weigh 3/4 at most, and the
/// distance to a chord is convex. A rotation turns by less than three times the distance of
/// quaternions whose norm is 0.7 or more, as it is on chords of half a turn.
bool PathSpline::deviates(std::size_t segment, double most) const {
  const double h = knots_[segment + 1] - knots_[segment];
  const Eigen::VectorXd chord = waypoints_[segment + 1] - waypoints_[segment];
  const Eigen::VectorXd& from = bends_[segment];
  const Eigen::VectorXd& to = bends_[segment + 1];
  most *= 4.0 / 3.0;
  for (const Eigen::VectorXd& inner :
       {Eigen::VectorXd(chord / 3.0 - h * h / 18.0 * (2.0 * from + to)),
        Eigen::VectorXd(chord * 2.0 / 3.0 - h * h / 18.0 * (from + 2.0 * to))}) {
    Eigen::Index k = 0;
    if (robot_->floating_base()) {
      if (distance_to_chord(inner.head<3>(), chord.head<3>()) > most) return true;
      const double turn = 3.0 * distance_to_chord(inner.segment<4>(3), chord.segment<4>(3));
      if (turn > std::min(most, 4.0 / 3.0 * kMostTurn)) return true;
      k = robot_->base_configuration_size();
    }
    for (; k < inner.size(); ++k) {
      const double below = std::min(0.0, chord[k]) - inner[k];
      if (std::max(below, inner[k] - std::max(0.0, chord[k])) > most) return true;
    }
  }
  return false;
}

bool PathSpline::add_waypoints(double max_deviation) {
  std::vector<Eigen::VectorXd> waypoints;
  Eigen::VectorXd step(robot_->tangent_size()), between(robot_->configuration_size());
  for (std::size_t i = 0; i + 1 < waypoints_.size(); ++i) {
    waypoints.push_back(waypoints_[i]);
    if (!deviates(i, max_deviation)) continue;
    robot_->difference(waypoints_[i].data(), waypoints_[i + 1].data(), step.data());
    step *= 0.5;
    robot_->integrate(waypoints_[i].data(), step.data(), between.data());
    waypoints.push_back(between);
  }
  waypoints.push_back(waypoints_.back());
  const bool added = waypoints.size() > waypoints_.size();
  waypoints_ = std::move(waypoints);
  return added;
}

double PathSpline::turn_rad(std::size_t knot) const {
  if (!robot_->floating_base()) return 0.0;
  Eigen::VectorXd step(robot_->tangent_size());
  robot_->difference(waypoints_[knot].data(), waypoints_[knot + 1].data(), step.data());
  return step.segment<3>(3).norm();
}

void PathSpline::at(double s, PathPoint& point) const {
  point.s = s = std::clamp(s, 0.0, length());
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, s);
  const auto i = static_cast<std::size_t>(after - knots_.begin()) - 1;
  const double h = knots_[i + 1] - knots_[i];
  const double to = (s - knots_[i]) / h, from = (knots_[i + 1] - s) / h;
  const Eigen::VectorXd& m0 = bends_[i];
  const Eigen::VectorXd& m1 = bends_[i + 1];
  const Eigen::VectorXd &q0 = waypoints_[i], &q1 = waypoints_[i + 1];
  point.configuration = from * q0 + to * q1 +
                        h * h / 6.0 * (from * (from * from - 1.0) * m0 + to * (to * to - 1.0) * m1);
  const Eigen::VectorXd first =
      (q1 - q0) / h + h / 6.0 * ((1.0 - 3.0 * from * from) * m0 + (3.0 * to * to - 1.0) * m1);
  const Eigen::VectorXd second = from * m0 + to * m1;
  const int joints = robot_->active_joint_count();
  point.first.resize(robot_->tangent_size());
  point.second.resize(robot_->tangent_size());
  point.first.tail(joints) = first.tail(joints);
  point.second.tail(joints) = second.tail(joints);
  if (!robot_->floating_base()) return;
  const Eigen::Vector4d quaternion = point.configuration.segment<4>(3);
  const double squared = quaternion.squaredNorm();
  const Eigen::Vector3d omega = 2.0 / squared * turn(quaternion, first.segment<4>(3));
  point.configuration.segment<4>(3) /= std::sqrt(squared);
  const double* q = point.configuration.data();
  const Eigen::Matrix3d base_from_world =
      Eigen::Quaterniond(q[6], q[3], q[4], q[5]).conjugate().toRotationMatrix();
  point.first.head<3>() = base_from_world * first.head<3>();
  point.first.segment<3>(3) = omega;
  point.second.head<3>() = base_from_world * second.head<3>() - omega.cross(point.first.head<3>());
  point.second.segment<3>(3) = 2.0 / squared * turn(quaternion, second.segment<4>(3)) -
                               2.0 / squared * quaternion.dot(first.segment<4>(3)) * omega;
}

}  // namespace locograph
