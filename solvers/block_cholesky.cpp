#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/dense_kernels.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace locograph {
namespace {

/// Blocks of N × N with leading dimension LD, a power of two: columns are vectors.
template <int N, int LD>
struct FixedKernel {
  // A typedef: GCC drops the attribute from an alias declaration when its size is dependent.
  typedef double Column __attribute__((vector_size(LD * sizeof(double))));
  static_assert(sizeof(Column) == LD * sizeof(double));

  // By reference: a vector that is returned would depend on the flags this file is compiled with.
  static void load(Column& column, const double* from) {
    std::memcpy(&column, from, sizeof column);
  }
  static void store(double* to, const Column& column) { std::memcpy(to, &column, sizeof column); }

  // C −= A Bᵀ
  void subtract_product(double* c, const double* a, const double* b, int, int, int) const {
    Column left[N];
    for (int k = 0; k < N; ++k) load(left[k], a + k * LD);
    for (int j = 0; j < N; ++j) {
      Column target;
      load(target, c + j * LD);
      for (int k = 0; k < N; ++k) target -= left[k] * b[k * LD + j];
      store(c + j * LD, target);
    }
  }
  bool cholesky(double* d, int) const {
    for (int j = 0; j < N; ++j) {
      const double pivot = d[j * LD + j];
      if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
      const double root = std::sqrt(pivot);
      for (int i = j; i < N; ++i) d[j * LD + i] /= root;
      for (int c = j + 1; c < N; ++c) {
        for (int i = c; i < N; ++i) d[c * LD + i] -= d[j * LD + i] * d[j * LD + c];
      }
    }
    return true;
  }
  // X ← X L⁻ᵀ
  void divide(double* x, const double* l, int, int) const {
    Column columns[N];
    for (int j = 0; j < N; ++j) {
      Column target;
      load(target, x + j * LD);
      for (int k = 0; k < j; ++k) target -= columns[k] * l[k * LD + j];
      columns[j] = target / l[j * LD + j];
      store(x + j * LD, columns[j]);
    }
  }
  static int leading(int) { return LD; }
  static int size(int) { return N; }
};

struct DynamicKernel {
  void subtract_product(double* c, const double* a, const double* b, int rows, int columns,
                        int inner) const {
    if (rows * columns * inner > 512) {
      locograph::subtract_product(c, rows, a, rows, b, columns, rows, columns, inner);
      return;
    }
    for (int j = 0; j < columns; ++j) {
      for (int k = 0; k < inner; ++k) {
        const double factor = b[k * columns + j];
        for (int i = 0; i < rows; ++i) c[j * rows + i] -= a[k * rows + i] * factor;
      }
    }
  }
  bool cholesky(double* d, int n) const { return cholesky_in_place(d, n, n, n) < 0; }
  void divide(double* x, const double* l, int rows, int n) const {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < j; ++k) {
        for (int i = 0; i < rows; ++i) x[j * rows + i] -= x[k * rows + i] * l[k * n + j];
      }
      for (int i = 0; i < rows; ++i) x[j * rows + i] /= l[j * n + j];
    }
  }
  static int leading(int rows) { return rows; }
  static int size(int n) { return n; }
};

int leading_dimension(int uniform, int rows) { return uniform == 3 ? 4 : uniform == 6 ? 8 : rows; }

}  // namespace

void BlockCholesky::analyse(const BlockPattern& pattern) {
  if (pattern == pattern_) return;
  pattern_ = pattern;
  uniform_ = pattern.size() == 0 ? 0 : pattern.dimension.front();
  for (const int d : pattern.dimension) {
    if (d != uniform_) uniform_ = 0;
  }
  if (uniform_ != 3 && uniform_ != 6) uniform_ = 0;
  order();
  symbolic();
  place_entries();
}

void BlockCholesky::order() {
  const int n = pattern_.size();
  std::vector<Eigen::Triplet<char>> entries;
  for (int c = 0; c < n; ++c) {
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      entries.emplace_back(pattern_.row[k], c, 1);
      if (pattern_.row[k] != c) entries.emplace_back(c, pattern_.row[k], 1);
    }
  }
  Eigen::SparseMatrix<char, Eigen::ColMajor, int> graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(graph, permutation);
  old_of_new_.resize(n);
  new_of_old_.resize(n);
  for (int i = 0; i < n; ++i) {
    old_of_new_[i] = permutation.indices()[i];
    new_of_old_[permutation.indices()[i]] = i;
  }
}

