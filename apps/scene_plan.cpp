#include <locograph/apps/packed.h>
#include <locograph/apps/scene.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/robots/robot_state.h>

#include <cmath>
#include <map>

namespace locograph {
namespace {

const VertexConfiguration& configuration(const PlanFile& file, int slot) {
  return file.graph.vertex(VertexId<VertexConfiguration>{slot});
}

void append(const Eigen::VectorXd& q, std::vector<float>& numbers) {
  for (const double value : q) numbers.push_back(static_cast<float>(value));
}

/// What the tracking edges hold to: the plan before it was refined, by vertex slot.
std::map<int, Eigen::VectorXd> references(const Graph& graph) {
  std::map<int, Eigen::VectorXd> result;
  for (const auto& pool : graph.edge_pools()) {
    const auto* tracking = dynamic_cast<const TypedEdgePool<EdgePlanTracking>*>(pool.get());
    if (tracking == nullptr) continue;
    for (const EdgePlanTracking& edge : tracking->edges) {
      result.emplace(edge.vertices[0], edge.reference);
    }
  }
  return result;
}

/// The lowest point of a wheel's disc touches the ground.
Json wheel_contact(const Wheel& wheel, const RobotState& state) {
  const Eigen::Isometry3d& carrier = state.world_from_link(wheel.carrier);
  const Eigen::Vector3d centre = carrier * wheel.centre_in_carrier;
  const Eigen::Vector3d axle = carrier.linear() * wheel.axle_in_carrier;
  Eigen::Vector3d down = axle.z() * axle - Eigen::Vector3d::UnitZ();
  down = down.norm() > 1e-6 ? Eigen::Vector3d(down.normalized())
                            : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
  return {{"link", wheel.link},
          {"kind", "wheel"},
          {"position", vector_json(centre + wheel.radius_m * down)},
          {"normal", {0, 0, 1}},
          {"radius", wheel.radius_m}};
}

}  // namespace

void add_plan_scene(const PlanFile& file, const SceneOptions& options, Json& scene) {
  const Robot& robot = *file.plan.robot->robot;
  const std::map<int, Eigen::VectorXd> planned = references(file.graph);
  RobotState state(robot);
  std::vector<float> configurations, reference;
  Json times = Json::array(), ids = Json::array(), contacts = Json::array();
  for (const int slot : file.plan.slots) {
    const VertexConfiguration& vertex = configuration(file, slot);
    times.push_back(rounded(vertex.time_s));
    ids.push_back(file.graph.vertex_record(slot).id);
    append(vertex.state, configurations);
    const auto found = planned.find(slot);
    append(found == planned.end() ? Eigen::VectorXd(vertex.state) : found->second, reference);
    if (!file.plan.wheels) continue;
    state.update(vertex.state.data());
    Json here = Json::array();
    for (const Wheel& wheel : file.plan.wheels->wheels) here.push_back(wheel_contact(wheel, state));
    contacts.push_back(std::move(here));
  }
  const int count = static_cast<int>(file.plan.slots.size());
  Json plan = {{"times", std::move(times)},
               {"configurations", packed_floats(configurations)},
               {"configuration_size", robot.configuration_size()},
               {"ids", std::move(ids)}};
  if (!planned.empty()) plan["reference"] = packed_floats(reference);
  if (options.executed >= 0) {
    if (options.executed >= count) {
      throw Error(file.name, 0, "no configuration " + std::to_string(options.executed),
                  "0 to " + std::to_string(count - 1));
    }
    plan["executed"] = options.executed;
    plan["window"] = std::min(options.window, count - 1 - options.executed);
  }
  if (file.plan.wheels) {
    plan["contacts"] = std::move(contacts);
    Json names = Json::array();
    for (const Wheel& wheel : file.plan.wheels->wheels) names.push_back(wheel.link_name);
    scene["stances"] = {{{"from", 0}, {"to", count - 1}, {"contacts", std::move(names)}}};
  }
  scene["plan"] = std::move(plan);
}

Json check_scene(const PlanFile& file, const CheckReport& report) {
  Json violations = Json::array();
  for (const Violation& v : report.violations) {
    const int slot = file.plan.slots.at(static_cast<std::size_t>(v.at_vertex));
    violations.push_back({{"constraint", v.constraint},
                          {"violated", v.violated},
                          {"worst", std::isfinite(v.worst) ? Json(v.worst) : Json(nullptr)},
                          {"unit", v.unit},
                          {"limit", v.limit},
                          {"at_vertex", file.graph.vertex_record(slot).id},
                          {"index", v.at_vertex},
                          {"count", v.count},
                          {"time", v.time_s},
                          {"at_point", vector_json(v.at_point)},
                          {"what", v.what}});
  }
  return {{"feasible", report.feasible},
          {"min_clearance_m", report.min_clearance_m},
          {"min_self_clearance_m", report.min_self_clearance_m},
          {"max_velocity_ratio", report.max_velocity_ratio},
          {"max_contact_error_m", report.max_contact_error_m},
          {"violations", std::move(violations)}};
}

}  // namespace locograph
