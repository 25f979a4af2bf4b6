#include <locograph/planners/offline/drive/wheeled_plan.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/edge_steering_slip.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace locograph {
namespace {

using Stances = std::vector<std::shared_ptr<const StanceParameter>>;

/// Steering: the joint above a wheel's carrier.
bool steers(const Robot& robot, const StanceParameter& stance, int active) {
  return std::any_of(stance.wheels.begin(), stance.wheels.end(), [&](const auto& standing) {
    const int above = robot.links()[static_cast<std::size_t>(standing.wheel.carrier)].parent_joint;
    return above >= 0 && robot.joints()[static_cast<std::size_t>(above)].index == active;
  });
}

bool turns_wheel(const StanceParameter& stance, int active) {
  return std::any_of(stance.wheels.begin(), stance.wheels.end(),
                     [active](const auto& standing) { return standing.wheel.joint == active; });
}

template <class Predicate>
bool in_any(const Stances& stances, Predicate&& predicate) {
  return std::any_of(stances.begin(), stances.end(),
                     [&](const auto& stance) { return predicate(*stance); });
}

/// Keeps the joints that `turns` picks from turning by more than max_rad over dt_s, or by more than
/// they do in `planned`, a tangent. Nothing where their velocity limits ask for as much.
template <class Turns>
std::optional<EdgeVelocityLimits> step_limit(const Robot& robot, const Eigen::VectorXd& planned,
                                             double dt_s, double max_rad,
                                             const PlanEdgeOptions& options, Turns&& turns) {
  constexpr double kRoom = 1.01;  // a plan is not an error from the start
  double fastest = 0.0;
  EdgeVelocityLimits edge(robot, 1.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const double velocity = robot.active_joint(i).max_velocity;
    if (!std::isfinite(velocity) || !turns(i)) continue;
    edge.weights[i] = options.limit_weight;
    fastest = std::max(fastest, velocity);
    max_rad = std::max(max_rad, kRoom * std::abs(planned[robot.base_tangent_size() + i]));
  }
  edge.fraction = max_rad / (fastest * dt_s);
  if (!(edge.fraction < options.velocity_fraction)) return std::nullopt;
  return edge;
}

}  // namespace

EdgeSelfCollision self_collision_edge(const std::shared_ptr<const RobotParameter>& robot,
                                      const std::vector<Eigen::VectorXd>& configurations,
                                      double margin_m, double weight, const JobControl& job) {
  EdgeSelfCollision edge(*robot, margin_m, weight);
  Eigen::VectorXd lack(edge.weights.size());
  ConfigurationState state(robot);
  std::size_t seen = 0;
  for (const Eigen::VectorXd& q : configurations) {
    if (!job.go_on("comparing links", seen++, configurations.size())) break;
    state.update(q.data());
    edge.error(state, lack);
    for (Eigen::Index p = 0; p < lack.size(); ++p) {
      if (lack[p] > 0.0) edge.weights[p] = 0.0;
    }
  }
  return edge;
}

