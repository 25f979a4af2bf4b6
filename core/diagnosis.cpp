#include <locograph/core/diagnosis.h>
#include <locograph/core/null_space.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <sstream>

namespace locograph {
namespace {

constexpr std::size_t kMostVertices = 10;
/// Edges of a type whose Jacobians are compared, and the difference that is none.
constexpr std::size_t kMostCompared = 1000;
constexpr double kSameJacobian = 1e-2;

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

/// False: the termination ended it.
bool find_free_directions(Workspace& workspace, const std::vector<int>& part_of,
                          const Termination& termination, std::vector<Diagnosis::Part>& parts) {
  const Problem& problem = workspace.problem();
  const BlockPattern& pattern = problem.pattern();
  const NullSpace null_space(workspace, termination);
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
  return null_space.complete();
}

void check_edges(Graph& graph, Diagnosis& diagnosis) {
  Eigen::MatrixXd last_good;
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (!graph.edge_alive(e)) continue;
    const Graph::EdgeRecord& record = graph.edge_record(e);
    const EdgePool& pool = *graph.edge_pools()[record.pool];
    if (pool.has_weights()) {
      double least = pool.weight(record.index, 0), most = least;
      for (int r = 1; r < pool.dimension(record.index); ++r) {
        least = std::min(least, pool.weight(record.index, r));
        most = std::max(most, pool.weight(record.index, r));
      }
      if (!(least > 1e-12 * most)) diagnosis.information.push_back({{e}, 0.0});
      continue;
    }
    Eigen::MatrixXd information = pool.information(record.index);
    // Most edges share their matrix with the one before.
    if (information.rows() == last_good.rows() && information == last_good) continue;
    const double smallest =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(information, Eigen::EigenvaluesOnly)
            .eigenvalues()[0];
    const double rounding = 1e-12 * information.cwiseAbs().maxCoeff();
    if (smallest > rounding) {
      last_good = std::move(information);
    } else {
      diagnosis.information.push_back({{e}, smallest >= -rounding ? 0.0 : smallest});
    }
  }
}

/// By pool and index in it.
std::vector<std::vector<int>> slots_of_edges(const Graph& graph) {
  std::vector<std::vector<int>> slots(graph.edge_pools().size());
  for (std::size_t p = 0; p < slots.size(); ++p) slots[p].resize(graph.edge_pools()[p]->size());
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (!graph.edge_alive(e)) continue;
    const Graph::EdgeRecord& record = graph.edge_record(e);
    slots[record.pool][record.index] = e;
  }
  return slots;
}

std::vector<EdgeId> edges_without_numbers(Workspace& workspace) {
  const Problem& problem = workspace.problem();
  const Graph& graph = problem.graph();
  std::vector<EdgeId> found;
  const std::vector<std::vector<int>> slot_of = slots_of_edges(graph);
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

/// Largest difference over the largest entry. A row without error of a hinged edge has no
/// derivative to compare.
double difference_of(const EdgePool& pool, const Eigen::VectorXd& error, Eigen::MatrixXd used,
                     Eigen::MatrixXd expected) {
  for (Eigen::Index row = 0; pool.one_sided() && row < error.size(); ++row) {
    if (error[row] != 0.0) continue;
    used.row(row).setZero();
    expected.row(row).setZero();
  }
  const double largest =
      std::max(used.lpNorm<Eigen::Infinity>(), expected.lpNorm<Eigen::Infinity>());
  const double difference = (used - expected).lpNorm<Eigen::Infinity>();
  return difference == 0.0 ? 0.0 : difference / largest;
}

std::vector<Diagnosis::WrongJacobian> wrong_jacobians(Workspace& workspace,
                                                      const Termination& termination) {
  const Problem& problem = workspace.problem();
  const Graph& graph = problem.graph();
  const std::vector<std::vector<int>> slot_of = slots_of_edges(graph);
  std::vector<std::unique_ptr<DerivedStore>> derived;
  for (std::size_t p = 0; p < problem.active().size(); ++p) {
    const VertexPool& pool = *graph.vertex_pools()[p];
    derived.push_back(pool.make_derived(problem.active()[p]));
    if (derived.back()) {
      pool.derive(problem.active()[p], workspace.state().data(), *derived.back());
    }
  }
  Scratch scratch;
  scratch.reserve(problem.scratch_bytes());
  Evaluation x{workspace.state().data(), derived, &scratch};
  x.bindings = &workspace.bindings();
  std::vector<Diagnosis::WrongJacobian> found;
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    const EdgePool& pool = *graph.edge_pools()[p];
    const CompiledEdges& edges = problem.edges()[p];
    const std::size_t count = edges.edges.size(), stride = 1 + count / kMostCompared;
    Diagnosis::WrongJacobian worst;
    for (std::size_t i = 0; i < count && !termination.ended(); i += stride) {
      const int k = static_cast<int>(i);
      Eigen::VectorXd error(pool.dimension(edges.edges[k]));
      pool.error(edges, k, x, error.data());
      for (int slot = 0; slot < edges.slot_begin[k + 1] - edges.slot_begin[k]; ++slot) {
        if (edges.slots[edges.slot_begin[k] + slot].tangent_offset < 0) continue;
        const double difference =
            difference_of(pool, error, pool.jacobian(edges, k, slot, x, false),
                          pool.jacobian(edges, k, slot, x, true));
        if (difference > worst.difference) worst = {{slot_of[p][edges.edges[k]]}, slot, difference};
      }
    }
    if (worst.difference > kSameJacobian) found.push_back(worst);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.difference > b.difference; });
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
  return complete && free_directions() == 0 && not_finite.empty() && jacobians.empty() &&
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
  for (std::size_t i = 0; i < std::min(jacobians.size(), kMostLines); ++i) {
    out << "the Jacobian of " << edge_text(graph, jacobians[i].edge) << " by its vertex "
        << vertex_text(graph, graph.edge_vertices(jacobians[i].edge.slot)[jacobians[i].slot])
        << " is not the derivative of its error: it differs from numeric differences by "
        << 100.0 * jacobians[i].difference << " %\n";
  }
  std::size_t lines = 0;
  for (const BadInformation& bad : information) {
    if (lines++ == kMostLines) break;
    out << "the information matrix of " << edge_text(graph, bad.edge)
        << (bad.smallest_eigenvalue < 0.0 ? " is indefinite" : " is singular")
        << " (smallest eigenvalue " << bad.smallest_eigenvalue << ")\n";
  }
  if (!complete) out << "the diagnosis was ended before it had looked at everything\n";
  return out.str();
}

Diagnosis diagnose(Graph& graph, const Bindings& bindings, const Termination& termination) {
  Diagnosis diagnosis;
  const std::vector<Component> parts = components(graph);
  for (const Component& part : parts) diagnosis.parts.push_back({part, 0, {}});
  check_edges(graph, diagnosis);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.bind(bindings);
  workspace.load_state();
  if (!std::isfinite(workspace.evaluate(workspace.state()).robust)) {
    diagnosis.not_finite = edges_without_numbers(workspace);
    return diagnosis;
  }
  diagnosis.jacobians = wrong_jacobians(workspace, termination);
  workspace.linearise();
  diagnosis.complete =
      find_free_directions(workspace, part_of_slot(graph, parts), termination, diagnosis.parts);
  return diagnosis;
}

}  // namespace locograph
