#include <locograph/core/covariance.h>
#include <locograph/core/null_space.h>
#include <locograph/core/workspace.h>

#include <cmath>
#include <cstdint>

namespace locograph {

namespace {

/// Solves for a right-hand side of the size of H's diagonal.
bool solution_explodes(const LinearSolver& solver, Workspace& workspace) {
  constexpr double kSuspicious = 1e7;
  std::vector<double> diagonal(workspace.problem().dimension());
  workspace.diagonal(diagonal);
  std::vector<double>& x = workspace.step();
  for (std::size_t i = 0; i < x.size(); ++i) {
    // Signs without a pattern that a null space could be orthogonal to.
    const std::uint64_t hash = (i + 1) * 0x9e3779b97f4a7c15u;
    x[i] = std::sqrt(diagonal[i]) * ((hash >> 40 & 1) != 0 ? 1.0 : -1.0);
  }
  solver.solve(x.data(), x.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(std::abs(x[i]) * std::sqrt(diagonal[i]) < kSuspicious)) return true;
  }
  return false;
}

}  // namespace

Covariance::Covariance(Graph& graph, std::unique_ptr<LinearSolver> solver)
    : solver_(std::move(solver)) {
  if (!solver_) throw Error("a covariance has no solver", "one of make_linear_solver()");
  Problem problem;
  problem.compile(graph);
  pattern_ = problem.pattern();
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    vertices_.push_back({graph.vertex_record(slot).id,
                         graph.vertex_alive(slot) ? VertexRow::kHeld : VertexRow::kNotThere});
  }
  for (int row = 0; row < pattern_.size(); ++row) {
    vertices_[problem.free_vertices()[row]].row = row;
  }
  if (problem.dimension() == 0) return;
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  if (!std::isfinite(workspace.evaluate(workspace.state()).robust)) {
    singular_ = true;
    reason_ = "the error of an edge is not a number";
    return;
  }
  workspace.linearise();
  problem.analyse(*solver_);
  hessian_.assign(workspace.hessian().begin(), workspace.hessian().end());
  damping_ = workspace.damping();
  const bool good = solver_->factorise(hessian_.data(), damping_.data());
  // Rounding may hide a null space from the factorisation: look again when a solution explodes.
  if (!good || (solution_explodes(*solver_, workspace) && NullSpace(workspace).dimension() > 0)) {
    singular_ = true;
    reason_ = "H is singular: some direction is not measured (see diagnose())";
  }
}

int Covariance::block_row(int slot) const {
  const VertexRow vertex = slot >= 0 && slot < static_cast<int>(vertices_.size())
                               ? vertices_[slot]
                               : VertexRow{0, VertexRow::kNotThere};
  if (vertex.row == VertexRow::kNotThere) {
    throw Error("a covariance is asked of a vertex that is not in the graph");
  }
  if (vertex.row == VertexRow::kHeld) {
    throw Error(
        "a covariance is asked of vertex " + std::to_string(vertex.id) + ", which was held fixed",
        "free vertices");
  }
  return vertex.row;
}

Eigen::MatrixXd Covariance::block(int a, int b) const {
  const std::pair<int, int> pair(a, b);
  return blocks({&pair, 1})[0];
}

std::vector<Eigen::MatrixXd> Covariance::blocks(std::span<const std::pair<int, int>> pairs) const {
  if (singular_) throw Error("there is no covariance: " + reason_);
  std::vector<std::pair<int, int>> blocks;
  std::size_t size = 0;
  for (const auto& [a, b] : pairs) {
    blocks.emplace_back(block_row(a), block_row(b));
    size += static_cast<std::size_t>(pattern_.dimension[blocks.back().first]) *
            pattern_.dimension[blocks.back().second];
  }
  std::vector<double> values(size);
  if (!solver_->inverse_blocks(pattern_, blocks, values.data())) {
    throw Error("a covariance is not a number");
  }
  std::vector<Eigen::MatrixXd> result;
  const double* from = values.data();
  for (const auto& [row, column] : blocks) {
    const Eigen::Map<const Eigen::MatrixXd> block(from, pattern_.dimension[row],
                                                  pattern_.dimension[column]);
    from += block.size();
    result.push_back(block);
    // What rounding leaves of asymmetry.
    if (row == column) result.back() = 0.5 * (block + block.transpose());
  }
  return result;
}

Eigen::MatrixXd Covariance::joint(std::span<const int> vertices) const {
  std::vector<std::pair<int, int>> pairs;
  int size = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    size += pattern_.dimension[block_row(vertices[i])];
    for (std::size_t j = i; j < vertices.size(); ++j) pairs.emplace_back(vertices[i], vertices[j]);
  }
  const std::vector<Eigen::MatrixXd> parts = blocks(pairs);
  Eigen::MatrixXd all(size, size);
  std::size_t next = 0;
  for (std::size_t i = 0, row = 0; i < vertices.size(); ++i) {
    for (std::size_t j = i, column = row; j < vertices.size(); ++j) {
      const Eigen::MatrixXd& part = parts[next++];
      all.block(row, column, part.rows(), part.cols()) = part;
      all.block(column, row, part.cols(), part.rows()) = part.transpose();
      column += part.cols();
    }
    row += pattern_.dimension[block_row(vertices[i])];
  }
  return all;
}

}  // namespace locograph
