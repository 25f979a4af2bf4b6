#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/execution/whole_body_controller.h>
#include <locograph/robots/rolling_ball.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kAhead_s = 1e-4;      // in which Jacobians are seen to change
constexpr double kTurning = 0.1;       // weight of rotations beside that of places
constexpr double kMomentPart = 30.0;   // of regularisation: moments beside forces [1/m^2]
constexpr double kLeastShare = 0.02;   // of what bears next to nothing
constexpr double kMostWeights = 2.0;   // that one contact bears
constexpr double kOverEffort = 100.0;  // cost of torques beyond the efforts, of one times those
constexpr double kOverEffortTold = 1e-3;
constexpr double kLittle = 1e-3;
/// Where the base misses more than this part of the weight, contacts give more of their friction:
/// all of it within so many cycles, and less again when it is not missed.
constexpr double kMissing = 0.005, kReserveUp = 1.0 / 20, kReserveDown = 1.0 / 500;
constexpr double kLine_m = 0.005;  // soles that bear on less than twice this may turn about it
constexpr double kMostSteering_rad = 0.3;
constexpr double kRolling_m_s = 0.02;  // from which on steering gets a wheel anywhere
constexpr int kRounds = 3;             // of limits that are taken in
constexpr int kBaseRows = 6;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d rotation_of(const Eigen::VectorXd& q) {
  return Eigen::Quaterniond(q[6], q[3], q[4], q[5]).toRotationMatrix();
}

/// The rotation vector, in the world, from one rotation to another.
Eigen::Vector3d turn(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::AngleAxisd turn(to * from.transpose());
  return turn.angle() * turn.axis();
}

}  // namespace

void WholeBodyOptions::validate() const {
  const auto not_negative = [](double value, const char* name) {
    check_option(value >= 0.0 && std::isfinite(value), name, "0 or more");
  };
  const auto share = [](double value, const char* name) {
    check_option(value > 0.0 && value <= 1.0, name, "above 0, at most 1");
  };
  not_negative(contact_weight, "contact_weight");
  not_negative(centre_weight, "centre_weight");
  not_negative(swing_weight, "swing_weight");
  not_negative(base_weight, "base_weight");
  check_option(joint_weight > 0.0 && std::isfinite(joint_weight), "joint_weight", "above 0");
  not_negative(limit_weight, "limit_weight");
  not_negative(centre_rate, "centre_rate");
  not_negative(swing_rate, "swing_rate");
  not_negative(base_rate, "base_rate");
  not_negative(joint_rate, "joint_rate");
  not_negative(tilt_rate, "tilt_rate");
  not_negative(contact_damping, "contact_damping");
  not_negative(wheel_weight, "wheel_weight");
  not_negative(wheel_rate, "wheel_rate");
  not_negative(steering_per_m, "steering_per_m");
  not_negative(seeking_m_s, "seeking_m_s");
  not_negative(seeking_rate, "seeking_rate");
  check_option(regularisation > 0.0 && std::isfinite(regularisation), "regularisation", "above 0");
  check_option(least_force >= 0.0 && least_force < 1.0, "least_force", "0 or more, below 1");
  share(torque, "torque");
  check_option(limit_horizon_s > 0.0 && std::isfinite(limit_horizon_s), "limit_horizon_s",
               "above 0");
}

struct WholeBodyController::Effector {
  EndEffector effector;
  int link = 0;
  bool surface = false, round = false, ball = false, grasp = false;
  Eigen::Vector3d axle = Eigen::Vector3d::UnitY();  ///< of a wheel, in its link
  int wheel_joint = -1;                             ///< the active joint that turns it
  std::vector<int> components;                      ///< of its wrenches
  int cone_rows = 0;
  int unknown = 0, row = 0;  ///< where those of the programme begin
  Jacobian jacobian, ahead;  ///< of the point of the end effector
  Vector6 velocity, drift;   ///< of that point; J' v
  Eigen::MatrixXd touching;  ///< jacobian of what touches, 6 x n; along its axes
  Eigen::MatrixXd along_axes;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vector6 wrench = Vector6::Zero();
  bool held = false;
};

WholeBodyController::~WholeBodyController() = default;

