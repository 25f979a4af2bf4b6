#include <locograph/check/balance_certificate.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>
#include <locograph/robots/statics.h>

namespace locograph {
namespace {

constexpr double kEdgeContact = 1e5, kEdgeLimit = 1e4, kEdgeBalance = 1e4, kEdgeWrench = 1e3,
                 kEdgeTorque = 1e2;

/// Of the stances before and after a configuration, the one with fewer contacts.
std::size_t smaller_stance(const StancePlan& plan, std::size_t i) {
  if (i == 0) return 0;
  return plan.stances[i - 1].contacts.size() < plan.stances[i].contacts.size() ? i - 1 : i;
}
std::size_t larger_stance(const StancePlan& plan, std::size_t i) {
  if (i == 0) return 0;
  return smaller_stance(plan, i) == i ? i - 1 : i;
}

}  // namespace

Graph stance_graph(const Scenario& scenario, const StanceProblem& problem, const StancePlan& plan) {
  Graph graph;
  const Robot& model = *problem.robot->robot;
  graph.parameters().set(kRobotNumber, problem.robot);
  const auto world = std::make_shared<WorldParameter>();
  world->set_files(scenario.map, scenario.obstacles);
  graph.parameters().set(kWorldNumber, world);
  const auto origin = std::make_shared<ScenarioParameter>();
  origin->scenario = scenario.source;
  graph.parameters().set(kScenarioNumber, origin);
  const std::vector<int> numbers = add_stances(graph, problem.robot, plan.stances);
  const auto format = std::make_shared<PlanParameter>();
  format->stances_only = true;
  format->incomplete = !plan.success;
  format->moves = problem.moves;
  graph.parameters().replace(kPlanNumber, format);

  const double weight_N = model.total_mass() * standard_gravity().norm();
  const double unit = 1.0 / (weight_N * weight_N);
  const int count = static_cast<int>(plan.configurations.size());
  BalanceOptions balance;
  balance.enforce_torque_limits = problem.check.enforce_torque_limits;
  balance.effort_scale = problem.check.effort_scale;
  for (int i = 0; i < count; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const Eigen::VectorXd& q = plan.configurations[k];
    const auto vertex =
        graph.add_vertex(i, VertexConfiguration(kRobotNumber, problem.robot, i, q, numbers[k]));
    const auto bearing = graph.parameters().get<StanceParameter>(numbers[smaller_stance(plan, k)]);
    VertexWrenches wrenches(graph.parameters(), bearing->contact_numbers);
    const BalanceCertificate certificate =
        certify_balance(model, q, bearing->stance.contacts, balance);
    Eigen::Index at = 0;
    for (std::size_t c = 0; c < bearing->contacts.size(); ++c) {
      for (const int component : bearing->contacts[c]->components()) {
        wrenches.state[at++] = certificate.wrenches[c][component];
      }
    }
    const auto forces = graph.add_vertex(count + i, std::move(wrenches));
    const auto closed = graph.parameters().get<StanceParameter>(numbers[larger_stance(plan, k)]);
    for (const int number : closed->contact_numbers) {
      const auto contact = graph.parameters().get<ContactParameter>(number);
      graph.add_edge(EdgeContact(*contact, number, kEdgeContact), vertex);
    }
    graph.add_edge(EdgeJointLimits(model, 0.0, kEdgeLimit), vertex);
    graph.add_edge(EdgeBalance(kEdgeBalance * unit, kEdgeBalance * unit), vertex, forces);
    EdgeContactWrench bearable(*graph.vertex(forces).contacts, kEdgeWrench * unit);
    graph.add_edge(std::move(bearable), forces);
    if (!problem.check.enforce_torque_limits) continue;
    EdgeTorqueLimits torques(model, problem.check.effort_scale, 0.0);
    for (int j = 0; j < model.active_joint_count(); ++j) {
      const double effort = model.active_joint(j).max_effort;
      torques.weights[j] = std::isfinite(effort) ? kEdgeTorque / (effort * effort) : 0.0;
    }
    graph.add_edge(std::move(torques), vertex, forces);
  }
  return graph;
}

}  // namespace locograph
