#pragma once
/// Small vertex and edge types that reach every path through the core: derivatives by hand, by dual
/// numbers and by differences; arity and sizes fixed or known at run time; derived quantities.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam2d/vertices.h>
#include <locograph/types/slam3d/vertices.h>

#include <cmath>
#include <limits>

namespace locograph::test {

enum class Derivatives { kByHand, kDual, kNumeric };

/// Scalars that error() of an edge accepts: an edge differentiated numerically knows double only.
template <class T, Derivatives D>
concept ScalarFor = D != Derivatives::kNumeric || std::is_same_v<T, double>;

/// Range and direction of a point from a planar pose. Error (2): (|d|, x·y) of d = A⁻¹ p, minus z.
template <Derivatives D>
struct ToyRange : Edge<2, VertexSE2, VertexXY> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  requires ScalarFor<T, D>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    const Eigen::Matrix<T, 2, 1> d = a.inverse_rotate(p - a.translation());
    e[0] = d.norm() - T(measurement[0]);
    e[1] = d[0] * d[1] - T(measurement[1]);
  }
  void jacobians(const SE2<double>& a, const Eigen::Vector2d& p, JacobianRef<ToyRange, 0> ja,
                 JacobianRef<ToyRange, 1> jp) const requires(D == Derivatives::kByHand) {
    const Eigen::Vector2d d = a.inverse_rotate(p - a.translation());
    const double c = std::cos(a.angle()), s = std::sin(a.angle());
    Eigen::Matrix2d by_d, back;
    by_d << d[0] / d.norm(), d[1] / d.norm(), d[1], d[0];
    back << c, s, -s, c;
    jp = by_d * back;
    ja.template leftCols<2>() = -by_d * back;
    ja.col(2) = by_d * Eigen::Vector2d(d[1], -d[0]);
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const ToyRange<D>*) {
  return D == Derivatives::kByHand ? "TOY_RANGE_HAND"
         : D == Derivatives::kDual ? "TOY_RANGE_DUAL"
                                   : "TOY_RANGE_NUMERIC";
}

/// Any number of points. Error (2): Σᵢ wᵢ (|pᵢ|², x sin y), wᵢ = 1 + i, minus z.
template <Derivatives D>
struct ToyMoments : DynamicEdge<2, VertexXY> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  requires ScalarFor<T, D>
  void error(std::span<const Eigen::Matrix<T, 2, 1>> points,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    using std::sin;
    e = -measurement.template cast<T>();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Matrix<T, 2, 1>& p = points[i];
      const T w(1.0 + static_cast<double>(i));
      e[0] += w * p.squaredNorm();
      e[1] += w * p[0] * sin(p[1]);
    }
  }
  void jacobians(std::span<const Eigen::Vector2d> points, std::span<JacobianMap> j) const
      requires(D == Derivatives::kByHand) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d& p = points[i];
      const double w = 1.0 + static_cast<double>(i);
      j[i] << 2.0 * w * p[0], 2.0 * w * p[1], w * std::sin(p[1]), w * p[0] * std::cos(p[1]);
    }
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const ToyMoments<D>*) {
  return D == Derivatives::kByHand ? "TOY_MOMENTS_HAND"
         : D == Derivatives::kDual ? "TOY_MOMENTS_DUAL"
                                   : "TOY_MOMENTS_NUMERIC";
}

/// A planar pose first, then any number of points. Error (3): Σᵢ of d = A⁻¹ pᵢ and |d|²/2.
template <Derivatives D>
struct ToyView : DynamicEdge<3, VertexXY, VertexSE2> {
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  requires ScalarFor<T, D>
  void error(const SE2<T>& a, std::span<const Eigen::Matrix<T, 2, 1>> points,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    e = -measurement.template cast<T>();
    for (const Eigen::Matrix<T, 2, 1>& p : points) {
      const Eigen::Matrix<T, 2, 1> d = a.inverse_rotate(p - a.translation());
      e.template head<2>() += d;
      e[2] += T(0.5) * d.squaredNorm();
    }
  }
  void jacobians(const SE2<double>& a, std::span<const Eigen::Vector2d> points,
                 std::span<JacobianMap> j) const requires(D == Derivatives::kByHand) {
    const double c = std::cos(a.angle()), s = std::sin(a.angle());
    Eigen::Matrix2d back;
    back << c, s, -s, c;
    j[0].setZero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d d = back * (points[i] - a.translation());
      Eigen::Matrix<double, 3, 2> by_p;
      by_p.topRows<2>() = back;
      by_p.row(2) = d.transpose() * back;
      j[i + 1] = by_p;
      j[0].leftCols<2>() -= by_p;
      // The turn leaves |d| as it is.
      j[0].block<2, 1>(0, 2) += Eigen::Vector2d(d[1], -d[0]);
    }
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const ToyView<D>*) {
  return D == Derivatives::kByHand ? "TOY_VIEW_HAND"
         : D == Derivatives::kDual ? "TOY_VIEW_DUAL"
                                   : "TOY_VIEW_NUMERIC";
}

