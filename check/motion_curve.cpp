#include <locograph/check/motion_curve.h>
#include <locograph/check/polynomial.h>
#include <locograph/common/error.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

using Vector3 = Eigen::Vector3d;

// Coefficients x y z w, normalised.
Eigen::Quaterniond base_rotation(const Eigen::VectorXd& configuration) {
  return Eigen::Quaterniond(Eigen::Vector4d(configuration.segment<4>(3))).normalized();
}

/// The rotation vector from one rotation to another, in the axes of both.
Vector3 turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  Eigen::Quaterniond turn = from.conjugate() * to;
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;
  const double sine = turn.vec().norm();
  // 2 atan2(sine, w) / sine, without the loss of digits of small angles.
  const double factor = sine < 1e-8 ? 2.0 / turn.w() : 2.0 * std::atan2(sine, turn.w()) / sine;
  return factor * turn.vec();
}

/// Of the base's position in the world, by the rotation vector of its turn, of joints.
Eigen::VectorXd change_between(const Robot& robot, const Eigen::VectorXd& from,
                               const Eigen::VectorXd& to) {
  Eigen::VectorXd change(robot.tangent_size());
  const int joints = robot.active_joint_count();
  change.tail(joints) = to.tail(joints) - from.tail(joints);
  if (robot.floating_base()) {
    change.head<3>() = to.head<3>() - from.head<3>();
    change.segment<3>(3) = turn_between(base_rotation(from), base_rotation(to));
  }
  return change;
}

Eigen::Quaterniond exponential(const Vector3& rotation) {
  const double angle = rotation.norm();
  // sin(angle / 2) / angle.
  const double factor = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond result;
  result.w() = std::cos(0.5 * angle);
  result.vec() = factor * rotation;
  return result;
}

/// Of exp(c) as c changes: with a = (1 - cos) / |c|^2 and b = (|c| - sin) / |c|^3 the right
/// Jacobian is I - a [c] + b [c]^2; a_slope and b_slope are their derivatives by |c|, over |c|.
struct RightJacobian {
  double a, b, a_slope, b_slope;

  explicit RightJacobian(double angle) {
    const double x = angle * angle;
    if (angle < 0.03) {  // series, whose next terms are below 1e-15
      a = 0.5 - x / 24.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0));
      b = 1.0 / 6.0 - x / 120.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0));
      a_slope = -1.0 / 12.0 + x / 180.0 * (1.0 - x / 37.3333333333333);
      b_slope = -1.0 / 60.0 + x / 1260.0 * (1.0 - x / 48.0);
      return;
    }
    const double sine = std::sin(angle), cosine = std::cos(angle);
    a = (1.0 - cosine) / x;
    b = (angle - sine) / (x * angle);
    a_slope = (angle * sine - 2.0 * (1.0 - cosine)) / (x * x);
    b_slope = (3.0 * sine - 2.0 * angle - angle * cosine) / (x * x * angle);
  }
};

/// What c has to change by for the angular velocity w at the end of a turn d: Jr(d)^-1 w.
Vector3 inverse_right_jacobian(const Vector3& d, const Vector3& w) {
  const double angle = d.norm();
  const double factor = angle < 1e-3
                            ? 1.0 / 12.0 + angle * angle / 720.0
                            : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  const Vector3 across = d.cross(w);
  return w + 0.5 * across + factor * d.cross(across);
}

/// The largest |v| of v(s) = v_0 + v_1 s + v_2 s^2 on [0, 1], of vectors or of one number.
template <class Vector>
double largest_norm(const Vector& v0, const Vector& v1, const Vector& v2) {
  double most = std::max(v0.squaredNorm(), (v0 + v1 + v2).squaredNorm());
  // Half the derivative of |v|^2.
  const std::array<double, 4> slope = {v0.dot(v1), v1.dot(v1) + 2.0 * v0.dot(v2), 3.0 * v1.dot(v2),
                                       2.0 * v2.dot(v2)};
  for (const double s : roots_in_unit(slope)) {
    most = std::max(most, (v0 + s * (v1 + s * v2)).squaredNorm());
  }
  return std::sqrt(most);
}

}  // namespace

