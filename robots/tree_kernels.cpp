#include <locograph/common/simd.h>
#include <locograph/robots/tree_kernels.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

template <class V>
constexpr int kWidth = sizeof(V) / sizeof(double);

typedef long long Bits __attribute__((vector_size(sizeof(Vector))));

LOCOGRAPH_INLINE Bits bits_of(const Vector& v) { return (Bits)v; }
LOCOGRAPH_INLINE Vector from_bits(const Bits& bits) { return (Vector)bits; }
LOCOGRAPH_INLINE Vector all(double value) { return broadcast<Vector>(value); }

/// Coefficients, the one of the highest power first, of a polynomial in z.
template <int N>
LOCOGRAPH_INLINE Vector polynomial(const double (&coefficients)[N], const Vector& z) {
  Vector value = all(coefficients[0]);
#pragma GCC unroll 8
  for (int i = 1; i < N; ++i) value = plus_product(all(coefficients[i]), value, z);
  return value;
}

/// The remainder by pi / 2 in three parts (Cody & Waite 1980), then minimax polynomials on
/// [-pi/4, pi/4], those of the Cephes library; for |x| up to kFarthest.
constexpr double kFarthest = 1e5;
LOCOGRAPH_INLINE void sine_cosine(const Vector& x, Vector& sine, Vector& cosine) {
  constexpr double kTwoOverPi = 0.63661977236758134308, kRound = 6755399441055744.0;  // 1.5 2^52
  constexpr double kSine[] = {1.58962301576546568060e-10, -2.50507477628578072866e-8,
                              2.75573136213857245213e-6,  -1.98412698295895385996e-4,
                              8.33333333332211858878e-3,  -1.66666666666666307295e-1};
  constexpr double kCosine[] = {-1.13585365213876817300e-11, 2.08757008419747316778e-9,
                                -2.75573141792967388112e-7,  2.48015872888517045348e-5,
                                -1.38888888888730564116e-3,  4.16666666666665929218e-2};
  const Vector rounded = plus_product(all(kRound), x, all(kTwoOverPi));
  const Bits quarter = bits_of(rounded);
  const Vector k = rounded - all(kRound);
  Vector r = minus_product(x, k, all(1.5707963267341256));
  r = minus_product(r, k, all(6.0771005063039660e-11));
  r = minus_product(r, k, all(2.0222662487959506e-21));
  const Vector z = r * r;
  const Vector s = plus_product(r, r * z, polynomial(kSine, z));
  const Vector c =
      plus_product(minus_product(all(1.0), all(0.5), z), z * z, polynomial(kCosine, z));
  const Bits odd = (quarter & 1) != 0;
  sine = from_bits(bits_of(odd ? c : s) ^ ((quarter & 2) << 62));
  cosine = from_bits(bits_of(odd ? s : c) ^ (((quarter + 1) & 2) << 62));
}

/// Of n angles, n a multiple of kLanes.
LOCOGRAPH_INLINE void sines_cosines(int n, const double* angles, double* sines, double* cosines) {
  for (int i = 0; i < n; i += kLanes) {
    const Vector x = load(angles + i);
    Vector s, c;
    sine_cosine(x, s, c);
    store(sines + i, s);
    store(cosines + i, c);
    for (int l = 0; l < kLanes; ++l) {
      if (__builtin_fabs(x[l]) <= kFarthest) continue;
      sines[i + l] = __builtin_sin(x[l]);
      cosines[i + l] = __builtin_cos(x[l]);
    }
  }
}

// ------------------------------------------------------------------ lanes to configurations

/// Exchanges what lies beside the diagonal in blocks of S × S.
template <int S, class V>
LOCOGRAPH_INLINE void exchange(V& a, V& b) {
  constexpr int kW = kWidth<V>;
  constexpr auto first = [](int k) { return (k & S) != 0 ? k - S + kW : k; };
  constexpr auto second = [](int k) { return (k & S) != 0 ? k + kW : k + S; };
  const V was = a;
  if constexpr (kW == 8) {
    a = __builtin_shufflevector(was, b, first(0), first(1), first(2), first(3), first(4), first(5),
                                first(6), first(7));
    b = __builtin_shufflevector(was, b, second(0), second(1), second(2), second(3), second(4),
                                second(5), second(6), second(7));
  } else if constexpr (kW == 4) {
    a = __builtin_shufflevector(was, b, first(0), first(1), first(2), first(3));
    b = __builtin_shufflevector(was, b, second(0), second(1), second(2), second(3));
  } else {
    a = __builtin_shufflevector(was, b, first(0), first(1));
    b = __builtin_shufflevector(was, b, second(0), second(1));
  }
}
template <int S, class V, int W>
LOCOGRAPH_INLINE void exchange_all(V (&tile)[W]) {
  if constexpr (S < W) {
#pragma GCC unroll 8
    for (int i = 0; i < W; ++i) {
      if ((i & S) == 0) exchange<S>(tile[i], tile[i | S]);
    }
    exchange_all<2 * S>(tile);
  }
}

