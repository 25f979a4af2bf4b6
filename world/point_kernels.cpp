#include <locograph/common/simd.h>
#include <locograph/world/point_kernels.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

#if defined(__AVX512F__)
LOCOGRAPH_INLINE Vector root(const Vector& v) { return (Vector)_mm512_sqrt_pd((__m512d)v); }
#elif defined(__AVX2__) && defined(__FMA__)
LOCOGRAPH_INLINE Vector root(const Vector& v) { return (Vector)_mm256_sqrt_pd((__m256d)v); }
#else
LOCOGRAPH_INLINE Vector root(Vector v) {
  for (int i = 0; i < kLanes; ++i) v[i] = __builtin_sqrt(v[i]);
  return v;
}
#endif
LOCOGRAPH_INLINE Vector all(double value) { return broadcast<Vector>(value); }
LOCOGRAPH_INLINE Vector least(const Vector& a, const Vector& b) { return b < a ? b : a; }
LOCOGRAPH_INLINE Vector most(const Vector& a, const Vector& b) { return b > a ? b : a; }
LOCOGRAPH_INLINE Vector size_of(const Vector& a) { return most(a, -a); }

struct Three {
  Vector x, y, z;
};

/// Lanes that points leave over have the coordinates 0.
LOCOGRAPH_INLINE Vector load_some(const double* from, int lanes) {
  return lanes == kLanes ? load(from) : load_partial(from, lanes);
}

/// Lowers nearest by distance_of(points, kLanes at a time).
template <class Distance>
LOCOGRAPH_INLINE void lower(const PointList& points, double* nearest, Distance&& distance_of) {
  for (int i = 0; i < points.count; i += kLanes) {
    const int lanes = smaller(kLanes, points.count - i);
    const Three p{load_some(points.x + i, lanes), load_some(points.y + i, lanes),
                  load_some(points.z + i, lanes)};
    const Vector found = least(load_some(nearest + i, lanes), distance_of(p));
    if (lanes == kLanes) {
      store(nearest + i, found);
    } else {
      store_partial(nearest + i, found, lanes);
    }
  }
}

LOCOGRAPH_INLINE Vector along(const double* axis, const Three& v) {
  return plus_product(plus_product(all(axis[2]) * v.z, all(axis[1]), v.y), all(axis[0]), v.x);
}
LOCOGRAPH_INLINE Three in_axes_of(const PlacedShape& shape, const Three& p) {
  const Three v{p.x - all(shape.origin[0]), p.y - all(shape.origin[1]), p.z - all(shape.origin[2])};
  return {along(shape.axes, v), along(shape.axes + 3, v), along(shape.axes + 6, v)};
}

void box(const PlacedShape& shape, const PointList& points, double* nearest) {
  lower(
      points, nearest, [&](const Three& p) __attribute__((always_inline)) {
        const Three at = in_axes_of(shape, p);
        const Vector x = size_of(at.x) - all(shape.size[0]), y = size_of(at.y) - all(shape.size[1]),
                     z = size_of(at.z) - all(shape.size[2]), none = all(0.0);
        const Vector ox = most(x, none), oy = most(y, none), oz = most(z, none);
        const Vector outside = root(plus_product(plus_product(oz * oz, oy, oy), ox, ox));
        return outside > none ? outside : most(most(x, y), z);
      });
}

void sphere(const PlacedShape& shape, const PointList& points, double* nearest) {
  lower(
      points, nearest, [&](const Three& p) __attribute__((always_inline)) {
        const Vector x = p.x - all(shape.origin[0]), y = p.y - all(shape.origin[1]),
                     z = p.z - all(shape.origin[2]);
        return root(plus_product(plus_product(z * z, y, y), x, x)) - all(shape.size[0]);
      });
}

void cylinder(const PlacedShape& shape, const PointList& points, double* nearest) {
  lower(
      points, nearest, [&](const Three& p) __attribute__((always_inline)) {
        const Three at = in_axes_of(shape, p);
        const Vector round = root(plus_product(at.y * at.y, at.x, at.x)) - all(shape.size[0]);
        const Vector over = size_of(at.z) - all(shape.size[1]), none = all(0.0);
        const Vector out_round = most(round, none), out_over = most(over, none);
        const Vector corner = root(plus_product(out_over * out_over, out_round, out_round));
        return corner > none ? corner : most(round, over);
      });
}

