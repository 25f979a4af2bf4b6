#pragma once
/// What the examples of check/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <documentation/example_world.h>
#include <locograph/check/balance_along.h>
#include <locograph/check/check_report.h>
#include <locograph/check/clearance_search.h>
#include <locograph/check/contact_check.h>
#include <locograph/check/judge.h>
#include <locograph/check/limits.h>
#include <locograph/check/motion_curve.h>
#include <locograph/check/numbers_check.h>
#include <locograph/check/violation_tally.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

#include "check/coman_plus_standing.h"

namespace locograph::documentation::in_check {

/// COMAN+ stands in a room with both soles on the floor, and moves an arm.
struct Standing {
  const test::Standing& standing = test::standing();
  const Robot& robot = *standing.robot;
  const World world = small_room();
  const Eigen::VectorXd &configuration = standing.home, &q0 = configuration;
  const Stance &stance = standing.feet, &both_feet = stance;
  const EndEffector &left_foot = standing.known[0], &right_foot = standing.known[1];
  const std::vector<Obstacle>& obstacles = world.obstacles;
  const RobotState state = state_at(robot, configuration);
  const std::vector<Eigen::Isometry3d> world_from_link = link_poses(state);
  const double time_s = 0.25;
  const int vertex = 1;
  const Eigen::Vector3d point = {0.0, 0.0, 0.5};
};

/// The motion, while it is being judged.
struct Judging : Standing {
  const Motion motion;
  const CheckOptions options;
  const JobControl job;
  const CollisionWorld exact{robot, world};
  MovingShapes shapes{robot};
  const MotionCurve curve{robot, motion};
  CheckContext context{robot, world, exact, motion, options, &shapes, curve, job};
  CheckReport report;

