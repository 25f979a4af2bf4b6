#pragma once
/// Plans a drive on wheels along a line or an arc, legs at rest, and emits it as a graph.
///
///     Scenario scenario = load_scenario("centauro_drive", data_folder);
///     Graph plan = plan_wheeled_drive(scenario);
///     write_graph(plan, "plan.g2o");
///
/// The base follows the path at constant height, from rest to rest: at the drive's speed but for
/// whole steps at both ends, in which it speeds up and brakes by at most 0.5 m/s^2. Each wheel is
/// steered at right angles to the line from the instantaneous centre of rotation and turned as far
/// as its centre moves. The first configuration is the scenario's start state lifted so that the
/// wheels stand on z = 0, base above the origin, heading +x, wheels already steered into the arc.
/// Its one stance is that of all wheels on the ground.

#include <locograph/common/job_control.h>
#include <locograph/core/graph.h>
#include <locograph/planners/scenario/scenario.h>

#include <optional>

namespace locograph {

/// Throws Error when the scenario has no drive, when its robot has no collision shapes, when its
/// wheels do not stand on one level in the start state, or when a wheel cannot be steered.
Graph plan_wheeled_drive(const Scenario& scenario);
/// Nothing when the job ends before the plan is whole.
std::optional<Graph> plan_wheeled_drive(const Scenario& scenario, const JobControl& job);

}  // namespace locograph
