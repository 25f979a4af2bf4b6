#pragma once
/// What stance planners search in: places that end effectors may touch, stances made of them, and
/// the transitions between these.
///
///     StanceSpace space(task, options);
///     const Footing start = space.footing(task.start);
///     const Footing lifted = without(start, 0);
///     const StanceSpace::Attempt attempt = space.try_transition(start, lifted, q, 0);
///
/// A place is an end effector's contact at one point of the world; places that are equal are one.
/// Balls that are held roll: where transitions are asked for, `before` is the configuration that
/// closes the contacts of `from`, whose balls roll from there by the shortest turn; null: all balls
/// are at their places.

#include <locograph/planners/offline/stance/footing.h>
#include <locograph/planners/offline/stance/stance_plan.h>
#include <locograph/planners/offline/stance/transition_ahead.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/box_tree.h>

#include <algorithm>
#include <map>
#include <memory>
#include <unordered_set>
#include <vector>

namespace locograph {

class StanceSpace {
 public:
  struct Place {
    int effector;
    BearingContact bearing;
  };
  struct Attempt {
    bool found = false;
    Eigen::VectorXd configuration;
    TransitionFailure failure = TransitionFailure::kNone;
    std::string reason = {};  ///< in words
  };

  /// One that try_transition() may be asked for.
  struct Expected {
    Footing from, to;
    Eigen::VectorXd start = {};
    int restarts = 0;
    /// Of a chain's second one any configuration: what is found for the first takes its place.
    const Eigen::VectorXd* before = nullptr;
  };

  StanceSpace(const Task& task, const StancePlannerOptions& options);

  const Task& task() const { return task_; }
  int effectors() const { return static_cast<int>(task_.end_effectors().size()); }
  const Place& place(int number) const { return places_[static_cast<std::size_t>(number)]; }
  double reach_m(int effector) const { return reach_m_[static_cast<std::size_t>(effector)]; }

  /// Throws Error for a contact of an unknown end effector.
  Footing footing(const Stance& stance);
  Stance stance(const Footing& footing) const;
  /// Its contacts with what they can bear where they are.
  std::vector<BearingContact> bearing_contacts(const Footing& footing) const;
  /// What part of the task's execution margin is asked of a footing: all of it, of the start and
  /// the goals, which are given, as much as leaves room for the centre of mass.
  double margin_share(const Footing& footing) const;
  /// The same, less that part of the margin.
  std::vector<BearingContact> counted_contacts(const Footing& footing) const;

  /// Where the end effector's point is in a configuration [m, world].
  Eigen::Vector3d position(int effector, const Eigen::VectorXd& q);
  /// Places of the end effector on surfaces and bars that are no further than `reach` from a point,
  /// in the order of the surfaces. See StancePlannerOptions::approachable_only.
  std::vector<int> places_near(int effector, const Eigen::Vector3d& point, double reach_m);

  /// From one footing to the next, which has one contact more or less: what is closed are the
  /// contacts of the larger one, what balances is the smaller one. Counts.
  Attempt try_transition(const Footing& from, const Footing& to, const Eigen::VectorXd& start,
                         int restarts, const Eigen::VectorXd* before = nullptr);
  /// The same again, and nothing of it kept: with wider margins.
  Attempt try_harder(const Footing& from, const Footing& to, const Eigen::VectorXd& start,
                     const Eigen::VectorXd* before = nullptr);
  /// Another posture for a transition that was found before: as near `start` as can be; nothing of
  /// it is kept, and it does not count.
  Attempt try_nearby(const Footing& from, const Footing& to, const Eigen::VectorXd& start,
                     const Eigen::VectorXd* before = nullptr);
  /// Likewise as try_transition() finds it, and observed as that is.
  Attempt try_again(const Footing& from, const Footing& to, const Eigen::VectorXd& start,
                    const Eigen::VectorXd* before = nullptr);
  /// How far the balls of `from` slip between two configurations, or are off what they touch [m].
  double slip_m(const Footing& from, const Eigen::VectorXd& before, const Eigen::VectorXd& after);
  /// Its contacts, with the balls that `held` has as well where they are in a configuration.
  Stance rolled_stance(const Footing& footing, const Footing& held, const Eigen::VectorXd& q);
  /// A posture in one stance, near `start`; further attempts have other seeds and wider margins.
  Attempt stand(const Stance& stance, const Eigen::VectorXd& start, int attempt);
  /// The transition is not to be found again: the judge refused it.
  void forbid(const Footing& from, const Footing& to);

