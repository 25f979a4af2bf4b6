#pragma once
/// Start and goals of a scenario's contact task as planners and the judge take them.
///
///     const TaskStances task = task_stances(scenario, scenario.end_effectors, world_of(scenario));
///     const TaskStances similar =
///         task_stances(scenario, scenario.end_effectors, world, {.most_m = 0.05, .seed = 3});

#include <locograph/planners/scenario/scenario.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/robots/contact.h>
#include <locograph/world/world.h>

#include <span>
#include <vector>

namespace locograph {

struct TaskStances {
  Stance start;
  std::vector<Stance> goals;
};

/// effectors: the scenario's, of the same names, as they touch. Contacts on scans are brought onto
/// them (snap_to_places.h), then moved as it is asked (move_contacts.h): those of the start
/// ContactMoves::draws times anew from where they were, of which the last counts. The goals do not
/// depend on that. The scenario must have a contact task, world must be its own, and contacts that
/// are to be moved must be sound.
TaskStances task_stances(const Scenario& scenario, std::span<const EndEffector> effectors,
                         const World& world, const ContactMoves& moves = {});

}  // namespace locograph
