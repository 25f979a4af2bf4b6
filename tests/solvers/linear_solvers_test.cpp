#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/solvers/linear_solvers.h>

#include <cstring>
#include <map>
#include <random>

#include "common/allocation_counter.h"
#include "common/sanitized.h"
#include "solvers/expect_solution.h"

namespace locograph::test {
namespace {

constexpr double kTolerance = 1e-12;  ///< of solutions, relative

std::vector<int> uniform(int count, int dimension) { return std::vector<int>(count, dimension); }
std::vector<int> mixed(int count, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<int> dimension;
  for (int i = 0; i < count; ++i) dimension.push_back(1 + static_cast<int>(engine() % 9));
  return dimension;
}

struct Case {
  std::string name;
  Pairs pairs;
  std::vector<int> dimension;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int d : {1, 2, 3, 6, 7}) {
    const std::string size = std::to_string(d);
    all.push_back({"Single" + size, {}, uniform(1, d)});
    all.push_back({"Diagonal" + size, {}, uniform(9, d)});
    all.push_back({"Chain" + size, chain_pairs(25, 1), uniform(25, d)});
    all.push_back({"Band" + size, chain_pairs(25, 3), uniform(25, d)});
    all.push_back({"ArrowFirst" + size, arrow_pairs(15, 0), uniform(15, d)});
    all.push_back({"ArrowMiddle" + size, arrow_pairs(15, 7), uniform(15, d)});
    all.push_back({"ArrowLast" + size, arrow_pairs(15, 14), uniform(15, d)});
    all.push_back({"Grid" + size, grid_pairs(6), uniform(36, d)});
    all.push_back({"Random" + size, random_pairs(30, 60, 7), uniform(30, d)});
    all.push_back({"Full" + size, chain_pairs(10, 9), uniform(10, d)});
  }
  all.push_back({"MixedChain", chain_pairs(25, 2), mixed(25, 1)});
  all.push_back({"MixedArrow", arrow_pairs(20, 5), mixed(20, 2)});
  all.push_back({"MixedGrid", grid_pairs(6), mixed(36, 3)});
  all.push_back({"MixedRandom", random_pairs(30, 70, 8), mixed(30, 4)});
  all.push_back({"WideChain", chain_pairs(20, 1), uniform(20, 30)});
  all.push_back({"WideBand", chain_pairs(20, 2), uniform(20, 24)});
  all.push_back({"VeryWideBand", chain_pairs(12, 8), uniform(12, kSanitized ? 24 : 40)});
  all.push_back({"HugeBlocks", chain_pairs(3, 2), uniform(3, kSanitized ? 100 : 200)});
  all.push_back({"WideMixed", chain_pairs(12, 3), {40, 3, 17, 90, 1, 6, 33, 24, 8, 16, 64, 2}});
  return all;
}

/// Made once, with its dense solutions, for all solvers and tests.
const RandomSystem& system_of(const Case& c, unsigned seed) {
  static std::map<std::pair<std::string, unsigned>, RandomSystem> made;
  const auto key = std::pair(c.name, seed);
  const auto found = made.find(key);
  if (found != made.end()) return found->second;
  return made.emplace(key, RandomSystem(c.pairs, c.dimension, seed)).first->second;
}

/// Those that factorise. Conjugate gradients are as exact as asked, and see an indefinite matrix
/// only where a diagonal block is: pcg_solver_test.cpp and schur_solver_test.cpp.
std::vector<std::string> direct_solver_names() {
  std::vector<std::string> names = linear_solver_names();
  std::erase_if(names, [](const std::string& name) { return name.ends_with("pcg"); });
  return names;
}

class EverySolver : public testing::TestWithParam<std::tuple<std::string, Case>> {
 protected:
  std::unique_ptr<LinearSolver> solver() const {
    return make_linear_solver(std::get<0>(GetParam()));
  }
  const RandomSystem& system(unsigned seed = 1) const {
    return system_of(std::get<1>(GetParam()), seed);
  }
};
INSTANTIATE_TEST_SUITE_P(LinearSolvers, EverySolver,
                         testing::Combine(testing::ValuesIn(direct_solver_names()),
                                          testing::ValuesIn(cases())),
                         [](const auto& info) {
                           std::string solver = std::get<0>(info.param);
                           std::erase(solver, '-');
                           return solver + std::get<1>(info.param).name;
                         });

TEST_P(EverySolver, AgreesWithDenseLdltDampingIncluded) {
  const std::unique_ptr<LinearSolver> s = solver();
  for (const unsigned seed : {1u, 2u}) {
    const RandomSystem& a = system(seed);
    s->analyse(a.pattern);
    ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
    EXPECT_EQ(s->failed_row(), -1);
    expect_solution(*s, a, kTolerance);
  }
}

TEST_P(EverySolver, BlocksOfZerosAreSolvedAsTheyAre) {
  const std::unique_ptr<LinearSolver> s = solver();
  RandomSystem a = system();
  s->analyse(a.pattern);
  // None, some and all of those beside the diagonal are 0, and then none again.
  for (const int of_three : {0, 1, 2, 3, 0}) {
    RandomSystem b = a;
    int i = 0;
    b.for_each_block([&](int r, int c, auto block) {
      if (r != c && i++ % 3 < of_three) block.setZero();
    });
    b.update_matrix();
    ASSERT_TRUE(s->factorise(b.values.data(), b.damping.data()));
    expect_solution(*s, b, kTolerance);
  }
}

TEST_P(EverySolver, FactorisesAndSolvesWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const std::unique_ptr<LinearSolver> s = solver();
  if (s->name() == "eigen" || s->name() == "cholmod") GTEST_SKIP() << "a library that allocates";
  const RandomSystem& a = system();
  std::vector<double> x(a.right_hand_side.size());
  s->analyse(a.pattern);
  const long before = allocation_count();
  s->analyse(a.pattern);
  const bool good = s->factorise(a.values.data(), a.damping.data());
  s->solve(a.right_hand_side.data(), x.data());
  const long after = allocation_count();
  EXPECT_TRUE(good);
  EXPECT_EQ(after - before, 0) << s->name();
}

TEST_P(EverySolver, GivesTheSameBitsEveryTime) {
  const RandomSystem& a = system();
  std::vector<double> first(a.right_hand_side.size()), again(first.size());
  for (std::vector<double>* x : {&first, &again}) {
    const std::unique_ptr<LinearSolver> s = solver();
    s->analyse(a.pattern);
    ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
    ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
    s->solve(a.right_hand_side.data(), x->data());
  }
  EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(double)), 0);
}

