#pragma once
/// When the proposals of an online planner are asked, and which of them is next.
///
///     ProposalSchedule schedule(standard_proposals(), online, 4);
///     if (!schedule.paused_at(executed)) {
///       answer = schedule.ask(online, window, termination, candidate);
///       if (answer == Proposal::Answer::kNone) schedule.pause_after(executed);
///     }
///
/// They take turns. One whose search is unfinished stays next. It hears of a new world after that:
/// a search whose world changes in each cycle would never end.

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

  /// From the cycle after `executed` on.
  void pause_after(int executed) { not_before_ = executed + 1 + pause_; }
  bool paused_at(int executed) const { return executed < not_before_; }

  void world_changed();
  /// A search that is unfinished does not go on.
  void give_up();

 private:
  std::vector<std::unique_ptr<Proposal>> proposals_;
  int pause_;
  std::size_t next_ = 0;
  bool unfinished_ = false;     ///< the search of the next one
  bool world_changed_ = false;  ///< since it began
  int not_before_ = 0;          ///< executed index
};

}  // namespace locograph
