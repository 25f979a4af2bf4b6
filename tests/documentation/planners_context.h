#pragma once
/// What the examples of planners/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <documentation/example_world.h>
#include <locograph/check/judge.h>
#include <locograph/common/data_folder.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/planners/balance/reach_programme.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/motion_loads.h>
#include <locograph/planners/offline/motion/rest_spline.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/motion/segment_planners.h>
#include <locograph/planners/offline/stance/experience.h>
#include <locograph/planners/offline/stance/given_margins.h>
#include <locograph/planners/offline/stance/guided_tree.h>
#include <locograph/planners/offline/stance/improve_stances.h>
#include <locograph/planners/offline/stance/judged_path.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/offline/stance/stance_path.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/stance_tree.h>
#include <locograph/planners/offline/stance/standing_wheels.h>
#include <locograph/planners/offline/stance/started_task.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/offline/timing/path_timing.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/online/camera_walk.h>
#include <locograph/planners/online/free_drive.h>
#include <locograph/planners/online/free_way.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/online/sideways_detour.h>
#include <locograph/planners/online/walk_ahead.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/planners/plan/record.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/posture/transition_rows.h>
#include <locograph/planners/scenario/bar_place.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/contacts_file.h>
#include <locograph/planners/scenario/execution_element.h>
#include <locograph/planners/scenario/move_contacts.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/planners/scenario/snap_to_places.h>
#include <locograph/planners/task/task_stances.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/robots/xml_file.h>
#include <locograph/types/standard_types.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/proposed_effectors.h>

namespace locograph::documentation::in_planners {

/// COMAN+ puts its left foot 5 cm ahead.
inline constexpr std::string_view kOneStep = R"(<scenario version="1" name="one_step">
  <robot model="coman_plus"/>
  <end_effectors>
    <end_effector name="left_foot" link="l_sole" kind="surface" half_x="0.08" half_y="0.035"
                  link_forward="1 0 0" max_force="1000"/>
    <end_effector name="right_foot" link="r_sole" kind="surface" half_x="0.08" half_y="0.035"
                  link_forward="1 0 0" max_force="1000"/>
  </end_effectors>
  <environment friction="0.8">
    <plane name="floor" center="0 0 0" normal="0 0 1" forward="1 0 0" size="2 2"/>
  </environment>
  <start>
    <contact end_effector="left_foot" position="0 0.1 0" normal="0 0 1" forward="1 0 0"/>
    <contact end_effector="right_foot" position="0 -0.1 0" normal="0 0 1" forward="1 0 0"/>
  </start>
  <goal>
    <contact end_effector="left_foot" position="0.05 0.1 0" normal="0 0 1" forward="1 0 0"/>
    <contact end_effector="right_foot" position="0 -0.1 0" normal="0 0 1" forward="1 0 0"/>
  </goal>
  <planner torque_limits="enforce"/>
</scenario>
)";

inline Scenario one_step() {
  write_example_file("one_step.xml", kOneStep);
  Scenario scenario = load_scenario("one_step.xml", data_folder());
  scenario.limits.joint_acceleration_rad_s2 = 10.0;
  return scenario;
}
inline const Task& step_task() {
  static const Task task = started_task(one_step()).task;
  return task;
}
/// On both feet, on the right one, on both.
inline const StancePlan& step_stances() {
  static const StancePlan plan = make_stance_planner("guided")->plan(step_task(), {.seed = 7});
  if (plan.configurations.size() != 3) throw Error("the step is not planned: " + plan.reason);
  return plan;
}
inline Task drive_task(double distance_m, int configurations) {
  Scenario scenario = load_scenario("centauro_drive", data_folder());
  scenario.drive->distance_m = distance_m;
  scenario.drive->configurations = configurations;
  return task_of(scenario);
}
inline Graph drive(double distance_m, int configurations) {
  const Task task = drive_task(distance_m, configurations);
  return *drive_graph(task, plan_wheeled_drive(task).motion);
}
inline std::vector<Eigen::VectorXd> configurations_of(const Graph& graph, const Plan& plan) {
  return motion_of(graph, plan).configurations;
}

