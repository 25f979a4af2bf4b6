#pragma once
/// Robots with limbs, and frames at the ends of two of them, for the tests of contacts and tasks.
///
///     const RobotCase robot = robot_case("ComanPlus");
///     Graph graph = graph_of(robot);
///     add_frames(graph, robot, random);               // PARAMS_FRAME kFrame and kFrame + 1
///     Eigen::Isometry3d pose = frame_pose(graph, kFrame, robot, q);

#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/com/edge_com.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/frame_pose/edge_frame_pose.h>

#include "plugins/plugin_test_support.h"

namespace locograph::test {

inline constexpr int kFrame = 10;

/// A kind of contact that holds a frame.
struct HeldKind {
  const char* name;
  ContactKind kind;
  bool free_yaw;
  int rows;
};
inline constexpr HeldKind kHeldKinds[] = {{"surface", ContactKind::kSurface, false, 6},
                                          {"surface with free yaw", ContactKind::kSurface, true, 5},
                                          {"point", ContactKind::kPoint, false, 3},
                                          {"rung", ContactKind::kGrasp, false, 5}};

inline Eigen::Isometry3d random_pose(Random& random, double reach) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = random.vector(3, reach);
  pose.rotate(Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction()));
  return pose;
}

/// On the first and the last of the links with the most joints above them.
inline void add_frames(Graph& graph, const RobotCase& robot, Random& random) {
  const Robot& model = robot.model();
  int first = 0, last = 0;
  for (int link = 0; link < static_cast<int>(model.links().size()); ++link) {
    const std::size_t joints = model.support(link).size();
    if (joints > model.support(first).size()) first = link;
    if (joints >= model.support(last).size()) last = link;
  }
  for (const int i : {0, 1}) {
    graph.parameters().set(kFrame + i, std::make_shared<const FrameParameter>(
                                           model, kRobot, model.links()[i == 0 ? first : last].name,
                                           random_pose(random, 0.2)));
  }
}

inline Eigen::Isometry3d frame_pose(const Graph& graph, int number, const RobotCase& robot,
                                    const Eigen::VectorXd& q) {
  ConfigurationState state(robot.robot);
  state.update(q.data());
  return graph.parameters().get<FrameParameter>(number)->world_from_frame(state.kinematics);
}

/// The contact that holds a frame there, as a new parameter of the graph.
inline EdgeContact contact_edge(Graph& graph, const RobotCase& robot, int frame,
                                const HeldKind& held, const Eigen::Isometry3d& world_from_contact) {
  const auto on_link = graph.parameters().get<FrameParameter>(frame);
  const Eigen::Isometry3d pose = on_link->link_from_frame.isometry();
  Contact contact;
  contact.effector.link = on_link->link_name;
  contact.effector.kind = held.kind;
  contact.effector.point = pose.translation();
  contact.effector.normal = pose.linear().col(2);
  contact.effector.forward = pose.linear().col(0);
  contact.effector.half_x_m = contact.effector.half_y_m = 0.05;
  contact.effector.friction = 0.5;
  contact.effector.max_force_N = 100.0;
  contact.position = world_from_contact.translation();
  contact.normal = world_from_contact.linear().col(2);
  if (!held.free_yaw) contact.forward = world_from_contact.linear().col(0);
  const int number = 1000 + static_cast<int>(graph.parameters().all().size());
  const auto parameter = std::make_shared<const ContactParameter>(robot.robot, kRobot, contact);
  graph.parameters().set(number, parameter);
  return EdgeContact(*parameter, number, 1.0);
}

}  // namespace locograph::test
