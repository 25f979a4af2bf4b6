#include <locograph/common/error.h>
#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/robots/statics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// Pyramids of 8 edges on the cone, this much smaller, are inside those of 16 sides.
constexpr double kInsideCones = 0.02;
constexpr int kBaseRows = 6;

std::vector<int> limited_joints(const Robot& robot, double effort_scale) {
  std::vector<int> joints;
  for (int i = 0; effort_scale > 0.0 && i < robot.active_joint_count(); ++i) {
    const double effort = robot.active_joint(i).max_effort;
    if (effort > 0.0 && std::isfinite(effort)) joints.push_back(i);
  }
  return joints;
}

int count_rays(std::span<const BearingContact> contacts, double weight_N) {
  int count = 0;
  for (const BearingContact& bearing : contacts) {
    if (!bearing.contact.bears_load) continue;
    count += static_cast<int>(bearing_rays(bearing, kInsideCones, weight_N).size());
  }
  if (count == 0) throw Error("wrenches of contacts that bear nothing", "one that bears load");
  return count;
}

/// Its rays are along the contact's axes, its wrenches are stated along the link's, which are the
/// same but for rounding. Rays of what has turned are turned, too.
bool has_link_axes(const Contact& contact) {
  const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
  return kind.axes_on_link && kind.bar_touch != BarTouch::kGrasp;
}

}  // namespace

LeastWrenches::LeastWrenches(const Robot& robot, std::span<const BearingContact> contacts,
                             double effort_scale)
    : robot_(robot),
      contacts_(contacts.begin(), contacts.end()),
      turned_(contacts.size(), Eigen::Matrix3d::Identity()),
      touching_(contacts.size()),
      weight_N_(robot.total_mass() * standard_gravity().norm()),
      joints_(limited_joints(robot, effort_scale)),
      qp_(count_rays(contacts, weight_N_), kBaseRows + count_rays(contacts, weight_N_) +
                                               static_cast<int>(contacts.size()) +
                                               static_cast<int>(joints_.size())),
      torques_(robot.tangent_size()),
      wrenches_(contacts.size(), StanceWrenches::value_type::Zero()) {
  for (const int joint : joints_) {
    efforts_Nm_.push_back(effort_scale * robot.active_joint(joint).max_effort);
  }
  int unknown = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const BearingContact& bearing = contacts_[c];
    links_.push_back(robot.link_index(bearing.contact.effector.link));
    axes_.push_back(has_link_axes(bearing.contact) ? axes_in_link(bearing.contact.effector)
                                                   : axes_in_world(bearing.contact));
    if (!bearing.contact.bears_load) continue;
    const double most = most_of_rays(bearing.contact, kInsideCones, weight_N_);
    const std::vector<BearingRay> rays = bearing_rays(bearing, kInsideCones, weight_N_);
    const int sum = kBaseRows + qp_.variables() + static_cast<int>(c);
    for (const BearingRay& ray : rays) {
      rays_.push_back({c, ray.at - bearing.contact.position, ray.force, ray.moment});
      const double weight = most >= 0.0 ? static_cast<double>(rays.size()) / (most * most)
                                        : 1.0 / (ray.upper * ray.upper);
      qp_.hessian()(unknown, unknown) = weight;
      qp_.row(kBaseRows + unknown)[unknown] = 1.0;
      const bool bounded = std::isfinite(ray.upper);
      qp_.bound(kBaseRows + unknown, ray.lower, bounded ? ray.upper : kUnbounded);
      if (most >= 0.0) qp_.row(sum)[unknown] = 1.0;
      ++unknown;
    }
    if (most >= 0.0) qp_.bound(sum, least_of_rays(bearing, weight_N_), most);
  }
}

