#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/rolling/edge_ball_rolling.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/edge_steering_slip.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_moving_balance.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/edge_wrench_tracking.h>
#include <locograph/plugins/surface_distance/edge_surface_distance.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_tracking/edge_acceleration_tracking.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace locograph {
namespace {

using Configuration = VertexId<VertexConfiguration>;

bool is_limited(double limit) { return limit > 0.0 && std::isfinite(limit); }

/// The joint above the carrier of a wheel that rolls.
bool steers(const Robot& robot, const StanceParameter& stance, int active) {
  return std::ranges::any_of(stance.wheels, [&](const auto& standing) {
    const int above = robot.links()[static_cast<std::size_t>(standing.wheel.carrier)].parent_joint;
    return !standing.locked && above >= 0 &&
           robot.joints()[static_cast<std::size_t>(above)].index == active;
  });
}

bool turns_wheel(const StanceParameter& stance, int active) {
  return std::ranges::any_of(stance.wheels, [active](const auto& standing) {
    return !standing.locked && standing.wheel.joint == active;
  });
}

/// Keeps the joints that `turns` picks from turning by more than max_rad over dt_s, or by more than
/// they do in `planned`, a tangent. Nothing where their velocity limits ask for as much.
template <class Turns>
std::optional<EdgeVelocityLimits> step_limit(const Robot& robot, const Eigen::VectorXd& planned,
                                             double dt_s, double max_rad,
                                             const PlanEdgeOptions& options, Turns&& turns) {
  constexpr double kRoom = 1.01;  // a plan is not an error from the start
  if (!(max_rad > 0.0)) return std::nullopt;
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

/// The number of the plan's PARAMS_WORLD; one of an empty world where it has none.
int world_number(Graph& graph, const Plan& plan) {
  if (plan.world) return plan.world_number;
  const auto& all = graph.parameters().all();
  const int number = all.contains(kWorldNumber) ? all.rbegin()->first + 1 : kWorldNumber;
  graph.parameters().set(number, std::make_shared<const WorldParameter>());
  return number;
}

/// The stance whose contacts balance a configuration.
const StanceParameter* bearing_stance(const Plan& plan, std::size_t i) {
  const StanceParameter* left_in = plan.stance_from[i].get();
  if (!plan.stances_only || i == 0) return left_in;
  const StanceParameter* before = plan.stance_from[i - 1].get();
  return &bearing_stance(before->stance, left_in->stance) == &before->stance ? before : left_in;
}

WrenchesState state_of(const VertexWrenches& vertex) {
  WrenchesState state = vertex.make_derived();
  vertex.derive(vertex.state.data(), state);
  return state;
}

/// Adds the edges of one plan.
class PlanEdges {
 public:
  PlanEdges(Graph& graph, const PlanEdgeOptions& options, const JobControl& job)
      : graph_(graph),
        options_(options),
        job_(job),
        plan_(plan_of(graph)),
        robot_(*plan_.robot->robot),
        world_number_(world_number(graph, plan_)),
        places_number_(graph.parameters().number_of<PlacesParameter>()),
        track_(robot_.tangent_size()),
        steps_(robot_.tangent_size()),
        state_(plan_.robot),
        before_(plan_.robot),
        after_(plan_.robot) {
    for (const int slot : plan_.slots) {
      ids_.push_back({slot});
      configurations_.push_back(graph.vertex(ids_.back()).state);
      free_id_ = std::max(free_id_, graph.vertex_record(slot).id + 1);
    }
    weigh_tracking();
  }

  bool add(const std::vector<StanceWrenches>& wrenches) {
    if (!wrenches.empty() && wrenches.size() != ids_.size()) {
      throw Error("wrenches of " + std::to_string(wrenches.size()) + " configurations",
                  "of all " + std::to_string(ids_.size()));
    }
    const EdgeSelfCollision apart = self_collision_edge();
    const bool any_apart = (apart.weights.array() > 0.0).any();
    const EdgeSweptObstacleDistance swept = swept_edge();
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      job_.report_progress("adding constraints", i, ids_.size());
      if (job_.termination.ended()) return false;
      add_to_configuration(i);
      if (any_apart) graph_.add_edge(apart, ids_[i]);
      add_surface_distance(i);
      if (!wrenches.empty() && !wrenches[i].empty()) add_balance(i, wrenches[i]);
      if (i == 0 || plan_.stances_only) continue;
      add_to_step(i);
      graph_.add_edge(swept, ids_[i - 1], ids_[i]);
      if (i == 1) continue;
      if (is_smooth()) track_acceleration(i - 1);
      if (!is_limited(options_.joint_acceleration_rad_s2)) continue;
      graph_.add_edge(EdgeAccelerationLimits(robot_, options_.joint_acceleration_rad_s2, 0.0, 0.0,
                                             options_.acceleration_weight),
                      ids_[i - 2], ids_[i - 1], ids_[i]);
    }
    if (ids_.size() == 1 && !plan_.stances_only) add_obstacle_distance();
    return true;
  }

 private:
  void weigh_tracking() {
    track_.setConstant(options_.track_joint);
    steps_.setConstant(options_.step_joint);
    const int base = robot_.base_tangent_size();
    if (base > 0) {
      track_.head<6>() << options_.track_forward, options_.track_lateral, options_.track_height,
          options_.track_tilt, options_.track_tilt, options_.track_yaw;
      steps_.head<6>().setConstant(options_.step_base);
    }
    const auto in_any = [&](auto&& predicate) {
      return std::ranges::any_of(plan_.stance_from,
                                 [&](const auto& stance) { return stance && predicate(*stance); });
    };
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      if (in_any([&](const auto& stance) { return steers(robot_, stance, i); })) {
        track_[base + i] = 0.0;
        steps_[base + i] = options_.step_steering;
      } else if (in_any([&](const auto& stance) { return turns_wheel(stance, i); })) {
        track_[base + i] = 0.0;
        steps_[base + i] = 0.0;
      }
    }
    goal_ = track_;
    if (base > 0) goal_[0] = goal_[1] = goal_[5] = options_.track_goal;
  }

