#include <locograph/common/simd.h>
#include <locograph/solvers/level_tables.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

/// K, D: compile-time sizes, 0 where they are known at run time only.
template <int K, int D>
struct SizedKernels {
  static int dimension(const SchurColumn& column) { return D > 0 ? D : column.dimension; }
  static int rows(const SchurColumn& column, int i) {
    return K > 0 ? K : column.row_dimension[column.row[i]];
  }
  static double* block(const SchurColumn& column, int i) {
    if constexpr (K > 0) {
      return column.factor + static_cast<std::int64_t>(i) * K * dimension(column);
    } else {
      std::int64_t before = 0;
      for (int k = 0; k < i; ++k) before += rows(column, k);
      return column.factor + before * dimension(column);
    }
  }
  static double* diagonal(const SchurColumn& column) { return block(column, column.blocks); }

  static bool eliminate(const SchurColumn& column, const double* values, const double* damping) {
    const int d = dimension(column);
    double* l = diagonal(column);
    std::memcpy(l, values + (l - column.factor), sizeof(double) * d * d);
    for (int i = 0; i < d; ++i) l[i * d + i] += damping[i];
    if constexpr (D == 0) {
      if (dense_kernels.cholesky_in_place(l, d, d, d) >= 0) return false;
    } else {
      for (int j = 0; j < D; ++j) {
        const double pivot = l[j * D + j];
        if (!(pivot > 0.0 && pivot <= __DBL_MAX__)) return false;
        const double root = __builtin_sqrt(pivot), inverse = 1.0 / root;
        l[j * D + j] = root;
        for (int i = j + 1; i < D; ++i) l[j * D + i] *= inverse;
        for (int c = j + 1; c < D; ++c) {
          for (int i = c; i < D; ++i) {
            l[c * D + i] = minus_product(l[c * D + i], l[j * D + i], l[j * D + c]);
          }
        }
      }
    }
    // W = E L⁻ᵀ, column by column of each block.
    const double* from = values;
    double* to = column.factor;
    if constexpr (K > 0 && D > 0) {
      double inverse[D];
      for (int j = 0; j < D; ++j) inverse[j] = 1.0 / l[j * D + j];
      for (int b = 0; b < column.blocks; ++b, from += K * D, to += K * D) {
        double w[K * D];
        for (int j = 0; j < D; ++j) {
          for (int i = 0; i < K; ++i) w[j * K + i] = from[j * K + i];
          for (int k = 0; k < j; ++k) {
            for (int i = 0; i < K; ++i) {
              w[j * K + i] = minus_product(w[j * K + i], w[k * K + i], l[k * D + j]);
            }
          }
          for (int i = 0; i < K; ++i) w[j * K + i] *= inverse[j];
        }
        std::memcpy(to, w, sizeof w);
      }
    } else {
      for (int b = 0; b < column.blocks; ++b) {
        const int n = rows(column, b);
        for (int j = 0; j < d; ++j) {
          for (int i = 0; i < n; ++i) to[j * n + i] = from[j * n + i];
          for (int k = 0; k < j; ++k) {
            for (int i = 0; i < n; ++i) {
              to[j * n + i] = minus_product(to[j * n + i], to[k * n + i], l[k * d + j]);
            }
          }
          for (int i = 0; i < n; ++i) to[j * n + i] /= l[j * d + j];
        }
        from += n * d;
        to += n * d;
      }
    }
    return true;
  }

  /// Rows First … K − 1 of target (K × K) −= left rightᵀ, a power of two of them at a time.
  template <int First>
  static void subtract_rows(double* __restrict target, const double* __restrict left,
                            const double* __restrict right) {
    constexpr int kLeft = K - First;
    constexpr int kWidth = kLeft >= kLanes ? kLanes : kLeft >= 4 ? 4 : kLeft >= 2 ? 2 : 1;
    using Rows = typename Lanes<kWidth>::Type;
    Rows factors[D];
    for (int k = 0; k < D; ++k) factors[k] = load<Rows>(left + k * K + First);
    for (int c = 0; c < K; ++c) {
      Rows rows = load<Rows>(target + c * K + First);
      for (int k = 0; k < D; ++k) {
        rows = minus_product(rows, factors[k], broadcast<Rows>(right[k * K + c]));
      }
      store(target + c * K + First, rows);
    }
    if constexpr (First + kWidth < K) subtract_rows<First + kWidth>(target, left, right);
  }

  /// As many rows of target −= left rightᵀ (m × n) as are read and written at a time.
  template <class Load, class Store>
  LOCOGRAPH_INLINE static void subtract_some_rows(double* target, const double* left,
                                                  const double* right, int m, int n, int inner,
                                                  const Load& read, const Store& write) {
    for (int c = 0; c < n; ++c) {
      Vector rows = read(target + c * m);
      for (int k = 0; k < inner; ++k) {
        rows = minus_product(rows, read(left + k * m), broadcast<Vector>(right[k * n + c]));
      }
      write(target + c * m, rows);
    }
  }

