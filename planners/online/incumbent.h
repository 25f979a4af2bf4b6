#pragma once
/// The best window of a cycle so far: a cycle hands it out, whenever it ends.
///
///     Incumbent incumbent;
///     incumbent.offer(quality, state);                   // where the cycle begins
///     while (search(quality, state)) incumbent.offer(quality, state);
///     if (incumbent.best().quality.feasible()) hand_out(incumbent.best().state);
///
/// The best is never replaced by a worse window (window_quality.h). The least violating window is
/// remembered beside it: the best may hold for more steps and violate more after them, but
/// constraints are raised from where they are violated least.
///
/// Does not allocate once windows of their size have been seen.

#include <locograph/planners/online/window_quality.h>

#include <vector>

namespace locograph {

/// A window as the solver had it, and how good it is.
struct WindowCandidate {
  WindowQuality quality;
  std::vector<double> state;  ///< of a Workspace; empty: none
};

class Incumbent {
 public:
  /// Before the first candidate of a cycle.
  void clear();

  /// Whether it is better than the best so far, and now is the best.
  bool offer(const WindowQuality& quality, const std::vector<double>& state);

  const WindowCandidate& best() const { return best_; }
  const WindowCandidate& least_violating() const { return least_violating_; }

  /// The state that is worth another cycle beside the best: where the deadline cut the last run
  /// short (null: nowhere), else the least violating one while the best is infeasible. Null when
  /// there is none, or when it is the best.
  const std::vector<double>* unfinished(const std::vector<double>* cut_short) const;

 private:
  WindowCandidate best_, least_violating_;
};

}  // namespace locograph