WholeBodyController::WholeBodyController(const Robot& robot, std::span<const EndEffector> effectors,
                                         const WholeBodyOptions& options)
    : robot_(robot),
      options_(options),
      weight_N_(robot.total_mass() * standard_gravity().norm()),
      state_(robot),
      ahead_(robot),
      planned_(robot),
      dynamics_(robot),
      factor_(robot.tangent_size()) {
  options.validate();
  if (!robot.floating_base()) throw Error("a whole-body controller needs a floating base");
  const int n = robot.tangent_size(), joints = robot.active_joint_count();
  int unknowns = 0, rows = 0;
  for (const EndEffector& given : effectors) {
    require_sound_effector(robot, given);
    Effector& own = effectors_.emplace_back();
    own.effector = given;
    own.link = robot.link_index(given.link);
    own.surface = given.kind == ContactKind::kSurface;
    own.grasp = given.kind == ContactKind::kGrasp;
    own.ball = is_ball(given);
    own.round = own.ball || given.kind == ContactKind::kWheel;
    if (given.kind == ContactKind::kWheel) {
      const Joint& joint = robot.joints()[static_cast<std::size_t>(
          robot.links()[static_cast<std::size_t>(own.link)].parent_joint)];
      own.axle = joint.axis;
      own.wheel_joint = joint.index;
    }
    const HeldContact any(Contact{.effector = given, .forward = Eigen::Vector3d::UnitX()}, {});
    for (const int component : any.cone().components()) own.components.push_back(component);
    own.cone_rows = any.cone().rows();
    own.unknown = unknowns;
    own.row = rows;
    const int components = static_cast<int>(own.components.size());
    unknowns += components;
    rows += own.cone_rows;
    own.jacobian = own.ahead = Jacobian::Zero(6, n);
    own.touching = Eigen::MatrixXd::Zero(6, n);
    own.along_axes = Eigen::MatrixXd::Zero(components, n);
  }
  torque_rows_from_ = rows;
  qp_ = std::make_unique<DenseQp>(unknowns + 1, rows + 2 * joints);
  for (int i = 0; i < joints; ++i) effort_.push_back(robot.active_joint(i).max_effort);
  joint_taken_.assign(static_cast<std::size_t>(joints), 0);
  torque_taken_.assign(static_cast<std::size_t>(joints), 0);
  const int most = static_cast<int>(effectors.size()) * 9 + 3 + joints;
  rows_ = Eigen::MatrixXd::Zero(most, n);
  wanted_ = Eigen::VectorXd::Zero(most);
  diagonal_ = gradient_ = bias_ = error_ = planned_force_ = acceleration_ = torques_full_ =
      small_step_ = Eigen::VectorXd::Zero(n);
  ahead_configuration_ = Eigen::VectorXd::Zero(robot.configuration_size());
  torques_ = Eigen::VectorXd::Zero(joints);
  mass_ = cost_ = Eigen::MatrixXd::Zero(n, n);
  by_base_ = Eigen::MatrixXd::Zero(n, kBaseRows);
  mass_by_base_ = torque_by_base_ = Eigen::MatrixXd::Zero(joints, kBaseRows);
  base_rows_ = Eigen::MatrixXd::Zero(kBaseRows, unknowns);
  by_wrench_ = Eigen::MatrixXd::Zero(kBaseRows, unknowns);
  torque_rows_ = Eigen::MatrixXd::Zero(joints, unknowns);
  centre_jacobian_.setZero(3, n);
  three_rows_.setZero(3, n);
}

const Eigen::Matrix<double, 6, 1>& WholeBodyController::wrench(int effector) const {
  return effectors_.at(static_cast<std::size_t>(effector)).wrench;
}

/// jacobian * acceleration of the robot should be this.
void WholeBodyController::add_rows(
    const Eigen::Ref<const Eigen::Matrix<double, 3, Eigen::Dynamic>>& jacobian,
    const Eigen::Vector3d& acceleration, double weight) {
  const double root = std::sqrt(weight);
  rows_.middleRows<3>(used_) = root * jacobian;
  wanted_.segment<3>(used_) = root * acceleration;
  used_ += 3;
}

/// The same along one direction.
void WholeBodyController::add_row(
    const Eigen::Vector3d& direction,
    const Eigen::Ref<const Eigen::Matrix<double, 3, Eigen::Dynamic>>& jacobian, double acceleration,
    double weight) {
  const double root = std::sqrt(weight);
  rows_.row(used_).noalias() = root * direction.transpose() * jacobian;
  wanted_[used_] = root * acceleration;
  ++used_;
}

