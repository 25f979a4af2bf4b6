#include <gtest/gtest.h>
#include <locograph/core/augmented_lagrangian.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/type_registry.h>
#include <locograph/core/violations.h>

#include <cmath>
#include <limits>
#include <utility>

#include "common/allocation_counter.h"

namespace locograph {
namespace violations_test {

struct VertexNumber : Vertex<1, 1> {
  static constexpr bool kFlat = true;
  template <class T>
  using View = T;
  template <class T>
  static T view(const T* s) {
    return s[0];
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    out[0] = s[0] + d[0];
  }
  VertexNumber() = default;
  explicit VertexNumber(double value) { state[0] = value; }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_NUMBER", VertexNumber)

using One = Eigen::Ref<Eigen::Matrix<double, 1, 1>>;
using Two = Eigen::Ref<Eigen::Matrix<double, 2, 1>>;

/// x − target; all rows in one unit.
struct EdgeAt : Edge<1, VertexNumber> {
  static constexpr std::string_view kUnit = "m";
  double target = 0.0;
  auto fields() { return std::tie(target); }
  void error(double x, One e) const { e[0] = x - target; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_AT", EdgeAt)

/// x ≤ 1 and −x ≤ 1, signed; a label for each row.
struct EdgeBetween : WeightedEdge<2, VertexNumber> {
  void error(double x, Two e) const { e << x - 1.0, -x - 1.0; }
  RowLabel row_label(int row) const { return {row == 0 ? "too far" : "too near", "s"}; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_BETWEEN", EdgeBetween)

/// x ≤ y, hinged; a label that depends on the vertices.
struct EdgeOrdered : WeightedEdge<1, VertexNumber, VertexNumber> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kUnit = "not asked for";
  void error(double x, double y, One e) const { e[0] = std::max(0.0, x - y); }
  RowLabel row_label(int, const VertexNumber& x, const VertexNumber& y) const {
    return {x.state[0] > 10.0 * y.state[0] ? "much above" : "above", "kg"};
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_ORDERED", EdgeOrdered)

/// Says nothing about its rows.
struct EdgeSilent : WeightedEdge<1, VertexNumber> {
  static constexpr bool kOneSided = true;
  void error(double x, One e) const { e[0] = std::max(0.0, x); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SILENT", EdgeSilent)

/// Any number of vertices with the sum zero.
struct EdgeSum : DynamicEdge<1, VertexNumber> {
  void error(std::span<const double> x, One e) const {
    e[0] = 0.0;
    for (const double one : x) e[0] += one;
  }
  RowLabel row_label(int) const { return {"sum", "N"}; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SUM", EdgeSum)

/// A constraint by its type: x = y, within a tenth.
struct EdgeTied : Edge<1, VertexNumber, VertexNumber> {
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  static constexpr double kTolerance = 0.1;
  void error(double x, double y, One e) const { e[0] = x - y; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_TIED", EdgeTied)

/// The same of any number of vertices, their sum below a limit, signed; the tolerance is a part of
/// the limit.
struct EdgeSumBelow : DynamicEdge<1, VertexNumber> {
  static constexpr ConstraintKind kConstraint = ConstraintKind::kInequality;
  double limit = 1.0;
  auto fields() { return std::tie(limit); }
  void error(std::span<const double> x, One e) const {
    e[0] = -limit;
    for (const double one : x) e[0] += one;
  }
  double row_tolerance(int) const { return 0.01 * limit; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SUM_BELOW", EdgeSumBelow)

/// Hinges, but is a wish only.
struct EdgeWish : WeightedEdge<1, VertexNumber> {
  static constexpr bool kOneSided = true;
  static constexpr ConstraintKind kConstraint = ConstraintKind::kNone;
  void error(double x, One e) const { e[0] = std::max(0.0, x); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_WISH", EdgeWish)

/// x ≤ y + gap by rows, with tolerances that depend on a vertex.
struct EdgeLevels : WeightedEdge<2, VertexNumber> {
  static constexpr bool kOneSided = true;
  void error(double x, Two e) const { e << std::max(0.0, x), std::max(0.0, x - 1.0); }
  double row_tolerance(int row, const VertexNumber& x) const { return row == 0 ? x.state[0] : 0.5; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_LEVELS", EdgeLevels)

class Violations : public testing::Test {
 protected:
  VertexId<VertexNumber> add(double value) {
    return graph.add_vertex(10 * graph.vertex_slots(), VertexNumber(value));
  }
  Graph graph;
};

TEST_F(Violations, AreNoneWhereThereIsNoConstraint) {
  EXPECT_TRUE(violations(graph).empty());
  EXPECT_EQ(constraint_count(graph), 0);
  graph.add_edge(EdgeAt(), add(3.0));
  graph.add_edge(EdgeBetween(), add(3.0));
  EXPECT_TRUE(violations(graph).empty()) << "edges that nobody marked are costs";
  EXPECT_EQ(constraint_count(graph), 0);
}

TEST_F(Violations, TellRowAmountAndUnitOfEqualitiesAndInequalities) {
  const auto x = add(-3.0), y = add(-4.5);
  const EdgeId at = graph.add_edge(EdgeAt(), x);
  const EdgeId between = graph.add_edge(EdgeBetween(), y);
  graph.set_constraint(at, ConstraintKind::kEquality);
  graph.set_constraint(between, ConstraintKind::kInequality);
  EXPECT_EQ(constraint_count(graph), 2);
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].edge, between);
  EXPECT_EQ(found[0].tag, "EDGE_BETWEEN");
  EXPECT_EQ(found[0].vertices, std::vector<int>({10}));
  EXPECT_EQ(found[0].row, 1) << "the other row holds";
  EXPECT_DOUBLE_EQ(found[0].amount, 3.5);
  EXPECT_EQ(found[0].label.name, "too near");
  EXPECT_EQ(found[0].label.unit, "s");
  EXPECT_TRUE(found[0].one_sided);
  EXPECT_EQ(found[0].line, 0);
  EXPECT_EQ(found[0].text(), "EDGE_BETWEEN 10, row 1: too near exceeded by 3.5 s");
  EXPECT_EQ(found[1].edge, at);
  EXPECT_DOUBLE_EQ(found[1].amount, 3.0) << "an equality is violated to either side";
  EXPECT_FALSE(found[1].one_sided);
  EXPECT_EQ(found[1].text(), "EDGE_AT 0, row 0: off by 3 m");
}

TEST_F(Violations, OfTypesThatHingeNeedNoMark) {
  for (const auto& [value, bound] :
       {std::pair(2.0, 1.5), std::pair(50.0, 1.0), std::pair(1.0, 2.0)}) {
    const auto x = add(value), y = add(bound);
    graph.add_edge(EdgeOrdered(), x, y);
  }
  graph.add_edge(EdgeSilent(), add(0.25));
  EXPECT_EQ(constraint_count(graph), 4);
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].text(), "EDGE_ORDERED 20 30, row 0: much above exceeded by 49 kg");
  EXPECT_EQ(found[1].text(), "EDGE_ORDERED 0 10, row 0: above exceeded by 0.5 kg");
  EXPECT_EQ(found[2].text(), "EDGE_SILENT 60, row 0: exceeded by 0.25");
}

TEST_F(Violations, AreFoundOnEdgesOfAnyArityAndOnHeldVertices) {
  const auto a = add(1.0), b = add(2.0), c = add(4.0);
  const EdgeId sum = graph.add_dynamic_edge(EdgeSum(), {a, b, c});
  graph.set_constraint(sum, ConstraintKind::kEquality);
  for (const auto v : {a, b, c}) graph.set_fixed(v, true);
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].text(), "EDGE_SUM 0 10 20, row 0: sum off by 7 N");
}

TEST_F(Violations, AreOrderedByExcessRelativeToTheToleranceOfTheirUnit) {
  const EdgeId at = graph.add_edge(EdgeAt(), add(0.5));  // 0.5 m
  graph.set_constraint(at, ConstraintKind::kEquality);
  const auto x = add(3.0), y = add(1.0);
  graph.add_edge(EdgeOrdered(), x, y);  // 2 kg
  ViolationOptions options;
  EXPECT_EQ(violations(graph, options).front().tag, "EDGE_ORDERED");
  options.tolerance_of_unit["kg"] = 1.0;
  options.tolerance_of_unit["m"] = 0.1;
  std::vector<ConstraintViolation> found = violations(graph, options);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].tag, "EDGE_AT");
  EXPECT_DOUBLE_EQ(found[0].ratio, 5.0);
  EXPECT_DOUBLE_EQ(found[1].ratio, 2.0);
  options.tolerance_of_unit["kg"] = 2.5;
  EXPECT_EQ(violations(graph, options).size(), 1u) << "within its tolerance";
  options.tolerance = 0.0;
  EXPECT_THROW(violations(graph, options), Error);
  options.tolerance = 1.0;
  options.tolerance_of_unit["kg"] = -1.0;
  EXPECT_THROW(violations(graph, options), Error);
}

TEST_F(Violations, AreOfConstraintsByTypeBeyondTheToleranceOfTheirRow) {
  const auto x = add(2.0), y = add(1.5);
  graph.add_edge(EdgeTied(), x, y);
  graph.add_dynamic_edge(EdgeSumBelow(), {x, y});
  graph.add_edge(EdgeLevels(), x);
  graph.add_edge(EdgeWish(), x);
  EXPECT_EQ(constraint_count(graph), 3) << "a wish is none";
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].tag, "EDGE_SUM_BELOW");
  EXPECT_DOUBLE_EQ(found[0].ratio, 250.0);
  EXPECT_DOUBLE_EQ(found[0].tolerance, 0.01);
  EXPECT_TRUE(found[0].one_sided);
  EXPECT_EQ(found[1].tag, "EDGE_TIED");
  EXPECT_DOUBLE_EQ(found[1].ratio, 5.0);
  EXPECT_EQ(found[2].tag, "EDGE_LEVELS");
  EXPECT_EQ(found[2].row, 1) << "the other row is at its tolerance";
  graph.vertex(x).state[0] = 1.55;
  graph.vertex(y).state[0] = -10.0;
  ViolationOptions options;
  options.tolerance = 100.0;
  EXPECT_EQ(violations(graph, options).size(), 2u) << "the type's tolerance counts, not this one";
}

TEST_F(Violations, FollowWhatTheGraphSaysOfASingleEdge) {
  const auto x = add(2.0), y = add(1.5);
  const EdgeId first = graph.add_edge(EdgeTied(), x, y);
  const EdgeId second = graph.add_edge(EdgeTied(), y, x);
  graph.set_constraint(first, ConstraintKind::kNone);
  graph.set_constraint(second, ConstraintKind::kEquality, 0.05);
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].edge, second);
  EXPECT_DOUBLE_EQ(found[0].ratio, 10.0);
  EXPECT_THROW(graph.set_constraint(second, ConstraintKind::kEquality, -1.0), Error);
  EXPECT_THROW(graph.set_constraint(second, ConstraintKind::kEquality,
                                    std::numeric_limits<double>::quiet_NaN()),
               Error);
}

TypeRegistry own_types() {
  TypeRegistry types;
  types.add_vertex<VertexNumber>();
  types.add_edge<EdgeTied>();
  types.add_edge<EdgeSumBelow>();
  types.add_edge<EdgeAt>();
  types.add_edge<EdgeBetween>();
  return types;
}

TEST_F(Violations, AreTheSameOnceTheGraphIsReadBack) {
  const auto x = add(2.0), y = add(1.5);
  graph.set_constraint(graph.add_edge(EdgeTied(), x, y), ConstraintKind::kNone);
  graph.set_constraint(graph.add_edge(EdgeTied(), y, x), ConstraintKind::kEquality, 0.05);
  graph.set_constraint(graph.add_edge(EdgeAt(), x), ConstraintKind::kEquality);
  graph.set_constraint(graph.add_edge(EdgeBetween(), x), ConstraintKind::kInequality, 0.1 / 3.0);
  graph.add_edge(EdgeTied(), x, y);
  graph.add_edge(EdgeAt(), y);
  const EdgeId sum = graph.add_dynamic_edge(EdgeSumBelow(), {x, y});
  graph.set_constraint(sum, ConstraintKind::kInequality, 3.0);
  const std::string text = write_graph_text(graph);
  EXPECT_NE(text.find("constraint none\n"), std::string::npos) << text;
  Graph again = read_graph_text(text, "a.g2o", ".", own_types());
  EXPECT_EQ(write_graph_text(again), text);
  const std::vector<ConstraintViolation> before = violations(graph), after = violations(again);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].tag, after[i].tag);
    EXPECT_EQ(before[i].vertices, after[i].vertices);
    EXPECT_EQ(before[i].ratio, after[i].ratio);
  }
}

TEST_F(Violations, AreNotReadFromAFileThatSaysNothingSensible) {
  const auto fails = [](const std::string& end, const std::string& what) {
    try {
      read_graph_text("VERTEX_NUMBER 0 1\nVERTEX_NUMBER 1 2\nEDGE_TIED 0 1 1 " + end + "\n",
                      "a.g2o", ".", own_types());
      ADD_FAILURE() << end;
    } catch (const Error& error) {
      EXPECT_EQ(error.line(), 3);
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  fails("constraint", "constraint");
  fails("constraint perhaps", "perhaps");
  fails("constraint equality -1", "tolerance");
  fails("constraint equality 1 2", "2");
  fails("constrained", "constrained");
}

TEST_F(Violations, AreReadOffAWorkspaceWithoutAllocating) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::vector<VertexId<VertexNumber>> all;
  for (int i = 0; i < 20; ++i) all.push_back(add(i));
  for (int i = 1; i < 20; ++i) graph.add_edge(EdgeTied(), all[i - 1], all[i]);
  graph.add_dynamic_edge(EdgeSumBelow(), all);
  graph.add_edge(EdgeOrdered(), all[3], all[2]);
  graph.add_edge(EdgeLevels(), all[3]);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());
  const ConstraintReader reader(workspace);
  const long before = test::allocation_count();
  const ConstraintReader::Row worst = reader.worst();
  int violated = 0;
  reader.each([&violated](const ConstraintReader::Row& row) { violated += row.ratio > 1.0; });
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(violated, 19 + 1 + 1 + 1);
  EXPECT_EQ(reader.describe(worst).tag, "EDGE_ORDERED") << "in units of the default tolerance";
  EXPECT_EQ(violations(graph).size(), 22u);
}

TEST_F(Violations, IgnoreRowsOfWeightZeroAndRemovedEdges) {
  EdgeBetween edge;
  edge.weights << 0.0, 1.0;
  graph.set_constraint(graph.add_edge(edge, add(5.0)), ConstraintKind::kInequality);
  const EdgeId gone = graph.add_edge(EdgeSilent(), add(5.0));
  graph.remove_edge(gone);
  EXPECT_EQ(constraint_count(graph), 1);
  EXPECT_TRUE(violations(graph).empty());
}

TEST_F(Violations, ThatAreNotANumberComeFirst) {
  graph.add_edge(EdgeSilent(), add(1e9));
  const EdgeId at = graph.add_edge(EdgeAt(), add(std::numeric_limits<double>::quiet_NaN()));
  graph.set_constraint(at, ConstraintKind::kEquality);
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].tag, "EDGE_AT");
  EXPECT_TRUE(std::isnan(found[0].amount));
}

TEST_F(Violations, NameTheLineOfTheirEdge) {
  TypeRegistry types;
  types.add_vertex<VertexNumber>();
  types.add_edge<EdgeSilent>();
  Graph read =
      read_graph_text("VERTEX_NUMBER 4 0.5\n\nEDGE_SILENT 4 scalar 1\n", "a.g2o", ".", types);
  const std::vector<ConstraintViolation> found = violations(read);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].line, 3);
  EXPECT_EQ(found[0].text(), "EDGE_SILENT 4 (line 3), row 0: exceeded by 0.5");
}

}  // namespace violations_test
}  // namespace locograph
