#include <locograph/planners/online/drive_back.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/planners/online/way_back.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

double moved_m(const Eigen::VectorXd& step) {
  return step.head<3>().norm() + kTurn_m * step.segment<3>(3).norm();
}

}  // namespace

/// Whether all wheels that the robot rolls on at a configuration can be steered.
bool DriveBack::can_steer(int index, const Eigen::VectorXd& q) {
  const auto& stance = plan_.plan().stance_from[static_cast<std::size_t>(index)];
  if (stance != stance_) {
    wheels_.emplace(plan_.robot(), stance->stance);
    stance_ = stance;
  }
  return wheels_->can_steer(q);
}

/// The share of its way that it has gone at each configuration, from the executed one to where it
/// is back; empty: it does not drive as far, or a configuration of the way is fixed.
std::vector<double> DriveBack::share_gone(int executed, const Eigen::VectorXd& off) const {
  constexpr double kBack_s = 1.6, kTimesAsFar = 8.0, kStands_m_s = 1e-3;
  const Robot& robot = plan_.robot();
  const double joints_m = kJoint_m * off.tail(robot.active_joint_count()).lpNorm<Eigen::Infinity>(),
               back_m = kTimesAsFar * std::max(moved_m(off), joints_m),
               back_s = std::max(kBack_s, least_time_back(robot, off));
  Eigen::VectorXd step(off.size());
  std::vector<double> gone = {0.0};  // m at first
  double moves_s = 0.0;
  for (int i = executed; moves_s < back_s || gone.back() < back_m; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool ends = i == plan_.last() || plan_.plan().stance_from[at] != stance_;
    if (ends || plan_.is_fixed(i + 1)) return {};
    const double step_s = plan_.time_s(i + 1) - plan_.time_s(i);
    robot.difference(plan_.planned()[at].data(), plan_.planned()[at + 1].data(), step.data());
    const bool moves = moved_m(step) > kStands_m_s * step_s;
    gone.push_back(gone.back() + (moves ? moved_m(step) : 0.0));
    if (moves) moves_s += step_s;
  }
  const double all_m = gone.back();
  for (double& way : gone) way /= all_m;
  return gone;
}

/// Beside what is planned from `was` on by less and less of what the robot would be off.
void DriveBack::make_way(int executed, const Eigen::VectorXd& was,
                         const std::vector<double>& gone) {
  const Robot& robot = plan_.robot();
  Eigen::VectorXd goes = plan_.configuration(executed), next = goes, off(robot.tangent_size()),
                  step = off;
  before_ = {was};
  way_ = {goes};
  for (std::size_t k = 1; k < gone.size(); ++k) {
    const auto at = static_cast<std::size_t>(executed) + k;
    robot.difference(plan_.planned()[at - 1].data(), plan_.planned()[at].data(), step.data());
    robot.integrate(before_.back().data(), step.data(), next.data());
    before_.push_back(next);
    robot.integrate(goes.data(), step.data(), next.data());
    goes = next;
    robot.difference(before_.back().data(), goes.data(), off.data());
    wheels_->leave_out(off);
    off *= share_left(gone[k]);
    robot.integrate(before_.back().data(), off.data(), next.data());
    way_.push_back(next);
  }
}

/// By what its wheels are steered more than those of the way before, and less and less of what they
/// were turned off. Whether they can be.
bool DriveBack::steer(const Eigen::VectorXd& turned, const std::vector<double>& gone) {
  constexpr double kMost_rad = 0.5 * std::numbers::pi, kSteered = 5.0;
  std::vector<Eigen::VectorXd> driven = before_;
  if (!wheels_->drive(driven) || !wheels_->drive(way_)) return false;
  const Robot& robot = plan_.robot();
  const int base = robot.base_configuration_size(), base_tangent = robot.base_tangent_size();
  for (std::size_t k = 1; k < way_.size(); ++k) {
    for (const int joint : wheels_->steering_joints()) {
      double& here = way_[k][base + joint];
      const double more = here - driven[k][base + joint];
      if (std::abs(more) > kMost_rad) return false;
      here = before_[k][base + joint] + more +
             share_left(kSteered * gone[k]) * turned[base_tangent + joint];
    }
    wheels_->roll(way_[k - 1], way_[k]);
  }
  return true;
}

void DriveBack::lead(const Window& window, const Eigen::VectorXd& was) {
  const Robot& robot = plan_.robot();
  const int executed = window.executed();
  const Eigen::VectorXd is = plan_.configuration(executed);
  if (!robot.floating_base() || !can_steer(executed, is)) return;
  Eigen::VectorXd turned(robot.tangent_size());
  robot.difference(was.data(), is.data(), turned.data());
  Eigen::VectorXd off = turned;
  wheels_->leave_out(off);
  turned -= off;
  const std::vector<double> gone = share_gone(executed, off);
  if (gone.empty()) return;
  make_way(executed, was, gone);
  if (!steer(turned, gone)) return;
  std::vector<Eigen::VectorXd> by(static_cast<std::size_t>(executed - window.first_held()) + 1,
                                  off);
  way_.back() = before_.back();  // it is back: as planned
  for (std::size_t k = 1; k < way_.size(); ++k) {
    robot.difference(before_[k].data(), way_[k].data(), off.data());
    by.push_back(off);
  }
  plan_.move_planned(window.first_held(), by);
}

}  // namespace locograph
