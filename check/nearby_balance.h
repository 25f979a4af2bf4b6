#pragma once
/// What wrenches found in one configuration prove about another one nearby, without a linear
/// programme.
///
///     NearbyBalance nearby(robot);
///     const BalanceBounds bounds = nearby.prove(state, contacts, options, certificate);
///     const bool proved = bounds.margin_at_least >= enough;  // by certify_balance(), too
///
/// The wrenches at corners and points are changed by the least that restores equilibrium, sum of
/// squares over all of them, each divided by the room D that it has inside its limits: with G their
/// 6 rows of the base and r what is left over, D D G^T (G D D G^T)^-1 r. They are a solution of the
/// programme of balance_certificate.h then, for a margin that is read off its rows: no more than
/// the largest there is. With the wrenches of the least torques likewise, which mostly miss a
/// friction row by a little: of a mixture of both solutions, what is left of each row and the
/// torques are those mixed, or better, because all rows are linear; the mixture that just holds
/// bounds the least ratio from above.
///
/// Equilibrium is verified to 1e-9 of the weight. Nothing is proved where contacts, or what of them
/// bears, are others than in the certificate. Not thread-safe: one for each thread.

#include <locograph/check/balance_certificate.h>
#include <locograph/check/loaded_contact.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

struct BalanceBounds {
  double margin_at_least = -std::numeric_limits<double>::infinity();
  /// Of BalanceOptions::least_torques.
  double torque_ratio_at_most = std::numeric_limits<double>::infinity();
  StanceWrenches wrenches = {};  ///< with that margin
};

class NearbyBalance {
 public:
  explicit NearbyBalance(const Robot& robot);

  /// state: of the configuration, where the contacts are closed. Contacts and options are as
  /// certify_balance() would get them there; the base must be free.
  BalanceBounds prove(const RobotState& state, std::span<const Contact> contacts,
                      const BalanceOptions& options, const BalanceCertificate& found);

 private:
  using Wrench = Eigen::Matrix<double, 6, 1>;
  struct Place {
    int contact;
    Eigen::Vector3d at;  // from the contact's point, its axes
    double share;        // of the contact's cones
    bool cone;
  };
  /// How much of every limit is left, as a margin; with torques aside, and of them alone.
  struct Left {
    double contacts = 0.0, torque_ratio = 0.0;
    bool balanced = false;
    StanceWrenches wrenches = {};
  };

  bool place(const RobotState& state, std::span<const Contact> contacts,
             const BalanceOptions& options, std::size_t places);
  void find_rows(const RobotState& state);
  Left correct(const RobotState& state, const BalanceOptions& options,
               std::vector<Wrench> wrenches);
  /// What is left to hold with these wrenches, into torques_; they all together at each contact.
  StanceWrenches apply(const RobotState& state, const std::vector<Wrench>& wrenches);
  double reserve(const Place& place, const Wrench& wrench, int facets) const;
  Eigen::VectorXd room_of(const std::vector<Wrench>& wrenches, int facets) const;
  double least_left(const std::vector<Wrench>& wrenches, int facets) const;

  const Robot& robot_;
  std::optional<RobotDynamics> dynamics_;  // of what moves
  double weight_;
  Eigen::VectorXd load_, torques_;  // gravity and inertia; less what the contacts hold
  std::vector<LoadedContact> contacts_;
  std::vector<Place> places_;
  std::vector<std::array<int, 2>> columns_;  // place and component of the wrench
  Eigen::Matrix<double, 6, Eigen::Dynamic> rows_;
};

}  // namespace locograph
