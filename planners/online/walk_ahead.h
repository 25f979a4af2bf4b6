#pragma once
/// A walk along a plan (walk_plan.h) for something that carries it out: decided on some time ahead
/// of where that is, so that a robot that has to stop can brake.
///
///     WalkAhead walk(graph, world_seen_at, options);
///     for (double plan_time_s = 0.0; !walk.over(); plan_time_s += 0.02) {
///       if (std::optional<Motion> changed = walk.at(plan_time_s)) follow(*changed);
///     }
///
/// What has been carried out is never changed; what is handed out after it may be, until it is.

#include <locograph/planners/online/walk_plan.h>

#include <optional>

namespace locograph {

class WalkAhead {
 public:
  /// As PlanWalk.
  WalkAhead(Graph& graph, WorldAt world_at, const WalkOptions& options,
            double lead_s = kWalkLead_s);

  /// The plan is carried out up to this time of it, which never gets less. Gives all of the plan as
  /// it is then, where something of it has changed since the last time.
  std::optional<Motion> at(double plan_time_s);

  bool over() const { return over_; }
  WalkReport report() const { return walk_.report(); }

  /// How far ahead steps are decided on, both in time and in steps.
  static constexpr double kWalkLead_s = 1.0;
  static constexpr int kLeadSteps = 4;

 private:
  PlanWalk walk_;
  const double lead_s_;
  Motion motion_;  // as it was handed out
  bool over_ = false;
};

}  // namespace locograph
