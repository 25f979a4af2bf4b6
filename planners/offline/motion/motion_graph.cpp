#include <locograph/planners/offline/drive/wheeled_plan.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace locograph {
namespace {

constexpr double kConstraint = 1e5, kLimit = 1e4, kAcceleration = 1e2;
constexpr double kSelfMargin_m = 0.01, kObstacleMargin_m = 0.01;
constexpr int kSweptSamples = 2;

using MotionVertices = std::vector<VertexId<VertexConfiguration>>;

/// The spheres that are clear of the world all along have weight; nothing if it is empty.
std::optional<EdgeSweptObstacleDistance> swept_edge(const Graph& graph, const Plan& plan,
                                                    const MotionVertices& ids) {
  if (!plan.world || (plan.world->map.empty() && plan.world->obstacles.empty())) return {};
  const auto& all = graph.parameters().all();
  const auto named =
      std::ranges::find_if(all, [&](const auto& one) { return one.second == plan.world; });
  EdgeSweptObstacleDistance edge(*plan.robot, named->first, kObstacleMargin_m, kSweptSamples,
                                 kLimit);
  edge.bind(graph.parameters());
  Eigen::VectorXd lack(edge.weights.size());
  ConfigurationState before = graph.vertex(ids.front()).make_derived(), after = before;
  graph.vertex(ids.front()).derive(graph.state(ids.front().slot), before);
  for (std::size_t i = 1; i < ids.size(); ++i) {
    graph.vertex(ids[i]).derive(graph.state(ids[i].slot), after);
    edge.error(before, after, lack);
    edge.weights = (lack.array() > 0.0).select(0.0, edge.weights);
    std::swap(before, after);
  }
  return edge;
}

bool is_limited(double limit) { return limit > 0.0 && std::isfinite(limit); }

}  // namespace

void add_motion_edges(Graph& graph, const CheckOptions& check,
                      const std::vector<StanceWrenches>& wrenches) {
  const Plan plan = plan_of(graph);
  const Robot& model = *plan.robot->robot;
  MotionVertices ids;
  std::vector<Eigen::VectorXd> configurations;
  int free_id = 0;
  for (const int slot : plan.slots) {
    ids.push_back({slot});
    configurations.push_back(graph.vertex(ids.back()).state);
    free_id = std::max(free_id, graph.vertex_record(slot).id + 1);
  }
  if (!wrenches.empty() && wrenches.size() != ids.size()) {
    throw Error("wrenches of " + std::to_string(wrenches.size()) + " configurations",
                "of all " + std::to_string(ids.size()));
  }
  const EdgeSelfCollision apart =
      self_collision_edge(plan.robot, configurations, kSelfMargin_m, kLimit);
  const std::optional<EdgeSweptObstacleDistance> swept = swept_edge(graph, plan, ids);
  const double base_linear = is_limited(check.base_linear_m_s) ? check.base_linear_m_s : 0.0;
  const double base_angular = is_limited(check.base_angular_rad_s) ? check.base_angular_rad_s : 0.0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (const int number : contacts_at(plan.stance_from, i)) {
      const auto contact = graph.parameters().get<ContactParameter>(number);
      graph.add_edge(EdgeContact(*contact, number, kConstraint), ids[i]);
    }
    graph.add_edge(EdgeJointLimits(model, 0.0, kLimit), ids[i]);
    if ((apart.weights.array() > 0.0).any()) graph.add_edge(apart, ids[i]);
    if (!wrenches.empty() && !wrenches[i].empty() && plan.stance_from[i]) {
      add_balance_edges(graph, ids[i], *plan.stance_from[i], wrenches[i],
                        free_id + static_cast<int>(i), check);
    }
    if (i == 0) continue;
    graph.add_edge(EdgeVelocityLimits(model, 1.0, base_linear, base_angular, kLimit), ids[i - 1],
                   ids[i]);
    if (plan.stance_from[i - 1] && !plan.stance_from[i - 1]->wheels.empty()) {
      const int stance = graph.vertex(ids[i - 1]).stance_number;
      graph.add_edge(EdgeRolling(*plan.stance_from[i - 1], stance, kConstraint), ids[i - 1],
                     ids[i]);
    }
    if (swept) graph.add_edge(*swept, ids[i - 1], ids[i]);
    if (i == 1 || !is_limited(check.joint_acceleration_rad_s2)) continue;
    graph.add_edge(
        EdgeAccelerationLimits(model, check.joint_acceleration_rad_s2, 0.0, 0.0, kAcceleration),
        ids[i - 2], ids[i - 1], ids[i]);
  }
}

Graph motion_graph(const Scenario& scenario, const StanceProblem& problem, const MotionPlan& plan) {
  const Motion& motion = plan.motion;
  if (motion.configurations.empty()) throw Error("a motion without configurations", "one or more");
  Graph graph;
  const std::vector<int> numbers =
      add_task(graph, scenario, problem, motion.stances, {.incomplete = !plan.success});
  int number = graph.parameters().all().rbegin()->first;
  for (std::size_t j = 0; j < plan.segments.size(); ++j) {
    const SegmentRecord& record = plan.segments[j];
    const auto segment = std::make_shared<SegmentParameter>();
    segment->segment = static_cast<int>(j);
    segment->stance_number = numbers.at(static_cast<std::size_t>(record.stance));
    segment->from_s = motion.time_s.at(static_cast<std::size_t>(record.first));
    segment->duration_s = record.duration_s;
    segment->planner = record.planner;
    graph.parameters().set(++number, segment);
  }
  for (std::size_t i = 0; i < motion.configurations.size(); ++i) {
    if (motion.stance_from[i] < 0) {
      throw Error("a step whose stance is not known", "a stance for each step");
    }
    const int stance = numbers.at(static_cast<std::size_t>(motion.stance_from[i]));
    VertexConfiguration vertex(kRobotNumber, problem.robot, motion.time_s[i],
                               motion.configurations[i], stance);
    if (!motion.slopes.empty()) vertex.slopes = motion.slopes.at(i);
    graph.add_vertex(static_cast<int>(i), std::move(vertex));
  }
  graph.set_fixed(graph.slot_of(0), true);
  add_motion_edges(graph, problem.check, plan.wrenches);
  return graph;
}

}  // namespace locograph
