#include <locograph/common/uniform.h>
#include <locograph/core/optimiser.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/posture/posture_graph.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/world/distance_view.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <random>

namespace locograph {
namespace {

/// Pairs of RobotParameter::self_collision that the edges would keep apart where the exact shapes
/// do not touch.
std::vector<bool> coarse_pairs(const std::shared_ptr<const RobotParameter>& robot,
                               const Judge& judge) {
  const Robot& model = *robot->robot;
  const std::size_t pairs = robot->self_collision.pairs.size();
  std::vector<bool> coarse(pairs, false);
  std::vector<Eigen::VectorXd> examples = {model.neutral_configuration()};
  for (const std::string& name : model.configuration_names()) {
    examples.push_back(model.named_configuration(name));
  }
  const EdgeSelfCollision edge(*robot, 0.0, 1.0);
  Eigen::VectorXd depth(static_cast<Eigen::Index>(pairs));
  ConfigurationState state(robot);
  for (const Eigen::VectorXd& q : examples) {
    state.update(q.data());
    if (judge.self_distance_m(state.kinematics) < 0.0) continue;
    edge.error(state, depth);
    for (std::size_t p = 0; p < pairs; ++p) {
      if (depth[static_cast<Eigen::Index>(p)] > 0.0) coarse[p] = true;
    }
  }
  return coarse;
}

std::shared_ptr<const WorldParameter> parameter_of(World world, const WorldFiles& files) {
  const double height = ground_height(world);
  return std::make_shared<const WorldParameter>(
      std::make_shared<const WorldSnapshot>(std::move(world), 0.0, files),
      std::isfinite(height) ? std::optional(height) : std::nullopt);
}

/// One solve: the graph compiled once, attempts on it.
class Search {
 public:
  Search(const std::shared_ptr<const RobotParameter>& robot,
         const std::shared_ptr<const WorldParameter>& seen, const Judge& judge,
         const PostureProblem& problem, const PostureOptions& options, const PostureShapes& shapes,
         Workspace& workspace)
      : robot_(*robot->robot),
        judge_(judge),
        problem_(problem),
        options_(options),
        random_(options.seed),
        posture_(robot, seen, problem, options, shapes),
        solver_(make_linear_solver("dense")),
        workspace_(workspace) {
    compiled_.compile(posture_.graph);
    workspace_.allocate(compiled_);
    watched_ = posture_.watch(compiled_);
  }

  PostureResult run() {
    result_.statistics.build_s = watch_.seconds();
    Eigen::VectorXd start = problem_.preferred;
    for (;;) {
      attempt(start);
      if (result_.success()) break;
      const auto end = end_by(options_.termination, result_.statistics.iterations);
      if (end || result_.statistics.restarts >= options_.max_restarts) {
        explain(end);
        break;
      }
      ++result_.statistics.restarts;
      start = perturbed();
    }
    result_.statistics.total_s = watch_.seconds();
    return std::move(result_);
  }

 private:
  /// Optimises from `start`. The check has the last word, also on what lacks a margin only.
  void attempt(const Eigen::VectorXd& start) {
    posture_.set_start(start);
    workspace_.load_state();
    std::vector<double> worst_by_iteration;
    bool closed = false;
    OptimiserOptions lm;
    lm.scale_by_diagonal = true;
    lm.initial_lambda = 1e-4;
    lm.refused_lambda = 1e-2;
    lm.max_iterations =
        options_.termination.left_of(options_.max_iterations, result_.statistics.iterations);
    lm.gain = 1e-4;
    lm.deadline = options_.termination.deadline;
    lm.on_iteration = [&](const OptimiserResult&) {
      const double worst = watched_.worst(workspace_);
      closed = worst <= 1.0;
      worst_by_iteration.push_back(worst);
      return !closed && !options_.termination.stopped() && !stalled(worst_by_iteration);
    };
    const Stopwatch watch;
    Optimiser optimiser(lm);
    optimiser.start(workspace_, *solver_);
    while (optimiser.iterate()) {
    }
    workspace_.evaluate(workspace_.state());
    const double worst = watched_.worst(workspace_);
    workspace_.store_state();
    result_.statistics.optimise_s += watch.seconds();
    result_.statistics.iterations += optimiser.result().iterations;
    violated_ = watched_.violated(workspace_);
    const bool best = worst < best_;
    if (best) {
      best_ = worst;
      result_.configuration = posture_.configuration();
      checked_ = false;
    }
    CheckOptions asked = options_.check;
    asked.certify_only_if_rest_holds = true;
    CheckReport report = checked(posture_.configuration(), asked);
    if (report.feasible) {
      result_.status = PlannerStatus::kSolved;
      result_.reason = "found";
    }
    if (best || report.feasible) {
      result_.configuration = posture_.configuration();
      result_.report = std::move(report);
      checked_ = true;
    }
  }

  /// The worst violation, in tolerances, has not come down by a tenth in a few iterations.
  bool stalled(const std::vector<double>& worst) const {
    if (static_cast<int>(worst.size()) <= options_.patience) return false;
    const auto split = worst.end() - options_.patience;
    return *std::min_element(split, worst.end()) > 0.9 * *std::min_element(worst.begin(), split);
  }

