#include <locograph/core/covariance.h>
#include <locograph/core/null_space.h>

#include <cmath>

namespace locograph {

Covariance::Covariance(Graph& graph, LinearSolver& solver) : graph_(graph), solver_(solver) {
  problem_.compile(graph);
  workspace_.allocate(problem_);
  workspace_.load_state();
  block_of_slot_.assign(graph.vertex_slots(), -1);
  for (int b = 0; b < problem_.pattern().size(); ++b) {
    block_of_slot_[problem_.free_vertices()[b]] = b;
  }
  if (problem_.dimension() == 0) return;
  if (!std::isfinite(workspace_.evaluate(workspace_.state()).robust)) {
    singular_ = true;
    reason_ = "the error of an edge is not a number";
    return;
  }
  workspace_.linearise();
  problem_.analyse(solver);
  const bool good = solver.factorise(workspace_.hessian().data(), workspace_.damping().data());
  // Rounding may hide a null space from the factorisation: look again when a solution explodes.
  if (!good || (solution_explodes() && NullSpace(workspace_).dimension() > 0)) {
    singular_ = true;
    reason_ = "H is singular: some direction is not measured (see diagnose())";
  }
}

/// Solves for a right-hand side of the size of H's diagonal.
bool Covariance::solution_explodes() {
  constexpr double kSuspicious = 1e7;
  std::vector<double> diagonal(problem_.dimension());
  workspace_.diagonal(diagonal);
  std::vector<double>& x = workspace_.step();
  for (std::size_t i = 0; i < x.size(); ++i) {
    // Signs without a pattern that a null space could be orthogonal to.
    const std::uint64_t hash = (i + 1) * 0x9e3779b97f4a7c15u;
    x[i] = std::sqrt(diagonal[i]) * ((hash >> 40 & 1) != 0 ? 1.0 : -1.0);
  }
  solver_.solve(x.data(), x.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(std::abs(x[i]) * std::sqrt(diagonal[i]) < kSuspicious)) return true;
  }
  return false;
}

int Covariance::block_row(int slot) const {
  if (slot < 0 || slot >= graph_.vertex_slots() || !graph_.vertex_alive(slot)) {
    throw Error("a covariance is asked of a vertex that is not in the graph");
  }
  const int row = slot < static_cast<int>(block_of_slot_.size()) ? block_of_slot_[slot] : -1;
  if (row < 0) {
    throw Error("a covariance is asked of vertex " + std::to_string(graph_.vertex_record(slot).id) +
                    ", which was held fixed",
                "free vertices");
  }
  return row;
}

Eigen::MatrixXd Covariance::block(int a, int b) const {
  const std::pair<int, int> pair(a, b);
  return blocks({&pair, 1})[0];
}

std::vector<Eigen::MatrixXd> Covariance::blocks(std::span<const std::pair<int, int>> pairs) const {
  if (singular_) throw Error("there is no covariance: " + reason_);
  const BlockPattern& pattern = problem_.pattern();
  std::vector<std::pair<int, int>> blocks;
  std::size_t size = 0;
  for (const auto& [a, b] : pairs) {
    blocks.emplace_back(block_row(a), block_row(b));
    size += static_cast<std::size_t>(pattern.dimension[blocks.back().first]) *
            pattern.dimension[blocks.back().second];
  }
  std::vector<double> values(size);
  if (!solver_.inverse_blocks(pattern, blocks, values.data())) {
    throw Error("a covariance is not a number");
  }
  std::vector<Eigen::MatrixXd> result;
  const double* from = values.data();
  for (const auto& [row, column] : blocks) {
    const Eigen::Map<const Eigen::MatrixXd> block(from, pattern.dimension[row],
                                                  pattern.dimension[column]);
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
    size += problem_.pattern().dimension[block_row(vertices[i])];
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
    row += graph_.dimension(vertices[i]);
  }
  return all;
}

}  // namespace locograph
