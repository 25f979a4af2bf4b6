#pragma once
/// An edge type: an error on a few vertices, weighted by its information matrix Ω.
///
///     /// Range between a planar pose and a landmark. Error (1): measured − predicted [m].
///     struct EdgeRange : Edge<1, VertexSE2, VertexXY> {
///       double range_m = 0.0;
///       auto fields() { return std::tie(range_m); }               // saved and loaded
///       template <class T>
///       void error(const SE2<T>& pose, const Eigen::Matrix<T, 2, 1>& point,
///                  Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
///         e[0] = range_m - (point - pose.translation()).norm();
///       }
///     };
///     LOCOGRAPH_REGISTER_EDGE("RANGE_SE2_XY", EdgeRange)
///
/// Derivatives, the first that applies:
///  1. by hand: void jacobians(views…, JacobianRef<E, 0>, JacobianRef<E, 1>, …) const, each
///     (error × tangent of that vertex);
///  2. dual numbers, when error() is a template over the scalar (see dual.h);
///  3. central differences on local copies of the states, for opaque functions of double.
///
/// A DynamicEdge has its arity chosen at run time: any number of `Many` vertices, after the fixed
/// `Leading` ones. It takes the same path through the solver; error() receives the many as a span:
///
///     /// Centroid of some points. Error (2): centroid − measured [m].
///     struct EdgeCentroid : DynamicEdge<2, VertexXY> {
///       Eigen::Vector2d measured = Eigen::Vector2d::Zero();
///       auto fields() { return std::tie(measured); }
///       template <class T>
///       void error(std::span<const Eigen::Matrix<T, 2, 1>> points,
///                  Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
///         e = -measured.cast<T>();
///         const double share = 1.0 / static_cast<double>(points.size());
///         for (const Eigen::Matrix<T, 2, 1>& p : points) e += T(share) * p;
///       }
///     };
///     LOCOGRAPH_REGISTER_EDGE("CENTROID_XY", EdgeCentroid)
///
/// Optional members: fields() names what is saved besides ids and information (without it nothing
/// is); bind(const Parameters&) looks up shared parameters before use; check(const Graph&) const
/// throws Error for vertices that it does not fit, when it is read or added; predict_first and
/// predict_second (binary edges) give one vertex's view from the other's, for initial guesses. An
/// error size known at run time only is Eigen::Dynamic and hides dimension(). kRowsPerVertex
/// (DynamicEdge): the error has so many rows for each of the many vertices, and files count the
/// vertices, not the rows. Every edge carries its vertices, information and robust kernel by value.
///
/// An edge that reads a parameter which a workspace may stand another one in for (bindings.h) takes
/// const Bindings& as the last argument of error() and of jacobians(), and asks it:
///
///     /// Range whose offset may be bound. Error (1): measured + offset − predicted [m].
///     struct EdgeOffsetRange : Edge<1, VertexSE2, VertexXY> {
///       int offset_number = 0;
///       double range_m = 0.0;
///       std::shared_ptr<const RangeOffset> offset;              // the graph's own
///       auto fields() { return std::tie(offset_number, range_m); }
///       void bind(const Parameters& p) { offset = p.get<RangeOffset>(offset_number); }
///       template <class T>
///       void error(const SE2<T>& pose, const Eigen::Matrix<T, 2, 1>& point,
///                  Eigen::Ref<Eigen::Matrix<T, 1, 1>> e, const Bindings& bindings) const {
///         const double offset_m = bindings.get(offset_number, *offset).offset_m;
///         e[0] = range_m + offset_m - (point - pose.translation()).norm();
///       }
///     };
///     LOCOGRAPH_REGISTER_EDGE("OFFSET_RANGE_SE2_XY", EdgeOffsetRange)
///
/// Whether it is a constraint (constraint.h), of which kind and how exactly it is meant, stands in
/// the type: static constexpr ConstraintKind kConstraint, by default kInequality for types with
/// kOneSided and kNone for the others; and how large a violation counts as none, in the unit of the
/// row, by the first that the type has: double row_tolerance(int row, const V&… vertices) const,
/// with the vertices as for row_label; double row_tolerance(int row) const; static constexpr double
/// kTolerance. Graph::set_constraint() overrides both for a single edge.
///
/// What its rows are called when somebody asks which constraint is violated (violations.h), by the
/// first that the type has: RowLabel row_label(int row, const V&… vertices) const, with the fixed
/// (or leading) vertices as they stand in the graph; RowLabel row_label(int row) const; static
/// constexpr std::string_view kUnit, where all rows have one unit and no name.
///
/// A WeightedEdge has a diagonal Ω, a vector of weights, and a row-major Jacobian that is zero
/// before jacobians() is called; only entries other than zero cost time. It suits errors of many
/// rows that each touch a few coordinates (limits, distances). With kOneSided = true its rows are
/// hinges max(0, …): a row whose error is zero has no derivative and is skipped. One whose joints
/// do not concern each other may say so: from row int diagonal_from(view) const on, the view that
/// of its first vertex, a row has one entry in each Jacobian, in its own column, which jacobians()
/// sets, and the rows before it have entries in the columns before it only. It has to have its
/// jacobians() by hand, no more rows than any of its vertices has coordinates, and must not be
/// one-sided. What is zero by that costs nothing.

