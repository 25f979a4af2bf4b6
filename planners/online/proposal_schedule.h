#pragma once
/// When the proposals of an online planner are asked, and which of them is next.
///
///     ProposalSchedule schedule(standard_proposals(), online, 4);
///     if (!schedule.paused_at(executed)) {
///       answer = schedule.ask(online, window, termination, candidate);
///       if (answer == Proposal::Answer::kNone) schedule.pause_after(executed);
///     }
///
/// They take turns. One that the termination interrupts stays next and is due: the next cycle
/// begins with it.

#include <locograph/planners/online/proposal.h>

#include <memory>
#include <vector>

namespace locograph {

class ProposalSchedule {
 public:
  /// pause: cycles that a pause lasts.
  ProposalSchedule(const std::vector<ProposalFactory>& factories, const OnlinePlan& plan,
                   int pause);

  int size() const { return static_cast<int>(proposals_.size()); }

  /// Asks the next one; there must be one. Throws Error for a candidate that does not fit the
  /// window.
  Proposal::Answer ask(const OnlinePlan& plan, const Window& window, const Termination& termination,
                       std::vector<Eigen::VectorXd>& candidate);

  /// Whether a cycle is to begin with proposals.
  bool due() const { return due_; }
  void set_due(bool due) { due_ = due && !proposals_.empty(); }

  /// From the cycle after `executed` on.
  void pause_after(int executed) { not_before_ = executed + 1 + pause_; }
  bool paused_at(int executed) const { return executed < not_before_; }

  void world_changed();

 private:
  std::vector<std::unique_ptr<Proposal>> proposals_;
  int pause_;
  std::size_t next_ = 0;
  bool due_ = false;
  int not_before_ = 0;  ///< executed index
};

}  // namespace locograph
