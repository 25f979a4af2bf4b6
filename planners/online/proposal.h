#pragma once
/// A search for other windows to optimise from. A local optimiser only slides downhill from where
/// it begins; a proposal may jump, for instance to the other side of an obstacle.
///
///     struct AsPlanned : Proposal {
///       Answer search(const OnlinePlan& online, const Window& window, const Termination&,
///                     std::vector<Eigen::VectorXd>& candidate) override {
///         candidate.assign(online.planned().begin() + window.first(),
///                          online.planned().begin() + window.end());
///         return Answer::kFound;
///       }
///     };
///
///     options.proposals = standard_proposals();
///     options.proposals.push_back(
///         [](const OnlinePlan&) { return std::make_unique<AsPlanned>(); });
///
/// A candidate need not be feasible: the planner optimises from it, and takes the result only if it
/// is better than the best window so far. doc/window_proposals.md tells how to add one to the
/// standard proposals.

#include <locograph/common/termination.h>
#include <locograph/planners/online/window.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

namespace locograph {

class Proposal {
 public:
  enum class Answer {
    kFound,       ///< the candidate is complete
    kNone,        ///< there is nothing to propose for this window
    kUnfinished,  ///< the termination ended it: the next cycle begins with this proposal
  };

  virtual ~Proposal() = default;

  /// One slice of the search. Returns soon after the termination ends it; intermediate results are
  /// kept for the next call, whose window may have moved on by then. Every call makes some
  /// progress, also after that. kUnfinished is for searches that the termination ended. A
  /// termination that counts iterations counts pieces of work that take some microseconds each: the
  /// same slices on every machine.
  ///
  /// candidate: on kFound the configurations of the window in their order; those that are fixed in
  /// the plan are ignored. Read planned configurations, fixed ones, and those up to the executed
  /// one: free configurations of the window are in no defined place during the call.
  virtual Answer search(const OnlinePlan& plan, const Window& window,
                        const Termination& termination,
                        std::vector<Eigen::VectorXd>& candidate) = 0;

  /// The world has changed, or the plan has been moved by some mm or slowed down: intermediate
  /// results about it do not hold any more. A search that is unfinished goes on as it is, and hears
  /// of it afterwards.
  virtual void world_changed() {}
};

using ProposalFactory = std::function<std::unique_ptr<Proposal>(const OnlinePlan& plan)>;

}  // namespace locograph
