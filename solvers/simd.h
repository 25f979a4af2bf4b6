#pragma once
/// The widest vector of doubles this processor has, for the kernels of this folder only: its width
/// follows the flags a file is compiled with, so this header is included by .cpp files, never by
/// headers.
///
///     Vector v = load(from);  v -= v * 2.0;  store(to, v);
///     store_partial(to, v, 3);                  // the first three lanes

#include <cstring>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace locograph {
namespace {

#define LOCOGRAPH_INLINE inline __attribute__((always_inline))

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif
typedef double Vector __attribute__((vector_size(kLanes * sizeof(double))));

constexpr int padded(int rows) { return (rows + kLanes - 1) & -kLanes; }

LOCOGRAPH_INLINE Vector load(const double* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
LOCOGRAPH_INLINE void store(double* to, const Vector& v) { std::memcpy(to, &v, sizeof v); }

/// The first `lanes` lanes, the others zero; nothing else is read or written.
LOCOGRAPH_INLINE Vector load_partial(const double* from, int lanes) {
#if defined(__AVX512F__)
  return (Vector)_mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << lanes) - 1u), from);
#else
  Vector v = {};
  for (int i = 0; i < lanes; ++i) v[i] = from[i];
  return v;
#endif
}
LOCOGRAPH_INLINE void store_partial(double* to, const Vector& v, int lanes) {
#if defined(__AVX512F__)
  _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << lanes) - 1u), (__m512d)v);
#else
  for (int i = 0; i < lanes; ++i) to[i] = v[i];
#endif
}

/// to += from.
LOCOGRAPH_INLINE void add(double* to, const double* from, int count) {
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) store(to + i, load(to + i) + load(from + i));
  if (const int rest = count - i; rest != 0) {
    store_partial(to + i, load_partial(to + i, rest) + load_partial(from + i, rest), rest);
  }
}
/// The same for a block of rows × columns.
LOCOGRAPH_INLINE void add(double* to, long to_leading, const double* from, long from_leading,
                          int rows, int columns) {
  int i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    for (int j = 0; j < columns; ++j) {
      double* target = to + j * to_leading + i;
      store(target, load(target) + load(from + j * from_leading + i));
    }
  }
  if (const int rest = rows - i; rest != 0) {
    for (int j = 0; j < columns; ++j) {
      double* target = to + j * to_leading + i;
      store_partial(target,
                    load_partial(target, rest) + load_partial(from + j * from_leading + i, rest),
                    rest);
    }
  }
}
/// count: a multiple of the lanes.
LOCOGRAPH_INLINE void clear(double* to, long count) {
  for (long i = 0; i < count; i += kLanes) store(to + i, Vector{});
}

LOCOGRAPH_INLINE double sum(const Vector& v) {
  double total = v[0];
  for (int i = 1; i < kLanes; ++i) total += v[i];
  return total;
}

}  // namespace
}  // namespace locograph
