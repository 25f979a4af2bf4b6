#include <locograph/common/error.h>
#include <locograph/execution/state_estimator.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/robots/statics.h>

#include <algorithm>

namespace locograph {
namespace {

constexpr double kPressed = 0.05;     // of the weight, from which on a contact counts in full
constexpr double kDrawn_s = 0.02;     // in which the base is drawn to its contacts
constexpr double kAgrees_m_s = 0.02;  // contacts that are off by this count half
constexpr int kVotes = 4;

/// The point, moved along the normal so that the contact is closed.
Eigen::Vector3d closed(const Contact& contact, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d normal = normal_at(contact, centre);
  Eigen::Vector3d touched = contact.position;
  if (contact.bar && is_ball(contact.effector)) {
    touched += contact.bar->radius_m * (normal - contact.normal.normalized());
  }
  return centre + (normal.dot(touched - centre) + rolling_radius_m(contact.effector)) * normal;
}

}  // namespace

void require_floating_base(const Robot& robot) {
  if (!robot.floating_base())
    throw Error("robot " + robot.name() + " has a fixed base", "one that floats");
}

StateEstimator::StateEstimator(const Robot& robot, std::span<const EndEffector> effectors,
                               const Eigen::VectorXd& start, double cycle_s)
    : effectors_(effectors),
      cycle_s_(cycle_s),
      pressed_N_(kPressed * robot.total_mass() * standard_gravity().norm()),
      state_(robot),
      configuration_(start),
      velocity_(Eigen::VectorXd::Zero(robot.tangent_size())),
      jacobian_(6, robot.tangent_size()) {
  require_floating_base(robot);
  state_.update(start.data());
  for (const EndEffector& effector : effectors) {
    Support& own = supports_.emplace_back();
    own.link = robot.link_index(effector.link);
    own.anchor = state_.world_from_link(own.link) * effector.point;
  }
}

void StateEstimator::update(const SensorReadings& readings,
                            std::span<const ContactCommand> contacts) {
  const Eigen::Index joints = readings.joints.size();
  configuration_.segment<4>(3) = readings.attitude.coeffs();
  configuration_.tail(joints) = readings.joints;
  velocity_.head<3>().setZero();
  velocity_.segment<3>(3) = readings.angular_velocity;
  velocity_.tail(joints) = readings.joint_velocities;
  state_.update(configuration_.data());
  look(readings, contacts);
  find_velocity();
  find_place();
  velocity_.head<3>() = readings.attitude.conjugate() * moves_;
}

void StateEstimator::look(const SensorReadings& readings,
                          std::span<const ContactCommand> contacts) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  for (std::size_t e = 0; e < supports_.size(); ++e) {
    Support& own = supports_[e];
    const ContactCommand& command = contacts[e];
    const Contact* held = command.held && command.touches ? &command.held->contact() : nullptr;
    if (!started_) own.since_start = command.held != nullptr;
    own.weight = held ? std::clamp(readings.pressing_N[e] / pressed_N_, 0.0, 1.0) : 0.0;
    if (own.weight == 0.0) {
      own.contact = nullptr;
      continue;
    }
    own.centre = state_.world_from_link(own.link) * effectors_[e].point;
    frame.translation() = effectors_[e].point;
    state_.frame_jacobian(own.link, frame, jacobian_);
    const Eigen::Matrix<double, 6, 1> moves = jacobian_ * velocity_;
    own.moves = moves.head<3>();
    own.rolls = rolling_radius_m(effectors_[e]) *
                Eigen::Vector3d(moves.tail<3>()).cross(normal_at(*held, own.centre));
    // Contacts go on through a change of stance.
    if (own.contact == nullptr && !own.since_start) own.anchor = own.centre;
    own.since_start = false;
    own.contact = held;
  }
  started_ = true;
}

void StateEstimator::find_velocity() {
  Eigen::Vector3d mean = moves_;
  for (int round = 0; round < kVotes; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (const Support& own : supports_) {
      if (own.weight == 0.0) continue;
      const Eigen::Vector3d says = own.rolls - own.moves;
      const double off = (says - mean).norm() / kAgrees_m_s;
      const double weight = own.weight / (round == 0 ? 1.0 : 1.0 + off * off);
      sum += weight * says;
      weights += weight;
    }
    if (weights == 0.0) return;
    mean = sum / weights;
  }
  moves_ = mean;
}

void StateEstimator::find_place() {
  const Eigen::Vector3d by = cycle_s_ * moves_;
  Eigen::Vector3d off = Eigen::Vector3d::Zero();
  double weights = 0.0;
  for (Support& own : supports_) {
    if (own.weight == 0.0) continue;
    own.anchor += cycle_s_ * own.rolls;
    own.anchor = closed(*own.contact, own.anchor);
    off += own.weight * (own.anchor - own.centre - by);
    weights += own.weight;
  }
  configuration_.head<3>() += by;
  if (weights > 0.0) configuration_.head<3>() += (cycle_s_ / kDrawn_s) * off / weights;
}

}  // namespace locograph