CurveStep::CurveStep(const Robot& robot, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                     const Eigen::VectorXd& slope_from, const Eigen::VectorXd& slope_to,
                     double duration_s)
    : robot_(&robot),
      from_(&from),
      to_(&to),
      duration_s_(duration_s),
      rotation_(Eigen::Quaterniond::Identity()),
      cubics_(robot.tangent_size(), 3) {
  const Eigen::VectorXd change = change_between(robot, from, to), begin = duration_s * slope_from;
  Eigen::VectorXd end = duration_s * slope_to;
  if (robot.floating_base()) {
    rotation_ = base_rotation(from);
    end.segment<3>(3) = inverse_right_jacobian(change.segment<3>(3), Vector3(end.segment<3>(3)));
  }
  cubics_.col(0) = begin;
  cubics_.col(1) = 3.0 * change - 2.0 * begin - end;
  cubics_.col(2) = begin + end - 2.0 * change;
}

void CurveStep::configuration(double fraction, Eigen::VectorXd& out) const {
  const bool first = fraction == 0.0, last = fraction == 1.0;
  out = last ? *to_ : *from_;
  if (first || last) {
    if (robot_->floating_base()) out.segment<4>(3).normalize();
    return;
  }
  const double s = fraction;
  const auto change = [&](int begin, int size) {
    return s * (cubics_.block(begin, 0, size, 1) +
                s * (cubics_.block(begin, 1, size, 1) + s * cubics_.block(begin, 2, size, 1)));
  };
  const int joints = robot_->active_joint_count();
  out.tail(joints) += change(robot_->base_tangent_size(), joints);
  if (!robot_->floating_base()) return;
  out.head<3>() += change(0, 3);
  const Vector3 turn = change(3, 3);
  out.segment<4>(3) = (rotation_ * exponential(turn)).normalized().coeffs();
}

Eigen::VectorXd CurveStep::rates(double s) const {
  return (cubics_.col(0) + s * (2.0 * cubics_.col(1) + 3.0 * s * cubics_.col(2))) / duration_s_;
}

void CurveStep::at(double fraction, CurvePoint& point) const {
  const double s = fraction, h = duration_s_;
  configuration(s, point.configuration);
  // Into what is there: rates() would allocate.
  point.velocity = (cubics_.col(0) + s * (2.0 * cubics_.col(1) + 3.0 * s * cubics_.col(2))) / h;
  point.acceleration = (2.0 * cubics_.col(1) + 6.0 * s * cubics_.col(2)) / (h * h);
  if (!robot_->floating_base()) return;
  const Vector3 c = s * (cubics_.block<3, 1>(3, 0) +
                         s * (cubics_.block<3, 1>(3, 1) + s * cubics_.block<3, 1>(3, 2)));
  const Vector3 rate = point.velocity.segment<3>(3), bend = point.acceleration.segment<3>(3);
  const RightJacobian jacobian(c.norm());
  const Vector3 once = c.cross(rate), twice = c.cross(once);
  const Vector3 omega = rate - jacobian.a * once + jacobian.b * twice;
  const double along = c.dot(rate);
  const Vector3 alpha = bend - jacobian.a * c.cross(bend) + jacobian.b * c.cross(c.cross(bend)) -
                        jacobian.a_slope * along * once + jacobian.b_slope * along * twice +
                        jacobian.b * rate.cross(once);
  const Eigen::Matrix3d base_from_world =
      base_rotation(point.configuration).toRotationMatrix().transpose();
  const Vector3 own = base_from_world * Vector3(point.velocity.head<3>());
  // Along the base's own axes, which turn: d/dt (R^T u) = R^T u' - w x R^T u.
  point.acceleration.head<3>() =
      base_from_world * Vector3(point.acceleration.head<3>()) - omega.cross(own);
  point.velocity.head<3>() = own;
  point.velocity.segment<3>(3) = omega;
  point.acceleration.segment<3>(3) = alpha;
}

Eigen::VectorXd CurveStep::slope(double fraction) const {
  Eigen::VectorXd slope = rates(fraction);
  if (robot_->floating_base()) {
    CurvePoint point;
    at(fraction, point);
    slope.segment<3>(3) = point.velocity.segment<3>(3);
  }
  return slope;
}