void WholeBodyController::follow_joints_and_base(const Eigen::VectorXd& v,
                                                 const CurvePoint& reference) {
  const double joint = options_.joint_rate;
  for (int i = 0; i < robot_.active_joint_count(); ++i) {
    const int k = kBaseRows + i;
    diagonal_[k] = options_.joint_weight;
    gradient_[k] = options_.joint_weight * (reference.acceleration[k] + joint * joint * error_[k] +
                                            2.0 * joint * (reference.velocity[k] - v[k]));
  }
  const double place = options_.centre_rate, turning = options_.base_rate;
  const Eigen::Matrix3d here_from_planned = base_from_world_ * rotation_of(reference.configuration);
  const Eigen::Vector3d linear = here_from_planned * reference.velocity.head<3>() - v.head<3>();
  const Eigen::Vector3d angular =
      here_from_planned * reference.velocity.segment<3>(3) - v.segment<3>(3);
  const double little = 0.1 * options_.joint_weight;
  diagonal_.head<3>().setConstant(little);
  gradient_.head<3>() = little * (here_from_planned * reference.acceleration.head<3>() +
                                  place * place * error_.head<3>() + 2.0 * place * linear);
  diagonal_.segment<3>(3).setConstant(options_.base_weight);
  gradient_.segment<3>(3) =
      options_.base_weight * (here_from_planned * reference.acceleration.segment<3>(3) +
                              turning * turning * error_.segment<3>(3) + 2.0 * turning * angular);
}

/// The base's rows of the equation of motion are those of all momentum.
void WholeBodyController::follow_centre_of_mass(const Eigen::VectorXd& v,
                                                const CurvePoint& reference) {
  const double mass = robot_.total_mass(), rate = options_.centre_rate;
  dynamics_.inverse_dynamics(planned_, reference.velocity, reference.acceleration, {},
                             planned_force_);
  planned_.center_of_mass_jacobian(centre_jacobian_);
  Eigen::Vector3d wanted = rotation_of(reference.configuration) * planned_force_.head<3>() / mass +
                           standard_gravity() +
                           rate * rate * (planned_.center_of_mass() - state_.center_of_mass());
  wanted.noalias() += 2.0 * rate * (centre_jacobian_ * reference.velocity);
  state_.center_of_mass_jacobian(centre_jacobian_);
  wanted.noalias() -= 2.0 * rate * (centre_jacobian_ * v);
  three_rows_ = mass_.topRows<3>() / mass;
  const Eigen::Vector3d along_base =
      base_from_world_ * (wanted - standard_gravity()) - bias_.head<3>() / mass;
  add_rows(three_rows_, along_base, options_.centre_weight);
}

void WholeBodyController::hold(Effector& own, const ContactCommand& command,
                               const CurvePoint& reference) {
  const Contact& contact = command.held->contact();
  const Eigen::Isometry3d& world_from_link = state_.world_from_link(own.link);
  const Eigen::Vector3d centre = world_from_link * own.effector.point;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero(), normal = contact.normal.normalized();
  own.axes = axes_in_world(contact);
  if (own.ball) {
    const Eigen::Vector3d there = BallTrack(contact).normal(centre);
    own.axes = Eigen::Quaterniond::FromTwoVectors(normal, there).toRotationMatrix() * own.axes;
    normal = there;
  }
  if (own.surface || own.grasp) own.axes = world_from_link.linear() * axes_in_link(own.effector);
  if (own.round) arm = -own.effector.radius_m * normal;
  // Of what touches: its velocity, and how that changes while the normal stays.
  own.touching = own.jacobian;
  own.touching.topRows<3>().noalias() -= cross_matrix(arm) * own.jacobian.bottomRows<3>();
  Vector6 velocity = own.velocity, drift = own.drift;
  velocity.head<3>() += own.velocity.tail<3>().cross(arm);
  drift.head<3>() += own.drift.tail<3>().cross(arm);

  if (own.grasp) {
    hold_bar(own, command.touches, reference);
  } else {
    hold_against(own, command, normal, velocity, drift);
  }
  const Eigen::Vector3d off = planned_.world_from_link(own.link) * own.effector.point - centre;
  if (own.round && contact.locked) {
    add_rows(own.jacobian.topRows<3>(),
             100.0 * off - options_.contact_damping * own.velocity.head<3>() - own.drift.head<3>(),
             kTurning * options_.contact_weight);
  } else if (own.effector.kind == ContactKind::kWheel) {
    roll(own, contact.normal.normalized(), off, reference);
  }
  const std::vector<int>& components = own.components;
  for (std::size_t k = 0; k < components.size(); ++k) {
    const int component = components[k];
    own.along_axes.row(static_cast<Eigen::Index>(k)).noalias() =
        own.axes.col(component % 3).transpose() * own.touching.middleRows<3>(component < 3 ? 0 : 3);
  }
}

