#include <locograph/common/deadline.h>
#include <locograph/common/error.h>
#include <locograph/planners/plan/posture_check.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace locograph {
namespace {

/// Distances matter up to here; beyond it they are not computed.
constexpr double kCutoff_m = 0.05;
/// Further away than any robot reaches.
constexpr double kElsewhere_m = 1e4;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// How much of the unit counts as one violation.
double scale_of(const Violation& violation) {
  return violation.unit == "m" ? 0.01 : violation.unit == "count" ? 1e-3 : 0.1;
}

double excess(const Violation& v) { return std::abs(v.worst - v.limit) / scale_of(v); }

class Check {
 public:
  Check(const Robot& robot, std::span<const PlacedContact> contacts,
        const PostureCheckOptions& options)
      : robot_(robot), contacts_(contacts), options_(options) {}

  PostureReport report;

  bool numbers(const Eigen::VectorXd& q) {
    double bad = std::abs(static_cast<double>(q.size() - robot_.configuration_size()));
    for (const double value : q) bad += std::isfinite(value) ? 0.0 : 1.0;
    add("not_finite", "count", bad, 0.0, bad > 0.0, "the configuration");
    if (bad > 0.0) return false;
    const double norm = robot_.floating_base() ? q.segment<4>(3).norm() : 1.0;
    const double off = std::abs(norm - 1.0);
    add("base_orientation", "1", off, options_.quaternion_tolerance,
        !(off <= options_.quaternion_tolerance), "norm of the quaternion " + number(norm));
    return norm > 1e-3;
  }

  void contacts(const RobotState& state) {
    Farthest position, orientation;
    for (const PlacedContact& placed : contacts_) {
      const Eigen::Isometry3d& pose = state.world_from_link(robot_.link_index(placed.contact.link));
      const Eigen::Vector3d point = pose * placed.contact.point;
      position.add((point - placed.position).norm(), placed.contact.link, point);
      orientation.add(turned(placed, pose.linear()), placed.contact.link, point);
    }
    add("contact_position", "m", position, options_.contact_tolerance_m);
    add("contact_orientation", "rad", orientation, options_.contact_tolerance_rad);
  }

  void joint_limits(const Eigen::VectorXd& q) {
    Farthest farthest;
    const char* unit = "rad";
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      const Joint& joint = robot_.active_joint(i);
      const double at = q[robot_.base_configuration_size() + i];
      const double over = std::max({0.0, joint.lower - at, at - joint.upper});
      if (farthest.add(over, joint.name, Eigen::Vector3d::Zero())) {
        unit = joint.type == JointType::kPrismatic ? "m" : "rad";
      }
    }
    add("joint_limits", unit, farthest, options_.joint_tolerance_rad);
  }

  void obstacles(const CollisionWorld* world, std::span<const Eigen::Isometry3d> poses,
                 const std::vector<bool>& touching) {
    CollisionWorld::Closest free, touched;
    free.distance_m = touched.distance_m = kCutoff_m;
    if (world != nullptr) {
      free = world->environment_distance(only(poses, touching, false), 0.0);
      touched = world->environment_distance(only(poses, touching, true), 0.0);
    }
    add("obstacle_distance", "m", free.distance_m, options_.min_clearance_m,
        free.distance_m < options_.min_clearance_m, between(free), free.point);
    touching_depth_.add(std::max(0.0, -touched.distance_m), between(touched), touched.point);
  }

  void ground(const MovingShapes& shapes, std::span<const Eigen::Isometry3d> poses,
              const std::vector<bool>& touching) {
    Farthest deepest;
    for (int i = 0; i < shapes.size(); ++i) {
      const std::size_t link = static_cast<std::size_t>(shapes.link(i));
      const Eigen::Vector3d lowest = shapes.lowest_point(i, poses);
      (touching[link] ? touching_depth_ : deepest)
          .add(std::max(0.0, options_.ground_z_m - lowest.z()), robot_.links()[link].name, lowest);
    }
    add("touching_depth", "m", touching_depth_, options_.touching_depth_m);
    add("ground_penetration", "m", deepest, options_.ground_tolerance_m);
  }

  void self_collision(const CollisionWorld& world, std::span<const Eigen::Isometry3d> poses) {
    const CollisionWorld::Closest closest = world.self_distance(poses);
    add("self_collision", "m", closest.distance_m, options_.min_self_clearance_m,
        closest.distance_m < options_.min_self_clearance_m, between(closest), closest.point);
  }

  bool holds() const {
    return std::none_of(report.violations.begin(), report.violations.end(),
                        [](const Violation& v) { return v.violated; });
  }

  void balance(const Eigen::VectorXd& q) {
    const Stopwatch watch;
    BalanceOptions options;
    options.enforce_torque_limits = options_.enforce_torque_limits;
    report.balance = certify_balance(robot_, q, loaded_contacts(contacts_), options);
    report.certified = true;
    report.balance_s = watch.seconds();
    const BalanceCertificate& found = report.balance;
    add("balance", "1", found.margin, options_.min_balance_margin,
        !found.balanced || !(found.margin >= options_.min_balance_margin), found.limiting);
    // Where torques are not enforced their ratio is told, not judged.
    const bool over = options_.enforce_torque_limits && found.max_torque_ratio > 1.0 + 1e-6;
    add("torque_limits", "ratio", found.max_torque_ratio, 1.0, found.balanced && over, "");
  }

