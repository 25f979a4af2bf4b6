#pragma once
/// What the examples of check/ take for granted.

#include <locograph/check/balance_along.h>
#include <locograph/check/check_report.h>
#include <locograph/check/clearance_search.h>
#include <locograph/check/contact_check.h>
#include <locograph/check/judge.h>
#include <locograph/check/limits.h>
#include <locograph/check/motion_rates.h>
#include <locograph/check/numbers_check.h>
#include <locograph/check/violation_tally.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

namespace locograph::documentation::in_check {

extern const Robot robot;
extern const World world;
extern const RobotState state;
extern const Eigen::VectorXd q0, q1, from, to, configuration;
extern const Stance stance, both_feet;
extern const EndEffector left_foot, right_foot;
extern const Motion motion;
extern const CheckOptions options;
extern CheckContext context;
extern CheckReport report;
extern const std::vector<Obstacle> obstacles;
extern const std::vector<Eigen::Isometry3d> world_from_link;
extern const double time_s;
extern const int vertex;
extern const Eigen::Vector3d point;

namespace check_context_h {
extern const JobControl job;
extern const CollisionWorld exact;
extern MovingShapes shapes;
extern MotionSampler sampler;
void use(const JudgedStance& stance);
}  // namespace check_context_h
namespace balance_along_h {
extern ThreadPool threads;
}
namespace balance_worker_h {
extern const MotionRates rates;
extern BalanceFindings found;
}  // namespace balance_worker_h
namespace loaded_contact_h {
extern const Contact contact;
extern const std::vector<Eigen::Vector2d> area;
void use(const LoadedContact& contact, const Eigen::Vector2d& corner);
}  // namespace loaded_contact_h
namespace nearby_balance_h {
extern const std::vector<Contact> contacts;
extern const BalanceCertificate certificate;
extern const double enough;
extern const BalanceOptions options;
}  // namespace nearby_balance_h
namespace bar_contact_h {
extern const Contact contact;
extern const Bar bar;
extern const Eigen::Isometry3d world_from_link;
}  // namespace bar_contact_h
namespace check_report_h {
extern const Judge judge;
}
namespace clearance_search_h {
extern ViolationTally obstacle_distance, ground_penetration, touching_depth, self_collision;
}
namespace extent_h {
extern const std::vector<Eigen::Vector3d> path;
}
namespace judge_h {
extern const std::shared_ptr<const Robot> robot;
}
namespace moving_shapes_h {
extern const std::vector<Eigen::Isometry3d> poses_at_0_25, poses_at_0_50;
}
namespace plan_ends_h {
extern const Stance on_the_floor, on_top;
}
namespace violation_tally_h {
extern const double tilt;
extern const std::string wheel_name;
}  // namespace violation_tally_h
namespace wheel_rolling_h {
extern const JudgedContact contact;
extern const std::vector<Eigen::Isometry3d> poses_before, poses;
}  // namespace wheel_rolling_h

}  // namespace locograph::documentation::in_check
