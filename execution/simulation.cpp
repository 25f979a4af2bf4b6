#include <locograph/check/bar_contact.h>
#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/execution/engine.h>
#include <locograph/execution/simulation.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/world/link_solid.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

namespace locograph {
namespace {

constexpr double kTouched_N = 1.0;
constexpr double kMostPenetration_m = 0.003;
constexpr double kLongest = 5.0;  // of the motion's time, and a minute
/// An end effector that should be free may touch for so long, and so near a contact that it has
/// just left or is about to hold.
constexpr double kBrief_s = 0.05, kNearContact_m = 0.03;
/// A hand may be so far off the axis of a bar that it closes round, and off its end.
constexpr double kHandOff_m = 0.01, kHandOff_rad = 0.1;
constexpr double kBeyond_s = 0.01;  // for which it may bear more than it can
constexpr double kReach_m = 2.5;    // from the base to where a map is in the way

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string millimetres(double metres) {
  return std::to_string(static_cast<int>(std::lround(1000.0 * metres))) + " mm";
}

/// Of all that the robot may get to.
Eigen::AlignedBox3d reach_of(const Robot& robot, const Motion& motion) {
  Eigen::AlignedBox3d box(Eigen::Vector3d::Zero());
  if (robot.floating_base()) box.setEmpty();
  for (const Eigen::VectorXd& configuration : motion.configurations) {
    if (robot.floating_base()) box.extend(Eigen::Vector3d(configuration.head<3>()));
  }
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(kReach_m);
  return {box.min() - reach, box.max() + reach};
}

/// What a run draws at random, always in the same order.
class Perturbations {
 public:
  Perturbations(const Robot& robot, const World& world, const Motion& motion,
                const SimulationOptions& options)
      : random_(options.seed), world_(world) {
    start_ = motion.configurations.front();
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      start_[robot.base_configuration_size() + i] += options.initial_error_rad * within_one();
    }
    for (std::size_t i = 0; i < robot.links().size(); ++i) {
      factors_.push_back(1.0 + options.mass_error * within_one());
    }
    const double angle = std::numbers::pi * within_one();
    push_ = options.push_N * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    const double all = motion.time_s.back() - motion.time_s.front();
    push_at_s_ = motion.time_s.front() + all * (0.5 + 0.45 * within_one());
    move_world(options.contact_error_m);
  }

  const World& world() const { return world_; }
  const std::vector<double>& mass_factors() const { return factors_; }
  const Eigen::VectorXd& start() const { return start_; }
  const Eigen::Vector3d& push() const { return push_; }
  double push_at_s() const { return push_at_s_; }  ///< of the plan

 private:
  double within_one() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  /// A solid goes with its top, and all its faces with it.
  void move_world(double error_m) {
    const auto off_m = [&] { return within_one() < 0.0 ? -error_m : error_m; };
    std::vector<Eigen::Vector3d> moved;
    for (const SolidBox& box : world_.solids) {
      moved.emplace_back(off_m() * box.world_from_box.linear().col(2));
    }
    for (Surface& surface : world_.surfaces) {
      Eigen::Vector3d by = off_m() * surface.world_from_surface.linear().col(2);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        if (is_part_of(world_.solids[i], surface)) by = moved[i];
      }
      surface.world_from_surface.pretranslate(by);
    }
    for (std::size_t i = 0; i < moved.size(); ++i) {
      world_.solids[i].world_from_box.pretranslate(moved[i]);
    }
    for (Bar& bar : world_.bars) {
      const Eigen::Vector3d by(0.0, 0.0, off_m());
      bar.from += by;
      bar.to += by;
    }
  }

  std::mt19937 random_;
  World world_;
  std::vector<double> factors_;
  Eigen::VectorXd start_;
  Eigen::Vector3d push_;
  double push_at_s_;
};

/// Where an end effector touches what it holds, and how fast what touches slides along that.
class SlipMeter {
 public:
  SlipMeter(const Robot& robot, std::span<const EndEffector> effectors)
      : effectors_(effectors), jacobian_(6, robot.tangent_size()), slips_(effectors.size()) {
    for (const EndEffector& effector : effectors) links_.push_back(robot.link_index(effector.link));
  }

