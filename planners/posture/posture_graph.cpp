#include <locograph/check/limits.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/posture/posture_graph.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/ground_distance/edge_ground_distance.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

using Kind = WatchedRows::Kind;

// On squared errors in m, rad and parts of the robot's weight.
constexpr double kContactWeight = 1e5, kBalanceWeight = 1e4, kLimitWeight = 1e4,
                 kWrenchWeight = 1e3, kTorqueWeight = 1e2;
/// Links that touch near the ground: what their contacts, closed up to a tolerance, give way to.
constexpr double kTouchingMargin = 3e-5, kTouchingWeight = 1e6;
constexpr double kPreferredJoint = 1e-2, kPreferredBase = 1e-4, kWrenchNorm = 1e-2;

// What counts as closed; the check allows 1e-4 m and 1e-3 rad.
constexpr double kContactTolerance = 5e-5, kBalanceTolerance = 2e-4, kWrenchTolerance = 5e-3;
/// The part of a margin that a violation may use up.
constexpr double kMarginUsed = 0.9;
constexpr double kNoMargin = 1e-7;
/// The tolerance that the type of an edge has.
constexpr double kOfType = 0.0;

double used(double margin) { return margin > 0.0 ? kMarginUsed * margin : kNoMargin; }

Eigen::VectorXd all(Eigen::Index rows, double value) {
  return Eigen::VectorXd::Constant(rows, value);
}

/// The judge takes the contact for one on the plane z = 0.
bool is_on_ground(const Contact& contact) {
  const Eigen::Vector3d normal = contact.normal.normalized();
  return std::abs(contact.position.z()) <= limits::kClosed_m &&
         std::acos(std::clamp(normal.z(), -1.0, 1.0)) <= limits::kClosed_rad;
}

/// What the contact bears, less a margin.
Contact with_margin(Contact contact, double margin) {
  const double part = 1.0 - margin;
  EndEffector& effector = contact.effector;
  effector.friction *= part;
  effector.half_x_m *= part;
  effector.half_y_m *= part;
  effector.max_force_N *= part;
  effector.max_moment_Nm *= part;
  return contact;
}

}  // namespace

double WatchedRows::worst(const Workspace& workspace) const {
  return ConstraintReader(workspace).worst().ratio;
}

Violated WatchedRows::violated(const Workspace& workspace) const {
  const Robot& robot = *robot_->robot;
  Violated violated;
  violated.joints.assign(static_cast<std::size_t>(robot.active_joint_count()), false);
  const auto move_chain = [&](int link) {
    for (const int i : robot.support(link)) {
      const int active = robot.axes()[static_cast<std::size_t>(i)].active;
      violated.joints[static_cast<std::size_t>(active)] = true;
    }
  };
  ConstraintReader(workspace).each([&](const ConstraintReader::Row& found) {
    if (found.ratio <= 1.0) return;
    const Edge& edge = edges_[static_cast<std::size_t>(found.constraint)];
    const std::size_t row = static_cast<std::size_t>(found.row);
    switch (edge.kind) {
      case Kind::kContact:
        violated.base = true;
        move_chain(edge.link);
        break;
      case Kind::kJoints:
        violated.joints[row] = true;
        break;
      case Kind::kSelf: {
        const SelfCollisionShapes::Pair& pair = robot_->self_collision.pairs[row];
        move_chain(robot_->bounds[static_cast<std::size_t>(pair.first)].link);
        move_chain(robot_->bounds[static_cast<std::size_t>(pair.second)].link);
        break;
      }
      case Kind::kSpheres:
        violated.base = true;
        move_chain(robot_->spheres[row].link);
        break;
      case Kind::kBalance:
      case Kind::kWrenches:
      case Kind::kTorques:
        violated.base = true;
        for (const int link : loaded_links_) move_chain(link);
        break;
    }
  });
  // Nothing stands out: the check refused what the edges allow.
  if (!violated.base && std::none_of(violated.joints.begin(), violated.joints.end(),
                                     [](bool moved) { return moved; })) {
    violated.base = true;
    violated.joints.assign(violated.joints.size(), true);
  }
  return violated;
}

