#include <locograph/core/null_space.h>
#include <locograph/core/weighted_square.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace locograph {
namespace {

constexpr double kCandidatePivot = 1e-6;
constexpr double kFreeEnergy = 1e-17;
constexpr std::size_t kMostCandidates = 1000;  ///< looked at in one group
constexpr int kRefinements = 5;

/// For each block row the first of those that H ties to it.
std::vector<int> first_of_component(const BlockPattern& pattern) {
  std::vector<int> first(pattern.size());
  std::iota(first.begin(), first.end(), 0);
  const auto find = [&first](int b) {
    while (first[b] != b) b = first[b] = first[first[b]];
    return b;
  };
  for (int c = 0; c < pattern.size(); ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int a = find(c), b = find(pattern.row[k]);
      first[std::max(a, b)] = std::min(a, b);
    }
  }
  for (int b = 0; b < pattern.size(); ++b) first[b] = find(b);
  return first;
}

}  // namespace

NullSpace::NullSpace(Workspace& workspace, const Termination& termination)
    : workspace_(workspace), termination_(termination) {
  const int n = workspace.problem().dimension();
  if (n == 0) return;
  const Sparse hessian = scaled_hessian();
  const Sparse full = hessian.selfadjointView<Eigen::Upper>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(full, inverse);
  order_ = inverse.inverse();
  Sparse upper(n, n);
  upper.selfadjointView<Eigen::Upper>() = hessian.selfadjointView<Eigen::Upper>().twistedBy(order_);
  analyse(upper);
  factorise(upper);
  if (!complete_ || candidate_rows_.empty()) return;
  std::vector<Group> groups = make_groups();
  refine(groups);
  for (const Group& group : groups) {
    if (goes_on()) keep_free(group);
  }
  if (!complete_) parts_.clear();
}

bool NullSpace::goes_on() { return complete_ = complete_ && !termination_.ended(); }

int NullSpace::dimension() const {
  int sum = 0;
  for (const Part& part : parts_) sum += static_cast<int>(part.directions.cols());
  return sum;
}

/// The upper triangle of D^-½ H D^-½; rows without any measurement stay zero.
NullSpace::Sparse NullSpace::scaled_hessian() {
  Workspace& workspace = workspace_;
  const BlockPattern& pattern = workspace.problem().pattern();
  std::vector<double> diagonal(pattern.scalar_size());
  workspace.diagonal(diagonal);
  scale_.resize(pattern.scalar_size());
  for (Eigen::Index i = 0; i < scale_.size(); ++i) {
    scale_[i] = diagonal[i] > 0.0 ? 1.0 / std::sqrt(diagonal[i]) : 1.0;
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(pattern.values()));
  for (int c = 0; c < pattern.size(); ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int r = pattern.row[k], rows = pattern.dimension[r];
      const double* block = workspace.hessian().data() + pattern.value_offset[k];
      for (int j = 0; j < pattern.dimension[c]; ++j) {
        for (int i = 0; i < rows; ++i) {
          const int row = pattern.scalar_begin[r] + i, column = pattern.scalar_begin[c] + j;
          if (row > column) continue;
          entries.emplace_back(row, column, block[j * rows + i] * scale_[row] * scale_[column]);
        }
      }
    }
  }
  Sparse hessian(pattern.scalar_size(), pattern.scalar_size());
  hessian.setFromTriplets(entries.begin(), entries.end());
  return hessian;
}

/// Elimination tree and the size of each column of L.
void NullSpace::analyse(const Sparse& upper) {
  const int n = static_cast<int>(upper.cols());
  std::vector<int> mark(n);
  parent_.assign(n, -1);
  column_size_.assign(n, 0);
  for (int k = 0; k < n; ++k) {
    mark[k] = k;
    for (Sparse::InnerIterator entry(upper, k); entry; ++entry) {
      for (int i = static_cast<int>(entry.row()); i < k && mark[i] != k; i = parent_[i]) {
        if (parent_[i] < 0) parent_[i] = k;
        ++column_size_[i];
        mark[i] = k;
      }
    }
  }
  column_begin_.assign(n + 1, 0);
  for (int k = 0; k < n; ++k) column_begin_[k + 1] = column_begin_[k] + column_size_[k];
  row_.resize(column_begin_[n]);
  value_.resize(column_begin_[n]);
}

