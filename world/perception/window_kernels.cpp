#include <locograph/world/perception/window_kernels.h>

#include <cstring>

// Compiled once for each level: nothing of the standard library but memcpy and memset, nothing with
// linkage but the table.

#if !defined(LOCOGRAPH_SIMD_NAMESPACE)
#define LOCOGRAPH_SIMD_NAMESPACE simd_portable
#endif

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

#define LOCOGRAPH_INLINE inline __attribute__((always_inline))

using I8 = std::int8_t;
using U8 = std::uint8_t;
using I16 = std::int16_t;
using U16 = std::uint16_t;
using I32 = std::int32_t;

constexpr int kBlock = kVoxelBlock;
constexpr I32 kFloorBit = 1 << 30;

template <class T>
LOCOGRAPH_INLINE T smaller(T a, T b) {
  return a < b ? a : b;
}
template <class T>
LOCOGRAPH_INLINE T larger(T a, T b) {
  return a < b ? b : a;
}
LOCOGRAPH_INLINE int wrapped(int index, int size) { return index < size ? index : index - size; }

LOCOGRAPH_INLINE bool is_obstacle(I8 value, U8 first, U8 span) {
  return U8(U8(value) - first) <= span;
}

// ---- Minima of an image.

void pool(const PooledImage& image) {
  U16* const pairs = image.row;
  U16* const columns = image.row + image.width + 4;
  for (int level = 0; level < image.levels; ++level) {
    const int width = image.level_width[level], height = image.level_height[level];
    const int from_width = level == 0 ? image.width : image.level_width[level - 1];
    const U16* const from = level == 0 ? image.depth_mm : image.block + image.offset[level - 1];
    U16* const block = image.block + image.offset[level];
    const U16 unseen_last = level == 0 ? 1 : 0;  // depth - 1: 0 becomes the farthest
    for (int y = 0; y < height; ++y) {
      const U16* const upper = from + static_cast<std::size_t>(2 * y) * from_width;
      const U16* const lower = upper + from_width;
      for (int x = 0; x < from_width; ++x)
        pairs[x] = smaller(U16(upper[x] - unseen_last), U16(lower[x] - unseen_last));
      U16* const to = block + static_cast<std::size_t>(y) * width;
      for (int x = 0; x < width; ++x) to[x] = smaller(pairs[2 * x], pairs[2 * x + 1]);
    }
    for (int y = 0; y < height; ++y) {
      const U16* row[4];
      for (int k = 0; k < 4; ++k)
        row[k] = block + static_cast<std::size_t>(smaller(y + k, height - 1)) * width;
      for (int x = 0; x < width; ++x)
        columns[x] = smaller(smaller(row[0][x], row[1][x]), smaller(row[2][x], row[3][x]));
      for (int k = 0; k < 3; ++k) columns[width + k] = columns[width - 1];
      I32* const to = image.nearest + image.offset[level] + static_cast<std::size_t>(y) * width;
      for (int x = 0; x < width; ++x) {
        const U16 least =
            smaller(smaller(columns[x], columns[x + 1]), smaller(columns[x + 2], columns[x + 3]));
        to[x] = U16(least + 1);  // the farthest becomes 0
      }
    }
  }
}

// ---- Hits by pixel.

