#include <locograph/core/diagnosis.h>
#include <locograph/core/violations.h>
#include <locograph/core/workspace.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace locograph {
namespace {

std::vector<int> constraint_slots(const Graph& graph) {
  std::vector<int> slots;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (!graph.edge_alive(slot)) continue;
    const Graph::EdgeRecord& record = graph.edge_record(slot);
    if (record.constraint != ConstraintKind::kNone ||
        graph.edge_pools()[record.pool]->one_sided()) {
      slots.push_back(slot);
    }
  }
  return slots;
}

/// The slots by pool and index there.
std::vector<std::vector<int>> by_pool(const Graph& graph, const std::vector<int>& slots) {
  std::vector<std::vector<int>> slot_of(graph.edge_pools().size());
  for (std::size_t p = 0; p < slot_of.size(); ++p) slot_of[p].resize(graph.edge_pools()[p]->size());
  for (const int slot : slots) {
    slot_of[graph.edge_record(slot).pool][graph.edge_record(slot).index] = slot;
  }
  return slot_of;
}

double tolerance_of(const RowLabel& label, const ViolationOptions& options) {
  const auto found = options.tolerance_of_unit.find(label.unit);
  return found == options.tolerance_of_unit.end() ? options.tolerance : found->second;
}

ConstraintViolation describe(const Graph& graph, int slot) {
  const Graph::EdgeRecord& record = graph.edge_record(slot);
  ConstraintViolation violation;
  violation.edge = {slot};
  violation.place = edge_text(graph, {slot});
  violation.tag = graph.edge_pools()[record.pool]->tag();
  for (const int v : graph.edge_vertices(slot)) {
    violation.vertices.push_back(graph.vertex_record(v).id);
  }
  violation.line = record.line;
  return violation;
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
  const auto check = [](double value) {
    if (!(value > 0.0)) {
      throw Error("a tolerance of " + std::to_string(value), "a positive number");
    }
  };
  check(tolerance);
  for (const auto& [unit, value] : tolerance_of_unit) check(value);
}

std::vector<ConstraintViolation> violations(Graph& graph, const ViolationOptions& options) {
  options.validate();
  const std::vector<int> slots = constraint_slots(graph);
  std::vector<ConstraintViolation> found;
  if (slots.empty()) return found;
  Problem problem;
  problem.compile_on(graph, slots);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());

  const std::vector<std::vector<int>> slot_of = by_pool(graph, slots);
  Eigen::VectorXd e;
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    const CompiledEdges& compiled = problem.edges()[p];
    const EdgePool& pool = *graph.edge_pools()[p];
    for (std::size_t k = 0; k < compiled.edges.size(); ++k) {
      const int index = compiled.edges[k], slot = slot_of[p][index];
      const ConstraintKind kind = graph.edge_record(slot).constraint;
      const bool one_sided = kind == ConstraintKind::kInequality || pool.one_sided();
      Eigen::MatrixXd information;  // n × n: only of edges that are violated
      e.resize(pool.dimension(index));
      workspace.error(static_cast<int>(p), static_cast<int>(k), e.data());
      for (int row = 0; row < e.size(); ++row) {
        if (e[row] == 0.0 || (one_sided && e[row] < 0.0)) continue;
        if (information.size() == 0) information = pool.information(index);
        if (information(row, row) == 0.0) continue;
        RowLabel label = pool.row_label(compiled, static_cast<int>(k), row);
        const double amount = std::abs(e[row]);
        const double ratio = amount / tolerance_of(label, options);
        if (ratio <= 1.0) continue;
        ConstraintViolation violation = describe(graph, slot);
        violation.row = row;
        violation.label = std::move(label);
        violation.amount = amount;
        violation.ratio = std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
        violation.one_sided = one_sided;
        found.push_back(std::move(violation));
      }
    }
  }
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
