#pragma once
/// One segment of a motion: what has to hold all along it, and the tools that planners share.
///
///     SegmentSpace space(robot, world);
///     space.set_segment(segment);
///     Eigen::VectorXd q = space.half_way(segment.from, segment.to);
///     if (space.project(q) && space.valid(q)) waypoints.push_back(q);
///
/// Where an end effector leaves its contact or comes to one, the segment begins and ends with a
/// move along the contact's normal; from() and to() are what lies between, so that planners that
/// draw at random need not find their way out of a surface that is touched.
///
/// Balls that are held roll: closure lets them by the shortest turn since `from`, whatever the way
/// there, so that they have a manifold. Where balls really get to depends on the way:
/// roll_from() and project_end() are for who follows one (segment_motion.h).

#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/torque_programme.h>
#include <locograph/planners/posture/contact_projection.h>
#include <locograph/planners/posture/transition_rows.h>
#include <locograph/planners/posture/transition_solver.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

struct Segment {
  std::vector<Contact> held;               ///< closed and bearing all along, as they touched down
  const BalanceRegion* balance = nullptr;  ///< of those; null: not asked for
  TorqueProgramme* torques = nullptr;      ///< of those; null: not limited
  std::vector<Contact> left;      ///< of the stance before, closed at `from`, where they are then
  std::vector<Contact> reached;   ///< of the stance after, closed at `to`, not held
  Eigen::VectorXd from, to;       ///< feasible for `held`; without `from` balls are at their places
  double joint_margin_rad = 0.0;  ///< to joint limits, where more than by default
  double self_margin_m = 0.0;     ///< of links from each other, likewise
  double torque_share = 1.0;      ///< of efforts, that timing uses
};

class SegmentSpace {
 public:
  /// lift_off_m: how far end effectors move along normals before a swing and after it. Throws Error
  /// as TransitionSolver does.
  SegmentSpace(std::shared_ptr<const RobotParameter> robot, World world, double lift_off_m = 0.035);

  /// As TransitionSolver does.
  void leave_as_near(const Eigen::VectorXd& q, double margin_m);
  /// The segment must outlive its use. Throws Error for contacts that are not sound.
  void set_segment(const Segment& segment);
  const Segment& segment() const { return *segment_; }

  /// Finds the moves along normals, for planners that begin and end beyond them. False: there are
  /// none; see why_not().
  bool lift_off();
  /// After lifting off, before touching down: the ends of lifted() and landing().
  const Eigen::VectorXd& from() const { return lifted_.back(); }
  const Eigen::VectorXd& to() const { return landing_.front(); }
  /// Waypoints from the segment's `from` to from(), and from to() to its `to`; ends included. One
  /// where nothing swings.
  const std::vector<Eigen::VectorXd>& lifted() const { return lifted_; }
  const std::vector<Eigen::VectorXd>& landing() const { return landing_; }
  double lift_off_m() const { return lift_off_m_; }

  const Robot& robot() const { return state_.robot(); }
  /// Rows of the closure of the contacts that are held.
  int closure_rows() const { return contacts_.rows(); }
  /// Closure of a configuration whose quaternion has norm 1 [m, rad].
  void closure(const Eigen::VectorXd& q, Eigen::VectorXd& error) { contacts_.closure(q, error); }
  /// The same with its Jacobian, closure_rows() x tangent_size, by the robot's tangent (robot.h).
  void closure(const Eigen::VectorXd& q, Eigen::VectorXd& error, Eigen::MatrixXd& jacobian) {
    contacts_.closure(q, error, jacobian);
  }
  /// Poses of links, of the last closure().
  const RobotState& state() const { return contacts_.state(); }

  /// From here on balls roll from there; of the contacts that are held. In the beginning: from
  /// `from`.
  void roll_from(HeldBalls balls);
  /// Where they are in a configuration.
  HeldBalls balls_at(const Eigen::VectorXd& q);
  bool has_balls() const;

  /// Moves q the shortest way to where the contacts are closed to 1e-9; false: not found.
  bool project(Eigen::VectorXd& q) { return contacts_.project(q); }
  /// Likewise with the contacts that are reached.
  bool project_end(Eigen::VectorXd& q);
  /// All that has to be positive is: distances to what is not touched, joints within limits, the
  /// centre of mass within what the contacts balance, torques. Contacts are not looked at.
  /// swinging: links of what is left or reached may be near it, without reaching into it.
  bool valid(const Eigen::VectorXd& q, bool swinging = false);
  /// What valid() looks at, for planners that go downhill; until the next call of any of these.
  const TransitionRows& rows_at(const Eigen::VectorXd& q, bool swinging = false);
  /// Of the last valid() or solve(): what was violated most, in words.
  const std::string& why_not() const { return why_not_; }
  /// Whether the way from a to b, brought back to the contacts every step_rad and more often where
  /// little room is left, is valid and stays near. a and b are closed and valid.
  bool valid_between(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double step_rad = 0.05,
                     bool swinging = false);
  /// Length of the straight way: the norm of the difference of joints [rad], base position and
  /// rotation, 1 m as 1 rad.
  double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
  Eigen::VectorXd half_way(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                           double fraction = 0.5) const;

  /// How far what is fixed to a contact's link is from all that it does not touch there, with the
  /// link in this pose; at most 0.1 m.
  double room_of(const Contact& contact, const Eigen::Isometry3d& world_from_link);

  /// A configuration near `start` that is closed and valid, by the solver of transitions;
  /// `also`: contacts that are closed besides those that are held, as places of what swings.
  bool solve(const Eigen::VectorXd& start, std::span<const Contact> also, Eigen::VectorXd& q);

 private:
  bool room_between(const Eigen::VectorXd& a, double room_a, const Eigen::VectorXd& b,
                    double room_b, double step_rad, bool swinging);
  bool move_along(const Eigen::VectorXd& from, std::span<const Contact> contacts,
                  std::vector<Eigen::VectorXd>& way);
  /// Of near_, those whose end effectors are there: at `also`, or in the configuration.
  std::vector<bool> what_is_near(const Eigen::VectorXd& q, std::span<const Contact> also);
  void set_rows(bool swinging, const std::vector<bool>& which);
  std::vector<Contact> chosen(const std::vector<bool>& which) const;

  RobotState state_;
  TransitionSolver solver_;
  TransitionRows rows_;
  double lift_off_m_;
  const Segment* segment_ = nullptr;
  ContactProjection contacts_;
  HeldBalls balls_;            ///< of the contacts that are held: from where they roll
  std::vector<Contact> near_;  ///< left and reached
  std::optional<std::pair<bool, std::vector<bool>>> rows_for_;  ///< what rows_ are set for
  std::vector<Eigen::VectorXd> lifted_, landing_;
  std::string why_not_;
  double room_m_ = 0.0;  ///< of the last valid(): to what is nearest
};

/// The contact that holds a contact's end effector in a pose of its link, off the ground.
/// with_axes: surfaces by point and axes; all else by the point alone.
Contact contact_in_air(const Robot& robot, const Contact& contact, const Eigen::Isometry3d& link,
                       bool with_axes);

/// Along which a contact leaves its place: its normal; of a grasp, which may have turned about its
/// bar, that of the hand.
Eigen::Vector3d way_off(const Contact& contact, const Eigen::Isometry3d& link);

}  // namespace locograph
