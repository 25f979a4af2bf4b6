#pragma once
/// A vertex type: what is estimated, its tangent, and how the two combine (⊞, `oplus`).
///
///     struct VertexXY : Vertex<2, 2> {                       // tangent size, state size
///       template <class T> using View = Eigen::Matrix<T, 2, 1>;   // what edges see
///       template <class T> static View<T> view(const T* s) { return View<T>(s[0], s[1]); }
///       template <class T> static void oplus(const T* s, const T* d, T* out) {
///         out[0] = s[0] + d[0]; out[1] = s[1] + d[1];
///       }
///     };
///     LOCOGRAPH_REGISTER_VERTEX("VERTEX_XY", VertexXY)
///
/// The state is a flat array of doubles: the graph keeps one per vertex, the solver one for all.
/// `View` is a cheap value made from the state. A vertex whose edges share expensive quantities
/// (a robot's kinematics) has instead
///
///     struct VertexHeading : Vertex<1, 1> {
///       struct Derived {
///         double cosine, sine;                                 // what edges see
///       };
///       Derived make_derived() const { return {1.0, 0.0}; }    // may allocate
///       void derive(const double* state, Derived& d) const {   // fills it; once per state
///         d = {std::cos(state[0]), std::sin(state[0])};
///       }
///     };
///
/// What was made for one vertex must serve every other of the type with a state of the same size.
///
/// A type that fills several of them at once faster than one by one may offer, besides,
/// static void derive_together(std::span<const Derivation<V>>), which its pool calls instead. Each
/// vertex is to get what derive() gives it, to the bit, whatever stands beside it. It must not
/// allocate, and several threads call it.
///
/// Optional: static void ominus(const double* a, const double* b, double* d), the difference a ⊟ b:
/// b ⊞ d = a. What needs differences (marginalisation) solves b ⊞ d = a numerically without it.
/// A type whose ⊞ adds, wrapped angles included, says so: static constexpr bool kFlat = true.
///
/// A type with a size known at run time only uses Eigen::Dynamic and hides dimension() and
/// state_size(). Optional: read(FieldReader&) and write(FieldWriter&) const for its line in a file;
/// without them the state's numbers are the fields.

#include <locograph/core/fields.h>

#include <Eigen/Core>
#include <string_view>
#include <type_traits>

namespace locograph {

class Graph;

template <int Dimension, int StateSize>
struct Vertex {
  static constexpr int kDimension = Dimension;  ///< size of the tangent, or Eigen::Dynamic
  static constexpr int kStateSize = StateSize;  ///< numbers in the state, or Eigen::Dynamic

  using State = Eigen::Matrix<double, StateSize, 1>;
  State state = initial_state();

  int dimension() const { return Dimension; }
  int state_size() const { return static_cast<int>(state.size()); }

  void read(FieldReader& in) { read_field(in, state); }
  void write(FieldWriter& out) const { write_field(out, state); }

 private:
  static State initial_state() {
    if constexpr (StateSize == Eigen::Dynamic) {
      return State();
    } else {
      return State::Zero();
    }
  }
};

/// A vertex's place in a graph, typed so that an edge cannot be given the wrong kind.
template <class V>
struct VertexId {
  int slot = -1;
  bool operator==(const VertexId&) const = default;
};

template <class V>
concept HasDerived = requires {
  typename V::Derived;
};

/// Derived quantities that are to be filled, of a vertex at a state.
template <class V>
struct Derivation {
  const V* vertex;
  const double* state;
  typename V::Derived* derived;
};

namespace detail {
template <class V, class T>
struct ViewType {
  using type = typename V::template View<T>;
};
template <HasDerived V, class T>
struct ViewType<V, T> {
  using type = const typename V::Derived&;
};
}  // namespace detail

/// What edges on V receive: V::View<T> by value, or a reference to V::Derived.
template <class V, class T = double>
using ViewOf = typename detail::ViewType<V, T>::type;

/// Gives TYPE its tag in graph files; put it in the namespace of TYPE.
#define LOCOGRAPH_REGISTER_VERTEX(TAG, TYPE)                            \
  constexpr std::string_view locograph_tag(const TYPE*) { return TAG; } \
  static_assert(std::is_same_v<decltype(TYPE::kDimension), const int>,  \
                "a vertex type derives from locograph::Vertex");

}  // namespace locograph
