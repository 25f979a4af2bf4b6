#pragma once
/// Which constraints of a graph are violated: by how much, in which unit, where.
///
///     for (const ConstraintViolation& v : violations(graph)) std::cerr << v.text() << '\n';
///     // EDGE_JOINT_LIMITS 4 (line 17), row 2: knee_pitch_1 upper limit exceeded by 0.012 rad
///
/// In a loop, off a workspace that has been evaluated; nothing is computed or allocated:
///
///     const ConstraintReader reader(workspace);
///     while (reader.worst().ratio > 1.0 && optimiser.iterate()) workspace.return_to_state();
///
/// Constraints are the edges whose type says so, or that Graph::set_constraint() marks
/// (constraint.h). Rows of weight zero are no constraints. What a row is called, its unit and its
/// tolerance are the type's to say (edge.h); types that say nothing are listed without. Held
/// vertices count like free ones.
///
/// Amounts of different units are compared by their tolerances.

#include <locograph/core/all_zero.h>
#include <locograph/core/workspace.h>

#include <cmath>
#include <functional>
#include <limits>
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
  double tolerance = 0.0;  ///< in the same unit
  double ratio = 0.0;      ///< of amount and tolerance, > 1
  bool one_sided = false;  ///< otherwise an equality

  /// One line, without its end.
  std::string text() const;
};

struct ViolationOptions {
  /// Amounts up to it do not count where neither edge nor type has a tolerance. In the row's unit.
  double tolerance = 1e-6;
  /// The same for single units: {{"N", 0.1}, {"N m", 0.01}}.
  std::map<std::string, double, std::less<>> tolerance_of_unit;

  /// Throws Error for a tolerance that is not positive.
  void validate() const;
};

/// Reads the constraints of a compiled problem at the state that its workspace evaluated last. The
/// workspace must stay where it is; it may be allocated again. Does not allocate but in describe().
class ConstraintReader {
 public:
  /// A row that is not satisfied to the last bit.
  struct Row {
    int constraint = -1;  ///< of Problem::constraints(); -1: none
    int row = 0;          ///< of its edge's error
    double amount = 0.0;
    double tolerance = 0.0;
    double ratio = 0.0;          ///< of the two; infinite where the amount is not a number
    bool own_tolerance = false;  ///< of edge or type; otherwise the default
    bool one_sided = false;
  };

  explicit ConstraintReader(const Workspace& workspace,
                            double default_tolerance = ViolationOptions().tolerance)
      : workspace_(&workspace), default_tolerance_(default_tolerance) {}

  /// Calls visit(row) for every row that is off, also within its tolerance.
  template <class Visit>
  void each(Visit&& visit) const {
    const Problem& problem = workspace_->problem();
    const std::vector<double>& errors = workspace_->constraint_errors();
    for (std::size_t i = 0; i < problem.constraints().size(); ++i) {
      const CompiledConstraint& c = problem.constraints()[i];
      if (all_zero(errors.data() + c.row, c.count)) continue;
      const EdgePool& pool = *problem.graph().edge_pools()[c.pool];
      const bool one_sided = c.kind == ConstraintKind::kInequality || pool.one_sided();
      for (int r = 0; r < c.count; ++r) {
        const double e = errors[c.row + r];
        if (e == 0.0 || (one_sided && e < 0.0)) continue;
        const int index = problem.edges()[c.pool].edges[c.k];
        if (pool.weight(index, r) == 0.0) continue;
        visit(row_of(static_cast<int>(i), r, e, one_sided));
      }
    }
  }

  /// Of the rows of largest ratio the first; no constraint and ratio 0 where all hold exactly.
  Row worst() const;

  /// All about it, for people.
  ConstraintViolation describe(const Row& row) const;

 private:
  Row row_of(int constraint, int row, double error, bool one_sided) const;

  const Workspace* workspace_;
  double default_tolerance_;
};

/// At the states in the graph. Worst first, by ratio; equal ones by the order of edges and rows.
std::vector<ConstraintViolation> violations(Graph& graph, const ViolationOptions& options = {},
                                            const Bindings& bindings = {});

/// How many edges violations() looks at.
int constraint_count(const Graph& graph);

}  // namespace locograph