struct Context {
  const std::filesystem::path data_folder = locograph::data_folder();
};

/// CENTAURO drives ahead.
struct DriveContext : Context {
  Graph graph;
  const Plan plan = plan_of(graph);
  const std::vector<Eigen::VectorXd> planned = configurations_of(graph, plan);
  const std::shared_ptr<const RobotParameter>& parameter = plan.robot;
  const std::shared_ptr<const RobotParameter>& robot = plan.robot;
  World world;

  explicit DriveContext(double distance_m = 0.32, int configurations = 5)
      : graph(drive(distance_m, configurations)) {
    world.surfaces = {ground()};
  }
};

/// The drive as if it had been carried out.
struct RecordContext : DriveContext {
  const Graph& plan_graph = graph;
  const TypeRegistry types = [] {
    TypeRegistry all;
    add_robot_types(all);
    return all;
  }();
  const Record record = [this] {
    Record all;
    all.motion = motion_of(graph, plan);
    all.planned = planned;
    all.plan_time_s = all.motion.time_s;
    all.motion.wrenches.clear();
    for (std::size_t i = 0; i < planned.size(); ++i) {
      all.torques.emplace_back(Eigen::VectorXd::Zero(robot->robot->active_joint_count()));
      all.motion.slopes[i] = Eigen::VectorXd::Zero(robot->robot->tangent_size());
      const auto stance = static_cast<std::size_t>(all.motion.stance_from[i]);
      all.motion.wrenches.emplace_back(all.motion.stances[stance].contacts.size(),
                                       Eigen::Matrix<double, 6, 1>::Zero());
    }
    return all;
  }();
};

/// The window after the first configuration of the drive.
struct WindowContext : DriveContext {
  OnlinePlan online{graph};
  Window window{online, {.steps = 3}};
  const int executed = 0;
  WindowContext() { window.move_to(executed); }
};

/// The step that COMAN+ makes.
struct StepContext : Context {
  const Scenario scenario = one_step();
  const Task& task = step_task();
  const Robot& robot = *task.robot->robot;
  const World& world = task.world->world();
  const Stance& stance = task.start;
  const Eigen::VectorXd& q = task.start_configuration;
  const RobotState state = state_at(robot, q);
  const std::vector<BearingContact> bearing = {{stance.contacts[0]}, {stance.contacts[1]}};
  StancePlannerOptions options;
};

/// The search for it.
struct SearchContext : StepContext {
  StanceSpace space{task, options};
  const Footing footing = space.footing(task.start), start = footing;
  const int effector = 0, place = footing[0], other_place = space.footing(task.goals[0])[0];
};

/// The moment when the left foot is lifted: the smaller stance is the right foot's.
struct TransitionContext : StepContext {
  const std::shared_ptr<const RobotParameter>& robot = task.robot;
  const std::vector<Contact> smaller = {stance.contacts[1]};
  const BalanceRegion region_of_smaller =
      balance_region(robot->robot->total_mass(), std::vector<BearingContact>{{smaller[0]}}, 0.1);
  const TransitionOptions options;
  TransitionProblem transition() const {
    return {.closed = stance.contacts,
            .balance = &region_of_smaller,
            .start = q,
            .preferred = q,
            .held = smaller};
  }
  TransitionTask task_of(const Footing& larger, const Footing& smaller_footing) const {
    return {.larger = larger,
            .smaller = smaller_footing,
            .closed = stance.contacts,
            .held = smaller,
            .bearing = {{smaller[0]}},
            .start = q};
  }
};

/// The left foot on its way, the right one stands.
struct SegmentContext : StepContext {
  const StancePlan& stances = step_stances();
  const std::vector<BearingContact> bearing = {{stance.contacts[1]}};
  const BalanceRegion region = balance_region(robot.total_mass(), bearing, 0.1);
  const Segment segment = {.held = {stance.contacts[1]},
                           .balance = &region,
                           .left = {stance.contacts[0]},
                           .reached = {task.goals[0].contacts[0]},
                           .from = stances.configurations[1],
                           .to = stances.configurations[2]};
};
struct LiftedContext : SegmentContext {
  SegmentSpace space{task.robot, task.world->world()};
  LiftedContext() {
    space.set_segment(segment);
    if (!space.lift_off()) throw Error("the foot is not lifted: " + space.why_not());
  }
};

