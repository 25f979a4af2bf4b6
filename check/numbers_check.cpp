#include <locograph/check/limits.h>
#include <locograph/check/numbers_check.h>
#include <locograph/check/polynomial.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace locograph {
namespace {

constexpr double kMaxSpinPerSample = 0.25;  // rad: far below the half turn that would be ambiguous

template <class... Numbers>
std::string format(const char* pattern, Numbers... numbers) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, numbers...);
  return text;
}

bool limits_anything(double limit) { return limit > 0.0 && std::isfinite(limit); }

}  // namespace

NumbersCheck::NumbersCheck(CheckContext& context)
    : context_(context),
      robot_(context.robot),
      options_(context.options),
      not_finite_("not_finite", "count", 0.0, Worse::kHigher, context.vertices()),
      configuration_size_("configuration_size", "count", 0.0, Worse::kHigher, context.vertices()),
      base_orientation_("base_orientation", "1", context.options.quaternion_tolerance,
                        Worse::kHigher, context.vertices()),
      // Zero is too little.
      time_order_("time_order", "s", 0.0, Worse::kLower, context.vertices(),
                  -std::numeric_limits<double>::min()),
      step_size_("step_size", "count", context.options.max_samples_per_step, Worse::kHigher,
                 context.vertices()),
      joint_limits_("joint_limits", "rad", context.options.joint_tolerance_rad, Worse::kHigher,
                    context.vertices()),
      velocity_limits_("velocity_limits", "ratio", 1.0, Worse::kHigher, context.vertices(),
                       context.options.velocity_tolerance),
      base_velocity_("base_velocity", "ratio", 1.0, Worse::kHigher, context.vertices(),
                     context.options.velocity_tolerance),
      acceleration_limits_("acceleration_limits", "ratio", 1.0, Worse::kHigher, context.vertices(),
                           context.options.velocity_tolerance),
      end_at_rest_("end_at_rest", "rad/s", limits::kAtRest, Worse::kHigher, context.vertices()) {}

void NumbersCheck::run() {
  const std::size_t vertices = context_.vertices();
  context_.usable.vertices.assign(vertices, true);
  context_.usable.steps.assign(vertices, false);
  context_.samples_per_step.assign(vertices, 0);
  for (std::size_t i = 0; i < vertices; ++i) check_numbers(int(i));
  for (std::size_t i = 0; i < vertices; ++i)
    if (context_.usable.vertices[i])
      check_joint_limits(int(i), 0.0, context_.motion.configurations[i]);
  if (!context_.moves()) {
    // A posture whose file says that it moves.
    if (context_.vertices() == 1 && !context_.curve.slope(0).isZero(0.0)) check_at_rest(0);
    return;
  }
  // Before the plan's clock begins there is no time.
  if (time(0) < 0.0)
    time_order_.add(time(0), 0, time(0), Eigen::Vector3d::Zero(),
                    [&] { return format("it begins at %.6g s", time(0)); });
  for (std::size_t i = 0; i + 1 < vertices; ++i)
    if (context_.usable.vertices[i] && context_.usable.vertices[i + 1]) check_step(int(i));
  if (options_.starts_at_rest) check_at_rest(0);
  if (options_.ends_at_rest) check_at_rest(int(vertices) - 1);
}

void NumbersCheck::check_numbers(int vertex) {
  context_.begin_work("judging numbers", vertex);
  const Eigen::VectorXd& q = context_.motion.configurations[std::size_t(vertex)];
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
  const long missing = std::abs(long(q.size()) - long(robot_.configuration_size()));
  configuration_size_.add(double(missing), vertex, 0.0, nowhere, [&] {
    return std::to_string(q.size()) + " numbers, expected " +
           std::to_string(robot_.configuration_size());
  });
  int bad = std::isfinite(time(vertex)) ? 0 : 1;
  for (const double number : q) bad += std::isfinite(number) ? 0 : 1;
  if (!context_.motion.slopes.empty())
    for (const double number : context_.motion.slopes[std::size_t(vertex)])
      bad += std::isfinite(number) ? 0 : 1;
  not_finite_.add(bad, vertex, 0.0, nowhere, [&] {
    return bad == 0 ? std::string("all numbers are finite")
                    : std::to_string(bad) + " numbers are not finite";
  });
  if (missing == 0 && bad == 0 && robot_.floating_base()) {
    const double norm = q.segment<4>(3).norm();
    base_orientation_.add(std::abs(norm - 1.0), vertex, time(vertex), q.head<3>(),
                          [&] { return format("norm of the quaternion %.9g", norm); });
  }
  context_.usable.vertices[std::size_t(vertex)] = context_.curve.usable(vertex);
}