  CheckReport checked(const Eigen::VectorXd& q, const CheckOptions& options) {
    CheckReport report = judge_.check(q, problem_.stance, options);
    result_.statistics.geometry_s += report.geometry_s;
    result_.statistics.balance_s += report.balance_s;
    return report;
  }

  /// end: of the search, if the termination ended it.
  void explain(const std::optional<PlannerAnswer>& end) {
    if (!checked_) result_.report = checked(result_.configuration, options_.check);
    result_.reason = "no posture found: " + violation_text(result_.report.worst());
    if (!end) return;
    result_.status = end->status;
    result_.reason += "; " + end->reason;
  }

  /// The preferred configuration with what was violated moved at random, further from one restart
  /// to the next.
  Eigen::VectorXd perturbed() {
    Eigen::VectorXd q = problem_.preferred;
    const int base = robot_.base_configuration_size();
    const double reach = std::min(1.0, 0.25 * result_.statistics.restarts);
    Eigen::VectorXd tangent = Eigen::VectorXd::Zero(robot_.tangent_size());
    if (violated_.base) {
      for (int i = 0; i < 3; ++i) tangent[i] = uniform(random_, -0.2, 0.2) * reach;
      for (int i = 3; i < 6; ++i) tangent[i] = uniform(random_, -0.6, 0.6) * reach;
    }
    robot_.integrate(q.data(), tangent.data(), q.data());
    for (int i = 0; i < robot_.active_joint_count(); ++i) {
      if (!violated_.joints[static_cast<std::size_t>(i)]) continue;
      const Joint& joint = robot_.active_joint(i);
      const double span = joint.type == JointType::kPrismatic ? 0.2 : 1.5;
      const double lower = std::max(joint.lower, q[base + i] - span * reach);
      const double upper = std::min(joint.upper, q[base + i] + span * reach);
      if (lower < upper) q[base + i] = uniform(random_, lower, upper);
    }
    return q;
  }

  const Robot& robot_;
  const Judge& judge_;
  const PostureProblem& problem_;
  const PostureOptions& options_;
  const Stopwatch watch_;
  std::mt19937_64 random_;
  PostureGraph posture_;
  std::unique_ptr<LinearSolver> solver_;
  Problem compiled_;
  Workspace& workspace_;
  WatchedRows watched_;
  Violated violated_;
  double best_ = std::numeric_limits<double>::infinity();
  bool checked_ = false;
  PostureResult result_;
};

}  // namespace

/// Workspaces that no solve uses at the moment: their memory takes longer to get than most solves.
class PostureSolver::Workspaces {
 public:
  std::unique_ptr<Workspace> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Workspace>();
    std::unique_ptr<Workspace> workspace = std::move(free_.back());
    free_.pop_back();
    return workspace;
  }
  void give_back(std::unique_ptr<Workspace> workspace) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(workspace));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> free_;
};

World posture_world(World in_the_way) {
  in_the_way.surfaces = {ground()};
  return in_the_way;
}

PostureSolver::PostureSolver(std::shared_ptr<const RobotParameter> robot, World world,
                             const WorldFiles& files)
    : robot_(std::move(robot)),
      world_(parameter_of(std::move(world), files)),
      judge_(robot_->robot, world_->snapshot),
      workspaces_(std::make_unique<Workspaces>()) {
  auto shapes = std::make_unique<PostureShapes>();
  shapes->coarse_pairs = coarse_pairs(robot_, judge_);
  const Robot& model = *robot_->robot;
  for (int link = 0; link < static_cast<int>(model.links().size()); ++link)
    shapes->solids.push_back(std::make_shared<const LinkSolids>(model, link));
  shapes_ = std::move(shapes);
  world_->snapshot->distance();  // now rather than in the first solve
  if (!model.floating_base()) {
    throw Error("a posture of a robot with a fixed base", "a floating base");
  }
  RobotState(model).require_mass();
  model.require_collision_shapes();
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
  std::unique_ptr<Workspace> workspace = workspaces_->take();
  PostureResult result =
      Search(robot_, world_, judge_, problem, options, *shapes_, *workspace).run();
  workspaces_->give_back(std::move(workspace));
  return result;
}

Graph PostureSolver::graph(const PostureProblem& problem, const PostureResult& result,
                           const PostureOptions& options) const {
  PostureOptions exact = options;
  exact.joint_margin_rad = exact.self_margin_m = exact.obstacle_margin_m = 0.0;
  exact.ground_margin_m = exact.wrench_margin = exact.torque_margin = 0.0;
  // What it stays near is itself: the graph is at rest.
  const PostureProblem found{problem.stance, result.configuration, problem.file};
  PostureGraph posture(robot_, world_, found, exact, *shapes_);
  const std::optional<BalanceCertificate>& balance = result.report.balance;
  posture.set(result.configuration, balance ? balance->wrenches : StanceWrenches());
  if (!problem.file.empty()) {
    const auto contacts = std::make_shared<ContactsParameter>();
    contacts->file = problem.file;
    posture.graph.parameters().set(kContactsNumber, contacts);
  }
  return std::move(posture.graph);
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
