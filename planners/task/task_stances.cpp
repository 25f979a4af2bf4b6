#include <locograph/planners/scenario/move_contacts.h>
#include <locograph/planners/scenario/snap_to_places.h>
#include <locograph/planners/task/task_stances.h>

#include <algorithm>
#include <random>
#include <string>

namespace locograph {

TaskStances task_stances(const Scenario& scenario, std::span<const EndEffector> effectors,
                         const World& world, const ContactMoves& moves) {
  TaskStances task{scenario.contacts->start, scenario.contacts->goals};
  const auto take_effectors = [&](Stance& stance) {
    for (Contact& contact : stance.contacts) {
      const auto found = std::ranges::find(effectors, contact.name(), &EndEffector::name);
      if (found != effectors.end()) contact.effector = *found;
    }
  };
  take_effectors(task.start);
  std::ranges::for_each(task.goals, take_effectors);
  const std::vector<std::string> scanned = scanned_names(scenario);
  snap_to_places(task.start, world, scanned);
  for (Stance& goal : task.goals) snap_to_places(goal, world, scanned);
  if (!(moves.most_m > 0.0)) return task;
  std::mt19937_64 goal_places(2 * moves.seed), start_places(2 * moves.seed + 1);
  for (Stance& goal : task.goals) move_contacts(goal, world, moves.most_m, goal_places);
  const Stance unmoved = task.start;
  for (int draw = 0; draw < moves.draws; ++draw) {
    task.start = unmoved;
    move_contacts(task.start, world, moves.most_m, start_places);
  }
  return task;
}

}  // namespace locograph
