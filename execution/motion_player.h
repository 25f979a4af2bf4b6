#pragma once
/// Where a motion that is carried out should be now: plan time, stances, and what contacts bear.
///
///     MotionPlayer player(robot, effectors, world, motion);
///     while (!player.done()) {
///       player.advance(measured);                       // one for each end effector
///       engine.set_torques(controller.torques(configuration, velocity, player.reference(),
///                                             player.contacts()));
///       engine.step();
///     }
///
/// Plan time goes on as long as all contacts that should bear do so. A contact that is late is
/// waited for at its change of stance, where the robot stands; one that is early is taken. Where a
/// contact gets lost, plan time slows down and stops until it is found again. Contacts are loaded
/// and unloaded while the robot stands at a change of stance: as long as the plan has it stand
/// there, and where that is shorter than PlayerOptions::dwell_s, as long as that.
///
/// What contacts can bear is what of them lies on something in the world, with its friction.
///
/// A contact that is not found, or slips too far, is given up: it follows the reference, and the
/// motion halts for good. A motion that does not end at rest is slowed down before it ends.
/// advance() does not allocate. Keeps a pointer to the robot, which must
/// outlive it; the motion is copied.

#include <locograph/check/motion.h>
#include <locograph/check/motion_curve.h>
#include <locograph/execution/torque_controller.h>
#include <locograph/world/world.h>

#include <span>
#include <string>
#include <vector>

namespace locograph {

struct PlayerOptions {
  double cycle_s = 0.001;
  double dwell_s = 0.3;       ///< at changes of stance where the plan has less
  double settle_s = 0.5;      ///< before it starts
  double end_s = 1.0;         ///< that it stands at the end
  double patience_s = 1.0;    ///< with contacts that are late or lost
  double early_s = 0.4;       ///< by which a contact may be early
  double touch = 0.002;       ///< that tells of a contact
  double most_slip_m = 0.03;  ///< of a contact that is kept
  HoldingShares shares = {};
  double stopping_s = 0.25;  ///< in which plan time stops, or goes on again

  /// Throws Error naming the number that is negative or not finite.
  void validate() const;
};

/// Of one end effector.
struct TouchMeasurement {
  double pressing_N = 0.0;  ///< of a grasp: infinite while the hand is closed round the bar
  double slip_m = 0.0;      ///< since it was held
};

class MotionPlayer {
 public:
  /// Throws Error for a motion without times, steps whose stance is not known, and contacts of end
  /// effectors that are not among those given.
  MotionPlayer(const Robot& robot, std::span<const EndEffector> effectors, const World& world,
               Motion motion, const PlayerOptions& options = {});
  MotionPlayer(const MotionPlayer&) = delete;
  MotionPlayer& operator=(const MotionPlayer&) = delete;

  /// Goes on along another motion, which is the same as before up to the configuration after
  /// plan_time_s(): configurations, slopes, times and stances. Throws Error as the constructor
  /// does, and for a motion that ends before that.
  void follow(const World& world, Motion motion);

  /// One cycle on.
  void advance(std::span<const TouchMeasurement> measured);

  const CurvePoint& reference() const { return reference_; }
  std::span<const ContactCommand> contacts() const { return commands_; }
  const Motion& motion() const { return motion_; }

  /// That an end effector holds in the next stance; null: none.
  const Contact* next_contact(std::size_t effector) const;

  double plan_time_s() const { return time_s_; }
  /// The stance that is held now, into motion().stances.
  int stance() const;
  /// It has stood at the end for as long as it should, or halted for as long.
  bool done() const { return stood_s_ >= options_.end_s; }
  bool at_end() const { return at_end_; }
  /// Why it halts for good; empty: it does not.
  const std::string& halted() const { return halted_; }
  double waited_s() const { return waited_s_; }

 private:
  /// Of the same stance.
  struct Interval {
    int first = 0, last = 0;                           ///< vertices
    double still_before_s = 0.0, still_after_s = 0.0;  ///< that it stands at its start, at its end
    double hold_before_s = 0.0, hold_after_s = 0.0;    ///< that is added there
    std::vector<int> contact;                          ///< of each end effector; -1: none
    std::vector<char> closes, opens;                   ///< at its start, at its end
  };
  struct Touch {
    bool touches = true, was_lifted = false, given_up = false;
    double presence = 1.0;  ///< 0 to 1, of a debounced measurement
    double loaded_s = 0.0;  ///< since it touches
    double absent_s = 0.0;
  };

  void take(const World& world);
  void find_intervals();
  void find_still_times(Interval& interval) const;
  bool measure(std::span<const TouchMeasurement> measured);
  void move_on(bool all_bear);
  void set_reference();
  void set_commands();
  void find_what_holds(const World& world);
  const HeldContact* contact_of(std::size_t interval, std::size_t effector) const;
  double closing_share(const Interval& interval, std::size_t effector) const;
  double opening_share(const Interval& interval) const;
  void set_wrench(std::size_t effector);

  const Robot& robot_;
  const std::vector<EndEffector> effectors_;
  Motion motion_;
  const PlayerOptions options_;
  const double touch_N_;
  MotionCurve curve_;
  std::vector<CurveStep> steps_;
  std::vector<Interval> intervals_;
  std::vector<std::vector<HeldContact>> held_;  ///< of the contacts of each stance
  std::vector<Touch> touches_;
  std::vector<ContactCommand> commands_;
  std::vector<std::string> names_;
  CurvePoint reference_;
  std::size_t now_ = 0;  // into intervals_
  int vertex_ = 0;       // whose step the time is in
  double time_s_ = 0.0;  // of the plan
  double rate_ = 0.0, change_of_rate_ = 0.0;
  double settled_s_ = 0.0, stood_s_ = 0.0, waited_s_ = 0.0;
  double held_before_s_ = 0.0, held_after_s_ = 0.0;  // of what the interval now adds
  bool at_end_ = false, ends_at_rest_ = true;
  std::string halted_;
};

}  // namespace locograph
