#pragma once
/// What the tests of static balance share: vertices with wrenches at given contacts.
///
///     Graph graph = graph_of(robot);
///     const std::vector<int> numbers = add_contacts(graph, robot, {sole()});
///     auto w = graph.add_vertex(0, wrenches_at(graph, numbers, Eigen::VectorXd::Zero(6)));

#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_moving_balance.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>
#include <locograph/plugins/static_balance/edge_wrench_tracking.h>

#include "plugins/plugin_test_support.h"

namespace locograph::test::balance {

inline constexpr int kContact = 10;  // number of the first contact

inline std::vector<int> add_contacts(Graph& graph, const RobotCase& robot,
                                     const std::vector<Contact>& contacts,
                                     const std::vector<FrictionModel>& cones = {}) {
  std::vector<int> numbers;
  for (const Contact& contact : contacts) {
    const std::size_t i = numbers.size();
    numbers.push_back(kContact + static_cast<int>(i));
    graph.parameters().set(numbers.back(), std::make_shared<const ContactParameter>(
                                               robot.robot, kRobot, contact,
                                               i < cones.size() ? cones[i] : FrictionModel()));
  }
  return numbers;
}

inline VertexWrenches wrenches_at(const Graph& graph, const std::vector<int>& numbers,
                                  const Eigen::VectorXd& components) {
  VertexWrenches vertex(graph.parameters(), numbers);
  vertex.state = components;
  return vertex;
}

/// On the ground somewhere: balance does not ask where.
inline Contact sole() {
  Contact contact;
  contact.effector.link = "l_sole";
  contact.effector.half_x_m = 0.08;
  contact.effector.half_y_m = 0.035;
  contact.effector.friction = 0.6;
  contact.effector.max_force_N = 1000.0;
  contact.forward = Eigen::Vector3d::UnitX();
  return contact;
}

}  // namespace locograph::test::balance
