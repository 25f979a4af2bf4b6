#pragma once
/// Loop closures that nothing confirms: which measurements of a pose graph to leave out at first.
///
///     std::vector<int> odometry = odometry_edges(graph);
///     std::vector<int> doubted = doubtful_closures(graph, odometry);
///     guess_chordal(graph, *solver, doubted);
///     optimise_graduated(graph, options, *solver, odometry, doubted);
///
/// Looks at measurements around short cycles only, never at the states: no initial guess can spoil
/// it. Around a cycle of right measurements the motions compose to the identity, up to their
/// covariances (first order, Smith & Cheeseman 1986, "On the representation and estimation of
/// spatial uncertainty"). A cycle passes when the squared Mahalanobis distance of what is left is
/// below a quantile of χ², and it tells something only if a wrong closure would hardly pass by
/// accident: if the ellipsoid of what passes is small within the map.
///
///  1. Pairs: a closure and another one close to it at both ends, tied by trusted edges (pairwise
///     consistency, Mangelson et al. 2018). Confirmed is what passes more often than not.
///  2. Growth: a closure and the shortest path of trusted and confirmed edges between its ends,
///     short paths first, until none is confirmed any more.
///
/// Judged are the relative poses (EDGE_SE2, EDGE_SE3:QUAT and both _OFFSET forms, Ω positive
/// definite) that are not trusted. Doubted is what is not confirmed, unless it ties parts that
/// nothing else does: leaving the doubted edges out disconnects nothing. Without trusted edges
/// nothing is doubted. Wrong closures that agree with each other (a run of them) can be confirmed,
/// and where every fifth closure is wrong and odometry is poor enough of them agree by accident
/// (doc/benchmarks.md): keep a robust kernel or graduated non-convexity afterwards.

#include <locograph/core/graph.h>

#include <span>
#include <vector>

namespace locograph {

struct ConsistencyOptions {
  /// Probability that every right closure passes a test; shared out among them (Bonferroni).
  double inlier_probability = 0.99;
  /// Most probability that a wrong closure passes a test, its error being anywhere in the map.
  double accident_probability = 0.01;
  /// How far apart, in trusted edges, the ends of two closures of a pair may lie.
  int pair_steps = 5;
  /// Longest path of the growth, in edges.
  int path_steps = 40;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// Slots of the doubted edges, ascending. `trusted` are edge slots. Deterministic.
std::vector<int> doubtful_closures(const Graph& graph, std::span<const int> trusted,
                                   const ConsistencyOptions& options = {});

}  // namespace locograph