/// Indices of nodes, one for each lane. `Pair`: the values at a node and at the next one along z.
struct Pair {
  Vector here, next;
};
#if defined(__AVX512F__)
using Nodes = __m256i;
LOCOGRAPH_INLINE Nodes below(const Vector& cell, int nodes) {
  const Nodes first = _mm256_max_epi32(_mm512_cvttpd_epi32((__m512d)cell), _mm256_setzero_si256());
  return _mm256_min_epi32(first, _mm256_set1_epi32(nodes - 2));
}
LOCOGRAPH_INLINE Vector as_doubles(Nodes nodes) { return (Vector)_mm512_cvtepi32_pd(nodes); }
LOCOGRAPH_INLINE Nodes index_of(Nodes x, int dx, Nodes y, int dy, Nodes z) {
  return _mm256_add_epi32(_mm256_add_epi32(_mm256_mullo_epi32(x, _mm256_set1_epi32(dx)),
                                           _mm256_mullo_epi32(y, _mm256_set1_epi32(dy))),
                          z);
}
LOCOGRAPH_INLINE Pair pair_at(const float* values, Nodes at) {
  const __m512i both = _mm512_i32gather_epi64(at, (const long long*)values, 4);
  const __m256i here = _mm512_cvtepi64_epi32(both),
                next = _mm512_cvtepi64_epi32(_mm512_srli_epi64(both, 32));
  return {(Vector)_mm512_cvtps_pd((__m256)here), (Vector)_mm512_cvtps_pd((__m256)next)};
}
#elif defined(__AVX2__) && defined(__FMA__)
using Nodes = __m128i;
LOCOGRAPH_INLINE Nodes below(const Vector& cell, int nodes) {
  const Nodes first = _mm_max_epi32(_mm256_cvttpd_epi32((__m256d)cell), _mm_setzero_si128());
  return _mm_min_epi32(first, _mm_set1_epi32(nodes - 2));
}
LOCOGRAPH_INLINE Vector as_doubles(Nodes nodes) { return (Vector)_mm256_cvtepi32_pd(nodes); }
LOCOGRAPH_INLINE Nodes index_of(Nodes x, int dx, Nodes y, int dy, Nodes z) {
  return _mm_add_epi32(
      _mm_add_epi32(_mm_mullo_epi32(x, _mm_set1_epi32(dx)), _mm_mullo_epi32(y, _mm_set1_epi32(dy))),
      z);
}
LOCOGRAPH_INLINE Pair pair_at(const float* values, Nodes at) {
  const __m256i both = _mm256_i32gather_epi64((const long long*)values, at, 4);
  const __m256i apart =
      _mm256_permutevar8x32_epi32(both, _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7));
  return {(Vector)_mm256_cvtps_pd((__m128)_mm256_castsi256_si128(apart)),
          (Vector)_mm256_cvtps_pd((__m128)_mm256_extracti128_si256(apart, 1))};
}
#else
struct Nodes {
  int at[kLanes];
};
LOCOGRAPH_INLINE Nodes below(const Vector& cell, int nodes) {
  Nodes found;
  for (int i = 0; i < kLanes; ++i) {
    // One that is no number is neither.
    const double most = nodes - 2;
    found.at[i] = cell[i] > 0.0 ? static_cast<int>(cell[i] < most ? cell[i] : most) : 0;
  }
  return found;
}
LOCOGRAPH_INLINE Vector as_doubles(const Nodes& nodes) {
  Vector v;
  for (int i = 0; i < kLanes; ++i) v[i] = nodes.at[i];
  return v;
}
LOCOGRAPH_INLINE Nodes index_of(const Nodes& x, int dx, const Nodes& y, int dy, const Nodes& z) {
  Nodes found;
  for (int i = 0; i < kLanes; ++i) found.at[i] = x.at[i] * dx + y.at[i] * dy + z.at[i];
  return found;
}
LOCOGRAPH_INLINE Pair pair_at(const float* values, const Nodes& nodes) {
  Pair found;
  for (int i = 0; i < kLanes; ++i) {
    const float* at = values + nodes.at[i];
    found.here[i] = static_cast<double>(at[0]);
    found.next[i] = static_cast<double>(at[1]);
  }
  return found;
}
#endif

/// Whether a lane is above 0.
LOCOGRAPH_INLINE bool any_above_zero(const Vector& v) {
  double highest = 0.0;
  for (int i = 0; i < kLanes; ++i) highest = v[i] > highest ? v[i] : highest;
  return highest > 0.0;
}

LOCOGRAPH_INLINE Vector mix(const Vector& a, const Vector& b, const Vector& t) {
  return plus_product(a, t, b - a);
}

LOCOGRAPH_INLINE Pair mix(const Pair& a, const Pair& b, const Vector& t) {
  return {mix(a.here, b.here, t), mix(a.next, b.next, t)};
}

void field(const FieldNodes& f, const PointList& points, double* nearest) {
  const int dy = f.dimensions[2], dx = dy * f.dimensions[1];
  const Vector none = all(0.0), far = all(f.max_distance), per_metre = all(f.inverse_resolution),
               cut = all(static_cast<double>(static_cast<float>(f.max_distance)));
  lower(
      points, nearest, [&](const Three& p) __attribute__((always_inline)) {
        const Three c{least(most(p.x, all(f.lower[0])), all(f.upper[0])),
                      least(most(p.y, all(f.lower[1])), all(f.upper[1])),
                      least(most(p.z, all(f.lower[2])), all(f.upper[2]))};
        const Vector cx = (c.x - all(f.lower[0])) * per_metre,
                     cy = (c.y - all(f.lower[1])) * per_metre,
                     cz = (c.z - all(f.lower[2])) * per_metre;
        const Nodes x = below(cx, f.dimensions[0]), y = below(cy, f.dimensions[1]),
                    z = below(cz, f.dimensions[2]), at = index_of(x, dx, y, dy, z);
        const Vector tx = cx - as_doubles(x), ty = cy - as_doubles(y), tz = cz - as_doubles(z);
        const float* v = f.values;
        const Pair both = mix(mix(pair_at(v, at), pair_at(v + dx, at), tx),
                              mix(pair_at(v + dy, at), pair_at(v + dx + dy, at), tx), ty);
        Vector distance = mix(both.here, both.next, tz);
        distance = distance >= cut ? far : distance;
        const Vector ox = p.x - c.x, oy = p.y - c.y, oz = p.z - c.z;
        const Vector squared = plus_product(plus_product(oz * oz, oy, oy), ox, ox);
        if (!any_above_zero(squared)) return distance;
        // Beyond the nodes: see distance_field.h.
        const Vector beyond = distance > none ? root(plus_product(squared, distance, distance))
                                              : distance + root(squared);
        return least(squared > none ? beyond : distance, far);
      });
}

}  // namespace

const PointKernels point_kernels = {
    .box = box, .sphere = sphere, .cylinder = cylinder, .field = field};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
