#pragma once
/// The compile-time half of an edge pool: views, derivatives and the fused JᵀΩJ of one edge type.
///
/// Included by typed_edge_pool.h only. Fixed arity and run-time arity take the same path: the fixed
/// (or leading) vertices are a pack, the many vertices of a DynamicEdge a span behind it.

#include <locograph/core/dual.h>
#include <locograph/core/edge_pool.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace locograph::detail {

template <class E>
constexpr int fixed_slot_count() {
  if constexpr (E::kDynamicArity) {
    return E::kLeading;
  } else {
    return E::kArity;
  }
}
template <class E>
struct FixedVertices {
  static auto types() {
    if constexpr (E::kDynamicArity) {
      return std::type_identity<typename E::Leading>();
    } else {
      return std::type_identity<typename E::Vertices>();
    }
  }
  using type = typename decltype(types())::type;
};
template <class E, int I>
using FixedVertex = std::tuple_element_t<I, typename FixedVertices<E>::type>;

/// A matrix on the stack when its size is known, a view of scratch memory when it is not.
template <class Matrix>
using LocalMatrix =
    std::conditional_t<Matrix::SizeAtCompileTime == Eigen::Dynamic, Eigen::Map<Matrix>, Matrix>;
template <class Matrix>
LocalMatrix<Matrix> make_local([[maybe_unused]] int rows, [[maybe_unused]] int columns,
                               [[maybe_unused]] Scratch& scratch) {
  if constexpr (Matrix::SizeAtCompileTime == Eigen::Dynamic) {
    return LocalMatrix<Matrix>(scratch.array<double>(static_cast<std::size_t>(rows) * columns),
                               rows, columns);
  } else {
    return LocalMatrix<Matrix>();
  }
}

template <class V>
decltype(auto) view_of(const CompiledEdges::Slot& slot, const Evaluation& x) {
  if constexpr (HasDerived<V>) {
    using Store = TypedDerivedStore<V>;
    return static_cast<const typename V::Derived&>(
        static_cast<const Store&>(*x.derived[slot.pool_number]).values[slot.derived_index]);
  } else {
    return V::view(x.state + slot.state_offset);
  }
}

template <class V>
const V& vertex_of(const CompiledEdges::Slot& slot) {
  return static_cast<const TypedVertexPool<V>&>(*slot.pool).vertices[slot.vertex_index];
}

/// Everything the evaluation of one edge of type E needs; lives for one edge.
template <class E>
class EdgeEvaluator {
 public:
  static constexpr int kD = E::kDimension;
  static constexpr int kFixed = fixed_slot_count<E>();
  using FixedSequence = std::make_integer_sequence<int, kFixed>;
  using Slot = CompiledEdges::Slot;

  EdgeEvaluator(const E& edge, std::span<const Slot> slots, const Evaluation& x)
      : edge_(edge), slots_(slots), x_(x) {}

  /// Whether error() takes the bindings, as its last argument; jacobians() takes them, too, then.
  static constexpr bool reads_bindings() {
    return test_error<double, const Bindings&>(FixedSequence());
  }

  int dimension() const { return edge_.dimension(); }
  int many() const { return static_cast<int>(slots_.size()) - kFixed; }

  void error(Eigen::Ref<Eigen::Matrix<double, kD, 1>> e) const {
    call([&](auto&&... views) { call_error(std::forward<decltype(views)>(views)..., e); }, slots_,
         FixedSequence());
  }

  /// The row from which on rows have an entry in their own column alone, those before it in columns
  /// before it; dimension() where the type does not say (see edge.h).
  int diagonal_from() const {
    if constexpr (has_diagonal()) {
      static_assert(!E::kOneSided, "diagonal_from() does not know rows at rest");
      return edge_.diagonal_from(view_of<FixedVertex<E, 0>>(slots_[0], x_));
    } else {
      return dimension();
    }
  }