PostureGraph::PostureGraph(std::shared_ptr<const RobotParameter> robot,
                           std::shared_ptr<const WorldParameter> seen,
                           const PostureProblem& problem, const PostureOptions& options,
                           const PostureShapes& shapes)
    : robot_(std::move(robot)), weight_N_(robot_->robot->total_mass() * standard_gravity().norm()) {
  const Robot& model = *robot_->robot;
  add_parameters(std::move(seen), problem, options);
  q_ = graph.add_vertex(
      0, VertexConfiguration(kRobotNumber, robot_, 0.0, problem.preferred, stance_number_));
  w_ = graph.add_vertex(1, VertexWrenches(graph.parameters(), wrench_numbers_));

  Eigen::VectorXd preference = all(model.tangent_size(), kPreferredJoint);
  preference.head(model.base_tangent_size()).setConstant(kPreferredBase);
  graph.add_edge(EdgePlanTracking(problem.preferred, preference), q_);
  graph.add_edge(EdgeWrenchNorm(graph.vertex(w_), kWrenchNorm / (weight_N_ * weight_N_)), w_);
  add_contact_edges();
  constrain(Kind::kJoints, EdgeJointLimits(model, options.joint_margin_rad, kLimitWeight),
            used(options.joint_margin_rad), -1, q_);
  add_balance_edges(options);
  add_collision_edges(problem, options, shapes);
}

void PostureGraph::add_parameters(std::shared_ptr<const WorldParameter> seen,
                                  const PostureProblem& problem, const PostureOptions& options) {
  graph.parameters().set(kRobotNumber, robot_);
  const World& world = seen->snapshot->world();
  seen_ = world.map || !world.obstacles.empty();
  ground_z_m_ = seen->ground_z_m;
  graph.parameters().set(kWorldNumber, std::move(seen));
  Stance stance = problem.stance;
  for (Contact& contact : stance.contacts) contact = with_margin(contact, options.wrench_margin);
  stance_number_ = add_stances(graph, robot_, {stance}).front();
  const auto parameter = graph.parameters().get<StanceParameter>(stance_number_);
  for (std::size_t i = 0; i < parameter->contacts.size(); ++i) {
    const Contact& contact = parameter->contacts[i]->contact;
    contact_numbers_.push_back(parameter->contact_numbers[i]);
    if (!contact.bears_load) continue;
    wrench_numbers_.push_back(contact_numbers_.back());
    wrench_axes_.push_back(axes_in_world(contact));
    loaded_.push_back(i);
    loaded_links_.push_back(parameter->contacts[i]->link);
  }
}

template <class E, class... Vertices>
void PostureGraph::constrain(Kind kind, E edge, double tolerance, int link, Vertices... vertices) {
  if (edge.dimension() == 0) return;
  const EdgeId id = graph.add_edge(std::move(edge), vertices...);
  if (tolerance > 0.0) graph.set_constraint(id, constraint_of<E>(), tolerance);
  constraints_.push_back({kind, id, link});
}

void PostureGraph::add_contact_edges() {
  for (const int number : contact_numbers_) {
    const auto contact = graph.parameters().get<ContactParameter>(number);
    constrain(Kind::kContact, EdgeContact(*contact, number, kContactWeight), kContactTolerance,
              contact->closure.link(), q_);
  }
}

void PostureGraph::add_balance_edges(const PostureOptions& options) {
  const double unit = 1.0 / (weight_N_ * weight_N_);
  constrain(Kind::kBalance, EdgeBalance(kBalanceWeight * unit, kBalanceWeight * unit),
            kBalanceTolerance * weight_N_, -1, q_, w_);
  EdgeContactWrench bearable(*graph.vertex(w_).contacts, kWrenchWeight * unit);
  const double spare = std::min(kWrenchTolerance, 0.1 * options.wrench_margin) * weight_N_;
  constrain(Kind::kWrenches, std::move(bearable), std::max(spare, kNoMargin), -1, w_);
  if (!options.enforce_torque_limits) return;
  const Robot& robot = *robot_->robot;
  EdgeTorqueLimits torques(robot, 1.0 - options.torque_margin, 0.0);
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const double effort = robot.active_joint(i).max_effort;
    torques.weights[i] = std::isfinite(effort) ? kTorqueWeight / (effort * effort) : 0.0;
  }
  constrain(Kind::kTorques, std::move(torques), kOfType, -1, q_, w_);
}

