#pragma once
/// Finds a balanced, collision-free configuration that closes given contacts.
///
///     const PostureSolver solver(std::make_shared<const RobotParameter>(urdf, srdf, options));
///     PostureProblem problem;
///     problem.stance = load_contacts("standing.xml", solver.robot());
///     problem.preferred = placed_at(solver.robot(), home, problem.stance);
///     PostureResult result = solver.solve(problem);
///     if (!result.success()) std::cerr << result.reason;
///     else write_graph(solver.graph(problem, result), "standing.g2o");
///
/// The solver of stance planning's transitions (transition_solver.h) with one stance on both sides,
/// from the preferred configuration, then from a bounded number of seeded restarts that move what
/// was violated: the chains that collide or do not reach, the base when balance fails (the idea of
/// Rossini et al. 2021). What counts as found is decided by the judge alone (check/judge.h), never
/// by cost.
///
/// Constraints are solved with margins (PostureOptions), so that what the check asks for holds with
/// room to spare. What most postures have anyway is only asked for where one lacks it, from there
/// on: balance, where a linear programme says that the centre of mass is not over the contacts;
/// torques, and distances of links whose covering shapes overlap although the links do not, where
/// the check refuses them. Links that touch something near the ground which is not the ground, as
/// stones, are kept out of it by their exact shapes.
/// Deterministic but for the deadline, up to rounding that depends on where vectors lie in memory:
/// a program that makes the same calls gets the same bits. Thread-safe.

#include <locograph/check/judge.h>
#include <locograph/core/graph.h>
#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/posture/posture_problem.h>
#include <locograph/plugins/configuration/robot_parameters.h>

#include <filesystem>
#include <memory>

namespace locograph {

/// With the plane z = 0 as the ground, and nothing else that may be touched.
World posture_world(World in_the_way = {});

struct PostureStatistics : PlannerStatistics {  // iterations: steps of all attempts
  int restarts = 0;
  /// What contacts balance, the steps, exact geometry, balance certificates.
  double build_s = 0.0, optimise_s = 0.0, geometry_s = 0.0, balance_s = 0.0;
};

/// The reason of a failure: the worst violation of the best attempt, with amount and unit.
struct PostureResult : PlannerAnswer {
  /// The posture; without success, the best attempt.
  Eigen::VectorXd configuration;
  CheckReport report;  ///< of that configuration; its wrenches are the certificate's
  PostureStatistics statistics;
};

class PostureSolver {
 public:
  /// files: what graph() is saved with. Throws Error for a robot without a floating base, without
  /// masses, without collision shapes, or with shapes that cannot be used.
  explicit PostureSolver(std::shared_ptr<const RobotParameter> robot, World world = posture_world(),
                         const WorldFiles& files = {});
  ~PostureSolver();

  const Robot& robot() const { return *robot_->robot; }

  /// Throws Error for a stance that is not sound (robots/contact.h), a preferred configuration of
  /// the wrong size or not finite, and an effort limit that is not positive where torques are
  /// limited.
  PostureResult solve(const PostureProblem& problem, const PostureOptions& options = {}) const;

  /// The posture as a plan of one configuration, without margins: the configuration, which is also
  /// the one it stays near, its stance, the certificate's wrenches, and the edges of plan_edges.h.
  Graph graph(const PostureProblem& problem, const PostureResult& result,
              const PostureOptions& options = {}) const;

 private:
  class Solvers;

  std::shared_ptr<const RobotParameter> robot_;
  std::shared_ptr<const WorldParameter> world_;
  Judge judge_;
  std::unique_ptr<Solvers> solvers_;
};

/// `configuration` moved as a whole, so that its contact points are as near as possible to their
/// places and it stands as upright as that allows. Where there are surface contacts, by these
/// alone.
Eigen::VectorXd placed_at(const Robot& robot, const Eigen::VectorXd& configuration,
                          const Stance& stance);

}  // namespace locograph
