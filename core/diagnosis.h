#pragma once
/// Why a graph cannot be solved: parts that float, directions nothing measures, bad information,
/// Jacobians that are not the derivatives of their errors.
///
///     Diagnosis diagnosis = diagnose(graph);
///     if (!diagnosis.healthy()) std::cerr << diagnosis.text(graph);
///
/// Free directions are the null space of H = JᵀΩJ (null_space.h) at the present state, of the
/// vertices that are not fixed. Allocates.

#include <locograph/common/termination.h>
#include <locograph/core/connectivity.h>
#include <locograph/core/graph.h>

#include <string>
#include <vector>

namespace locograph {

struct Diagnosis {
  /// How much of a vertex the null space moves: the trace of its block of the projector, from 0 to
  /// the vertex's dimension.
  struct LooseVertex {
    int vertex = -1;  ///< slot
    double share = 0.0;
  };
  struct Part {
    Component component;
    int free_directions = 0;
    std::vector<LooseVertex> loosest;  ///< at most ten, the loosest first
  };
  struct BadInformation {
    EdgeId edge;
    double smallest_eigenvalue = 0.0;  ///< < 0: indefinite, 0: rows that count nothing
  };
  /// The Jacobian of an edge by one of its vertices, against central differences.
  struct WrongJacobian {
    EdgeId edge;
    int slot = 0;             ///< of its vertices
    double difference = 0.0;  ///< the largest, over the largest entry of the two
  };

  std::vector<Part> parts;                  ///< unconnected parts, by their first vertex
  std::vector<EdgeId> not_finite;           ///< edges whose error is no number at this state
  std::vector<BadInformation> information;  ///< matrices that are not positive definite
  /// Those that differ by more than a hundredth: of each type of edge the one that does most, the
  /// worst first.
  std::vector<WrongJacobian> jacobians;
  /// False: the termination ended it before Jacobians and free directions were all looked at.
  bool complete = true;

  int free_directions() const;
  /// Everything was looked at: nothing is free, every error a number, no information indefinite, no
  /// Jacobian wrong.
  bool healthy() const;
  /// A few lines, each ended by a newline; empty for a healthy graph in one part.
  std::string text(const Graph& graph) const;
};

/// Does not change the graph.
Diagnosis diagnose(Graph& graph, const Bindings& bindings = {},
                   const Termination& termination = {});

/// "EDGE_SE2 3 4 (line 17)", for messages.
std::string edge_text(const Graph& graph, EdgeId edge);

}  // namespace locograph
