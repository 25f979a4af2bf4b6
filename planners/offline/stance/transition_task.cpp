#include <locograph/planners/offline/stance/transition_task.h>

#include <algorithm>
#include <cstring>

namespace locograph {
namespace {

/// Of polygons about places that balls have rolled to, and how often these are looked for.
constexpr double kRolledResolution_m = 2e-3;
constexpr int kMostRolled = 3;

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  const std::size_t bytes = static_cast<std::size_t>(a.size()) * sizeof(double);
  return bytes == 0 || std::memcmp(a.data(), b.data(), bytes) == 0;
}

}  // namespace

bool same_task(const TransitionTask& a, const TransitionTask& b) {
  return a.larger == b.larger && a.smaller == b.smaller && a.seed == b.seed &&
         a.options == b.options && same_bits(a.start, b.start) &&
         same_bits(a.preferred, b.preferred) && same_bits(a.before, b.before) &&
         (a.before.size() == 0 || a.opens == b.opens);
}

const BalanceRegion& BalanceRegions::of(const Footing& footing,
                                        std::span<const BearingContact> contacts) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = regions_.find(footing);
    if (found != regions_.end()) return found->second;
  }
  // Two threads may both get here, to the same region.
  BalanceRegion region;
  if (!contacts.empty()) region = balance_region(mass_kg_, contacts, kRegionMargin);
  const std::lock_guard<std::mutex> lock(mutex_);
  return regions_.emplace(footing, std::move(region)).first->second;
}

TaskSolver::TaskSolver(const Task& task, BalanceRegions& regions)
    : task_(task),
      regions_(regions),
      solver_(task.robot, task.world->world()),
      state_(*task.robot->robot) {}

TransitionResult TaskSolver::solve(const TransitionTask& task) {
  TransitionProblem problem;
  problem.closed = task.closed;
  problem.held = task.held;
  problem.balance = &regions_.of(task.smaller, task.bearing);
  problem.start = task.start;
  problem.preferred = task.preferred.size() > 0 ? task.preferred : task_.start_configuration;
  problem.seed = task.seed;
  HeldBalls balls;
  if (task.before.size() > 0) {
    state_.update(task.before.data());
    balls = held_balls(state_, task.closed, [&task](const Contact& contact) {
      return task.opens ||
             std::ranges::find(task.held, contact.name(), &Contact::name) != task.held.end();
    });
    problem.rolled_from = balls;
  }
  TransitionResult result = solver_.solve(problem, task.options);
  if (result.success() && !balls.empty()) balance_where_rolled(task, problem, result);
  if (result.success() && task_.check.enforce_torque_limits) ease_torques(task, problem, result);
  return result;
}

/// The polygon is that of the touch-down places, worked out once for all: where it will not do,
/// that of the places rolled to takes its place.
void TaskSolver::balance_where_rolled(const TransitionTask& task, TransitionProblem& problem,
                                      TransitionResult& result) {
  const double mass_kg = state_.robot().total_mass();
  for (int round = 0;; ++round) {
    state_.update(result.configuration.data());
    const std::vector<BearingContact> bearing = rolled_to(state_, task.bearing);
    const Eigen::Vector2d com = state_.center_of_mass().head<2>();
    if (balances(mass_kg, bearing, kRegionMargin, com)) return;
    if (round == kMostRolled) break;
    rolled_region_ = balance_region(mass_kg, bearing, kRegionMargin, kRolledResolution_m);
    problem.balance = &rolled_region_;
    problem.start = result.configuration;
    result = solver_.solve(problem, task.options);
    if (!result.success()) return;
  }
  result.status = PlannerStatus::kNotFound;
  result.failure = TransitionFailure::kBalance;
  result.reason = "the centre of mass outside what the contacts balance where they rolled to";
}

void TaskSolver::ease_torques(const TransitionTask& task, TransitionProblem& problem,
                              TransitionResult& result) {
  TorqueProgramme torques(state_.robot(), task.bearing, task_.check.effort_scale, kRegionMargin);
  state_.update(result.configuration.data());
  Eigen::VectorXd gradient;
  if (torques.solve(state_, gradient) <= 1.0 - task.options.torque_margin) return;
  problem.torques = &torques;
  problem.start = result.configuration;
  result = solver_.solve(problem, task.options);
}

}  // namespace locograph
