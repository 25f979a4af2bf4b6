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

inline constexpr ContactKind kContactKinds[] = {ContactKind::kSurface, ContactKind::kSurfaceFreeYaw,
                                                ContactKind::kPoint, ContactKind::kRung,
                                                ContactKind::kSlidingRung};

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

}  // namespace locograph::test
