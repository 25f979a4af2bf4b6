#pragma once
/// The edge pool of one concrete type: include it where a type is registered or added to a graph.

#include <locograph/core/all_zero.h>
#include <locograph/core/block_products.h>
#include <locograph/core/edge_evaluation.h>
#include <locograph/core/edge_line.h>
#include <locograph/core/information.h>

namespace locograph {

template <class E>
class TypedEdgePool final : public EdgePool {
 public:
  TypedEdgePool() : EdgePool(std::string(locograph_tag(static_cast<const E*>(nullptr)))) {}

  std::vector<E> edges;

  std::type_index type() const override { return typeid(E); }
  int size() const override { return static_cast<int>(edges.size()); }
  int arity() const override { return E::kDynamicArity ? -1 : kFixed; }
  int dimension(int index) const override { return edges[index].dimension(); }
  std::span<const int> vertices(int index) const override { return edges[index].vertices; }
  std::span<int> vertices(int index) override { return edges[index].vertices; }

  std::type_index slot_type(int slot) const override {
    std::type_index type = typeid(void);
    with_slot_type(slot, [&]<class V>(std::type_identity<V>) { type = typeid(V); });
    return type;
  }
  std::unique_ptr<VertexPool> make_slot_pool(int slot) const override {
    std::unique_ptr<VertexPool> pool;
    with_slot_type(slot, [&]<class V>(std::type_identity<V>) {
      pool = std::make_unique<TypedVertexPool<V>>();
    });
    return pool;
  }

  bool has_weights() const override { return kHasWeights<E>; }
  bool reads_bindings() const override { return Evaluator::reads_bindings(); }
  bool one_sided() const override { return kHinged; }
  ConstraintKind constraint() const override { return constraint_of<E>(); }
  double weight(int index, int row) const override {
    if constexpr (kHasWeights<E>) {
      return edges[index].weights[row];
    } else {
      return edges[index].information(row, row);
    }
  }
  Eigen::MatrixXd information(int index) const override {
    if constexpr (kHasWeights<E>) {
      return edges[index].weights.asDiagonal();
    } else {
      return edges[index].information;
    }
  }
  void set_information(int index, const Eigen::MatrixXd& information) override {
    if constexpr (kHasWeights<E>) {
      edges[index].weights = information.diagonal();
    } else {
      edges[index].information = information;
    }
  }
  RobustKernel& kernel(int index) override { return edges[index].kernel; }

  std::size_t scratch_bytes(const CompiledEdges& compiled) const override {
    std::size_t most = 0;
    for (std::size_t k = 0; k < compiled.edges.size(); ++k) {
      most = std::max(most, scratch_bytes(compiled, static_cast<int>(k)));
    }
    return most;
  }

  void error(const CompiledEdges& compiled, int k, const Evaluation& x,
             double* error) const override {
    x.scratch->reset();
    const E& edge = edges[compiled.edges[k]];
    Eigen::Map<Eigen::Matrix<double, kD, 1>> e(error, edge.dimension());
    Evaluator(edge, slots(compiled, k), x).error(e);
  }

  Cost cost(const CompiledEdges& compiled, int begin, int end, const Evaluation& x) const override {
    Cost total;
    for (int k = begin; k < end; ++k) {
      x.scratch->reset();
      const E& edge = edges[compiled.edges[k]];
      const int n = edge.dimension();
      const Evaluator evaluator(edge, slots(compiled, k), x);
      const ConstraintRow* rows = constraint_rows(compiled, k, x);
      detail::LocalMatrix<Error> e = detail::make_local<Error>(n, 1, *x.scratch);
      if (rows != nullptr) {
        double* errors = x.constraint_errors + compiled.constraint_row[k];
        if (!x.errors_known) evaluator.error(Eigen::Map<Error>(errors, n));
        // Inside all of its limits: it has no shifts (constraint.h), and its cost is 0.
        if (kHinged && all_zero(errors, n)) continue;
        std::copy_n(errors, n, e.data());
        constrain_error(rows, compiled.one_sided[k] != 0, n, e.data());
      } else {
        evaluator.error(e);
      }
      const double chi2 = weighted_square(edge, e.data());
      total += {robust_weights(edge, rows, chi2).cost, chi2};
    }
    return total;
  }

  Cost linearise(const CompiledEdges& compiled, int begin, int end, const Evaluation& x,
                 double* hessian, double* gradient) const override {
    Cost total;
    for (int k = begin; k < end; ++k) {
      x.scratch->reset();
      total += linearise_one(compiled, k, x, hessian, gradient);
    }
    return total;
  }