/// An arm moves while both feet stand.
struct TimingContext : StepContext {
  const std::vector<Eigen::VectorXd> waypoints = {q, moved(0.1), moved(0.2)};
  const TimingLimits limits = timing_limits(robot, task.check);
  const TimingOptions options;
  Eigen::VectorXd moved(double angle_rad) const {
    Eigen::VectorXd to = q;
    to[7 + 24] += angle_rad;
    return to;
  }
};

namespace balance_balance_region_h {
using Context = StepContext;
}
namespace balance_margin_contacts_h {
struct Context : StepContext {
  const Eigen::Vector2d centre = state.center_of_mass().head<2>();
  const std::span<const Eigen::Vector2d> com{&centre, 1};
};
}  // namespace balance_margin_contacts_h
namespace balance_least_wrenches_h {
struct Context : StepContext {
  const std::vector<BearingContact>& counted = bearing;
  RobotDynamics dynamics{robot};
  const Eigen::VectorXd velocity = Eigen::VectorXd::Zero(robot.tangent_size()),
                        acceleration = velocity;
  Eigen::VectorXd asked = velocity;
  StanceWrenches feed_forward;
};
}  // namespace balance_least_wrenches_h
namespace balance_torque_programme_h {
struct Context : StepContext {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(robot.tangent_size());
};
}  // namespace balance_torque_programme_h
namespace balance_reach_programme_h {
/// Three forces of at most one, along x, y and both.
struct Context {
  const Eigen::MatrixXd columns = (Eigen::MatrixXd(2, 3) << 1, 0, 1, 0, 1, 1).finished();
  const Eigen::VectorXd within = Eigen::Vector2d(1e-6, 1e-6),
                        inside = Eigen::Vector3d(0.2, 0.2, 0.2), target = Eigen::Vector2d(3.0, 0.0);
  const ReachProgramme::Bounds bounds = {
      .group = {0, 0, 0}, .lower = {0, 0, 0}, .upper = {1, 1, 1}, .least = {0}, .most = {-1}};
};
}  // namespace balance_reach_programme_h
namespace offline_drive_drive_graph_h {
struct Context {
  const Task task = drive_task(0.32, 5);
  const Motion motion = plan_wheeled_drive(task).motion;
};
}  // namespace offline_drive_drive_graph_h
namespace offline_drive_wheel_motion_h {
struct Context : DriveContext {
  const Robot& robot = *parameter->robot;
  const Stance& stance = plan.stance_from[0]->stance;
  Eigen::VectorXd q = planned[1];
  const Eigen::VectorXd before = planned[0];
};
}  // namespace offline_drive_wheel_motion_h
namespace offline_stance_experience_h {
struct Context : SearchContext {
  const bool found = true;
  double cost = 0.0;
};
}  // namespace offline_stance_experience_h
namespace offline_stance_footing_h {
using Context = SearchContext;
}
namespace offline_stance_given_margins_h {
struct Context : StepContext {
  const StancePlan& plan = step_stances();
};
}  // namespace offline_stance_given_margins_h
namespace offline_stance_guided_tree_h {
struct Context {
  const GuidedTree::Move move = {};
  static void prepare(const GuidedTree::Move&) {}
};
}  // namespace offline_stance_guided_tree_h
namespace offline_stance_rrt_planner_h {
using Context = StepContext;
}
namespace offline_stance_improve_stances_h {
struct Context : StepContext {
  const std::unique_ptr<const StancePlanner> planner = make_stance_planner("guided");
};
}  // namespace offline_stance_improve_stances_h
namespace offline_stance_judged_path_h {
struct Context : SearchContext {
  const Judge judge{task.robot->robot, world};
  StancePath path = {.footings = {start}, .configurations = {q}};
};
}  // namespace offline_stance_judged_path_h
namespace offline_stance_stance_path_h {
struct Context : SearchContext {
  const Eigen::VectorXd& configuration = q;
};
}  // namespace offline_stance_stance_path_h
namespace offline_stance_stance_planner_h {
struct Context {
  const Scenario scenario = one_step();
};
}  // namespace offline_stance_stance_planner_h
namespace offline_stance_stance_plan_h {
struct Context : StepContext {
  const Judge judge{task.robot->robot, task.world};
};
}  // namespace offline_stance_stance_plan_h
namespace offline_stance_stance_search_h {
/// The first way will do.
struct Context : StepContext {
  const std::unique_ptr<const StancePlanner> planner = make_stance_planner("guided");
  static std::size_t change_without_motion(StanceSpace&, const StancePath&) { return 0; }
};
}  // namespace offline_stance_stance_search_h
namespace offline_stance_stance_tree_h {
struct Context : SearchContext {
  StancePlan plan;
};
}  // namespace offline_stance_stance_tree_h
namespace offline_stance_standing_wheels_h {
/// Of feet only: nothing turns.
struct Context : SearchContext {
  StancePath path = {.footings = {start, without(start, 0)}, .configurations = {q, q}};
};
}  // namespace offline_stance_standing_wheels_h
namespace offline_stance_transition_ahead_h {
struct Context : TransitionContext {
  BalanceRegions regions{robot->robot->total_mass()};
  TaskSolver solver{task, regions};
  const TransitionTask transition = task_of({0, 1}, {kFree, 1}), likeliest = transition,
                       lift = task_of({2, 1}, {kFree, 1}), put = task_of({3, 1}, {kFree, 1});
};
}  // namespace offline_stance_transition_ahead_h
namespace offline_stance_transition_task_h {
struct Context : TransitionContext {
  const TransitionTask transition = task_of({0, 1}, {kFree, 1});
  const double mass_kg = robot->robot->total_mass();
};
}  // namespace offline_stance_transition_task_h
namespace offline_stance_unheld_goal_h {
using Context = StepContext;
}
namespace offline_motion_motion_graph_h {
struct Context : StepContext {
  const MotionPlan plan = plan_motion(task, {.seed = 7});
};
}  // namespace offline_motion_motion_graph_h
namespace offline_motion_motion_planner_h {
struct Context {
  const Scenario scenario = one_step();
};
}  // namespace offline_motion_motion_planner_h
namespace offline_motion_motion_loads_h {
struct Context : StepContext {
  const std::vector<BearingContact>& counted = bearing;
  const double effort_scale = 1.0;
  const SegmentMotion way = {.configurations = {q, q},
                             .slopes = {2, Eigen::VectorXd::Zero(robot.tangent_size())},
                             .duration_s = 0.02};
  static void use(const std::vector<StanceWrenches>&) {}
};
}  // namespace offline_motion_motion_loads_h
namespace offline_motion_rest_spline_h {
struct Context : StepContext {
  std::vector<Eigen::VectorXd> configurations = std::vector<Eigen::VectorXd>(kLeastOfRestSpline, q),
                               slopes;
};
}  // namespace offline_motion_rest_spline_h
namespace offline_motion_segment_motion_h {
struct Context : SegmentContext {
  const MotionOptions options;
};
}  // namespace offline_motion_segment_motion_h
namespace offline_motion_segment_planner_h {
using Context = SegmentContext;
}
namespace offline_motion_segment_space_h {
struct Context : SegmentContext {
  const std::shared_ptr<const RobotParameter>& robot = task.robot;
  std::vector<Eigen::VectorXd> waypoints;
};
}  // namespace offline_motion_segment_space_h
namespace offline_motion_shorten_way_h {
using Context = LiftedContext;
}
namespace offline_motion_swing_h {
using Context = LiftedContext;
}
namespace offline_timing_balance_rows_h {
using Context = TimingContext;
}
namespace offline_timing_effort_rows_h {
/// The same robot, its base held.
struct Context {
  const Robot robot = fixed();
  const std::vector<Eigen::VectorXd> waypoints = {robot.named_configuration("home"), moved()};
  const TimingLimits limits = timing_limits(robot, {.joint_acceleration_rad_s2 = 10.0});
  static Robot fixed() {
    const RobotFiles files = shipped_robot("coman_plus").value();
    return Robot::load(files.urdf, files.srdf, {.floating_base = false});
  }
  Eigen::VectorXd moved() const {
    Eigen::VectorXd to = robot.named_configuration("home");
    to[24] += 0.2;
    return to;
  }
};
}  // namespace offline_timing_effort_rows_h
namespace offline_timing_path_spline_h {
using Context = TimingContext;
}
namespace offline_timing_path_timing_h {
using Context = TimingContext;
}
namespace offline_timing_speed_profile_h {
struct Context : TimingContext {
  const PathSpline path = timing_path(robot, waypoints, limits);
};
}  // namespace offline_timing_speed_profile_h
namespace posture_transition_rows_h {
struct Context : TransitionContext {
  const TransitionProblem problem = transition();
  double worst = 1.0;
};
}  // namespace posture_transition_rows_h
namespace offline_stance_stance_graph_h {
struct Context : StepContext {
  const StancePlan& plan = step_stances();
};
}  // namespace offline_stance_stance_graph_h
namespace offline_stance_stance_space_h {
using Context = StepContext;
}
namespace posture_contact_projection_h {
struct Context : StepContext {
  const HeldBalls balls = HeldBalls(stance.contacts.size());
  Eigen::VectorXd q = StepContext::q;
};
}  // namespace posture_contact_projection_h
namespace posture_transition_problem_h {
struct Context : TransitionContext {
  const Stance& larger = stance;
  const Eigen::VectorXd& home = q;
};
}  // namespace posture_transition_problem_h
namespace posture_transition_solver_h {
using Context = posture_transition_problem_h::Context;
}
namespace online_detour_search_h {
/// A box on the way, after two metres.
struct Context : DriveContext {
  const DetourOptions options;
  std::vector<const double*> window;
  std::vector<double> times;
  const WorldDistance world = distance_view(small_room());
  const int first = 1;
  Context() : DriveContext(1.6, 21) {
    for (int i = first; i < static_cast<int>(planned.size()); ++i) {
      window.push_back(planned[i].data());
      times.push_back(0.8 * i);
    }
  }
};
}  // namespace online_detour_search_h
namespace online_heading_h {
struct Context : DriveContext {
  const Eigen::Vector3d moved = Eigen::Vector3d(0.0, 0.1, 0.0);
};
}  // namespace online_heading_h
namespace online_incumbent_h {
/// One more window, which costs less.
struct Context : in_planners::Context {
  WindowQuality quality;
  std::vector<double> state = {1.0};
  bool search(WindowQuality& found, std::vector<double>&) {
    found.cost -= 1.0;
    return found.cost > -2.0;
  }
  void hand_out(const std::vector<double>&) {}
};
}  // namespace online_incumbent_h
namespace online_local_planner_h {
struct Context : DriveContext {
  Graph& plan_graph = graph;
  const LocalPlannerOptions options;
  const std::shared_ptr<const WorldSnapshot> snapshot =
      std::make_shared<const WorldSnapshot>(world);
  const Eigen::VectorXd& configuration = planned.front();
};
}  // namespace online_local_planner_h
namespace online_online_plan_h {
struct Context : DriveContext {
  Graph& plan_graph = graph;
};
}  // namespace online_online_plan_h
namespace online_proposal_h {
struct Context {
  LocalPlannerOptions options;
};
}  // namespace online_proposal_h
namespace online_standard_proposals_h {
struct Context {
  LocalPlannerOptions options;
};
}  // namespace online_standard_proposals_h
namespace online_proposal_schedule_h {
struct Context : WindowContext {
  const Termination termination;
  Proposal::Answer answer = Proposal::Answer::kNone;
  std::vector<Eigen::VectorXd> candidate;
};
}  // namespace online_proposal_schedule_h
namespace online_plan_wheels_h {
struct Context : DriveContext {
  const OnlinePlan online{graph};
  const int index = 0;
  const Eigen::VectorXd before = planned[0];
  Eigen::VectorXd q = planned[1];
};
}  // namespace online_plan_wheels_h
namespace online_free_drive_h {
/// The drive, stopped after its first step.
struct Context : in_planners::Context {
  const Task task = drive_task(0.32, 5);
  const Motion planned = plan_wheeled_drive(task).motion;
  Graph graph = *drive_graph(task, planned), stopped_graph = *drive_graph(task, planned);
  const std::shared_ptr<const WorldSnapshot> world = task.world;
  Context() { cut_plan(stopped_graph, plan_of(stopped_graph), 1); }
};
}  // namespace online_free_drive_h
namespace online_resumed_drive_h {
struct Context : in_planners::online_free_drive_h::Context {
  const std::shared_ptr<const WorldSnapshot>& world_now = world;
};
}  // namespace online_resumed_drive_h
namespace online_driven_way_h {
struct Context : in_planners::Context {
  const Task task = drive_task(0.32, 5);
  const Robot& robot = *task.robot->robot;
  Motion motion = plan_wheeled_drive(task).motion;
  const Stance& stance = motion.stances.front();
  std::vector<Eigen::VectorXd> way = motion.configurations;
};
}  // namespace online_driven_way_h
namespace online_sideways_detour_h {
struct Context {
  LocalPlannerOptions options;
};
}  // namespace online_sideways_detour_h
namespace online_camera_walk_h {
/// A camera of a few pixels.
struct Context : DriveContext {
  const Judging judging = judging_of(graph, plan_of(graph), {.data_folder = data_folder});
  const std::vector<DepthCamera> cameras = {
      depth_camera("eye", judging.robot->root_link(), 16, 12, 1.0)};
  Perception perception{judging.robot, cameras, {.surfaces = {ground()}}};
  SimulatedImages images{judging.robot, {.surfaces = {ground()}}, cameras, {.rate_hz = 1.0}};
  WalkOptions options;
};
}  // namespace online_camera_walk_h
/// COMAN+ at rest in its start, which is all of its plan.
struct StoppedContext {
  const Task task = started_task(load_scenario("standing_up", data_folder())).task;
  const Motion executed = [this] {
    Motion motion = stances_motion({task.start}, {task.start_configuration});
    motion.stances_only = false;
    motion.slopes = {Eigen::VectorXd::Zero(task.robot->robot->tangent_size())};
    return motion;
  }();
  const Motion& planned = executed;
  const std::vector<PlanSegment> segments;
  MotionPlan rest;
  Graph graph, stopped_graph;
  std::shared_ptr<const WorldSnapshot> world = task.world, world_now = world;
  StoppedContext() {
    rest.motion = executed;
    stopped_graph = motion_graph(task, rest);
  }
};
namespace online_resumed_plan_h {
using Context = StoppedContext;
}  // namespace online_resumed_plan_h
namespace online_free_way_h {
using Context = StoppedContext;
}  // namespace online_free_way_h
namespace online_continuation_h {
using Context = StoppedContext;
}  // namespace online_continuation_h
namespace online_changing_obstacles_h {
using Context = DriveContext;
}  // namespace online_changing_obstacles_h
namespace online_braking_h {
struct Context : DriveContext {
  const OnlinePlan online_plan{graph};
  const std::function<CheckReport(const Motion&)> verify = {};
  const int executed = 0;
};
}  // namespace online_braking_h
namespace online_ball_slip_h {
using Context = online_braking_h::Context;
}  // namespace online_ball_slip_h
namespace online_walk_ahead_h {
struct Context : DriveContext {
  const WorldAt world_seen_at = [](int) { return nullptr; };
  const WalkOptions options;
  Motion followed;
  void follow(const Motion& motion) { followed = motion; }
};
}  // namespace online_walk_ahead_h
namespace online_walk_plan_h {
/// Nothing new is seen.
struct Context : DriveContext {
  const Judge judge{parameter->robot, world};
  const CheckOptions limits;
  const WorldAt world_seen_at = [](int) { return nullptr; };
};
}  // namespace online_walk_plan_h
namespace online_warm_start_h {
using Context = WindowContext;
}
namespace online_drive_back_h {
struct Context : DriveContext {
  OnlinePlan online_plan{graph};
  Window window{online_plan, {.steps = 3}};
  const Eigen::VectorXd was = online_plan.configuration(0);
  Context() { window.move_to(0); }
};
}  // namespace online_drive_back_h
namespace online_way_back_h {
struct Context : online_drive_back_h::Context {
  const int executed = 1, entered = 4;
};
}  // namespace online_way_back_h
namespace online_led_wrenches_h {
struct Context : DriveContext {
  const Motion before = motion_of(graph, plan);
  const PlanRange range = {0, 3};
  const int from = 0, back = 3;
};
}  // namespace online_led_wrenches_h
namespace online_window_h {
struct Context : DriveContext {
  const OnlinePlan online{graph};
  const int executed = 0;
  Problem problem;
};
}  // namespace online_window_h
namespace online_window_solver_h {
struct Context : WindowContext {
  Incumbent incumbent;
  const Termination termination;
  WindowStatistics statistics;
};
}  // namespace online_window_solver_h
namespace online_window_cause_h {
struct Context : DriveContext {
  const OnlinePlan online{graph};
  Context() : DriveContext(2.56, 33) {}
};
}  // namespace online_window_cause_h
namespace online_window_quality_h {
/// Of the whole drive; each constraint counts for the first step.
struct Context : DriveContext {
  Problem problem;
  Workspace workspace;
  const ConstraintReader reader = compiled();
  const std::vector<int> step_of = std::vector<int>(problem.constraints().size(), 1);
  const int steps = 4;
  double cost = 1.0;
  static double optimise() { return 0.5; }
  static void keep() {}
  ConstraintReader compiled() {
    problem.compile(graph);
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    return ConstraintReader(workspace);
  }
};
}  // namespace online_window_quality_h
namespace plan_judging_h {
using Context = DriveContext;
}
namespace plan_plan_h {
struct Context : DriveContext {
  const TypeRegistry types = robot_types();
  Context() { write_graph(graph, "plan.g2o"); }
  static TypeRegistry robot_types() {
    TypeRegistry types = standard_types();
    add_robot_types(types);
    return types;
  }
};
}  // namespace plan_plan_h
namespace plan_record_h {
using Context = RecordContext;
}  // namespace plan_record_h
namespace plan_plan_edges_h {
struct Context : DriveContext {
  const Motion motion = motion_of(DriveContext::graph, plan);
  const std::shared_ptr<const RobotParameter>& robot = parameter;
  const std::shared_ptr<const WorldParameter> world = std::make_shared<const WorldParameter>();
  Graph graph;
};
}  // namespace plan_plan_edges_h
namespace plan_plan_index_h {
struct Context : DriveContext {
  const std::vector<int>& slots = plan.slots;
};
}  // namespace plan_plan_index_h
namespace plan_carried_wrenches_h {
using Context = DriveContext;
}  // namespace plan_carried_wrenches_h
namespace plan_seen_world_h {
struct Context : DriveContext {
  LocalPlanner planner{graph, {}};
  const Judging judging = judging_of(graph, plan, {.data_folder = data_folder});
};
}  // namespace plan_seen_world_h
namespace plan_slope_limits_h {
struct Context : DriveContext {
  Context() : DriveContext(0.72, 9) {}
  const Robot& robot = *parameter->robot;
  const Motion motion = motion_of(graph, plan);
  const Eigen::VectorXd& q = motion.configurations[7];
};
}  // namespace plan_slope_limits_h