int mark_hits(const HitMarking& m) {
  const int nx = m.window.size[0], ny = m.window.size[1], nz = m.window.size[2];
  const int rx = m.window.ring[0], ry = m.window.ring[1], rz = m.window.ring[2];
  const float a0 = m.rotation[0], a1 = m.rotation[3], a2 = m.rotation[6];
  const float t0 = m.origin[0], t1 = m.origin[1], t2 = m.origin[2];
  const int nearest = m.nearest_mm, farthest = m.farthest_mm;
  const float floor = m.floor;
  const float* const column = m.column;
  const int width = m.width;
  I32* const __restrict code = m.code + 1;
  I32* const run = m.run;
  m.code[0] = -1;
  int count = 0;
  for (int v = 0; v < m.height; ++v) {
    const float y = (static_cast<float>(v) - m.cy) * m.inverse_fy;
    const float c0 = m.rotation[1] * y + m.rotation[2], c1 = m.rotation[4] * y + m.rotation[5],
                c2 = m.rotation[7] * y + m.rotation[8];
    const U16* const depth = m.depth_mm + static_cast<std::size_t>(v) * width;
    for (int u = 0; u < width; ++u) {
      const int d = depth[u];
      const float k = static_cast<float>(d);
      const float pz = (a2 * column[u] + c2) * k + t2;
      const int ix = static_cast<int>(__builtin_floorf((a0 * column[u] + c0) * k + t0));
      const int iy = static_cast<int>(__builtin_floorf((a1 * column[u] + c1) * k + t1));
      const int iz = static_cast<int>(__builtin_floorf(pz));
      const bool inside = (d >= nearest) & (d <= farthest) &
                          (static_cast<unsigned>(ix) < static_cast<unsigned>(nx)) &
                          (static_cast<unsigned>(iy) < static_cast<unsigned>(ny)) &
                          (static_cast<unsigned>(iz) < static_cast<unsigned>(nz));
      const int sx = ix + rx - (ix + rx >= nx ? nx : 0), sy = iy + ry - (iy + ry >= ny ? ny : 0),
                sz = iz + rz - (iz + rz >= nz ? nz : 0);
      const I32 voxel = (sz * ny + sy) * nx + sx + (pz < floor ? kFloorBit : 0);
      code[u] = inside ? voxel : -1;
    }
    int runs = 0;
    for (int u = 0; u < width; ++u) {
      run[runs] = u;
      runs += code[u] != code[u - 1];
    }
    run[runs] = width;
    for (int i = 0; i < runs; ++i) {
      const int begin = run[i];
      if (code[begin] < 0) continue;
      const I32 voxel = code[begin] & (kFloorBit - 1);
      const U8 before = m.hits[voxel];
      if (before == 0) m.touched[count++] = {voxel, depth[begin]};
      if (code[begin] & kFloorBit) {
        m.hits[voxel] = U8(before | kFloorSeen);
      } else {
        const int pixels = smaller<int>(kMostHits, (before & kMostHits) + run[i + 1] - begin);
        m.hits[voxel] = U8((before & kFloorSeen) | pixels);
      }
    }
  }
  return count;
}

// ---- Misses by voxel.

// For part of a row: is the nearest that the image shows around the voxel's centre beyond it?
LOCOGRAPH_INLINE void look_through(const MissMarking& m, int level, float x0, float y0, float z0,
                                   int begin, int end, I32* __restrict free) {
  const PooledImage& image = *m.image;
  const int width = image.level_width[level], last_u = width - 1,
            last_v = image.level_height[level] - 1;
  const I32* const __restrict nearest = image.nearest + image.offset[level];
  const float scale = 1.0f / static_cast<float>(2 << level);
  const float dx = m.step[0][0], dy = m.step[0][1], dz = m.step[0][2];
  const float fx = m.fx, fy = m.fy, cx = m.cx + 0.5f, cy = m.cy + 0.5f;
  const float half_foot = 0.5f * m.footprint_px_m, margin = m.margin_mm;
  for (int i = begin; i < end; ++i) {
    const float f = static_cast<float>(i);
    const float z = z0 + f * dz;
    const float inverse = 1.0f / z;
    const float foot = half_foot * inverse;
    const float u = (x0 + f * dx) * fx * inverse + cx - foot;
    const float v = (y0 + f * dy) * fy * inverse + cy - foot;
    const int bu = larger(0, smaller(static_cast<int>(u * scale), last_u));
    const int bv = larger(0, smaller(static_cast<int>(v * scale), last_v));
    free[i] = static_cast<float>(nearest[bv * width + bu]) - 1000.0f * z > margin ? 1 : 0;
  }
}

