#include <locograph/common/error.h>
#include <locograph/execution/joint_impedance_controller.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/robots/statics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kSomeEffort = 100.0;  // N m, of a joint that has no limit

}  // namespace

JointImpedanceController::JointImpedanceController(const Robot& robot,
                                                   std::span<const EndEffector> effectors,
                                                   const JointImpedanceOptions& options)
    : robot_(robot),
      options_(options),
      planned_(robot),
      dynamics_(robot),
      effectors_(effectors.begin(), effectors.end()),
      mass_(Eigen::MatrixXd::Zero(robot.tangent_size(), robot.tangent_size())),
      factor_(robot.tangent_size()) {
  for (const EndEffector& effector : effectors_) {
    require_sound_effector(robot, effector);
    links_.push_back(robot.link_index(effector.link));
  }
  stiffness_ = damping_ = error_ = force_ = full_ = Eigen::VectorXd::Zero(robot.tangent_size());
  torques_ = Eigen::VectorXd::Zero(robot.active_joint_count());
}

void JointImpedanceController::feed_forward(const CurvePoint& reference,
                                            std::span<const ContactCommand> contacts) {
  dynamics_.inverse_dynamics(planned_, reference.velocity, reference.acceleration, {}, full_);
  for (std::size_t e = 0; e < effectors_.size(); ++e) {
    if (!contacts[e].held) continue;
    const Contact& contact = contacts[e].held->contact();
    const EndEffector& effector = effectors_[e];
    const Eigen::Isometry3d& world_from_link = planned_.world_from_link(links_[e]);
    const Eigen::Vector3d centre = world_from_link * effector.point;
    Eigen::Matrix3d axes = axes_in_world(contact);
    Eigen::Vector3d touching = centre;
    if (is_ball(effector)) {
      const Eigen::Vector3d normal = BallTrack(contact).normal(centre);
      axes = Eigen::Quaterniond::FromTwoVectors(axes.col(2), normal).toRotationMatrix() * axes;
      touching -= effector.radius_m * normal;
    } else if (effector.kind == ContactKind::kWheel) {
      touching -= effector.radius_m * axes.col(2);
    } else if (contact_kind_entry(effector.kind).axes_on_link) {
      axes = world_from_link.linear() * axes_in_link(effector);
    }
    PointWrench wrench;
    wrench.link = links_[e];
    wrench.point = world_from_link.inverse() * touching;
    wrench.force = axes * contacts[e].wrench.head<3>();
    wrench.moment = axes * contacts[e].wrench.tail<3>();
    add_wrench_torques(planned_, wrench, -1.0, full_);
  }
}

const Eigen::VectorXd& JointImpedanceController::torques(const Eigen::VectorXd& q,
                                                         const Eigen::VectorXd& v,
                                                         const CurvePoint& reference,
                                                         std::span<const ContactCommand> contacts) {
  planned_.update(reference.configuration.data());
  feed_forward(reference, contacts);
  dynamics_.mass_matrix(planned_, mass_);
  robot_.difference(q.data(), reference.configuration.data(), error_.data());
  const int base = robot_.base_tangent_size();
  force_.setZero();
  for (int i = 0; i < torques_.size(); ++i) {
    const int k = base + i;
    const double effort = robot_.active_joint(i).max_effort;
    stiffness_[k] = options_.effort_per_rad * (std::isfinite(effort) ? effort : kSomeEffort);
    damping_[k] = 2.0 * options_.damping_ratio * stiffness_[k] / options_.joint_rate;
    force_[k] = stiffness_[k] * error_[k] + damping_[k] * (reference.velocity[k] - v[k]);
  }
  // What they do to velocities in this cycle takes part in what they are at its end.
  const double cycle = options_.cycle_s;
  for (int i = 0; i < torques_.size(); ++i) {
    const int k = base + i;
    mass_(k, k) += cycle * (damping_[k] + cycle * stiffness_[k]);
  }
  factor_.compute(mass_);
  error_ = cycle * force_;
  factor_.solveInPlace(error_);
  for (int i = 0; i < torques_.size(); ++i) {
    const int k = base + i;
    const double effort = robot_.active_joint(i).max_effort;
    const double spring = force_[k] - (damping_[k] + cycle * stiffness_[k]) * error_[k];
    torques_[i] = std::clamp(full_[k] + spring, -effort, effort);
  }
  return torques_;
}

}  // namespace locograph
