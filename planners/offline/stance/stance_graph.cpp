#include <locograph/check/judge.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/plan/balance_edges.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>

#include <utility>

namespace locograph {
namespace {

constexpr double kEdgeContact = 1e5, kEdgeLimit = 1e4;

/// Of the stances before and after a configuration, the one with fewer contacts.
std::size_t smaller_stance(const StancePlan& plan, std::size_t i) {
  if (i == 0) return 0;
  return plan.stances[i - 1].contacts.size() < plan.stances[i].contacts.size() ? i - 1 : i;
}
std::size_t larger_stance(const StancePlan& plan, std::size_t i) {
  if (i == 0) return 0;
  return smaller_stance(plan, i) == i ? i - 1 : i;
}

/// Those that the judge finds: what it answers, as in whole motions.
StanceWrenches wrenches_of(const Judge& judge, const Eigen::VectorXd& configuration,
                           const Stance& bearing, CheckOptions options) {
  options.certify_only_if_rest_holds = false;
  CheckReport report = judge.check(configuration, bearing, options);
  if (report.balance) return std::move(report.balance->wrenches);
  return StanceWrenches(bearing.contacts.size(), Eigen::Matrix<double, 6, 1>::Zero());
}

}  // namespace

std::vector<int> add_task(Graph& graph, const Scenario& scenario, const StanceProblem& problem,
                          const std::vector<Stance>& stances, const TaskPlanKind& kind) {
  graph.parameters().set(kRobotNumber, problem.robot);
  const auto world = std::make_shared<WorldParameter>();
  world->set_files(scenario.map, scenario.obstacles);
  graph.parameters().set(kWorldNumber, world);
  const auto origin = std::make_shared<ScenarioParameter>();
  origin->scenario = scenario.source;
  graph.parameters().set(kScenarioNumber, origin);
  std::vector<int> numbers = add_stances(graph, problem.robot, stances);
  const auto format = std::make_shared<PlanParameter>();
  format->stances_only = kind.stances_only;
  format->incomplete = kind.incomplete;
  format->moves = problem.moves;
  graph.parameters().replace(kPlanNumber, format);
  return numbers;
}

Graph stance_graph(const Scenario& scenario, const StanceProblem& problem, const StancePlan& plan) {
  Graph graph;
  const Robot& model = *problem.robot->robot;
  const std::vector<int> numbers = add_task(graph, scenario, problem, plan.stances,
                                            {.stances_only = true, .incomplete = !plan.success});

  const int count = static_cast<int>(plan.configurations.size());
  const Judge judge(problem.robot->robot, problem.world);
  for (int i = 0; i < count; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const Eigen::VectorXd& q = plan.configurations[k];
    const auto vertex =
        graph.add_vertex(i, VertexConfiguration(kRobotNumber, problem.robot, i, q, numbers[k]));
    const auto bearing = graph.parameters().get<StanceParameter>(numbers[smaller_stance(plan, k)]);
    const StanceWrenches wrenches = wrenches_of(judge, q, bearing->stance, problem.check);
    const auto closed = graph.parameters().get<StanceParameter>(numbers[larger_stance(plan, k)]);
    for (const int number : closed->contact_numbers) {
      const auto contact = graph.parameters().get<ContactParameter>(number);
      graph.add_edge(EdgeContact(*contact, number, kEdgeContact), vertex);
    }
    graph.add_edge(EdgeJointLimits(model, 0.0, kEdgeLimit), vertex);
    add_balance_edges(graph, vertex, *bearing, wrenches, count + i, problem.check);
  }
  return graph;
}

}  // namespace locograph
