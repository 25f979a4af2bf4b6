#pragma once
/// A transition as a value, and who works it out, on any thread.
///
///     BalanceRegions regions(mass_kg);
///     TaskSolver solver(task, regions);       // one for each thread
///     const TransitionResult result = solver.solve(transition);
///
/// The outcome depends on the task alone, bit for bit: not on what was solved before.

#include <locograph/planners/offline/stance/footing.h>
#include <locograph/planners/posture/transition_solver.h>
#include <locograph/planners/task/task.h>

#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace locograph {

/// From one footing to another with one contact more or less, whichever way.
struct TransitionTask {
  Footing larger, smaller;
  std::vector<Contact> closed = {};          ///< of the larger one
  std::vector<Contact> held = {};            ///< of the smaller one
  std::vector<BearingContact> bearing = {};  ///< of the smaller one
  /// Of the larger one, where they have to bear as well, each its least force; empty: they have
  /// not.
  std::vector<BearingContact> all_bearing = {};
  Eigen::VectorXd start = {};
  Eigen::VectorXd preferred = {};  ///< empty: where the task starts
  /// The configuration before, from which the balls roll that are held from there on: those of the
  /// smaller one, and of the contact that opens. Empty: balls are at their places.
  Eigen::VectorXd before = {};
  bool opens = false;  ///< the larger one comes first
  std::uint64_t seed = 0;
  TransitionOptions options = {};
};

/// Whether two tasks of one search ask for the same, to the last bit.
bool same_task(const TransitionTask& a, const TransitionTask& b);

/// What footings balance, each worked out once. Threads may share it.
class BalanceRegions {
 public:
  explicit BalanceRegions(double mass_kg) : mass_kg_(mass_kg) {}
  /// The reference stays valid.
  const BalanceRegion& of(const Footing& footing, std::span<const BearingContact> contacts);

 private:
  double mass_kg_;
  std::mutex mutex_;
  std::unordered_map<Footing, BalanceRegion, FootingHash> regions_;
};

/// Keeps references to both arguments. Copies are for other threads.
class TaskSolver {
 public:
  TaskSolver(const Task& task, BalanceRegions& regions);

  /// Throws Error for contacts that are not sound.
  TransitionResult solve(const TransitionTask& task);

 private:
  /// Of state_, as are those below.
  bool is_balanced(const TransitionTask& task, bool rolls) const;
  /// Asks for balance as it is there.
  void balance_here(const TransitionTask& task, bool rolls, TransitionProblem& problem);
  bool is_too_heavy(const TransitionTask& task, std::optional<TorqueProgramme>& torques) const;

  const Task& task_;
  BalanceRegions& regions_;
  TransitionSolver solver_;
  RobotState state_;
  BalanceRegion region_;       ///< of balance_here()
  Eigen::VectorXd preferred_;  ///< where the task starts, within the joint margin
};

}  // namespace locograph