  Eigen::Vector3d centre(const RobotState& state, std::size_t e) const {
    return state.world_from_link(links_[e]) * effectors_[e].point;
  }
  const Eigen::Isometry3d& world_from_link(const RobotState& state, std::size_t e) const {
    return state.world_from_link(links_[e]);
  }
  Eigen::Vector3d touching(const RobotState& state, std::size_t e, const Contact& contact) const {
    return centre(state, e) + arm(state, e, contact);
  }

  /// held: null: not held, or not pressed.
  double measure(const RobotState& state, const Eigen::VectorXd& velocity, std::size_t e,
                 const Contact* held, double cycle_s) {
    Slip& slip = slips_[e];
    if (held != slip.held) slip = {held, Eigen::Vector3d::Zero()};
    if (!held) return 0.0;
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translation() = effectors_[e].point;
    state.frame_jacobian(links_[e], frame, jacobian_);
    const Eigen::Matrix<double, 6, 1> moves = jacobian_ * velocity;
    const Eigen::Vector3d normal = normal_at(*held, centre(state, e));
    Eigen::Vector3d slides =
        moves.head<3>() + Eigen::Vector3d(moves.tail<3>()).cross(arm(state, e, *held));
    slides -= slides.dot(normal) * normal;
    slip.by += cycle_s * slides;
    return slip.by.norm();
  }

 private:
  struct Slip {
    const Contact* held = nullptr;
    Eigen::Vector3d by = Eigen::Vector3d::Zero();
  };

  Eigen::Vector3d arm(const RobotState& state, std::size_t e, const Contact& contact) const {
    return -rolling_radius_m(effectors_[e]) * normal_at(contact, centre(state, e));
  }

  std::span<const EndEffector> effectors_;
  std::vector<int> links_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian_;
  std::vector<Slip> slips_;
};

class Run {
 public:
  Run(const Robot& robot, std::span<const EndEffector> effectors, const World& world,
      const Motion& motion, const SimulationOptions& options)
      : robot_(robot),
        effectors_(effectors),
        options_(options),
        perturbed_(robot, world, motion, options),
        engine_(robot, effectors, perturbed_.world(),
                {.timestep_s = options.player.cycle_s,
                 .friction_factor = options.friction_factor,
                 .link_mass_factors = perturbed_.mass_factors(),
                 .reach = reach_of(robot_, motion)}),
        believed_(world),
        player_(robot, effectors, world, motion, options.player),
        controller_(make_controller()),
        state_(robot),
        planned_(robot),
        estimated_(robot),
        meter_(robot, effectors),
        felt_(robot, effectors),
        touches_(effectors.size()),
        hands_(effectors.size()),
        free_(effectors.size()),
        error_(robot.tangent_size()) {
    require_shapes();
    require_start(world, motion);
    if (options.sensors) {
      sensors_.emplace(robot, *options.sensors, options.seed);
      estimator_.emplace(robot, effectors, motion.configurations.front(), options.player.cycle_s);
    }
    engine_.set_state(perturbed_.start(), Eigen::VectorXd::Zero(robot.tangent_size()));
  }

  SimulationResult run() {
    const double began = processor_seconds();
    const Motion& motion = player_.motion();
    const double longest_s = 60.0 + kLongest * (motion.time_s.back() - motion.time_s.front());
    while (!player_.done() && result_.upright) {
      cycle();
      if (engine_.time_s() > longest_s) {
        result_.reason = "it takes too long";
        break;
      }
    }
    result_.time_s = engine_.time_s();
    result_.plan_time_s = player_.plan_time_s();
    result_.waited_s = player_.waited_s();
    if (result_.upright) judge_end();
    result_.carried_out = result_.reached_goal && result_.max_contact_slip_m <= kMostSlip_m &&
                          result_.other_link.empty();
    if (result_.reached_goal && !result_.carried_out) {
      result_.reason =
          result_.other_link.empty()
              ? "contact of " + result_.slipping + " slips by " +
                    millimetres(result_.max_contact_slip_m)
              : "link " + result_.other_link + " touches" +
                    (result_.touched_link.empty() ? "" : " link " + result_.touched_link);
    }
    if (!result_.carried_out && !gave_way_.empty()) result_.reason += "; " + gave_way_;
    result_.processor_s = processor_seconds() - began;
    return std::move(result_);
  }