// Whether an obstacle came or went.
LOCOGRAPH_INLINE bool apply_misses(const MissMarking& m, std::size_t at, const I32* free) {
  const I8 miss = m.miss, least = m.least, saturated = I8(m.least + m.miss);
  const U8 first = m.obstacle.first, span = m.obstacle.span;
  I8* const odds = m.log_odds + at;
  const U8* const hits = m.hits + at;
  U8 flipped = 0, seen[kBlock];
  for (int x = 0; x < kBlock; ++x) seen[x] = free[x] != 0 ? 1 : 0;
  for (int x = 0; x < kBlock; ++x) {
    const I8 before = odds[x];
    const I8 base = before == kNeverSeen ? I8(0) : before;
    const I8 lower = base <= saturated ? least : I8(base - miss);
    const I8 after = (seen[x] != 0) & (hits[x] == 0) ? lower : before;
    odds[x] = after;
    flipped |= U8(is_obstacle(before, first, span) != is_obstacle(after, first, span));
  }
  if (m.age != nullptr) {
    U8* const age = m.age + at;
    for (int x = 0; x < kBlock; ++x) age[x] = (seen[x] != 0) & (hits[x] == 0) ? U8(0) : age[x];
  }
  return flipped != 0;
}

void mark_misses(const MissMarking& m) {
  const int nx = m.window.size[0], ny = m.window.size[1], nz = m.window.size[2];
  const int blocks = nx / kBlock;
  const PooledImage& image = *m.image;
  // Half-spaces a . p + b >= 0 of the optical frame that are seen.
  constexpr float kHalfPixel = 0.49f;
  const float planes[6][4] = {
      {0.0f, 0.0f, 1.0f, -m.nearest_m},
      {0.0f, 0.0f, -1.0f, m.farthest_m},
      {m.fx, 0.0f, m.cx + kHalfPixel, 0.0f},
      {-m.fx, 0.0f, static_cast<float>(image.width - 1) + kHalfPixel - m.cx, 0.0f},
      {0.0f, m.fy, m.cy + kHalfPixel, 0.0f},
      {0.0f, -m.fy, static_cast<float>(image.height - 1) + kHalfPixel - m.cy, 0.0f}};
  // A window of level l spans a footprint of 3 * 2^(l + 1) pixels wherever it begins: the level is
  // the first with z > footprint / (3 * 2^(l + 1)).
  float beyond[PooledImage::kMostLevels];
  for (int level = 0; level < image.levels; ++level)
    beyond[level] = m.footprint_px_m / (3.0f * static_cast<float>(2 << level));
  beyond[image.levels - 1] = 0.0f;
  const int seam = nx - m.window.ring[0];

  for (int z = 0; z < nz; ++z) {
    const int sz = wrapped(z + m.window.ring[2], nz);
    float row[3];
    for (int k = 0; k < 3; ++k) row[k] = m.first[k] + static_cast<float>(z) * m.step[2][k];
    float* const from = m.from;
    float* const to = m.to;
    for (int y = 0; y < ny; ++y) {
      from[y] = 0.0f;
      to[y] = static_cast<float>(nx - 1);
    }
    for (const float* a : planes) {
      const float start = a[0] * row[0] + a[1] * row[1] + a[2] * row[2] + a[3];
      const float per_y = a[0] * m.step[1][0] + a[1] * m.step[1][1] + a[2] * m.step[1][2];
      const float per_x = a[0] * m.step[0][0] + a[1] * m.step[0][1] + a[2] * m.step[0][2];
      constexpr float kLeast = 1e-9f;
      if (per_x >= 0.0f) {
        const float scale = -1.0f / larger(per_x, kLeast);
        for (int y = 0; y < ny; ++y)
          from[y] = larger(from[y], (start + static_cast<float>(y) * per_y) * scale);
      } else {
        const float scale = -1.0f / smaller(per_x, -kLeast);
        for (int y = 0; y < ny; ++y)
          to[y] = smaller(to[y], (start + static_cast<float>(y) * per_y) * scale);
      }
    }
    for (int y = 0; y < ny; ++y) {
      if (!(from[y] <= to[y])) continue;
      const int begin = static_cast<int>(__builtin_ceilf(from[y])),
                end = static_cast<int>(to[y]) + 1;
      if (begin >= end) continue;
      const int sy = wrapped(y + m.window.ring[1], ny);
      float at[3];
      for (int k = 0; k < 3; ++k) at[k] = row[k] + static_cast<float>(y) * m.step[1][k];
      const float per_x = m.step[0][2];
      for (int i = begin; i < end;) {
        const float depth = at[2] + static_cast<float>(i) * per_x;
        int level = 0;
        while (level + 1 < image.levels && depth <= beyond[level]) ++level;
        int stop = i < seam ? smaller(end, seam) : end;
        // Until the depth leaves the level's range.
        float limit = static_cast<float>(stop);
        if (per_x > 0.0f && level > 0) limit = (beyond[level - 1] - at[2]) / per_x;
        if (per_x < 0.0f) limit = (beyond[level] - at[2]) / per_x;
        if (limit < static_cast<float>(stop)) stop = larger(i + 1, static_cast<int>(limit) + 1);
        look_through(m, level, at[0], at[1], at[2], i, smaller(stop, end),
                     m.free + (i < seam ? nx - seam : -seam));
        i = stop;
      }
      // Where these voxels are stored: before the seam, and from 0 on after it.
      const std::size_t line = (static_cast<std::size_t>(sz) * ny + sy) * nx;
      const int shifted = nx - seam;
      const int first_begin = begin + shifted, first_end = smaller(end, seam) + shifted;
      const int second_begin = larger(begin, seam) - seam, second_end = end - seam;
      for (int b = 0; b < blocks; ++b) {
        const int low = b * kBlock, high = low + kBlock;
        const bool touched = (begin < seam && first_begin < high && first_end > low) ||
                             (end > seam && second_begin < high && second_end > low);
        if (!touched) continue;
        if (apply_misses(m, line + low, m.free + low)) m.changed[sy * blocks + b] = 1;
        std::memset(m.free + low, 0, kBlock * sizeof(I32));
      }
    }
  }
}