 private:
  /// The largest of several amounts, and whose it is.
  struct Farthest {
    double amount = 0.0;
    std::string whose;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();

    bool add(double value, const std::string& of, const Eigen::Vector3d& at) {
      if (!(value > amount)) return false;
      amount = value;
      whose = of;
      point = at;
      return true;
    }
  };

  static double turned(const PlacedContact& placed, const Eigen::Matrix3d& world_from_link) {
    const ContactDescription& contact = placed.contact;
    const Eigen::Vector3d normal = world_from_link * contact.normal;
    const Eigen::Vector3d forward = world_from_link * contact.forward;
    switch (contact.kind) {
      case WrenchKind::kPoint:
        return 0.0;
      case WrenchKind::kRung:
        return angle_between(normal.cross(forward), placed.normal.cross(*placed.forward));
      case WrenchKind::kSurface:
        break;
    }
    const double tilt = angle_between(normal, placed.normal);
    if (!placed.forward) return tilt;
    return std::max(tilt,
                    angle_between(normal.cross(forward), placed.normal.cross(*placed.forward)));
  }

  /// The poses, with the links of the other sort taken out of the way.
  static std::vector<Eigen::Isometry3d> only(std::span<const Eigen::Isometry3d> poses,
                                             const std::vector<bool>& touching, bool wanted) {
    std::vector<Eigen::Isometry3d> result(poses.begin(), poses.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (touching[i] != wanted) result[i].translation().z() += kElsewhere_m;
    }
    return result;
  }

  std::string between(const CollisionWorld::Closest& closest) const {
    if (closest.link < 0) return "";
    return robot_.links()[static_cast<std::size_t>(closest.link)].name + " and " + closest.what;
  }

  void add(const char* name, const char* unit, const Farthest& farthest, double limit) {
    add(name, unit, farthest.amount, limit, !(farthest.amount <= limit), farthest.whose,
        farthest.point);
  }
  void add(const char* name, const char* unit, double worst, double limit, bool violated,
           const std::string& what, const Eigen::Vector3d& point = Eigen::Vector3d::Zero()) {
    Violation violation;
    violation.constraint = name;
    violation.unit = unit;
    violation.worst = worst;
    violation.limit = limit;
    violation.violated = violated;
    violation.count = violated ? 1 : 0;
    violation.what = what;
    violation.at_point = point;
    report.violations.push_back(std::move(violation));
  }

  const Robot& robot_;
  std::span<const PlacedContact> contacts_;
  const PostureCheckOptions& options_;
  Farthest touching_depth_;
};

std::vector<Eigen::Isometry3d> link_poses(const RobotState& state) {
  std::vector<Eigen::Isometry3d> poses;
  for (int link = 0; link < static_cast<int>(state.robot().links().size()); ++link) {
    poses.push_back(state.world_from_link(link));
  }
  return poses;
}

CollisionWorldOptions near_only(const Robot& robot) {
  CollisionWorldOptions options;
  options.cutoff_m = kCutoff_m;
  // The ground as a sensor saw it is judged as the ground.
  for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
    options.ignore_floor_links.push_back(link);
  }
  return options;
}

}  // namespace

const Violation& PostureReport::worst() const {
  const Violation* most = &violations.front();
  for (const Violation& v : violations) {
    if (v.violated && (!most->violated || excess(v) > excess(*most))) most = &v;
  }
  return *most;
}

const Violation& PostureReport::constraint(const std::string& name) const {
  for (const Violation& v : violations) {
    if (v.constraint == name) return v;
  }
  throw Error("no constraint '" + name + "' in the report");
}

std::string violation_text(const Violation& v) {
  const std::string unit = v.unit == "1" ? "" : " " + v.unit;
  return v.constraint + (v.what.empty() ? "" : " (" + v.what + ")") + " is " + number(v.worst) +
         unit + ", limit " + number(v.limit) + unit;
}

PostureChecker::PostureChecker(std::shared_ptr<const Robot> robot,
                               std::shared_ptr<const octomap::OcTree> map,
                               std::vector<Obstacle> obstacles)
    : robot_(std::move(robot)),
      empty_(map == nullptr && obstacles.empty()),
      world_(*robot_, std::move(map), std::move(obstacles), near_only(*robot_)),
      shapes_(*robot_) {}

PostureReport PostureChecker::check(const Eigen::VectorXd& configuration,
                                    std::span<const PlacedContact> contacts,
                                    const PostureCheckOptions& options) const {
  require_sound_contacts(*robot_, contacts);
  const Stopwatch watch;
  Check check(*robot_, contacts, options);
  if (!check.numbers(configuration)) return check.report;
  RobotState state(*robot_);
  Eigen::VectorXd q = configuration;
  if (robot_->floating_base()) q.segment<4>(3).normalize();
  state.update(q.data());
  const std::vector<Eigen::Isometry3d> poses = link_poses(state);
  const std::vector<bool> touching = touching_links(*robot_, contacts);
  check.contacts(state);
  check.joint_limits(q);
  check.obstacles(empty_ ? nullptr : &world_, poses, touching);
  check.ground(shapes_, poses, touching);
  check.self_collision(world_, poses);
  check.report.geometry_s = watch.seconds();
  if (!options.certify_only_if_rest_holds || check.holds()) check.balance(q);
  check.report.feasible = check.report.certified && check.holds();
  return check.report;
}

double PostureChecker::self_distance_m(const RobotState& state) const {
  return world_.self_distance(link_poses(state)).distance_m;
}

}  // namespace locograph
