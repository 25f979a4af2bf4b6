#include <gtest/gtest.h>
#include <locograph/core/diagnosis.h>
#include <locograph/core/violations.h>

#include <random>
#include <thread>

#include "common/allocation_counter.h"
#include "core/dense_system.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

constexpr int kSpot = 5;

/// PARAMS_SPOT: a place in the plane.
struct Spot : Parameter {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Spot() = default;
  explicit Spot(const Eigen::Vector2d& at) : place(at) {}
  std::string_view tag() const override { return "PARAMS_SPOT"; }
  void read(FieldReader& in) override { read_field(in, place); }
  void write(FieldWriter& out) const override { write_field(out, place); }
};
struct OtherParameter : Parameter {
  std::string_view tag() const override { return "PARAMS_OTHER"; }
  void read(FieldReader&) override {}
  void write(FieldWriter&) const override {}
};

/// A point at a spot that may be bound. Error (2): x + sin x − spot.
template <Derivatives D>
struct BoundSpot : Edge<2, VertexXY> {
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  std::shared_ptr<const Spot> own;
  void bind(const Parameters& parameters) { own = parameters.get<Spot>(kSpot); }

  template <class T>
  requires ScalarFor<T, D>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e,
             const Bindings& bindings) const {
    using std::sin;
    const Eigen::Vector2d& spot = bindings.get(kSpot, *own).place;
    for (int i = 0; i < 2; ++i) e[i] = p[i] + sin(p[i]) * T(spot[0]) - T(spot[i]);
  }
  void jacobians(const Eigen::Vector2d& p, JacobianRef<BoundSpot, 0> j,
                 const Bindings& bindings) const requires(D == Derivatives::kByHand) {
    const double x = bindings.get(kSpot, *own).place[0];
    j << 1.0 + std::cos(p[0]) * x, 0.0, 0.0, 1.0 + std::cos(p[1]) * x;
  }
};
template <Derivatives D>
constexpr std::string_view locograph_tag(const BoundSpot<D>*) {
  return "BOUND_SPOT";
}

/// The same of any number of points. Error (2): Σ pᵢ − spot.
struct BoundSum : DynamicEdge<2, VertexXY> {
  std::shared_ptr<const Spot> own;
  void bind(const Parameters& parameters) { own = parameters.get<Spot>(kSpot); }
  template <class T>
  void error(std::span<const Eigen::Matrix<T, 2, 1>> points, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e,
             const Bindings& bindings) const {
    e = -bindings.get(kSpot, *own).place.template cast<T>();
    for (const Eigen::Matrix<T, 2, 1>& p : points) e += p;
  }
};
LOCOGRAPH_REGISTER_EDGE("BOUND_SUM", BoundSum)

/// It reads the same parameter, and asks for no bindings.
struct OwnSpot : Edge<2, VertexXY> {
  std::shared_ptr<const Spot> own;
  void bind(const Parameters& parameters) { own = parameters.get<Spot>(kSpot); }
  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = p - own->place.template cast<T>();
  }
};
LOCOGRAPH_REGISTER_EDGE("OWN_SPOT", OwnSpot)

static_assert(detail::EdgeEvaluator<BoundSpot<Derivatives::kByHand>>::reads_bindings());
static_assert(detail::EdgeEvaluator<BoundSpot<Derivatives::kDual>>::reads_bindings());
static_assert(detail::EdgeEvaluator<BoundSum>::reads_bindings());
static_assert(!detail::EdgeEvaluator<OwnSpot>::reads_bindings());

Bindings bound_to(const Eigen::Vector2d& place) {
  Bindings bindings;
  bindings.set(kSpot, std::make_shared<const Spot>(place));
  return bindings;
}

const Eigen::Vector2d kOwn(0.1, 0.2), kNewer(0.4, -0.3);

template <class E>
Graph graph_with(int points = 1) {
  Graph graph;
  graph.parameters().set(kSpot, std::make_shared<const Spot>(kOwn));
  for (int i = 0; i < points; ++i) {
    const VertexId<VertexXY> p =
        graph.add_vertex(i, VertexXY(Eigen::Vector2d(0.3 + 0.01 * i, 0.7)));
    if constexpr (E::kDynamicArity) {
      graph.add_dynamic_edge(E(), {p});
    } else {
      graph.add_edge(E(), p);
    }
  }
  return graph;
}