void NumbersCheck::check_joint_limits(int vertex, double fraction, const Eigen::VectorXd& q) {
  const Eigen::VectorXd joints = q.tail(robot_.active_joint_count());
  for (int i = 0; i < robot_.active_joint_count(); ++i) {
    const Joint& joint = robot_.active_joint(i);
    if (joint.type == JointType::kContinuous) continue;
    const double excess = std::max(joint.lower - joints[i], joints[i] - joint.upper);
    const bool worst = joint_limits_.add(
        excess, vertex, context_.curve.time_s(vertex, fraction), Eigen::Vector3d::Zero(), [&] {
          return joint.name + format(" at %.6g, limits %.6g to %.6g", double(joints[i]),
                                     joint.lower, joint.upper);
        });
    if (worst) joint_limits_.set_unit(joint.type == JointType::kPrismatic ? "m" : "rad");
  }
}

void NumbersCheck::check_step(int vertex) {
  context_.begin_work("judging steps", vertex);
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
  const double duration = time(vertex + 1) - time(vertex);
  time_order_.add(duration, vertex, time(vertex), nowhere,
                  [&] { return format("to the next vertex: %.6g s", duration); });
  const CurveStep step = context_.curve.step(vertex);
  const StepBounds bounds = step.bounds();
  if (duration > 0.0) {
    for (int i = 0; i < robot_.active_joint_count(); ++i) check_joint(vertex, step, i);
    check_base_velocity(vertex, step, bounds);
  }
  const double samples = samples_needed(bounds);
  step_size_.add(samples, vertex, time(vertex), nowhere, [&] {
    return format("base moves up to %.4g m and turns up to %.4g rad", bounds.base_distance_m,
                  bounds.base_angle_rad);
  });
  if (step_size_.violated_at(vertex) || !(duration > 0.0)) return;
  context_.usable.steps[std::size_t(vertex)] = true;
  context_.samples_per_step[std::size_t(vertex)] = int(samples);
}

/// Where its cubic turns: its position where the rate is zero, its rate where the acceleration is,
/// its acceleration at both ends.
void NumbersCheck::check_joint(int vertex, const CurveStep& step, int joint) {
  const Eigen::Vector3d c = step.cubic(robot_.base_tangent_size() + joint);
  const double h = step.duration_s();
  const auto rate = [&](double s) { return (c[0] + s * (2.0 * c[1] + 3.0 * s * c[2])) / h; };
  Eigen::VectorXd turning;
  for (const double s : roots_in_unit({c[0], 2.0 * c[1], 3.0 * c[2], 0.0})) {
    step.configuration(s, turning);
    check_joint_limits(vertex, s, turning);
  }
  check_velocity(vertex, 0.0, joint, rate(0.0));
  check_velocity(vertex, 1.0, joint, rate(1.0));
  for (const double s : roots_in_unit({2.0 * c[1], 6.0 * c[2], 0.0, 0.0}))
    check_velocity(vertex, s, joint, rate(s));
  if (!limits_anything(options_.joint_acceleration_rad_s2)) return;
  check_acceleration(vertex, 0.0, joint, 2.0 * c[1] / (h * h));
  check_acceleration(vertex, 1.0, joint, (2.0 * c[1] + 6.0 * c[2]) / (h * h));
}

void NumbersCheck::check_velocity(int vertex, double fraction, int joint, double velocity) {
  const Joint& model = robot_.active_joint(joint);
  if (std::isinf(model.max_velocity)) return;
  const double speed = std::abs(velocity);
  const double ratio = speed > 0.0 ? speed / model.max_velocity : 0.0;
  velocity_limits_.add(
      ratio, vertex, context_.curve.time_s(vertex, fraction), Eigen::Vector3d::Zero(), [&] {
        const char* unit = model.type == JointType::kPrismatic ? " m/s" : " rad/s";
        return model.name + format(" at %.6g of at most %.6g", speed, model.max_velocity) + unit;
      });
}

void NumbersCheck::check_acceleration(int vertex, double fraction, int joint, double acceleration) {
  const double amount = std::abs(acceleration);
  acceleration_limits_.add(amount / options_.joint_acceleration_rad_s2, vertex,
                           context_.curve.time_s(vertex, fraction), Eigen::Vector3d::Zero(), [&] {
                             return robot_.active_joint(joint).name +
                                    format(" at %.6g of at most %.6g", amount,
                                           options_.joint_acceleration_rad_s2);
                           });
}