// ---- Forgetting.

void age(const Ageing& a) {
  const int blocks = a.window.size[0] / kBlock, rows = a.window.size[1] * a.window.size[2];
  const U8 most = a.most, first = a.obstacle.first, span = a.obstacle.span;
  for (int row = 0; row < rows; ++row) {
    for (int b = 0; b < blocks; ++b) {
      const std::size_t at = (static_cast<std::size_t>(row) * blocks + b) * kBlock;
      I8* const odds = a.log_odds + at;
      U8* const years = a.age + at;
      U8 flipped = 0;
      for (int x = 0; x < kBlock; ++x) {
        const U8 older = years[x] == 255 ? U8(255) : U8(years[x] + 1);
        years[x] = older;
        const I8 before = odds[x], after = older > most ? kNeverSeen : before;
        odds[x] = after;
        flipped |= U8(is_obstacle(before, first, span) != is_obstacle(after, first, span));
      }
      if (flipped != 0) a.changed[row % a.window.size[1] * blocks + b] = 1;
    }
  }
}

// ---- Distances.

void along_z(const DistancePasses& p) {
  const int nx = p.window.size[0], ny = p.window.size[1], nz = p.window.size[2];
  const int blocks = nx / kBlock;
  const std::size_t plane = static_cast<std::size_t>(nx) * ny;
  const U8 far = U8(p.cap + 1), outside = p.outside_is_obstacle ? U8(0) : far;
  const U8 first = p.obstacle.first, span = p.obstacle.span;
  for (int y = 0; y < ny; ++y) {
    for (int b = 0; b < blocks; ++b) {
      U8& wanted = p.changed_columns[y * blocks + b];
      if (wanted == 0) continue;
      wanted = 0;
      const std::size_t base = static_cast<std::size_t>(y) * nx + b * kBlock;
      U8 distance[kBlock];
      for (int x = 0; x < kBlock; ++x) distance[x] = outside;
      for (int z = 0; z < nz; ++z) {
        const I8* const odds = p.log_odds + base + wrapped(z + p.window.ring[2], nz) * plane;
        U8* const to = p.column + z * kBlock;
        for (int x = 0; x < kBlock; ++x) {
          const U8 next = smaller(far, U8(distance[x] + 1));
          distance[x] = is_obstacle(odds[x], first, span) ? U8(0) : next;
          to[x] = distance[x];
        }
      }
      for (int x = 0; x < kBlock; ++x) distance[x] = outside;
      for (int z = nz - 1; z >= 0; --z) {
        const int sz = wrapped(z + p.window.ring[2], nz);
        const U8* const up = p.column + z * kBlock;
        U8* const to = p.along_z + base + sz * plane;
        U8 difference = 0, least = far;
        for (int x = 0; x < kBlock; ++x) {
          const U8 next = smaller(far, U8(distance[x] + 1));
          distance[x] = smaller(up[x], next);
          difference |= U8(to[x] ^ distance[x]);
          least = smaller(least, distance[x]);
          to[x] = distance[x];
        }
        if (difference == 0) continue;
        const std::size_t row = (static_cast<std::size_t>(sz) * ny + y) * blocks + b;
        p.reached[row] = least < far ? 1 : 0;
        p.changed_z[row] = 1;
      }
    }
  }
}

