#pragma once
/// What a check is asked and what it answers: options, violations, report.
///
///     CheckOptions options;
///     options.known = {left_foot, right_foot};  // what the scenario says that they can bear
///     CheckReport report = judge.check(motion, options);
///     for (const Violation& v : report.violations) std::cerr << violation_text(v) << '\n';
///     for (const std::string& what : report.trusted) std::cerr << "on trust: " << what << '\n';

#include <locograph/check/balance_certificate.h>
#include <locograph/robots/contact.h>

#include <Eigen/Core>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// What contacts and wheels are asked is not among them: see limits.h.
struct CheckOptions {
  /// What the scenario or the contacts file says that each end effector can bear, by its name. It
  /// counts instead of what a motion says of it.
  std::vector<EndEffector> known = {};
  /// Contacts whose places are known, by the word of a contacts file. A contact of a motion that is
  /// at none of its end effector's violates `contact_claims`. Empty: a motion says where it stands.
  std::vector<Contact> places = {};
  /// A motion that claims more than is known (a larger sole, more friction, larger forces, another
  /// kind, link or place) violates `contact_claims`. False: it is judged by what is known alone.
  bool compare_claims = true;
  /// False: contacts may also be on what the world does not describe, as in contacts files. What
  /// lies on no surface and no bar is then taken on trust. A world without any describes nothing
  /// anyway.
  bool surfaces_known = true;

  double base_linear_m_s = 0.0;            ///< largest speed; 0 or infinity: not limited
  double base_angular_rad_s = 0.0;         ///< the same
  double joint_acceleration_rad_s2 = 0.0;  ///< the same; m/s² for prismatic joints
  double effort_scale = 1.0;               ///< of the efforts of the URDF: the torque limits
  /// Whether the robot stands still before the first vertex and after the last one. False for a
  /// window of a longer motion: there is no acceleration then at that end.
  bool starts_at_rest = true, ends_at_rest = true;
  /// Where the motion ends, the robot stands still on, in the stance it ends in, until this time.
  std::optional<double> until_s = {};

  /// To obstacles and voxels; above 0 also to surfaces, bars and solids that a link touches neither
  /// in a step's stance nor in the one before or after it.
  double min_clearance_m = 0.0;
  double min_self_clearance_m = 0.0;  ///< of the pairs of Robot::self_collision_pairs()
  double min_balance_margin = 0.0;    ///< of balance_certificate.h, below 1
  bool enforce_torque_limits = true;  ///< else torques are told, and never too large
  /// Balance is judged only where nothing else is violated; else it is not judged, and the answer
  /// is no.
  bool certify_only_if_rest_holds = false;

  /// Sampling between vertices, for everything but distances: no point of a collision shape moves
  /// more than max_step_m from one sample to the next, or 0.1 mm from the chord between them, and
  /// neither base nor joints turn more than max_step_rad (a wheel about its own axle: 0.25).
  double max_step_m = 0.01;
  double max_step_rad = std::numbers::pi / 180.0;
  /// A step between vertices that would need more samples than this violates `step_size`; nothing
  /// else is checked between its vertices.
  int max_samples_per_step = 20000;
  /// Distances are searched for between the vertices, too: a step on which one is smaller than
  /// required by more than this is counted as violated, and nowhere along the motion is a clearance
  /// smaller than the reported minimum by more than this.
  double clearance_resolution_m = 1e-3;
  /// Between vertices balance is looked for at least as finely as this, where the margin is so
  /// small that the motion could use it up: how far contacts get as seen from the
  /// centre of mass, see balance_along.h.
  double balance_resolution_m = 0.005;

  /// Whether CheckReport::robustness is told.
  bool robustness = false;

  int threads = 1;  ///< of a motion; any number gives the same report
  /// False: a linear programme wherever balance is looked at. The same report, later: to test that.
  bool prove_nearby = true;
  /// If it is not empty, it is told the wrenches of the stance that is held from each vertex on (at
  /// the last one, of the stance that it ends in), in order, by the thread that called, once all
  /// are known: before the check returns; never where balance is not judged. They keep to all that
  /// is judged; not to be the ones of the largest margin, but of one no less than the least that is
  /// reported.
  std::function<void(int vertex, const StanceWrenches& wrenches)> on_balance = {};

