#include <gtest/gtest.h>
#include <locograph/common/error.h>

#include <algorithm>
#include <fstream>

#include "benchmarks/nist/nist_problem.h"

namespace locograph {
namespace {

std::vector<std::filesystem::path> data_sets() {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "nist";
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".dat") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

struct Tally {
  int solved = 0, runs = 0;
  std::string missed;
};

Tally solve_all(const OptimiserOptions& options) {
  Tally tally;
  for (const std::filesystem::path& file : data_sets()) {
    const NistProblem problem = read_nist(file);
    for (int start = 0; start < 2; ++start) {
      ++tally.runs;
      const NistSolution solution = solve_nist(problem, start, options);
      if (problem.correct_digits(solution.parameters) >= 4.0) {
        ++tally.solved;
      } else {
        tally.missed += " " + problem.name + " from start " + std::to_string(start + 1) + " (" +
                        solution.result.reason_text() + ")";
      }
    }
  }
  return tally;
}

TEST(Nist, LevenbergMarquardtFindsFourDigitsFromEveryStart) {
  if (data_sets().empty()) GTEST_SKIP() << "the shared data sets of NIST StRD are not there";
  const Tally tally = solve_all(nist_options());
  EXPECT_EQ(tally.runs, 54);
  EXPECT_EQ(tally.solved, tally.runs) << tally.missed;
}

TEST(Nist, ALotOfInitialDampingIsNotAMatterOfTuning) {
  if (data_sets().empty()) GTEST_SKIP() << "the shared data sets of NIST StRD are not there";
  for (const double lambda : {300.0, 1e6}) {
    OptimiserOptions options = nist_options();
    options.initial_lambda = lambda;
    const Tally tally = solve_all(options);
    EXPECT_EQ(tally.solved, tally.runs) << lambda << tally.missed;
  }
}

TEST(Nist, DoglegFindsFourDigitsInMostProblems) {
  if (data_sets().empty()) GTEST_SKIP() << "the shared data sets of NIST StRD are not there";
  OptimiserOptions options = nist_options();
  options.algorithm = Algorithm::kDogleg;
  const Tally tally = solve_all(options);
  EXPECT_GE(tally.solved, 50) << tally.missed;
}

TEST(Nist, CorrectDigitsAreThoseOfTheWorstParameter) {
  NistProblem problem;
  problem.certified = {2.0, -1e-6};
  EXPECT_NEAR(problem.correct_digits({2.0, -1.001e-6}), 3.0, 1e-6);
  EXPECT_EQ(problem.correct_digits({2.0, -1e-6}), 11.0);
  EXPECT_EQ(problem.correct_digits({2.0, 1.0}), 0.0);
  EXPECT_EQ(problem.correct_digits({std::nan(""), -1e-6}), 0.0);
}

TEST(Nist, AFileThatIsNoDataSetIsAnErrorWithItsLine) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "locograph_nist.dat";
  const auto message = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      read_nist(file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string header =
      "               Starting Values   (lines 3 to 3)\n"
      "               Data              (lines 4 to 4)\n";
  EXPECT_NE(message("").find("Starting Values"), std::string::npos);
  EXPECT_NE(message(header + "b1 = 1 2\n1 2\n").find(":3: no parameter"), std::string::npos);
  EXPECT_NE(message(header + "b1 = 1 2 3 4\n1 x\n").find(":4: no observation"), std::string::npos);
  EXPECT_NE(message(header + "b1 = 1 2 3 4\n").find(":2: no range"), std::string::npos);
  EXPECT_EQ(message(header + "b1 = 1 2 3 4\n1 2\n"), "no error");
  std::filesystem::remove(file);
  EXPECT_THROW(read_nist(file), Error);
}

}  // namespace
}  // namespace locograph