void NumbersCheck::check_base_velocity(int vertex, const CurveStep& step,
                                       const StepBounds& bounds) {
  if (!robot_.floating_base()) return;
  const auto check = [&](double velocity, double limit, const char* pattern) {
    if (!limits_anything(limit)) return;
    base_velocity_.add(velocity / limit, vertex, time(vertex), Eigen::Vector3d::Zero(),
                       [&] { return format(pattern, velocity, limit); });
  };
  check(bounds.base_distance_m / step.duration_s(), options_.base_linear_m_s,
        "%.6g m/s of at most %.6g");
  // Of its rotation vector, which no turn is faster than: as fast where its axis stays.
  check(bounds.base_angle_rad / step.duration_s(), options_.base_angular_rad_s,
        "%.6g rad/s of at most %.6g");
}

void NumbersCheck::check_at_rest(int vertex) {
  if (!context_.usable.vertices[std::size_t(vertex)]) return;
  const Eigen::VectorXd& slope = context_.curve.slope(vertex);
  const int base = robot_.base_tangent_size();
  Eigen::Index fastest = 0;
  if (slope.size() > 0) slope.cwiseAbs().maxCoeff(&fastest);
  const double speed = slope.size() > 0 ? std::abs(slope[fastest]) : 0.0;
  const bool worst = end_at_rest_.add(speed, vertex, time(vertex), Eigen::Vector3d::Zero(), [&] {
    const std::string what =
        fastest < base ? "the base" : robot_.active_joint(int(fastest) - base).name;
    return what + format(vertex == 0 ? " moves at %.4g as the plan begins"
                                     : " moves at %.4g as the plan ends",
                         speed);
  });
  const bool slides = fastest < base
                          ? fastest < 3
                          : robot_.active_joint(int(fastest) - base).type == JointType::kPrismatic;
  if (worst) end_at_rest_.set_unit(slides ? "m/s" : "rad/s");
}

double NumbersCheck::samples_needed(const StepBounds& step) {
  MovingShapes& shapes = *context_.shapes;
  shapes.set_step(step);
  double samples = std::max(step.base_distance_m, shapes.step_length_bound()) / options_.max_step_m;
  samples = std::max(samples, step.base_angle_rad / options_.max_step_rad);
  for (const Axis& axis : robot_.axes()) {
    if (robot_.joints()[std::size_t(axis.joint)].type == JointType::kPrismatic) continue;
    const double largest =
        shapes.joint_moves_shapes(axis.active) ? options_.max_step_rad : kMaxSpinPerSample;
    samples = std::max(samples, std::abs(axis.multiplier) * step.joints[axis.active] / largest);
  }
  // Between two samples nothing is further than this from where both say that it is.
  constexpr double kBend_m = 0.1 * limits::kHeld_m;
  samples = std::max(samples, std::sqrt(shapes.bend(1.0) / kBend_m));
  // What is closed at both ends is furthest off in between.
  return std::max(2.0, std::ceil(samples));
}

void NumbersCheck::report(std::vector<Violation>& violations) const {
  const std::string still =
      context_.moves() ? "no two vertices in a row can be looked at" : context_.why_nothing_moves();
  const auto with_limit = [&](bool limited) {
    return context_.moves() && !limited ? std::string("no limit is given") : still;
  };
  const std::string no_vertex = "no vertex can be looked at";
  violations.insert(violations.begin(), {not_finite_.result(), configuration_size_.result()});
  violations.push_back(base_orientation_.result(
      robot_.floating_base() ? no_vertex : "the base is fixed to the world"));
  violations.push_back(time_order_.result(still));
  violations.push_back(step_size_.result(still));
  violations.push_back(joint_limits_.result(
      robot_.active_joint_count() == 0 ? "the robot has no joints" : no_vertex));
  violations.push_back(velocity_limits_.result(still));
  violations.push_back(base_velocity_.result(
      robot_.floating_base() ? with_limit(limits_anything(options_.base_linear_m_s) ||
                                          limits_anything(options_.base_angular_rad_s))
                             : "the base is fixed to the world"));
  violations.push_back(
      acceleration_limits_.result(with_limit(limits_anything(options_.joint_acceleration_rad_s2))));
  violations.push_back(end_at_rest_.result(
      context_.moves() ? "it is a part of a motion, which goes on at both ends" : still));
}

std::optional<double> NumbersCheck::max_velocity_ratio() const {
  if (velocity_limits_.empty()) return std::nullopt;
  return velocity_limits_.worst();
}

}  // namespace locograph
