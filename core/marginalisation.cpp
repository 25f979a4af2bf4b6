#include <locograph/core/information.h>
#include <locograph/core/marginalisation.h>
#include <locograph/core/workspace.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// A generalised inverse (A A⁻ A = A) of a symmetric positive semi-definite matrix, which is scaled
/// to a unit diagonal before its null space is told from its weak directions.
Eigen::MatrixXd generalised_inverse(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return a;
  Eigen::VectorXd scale(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    scale[i] = a(i, i) > 0.0 ? 1.0 / std::sqrt(a(i, i)) : 1.0;
  }
  const Eigen::MatrixXd unit = scale.asDiagonal() * a * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit);
  Eigen::VectorXd inverse = eigen.eigenvalues();
  for (double& value : inverse) value = value > 1e-11 ? 1.0 / value : 0.0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * eigen.eigenvectors();
  return scaled * inverse.asDiagonal() * scaled.transpose();
}

/// All edges on the vertices.
std::vector<int> edges_on(const Graph& graph, std::span<const int> vertices) {
  std::vector<int> edges;
  for (const int v : vertices) {
    edges.insert(edges.end(), graph.incident_edges(v).begin(), graph.incident_edges(v).end());
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const int e : edges) {
    if (graph.edge_record(e).constraint != ConstraintKind::kNone) {
      throw Error("a constraint edge on a vertex to marginalise", "ordinary edges");
    }
  }
  return edges;
}

/// The linearised edges as one dense system: rows of the vertices to take out first.
struct LocalSystem {
  LocalSystem(Workspace& workspace, std::span<const int> taken) {
    const Problem& problem = workspace.problem();
    const BlockPattern& pattern = problem.pattern();
    std::vector<int> row_of_block(pattern.size());
    for (int b = 0; b < pattern.size(); ++b) {
      const int v = problem.free_vertices()[b];
      if (std::find(taken.begin(), taken.end(), v) == taken.end()) {
        blanket.push_back(v);
      } else {
        row_of_block[b] = taken_rows;
        taken_rows += pattern.dimension[b];
      }
    }
    std::sort(blanket.begin(), blanket.end());
    int next = taken_rows;
    for (const int v : blanket) {
      const auto found =
          std::find(problem.free_vertices().begin(), problem.free_vertices().end(), v);
      const auto b = found - problem.free_vertices().begin();
      row_of_block[b] = next;
      next += pattern.dimension[b];
    }
    hessian.setZero(next, next);
    gradient.setZero(next);
    for (int c = 0; c < pattern.size(); ++c) {
      const int columns = pattern.dimension[c], column = row_of_block[c];
      gradient.segment(column, columns) = Eigen::Map<const Eigen::VectorXd>(
          workspace.gradient().data() + pattern.scalar_begin[c], columns);
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const int rows = pattern.dimension[pattern.row[k]], row = row_of_block[pattern.row[k]];
        const Eigen::Map<const Eigen::MatrixXd> block(
            workspace.hessian().data() + pattern.value_offset[k], rows, columns);
        hessian.block(row, column, rows, columns) = block;
        hessian.block(column, row, columns, rows) = block.transpose();
      }
    }
  }

  std::vector<int> blanket;
  int taken_rows = 0;
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
};

void check_vertices(const Graph& graph, std::span<const int> vertices) {
  std::vector<int> sorted(vertices.begin(), vertices.end());
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (sorted[i] < 0 || sorted[i] >= graph.vertex_slots() || !graph.vertex_alive(sorted[i])) {
      throw Error("a vertex to marginalise is not in the graph");
    }
    if (i > 0 && sorted[i] == sorted[i - 1]) {
      throw Error("vertex " + std::to_string(graph.vertex_record(sorted[i]).id) +
                      " is to be marginalised twice",
                  "different vertices");
    }
  }
}

}  // namespace

Marginalised marginalise(Graph& graph, std::span<const int> vertices) {
  check_vertices(graph, vertices);
  const std::vector<int> edges = edges_on(graph, vertices);
  Problem problem;
  problem.compile_on(graph, edges);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const Cost cost = workspace.evaluate(workspace.state());
  if (!std::isfinite(cost.robust)) {
    throw Error("an edge on a vertex to marginalise has an error that is not a number",
                "finite errors");
  }
  workspace.linearise();
  const LocalSystem system(workspace, vertices);
  const Eigen::Index m = system.taken_rows, b = system.hessian.rows() - m;
  const Eigen::MatrixXd inverse = generalised_inverse(system.hessian.topLeftCorner(m, m));
  const Eigen::MatrixXd gain = inverse * system.hessian.topRightCorner(m, b);
  const Eigen::VectorXd gradient =
      system.gradient.tail(b) - gain.transpose() * system.gradient.head(m);

  Marginalised result;
  result.blanket = system.blanket;
  result.edges_removed = static_cast<int>(edges.size());
  DensePrior prior;
  prior.information =
      system.hessian.bottomRightCorner(b, b) - system.hessian.bottomLeftCorner(b, m) * gain;
  prior.information = (0.5 * (prior.information + prior.information.transpose())).eval();
  if (!is_positive_semidefinite(prior.information)) {
    prior.information = nearest_positive_semidefinite(prior.information);
  }
  prior.offset = generalised_inverse(prior.information) * gradient;
  result.constant = cost.chi2 - gradient.dot(prior.offset) -
                    system.gradient.head(m).dot(inverse * system.gradient.head(m));
  for (const int v : result.blanket) {
    prior.vertices.push_back(v);
    prior.states.insert(prior.states.end(), graph.state(v), graph.state(v) + graph.state_size(v));
  }
  for (const int v : vertices) graph.remove_vertex(v);
  if (!prior.vertices.empty()) result.prior = graph.add_dense_prior(std::move(prior));
  return result;
}

}  // namespace locograph