void BlockCholesky::symbolic() {
  const int n = pattern_.size();
  dimension_.resize(n);
  scalar_begin_.assign(n + 1, 0);
  for (int i = 0; i < n; ++i) {
    dimension_[i] = pattern_.dimension[old_of_new_[i]];
    scalar_begin_[i + 1] = scalar_begin_[i] + dimension_[i];
  }
  // Lower pattern of the permuted matrix, by column.
  std::vector<std::vector<int>> below(n);
  for (int c = 0; c < n; ++c) {
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      const int a = new_of_old_[pattern_.row[k]], b = new_of_old_[c];
      if (a != b) below[std::min(a, b)].push_back(std::max(a, b));
    }
  }
  // The structure of a column is its own and that of its children in the elimination tree.
  std::vector<std::vector<int>> children(n);
  std::vector<int> mark(n, -1);
  column_begin_.assign(1, 0);
  rows_.clear();
  for (int c = 0; c < n; ++c) {
    const std::size_t begin = rows_.size();
    rows_.push_back(c);
    mark[c] = c;
    const auto add = [&](int r) {
      if (mark[r] == c) return;
      mark[r] = c;
      rows_.push_back(r);
    };
    for (const int r : below[c]) add(r);
    for (const int child : children[c]) {
      for (int k = column_begin_[child] + 2; k < column_begin_[child + 1]; ++k) add(rows_[k]);
    }
    std::sort(rows_.begin() + begin, rows_.end());
    column_begin_.push_back(static_cast<int>(rows_.size()));
    if (rows_.size() > begin + 1) children[rows_[begin + 1]].push_back(c);
    std::vector<int>().swap(below[c]);
  }
  offset_.assign(1, 0);
  row_begin_.assign(n + 1, 0);
  cost_ = 0.0;
  for (int c = 0; c < n; ++c) {
    double height = 0.0;
    for (int k = column_begin_[c]; k < column_begin_[c + 1]; ++k) {
      const int r = rows_[k];
      offset_.push_back(offset_.back() +
                        std::int64_t{leading_dimension(uniform_, dimension_[r])} * dimension_[c]);
      height += dimension_[r];
      if (r != c) ++row_begin_[r + 1];
    }
    cost_ += 0.5 * height * height * dimension_[c];
  }
  for (int r = 0; r < n; ++r) row_begin_[r + 1] += row_begin_[r];
  row_blocks_.resize(row_begin_.back());
  std::vector<int> next(row_begin_.begin(), row_begin_.end() - 1);
  for (int c = 0; c < n; ++c) {
    for (int k = column_begin_[c] + 1; k < column_begin_[c + 1]; ++k) {
      row_blocks_[next[rows_[k]]++] = {c, k};
    }
  }
  factor_.resize(offset_.back());
  position_.resize(n);
  permuted_.resize(scalar_begin_.back());
}

void BlockCholesky::place_entries() {
  entries_.clear();
  for (int c = 0; c < pattern_.size(); ++c) {
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      const int r = pattern_.row[k];
      const int a = new_of_old_[r], b = new_of_old_[c];
      const int column = std::min(a, b), row = std::max(a, b);
      const auto begin = rows_.begin() + column_begin_[column];
      const auto end = rows_.begin() + column_begin_[column + 1];
      const std::int64_t block = std::lower_bound(begin, end, row) - rows_.begin();
      // H stores (r, c); the factor wants (row, column): transposed when r is the column.
      entries_.push_back({pattern_.value_offset[k], offset_[block], pattern_.dimension[r],
                          pattern_.dimension[c], a < b});
    }
  }
}

