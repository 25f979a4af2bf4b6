#pragma once
/// What the tests of static balance share: vertices with wrenches at given contacts.
///
///     Graph graph = graph_of(robot);
///     const std::vector<int> numbers = add_contacts(graph, robot, {sole()});
///     auto w = graph.add_vertex(0, wrenches_at(graph, numbers, Eigen::VectorXd::Zero(6)));

#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>

#include "plugins/plugin_test_support.h"

namespace locograph::test::balance {

inline constexpr int kContact = 10;  // number of the first contact

inline std::vector<int> add_contacts(Graph& graph, const RobotCase& robot,
                                     const std::vector<ContactDescription>& contacts) {
  std::vector<int> numbers;
  for (const ContactDescription& contact : contacts) {
    numbers.push_back(kContact + static_cast<int>(numbers.size()));
    graph.parameters().set(numbers.back(),
                           std::make_shared<const ContactParameter>(robot.robot, kRobot, contact));
  }
  return numbers;
}

inline VertexWrenches wrenches_at(const Graph& graph, const std::vector<int>& numbers,
                                  const Eigen::VectorXd& components) {
  VertexWrenches vertex(graph.parameters(), numbers);
  vertex.state = components;
  return vertex;
}

inline ContactDescription sole() {
  ContactDescription contact;
  contact.link = "l_sole";
  contact.half_x_m = 0.08;
  contact.half_y_m = 0.035;
  contact.mu = 0.6;
  contact.max_force_N = 1000.0;
  return contact;
}

}  // namespace locograph::test::balance
