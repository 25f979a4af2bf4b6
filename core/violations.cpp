#include <locograph/common/check_option.h>
#include <locograph/core/diagnosis.h>
#include <locograph/core/violations.h>

#include <algorithm>
#include <sstream>

namespace locograph {
namespace {

std::vector<int> constraint_slots(const Graph& graph) {
  std::vector<int> slots;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (graph.edge_alive(slot) && graph.edge_record(slot).constraint != ConstraintKind::kNone) {
      slots.push_back(slot);
    }
  }
  return slots;
}

/// Not a number counts as more than any number.
double ratio_of(double amount, double tolerance) {
  const double ratio = amount / tolerance;
  return std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
}

}  // namespace

std::string ConstraintViolation::text() const {
  std::ostringstream out;
  out << place << ", row " << row << ": ";
  if (!label.name.empty()) out << label.name << ' ';
  out << (one_sided ? "exceeded by " : "off by ") << amount;
  if (!label.unit.empty()) out << ' ' << label.unit;
  return out.str();
}

void ViolationOptions::validate() const {
  check_option(tolerance > 0.0, "tolerance", "a positive number");
  for (const auto& [unit, value] : tolerance_of_unit) {
    check_option(value > 0.0, "tolerance_of_unit", "positive numbers");
  }
}

ConstraintReader::Row ConstraintReader::row_of(int constraint, int row, double error,
                                               bool one_sided) const {
  const Problem& problem = workspace_->problem();
  const CompiledConstraint& c = problem.constraints()[constraint];
  double tolerance = problem.graph().edge_record(c.edge).tolerance;
  if (tolerance == 0.0) {
    tolerance =
        problem.graph().edge_pools()[c.pool]->row_tolerance(problem.edges()[c.pool], c.k, row);
  }
  Row result;
  result.constraint = constraint;
  result.row = row;
  result.amount = std::abs(error);
  result.own_tolerance = tolerance > 0.0;
  result.tolerance = result.own_tolerance ? tolerance : default_tolerance_;
  result.ratio = ratio_of(result.amount, result.tolerance);
  result.one_sided = one_sided;
  return result;
}

ConstraintReader::Row ConstraintReader::worst() const {
  Row worst;
  each([&worst](const Row& row) {
    if (row.ratio > worst.ratio) worst = row;
  });
  return worst;
}

ConstraintViolation ConstraintReader::describe(const Row& row) const {
  const Problem& problem = workspace_->problem();
  const Graph& graph = problem.graph();
  const CompiledConstraint& c = problem.constraints()[row.constraint];
  const EdgePool& pool = *graph.edge_pools()[c.pool];
  ConstraintViolation violation;
  violation.edge = {c.edge};
  violation.place = edge_text(graph, {c.edge});
  violation.tag = pool.tag();
  for (const int v : graph.edge_vertices(c.edge)) {
    violation.vertices.push_back(graph.vertex_record(v).id);
  }
  violation.line = graph.edge_record(c.edge).line;
  violation.row = row.row;
  violation.label = pool.row_label(problem.edges()[c.pool], c.k, row.row);
  violation.amount = row.amount;
  violation.tolerance = row.tolerance;
  violation.ratio = row.ratio;
  violation.one_sided = row.one_sided;
  return violation;
}

std::vector<ConstraintViolation> violations(Graph& graph, const ViolationOptions& options,
                                            const Bindings& bindings) {
  options.validate();
  const std::vector<int> slots = constraint_slots(graph);
  std::vector<ConstraintViolation> found;
  if (slots.empty()) return found;
  Problem problem;
  problem.compile_on(graph, slots);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.bind(bindings);
  workspace.load_state();
  workspace.evaluate(workspace.state());

  const ConstraintReader reader(workspace, options.tolerance);
  reader.each([&](ConstraintReader::Row row) {
    if (!row.own_tolerance && !options.tolerance_of_unit.empty()) {
      const CompiledConstraint& c = problem.constraints()[row.constraint];
      const EdgePool& pool = *graph.edge_pools()[c.pool];
      const auto of_unit = options.tolerance_of_unit.find(
          pool.row_label(problem.edges()[c.pool], c.k, row.row).unit);
      if (of_unit != options.tolerance_of_unit.end()) row.tolerance = of_unit->second;
      row.ratio = ratio_of(row.amount, row.tolerance);
    }
    if (row.ratio > 1.0) found.push_back(reader.describe(row));
  });
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    if (a.ratio != b.ratio) return a.ratio > b.ratio;
    return a.edge.slot != b.edge.slot ? a.edge.slot < b.edge.slot : a.row < b.row;
  });
  return found;
}

int constraint_count(const Graph& graph) {
  return static_cast<int>(constraint_slots(graph).size());
}

}  // namespace locograph