/// A vertex whose size is known at run time. Fields: n, then n numbers.
struct VertexJoints : Vertex<Eigen::Dynamic, Eigen::Dynamic> {
  VertexJoints() = default;
  explicit VertexJoints(const Eigen::VectorXd& q) { state = q; }
  int dimension() const { return static_cast<int>(state.size()); }
  void oplus(const double* s, const double* d, double* out) const {
    for (int i = 0; i < dimension(); ++i) out[i] = s[i] + d[i];
  }
  void read(FieldReader& in) {
    const int size = in.integer();
    if (size < 1) in.fail("an arm without joints", "at least one");
    state.resize(size);
    read_field(in, state);
  }
  void write(FieldWriter& out) const {
    out.integer(dimension());
    write_field(out, state);
  }
  // What edges see: the arm's link directions, worked out once for each state.
  struct Derived {
    Eigen::VectorXd angle;  ///< of each link in the world
    Eigen::Vector2d tip = Eigen::Vector2d::Zero();
  };
  Derived make_derived() const { return {Eigen::VectorXd::Zero(dimension()), {}}; }
  void derive(const double* s, Derived& derived) const {
    double angle = 0.0;
    derived.tip.setZero();
    for (int i = 0; i < dimension(); ++i) {
      derived.angle[i] = angle += s[i];
      derived.tip += Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
  }
};
LOCOGRAPH_REGISTER_VERTEX("TOY_JOINTS", VertexJoints)

/// j = scale · ∂tip/∂q of a planar arm with links of 1 m.
inline void tip_jacobian(const VertexJoints::Derived& arm, double scale,
                         Eigen::Ref<Eigen::Matrix2Xd> j) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (Eigen::Index c = j.cols() - 1; c >= 0; --c) {
    sum += scale * Eigen::Vector2d(-std::sin(arm.angle[c]), std::cos(arm.angle[c]));
    j.col(c) = sum;
  }
}

/// The tip of one arm at a point. Error (2): tip − p.
template <Derivatives D>
struct ToyReach : Edge<2, VertexJoints, VertexXY> {
  void error(const VertexJoints::Derived& arm, const Eigen::Vector2d& p,
             Eigen::Ref<Eigen::Vector2d> e) const {
    e = arm.tip - p;
  }
  void jacobians(const VertexJoints::Derived& arm, const Eigen::Vector2d&,
                 JacobianRef<ToyReach, 0> ja, JacobianRef<ToyReach, 1> jp) const
      requires(D == Derivatives::kByHand) {
    tip_jacobian(arm, 1.0, ja);
    jp = -Eigen::Matrix2d::Identity();
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const ToyReach<D>*) {
  return D == Derivatives::kByHand ? "TOY_REACH_HAND" : "TOY_REACH_NUMERIC";
}

/// Two arms whose tips meet. Error (2): difference of the tips.
template <Derivatives D>
struct ToyMeet : Edge<2, VertexJoints, VertexJoints> {
  void error(const VertexJoints::Derived& a, const VertexJoints::Derived& b,
             Eigen::Ref<Eigen::Vector2d> e) const {
    e = a.tip - b.tip;
  }
  void jacobians(const VertexJoints::Derived& a, const VertexJoints::Derived& b,
                 JacobianRef<ToyMeet, 0> ja, JacobianRef<ToyMeet, 1> jb) const
      requires(D == Derivatives::kByHand) {
    tip_jacobian(a, 1.0, ja);
    tip_jacobian(b, -1.0, jb);
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const ToyMeet<D>*) {
  return D == Derivatives::kByHand ? "TOY_MEET_HAND" : "TOY_MEET_NUMERIC";
}

/// Any number of arms, of which the first leads. Error (2): tip of the leader − mean of the others.
template <Derivatives D>
struct ToyCarry : DynamicEdge<2, VertexJoints, VertexJoints> {
  void error(const VertexJoints::Derived& first, std::span<const VertexJoints::Derived* const> all,
             Eigen::Ref<Eigen::Vector2d> e) const {
    e = first.tip;
    for (const VertexJoints::Derived* arm : all) e -= arm->tip / static_cast<double>(all.size());
  }
  void jacobians(const VertexJoints::Derived& first,
                 std::span<const VertexJoints::Derived* const> all, std::span<JacobianMap> j) const
      requires(D == Derivatives::kByHand) {
    fill(first, 1.0, j[0]);
    for (std::size_t i = 0; i < all.size(); ++i) {
      fill(*all[i], -1.0 / static_cast<double>(all.size()), j[i + 1]);
    }
  }
  static void fill(const VertexJoints::Derived& arm, double scale, JacobianMap& j) {
    tip_jacobian(arm, scale, Eigen::Map<Eigen::Matrix2Xd>(j.data(), 2, j.cols()));
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const ToyCarry<D>*) {
  return D == Derivatives::kByHand ? "TOY_CARRY_HAND" : "TOY_CARRY_NUMERIC";
}

/// An error whose size is known at run time. Error (n): x of every point minus zᵢ, cyclically, and
/// quadratic in y.
struct ToySignal : DynamicEdge<Eigen::Dynamic, VertexXY> {
  Eigen::VectorXd measurement;
  auto fields() { return std::tie(measurement); }
  void resize(int dimension) { measurement.setZero(dimension); }

