#include <locograph/common/simd.h>
#include <locograph/core/row_kernels.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

/// A bit for each of the first n lanes, n ≤ kLanes, that is not 0.
#if defined(__AVX512F__)
LOCOGRAPH_INLINE std::uint64_t lanes_set(const double* from, int n) {
  const __mmask8 first = static_cast<__mmask8>((1u << n) - 1u);
  const __m512d v = _mm512_maskz_loadu_pd(first, from);
  return _mm512_cmp_pd_mask(v, _mm512_setzero_pd(), _CMP_NEQ_UQ);
}
#elif defined(__AVX2__) && defined(__FMA__)
LOCOGRAPH_INLINE std::uint64_t lanes_set(const double* from, int n) {
  const Vector v = n == kLanes ? load(from) : load_partial(from, n);
  return static_cast<std::uint64_t>(
      _mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, _mm256_setzero_pd(), _CMP_NEQ_UQ)));
}
#else
LOCOGRAPH_INLINE std::uint64_t lanes_set(const double* from, int n) {
  std::uint64_t set = 0;
  for (int i = 0; i < n; ++i) set |= static_cast<std::uint64_t>(from[i] != 0.0) << i;
  return set;
}
#endif

std::uint64_t entries(const double* from, int n) {
  std::uint64_t set = 0;
  for (int c = 0; c < n; c += kLanes) set |= lanes_set(from + c, smaller(kLanes, n - c)) << c;
  return set;
}

template <int Rows>
LOCOGRAPH_INLINE void add_products_of(const double* const* left, int n, const double* const* right,
                                      const double* weight, const int* columns, int count,
                                      double* to, long stride) {
  const int whole = n / kLanes * kLanes, rest = n - whole;
  for (int k = 0; k < count; ++k) {
    double factor[Rows];
#pragma GCC unroll 8
    for (int r = 0; r < Rows; ++r) factor[r] = weight[r] * right[r][columns[k]];
    double* column = to + columns[k] * stride;
    for (int i = 0; i < whole; i += kLanes) {
      Vector all = load(column + i);
#pragma GCC unroll 8
      for (int r = 0; r < Rows; ++r) {
        all = plus_product(all, broadcast<Vector>(factor[r]), load(left[r] + i));
      }
      store(column + i, all);
    }
    if (rest == 0) continue;
    Vector all = load_partial(column + whole, rest);
#pragma GCC unroll 8
    for (int r = 0; r < Rows; ++r) {
      all = plus_product(all, broadcast<Vector>(factor[r]), load_partial(left[r] + whole, rest));
    }
    store_partial(column + whole, all, rest);
  }
}

void add_products(int rows, const double* const* left, int n, const double* const* right,
                  const double* weight, const int* columns, int count, double* to, long stride) {
  switch (rows) {
#define LOCOGRAPH_ROWS(count_of_rows)                                                   \
  case count_of_rows:                                                                   \
    add_products_of<count_of_rows>(left, n, right, weight, columns, count, to, stride); \
    break
    LOCOGRAPH_ROWS(1);
    LOCOGRAPH_ROWS(2);
    LOCOGRAPH_ROWS(3);
    LOCOGRAPH_ROWS(4);
    LOCOGRAPH_ROWS(5);
    LOCOGRAPH_ROWS(6);
    LOCOGRAPH_ROWS(7);
    LOCOGRAPH_ROWS(8);
#undef LOCOGRAPH_ROWS
    default:
      break;
  }
}

}  // namespace

const RowKernels row_kernels = {.entries = entries, .add_products = add_products};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