  /// target (m × n) −= left rightᵀ
  static void subtract_product(double* __restrict target, const double* __restrict left,
                               const double* __restrict right, [[maybe_unused]] int m,
                               [[maybe_unused]] int n, [[maybe_unused]] int inner) {
    if constexpr (K > 0 && D > 0) {
      subtract_rows<0>(target, left, right);
    } else {
      if (m * n * inner > 4096) {
        dense_kernels.subtract_product(target, m, left, m, right, n, m, n, inner);
        return;
      }
      int row = 0;
      for (; row + kLanes <= m; row += kLanes) {
        subtract_some_rows(
            target + row, left + row, right, m, n, inner,
            [](const double* from) { return load(from); },
            [](double* to, const Vector& v) { store(to, v); });
      }
      if (const int rest = m - row; rest > 0) {
        subtract_some_rows(
            target + row, left + row, right, m, n, inner,
            [rest](const double* from) { return load_partial(from, rest); },
            [rest](double* to, const Vector& v) { store_partial(to, v, rest); });
      }
    }
  }

  static void subtract_products(const SchurColumn& column, int first, int last,
                                const std::int64_t* place, double* s) {
    const int d = dimension(column);
    const double* right = block(column, first);
    for (int j = first; j < last; ++j) {
      const std::int64_t* places = place + static_cast<std::int64_t>(j) * (j + 1) / 2;
      const int n = rows(column, j);
      const double* left = column.factor;
      for (int i = 0; i <= j; ++i) {
        const int m = rows(column, i);
        subtract_product(s + places[i], left, right, m, n, d);
        left += m * d;
      }
      right += n * d;
    }
  }

  static void subtract_squares(const SchurColumn& column, int first, int last,
                               const std::int64_t* place, double* out) {
    const int d = dimension(column);
    const double* w = block(column, first);
    for (int i = first; i < last; ++i) {
      const int n = rows(column, i);
      subtract_product(out + place[column.row[i]], w, w, n, n, d);
      w += n * d;
    }
  }

  static void solve_lower(const SchurColumn& column, double* t) {
    const int d = dimension(column);
    const double* l = diagonal(column);
    for (int j = 0; j < d; ++j) {
      t[j] /= l[j * d + j];
      for (int i = j + 1; i < d; ++i) t[i] = minus_product(t[i], l[j * d + i], t[j]);
    }
  }

  static void solve_lower_transposed(const SchurColumn& column, double* t) {
    const int d = dimension(column);
    const double* l = diagonal(column);
    for (int j = d - 1; j >= 0; --j) {
      for (int i = j + 1; i < d; ++i) t[j] = minus_product(t[j], l[j * d + i], t[i]);
      t[j] /= l[j * d + j];
    }
  }

  static void scatter(const SchurColumn& column, int first, int last, const double* t, double* y) {
    const int d = dimension(column);
    const double* w = block(column, first);
    for (int b = first; b < last; ++b) {
      const int n = rows(column, b);
      double* __restrict out = y + column.row_scalar[column.row[b]];
      for (int j = 0; j < d; ++j) {
        for (int i = 0; i < n; ++i) out[i] = minus_product(out[i], w[j * n + i], t[j]);
      }
      w += n * d;
    }
  }

  static void gather(const SchurColumn& column, const double* y, double* t) {
    const int d = dimension(column);
    const double* w = column.factor;
    for (int b = 0; b < column.blocks; ++b) {
      const int n = rows(column, b);
      const double* in = y + column.row_scalar[column.row[b]];
      for (int j = 0; j < d; ++j) {
        double sum = 0.0;
        for (int i = 0; i < n; ++i) sum = plus_product(sum, w[j * n + i], in[i]);
        t[j] -= sum;
      }
      w += n * d;
    }
  }

  static constexpr SchurKernels kTable = {eliminate,   subtract_products,      subtract_squares,
                                          solve_lower, solve_lower_transposed, scatter,
                                          gather};
};

}  // namespace

const SchurKernels& schur_kernels(int rows, int dimension) {
  if (rows == 9 && dimension == 3) return SizedKernels<9, 3>::kTable;
  if (rows == 6 && dimension == 3) return SizedKernels<6, 3>::kTable;
  if (rows == 6 && dimension == 1) return SizedKernels<6, 1>::kTable;
  if (rows == 3 && dimension == 2) return SizedKernels<3, 2>::kTable;
  // Points and inverse depths on rows of different sizes, or of a size that is rare.
  switch (dimension) {
    case 3:
      return SizedKernels<0, 3>::kTable;
    case 2:
      return SizedKernels<0, 2>::kTable;
    case 1:
      return SizedKernels<0, 1>::kTable;
    default:
      return SizedKernels<0, 0>::kTable;
  }
}

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