/// A hand that is not closed yet is brought to where it will be; one that is turns about the bar.
void WholeBodyController::hold_bar(Effector& own, bool closed, const CurvePoint& reference) {
  if (!closed) {
    swing(own, reference);
    return;
  }
  const double damping = options_.contact_damping;
  const Vector6 wanted = -damping * own.velocity - own.drift;
  add_rows(own.touching.topRows<3>(), wanted.head<3>(), options_.contact_weight);
  for (const int axis : {0, 2}) {  // y is the bar
    const Eigen::Vector3d about = own.axes.col(axis);
    add_row(about, own.touching.bottomRows<3>(), about.dot(wanted.tail<3>()),
            kTurning * options_.contact_weight);
  }
}

/// What is pressed stays, or comes nearer until it touches. velocity, drift: of what touches.
void WholeBodyController::hold_against(Effector& own, const ContactCommand& command,
                                       const Eigen::Vector3d& normal, const Vector6& velocity,
                                       const Vector6& drift) {
  const double damping = options_.contact_damping;
  Eigen::Vector3d linear = -damping * velocity.head<3>();
  double weight = options_.contact_weight;
  if (!command.touches) {
    const double along = normal.dot(velocity.head<3>());
    linear -= (options_.seeking_rate * (options_.seeking_m_s + along) - damping * along) * normal;
    weight = options_.swing_weight;
  }
  add_rows(own.touching.topRows<3>(), linear - drift.head<3>(), weight);
  if (own.surface) {
    const Eigen::Vector3d back = upright(own, *command.held, velocity.tail<3>());
    add_rows(own.touching.bottomRows<3>(), back - damping * velocity.tail<3>() - drift.tail<3>(),
             kTurning * weight);
  }
}

/// A sole on a bar turns about it freely: nothing but the ankle keeps it as it was planned, against
/// moments of forces that are not quite where they are thought to be.
Eigen::Vector3d WholeBodyController::upright(const Effector& own, const HeldContact& held,
                                             const Eigen::Vector3d& angular) const {
  const Eigen::Vector3d off =
      turn(state_.world_from_link(own.link).linear(), planned_.world_from_link(own.link).linear());
  const double rate = options_.tilt_rate;
  Eigen::Vector3d back = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    if (held.half_m()[1 - axis] >= kLine_m) continue;
    const Eigen::Vector3d about = own.axes.col(axis);
    const double damping = 2.0 * rate - options_.contact_damping;
    back += (rate * rate * about.dot(off) - damping * about.dot(angular)) * about;
  }
  return back;
}

/// A wheel keeps to its place along its way by rolling, and beside it by steering against it.
void WholeBodyController::roll(Effector& own, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& off, const CurvePoint& reference) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = own.effector.point;
  planned_.frame_jacobian(own.link, frame, own.ahead);
  const Vector6 planned = own.ahead * reference.velocity;
  if (own.wheel_joint >= 0) {  // where it is matters, not how far it has turned
    diagonal_[kBaseRows + own.wheel_joint] *= kLittle;
    gradient_[kBaseRows + own.wheel_joint] *= kLittle;
  }
  const Eigen::Vector3d axle = state_.world_from_link(own.link).linear() * own.axle;
  const Eigen::Vector3d planned_axle = planned_.world_from_link(own.link).linear() * own.axle;
  const Eigen::Vector3d along = axle.cross(normal).normalized();
  const Eigen::Vector3d side = normal.cross(along);
  const double rate = options_.wheel_rate;
  const double ahead = rate * rate * along.dot(off) +
                       2.0 * rate * along.dot(planned.head<3>() - own.velocity.head<3>()) -
                       along.dot(own.drift.head<3>());
  add_row(along, own.jacobian.topRows<3>(), ahead, options_.wheel_weight);
  const double speed = along.dot(planned.head<3>());
  const double steer =
      std::clamp(options_.steering_per_m * side.dot(off), -kMostSteering_rad, kMostSteering_rad) *
      std::clamp(speed / kRolling_m_s, -1.0, 1.0);
  const double heading = normal.dot(axle.cross(planned_axle)) + steer;
  const double turns = normal.dot(planned.tail<3>() - own.velocity.tail<3>());
  const double turning =
      rate * rate * heading + 2.0 * rate * turns - normal.dot(own.drift.tail<3>());
  add_row(normal, own.jacobian.bottomRows<3>(), turning, kTurning * options_.wheel_weight);
}

