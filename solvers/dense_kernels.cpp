#include <locograph/solvers/dense_kernels.h>
#include <locograph/solvers/simd.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
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
      const double factor = b[n];
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) t[r][n] -= left[r] * factor;
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
      const double factor = l[q * ldl + n];
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) t[r][n] -= t[r][q] * factor;
    }
    const double factor = inverse[n];
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) t[r][n] *= factor;
  }
  store_tile<R, N, kPartial>(t, s.c + row, s.ldc, last);
}

/// Calls tile<R, partial>(row, last) over `rows` rows.
template <class Tile>
LOCOGRAPH_INLINE void for_each_tile(long row, long end, Tile&& tile) {
  constexpr auto one = std::integral_constant<int, 1>();
  constexpr auto two = std::integral_constant<int, 2>();
  constexpr auto three = std::integral_constant<int, 3>();
  for (; row + kTileRows <= end; row += kTileRows) tile(three, std::false_type(), row, kLanes);
  const int rest = static_cast<int>(end - row);
  if (rest == 0) return;
  const int vectors = (rest + kLanes - 1) / kLanes, last = rest - (vectors - 1) * kLanes;
  if (last == kLanes) {
    if (vectors == 1) tile(one, std::false_type(), row, last);
    if (vectors == 2) tile(two, std::false_type(), row, last);
  } else {
    if (vectors == 1) tile(one, std::true_type(), row, last);
    if (vectors == 2) tile(two, std::true_type(), row, last);
    if (vectors == 3) tile(three, std::true_type(), row, last);
  }
}

template <int N>
void product_strip(const Strip& s, long row, long end, bool overwrite) {
  for_each_tile(row, end, [&](auto vectors, auto partial, long at, int last) {
    product_tile<vectors, N, partial>(s, at, overwrite, last);
  });
}

template <int N>
void divide_strip(const Strip& s, long row, long end, const double* l, long ldl,
                  const double* inverse) {
  for_each_tile(row, end, [&](auto vectors, auto partial, long at, int last) {
    divide_tile<vectors, N, partial>(s, at, l, ldl, inverse, last);
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
    if (!(pivot > 0.0 && pivot <= std::numeric_limits<double>::max())) {
      failed = j;
      break;
    }
    const double reciprocal = 1.0 / pivot;
#pragma GCC unroll 8
    for (int n = j + 1; n < N; ++n) t[0][n] -= t[0][j] * (t[0][j][n] * reciprocal);
    inverse[j] = reciprocal;
  }
  for (int j = 0; j < N; ++j) inverse[j] = std::sqrt(inverse[j]);
#pragma GCC unroll 8
  for (int j = 0; j < N; ++j) t[0][j] *= inverse[j];
  store_tile<1, N, kPartial>(t, s.c, s.ldc, last);
  return failed;
}

template <int N>
int cholesky_strip(const Strip& s, long rows, double* inverse) {
  const int top = static_cast<int>(std::min<long>(rows, kLanes));
  const int failed = top == kLanes ? factor_square<N, false>(s, top, inverse)
                                   : factor_square<N, true>(s, top, inverse);
  if (failed >= 0) return failed;
  divide_strip<N>(s, top, rows, s.c, s.ldc, inverse);
  return -1;
}

/// Calls f(std::integral_constant<int, width>) for a width of 1 … kStrip.
template <class F>
LOCOGRAPH_INLINE auto with_width(int width, F&& f) {
  switch (width) {
    case 1:
      return f(std::integral_constant<int, 1>());
#if defined(__AVX__)
    case 3:
      return f(std::integral_constant<int, 3>());
    case 2:
      return f(std::integral_constant<int, 2>());
#endif
#if defined(__AVX512F__)
    case 4:
      return f(std::integral_constant<int, 4>());
    case 5:
      return f(std::integral_constant<int, 5>());
    case 6:
      return f(std::integral_constant<int, 6>());
    case 7:
      return f(std::integral_constant<int, 7>());
#endif
    default:
      return f(std::integral_constant<int, kStrip>());
  }
}

void product(double* c, long ldc, const double* a, long lda, const double* b, long ldb, int m,
             int n, int k, bool lower, bool overwrite) {
  for (int p = 0; p < k || (p == 0 && overwrite); p += kInner) {
    const int inner = std::min(kInner, k - p);
    for (int top = 0; top < m; top += kRows) {
      const int bottom = std::min(m, top + kRows);
      for (int j = 0; j < n && !(lower && j >= bottom); j += kStrip) {
        const Strip s = {c + j * ldc, ldc, a + p * lda, lda, b + p * ldb + j, ldb, inner};
        with_width(std::min(kStrip, n - j), [&](auto width) {
          product_strip<width>(s, lower ? std::max(top, j) : top, bottom, overwrite && p == 0);
        });
      }
    }
  }
}

}  // namespace

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
    const int end = std::min(columns, first + kPanel);
    for (int j = first; j < end; j += kStrip) {
      const double* left = panel + first * ld + j;
      const Strip s = {panel + j * ld + j, ld, left, ld, left, ld, j - first};
      const int failed = with_width(std::min(kStrip, end - j), [&](auto width) {
        return cholesky_strip<width>(s, rows - j, inverse);
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
    const int end = std::min(n, first + kPanel);
    for (int j = first; j < end; j += kStrip) {
      const int width = std::min(kStrip, end - j);
      const double* triangle = l + static_cast<long>(j) * ldl + j;
      for (int i = 0; i < width; ++i) inverse[i] = 1.0 / triangle[static_cast<long>(i) * ldl + i];
      const Strip s = {x + static_cast<long>(j) * ldx,
                       ldx,
                       x + static_cast<long>(first) * ldx,
                       ldx,
                       l + static_cast<long>(first) * ldl + j,
                       ldl,
                       j - first};
      with_width(width, [&](auto w) { divide_strip<w>(s, 0, rows, triangle, ldl, inverse); });
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
    for (int i = j + 1; i < n; ++i) x[i] -= column[i] * value;
  }
}

void solve_lower_transposed(const double* l, int ld, int n, double* x) {
  for (int j = n - 1; j >= 0; --j) {
    const double* column = l + static_cast<long>(j) * ld;
    double sum = x[j];
    for (int i = j + 1; i < n; ++i) sum -= column[i] * x[i];
    x[j] = sum / column[j];
  }
}

}  // namespace locograph
