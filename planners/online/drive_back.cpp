#include <locograph/planners/online/drive_back.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/planners/online/way_back.h>

#include <algorithm>
#include <vector>

namespace locograph {
namespace {

double length_m(const Eigen::VectorXd& step) {
  constexpr double kTurn_m = 0.5;  // for a radian
  return step.head<3>().norm() + kTurn_m * step.segment<3>(3).norm();
}

}  // namespace

/// Whether all wheels of a stance can be steered, which are looked at from now on.
bool DriveBack::can_steer(int index) {
  const auto& stance = plan_.plan().stance_from[static_cast<std::size_t>(index)];
  if (stance != stance_) {
    wheels_.emplace(plan_.robot(), stance->stance);
    stance_ = stance;
  }
  return wheels_->can_steer();
}

/// How much of what the robot is off is left at each configuration, from the executed one until
/// there is nothing; empty: it drives nowhere.
std::vector<double> DriveBack::shares_left(int executed, const Eigen::VectorXd& off) const {
  constexpr double kBack_s = 1.6, kTimesAsFar = 8.0;
  const double back_s =
                   plan_.time_s(executed) + std::max(kBack_s, least_time_back(plan_.robot(), off)),
               back_m = kTimesAsFar * length_m(off);
  const auto& stance_from = plan_.plan().stance_from;
  Eigen::VectorXd step(off.size());
  std::vector<double> share = {0.0};  // of the way, at first
  for (int i = executed; i < plan_.last(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool is_back = plan_.time_s(i) >= back_s && share.back() >= back_m;
    if (is_back || stance_from[at] != stance_) break;
    plan_.robot().difference(plan_.planned()[at].data(), plan_.planned()[at + 1].data(),
                             step.data());
    share.push_back(share.back() + length_m(step));
  }
  const double all_m = share.back();
  if (!(all_m > 0.0)) return {};
  for (double& x : share) x = share_left(x / all_m);
  return share;
}

bool DriveBack::begin(const Window& window, const Eigen::VectorXd& was) {
  const int executed = window.executed();
  const Robot& robot = plan_.robot();
  if (!robot.floating_base() || !can_steer(executed)) return false;
  Eigen::VectorXd off(robot.tangent_size());
  robot.difference(was.data(), plan_.configuration(executed).data(), off.data());
  std::vector<Eigen::VectorXd> by = {off};
  wheels_->leave_out(off);
  const std::vector<double> left = shares_left(executed, off);
  if (left.empty()) return false;
  const int count = static_cast<int>(left.size());
  std::vector<Eigen::VectorXd> way = {plan_.configuration(executed)};
  for (int k = 1; k < count; ++k) {
    by.emplace_back(left[static_cast<std::size_t>(k)] * off);
    const int i = executed + k;
    if (i > window.last()) continue;
    if (plan_.is_fixed(i)) return false;
    Eigen::VectorXd& q = way.emplace_back(was.size());
    robot.integrate(plan_.configuration(i).data(), by.back().data(), q.data());
  }
  if (!wheels_->drive(way)) return false;
  for (int i = executed + 1; i <= window.last() && plan_.rolls(i - 1); ++i) {
    if (plan_.is_fixed(i)) continue;
    const auto at = static_cast<std::size_t>(i - executed);
    const bool is_led = at < way.size() && left[at] > 0.0;
    Eigen::VectorXd q = is_led ? way[at] : Eigen::VectorXd(plan_.configuration(i));
    rolled_.at(plan_, i - 1).roll(plan_.configuration(i - 1), q);
    if (is_led && plan_.is_as_planned(i)) {
      robot.difference(plan_.configuration(i).data(), q.data(), by[at].data());
    }
    plan_.configuration(i) = q;
  }
  plan_.move_planned(executed, by);
  return true;
}

}  // namespace locograph