// The least of at[d stride] + d^2 over |d| <= cap, or as many more as fill a group of four: those
// are beyond the cap.
LOCOGRAPH_INLINE void least_around(const I16* at, int stride, int cap, I16* least) {
  for (int x = 0; x < kBlock; ++x) least[x] = at[x];
  for (int d = 1; d <= cap; d += 4) {
    I16 most = 0;
    for (int x = 0; x < kBlock; ++x) most = larger(most, least[x]);
    if (most <= d * d) return;
    const I16 s0 = I16(d * d), s1 = I16((d + 1) * (d + 1)), s2 = I16((d + 2) * (d + 2)),
              s3 = I16((d + 3) * (d + 3));
    const I16 *const a0 = at - d * stride, *const a1 = a0 - stride, *const a2 = a1 - stride,
                     *const a3 = a2 - stride;
    const I16 *const b0 = at + d * stride, *const b1 = b0 + stride, *const b2 = b1 + stride,
                     *const b3 = b2 + stride;
    for (int x = 0; x < kBlock; ++x) {
      const I16 m0 = I16(smaller(a0[x], b0[x]) + s0), m1 = I16(smaller(a1[x], b1[x]) + s1),
                m2 = I16(smaller(a2[x], b2[x]) + s2), m3 = I16(smaller(a3[x], b3[x]) + s3);
      least[x] = smaller(least[x], smaller(smaller(m0, m1), smaller(m2, m3)));
    }
  }
}

LOCOGRAPH_INLINE bool replace_row(I16* to, const I16* from) {
  I16 difference = 0;
  for (int x = 0; x < kBlock; ++x) {
    difference |= I16(to[x] ^ from[x]);
    to[x] = from[x];
  }
  return difference != 0;
}

void along_y(const DistancePasses& p) {
  const int nx = p.window.size[0], ny = p.window.size[1], nz = p.window.size[2];
  const int blocks = nx / kBlock, cap = p.cap, reach = (cap + 3) & ~3;
  const I16 far = I16(cap * cap + 1), outside = p.outside_is_obstacle ? I16(0) : far;
  U8* const has = p.flags;                      // rows -reach … ny + reach: anything in them
  U8* const wanted = p.flags + ny + 2 * reach;  // rows 0 … ny
  for (int z = 0; z < nz; ++z) {
    for (int b = 0; b < blocks; ++b) {
      const std::size_t slice = static_cast<std::size_t>(z) * ny;
      int low = ny, high = 0;  // rows wanted
      std::memset(wanted, 0, ny);
      for (int y = 0; y < ny; ++y) {
        U8& changed = p.changed_z[(slice + wrapped(y + p.window.ring[1], ny)) * blocks + b];
        if (changed == 0) continue;
        changed = 0;
        const int begin = larger(larger(0, y - cap), high), end = smaller(ny, y + cap + 1);
        if (begin < end) std::memset(wanted + begin, 1, end - begin);
        low = smaller(low, larger(0, y - cap));
        high = end;
      }
      if (high == 0) continue;
      for (int y = low - reach; y < high + reach; ++y) {
        I16* const to = p.rows + (y + reach) * kBlock;
        U8& any = has[y + reach];
        any = 0;
        if (y < 0 || y >= ny) {
          any = p.outside_is_obstacle ? 1 : 0;
          for (int x = 0; x < kBlock; ++x) to[x] = outside;
          continue;
        }
        const std::size_t row = slice + wrapped(y + p.window.ring[1], ny);
        any = p.reached[row * blocks + b];
        const U8* const from = p.along_z + row * nx + b * kBlock;
        for (int x = 0; x < kBlock; ++x) {
          const I16 d = I16(from[x]);
          to[x] = smaller(far, I16(d * d));
        }
      }
      int near = 0;  // rows within reach that have anything
      for (int y = low - reach; y < low + reach; ++y) near += has[y + reach];
      for (int y = low; y < high; ++y) {
        near += has[y + 2 * reach];
        if (wanted[y] != 0) {
          I16 least[kBlock];
          if (near == 0) {
            for (int x = 0; x < kBlock; ++x) least[x] = far;
          } else {
            least_around(p.rows + (y + reach) * kBlock, kBlock, cap, least);
          }
          const std::size_t row = slice + wrapped(y + p.window.ring[1], ny);
          if (replace_row(p.along_y + row * nx + b * kBlock, least))
            p.changed_y[row * blocks + b] = 1;
        }
        near -= has[y];
      }
    }
  }
}

