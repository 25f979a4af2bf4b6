#include <locograph/common/check_option.h>
#include <locograph/core/optimiser.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

using Reason = OptimiserResult::Reason;
using Vector = Eigen::Map<Eigen::VectorXd>;

constexpr int kMostStatistics = 10000;
/// Nielsen's: the factor on λ after a step that did what the model says.
constexpr double kLambdaFall = 1.0 / 3.0;
/// A predicted decrease below this fraction of the cost is too near to rounding to measure parts
/// of it.
constexpr double kMeasurable = 1e-11;
/// A predicted decrease above this fraction of the cost is one that rounding cannot hide.
constexpr double kPromise = 1e-9;
/// A step is one of many where it promises more than this fraction of the cost.
constexpr double kMatters = 1e-2;

Vector map(std::span<double> values) {
  return Vector(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Sum of term(0) … term(n − 1), in an order that depends on n alone. Eigen's depends on where the
/// numbers lie in memory: the same input would not give the same bits.
template <class Term>
double sum(Eigen::Index n, Term term) {
  constexpr Eigen::Index kLanes = 8;
  Eigen::Array<double, kLanes, 1> lanes = Eigen::Array<double, kLanes, 1>::Zero();
  const Eigen::Index whole = n / kLanes * kLanes;
  for (Eigen::Index i = 0; i < whole; i += kLanes) {
    for (Eigen::Index lane = 0; lane < kLanes; ++lane) lanes[lane] += term(i + lane);
  }
  double total = lanes.sum();
  for (Eigen::Index i = whole; i < n; ++i) total += term(i);
  return total;
}
double dot(const Vector& a, const Vector& b) {
  return sum(a.size(), [&](Eigen::Index i) { return a[i] * b[i]; });
}
double norm(const Vector& a) { return std::sqrt(dot(a, a)); }

}  // namespace

OptimiserOptions OptimiserOptions::for_any_start() {
  OptimiserOptions options;
  options.scale_by_diagonal = options.follow_diagonal = true;
  options.refused_lambda = 1e-4;
  return options;
}

void OptimiserOptions::validate() const {
  check_option(max_iterations >= 0, "max_iterations", "0 or more");
  check_option(gain >= 0.0 && gain < 1.0, "gain", "a fraction in [0, 1)");
  check_option(gradient_tolerance >= 0.0, "gradient_tolerance", "0 or more");
  check_option(step_tolerance >= 0.0, "step_tolerance", "0 or more");
  check_option(initial_lambda > 0.0, "initial_lambda", "a positive number");
  check_option(refused_lambda > 0.0, "refused_lambda", "a positive number");
  check_option(initial_radius > 0.0, "initial_radius", "a positive number");
  check_option(max_refusals >= 1, "max_refusals", "1 or more");
  check_option(max_cuts >= 1, "max_cuts", "1 or more");
  check_option(nonmonotonic_steps >= 0, "nonmonotonic_steps", "0 or more");
}

std::string OptimiserResult::reason_text() const {
  switch (reason) {
    case Reason::kRunning:
      return "still running";
    case Reason::kGain:
      return "converged: the cost changes less than the gain asked for";
    case Reason::kGradient:
      return "converged: the gradient vanishes";
    case Reason::kStep:
      return "converged: the step vanishes";
    case Reason::kMaxIterations:
      return "the number of iterations is used up";
    case Reason::kDeadline:
      return "the deadline has passed";
    case Reason::kNoProgress:
      return promised_decrease > kPromise
                 ? "no step lowers the cost, although the gradient promises one that does: the "
                   "Jacobian of an edge may not be the derivative of its error"
                 : "no step lowers the cost";
    case Reason::kSingular:
      return "the linear system is singular";
    case Reason::kNotFinite:
      return "the initial cost is not finite";
    case Reason::kDiverged:
      return "the step raised the cost";
    case Reason::kNothingToDo:
      return "converged: every vertex is fixed";
    case Reason::kStopped:
      return "stopped by the caller";
  }
  return "";
}

void Optimiser::start(Workspace& workspace, LinearSolver& solver, bool evaluated) {
  workspace_ = &workspace;
  solver_ = &solver;
  // The statistics keep their memory: a moving horizon starts an optimisation every cycle.
  std::vector<IterationStatistics> statistics = std::move(result_.statistics);
  statistics.clear();
  statistics.reserve(std::min(options_.max_iterations, kMostStatistics));
  result_ = {};
  result_.statistics = std::move(statistics);
  lambda_ = 0.0;
  lambda_growth_ = 2.0;
  lambda_fall_ = kLambdaFall;
  refused_ = linearised_ = false;
  radius_ = options_.initial_radius;
  const int n = workspace.problem().dimension();
  diagonal_.resize(n);
  scaling_.assign(n, 0.0);
  if (options_.follow_diagonal) first_diagonal_.resize(n);
  newton_step_.resize(n);
  negative_gradient_.resize(n);
  workspace.problem().analyse(solver);
  cost_ = evaluated ? workspace.return_to_state() : workspace.evaluate(workspace.state());
  result_.initial = result_.final = best_cost_ = cost_;
  const bool undamped_first =
      options_.follow_diagonal && options_.algorithm == Algorithm::kLevenbergMarquardt;
  reference_.start(cost_.robust, undamped_first ? 0 : options_.nonmonotonic_steps);
  if (may_rise()) best_state_ = first_state_ = workspace.state();
  if (!std::isfinite(cost_.robust)) finish(Reason::kNotFinite);
  if (n == 0) finish(Reason::kNothingToDo);
}

void Optimiser::go_to(const std::vector<double>& state, const Cost& cost) {
  linearised_ = false;
  workspace_->trial() = state;
  workspace_->evaluate(workspace_->trial());
  workspace_->accept_trial();
  cost_ = result_.final = cost;
}

void Optimiser::return_to_best() {
  if (cost_.robust > best_cost_.robust) go_to(best_state_, best_cost_);
}

/// At the first state, with damping and the steps that may rise.
bool Optimiser::begin_again() {
  if (cost_.robust <= best_cost_.robust) best_state_ = workspace_->state();
  go_to(first_state_, result_.initial);
  reference_.start(cost_.robust, options_.nonmonotonic_steps);
  lambda_growth_ = 2.0;
  ++result_.iterations;
  return true;
}

bool Optimiser::finish(Reason reason) {
  return_to_best();
  result_.reason = reason;
  result_.converged = reason == Reason::kGain || reason == Reason::kGradient ||
                      reason == Reason::kStep || reason == Reason::kNothingToDo;
  result_.final = cost_;
  return false;
}

/// Ends because refused steps have become too short to matter. That is convergence where already
/// the first of them, which was to lower the cost by `promised`, mattered to nobody; a gradient
/// that is one lowers the cost before the step vanishes. What is below the rounding of the cost
/// that the run began with does not matter either: near nothing it is a large fraction of what is
/// left.
bool Optimiser::finish_refused(Reason converged, double promised) {
  const double fraction = promised / cost_.robust;
  const double rounding = std::numeric_limits<double>::epsilon() * result_.initial.robust;
  const bool matters = fraction > std::max(options_.gain, kPromise) && promised > rounding;
  if (!matters) return finish(converged);
  result_.promised_decrease = fraction;
  return finish(Reason::kNoProgress);
}

void Optimiser::go_on_refused() {
  result_.reason = Reason::kRunning;
  result_.converged = false;
  result_.promised_decrease = 0.0;
  result_.singular_vertex = -1;
}

void Optimiser::costs_changed() {
  linearised_ = false;
  cost_ = result_.final = best_cost_ = workspace_->return_to_state();
  reference_.start(cost_.robust, options_.nonmonotonic_steps);
  if (may_rise()) best_state_ = workspace_->state();
}

bool Optimiser::iterate() {
  if (result_.reason != Reason::kRunning) return false;
  if (result_.iterations >= options_.max_iterations) return finish(Reason::kMaxIterations);
  if (options_.deadline.passed()) return finish(Reason::kDeadline);
  IterationStatistics now;
  Stopwatch watch;
  if (!linearised_) {
    workspace_->linearise();
    linearised_ = true;
    promised_ = 0.0;
  }
  now.time_linearise = watch.seconds();
  map(negative_gradient_) = -map(workspace_->gradient());
  if (map(negative_gradient_).lpNorm<Eigen::Infinity>() <= options_.gradient_tolerance) {
    return finish(Reason::kGradient);
  }
  bool more = false;
  switch (options_.algorithm) {
    case Algorithm::kGaussNewton:
      more = iterate_gauss_newton(now);
      break;
    case Algorithm::kLevenbergMarquardt:
      more = iterate_levenberg_marquardt(now);
      break;
    case Algorithm::kDogleg:
      more = iterate_dogleg(now);
      break;
  }
  now.cost = cost_.robust;
  now.chi2 = cost_.chi2;
  if (result_.statistics.size() < result_.statistics.capacity()) result_.statistics.push_back(now);
  if (options_.on_iteration && !options_.on_iteration(result_) && more) {
    return finish(Reason::kStopped);
  }
  return more;
}

/// step = (H + diag(damping))⁻¹ (−gradient), timed.
bool Optimiser::solve(IterationStatistics& now) {
  const Stopwatch watch;
  const bool good = solver_->factorise(workspace_->hessian().data(), workspace_->damping().data());
  if (good) {
    solver_->solve(negative_gradient_.data(), workspace_->step().data());
  } else if (solver_->failed_row() >= 0) {
    result_.singular_vertex = workspace_->problem().free_vertices()[solver_->failed_row()];
  }
  now.time_solve += watch.seconds();
  return good;
}

Cost Optimiser::evaluate_trial(IterationStatistics& now) {
  const Stopwatch watch;
  workspace_->apply_step();
  const Cost cost = workspace_->evaluate(workspace_->trial());
  now.time_evaluate += watch.seconds();
  return cost;
}

double Optimiser::state_norm() const { return norm(map(workspace_->state())); }

/// Takes the trial state; true when there is more to do. That a step cut short is small, or gains
/// little, says nothing: it is no sign of convergence.
bool Optimiser::accept(const Cost& cost, double predicted, IterationStatistics& now, bool whole) {
  const double before = cost_.robust;
  now.step_norm = norm(map(workspace_->step()));
  const bool tiny =
      now.step_norm <= options_.step_tolerance * (state_norm() + options_.step_tolerance);
  if (may_rise() && cost.robust > before && before <= best_cost_.robust) {
    best_state_ = workspace_->state();
  }
  workspace_->accept_trial();
  linearised_ = false;
  reference_.accept(cost.robust, predicted);
  cost_ = cost;
  if (!may_rise() || cost.robust < best_cost_.robust) best_cost_ = cost;
  result_.final = cost;
  ++result_.iterations;
  if (!whole) return true;
  const double change = may_rise() ? std::abs(before - cost.robust) : before - cost.robust;
  const bool settled = change <= options_.gain * before;
  if (!settled && !tiny) return true;
  if (cost.robust <= best_cost_.robust * (1.0 + options_.gain)) {
    return finish(settled ? Reason::kGain : Reason::kStep);
  }
  // The rise led to a worse place: from the best one again, downwards.
  return_to_best();
  reference_.start(cost_.robust, 0);
  return true;
}

bool Optimiser::iterate_gauss_newton(IterationStatistics& now) {
  map(workspace_->damping()).setZero();
  if (!solve(now)) return finish(Reason::kSingular);
  const Cost cost = evaluate_trial(now);
  // A rise beyond rounding: keep the better state and say so.
  if (!(cost.robust <= cost_.robust * (1.0 + 1e-9))) return finish(Reason::kDiverged);
  return accept(cost, 0.0, now);
}

/// Cuts the refused step, whose cost is `cost`, until a tenth of the decrease that the gradient
/// promises is there (Nocedal & Wright 2006, section 3.1; the cuts by interpolation, section 3.5).
/// True when the trial state is one to take; `cost` is then its cost.
bool Optimiser::shorten(Cost& cost, IterationStatistics& now) {
  Vector step = map(workspace_->step());
  const double slope = 2.0 * dot(step, map(negative_gradient_));  // at 0, downwards
  double length = 1.0;
  for (int cut = 0; cut < options_.max_cuts; ++cut) {
    // The least of the parabola through the cost at 0, with its slope, and at `length`.
    const double least = 0.5 * slope * length / (slope + (cost.robust - cost_.robust) / length);
    const double factor = std::isfinite(cost.robust) ? std::clamp(least / length, 0.1, 0.5) : 0.1;
    step *= factor;
    length *= factor;
    cost = evaluate_trial(now);
    if (std::isfinite(cost.robust) && cost_.robust - cost.robust > 0.1 * slope * length) {
      return true;
    }
  }
  return false;
}

void Optimiser::update_scaling() {
  constexpr double kLeastOfFirst = 1e-6;
  Vector scaling = map(scaling_);
  const Vector now = map(diagonal_);
  if (!options_.follow_diagonal) {
    scaling = scaling.cwiseMax(now);
    return;
  }
  if (result_.iterations == 0) first_diagonal_ = diagonal_;
  scaling = now.cwiseMax(kLeastOfFirst * map(first_diagonal_));
}

bool Optimiser::iterate_levenberg_marquardt(IterationStatistics& now) {
  workspace_->diagonal(diagonal_);
  if (lambda_ == 0.0) {
    lambda_unit_ = options_.scale_by_diagonal ? 1.0 : map(diagonal_).maxCoeff();
    lambda_ = options_.initial_lambda * lambda_unit_;
  }
  update_scaling();
  bool factorised = false;
  for (; now.refusals < options_.max_refusals; ++now.refusals) {
    now.lambda = lambda_;
    Vector damping = map(workspace_->damping());
    if (options_.scale_by_diagonal) {
      damping = lambda_ * map(scaling_).cwiseMax(1e-9).cwiseMin(1e32);
    } else {
      damping.setConstant(lambda_);
    }
    if (solve(now)) {
      const Vector step = map(workspace_->step());
      if (norm(step) <= options_.step_tolerance * (state_norm() + options_.step_tolerance)) {
        return finish_refused(Reason::kStep, promised_);
      }
      const Cost cost = evaluate_trial(now);
      // F(h) ≈ F + 2gᵀh + hᵀHh, and (H + D)h = −g: the predicted decrease is hᵀ(Dh − g).
      const Vector descent = map(negative_gradient_);
      const double predicted = sum(step.size(), [&](Eigen::Index i) {
        return step[i] * (damping[i] * step[i] + descent[i]);
      });
      if (promised_ == 0.0) promised_ = predicted;
      factorised = true;
      now.gain_ratio = reference_.quality(cost.robust, predicted);
      if (std::isfinite(cost.robust) && now.gain_ratio > 0.0) {
        const double s = 2.0 * now.gain_ratio - 1.0;
        const double factor = 1.0 - s * s * s;
        lambda_ *= std::max(lambda_fall_, factor);
        lambda_growth_ = 2.0;
        if (options_.shorten_steps) {
          constexpr double kFastest = 1e-4;
          // Below the first λ there is nothing to hurry for.
          const bool fell = factor <= lambda_fall_;
          const bool damped = lambda_ > options_.initial_lambda * lambda_unit_;
          lambda_fall_ =
              fell && damped ? std::max(lambda_fall_ * lambda_fall_, kFastest) : kLambdaFall;
        }
        return accept(cost, predicted, now);
      }
      // At the bottom of the valley rounding decides; the model says there is nothing to gain.
      if (predicted <= options_.gain * cost_.robust * 1e-3) {
        return finish_refused(Reason::kGain, promised_);
      }
      lambda_fall_ = kLambdaFall;
      Cost shorter = cost;
      if (options_.shorten_steps && predicted > kMeasurable * cost_.robust &&
          shorten(shorter, now)) {
        // The rows that were in the way are known from now on: the next whole step takes the rise
        // back. Otherwise two rows that act in turns would raise λ until nothing moves.
        constexpr double kRise = 10.0;
        lambda_ *= kRise;
        lambda_fall_ = kLambdaFall / kRise;
        return accept(shorter, predicted, now, false);
      }
    }
    lambda_ *= lambda_growth_;
    if (!refused_ || !options_.follow_diagonal) {
      lambda_ = std::max(lambda_, options_.refused_lambda * lambda_unit_);
    }
    lambda_growth_ *= 2.0;
    if (!refused_ && options_.follow_diagonal && promised_ > kMatters * cost_.robust) {
      refused_ = true;
      if (result_.iterations > 0) return begin_again();
      reference_.start(cost_.robust, options_.nonmonotonic_steps);
    }
    if (options_.deadline.passed()) return finish(Reason::kDeadline);
  }
  if (!factorised) return finish(Reason::kSingular);
  return finish_refused(Reason::kNoProgress, promised_);
}

bool Optimiser::iterate_dogleg(IterationStatistics& now) {
  Vector step = map(workspace_->step());
  const Vector descent = map(negative_gradient_);
  Vector newton = map(newton_step_);
  // A little damping when H alone cannot be factorised.
  double damping = 0.0;
  workspace_->diagonal(diagonal_);
  for (;;) {
    map(workspace_->damping()).setConstant(damping);
    if (solve(now)) break;
    damping = damping == 0.0 ? 1e-9 * map(diagonal_).maxCoeff() : damping * 100.0;
    if (!(damping < map(diagonal_).maxCoeff())) return finish(Reason::kSingular);
  }
  newton = step;
  const double curvature = workspace_->quadratic_form(negative_gradient_);
  double promised = 0.0;
  const double alpha = curvature > 0.0 ? dot(descent, descent) / curvature : 0.0;
  for (; now.refusals < options_.max_refusals; ++now.refusals) {
    now.lambda = radius_;
    if (norm(newton) <= radius_) {
      step = newton;
    } else if (alpha * norm(descent) >= radius_ || alpha == 0.0) {
      step = radius_ / norm(descent) * descent;
    } else {
      // From the Cauchy point a towards the Newton step b until the radius: |a + β(b − a)| = Δ.
      const double a2 = alpha * alpha * dot(descent, descent);
      const double ab = alpha * dot(descent, newton) - a2;
      const double b2 = sum(step.size(), [&](Eigen::Index i) {
        const double between = newton[i] - alpha * descent[i];
        return between * between;
      });
      const double beta = (-ab + std::sqrt(ab * ab + b2 * (radius_ * radius_ - a2))) / b2;
      for (Eigen::Index i = 0; i < step.size(); ++i) {
        step[i] = alpha * descent[i] + beta * (newton[i] - alpha * descent[i]);
      }
    }
    const Cost cost = evaluate_trial(now);
    const double predicted =
        2.0 * dot(descent, step) - workspace_->quadratic_form(workspace_->step());
    if (now.refusals == 0) promised = predicted;
    now.gain_ratio = reference_.quality(cost.robust, predicted);
    const bool good = std::isfinite(cost.robust) && now.gain_ratio > 0.0;
    const double length = norm(step);
    if (good && now.gain_ratio > 0.75) radius_ = std::max(radius_, 3.0 * length);
    if (!good || now.gain_ratio < 0.25) radius_ = std::min(radius_, length) / 2.0;
    if (good) return accept(cost, predicted, now);
    if (predicted <= options_.gain * cost_.robust * 1e-3) {
      return finish_refused(Reason::kGain, promised);
    }
    if (options_.deadline.passed()) return finish(Reason::kDeadline);
  }
  return finish_refused(Reason::kNoProgress, promised);
}

OptimiserResult optimise(Graph& graph, const OptimiserOptions& options, LinearSolver& solver,
                         ThreadPool* threads) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.use_threads(threads);
  workspace.load_state();
  solver.use_threads(threads);
  Optimiser optimiser(options);
  optimiser.start(workspace, solver);
  while (optimiser.iterate()) {
  }
  workspace.store_state();
  solver.use_threads(nullptr);
  return optimiser.result();
}

}  // namespace locograph
