#include <locograph/common/error.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/bent_legs.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace locograph {
namespace {

using Eigen::Vector3d;

constexpr double kFewBend = 0.06, kManyBend = 0.2;  // of two contacts, of more
constexpr double kOneSided_rad = 0.35;              // of the middle of a joint's limits
constexpr double kSplayed = 0.15;                   // to the side, of the stretched leg
constexpr double kFirstBend = 0.2;                  // of the way to the middle

/// Of joints whose limits are one-sided, a little of the way to the middle.
Eigen::VectorXd begun(const Robot& robot) {
  Eigen::VectorXd q = robot.neutral_configuration();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    const double middle = 0.5 * (joint.lower + joint.upper);
    if (joint.type != JointType::kRevolute || joint.upper - joint.lower > 2.0 * std::numbers::pi)
      continue;
    double& position = q[robot.base_configuration_size() + i];
    if (std::abs(middle) > kOneSided_rad) position += kFirstBend * (middle - position);
  }
  return q;
}

/// Reaches for places with the joints of legs, the base held.
class Legs {
 public:
  Legs(const Robot& robot, const std::vector<EndEffector>& effectors)
      : robot_(robot), effectors_(effectors), state_(robot), q_(begun(robot)) {
    RobotState neutral(robot);
    for (const EndEffector& effector : effectors) {
      Leg leg;
      leg.effector = &effector;
      leg.link = robot.link_index(effector.link);
      const auto support = robot.support(leg.link);
      if (support.empty()) throw Error("end effector " + effector.name, "on a link that moves");
      const Eigen::Isometry3d& pose = neutral.world_from_link(leg.link);
      const Vector3d hip = neutral.joint_origin(support.front());
      leg.place = pose * effector.point;
      leg.level = effector.kind == ContactKind::kSurface;
      leg.forward = pose.linear() * effector.forward;
      leg.forward.z() = 0.0;
      if (!(leg.forward.norm() > 0.1)) leg.forward = Vector3d::UnitX();
      leg.forward.normalize();
      if (!leg.level) leg.place.x() = hip.x();
      leg.stretched_m = stretched(leg, hip, support);
      const bool rolls = effector.kind == ContactKind::kWheel;
      if (!rolls && std::abs(leg.place.y() - hip.y()) > kSplayed * leg.stretched_m)
        leg.place.y() = hip.y();
      const double least_z = hip.z() - reach(leg, hip);
      const double round = contact_kind_entry(effector.kind).is_round() ? effector.radius_m : 0.0;
      floor_z_ = std::max(floor_z_, least_z - round);
      legs_.push_back(leg);
    }
    for (Leg& leg : legs_) {
      const bool is_round = contact_kind_entry(leg.effector->kind).is_round();
      leg.place.z() = floor_z_ + (is_round ? leg.effector->radius_m : 0.0);
    }
  }

  /// With what stands below the centre of mass.
  Eigen::VectorXd stand() {
    constexpr int kShifts = 4;
    bend();
    for (int k = 0; robot_.total_mass() > 0.0 && k < kShifts; ++k) {
      state_.update(q_.data());
      Vector3d shift = state_.center_of_mass();
      for (const Leg& leg : legs_) shift -= leg.place / static_cast<double>(legs_.size());
      for (Leg& leg : legs_) leg.place.head<2>() += shift.head<2>();
      bend();
    }
    if (robot_.floating_base()) q_[2] -= floor_z_;
    return q_;
  }

 private:
  void bend() {
    constexpr int kIterations = 200;
    constexpr double kDamping = 1e-4;
    const int size = robot_.active_joint_count();
    Eigen::MatrixXd normal(size, size);
    Eigen::VectorXd gradient(size);
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, robot_.tangent_size());
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      state_.update(q_.data());
      normal.setZero();
      gradient.setZero();
      double off = 0.0;
      for (const Leg& leg : legs_) {
        const Eigen::Isometry3d& pose = state_.world_from_link(leg.link);
        Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
        frame.translation() = leg.effector->point;
        state_.frame_jacobian(leg.link, frame, jacobian);
        Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
        error.head<3>() = leg.place - pose * leg.effector->point;
        if (leg.level) {
          const Vector3d normal_now = (pose.linear() * leg.effector->normal).normalized();
          const Vector3d forward_now = (pose.linear() * leg.effector->forward).normalized();
          error.tail<3>() = kArm_m * (normal_now.cross(Vector3d::UnitZ()) +
                                      Vector3d::UnitZ() * forward_now.cross(leg.forward).z());
          jacobian.bottomRows<3>() *= kArm_m;
        } else {
          jacobian.bottomRows<3>().setZero();
        }
        const auto by_joints = jacobian.rightCols(size);
        normal.noalias() += by_joints.transpose() * by_joints;
        gradient.noalias() += by_joints.transpose() * error;
        off += error.squaredNorm();
      }
      if (off < 1e-10) break;
      normal.diagonal().array() += kDamping;
      Eigen::VectorXd step = normal.ldlt().solve(gradient);
      step *= std::min(1.0, kStep_rad / std::max(1e-9, step.lpNorm<Eigen::Infinity>()));
      for (int i = 0; i < size; ++i) {
        const Joint& joint = robot_.active_joint(i);
        double& position = q_[robot_.base_configuration_size() + i];
        position = std::clamp(position + step[i], joint.lower, joint.upper);
      }
    }
  }

  struct Leg {
    const EndEffector* effector = nullptr;
    int link = -1;
    Vector3d place, forward;
    bool level = false;
    double stretched_m = 0.0;
  };

  static constexpr double kArm_m = 0.3, kStep_rad = 0.2;

  /// The longest way from the hip to what stands that one joint alone can make of the neutral leg.
  double stretched(const Leg& leg, const Vector3d& hip, std::span<const int> support) const {
    constexpr int kPositions = 20;
    RobotState state(robot_);
    double longest_m = 0.0;
    for (const int axis : support) {
      const int active = robot_.axes()[static_cast<std::size_t>(axis)].active;
      const Joint& joint = robot_.active_joint(active);
      const double lower = std::max(joint.lower, -std::numbers::pi);
      const double upper = std::min(joint.upper, std::numbers::pi);
      Eigen::VectorXd q = robot_.neutral_configuration();
      double& position = q[robot_.base_configuration_size() + active];
      const double neutral = position;
      for (int k = -1; k <= kPositions; ++k) {
        position = k < 0 ? neutral : lower + (upper - lower) * k / kPositions;
        state.update(q.data());
        longest_m = std::max(longest_m,
                             (state.world_from_link(leg.link) * leg.effector->point - hip).norm());
      }
    }
    return longest_m;
  }

  /// How far below its hip a leg is to reach.
  double reach(const Leg& leg, const Vector3d& hip) const {
    const double bend = effectors_.size() > 2 ? kManyBend : kFewBend;
    const double along_m = (1.0 - bend) * leg.stretched_m;
    const double beside_m = (leg.place - hip).head<2>().norm();
    return std::sqrt(std::max(0.0, along_m * along_m - beside_m * beside_m));
  }

  const Robot& robot_;
  const std::vector<EndEffector>& effectors_;
  RobotState state_;
  Eigen::VectorXd q_;
  std::vector<Leg> legs_;
  double floor_z_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

Eigen::VectorXd bent_legs(const Robot& robot, const std::vector<EndEffector>& effectors) {
  return Legs(robot, effectors).stand();
}

}  // namespace locograph
