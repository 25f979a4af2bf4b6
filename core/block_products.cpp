#include <locograph/core/all_zero.h>
#include <locograph/core/block_products.h>
#include <locograph/core/row_kernels.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace locograph::detail {
namespace {
using Matrix = Eigen::Map<Eigen::MatrixXd>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

constexpr int kGroup = kMostRowsTogether;
constexpr int kNarrow = 5;  // rows of fewer entries are added one by one

using Word = std::uint64_t;  // a bit for each column
constexpr int kBits = 64;

/// Adds the rows of one edge to H and b, with their entries in the first columns of each slot. Rows
/// with few entries one by one; others, one after the other with mostly the same columns, as
/// vectors.
class RowSum {
 public:
  RowSum(const CompiledEdges& compiled, int k, int columns, double* const* jacobians,
         Scratch& scratch, double* hessian, double* gradient)
      : columns_(columns),
        slots_(compiled.slots.data() + compiled.slot_begin[k]),
        count_(compiled.slot_begin[k + 1] - compiled.slot_begin[k]),
        blocks_(compiled.blocks.data() + compiled.block_begin[k]),
        jacobians_(jacobians),
        hessian_(hessian),
        gradient_(gradient) {
    width_ = scratch.array<int>(static_cast<std::size_t>(count_));
    word_ = scratch.array<int>(static_cast<std::size_t>(count_) + 1);
    word_[0] = 0;
    int widest = 0;
    for (int s = 0; s < count_; ++s) {
      width_[s] = slots_[s].pool->dimension(slots_[s].vertex_index);
      widest = std::max(widest, width_[s]);
      const int words = jacobians_[s] == nullptr ? 0 : (searched(s) + kBits - 1) / kBits;
      word_[s + 1] = word_[s] + words;
    }
    for (Word** mask : {&of_row_, &of_group_})
      *mask = scratch.array<Word>(static_cast<std::size_t>(words()));
    for (int** list : {&left_, &right_})
      *list = scratch.array<int>(static_cast<std::size_t>(widest));
  }

  void add(int r, double weight, double error) {
    const int entries = find_entries(r);
    if (entries < kNarrow) {
      add_one(r, weight, error);
      return;
    }
    if (!belongs(entries)) flush();
    for (int w = 0; w < words(); ++w)
      of_group_[w] = rows_ == 0 ? of_row_[w] : of_group_[w] | of_row_[w];
    row_[rows_] = r;
    weight_[rows_] = weight;
    error_[rows_++] = error;
  }

  void flush() {
    if (rows_ > 0) add_group();
    rows_ = 0;
  }

 private:
  int words() const { return word_[count_]; }
  int searched(int s) const { return std::min(width_[s], columns_); }
  const double* row(int s, int r) const {
    return jacobians_[s] + static_cast<std::ptrdiff_t>(r) * width_[s];
  }

  int find_entries(int r) {
    int entries = 0;
    for (int s = 0; s < count_; ++s) {
      const double* from = word_[s + 1] > word_[s] ? row(s, r) : nullptr;
      for (int w = word_[s], c = 0; w < word_[s + 1]; ++w, c += kBits) {
        const int end = std::min(searched(s) - c, kBits);
        const Word mask = kernels_.entries(from + c, end);
        of_row_[w] = mask;
        entries += std::popcount(mask);
      }
    }
    return entries;
  }

  /// Whether the row just looked at adds few columns to the group.
  bool belongs(int entries) const {
    if (rows_ == 0) return true;
    if (rows_ == kGroup) return false;
    int united = 0, group = 0;
    for (int w = 0; w < words(); ++w) {
      united += std::popcount(of_group_[w] | of_row_[w]);
      group += std::popcount(of_group_[w]);
    }
    return 4 * united <= 5 * std::min(entries, group);
  }

  int columns(const Word* mask, int s, int* list) const {
    int count = 0;
    for (int w = word_[s], c = 0; w < word_[s + 1]; ++w, c += kBits) {
      for (Word left = mask[w]; left != 0; left &= left - 1) {
        list[count++] = c + std::countr_zero(left);
      }
    }
    return count;
  }

  // Block (i, j) is width_[i] × width_[j], column-major; transposed where i comes later.
  void add_one(int r, double weight, double error) {
    const CompiledEdges::Block* block = blocks_;
    for (int i = 0; i < count_; ++i) {
      const int left = columns(of_row_, i, left_);
      const double* own = left > 0 ? row(i, r) : nullptr;
      double* g = gradient_ + slots_[i].gradient_offset;
      for (int a = 0; a < left; ++a) g[left_[a]] += weight * error * own[left_[a]];
      for (int j = i; j < count_; ++j, ++block) {
        const int right = left == 0 ? 0 : columns(of_row_, j, right_);
        if (right == 0) continue;
        const bool transposed = (*block & 1) != 0;
        const int row_step = transposed ? width_[j] : 1, column_step = transposed ? 1 : width_[i];
        const double* other = row(j, r);
        for (int b = 0; b < right; ++b) {
          const double factor = weight * other[right_[b]];
          double* column =
              hessian_ + (*block >> 1) + static_cast<std::ptrdiff_t>(right_[b]) * column_step;
          for (int a = 0; a < left; ++a) column[left_[a] * row_step] += factor * own[left_[a]];
        }
      }
    }
  }