bool add_wheeled_plan(Graph& graph, const Motion& motion, const PlanEdgeOptions& options,
                      const JobControl& job) {
  const auto robot = graph.parameters().get<RobotParameter>(kRobotNumber);
  const Robot& model = *robot->robot;
  const std::vector<int> numbers = add_stances(graph, robot, motion.stances);
  std::vector<int> number_from;
  Stances from;
  for (const int stance : motion.stance_from) {
    if (stance < 0) throw Error("a step whose stance is not known", "a stance for each step");
    number_from.push_back(numbers.at(static_cast<std::size_t>(stance)));
    from.push_back(graph.parameters().get<StanceParameter>(number_from.back()));
  }

  const int base = model.base_tangent_size();
  Eigen::VectorXd track = Eigen::VectorXd::Constant(model.tangent_size(), options.track_joint);
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(model.tangent_size(), options.step_joint);
  track.head<6>() << options.track_forward, options.track_lateral, options.track_height,
      options.track_tilt, options.track_tilt, options.track_yaw;
  steps.head<6>().setConstant(options.step_base);
  for (int i = 0; i < model.active_joint_count(); ++i) {
    if (in_any(from, [&](const auto& stance) { return steers(model, stance, i); })) {
      track[base + i] = 0.0;
      steps[base + i] = options.step_steering;
    } else if (in_any(from, [&](const auto& stance) { return turns_wheel(stance, i); })) {
      track[base + i] = 0.0;
      steps[base + i] = 0.0;
    }
  }

  const std::vector<Eigen::VectorXd>& configurations = motion.configurations;
  std::vector<VertexId<VertexConfiguration>> ids;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    if (!job.go_on("placing configurations", i, configurations.size())) return false;
    VertexConfiguration vertex(kRobotNumber, robot, motion.time_s[i], configurations[i],
                               number_from[i]);
    if (!motion.slopes.empty()) vertex.slopes = motion.slopes[i];
    ids.push_back(graph.add_vertex(static_cast<int>(i), std::move(vertex)));
  }
  graph.set_fixed(ids.front(), true);
  Eigen::VectorXd goal = track;
  goal[0] = goal[1] = goal[5] = options.track_goal;
  const EdgeSelfCollision apart =
      self_collision_edge(robot, configurations, options.self_margin_m, options.limit_weight, job);
  Eigen::VectorXd step(model.tangent_size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (!job.go_on("adding constraints", i, ids.size())) return false;
    graph.add_edge(EdgePlanTracking(configurations[i], i + 1 < ids.size() ? track : goal), ids[i]);
    graph.add_edge(EdgeJointLimits(model, options.joint_margin_rad, options.limit_weight), ids[i]);
    for (const int number : contacts_at(from, i)) {
      const auto contact = graph.parameters().get<ContactParameter>(number);
      graph.add_edge(EdgeContact(*contact, number, options.constraint_weight), ids[i]);
    }
    if (apart.weights.size() > 0) graph.add_edge(apart, ids[i]);
    if (i == 0) continue;
    model.difference(configurations[i - 1].data(), configurations[i].data(), step.data());
    graph.add_edge(EdgeVelocityTracking(step, steps), ids[i - 1], ids[i]);
    graph.add_edge(EdgeVelocityLimits(model, options.velocity_fraction, options.base_linear_m_s,
                                      options.base_angular_rad_s, options.limit_weight),
                   ids[i - 1], ids[i]);
    const double dt_s = motion.time_s[i] - motion.time_s[i - 1];
    const auto steering = [&](int joint) { return steers(model, *from[i - 1], joint); };
    const auto bending = [&](int joint) {
      return !steering(joint) && !turns_wheel(*from[i - 1], joint);
    };
    for (const auto& limit :
         {step_limit(model, step, dt_s, options.steering_step_rad, options, steering),
          step_limit(model, step, dt_s, options.leg_step_rad, options, bending)}) {
      if (limit) graph.add_edge(*limit, ids[i - 1], ids[i]);
    }
    if (!from[i - 1]->wheels.empty()) {
      graph.add_edge(EdgeRolling(*from[i - 1], number_from[i - 1], options.constraint_weight),
                     ids[i - 1], ids[i]);
      const EdgeSteeringSlip slip(*from[i - 1], number_from[i - 1], options.steering_slip_m,
                                  options.constraint_weight);
      if (slip.dimension() > 0) graph.add_edge(slip, ids[i - 1], ids[i]);
    }
    graph.add_edge(EdgeSweptObstacleDistance(*robot, kWorldNumber, options.obstacle_margin_m,
                                             options.swept_samples, options.limit_weight),
                   ids[i - 1], ids[i]);
    if (i == 1) continue;
    graph.add_edge(EdgeAccelerationLimits(model, options.joint_acceleration_rad_s2, 0.0, 0.0,
                                          options.acceleration_weight),
                   ids[i - 2], ids[i - 1], ids[i]);
  }
  return true;
}

}  // namespace locograph
