#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits_timed.h>
#include <locograph/plugins/com/edge_com.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/frame_pose/edge_frame_pose.h>
#include <locograph/plugins/ground_distance/edge_ground_distance.h>
#include <locograph/plugins/ground_distance/edge_link_height.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/record/edge_measurement.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/rolling/edge_ball_rolling.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/edge_steering_slip.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_moving_balance.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>
#include <locograph/plugins/static_balance/edge_wrench_tracking.h>
#include <locograph/plugins/surface_distance/edge_surface_distance.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/time_step/edge_duration.h>
#include <locograph/plugins/time_step/edge_time_step_limits.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>
#include <locograph/plugins/velocity_tracking/edge_acceleration_tracking.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>

namespace locograph {

void add_robot_types(TypeRegistry& types) {
  types.add_parameter<RobotParameter>("PARAMS_ROBOT");
  types.add_parameter<FrameParameter>("PARAMS_FRAME");
  types.add_parameter<WorldParameter>("PARAMS_WORLD");
  types.add_parameter<PlanParameter>("PARAMS_PLAN");
  types.add_parameter<ScenarioParameter>("PARAMS_SCENARIO");
  types.add_parameter<ContactsParameter>("PARAMS_CONTACTS");
  types.add_parameter<RecordParameter>("PARAMS_RECORD");
  types.add_parameter<ContactParameter>("PARAMS_CONTACT");
  types.add_parameter<StanceParameter>("PARAMS_STANCE");
  types.add_parameter<SegmentParameter>("PARAMS_SEGMENT");
  types.add_parameter<PlacesParameter>("PARAMS_PLACES");
  types.add_vertex<VertexConfiguration>();
  types.add_vertex<VertexTimeStep>();
  types.add_vertex<VertexWrenches>();
  types.add_edge<EdgeAccelerationLimits>();
  types.add_edge<EdgeAccelerationLimitsTimed>();
  types.add_edge<EdgeAccelerationLimitsTimedSigned>();
  types.add_edge<EdgeAccelerationTracking>();
  types.add_edge<EdgeBalance>();
  types.add_edge<EdgeCom>();
  types.add_edge<EdgeContact>();
  types.add_edge<EdgeContactWrench>();
  types.add_edge<EdgeDuration>();
  types.add_edge<EdgeFramePose>();
  types.add_edge<EdgeGroundDistance>();
  types.add_edge<EdgeLinkHeight>();
  types.add_edge<EdgeJointLimits>();
  types.add_edge<EdgeMeasurement>();
  types.add_edge<EdgeMovingBalance>();
  types.add_edge<EdgeObstacleDistance>();
  types.add_edge<EdgePlanTracking>();
  types.add_edge<EdgeRestAccelerationLimitsTimed>();
  types.add_edge<EdgeRestAccelerationLimitsTimedSigned>();
  types.add_edge<EdgeRolling>();
  types.add_edge<EdgeSelfCollision>();
  types.add_edge<EdgeSteeringSlip>();
  types.add_edge<EdgeBallRolling>();
  types.add_edge<EdgeSurfaceDistance>();
  types.add_edge<EdgeSweptObstacleDistance>();
  types.add_edge<EdgeTimeStepLimits>();
  types.add_edge<EdgeTimeStepLimitsSigned>();
  types.add_edge<EdgeTorqueLimits>();
  types.add_edge<EdgeVelocityLimits>();
  types.add_edge<EdgeVelocityLimitsTimed>();
  types.add_edge<EdgeVelocityLimitsTimedSigned>();
  types.add_edge<EdgeVelocityTracking>();
  types.add_edge<EdgeWrenchNorm>();
  types.add_edge<EdgeWrenchTracking>();
  for (const char* tag : {"PARAMS_WHEELS", "EDGE_WHEEL_CONTACT"}) {
    types.retire(tag, "a plan of format version 3, which has contacts and stances: make it again");
  }
}

}  // namespace locograph