TEST_P(EverySolver, GivesTheSameBitsOnTwoThreads) {
  const RandomSystem& a = system();
  std::vector<double> alone(a.right_hand_side.size()), together(alone.size());
  const std::unique_ptr<LinearSolver> s = solver();
  s->analyse(a.pattern);
  ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
  s->solve(a.right_hand_side.data(), alone.data());
  ThreadPool threads(2);
  s->use_threads(&threads);
  ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
  s->solve(a.right_hand_side.data(), together.data());
  EXPECT_EQ(std::memcmp(alone.data(), together.data(), alone.size() * sizeof(double)), 0);
}

TEST_P(EverySolver, GivesBlocksOfTheInverse) {
  const std::unique_ptr<LinearSolver> s = solver();
  const RandomSystem& a = system();
  s->analyse(a.pattern);
  ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
  // Blocks of H in both triangles, and others that may lie outside the factor.
  std::vector<std::pair<int, int>> blocks;
  const int n = a.pattern.size();
  for (int c = 0; c < n; ++c) {
    blocks.emplace_back((7 * c + 3) % n, c);
    for (int k = a.pattern.column_begin[c]; k < a.pattern.column_begin[c + 1]; ++k) {
      blocks.emplace_back(a.pattern.row[k], c);
      blocks.emplace_back(c, a.pattern.row[k]);
    }
  }
  std::size_t size = 0;
  for (const auto& [r, c] : blocks) size += a.pattern.dimension[r] * a.pattern.dimension[c];
  std::vector<double> out(size);
  ASSERT_TRUE(s->inverse_blocks(a.pattern, blocks, out.data()));
  const Eigen::MatrixXd& expected = a.inverse();
  const double* next = out.data();
  for (const auto& [r, c] : blocks) {
    const int rows = a.pattern.dimension[r], columns = a.pattern.dimension[c];
    const Eigen::Map<const Eigen::MatrixXd> block(next, rows, columns);
    ASSERT_LE((block -
               expected.block(a.pattern.scalar_begin[r], a.pattern.scalar_begin[c], rows, columns))
                  .norm(),
              1e-12 * expected.norm())
        << r << ", " << c;
    next += rows * columns;
  }
}

