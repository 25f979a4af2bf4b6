#include <locograph/check/motion_rates.h>
#include <locograph/check/numbers_check.h>

#include <algorithm>
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
                           context.options.velocity_tolerance) {}

void NumbersCheck::run() {
  const std::size_t vertices = context_.vertices();
  context_.usable.vertices.assign(vertices, true);
  context_.usable.steps.assign(vertices, false);
  context_.samples_per_step.assign(vertices, 0);
  for (std::size_t i = 0; i < vertices; ++i) check_numbers(int(i));
  for (std::size_t i = 0; i < vertices; ++i)
    if (context_.usable.vertices[i]) check_joint_limits(int(i));
  if (!context_.moves()) return;
  for (std::size_t i = 0; i + 1 < vertices; ++i)
    if (context_.usable.vertices[i] && context_.usable.vertices[i + 1]) check_step(int(i));
  if (limits_anything(options_.joint_acceleration_rad_s2)) check_accelerations();
}

void NumbersCheck::check_numbers(int vertex) {
  context_.go_on("judging numbers", vertex);
  const Eigen::VectorXd& q = context_.motion.configurations[std::size_t(vertex)];
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
  const long missing = std::abs(long(q.size()) - long(robot_.configuration_size()));
  configuration_size_.add(double(missing), vertex, 0.0, nowhere, [&] {
    return std::to_string(q.size()) + " numbers, expected " +
           std::to_string(robot_.configuration_size());
  });
  int bad = std::isfinite(time(vertex)) ? 0 : 1;
  for (const double number : q) bad += std::isfinite(number) ? 0 : 1;
  not_finite_.add(bad, vertex, 0.0, nowhere, [&] {
    return bad == 0 ? std::string("all numbers are finite")
                    : std::to_string(bad) + " numbers are not finite";
  });
  bool usable = missing == 0 && bad == 0;
  if (usable && robot_.floating_base()) {
    const double norm = q.segment<4>(3).norm();
    base_orientation_.add(std::abs(norm - 1.0), vertex, time(vertex), q.head<3>(),
                          [&] { return format("norm of the quaternion %.9g", norm); });
    usable = norm > 1e-3 && std::isfinite(norm);
  }
  context_.usable.vertices[std::size_t(vertex)] = usable;
}

void NumbersCheck::check_joint_limits(int vertex) {
  const Eigen::VectorXd& q = context_.motion.configurations[std::size_t(vertex)];
  const Eigen::VectorXd joints = q.tail(robot_.active_joint_count());
  for (int i = 0; i < robot_.active_joint_count(); ++i) {
    const Joint& joint = robot_.active_joint(i);
    if (joint.type == JointType::kContinuous) continue;
    const double excess = std::max(joint.lower - joints[i], joints[i] - joint.upper);
    const bool worst =
        joint_limits_.add(excess, vertex, time(vertex), Eigen::Vector3d::Zero(), [&] {
          return joint.name + format(" at %.6g, limits %.6g to %.6g", double(joints[i]),
                                     joint.lower, joint.upper);
        });
    if (worst) joint_limits_.set_unit(joint.type == JointType::kPrismatic ? "m" : "rad");
  }
}

void NumbersCheck::check_step(int vertex) {
  context_.go_on("judging steps", vertex);
  const Motion& motion = context_.motion;
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
  const double duration = time(vertex + 1) - time(vertex);
  time_order_.add(duration, vertex, time(vertex), nowhere,
                  [&] { return format("to the next vertex: %.6g s", duration); });
  const ConfigurationStep step =
      configuration_step(robot_, motion.configurations[std::size_t(vertex)],
                         motion.configurations[std::size_t(vertex) + 1]);
  if (duration > 0.0) {
    check_velocities(vertex, step, duration);
    check_base_velocity(vertex, step, duration);
  }
  const double samples = samples_needed(step);
  step_size_.add(samples, vertex, time(vertex), nowhere, [&] {
    return format("base moves %.4g m and turns %.4g rad", step.base_distance_m,
                  step.base_angle_rad);
  });
  if (step_size_.violated_at(vertex)) return;
  context_.usable.steps[std::size_t(vertex)] = true;
  context_.samples_per_step[std::size_t(vertex)] = int(samples);
}

void NumbersCheck::check_velocities(int vertex, const ConfigurationStep& step, double duration) {
  for (int i = 0; i < robot_.active_joint_count(); ++i) {
    const Joint& joint = robot_.active_joint(i);
    if (std::isinf(joint.max_velocity)) continue;
    const double velocity = std::abs(step.joints[i]) / duration;
    const double ratio = velocity > 0.0 ? velocity / joint.max_velocity : 0.0;
    velocity_limits_.add(ratio, vertex, time(vertex), Eigen::Vector3d::Zero(), [&] {
      const char* unit = joint.type == JointType::kPrismatic ? " m/s" : " rad/s";
      return joint.name + format(" at %.6g of at most %.6g", velocity, joint.max_velocity) + unit;
    });
  }
}

void NumbersCheck::check_base_velocity(int vertex, const ConfigurationStep& step, double duration) {
  if (!robot_.floating_base()) return;
  const auto check = [&](double change, double limit, const char* pattern) {
    if (!limits_anything(limit)) return;
    const double velocity = change / duration;
    base_velocity_.add(velocity / limit, vertex, time(vertex), Eigen::Vector3d::Zero(),
                       [&] { return format(pattern, velocity, limit); });
  };
  check(step.base_distance_m, options_.base_linear_m_s, "%.6g m/s of at most %.6g");
  check(step.base_angle_rad, options_.base_angular_rad_s, "%.6g rad/s of at most %.6g");
}

void NumbersCheck::check_accelerations() {
  const MotionRates rates(context_);
  for (std::size_t i = 0; i < context_.vertices(); ++i) {
    const Eigen::VectorXd accelerations = rates.joint_acceleration(int(i));
    for (int j = 0; j < accelerations.size(); ++j) {
      const double amount = std::abs(accelerations[j]);
      acceleration_limits_.add(amount / options_.joint_acceleration_rad_s2, int(i), time(int(i)),
                               Eigen::Vector3d::Zero(), [&] {
                                 return robot_.active_joint(j).name +
                                        format(" at %.6g of at most %.6g", amount,
                                               options_.joint_acceleration_rad_s2);
                               });
    }
  }
}

double NumbersCheck::samples_needed(const ConfigurationStep& step) {
  MovingShapes& shapes = *context_.shapes;
  shapes.set_step(step);
  double samples = std::max(step.base_distance_m, shapes.step_length_bound()) / options_.max_step_m;
  samples = std::max(samples, step.base_angle_rad / options_.max_step_rad);
  for (const Axis& axis : robot_.axes()) {
    if (robot_.joints()[std::size_t(axis.joint)].type == JointType::kPrismatic) continue;
    const double largest =
        shapes.joint_moves_shapes(axis.active) ? options_.max_step_rad : kMaxSpinPerSample;
    samples = std::max(samples, std::abs(axis.multiplier * step.joints[axis.active]) / largest);
  }
  return std::max(1.0, std::ceil(samples));
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
}

std::optional<double> NumbersCheck::max_velocity_ratio() const {
  if (velocity_limits_.empty()) return std::nullopt;
  return velocity_limits_.worst();
}

}  // namespace locograph
