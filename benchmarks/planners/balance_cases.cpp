#include "balance_cases.h"

#include <locograph/common/uniform.h>
#include <locograph/core/graph.h>
#include <locograph/core/optimiser.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/statics.h>
#include <locograph/solvers/linear_solvers.h>

#include <cmath>

namespace locograph {
namespace {

constexpr int kRobot = 0, kFirst = 1;

Eigen::Vector3d vector(std::mt19937_64& random, double scale) {
  Eigen::Vector3d v;
  for (double& x : v) x = uniform(random, -scale, scale);
  return v;
}

double weight_of(const BalanceRobot& robot) {
  return robot.model().total_mass() * standard_gravity().norm();
}

Contact draw_contact(const BalanceRobot& robot, const RobotState& state, const std::string& link,
                     bool hand, bool flat, std::mt19937_64& random) {
  Contact contact;
  EndEffector& effector = contact.effector;
  effector.link = link;
  const Eigen::Isometry3d& pose = state.world_from_link(robot.model().link_index(link));
  const bool axes_in_world = !flat || uniform(random, 0.0, 1.0) < 0.5;
  const double slope = uniform(random, 0.0, 1.0) < 0.3 ? 1.0 : 0.3;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  if (axes_in_world) normal += vector(random, slope);
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitX() + vector(random, 0.3);
  effector.kind = flat ? ContactKind::kSurface : ContactKind::kPoint;
  effector.half_x_m = uniform(random, 0.04, 0.1);
  effector.half_y_m = uniform(random, 0.02, 0.06);
  effector.friction = uniform(random, 0.3, 0.9);
  effector.max_force_N = uniform(random, 0.5, 1.5) * weight_of(robot);
  if (hand && uniform(random, 0.0, 1.0) < 0.4) {
    effector.kind = ContactKind::kGrasp;
    effector.max_force_N = uniform(random, 0.1, 0.8) * weight_of(robot);
    effector.max_moment_Nm = uniform(random, 0.0, 20.0);
  }
  const Eigen::Matrix3d turn = pose.linear();
  contact.position = pose.translation();
  contact.normal = axes_in_world ? normal : Eigen::Vector3d(turn * normal);
  contact.forward = axes_in_world ? forward : Eigen::Vector3d(turn * forward);
  effector.normal = turn.transpose() * contact.normal;
  effector.forward = turn.transpose() * *contact.forward;
  return contact;
}

/// A surface's four corners as points.
std::vector<Contact> corners_of(const Contact& surface) {
  const Eigen::Matrix3d in_link = axes_in_link(surface.effector), in_world = axes_in_world(surface);
  std::vector<Contact> corners;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      const Eigen::Vector3d corner(a * surface.effector.half_x_m, b * surface.effector.half_y_m,
                                   0.0);
      corners.push_back(surface);
      corners.back().effector.kind = ContactKind::kPoint;
      corners.back().effector.point += in_link * corner;
      corners.back().position += in_world * corner;
    }
  }
  return corners;
}

/// 1 / unit² of each row of EDGE_CONTACT_WRENCH.
Eigen::VectorXd contact_weights(const std::vector<Contact>& contacts, int facets, double weight) {
  std::vector<double> units;
  const auto add = [&units](int count, double unit) {
    for (int i = 0; i < count; ++i) units.push_back(unit);
  };
  for (const Contact& contact : contacts) {
    const EndEffector& effector = contact.effector;
    if (effector.kind == ContactKind::kGrasp) {
      add(3, effector.max_force_N);
      add(2, effector.max_moment_Nm);
      continue;
    }
    add(1, weight);
    add(1, effector.max_force_N);
    add(facets, weight);
    if (effector.kind == ContactKind::kPoint) continue;
    add(2, weight * effector.half_x_m);
    add(2, weight * effector.half_y_m);
    add(8, weight * (effector.half_x_m + effector.half_y_m));
  }
  const Eigen::Map<const Eigen::VectorXd> all(units.data(),
                                              static_cast<Eigen::Index>(units.size()));
  return all.array().square().inverse().matrix();
}

}  // namespace

BalanceRobot balance_robot(const std::string& name) {
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/" + name + "/" + name;
  return {name,
          std::make_shared<const RobotParameter>(stem + ".urdf", stem + ".srdf", RobotOptions{})};
}

