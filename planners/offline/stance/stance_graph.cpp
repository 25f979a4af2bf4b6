#include <locograph/check/judge.h>
#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/surface_distance/places_parameter.h>

#include <optional>
#include <utility>

namespace locograph {
namespace {

/// Those that the judge finds: what it answers, as in whole motions.
StanceWrenches wrenches_of(const Judge& judge, const Eigen::VectorXd& configuration,
                           const Stance& bearing, CheckOptions options) {
  options.certify_only_if_rest_holds = false;
  CheckReport report = judge.check(configuration, bearing, options);
  if (report.balance) return std::move(report.balance->wrenches);
  return StanceWrenches(bearing.contacts.size(), Eigen::Matrix<double, 6, 1>::Zero());
}

/// Of a task with an execution margin.
class LeastAtRest {
 public:
  explicit LeastAtRest(const Task& task)
      : task_(task), space_(task, options_), state_(*task.robot->robot) {}

  std::optional<StanceWrenches> wrenches_of(const Eigen::VectorXd& configuration,
                                            const Stance& bearing) {
    state_.update(configuration.data());
    const CheckOptions& check = task_.check;
    const std::vector<BearingContact> contacts = space_.bearing_contacts(space_.footing(bearing));
    return wrenches_at_rest(state_, contacts, task_.margin,
                            check.enforce_torque_limits ? check.effort_scale : 0.0);
  }

 private:
  const Task& task_;
  StancePlannerOptions options_;
  StanceSpace space_;
  RobotState state_;
};

}  // namespace

std::vector<int> add_task(Graph& graph, const Task& task, const std::vector<Stance>& stances,
                          const TaskPlanKind& kind) {
  graph.parameters().set(kRobotNumber, task.robot);
  graph.parameters().set(kWorldNumber, std::make_shared<const WorldParameter>(task.world));
  graph.parameters().set(kPlacesNumber, std::make_shared<const PlacesParameter>(
                                            task.robot, kRobotNumber, task.world->world()));
  const auto origin = std::make_shared<ScenarioParameter>();
  origin->scenario = task.scenario;
  graph.parameters().set(kScenarioNumber, origin);
  std::vector<int> numbers = add_stances(graph, task.robot, stances);
  const auto format = std::make_shared<PlanParameter>();
  format->stances_only = kind.stances_only;
  format->incomplete = kind.incomplete;
  format->moves = task.moves;
  format->margin = task.margin;
  graph.parameters().replace(kPlanNumber, format);
  return numbers;
}

Graph stance_graph(const Task& task, const StancePlan& plan) {
  Graph graph;
  const std::vector<int> numbers =
      add_task(graph, task, plan.stances, {.stances_only = true, .incomplete = !plan.success()});

  Motion motion{.time_s = {},
                .configurations = plan.configurations,
                .stances = plan.stances,
                .stance_from = {}};
  std::vector<StanceWrenches> wrenches;
  const Judge judge(task.robot->robot, task.world);
  const bool in_margin = task.margin != ExecutionMargin::none();
  LeastAtRest least(task);
  for (std::size_t i = 0; i < plan.configurations.size(); ++i) {
    motion.time_s.push_back(static_cast<double>(i));
    motion.stance_from.push_back(static_cast<int>(i));
    const Stance& bearing = bearing_stance(plan.stances[i == 0 ? i : i - 1], plan.stances[i]);
    std::optional<StanceWrenches> found;
    if (in_margin) found = least.wrenches_of(plan.configurations[i], bearing);
    wrenches.push_back(found ? std::move(*found)
                             : wrenches_of(judge, plan.configurations[i], bearing, task.check));
  }
  add_configurations(graph, motion, numbers);
  add_plan_edges(graph, motion_edges(task.check), wrenches);
  return graph;
}

}  // namespace locograph
