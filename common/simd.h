#pragma once
/// The widest vector of doubles that a source is compiled for. Only for sources that are compiled
/// once for each level (cmake/LocographLevels.cmake): the width follows the flags, so no header but
/// these sources includes this one.
///
///     Vector v = load(from);  v = minus_product(v, v, broadcast<Vector>(2.0));  store(to, v);
///     store_partial(to, v, 3);                  // the first three lanes
///
/// Two rules keep the promises that the kernels make:
///
/// - A product and a sum are one operation, plus_product() or minus_product(): rounded once where
///   the processor has a fused multiply-add, twice where it has none. Left to the compiler
///   (-ffp-contract=fast), it fuses some unrolled copies of a loop and not others, and the bits
///   depend on how a matrix is cut. These sources are compiled with -ffp-contract=off.
/// - Nothing here or in these sources has linkage that the linker could use elsewhere, not even
///   std::min: a program has one copy of an inline function, and it would be any of them.

#include <cstdint>
#include <cstring>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#if !defined(LOCOGRAPH_SIMD_NAMESPACE)
#define LOCOGRAPH_SIMD_NAMESPACE simd_portable
#endif

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

#define LOCOGRAPH_INLINE inline __attribute__((always_inline))

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#elif defined(__AVX2__) && defined(__FMA__)
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif

/// N doubles; N at most kLanes.
template <int N>
struct Lanes;
template <>
struct Lanes<1> {
  using Type = double;
};
template <>
struct Lanes<2> {
  typedef double Type __attribute__((vector_size(16)));
};
template <>
struct Lanes<4> {
  typedef double Type __attribute__((vector_size(32)));
};
template <>
struct Lanes<8> {
  typedef double Type __attribute__((vector_size(64)));
};
using Vector = Lanes<kLanes>::Type;

constexpr int padded(int rows) { return (rows + kLanes - 1) & -kLanes; }
constexpr int smaller(int a, int b) { return a < b ? a : b; }
constexpr int larger(int a, int b) { return a < b ? b : a; }

template <class V = Vector>
LOCOGRAPH_INLINE V load(const double* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class V>
LOCOGRAPH_INLINE void store(double* to, const V& v) {
  std::memcpy(to, &v, sizeof v);
}

template <class V>
LOCOGRAPH_INLINE V broadcast(double value) {
  if constexpr (sizeof(V) == sizeof(double)) {
    return value;
  } else {
    return value - V{};  // −0 stays −0, so that a compiler may leave the difference out
  }
}

/// sum − a b and sum + a b.
#if defined(__FMA__)
LOCOGRAPH_INLINE double minus_product(double sum, double a, double b) {
  return __builtin_fma(-a, b, sum);
}
LOCOGRAPH_INLINE double plus_product(double sum, double a, double b) {
  return __builtin_fma(a, b, sum);
}
using Two = Lanes<2>::Type;
LOCOGRAPH_INLINE Two minus_product(const Two& sum, const Two& a, const Two& b) {
  return (Two)_mm_fnmadd_pd((__m128d)a, (__m128d)b, (__m128d)sum);
}
LOCOGRAPH_INLINE Two plus_product(const Two& sum, const Two& a, const Two& b) {
  return (Two)_mm_fmadd_pd((__m128d)a, (__m128d)b, (__m128d)sum);
}
using Four = Lanes<4>::Type;
LOCOGRAPH_INLINE Four minus_product(const Four& sum, const Four& a, const Four& b) {
  return (Four)_mm256_fnmadd_pd((__m256d)a, (__m256d)b, (__m256d)sum);
}
LOCOGRAPH_INLINE Four plus_product(const Four& sum, const Four& a, const Four& b) {
  return (Four)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)sum);
}
#if defined(__AVX512F__)
using Eight = Lanes<8>::Type;
LOCOGRAPH_INLINE Eight minus_product(const Eight& sum, const Eight& a, const Eight& b) {
  return (Eight)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)sum);
}
LOCOGRAPH_INLINE Eight plus_product(const Eight& sum, const Eight& a, const Eight& b) {
  return (Eight)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)sum);
}
#endif
#elif defined(__aarch64__)
LOCOGRAPH_INLINE double minus_product(double sum, double a, double b) {
  return __builtin_fma(-a, b, sum);
}
LOCOGRAPH_INLINE double plus_product(double sum, double a, double b) {
  return __builtin_fma(a, b, sum);
}
LOCOGRAPH_INLINE Vector minus_product(const Vector& sum, const Vector& a, const Vector& b) {
  return (Vector)vfmsq_f64((float64x2_t)sum, (float64x2_t)a, (float64x2_t)b);
}
LOCOGRAPH_INLINE Vector plus_product(const Vector& sum, const Vector& a, const Vector& b) {
  return (Vector)vfmaq_f64((float64x2_t)sum, (float64x2_t)a, (float64x2_t)b);
}
#else
template <class V>
LOCOGRAPH_INLINE V minus_product(const V& sum, const V& a, const V& b) {
  return sum - a * b;
}
template <class V>
LOCOGRAPH_INLINE V plus_product(const V& sum, const V& a, const V& b) {
  return sum + a * b;
}
#endif

/// The first `lanes` lanes, 1 ≤ lanes < kLanes, the others zero; nothing else is read or written.
#if defined(__AVX512F__)
LOCOGRAPH_INLINE Vector load_partial(const double* from, int lanes) {
  return (Vector)_mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << lanes) - 1u), from);
}
LOCOGRAPH_INLINE void store_partial(double* to, const Vector& v, int lanes) {
  _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << lanes) - 1u), (__m512d)v);
}
#elif defined(__AVX2__) && defined(__FMA__)
constexpr long long kMasks[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
LOCOGRAPH_INLINE Vector load_partial(const double* from, int lanes) {
  __m256i mask;
  std::memcpy(&mask, kMasks + 4 - lanes, sizeof mask);
  return (Vector)_mm256_maskload_pd(from, mask);
}
/// Not by a mask: a masked store takes a Zen processor dozens of micro-operations.
LOCOGRAPH_INLINE void store_partial(double* to, const Vector& v, int lanes) {
  const __m128d low = _mm256_castpd256_pd128((__m256d)v);
  const __m128d high = _mm256_extractf128_pd((__m256d)v, 1);
  if (lanes == 1) {
    _mm_store_sd(to, low);
  } else {
    _mm_storeu_pd(to, low);
    if (lanes == 3) _mm_store_sd(to + 2, high);
  }
}
#else
LOCOGRAPH_INLINE Vector load_partial(const double* from, int) { return Vector{*from, 0.0}; }
LOCOGRAPH_INLINE void store_partial(double* to, const Vector& v, int) { *to = v[0]; }
#endif

LOCOGRAPH_INLINE double sum(const Vector& v) {
  double total = v[0];
  for (int i = 1; i < kLanes; ++i) total += v[i];
  return total;
}

}  // namespace
}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