  /// Keeps links apart that the edge sees apart in every one of the configurations which the job
  /// lets it look at: others have no weight.
  EdgeSelfCollision self_collision_edge() const {
    EdgeSelfCollision edge(*plan_.robot, options_.self_margin_m, options_.limit_weight);
    Eigen::VectorXd lack(edge.weights.size());
    ConfigurationState state(plan_.robot);
    std::size_t seen = 0;
    for (const Eigen::VectorXd& q : configurations_) {
      job_.report_progress("comparing links", seen++, configurations_.size());
      if (job_.termination.ended()) break;
      state.update(q.data());
      edge.error(state, lack);
      edge.weights = (lack.array() > 0.0).select(0.0, edge.weights);
    }
    return edge;
  }

  EdgeSweptObstacleDistance swept_edge() const {
    EdgeSweptObstacleDistance edge(*plan_.robot, world_number_, options_.obstacle_margin_m,
                                   options_.swept_samples, options_.limit_weight);
    const bool nothing_there = !plan_.world || plan_.world->snapshot->files().empty();
    if (!options_.excuse_near_world || nothing_there || plan_.stances_only) return edge;
    edge.bind(graph_.parameters());
    Eigen::VectorXd lack(edge.weights.size());
    ConfigurationState before = graph_.vertex(ids_.front()).make_derived(), after = before;
    graph_.vertex(ids_.front()).derive(graph_.state(ids_.front().slot), before);
    for (std::size_t i = 1; i < ids_.size(); ++i) {
      graph_.vertex(ids_[i]).derive(graph_.state(ids_[i].slot), after);
      edge.error(before, after, lack, Bindings());
      edge.weights = (lack.array() > 0.0).select(0.0, edge.weights);
      std::swap(before, after);
    }
    return edge;
  }