  /// jacobians: one data pointer for each slot; null for the slots nobody asks for. Given `active`,
  /// one number for each row, the rows with a zero there may be left as they are. Given that rows
  /// are diagonal from one on, what is zero by that may be, too.
  void jacobians(double* const* jacobians, const double* active = nullptr) const {
    this->jacobians(jacobians, active, dimension());
  }
  void jacobians(double* const* jacobians, const double* active, int diagonal) const {
    if constexpr (has_analytic()) {
      call_analytic(jacobians, active, diagonal, FixedSequence());
    } else {
      each_slot([&]<class V>(std::type_identity<V>, int slot) {
        if (jacobians[slot] == nullptr) return;
        if constexpr (dual_capable()) {
          dual_jacobian<V>(slot, jacobians[slot]);
        } else {
          numeric_jacobian<V>(slot, jacobians[slot]);
        }
      });
    }
  }

  /// Central differences on local copies of the states; truncation and rounding balance at ε^(1/3).
  /// Allocates only where the vertex has derived quantities, whose copy must be made.
  template <class V>
  void numeric_jacobian(int slot, double* data) const {
    const V& vertex = vertex_of<V>(slots_[slot]);
    const int d = vertex.dimension();
    const int n = dimension();
    constexpr double kStep = 6e-6;
    const std::size_t mark = x_.scratch->mark();
    double* step = x_.scratch->array<double>(d);
    std::fill(step, step + d, 0.0);
    double* plus = x_.scratch->array<double>(n);
    double* minus = x_.scratch->array<double>(n);
    for (int c = 0; c < d; ++c) {
      step[c] = kStep;
      perturbed_error<V>(slot, vertex, step, plus);
      step[c] = -kStep;
      perturbed_error<V>(slot, vertex, step, minus);
      step[c] = 0.0;
      for (int r = 0; r < n; ++r) {
        jacobian_entry<V>(data, n, d, r, c) = (plus[r] - minus[r]) / (2.0 * kStep);
      }
    }
    x_.scratch->rewind(mark);
  }

  /// Entry (r, c) of a Jacobian (n × d) by a vertex of type V.
  template <class V>
  static double& jacobian_entry(double* data, int n, int d, int r, int c) {
    return data[JacobianMatrix<E, V::kDimension>::IsRowMajor ? r * d + c : c * n + r];
  }

  /// Calls f(type_identity<V>, slot) for every slot with its vertex type.
  template <class F>
  void each_slot(F&& f) const {
    each_fixed_slot(f, FixedSequence());
    if constexpr (E::kDynamicArity) {
      for (int s = kFixed; s < static_cast<int>(slots_.size()); ++s) {
        f(std::type_identity<typename E::Many>(), s);
      }
    }
  }

 private:
  template <class... Arguments>
  void call_error(Arguments&&... arguments) const {
    if constexpr (reads_bindings()) {
      edge_.error(std::forward<Arguments>(arguments)..., bindings());
    } else {
      edge_.error(std::forward<Arguments>(arguments)...);
    }
  }
  template <class... Arguments>
  void call_jacobians(Arguments&&... arguments) const {
    if constexpr (reads_bindings()) {
      edge_.jacobians(std::forward<Arguments>(arguments)..., bindings());
    } else {
      edge_.jacobians(std::forward<Arguments>(arguments)...);
    }
  }
  const Bindings& bindings() const {
    static const Bindings none;
    return x_.bindings == nullptr ? none : *x_.bindings;
  }

  template <class F, int... I>
  void each_fixed_slot(F& f, std::integer_sequence<int, I...>) const {
    (f(std::type_identity<FixedVertex<E, I>>(), I), ...);
  }

  template <class F, int... I>
  void call(F&& f, std::span<const Slot> slots, std::integer_sequence<int, I...>) const {
    if constexpr (E::kDynamicArity) {
      std::span<const ManyView<E>> views = many_views(slots);
      f(view_of<FixedVertex<E, I>>(slots[I], x_)..., views);
    } else {
      f(view_of<FixedVertex<E, I>>(slots[I], x_)...);
    }
  }

