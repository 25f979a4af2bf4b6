#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/posture/transition_solver.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/surface_distance/places_parameter.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/world/distance_view.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <random>

namespace locograph {
namespace {

/// Of the polygon of balance; of one that is too narrow for it.
constexpr double kResolution_m = 5e-3, kFineResolution_m = 1e-4;
/// Polygons after wheels that rolled, for each start.
constexpr int kMostPolygons = 4;

std::shared_ptr<const WorldParameter> parameter_of(World world, const WorldFiles& files) {
  const double height = ground_height(world);
  return std::make_shared<const WorldParameter>(
      std::make_shared<const WorldSnapshot>(std::move(world), 0.0, files),
      std::isfinite(height) ? std::optional(height) : std::nullopt);
}

/// As it is at time 0, which a posture is judged at.
World at_rest(World world) {
  for (Obstacle& obstacle : world.obstacles) obstacle.motion.clear();
  return world;
}

bool rolls(const Contact& contact) {
  return contact_kind_entry(contact.effector.kind).rolls && !contact.locked;
}

/// One solve. Asked for are first contacts, limits and distances alone, which are cheap and mostly
/// enough; balance, torques and exact distances between links, each from there on where a posture
/// lacks them.
class Search {
 public:
  Search(const Robot& robot, const Judge& judge, const PostureProblem& problem,
         const PostureOptions& options, TransitionSolver& solver)
      : robot_(robot),
        judge_(judge),
        problem_(problem),
        options_(options),
        random_(options.seed),
        solver_(solver),
        state_(robot),
        rolls_(std::ranges::any_of(problem.stance.contacts, rolls)) {
    asked_.closed = problem.stance.contacts;
    asked_.preferred = problem.preferred;
    asked_.preferred.segment<4>(3).normalize();
    asked_.start = asked_.preferred;
    asked_.places_known = asked_.exact_pairs = false;
    how_.max_iterations = options.max_iterations;
    how_.patience = options.patience;
    how_.joint_margin_rad = options.joint_margin_rad;
    how_.self_margin_m = options.self_margin_m;
    how_.surface_margin_m = options.ground_margin_m;
    how_.obstacle_margin_m = options.obstacle_margin_m;
    how_.torque_margin = options.torque_margin;
  }

  PostureResult run() {
    const Stopwatch watch;
    for (;;) {
      attempt();
      if (result_.success()) break;
      const auto end = end_by(options_.termination, result_.statistics.iterations);
      if (!end && ask_more()) continue;
      if (end || balances_nowhere_ || result_.statistics.restarts >= options_.max_restarts) {
        explain(end);
        break;
      }
      restart();
    }
    result_.statistics.total_s = watch.seconds();
    return std::move(result_);
  }

 private:
  /// Optimises from where it is asked to. The check has the last word, also on what lacks a margin
  /// only.
  void attempt() {
    optimise();
    const bool ended = options_.termination.ended(result_.statistics.iterations);
    if (!ended && found_.success() && asked_.balance == nullptr && !is_balanced() &&
        ask_balance()) {
      asked_.start = found_.configuration;
      optimise();
    }
    const double amount = found_.success() ? 0.0 : found_.amount;
    CheckOptions asked = options_.check;
    asked.certify_only_if_rest_holds = true;
    report_ = checked(found_.configuration, asked);
    if (report_.feasible) {
      result_.status = PlannerStatus::kSolved;
      result_.reason = "found";
    }
    if (report_.feasible || !(amount >= least_)) {
      least_ = amount;
      result_.configuration = found_.configuration;
      result_.report = report_;
    }
  }

  void optimise() {
    const Stopwatch watch;
    how_.termination = options_.termination.after(result_.statistics.iterations);
    found_ = solver_.solve(asked_, how_);
    result_.statistics.iterations += found_.statistics.iterations;
    result_.statistics.optimise_s += watch.seconds();
  }

  /// From where the last attempt ended, with what the check misses there. False: nothing is left to
  /// ask for.
  bool ask_more() {
    if (!found_.success() || balances_nowhere_) return false;
    asked_.start = found_.configuration;
    if (!asked_.exact_pairs && report_.constraint("self_collision").violated) {
      asked_.exact_pairs = true;
      return true;
    }
    const Violation& balance = report_.constraint("static_balance");
    if (!balance.judged || !balance.violated) return false;
    if (asked_.balance == nullptr || (rolls_ && polygons_ < kMostPolygons)) return ask_balance();
    if (!options_.enforce_torque_limits || asked_.torques != nullptr) return false;
    const Stopwatch watch;
    torques_.emplace(robot_, bearing(), options_.check.effort_scale, options_.wrench_margin);
    asked_.torques = &*torques_;
    result_.statistics.build_s += watch.seconds();
    return true;
  }