/// Of a graph whose parameter is `place`, with nothing bound.
template <class E>
Graph graph_at(const Eigen::Vector2d& place, int points = 1) {
  Graph graph = graph_with<E>(points);
  graph.replace_parameter(kSpot, std::make_shared<const Spot>(place));
  return graph;
}

template <class E>
class EdgeThatReadsBindings : public testing::Test {};
using EdgesThatReadBindings =
    testing::Types<BoundSpot<Derivatives::kByHand>, BoundSpot<Derivatives::kDual>,
                   BoundSpot<Derivatives::kNumeric>, BoundSum>;
TYPED_TEST_SUITE(EdgeThatReadsBindings, EdgesThatReadBindings);

TYPED_TEST(EdgeThatReadsBindings, IsEvaluatedAsIfTheGraphHadWhatIsBound) {
  Graph graph = graph_with<TypeParam>(), other = graph_at<TypeParam>(kNewer);
  Loaded bound(graph), replaced(other);
  bound.workspace.bind(bound_to(kNewer));
  EXPECT_EQ(bound.workspace.evaluate(bound.workspace.state()).chi2,
            replaced.workspace.evaluate(replaced.workspace.state()).chi2);
  bound.workspace.linearise();
  replaced.workspace.linearise();
  EXPECT_EQ(dense_hessian(bound.workspace), dense_hessian(replaced.workspace));
  EXPECT_EQ(dense_gradient(bound.workspace), dense_gradient(replaced.workspace));
}

TYPED_TEST(EdgeThatReadsBindings, ReadsTheGraphsOwnElsewhere) {
  Graph graph = graph_with<TypeParam>();
  Loaded bound(graph), unbound(graph);
  const double before = unbound.workspace.evaluate(unbound.workspace.state()).chi2;
  bound.workspace.bind(bound_to(kNewer));
  EXPECT_NE(bound.workspace.evaluate(bound.workspace.state()).chi2, before);
  EXPECT_EQ(unbound.workspace.evaluate(unbound.workspace.state()).chi2, before);
  bound.workspace.bind({});
  EXPECT_EQ(bound.workspace.evaluate(bound.workspace.state()).chi2, before);
}

TYPED_TEST(EdgeThatReadsBindings, IteratesWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = graph_with<TypeParam>(20);
  Loaded loaded(graph);
  loaded.workspace.bind(bound_to(kNewer));
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("dense");
  Optimiser optimiser({});
  optimiser.start(loaded.workspace, *solver);
  const long before = allocation_count();
  while (optimiser.iterate()) {
  }
  EXPECT_EQ(allocation_count() - before, 0);
  EXPECT_FALSE(optimiser.result().statistics.empty());
}

TEST(Bindings, DoNotReachEdgesThatDoNotAsk) {
  Graph graph = graph_with<OwnSpot>();
  Loaded loaded(graph);
  const double before = loaded.workspace.evaluate(loaded.workspace.state()).chi2;
  loaded.workspace.bind(bound_to(kNewer));
  EXPECT_EQ(loaded.workspace.evaluate(loaded.workspace.state()).chi2, before);
}

TEST(Bindings, EndWhenTheWorkspaceIsAllocatedAnew) {
  Graph graph = graph_with<BoundSum>();
  Loaded loaded(graph);
  const double before = loaded.workspace.evaluate(loaded.workspace.state()).chi2;
  loaded.workspace.bind(bound_to(kNewer));
  loaded.workspace.allocate(loaded.problem);
  loaded.workspace.load_state();
  EXPECT_EQ(loaded.workspace.evaluate(loaded.workspace.state()).chi2, before);
}

TEST(Bindings, AreEvaluatedAgainByReturnToState) {
  using E = BoundSpot<Derivatives::kByHand>;
  Graph graph = graph_with<E>();
  Loaded loaded(graph);
  loaded.workspace.evaluate(loaded.workspace.state());
  const std::vector<double> before = loaded.workspace.constraint_errors();
  loaded.workspace.bind(bound_to(kNewer));
  loaded.workspace.return_to_state();
  EXPECT_NE(loaded.workspace.constraint_errors(), before);
}

