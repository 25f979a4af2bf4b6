#pragma once
/// Takes vertices out of a graph and leaves what they knew: a dense prior on their neighbours.
///
///     optimise(graph, options, *solver);                     // the linearisation point
///     Marginalised old = marginalise(graph, {a.slot, b.slot});
///     graph.dense_prior(old.prior).information;              // on old.blanket
///
/// The edges on the vertices are linearised at the present state, with the weights of their robust
/// kernels; the vertices are eliminated by a Schur complement (Λ = H_bb − H_bm H_mm⁻¹ H_mb and the
/// same for the gradient), and they and their edges removed. The prior on the free vertices left on
/// those edges, the Markov blanket, is (x ⊟ x₀ + Λ⁻g)ᵀ Λ (x ⊟ x₀ + Λ⁻g), x₀ the present state:
/// exact for linear edges; for others to second order in x ⊟ x₀, but for the curvature of the
/// errors that Gauss-Newton neglects. Directions that no edge measures stay free (generalised
/// inverses). Fixed vertices count as constants: of the vertices taken out, and of the blanket, on
/// which the prior does not depend; freeing one later does not undo that.
///
/// The prior holds its vertices in the world, not to each other: what turns far away from x₀ is
/// pulled back, so marginalise what will not move much any more (examples/sliding_window).
///
/// Dense in the vertices taken out and their blanket: meant for a few at a time.

#include <locograph/core/graph.h>

#include <initializer_list>
#include <span>
#include <vector>

namespace locograph {

struct Marginalised {
  EdgeId prior;              ///< slot -1 when nothing is left to hold
  std::vector<int> blanket;  ///< vertex slots, ascending
  int edges_removed = 0;
  /// Least χ² of the removed edges, which the prior does not charge: for linear edges without
  /// kernels the χ² of an optimum is by this less than before.
  double constant = 0.0;
};

/// Throws Error for vertices that are not in the graph or given twice, for constraint edges on
/// them, and when an error at the present state is not a number.
Marginalised marginalise(Graph& graph, std::span<const int> vertices);
inline Marginalised marginalise(Graph& graph, std::initializer_list<int> vertices) {
  return marginalise(graph, std::span<const int>(vertices.begin(), vertices.size()));
}

}  // namespace locograph