  template <class Dynamic = E>
  std::span<const ManyView<Dynamic>> many_views(std::span<const Slot> slots) const {
    ManyView<E>* views = x_.scratch->array<ManyView<E>>(many());
    for (int i = 0; i < many(); ++i) {
      if constexpr (HasDerived<typename E::Many>) {
        views[i] = &view_of<typename E::Many>(slots[kFixed + i], x_);
      } else {
        views[i] = view_of<typename E::Many>(slots[kFixed + i], x_);
      }
    }
    return {views, static_cast<std::size_t>(many())};
  }

  template <int I>
  using FixedJacobian = Eigen::Ref<JacobianMatrix<E, FixedVertex<E, I>::kDimension>>;

  /// Whether error() takes views in T and, after the error, what is given besides.
  template <class T, class... More, int... I>
  static constexpr bool test_error(std::integer_sequence<int, I...>) {
    if constexpr (E::kDynamicArity) {
      return requires(const E& e, ViewOf<FixedVertex<E, I>, T>... views,
                      std::span<const ManyView<E, T>> many, Eigen::Ref<Eigen::Matrix<T, kD, 1>> out,
                      More... more) {
        e.error(views..., many, out, more...);
      };
    } else {
      return requires(const E& e, ViewOf<FixedVertex<E, I>, T>... views,
                      Eigen::Ref<Eigen::Matrix<T, kD, 1>> out, More... more) {
        e.error(views..., out, more...);
      };
    }
  }
  template <class... More, int... I>
  static constexpr bool test_analytic(std::integer_sequence<int, I...>) {
    if constexpr (E::kDynamicArity) {
      return requires(const E& e, ViewOf<FixedVertex<E, I>>... views,
                      std::span<const ManyView<E>> many, std::span<JacobianMap> out, More... more) {
        e.jacobians(views..., many, out, more...);
      };
    } else {
      return requires(const E& e, ViewOf<FixedVertex<E, I>>... views, FixedJacobian<I>... out,
                      More... more) {
        e.jacobians(views..., out..., more...);
      };
    }
  }

 public:
  static constexpr bool has_diagonal() {
    if constexpr (kHasWeights<E> && kFixed > 0 && !E::kDynamicArity) {
      return requires(const E& edge, ViewOf<FixedVertex<E, 0>> view) {
        { edge.diagonal_from(view) } -> std::same_as<int>;
      };
    } else {
      return false;
    }
  }
  static constexpr bool has_analytic() {
    constexpr bool with = test_analytic<const Bindings&>(FixedSequence());
    constexpr bool without = test_analytic(FixedSequence());
    static_assert(reads_bindings() ? !without : !with,
                  "error() and jacobians() take the bindings both, or neither does");
    return with || without;
  }

 private:
  template <int I>
  Eigen::Map<JacobianMatrix<E, FixedVertex<E, I>::kDimension>> fixed_map(
      double* const* jacobians, const double* active, [[maybe_unused]] int diagonal) const {
    using M = JacobianMatrix<E, FixedVertex<E, I>::kDimension>;
    const int d = vertex_of<FixedVertex<E, I>>(slots_[I]).dimension();
    double* data = jacobians[I];
    if (data == nullptr)
      data = x_.scratch->array<double>(static_cast<std::size_t>(dimension()) * d);
    Eigen::Map<M> map(data, dimension(), d);
    if constexpr (kHasWeights<E>) {
      // Of hundreds of limits few are reached.
      const int columns = diagonal < dimension() ? std::min(diagonal, d) : d;
      for (int r = 0; r < diagonal; ++r) {
        if (active == nullptr || active[r] != 0.0) map.row(r).head(columns).setZero();
      }
    }
    return map;
  }