#include <locograph/core/constraint.h>
#include <locograph/core/robust_kernel.h>
#include <locograph/core/vertex.h>

#include <Eigen/Core>
#include <array>
#include <span>
#include <tuple>
#include <vector>

namespace locograph {

class Bindings;
class Parameters;

namespace detail {

template <int Dimension>
struct EdgeData {
  static constexpr int kDimension = Dimension;
  static constexpr bool kDiagonal = false;
  using Error = Eigen::Matrix<double, Dimension, 1>;
  using Information = Eigen::Matrix<double, Dimension, Dimension>;

  Information information = initial_information();  ///< Ω: symmetric, positive semi-definite
  RobustKernel kernel;

  int dimension() const {
    return Dimension == Eigen::Dynamic ? static_cast<int>(information.rows()) : Dimension;
  }
  std::tuple<> fields() { return {}; }

 private:
  static Information initial_information() {
    if constexpr (Dimension == Eigen::Dynamic) {
      return Information();
    } else {
      return Information::Identity();
    }
  }
};

template <int Dimension>
struct WeightedEdgeData {
  static constexpr int kDimension = Dimension;
  static constexpr bool kDiagonal = true;
  static constexpr bool kOneSided = false;
  using Error = Eigen::Matrix<double, Dimension, 1>;

  Error weights = initial_weights();  ///< the diagonal of Ω, ≥ 0
  RobustKernel kernel;

  int dimension() const { return static_cast<int>(weights.size()); }
  std::tuple<> fields() { return {}; }

 private:
  static Error initial_weights() {
    if constexpr (Dimension == Eigen::Dynamic) {
      return Error();
    } else {
      return Error::Ones();
    }
  }
};

}  // namespace detail

/// An edge whose Ω is diagonal. (A constant, not a concept: it is asked while E is still
/// incomplete.)
template <class E>
inline constexpr bool kHasWeights = E::kDiagonal;

/// What edges of type E are unless the graph says otherwise.
template <class E>
constexpr ConstraintKind constraint_of() {
  if constexpr (requires { E::kConstraint; }) {
    return E::kConstraint;
  } else if constexpr (requires { E::kOneSided; }) {
    return E::kOneSided ? ConstraintKind::kInequality : ConstraintKind::kNone;
  } else {
    return ConstraintKind::kNone;
  }
}

namespace detail {

template <class... Vs>
struct FixedArity {
  static constexpr bool kDynamicArity = false;
  static constexpr int kArity = sizeof...(Vs);
  using Vertices = std::tuple<Vs...>;
  template <int I>
  using VertexAt = std::tuple_element_t<I, Vertices>;

  std::array<int, sizeof...(Vs)> vertices{};  ///< slots in the graph
};

}  // namespace detail

/// An edge on a fixed list of vertices.
template <int Dimension, class... Vs>
struct Edge : detail::EdgeData<Dimension>, detail::FixedArity<Vs...> {};

/// The same with a diagonal Ω.
template <int Dimension, class... Vs>
struct WeightedEdge : detail::WeightedEdgeData<Dimension>, detail::FixedArity<Vs...> {};

/// An edge on fixed leading vertices and any number (at least one) of vertices of one more type.
template <int Dimension, class ManyVertex, class... LeadingVertices>
struct DynamicEdge : detail::EdgeData<Dimension> {
  static constexpr bool kDynamicArity = true;
  static constexpr int kLeading = sizeof...(LeadingVertices);
  using Many = ManyVertex;
  using Leading = std::tuple<LeadingVertices...>;

  std::vector<int> vertices;  ///< slots in the graph, the leading ones first
};

/// The derivative of the error of E by a vertex of a given tangent size. Row-major for weighted
/// edges and, as Eigen demands, for a single row; column-major for the others.
template <class E, int Columns>
using JacobianMatrix =
    Eigen::Matrix<double, E::kDimension, Columns,
                  Columns != 1 && (kHasWeights<E> || E::kDimension == 1) ? Eigen::RowMajor
                                                                         : Eigen::ColMajor>;

/// Where a hand-written jacobians() of edge E writes the derivative by vertex I.
template <class E, int I>
using JacobianRef = Eigen::Ref<JacobianMatrix<E, E::template VertexAt<I>::kDimension>>;

/// The same for a DynamicEdge, which receives std::span<JacobianMap>, one for each vertex.
using JacobianMap = Eigen::Map<Eigen::MatrixXd>;

/// The type of the views of the many vertices of a DynamicEdge.
template <class E, class T = double>
using ManyView = std::conditional_t<HasDerived<typename E::Many>,
                                    const std::remove_reference_t<ViewOf<typename E::Many, T>>*,
                                    std::remove_cvref_t<ViewOf<typename E::Many, T>>>;

/// Gives TYPE its tag in graph files; put it in the namespace of TYPE.
#define LOCOGRAPH_REGISTER_EDGE(TAG, TYPE)                                 \
  constexpr std::string_view locograph_tag(const TYPE*) { return TAG; }    \
  static_assert(std::is_same_v<decltype(TYPE::kDynamicArity), const bool>, \
                "an edge type derives from locograph::Edge or locograph::DynamicEdge");

}  // namespace locograph