void WholeBodyController::swing(Effector& own, const CurvePoint& reference) {
  const double rate = options_.swing_rate;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = own.effector.point;
  planned_.frame_jacobian(own.link, frame, own.ahead);
  const Eigen::Isometry3d& here = state_.world_from_link(own.link);
  const Eigen::Isometry3d& there = planned_.world_from_link(own.link);
  Vector6 off;
  off.head<3>() = there * own.effector.point - here * own.effector.point;
  off.tail<3>() = turn(here.linear(), there.linear());
  Vector6 wanted = rate * rate * off - 2.0 * rate * own.velocity - own.drift;
  wanted.noalias() += own.ahead * (reference.acceleration + 2.0 * rate * reference.velocity);
  add_rows(own.jacobian.topRows<3>(), wanted.head<3>(), options_.swing_weight);
  if (own.surface || own.grasp) {
    add_rows(own.jacobian.bottomRows<3>(), wanted.tail<3>(), kTurning * options_.swing_weight);
  }
}

void WholeBodyController::collect_tasks(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const CurvePoint& reference,
                                        std::span<const ContactCommand> contacts) {
  robot_.difference(q.data(), reference.configuration.data(), error_.data());
  state_.update(q.data());
  planned_.update(reference.configuration.data());
  small_step_ = kAhead_s * v;
  robot_.integrate(q.data(), small_step_.data(), ahead_configuration_.data());
  ahead_.update(ahead_configuration_.data());
  dynamics_.mass_matrix(state_, mass_);
  dynamics_.bias_forces(state_, v, bias_);
  base_from_world_ = rotation_of(q).transpose();
  used_ = 0;
  follow_joints_and_base(v, reference);
  follow_centre_of_mass(v, reference);
  for (std::size_t i = 0; i < effectors_.size(); ++i) {
    Effector& own = effectors_[i];
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translation() = own.effector.point;
    state_.frame_jacobian(own.link, frame, own.jacobian);
    ahead_.frame_jacobian(own.link, frame, own.ahead);
    own.velocity.noalias() = own.jacobian * v;
    own.drift.noalias() = own.ahead * v;
    own.drift = (own.drift - own.velocity) / kAhead_s;
    own.held = contacts[i].held != nullptr;
    if (own.held) {
      hold(own, contacts[i], reference);
    } else {
      swing(own, reference);
    }
  }
}

void WholeBodyController::solve_accelerations() {
  cost_.setZero();
  cost_.diagonal() = diagonal_;
  const auto rows = rows_.topRows(used_);
  cost_.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  acceleration_ = gradient_;
  acceleration_.noalias() += rows.transpose() * wanted_.head(used_);
  factor_.compute(cost_);
  factor_.solveInPlace(acceleration_);
  by_base_ = mass_.topRows<kBaseRows>().transpose();
  factor_.solveInPlace(by_base_);
  const Matrix6 spread = mass_.topRows<kBaseRows>() * by_base_;
  base_cost_ = spread.inverse();
  asked_ = bias_.head<kBaseRows>();
  asked_.noalias() += mass_.topRows<kBaseRows>() * acceleration_;
}