/// COMAN+ on both soles.
inline constexpr std::string_view kStanding = R"(<contacts version="1" name="standing">
  <contact link="l_sole" kind="surface" position="0 0.1 0" normal="0 0 1" forward="1 0 0"
           half_x="0.08" half_y="0.035" mu="0.6" max_force="1000"/>
  <contact link="r_sole" kind="surface" position="0 -0.1 0" normal="0 0 1" forward="1 0 0"
           half_x="0.08" half_y="0.035" mu="0.6" max_force="1000"/>
</contacts>
)";

namespace scenario_contacts_file_h {
struct Context {
  const Robot& robot = *coman_plus();
  Context() { write_example_file("standing.xml", kStanding); }
};
}  // namespace scenario_contacts_file_h
namespace answer_planner_answer_h {
struct Context : StepContext {
  const PostureSolver solver{task.robot};
  const PostureProblem problem = {.stance = stance, .preferred = q};
};
}  // namespace answer_planner_answer_h
namespace posture_posture_problem_h {
using Context = StepContext;
}
namespace posture_posture_solver_h {
struct Context : scenario_contacts_file_h::Context {
  const RobotFiles files = shipped_robot("coman_plus").value();
  const std::filesystem::path &urdf = files.urdf, &srdf = files.srdf;
  const RobotOptions options;
  const Eigen::VectorXd home = robot.named_configuration("home");
};
}  // namespace posture_posture_solver_h
namespace posture_standing_start_h {
struct Context {
  const RobotFiles files = shipped_robot("coman_plus").value();
  const std::filesystem::path &urdf = files.urdf, &srdf = files.srdf;
};
}  // namespace posture_standing_start_h
namespace scenario_bar_place_h {
struct Context {
  const Bar bar = small_room().bars[0];
  const Contact contact = step_task().start.contacts[0];
};
}  // namespace scenario_bar_place_h
namespace scenario_contact_place_h {
struct Context {
  const World world = small_room();
  const Contact contact = step_task().start.contacts[0];
};
}  // namespace scenario_contact_place_h
namespace scenario_contact_task_h {
struct Context {
  const Stance &start = step_task().start, &goal = step_task().goals[0];
};
}  // namespace scenario_contact_task_h
namespace scenario_camera_element_h {
struct Context {
  Context() { write_example_file("hall.xml", kOneStep); }
};
}  // namespace scenario_camera_element_h
namespace scenario_contact_task_element_h {
struct Context {
  const std::vector<EndEffector> effectors = one_step().end_effectors;
  Context() { write_example_file("stones.xml", kOneStep); }
};
}  // namespace scenario_contact_task_element_h
namespace scenario_execution_element_h {
struct Context {
  const XmlFile xml = file();
  const XmlFile::Element& element = xml.root();
  Scenario scenario;
  static XmlFile file() {
    write_example_file("margin.xml", R"(<execution friction="0.7"/>)");
    return XmlFile("margin.xml", "execution");
  }
};
}  // namespace scenario_execution_element_h
namespace scenario_effector_element_h {
struct Context {
  const XmlFile xml = file();
  const XmlFile::Element& element = *xml.root().FirstChildElement();
  static XmlFile file() {
    write_example_file("feet.xml", R"(<feet><foot link="l_sole" kind="surface" position="0 0.1 0"
      half_x="0.08" half_y="0.035" mu="0.6" max_force="1000"/></feet>)");
    return XmlFile("feet.xml", "feet");
  }
};
}  // namespace scenario_effector_element_h
namespace scenario_environment_element_h {
struct Context {
  Context() { write_example_file("hall.xml", kOneStep); }
};
}  // namespace scenario_environment_element_h
namespace scenario_move_contacts_h {
struct Context : StepContext {
  ContactTask task = *scenario.contacts;
};
}  // namespace scenario_move_contacts_h
namespace scenario_scenario_h {
struct Context : in_planners::Context {
  Context() { write_example_file("hall.xml", kOneStep); }
};
}  // namespace scenario_scenario_h
namespace scenario_scenario_camera_h {
struct Context : StepContext {
  static void report(const std::string&) {}
};
}  // namespace scenario_scenario_camera_h
namespace scenario_snap_to_places_h {
struct Context : StepContext {
  ContactTask task = *scenario.contacts;
};
}  // namespace scenario_snap_to_places_h
namespace task_skin_frames_h {
using Context = StepContext;
}
namespace task_task_h {
struct Context : StepContext {
  const Motion motion = stances_motion(step_stances());
};
}  // namespace task_task_h
namespace task_task_stances_h {
using Context = StepContext;
}

}  // namespace locograph::documentation::in_planners
