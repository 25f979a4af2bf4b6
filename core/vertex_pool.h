#pragma once
/// All vertices of one concrete type, by value and contiguous, behind one virtual interface.
///
/// The solver never calls a vertex: it calls its pool, once for all vertices. Users reach a typed
/// pool through Graph.

#include <locograph/core/scratch.h>
#include <locograph/core/vertex.h>
#include <locograph/core/vertex_difference.h>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

namespace locograph {

/// Where one vertex of a pool lives in a compiled problem.
struct ActiveVertex {
  int index = 0;            ///< in its pool
  int state_offset = 0;     ///< in the flat state
  int tangent_offset = -1;  ///< in the step; -1 when it is held fixed
};

/// Derived quantities of the active vertices of one pool, in the order of the ActiveVertex list.
class DerivedStore {
 public:
  virtual ~DerivedStore() = default;
  virtual int size() const = 0;
  /// What stands at i afterwards stood at from[i], a permutation of size() numbers, which is used
  /// up.
  virtual void arrange(std::span<int> from) = 0;
};
template <HasDerived V>
class TypedDerivedStore final : public DerivedStore {
 public:
  std::vector<typename V::Derived> values;

  int size() const override { return static_cast<int>(values.size()); }
  void arrange(std::span<int> from) override {
    for (int i = 0; i < static_cast<int>(from.size()); ++i) {
      int at = i;
      while (from[at] != i) {
        std::swap(values[at], values[from[at]]);
        at = std::exchange(from[at], at);
      }
      from[at] = at;
    }
  }
};

class VertexPool {
 public:
  explicit VertexPool(std::string tag) : tag_(std::move(tag)) {}
  virtual ~VertexPool() = default;

  const std::string& tag() const { return tag_; }
  virtual std::type_index type() const = 0;
  virtual int size() const = 0;
  virtual int dimension(int index) const = 0;
  virtual int state_size(int index) const = 0;
  virtual const double* state(int index) const = 0;
  virtual double* state(int index) = 0;

  /// out = state ⊞ step for all listed vertices that are not fixed; fixed ones are left alone.
  virtual void oplus(std::span<const ActiveVertex> vertices, const double* state,
                     const double* step, double* out) const = 0;

  /// d = a ⊟ b of two states of a vertex; not a number where there is none.
  virtual void ominus(int index, const double* a, const double* b, double* d,
                      Scratch& scratch) const = 0;
  /// ∂((a ⊞ δ) ⊟ b)/∂δ at zero, dimension × dimension, by column.
  virtual void ominus_jacobian(int index, const double* a, const double* b, double* jacobian,
                               Scratch& scratch) const = 0;
  /// What the two ask of the scratch memory.
  virtual std::size_t ominus_scratch_bytes(int index) const = 0;

  /// Null when the type has no derived quantities.
  virtual std::unique_ptr<DerivedStore> make_derived(
      std::span<const ActiveVertex> vertices) const = 0;
  /// Puts the place of vertex i of the list into a store, instead of what is there or after the
  /// last one.
  virtual void make_derived_at(std::span<const ActiveVertex> vertices, std::size_t i,
                               DerivedStore& derived) const = 0;
  /// Fills those of vertices [begin, end) of the list.
  virtual void derive(std::span<const ActiveVertex> vertices, std::size_t begin, std::size_t end,
                      const double* state, DerivedStore& derived) const = 0;
  void derive(std::span<const ActiveVertex> vertices, const double* state,
              DerivedStore& derived) const {
    derive(vertices, 0, vertices.size(), state, derived);
  }

  virtual int add_default() = 0;
  virtual int read(FieldReader& in) = 0;  ///< returns the index of the new vertex
  virtual void write(int index, FieldWriter& out) const = 0;
  /// Removes by moving the last vertex into the gap.
  virtual void remove(int index) = 0;

 private:
  std::string tag_;
};

template <class V>
class TypedVertexPool final : public VertexPool {
 public:
  TypedVertexPool() : VertexPool(std::string(locograph_tag(static_cast<const V*>(nullptr)))) {}

  std::vector<V> vertices;

  std::type_index type() const override { return typeid(V); }
  int size() const override { return static_cast<int>(vertices.size()); }
  int dimension(int index) const override { return vertices[index].dimension(); }
  int state_size(int index) const override { return vertices[index].state_size(); }
  const double* state(int index) const override { return vertices[index].state.data(); }
  double* state(int index) override { return vertices[index].state.data(); }