void NullSpace::factorise(const Sparse& upper) {
  const int n = static_cast<int>(upper.cols());
  std::vector<double> y(n, 0.0);
  std::vector<int> mark(n), pattern(n), path(n);
  pivot_.resize(n);
  column_size_.assign(n, 0);
  for (int k = 0; k < n && goes_on(); ++k) {
    int top = n;
    mark[k] = k;
    for (Sparse::InnerIterator entry(upper, k); entry; ++entry) {
      int i = static_cast<int>(entry.row());
      if (i > k) continue;
      y[i] += entry.value();
      int length = 0;
      for (; mark[i] != k; i = parent_[i]) {
        path[length++] = i;
        mark[i] = k;
      }
      while (length > 0) pattern[--top] = path[--length];
    }
    double pivot = y[k];
    y[k] = 0.0;
    for (; top < n; ++top) {
      const int i = pattern[top];
      const double yi = y[i];
      y[i] = 0.0;
      const std::int64_t begin = column_begin_[i], end = begin + column_size_[i];
      for (std::int64_t p = begin; p < end; ++p) y[row_[p]] -= value_[p] * yi;
      const double l = yi / pivot_[i];
      pivot -= l * yi;
      row_[end] = k;
      value_[end] = l;
      ++column_size_[i];
    }
    if (!(pivot > kCandidatePivot)) {
      candidate_rows_.push_back(k);
      pivot += 1.0;
    }
    pivot_[k] = pivot;
  }
}

std::vector<NullSpace::Group> NullSpace::make_groups() {
  const BlockPattern& pattern = workspace_.problem().pattern();
  const int n = pattern.scalar_size();
  block_of_row_.reserve(n);
  for (int b = 0; b < pattern.size(); ++b) {
    block_of_row_.insert(block_of_row_.end(), pattern.dimension[b], b);
  }
  std::vector<int> row_at(n);  // of H, by place in the factorisation
  for (int row = 0; row < n; ++row) row_at[order_.indices()[row]] = row;
  const std::vector<int> first = first_of_component(pattern);
  std::vector<int> group_of_first(pattern.size(), -1);
  int count = 0;
  for (const int k : candidate_rows_) {
    int& group = group_of_first[first[block_of_row_[row_at[k]]]];
    if (group < 0) group = count++;
  }
  std::vector<Group> groups(count);
  group_of_block_.resize(pattern.size());
  position_of_block_.assign(pattern.size(), -1);
  std::vector<int> size(count, 0);
  for (int b = 0; b < pattern.size(); ++b) {
    const int group = group_of_block_[b] = group_of_first[first[b]];
    if (group < 0) continue;
    groups[group].blocks.push_back(b);
    position_of_block_[b] = size[group];
    size[group] += pattern.dimension[b];
  }
  const auto position_of = [&](int row) {
    const int block = block_of_row_[row];
    return position_of_block_[block] + row - pattern.scalar_begin[block];
  };
  for (int k = 0; k < n; ++k) {
    const int group = group_of_block_[block_of_row_[row_at[k]]];
    if (group < 0) continue;
    groups[group].rows.push_back(k);
    groups[group].position.push_back(position_of(row_at[k]));
  }
  for (const int k : candidate_rows_) {
    Group& group = groups[group_of_block_[block_of_row_[row_at[k]]]];
    if (group.anchors.size() < kMostCandidates) group.anchors.push_back(position_of(row_at[k]));
  }
  for (int g = 0; g < count; ++g) {
    groups[g].v.setZero(size[g], static_cast<Eigen::Index>(groups[g].anchors.size()));
  }
  return groups;
}

/// x ← (H + EEᵀ)⁻¹ x on the rows of one group.
void NullSpace::solve(const Group& group, Eigen::Ref<Eigen::VectorXd> x,
                      Eigen::VectorXd& scratch) const {
  for (std::size_t i = 0; i < group.rows.size(); ++i) scratch[group.rows[i]] = x[group.position[i]];
  for (const int k : group.rows) {
    for (std::int64_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
      scratch[row_[p]] -= value_[p] * scratch[k];
    }
  }
  for (const int k : group.rows) scratch[k] /= pivot_[k];
  for (auto k = group.rows.rbegin(); k != group.rows.rend(); ++k) {
    for (std::int64_t p = column_begin_[*k]; p < column_begin_[*k + 1]; ++p) {
      scratch[*k] -= value_[p] * scratch[row_[p]];
    }
  }
  for (std::size_t i = 0; i < group.rows.size(); ++i) x[group.position[i]] = scratch[group.rows[i]];
}