  /// The contacts that bear, a wheel where it touches now.
  std::vector<BearingContact> bearing() {
    std::vector<BearingContact> bearing;
    if (rolls_) state_.update(found_.configuration.data());
    for (const Contact& contact : problem_.stance.contacts) {
      bearing.push_back({contact});
      if (!rolls(contact)) continue;
      bearing.back().contact.position =
          contact_kind_entry(contact.effector.kind).touching_point(state_, contact);
    }
    return bearing;
  }

  bool is_balanced() {
    const Stopwatch watch;
    state_.update(found_.configuration.data());
    const bool is = balances(robot_.total_mass(), bearing(), options_.wrench_margin,
                             state_.center_of_mass().head<2>());
    result_.statistics.build_s += watch.seconds();
    return is;
  }

  /// Without the margin where nothing balances with it. False: nor without.
  bool ask_balance() {
    const Stopwatch watch;
    ++polygons_;
    const std::vector<BearingContact> contacts = bearing();
    const double mass_kg = robot_.total_mass();
    region_ = balance_region(mass_kg, contacts, options_.wrench_margin, kResolution_m);
    for (const double margin : {options_.wrench_margin, 0.0}) {
      if (!region_.empty()) break;
      region_ = balance_region(mass_kg, contacts, margin, kFineResolution_m);
    }
    asked_.balance = region_.empty() ? nullptr : &region_;
    balances_nowhere_ = region_.empty() && !rolls_;
    result_.statistics.build_s += watch.seconds();
    return !region_.empty();
  }

  /// From the preferred configuration, with what was violated moved at random, further from one
  /// restart to the next.
  void restart() {
    ++result_.statistics.restarts;
    polygons_ = 0;
    const double reach = std::min(1.0, 0.25 * result_.statistics.restarts);
    asked_.start = solver_.perturbed(asked_.preferred, reach, random_);
  }

  CheckReport checked(const Eigen::VectorXd& q, const CheckOptions& options) {
    CheckReport report = judge_.check(q, problem_.stance, options);
    result_.statistics.geometry_s += report.geometry_s;
    result_.statistics.balance_s += report.balance_s;
    return report;
  }

  /// end: of the search, if the termination ended it.
  void explain(const std::optional<PlannerAnswer>& end) {
    if (!result_.report.constraint("static_balance").judged) {
      result_.report = checked(result_.configuration, options_.check);
    }
    result_.reason = "no posture found: " + violation_text(result_.report.worst());
    if (!end) return;
    result_.status = end->status;
    result_.reason += "; " + end->reason;
  }

  const Robot& robot_;
  const Judge& judge_;
  const PostureProblem& problem_;
  const PostureOptions& options_;
  std::mt19937_64 random_;
  TransitionSolver& solver_;
  RobotState state_;
  bool rolls_;  ///< a wheel may: where it bears depends on the posture
  TransitionProblem asked_;
  TransitionOptions how_;
  BalanceRegion region_;
  int polygons_ = 0;
  bool balances_nowhere_ = false;
  std::optional<TorqueProgramme> torques_;
  TransitionResult found_;  ///< of the last attempt
  CheckReport report_;      ///< likewise
  double least_ = std::numeric_limits<double>::infinity();
  PostureResult result_;
};

}  // namespace

/// Those that no solve uses at the moment: copies of one.
class PostureSolver::Solvers {
 public:
  Solvers(const std::shared_ptr<const RobotParameter>& robot, World world)
      : first_(robot, std::move(world)) {}

  std::unique_ptr<TransitionSolver> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<TransitionSolver>(first_);
    std::unique_ptr<TransitionSolver> solver = std::move(free_.back());
    free_.pop_back();
    return solver;
  }
  void give_back(std::unique_ptr<TransitionSolver> solver) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(solver));
  }

 private:
  std::mutex mutex_;
  const TransitionSolver first_;
  std::vector<std::unique_ptr<TransitionSolver>> free_;
};

World posture_world(World in_the_way) {
  in_the_way.surfaces = {ground()};
  return in_the_way;
}

PostureSolver::PostureSolver(std::shared_ptr<const RobotParameter> robot, World world,
                             const WorldFiles& files)
    : robot_(std::move(robot)),
      world_(parameter_of(std::move(world), files)),
      judge_(robot_->robot, world_->snapshot) {
  const Robot& model = *robot_->robot;
  if (!model.floating_base()) {
    throw Error("a posture of a robot with a fixed base", "a floating base");
  }
  RobotState(model).require_mass();
  model.require_collision_shapes();
  solvers_ = std::make_unique<Solvers>(robot_, at_rest(world_->snapshot->world()));
}

PostureSolver::~PostureSolver() = default;

