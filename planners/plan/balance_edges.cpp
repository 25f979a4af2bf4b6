#include <locograph/planners/plan/balance_edges.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>
#include <locograph/robots/statics.h>

#include <cmath>

namespace locograph {
namespace {

constexpr double kEdgeBalance = 1e4, kEdgeWrench = 1e3, kEdgeTorque = 1e2;

}  // namespace

void add_balance_edges(Graph& graph, VertexId<VertexConfiguration> configuration,
                       const StanceParameter& bearing, const StanceWrenches& wrenches, int id,
                       const CheckOptions& check) {
  if (wrenches.size() != bearing.contacts.size()) {
    throw Error("wrenches at " + std::to_string(wrenches.size()) + " contacts",
                "one for each of the stance, " + std::to_string(bearing.contacts.size()));
  }
  const Robot& model = *bearing.robot->robot;
  std::vector<int> numbers;
  std::vector<double> components;
  for (std::size_t c = 0; c < bearing.contacts.size(); ++c) {
    if (!bearing.contacts[c]->contact.bears_load) continue;
    numbers.push_back(bearing.contact_numbers[c]);
    for (const int component : bearing.contacts[c]->cone->components()) {
      components.push_back(wrenches[c][component]);
    }
  }
  VertexWrenches vertex(graph.parameters(), std::move(numbers));
  vertex.state = Eigen::Map<const Eigen::VectorXd>(components.data(),
                                                   static_cast<Eigen::Index>(components.size()));
  const auto forces = graph.add_vertex(id, std::move(vertex));
  const double weight_N = model.total_mass() * standard_gravity().norm();
  const double unit = 1.0 / (weight_N * weight_N);
  graph.add_edge(EdgeBalance(kEdgeBalance * unit, kEdgeBalance * unit), configuration, forces);
  graph.add_edge(EdgeContactWrench(*graph.vertex(forces).contacts, kEdgeWrench * unit), forces);
  if (!check.enforce_torque_limits) return;
  EdgeTorqueLimits torques(model, check.effort_scale, 0.0);
  for (int j = 0; j < model.active_joint_count(); ++j) {
    const double effort = model.active_joint(j).max_effort;
    torques.weights[j] = std::isfinite(effort) ? kEdgeTorque / (effort * effort) : 0.0;
  }
  graph.add_edge(std::move(torques), configuration, forces);
}

}  // namespace locograph