  /// Of a posture. Spheres that are nearer than the margin have no weight, as swept ones.
  void add_obstacle_distance() {
    if (!plan_.world) return;
    const World& world = plan_.world->snapshot->world();
    if (!world.map && world.obstacles.empty()) return;
    EdgeObstacleDistance edge(*plan_.robot, world_number_, options_.obstacle_margin_m,
                              options_.limit_weight);
    edge.bind(graph_.parameters());
    ConfigurationState state = graph_.vertex(ids_.front()).make_derived();
    graph_.vertex(ids_.front()).derive(graph_.state(ids_.front().slot), state);
    Eigen::VectorXd lack(edge.weights.size());
    edge.error(state, lack, Bindings());
    edge.weights = (lack.array() > 0.0).select(0.0, edge.weights);
    graph_.add_edge(std::move(edge), ids_.front());
  }

  void add_to_configuration(std::size_t i) {
    const bool last = i + 1 == ids_.size();
    graph_.add_edge(EdgePlanTracking(configurations_[i], last ? goal_ : track_), ids_[i]);
    const double room = robot_.joint_room(configurations_[i]);
    graph_.add_edge(
        EdgeJointLimits(robot_, std::min(options_.joint_margin_rad, room), options_.limit_weight),
        ids_[i]);
    for (const int number : contacts_at(plan_.stance_from, i)) {
      const auto contact = graph_.parameters().get<ContactParameter>(number);
      if (i > 0 && is_ball(contact->contact.effector) && is_held(i - 1, number)) {
        add_rolling_ball(i, number);
      } else {
        graph_.add_edge(EdgeContact(*contact, number, options_.constraint_weight), ids_[i]);
      }
    }
  }

  /// A ball that slips in the plan by what the judge allows, and the edge's type does not, may slip
  /// by as much; its height, in an edge of its own then, is what the type says.
  void add_rolling_ball(std::size_t i, int contact) {
    constexpr double kRoom = 1.05, kMost_m = 1e-3;
    EdgeBallRolling rolling(contact, options_.constraint_weight);
    rolling.bind(graph_.parameters());
    Eigen::Vector3d slip;
    rolling.error(at(i - 1, before_), at(i, state_), slip);
    const double row_m = slip.head<2>().lpNorm<Eigen::Infinity>();
    const bool slips = !plan_.stances_only && row_m > EdgeBallRolling::kSlipTolerance &&
                       kRoom * slip.head<2>().norm() <= kMost_m;
    if (!slips) {
      graph_.add_edge(std::move(rolling), ids_[i - 1], ids_[i]);
      return;
    }
    EdgeBallRolling height = rolling;
    height.weights.head<2>().setZero();
    graph_.add_edge(std::move(height), ids_[i - 1], ids_[i]);
    rolling.weights[2] = 0.0;
    const EdgeId edge = graph_.add_edge(std::move(rolling), ids_[i - 1], ids_[i]);
    graph_.set_constraint(edge, ConstraintKind::kEquality, kRoom * row_m);
  }

  /// From configuration i to the next one.
  bool is_held(std::size_t i, int contact) const {
    return plan_.stance_from[i] &&
           std::ranges::count(plan_.stance_from[i]->contact_numbers, contact) > 0;
  }

  int stance_number(std::size_t i) const { return graph_.vertex(ids_[i]).stance_number; }

