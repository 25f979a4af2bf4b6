#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/robots/states_together.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace locograph {

template class TypedVertexPool<VertexConfiguration>;

namespace {

/// A file with edges only makes vertices that know no robot.
std::shared_ptr<const RobotParameter> known(std::shared_ptr<const RobotParameter> robot) {
  if (!robot || !robot->robot) {
    throw Error("a configuration without a robot", "a VERTEX_CONFIGURATION that names it");
  }
  return robot;
}

int read_stance(FieldReader& in, const std::shared_ptr<const RobotParameter>& robot) {
  if (in.peek() == "-") {
    in.word();
    return kNoStance;
  }
  // Where the stance stands now, a plan of version 1 had the first number of the configuration.
  const Parameters& known = *in.parameters();
  const bool versioned = known.find<PlanParameter>() != nullptr;
  if (!versioned && !known.find<StanceParameter>()) refuse_older_plan(in, "VERTEX_CONFIGURATION");
  const int number = in.integer();
  if (known.get<StanceParameter>(number)->robot != robot) {
    in.fail("stance " + std::to_string(number) + " of another robot", "a stance of this robot");
  }
  return number;
}

/// Beyond all use, and where the digits of distances end.
void require_range(const FieldReader& in, const char* what, double value, double most,
                   const char* unit) {
  if (std::abs(value) <= most) return;
  char found[80], expected[80];
  std::snprintf(found, sizeof found, "%s %.6g%s", what, value, unit);
  std::snprintf(expected, sizeof expected, "at most %.6g%s", most, unit);
  in.fail(found, expected);
}

StateUpdate update_of(ConfigurationState& state) {
  return {
      &state.kinematics, state.q.data(), {state.sphere_centres.data(), state.bound_centres.data()}};
}

}  // namespace

ConfigurationState::ConfigurationState(std::shared_ptr<const RobotParameter> parameter)
    : robot(known(std::move(parameter))),
      kinematics(*robot->robot),
      q(robot->robot->configuration_size()),
      sphere_centres(static_cast<Eigen::Index>(robot->sphere_points.size()), 3),
      bound_centres(static_cast<Eigen::Index>(robot->bound_points.size()), 3) {}

void ConfigurationState::update(const double* configuration) {
  std::copy_n(configuration, q.size(), q.data());
  const StateUpdate one = update_of(*this);
  update_together({&one, 1}, robot->sphere_points, robot->bound_points);
}

Eigen::Vector3d relative_base_rotation(const ConfigurationState& a, const ConfigurationState& b) {
  const Eigen::AngleAxisd rotation(a.base_rotation().conjugate() * b.base_rotation());
  return rotation.angle() * rotation.axis();
}

VertexConfiguration::VertexConfiguration(int number,
                                         std::shared_ptr<const RobotParameter> parameter,
                                         double time, const Eigen::VectorXd& q, int stance)
    : robot_number(number), time_s(time), stance_number(stance), robot(std::move(parameter)) {
  if (q.size() != robot->robot->configuration_size()) {
    throw Error("configuration of " + std::to_string(q.size()) + " numbers",
                std::to_string(robot->robot->configuration_size()));
  }
  state = q;
}

void VertexConfiguration::derive_together(
    std::span<const Derivation<VertexConfiguration>> vertices) {
  constexpr std::size_t kMost = 32;
  std::array<StateUpdate, kMost> updates;
  for (std::size_t i = 0; i < vertices.size();) {
    const RobotParameter* robot = vertices[i].vertex->robot.get();
    std::size_t count = 0;
    for (; count < kMost && i < vertices.size(); ++count, ++i) {
      const auto& [vertex, state, derived] = vertices[i];
      if (vertex->robot.get() != robot) break;
      // Made for a vertex of another robot whose state has the same size.
      if (derived->robot != vertex->robot) *derived = vertex->make_derived();
      derived->time_s = vertex->time_s;
      std::copy_n(state, derived->q.size(), derived->q.data());
      updates[count] = update_of(*derived);
    }
    update_together(std::span(updates).first(count), robot->sphere_points, robot->bound_points);
  }
}

void VertexConfiguration::read(FieldReader& in) {
  robot_number = in.integer();
  robot = in.parameters()->get<RobotParameter>(robot_number);
  time_s = in.number();
  stance_number = read_stance(in, robot);
  state.resize(robot->robot->configuration_size());
  for (Eigen::Index i = 0; i < state.size(); ++i) state[i] = in.number();
  require_range(in, "a time of", time_s, ranges::kTime_s, " s");
  if (time_s < 0.0) in.fail("a time of " + std::to_string(time_s) + " s", "0 or later");
  if (robot->robot->floating_base()) {
    for (const double x : state.head<3>()) {
      require_range(in, "a base at", x, ranges::kCoordinate_m, " m");
    }
    read_quaternion(in, state);
  }
  for (const double joint : state.tail(robot->robot->active_joint_count())) {
    require_range(in, "a joint at", joint, ranges::kJoint_rad, "");
  }
  slopes.resize(in.at_end() ? 0 : robot->robot->tangent_size());
  for (double& slope : slopes) {
    slope = in.number();
    require_range(in, "a slope of", slope, ranges::kSlope, " per second");
  }
}

void read_quaternion(const FieldReader& in, Eigen::VectorXd& configuration) {
  if (configuration.size() < 7) return;
  const double squared = configuration.segment<4>(3).squaredNorm();
  if (squared < 1e-12) in.fail("quaternion of length zero", "a unit quaternion qx qy qz qw");
  // As it was written if it is normalised: reading what was written gives the same bits.
  if (std::abs(squared - 1.0) > 1e-14) configuration.segment<4>(3) /= std::sqrt(squared);
}

void VertexConfiguration::write(FieldWriter& out) const {
  out.integer(robot_number);
  out.number(time_s);
  if (stance_number == kNoStance) {
    out.word("-");
  } else {
    out.integer(stance_number);
  }
  for (const double number : state) out.number(number);
  for (const double number : slopes) out.number(number);
}

}  // namespace locograph
