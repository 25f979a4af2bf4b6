#include <locograph/common/uniform.h>
#include <locograph/planners/posture/transition_rows.h>
#include <locograph/planners/posture/transition_solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace locograph {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kClosureWeight = 1e5, kRowWeight = 1e3, kPosture = 1e-3, kDamping = 1e-3;
constexpr double kLongestTurn_rad = 0.4, kLongestShift_m = 0.25;
constexpr double kClosed = 1e-5;        ///< m, rad; the judge allows 1e-4 m
constexpr double kContactMerit = 3.0;   ///< against the merit of the rows
constexpr double kRowTolerance = 5e-4;  ///< of what rows ask for beyond what is needed
constexpr int kMostPasses = 8;
/// Damping grows until the trust region holds so much of the step.
constexpr double kLeastShare = 0.6, kMoreDamping = 6.0;
constexpr int kMostDamped = 5;
/// A ball that is lifted must not be in its surface by more than 1e-6 m.
constexpr double kExactlyClosed = 1e-8;

}  // namespace

struct TransitionSolver::Parts {
  TransitionRows rows;
  int size;
  Eigen::MatrixXd base_hessian, hessian;
  Eigen::VectorXd base_gradient, gradient, step, predicted, away, moved, error;
  Eigen::MatrixXd gram;
  Eigen::LLT<Eigen::MatrixXd> factor, small_factor;
  std::vector<bool> active;

  explicit Parts(TransitionRows of) : rows(std::move(of)), size(rows.robot().tangent_size()) {
    hessian.resize(size, size);
    step.resize(size);
    away.resize(size);
  }

  double merit() const {
    double sum = kContactMerit * rows.closure().cwiseAbs().sum();
    for (const TransitionRows::Row& row : rows.rows()) sum += std::max(0.0, -row.value);
    return sum;
  }

  bool holds() const {
    if (rows.closure().size() > 0 && rows.closure().cwiseAbs().maxCoeff() > kClosed) return false;
    return std::none_of(rows.rows().begin(), rows.rows().end(),
                        [](const TransitionRows::Row& row) { return row.value < -kRowTolerance; });
  }