StepBounds CurveStep::bounds() const {
  StepBounds result;
  const int joints = robot_->active_joint_count(), base = robot_->base_tangent_size();
  const auto rate = [&](int row) {
    const Vector3 v0 = cubics_.block<3, 1>(row, 0), v1 = 2.0 * cubics_.block<3, 1>(row, 1),
                  v2 = 3.0 * cubics_.block<3, 1>(row, 2);
    return largest_norm(v0, v1, v2);
  };
  // Linear over the step: the largest is at an end.
  const auto bend = [&](int row) {
    const Vector3 first = 2.0 * cubics_.block<3, 1>(row, 1),
                  last = first + 6.0 * cubics_.block<3, 1>(row, 2);
    return std::max(first.norm(), last.norm());
  };
  result.joints.resize(joints);
  result.joint_bends.resize(joints);
  for (int i = 0; i < joints; ++i) {
    using Number = Eigen::Matrix<double, 1, 1>;
    const double v1 = 2.0 * cubics_(base + i, 1), v2 = 3.0 * cubics_(base + i, 2);
    result.joints[i] = largest_norm(Number(cubics_(base + i, 0)), Number(v1), Number(v2));
    result.joint_bends[i] = std::max(std::abs(v1), std::abs(v1 + 2.0 * v2));
  }
  if (base == 0) return result;
  result.base_distance_m = rate(0);
  result.base_bend_m = bend(0);
  // exp(c) turns no faster than c changes, as Jr = int_0^1 exp(-t [c]) dt shortens; and as
  // |d Jr / ds| <= int t |c'| dt, its angular acceleration is no more than |c''| + |c'|^2 / 2.
  result.base_angle_rad = rate(3);
  result.base_bend_rad = bend(3) + 0.5 * result.base_angle_rad * result.base_angle_rad;
  return result;
}

MotionCurve::MotionCurve(const Robot& robot, const Motion& motion)
    : robot_(&robot), motion_(&motion) {
  const std::size_t count = motion.configurations.size();
  if (!motion.slopes.empty() && motion.slopes.size() != count) {
    throw Error("slopes of " + std::to_string(motion.slopes.size()) + " configurations",
                "of all " + std::to_string(count) + ", or none");
  }
  const auto given = [&](std::size_t i) {
    return motion.slopes.empty() || motion.slopes[i].size() == 0 ? nullptr : &motion.slopes[i];
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::VectorXd& q = motion.configurations[i];
    bool usable =
        q.size() == robot.configuration_size() && q.allFinite() && std::isfinite(motion.time_s[i]);
    if (usable && robot.floating_base()) {
      const double norm = q.segment<4>(3).norm();
      usable = norm > 1e-3 && std::isfinite(norm);
    }
    if (const Eigen::VectorXd* slope = given(i)) {
      if (slope->size() != robot.tangent_size()) {
        throw Error(std::to_string(slope->size()) + " slopes of a configuration",
                    std::to_string(robot.tangent_size()) + ", or none");
      }
      usable = usable && slope->allFinite();
    }
    usable_.push_back(usable);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool by_rule = given(i) == nullptr || !usable_[i];
    slopes_.push_back(by_rule ? three_point_slope(static_cast<int>(i)) : *given(i));
  }
}

Eigen::VectorXd MotionCurve::three_point_slope(int vertex) const {
  const Motion& motion = *motion_;
  const std::size_t i = static_cast<std::size_t>(vertex);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(robot_->tangent_size());
  if (i == 0 || i + 1 == motion.configurations.size() || motion.stances_only) return slope;
  if (!usable_[i - 1] || !usable_[i] || !usable_[i + 1]) return slope;
  if (!motion.stance_from.empty() && motion.stance_from[i - 1] != motion.stance_from[i]) {
    return slope;
  }
  const double before_s = motion.time_s[i] - motion.time_s[i - 1],
               after_s = motion.time_s[i + 1] - motion.time_s[i];
  if (!(before_s > 0.0) || !(after_s > 0.0)) return slope;
  const std::vector<Eigen::VectorXd>& q = motion.configurations;
  const Eigen::VectorXd before = change_between(*robot_, q[i - 1], q[i]),
                        after = change_between(*robot_, q[i], q[i + 1]);
  return (after_s / before_s * before + before_s / after_s * after) / (before_s + after_s);
}

