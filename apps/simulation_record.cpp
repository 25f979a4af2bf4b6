#include <locograph/apps/csv.h>
#include <locograph/apps/simulation_record.h>
#include <locograph/common/ranges.h>
#include <locograph/plugins/static_balance/static_rows.h>

#include <algorithm>
#include <cstdio>

namespace locograph {
namespace {

bool within(const Eigen::VectorXd& numbers, double most) {
  return numbers.allFinite() && (numbers.size() == 0 || numbers.cwiseAbs().maxCoeff() <= most);
}

/// Whether a graph file may hold it.
bool is_sound(const SimulationSample& sample) {
  return within(sample.configuration, ranges::kJoint_rad) &&
         within(sample.velocity, ranges::kSlope) && within(sample.torques, ranges::kMoment_Nm) &&
         std::ranges::all_of(sample.forces,
                             [](const auto& f) { return within(f, ranges::kWrench); }) &&
         std::ranges::all_of(sample.moments,
                             [](const auto& m) { return within(m, ranges::kWrench); });
}

/// Along the axes of each contact of the stance, about its point.
StanceWrenches wrenches_of(const SimulationSample& sample, const RobotState& state,
                           const StanceParameter& stance, std::span<const EndEffector> effectors) {
  constexpr double kNothing[6] = {};
  StanceWrenches wrenches;
  for (const auto& contact : stance.contacts) {
    const std::size_t e = effector_of(effectors, contact->contact);
    const AppliedWrench place(state, *contact, kNothing);
    const Eigen::Vector3d& force = sample.forces[e];
    const Eigen::Vector3d moment = sample.moments[e] - place.touching_offset.cross(force);
    wrenches.emplace_back() << place.axes.transpose() * force, place.axes.transpose() * moment;
  }
  return wrenches;
}

/// Of the base's position in the world instead of along its own axes.
Eigen::VectorXd slopes_of(const Robot& robot, const SimulationSample& sample) {
  Eigen::VectorXd slopes = sample.velocity;
  if (!robot.floating_base()) return slopes;
  const Eigen::Quaterniond base(sample.configuration.segment<4>(3).data());
  slopes.head<3>() = base.normalized() * Eigen::Vector3d(sample.velocity.head<3>());
  return slopes;
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::vector<std::string> columns(const Robot& robot, std::span<const EndEffector> effectors) {
  std::vector<std::string> names = {"time_s", "plan_time_s", "stance"};
  const auto add_configuration = [&](const std::string& before) {
    if (robot.floating_base()) {
      for (const char* name :
           {"base_x", "base_y", "base_z", "base_qx", "base_qy", "base_qz", "base_qw"}) {
        names.push_back(before + name);
      }
    }
    for (int j = 0; j < robot.active_joint_count(); ++j) {
      names.push_back(before + robot.active_joint(j).name);
    }
  };
  add_configuration("");
  add_configuration("planned_");
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    names.push_back("torque_" + robot.active_joint(j).name);
  }
  for (const EndEffector& effector : effectors) {
    for (const char* axis : {"_x", "_y", "_z"}) {
      names.push_back("force_" + name_of(effector) + axis);
    }
  }
  return names;
}

}  // namespace

Record record_of_run(const Graph& graph, const Plan& plan, std::span<const EndEffector> effectors,
                     std::span<const SimulationSample> samples) {
  const Robot& robot = *plan.robot->robot;
  const Motion planned = motion_of(graph, plan);
  std::vector<const StanceParameter*> stances(planned.stances.size());
  for (std::size_t i = 0; i < plan.slots.size(); ++i) {
    if (planned.stance_from[i] < 0) continue;
    stances[static_cast<std::size_t>(planned.stance_from[i])] = plan.stance_from[i].get();
  }
  Record record;
  record.motion.stances = planned.stances;
  RobotState state(robot);
  for (const SimulationSample& sample : samples) {
    if (!is_sound(sample)) break;
    state.update(sample.configuration.data());
    record.motion.time_s.push_back(sample.time_s);
    record.motion.configurations.push_back(sample.configuration);
    record.motion.stance_from.push_back(sample.stance);
    record.motion.slopes.push_back(slopes_of(robot, sample));
    record.motion.wrenches.push_back(
        wrenches_of(sample, state, *stances[static_cast<std::size_t>(sample.stance)], effectors));
    record.plan_time_s.push_back(sample.plan_time_s);
    record.planned.push_back(sample.planned);
    record.torques.push_back(sample.torques);
  }
  return record;
}

std::string samples_csv(const Robot& robot, std::span<const EndEffector> effectors,
                        std::span<const SimulationSample> samples) {
  std::string text = csv_line(columns(robot, effectors));
  for (const SimulationSample& sample : samples) {
    std::vector<std::string> fields = {number_text(sample.time_s), number_text(sample.plan_time_s),
                                       std::to_string(sample.stance)};
    const auto add = [&](const auto& numbers) {
      for (const double number : numbers) fields.push_back(number_text(number));
    };
    add(sample.configuration);
    add(sample.planned);
    add(sample.torques);
    for (const Eigen::Vector3d& force : sample.forces) add(force);
    text += csv_line(fields);
  }
  return text;
}

}  // namespace locograph