/// rows: n times one number for each lane of V; to(l) gets the n numbers of lane l.
template <class V, class To>
LOCOGRAPH_INLINE void hand_out(const double* rows, int n, int lanes, To&& to) {
  constexpr int kW = kWidth<V>;
  V tile[kW];
  int i = 0;
  for (; i + kW <= n; i += kW) {
#pragma GCC unroll 8
    for (int k = 0; k < kW; ++k) tile[k] = load<V>(rows + (i + k) * kW);
    exchange_all<1>(tile);
#pragma GCC unroll 8
    for (int l = 0; l < kW; ++l) {
      if (l < lanes) store(to(l) + i, tile[l]);
    }
  }
  for (; i < n; ++i) {
    for (int l = 0; l < lanes; ++l) to(l)[i] = rows[i * kW + l];
  }
}

// ------------------------------------------------------------------ kinematics

/// Where rows of as many numbers as there are lanes go.
struct Rows {
  double *links, *axes, *origins, *moments, *points[2];
};

/// The upper three rows of a pose, by column; in memory a whole 4 × 4 matrix.
template <class V>
struct Pose {
  V m[12];
};
template <class V>
LOCOGRAPH_INLINE Pose<V> load_pose(const double* rows, int link) {
  constexpr int kW = kWidth<V>;
  Pose<V> pose;
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) {
#pragma GCC unroll 3
    for (int r = 0; r < 3; ++r) pose.m[3 * c + r] = load<V>(rows + (16 * link + 4 * c + r) * kW);
  }
  return pose;
}
template <class V>
LOCOGRAPH_INLINE void store_pose(double* rows, int link, const Pose<V>& pose) {
  constexpr int kW = kWidth<V>;
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) {
    double* column = rows + (16 * link + 4 * c) * kW;
#pragma GCC unroll 3
    for (int r = 0; r < 3; ++r) store(column + r * kW, pose.m[3 * c + r]);
    store(column + 3 * kW, broadcast<V>(c == 3 ? 1.0 : 0.0));
  }
}

/// Row r of pose · (x y z w)ᵀ, w 0 or 1.
template <class V>
LOCOGRAPH_INLINE V turned(const Pose<V>& pose, int r, const V& x, const V& y, const V& z) {
  return plus_product(plus_product(pose.m[r] * x, pose.m[3 + r], y), pose.m[6 + r], z);
}
template <class V>
LOCOGRAPH_INLINE V moved(const Pose<V>& pose, int r, const V& x, const V& y, const V& z) {
  return plus_product(plus_product(plus_product(pose.m[9 + r], pose.m[r], x), pose.m[3 + r], y),
                      pose.m[6 + r], z);
}
template <class V>
LOCOGRAPH_INLINE Pose<V> product(const Pose<V>& a, const Pose<V>& b) {
  Pose<V> ab;
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) {
#pragma GCC unroll 3
    for (int r = 0; r < 3; ++r) {
      ab.m[3 * c + r] = turned(a, r, b.m[3 * c], b.m[3 * c + 1], b.m[3 * c + 2]);
    }
  }
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) ab.m[9 + r] = moved(a, r, b.m[9], b.m[10], b.m[11]);
  return ab;
}

/// A + u B + w C of a joint.
template <class V>
LOCOGRAPH_INLINE Pose<V> in_parent(const TreeAxis& axis, const V& u, const V& w) {
  Pose<V> pose;
#pragma GCC unroll 12
  for (int i = 0; i < 12; ++i) pose.m[i] = broadcast<V>(axis.a[i]);
  if (axis.revolute) {
#pragma GCC unroll 9
    for (int i = 0; i < 9; ++i) {
      pose.m[i] = plus_product(plus_product(pose.m[i], u, broadcast<V>(axis.b[i])), w,
                               broadcast<V>(axis.c[i]));
    }
  } else {
#pragma GCC unroll 3
    for (int i = 9; i < 12; ++i) pose.m[i] = plus_product(pose.m[i], u, broadcast<V>(axis.b[i]));
  }
  return pose;
}