/// Wrenches and slack in parts of the weight and of the efforts.
void WholeBodyController::solve_wrenches(std::span<const ContactCommand> contacts) {
  const int joints = robot_.active_joint_count(), unknowns = static_cast<int>(by_wrench_.cols());
  const double scale = base_cost_.trace() / kBaseRows;
  const Matrix6 metric = base_cost_ / scale;
  for (const Effector& own : effectors_) {
    const int count = static_cast<int>(own.along_axes.rows());
    if (own.held) {
      by_wrench_.middleCols(own.unknown, count) = own.along_axes.leftCols<kBaseRows>().transpose();
      torque_rows_.middleCols(own.unknown, count) = -own.along_axes.rightCols(joints).transpose();
    } else {
      by_wrench_.middleCols(own.unknown, count).setZero();
      torque_rows_.middleCols(own.unknown, count).setZero();
    }
  }
  base_rows_.noalias() = metric * by_wrench_;
  Eigen::MatrixXd& hessian = qp_->hessian();
  hessian.topLeftCorner(unknowns, unknowns).noalias() = by_wrench_.transpose() * base_rows_;
  hessian.row(unknowns).setZero();
  hessian.col(unknowns).setZero();
  hessian(unknowns, unknowns) = kOverEffort;
  const Vector6 asked = asked_ / weight_N_;
  qp_->gradient().head(unknowns).noalias() = base_rows_.transpose() * asked;
  qp_->gradient().head(unknowns) *= -1.0;
  qp_->gradient()[unknowns] = 0.0;

  // A torque is that of the accelerations for these wrenches, less what these do themselves.
  mass_by_base_.noalias() = mass_.bottomRows(joints) * by_base_;
  torque_by_base_.noalias() = mass_by_base_ * base_cost_;
  torque_rows_.noalias() += torque_by_base_ * by_wrench_;

  for (std::size_t i = 0; i < effectors_.size(); ++i) {
    const Effector& own = effectors_[i];
    const ContactCommand& command = contacts[i];
    const std::vector<int>& components = own.components;
    const double share =
        command.touches ? std::clamp(command.share, kLeastShare, 1.0) : kLeastShare;
    for (std::size_t k = 0; k < components.size(); ++k) {
      const int at = own.unknown + static_cast<int>(k);
      double cost = own.held ? options_.regularisation / (share * share) : 1.0;
      if (components[k] >= 3) cost *= kMomentPart;
      hessian(at, at) += cost;
      if (own.held) qp_->gradient()[at] -= cost * command.wrench[components[k]] / weight_N_;
    }
    for (int r = 0; r < own.cone_rows; ++r) {
      const int at = own.row + r;
      if (!own.held) {
        qp_->bound(at, -kUnbounded, kUnbounded);
        continue;
      }
      const WrenchRow limit = command.held->row(r, reserve_);
      for (std::size_t k = 0; k < components.size(); ++k) {
        qp_->row(at)[own.unknown + static_cast<int>(k)] = limit.gradient[components[k]];
      }
      double bound = -limit.offset / weight_N_;
      const bool pressed = command.held->pressed();
      const double least = command.touches ? share * options_.least_force : 0.0;
      if (pressed && r == 0) bound = -least;
      if (pressed && r == 1) bound = std::max(share * std::min(bound, kMostWeights), least);
      if (!pressed) bound *= share;
      qp_->bound(at, pressed ? -kUnbounded : -bound, bound);
    }
  }
  for (int i = 0; i < joints; ++i) {
    const int at = torque_rows_from_ + 2 * i;
    const double effort = effort_[static_cast<std::size_t>(i)];
    const bool limited = std::isfinite(effort) && effort > 0.0;
    if (!limited) {
      qp_->bound(at, -kUnbounded, kUnbounded);
      qp_->bound(at + 1, -kUnbounded, kUnbounded);
      continue;
    }
    const double fixed = mass_.row(kBaseRows + i).dot(acceleration_) + bias_[kBaseRows + i] -
                         torque_by_base_.row(i).dot(asked_);
    const double by = weight_N_ / effort;
    qp_->row(at).head(unknowns) = by * torque_rows_.row(i);
    qp_->row(at)[unknowns] = -1.0;
    qp_->bound(at, -kUnbounded, options_.torque - fixed / effort);
    qp_->row(at + 1).head(unknowns) = by * torque_rows_.row(i);
    qp_->row(at + 1)[unknowns] = 1.0;
    qp_->bound(at + 1, -options_.torque - fixed / effort, kUnbounded);
  }
  const bool solved = qp_->solve() == QpAnswer::kOptimal;
  for (Effector& own : effectors_) {
    // The last ones, where the programme failed: they were within their limits a moment ago.
    if (own.held && !solved) continue;
    own.wrench.setZero();
    if (!own.held) continue;
    const std::vector<int>& components = own.components;
    for (std::size_t k = 0; k < components.size(); ++k) {
      own.wrench[components[k]] = weight_N_ * qp_->solution()[own.unknown + static_cast<int>(k)];
    }
  }
  missing_ = -asked_;
  for (const Effector& own : effectors_) {
    const std::vector<int>& components = own.components;
    for (std::size_t k = 0; own.held && k < components.size(); ++k) {
      missing_ += own.wrench[components[k]] * by_wrench_.col(own.unknown + static_cast<int>(k));
    }
  }
  // From here on the accelerations that these wrenches bring about.
  const Vector6 force = base_cost_ * missing_;
  acceleration_.noalias() += by_base_ * force;
  torques_full_ = bias_;
  torques_full_.noalias() += mass_ * acceleration_;
  for (const Effector& own : effectors_) {
    const std::vector<int>& components = own.components;
    for (std::size_t k = 0; own.held && k < components.size(); ++k) {
      torques_full_.noalias() -=
          own.wrench[components[k]] * own.along_axes.row(static_cast<Eigen::Index>(k)).transpose();
    }
  }
}