  template <int... I>
  void call_analytic(double* const* jacobians, [[maybe_unused]] const double* active,
                     [[maybe_unused]] int diagonal,
                     std::integer_sequence<int, I...> sequence) const {
    if constexpr (E::kDynamicArity) {
      JacobianMap* maps = static_cast<JacobianMap*>(
          static_cast<void*>(x_.scratch->array<std::byte>(slots_.size() * sizeof(JacobianMap))));
      each_slot([&]<class V>(std::type_identity<V>, int slot) {
        const int d = vertex_of<V>(slots_[slot]).dimension();
        double* data = jacobians[slot];
        if (data == nullptr) {
          data = x_.scratch->array<double>(static_cast<std::size_t>(dimension()) * d);
        }
        new (maps + slot) JacobianMap(data, dimension(), d);
      });
      call(
          [&](auto&&... views) {
            call_jacobians(std::forward<decltype(views)>(views)...,
                           std::span<JacobianMap>(maps, slots_.size()));
          },
          slots_, sequence);
    } else {
      call(
          [&](auto&&... views) {
            call_jacobians(std::forward<decltype(views)>(views)...,
                           FixedJacobian<I>(fixed_map<I>(jacobians, active, diagonal))...);
          },
          slots_, sequence);
    }
  }

  template <class V>
  void perturbed_error(int slot, const V& vertex, const double* step, double* error) const {
    const std::size_t mark = x_.scratch->mark();
    Slot* slots = x_.scratch->array<Slot>(slots_.size());
    std::copy(slots_.begin(), slots_.end(), slots);
    double* states = x_.scratch->array<double>(total_state_size());
    int offset = 0;
    each_slot([&]<class U>(std::type_identity<U>, int s) {
      const int size = vertex_of<U>(slots_[s]).state_size();
      const double* own = x_.state + slots_[s].state_offset;
      std::copy(own, own + size, states + offset);
      slots[s].state_offset = offset;
      offset += size;
    });
    double* perturbed = states + slots[slot].state_offset;
    vertex.oplus(x_.state + slots_[slot].state_offset, step, perturbed);

    Evaluation local = x_;
    local.state = states;
    const EdgeEvaluator evaluator(edge_, {slots, slots_.size()}, local);
    Eigen::Map<Eigen::Matrix<double, kD, 1>> out(error, dimension());
    if constexpr (HasDerived<V>) {
      typename V::Derived derived = vertex.make_derived();
      vertex.derive(perturbed, derived);
      evaluator.error_with_derived(slot, derived, out, FixedSequence());
    } else {
      evaluator.error(out);
    }
    x_.scratch->rewind(mark);
  }

  int total_state_size() const {
    int total = 0;
    each_slot([&]<class V>(std::type_identity<V>, int s) {
      total += vertex_of<V>(slots_[s]).state_size();
    });
    return total;
  }

  /// error() with the derived quantities of one slot replaced.
  template <class D, int... I>
  void error_with_derived(int slot, const D& derived, Eigen::Ref<Eigen::Matrix<double, kD, 1>> out,
                          std::integer_sequence<int, I...>) const {
    if constexpr (E::kDynamicArity) {
      std::span<const ManyView<E>> views = many_views(slots_);
      if constexpr (std::is_same_v<ManyView<E>, const D*>) {
        if (slot >= kFixed) const_cast<ManyView<E>&>(views[slot - kFixed]) = &derived;
      }
      call_error(replaced<I>(slot, derived)..., views, out);
    } else {
      call_error(replaced<I>(slot, derived)..., out);
    }
  }
  template <int I, class D>
  decltype(auto) replaced(int slot, const D& derived) const {
    using V = FixedVertex<E, I>;
    if constexpr (HasDerived<V>) {
      const typename V::Derived& own = view_of<V>(slots_[I], x_);
      if constexpr (std::is_same_v<D, typename V::Derived>) {
        return slot == I ? derived : own;
      } else {
        return own;
      }
    } else {
      return view_of<V>(slots_[I], x_);
    }
  }

#if LOCOGRAPH_HAS_DUAL
  template <class V>
  static constexpr bool dual_vertex() {
    return !HasDerived<V> && V::kDimension != Eigen::Dynamic && V::kStateSize != Eigen::Dynamic;
  }
  template <int... I>
  static constexpr bool test_dual([[maybe_unused]] std::integer_sequence<int, I...> sequence) {
    if constexpr (kD == Eigen::Dynamic || !(dual_vertex<FixedVertex<E, I>>() && ...)) {
      return false;
    } else if constexpr (E::kDynamicArity) {
      using V = typename E::Many;
      if constexpr (!dual_vertex<V>()) {
        return false;
      } else {
        return takes_dual<Dual<V::kDimension>>(sequence);
      }
    } else {
      return takes_dual<Dual<FixedVertex<E, 0>::kDimension>>(sequence);
    }
  }
  template <class T>
  static constexpr bool takes_dual(FixedSequence sequence) {
    if constexpr (reads_bindings()) {
      return test_error<T, const Bindings&>(sequence);
    } else {
      return test_error<T>(sequence);
    }
  }
  static constexpr bool dual_capable() { return test_dual(FixedSequence()); }