PostureResult PostureSolver::solve(const PostureProblem& problem,
                                   const PostureOptions& options) const {
  options.validate();
  require_sound_stance(robot(), problem.stance);
  if (problem.preferred.size() != robot().configuration_size() || !problem.preferred.allFinite() ||
      !(problem.preferred.segment<4>(3).norm() > 1e-3)) {
    throw Error("a preferred configuration that is none of " + robot().name(),
                std::to_string(robot().configuration_size()) + " finite numbers");
  }
  std::unique_ptr<TransitionSolver> solver = solvers_->take();
  PostureResult result = Search(robot(), judge_, problem, options, *solver).run();
  solvers_->give_back(std::move(solver));
  return result;
}

Graph PostureSolver::graph(const PostureProblem& problem, const PostureResult& result,
                           const PostureOptions& options) const {
  Graph graph;
  graph.parameters().set(kRobotNumber, robot_);
  graph.parameters().set(kWorldNumber, world_);
  if (!problem.file.empty()) {
    const auto contacts = std::make_shared<ContactsParameter>();
    contacts->file = problem.file;
    graph.parameters().set(kContactsNumber, contacts);
  }
  graph.parameters().set(kPlacesNumber, std::make_shared<const PlacesParameter>(
                                            robot_, kRobotNumber, world_->snapshot->world()));
  const int stance = add_stances(graph, robot_, {problem.stance}).front();
  graph.add_vertex(0, VertexConfiguration(kRobotNumber, robot_, 0.0, result.configuration, stance));
  CheckOptions check = options.check;
  check.enforce_torque_limits = options.enforce_torque_limits;
  PlanEdgeOptions edges = motion_edges(check);
  edges.joint_margin_rad = edges.self_margin_m = 0.0;
  edges.obstacle_margin_m = edges.surface_margin_m = 0.0;
  const std::optional<BalanceCertificate>& balance = result.report.balance;
  const std::size_t contacts = problem.stance.contacts.size();
  add_plan_edges(
      graph, edges,
      {balance ? balance->wrenches : StanceWrenches(contacts, StanceWrenches::value_type::Zero())});
  return graph;
}

Eigen::VectorXd placed_at(const Robot& robot, const Eigen::VectorXd& configuration,
                          const Stance& stance) {
  require_sound_stance(robot, stance);
  const std::vector<Contact>& contacts = stance.contacts;
  RobotState state(robot);
  state.update(configuration.data());
  // Each contact is a few points: its own, one along the normal and one forward where these are
  // held; one straight above keeps the robot upright, one ahead its heading, where nothing else
  // says so.
  constexpr double kAxis_m = 0.1, kUpright_m = 0.3, kHeading_m = 0.02;
  std::vector<Eigen::Vector3d> own, wanted;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), ahead = Eigen::Vector3d::UnitX();
  // What the robot stands on says where it is; a hand reaches out from there.
  const bool stands = std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) {
    return contact_kind_entry(c.effector.kind).stood_on;
  });
  for (const Contact& placed : contacts) {
    const EndEffector& effector = placed.effector;
    const ContactKindEntry& kind = contact_kind_entry(effector.kind);
    if (stands && !kind.stood_on) continue;
    const Eigen::Isometry3d& pose = state.world_from_link(robot.link_index(effector.link));
    const Eigen::Vector3d point = pose * effector.point;
    // A ball's centre, and that of an upright wheel, is above the place it touches.
    const Eigen::Vector3d place =
        placed.position + (kind.is_round() ? effector.radius_m : 0.0) *
                              Eigen::Vector3d(placed.normal.stableNormalized());
    const auto pair = [&](const Eigen::Vector3d& of_robot, const Eigen::Vector3d& of_world) {
      own.push_back(point + of_robot);
      wanted.push_back(place + of_world);
    };
    pair(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    pair(kUpright_m * up, kUpright_m * up);
    pair(kHeading_m * ahead, kHeading_m * ahead);
    if (!kind.axes_on_link) continue;
    const Eigen::Vector3d normal = pose.linear() * effector.normal.normalized();
    pair(kAxis_m * normal, kAxis_m * placed.normal.normalized());
    if (!placed.forward) continue;
    pair(kAxis_m * (pose.linear() * effector.forward.normalized()),
         kAxis_m * placed.forward->normalized());
  }
  const Eigen::Index count = static_cast<Eigen::Index>(own.size());
  const Eigen::Map<const Eigen::Matrix3Xd> from(own.front().data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> to(wanted.front().data(), 3, count);
  Eigen::Isometry3d moved;
  moved.matrix() = Eigen::umeyama(from, to, false);
  Eigen::VectorXd q = configuration;
  const Eigen::Vector3d position = moved * Eigen::Vector3d(q.head<3>());
  const Eigen::Quaterniond turned =
      Eigen::Quaterniond(moved.linear()) * Eigen::Quaterniond(q.segment<4>(3).data());
  q.head<3>() = position;
  q.segment<4>(3) = turned.normalized().coeffs();
  return q;
}

}  // namespace locograph
