#pragma once
/// PRIOR_DENSE: a Gaussian on any vertices of any types together, what marginalisation leaves.
///
///     PRIOR_DENSE ids… || n  states  offset  information
///
/// Error (n): (x ⊟ x₀) + offset, the differences of all vertices one below the other, n the sum of
/// their dimensions; states are the x₀ (all state numbers, in the order of the ids), offset n
/// numbers, information the upper triangle of the n × n matrix Ω, positive semi-definite.
///
///     DensePrior prior;
///     prior.vertices = {a.slot, b.slot};
///     prior.states = {0.0, 0.0, 0.0, 1.0, 0.0, 0.1};
///     prior.offset = Eigen::VectorXd::Zero(6);
///     prior.information = 100.0 * Eigen::MatrixXd::Identity(6, 6);
///     EdgeId e = graph.add_dense_prior(prior);
///
/// The pool derives from EdgePool itself: its vertices have no type known when it is compiled. It
/// takes part in everything that pools do.

#include <locograph/core/edge_pool.h>

#include <string_view>
#include <vector>

namespace locograph {

struct DensePrior {
  std::vector<int> vertices;   ///< slots in the graph
  std::vector<double> states;  ///< x₀: the states of the vertices, one behind the other
  Eigen::VectorXd offset;
  Eigen::MatrixXd information;
  RobustKernel kernel;
};

class DensePriorPool final : public EdgePool {
 public:
  static constexpr std::string_view kTag = "PRIOR_DENSE";
  DensePriorPool() : EdgePool(std::string(kTag)) {}

  std::vector<DensePrior> edges;

  std::type_index type() const override { return typeid(DensePrior); }
  int size() const override { return static_cast<int>(edges.size()); }
  int arity() const override { return -1; }
  int dimension(int index) const override { return static_cast<int>(edges[index].offset.size()); }
  std::span<const int> vertices(int index) const override { return edges[index].vertices; }
  std::span<int> vertices(int index) override { return edges[index].vertices; }
  std::type_index slot_type(int) const override { return typeid(void); }
  std::unique_ptr<VertexPool> make_slot_pool(int) const override { return nullptr; }
  bool has_weights() const override { return false; }
  bool one_sided() const override { return false; }
  double weight(int index, int row) const override { return edges[index].information(row, row); }
  Eigen::MatrixXd information(int index) const override { return edges[index].information; }
  void set_information(int index, const Eigen::MatrixXd& information) override {
    edges[index].information = information;
  }
  RobustKernel& kernel(int index) override { return edges[index].kernel; }

  std::size_t scratch_bytes(const CompiledEdges& compiled) const override;
  void error(const CompiledEdges& compiled, int k, const Evaluation& x,
             double* error) const override;
  Cost cost(const CompiledEdges& compiled, int begin, int end, const Evaluation& x) const override;
  Cost linearise(const CompiledEdges& compiled, int begin, int end, const Evaluation& x,
                 double* hessian, double* gradient) const override;
  Eigen::MatrixXd jacobian(const CompiledEdges& compiled, int k, int slot, const Evaluation& x,
                           bool numeric) const override;
  bool predict(int, int, const double*, double*) const override { return false; }
  void bind(int, const Parameters&) override {}
  int read(std::span<const int> vertices, FieldReader& in) override;
  void check(int index, const Graph& graph) const override;
  void write(int index, FieldWriter& out) const override;
  void remove(int index) override;

 private:
  using Vector = Eigen::Map<Eigen::VectorXd>;

  Vector shifted_error(const CompiledEdges& compiled, int k, const Evaluation& x) const;
  Cost linearise_one(const CompiledEdges& compiled, int k, const Evaluation& x, double* hessian,
                     double* gradient) const;
};

}  // namespace locograph