  /// Nothing where no stance is known, or where two without a common contact meet. Configurations
  /// come one after the other.
  void add_surface_distance(std::size_t i) {
    const std::size_t before = i == 0 ? i : i - 1;
    if (i == 0 || stance_number(before) != stance_number(i)) begin_stance(before, i);
    if (!places_number_ || !plan_.stance_from[before] || !plan_.stance_from[i]) return;
    if (std::ranges::none_of(plan_.stance_from[i]->contact_numbers,
                             [&](int number) { return is_held(before, number); })) {
      return;
    }
    state_.update(configurations_[i].data());
    std::vector<int> near = near_contacts(i);
    if (!surfaces_ || surfaces_->before_number != stance_number(before) ||
        surfaces_->after_number != stance_number(i) || surfaces_->near_numbers.all != near) {
      surfaces_.emplace(*plan_.robot, *places_number_, stance_number(before), stance_number(i),
                        options_.surface_margin_m, options_.limit_weight, std::move(near));
      surfaces_->bind(graph_.parameters());
    }
    EdgeSurfaceDistance edge = *surfaces_;
    Eigen::VectorXd lack(edge.weights.size());
    edge.error(state_, lack);
    edge.weights = (lack.array() > 0.0).select(0.0, edge.weights);
    graph_.add_edge(std::move(edge), ids_[i]);
  }

  void begin_stance(std::size_t before, std::size_t i) {
    other_before_ = before;
    other_after_ = i;
    while (other_after_ + 1 < ids_.size() && stance_number(other_after_) == stance_number(i)) {
      ++other_after_;
    }
  }

  /// Of the stances before and after that of a configuration, contacts that it has just left or is
  /// about to make.
  std::vector<int> near_contacts(std::size_t i) const {
    if (plan_.stances_only) return {};
    const std::vector<int> closed = contacts_at(plan_.stance_from, i);
    const auto is_closed = [&](const ContactParameter& contact) {
      return std::ranges::any_of(closed, [&](int number) {
        return graph_.parameters().get<ContactParameter>(number)->contact.name() ==
               contact.contact.name();
      });
    };
    std::vector<int> near;
    for (const std::size_t other : {other_before_, other_after_}) {
      if (!plan_.stance_from[other]) continue;
      for (std::size_t c = 0; c < plan_.stance_from[other]->contacts.size(); ++c) {
        const ContactParameter& contact = *plan_.stance_from[other]->contacts[c];
        const int number = plan_.stance_from[other]->contact_numbers[c];
        if (is_closed(contact) || std::ranges::find(near, number) != near.end()) continue;
        const Eigen::Vector3d point =
            state_.kinematics.world_from_link(contact.link) * contact.contact.effector.point;
        if (is_near(contact.contact, point)) near.push_back(number);
      }
    }
    return near;
  }

  void add_balance(std::size_t i, const StanceWrenches& wrenches) {
    const StanceParameter* bearing = bearing_stance(plan_, i);
    const std::size_t expected = bearing == nullptr ? 0 : bearing->contacts.size();
    if (wrenches.size() != expected) {
      throw Error("wrenches at " + std::to_string(wrenches.size()) + " contacts",
                  "one for each of the stance, " + std::to_string(expected));
    }
    constexpr double kNothing = 1e-2;  // what closes here bears nothing, others take it over
    std::vector<int> numbers;
    std::vector<double> components, arms;
    for (std::size_t c = 0; c < bearing->contacts.size(); ++c) {
      if (!bearing->contacts[c]->contact.bears_load) continue;
      numbers.push_back(bearing->contact_numbers[c]);
      const bool bears = !wrenches[c].isZero(0.0);
      for (const int component : bearing->contacts[c]->cone->components()) {
        components.push_back(wrenches[c][component]);
        arms.push_back((component < 3 ? 1.0 : options_.wrench_arm_m) * (bears ? 1.0 : kNothing));
      }
    }
    VertexWrenches vertex(graph_.parameters(), std::move(numbers));
    vertex.state = Eigen::Map<const Eigen::VectorXd>(components.data(),
                                                     static_cast<Eigen::Index>(components.size()));
    const auto forces = graph_.add_vertex(free_id_ + static_cast<int>(i), std::move(vertex));
    const double weight_N = robot_.total_mass() * standard_gravity().norm();
    const double unit = 1.0 / (weight_N * weight_N);
    const double balance = options_.balance_weight * unit;
    add_balance_edge(i, forces, balance);
    add_contact_wrench_edge(forces, options_.friction_weight * unit);
    EdgeWrenchTracking tracking(graph_.vertex(forces), options_.wrench_tracking_weight * unit);
    tracking.weights.array() /=
        Eigen::Map<const Eigen::ArrayXd>(arms.data(), tracking.weights.size()).square();
    graph_.add_edge(std::move(tracking), forces);
    if (!options_.torque_limits) return;
    EdgeTorqueLimits torques(robot_, options_.effort_scale, 0.0);
    for (int j = 0; j < robot_.active_joint_count(); ++j) {
      const double effort = robot_.active_joint(j).max_effort;
      torques.weights[j] = std::isfinite(effort) ? options_.torque_weight / (effort * effort) : 0.0;
    }
    graph_.add_edge(std::move(torques), ids_[i], forces);
  }

