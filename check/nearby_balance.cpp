#include <locograph/check/nearby_balance.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

constexpr double kLeftOver = 1e-9;   // of the weight, and of the weight times 1 m
constexpr double kLeastRoom = 1e-3;  // of the weight

}  // namespace

NearbyBalance::NearbyBalance(const Robot& robot)
    : robot_(robot),
      weight_(robot.total_mass() * standard_gravity().norm()),
      load_(robot.tangent_size()),
      torques_(robot.tangent_size()) {}

BalanceBounds NearbyBalance::prove(const RobotState& state, std::span<const Contact> contacts,
                                   const BalanceOptions& options, const BalanceCertificate& found) {
  BalanceBounds bounds;
  if (found.at_places.empty() || !place(state, contacts, options, found.at_places.size()))
    return bounds;
  if (options.motion) {
    if (!dynamics_) dynamics_.emplace(robot_);
    dynamics_->inverse_dynamics(state, options.motion->velocity, options.motion->acceleration, {},
                                load_);
  } else {
    gravity_torques(state, standard_gravity(), load_);
  }
  for (const PointWrench& load : options.loads) add_wrench_torques(state, load, -1.0, load_);
  find_rows(state);
  Left widest = correct(state, options, found.at_places);
  if (!widest.balanced) return bounds;
  bounds.margin_at_least = std::min(1.0, widest.contacts);
  if (options.enforce_torque_limits)
    bounds.margin_at_least = std::min(bounds.margin_at_least, 1.0 - widest.torque_ratio);
  bounds.wrenches = std::move(widest.wrenches);
  if (!(widest.contacts >= 0.0)) return bounds;
  bounds.torque_ratio_at_most = widest.torque_ratio;
  if (found.least_at_places.size() != found.at_places.size()) return bounds;
  const Left least = correct(state, options, found.least_at_places);
  if (!least.balanced) return bounds;
  const double lacking = std::max(0.0, -least.contacts);
  const double share = lacking > 0.0 ? lacking / (lacking + widest.contacts) : 0.0;
  bounds.torque_ratio_at_most =
      std::min(bounds.torque_ratio_at_most,
               (1.0 - share) * least.torque_ratio + share * widest.torque_ratio);
  return bounds;
}

bool NearbyBalance::place(const RobotState& state, std::span<const Contact> contacts,
                          const BalanceOptions& options, std::size_t places) {
  contacts_.clear();
  places_.clear();
  columns_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    contacts_.push_back(loaded_contact(state, contact));
    if (!contact.bears_load) continue;
    const EndEffector& effector = contact.effector;
    std::vector<Eigen::Vector2d> corners = {Eigen::Vector2d::Zero()};
    if (effector.kind == ContactKind::kSurface)
      corners = corners_of(
          effector, options.areas.empty() ? std::vector<Eigen::Vector2d>() : options.areas[i]);
    const bool cone = effector.kind != ContactKind::kGrasp;
    for (const Eigen::Vector2d& corner : corners) {
      const int place = static_cast<int>(places_.size());
      places_.push_back({static_cast<int>(i),
                         {corner.x(), corner.y(), 0.0},
                         1.0 / static_cast<double>(corners.size()),
                         cone});
      for (const int component : {0, 1, 2, 3, 5})
        if (component < 3 || (!cone && effector.max_moment_Nm > 0.0))
          columns_.push_back({place, component});
    }
  }
  return places_.size() == places;
}

/// The rows of the base, of one unit of each component: along its own axes, moments about it.
void NearbyBalance::find_rows(const RobotState& state) {
  const Eigen::Isometry3d& base = state.world_from_link(robot_.root_link());
  rows_.resize(6, static_cast<Eigen::Index>(columns_.size()));
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const Place& place = places_[static_cast<std::size_t>(columns_[c][0])];
    const LoadedContact& contact = contacts_[static_cast<std::size_t>(place.contact)];
    const int component = columns_[c][1];
    const Eigen::Vector3d along = base.linear().transpose() * contact.axes.col(component % 3);
    auto column = rows_.col(static_cast<Eigen::Index>(c));
    if (component < 3) {
      const Eigen::Vector3d arm = contact.point + contact.axes * place.at - base.translation();
      column << along, (base.linear().transpose() * arm).cross(along);
    } else {
      column << Eigen::Vector3d::Zero(), along;
    }
  }
}

StanceWrenches NearbyBalance::apply(const RobotState& state, const std::vector<Wrench>& wrenches) {
  StanceWrenches whole(contacts_.size(), Wrench::Zero());
  for (std::size_t p = 0; p < places_.size(); ++p) {
    Wrench& wrench = whole[static_cast<std::size_t>(places_[p].contact)];
    wrench += wrenches[p];
    wrench.tail<3>() += places_[p].at.cross(wrenches[p].head<3>());
  }
  torques_ = load_;
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    add_wrench_torques(state, contacts_[i].applied(state, Eigen::Vector3d::Zero(), whole[i]), -1.0,
                       torques_);
  return whole;
}