  explicit Judging(int vertices) : motion(standing.motion(vertices)) {
    for (const Stance& held : motion.stances) {
      context.stances.emplace_back(robot, world, held, options.known);
    }
    NumbersCheck(context).run();
  }
};

struct Context : Judging {
  Context() : Judging(6) {}
};

namespace check_context_h {
struct Context : in_check::Context {
  static void use(const JudgedStance&) {}
};
}  // namespace check_context_h
namespace balance_along_h {
struct Context : in_check::Context {
  ThreadPool threads{2};
};
}  // namespace balance_along_h
namespace balance_worker_h {
/// A motion of 33 vertices, half of which another worker has judged.
struct Context : Judging {
  BalanceFindings found{context.vertices()};
  Context() : Judging(33) { BalanceWorker(context).judge_vertices(0, 17, found); }
};
}  // namespace balance_worker_h
namespace robustness_h {
struct Context : in_check::Context {
  const Judge judge{standing.robot, world};
};
}  // namespace robustness_h
namespace loaded_contact_h {
struct Context : Standing {
  const Contact& contact = stance.contacts[0];
  const std::vector<Eigen::Vector2d> area;
  static void use(const LoadedContact&, const Eigen::Vector2d&) {}
};
}  // namespace loaded_contact_h
namespace nearby_balance_h {
struct Context : Standing {
  const std::vector<Contact>& contacts = stance.contacts;
  const BalanceOptions options;
  const BalanceCertificate certificate = certify_balance(robot, configuration, contacts, options);
  const double enough = 0.1;
};
}  // namespace nearby_balance_h
namespace bar_contact_h {
/// The left sole stands on a bar across it.
struct Context : Standing {
  const Contact& contact = stance.contacts[0];
  const Eigen::Isometry3d& world_from_link =
      Standing::world_from_link[robot.link_index(contact.effector.link)];
  const Bar bar = {.name = "rung",
                   .from = world_from_link * Eigen::Vector3d(0.0, -0.5, -0.02),
                   .to = world_from_link * Eigen::Vector3d(0.0, 0.5, -0.02),
                   .radius_m = 0.02};
};
}  // namespace bar_contact_h
namespace ball_rolling_h {
/// A ball that slides over the floor.
struct Context : Standing {
  const Contact touching = {.effector = {.name = "ball",
                                         .link = "l_sole",
                                         .kind = ContactKind::kPoint,
                                         .radius_m = 0.03,
                                         .friction = 0.5,
                                         .max_force_N = 100.0}};
  const JudgedContact contact = JudgedStance(robot, World(), {{touching}}, {}).contacts[0];
  const SkinPath::PoseAt pose_at = [](double s) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.1 * s, 0.0, 0.03));
  };
};
}  // namespace ball_rolling_h
namespace check_report_h {
struct Context : in_check::Context {
  const Judge judge{standing.robot, world};
};
}  // namespace check_report_h
namespace clearance_search_h {
struct Context : in_check::Context {
  static ViolationTally tally(const char* what, Worse worse) { return {what, "m", 0.0, worse, 6}; }
  ViolationTally obstacle_distance = tally("obstacle_distance", Worse::kLower);
  ViolationTally ground_penetration = tally("ground_penetration", Worse::kHigher);
  ViolationTally touching_depth = tally("touching_depth", Worse::kHigher);
  ViolationTally self_collision = tally("self_collision", Worse::kLower);
};
}  // namespace clearance_search_h
namespace extent_h {
struct Context {
  const std::vector<Eigen::Vector3d> path = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.2}, {0.3, 0.1, 0.0}};
};
}  // namespace extent_h
namespace judge_h {
struct Context : in_check::Context {
  const std::shared_ptr<const Robot>& robot = standing.robot;
  Context() { write_room_files(); }
};
}  // namespace judge_h
namespace motion_h {
struct Context : Standing {
  const Eigen::VectorXd q1 = standing.motion(2).configurations[1];
};
}  // namespace motion_h
namespace polynomial_h {
struct Context {
  const double c0 = -0.25, c1 = 0.0, c2 = 1.0, c3 = 0.0;
  static void look_at(double) {}
};
}  // namespace polynomial_h
namespace moving_shapes_h {
struct Context : in_check::Context {
  std::vector<Eigen::Isometry3d> poses_at_0_25, poses_at_0_50;
  Context() {
    MotionSampler sampler(curve);
    sampler.link_poses(0, 0.25, poses_at_0_25);
    sampler.link_poses(0, 0.5, poses_at_0_50);
  }
};
}  // namespace moving_shapes_h
namespace obstacle_path_h {
struct Context : in_check::Context {
  static void look_at(double) {}
};
}  // namespace obstacle_path_h
namespace plan_ends_h {
struct Context : in_check::Context {
  const Stance on_the_floor = both_feet, on_top = raised();
  Stance raised() const {
    Stance stance = both_feet;
    for (Contact& contact : stance.contacts) contact.position.z() += 0.2;
    return stance;
  }
};
}  // namespace plan_ends_h
namespace violation_tally_h {
struct Context : in_check::Context {
  const double tilt = 0.1;
  const std::string wheel_name = "wheel_1";
};
}  // namespace violation_tally_h
namespace wheel_rolling_h {
/// A wheel of CENTAURO that is pushed forward without turning.
struct Context {
  const Robot& robot = *centauro();
  const Eigen::VectorXd before = robot.named_configuration("home"), now = moved();
  const std::vector<Eigen::Isometry3d> poses_before = link_poses(state_at(robot, before)),
                                       poses = link_poses(state_at(robot, now));
  const Stance wheels = {.contacts = {{.effector = {.name = "wheel_1",
                                                    .link = "wheel_1",
                                                    .kind = ContactKind::kWheel,
                                                    .radius_m = 0.078,
                                                    .friction = 0.5,
                                                    .max_force_N = 1000.0}}}};
  const JudgedContact contact = JudgedStance(robot, World(), wheels, {}).contacts[0];
  Eigen::VectorXd moved() const {
    Eigen::VectorXd q = before;
    q[0] += 0.01;
    return q;
  }
};
}  // namespace wheel_rolling_h

}  // namespace locograph::documentation::in_check
