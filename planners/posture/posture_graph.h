#pragma once
/// The graph that a posture is the optimum of, and which of its rows are violated.
///
///     PostureGraph posture(robot, seen, problem, options, shapes);
///     posture.set_start(problem.preferred);
///     Problem compiled;
///     compiled.compile(posture.graph);
///     Workspace workspace;
///     workspace.allocate(compiled);
///     workspace.load_state();
///     workspace.evaluate(workspace.state());
///     WatchedRows rows = posture.watch(compiled);
///     double worst = rows.worst(workspace);                // 1: the worst row is at its tolerance
///
/// Its constraints and their tolerances are in the graph, for core/violations.h to read. Weights
/// make one unit of violation count alike: 0.01 of m, rad or the robot's weight. Those of the
/// preferred configuration and of the wrenches' size are so small that they move a constraint by
/// micrometres only.

#include <locograph/core/violations.h>
#include <locograph/planners/posture/posture_problem.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/ground_distance/edge_link_height.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

#include <vector>

namespace locograph {

/// What may have to move to get rid of a violation.
struct Violated {
  bool base = false;
  std::vector<bool> joints;  ///< by active joint
};

/// The rows of a posture's constraints, at the state evaluated last.
class WatchedRows {
 public:
  enum class Kind { kContact, kJoints, kSelf, kSpheres, kBalance, kWrenches, kTorques };

  /// The largest violation, in tolerances.
  double worst(const Workspace& workspace) const;
  /// What the rows above their tolerance depend on.
  Violated violated(const Workspace& workspace) const;

 private:
  friend class PostureGraph;
  struct Edge {
    Kind kind;
    int link;  ///< of a contact
  };

  std::shared_ptr<const RobotParameter> robot_;
  std::vector<int> loaded_links_;
  std::vector<Edge> edges_;  ///< of the problem's constraints
};

/// What is worked out once for a robot.
struct PostureShapes {
  std::vector<bool> coarse_pairs;                         ///< without weight in self-collision
  std::vector<std::shared_ptr<const LinkSolids>> solids;  ///< of each link
};

class PostureGraph {
 public:
  /// seen: what is in the way, as edges see it.
  PostureGraph(std::shared_ptr<const RobotParameter> robot,
               std::shared_ptr<const WorldParameter> seen, const PostureProblem& problem,
               const PostureOptions& options, const PostureShapes& shapes);

  /// The configuration, and wrenches that share the weight evenly among the contacts.
  void set_start(const Eigen::VectorXd& configuration);
  /// wrenches: 6 numbers for each contact of the stance; empty: as they are.
  void set(const Eigen::VectorXd& configuration, const StanceWrenches& wrenches);
  Eigen::VectorXd configuration() const;

  WatchedRows watch(const Problem& compiled) const;

  Graph graph;

 private:
  void add_parameters(std::shared_ptr<const WorldParameter> seen, const PostureProblem& problem,
                      const PostureOptions& options);
  void add_contact_edges();
  void add_balance_edges(const PostureOptions& options);
  void add_collision_edges(const PostureProblem& problem, const PostureOptions& options,
                           const PostureShapes& shapes);
  void keep_touching_above_ground(const PostureProblem& problem, const PostureOptions& options,
                                  const PostureShapes& shapes);
  template <class E, class... Vertices>
  void constrain(WatchedRows::Kind kind, E edge, double tolerance, int link, Vertices... vertices);

  struct Constraint {
    WatchedRows::Kind kind;
    EdgeId edge;
    int link;
  };

  std::shared_ptr<const RobotParameter> robot_;
  double weight_N_;
  VertexId<VertexConfiguration> q_;
  VertexId<VertexWrenches> w_;
  bool seen_ = false;  ///< there is something in the way
  std::optional<double> ground_z_m_;
  int stance_number_ = kNoStance;
  std::vector<int> contact_numbers_;
  std::vector<std::size_t> loaded_;  ///< which of them bear load
  std::vector<int> wrench_numbers_;
  std::vector<Eigen::Matrix3d> wrench_axes_;  ///< in the world, once closed
  std::vector<int> loaded_links_;
  std::vector<Constraint> constraints_;
};

}  // namespace locograph