  void oplus(std::span<const ActiveVertex> active, const double* state, const double* step,
             double* out) const override {
    for (const ActiveVertex& v : active) {
      if (v.tangent_offset < 0) continue;
      vertices[v.index].oplus(state + v.state_offset, step + v.tangent_offset,
                              out + v.state_offset);
    }
  }

  void ominus(int index, const double* a, const double* b, double* d,
              [[maybe_unused]] Scratch& scratch) const override {
    const V& vertex = vertices[index];
    if constexpr (requires { vertex.ominus(a, b, d); }) {
      vertex.ominus(a, b, d);
    } else {
      detail::solve_ominus(vertex.dimension(), vertex.state_size(), plus(index), a, b, d, scratch);
    }
  }
  void ominus_jacobian(int index, const double* a, const double* b, double* jacobian,
                       Scratch& scratch) const override {
    const int n = dimension(index);
    if constexpr (requires { V::kFlat; }) {
      Eigen::Map<Eigen::MatrixXd>(jacobian, n, n).setIdentity();
    } else {
      const auto minus = [&, this](const double* p, const double* q, double* d) {
        ominus(index, p, q, d, scratch);
      };
      // By reference, lest the function allocates for what the lambda holds.
      detail::ominus_jacobian(n, state_size(index), plus(index), std::cref(minus), a, b, jacobian,
                              scratch);
    }
  }
  std::size_t ominus_scratch_bytes(int index) const override {
    return detail::ominus_scratch_bytes(dimension(index), state_size(index));
  }

  std::unique_ptr<DerivedStore> make_derived(
      [[maybe_unused]] std::span<const ActiveVertex> active) const override {
    if constexpr (HasDerived<V>) {
      auto store = std::make_unique<TypedDerivedStore<V>>();
      store->values.reserve(active.size());
      for (const ActiveVertex& v : active) {
        store->values.push_back(vertices[v.index].make_derived());
      }
      return store;
    } else {
      return nullptr;
    }
  }

  void make_derived_at([[maybe_unused]] std::span<const ActiveVertex> active,
                       [[maybe_unused]] std::size_t i,
                       [[maybe_unused]] DerivedStore& derived) const override {
    if constexpr (HasDerived<V>) {
      std::vector<typename V::Derived>& values = static_cast<TypedDerivedStore<V>&>(derived).values;
      typename V::Derived made = vertices[active[i].index].make_derived();
      if (i < values.size()) {
        values[i] = std::move(made);
      } else {
        values.push_back(std::move(made));
      }
    }
  }

  using VertexPool::derive;
  void derive([[maybe_unused]] std::span<const ActiveVertex> active,
              [[maybe_unused]] std::size_t begin, [[maybe_unused]] std::size_t end,
              [[maybe_unused]] const double* state,
              [[maybe_unused]] DerivedStore& derived) const override {
    if constexpr (HasDerived<V>) {
      std::vector<typename V::Derived>& values = static_cast<TypedDerivedStore<V>&>(derived).values;
      const auto derivation = [&](std::size_t i) -> Derivation<V> {
        return {&vertices[active[i].index], state + active[i].state_offset, &values[i]};
      };
      if constexpr (requires(std::span<const Derivation<V>> some) { V::derive_together(some); }) {
        constexpr std::size_t kMost = 32;
        std::array<Derivation<V>, kMost> some;
        for (std::size_t i = begin; i < end;) {
          std::size_t count = 0;
          for (; count < kMost && i < end; ++count, ++i) some[count] = derivation(i);
          V::derive_together(std::span(some).first(count));
        }
      } else {
        for (std::size_t i = begin; i < end; ++i) {
          const Derivation<V> one = derivation(i);
          one.vertex->derive(one.state, *one.derived);
        }
      }
    }
  }

  int add_default() override {
    vertices.emplace_back();
    return size() - 1;
  }
  int read(FieldReader& in) override {
    V vertex;
    vertex.read(in);
    vertices.push_back(std::move(vertex));
    return size() - 1;
  }
  void write(int index, FieldWriter& out) const override { vertices[index].write(out); }
  void remove(int index) override {
    if (index + 1 != size()) vertices[index] = std::move(vertices.back());
    vertices.pop_back();
  }

 private:
  detail::Plus plus(int index) const {
    const V& vertex = vertices[index];
    return [&vertex](const double* s, const double* d, double* out) { vertex.oplus(s, d, out); };
  }
};

}  // namespace locograph
