#include <locograph/core/diagnosis.h>
#include <locograph/core/null_space.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace locograph {
namespace {

constexpr std::size_t kMostVertices = 10;

/// Part of each vertex slot, -1 for removed ones.
std::vector<int> part_of_slot(const Graph& graph, const std::vector<Component>& parts) {
  std::vector<int> part(graph.vertex_slots(), -1);
  std::vector<int> stack;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    stack.assign(1, parts[p].first);
    part[parts[p].first] = static_cast<int>(p);
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      for (const int e : graph.incident_edges(v)) {
        for (const int other : graph.edge_vertices(e)) {
          if (part[other] >= 0) continue;
          part[other] = static_cast<int>(p);
          stack.push_back(other);
        }
      }
    }
  }
  return part;
}

void find_free_directions(Workspace& workspace, const std::vector<int>& part_of,
                          std::vector<Diagnosis::Part>& parts) {
  const Problem& problem = workspace.problem();
  const BlockPattern& pattern = problem.pattern();
  const NullSpace null_space(workspace);
  // Held vertices may cut a part into several that H does not tie together.
  for (const NullSpace::Part& loose : null_space.parts()) {
    Diagnosis::Part& part = parts[part_of[problem.free_vertices()[loose.blocks[0]]]];
    const Eigen::Index count = loose.directions.cols();
    part.free_directions += static_cast<int>(count);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(loose.directions);
    const Eigen::MatrixXd basis =
        qr.householderQ() * Eigen::MatrixXd::Identity(loose.directions.rows(), count);
    Eigen::Index row = 0;
    for (const int b : loose.blocks) {
      const double share = basis.middleRows(row, pattern.dimension[b]).squaredNorm();
      if (share > 1e-6) part.loosest.push_back({problem.free_vertices()[b], share});
      row += pattern.dimension[b];
    }
  }
  for (Diagnosis::Part& part : parts) {
    // Rounding must not decide between vertices that are equally loose.
    std::stable_sort(part.loosest.begin(), part.loosest.end(), [](const auto& a, const auto& b) {
      return std::round(a.share * 1e6) > std::round(b.share * 1e6);
    });
    if (part.loosest.size() > kMostVertices) part.loosest.resize(kMostVertices);
  }
}

void check_edges(Graph& graph, Diagnosis& diagnosis) {
  Eigen::MatrixXd last_good;
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (!graph.edge_alive(e)) continue;
    const Graph::EdgeRecord& record = graph.edge_record(e);
    const EdgePool& pool = *graph.edge_pools()[record.pool];
    Eigen::MatrixXd information = pool.information(record.index);
    // Most edges share their matrix with the one before.
    if (information.rows() == last_good.rows() && information == last_good) continue;
    const double smallest = pool.has_weights() ? information.diagonal().minCoeff()
                                               : Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                                     information, Eigen::EigenvaluesOnly)
                                                     .eigenvalues()[0];
    const double rounding = 1e-12 * information.cwiseAbs().maxCoeff();
    if (smallest > rounding) {
      last_good = std::move(information);
    } else {
      diagnosis.information.push_back({{e}, smallest >= -rounding ? 0.0 : smallest});
    }
  }
}

std::vector<EdgeId> edges_without_numbers(Workspace& workspace) {
  const Problem& problem = workspace.problem();
  const Graph& graph = problem.graph();
  std::vector<EdgeId> found;
  std::vector<std::vector<int>> slot_of(problem.edges().size());
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (!graph.edge_alive(e)) continue;
    const Graph::EdgeRecord& record = graph.edge_record(e);
    std::vector<int>& slots = slot_of[record.pool];
    if (static_cast<int>(slots.size()) <= record.index) slots.resize(record.index + 1);
    slots[record.index] = e;
  }
  Eigen::VectorXd error;
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    const CompiledEdges& compiled = problem.edges()[p];
    for (std::size_t k = 0; k < compiled.edges.size(); ++k) {
      error.resize(graph.edge_pools()[p]->dimension(compiled.edges[k]));
      workspace.error(static_cast<int>(p), static_cast<int>(k), error.data());
      if (!error.allFinite()) found.push_back({slot_of[p][compiled.edges[k]]});
    }
  }
  return found;
}

std::string vertex_text(const Graph& graph, int slot) {
  return std::to_string(graph.vertex_record(slot).id);
}

}  // namespace

std::string edge_text(const Graph& graph, EdgeId edge) {
  const Graph::EdgeRecord& record = graph.edge_record(edge.slot);
  std::string text = graph.edge_pools()[record.pool]->tag();
  for (const int v : graph.edge_vertices(edge.slot)) {
    text += ' ';
    text += vertex_text(graph, v);
  }
  if (record.line > 0) text += " (line " + std::to_string(record.line) + ")";
  return text;
}

int Diagnosis::free_directions() const {
  return std::accumulate(parts.begin(), parts.end(), 0,
                         [](int sum, const Part& part) { return sum + part.free_directions; });
}

bool Diagnosis::healthy() const {
  return free_directions() == 0 && not_finite.empty() &&
         std::none_of(information.begin(), information.end(),
                      [](const BadInformation& bad) { return bad.smallest_eigenvalue < 0.0; });
}

std::string Diagnosis::text(const Graph& graph) const {
  std::ostringstream out;
  constexpr std::size_t kMostLines = 10;
  if (parts.size() > 1) {
    out << "the graph is in " << parts.size() << " unconnected parts\n";
    for (std::size_t p = 0; p < std::min(parts.size(), kMostLines); ++p) {
      const Component& part = parts[p].component;
      out << "  part " << p + 1 << ": vertex " << vertex_text(graph, part.first) << " and "
          << part.vertices - 1 << " more" << (part.anchored ? "" : ", held by nothing") << '\n';
    }
  }
  for (std::size_t p = 0, lines = 0; p < parts.size() && lines < kMostLines; ++p) {
    const Part& part = parts[p];
    if (part.free_directions == 0) continue;
    ++lines;
    out << part.free_directions
        << (part.free_directions == 1 ? " direction is free" : " directions are free");
    if (parts.size() > 1) out << " in part " << p + 1;
    out << ", mostly at";
    for (std::size_t i = 0; i < std::min<std::size_t>(part.loosest.size(), 5); ++i) {
      out << (i == 0 ? " vertex " : ", ") << vertex_text(graph, part.loosest[i].vertex) << " ("
          << graph.vertex_tag(part.loosest[i].vertex) << ')';
    }
    out << '\n';
  }
  for (std::size_t i = 0; i < std::min(not_finite.size(), kMostLines); ++i) {
    out << "the error of " << edge_text(graph, not_finite[i]) << " is not a number\n";
  }
  std::size_t lines = 0;
  for (const BadInformation& bad : information) {
    if (lines++ == kMostLines) break;
    out << "the information matrix of " << edge_text(graph, bad.edge)
        << (bad.smallest_eigenvalue < 0.0 ? " is indefinite" : " is singular")
        << " (smallest eigenvalue " << bad.smallest_eigenvalue << ")\n";
  }
  return out.str();
}

Diagnosis diagnose(Graph& graph) {
  Diagnosis diagnosis;
  const std::vector<Component> parts = components(graph);
  for (const Component& part : parts) diagnosis.parts.push_back({part, 0, {}});
  check_edges(graph, diagnosis);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  if (!std::isfinite(workspace.evaluate(workspace.state()).robust)) {
    diagnosis.not_finite = edges_without_numbers(workspace);
    return diagnosis;
  }
  workspace.linearise();
  find_free_directions(workspace, part_of_slot(graph, parts), diagnosis.parts);
  return diagnosis;
}

}  // namespace locograph