TEST(Bindings, MustFitTheParametersOfTheGraph) {
  Graph graph = graph_with<BoundSum>();
  Loaded loaded(graph);
  Bindings unknown, of_another_type;
  unknown.set(kSpot + 1, std::make_shared<const Spot>());
  of_another_type.set(kSpot, std::make_shared<const OtherParameter>());
  EXPECT_THROW(loaded.workspace.bind(unknown), Error);
  EXPECT_THROW(loaded.workspace.bind(of_another_type), Error);
}

TEST(Bindings, KeepOneParameterForEachNumber) {
  Bindings bindings = bound_to(kOwn);
  bindings.set(kSpot, std::make_shared<const Spot>(kNewer));
  const Spot own;
  EXPECT_EQ(bindings.get(kSpot, own).place, kNewer);
  EXPECT_EQ(&bindings.get(kSpot + 1, own), &own);
}

TEST(Bindings, AreSeenByReadersOfConstraintsAndByDiagnosis) {
  using E = BoundSpot<Derivatives::kByHand>;
  Graph graph = graph_with<E>(), other = graph_at<E>(kNewer);
  const auto bound = violations(graph, {}, bound_to(kNewer)), replaced = violations(other);
  ASSERT_EQ(bound.size(), replaced.size());
  for (std::size_t i = 0; i < bound.size(); ++i) EXPECT_EQ(bound[i].amount, replaced[i].amount);
  EXPECT_NE(violations(graph)[0].amount, bound[0].amount);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(diagnose(graph).not_finite.empty());
  EXPECT_EQ(diagnose(graph, bound_to({nan, nan})).not_finite.size(), 1u);
}

TEST(Bindings, GiveTheSameBitsOnAnyNumberOfThreads) {
  Graph graph = graph_with<BoundSpot<Derivatives::kDual>>(4000);
  Loaded alone(graph);
  ASSERT_GT(alone.problem.chunks(), 1);
  alone.workspace.bind(bound_to(kNewer));
  const double expected = alone.workspace.evaluate(alone.workspace.state()).chi2;
  alone.workspace.linearise();
  for (const int size : {2, 3}) {
    ThreadPool threads(size);
    Loaded loaded(graph);
    loaded.workspace.use_threads(&threads);
    loaded.workspace.bind(bound_to(kNewer));
    EXPECT_EQ(loaded.workspace.evaluate(loaded.workspace.state()).chi2, expected);
    loaded.workspace.linearise();
    EXPECT_TRUE(std::ranges::equal(loaded.workspace.hessian(), alone.workspace.hessian()));
  }
}

TEST(Bindings, OfSeveralWorkspacesAreIndependentOnSeveralThreads) {
  Graph graph = graph_with<BoundSpot<Derivatives::kByHand>>(20);
  const auto cost_at = [&graph](const Eigen::Vector2d& place) {
    Loaded loaded(graph);
    loaded.workspace.bind(bound_to(place));
    return loaded.workspace.evaluate(loaded.workspace.state()).chi2;
  };
  const double own = cost_at(kOwn), newer = cost_at(kNewer);
  std::array<double, 2> costs{};
  {
    std::jthread first([&] { costs[0] = cost_at(kOwn); });
    std::jthread second([&] { costs[1] = cost_at(kNewer); });
  }
  EXPECT_EQ(costs[0], own);
  EXPECT_EQ(costs[1], newer);
}

TEST(Graph, HasItsEdgesLookUpAParameterThatIsReplaced) {
  Graph graph = graph_with<OwnSpot>();
  Loaded before(graph);
  EXPECT_NE(before.workspace.evaluate(before.workspace.state()).chi2, 0.0);
  graph.replace_parameter(kSpot, std::make_shared<const Spot>(Eigen::Vector2d(0.3, 0.7)));
  EXPECT_EQ(before.workspace.evaluate(before.workspace.state()).chi2, 0.0);
}

}  // namespace
}  // namespace locograph::test