  /// The view of a vertex in dual numbers; its tangent seeded when it is the one asked for.
  template <class V, class T>
  typename V::template View<T> dual_view(int slot, bool seeded) const {
    std::array<T, V::kStateSize> state;
    for (int i = 0; i < V::kStateSize; ++i) state[i] = T(x_.state[slots_[slot].state_offset + i]);
    if (!seeded) return V::view(state.data());
    std::array<T, V::kDimension> step;
    for (int i = 0; i < V::kDimension; ++i) step[i] = T(0.0, i);
    std::array<T, V::kStateSize> moved;
    V::oplus(state.data(), step.data(), moved.data());
    return V::view(moved.data());
  }

  template <class V>
  void dual_jacobian(int slot, double* data) const {
    using T = Dual<V::kDimension>;
    const std::size_t mark = x_.scratch->mark();
    Eigen::Matrix<T, kD, 1> error;
    call_dual<T>(slot, Eigen::Ref<Eigen::Matrix<T, kD, 1>>(error), FixedSequence());
    x_.scratch->rewind(mark);
    constexpr int d = V::kDimension;
    for (int r = 0; r < kD; ++r) {
      for (int c = 0; c < d; ++c) jacobian_entry<V>(data, kD, d, r, c) = error[r].v[c];
    }
  }

  /// Only the slot whose dimension fits T can be the seeded one.
  template <int I, class T>
  auto fixed_dual_view(int slot) const {
    using V = FixedVertex<E, I>;
    if constexpr (std::is_same_v<T, Dual<V::kDimension>>) {
      return dual_view<V, T>(I, I == slot);
    } else {
      std::array<T, V::kStateSize> state;
      for (int i = 0; i < V::kStateSize; ++i) state[i] = T(x_.state[slots_[I].state_offset + i]);
      return typename V::template View<T>(V::view(state.data()));
    }
  }

  template <class T, int... I>
  void call_dual(int slot, Eigen::Ref<Eigen::Matrix<T, kD, 1>> error,
                 std::integer_sequence<int, I...>) const {
    if constexpr (E::kDynamicArity) {
      using V = typename E::Many;
      using View = ManyView<E, T>;
      View* views = x_.scratch->array<View>(many());
      for (int i = 0; i < many(); ++i) {
        const int s = kFixed + i;
        if constexpr (std::is_same_v<T, Dual<V::kDimension>>) {
          views[i] = dual_view<V, T>(s, s == slot);
        } else {
          std::array<T, V::kStateSize> state;
          for (int k = 0; k < V::kStateSize; ++k) {
            state[k] = T(x_.state[slots_[s].state_offset + k]);
          }
          views[i] = V::view(state.data());
        }
      }
      call_error(fixed_dual_view<I, T>(slot)...,
                 std::span<const View>(views, static_cast<std::size_t>(many())), error);
    } else {
      call_error(fixed_dual_view<I, T>(slot)..., error);
    }
  }
#else
  static constexpr bool dual_capable() { return false; }
  template <class V>
  void dual_jacobian(int, double*) const {}
#endif

  const E& edge_;
  std::span<const Slot> slots_;
  const Evaluation& x_;
};

}  // namespace locograph::detail
