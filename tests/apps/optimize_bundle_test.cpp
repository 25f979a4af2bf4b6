#include <apps/command_runner.h>

namespace locograph {
namespace {

const char kDubrovnik[] = "bundle/dubrovnik-3-7-pre.txt";

TEST(OptimizeBundle, EliminatesThePointsOfABalFileAndWritesAGraphFile) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const Outcome outcome = runner.run("optimize " + shared(kDubrovnik) + " -o out.g2o --json");
  ASSERT_LE(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["vertices"], 10);
  EXPECT_EQ(json["edges"], 19);
  EXPECT_EQ(json["dimension"], 48);
  EXPECT_EQ(json["gauge"], "free, held by damping");
  EXPECT_EQ(json["linear_solver"].get<std::string>().substr(0, 5), "schur");
  // 38 measurements of 48 unknowns: they can be met.
  EXPECT_LT(json["final_chi2"], 1e-4 * json["initial_chi2"].get<double>());
  const Outcome again = runner.run("optimize out.g2o --json");
  ASSERT_LE(again.exit_code, 1) << again.err;
  EXPECT_NEAR(again.json()["initial_chi2"], json["final_chi2"],
              1e-9 * json["final_chi2"].get<double>());
}

TEST(OptimizeBundle, KnowsABalFileByItsFirstLine) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  std::filesystem::copy_file(std::string(LOCOGRAPH_SHARED_DATA "/") + kDubrovnik,
                             runner.folder() / "problem");
  const Outcome outcome = runner.run("optimize problem --iterations 3 --json");
  EXPECT_EQ(outcome.json()["edges"], 19) << outcome.err;
}

TEST(OptimizeBundle, RefusesADamagedBalFileWithItsLine) {
  const CommandRunner runner;
  runner.write("a.bal", "1 1 1\n0 3 1 1\n0 0 0 0 0 0 1 0 0 1 1 1\n");
  expect_refusal(runner.run("optimize a.bal"), "a.bal:2", "index of a point 3");
  runner.write("b.txt", "1 1 1\n0 0 1 1\n0 0 0 0 0 0 1 0 0 1 1\n");
  expect_refusal(runner.run("optimize b.txt"), "b.txt:4", "the file ends");
}

}  // namespace
}  // namespace locograph