  Eigen::MatrixXd jacobian(const CompiledEdges& compiled, int k, int slot, const Evaluation& x,
                           bool numeric) const override {
    x.scratch->reset();
    const E& edge = edges[compiled.edges[k]];
    const Evaluator evaluator(edge, slots(compiled, k), x);
    Eigen::MatrixXd result;
    evaluator.each_slot([&]<class V>(std::type_identity<V>, int s) {
      if (s != slot) return;
      const int n = edge.dimension(), d = detail::vertex_of<V>(slots(compiled, k)[s]).dimension();
      double** data = x.scratch->array<double*>(slots(compiled, k).size());
      std::fill(data, data + slots(compiled, k).size(), nullptr);
      data[s] = x.scratch->array<double>(static_cast<std::size_t>(n) * d);
      if (numeric) {
        evaluator.template numeric_jacobian<V>(s, data[s]);
      } else {
        evaluator.jacobians(data);
      }
      result.resize(n, d);
      for (int r = 0; r < n; ++r) {
        for (int c = 0; c < d; ++c) {
          result(r, c) = Evaluator::template jacobian_entry<V>(data[s], n, d, r, c);
        }
      }
    });
    return result;
  }

  RowLabel row_label(const CompiledEdges& compiled, int k, int row) const override {
    return label_of(edges[compiled.edges[k]], slots(compiled, k), row,
                    typename Evaluator::FixedSequence());
  }

  double row_tolerance(const CompiledEdges& compiled, int k, int row) const override {
    return tolerance_of(edges[compiled.edges[k]], slots(compiled, k), row,
                        typename Evaluator::FixedSequence());
  }

  bool predict([[maybe_unused]] int index, [[maybe_unused]] int slot,
               [[maybe_unused]] const double* other_state,
               [[maybe_unused]] double* state) const override {
    if constexpr (!E::kDynamicArity) {
      if constexpr (E::kArity == 2) {
        using A = typename E::template VertexAt<0>;
        using B = typename E::template VertexAt<1>;
        if constexpr (!HasDerived<A> && !HasDerived<B>) {
          if constexpr (requires(const E& e, ViewOf<A> a) {
                          B::store(e.predict_second(a), state);
                        }) {
            if (slot == 1) {
              B::store(edges[index].predict_second(A::view(other_state)), state);
              return true;
            }
          }
          if constexpr (requires(const E& e, ViewOf<B> b) {
                          A::store(e.predict_first(b), state);
                        }) {
            if (slot == 0) {
              A::store(edges[index].predict_first(B::view(other_state)), state);
              return true;
            }
          }
        }
      }
    }
    return false;
  }

  void bind([[maybe_unused]] int index, [[maybe_unused]] const Parameters& parameters) override {
    if constexpr (requires(E & e) { e.bind(parameters); }) edges[index].bind(parameters);
  }
  void check([[maybe_unused]] int index, [[maybe_unused]] const Graph& graph) const override {
    if constexpr (requires(const E& e) { e.check(graph); }) edges[index].check(graph);
  }

  int read(std::span<const int> vertices, FieldReader& in) override {
    E edge;
    if constexpr (E::kDynamicArity) {
      if (static_cast<int>(vertices.size()) <= kFixed) {
        in.fail("an edge on " + std::to_string(vertices.size()) + " vertices",
                std::to_string(kFixed + 1) + " or more");
      }
      edge.vertices.assign(vertices.begin(), vertices.end());
    } else {
      std::copy(vertices.begin(), vertices.end(), edge.vertices.begin());
    }
    detail::read_edge_line(edge, static_cast<int>(vertices.size()), in);
    edges.push_back(std::move(edge));
    return size() - 1;
  }

  void write(int index, FieldWriter& out) const override {
    detail::write_edge_line(edges[index], out);
  }

  void remove(int index) override {
    if (index + 1 != size()) edges[index] = std::move(edges.back());
    edges.pop_back();
  }

 private:
  using Evaluator = detail::EdgeEvaluator<E>;
  using Error = Eigen::Matrix<double, E::kDimension, 1>;
  static constexpr int kD = E::kDimension;
  static constexpr int kFixed = detail::fixed_slot_count<E>();
  static constexpr bool kHinged = [] {
    if constexpr (kHasWeights<E>) {
      return E::kOneSided;
    } else {
      return false;
    }
  }();

  static std::span<const CompiledEdges::Slot> slots(const CompiledEdges& compiled, int k) {
    const int begin = compiled.slot_begin[k];
    return {compiled.slots.data() + begin,
            static_cast<std::size_t>(compiled.slot_begin[k + 1] - begin)};
  }