  /// Without weight for what the plan's own wrenches exceed: the judge's friction pyramids bear
  /// more yaw than the edge's.
  void add_contact_wrench_edge(VertexId<VertexWrenches> forces, double weight) {
    const VertexWrenches& vertex = graph_.vertex(forces);
    EdgeContactWrench edge(*vertex.contacts, weight);
    Eigen::VectorXd excess(edge.weights.size());
    edge.error(state_of(vertex), excess);
    edge.weights = (excess.array() > 0.0).select(0.0, edge.weights);
    graph_.add_edge(std::move(edge), forces);
  }

  /// Of a moving robot where it has a configuration before and one after, with what the plan itself
  /// leaves over as its load; else of one at rest.
  void add_balance_edge(std::size_t i, VertexId<VertexWrenches> forces, double weight) {
    if (plan_.stances_only || i == 0 || i + 1 == ids_.size()) {
      graph_.add_edge(EdgeBalance(weight, weight), ids_[i], forces);
      return;
    }
    EdgeMovingBalance edge(weight, weight);
    const WrenchesState wrenches = state_of(graph_.vertex(forces));
    Eigen::Matrix<double, 6, 1> left_over;
    edge.error(at(i, state_), wrenches, at(i - 1, before_), at(i + 1, after_), left_over);
    edge.load = left_over;
    graph_.add_edge(edge, ids_[i], forces, ids_[i - 1], ids_[i + 1]);
  }

  bool is_smooth() const { return options_.smooth_over_s > 0.0; }
  bool rests(std::size_t i) const {
    const Eigen::VectorXd& slopes = graph_.vertex(ids_[i]).slopes;
    return i == 0 || i + 1 == ids_.size() || (slopes.size() > 0 && slopes.isZero(0.0));
  }

  /// At configuration i, neither first nor last.
  void track_acceleration(std::size_t i) {
    const double smooth = options_.smooth_over_s * options_.smooth_over_s;
    EdgeAccelerationTracking edge(Eigen::VectorXd::Zero(track_.size()), smooth * smooth * track_);
    Eigen::VectorXd planned(track_.size());
    edge.error(at(i - 1, before_), at(i, state_), at(i + 1, after_), planned);
    edge.acceleration = planned;
    graph_.add_edge(std::move(edge), ids_[i - 1], ids_[i], ids_[i + 1]);
  }

  /// The plan's configuration.
  const ConfigurationState& at(std::size_t i, ConfigurationState& state) const {
    state.time_s = graph_.vertex(ids_[i]).time_s;
    state.update(configurations_[i].data());
    return state;
  }

