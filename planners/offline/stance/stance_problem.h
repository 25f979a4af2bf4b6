#pragma once
/// A scenario's contact task as a stance planner takes it.
///
///     const Scenario scenario = load_scenario("ladder_climbing", data_folder);
///     const StanceProblem problem = stance_problem(scenario).problem;
///     const StanceProblem similar = stance_problem(scenario, {.most_m = 0.05, .seed = 3}).problem;

#include <locograph/planners/offline/stance/stance_planner.h>
#include <locograph/planners/scenario/scenario.h>

#include <cstdint>

namespace locograph {

/// The contacts of the start and of the goals moved at random, see move_contacts.h.
struct ContactMoves {
  double most_m = 0.0;  ///< 0: they stay
  std::uint64_t seed = 0;
};

struct StartedProblem {
  StanceProblem problem;
  /// How far the start configuration is from the scenario's [m, rad]; 0: as given.
  double moved_base_m = 0.0, moved_joint_rad = 0.0;
  int draws = 1;  ///< of the start's contacts, until a configuration was found that stands there
};

/// Loads robot and world. Where the scenario's start configuration misses its contacts, touches
/// something or does not balance, the nearest one is found that does not. Throws Error for a
/// scenario without a contact task, for unknown links and joints, contacts that are on nothing, and
/// a start for which no configuration is found: with the line and by how much.
///
/// Contacts are moved after those on scans were brought onto them. A start in which no
/// configuration is found to stand is drawn again, up to 20 times in all, as without one there is
/// no task; goals are not, whether they can be reached or not. They do not depend on the draws of
/// the start.
StartedProblem stance_problem(const Scenario& scenario, const ContactMoves& moves = {});

}  // namespace locograph
