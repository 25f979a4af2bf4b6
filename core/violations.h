#pragma once
/// Which constraints of a graph are violated: by how much, in which unit, where.
///
///     for (const ConstraintViolation& v : violations(graph)) std::cerr << v.text() << '\n';
///     // EDGE_JOINT_LIMITS 4 (line 17), row 2: knee_pitch_1 upper limit exceeded by 0.012 rad
///
/// Constraints are the edges that Graph::set_constraint() marks, and those whose type hinges by
/// itself (WeightedEdge with kOneSided): limits, which are zero where they hold. Rows of weight
/// zero are no constraints. What a row is called and its unit are the type's to say (edge.h); types
/// that say nothing are listed without. Held vertices count like free ones.
///
/// Amounts of different units are compared by their tolerances, as options say.

#include <locograph/core/graph.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace locograph {

struct ConstraintViolation {
  EdgeId edge;
  std::string place;          ///< edge_text() of diagnosis.h: "EDGE_JOINT_LIMITS 4 (line 17)"
  std::string tag;            ///< of the edge's type
  std::vector<int> vertices;  ///< their ids, in the edge's order
  int line = 0;               ///< in the file the edge came from, 0 otherwise
  int row = 0;
  RowLabel label;
  /// |error|, or how far a one-sided row is beyond its limit, in label.unit. Not finite where the
  /// error is not.
  double amount = 0.0;
  double ratio = 0.0;      ///< of amount and tolerance, > 1
  bool one_sided = false;  ///< otherwise an equality

  /// One line, without its end.
  std::string text() const;
};

struct ViolationOptions {
  /// Amounts up to it do not count. In the row's unit.
  double tolerance = 1e-6;
  /// The same for single units: {{"N", 0.1}, {"N m", 0.01}}.
  std::map<std::string, double, std::less<>> tolerance_of_unit;

  /// Throws Error for a tolerance that is not positive.
  void validate() const;
};

/// At the states in the graph. Worst first, by ratio; equal ones by the order of edges and rows.
std::vector<ConstraintViolation> violations(Graph& graph, const ViolationOptions& options = {});

/// How many edges violations() looks at.
int constraint_count(const Graph& graph);

}  // namespace locograph
