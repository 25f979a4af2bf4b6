#include <locograph/planners/plan/plan_edges.h>
#include <locograph/planners/plan/record.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/record/edge_measurement.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

void require_counts(const Record& record) {
  const std::size_t count = record.motion.configurations.size();
  if (count == 0) throw Error("a record without a moment", "one or more");
  for (const std::size_t given :
       {record.motion.time_s.size(), record.motion.stance_from.size(), record.motion.slopes.size(),
        record.motion.wrenches.size(), record.plan_time_s.size(), record.planned.size(),
        record.torques.size()}) {
    if (given == count) continue;
    throw Error("a record of " + std::to_string(count) + " moments with " + std::to_string(given) +
                    " of something",
                "of each moment one");
  }
}

void copy_parameters(const Graph& graph, const Plan& plan, const Record& record, Graph& result) {
  Parameters& parameters = result.parameters();
  auto format = std::make_shared<PlanParameter>(*graph.parameters().find<PlanParameter>());
  format->recorded = true;
  format->stances_only = false;
  parameters.replace(kPlanNumber, format);
  if (plan.world) parameters.set(kWorldNumber, plan.world);
  if (const auto scenario = graph.parameters().find<ScenarioParameter>()) {
    parameters.set(kScenarioNumber, scenario);
  }
  if (const auto contacts = graph.parameters().find<ContactsParameter>()) {
    parameters.set(kContactsNumber, contacts);
  }
  const auto origin = std::make_shared<RecordParameter>();
  origin->plan = record.plan_file;
  parameters.set(kRecordNumber, origin);
}

/// Those of the stance's contacts that bear load.
VertexWrenches wrenches_vertex(const Parameters& parameters, const StanceParameter& stance,
                               const StanceWrenches& wrenches) {
  if (wrenches.size() != stance.contacts.size()) {
    throw Error("wrenches at " + std::to_string(wrenches.size()) + " contacts",
                "one for each of the stance, " + std::to_string(stance.contacts.size()));
  }
  std::vector<int> numbers;
  std::vector<double> components;
  for (std::size_t c = 0; c < stance.contacts.size(); ++c) {
    if (!stance.contacts[c]->contact.bears_load) continue;
    numbers.push_back(stance.contact_numbers[c]);
    for (const int component : stance.contacts[c]->cone->components()) {
      components.push_back(wrenches[c][component]);
    }
  }
  VertexWrenches vertex(parameters, std::move(numbers));
  vertex.state = Eigen::Map<const Eigen::VectorXd>(components.data(),
                                                   static_cast<Eigen::Index>(components.size()));
  return vertex;
}

}  // namespace

Graph record_graph(const Graph& graph, const Plan& plan, const Record& record) {
  require_counts(record);
  const Robot& robot = *plan.robot->robot;
  Graph result;
  Parameters& parameters = result.parameters();
  parameters.set(kRobotNumber, plan.robot);
  const std::vector<int> stances = add_stances(result, plan.robot, record.motion.stances);
  copy_parameters(graph, plan, record, result);
  add_configurations(result, record.motion, stances);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(robot.tangent_size());
  const int count = static_cast<int>(record.motion.configurations.size());
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const VertexId<VertexConfiguration> configuration{result.slot_of(i)};
    const auto stance = static_cast<std::size_t>(record.motion.stance_from[at]);
    const auto wrenches = result.add_vertex(
        count + i, wrenches_vertex(parameters, *parameters.get<StanceParameter>(stances.at(stance)),
                                   record.motion.wrenches[at]));
    result.add_edge(EdgePlanTracking(record.planned[at], ones), configuration);
    result.add_edge(EdgeMeasurement(robot, record.plan_time_s[at], record.torques[at]),
                    configuration, wrenches);
  }
  return result;
}

Record record_of(const Graph& graph, const Plan& plan) {
  if (!plan.recorded) throw Error("no record of a plan carried out", "'recorded' in PARAMS_PLAN");
  Record record;
  record.motion = motion_of(graph, plan);
  record.planned = tracked_configurations(graph, plan);
  record.plan_time_s.resize(plan.slots.size());
  record.torques.resize(plan.slots.size());
  for (const EdgeMeasurement& edge : graph.edges_of<EdgeMeasurement>()) {
    const int i = plan.index.configuration[static_cast<std::size_t>(edge.vertices[0])];
    record.plan_time_s[static_cast<std::size_t>(i)] = edge.plan_time_s;
    record.torques[static_cast<std::size_t>(i)] = edge.torques;
  }
  for (std::size_t i = 0; i < plan.slots.size(); ++i) {
    const auto require = [&](bool there, const char* what, const char* expected) {
      if (there) return;
      const Graph::VertexRecord& vertex = graph.vertex_record(plan.slots[i]);
      throw Error("", vertex.line,
                  "configuration " + std::to_string(vertex.id) + " of a record without " + what,
                  expected);
    };
    require(record.planned[i].size() > 0, "a planned one", "an EDGE_PLAN_TRACKING");
    require(record.torques[i].size() > 0, "torques", "an EDGE_MEASUREMENT");
    require(plan.stance_from[i] != nullptr, "a stance", "a PARAMS_STANCE");
  }
  if (const auto origin = graph.parameters().find<RecordParameter>()) {
    record.plan_file = origin->plan;
  }
  return record;
}

TrackingErrors tracking_errors(const Robot& robot, const Record& record) {
  TrackingErrors errors;
  Eigen::VectorXd error(robot.tangent_size());
  for (std::size_t i = 0; i < record.planned.size(); ++i) {
    robot.difference(record.planned[i].data(), record.motion.configurations[i].data(),
                     error.data());
    const bool base = robot.floating_base();
    errors.base_m.push_back(base ? error.head<3>().norm() : 0.0);
    errors.base_rad.push_back(base ? error.segment<3>(3).norm() : 0.0);
    errors.joints.emplace_back(error.tail(robot.active_joint_count()).cwiseAbs());
    errors.most_base_m = std::max(errors.most_base_m, errors.base_m.back());
    errors.most_base_rad = std::max(errors.most_base_rad, errors.base_rad.back());
    for (int j = 0; j < robot.active_joint_count(); ++j) {
      const Joint& joint = robot.active_joint(j);
      if (joint.type == JointType::kContinuous) continue;
      if (errors.joints.back()[j] <= errors.most_joint_rad) continue;
      errors.most_joint_rad = errors.joints.back()[j];
      errors.worst_joint = joint.name;
    }
  }
  return errors;
}

WorstTorque worst_torque(const Robot& robot, const Record& record) {
  WorstTorque worst;
  for (const Eigen::VectorXd& torques : record.torques) {
    for (int j = 0; j < robot.active_joint_count(); ++j) {
      const double effort = robot.active_joint(j).max_effort;
      if (!(effort > 0.0)) continue;
      const double ratio = std::abs(torques[j]) / effort;
      if (ratio > worst.ratio) worst = {ratio, robot.active_joint(j).name};
    }
  }
  return worst;
}

}  // namespace locograph