  void error(std::span<const Eigen::Vector2d> points, Eigen::Ref<Eigen::VectorXd> e) const {
    for (Eigen::Index r = 0; r < e.size(); ++r) {
      const Eigen::Vector2d& p = points[static_cast<std::size_t>(r) % points.size()];
      e[r] = p[0] + 0.1 * static_cast<double>(r + 1) * p[1] * p[1] - measurement[r];
    }
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_SIGNAL", ToySignal)

/// Holds an arm's angles. Error (n): q − z, n the number of joints.
struct ToyPosture : Edge<Eigen::Dynamic, VertexJoints> {
  Eigen::VectorXd measurement;
  auto fields() { return std::tie(measurement); }
  void resize(int dimension) { measurement.setZero(dimension); }

  void error(const VertexJoints::Derived& arm, Eigen::Ref<Eigen::VectorXd> e) const {
    for (Eigen::Index i = 0; i < e.size(); ++i) {
      e[i] = arm.angle[i] - (i > 0 ? arm.angle[i - 1] : 0.0) - measurement[i];
    }
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_POSTURE", ToyPosture)

/// Error (2): (atan x, y), on which Gauss-Newton diverges from |x| > 1.39.
struct ToyArctan : Edge<2, VertexXY> {
  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    using std::atan;
    e << atan(p[0]), p[1];
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_ARCTAN", ToyArctan)

/// Error (2) that is never a number.
struct ToyNotANumber : Edge<2, VertexXY> {
  void error(const Eigen::Vector2d&, Eigen::Ref<Eigen::Vector2d> e) const {
    e.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_NOT_A_NUMBER", ToyNotANumber)

}  // namespace locograph::test

namespace locograph {

// Compiled once, in toy_types.cpp.
extern template class TypedEdgePool<test::ToyRange<test::Derivatives::kByHand>>;
extern template class TypedEdgePool<test::ToyRange<test::Derivatives::kDual>>;
extern template class TypedEdgePool<test::ToyRange<test::Derivatives::kNumeric>>;
extern template class TypedEdgePool<test::ToyMoments<test::Derivatives::kByHand>>;
extern template class TypedEdgePool<test::ToyMoments<test::Derivatives::kDual>>;
extern template class TypedEdgePool<test::ToyMoments<test::Derivatives::kNumeric>>;
extern template class TypedEdgePool<test::ToyView<test::Derivatives::kByHand>>;
extern template class TypedEdgePool<test::ToyView<test::Derivatives::kDual>>;
extern template class TypedEdgePool<test::ToyView<test::Derivatives::kNumeric>>;
extern template class TypedEdgePool<test::ToyReach<test::Derivatives::kByHand>>;
extern template class TypedEdgePool<test::ToyReach<test::Derivatives::kNumeric>>;
extern template class TypedEdgePool<test::ToyMeet<test::Derivatives::kByHand>>;
extern template class TypedEdgePool<test::ToyMeet<test::Derivatives::kNumeric>>;
extern template class TypedEdgePool<test::ToyCarry<test::Derivatives::kByHand>>;
extern template class TypedEdgePool<test::ToyCarry<test::Derivatives::kNumeric>>;
extern template class TypedEdgePool<test::ToySignal>;
extern template class TypedEdgePool<test::ToyPosture>;

}  // namespace locograph
