#pragma once
/// A plan is a graph: what planners and the judge read out of it.
///
///     Graph graph = read_graph("plan.g2o", types);
///     Plan plan = plan_of(graph);
///     for (int slot : plan.slots) std::cout << "base height " << graph.state(slot)[2] << " m\n";
///     CheckReport report = Judge(plan.robot->robot, world).check(motion_of(graph, plan));

#include <locograph/check/motion.h>
#include <locograph/core/graph.h>
#include <locograph/planners/plan/plan_index.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// A part of a plan in one stance; see PARAMS_SEGMENT.
struct PlanSegment {
  int first = 0, last = 0;  ///< of Plan::slots; the next one begins with the last of this
  double duration_s = 0.0;
  std::string planner;
};

struct Plan {
  /// The configuration vertices in order of time; those of a plan of stances as they stand in the
  /// graph.
  std::vector<int> slots;
  std::shared_ptr<const RobotParameter> robot;
  std::shared_ptr<const WorldParameter> world;  ///< null: nothing in the way
  int world_number = -1;                        ///< of that parameter
  /// Of each configuration the stance that is held from it to the next one; null: not known.
  std::vector<std::shared_ptr<const StanceParameter>> stance_from;
  /// Its file says so, and its times are 0, 1, 2, …, each step changes one contact, and it has no
  /// segments: else it is a motion.
  bool stances_only = false;
  bool says_stances_only = false;  ///< its file does, whatever it is
  bool incomplete = false;         ///< it ends before its goal
  bool recorded = false;           ///< no plan: the record of one carried out (record.h)
  bool states_wrenches = false;    ///< it has some
  ContactMoves moves;              ///< how its start and goals differ from its scenario's
  PlanIndex index;                 ///< where all of this is in the graph
  /// From the first configuration to the last; none: the plan does not say.
  std::vector<PlanSegment> segments;
};

/// Throws Error, with the line if the graph was read from a file, when it holds no configuration,
/// no PARAMS_PLAN, several robots, worlds or PARAMS_PLANs, configurations of several robots,
/// wrenches at contacts that are not in a stance of their configuration, and segments that are not
/// what the configurations are: one is missing or there twice, begins or ends at another time, or
/// is in another stance.
Plan plan_of(const Graph& graph);

Motion motion_of(const Graph& graph, const Plan& plan);
/// The part of it from one of its configurations to another, the last one included.
Motion motion_of(const Graph& graph, const Plan& plan, int first, int last);

/// Of each configuration the one that its EDGE_PLAN_TRACKING holds to; empty where it has none.
std::vector<Eigen::VectorXd> tracked_configurations(const Graph& graph, const Plan& plan);

/// The contacts of the stances before and after a configuration: what it has to close.
std::vector<int> contacts_at(const std::vector<std::shared_ptr<const StanceParameter>>& stance_from,
                             std::size_t i);

/// The first of the configurations that hold a contact, by its number, without a break until this
/// one is reached; this one where the step to it does not hold it.
int held_since(const std::vector<std::shared_ptr<const StanceParameter>>& stance_from, int contact,
               int configuration);

/// Says in its PARAMS_PLAN that the plan ends before its goal, and ends its segments where the
/// configurations end.
void mark_incomplete(Graph& graph);

/// Numbers of the parameters in a plan file. Contacts begin at kFirstContact; stances follow them.
inline constexpr int kRobotNumber = 0, kPlanNumber = 1, kWorldNumber = 2, kScenarioNumber = 3,
                     kContactsNumber = 4, kPlacesNumber = 5, kRecordNumber = 6, kFirstContact = 10;

/// Adds PARAMS_PLAN, and the stances with their contacts as parameters; contacts that are equal are
/// one. Returns the number of each stance.
std::vector<int> add_stances(Graph& graph, const std::shared_ptr<const RobotParameter>& robot,
                             const std::vector<Stance>& stances);

}  // namespace locograph