TEST_P(EverySolver, NamesTheBlockThatIsNotPositiveDefiniteAndRecovers) {
  const std::unique_ptr<LinearSolver> s = solver();
  const RandomSystem& good = system();
  s->analyse(good.pattern);
  expect_bad_blocks_named(*s, good, kTolerance);
}

TEST_P(EverySolver, NamesABlockOfZeros) {
  const std::unique_ptr<LinearSolver> s = solver();
  RandomSystem a = system();
  const int bad = a.pattern.size() / 2;
  a.for_each_block([&](int r, int c, auto block) {
    if (r == bad || c == bad) block.setZero();
  });
  std::fill(a.damping.begin(), a.damping.end(), 0.0);
  s->analyse(a.pattern);
  EXPECT_FALSE(s->factorise(a.values.data(), a.damping.data()));
  EXPECT_EQ(s->failed_row(), bad);
  // Damping alone makes it solvable again.
  std::fill(a.damping.begin(), a.damping.end(), 0.5);
  a.update_matrix();
  ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data()));
  expect_solution(*s, a, kTolerance);
}

class EverySolverName : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(LinearSolvers, EverySolverName, testing::ValuesIn(direct_solver_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(EverySolverName, IsAnalysedAgainWhenThePatternChanges) {
  const std::unique_ptr<LinearSolver> s = make_linear_solver(GetParam());
  for (const Case& c : cases()) {
    const RandomSystem& a = system_of(c, 3);
    s->analyse(a.pattern);
    ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data())) << c.name;
    expect_solution(*s, a, kTolerance);
  }
}

TEST_P(EverySolverName, IsAnalysedAgainWhenOnlyTheBlockSizesChange) {
  const std::unique_ptr<LinearSolver> s = make_linear_solver(GetParam());
  for (const int d : {3, 6, 4, 6, 3}) {
    const RandomSystem a(grid_pairs(5), uniform(25, d), 3);
    s->analyse(a.pattern);
    ASSERT_TRUE(s->factorise(a.values.data(), a.damping.data())) << d;
    expect_solution(*s, a, kTolerance);
  }
}

TEST_P(EverySolverName, TakesAnEmptySystem) {
  const std::unique_ptr<LinearSolver> s = make_linear_solver(GetParam());
  s->analyse(make_pattern({}, {}));
  EXPECT_TRUE(s->factorise(nullptr, nullptr));
  s->solve(nullptr, nullptr);
  EXPECT_EQ(s->failed_row(), -1);
}

TEST_P(EverySolverName, HasItsName) {
  EXPECT_EQ(make_linear_solver(GetParam())->name(), GetParam());
}

TEST(LinearSolvers, ThatAreUnknownAreAnErrorNamingTheKnownOnes) {
  try {
    make_linear_solver("sparse");
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'sparse'"), std::string::npos) << message;
    for (const std::string& name : linear_solver_names()) {
      EXPECT_NE(message.find(name), std::string::npos) << message;
    }
  }
}

TEST(AutoSolver, ChoosesWhatSuitsThePattern) {
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  const auto choice = [&](const Pairs& pairs, const std::vector<int>& dimension) {
    solver->analyse(make_pattern(pairs, dimension));
    return solver->name();
  };
  EXPECT_EQ(choice(chain_pairs(20, 1), uniform(20, 30)), "banded");
  EXPECT_EQ(choice(chain_pairs(20, 2), uniform(20, 24)), "banded");
  EXPECT_EQ(choice(grid_pairs(20), uniform(400, 6)), "block-cholesky");
  EXPECT_EQ(choice(arrow_pairs(200, 0), uniform(200, 6)), "block-cholesky");
  EXPECT_EQ(choice(grid_pairs(3), uniform(9, 3)), "dense");
}

}  // namespace
}  // namespace locograph::test