CurveStep MotionCurve::step(int vertex) const {
  const std::size_t i = static_cast<std::size_t>(vertex);
  const Motion& motion = *motion_;
  const double duration_s = motion.time_s[i + 1] - motion.time_s[i];
  return {*robot_,    motion.configurations[i], motion.configurations[i + 1],
          slopes_[i], slopes_[i + 1],           std::max(0.0, duration_s)};
}

CurvePoint MotionCurve::at_vertex(int vertex) const {
  const auto count = static_cast<int>(motion_->configurations.size());
  CurvePoint point;
  if (count > 1) {
    const bool last = vertex + 1 == count;
    step(last ? vertex - 1 : vertex).at(last ? 1.0 : 0.0, point);
    return point;
  }
  point.configuration = motion_->configurations.front();
  point.velocity = point.acceleration = Eigen::VectorXd::Zero(robot_->tangent_size());
  return point;
}

CurvePoint MotionCurve::through_vertex(int vertex) const {
  CurvePoint point = at_vertex(vertex);
  if (vertex == 0 || vertex + 1 == static_cast<int>(motion_->configurations.size())) return point;
  CurvePoint before;
  step(vertex - 1).at(1.0, before);
  point.acceleration = 0.5 * (point.acceleration + before.acceleration);
  return point;
}

double MotionCurve::time_s(int vertex, double fraction) const {
  const std::vector<double>& times = motion_->time_s;
  const std::size_t i = static_cast<std::size_t>(vertex);
  if (fraction == 0.0) return times[i];
  return times[i] + fraction * (times[i + 1] - times[i]);
}

Motion part_of(const MotionCurve& curve, int first, int last) {
  const Motion& whole = curve.motion();
  Motion part;
  part.stances = whole.stances;
  part.stances_only = whole.stances_only;
  for (int i = first; i <= last; ++i) {
    const std::size_t at = static_cast<std::size_t>(i);
    part.time_s.push_back(whole.time_s[at]);
    part.configurations.push_back(whole.configurations[at]);
    if (!whole.stance_from.empty()) part.stance_from.push_back(whole.stance_from[at]);
    part.slopes.push_back(curve.slope(i));
  }
  return part;
}

Motion resampled(const MotionCurve& curve, const std::vector<double>& times_s) {
  const Motion& motion = curve.motion();
  Motion result;
  result.stances = motion.stances;
  std::size_t i = 0;
  for (const double time_s : times_s) {
    while (i + 2 < motion.time_s.size() && motion.time_s[i + 1] <= time_s) ++i;
    const CurveStep step = curve.step(static_cast<int>(i));
    const bool last = time_s >= motion.time_s.back();
    const double fraction =
        last ? 1.0 : std::clamp((time_s - motion.time_s[i]) / step.duration_s(), 0.0, 1.0);
    result.time_s.push_back(time_s);
    step.configuration(fraction, result.configurations.emplace_back());
    result.slopes.push_back(fraction == 0.0 || last
                                ? curve.slope(static_cast<int>(last ? i + 1 : i))
                                : step.slope(fraction));
    if (!motion.stance_from.empty())
      result.stance_from.push_back(motion.stance_from[last ? i + 1 : i]);
  }
  return result;
}

void MotionSampler::link_poses(int vertex, double fraction,
                               std::vector<Eigen::Isometry3d>& world_from_link) {
  if (vertex != vertex_ || fraction != fraction_) move_to(vertex, fraction);
  const std::size_t links = curve_->robot().links().size();
  world_from_link.resize(links);
  for (std::size_t link = 0; link < links; ++link)
    world_from_link[link] = state_.world_from_link(static_cast<int>(link));
}

void MotionSampler::move_to(int vertex, double fraction) {
  if (fraction == 0.0) {
    configuration_ = curve_->motion().configurations[static_cast<std::size_t>(vertex)];
    if (curve_->robot().floating_base()) configuration_.segment<4>(3).normalize();
  } else {
    if (step_from_ != vertex) step_.emplace(curve_->step(vertex));
    step_from_ = vertex;
    step_->configuration(fraction, configuration_);
  }
  state_.update(configuration_.data());
  vertex_ = vertex;
  fraction_ = fraction;
}

}  // namespace locograph
