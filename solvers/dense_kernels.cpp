#include <locograph/common/simd.h>
#include <locograph/solvers/level_tables.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

constexpr int kStrip = kLanes;   // columns of a tile: its top is a square of one register high
constexpr int kTileVectors = 3;  // 3 × 8 accumulators, 3 rows of A: 27 of the 32 registers
constexpr int kTileRows = kTileVectors * kLanes;
constexpr int kInner = 128;            // columns of A at a time: a strip of B stays in L1
constexpr int kRows = 20 * kTileRows;  // rows of A at a time: they stay in L2
constexpr int kPanel = 64;             // columns factored before the rest of the panel is updated

template <int R, bool kPartial>
LOCOGRAPH_INLINE Vector load_row(const double* from, int r, int last) {
  if (kPartial && r == R - 1) return load_partial(from + r * kLanes, last);
  return load(from + r * kLanes);
}
template <int R, bool kPartial>
LOCOGRAPH_INLINE void store_row(double* to, int r, const Vector& v, int last) {
  if (kPartial && r == R - 1) {
    store_partial(to + r * kLanes, v, last);
  } else {
    store(to + r * kLanes, v);
  }
}

/// t −= A Bᵀ, one register tile of R vectors × N columns.
template <int R, int N, bool kPartial>
LOCOGRAPH_INLINE void accumulate(Vector (&t)[R][N], const double* a, long lda, const double* b,
                                 long ldb, int k, int last) {
  for (int p = 0; p < k; ++p) {
    Vector left[R];
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) left[r] = load_row<R, kPartial>(a, r, last);
#pragma GCC unroll 8
    for (int n = 0; n < N; ++n) {
      const Vector factor = broadcast<Vector>(b[n]);
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) t[r][n] = minus_product(t[r][n], left[r], factor);
    }
    a += lda;
    b += ldb;
  }
}

template <int R, int N, bool kPartial>
LOCOGRAPH_INLINE void load_tile(Vector (&t)[R][N], const double* c, long ldc, int last) {
#pragma GCC unroll 8
  for (int n = 0; n < N; ++n) {
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) t[r][n] = load_row<R, kPartial>(c + n * ldc, r, last);
  }
}
template <int R, int N, bool kPartial>
LOCOGRAPH_INLINE void store_tile(const Vector (&t)[R][N], double* c, long ldc, int last) {
#pragma GCC unroll 8
  for (int n = 0; n < N; ++n) {
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) store_row<R, kPartial>(c + n * ldc, r, t[r][n], last);
  }
}

/// A strip of N columns, all that tiles of it have in common.
struct Strip {
  double* c;
  long ldc;
  const double* a;
  long lda;
  const double* b;
  long ldb;
  int k;
};

template <int R, int N, bool kPartial>
void product_tile(const Strip& s, long row, bool overwrite, int last) {
  Vector t[R][N];
  if (overwrite) {
#pragma GCC unroll 8
    for (int n = 0; n < N; ++n) {
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) t[r][n] = Vector{};
    }
  } else {
    load_tile<R, N, kPartial>(t, s.c + row, s.ldc, last);
  }
  accumulate<R, N, kPartial>(t, s.a + row, s.lda, s.b, s.ldb, s.k, last);
  store_tile<R, N, kPartial>(t, s.c + row, s.ldc, last);
}

/// As above, and then divided by the triangle on top of the strip.
template <int R, int N, bool kPartial>
void divide_tile(const Strip& s, long row, const double* l, long ldl, const double* inverse,
                 int last) {
  Vector t[R][N];
  load_tile<R, N, kPartial>(t, s.c + row, s.ldc, last);
  accumulate<R, N, kPartial>(t, s.a + row, s.lda, s.b, s.ldb, s.k, last);
#pragma GCC unroll 8
  for (int n = 0; n < N; ++n) {
#pragma GCC unroll 8
    for (int q = 0; q < n; ++q) {
      const Vector factor = broadcast<Vector>(l[q * ldl + n]);
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) t[r][n] = minus_product(t[r][n], t[r][q], factor);
    }
    const double factor = inverse[n];
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) t[r][n] *= factor;
  }
  store_tile<R, N, kPartial>(t, s.c + row, s.ldc, last);
}