/// Whether there are new ones.
bool WholeBodyController::take_in_limits(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  const int base = robot_.base_configuration_size();
  const double time = options_.limit_horizon_s;
  bool added = false;
  for (int i = 0; i < robot_.active_joint_count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int k = kBaseRows + i;
    const Joint& joint = robot_.active_joint(i);
    const double next = q[base + i] + time * v[k];
    const double half = 0.5 * time * time;
    const double low = (joint.lower - next) / half, high = (joint.upper - next) / half;
    if (!joint_taken_[at] && low <= high &&
        (acceleration_[k] < low - 1e-6 || acceleration_[k] > high + 1e-6)) {
      joint_taken_[at] = 1;
      added = true;
      const double bound = std::clamp(acceleration_[k], low, high);
      diagonal_[k] += options_.limit_weight;
      gradient_[k] += options_.limit_weight * bound;
    }
    const double effort = effort_[at];
    if (torque_taken_[at] || !std::isfinite(effort) || effort <= 0.0) continue;
    if (std::abs(torques_full_[k]) <= (options_.torque + kOverEffortTold) * effort) continue;
    if (used_ == rows_.rows()) continue;
    // By how much, in accelerations of the joint alone.
    torque_taken_[at] = 1;
    added = true;
    const double bound = std::copysign(options_.torque * effort, torques_full_[k]);
    const double inertia = mass_(k, k), root = std::sqrt(options_.limit_weight) / inertia;
    rows_.row(used_) = root * mass_.row(k);
    wanted_[used_] = root * (bound - torques_full_[k] + mass_.row(k).dot(acceleration_));
    ++used_;
  }
  return added;
}

const Eigen::VectorXd& WholeBodyController::torques(const Eigen::VectorXd& q,
                                                    const Eigen::VectorXd& v,
                                                    const CurvePoint& reference,
                                                    std::span<const ContactCommand> contacts) {
  if (contacts.size() != effectors_.size()) {
    throw Error("commands of " + std::to_string(contacts.size()) + " end effectors",
                std::to_string(effectors_.size()));
  }
  collect_tasks(q, v, reference, contacts);
  std::fill(joint_taken_.begin(), joint_taken_.end(), char{0});
  std::fill(torque_taken_.begin(), torque_taken_.end(), char{0});
  for (int round = 0; round < kRounds; ++round) {
    solve_accelerations();
    solve_wrenches(contacts);
    if (!take_in_limits(q, v)) break;
  }
  const bool misses = missing_.norm() > kMissing * weight_N_;
  reserve_ = std::clamp(reserve_ + (misses ? kReserveUp : -kReserveDown), 0.0, 1.0);
  for (int i = 0; i < torques_.size(); ++i) {
    const double effort = effort_[static_cast<std::size_t>(i)];
    torques_[i] = std::clamp(torques_full_[kBaseRows + i], -effort, effort);
  }
  return torques_;
}

}  // namespace locograph