/// q: x y z qx qy qz qw, each of all lanes.
template <class V>
LOCOGRAPH_INLINE Pose<V> base_pose(const V (&q)[7]) {
  const V one = broadcast<V>(1.0), two = broadcast<V>(2.0);
  const V &x = q[3], &y = q[4], &z = q[5], &w = q[6];
  const V xx = two * x * x, yy = two * y * y, zz = two * z * z, xy = two * x * y, xz = two * x * z,
          yz = two * y * z, wx = two * w * x, wy = two * w * y, wz = two * w * z;
  return {{one - (yy + zz), xy + wz, xz - wy, xy - wz, one - (xx + zz), yz + wx, xz + wy, yz - wx,
           one - (xx + yy), q[0], q[1], q[2]}};
}

template <class V>
LOCOGRAPH_INLINE Pose<V> root_pose(const TreeView& tree, int lanes, const TreeState* states) {
  constexpr int kW = kWidth<V>;
  if (!tree.floating_base) {
    Pose<V> pose;
#pragma GCC unroll 12
    for (int i = 0; i < 12; ++i) pose.m[i] = broadcast<V>(i == 0 || i == 4 || i == 8 ? 1.0 : 0.0);
    return pose;
  }
  V q[7];
  for (int i = 0; i < 7; ++i) {
    double of_lanes[kW];
    for (int l = 0; l < kW; ++l) of_lanes[l] = states[smaller(l, lanes - 1)].q[i];
    q[i] = load<V>(of_lanes);
  }
  return base_pose(q);
}

/// Mass times centre of mass, and mass, of what moves with a body.
template <class V>
LOCOGRAPH_INLINE void store_moment(double* rows, const Pose<V>& pose, const double* moment,
                                   double mass, double subtree_mass) {
  constexpr int kW = kWidth<V>;
  const V x = broadcast<V>(moment[0]), y = broadcast<V>(moment[1]), z = broadcast<V>(moment[2]);
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) {
    store(rows + r * kW, plus_product(turned(pose, r, x, y, z), pose.m[9 + r], broadcast<V>(mass)));
  }
  store(rows + 3 * kW, broadcast<V>(subtree_mass));
}

/// Of at most as many configurations as V has lanes, to rows; angles: 3 × padded(axes × lanes)
/// numbers.
template <class V>
LOCOGRAPH_INLINE void update_some(const TreeView& tree, const PointsView* points, int lanes,
                                  const TreeState* states, const Rows& to, double* angles) {
  constexpr int kW = kWidth<V>;
  const int n = padded(tree.axis_count * kW), base = tree.floating_base ? 7 : 0;
  double *sines = angles + n, *cosines = sines + n;
  for (int i = 0; i < tree.axis_count; ++i) {
    const TreeAxis& axis = tree.axes[i];
    for (int l = 0; l < kW; ++l) {
      const double joint = states[smaller(l, lanes - 1)].q[base + axis.active];
      angles[i * kW + l] = plus_product(axis.offset, axis.multiplier, joint);
    }
  }
  for (int i = tree.axis_count * kW; i < n; ++i) angles[i] = 0.0;
  sines_cosines(n, angles, sines, cosines);

  const Pose<V> root = root_pose<V>(tree, lanes, states);
  store_pose(to.links, 0, root);
  store_moment(to.moments, root, tree.moment, tree.mass, tree.subtree_mass);
  for (int i = 0; i < tree.axis_count; ++i) {
    const TreeAxis& axis = tree.axes[i];
    const V u = load<V>((axis.revolute ? sines : angles) + i * kW), w = load<V>(cosines + i * kW);
    const Pose<V> pose = product(load_pose<V>(to.links, axis.parent_link), in_parent(axis, u, w));
    store_pose(to.links, axis.link, pose);
    store_moment(to.moments + 4 * (i + 1) * kW, pose, axis.moment, axis.mass, axis.subtree_mass);
    const V x = broadcast<V>(axis.axis[0]), y = broadcast<V>(axis.axis[1]),
            z = broadcast<V>(axis.axis[2]);
#pragma GCC unroll 3
    for (int r = 0; r < 3; ++r) {
      store(to.axes + (3 * i + r) * kW, turned(pose, r, x, y, z));
      store(to.origins + (3 * i + r) * kW, pose.m[9 + r]);
    }
  }
  for (int i = 0; i < tree.rigid_link_count; ++i) {
    const TreeLink& link = tree.rigid_links[i];
    Pose<V> in_body;
#pragma GCC unroll 12
    for (int k = 0; k < 12; ++k) in_body.m[k] = broadcast<V>(link.pose[k]);
    store_pose(to.links, link.link, product(load_pose<V>(to.links, link.body_link), in_body));
  }
  for (int i = tree.axis_count - 1; i >= 0; --i) {
    const double* own = to.moments + 4 * (i + 1) * kW;
    double* of_parent = to.moments + 4 * tree.axes[i].parent_body * kW;
    for (int r = 0; r < 3; ++r) {
      store(of_parent + r * kW, load<V>(of_parent + r * kW) + load<V>(own + r * kW));
    }
  }
  for (int k = 0; k < 2; ++k) {
    const int count = points[k].count;
    for (int i = 0; i < count; ++i) {
      const LinkPoint& point = points[k].points[i];
      const Pose<V> pose = load_pose<V>(to.links, point.link);
      const V x = broadcast<V>(point.at[0]), y = broadcast<V>(point.at[1]),
              z = broadcast<V>(point.at[2]);
#pragma GCC unroll 3
      for (int r = 0; r < 3; ++r) {
        store(to.points[k] + (r * count + i) * kW, moved(pose, r, x, y, z));
      }
    }
  }
}

