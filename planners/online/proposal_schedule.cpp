#include <locograph/common/error.h>
#include <locograph/planners/online/proposal_schedule.h>

#include <utility>

namespace locograph {
namespace {

void require_fit(const std::vector<Eigen::VectorXd>& candidate, const OnlinePlan& plan,
                 const Window& window) {
  const std::size_t steps = static_cast<std::size_t>(window.steps());
  if (candidate.size() != steps) {
    throw Error("a proposal of " + std::to_string(candidate.size()) + " configurations",
                std::to_string(steps) + ", as many as the window has");
  }
  const Eigen::Index size = plan.planned().front().size();
  for (const Eigen::VectorXd& q : candidate) {
    if (q.size() == size) continue;
    throw Error("a proposed configuration of " + std::to_string(q.size()) + " numbers",
                std::to_string(size));
  }
}

}  // namespace

ProposalSchedule::ProposalSchedule(const std::vector<ProposalFactory>& factories,
                                   const OnlinePlan& plan, int pause)
    : pause_(pause) {
  for (const ProposalFactory& make : factories) proposals_.push_back(make(plan));
}

Proposal::Answer ProposalSchedule::ask(const OnlinePlan& plan, const Window& window,
                                       const Termination& termination,
                                       std::vector<Eigen::VectorXd>& candidate) {
  const Proposal::Answer answer = proposals_[next_]->search(plan, window, termination, candidate);
  if (answer == Proposal::Answer::kFound) require_fit(candidate, plan, window);
  unfinished_ = answer == Proposal::Answer::kUnfinished;
  if (unfinished_) return answer;
  next_ = (next_ + 1) % proposals_.size();
  give_up();
  return answer;
}

void ProposalSchedule::give_up() {
  unfinished_ = false;
  if (std::exchange(world_changed_, false)) world_changed();
}

void ProposalSchedule::world_changed() {
  world_changed_ = unfinished_;
  if (unfinished_) return;
  for (const std::unique_ptr<Proposal>& proposal : proposals_) proposal->world_changed();
}

}  // namespace locograph