  /// Of the step that ends at configuration i.
  void add_to_step(std::size_t i) {
    const Configuration a = ids_[i - 1], b = ids_[i];
    Eigen::VectorXd step(robot_.tangent_size());
    robot_.difference(configurations_[i - 1].data(), configurations_[i].data(), step.data());
    const double dt_s = graph_.vertex(b).time_s - graph_.vertex(a).time_s;
    if (!is_smooth()) {
      graph_.add_edge(EdgeVelocityTracking(step, steps_), a, b);
    } else if (rests(i - 1) || rests(i)) {
      const Eigen::VectorXd held =
          (track_.array() > 0.0)
              .select(Eigen::VectorXd::Constant(track_.size(), options_.rest_weight), 0.0);
      graph_.add_edge(EdgeVelocityTracking(step, held), a, b);
    }
    graph_.add_edge(EdgeVelocityLimits(robot_, options_.velocity_fraction, options_.base_linear_m_s,
                                       options_.base_angular_rad_s, options_.limit_weight),
                    a, b);
    const StanceParameter* stance = plan_.stance_from[i - 1].get();
    if (stance == nullptr || stance->wheels.empty()) return;
    const auto steering = [&](int joint) { return steers(robot_, *stance, joint); };
    const auto bending = [&](int joint) {
      return !steering(joint) && !turns_wheel(*stance, joint);
    };
    for (const auto& limit :
         {step_limit(robot_, step, dt_s, options_.steering_step_rad, options_, steering),
          step_limit(robot_, step, dt_s, options_.leg_step_rad, options_, bending)}) {
      if (limit) graph_.add_edge(*limit, a, b);
    }
    const int number = stance_number(i - 1);
    const EdgeId rolling =
        graph_.add_edge(EdgeRolling(*stance, number, options_.constraint_weight), a, b);
    const double tolerance_m = slip_tolerance(*stance, step);
    if (tolerance_m < EdgeRolling::kTolerance) {
      graph_.set_constraint(rolling, ConstraintKind::kEquality, tolerance_m);
    }
    if (!(options_.steering_slip_m > 0.0)) return;
    const EdgeSteeringSlip slip(*stance, number, options_.steering_slip_m,
                                options_.constraint_weight);
    if (slip.dimension() > 0) graph_.add_edge(slip, a, b);
  }

  /// Of wheels that roll on a step: over the 0.1 m within which the judge adds it up it leaves room
  /// for what wheels that steer slip half-way of two steps, in as many steps as there are.
  double slip_tolerance(const StanceParameter& stance, const Eigen::VectorXd& step) const {
    constexpr double kLeast_m = 2e-5, kShare = 0.0125, kArm_m = 0.5;
    if (robot_.base_tangent_size() == 0 ||
        std::ranges::all_of(stance.wheels, &StanceParameter::StandingWheel::locked)) {
      return EdgeRolling::kTolerance;
    }
    const double way_m = step.head<3>().norm() + kArm_m * step.segment<3>(3).norm();
    return std::max(kLeast_m, kShare * way_m);
  }

  Graph& graph_;
  const PlanEdgeOptions& options_;
  const JobControl& job_;
  const Plan plan_;
  const Robot& robot_;
  int world_number_;
  std::optional<int> places_number_;      // none: the plan does not say what may be touched
  Eigen::VectorXd track_, goal_, steps_;  // weights
  std::vector<Configuration> ids_;
  std::vector<Eigen::VectorXd> configurations_;
  int free_id_ = 0;
  ConfigurationState state_, before_, after_;
  std::optional<EdgeSurfaceDistance> surfaces_;  // of the configuration before
  /// The nearest configurations that are left in another stance, else the ends of the plan.
  std::size_t other_before_ = 0, other_after_ = 0;
};

}  // namespace

const Stance& bearing_stance(const Stance& before, const Stance& after) {
  return before.contacts.size() < after.contacts.size() ? before : after;
}

PlanEdgeOptions drive_edges() {
  PlanEdgeOptions options;
  options.leg_step_rad = 0.035;
  options.steering_step_rad = 0.25;
  options.steering_slip_m = 0.0018;
  return options;
}

