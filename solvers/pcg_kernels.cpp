#include <locograph/common/simd.h>
#include <locograph/solvers/level_tables.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

/// N × N blocks, N = 0: of any size.
template <int N>
struct SizedKernels {
  static void add(const double* __restrict a, [[maybe_unused]] int m, [[maybe_unused]] int n,
                  const double* __restrict x, double* __restrict y) {
    const int rows = N > 0 ? N : m, columns = N > 0 ? N : n;
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < rows; ++i) y[i] = plus_product(y[i], a[j * rows + i], x[j]);
    }
  }
  static void add_transposed(const double* __restrict a, [[maybe_unused]] int m,
                             [[maybe_unused]] int n, const double* __restrict x,
                             double* __restrict y) {
    const int rows = N > 0 ? N : m, columns = N > 0 ? N : n;
    for (int j = 0; j < columns; ++j) {
      double total = 0.0;
      for (int i = 0; i < rows; ++i) total = plus_product(total, a[j * rows + i], x[i]);
      y[j] += total;
    }
  }
  static void multiply(const double* __restrict a, [[maybe_unused]] int size,
                       const double* __restrict x, double* __restrict y) {
    const int n = N > 0 ? N : size;
    for (int i = 0; i < n; ++i) y[i] = 0.0;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) y[i] = plus_product(y[i], a[j * n + i], x[j]);
    }
  }
  static constexpr PcgKernels kTable = {add, add_transposed, multiply};
};

}  // namespace

const PcgKernels& pcg_kernels(int dimension) {
  switch (dimension) {
    case 3:
      return SizedKernels<3>::kTable;
    case 6:
      return SizedKernels<6>::kTable;
    case 9:
      return SizedKernels<9>::kTable;
    default:
      return SizedKernels<0>::kTable;
  }
}

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