/// A ball acts where it has rolled to; on a bar its forces go along with the normal. The limits of
/// a grasp are along the axes of the hand, which may have turned about its bar.
void LeastWrenches::place(const RobotState& state, std::size_t c) {
  const Contact& contact = contacts_[c].contact;
  const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
  turned_[c].setIdentity();
  touching_[c] = kind.rolls ? kind.touching_point(state, contact)
                            : state.world_from_link(links_[c]) * contact.effector.point;
  if (kind.bar_touch == BarTouch::kGrasp) {
    const Eigen::Matrix3d hand =
        state.world_from_link(links_[c]).linear() * axes_in_link(contact.effector);
    turned_[c] = hand * axes_in_world(contact).transpose();
  }
  if (!is_ball(contact.effector)) return;
  const Contact there = rolled_to(state, contact);
  touching_[c] = there.position;
  if (contact.bar) {
    turned_[c] = Eigen::Quaterniond::FromTwoVectors(contact.normal, there.normal);
  }
}

bool LeastWrenches::solve(const RobotState& state, const Eigen::VectorXd& asked) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) place(state, c);
  const int joints_from = kBaseRows + qp_.variables() + static_cast<int>(contacts_.size());
  for (int r = 0; r < qp_.variables(); ++r) {
    const Ray& ray = rays_[static_cast<std::size_t>(r)];
    const Eigen::Matrix3d& turned = turned_[ray.contact];
    PointWrench wrench;
    wrench.link = links_[ray.contact];
    wrench.point =
        state.world_from_link(wrench.link).inverse() * (touching_[ray.contact] + turned * ray.at);
    wrench.force = weight_N_ * (turned * ray.force);
    wrench.moment = weight_N_ * (turned * ray.moment);
    torques_.setZero();
    add_wrench_torques(state, wrench, 1.0, torques_);
    for (int i = 0; i < kBaseRows; ++i) qp_.row(i)[r] = torques_[i] / weight_N_;
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      qp_.row(joints_from + static_cast<int>(k))[r] =
          torques_[kBaseRows + joints_[k]] / efforts_Nm_[k];
    }
  }
  for (int i = 0; i < kBaseRows; ++i) {
    qp_.bound(i, asked[i] / weight_N_, asked[i] / weight_N_);
  }
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const double share = asked[kBaseRows + joints_[k]] / efforts_Nm_[k];
    qp_.bound(joints_from + static_cast<int>(k), share - 1.0, share + 1.0);
  }
  if (qp_.solve() != QpAnswer::kOptimal) return false;
  for (StanceWrenches::value_type& wrench : wrenches_) wrench.setZero();
  for (int r = 0; r < qp_.variables(); ++r) {
    const Ray& ray = rays_[static_cast<std::size_t>(r)];
    const double amount = weight_N_ * qp_.solution()[r];
    wrenches_[ray.contact].head<3>() += amount * ray.force;
    wrenches_[ray.contact].tail<3>() += amount * (ray.moment + ray.at.cross(ray.force));
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    Eigen::Matrix3d axes = axes_[c];
    if (has_link_axes(contacts_[c].contact)) {
      axes = state.world_from_link(links_[c]).linear() * axes_[c];
    }
    wrenches_[c].head<3>() = (axes.transpose() * wrenches_[c].head<3>()).eval();
    wrenches_[c].tail<3>() = (axes.transpose() * wrenches_[c].tail<3>()).eval();
  }
  return true;
}

std::optional<StanceWrenches> wrenches_at_rest(const RobotState& state,
                                               std::span<const BearingContact> contacts,
                                               const ExecutionMargin& margin, double effort_scale) {
  const Robot& robot = state.robot();
  const double weight_N = robot.total_mass() * standard_gravity().norm();
  Eigen::VectorXd asked(robot.tangent_size());
  gravity_torques(state, standard_gravity(), asked);
  for (const double part : kPartsOfMargin) {
    const ExecutionMargin less = margin.scaled(part);
    LeastWrenches least(robot, with_margin(contacts, less, weight_N), effort_scale * less.torque);
    if (least.solve(state, asked)) return least.wrenches();
  }
  return std::nullopt;
}

}  // namespace locograph