PlanEdgeOptions motion_edges(const CheckOptions& check) {
  PlanEdgeOptions options;
  options.acceleration_weight = 1e-2;
  options.smooth_over_s = 0.3;
  options.limit_weight = 1e5;
  options.constraint_weight = 3e6;
  options.balance_weight = 1e4;
  options.friction_weight = 3e1;
  options.torque_weight = 1e2;
  options.obstacle_margin_m = 2e-3;
  options.swept_samples = 2;
  options.excuse_near_world = true;
  options.joint_margin_rad = 1e-3;
  options.velocity_fraction = 1.0;
  options.base_linear_m_s = is_limited(check.base_linear_m_s) ? check.base_linear_m_s : 0.0;
  options.base_angular_rad_s =
      is_limited(check.base_angular_rad_s) ? check.base_angular_rad_s : 0.0;
  if (is_limited(check.joint_acceleration_rad_s2)) {
    options.joint_acceleration_rad_s2 = check.joint_acceleration_rad_s2;
  }
  options.torque_limits = check.enforce_torque_limits;
  options.effort_scale = check.effort_scale;
  options.track_lateral = options.track_forward;
  options.track_yaw = options.track_tilt;
  return options;
}

bool add_configurations(Graph& graph, const Motion& motion, const std::vector<int>& stance_numbers,
                        const JobControl& job) {
  const auto robot = graph.parameters().get<RobotParameter>(kRobotNumber);
  const std::size_t count = motion.configurations.size();
  for (std::size_t i = 0; i < count; ++i) {
    job.report_progress("placing configurations", i, count);
    if (job.termination.ended()) return false;
    if (motion.stance_from[i] < 0) {
      throw Error("a step whose stance is not known", "a stance for each step");
    }
    VertexConfiguration vertex(kRobotNumber, robot, motion.time_s[i], motion.configurations[i],
                               stance_numbers.at(static_cast<std::size_t>(motion.stance_from[i])));
    if (!motion.slopes.empty()) vertex.slopes = motion.slopes[i];
    const auto id = graph.add_vertex(static_cast<int>(i), std::move(vertex));
    graph.set_fixed(id, i == 0);
  }
  return true;
}

bool add_plan_edges(Graph& graph, const PlanEdgeOptions& options,
                    const std::vector<StanceWrenches>& wrenches, const JobControl& job) {
  return PlanEdges(graph, options, job).add(wrenches);
}

void cut_plan(Graph& graph, const Plan& plan, int last) {
  const auto at = static_cast<std::size_t>(last);
  // Balance in motion goes with the next configuration.
  for (const EdgeMovingBalance& moving : graph.edges_of<EdgeMovingBalance>()) {
    if (moving.vertices[0] != plan.slots[at] || at + 1 == plan.slots.size()) continue;
    const EdgeBalance resting(moving.weights[0], moving.weights[3]);
    graph.add_edge(resting, Configuration{plan.slots[at]},
                   VertexId<VertexWrenches>{moving.vertices[1]});
    break;
  }
  for (std::size_t i = at + 1; i < plan.slots.size(); ++i) {
    for (const int slot : plan.index.wrenches[i]) graph.remove_vertex(slot);
    graph.remove_vertex(plan.slots[i]);
  }
  for (const int number : graph.parameters().numbers_of<SegmentParameter>()) {
    const auto given = graph.parameters().get<SegmentParameter>(number);
    const PlanSegment& segment = plan.segments.at(static_cast<std::size_t>(given->segment));
    if (segment.first >= last) {
      graph.parameters().remove(number);
    } else if (segment.last > last) {
      const auto shorter = std::make_shared<SegmentParameter>(*given);
      shorter->duration_s = graph.vertex(Configuration{plan.slots[at]}).time_s - shorter->from_s;
      graph.parameters().replace(number, shorter);
    }
  }
  mark_incomplete(graph);
}

}  // namespace locograph