void along_x(const DistancePasses& p) {
  const int nx = p.window.size[0], ny = p.window.size[1], nz = p.window.size[2];
  const int blocks = nx / kBlock, cap = p.cap, reach = (cap + 3) & ~3, seam = nx - p.window.ring[0];
  const I16 far = I16(cap * cap + 1), outside = p.outside_is_obstacle ? I16(0) : far;
  I16* const line = p.line + reach;  // of the window; free of obstacles on both sides
  for (int x = 0; x < reach; ++x) line[x - reach] = line[nx + x] = outside;
  U8* const wanted = p.flags;         // blocks of the window
  U8* const near = p.flags + blocks;  // those that anything is near
  for (int row = 0; row < ny * nz; ++row) {
    U8* const changed = p.changed_y + static_cast<std::size_t>(row) * blocks;
    std::memset(wanted, 0, blocks);
    bool any = false;
    for (int b = 0; b < blocks; ++b) {
      if (changed[b] == 0) continue;
      changed[b] = 0;
      any = true;
      // Stored from low to high: one or two intervals of the window, which reach cap further.
      const int low = b * kBlock, high = low + kBlock - 1;
      const auto want = [&](int begin, int end) {
        for (int k = larger(0, begin - cap) / kBlock; k <= smaller(nx - 1, end + cap) / kBlock; ++k)
          wanted[k] = 1;
      };
      if (high < p.window.ring[0]) {
        want(low + seam, high + seam);
      } else if (low >= p.window.ring[0]) {
        want(low - p.window.ring[0], high - p.window.ring[0]);
      } else {
        want(low + seam, nx - 1);
        want(0, high - p.window.ring[0]);
      }
    }
    if (!any) continue;
    const I16* const from = p.along_y + static_cast<std::size_t>(row) * nx;
    I16* const to = p.squared + static_cast<std::size_t>(row) * nx;
    std::memcpy(line, from + nx - seam, seam * sizeof(I16));
    std::memcpy(line + seam, from, (nx - seam) * sizeof(I16));
    for (int b = 0; b < blocks; ++b) {
      I16 most_near = far;
      for (int x = b * kBlock; x < b * kBlock + kBlock; ++x)
        most_near = smaller(most_near, line[x]);
      near[b] = most_near < far ? 1 : 0;
    }
    for (int b = 0; b < blocks; ++b) {
      if (wanted[b] == 0) continue;
      const int x = b * kBlock;
      int sources = p.outside_is_obstacle ? 1 : 0;
      for (int k = larger(0, x - cap) / kBlock; k <= smaller(nx - 1, x + kBlock + cap) / kBlock;
           ++k)
        sources += near[k];
      I16 least[kBlock];
      if (sources == 0) {
        for (int k = 0; k < kBlock; ++k) least[k] = far;
      } else {
        least_around(line + x, 1, cap, least);
        for (int k = 0; k < kBlock; ++k) least[k] = smaller(least[k], far);
      }
      const int before_seam = larger(0, smaller(kBlock, seam - x));
      std::memcpy(to + nx - seam + x, least, before_seam * sizeof(I16));
      std::memcpy(to + x + before_seam - seam, least + before_seam,
                  (kBlock - before_seam) * sizeof(I16));
    }
  }
}

}  // namespace

const WindowKernels window_kernels = {.pool = pool,
                                      .mark_hits = mark_hits,
                                      .mark_misses = mark_misses,
                                      .age = age,
                                      .along_z = along_z,
                                      .along_y = along_y,
                                      .along_x = along_x};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
