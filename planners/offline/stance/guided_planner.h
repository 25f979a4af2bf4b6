#pragma once
/// The planner "guided": see stance_planners.h.

#include <locograph/planners/offline/stance/stance_planner.h>

namespace locograph {

/// Best-first search over moves: an end effector is lifted and put down elsewhere. What promises
/// most is tried first, by stances so far, stances to go were there no balance and no limits (each
/// end effector by itself, in moves of the lengths that have worked), how often moves like it have
/// failed, how crowded the tree is there, and noise. Transitions are only solved for what is tried.
/// After 75 transitions the tree is begun anew with other noise, each time with a quarter
/// more, in an execution margin with a twentieth;
/// what failed is remembered. Every second time two trees grow towards each other, one of them
/// backwards from the goal: a transition serves both ways.
class GuidedPlanner final : public StancePlanner {
 public:
  const std::string& name() const override;
  std::unique_ptr<StanceSearch> begin(const Task& task,
                                      const StancePlannerOptions& options) const override;
};

}  // namespace locograph
