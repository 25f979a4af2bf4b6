#include <locograph/common/simd.h>
#include <locograph/solvers/level_tables.h>

#include <utility>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

template <int N>
void forward_strip(const double* panel, long ld, long first, long rows, double* x) {
  double value[N];
  for (int j = 0; j < N; ++j) {
    double v = x[j];
    for (int k = 0; k < j; ++k) v = minus_product(v, panel[k * ld + j], value[k]);
    x[j] = value[j] = v / panel[j * ld + j];
  }
  long i = first;
  for (; i + kLanes <= rows; i += kLanes) {
    Vector v = load(x + i);
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j) {
      v = minus_product(v, load(panel + j * ld + i), broadcast<Vector>(value[j]));
    }
    store(x + i, v);
  }
  if (const int rest = static_cast<int>(rows - i); rest > 0) {
    Vector v = load_partial(x + i, rest);
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j) {
      v = minus_product(v, load_partial(panel + j * ld + i, rest), broadcast<Vector>(value[j]));
    }
    store_partial(x + i, v, rest);
  }
}

template <int N>
void backward_strip(const double* panel, long ld, long first, long rows, double* x) {
  Vector total[N] = {};
  long i = first;
  for (; i + kLanes <= rows; i += kLanes) {
    const Vector v = load(x + i);
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j) total[j] = plus_product(total[j], load(panel + j * ld + i), v);
  }
  if (const int rest = static_cast<int>(rows - i); rest > 0) {
    const Vector v = load_partial(x + i, rest);
#pragma GCC unroll 8
    for (int j = 0; j < N; ++j) {
      total[j] = plus_product(total[j], load_partial(panel + j * ld + i, rest), v);
    }
  }
  for (int j = N - 1; j >= 0; --j) {
    double v = x[j] - sum(total[j]);
    for (int k = j + 1; k < N; ++k) v = minus_product(v, panel[j * ld + k], x[k]);
    x[j] = v / panel[j * ld + j];
  }
}

using Strip = void (*)(const double* panel, long ld, long first, long rows, double* x);

template <bool kBackward, int... N>
constexpr auto strips(std::integer_sequence<int, N...>) {
  struct Table {
    Strip by_width[kLanes];
  };
  return Table{{(kBackward ? &backward_strip<N + 1> : &forward_strip<N + 1>)...}};
}
constexpr auto kForward = strips<false>(std::make_integer_sequence<int, kLanes>());
constexpr auto kBackward = strips<true>(std::make_integer_sequence<int, kLanes>());

void forward(const double* panel, int leading_dimension, int rows, int columns, double* x,
             bool is_padded) {
  const long ld = leading_dimension;
  for (int j = 0; j < columns; j += kLanes) {
    const int width = smaller(kLanes, columns - j);
    kForward.by_width[width - 1](panel + j * ld + j, ld, is_padded ? kLanes : width, rows - j,
                                 x + j);
  }
}

void backward(const double* panel, int leading_dimension, int rows, int columns, double* x,
              bool is_padded) {
  const long ld = leading_dimension;
  for (int j = padded(columns) - kLanes; j >= 0; j -= kLanes) {
    const int width = smaller(kLanes, columns - j);
    kBackward.by_width[width - 1](panel + j * ld + j, ld, is_padded ? kLanes : width, rows - j,
                                  x + j);
  }
}

}  // namespace

const PanelSolve panel_solve = {forward, backward};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