 private:
  std::unique_ptr<TorqueController> make_controller() const {
    if (options_.controller == "joint_impedance") {
      JointImpedanceOptions own = options_.joint_impedance;
      own.cycle_s = options_.player.cycle_s;
      return std::make_unique<JointImpedanceController>(robot_, effectors_, own);
    }
    return std::make_unique<WholeBodyController>(robot_, effectors_, options_.whole_body);
  }

  void require_shapes() const {
    for (const Link& link : robot_.links()) {
      for (const CollisionShape& shape : link.collision) {
        if (shape.type == ShapeType::kMesh && !shape.mesh_found)
          link_solid(robot_, shape);  // throws
      }
    }
  }

  /// The motion's own start in the world that it was planned in.
  void require_start(const World& world, const Motion& motion) const {
    Engine as_planned(robot_, effectors_, world, {.reach = reach_of(robot_, motion)});
    as_planned.set_obstacle_time(motion.time_s.front());
    as_planned.set_state(motion.configurations.front(),
                         Eigen::VectorXd::Zero(robot_.tangent_size()));
    if (as_planned.penetration_m() <= kMostPenetration_m) return;
    throw Error("the motion begins " + millimetres(as_planned.penetration_m()) +
                    " deep in what is in its way",
                "a start without penetration");
  }

  void cycle() {
    const Eigen::VectorXd q = engine_.configuration(), v = engine_.velocity();
    state_.update(q.data());
    close_and_open_hands();
    measure(v);
    estimate(q, v);
    revise(estimator_ ? estimator_->configuration() : q);
    player_.advance(touches_);
    const double before = processor_seconds();
    const Eigen::VectorXd& torques = controller_->torques(
        estimator_ ? estimator_->configuration() : q, estimator_ ? estimator_->velocity() : v,
        player_.reference(), player_.contacts());
    result_.controller_s.push_back(processor_seconds() - before);
    engine_.set_torques(torques);
    push();
    // What moves does not wait for the robot.
    engine_.set_obstacle_time(clock_s());
    record(q, v, torques);
    engine_.step();
    watch(q, torques);
  }

  double clock_s() const {
    return player_.motion().time_s.front() +
           std::max(0.0, engine_.time_s() - options_.player.settle_s);
  }

  void revise(const Eigen::VectorXd& configuration) {
    if (!options_.revise) return;
    std::optional<Motion> motion =
        options_.revise({clock_s(), player_.plan_time_s(), configuration});
    if (motion) player_.follow(believed_, std::move(*motion));
  }

  bool is_grasp(std::size_t e) const { return effectors_[e].kind == ContactKind::kGrasp; }

  /// The bar that a hand is round, if it is.
  const Bar* bar_in_hand(std::size_t e) const {
    const Eigen::Vector3d at = meter_.centre(state_, e);
    const Eigen::Vector3d along =
        meter_.world_from_link(state_, e).linear() * axes_in_link(effectors_[e]).col(1);
    for (const Bar& bar : perturbed_.world().bars) {
      const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
      const bool beside = axis.cross(at - bar.from).norm() > kHandOff_m;
      const bool along_it = axis.cross(along).norm() <= kHandOff_rad;
      if (!beside && along_it && beyond_ends_m(bar, at) <= kHandOff_m) return &bar;
    }
    return nullptr;
  }