void PostureGraph::add_collision_edges(const PostureProblem& problem, const PostureOptions& options,
                                       const PostureShapes& shapes) {
  const auto pairs = static_cast<Eigen::Index>(robot_->self_collision.pairs.size());
  if (pairs > 0) {
    EdgeSelfCollision apart(*robot_, options.self_margin_m, kLimitWeight);
    for (Eigen::Index p = 0; p < pairs; ++p) {
      if (shapes.coarse_pairs[static_cast<std::size_t>(p)]) apart.weights[p] = 0.0;
    }
    constrain(Kind::kSelf, std::move(apart), used(options.self_margin_m), -1, q_);
  }
  const auto spheres = static_cast<Eigen::Index>(robot_->spheres.size());
  if (spheres == 0) return;
  const std::vector<bool> touching = touching_links(*robot_->robot, problem.stance.contacts);
  const auto release_touching = [&](Eigen::VectorXd& weights) {
    for (Eigen::Index i = 0; i < spheres; ++i) {
      const CollisionSphere& sphere = robot_->spheres[static_cast<std::size_t>(i)];
      if (touching[static_cast<std::size_t>(sphere.link)]) weights[i] = 0.0;
    }
  };
  // The edge knows the plane z = 0 only; other ground is left to the judge.
  if (ground_z_m_ == 0.0) {
    EdgeGroundDistance ground(*robot_, options.ground_margin_m, kLimitWeight);
    release_touching(ground.weights);
    constrain(Kind::kSpheres, std::move(ground), used(options.ground_margin_m), -1, q_);
    keep_touching_above_ground(problem, options, shapes);
  }
  if (seen_) {
    EdgeObstacleDistance obstacles(*robot_, kWorldNumber, options.obstacle_margin_m, kLimitWeight);
    release_touching(obstacles.weights);
    constrain(Kind::kSpheres, std::move(obstacles), used(options.obstacle_margin_m), -1, q_);
  }
}

/// Links whose contacts are not on the ground may not reach into it, however near it they touch.
void PostureGraph::keep_touching_above_ground(const PostureProblem& problem,
                                              const PostureOptions& options,
                                              const PostureShapes& shapes) {
  const Robot& model = *robot_->robot;
  const double margin = std::min(kTouchingMargin, options.ground_margin_m);
  std::vector<bool> on_ground(model.links().size(), false), near(on_ground);
  for (const Contact& contact : problem.stance.contacts) {
    const std::vector<bool> touching = touching_links(model, {&contact, 1});
    const bool on = is_on_ground(contact);
    for (std::size_t link = 0; link < touching.size(); ++link) {
      if (!touching[link]) continue;
      (on ? on_ground : near)[link] = true;
    }
  }
  for (std::size_t link = 0; link < near.size(); ++link) {
    if (!near[link] || on_ground[link] || shapes.solids[link]->empty()) continue;
    constrain(Kind::kContact,
              EdgeLinkHeight(kRobotNumber, model.links()[link].name, margin, kTouchingWeight,
                             shapes.solids[link]),
              used(margin), static_cast<int>(link), q_);
  }
}

void PostureGraph::set_start(const Eigen::VectorXd& configuration) {
  const double share_N = weight_N_ / static_cast<double>(wrench_axes_.size());
  StanceWrenches wrenches(contact_numbers_.size(), StanceWrenches::value_type::Zero());
  for (std::size_t i = 0; i < loaded_.size(); ++i) {
    wrenches[loaded_[i]].head<3>() =
        wrench_axes_[i].transpose() * (share_N * Eigen::Vector3d::UnitZ());
  }
  set(configuration, wrenches);
}

void PostureGraph::set(const Eigen::VectorXd& configuration, const StanceWrenches& wrenches) {
  graph.vertex(q_).state = configuration;
  if (wrenches.empty()) return;
  VertexWrenches& vertex = graph.vertex(w_);
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < loaded_.size(); ++i) {
    for (const int component : (*vertex.contacts)[i]->cone->components()) {
      vertex.state[at++] = wrenches[loaded_[i]][component];
    }
  }
}

Eigen::VectorXd PostureGraph::configuration() const { return graph.vertex(q_).state; }

WatchedRows PostureGraph::watch(const Problem& compiled) const {
  WatchedRows rows;
  rows.robot_ = robot_;
  rows.loaded_links_ = loaded_links_;
  for (const CompiledConstraint& c : compiled.constraints()) {
    const auto found =
        std::find_if(constraints_.begin(), constraints_.end(),
                     [&c](const Constraint& constraint) { return constraint.edge.slot == c.edge; });
    rows.edges_.push_back({found->kind, found->link});
  }
  return rows;
}

}  // namespace locograph
