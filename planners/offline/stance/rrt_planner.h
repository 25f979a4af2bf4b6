#pragma once
/// The planner "rrt": the published one, a random tree in contact space.
///
///     const auto planner = make_stance_planner("rrt");
///     const StancePlan plan = planner->plan(task, {.seed = 7});
///
/// Rossini et al., "Loco-Manipulation Planning for Legged Robots: Offline and Online Strategies",
/// after Ferrari et al. 2023. Other than there, transitions are those of stance_space.h, the last
/// one is checked like every other, vertices wear out instead of being closed after six attempts,
/// and how few contacts may remain depends on the start and the goal.

#include <locograph/planners/offline/stance/stance_planner.h>

namespace locograph {

/// An iteration draws an end effector and a point for it: mostly a contact of the goal, else
/// anything. A vertex is drawn by weight: one by the end effector's distance to the point, halved
/// by every five attempts made there. If the end effector is in contact it is lifted, else put down
/// in reach of where it is, nearest to the point. A new stance with a transition to it is a new
/// vertex. Ends without success where 5000 iterations, one after the other, give nothing to try.
class RrtPlanner final : public StancePlanner {
 public:
  const std::string& name() const override;
  std::unique_ptr<StanceSearch> begin(const Task& task,
                                      const StancePlannerOptions& options) const override;
};

}  // namespace locograph
