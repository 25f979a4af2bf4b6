#pragma once
/// What the examples of planners/ take for granted.

#include <locograph/check/judge.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/stance/experience.h>
#include <locograph/planners/offline/stance/guided_tree.h>
#include <locograph/planners/offline/stance/improve_stances.h>
#include <locograph/planners/offline/stance/plan_stances.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/offline/stance/stance_path.h>
#include <locograph/planners/offline/stance/stance_problem.h>
#include <locograph/planners/offline/stance/stance_tree.h>
#include <locograph/planners/offline/stance/standing_wheels.h>
#include <locograph/planners/offline/stance/transition_rows.h>
#include <locograph/planners/offline/timing/path_timing.h>
#include <locograph/planners/offline/timing/reach_programme.h>
#include <locograph/planners/online/refine.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/posture/contacts_file.h>
#include <locograph/planners/posture/posture_graph.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/scenario/bar_place.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/move_contacts.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/planners/scenario/snap_to_places.h>
#include <locograph/robots/xml_file.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace locograph::documentation::in_planners {

extern const std::filesystem::path data_folder;
extern Graph graph;
extern const Plan plan;
extern const std::vector<Eigen::VectorXd> planned;
extern const Stance stance;
extern const Robot robot;
extern const World world;

namespace offline_drive_wheel_motion_h {
extern Eigen::VectorXd q;
extern const Eigen::VectorXd before;
}  // namespace offline_drive_wheel_motion_h
namespace offline_drive_wheeled_plan_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const std::shared_ptr<const WorldParameter> world;
extern const Motion motion;
}  // namespace offline_drive_wheeled_plan_h
namespace offline_stance_balance_region_h {
extern const std::vector<BearingContact> bearing;
extern const RobotState state;
}  // namespace offline_stance_balance_region_h
namespace offline_stance_experience_h {
extern const StanceSpace space;
extern const Footing footing;
extern const int effector, place, other_place;
extern const bool found;
extern double cost;
}  // namespace offline_stance_experience_h
namespace offline_stance_footing_h {
extern const Footing footing;
extern const int place;
}  // namespace offline_stance_footing_h
namespace offline_stance_guided_tree_h {
extern const GuidedTree::Move move;
void prepare(const GuidedTree::Move& likely);
}  // namespace offline_stance_guided_tree_h
namespace offline_stance_plan_stances_h {
extern const StanceProblem problem;
extern const StancePlannerOptions options;
bool search(StanceSpace& space, const Footing& goal, StancePath& path);
}  // namespace offline_stance_plan_stances_h
namespace offline_stance_rrt_planner_h {
extern const StanceProblem problem;
}
namespace offline_stance_improve_stances_h {
extern const std::unique_ptr<const StancePlanner> planner;
extern const StanceProblem problem;
extern StancePlannerOptions options;
}  // namespace offline_stance_improve_stances_h
namespace offline_stance_stance_path_h {
extern StanceSpace space;
extern const Judge judge;
extern const Footing footing;
extern const Eigen::VectorXd configuration;
}  // namespace offline_stance_stance_path_h
namespace offline_stance_stance_planner_h {
extern const Scenario scenario;
}
namespace offline_stance_stance_tree_h {
extern const StanceSpace space;
extern const StancePlannerOptions options;
extern StancePlan plan;
extern const Footing start;
}  // namespace offline_stance_stance_tree_h
namespace offline_stance_standing_wheels_h {
extern const StanceSpace space;
extern StancePath path;
}  // namespace offline_stance_standing_wheels_h
namespace offline_stance_torque_programme_h {
extern const std::vector<BearingContact> bearing;
extern const RobotState state;
extern Eigen::VectorXd gradient;
}  // namespace offline_stance_torque_programme_h
namespace offline_stance_transition_ahead_h {
extern TaskSolver solver;
extern const TransitionTask task, likeliest, lift, put;
}  // namespace offline_stance_transition_ahead_h
namespace offline_stance_transition_task_h {
extern const StanceProblem problem;
extern const TransitionTask task;
extern const double mass_kg;
}  // namespace offline_stance_transition_task_h
namespace offline_stance_transition_places_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const World world;
extern const TransitionProblem problem;
extern const Eigen::AlignedBox3d around_the_robot;
extern double least_m;
extern const std::size_t bound;
extern const Eigen::Vector3d centre;
extern const double radius;
}  // namespace offline_stance_transition_places_h
namespace offline_motion_motion_graph_h {
extern const Scenario scenario;
extern const StanceProblem problem;
extern const MotionPlan plan;
}  // namespace offline_motion_motion_graph_h
namespace offline_motion_motion_planner_h {
extern const Scenario scenario;
}
namespace offline_motion_segment_motion_h {
extern const StanceProblem problem;
extern const MotionOptions options;
extern const Segment segment;
extern const std::vector<BearingContact> bearing;
}  // namespace offline_motion_segment_motion_h
namespace offline_motion_segment_planner_h {
extern const StanceProblem problem;
extern const Segment segment;
}  // namespace offline_motion_segment_planner_h
namespace offline_motion_segment_space_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const World world;
extern const Segment segment;
extern std::vector<Eigen::VectorXd> waypoints;
}  // namespace offline_motion_segment_space_h
namespace offline_motion_shorten_way_h {
extern SegmentSpace space;
}
namespace offline_motion_swing_h {
extern SegmentSpace space;
}
namespace offline_timing_balance_rows_h {
extern const std::vector<BearingContact> bearing;
extern const std::vector<Eigen::VectorXd> waypoints;
extern const TimingLimits limits;
extern const TimingOptions options;
}  // namespace offline_timing_balance_rows_h
namespace offline_timing_reach_programme_h {
extern const Eigen::MatrixXd columns;
extern const Eigen::VectorXd within, inside, target;
extern const ReachProgramme::Bounds bounds;
}  // namespace offline_timing_reach_programme_h
namespace scenario_bar_place_h {
extern const Bar bar;
extern const Contact contact;
}  // namespace scenario_bar_place_h
namespace plan_balance_edges_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const Eigen::VectorXd configuration;
extern const std::shared_ptr<const StanceParameter> stance;
extern const StanceWrenches wrenches;
extern const StanceProblem problem;
}  // namespace plan_balance_edges_h
namespace offline_timing_effort_rows_h {
extern const std::vector<Eigen::VectorXd> waypoints;
extern const TimingLimits limits;
}  // namespace offline_timing_effort_rows_h
namespace offline_timing_path_spline_h {
extern const std::vector<Eigen::VectorXd> waypoints;
}
namespace offline_timing_path_timing_h {
extern const std::vector<Eigen::VectorXd> waypoints;
extern const Scenario scenario;
}  // namespace offline_timing_path_timing_h
namespace offline_timing_speed_profile_h {
extern const Scenario scenario;
extern const PathSpline path;
}  // namespace offline_timing_speed_profile_h
namespace offline_stance_transition_rows_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const TransitionProblem problem;
extern const TransitionOptions options;
extern const Eigen::VectorXd q;
extern double worst;
}  // namespace offline_stance_transition_rows_h
namespace offline_stance_stance_graph_h {
extern const Scenario scenario;
extern const StanceProblem problem;
extern const StancePlan plan;
}  // namespace offline_stance_stance_graph_h
namespace offline_stance_stance_space_h {
extern const StanceProblem problem;
extern const StancePlannerOptions options;
extern const Eigen::VectorXd q;
}  // namespace offline_stance_stance_space_h
namespace offline_stance_transition_solver_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const Stance larger;
extern const BalanceRegion region_of_smaller;
extern const Eigen::VectorXd q, home;
}  // namespace offline_stance_transition_solver_h
namespace online_detour_search_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const DetourOptions options;
extern const std::vector<const double*> window;
extern const std::vector<double> times;
extern const WorldDistance world;
extern const double offset, slope;
extern const int first;
}  // namespace online_detour_search_h
namespace online_local_planner_h {
extern Graph plan_graph;
extern const LocalPlannerOptions options;
extern const WorldDistance world;
}  // namespace online_local_planner_h
namespace online_refine_h {
extern const Judge judge;
extern const CheckOptions limits;
extern const WorldAt world_seen_at;
}  // namespace online_refine_h
namespace online_window_quality_h {
extern const ConstraintReader reader;
extern const std::vector<int> step_of;
extern const int steps;
extern double cost;
double optimise();
void keep();
}  // namespace online_window_quality_h
namespace plan_plan_h {
extern const TypeRegistry types;
}
namespace plan_seen_world_h {
extern const Judging judging;
}
namespace posture_posture_graph_h {
extern const std::shared_ptr<const RobotParameter> robot;
extern const std::shared_ptr<const WorldParameter> seen;
extern const PostureProblem problem;
extern const PostureOptions options;
extern const PostureSolver::Shapes shapes;
extern const Workspace workspace;
}  // namespace posture_posture_graph_h
namespace posture_posture_solver_h {
extern const std::filesystem::path urdf, srdf;
extern const RobotOptions options;
extern const Eigen::VectorXd home;
}  // namespace posture_posture_solver_h
namespace scenario_contact_place_h {
extern const Contact contact;
}
namespace scenario_move_contacts_h {
extern ContactTask task;
}
namespace scenario_snap_to_places_h {
extern const Scenario scenario;
extern ContactTask task;
}  // namespace scenario_snap_to_places_h
namespace scenario_task_stances_h {
extern const Scenario scenario;
}
namespace scenario_effector_element_h {
extern const XmlFile xml;
extern const XmlFile::Element element;
}  // namespace scenario_effector_element_h

}  // namespace locograph::documentation::in_planners