/// A number that a lambda knows when it is compiled.
template <int kNumber>
struct Constant {
  static constexpr int value = kNumber;
};

/// Calls tile<R, partial>(row, last) over `rows` rows.
template <class Tile>
LOCOGRAPH_INLINE void for_each_tile(long row, long end, const Tile& tile) {
  constexpr Constant<1> one, yes;
  constexpr Constant<2> two;
  constexpr Constant<3> three;
  constexpr Constant<0> no;
  for (; row + kTileRows <= end; row += kTileRows) tile(three, no, row, kLanes);
  const int rest = static_cast<int>(end - row);
  if (rest == 0) return;
  const int vectors = (rest + kLanes - 1) / kLanes, last = rest - (vectors - 1) * kLanes;
  if (last == kLanes) {
    if (vectors == 1) tile(one, no, row, last);
    if (vectors == 2) tile(two, no, row, last);
  } else {
    if (vectors == 1) tile(one, yes, row, last);
    if (vectors == 2) tile(two, yes, row, last);
    if (vectors == 3) tile(three, yes, row, last);
  }
}

template <int N>
void product_strip(const Strip& s, long row, long end, bool overwrite) {
  for_each_tile(row, end, [&](auto vectors, auto partial, long at, int last) {
    product_tile<decltype(vectors)::value, N, decltype(partial)::value != 0>(s, at, overwrite,
                                                                             last);
  });
}

template <int N>
void divide_strip(const Strip& s, long row, long end, const double* l, long ldl,
                  const double* inverse) {
  for_each_tile(row, end, [&](auto vectors, auto partial, long at, int last) {
    divide_tile<decltype(vectors)::value, N, decltype(partial)::value != 0>(s, at, l, ldl, inverse,
                                                                            last);
  });
}

/// Updates and factors the square on top of a strip; what it has below, in the same register, is
/// divided as well. Returns the failing column or -1.
template <int N, bool kPartial>
int factor_square(const Strip& s, int last, double* inverse) {
  Vector t[1][N];
  load_tile<1, N, kPartial>(t, s.c, s.ldc, last);
  accumulate<1, N, kPartial>(t, s.a, s.lda, s.b, s.ldb, s.k, last);
  // What a column subtracts from the next is scaled by 1/pivot: no root waits for another.
  int failed = -1;
#pragma GCC unroll 8
  for (int j = 0; j < N; ++j) {
    const double pivot = t[0][j][j];
    if (!(pivot > 0.0 && pivot <= __DBL_MAX__)) {
      failed = j;
      break;
    }
    const double reciprocal = 1.0 / pivot;
#pragma GCC unroll 8
    for (int n = j + 1; n < N; ++n) {
      t[0][n] = minus_product(t[0][n], t[0][j], broadcast<Vector>(t[0][j][n] * reciprocal));
    }
    inverse[j] = reciprocal;
  }
  for (int j = 0; j < N; ++j) inverse[j] = __builtin_sqrt(inverse[j]);
#pragma GCC unroll 8
  for (int j = 0; j < N; ++j) t[0][j] *= inverse[j];
  store_tile<1, N, kPartial>(t, s.c, s.ldc, last);
  return failed;
}

template <int N>
int cholesky_strip(const Strip& s, long rows, double* inverse) {
  const int top = rows < kLanes ? static_cast<int>(rows) : kLanes;
  const int failed = top == kLanes ? factor_square<N, false>(s, top, inverse)
                                   : factor_square<N, true>(s, top, inverse);
  if (failed >= 0) return failed;
  divide_strip<N>(s, top, rows, s.c, s.ldc, inverse);
  return -1;
}

/// Calls f(Constant<width>()) for a width of 1 … kStrip.
template <int kWidth = 1, class F>
LOCOGRAPH_INLINE auto with_width(int width, const F& f) {
  if constexpr (kWidth == kStrip) {
    return f(Constant<kStrip>());
  } else {
    return width == kWidth ? f(Constant<kWidth>()) : with_width<kWidth + 1>(width, f);
  }
}