bool BlockCholesky::factorise(const double* values, const double* damping) {
  std::fill(factor_.begin(), factor_.end(), 0.0);
  for (const Entry& entry : entries_) {
    const double* from = values + entry.from;
    double* to = factor_.data() + entry.to;
    const int ld = leading_dimension(uniform_, entry.transposed ? entry.columns : entry.rows);
    for (int j = 0; j < entry.columns; ++j) {
      for (int i = 0; i < entry.rows; ++i) {
        to[entry.transposed ? i * ld + j : j * ld + i] = from[j * entry.rows + i];
      }
    }
  }
  for (int c = 0; c < pattern_.size(); ++c) {
    double* diagonal = factor_.data() + offset_[column_begin_[c]];
    const int ld = leading_dimension(uniform_, dimension_[c]);
    const double* own = damping + pattern_.scalar_begin[old_of_new_[c]];
    for (int i = 0; i < dimension_[c]; ++i) diagonal[i * ld + i] += own[i];
  }
  int failed = -1;
  switch (uniform_) {
    case 3:
      failed = factorise_columns(FixedKernel<3, 4>());
      break;
    case 6:
      failed = factorise_columns(FixedKernel<6, 8>());
      break;
    default:
      failed = factorise_columns(DynamicKernel());
  }
  failed_row_ = failed < 0 ? -1 : old_of_new_[failed];
  return failed < 0;
}

template <class Kernel>
int BlockCholesky::factorise_columns(const Kernel& kernel) {
  const int n = pattern_.size();
  double* factor = factor_.data();
  for (int c = 0; c < n; ++c) {
    const int begin = column_begin_[c], end = column_begin_[c + 1], width = dimension_[c];
    for (int k = begin; k < end; ++k) position_[rows_[k]] = k;
    for (int b = row_begin_[c]; b < row_begin_[c + 1]; ++b) {
      const RowBlock& left = row_blocks_[b];
      const double* pivot = factor + offset_[left.position];
      const int inner = dimension_[left.column];
      for (int k = left.position; k < column_begin_[left.column + 1]; ++k) {
        kernel.subtract_product(factor + offset_[position_[rows_[k]]], factor + offset_[k], pivot,
                                dimension_[rows_[k]], width, inner);
      }
    }
    double* diagonal = factor + offset_[begin];
    if (!kernel.cholesky(diagonal, width)) return c;
    for (int k = begin + 1; k < end; ++k) {
      kernel.divide(factor + offset_[k], diagonal, dimension_[rows_[k]], width);
    }
  }
  return -1;
}

template <class Kernel>
void BlockCholesky::solve_columns(const Kernel& kernel, double* y) const {
  const int n = pattern_.size();
  for (int c = 0; c < n; ++c) {
    double* own = y + scalar_begin_[c];
    const int width = kernel.size(dimension_[c]);
    solve_lower(factor_.data() + offset_[column_begin_[c]], kernel.leading(width), width, own);
    for (int k = column_begin_[c] + 1; k < column_begin_[c + 1]; ++k) {
      double* other = y + scalar_begin_[rows_[k]];
      const double* block = factor_.data() + offset_[k];
      const int rows = kernel.size(dimension_[rows_[k]]), ld = kernel.leading(rows);
      for (int j = 0; j < width; ++j) {
        for (int i = 0; i < rows; ++i) other[i] -= block[j * ld + i] * own[j];
      }
    }
  }
  for (int c = n - 1; c >= 0; --c) {
    double* own = y + scalar_begin_[c];
    const int width = kernel.size(dimension_[c]);
    for (int k = column_begin_[c] + 1; k < column_begin_[c + 1]; ++k) {
      const double* other = y + scalar_begin_[rows_[k]];
      const double* block = factor_.data() + offset_[k];
      const int rows = kernel.size(dimension_[rows_[k]]), ld = kernel.leading(rows);
      for (int j = 0; j < width; ++j) {
        double sum = 0.0;
        for (int i = 0; i < rows; ++i) sum += block[j * ld + i] * other[i];
        own[j] -= sum;
      }
    }
    solve_lower_transposed(factor_.data() + offset_[column_begin_[c]], kernel.leading(width), width,
                           own);
  }
}

void BlockCholesky::solve(const double* right_hand_side, double* x) const {
  for (int c = 0; c < pattern_.size(); ++c) {
    std::copy_n(right_hand_side + pattern_.scalar_begin[old_of_new_[c]], dimension_[c],
                permuted_.begin() + scalar_begin_[c]);
  }
  switch (uniform_) {
    case 3:
      solve_columns(FixedKernel<3, 4>(), permuted_.data());
      break;
    case 6:
      solve_columns(FixedKernel<6, 8>(), permuted_.data());
      break;
    default:
      solve_columns(DynamicKernel(), permuted_.data());
  }
  for (int c = 0; c < pattern_.size(); ++c) {
    std::copy_n(permuted_.begin() + scalar_begin_[c], dimension_[c],
                x + pattern_.scalar_begin[old_of_new_[c]]);
  }
}

}  // namespace locograph
