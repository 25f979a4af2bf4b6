#pragma once
/// A scenario's contact task with a configuration that stands at its start: what stance planners
/// begin with.
///
///     const Scenario scenario = load_scenario("ladder_climbing", data_folder);
///     const Task task = started_task(scenario).task;
///     const Task similar = started_task(scenario, {.most_m = 0.05, .seed = 3}).task;

#include <locograph/planners/task/task.h>

namespace locograph {

struct StartedTask {
  Task task;
  /// How far the start configuration is from the scenario's [m, rad]; 0: as given.
  double moved_base_m = 0.0, moved_joint_rad = 0.0;
};

/// Loads robot and world. Where the scenario's start configuration misses its contacts, touches
/// something or does not balance, the nearest one is found that does not. Throws Error for a
/// scenario without a contact task, for a robot without collision shapes, for unknown links and
/// joints, contacts that are on nothing, and a start for which no configuration is found: with the
/// line and by how much.
///
/// Soles of start and goals without a direction `forward` get the one that they have in the start
/// configuration.
///
/// moves: of the contacts, see task_stances.h; its draws are found, not asked for. A start in which
/// no configuration is found to stand is drawn again, up to kMostDraws times in all, as without one
/// there is no task; goals are not, whether they can be reached or not.
///
/// Throws OutOfTime when the deadline passes before there is a start.
StartedTask started_task(const Scenario& scenario, const ContactMoves& moves = {},
                         const Deadline& deadline = {});

}  // namespace locograph
