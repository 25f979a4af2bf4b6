#pragma once
/// A plan is a graph: what planners and the judge read out of it.
///
///     Graph graph = read_graph("plan.g2o", types);
///     Plan plan = plan_of(graph);
///     for (int slot : plan.slots) std::cout << "base height " << graph.state(slot)[2] << " m\n";
///     CheckReport report = Judge(plan.robot->robot, world).check(motion_of(graph, plan));

#include <locograph/check/motion.h>
#include <locograph/core/graph.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/contact/stance_parameter.h>

#include <memory>
#include <vector>

namespace locograph {

struct Plan {
  /// The configuration vertices in order of time; those of a plan of stances as they stand in the
  /// graph.
  std::vector<int> slots;
  std::shared_ptr<const RobotParameter> robot;
  std::shared_ptr<const WorldParameter> world;  ///< null: nothing in the way
  /// Of each configuration the stance that is held from it to the next one; null: not known.
  std::vector<std::shared_ptr<const StanceParameter>> stance_from;
  bool stances_only = false;
  bool incomplete = false;  ///< it ends before its goal
  ContactMoves moves;       ///< how its start and goals differ from its scenario's
};

/// Throws Error, with the line if the graph was read from a file, when it holds no configuration,
/// no PARAMS_PLAN, several robots, worlds or PARAMS_PLANs, configurations of several robots, and
/// wrenches at contacts that are not in a stance of their configuration.
Plan plan_of(const Graph& graph);

Motion motion_of(const Graph& graph, const Plan& plan);

/// Says in its PARAMS_PLAN that the plan ends before its goal.
void mark_incomplete(Graph& graph);

/// Numbers of the parameters in a plan file. Contacts begin at kFirstContact; stances follow them.
inline constexpr int kRobotNumber = 0, kPlanNumber = 1, kWorldNumber = 2, kScenarioNumber = 3,
                     kContactsNumber = 4, kFirstContact = 10;

/// Adds PARAMS_PLAN, and the stances with their contacts as parameters; contacts that are equal are
/// one. Returns the number of each stance.
std::vector<int> add_stances(Graph& graph, const std::shared_ptr<const RobotParameter>& robot,
                             const std::vector<Stance>& stances);

}  // namespace locograph