  /// The first that the type has: a label for each row, with its (leading) vertices or without
  /// them; one unit for all rows.
  template <class Own, int... I>
  static RowLabel label_of([[maybe_unused]] const Own& edge,
                           [[maybe_unused]] std::span<const CompiledEdges::Slot> own,
                           [[maybe_unused]] int row, std::integer_sequence<int, I...>) {
    if constexpr (requires {
                    edge.row_label(row, detail::vertex_of<detail::FixedVertex<Own, I>>(own[I])...);
                  }) {
      return edge.row_label(row, detail::vertex_of<detail::FixedVertex<Own, I>>(own[I])...);
    } else if constexpr (requires { edge.row_label(row); }) {
      return edge.row_label(row);
    } else if constexpr (requires { Own::kUnit; }) {
      return {"", std::string(Own::kUnit)};
    } else {
      return {};
    }
  }

  /// Likewise.
  template <class Own, int... I>
  static double tolerance_of([[maybe_unused]] const Own& edge,
                             [[maybe_unused]] std::span<const CompiledEdges::Slot> own,
                             [[maybe_unused]] int row, std::integer_sequence<int, I...>) {
    if constexpr (requires {
                    edge.row_tolerance(row,
                                       detail::vertex_of<detail::FixedVertex<Own, I>>(own[I])...);
                  }) {
      return edge.row_tolerance(row, detail::vertex_of<detail::FixedVertex<Own, I>>(own[I])...);
    } else if constexpr (requires { edge.row_tolerance(row); }) {
      return edge.row_tolerance(row);
    } else if constexpr (requires { Own::kTolerance; }) {
      return Own::kTolerance;
    } else {
      return 0.0;
    }
  }

  /// Null for an edge that is no constraint, and where nobody keeps rows for them.
  static const ConstraintRow* constraint_rows(const CompiledEdges& compiled, int k,
                                              const Evaluation& x) {
    if (compiled.constraint_row.empty() || compiled.constraint_row[k] < 0) return nullptr;
    if (x.constraint_rows == nullptr) return nullptr;
    return x.constraint_rows + compiled.constraint_row[k];
  }
  static RobustKernel::Weights robust_weights(const E& edge, const ConstraintRow* rows,
                                              double chi2) {
    return rows == nullptr ? edge.kernel.weights(chi2) : RobustKernel::Weights{chi2, 1.0};
  }

  template <class F>
  static void with_slot_type(int slot, F&& f) {
    if constexpr (E::kDynamicArity) {
      if (slot >= kFixed) {
        f(std::type_identity<typename E::Many>());
        return;
      }
    }
    with_fixed_slot_type(slot, f, typename Evaluator::FixedSequence());
  }
  template <class F, int... I>
  static void with_fixed_slot_type(int slot, F& f, std::integer_sequence<int, I...>) {
    ((slot == I ? f(std::type_identity<detail::FixedVertex<E, I>>()) : void()), ...);
  }

  /// An upper bound of everything one edge may ask of the scratch memory in one evaluation.
  std::size_t scratch_bytes(const CompiledEdges& compiled, int k) const {
    const std::size_t n = static_cast<std::size_t>(edges[compiled.edges[k]].dimension());
    const std::span<const CompiledEdges::Slot> own = slots(compiled, k);
    std::size_t tangent = 0, state = 0, widest = 0;
    for (const CompiledEdges::Slot& slot : own) {
      const std::size_t d = slot.pool->dimension(slot.vertex_index);
      widest = std::max(widest, d);
      tangent += d;
      state += slot.pool->state_size(slot.vertex_index);
    }
    const std::size_t views = state * (widest + 2) * 2;  // as dual numbers, aligned
    const std::size_t doubles =
        n * (2 * tangent + 8) + 3 * tangent + 3 * state + views + widest * n + widest * widest;
    return doubles * sizeof(double) + own.size() * (sizeof(CompiledEdges::Slot) + 512) + 8192;
  }

  static double weighted_square(const E& edge, const double* e) {
    const int n = edge.dimension();
    double sum = 0.0;
    if constexpr (kHasWeights<E>) {
      for (int r = 0; r < n; ++r) sum += edge.weights[r] * e[r] * e[r];
    } else {
      const double* information = edge.information.data();
      for (int c = 0; c < n; ++c, information += n) {
        double row = 0.0;
        for (int r = 0; r < n; ++r) row += information[r] * e[r];
        sum += e[c] * row;
      }
    }
    return sum;
  }

  /// What a robust kernel makes of Ω: first·(Ω + second·Ωe(Ωe)ᵀ).
  struct Weight {
    double first, second;
  };

