#include <locograph/check/balance_certificate.h>
#include <locograph/check/dense_programme.h>
#include <locograph/check/loaded_contact.h>
#include <locograph/common/error.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/statics.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace locograph {
namespace {

constexpr double kTolerance = 1e-6;    // of the margin and of what is verified, dimensionless
constexpr double kMomentLength = 1.0;  // m: a moment of weight times this counts as the weight
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Wrench = Eigen::Matrix<double, 6, 1>;

/// An unknown: what one unit of it does.
struct Unknown {
  int contact;
  Wrench wrench;            // N, N m, along the contact's axes, about the contact point
  Eigen::VectorXd torques;  // J^T wrench, entries of the tangent
  double lower = 0.0;       // 0, or -infinity
  int place = 0;            // of BalanceCertificate::at_places
};

/// What the margin takes away from one friction cone: a force along the normal.
struct Reserve {
  Unknown force;  // for a margin of 1
  int corner;     // -1: a point
  Eigen::Vector2d at;
};

class Programme {
 public:
  Programme(const Robot& robot, const Eigen::VectorXd& configuration,
            std::span<const Contact> contacts, const BalanceOptions& options)
      : robot_(robot), options_(options), state_(robot), base_(robot.base_tangent_size()) {
    if (options.facets < 3 || options.facets > 64) {
      throw Error("friction pyramids of " + std::to_string(options.facets) + " sides", "3 to 64");
    }
    if (!(options.effort_scale > 0.0) || std::isinf(options.effort_scale)) {
      throw Error("efforts scaled by " + std::to_string(options.effort_scale), "a positive number");
    }
    place_robot(configuration);
    gravity_.resize(robot.tangent_size());
    take_motion();
    for (const PointWrench& load : options.loads) add_wrench_torques(state_, load, -1.0, gravity_);
    weight_ = robot.total_mass() * standard_gravity().norm();
    moving_joint_.assign(std::size_t(robot.active_joint_count()), false);
    if (!options.areas.empty() && options.areas.size() != contacts.size()) {
      throw Error(std::to_string(options.areas.size()) + " areas for " +
                      std::to_string(contacts.size()) + " contacts",
                  "one each, or none");
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      add_contact(contacts[i], options.areas.empty() ? none_ : options.areas[i]);
    }
    limit_torques();
  }

  BalanceCertificate solve() {
    if (solve(Mode::kMargin) || (options_.least_violation && solve(Mode::kViolation))) {
      BalanceCertificate result = certificate();
      if (result.margin >= 0.0) result.at_places = at_places(result.margin);
      if (options_.least_torques && solve(Mode::kTorques)) {
        result.max_torque_ratio = solution_[0];
        result.least_at_places = at_places(0.0);
      }
      return result;
    }
    BalanceCertificate failed;
    failed.margin = -kInfinity;
    failed.max_torque_ratio = kInfinity;
    failed.wrenches.assign(contacts_.size(), Wrench::Zero());
    failed.limiting = options_.least_violation
                          ? "the linear programme was not solved (a numerical failure)"
                          : "nothing balances it";
    return failed;
  }

 private:
  /// What is sought: the largest margin, the least violation, or, at a margin of zero, the least
  /// largest ratio of a torque to its limit.
  enum class Mode { kMargin, kViolation, kTorques };

  void place_robot(const Eigen::VectorXd& configuration) {
    if (configuration.size() != robot_.configuration_size()) {
      throw Error("a configuration of " + std::to_string(configuration.size()) + " numbers",
                  std::to_string(robot_.configuration_size()));
    }
    if (!configuration.allFinite()) {
      throw Error("a configuration that is not finite", "numbers");
    }
    Eigen::VectorXd q = configuration;
    if (robot_.floating_base()) {
      const double norm = q.segment<4>(3).norm();
      if (std::abs(norm - 1.0) > 1e-3) {
        throw Error("a quaternion of norm " + std::to_string(norm), "1");
      }
      q.segment<4>(3) /= norm;
    }
    state_.update(q.data());
  }