  /// A hand closes where its stance lists it and it is round a bar, and opens where it does not.
  /// One that bears more than it can gives way, and does not close again in that stance.
  void close_and_open_hands() {
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      if (!is_grasp(e)) continue;
      const int index = static_cast<int>(e);
      const HeldContact* command = player_.contacts()[e].held;
      if (engine_.grasps(index)) {
        Hand& hand = hands_[e];
        hand.beyond_s = bears_in_hand(e) ? 0.0 : hand.beyond_s + options_.player.cycle_s;
        if (command && hand.beyond_s <= kBeyond_s) continue;
        if (command && gave_way_.empty()) {
          gave_way_ = "the grasp of " + effectors_[e].name + " gave way at " +
                      std::to_string(player_.plan_time_s()).substr(0, 5) + " s of the plan";
        }
        engine_.release(index);
        hand = {0.0, command};
      } else if (command && hands_[e].gave_way != command) {
        const Bar* bar = bar_in_hand(e);
        if (!bar) continue;
        const Eigen::Vector3d axis = (bar->to - bar->from).normalized();
        engine_.grasp(index, bar->from + axis.dot(meter_.centre(state_, e) - bar->from) * axis,
                      axis);
      }
    }
  }

  bool bears_in_hand(std::size_t e) const {
    const Eigen::Matrix3d axes =
        meter_.world_from_link(state_, e).linear() * axes_in_link(effectors_[e]);
    const int index = static_cast<int>(e);
    const Eigen::Vector3d force = axes.transpose() * engine_.contact_force(index);
    const Eigen::Vector3d moment = axes.transpose() * engine_.contact_moment(index);
    return force.cwiseAbs().maxCoeff() <= effectors_[e].max_force_N &&
           std::max(std::abs(moment.x()), std::abs(moment.z())) <= effectors_[e].max_moment_Nm;
  }

  /// null: not held, or not pressed.
  const Contact* held(std::size_t e) const {
    const HeldContact* command = player_.contacts()[e].held;
    return command && touches_[e].pressing_N > kTouched_N ? &command->contact() : nullptr;
  }

  void measure(const Eigen::VectorXd& v) {
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      const HeldContact* command = player_.contacts()[e].held;
      const Eigen::Vector3d force = engine_.contact_force(static_cast<int>(e));
      touches_[e].pressing_N =
          command ? force.dot(command->contact().normal.normalized()) : force.norm();
      if (is_grasp(e)) {
        touches_[e].pressing_N =
            engine_.grasps(static_cast<int>(e)) ? std::numeric_limits<double>::infinity() : 0.0;
      }
      const double slip_m = meter_.measure(state_, v, e, held(e), options_.player.cycle_s);
      touches_[e].slip_m = slip_m;
      if (slip_m <= result_.max_contact_slip_m) continue;
      result_.max_contact_slip_m = slip_m;
      result_.slip_at_s = player_.plan_time_s();
      result_.slipping = name_of(effectors_[e]);
    }
  }

  /// A robot knows no more of how its contacts slip than of where it is.
  void estimate(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    if (!estimator_) return;
    SensorReadings& readings = sensors_->read(q, v);
    readings.pressing_N.resize(effectors_.size());
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      readings.pressing_N[e] = touches_[e].pressing_N;
    }
    estimator_->update(readings, player_.contacts());
    robot_.difference(estimator_->configuration().data(), q.data(), error_.data());
    result_.max_estimate_error_m = std::max(result_.max_estimate_error_m, error_.head<3>().norm());
    result_.max_estimate_error_rad =
        std::max(result_.max_estimate_error_rad, error_.segment<3>(3).norm());
    estimated_.update(estimator_->configuration().data());
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      touches_[e].slip_m =
          felt_.measure(estimated_, estimator_->velocity(), e, held(e), options_.player.cycle_s);
    }
  }

  void push() {
    if (options_.push_N <= 0.0) return;
    if (result_.pushed_at_s < 0.0 && player_.plan_time_s() >= perturbed_.push_at_s()) {
      result_.pushed_at_s = engine_.time_s();
    }
    const bool now =
        result_.pushed_at_s >= 0.0 && engine_.time_s() < result_.pushed_at_s + options_.push_s;
    engine_.set_push(now ? perturbed_.push() : Eigen::Vector3d::Zero().eval());
  }

  void record(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& torques) {
    if (options_.record_every_s <= 0.0 || engine_.time_s() < next_record_s_ - 1e-9) return;
    next_record_s_ += options_.record_every_s;
    SimulationSample& sample = result_.samples.emplace_back();
    sample.time_s = engine_.time_s();
    sample.plan_time_s = player_.plan_time_s();
    sample.stance = player_.stance();
    sample.configuration = q;
    sample.velocity = v;
    sample.torques = torques;
    sample.planned = player_.reference().configuration;
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      sample.forces.push_back(engine_.contact_force(static_cast<int>(e)));
      sample.moments.push_back(engine_.contact_moment(static_cast<int>(e)));
    }
  }

  void watch(const Eigen::VectorXd& q, const Eigen::VectorXd& torques) {
    robot_.difference(q.data(), player_.reference().configuration.data(), error_.data());
    const double base_m = error_.head<3>().norm(), base_rad = error_.segment<3>(3).norm();
    result_.max_base_error_m = std::max(result_.max_base_error_m, base_m);
    result_.max_base_error_rad = std::max(result_.max_base_error_rad, base_rad);
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      const Joint& joint = robot_.active_joint(i);
      if (joint.type != JointType::kContinuous) {
        result_.max_joint_error_rad =
            std::max(result_.max_joint_error_rad, std::abs(error_[robot_.base_tangent_size() + i]));
      }
      if (joint.max_effort > 0.0) {
        result_.max_torque_ratio =
            std::max(result_.max_torque_ratio, std::abs(torques[i]) / joint.max_effort);
      }
    }
    const Engine::OtherTouch other = engine_.other_touch();
    if (other.pressing_N > kTouched_N) {
      const auto name = [&](int link) {
        return robot_.links()[static_cast<std::size_t>(link)].name;
      };
      tell_touch(other.pressing_N, name(other.link), other.touched < 0 ? "" : name(other.touched));
    }
    watch_free_effectors();
    if (engine_.diverged()) {
      result_.upright = false;
      result_.reason = "the engine gives up";
    } else if (base_m > kFallen_m || base_rad > kFallen_rad) {
      result_.upright = false;
      result_.reason = "it falls: its base is off by " + millimetres(base_m) + " and " +
                       std::to_string(base_rad).substr(0, 4) + " rad";
    }
    if (!result_.upright && !player_.halted().empty()) {
      result_.reason += ", after " + player_.halted();
    }
  }

  /// touched: a link; empty: the world.
  void tell_touch(double pressing_N, const std::string& link, const std::string& touched) {
    if (pressing_N <= result_.other_touch_N) return;
    result_.other_touch_N = pressing_N;
    result_.other_touch_at_s = player_.plan_time_s();
    result_.other_link = link;
    result_.touched_link = touched;
  }

  bool is_near_contact(std::size_t e) const {
    if ((meter_.centre(state_, e) - free_[e].left).norm() < kNearContact_m) return true;
    const Contact* next = player_.next_contact(e);
    return next && (meter_.touching(state_, e, *next) - next->position).norm() < kNearContact_m;
  }

  /// Those that touch nothing by the plan.
  void watch_free_effectors() {
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      Free& own = free_[e];
      if (player_.contacts()[e].held) {
        own = {0.0, meter_.centre(state_, e)};
        continue;
      }
      const double force_N = engine_.contact_force(static_cast<int>(e)).norm();
      own.touches_s = force_N > kTouched_N ? own.touches_s + options_.player.cycle_s : 0.0;
      if (own.touches_s > kBrief_s && !is_near_contact(e)) {
        tell_touch(force_N, effectors_[e].link, "");
      }
    }
  }

  void judge_end() {
    const Motion& motion = player_.motion();
    if (!player_.at_end()) {
      if (result_.reason.empty()) result_.reason = "it halts: " + player_.halted();
      return;
    }
    const Eigen::VectorXd q = engine_.configuration();
    state_.update(q.data());
    planned_.update(motion.configurations.back().data());
    const Stance& stance = motion.stances[static_cast<std::size_t>(motion.stance_from.back())];
    for (const Contact& contact : stance.contacts) {
      const std::size_t e = effector_of(effectors_, contact);
      // What rolls ends where the last configuration has it, all else where the contact says.
      const bool rolls = is_ball(contact.effector) ||
                         (contact.effector.kind == ContactKind::kWheel && !contact.locked);
      const Eigen::Vector3d place =
          rolls ? meter_.touching(planned_, e, contact) : contact.position;
      const double off_m = (meter_.touching(state_, e, contact) - place).norm();
      if (off_m > kThere_m) {
        result_.reason = "contact of " + contact.name() + " ends " + millimetres(off_m) + " off";
      } else if (contact.bears_load && !engine_.grasps(static_cast<int>(e)) &&
                 !(engine_.contact_force(static_cast<int>(e)).norm() > kTouched_N)) {
        result_.reason = "contact of " + contact.name() + " does not bear at the end";
      }
      if (!result_.reason.empty()) return;
    }
    robot_.difference(q.data(), motion.configurations.back().data(), error_.data());
    const double base_m = error_.head<3>().norm(), base_rad = error_.segment<3>(3).norm();
    if (base_m > kBaseThere_m || base_rad > kBaseThere_rad) {
      result_.reason = "the base ends " + millimetres(base_m) + " and " +
                       std::to_string(base_rad).substr(0, 4) + " rad off";
      return;
    }
    result_.reached_goal = true;
  }

  const Robot& robot_;
  const std::span<const EndEffector> effectors_;
  const SimulationOptions& options_;
  Perturbations perturbed_;
  Engine engine_;
  const World& believed_;
  MotionPlayer player_;
  std::unique_ptr<TorqueController> controller_;
  std::optional<SimulatedSensors> sensors_;
  std::optional<StateEstimator> estimator_;
  RobotState state_, planned_, estimated_;
  SlipMeter meter_, felt_;  // by the truth, by what is estimated
  std::vector<TouchMeasurement> touches_;
  /// Of a grasp.
  struct Hand {
    double beyond_s = 0.0;                  ///< for which it has borne more than it can
    const HeldContact* gave_way = nullptr;  ///< what it could not hold
  };
  std::vector<Hand> hands_;
  std::string gave_way_;  ///< the first hand that did, in words
  /// Of an end effector that should be free.
  struct Free {
    double touches_s = 0.0;                                          ///< so far
    Eigen::Vector3d left = Eigen::Vector3d::Constant(std::nan(""));  ///< where it was held last
  };
  std::vector<Free> free_;
  Eigen::VectorXd error_;
  SimulationResult result_;
  double next_record_s_ = 0.0;
};

}  // namespace

