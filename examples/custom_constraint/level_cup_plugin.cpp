// A plug-in: a constraint on a robot's motion. It keeps a carried cup level enough not to spill.
//
//     locograph refine plan.g2o --plugin ./level_cup.so -o refined.g2o

#include <locograph/core/plugin.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/frame_parameter.h>

#include <cmath>

namespace example {

using namespace locograph;

/// EDGE_CUP_TILT: the z axis of a frame leans no further than max_tilt from the vertical. Fields:
/// number of the PARAMS_FRAME, max_tilt [rad], weights. Error (1): max(0, tilt − max_tilt) [rad].
struct EdgeCupTilt : WeightedEdge<1, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr double kTolerance = 1e-3;
  static constexpr std::string_view kTag = "EDGE_CUP_TILT";
  int frame_number = 0;
  double max_tilt = 0.0;
  std::shared_ptr<const FrameParameter> frame;  // looked up by bind()
  std::shared_ptr<const RobotParameter> robot;  // whose frame it is
  auto fields() { return std::tie(frame_number, max_tilt); }
  void bind(const Parameters& parameters) {
    frame = parameters.get<FrameParameter>(frame_number);
    robot = parameters.get<RobotParameter>(frame->robot_number);
    if (max_tilt > 0.0) return;
    throw locograph::Error("a cup that may not tilt at all", "max_tilt > 0 rad");
  }

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::Matrix<double, 1, 1>> e) const {
    require_same_robot(kTag, q.robot, robot);
    const Eigen::Vector3d axis = frame->world_from_frame(q.kinematics).linear().col(2);
    e[0] = std::max(0.0, std::atan2(axis.head<2>().norm(), axis.z()) - max_tilt);
  }

  /// Turning the frame by ω moves its axis a by ω × a, and the tilt by ω · (z × a) / |z × a|.
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeCupTilt, 0> j) const {
    const Eigen::Vector3d axis = frame->world_from_frame(q.kinematics).linear().col(2);
    const double sine = axis.head<2>().norm();
    if (std::atan2(sine, axis.z()) <= max_tilt || sine < 1e-9) return;  // j is zero already
    const Eigen::Vector3d about(-axis.y() / sine, axis.x() / sine, 0.0);
    q.kinematics.add_rotation_gradient(frame->link, about, 1.0, j.data());
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeCupTilt::kTag, EdgeCupTilt)

void register_types(TypeRegistry& types) { types.add_edge<EdgeCupTilt>(); }

}  // namespace example

LOCOGRAPH_PLUGIN(example::register_types)
