#pragma once
/// What the examples of plugins/ take for granted.

#include <locograph/core/graph_file.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/contact/stance_parameter.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/time_step/vertex_time_step.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>
#include <locograph/types/standard_types.h>

#include <memory>
#include <string_view>
#include <vector>

namespace locograph::documentation::in_plugins {

extern Graph graph;
extern const Robot robot;
extern VertexId<VertexConfiguration> configuration, before, here, after, from, to;
extern const Eigen::Isometry3d link_from_sole, world_from_target, world_from_frame;
extern const Eigen::Vector3d point, normal, forward;
extern const ConfigurationState q, a, b, c;
extern const Eigen::VectorXd limits;
extern Eigen::VectorXd e;
extern Eigen::MatrixXd j;
extern const double dt_s, dt_1_s, dt_2_s, step_s, max_s;
extern const int i, row;

namespace configuration_edge_fit_h {
constexpr std::string_view kTag = "EDGE_JOINT_LIMITS";
extern const Parameters parameters;
extern const long dimension;
}  // namespace configuration_edge_fit_h
namespace configuration_frame_parameter_h {
extern const Robot model;
}
namespace configuration_path_field_h {
extern std::filesystem::path map;
extern FieldReader in;
extern FieldWriter out;
}  // namespace configuration_path_field_h
namespace configuration_self_collision_shapes_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern std::vector<int> first_capsules;
}  // namespace configuration_self_collision_shapes_h
namespace contact_edge_contact_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const Contact standing;
extern const VertexId<VertexConfiguration> q;
}  // namespace contact_edge_contact_h
namespace frame_pose_edge_frame_pose_h {
extern const Eigen::Matrix<double, 6, 1> weights;
}
namespace ground_distance_edge_ground_distance_h {
extern const std::shared_ptr<const RobotParameter> robot;
}
namespace ground_distance_edge_link_height_h {
extern const Robot model;
constexpr int kRobotNumber = 0;
}  // namespace ground_distance_edge_link_height_h
namespace rolling_edge_rolling_h {
extern const std::shared_ptr<const StanceParameter> stance;
}
namespace rolling_edge_steering_slip_h {
extern const std::shared_ptr<const StanceParameter> stance;
}
namespace rolling_rolling_step_h {
extern const ConfigurationState a, b;
extern const Wheel wheel;
extern const Eigen::Vector3d normal;
}  // namespace rolling_rolling_step_h
namespace self_collision_nearest_points_h {
extern const Eigen::Vector3d a_from, a_to, b_from, b_to;
}
namespace static_balance_static_rows_h {
extern const ContactParameter contact;
extern const double* components;
extern double* row;
}  // namespace static_balance_static_rows_h
namespace time_step_edge_duration_h {
extern const std::vector<VertexId<VertexTimeStep>> steps;
}

}  // namespace locograph::documentation::in_plugins
