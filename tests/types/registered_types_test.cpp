#include <gtest/gtest.h>
#include <locograph/types/standard_types.h>

#include <cstring>
#include <sstream>

#include "core/dense_system.h"
#include "types/random_lines.h"

namespace locograph::test {
namespace {

constexpr int kSamples = 150;

enum class Kind { kVertex, kEdge, kParameter };

std::vector<std::string> tags_of(Kind kind) {
  const TypeRegistry types = standard_types();
  std::vector<std::string> tags;
  for (const std::string& tag : types.tags()) {
    const Kind its_kind = types.vertex_type(tag) != nullptr ? Kind::kVertex
                          : types.edge_type(tag) != nullptr ? Kind::kEdge
                                                            : Kind::kParameter;
    if (its_kind == kind) tags.push_back(tag);
  }
  return tags;
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) == 0 ? '_' : c;
  return name;
}

Graph read(const std::string& text) {
  return read_graph_text(text, "random.g2o", {}, standard_types());
}

/// load → save → load: the same states, the same text.
void expect_round_trip(const std::string& text) {
  const Graph graph = read(text);
  const std::string first = write_graph_text(graph);
  const Graph again = read(first);
  ASSERT_EQ(again.vertex_slots(), graph.vertex_slots());
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    ASSERT_EQ(std::memcmp(graph.state(v), again.state(v), sizeof(double) * graph.state_size(v)), 0);
  }
  EXPECT_EQ(again.edge_count(), graph.edge_count());
  EXPECT_EQ(write_graph_text(again), first);
}

std::vector<std::string> tokens_of(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}
std::string line_of(const std::vector<std::string>& tokens) {
  std::string line;
  for (const std::string& token : tokens) line += (line.empty() ? "" : " ") + token;
  return line;
}

/// `before` holds good lines that `good` needs; every way to spoil `good` is an error on its line.
void expect_bad_lines_are_errors(const std::string& before, const std::string& good) {
  const int line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
  ASSERT_NO_THROW(read(before + good));
  const auto refused = [&](const std::vector<std::string>& tokens) {
    try {
      read(before + line_of(tokens) + "\n");
      ADD_FAILURE() << "accepted: " << line_of(tokens);
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), "random.g2o");
      EXPECT_EQ(error.line(), line) << error.what();
    }
  };
  const std::vector<std::string> tokens = tokens_of(good);
  for (std::size_t count = 1; count < tokens.size(); ++count) {
    refused({tokens.begin(), tokens.begin() + static_cast<long>(count)});
  }
  std::vector<std::string> spoilt = tokens;
  spoilt.push_back("1");
  refused(spoilt);
  for (std::size_t i = 1; i < tokens.size(); ++i) {
    if (tokens[i] == "||") continue;
    for (const char* bad : {"x", "nan", "inf", "1e999", "1.5.2"}) {
      spoilt = tokens;
      spoilt[i] = bad;
      refused(spoilt);
    }
  }
}

/// Derivative of edge k of the first pool by the vertex in a slot, by central differences.
Eigen::MatrixXd differences(const Problem& problem, const std::vector<double>& state, int k,
                            int slot, double h) {
  const EdgePool& pool = *problem.graph().edge_pools()[0];
  const CompiledEdges& edges = problem.edges()[0];
  const CompiledEdges::Slot& s = edges.slots[edges.slot_begin[k] + slot];
  const ActiveVertex vertex{s.vertex_index, s.state_offset, 0};
  const int size = pool.dimension(edges.edges[k]), tangent = s.pool->dimension(s.vertex_index);
  const auto error = [&](int direction, double length) {
    std::vector<double> step(tangent, 0.0), moved = state;
    step[direction] = length;
    s.pool->oplus({&vertex, 1}, state.data(), step.data(), moved.data());
    StateEvaluation evaluation(problem, moved);
    Eigen::VectorXd e(size);
    pool.error(edges, k, evaluation.get(), e.data());
    return e;
  };
  Eigen::MatrixXd all(size, tangent);
  for (int c = 0; c < tangent; ++c) all.col(c) = (error(c, h) - error(c, -h)) / (2.0 * h);
  return all;
}

class EveryVertexType : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(RegisteredTypes, EveryVertexType,
                         testing::ValuesIn(tags_of(Kind::kVertex)), test_name);

TEST_P(EveryVertexType, ComesBackFromAFileBitForBit) {
  RandomLines lines(standard_types(), 1);
  std::string text = lines.parameters();
  for (int i = 0; i < kSamples; ++i) text += lines.vertex(GetParam(), i) + "\n";
  expect_round_trip(text);
}

TEST_P(EveryVertexType, OnABadLineIsAnErrorWithItsNumber) {
  RandomLines lines(standard_types(), 2);
  expect_bad_lines_are_errors(lines.parameters(), lines.vertex(GetParam(), 5));
}