std::vector<EndEffector> effectors_of(const Motion& motion, std::vector<EndEffector> known) {
  for (const Stance& stance : motion.stances) {
    for (const Contact& contact : stance.contacts) {
      const std::size_t at = effector_of(known, contact);
      if (at == known.size()) {
        known.push_back(contact.effector);
      } else if (contact.effector.friction > 0.0) {
        double& friction = known[at].friction;
        friction = friction > 0.0 ? std::min(friction, contact.effector.friction)
                                  : contact.effector.friction;
      }
    }
  }
  return known;
}

std::vector<std::string> controller_names() { return {"whole_body", "joint_impedance"}; }

void SimulationOptions::validate() const {
  player.validate();
  const std::vector<std::string> names = controller_names();
  check_option(std::find(names.begin(), names.end(), controller) != names.end(), "controller",
               "whole_body or joint_impedance");
  const auto in = [](double value, double low, double high, const char* name,
                     const char* expected) {
    check_option(value >= low && value <= high, name, expected);
  };
  in(friction_factor, 0.0, 10.0, "friction_factor", "0 to 10");
  in(mass_error, 0.0, 0.9, "mass_error", "0 to 0.9");
  in(contact_error_m, 0.0, 0.2, "contact_error_m", "0 to 0.2 m");
  in(push_N, 0.0, 1e5, "push_N", "0 to 100000 N");
  in(push_s, 0.0, 60.0, "push_s", "0 to 60 s");
  in(initial_error_rad, 0.0, 0.5, "initial_error_rad", "0 to 0.5 rad");
  in(record_every_s, 0.0, 60.0, "record_every_s", "0 to 60 s");
  if (sensors) sensors->validate();
}

SimulationResult simulate(const Robot& robot, std::span<const EndEffector> effectors,
                          const World& world, const Motion& motion,
                          const SimulationOptions& options) {
  options.validate();
  return Run(robot, effectors, world, motion, options).run();
}

}  // namespace locograph
