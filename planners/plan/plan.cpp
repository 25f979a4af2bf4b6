#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/plugins/wheel_contact/edge_wheel_contact.h>

#include <algorithm>

namespace locograph {
namespace {

const VertexConfiguration& configuration(const Graph& graph, int slot) {
  return graph.vertex(VertexId<VertexConfiguration>{slot});
}

/// Steering: the joint above a wheel's carrier.
bool steers(const Robot& robot, const WheelsParameter& wheels, int active) {
  for (const Wheel& wheel : wheels.wheels) {
    const int above = robot.links()[wheel.carrier].parent_joint;
    if (above >= 0 && robot.joints()[above].index == active) return true;
  }
  return false;
}

bool turns_wheel(const WheelsParameter& wheels, int active) {
  return std::any_of(wheels.wheels.begin(), wheels.wheels.end(),
                     [active](const Wheel& wheel) { return wheel.joint == active; });
}

template <class V>
bool is(const Graph& graph, int slot) {
  return graph.vertex_pools()[graph.vertex_record(slot).pool]->type() == typeid(V);
}

/// By the slot of a configuration: the VERTEX_WRENCHES that shares an edge with it, -1 for none.
std::vector<int> wrenches_by_configuration(const Graph& graph) {
  std::vector<int> wrenches(static_cast<std::size_t>(graph.vertex_slots()), -1);
  for (int edge = 0; edge < graph.edge_slots(); ++edge) {
    if (!graph.edge_alive(edge)) continue;
    for (const int a : graph.edge_vertices(edge)) {
      if (!is<VertexConfiguration>(graph, a)) continue;
      int& found = wrenches[static_cast<std::size_t>(a)];
      for (const int b : graph.edge_vertices(edge)) {
        if (!is<VertexWrenches>(graph, b)) continue;
        if (found >= 0 && found != b) {
          throw Error("configuration " + std::to_string(graph.vertex_record(a).id) +
                          " shares edges with several VERTEX_WRENCHES",
                      "one with all its contacts");
        }
        found = b;
      }
    }
  }
  return wrenches;
}

void add_contacts(const Graph& graph, const Plan& plan, Motion& motion) {
  const std::vector<int> wrenches = wrenches_by_configuration(graph);
  for (const int slot : plan.slots) {
    std::vector<ContactDescription>& contacts = motion.contacts.emplace_back();
    const int found = wrenches[static_cast<std::size_t>(slot)];
    if (found < 0) continue;
    const VertexWrenches& vertex = graph.vertex(VertexId<VertexWrenches>{found});
    if (!vertex.contacts) throw Error("wrenches without contacts", "a VERTEX_WRENCHES line");
    for (const auto& contact : *vertex.contacts) contacts.push_back(contact->given);
  }
}

}  // namespace

Plan plan_of(const Graph& graph) {
  Plan plan;
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (!graph.vertex_alive(slot)) continue;
    const int pool = graph.vertex_record(slot).pool;
    if (graph.vertex_pools()[pool]->type() == typeid(VertexConfiguration)) {
      plan.slots.push_back(slot);
    }
  }
  if (plan.slots.empty()) throw Error("the graph holds no plan", "VERTEX_CONFIGURATION lines");
  std::stable_sort(plan.slots.begin(), plan.slots.end(), [&graph](int a, int b) {
    return configuration(graph, a).time_s < configuration(graph, b).time_s;
  });
  plan.robot = configuration(graph, plan.slots.front()).robot;
  for (const int slot : plan.slots) {
    if (configuration(graph, slot).robot != plan.robot) {
      throw Error("the plan has configurations of several robots", "one robot");
    }
  }
  plan.wheels = graph.parameters().find<WheelsParameter>();
  plan.world = graph.parameters().find<WorldParameter>();
  return plan;
}

Motion motion_of(const Graph& graph, const Plan& plan) {
  Motion motion;
  for (const int slot : plan.slots) {
    const VertexConfiguration& vertex = configuration(graph, slot);
    motion.time_s.push_back(vertex.time_s);
    motion.configurations.push_back(vertex.state);
  }
  if (plan.wheels) {
    for (const Wheel& wheel : plan.wheels->wheels) {
      motion.wheels.push_back({wheel.link, wheel.radius_m});
    }
  }
  if (!graph.vertices_of<VertexWrenches>().empty()) add_contacts(graph, plan, motion);
  return motion;
}

void add_wheeled_plan(Graph& graph, const std::vector<double>& time_s,
                      const std::vector<Eigen::VectorXd>& configurations,
                      const PlanEdgeOptions& options) {
  const auto robot = graph.parameters().get<RobotParameter>(kRobotNumber);
  const auto wheels = graph.parameters().get<WheelsParameter>(kWheelsNumber);
  const Robot& model = *robot->robot;
  const int base = model.base_tangent_size();
  Eigen::VectorXd track = Eigen::VectorXd::Constant(model.tangent_size(), options.track_joint);
  Eigen::VectorXd steps = Eigen::VectorXd::Constant(model.tangent_size(), options.step_joint);
  track.head<6>() << options.track_forward, options.track_lateral, options.track_height,
      options.track_tilt, options.track_tilt, options.track_yaw;
  steps.head<6>().setConstant(options.step_base);
  for (int i = 0; i < model.active_joint_count(); ++i) {
    if (steers(model, *wheels, i)) {
      track[base + i] = 0.0;
      steps[base + i] = options.step_steering;
    } else if (turns_wheel(*wheels, i)) {
      track[base + i] = 0.0;
      steps[base + i] = 0.0;
    }
  }

  std::vector<VertexId<VertexConfiguration>> ids;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    ids.push_back(
        graph.add_vertex(static_cast<int>(i),
                         VertexConfiguration(kRobotNumber, robot, time_s[i], configurations[i])));
  }
  graph.set_fixed(ids.front(), true);
  Eigen::VectorXd step(model.tangent_size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    graph.add_edge(EdgePlanTracking(configurations[i], track), ids[i]);
    graph.add_edge(EdgeJointLimits(model, options.joint_margin_rad, options.limit_weight), ids[i]);
    graph.add_edge(
        EdgeObstacleDistance(*robot, kWorldNumber, options.obstacle_margin_m, options.limit_weight),
        ids[i]);
    graph.add_edge(EdgeWheelContact(*wheels, kWheelsNumber, options.constraint_weight), ids[i]);
    if (i == 0) continue;
    model.difference(configurations[i - 1].data(), configurations[i].data(), step.data());
    graph.add_edge(EdgeVelocityTracking(step, steps), ids[i - 1], ids[i]);
    graph.add_edge(EdgeVelocityLimits(model, options.velocity_fraction, options.base_linear_m_s,
                                      options.base_angular_rad_s, options.limit_weight),
                   ids[i - 1], ids[i]);
    graph.add_edge(EdgeRolling(*wheels, kWheelsNumber, options.constraint_weight), ids[i - 1],
                   ids[i]);
  }
}

}  // namespace locograph