TEST_P(EveryVertexType, StaysWhereItIsOnAStepOfZeroAndMovesOnAnyOther) {
  RandomLines lines(standard_types(), 3);
  std::string text = lines.parameters();
  for (int i = 0; i < kSamples; ++i) text += lines.vertex(GetParam(), i) + "\n";
  const Graph graph = read(text);
  const VertexPool& pool = *graph.vertex_pools()[0];
  for (int i = 0; i < pool.size(); ++i) {
    const std::vector<ActiveVertex> active{{i, 0, 0}};
    const Eigen::Map<const Eigen::VectorXd> state(pool.state(i), pool.state_size(i));
    Eigen::VectorXd step = Eigen::VectorXd::Zero(pool.dimension(i)), moved = state;
    pool.oplus(active, state.data(), step.data(), moved.data());
    for (Eigen::Index k = 0; k < state.size(); ++k) {
      // A heading of π may come back as −π.
      const double turn = 2.0 * std::numbers::pi;
      EXPECT_NEAR(std::remainder(moved[k] - state[k], turn), 0.0, 1e-15 * (1 + std::abs(state[k])));
    }
    for (int d = 0; d < pool.dimension(i); ++d) {
      step.setZero();
      step[d] = 1e-3;
      pool.oplus(active, state.data(), step.data(), moved.data());
      // Not far where a line close to the origin turns about itself.
      EXPECT_GT((moved - state).norm(), 1e-6) << "direction " << d;
    }
  }
}

class EveryParameterType : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(RegisteredTypes, EveryParameterType,
                         testing::ValuesIn(tags_of(Kind::kParameter)), test_name);

TEST_P(EveryParameterType, ComesBackFromAFileAndIsRefusedOnABadLine) {
  const RandomLines lines(standard_types(), 1);
  std::istringstream in(lines.parameters());
  bool found = false;
  for (std::string line; std::getline(in, line);) {
    if (tokens_of(line)[0] != GetParam()) continue;
    found = true;
    expect_round_trip(line + "\n");
    expect_bad_lines_are_errors("", line);
  }
  EXPECT_TRUE(found);
}

class EveryEdgeType : public testing::TestWithParam<std::string> {
 protected:
  /// Many edges of the type, each on vertices of its own.
  std::string random_edges(unsigned seed) const {
    RandomLines lines(standard_types(), seed);
    std::string text = lines.parameters();
    for (int i = 0; i < kSamples; ++i) {
      for (const std::string& line : lines.edge(GetParam(), 10 * i)) text += line + "\n";
    }
    return text;
  }
};
INSTANTIATE_TEST_SUITE_P(RegisteredTypes, EveryEdgeType, testing::ValuesIn(tags_of(Kind::kEdge)),
                         test_name);

TEST_P(EveryEdgeType, ComesBackFromAFileBitForBit) { expect_round_trip(random_edges(1)); }

TEST_P(EveryEdgeType, OnABadLineIsAnErrorWithItsNumber) {
  RandomLines lines(standard_types(), 2);
  const std::vector<std::string> all = lines.edge(GetParam(), 40);
  std::string before = lines.parameters();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) before += all[i] + "\n";
  expect_bad_lines_are_errors(before, all.back());
}

TEST_P(EveryEdgeType, HasTheJacobiansOfItsError) {
  Graph graph = read(random_edges(3));
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  StateEvaluation evaluation(problem, workspace.state());
  const Evaluation x = evaluation.get();
  ASSERT_EQ(graph.edge_pools().size(), 1u);
  const EdgePool& pool = *graph.edge_pools()[0];
  const CompiledEdges& edges = problem.edges()[0];
  ASSERT_EQ(edges.edges.size(), static_cast<std::size_t>(kSamples));
  int singular = 0;
  for (int k = 0; k < kSamples; ++k) {
    for (int slot = 0; slot < edges.slot_begin[k + 1] - edges.slot_begin[k]; ++slot) {
      const Eigen::MatrixXd used = pool.jacobian(edges, k, slot, x, false);
      const Eigen::MatrixXd numeric = pool.jacobian(edges, k, slot, x, true);
      if (relative_difference(used, numeric) <= 1e-6) continue;
      // Close to a singularity (a point in the camera's plane, a bearing to where one stands)
      // differences are no measure: they depend on their step.
      const Eigen::MatrixXd wide = differences(problem, workspace.state(), k, slot, 6e-6);
      const Eigen::MatrixXd narrow = differences(problem, workspace.state(), k, slot, 1.5e-6);
      ASSERT_GT(relative_difference(wide, narrow), 1e-7) << "edge " << k << " slot " << slot << "\n"
                                                         << used << "\n\n"
                                                         << numeric;
      ++singular;
    }
  }
  EXPECT_LE(singular, kSamples / 20);
}

TEST_P(EveryEdgeType, InABatchEqualsOneByOne) {
  Graph graph = read(random_edges(4));
  const RobustKernel kernels[] = {RobustKernel(), RobustKernel::parse("huber:0.5"),
                                  RobustKernel::parse("cauchy:2")};
  for (int i = 0; i < kSamples; ++i) graph.edge_pools()[0]->kernel(i) = kernels[i % 3];
  for (int v = 0; v < graph.vertex_slots(); v += 7) graph.set_fixed(v, true);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  EXPECT_GT(expect_batch_equals_one_by_one(workspace, 1e-13).hessian.norm(), 1.0);
}

}  // namespace
}  // namespace locograph::test