BalanceCase without_surface_limits(const BalanceRobot& robot, BalanceCase posture) {
  for (Contact& contact : posture.contacts) {
    if (contact.effector.kind != ContactKind::kSurface) continue;
    contact.effector.max_force_N = 100.0 * weight_of(robot);
  }
  return posture;
}

BalanceCase draw_balance_case(const BalanceRobot& robot, std::mt19937_64& random) {
  const Robot& model = robot.model();
  BalanceCase drawn;
  drawn.configuration = model.named_configuration("home");
  const Eigen::Vector3d turn = vector(random, 0.3);
  drawn.configuration.segment<4>(3) =
      Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())).coeffs();
  const double reach = uniform(random, 0.02, 0.25);
  for (int i = 0; i < model.active_joint_count(); ++i) {
    const Joint& joint = model.active_joint(i);
    const double range =
        joint.type == JointType::kContinuous ? 2.0 * EIGEN_PI : joint.upper - joint.lower;
    double& q = drawn.configuration[7 + i];
    q = std::clamp(q + reach * uniform(random, -range, range), joint.lower, joint.upper);
  }
  const bool coman = robot.name == "coman_plus";
  const std::vector<std::string> feet =
      coman ? std::vector<std::string>{"l_sole", "r_sole"}
            : std::vector<std::string>{"wheel_1", "wheel_2", "wheel_3", "wheel_4"};
  const std::vector<std::string> hands = coman ? std::vector<std::string>{"TCP_L", "TCP_R"}
                                               : std::vector<std::string>{"ball1_tip", "ball2_tip"};
  RobotState state(model);
  state.update(drawn.configuration.data());
  while (drawn.contacts.empty()) {
    for (const std::string& link : feet) {
      if (uniform(random, 0.0, 1.0) < 0.25) continue;
      drawn.contacts.push_back(draw_contact(robot, state, link, false, coman, random));
    }
    for (const std::string& link : hands) {
      if (uniform(random, 0.0, 1.0) < 0.5) continue;
      const bool flat = uniform(random, 0.0, 1.0) < 0.3;
      drawn.contacts.push_back(draw_contact(robot, state, link, !flat, flat, random));
    }
  }
  return drawn;
}

double graph_residual(const BalanceRobot& robot, const BalanceCase& posture,
                      SurfaceModel surfaces) {
  std::vector<Contact> contacts;
  for (const Contact& contact : posture.contacts) {
    if (contact.effector.kind == ContactKind::kSurface && surfaces == SurfaceModel::kCorners) {
      for (Contact& corner : corners_of(contact)) contacts.push_back(std::move(corner));
    } else {
      contacts.push_back(contact);
    }
  }
  Graph graph;
  graph.parameters().set(kRobot, robot.parameter);
  std::vector<int> numbers;
  for (const Contact& contact : contacts) {
    numbers.push_back(kFirst + static_cast<int>(numbers.size()));
    FrictionModel cone;
    if (contact.effector.kind != ContactKind::kGrasp) cone = {FrictionCone::kInner, posture.facets};
    graph.parameters().set(numbers.back(), std::make_shared<const ContactParameter>(
                                               robot.parameter, kRobot, contact, cone));
  }
  const auto q =
      graph.add_vertex(0, VertexConfiguration(kRobot, robot.parameter, 0.0, posture.configuration));
  graph.set_fixed(q, true);
  const auto w = graph.add_vertex(1, VertexWrenches(graph.parameters(), numbers));
  const double weight = weight_of(robot);
  graph.add_edge(EdgeBalance(1.0 / (weight * weight), 1.0 / (weight * weight)), q, w);
  EdgeContactWrench limits(*graph.vertex(w).contacts, 1.0);
  limits.weights = contact_weights(contacts, posture.facets, weight);
  graph.add_edge(limits, w);
  EdgeTorqueLimits torques(robot.model(), 1.0, 1.0);
  for (int i = 0; i < robot.model().active_joint_count(); ++i) {
    const double effort = robot.model().active_joint(i).max_effort;
    torques.weights[i] = std::isinf(effort) ? 0.0 : 1.0 / (effort * effort);
  }
  graph.add_edge(torques, q, w);

  OptimiserOptions options;
  options.max_iterations = 500;
  options.gain = 1e-15;
  options.gradient_tolerance = 1e-16;
  const OptimiserResult result = optimise(graph, options, *make_linear_solver("dense"));
  return std::sqrt(result.final.chi2);
}

}  // namespace locograph