  /// What is likely to be asked for next, the likeliest first: other threads begin with it
  /// (transition_ahead.h), and no result is another one. A chain has one or two transitions; the
  /// second goes on from what is found for the first, whatever its `start`. Nothing on one thread.
  void expect(const std::vector<std::vector<Expected>>& chains);
  /// StancePlannerOptions::threads, as far as they are of use.
  int threads() const { return std::min(options_.threads, kMostThreads); }
  /// What was expected before will not be asked for any more.
  void expect_nothing();

  /// From here on transitions count for the next goal; StanceSearch calls it.
  void begin_goal() { began_ = transitions; }
  /// How many transitions may still be tried for this goal, below 0 where shortening and mending
  /// took more; the largest int: any number.
  int transitions_left() const;
  /// StancePlannerOptions::max_transitions is used up for this goal.
  bool tried_enough() const { return transitions_left() <= 0; }

  /// Stopped, or the time allowed is used up.
  bool ended() const { return options_.termination.ended(iterations); }

  int iterations = 0;  ///< counted by searches
  int transitions = 0, transitions_found = 0;
  double transitions_s = 0.0;
  std::vector<StanceFailure> failures() const;
  void count_failure(int effector, const std::string& what);

 private:
  int intern(int effector, const Contact& contact);
  int effector_of(const Contact& contact) const;
  /// What touches a place comes to it along its normal without meeting a surface.
  bool has_room(int number);
  /// Of World::surfaces, those that the end effector may lie on there, and a few more.
  std::vector<int> surfaces_at(const Contact& contact) const;
  void places_on(int effector, const Surface& surface, const Eigen::Vector3d& point, double reach_m,
                 std::vector<int>& places);
  void places_on(int effector, const Bar& bar, const Eigen::Vector3d& point, double reach_m,
                 std::vector<int>& places);
  std::vector<Eigen::Vector2d> area_on_surfaces(const Contact& contact) const;
  double friction_at(const Contact& contact) const;
  std::optional<RoundBar> bar_at(const Contact& contact) const;
  bool has_balls(const Footing& footing) const;
  TransitionTask task_of(const Footing& from, const Footing& to, const Eigen::VectorXd& start,
                         std::uint64_t seed, const TransitionOptions& options,
                         const Eigen::VectorXd* before) const;
  Attempt solve(const TransitionTask& task);
  /// Counts.
  Attempt change(const TransitionTask& task);
  /// See StancePlannerOptions::observe.
  void tell(const TransitionTask& task, const Footing& from, const Footing& to, bool found,
            double seconds) const;

  /// What is expected further ahead is hardly ever asked for.
  static constexpr int kMostThreads = 8;

  const Task& task_;
  const StancePlannerOptions& options_;
  BalanceRegions regions_;
  TaskSolver solver_;
  std::unique_ptr<TransitionAhead> ahead_;  ///< once there is something to work out ahead
  RobotState state_, after_;
  std::vector<double> reach_m_;
  BoxTree surfaces_;
  std::vector<Place> places_;
  std::map<int, bool> has_room_;  ///< of places, once they were asked for
  std::map<std::vector<long long>, int> numbers_;
  std::unordered_set<Footing, FootingHash> refused_;  ///< transitions, as joined() gives them
  std::map<std::pair<int, std::string>, int> failures_;
  std::map<Footing, double> given_shares_;  ///< of the execution margin, of start and goals
  int began_ = 0;                           ///< transitions tried before this goal
};

}  // namespace locograph