/// V from zero, each time by the residual E − (JᵀΩJ + EEᵀ) V.
void NullSpace::refine(std::vector<Group>& groups) {
  Eigen::VectorXd scratch = Eigen::VectorXd::Zero(workspace_.problem().dimension());
  for (Group& group : groups) group.product.setZero(group.v.rows(), group.v.cols());
  for (int round = 0; round < kRefinements; ++round) {
    for (Group& group : groups) {
      Eigen::MatrixXd residual = -group.product;
      for (std::size_t a = 0; a < group.anchors.size(); ++a) {
        residual.row(group.anchors[a]) -= group.v.row(group.anchors[a]);
        residual(group.anchors[a], static_cast<Eigen::Index>(a)) += 1.0;
      }
      for (Eigen::Index c = 0; c < residual.cols() && goes_on(); ++c) {
        solve(group, residual.col(c), scratch);
      }
      group.v += residual;
    }
    sum_edges(groups);
  }
}

void NullSpace::sum_edges(std::vector<Group>& groups) {
  const Problem& problem = workspace_.problem();
  const BlockPattern& pattern = problem.pattern();
  for (Group& group : groups) {
    group.product.setZero(group.v.rows(), group.v.cols());
    group.energy.setZero(group.v.cols(), group.v.cols());
  }
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    EdgePool& pool = *problem.graph().edge_pools()[p];
    const CompiledEdges& compiled = problem.edges()[p];
    for (int k = 0; k < static_cast<int>(compiled.edges.size()) && goes_on(); ++k) {
      int number = -1;
      for (int s = compiled.slot_begin[k]; s < compiled.slot_begin[k + 1] && number < 0; ++s) {
        const int row = compiled.slots[s].tangent_offset;
        if (row >= 0) number = group_of_block_[block_of_row_[row]];
      }
      if (number < 0) continue;
      Group& group = groups[number];
      const Workspace::Linearised edge = workspace_.linearise_edge(static_cast<int>(p), k);
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(edge.error.size(), group.v.cols());
      const auto each_slot = [&](auto&& visit) {
        for (std::size_t i = 0; i < edge.jacobians.size(); ++i) {
          const int row =
              compiled.slots[compiled.slot_begin[k] + static_cast<int>(i)].tangent_offset;
          if (row < 0) continue;
          const int block = block_of_row_[row], size = pattern.dimension[block];
          const Eigen::MatrixXd scaled = edge.jacobians[i] * scale_.segment(row, size).asDiagonal();
          visit(scaled, position_of_block_[block], size);
        }
      };
      each_slot([&](const Eigen::MatrixXd& jacobian, int at, int size) {
        change += jacobian * group.v.middleRows(at, size);
      });
      const Eigen::MatrixXd force = edge.weight * weighted(pool, compiled.edges[k], change);
      group.energy += change.transpose() * force;
      each_slot([&](const Eigen::MatrixXd& jacobian, int at, int size) {
        group.product.middleRows(at, size) += jacobian.transpose() * force;
      });
    }
  }
}

/// The part of the span of V that has no energy.
void NullSpace::keep_free(const Group& group) {
  const Eigen::Index rows = group.v.rows(), count = group.v.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(group.v);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(rows, count);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(count);
  const Eigen::MatrixXd half = r.triangularView<Eigen::Upper>().transpose().solve(group.energy);
  const Eigen::MatrixXd energy =
      r.triangularView<Eigen::Upper>().transpose().solve(half.transpose());
  const Eigen::MatrixXd symmetric = 0.5 * (energy + energy.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric);
  const Eigen::Index free = (eigen.eigenvalues().array() <= kFreeEnergy).count();
  if (free == 0) return;
  Part part;
  part.blocks = group.blocks;
  part.directions = q * eigen.eigenvectors().leftCols(free);
  const BlockPattern& pattern = workspace_.problem().pattern();
  for (const int b : group.blocks) {
    part.directions.middleRows(position_of_block_[b], pattern.dimension[b]).array().colwise() *=
        scale_.segment(pattern.scalar_begin[b], pattern.dimension[b]).array();
  }
  parts_.push_back(std::move(part));
}

}  // namespace locograph