  Cost linearise_one(const CompiledEdges& compiled, int k, const Evaluation& x, double* hessian,
                     double* gradient) const {
    const E& edge = edges[compiled.edges[k]];
    const std::span<const CompiledEdges::Slot> own = slots(compiled, k);
    const Evaluator evaluator(edge, own, x);
    const int n = edge.dimension();

    detail::LocalMatrix<Error> e = detail::make_local<Error>(n, 1, *x.scratch);
    const ConstraintRow* rows = constraint_rows(compiled, k, x);
    if (rows != nullptr) {
      const double* errors = x.constraint_errors + compiled.constraint_row[k];
      if (kHinged && all_zero(errors, n)) return {};
      std::copy_n(errors, n, e.data());
      constrain_error(rows, compiled.one_sided[k] != 0, n, e.data());
    } else {
      evaluator.error(e);
    }
    if constexpr (kHinged) {
      // Inside all of its limits: nothing to add, and no Jacobian to clear and fill.
      bool inside = true;
      for (int r = 0; r < n && inside; ++r) inside = e[r] == 0.0 || edge.weights[r] == 0.0;
      if (inside) return {};
    }
    const double chi2 = weighted_square(edge, e.data());
    const RobustKernel::Weights robust = robust_weights(edge, rows, chi2);
    const Weight weight = {robust.weight,
                           rows == nullptr ? edge.kernel.correction(chi2, robust) : 0.0};
    double** data = x.scratch->array<double*>(own.size());
    evaluator.each_slot([&]<class V>(std::type_identity<V>, int s) {
      const int d = detail::vertex_of<V>(own[s]).dimension();
      data[s] = own[s].tangent_offset < 0
                    ? nullptr
                    : x.scratch->array<double>(static_cast<std::size_t>(n) * d);
    });
    // What a shift or a scale is applied to has to be there.
    const int diagonal = rows == nullptr ? evaluator.diagonal_from() : n;
    evaluator.jacobians(data, kHinged ? e.data() : nullptr, diagonal);
    if (rows != nullptr) {
      evaluator.each_slot([&]<class V>(std::type_identity<V>, int s) {
        if (data[s] == nullptr) return;
        constrain_jacobian(rows, compiled.one_sided[k] != 0, n,
                           detail::vertex_of<V>(own[s]).dimension(), e.data(), data[s],
                           JacobianMatrix<E, V::kDimension>::IsRowMajor, kHinged);
      });
    }
    if constexpr (kHasWeights<E>) {
      detail::add_rows(compiled, k, n, diagonal, e.data(), edge.weights.data(), weight.first,
                       kHinged, data, *x.scratch, hessian, gradient);
    } else {
      accumulate(compiled, k, evaluator, e.data(), weight, data, x, hessian, gradient);
    }
    return {robust.cost, chi2};
  }

  /// H_ij += J_iᵀ W J_j for i ≤ j, g_i += J_iᵀ (wΩ) e, at the precomputed offsets; W is Ω as the
  /// kernel weights it.
  /// A template, lest explicit instantiations of pools of weighted edges reach for their Ω.
  template <class Own = E>
  void accumulate(const CompiledEdges& compiled, int k, const Evaluator& evaluator, const double* e,
                  const Weight& weight, double* const* data, const Evaluation& x, double* hessian,
                  double* gradient) const {
    if (weight.first == 0.0) return;
    const Own& edge = edges[compiled.edges[k]];
    const int n = edge.dimension();
    const double* information = edge.information.data();
    const std::span<const CompiledEdges::Slot> own = slots(compiled, k);
    const int count = static_cast<int>(own.size());
    const CompiledEdges::Block* block = compiled.blocks.data() + compiled.block_begin[k];
    evaluator.each_slot([&]<class A>(std::type_identity<A>, int i) {
      const CompiledEdges::Block* row = block;
      block += count - i;
      if (data[i] == nullptr) return;
      const std::size_t mark = x.scratch->mark();
      const int a = detail::vertex_of<A>(own[i]).dimension();
      double* weighted = x.scratch->array<double>(static_cast<std::size_t>(a) * n);
      detail::weight_jacobian<kD, A::kDimension>(n, a, data[i], information, weight.first,
                                                 weighted);
      double* g = gradient + own[i].gradient_offset;
      for (int r = 0; r < n; ++r) {
        for (int c = 0; c < a; ++c) g[c] += weighted[r * a + c] * e[r];
      }
      if (weight.second != 0.0) {
        detail::bend_weighted(n, a, information, e, weight.second, weighted,
                              x.scratch->array<double>(a));
      }
      evaluator.each_slot([&]<class B>(std::type_identity<B>, int j) {
        if (j < i || data[j] == nullptr) return;
        const int b = detail::vertex_of<B>(own[j]).dimension();
        const CompiledEdges::Block where = row[j - i];
        detail::add_product<kD, A::kDimension, B::kDimension>(
            n, a, b, weighted, data[j], (where & 1) != 0, hessian + (where >> 1));
      });
      x.scratch->rewind(mark);
    });
  }
};

}  // namespace locograph
