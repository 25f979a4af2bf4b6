#include <locograph/common/error.h>
#include <locograph/planners/plan/balance_certificate.h>
#include <locograph/planners/plan/clearance_search.h>
#include <locograph/planners/plan/feasibility_checker.h>
#include <locograph/planners/plan/moving_shapes.h>
#include <locograph/planners/plan/violation_tally.h>
#include <locograph/planners/plan/wheel_rolling.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace locograph {
namespace {

constexpr double kMaxSpinPerSample = 0.25;  // rad: far below the half turn that would be ambiguous

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string format(const char* pattern, double value, double other) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value, other);
  return text;
}

class Check {
 public:
  Check(const Robot& robot, const CollisionWorld& world, const Motion& motion,
        const CheckOptions& options)
      : robot_(robot),
        world_(world),
        motion_(motion),
        options_(options),
        vertices_(motion.configurations.size()),
        shapes_(robot) {
    for (const RollingWheel& wheel : motion.wheels) wheels_.emplace_back(robot, wheel);
    usable_.vertices.assign(vertices_, true);
    usable_.steps.assign(vertices_, false);
    samples_per_step_.assign(vertices_, 0);
    assign_ground_roles();
  }

  CheckReport run() {
    for (std::size_t i = 0; i < vertices_; ++i) check_numbers(int(i));
    for (std::size_t i = 0; i < vertices_; ++i)
      if (usable_.vertices[i]) check_joint_limits(int(i));
    for (std::size_t i = 0; i < motion_.contacts.size(); ++i)
      if (usable_.vertices[i] && !motion_.contacts[i].empty()) check_balance(int(i));
    for (std::size_t i = 0; i + 1 < vertices_; ++i)
      if (usable_.vertices[i] && usable_.vertices[i + 1]) check_step(int(i));
    check_ground_and_wheels();
    ClearanceSearch search(robot_, world_, motion_, shapes_, options_);
    search.run(ClearanceSearch::Kind::kObstacles, usable_, obstacle_distance_);
    search.run(ClearanceSearch::Kind::kSelf, usable_, self_collision_);
    samples_ += search.samples();
    return report();
  }

 private:
  const Eigen::VectorXd& configuration(int vertex) const {
    return motion_.configurations[std::size_t(vertex)];
  }
  double time(int vertex) const { return motion_.time_s[std::size_t(vertex)]; }

