#pragma once
/// EDGE_FRAME_POSE: a task: brings a frame of the robot to a pose, each coordinate by its weight.
///
///     EDGE_FRAME_POSE id  frame x y z qx qy qz qw  weights
///
///     graph.add_edge(EdgeFramePose(3, world_from_target, weights), configuration);
///
/// Error (6): position of the frame [m] and its rotation vector [rad] in the target, along the
/// target's axes. A weight of zero leaves a coordinate free. `frame` is a PARAMS_FRAME.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/frame_parameter.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeFramePose : WeightedEdge<6, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_FRAME_POSE";
  int frame_number = 0;
  SavedPose target;                             ///< world_from_target
  std::shared_ptr<const FrameParameter> frame;  ///< looked up by bind()
  std::shared_ptr<const RobotParameter> robot;  ///< whose frame it is, likewise
  auto fields() { return std::tie(frame_number, target); }
  void bind(const Parameters& parameters) {
    frame = parameters.get<FrameParameter>(frame_number);
    robot = parameters.get<RobotParameter>(frame->robot_number);
  }

  EdgeFramePose() = default;
  EdgeFramePose(int frame_number, const Eigen::Isometry3d& world_from_target,
                const Eigen::Matrix<double, 6, 1>& weights);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeFramePose, 0> j) const;
  RowLabel row_label(int row) const {
    RowLabel label = pose_row(row);
    label.name = frame->link_name + " " + label.name;
    return label;
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeFramePose::kTag, EdgeFramePose)
extern template class TypedEdgePool<EdgeFramePose>;

}  // namespace locograph