  double joint_tolerance_rad = 1e-6;  ///< beyond a joint limit; metres for prismatic joints
  double velocity_tolerance = 1e-6;   ///< of a ratio of velocity or acceleration, for rounding
  double quaternion_tolerance = 1e-6;

  /// Throws Error naming the option that makes no sense.
  void validate() const;
};

/// One constraint: where it is violated most or, if it holds, where it comes closest to that.
struct Violation {
  std::string constraint;
  double worst = 0.0;  ///< means nothing where it was not judged
  std::string unit;
  double limit = 0.0;
  int at_vertex = 0;  ///< the earlier one if it happens between two
  int count = 0;      ///< vertices violated at, or on the way from them to the next
  double time_s = 0.0;
  Eigen::Vector3d at_point = Eigen::Vector3d::Zero();  ///< world; zero where there is no place
  std::string what;                                    ///< links, obstacle or joint concerned
  bool violated = false;
  bool judged = true;
  std::string why_not;  ///< why it was not judged
};

/// What texts say instead of a worst value that is not finite, as that of a contact in a world
/// where nothing faces it.
inline constexpr char kBeyondMeasure[] = "beyond all measure";

/// "contact_position (l_sole) is 0.31 m, limit 0.0001 m", or "… is not judged: …".
std::string violation_text(const Violation& violation);

/// How far a ball rolled while it was held, the most of all times.
struct BallRolling {
  std::string end_effector;
  double way_m = 0.0;   ///< of the place that touches, over what it rolls on
  double slip_m = 0.0;  ///< of its skin there, the most since it touched down
};

/// How far from falling, see robustness.h; nothing where there is nothing that may shrink, or no
/// limit that is enforced.
struct Robustness {
  std::optional<double> friction, area, torque;  ///< shares by which they may shrink
  std::optional<double> push_N;                  ///< at the centre of mass
  std::optional<double> mass;                    ///< at the root link, as a share of the robot's
};

struct RobustnessReport {
  struct OfStance {
    int stance = 0;                         ///< into Motion::stances
    int first_vertex = 0, last_vertex = 0;  ///< from the one to the other it is held
    double from_s = 0.0, until_s = 0.0;
    Robustness least;
  };
  Robustness least;
  std::vector<OfStance> by_stance;  ///< in the order of the motion
  double processor_s = 0.0;
};

/// Where a whole plan begins and what it gets to, by the word of its task; see plan_ends.h.
struct PlanEnds {
  std::string off_start;  ///< what is elsewhere where it begins; empty: nothing
  int goals_reached = 0, goals = 0;
  std::string off_goal;  ///< the same of the first goal that is not reached
  bool starts() const { return off_start.empty(); }
};

struct CheckReport {
  /// Every constraint that is required was judged and holds.
  bool feasible = false;
  int configurations = 0;             ///< vertices
  int samples = 0;                    ///< configurations looked at, vertices included
  std::vector<Violation> violations;  ///< every constraint, also those that hold, in fixed order
  /// What was taken on trust: "left_foot: what it can bear", …
  std::vector<std::string> trusted;

  // Nothing where nothing was judged.
  std::optional<double> min_clearance_m, min_self_clearance_m;  ///< the cutoff if nothing is nearer
  std::optional<double> min_balance_margin;
  std::optional<double> max_torque_ratio;  ///< where it balances
  std::optional<double> max_velocity_ratio, max_contact_error_m;
  std::vector<BallRolling> ball_rolling;  ///< by name
  /// Of the vertex with the least margin; one wrench for each contact of its stance.
  std::optional<BalanceCertificate> balance;

  std::optional<RobustnessReport> robustness;  ///< where it was asked for

  /// Nothing where no task is known; windows and postures have none.
  std::optional<PlanEnds> ends;

  double geometry_s = 0.0, balance_s = 0.0;  ///< what the check took

  /// The one that is violated most, by its unit: 0.01 m, 0.1 rad and 0.1 of a ratio count alike.
  /// Where none is, what was required and not judged; where all hold, the first.
  const Violation& worst() const;
  /// Those that are violated, the worst first by the same measure.
  std::vector<const Violation*> violated() const;
  /// Throws Error if there is no such constraint.
  const Violation& constraint(const std::string& name) const;
};

}  // namespace locograph
