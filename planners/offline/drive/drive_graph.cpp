#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/plugins/configuration/plan_parameters.h>

#include <memory>
#include <vector>

namespace locograph {

std::optional<Graph> drive_graph(const Task& task, const Motion& motion, const JobControl& job) {
  Graph graph;
  graph.parameters().set(kRobotNumber, task.robot);
  // As its file will say: what is scanned to be driven on is not among what is in the way.
  graph.parameters().set(
      kWorldNumber, std::make_shared<const WorldParameter>(task.world->files(), task.ground_z_m));
  const auto origin = std::make_shared<ScenarioParameter>();
  origin->scenario = task.scenario;
  graph.parameters().set(kScenarioNumber, origin);
  const std::vector<int> numbers = add_stances(graph, task.robot, motion.stances);
  if (!add_configurations(graph, motion, numbers, job)) return {};
  if (!add_plan_edges(graph, drive_edges(), {}, job)) return {};
  return graph;
}

}  // namespace locograph