  void add_group() {
    static constexpr int kFirst[] = {0};
    const CompiledEdges::Block* block = blocks_;
    const double *left[kGroup], *right[kGroup], *errors[kGroup];
    for (int i = 0; i < count_; ++i) {
      const int own = columns(of_group_, i, left_);
      if (own == 0) {
        block += count_ - i;
        continue;
      }
      const int own_begin = left_[0], own_size = left_[own - 1] + 1 - own_begin;
      for (int r = 0; r < rows_; ++r) {
        left[r] = row(i, row_[r]) + own_begin;
        errors[r] = error_ + r;
      }
      kernels_.add_products(rows_, left, own_size, errors, weight_, kFirst, 1,
                            gradient_ + slots_[i].gradient_offset + own_begin, 0);
      for (int j = i; j < count_; ++j, ++block) {
        const int other = columns(of_group_, j, right_);
        if (other == 0) continue;
        double* h = hessian_ + (*block >> 1);
        if ((*block & 1) != 0) {
          const int begin = right_[0], size = right_[other - 1] + 1 - begin;
          for (int r = 0; r < rows_; ++r) {
            right[r] = row(j, row_[r]) + begin;
            own_[r] = left[r] - own_begin;
          }
          kernels_.add_products(rows_, right, size, own_, weight_, left_, own, h + begin,
                                width_[j]);
        } else {
          for (int r = 0; r < rows_; ++r) right[r] = row(j, row_[r]);
          kernels_.add_products(rows_, left, own_size, right, weight_, right_, other, h + own_begin,
                                width_[i]);
        }
      }
    }
  }

  int columns_;
  const CompiledEdges::Slot* slots_;
  int count_;  ///< of slots
  const CompiledEdges::Block* blocks_;
  double* const* jacobians_;  ///< by slot, stored row by row; null where a slot has none
  double* hessian_;
  double* gradient_;
  int* width_;  ///< of each slot
  int* word_;   ///< first word of each slot in a mask
  Word *of_row_, *of_group_;
  int *left_, *right_;  ///< columns
  const RowKernels& kernels_ = row_kernels();
  int rows_ = 0, row_[kGroup] = {};
  const double* own_[kGroup] = {};
  double weight_[kGroup] = {}, error_[kGroup] = {};
};

/// Rows [begin, end), which have an entry in their own column alone.
void add_diagonal(const CompiledEdges& compiled, int k, int begin, int end, const double* error,
                  const double* weights, double w, double* const* jacobians, double* hessian,
                  double* gradient) {
  const CompiledEdges::Slot* slots = compiled.slots.data() + compiled.slot_begin[k];
  const int count = compiled.slot_begin[k + 1] - compiled.slot_begin[k];
  const CompiledEdges::Block* block = compiled.blocks.data() + compiled.block_begin[k];
  const auto stride = [&](int s) {
    return static_cast<std::ptrdiff_t>(slots[s].pool->dimension(slots[s].vertex_index)) + 1;
  };
  for (int i = 0; i < count; ++i) {
    const double* own = jacobians[i];
    if (own == nullptr) {
      block += count - i;
      continue;
    }
    const std::ptrdiff_t step = stride(i);
    double* g = gradient + slots[i].gradient_offset;
    for (int r = begin; r < end; ++r) g[r] += w * weights[r] * error[r] * own[r * step];
    for (int j = i; j < count; ++j, ++block) {
      const double* other = jacobians[j];
      if (other == nullptr) continue;
      const std::ptrdiff_t other_step = stride(j), h_step = (*block & 1) != 0 ? other_step : step;
      double* h = hessian + (*block >> 1);
      for (int r = begin; r < end; ++r) {
        h[r * h_step] += w * weights[r] * own[r * step] * other[r * other_step];
      }
    }
  }
}
}  // namespace

void weight_jacobian(int n, int d, const double* jacobian, const double* information, double w,
                     double* weighted) {
  Matrix out(weighted, d, n);
  out.noalias() = ConstMatrix(jacobian, n, d).transpose() * ConstMatrix(information, n, n);
  out *= w;
}

void bend_weighted(int n, int d, const double* information, const double* error, double beta,
                   double* weighted, double* along) {
  Matrix out(weighted, d, n);
  const ConstVector e(error, n);
  Eigen::Map<Eigen::VectorXd> direction(along, d);
  direction.noalias() = out * e;
  for (int c = 0; c < n; ++c) {
    out.col(c) +=
        beta * ConstVector(information + static_cast<std::ptrdiff_t>(c) * n, n).dot(e) * direction;
  }
}

void add_product(int n, int a, int b, const double* weighted, const double* jacobian,
                 bool transposed, double* block) {
  const ConstMatrix left(weighted, a, n), right(jacobian, n, b);
  if (transposed) {
    Matrix(block, b, a).noalias() += right.transpose() * left.transpose();
  } else {
    Matrix(block, a, b).noalias() += left * right;
  }
}

void add_rows(const CompiledEdges& compiled, int k, int n, int diagonal, const double* error,
              const double* weights, double w, bool one_sided, double* const* jacobians,
              Scratch& scratch, double* hessian, double* gradient) {
  constexpr int kAll = std::numeric_limits<int>::max();
  RowSum sum(compiled, k, diagonal < n ? diagonal : kAll, jacobians, scratch, hessian, gradient);
  for (int r = 0; r < diagonal; ++r) {
    const double weight = w * weights[r];
    if (weight != 0.0 && !(one_sided && error[r] == 0.0)) sum.add(r, weight, error[r]);
  }
  sum.flush();
  if (diagonal < n) {
    add_diagonal(compiled, k, diagonal, n, error, weights, w, jacobians, hessian, gradient);
  }
}

}  // namespace locograph::detail
