#pragma once
/// Finds configurations between two stances: the contacts of the larger one closed, in balance on
/// the smaller one, within joint limits, free of collisions.
///
///     TransitionSolver solver(robot, world);
///     const TransitionProblem problem{.closed = larger.contacts, .balance = &region_of_smaller,
///                                     .start = q, .preferred = home};
///     const TransitionResult result = solver.solve(problem);
///     if (!result.success()) std::cerr << result.reason;
///
/// Wrenches are no unknowns: what a stance can balance is a polygon for the centre of mass
/// (balance_region.h), and what it asks of the joints one number with a gradient
/// (torque_programme.h). Each step minimises, over the tangent d of the configuration,
///
///   damping |d|² + pull to the preferred joints + 1e5 |c + J d|² + 1e3 Σ max(0, −(g + a d))²
///
/// with the closure c of the contacts (robots/contact_closure.h) and, linearised, everything that
/// has to be positive: distances less their margins, joints to their limits, the centre of mass to
/// the sides of the polygon. It is cut to a trust region, brought back to the contacts, and taken
/// when Σ |c| and Σ max(0, −g) come down together (an L1 merit). What is found is judged by who
/// asked (check/judge.h); this solver shares nothing with the judge.
///
/// Restarts begin from the start with what was violated moved at random. Deterministic for a seed.
/// The result depends on the arguments alone, not on what was solved before. One solver for each
/// thread; copies share what does not change.

#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/posture/transition_problem.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <memory>
#include <random>
#include <vector>

namespace locograph {

struct TransitionStatistics : PlannerStatistics {  // iterations: steps of all attempts
  int restarts = 0;
};

/// Infeasible where the contacts balance the robot nowhere. The reason of a failure: link, joint or
/// contact and amount.
struct TransitionResult : PlannerAnswer {
  Eigen::VectorXd configuration;  ///< the posture, or the best attempt
  TransitionStatistics statistics;
  TransitionFailure failure = TransitionFailure::kNone;
  double amount = 0.0;  ///< of that violation, m or rad
};

class TransitionSolver {
 public:
  /// Throws Error for a robot with a fixed base or without masses, and for collision shapes that
  /// cannot be used.
  TransitionSolver(std::shared_ptr<const RobotParameter> robot, World world);
  ~TransitionSolver();
  TransitionSolver(const TransitionSolver& other);
  TransitionSolver(TransitionSolver&&) noexcept;

  /// From now on pairs of links that are nearer than margin_m in q are kept that near, less a
  /// fifth, where more is asked for: some always are, and a start may be.
  void leave_as_near(const Eigen::VectorXd& q, double margin_m);
  /// Throws Error for contacts that are not sound and for options out of range.
  TransitionResult solve(const TransitionProblem& problem, const TransitionOptions& options = {});

  /// `q` with what was violated where the last solve ended moved at random, by `reach` of the most;
  /// where nothing was, everything.
  Eigen::VectorXd perturbed(const Eigen::VectorXd& q, double reach, std::mt19937_64& random) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace locograph