  /// What equilibrium and torques have to hold: gravity and, in motion, inertia.
  void take_motion() {
    if (!options_.motion) {
      gravity_torques(state_, standard_gravity(), gravity_);
      return;
    }
    const BalanceMotion& motion = *options_.motion;
    for (const Eigen::VectorXd* part : {&motion.velocity, &motion.acceleration}) {
      if (part->size() != robot_.tangent_size() || !part->allFinite()) {
        throw Error("a velocity or acceleration of another size or not finite",
                    std::to_string(robot_.tangent_size()) + " numbers");
      }
    }
    RobotDynamics dynamics(robot_);
    dynamics.inverse_dynamics(state_, motion.velocity, motion.acceleration, {}, gravity_);
  }

  Unknown unknown(const Eigen::Vector3d& at, const Wrench& along, double lower) const {
    const LoadedContact& contact = contacts_.back();
    Unknown result{static_cast<int>(contacts_.size()) - 1, along, {}, lower, places_ - 1};
    result.torques.setZero(robot_.tangent_size());
    add_wrench_torques(state_, contact.applied(state_, at, along), 1.0, result.torques);
    // As a wrench about the contact point.
    result.wrench.tail<3>() += at.cross(along.head<3>());
    return result;
  }

  void add_contact(const Contact& given, const std::vector<Eigen::Vector2d>& area) {
    const EndEffector& effector = given.effector;
    require_sound_effector(robot_, effector);
    contacts_.push_back(loaded_contact(state_, given));
    if (!given.bears_load) return;
    for (const int axis : robot_.support(contacts_.back().link))
      moving_joint_[std::size_t(robot_.axes()[std::size_t(axis)].active)] = true;
    switch (effector.kind) {
      case ContactKind::kGrasp:
        ++places_;
        for (const int component : {0, 1, 2, 3, 5}) {
          if (component >= 3 && effector.max_moment_Nm == 0.0) continue;
          unknowns_.push_back(
              unknown(Eigen::Vector3d::Zero(), weight_ * Wrench::Unit(component), -kInfinity));
        }
        break;
      case ContactKind::kPoint:
      case ContactKind::kWheel:
        add_cone(Eigen::Vector3d::Zero(), 1.0, -1);
        break;
      case ContactKind::kSurface:
        add_area(area);
        break;
    }
  }

  void add_area(const std::vector<Eigen::Vector2d>& area) {
    const EndEffector& effector = *contacts_.back().effector;
    const std::vector<Eigen::Vector2d> corners = corners_of(effector, area);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      add_cone({corners[i].x(), corners[i].y(), 0.0}, 1.0 / double(corners.size()), int(i));
    }
  }

  /// The rays of a pyramid whose sides are normal to the angles 2 pi k / facets.
  void add_cone(const Eigen::Vector3d& at, double share, int corner) {
    const double mu = contacts_.back().effector->friction,
                 step = 2.0 * std::numbers::pi / options_.facets;
    std::array<Unknown, 3> axes;
    ++places_;
    for (int i = 0; i < 3; ++i) axes[std::size_t(i)] = unknown(at, weight_ * Wrench::Unit(i), 0.0);
    Reserve reserve{axes[2], corner, at.head<2>()};
    const double height = share / (mu * std::cos(0.5 * step));
    reserve.force.wrench *= height;
    reserve.force.torques *= height;
    reserves_.push_back(std::move(reserve));
    for (int k = 0; k < options_.facets; ++k) {
      const double c = mu * std::cos((k + 0.5) * step), s = mu * std::sin((k + 0.5) * step);
      Unknown ray = axes[2];
      ray.wrench += c * axes[0].wrench + s * axes[1].wrench;
      ray.torques += c * axes[0].torques + s * axes[1].torques;
      unknowns_.push_back(std::move(ray));
    }
  }

  double effort_limit(int active_joint) const {
    return options_.effort_scale * robot_.active_joint(active_joint).max_effort;
  }