void product(double* c, long ldc, const double* a, long lda, const double* b, long ldb, int m,
             int n, int k, bool lower, bool overwrite) {
  for (int p = 0; p < k || (p == 0 && overwrite); p += kInner) {
    const int inner = smaller(kInner, k - p);
    for (int top = 0; top < m; top += kRows) {
      const int bottom = smaller(m, top + kRows);
      for (int j = 0; j < n && !(lower && j >= bottom); j += kStrip) {
        const Strip s = {c + j * ldc, ldc, a + p * lda, lda, b + p * ldb + j, ldb, inner};
        with_width(smaller(kStrip, n - j), [&](auto width) {
          product_strip<decltype(width)::value>(s, lower ? larger(top, j) : top, bottom,
                                                overwrite && p == 0);
        });
      }
    }
  }
}

void subtract_product(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m,
                      int n, int k) {
  product(c, ldc, a, lda, b, ldb, m, n, k, false, false);
}

void subtract_lower_product(double* c, int ldc, const double* a, int lda, int m, int n, int k) {
  product(c, ldc, a, lda, a, lda, m, n, k, true, false);
}

void negative_product(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m,
                      int n, int k, bool lower) {
  product(c, ldc, a, lda, b, ldb, m, n, k, lower, true);
}

int cholesky_in_place(double* panel, int leading_dimension, int rows, int columns) {
  const long ld = leading_dimension;
  double inverse[kStrip];
  for (int first = 0; first < columns; first += kPanel) {
    const int end = smaller(columns, first + kPanel);
    for (int j = first; j < end; j += kStrip) {
      const double* left = panel + first * ld + j;
      const Strip s = {panel + j * ld + j, ld, left, ld, left, ld, j - first};
      const int failed = with_width(smaller(kStrip, end - j), [&](auto width) {
        return cholesky_strip<decltype(width)::value>(s, rows - j, inverse);
      });
      if (failed >= 0) return j + failed;
    }
    if (end < columns) {
      subtract_lower_product(panel + end * ld + end, leading_dimension, panel + first * ld + end,
                             leading_dimension, rows - end, columns - end, end - first);
    }
  }
  return -1;
}

void divide_rows(double* x, int ldx, int rows, const double* l, int ldl, int n) {
  double inverse[kStrip];
  for (int first = 0; first < n; first += kPanel) {
    const int end = smaller(n, first + kPanel);
    for (int j = first; j < end; j += kStrip) {
      const int width = smaller(kStrip, end - j);
      const double* triangle = l + static_cast<long>(j) * ldl + j;
      for (int i = 0; i < width; ++i) inverse[i] = 1.0 / triangle[static_cast<long>(i) * ldl + i];
      const Strip s = {x + static_cast<long>(j) * ldx,
                       ldx,
                       x + static_cast<long>(first) * ldx,
                       ldx,
                       l + static_cast<long>(first) * ldl + j,
                       ldl,
                       j - first};
      with_width(width, [&](auto w) {
        divide_strip<decltype(w)::value>(s, 0, rows, triangle, ldl, inverse);
      });
    }
    if (end < n) {
      subtract_product(x + static_cast<long>(end) * ldx, ldx, x + static_cast<long>(first) * ldx,
                       ldx, l + static_cast<long>(first) * ldl + end, ldl, rows, n - end,
                       end - first);
    }
  }
}

void solve_lower(const double* l, int ld, int n, double* x) {
  for (int j = 0; j < n; ++j) {
    const double* column = l + static_cast<long>(j) * ld;
    const double value = x[j] /= column[j];
    for (int i = j + 1; i < n; ++i) x[i] = minus_product(x[i], column[i], value);
  }
}

void solve_lower_transposed(const double* l, int ld, int n, double* x) {
  for (int j = n - 1; j >= 0; --j) {
    const double* column = l + static_cast<long>(j) * ld;
    double sum = x[j];
    for (int i = j + 1; i < n; ++i) sum = minus_product(sum, column[i], x[i]);
    x[j] = sum / column[j];
  }
}

}  // namespace

const DenseKernels dense_kernels = {
    kLanes,           cholesky_in_place, subtract_product, subtract_lower_product,
    negative_product, divide_rows,       solve_lower,      solve_lower_transposed,
};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