/// Rows of all lanes, one after the other, and the angles after them.
struct Sizes {
  int links, axes, moments, points[2];

  Sizes(const TreeView& tree, const PointsView* lists)
      : links(16 * tree.link_count),
        axes(3 * tree.axis_count),
        moments(4 * (tree.axis_count + 1)),
        points{3 * lists[0].count, 3 * lists[1].count} {}
  long rows() const { return links + 2L * axes + moments + points[0] + points[1]; }
};

long work(const TreeView& tree, const PointsView* points) {
  return kLanes * (Sizes(tree, points).rows() + 3L * (tree.axis_count + 1));
}

/// Of at most as many configurations as V has lanes, by way of `work`.
template <class V>
LOCOGRAPH_INLINE void update_lanes(const TreeView& tree, const PointsView* points, int lanes,
                                   const TreeState* some, double* work) {
  constexpr int kW = kWidth<V>;
  const Sizes sizes(tree, points);
  double* const links = work;
  double* const axes = links + kW * sizes.links;
  double* const origins = axes + kW * sizes.axes;
  double* const moments = origins + kW * sizes.axes;
  double* const first = moments + kW * sizes.moments;
  double* const second = first + kW * sizes.points[0];
  double* const angles = second + kW * sizes.points[1];
  update_some<V>(tree, points, lanes, some, {links, axes, origins, moments, {first, second}},
                 angles);
  hand_out<V>(links, sizes.links, lanes, [&](int l) { return some[l].world_from_link; });
  hand_out<V>(axes, sizes.axes, lanes, [&](int l) { return some[l].joint_axis; });
  hand_out<V>(origins, sizes.axes, lanes, [&](int l) { return some[l].joint_origin; });
  hand_out<V>(moments, sizes.moments, lanes, [&](int l) { return some[l].subtree_moment; });
  hand_out<V>(first, sizes.points[0], lanes, [&](int l) { return some[l].points[0]; });
  hand_out<V>(second, sizes.points[1], lanes, [&](int l) { return some[l].points[1]; });
}

void update(const TreeView& tree, const PointsView* points, int count, const TreeState* states,
            double* work) {
  while (count > 1) {
    const int lanes = smaller(kLanes, count);
    if constexpr (kLanes > 2) {
      using Half = Lanes<kLanes / 2>::Type;
      if (lanes <= kLanes / 2) {
        update_lanes<Half>(tree, points, lanes, states, work);
        return;
      }
    }
    update_lanes<Vector>(tree, points, lanes, states, work);
    states += lanes;
    count -= lanes;
  }
  if (count == 0) return;
  update_some<double>(tree, points, 1, states,
                      {states->world_from_link,
                       states->joint_axis,
                       states->joint_origin,
                       states->subtree_moment,
                       {states->points[0], states->points[1]}},
                      work);
}

}  // namespace

const TreeKernels tree_kernels = {.work = work, .update = update};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
