#include <locograph/core/block_products.h>

namespace locograph::detail {
namespace {
using Matrix = Eigen::Map<Eigen::MatrixXd>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

/// The entries other than zero of one row of a Jacobian.
struct RowEntries {
  int width;
  int count;
  int* column;
  double* value;
};
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

void add_rows(const CompiledEdges& compiled, int k, int n, const double* error,
              const double* weights, double w, bool one_sided, double* const* jacobians,
              Scratch& scratch, double* hessian, double* gradient) {
  const CompiledEdges::Slot* slots = compiled.slots.data() + compiled.slot_begin[k];
  const int count = compiled.slot_begin[k + 1] - compiled.slot_begin[k];
  RowEntries* entries = scratch.array<RowEntries>(count);
  for (int s = 0; s < count; ++s) {
    const int width = slots[s].pool->dimension(slots[s].vertex_index);
    entries[s] = {width, 0, scratch.array<int>(width), scratch.array<double>(width)};
  }
  for (int r = 0; r < n; ++r) {
    const double weight = w * weights[r];
    if (weight == 0.0 || (one_sided && error[r] == 0.0)) continue;
    for (int s = 0; s < count; ++s) {
      RowEntries& row = entries[s];
      row.count = 0;
      if (jacobians[s] == nullptr) continue;
      const double* from = jacobians[s] + static_cast<std::ptrdiff_t>(r) * row.width;
      for (int c = 0; c < row.width; ++c) {
        if (from[c] == 0.0) continue;
        row.column[row.count] = c;
        row.value[row.count++] = from[c];
      }
    }
    const CompiledEdges::Block* block = compiled.blocks.data() + compiled.block_begin[k];
    for (int i = 0; i < count; ++i) {
      const RowEntries& left = entries[i];
      double* g = gradient + slots[i].gradient_offset;
      for (int a = 0; a < left.count; ++a) g[left.column[a]] += weight * error[r] * left.value[a];
      for (int j = i; j < count; ++j, ++block) {
        const RowEntries& right = entries[j];
        if (left.count == 0 || right.count == 0) continue;
        double* h = hessian + (*block >> 1);
        // Block (i, j) is width[i] × width[j], column-major; transposed where i comes later.
        const bool transposed = (*block & 1) != 0;
        const int row_step = transposed ? right.width : 1;
        const int column_step = transposed ? 1 : left.width;
        for (int b = 0; b < right.count; ++b) {
          const double factor = weight * right.value[b];
          double* column = h + static_cast<std::ptrdiff_t>(right.column[b]) * column_step;
          for (int a = 0; a < left.count; ++a) {
            column[left.column[a] * row_step] += factor * left.value[a];
          }
        }
      }
    }
  }
}

}  // namespace locograph::detail