NearbyBalance::Left NearbyBalance::correct(const RobotState& state, const BalanceOptions& options,
                                           std::vector<Wrench> wrenches) {
  Left left;
  // What bears otherwise here than where they were found bears nothing of that.
  std::vector<Wrench> kept(wrenches.size(), Wrench::Zero());
  for (const auto& [place, component] : columns_) {
    const auto number = static_cast<std::size_t>(place);
    kept[number][component] = wrenches[number][component];
  }
  wrenches = std::move(kept);
  apply(state, wrenches);
  const Eigen::VectorXd room = room_of(wrenches, options.facets);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> rows = rows_ * room.asDiagonal();
  const Eigen::Matrix<double, 6, 6> squares = rows * rows.transpose();
  const Wrench multipliers = squares.ldlt().solve(torques_.head<6>());
  const Eigen::VectorXd change = room.asDiagonal() * (rows.transpose() * multipliers);
  if (!change.allFinite()) return left;
  for (std::size_t c = 0; c < columns_.size(); ++c)
    wrenches[static_cast<std::size_t>(columns_[c][0])][columns_[c][1]] +=
        change[static_cast<Eigen::Index>(c)];
  left.wrenches = apply(state, wrenches);
  left.balanced = torques_.head<6>().lpNorm<Eigen::Infinity>() <= kLeftOver * weight_;
  left.contacts = least_left(wrenches, options.facets);
  for (int i = 0; i < robot_.active_joint_count(); ++i) {
    const double limit = options.effort_scale * robot_.active_joint(i).max_effort;
    if (!(limit > 0.0) || std::isinf(limit)) continue;
    left.torque_ratio =
        std::max(left.torque_ratio, std::abs(torques_[robot_.base_tangent_size() + i]) / limit);
  }
  return left;
}

/// How far a force is inside its friction pyramid, pressing: towards the side whose normal is
/// nearest to what is tangential.
double NearbyBalance::reserve(const Place& place, const Wrench& wrench, int facets) const {
  const double step = 2.0 * std::numbers::pi / facets;
  const double side = step * std::round(std::atan2(wrench[1], wrench[0]) / step);
  const double along = std::cos(side) * wrench[0] + std::sin(side) * wrench[1];
  const double friction =
      contacts_[static_cast<std::size_t>(place.contact)].effector->friction * std::cos(0.5 * step);
  return friction * wrench[2] - along;
}

/// How much of a change each column may take: as much as it is away from its limit.
Eigen::VectorXd NearbyBalance::room_of(const std::vector<Wrench>& wrenches, int facets) const {
  Eigen::VectorXd room(static_cast<Eigen::Index>(columns_.size()));
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto& [number, component] = columns_[c];
    const Place& place = places_[static_cast<std::size_t>(number)];
    const Wrench& wrench = wrenches[static_cast<std::size_t>(number)];
    double left = 0.0;
    if (place.cone) {
      left = reserve(place, wrench, facets);
    } else {
      const EndEffector& effector = *contacts_[static_cast<std::size_t>(place.contact)].effector;
      const double limit = component < 3 ? effector.max_force_N : effector.max_moment_Nm;
      left = limit - std::abs(wrench[component]);
    }
    room[static_cast<Eigen::Index>(c)] =
        std::clamp(left, kLeastRoom * place.share * weight_, weight_);
  }
  return room;
}

double NearbyBalance::least_left(const std::vector<Wrench>& wrenches, int facets) const {
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> pressing(contacts_.size(), 0.0);
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& place = places_[p];
    const EndEffector& effector = *contacts_[static_cast<std::size_t>(place.contact)].effector;
    const Wrench& wrench = wrenches[p];
    if (!place.cone) {
      for (const int component : {0, 1, 2, 3, 5}) {
        const double limit = component < 3 ? effector.max_force_N : effector.max_moment_Nm;
        if (limit > 0.0) least = std::min(least, 1.0 - std::abs(wrench[component]) / limit);
      }
      continue;
    }
    pressing[static_cast<std::size_t>(place.contact)] += wrench[2];
    least = std::min(least, reserve(place, wrench, facets) / (weight_ * place.share));
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const EndEffector& effector = *contacts_[i].effector;
    if (effector.kind != ContactKind::kGrasp)
      least = std::min(least, 1.0 - pressing[i] / effector.max_force_N);
  }
  return least;
}

}  // namespace locograph
