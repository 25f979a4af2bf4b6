#include <locograph/common/error.h>
#include <locograph/common/thread_pool.h>
#include <locograph/planners/offline/stance/improve_stances.h>

#include <utility>
#include <vector>

namespace locograph {
namespace {

/// Stances, then how far the joints move [rad, m].
std::pair<std::size_t, double> price_of(const Task& task, const StancePlan& plan) {
  const Eigen::Index first = task.robot->robot->base_configuration_size();
  double moved = 0.0;
  for (std::size_t i = 1; i < plan.configurations.size(); ++i) {
    const Eigen::VectorXd step = plan.configurations[i] - plan.configurations[i - 1];
    moved += step.tail(step.size() - first).cwiseAbs().sum();
  }
  return {plan.stances.size(), moved};
}

void add_effort(const StanceStatistics& spent, StanceStatistics& statistics) {
  statistics.vertices_in_tree += spent.vertices_in_tree;
  statistics.iterations += spent.iterations;
  statistics.transitions += spent.transitions;
  statistics.transitions_found += spent.transitions_found;
  statistics.transitions_s += spent.transitions_s;
  statistics.judge_s += spent.judge_s;
}

}  // namespace

int improve_stances(const StancePlanner& planner, const Task& task,
                    const StancePlannerOptions& options, int threads, StancePlan& plan) {
  if (!options.termination.deadline.exists() && options.termination.stop == nullptr) {
    throw Error("plans are to be improved without end", "a deadline, or a flag that stops it");
  }
  const Stopwatch watch;
  ThreadPool pool(threads);
  std::vector<StancePlan> others(static_cast<std::size_t>(threads));
  auto best = price_of(task, plan);
  int better = 0;
  for (std::uint64_t tried = 1; plan.success() && !options.termination.ended();
       tried += static_cast<std::uint64_t>(threads)) {
    pool.run(threads, [&](int i) {
      StancePlannerOptions other = options;
      other.threads = 1;
      other.seed += 0x9e3779b97f4a7c15ULL * (tried + static_cast<std::uint64_t>(i));
      others[static_cast<std::size_t>(i)] = planner.plan(task, other);
    });
    for (StancePlan& other : others) {
      const auto price = price_of(task, other);
      const bool found = other.success() && price < best;
      add_effort((found ? plan : other).statistics, (found ? other : plan).statistics);
      if (!found) continue;
      best = price;
      other.statistics.total_s = plan.statistics.total_s;
      plan = std::move(other);
      ++better;
    }
  }
  plan.statistics.total_s += watch.seconds();
  return better;
}

}  // namespace locograph