  void check_numbers(int vertex) {
    const Eigen::VectorXd& q = configuration(vertex);
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
                            [&] { return "norm of the quaternion " + format("%.9g", norm); });
      usable = norm > 1e-3 && std::isfinite(norm);
    }
    usable_.vertices[std::size_t(vertex)] = usable;
  }

  void check_joint_limits(int vertex) {
    const Eigen::VectorXd joints = configuration(vertex).tail(robot_.active_joint_count());
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      const Joint& joint = robot_.active_joint(i);
      if (joint.type == JointType::kContinuous) continue;
      const double excess = std::max(joint.lower - joints[i], joints[i] - joint.upper);
      const bool worst =
          joint_limits_.add(excess, vertex, time(vertex), Eigen::Vector3d::Zero(), [&] {
            return joint.name + " at " + format("%.6g", joints[i]) + ", limits " +
                   format("%.6g to %.6g", joint.lower, joint.upper);
          });
      if (worst) joint_limits_.set_unit(joint.type == JointType::kPrismatic ? "m" : "rad");
    }
  }

  void check_balance(int vertex) {
    Eigen::VectorXd q = configuration(vertex);
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    if (robot_.floating_base()) {
      q.segment<4>(3).normalize();
      place = q.head<3>();
    }
    BalanceOptions balance;
    balance.enforce_torque_limits = false;
    balance.least_torques = true;
    const BalanceCertificate certificate =
        certify_balance(robot_, q, motion_.contacts[std::size_t(vertex)], balance);
    static_balance_.add(certificate.margin, vertex, time(vertex), place,
                        [&] { return certificate.limiting; });
    if (!certificate.balanced) return;
    torque_limits_.add(certificate.max_torque_ratio, vertex, time(vertex), place,
                       [] { return std::string("of all wrenches that balance, at the least"); });
  }

  void check_step(int vertex) {
    const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
    const double duration = time(vertex + 1) - time(vertex);
    time_order_.add(duration, vertex, time(vertex), nowhere,
                    [&] { return "to the next vertex: " + format("%.6g s", duration); });
    const ConfigurationStep step =
        configuration_step(robot_, configuration(vertex), configuration(vertex + 1));
    if (duration > 0.0) check_velocities(vertex, step, duration);
    const double samples = samples_needed(step);
    step_size_.add(samples, vertex, time(vertex), nowhere, [&] {
      return "base moves " +
             format("%.4g m and turns %.4g rad", step.base_distance_m, step.base_angle_rad);
    });
    if (step_size_.violated_at(vertex)) return;
    usable_.steps[std::size_t(vertex)] = true;
    samples_per_step_[std::size_t(vertex)] = int(samples);
  }

  void check_velocities(int vertex, const ConfigurationStep& step, double duration) {
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      const Joint& joint = robot_.active_joint(i);
      if (std::isinf(joint.max_velocity)) continue;
      const double velocity = std::abs(step.joints[i]) / duration;
      const double ratio = velocity > 0.0 ? velocity / joint.max_velocity : 0.0;
      velocity_limits_.add(ratio, vertex, time(vertex), Eigen::Vector3d::Zero(), [&] {
        const char* unit = joint.type == JointType::kPrismatic ? " m/s" : " rad/s";
        return joint.name + " at " + format("%.6g of at most %.6g", velocity, joint.max_velocity) +
               unit;
      });
    }
  }

  double samples_needed(const ConfigurationStep& step) {
    shapes_.set_step(step);
    double samples =
        std::max(step.base_distance_m, shapes_.step_length_bound()) / options_.max_step_m;
    samples = std::max(samples, step.base_angle_rad / options_.max_step_rad);
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      if (robot_.active_joint(i).type == JointType::kPrismatic) continue;
      const double largest =
          shapes_.joint_moves_shapes(i) ? options_.max_step_rad : kMaxSpinPerSample;
      samples = std::max(samples, std::abs(step.joints[i]) / largest);
    }
    return std::max(1.0, std::ceil(samples));
  }

  void check_ground_and_wheels() {
    if (std::isinf(options_.ground_z_m)) return;
    MotionSampler sampler(robot_, motion_);
    std::vector<Eigen::Isometry3d> poses, next;
    std::vector<WheelSlip> slips;
    for (std::size_t i = 0; i < vertices_; ++i) {
      if (!usable_.vertices[i]) continue;
      const int vertex = int(i);
      sampler.link_poses(vertex, 0.0, poses);
      check_pose(vertex, time(vertex), poses);
      if (!usable_.steps[i]) continue;
      slips.assign(wheels_.size(), WheelSlip{});
      const int samples = samples_per_step_[i];
      for (int k = 1; k <= samples; ++k) {
        const double fraction = double(k) / samples;
        const double time_s = sampler.time_s(vertex, fraction);
        sampler.link_poses(vertex, fraction, next);
        if (k < samples) check_pose(vertex, time_s, next);
        for (std::size_t w = 0; w < wheels_.size(); ++w) {
          const std::size_t link = std::size_t(wheels_[w].link());
          slips[w] = wheels_[w].slip(poses[link], next[link], slips[w]);
          check_slip(wheels_[w], slips[w], vertex, time_s, next[link]);
        }
        std::swap(poses, next);
      }
    }
  }

  void check_pose(int vertex, double time_s, const std::vector<Eigen::Isometry3d>& poses) {
    ++samples_;
    for (int i = 0; i < shapes_.size(); ++i) {
      const Eigen::Vector3d lowest = shapes_.lowest_point(i, poses);
      ground_tally(shapes_.link(i))
          .add(options_.ground_z_m - lowest.z(), vertex, time_s, lowest,
               [&] { return link_name(shapes_.link(i)); });
    }
    for (const WheelOnGround& wheel : wheels_) {
      const Eigen::Isometry3d& pose = poses[std::size_t(wheel.link())];
      const Eigen::Vector3d lowest = wheel.lowest_point(pose);
      const double height = lowest.z() - options_.ground_z_m;
      wheel_contact_.add(std::abs(height), vertex, time_s, lowest, [&] {
        return link_name(wheel.link()) + (height > 0.0 ? " in the air" : " in the ground");
      });
      wheel_tilt_.add(wheel.tilt_rad(pose), vertex, time_s, pose.translation(),
                      [&] { return link_name(wheel.link()); });
    }
  }

  void check_slip(const WheelOnGround& wheel, const WheelSlip& slip, int vertex, double time_s,
                  const Eigen::Isometry3d& world_from_wheel) {
    const auto name = [&] { return link_name(wheel.link()); };
    const Eigen::Vector3d point = wheel.lowest_point(world_from_wheel);
    lateral_slip_.add(std::abs(slip.lateral_m), vertex, time_s, point, name);
    longitudinal_slip_.add(std::abs(slip.longitudinal_m), vertex, time_s, point, name);
  }

  ViolationTally& ground_tally(int link) {
    switch (ground_role_[std::size_t(link)]) {
      case GroundRole::kWheel:
        return wheel_ground_penetration_;
      case GroundRole::kMount:
        return mount_ground_penetration_;
      case GroundRole::kOther:
        break;
    }
    return ground_penetration_;
  }

  // A link rigidly or otherwise behind a wheel counts as the wheel.
  void assign_ground_roles() {
    ground_role_.assign(robot_.links().size(), GroundRole::kOther);
    for (const WheelOnGround& wheel : wheels_)
      ground_role_[std::size_t(wheel.mount_link())] = GroundRole::kMount;
    for (const WheelOnGround& wheel : wheels_)
      ground_role_[std::size_t(wheel.link())] = GroundRole::kWheel;
    for (const Joint& joint : robot_.joints())
      if (ground_role_[std::size_t(joint.parent_link)] == GroundRole::kWheel)
        ground_role_[std::size_t(joint.child_link)] = GroundRole::kWheel;
  }

  const std::string& link_name(int link) const { return robot_.links()[std::size_t(link)].name; }

  CheckReport report() const {
    CheckReport report;
    report.configurations = int(vertices_);
    report.samples = samples_;
    report.feasible = true;
    for (const ViolationTally* tally :
         {&not_finite_, &configuration_size_, &time_order_, &step_size_, &base_orientation_,
          &joint_limits_, &velocity_limits_, &obstacle_distance_, &self_collision_,
          &ground_penetration_, &wheel_ground_penetration_, &mount_ground_penetration_,
          &wheel_contact_, &wheel_tilt_, &lateral_slip_, &longitudinal_slip_, &static_balance_,
          &torque_limits_}) {
      report.violations.push_back(tally->result());
      report.feasible = report.feasible && !tally->result().violated;
    }
    report.min_clearance_m = obstacle_distance_.worst();
    report.min_self_clearance_m = self_collision_.worst();
    if (!static_balance_.empty()) report.min_balance_margin = static_balance_.worst();
    if (!torque_limits_.empty()) report.max_torque_ratio = torque_limits_.worst();
    report.max_velocity_ratio = velocity_limits_.worst();
    report.max_contact_error_m = wheel_contact_.worst();
    return report;
  }

  enum class GroundRole { kOther, kWheel, kMount };

  ViolationTally higher(const char* name, const char* unit, double limit, double slack = 0.0) {
    return ViolationTally(name, unit, limit, Worse::kHigher, vertices_, slack);
  }
  ViolationTally lower(const char* name, const char* unit, double limit, double slack = 0.0) {
    return ViolationTally(name, unit, limit, Worse::kLower, vertices_, slack);
  }

  const Robot& robot_;
  const CollisionWorld& world_;
  const Motion& motion_;
  const CheckOptions& options_;
  const std::size_t vertices_;
  MovingShapes shapes_;
  std::vector<WheelOnGround> wheels_;
  std::vector<GroundRole> ground_role_;
  UsableParts usable_;
  std::vector<int> samples_per_step_;
  int samples_ = 0;

  ViolationTally not_finite_ = higher("not_finite", "count", 0.0);
  ViolationTally configuration_size_ = higher("configuration_size", "count", 0.0);
  // Zero is too little.
  ViolationTally time_order_ = lower("time_order", "s", 0.0, -std::numeric_limits<double>::min());
  ViolationTally step_size_ = higher("step_size", "count", options_.max_samples_per_step);
  ViolationTally base_orientation_ = higher("base_orientation", "1", options_.quaternion_tolerance);
  ViolationTally joint_limits_ = higher("joint_limits", "rad", options_.joint_tolerance_rad);
  ViolationTally velocity_limits_ =
      higher("velocity_limits", "ratio", 1.0, options_.velocity_tolerance);
  ViolationTally obstacle_distance_ = lower("obstacle_distance", "m", options_.min_clearance_m);
  ViolationTally self_collision_ = lower("self_collision", "m", options_.min_self_clearance_m);
  ViolationTally ground_penetration_ =
      higher("ground_penetration", "m", options_.ground_tolerance_m);
  ViolationTally wheel_ground_penetration_ =
      higher("wheel_ground_penetration", "m", options_.contact_tolerance_m);
  ViolationTally mount_ground_penetration_ =
      higher("mount_ground_penetration", "m", options_.wheel_mount_ground_tolerance_m);
  ViolationTally wheel_contact_ = higher("wheel_contact", "m", options_.contact_tolerance_m);
  ViolationTally wheel_tilt_ = higher("wheel_tilt", "rad", options_.max_wheel_tilt_rad);
  ViolationTally lateral_slip_ = higher("lateral_slip", "m", options_.max_lateral_slip_m);
  ViolationTally longitudinal_slip_ =
      higher("longitudinal_slip", "m", options_.max_longitudinal_slip_m);
  // Slack: what the linear programmes round.
  ViolationTally static_balance_ = lower("static_balance", "1", options_.min_balance_margin, 1e-6);
  ViolationTally torque_limits_ =
      higher("torque_limits", "ratio", 1.0,
             options_.enforce_torque_limits ? 1e-6 : std::numeric_limits<double>::infinity());
};

}  // namespace

CheckReport check_motion(const Robot& robot, const CollisionWorld& world, const Motion& motion,
                         const CheckOptions& options) {
  options.validate();
  if (motion.configurations.empty()) throw Error("an empty motion", "at least one configuration");
  if (motion.time_s.size() != motion.configurations.size())
    throw Error(std::to_string(motion.time_s.size()) + " times for " +
                    std::to_string(motion.configurations.size()) + " configurations",
                "one each");
  if (!motion.contacts.empty() && motion.contacts.size() != motion.configurations.size())
    throw Error(std::to_string(motion.contacts.size()) + " lists of contacts for " +
                    std::to_string(motion.configurations.size()) + " configurations",
                "one each, or none");
  if (!motion.wheels.empty() && std::isinf(options.ground_z_m))
    throw Error("wheels without ground", "a ground_z_m that is finite");
  return Check(robot, world, motion, options).run();
}

}  // namespace locograph