  /// The step of the linearised problem, into `step`.
  void find_step(const Eigen::VectorXd& q, const Eigen::VectorXd& preferred, double damping) {
    const auto jacobian = rows.closure_jacobian();
    const auto gradients = rows.gradients();
    const int base = rows.robot().base_tangent_size();
    base_hessian.setZero(size, size);
    base_gradient.setZero(size);
    rows.robot().difference(q.data(), preferred.data(), away.data());
    for (int i = 0; i < size; ++i) {
      const double pull = i < base ? 0.0 : kPosture;
      base_hessian(i, i) = damping + pull;
      base_gradient[i] = pull * away[i];
    }
    if (jacobian.rows() > 0) {
      base_hessian.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose(), kClosureWeight);
      base_gradient.noalias() -= kClosureWeight * (jacobian.transpose() * rows.closure());
    }
    const std::vector<TransitionRows::Row>& all = rows.rows();
    active.assign(all.size(), false);
    hessian = base_hessian;
    gradient = base_gradient;
    const auto toggle = [&](std::size_t i) {
      active[i] = !active[i];
      const double weight = active[i] ? kRowWeight : -kRowWeight;
      const auto a = gradients.row(static_cast<Eigen::Index>(i));
      for (int k = 0; k < size; ++k) {
        if (a[k] == 0.0) continue;
        hessian.col(k).tail(size - k) += (weight * a[k]) * a.tail(size - k).transpose();
      }
      gradient.noalias() -= (weight * all[i].value) * a.transpose();
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].value < 0.0) toggle(i);
    }
    for (int pass = 0; pass < kMostPasses; ++pass) {
      factor.compute(hessian);
      step = factor.solve(gradient);
      predicted.noalias() = gradients * step;
      bool same = true;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if ((all[i].value + predicted[static_cast<Eigen::Index>(i)] < 0.0) == active[i]) continue;
        same = false;
        toggle(i);
      }
      if (same) break;
    }
  }

  double share_within(double radius) const {
    const double turn = step.tail(size - 3).cwiseAbs().maxCoeff();
    const double shift = step.head<3>().norm();
    return std::min({1.0, radius * kLongestTurn_rad / turn, radius * kLongestShift_m / shift});
  }

  /// Moves `q` until the contacts are as far from closed as `wanted`.
  void correct(Eigen::VectorXd& q, const Eigen::VectorXd& wanted, double tolerance, int most) {
    if (wanted.size() == 0) return;
    const auto jacobian = rows.closure_jacobian();
    gram.noalias() = jacobian * jacobian.transpose();
    gram.diagonal().array() += 1e-6;
    small_factor.compute(gram);
    for (int i = 0; i < most; ++i) {
      rows.closure_at(q, error);
      error -= wanted;
      if (error.cwiseAbs().maxCoeff() < tolerance) return;
      moved = -(jacobian.transpose() * small_factor.solve(error));
      const double longest = moved.cwiseAbs().maxCoeff();
      if (longest > 0.2) moved *= 0.2 / longest;
      rows.robot().integrate(q.data(), moved.data(), q.data());
    }
  }

  /// One attempt from q, which becomes where it ends.
  bool attempt(Eigen::VectorXd& q, const Eigen::VectorXd& preferred,
               const TransitionOptions& options, int& iterations, double& best) {
    double damping = kDamping, radius = 1.0;
    rows.evaluate(q);
    double now = merit();
    best = now;
    double before = now;
    int since = 0;
    Eigen::VectorXd trial;
    for (int i = 0; i < options.max_iterations; ++i) {
      if (holds()) return true;
      if (options.termination.ended(iterations)) return false;
      ++iterations;
      find_step(q, preferred, damping);
      double share = share_within(radius);
      // A direction that is far too long for its linearisation is no good when cut, either.
      for (int k = 0; k < kMostDamped && share < kLeastShare; ++k) {
        damping *= kMoreDamping;
        find_step(q, preferred, damping);
        share = share_within(radius);
      }
      if (!step.allFinite()) break;
      step *= share;
      trial.resize(q.size());
      rows.robot().integrate(q.data(), step.data(), trial.data());
      const Eigen::VectorXd wanted = (1.0 - share) * rows.closure();
      correct(trial, wanted, 0.2 * kClosed, 2);
      rows.evaluate(trial);
      const double then = merit();
      if (then < now * (1.0 - 1e-4) || holds()) {
        q.swap(trial);
        now = then;
        radius = std::min(1.0, 2.0 * radius);
        damping = std::max(kDamping, damping / 3.0);
      } else {
        rows.evaluate(q);
        radius *= 0.5;
        damping *= 3.0;
        if (radius < 1e-3) break;
      }
      best = std::min(best, now);
      if (now < 0.9 * before) {
        before = now;
        since = 0;
      } else if (++since >= options.patience) {
        break;
      }
    }
    return holds();
  }

  /// What is violated most, of rows() as they are; and besides, which contacts are open.
  void explain(TransitionResult& result) const {
    result.failure = TransitionFailure::kNone;
    result.amount = 0.0;
    std::string worst, open;
    const std::string* last = nullptr;
    const auto take = [&](TransitionFailure kind, double amount, auto&& text) {
      if (amount <= result.amount) return;
      result.failure = kind;
      result.amount = amount;
      worst = text();
    };
    const Eigen::VectorXd& closure = rows.closure();
    for (Eigen::Index i = 0; i < closure.size(); ++i) {
      const double amount = std::abs(closure[i]) - kClosed;
      if (amount <= 0.0) continue;
      const std::string& name = rows.contact_name(static_cast<int>(i));
      if (last == nullptr || *last != name) open += (open.empty() ? "" : ", ") + name;
      last = &name;
      take(TransitionFailure::kContact, amount,
           [&] { return "contact of " + name + " not closed"; });
    }
    for (const TransitionRows::Row& row : rows.rows()) {
      take(row.kind, -row.value - kRowTolerance, [&] { return rows.text(row); });
    }
    char amount[32];
    std::snprintf(amount, sizeof amount, " by %.3g", result.amount);
    result.reason = worst + amount;
    if (result.failure != TransitionFailure::kContact && !open.empty()) {
      result.reason += ", contact of " + open + " not closed";
    }
  }

  /// See TransitionSolver::perturbed().
  Eigen::VectorXd perturbed(const Eigen::VectorXd& q, double reach, std::mt19937_64& random) const {
    const Robot& robot = rows.robot();
    std::vector<bool> joints(static_cast<std::size_t>(robot.active_joint_count()), false);
    bool base = false;
    const auto chain = [&](int link) {
      if (link < 0) return;
      for (const int axis : robot.support(link)) {
        joints[static_cast<std::size_t>(robot.axes()[static_cast<std::size_t>(axis)].active)] =
            true;
      }
    };
    for (Eigen::Index i = 0; i < rows.closure().size(); ++i) {
      if (std::abs(rows.closure()[i]) <= kClosed) continue;
      base = true;
      chain(rows.contact_link(static_cast<int>(i)));
    }
    for (const TransitionRows::Row& row : rows.rows()) {
      if (row.value >= -kRowTolerance) continue;
      if (row.kind == TransitionFailure::kJoint) {
        joints[static_cast<std::size_t>(row.first)] = true;
        continue;
      }
      const auto [first, second] = rows.links(row);
      chain(first);
      chain(second);
      base = base || row.kind != TransitionFailure::kSelf;
    }
    if (!base && std::find(joints.begin(), joints.end(), true) == joints.end()) {
      base = true;
      joints.assign(joints.size(), true);
    }
    Eigen::VectorXd tangent = Eigen::VectorXd::Zero(size);
    if (base) {
      for (int i = 0; i < 3; ++i) tangent[i] = uniform(random, -0.2, 0.2) * reach;
      for (int i = 3; i < 6; ++i) tangent[i] = uniform(random, -0.6, 0.6) * reach;
    }
    Eigen::VectorXd result(q.size());
    robot.integrate(q.data(), tangent.data(), result.data());
    const int first = robot.base_configuration_size();
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      if (!joints[static_cast<std::size_t>(i)]) continue;
      const Joint& joint = robot.active_joint(i);
      const double span = joint.type == JointType::kPrismatic ? 0.2 : 1.5;
      const double lower = std::max(joint.lower, result[first + i] - span * reach);
      const double upper = std::min(joint.upper, result[first + i] + span * reach);
      if (lower < upper) result[first + i] = uniform(random, lower, upper);
    }
    return result;
  }
};