  /// Joints that no contact loads bound the margin and the ratio, the others get rows.
  void limit_torques() {
    if (!options_.enforce_torque_limits && !options_.least_torques) return;
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      const Joint& joint = robot_.active_joint(i);
      if (!(joint.max_effort > 0.0)) {
        throw Error("joint " + joint.name + " has an effort limit of " +
                        std::to_string(joint.max_effort) + ", with which it cannot hold anything",
                    "a positive effort in the URDF, or none");
      }
      if (std::isinf(effort_limit(i))) continue;
      if (moving_joint_[std::size_t(i)]) {
        limited_.push_back(i);
        continue;
      }
      const double ratio = std::abs(gravity_[base_ + i]) / effort_limit(i);
      if (ratio <= least_ratio_) continue;
      least_ratio_ = ratio;
      least_ratio_joint_ = i;
    }
  }

  /// Rows: those of the base, as equations or, in both directions, as inequalities; two for each
  /// limited joint; those of the contacts. Inequalities read row <= bound.
  int base_rows() const { return mode_ == Mode::kViolation ? 2 * base_ : base_; }
  bool torques_limited() const { return options_.enforce_torque_limits || mode_ == Mode::kTorques; }
  int torque_rows() const { return torques_limited() ? 2 * static_cast<int>(limited_.size()) : 0; }
  static int rows_of(const EndEffector& effector) {
    if (effector.kind != ContactKind::kGrasp) return 1;
    return effector.max_moment_Nm > 0.0 ? 10 : 6;
  }

  double base_scale(int i) const { return i < 3 ? weight_ : weight_ * kMomentLength; }

  /// What one unit of an unknown adds to each row.
  void fill(const Unknown& unknown, Eigen::Ref<Eigen::VectorXd> column) const {
    column.setZero();
    for (int i = 0; i < base_; ++i) {
      column[i] = unknown.torques[i] / base_scale(i);
      if (mode_ == Mode::kViolation) column[base_ + i] = -column[i];
    }
    for (int i = 0; i < torque_rows() / 2; ++i) {
      const int joint = limited_[std::size_t(i)], row = base_rows() + 2 * i;
      column[row] = -unknown.torques[base_ + joint] / effort_limit(joint);
      column[row + 1] = -column[row];
    }
    int row = base_rows() + torque_rows();
    for (int i = 0; i < unknown.contact; ++i) row += rows_of(*contacts_[std::size_t(i)].effector);
    const EndEffector& given = *contacts_[std::size_t(unknown.contact)].effector;
    if (given.kind != ContactKind::kGrasp) {
      column[row] = unknown.wrench[2] / given.max_force_N;
      return;
    }
    for (const int component : {0, 1, 2, 3, 5}) {
      const double limit = component < 3 ? given.max_force_N : given.max_moment_Nm;
      if (limit == 0.0) break;
      column[row] = unknown.wrench[component] / limit;
      column[row + 1] = -column[row];
      row += 2;
    }
  }

  bool solve(Mode mode) {
    mode_ = mode;
    const int columns = static_cast<int>(unknowns_.size()) + 1;
    int rows = base_rows() + torque_rows();
    for (const LoadedContact& contact : contacts_) rows += rows_of(*contact.effector);

    DenseProgramme programme(rows, columns);
    Eigen::MatrixXd& matrix = programme.matrix;
    Eigen::VectorXd &lower = programme.lower, &upper = programme.upper;
    upper.setOnes();
    for (int c = 1; c < columns; ++c) fill(unknowns_[std::size_t(c - 1)], matrix.col(c));
    if (mode == Mode::kTorques) {
      // Column 0: the ratio.
      matrix.col(0).setZero();
      matrix.col(0).segment(base_rows(), torque_rows()).setConstant(-1.0);
      upper.segment(base_rows(), torque_rows()).setZero();
    } else {
      // Column 0: the margin, which tightens every inequality and shifts every cone.
      reserve_columns_.resize(rows, static_cast<Eigen::Index>(reserves_.size()));
      for (std::size_t i = 0; i < reserves_.size(); ++i) {
        fill(reserves_[i].force, reserve_columns_.col(Eigen::Index(i)));
      }
      matrix.col(0) = reserve_columns_.rowwise().sum();
      matrix.col(0).tail(rows - (mode == Mode::kMargin ? base_ : 0)).array() += 1.0;
    }
    for (int i = 0; i < base_; ++i) {
      upper[i] = gravity_[i] / base_scale(i);
      if (mode == Mode::kViolation) {
        upper[base_ + i] = -upper[i];
      } else {
        lower[i] = upper[i];
      }
    }
    for (int i = 0; i < torque_rows() / 2; ++i) {
      const int joint = limited_[std::size_t(i)], row = base_rows() + 2 * i;
      const double ratio = gravity_[base_ + joint] / effort_limit(joint);
      upper[row] -= ratio;
      upper[row + 1] += ratio;
    }
    Eigen::VectorXd &least = programme.least, &most = programme.most;
    for (int c = 1; c < columns; ++c) least[c] = unknowns_[std::size_t(c - 1)].lower;
    programme.objective[0] = mode == Mode::kTorques ? 1.0 : -1.0;
    switch (mode) {
      case Mode::kMargin:
        most[0] = largest_margin();
        if (most[0] < 0.0) return false;
        break;
      case Mode::kViolation:
        least[0] = -kInfinity;
        most[0] = std::min(0.0, largest_margin());
        break;
      case Mode::kTorques:
        least[0] = least_ratio_;
        break;
    }
    std::optional<DenseSolution> solution = locograph::solve(programme);
    if (!solution) return false;
    solution_ = std::move(solution->x);
    prices_ = std::move(solution->prices);
    return true;
  }

  double largest_margin() const {
    return options_.enforce_torque_limits ? 1.0 - least_ratio_ : 1.0;
  }

  /// The wrenches of the last solution, at each place on its own.
  std::vector<Wrench> at_places(double margin) const {
    std::vector<Wrench> wrenches(std::size_t(places_), Wrench::Zero());
    const auto add = [&](const Unknown& unknown, double amount) {
      Wrench& wrench = wrenches[std::size_t(unknown.place)];
      wrench.head<3>() += amount * unknown.wrench.head<3>();
      const LoadedContact& contact = contacts_[std::size_t(unknown.contact)];
      if (contact.effector->kind == ContactKind::kGrasp)
        wrench.tail<3>() += amount * unknown.wrench.tail<3>();
    };
    for (const Reserve& reserve : reserves_) add(reserve.force, margin);
    for (std::size_t c = 0; c < unknowns_.size(); ++c)
      add(unknowns_[c], solution_[Eigen::Index(c) + 1]);
    return wrenches;
  }

  BalanceCertificate certificate() const {
    BalanceCertificate result;
    result.margin = solution_[0];
    StanceWrenches& wrenches = result.wrenches;
    wrenches.assign(contacts_.size(), Wrench::Zero());
    const auto add = [&](const Unknown& unknown, double amount) {
      wrenches[std::size_t(unknown.contact)] += amount * unknown.wrench;
    };
    for (const Reserve& reserve : reserves_) add(reserve.force, result.margin);
    for (std::size_t c = 0; c < unknowns_.size(); ++c) {
      add(unknowns_[c], solution_[Eigen::Index(c) + 1]);
    }
    std::vector<PointWrench> applied;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const LoadedContact& contact = contacts_[i];
      applied.push_back({.link = contact.link,
                         .point = state_.world_from_link(contact.link).inverse() * contact.point,
                         .force = contact.axes * wrenches[i].head<3>(),
                         .moment = contact.axes * wrenches[i].tail<3>()});
    }
    Eigen::VectorXd torques(robot_.tangent_size());
    torques = gravity_;
    for (const PointWrench& wrench : applied) add_wrench_torques(state_, wrench, -1.0, torques);
    double left_over = 0.0;
    for (int i = 0; i < base_; ++i) {
      left_over = std::max(left_over, std::abs(torques[i]) / base_scale(i));
    }
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      const double limit = effort_limit(i);
      if (!(limit > 0.0) || std::isinf(limit)) continue;
      result.max_torque_ratio =
          std::max(result.max_torque_ratio, std::abs(torques[base_ + i]) / limit);
    }
    const bool torques_hold =
        !options_.enforce_torque_limits || result.max_torque_ratio <= 1.0 + kTolerance;
    result.balanced = result.margin >= -kTolerance && left_over <= 2.0 * kTolerance && torques_hold;
    result.limiting = limiting();
    return result;
  }

  /// The dual of the linear programme splits the margin among what limits it: each inequality's
  /// multiplier times what the margin takes from it, all together one.
  std::string limiting() const {
    std::string words = "nothing: the margin is at its largest";
    double most = 1e-9;
    const auto consider = [&](double share, auto&& text) {
      if (share <= most) return;
      most = share;
      words = text();
    };
    if (torques_limited() && least_ratio_joint_ >= 0 && solution_[0] >= largest_margin() - 1e-9) {
      words =
          "torque of " + robot_.active_joint(least_ratio_joint_).name + ", which no contact loads";
    }
    for (int i = 0; mode_ == Mode::kViolation && i < base_; ++i) {
      consider(-prices_[i] - prices_[base_ + i], [&] {
        return std::string(i < 3 ? "a force" : "a moment") + " on the base is left over";
      });
    }
    for (int i = 0; i < torque_rows() / 2; ++i) {
      const int row = base_rows() + 2 * i;
      consider(-prices_[row] - prices_[row + 1],
               [&] { return "torque of " + robot_.active_joint(limited_[std::size_t(i)]).name; });
    }
    int row = base_rows() + torque_rows();
    for (const LoadedContact& contact : contacts_) {
      const int rows = rows_of(*contact.effector);
      for (int k = 0; k < rows; ++k) {
        consider(-prices_[row + k], [&] {
          return std::string(k < 6 ? "force" : "moment") + " limit of " + contact.given->name();
        });
      }
      row += rows;
    }
    for (std::size_t i = 0; i < reserves_.size(); ++i) {
      const Reserve& reserve = reserves_[i];
      consider(-prices_.dot(reserve_columns_.col(Eigen::Index(i))), [&] {
        std::string text =
            "friction of " + contacts_[std::size_t(reserve.force.contact)].given->name();
        if (reserve.corner >= 0) {
          text += std::string(" at its corner ") + (reserve.at.x() >= 0.0 ? "+x" : "-x") +
                  (reserve.at.y() >= 0.0 ? " +y" : " -y");
        }
        return text;
      });
    }
    return words;
  }

  const Robot& robot_;
  const BalanceOptions& options_;
  RobotState state_;
  int base_;                 // rows of the base
  Eigen::VectorXd gravity_;  // and inertia
  const std::vector<Eigen::Vector2d> none_;
  double weight_ = 0.0;
  std::vector<LoadedContact> contacts_;
  std::vector<Unknown> unknowns_;
  int places_ = 0;
  std::vector<Reserve> reserves_;
  std::vector<bool> moving_joint_;  // some contact loads it
  std::vector<int> limited_;        // joints with rows
  double least_ratio_ = 0.0;        // of the joints without rows
  int least_ratio_joint_ = -1;

  Mode mode_ = Mode::kMargin;
  Eigen::MatrixXd reserve_columns_;
  Eigen::VectorXd solution_, prices_;
};

}  // namespace

BalanceCertificate certify_balance(const Robot& robot, const Eigen::VectorXd& configuration,
                                   std::span<const Contact> contacts,
                                   const BalanceOptions& options) {
  return Programme(robot, configuration, contacts, options).solve();
}

}  // namespace locograph