TransitionSolver::TransitionSolver(std::shared_ptr<const RobotParameter> robot, World world)
    : parts_(std::make_unique<Parts>(TransitionRows(std::move(robot), std::move(world)))) {}
TransitionSolver::~TransitionSolver() = default;
TransitionSolver::TransitionSolver(const TransitionSolver& other)
    : parts_(std::make_unique<Parts>(other.parts_->rows)) {}
TransitionSolver::TransitionSolver(TransitionSolver&&) noexcept = default;

void TransitionSolver::leave_as_near(const Eigen::VectorXd& q, double margin_m) {
  parts_->rows.leave_as_near(q, margin_m);
}

TransitionResult TransitionSolver::solve(const TransitionProblem& problem,
                                         const TransitionOptions& options) {
  options.validate();
  const Stopwatch watch;
  TransitionResult result;
  if (problem.balance != nullptr && problem.balance->empty()) {
    result.status = PlannerStatus::kInfeasible;
    result.configuration = problem.start;
    result.failure = TransitionFailure::kBalance;
    result.reason = "the contacts balance the robot nowhere";
    return result;
  }
  Parts& parts = *parts_;
  parts.rows.set_problem(problem, options);
  std::mt19937_64 random(problem.seed);
  Eigen::VectorXd q = problem.start;
  double least = std::numeric_limits<double>::infinity();
  int &iterations = result.statistics.iterations, &restarts = result.statistics.restarts;
  for (;; ++restarts) {
    double best = 0.0;
    const bool found = parts.attempt(q, problem.preferred, options, iterations, best);
    if (found) result.status = PlannerStatus::kSolved;
    if (found || best < least) {
      least = best;
      result.configuration = q;
      if (!found) parts.explain(result);
    }
    if (found) break;
    if (const auto end = end_by(options.termination, iterations)) {
      result.status = end->status;
      result.reason += "; " + end->reason;
      break;
    }
    if (restarts >= options.restarts) break;
    q = parts.perturbed(problem.start, std::min(1.0, 0.25 * (restarts + 1)), random);
  }
  if (result.success()) {
    const Eigen::VectorXd closed = Eigen::VectorXd::Zero(parts.rows.closure().size());
    parts.correct(result.configuration, closed, kExactlyClosed, 4);
    result.failure = TransitionFailure::kNone;
    result.reason = "found";
  }
  result.statistics.total_s = watch.seconds();
  return result;
}

Eigen::VectorXd TransitionSolver::perturbed(const Eigen::VectorXd& q, double reach,
                                            std::mt19937_64& random) const {
  return parts_->perturbed(q, reach, random);
}

}  // namespace locograph
