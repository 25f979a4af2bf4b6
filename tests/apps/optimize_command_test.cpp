#include <apps/command_runner.h>
#include <locograph/common/uniform.h>
#include <plugins/small_robot.h>

#include <algorithm>
#include <random>
#include <sstream>

namespace locograph {
namespace {

/// Three planar poses in a row, a measurement between neighbours and one around.
const char kTriangle[] =
    "VERTEX_SE2 0 0 0 0\n"
    "VERTEX_SE2 1 0.9 0.1 0.1\n"
    "VERTEX_SE2 2 2.2 0.1 -0.1\n"
    "EDGE_SE2 0 1 1 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 1 2 1 0 0 100 0 0 100 0 100\n"
    "EDGE_SE2 0 2 2.1 0 0 100 0 0 100 0 100\n";

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

struct KnownOptimum {
  const char* graph;
  double chi2;
};

class KnownGraph : public testing::TestWithParam<KnownOptimum> {};

TEST_P(KnownGraph, IsOptimisedToItsBestKnownCost) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const Outcome outcome =
      runner.run("optimize " + shared(std::string("pose_graphs/") + GetParam().graph) + " --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NEAR(outcome.json()["final_chi2"], GetParam().chi2, 1e-3 * GetParam().chi2);
}

INSTANTIATE_TEST_SUITE_P(Optimize, KnownGraph,
                         testing::Values(KnownOptimum{"tinyGrid3D.g2o", 6.7278816},
                                         KnownOptimum{"CSAIL.g2o", 40.555129},
                                         KnownOptimum{"intel.g2o", 45.004696},
                                         KnownOptimum{"kitti_00.g2o", 98.322012}));

TEST(Optimize, TellsWhatIsFreeWhenTheSystemIsSingular) {
  const CommandRunner runner;
  runner.write("a.g2o",
               std::string(kTriangle) + "VERTEX_XY 7 1 1\nEDGE_BEARING_SE2_XY 1 7 0.5 100\n");
  const Outcome outcome = runner.run("optimize a.g2o --algorithm gn --json");
  EXPECT_NE(outcome.exit_code, 0);
  const nlohmann::json diagnosis = outcome.json()["diagnosis"];
  EXPECT_EQ(diagnosis["free_directions"], 1);
  EXPECT_EQ(diagnosis["parts"][0]["loosest"][0]["vertex"], 7);
  const Outcome text = runner.run("optimize a.g2o --algorithm gn");
  EXPECT_NE(text.out.find("1 direction is free, mostly at vertex 7 (VERTEX_XY)"), std::string::npos)
      << text.out;
}

/// The arm of a held configuration stands 0.25 rad beyond its limit.
const char kBeyondALimit[] =
    "PARAMS_ROBOT 0 cart.urdf - floating 0\n"
    "VERTEX_CONFIGURATION 3 0 0 - 0 0 0 0 0 0 1 2.25 0.2 0.3\n"
    "VERTEX_CONFIGURATION 4 0 1 - 0 0 0 0 0 0 1 2.5 0.2 0.3\n"
    "FIX 3\n"
    "EDGE_JOINT_LIMITS 3 3 0 scalar 1\n"
    "EDGE_JOINT_LIMITS 4 3 0 scalar 1\n"
    "EDGE_PLAN_TRACKING 4 9 0 0 0 0 0 0 1 0 0.2 0.3 scalar 1\n";

TEST(Optimize, TellsWhichConstraintsAreViolated) {
  const CommandRunner runner;
  runner.write("cart.urdf", test::kCartUrdf);
  runner.write("plan.g2o", kBeyondALimit);
  const nlohmann::json result = runner.run("optimize plan.g2o --json").json();
  EXPECT_EQ(result["constraints"], 2);
  EXPECT_EQ(result["violated_rows"], 1) << "the free configuration was brought inside";
  ASSERT_EQ(result["violations"].size(), 1u);
  const nlohmann::json worst = result["violations"][0];
  EXPECT_EQ(worst["constraint"], "EDGE_JOINT_LIMITS");
  EXPECT_EQ(worst["line"], 5);
  EXPECT_EQ(worst["vertices"], nlohmann::json({3}));
  EXPECT_EQ(worst["row"], 0);
  EXPECT_EQ(worst["name"], "arm_joint upper limit");
  EXPECT_EQ(worst["unit"], "rad");
  EXPECT_EQ(worst["one_sided"], true);
  EXPECT_DOUBLE_EQ(worst["amount"], 0.25);
  const std::string text =
      "EDGE_JOINT_LIMITS 3 (line 5), row 0: arm_joint upper limit exceeded by 0.25 rad";
  EXPECT_EQ(worst["text"], text);
  const Outcome summary = runner.run("optimize plan.g2o");
  EXPECT_NE(summary.out.find("2 constraints, 1 row violated\n  " + text), std::string::npos)
      << summary.out;
}

TEST(Optimize, HasNothingToSayOfConstraintsWhereThereAreNone) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  EXPECT_FALSE(runner.run("optimize a.g2o --json").json().contains("violations"));
}

TEST(Info, TellsWhichConstraintsAreViolated) {
  const CommandRunner runner;
  runner.write("cart.urdf", test::kCartUrdf);
  runner.write("plan.g2o", kBeyondALimit);
  const Outcome outcome = runner.run("info plan.g2o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  // As they stand in the file, the worse one first.
  const std::size_t worse = outcome.out.find(
                        "EDGE_JOINT_LIMITS 4 (line 6), row 0: arm_joint upper "
                        "limit exceeded by 0.5 rad"),
                    better = outcome.out.find(
                        "EDGE_JOINT_LIMITS 3 (line 5), row 0: arm_joint "
                        "upper limit exceeded by 0.25 rad");
  EXPECT_NE(worse, std::string::npos) << outcome.out;
  EXPECT_NE(better, std::string::npos) << outcome.out;
  EXPECT_LT(worse, better);
}

TEST(Optimize, DiagnosesAHealthyGraphWhenAsked) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome outcome = runner.run("optimize a.g2o --diagnose --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["diagnosis"]["healthy"], true);
  EXPECT_FALSE(runner.run("optimize a.g2o --json").json().contains("diagnosis"));
}

TEST(Optimize, EndsADiagnosisOnASignal) {
  if (std::system("command -v script >/dev/null") != 0) GTEST_SKIP() << "no script (bsdutils)";
  const CommandRunner runner;
  // Two of three directions are free at each of many poses: half a minute of work.
  std::string chain;
  for (int i = 0; i < 3000; ++i) {
    const std::string id = std::to_string(i);
    chain += "VERTEX_SE2 " + id + ' ' + id + " 0 0\n";
    if (i > 0) chain += "EDGE_SE2 " + std::to_string(i - 1) + ' ' + id + " 1 0 0 1 0 0 0 0 0\n";
  }
  runner.write("a.g2o", chain);
  // SIGTERM, as what a shell runs in the background ignores SIGINT.
  runner.write("job.sh",
               "'" LOCOGRAPH_COMMAND
               "' optimize a.g2o --initial-guess none --diagnose -o b.g2o --json >out & job=$!\n"
               "until grep -q diagnosing seen || ! kill -0 $job; do sleep 0.1; done\n"
               "kill $job; wait $job\n");
  const std::string line =
      "cd '" + runner.folder().string() + "' && script -qec 'sh job.sh' /dev/null >seen </dev/null";
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1) << runner.read("seen");
  const nlohmann::json json = nlohmann::json::parse(runner.read("out"));
  EXPECT_EQ(json["reason"], "interrupted");
  EXPECT_EQ(json["diagnosis"]["complete"], false);
  EXPECT_TRUE(runner.exists("b.g2o"));
}

TEST(Optimize, GivesTheWholeGraphToCeres) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome theirs = runner.run("optimize a.g2o --linear-solver ceres --json");
  if (theirs.err.find("built without Ceres") != std::string::npos) GTEST_SKIP() << theirs.err;
  ASSERT_EQ(theirs.exit_code, 0) << theirs.err;
  const nlohmann::json ours = runner.run("optimize a.g2o --json").json();
  EXPECT_EQ(theirs.json()["linear_solver"], "ceres");
  EXPECT_EQ(theirs.json()["dimension"], 6);
  EXPECT_NEAR(theirs.json()["final_chi2"].get<double>(), ours["final_chi2"].get<double>(), 1e-9);
}

TEST(Optimize, PrintsOneJsonObjectWithEveryField) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome outcome = runner.run("optimize a.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["vertices"], 3);
  EXPECT_EQ(json["edges"], 3);
  EXPECT_EQ(json["dimension"], 6);
  EXPECT_EQ(json["converged"], true);
  EXPECT_EQ(json["algorithm"], "lm");
  EXPECT_EQ(json["linear_solver"], "dense");
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["gauge"], "vertex 0 held");
  EXPECT_EQ(json["information_projected"], 0);
  EXPECT_GT(json["initial_chi2"].get<double>(), json["final_chi2"].get<double>());
  // Two steps of 1 m against one of 2.1 m, all equally certain: 3 × 100 × (0.1 m / 3)².
  EXPECT_NEAR(json["final_chi2"], 1.0 / 3.0, 1e-6);
  EXPECT_EQ(json["final_cost"], json["final_chi2"]);
  EXPECT_FALSE(json["reason"].get<std::string>().empty());
  EXPECT_EQ(json["iterations_detail"].size(), json["iterations"].get<std::size_t>());
  for (const char* phase : {"load", "compile", "optimize", "total"}) {
    EXPECT_GE(json["time"][phase].get<double>(), 0.0) << phase;
  }
}

TEST(Optimize, PrintsAReadableSummaryWithoutJson) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome outcome = runner.run("optimize a.g2o -o b.g2o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("3 vertices, 3 edges"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("written: b.g2o"), std::string::npos) << outcome.out;
}

TEST(Optimize, ReadsStandardInput) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome outcome = runner.run("optimize - --json < a.g2o");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["vertices"], 3);
}

TEST(Optimize, NamesStandardInputInErrors) {
  const CommandRunner runner;
  runner.write("a.g2o", "VERTEX_SE2 0 0 0 0\nNONSENSE 1\n");
  expect_refusal(runner.run("optimize - < a.g2o"), "stdin:2", "unknown tag 'NONSENSE'");
}

TEST(Optimize, WritesAnOptimumThatStaysWhereItIs) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome first = runner.run("optimize a.g2o -o b.g2o --json");
  const Outcome second = runner.run("optimize b.g2o --json");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(first.json()["final_chi2"], second.json()["initial_chi2"]);
}

TEST(Optimize, AddsNoFixLineToTheOutput) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  ASSERT_EQ(runner.run("optimize a.g2o -o b.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("b.g2o").find("FIX"), std::string::npos);
  EXPECT_EQ(lines(runner.read("b.g2o"))[0], "VERTEX_SE2 0 0 0 0") << "the held vertex moved";
}

TEST(Optimize, KeepsTheFixLinesOfTheInput) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle + std::string("FIX 2\n"));
  const Outcome outcome = runner.run("optimize a.g2o -o b.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["gauge"], "held by the file");
  EXPECT_NE(runner.read("b.g2o").find("FIX 2\n"), std::string::npos);
}

TEST(Optimize, HoldsAPoseRatherThanAPoint) {
  const CommandRunner runner;
  runner.write("a.g2o",
               "VERTEX_XY 0 1 0\nVERTEX_SE2 7 0 0 0\nVERTEX_SE2 8 1 0 0\n"
               "EDGE_SE2 7 8 1 0 0 1 0 0 1 0 1\nEDGE_SE2_XY 7 0 1 0.5 1 0 1\n");
  const Outcome outcome = runner.run("optimize a.g2o --algorithm gn --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["gauge"], "vertex 7 held");
}

TEST(Optimize, EveryAlgorithmAndSolverReachesTheSameCost) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  for (const char* options :
       {"--algorithm gn", "--algorithm dogleg", "--linear-solver dense", "--linear-solver banded",
        "--linear-solver block-cholesky", "--initial-guess odometry",
        "--initial-guess spanning-tree", "--initial-guess chordal"}) {
    const Outcome outcome = runner.run(std::string("optimize a.g2o --json ") + options);
    ASSERT_EQ(outcome.exit_code, 0) << options << ": " << outcome.err;
    EXPECT_NEAR(outcome.json()["final_chi2"], 1.0 / 3.0, 1e-6) << options;
  }
}

/// The triangle with its vertices far from where its edges say.
std::string misplaced_triangle() {
  std::string text = kTriangle;
  const std::size_t end = text.find("EDGE");
  return "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 -70 4 2\nVERTEX_SE2 2 9 90 -1\n" + text.substr(end);
}

TEST(Optimize, StartsFromTheFileWhereItsValuesAreBest) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  ASSERT_EQ(runner.run("optimize a.g2o -o b.g2o").exit_code, 0);
  const Outcome outcome = runner.run("optimize b.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["initial_guess"], "none");
  EXPECT_NE(runner.run("optimize b.g2o").out.find("starts from the values of the file\n"),
            std::string::npos);
}

TEST(Optimize, StartsFromABetterGuessWhereTheValuesOfTheFileAreWorseUnlessToldNotTo) {
  const CommandRunner runner;
  runner.write("a.g2o", misplaced_triangle());
  const nlohmann::json best = runner.run("optimize a.g2o --json").json();
  EXPECT_NE(best["initial_guess"], "none");
  EXPECT_LT(best["initial_chi2"].get<double>(), 10.0);
  EXPECT_NEAR(best["final_chi2"].get<double>(), 1.0 / 3.0, 1e-6);
  const nlohmann::json as_it_is = runner.run("optimize a.g2o --initial-guess none --json").json();
  EXPECT_EQ(as_it_is["initial_guess"], "none");
  EXPECT_GT(as_it_is["initial_chi2"].get<double>(), 100.0);
}

TEST(Optimize, SaysWhatAGraphWithoutVerticesStartsFrom) {
  const CommandRunner runner;
  const std::string text = kTriangle;
  runner.write("a.g2o", text.substr(text.find("EDGE")));
  const Outcome outcome = runner.run("optimize a.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.json()["initial_guess"], "none");
}

TEST(Optimize, GivesTheSameBitsAgainAndForAnyNumberOfThreads) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  ASSERT_EQ(runner.run("optimize a.g2o -o b.g2o").exit_code, 0);
  ASSERT_EQ(runner.run("optimize a.g2o -o c.g2o").exit_code, 0);
  ASSERT_EQ(runner.run("optimize a.g2o -o d.g2o --threads 4").exit_code, 0);
  EXPECT_EQ(runner.read("b.g2o"), runner.read("c.g2o"));
  EXPECT_EQ(runner.read("b.g2o"), runner.read("d.g2o"));
}

TEST(Optimize, ARobustKernelLowersTheCostOfAnOutlier) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle + std::string("EDGE_SE2 0 1 50 0 0 100 0 0 100 0 100\n"));
  const Outcome outcome = runner.run("optimize a.g2o --kernel cauchy:1 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LT(outcome.json()["final_cost"].get<double>(), 100.0);
  EXPECT_GT(outcome.json()["final_chi2"].get<double>(), 100.0);
}

TEST(Optimize, LeavesWrongLoopClosuresOutWhenAskedTo) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle + std::string("EDGE_SE2 0 2 50 0 0 100 0 0 100 0 100\n"));
  const Outcome outcome = runner.run("optimize a.g2o --gnc --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["rejected_edges"], 1);
  // What the triangle costs alone, and the price of one edge left out: χ²(0.99) of 3 dimensions.
  EXPECT_NEAR(outcome.json()["final_cost"].get<double>(), 1.0 / 3.0 + 11.3449, 1e-3);
  EXPECT_FALSE(runner.run("optimize a.g2o --json").json().contains("rejected_edges"));
}

TEST(Optimize, DoesNotBelieveAWrongLoopClosureForTheChordalGuessEither) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle + std::string("EDGE_SE2 0 2 50 0 0 100 0 0 100 0 100\n"));
  const Outcome outcome = runner.run("optimize a.g2o --initial-guess chordal --gnc --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["rejected_edges"], 1);
  // What the triangle costs alone: the wrong edge is not in the problem.
  EXPECT_NEAR(outcome.json()["final_chi2"].get<double>(), 1.0 / 3.0, 1e-6);
  const Outcome with_kernel =
      runner.run("optimize a.g2o --initial-guess chordal --kernel dcs:1 --json");
  ASSERT_EQ(with_kernel.exit_code, 0) << with_kernel.err;
  // DCS of width 1 never costs more than 3.
  EXPECT_NEAR(with_kernel.json()["final_cost"].get<double>(), 1.0 / 3.0 + 3.0, 1e-3);
}

TEST(Optimize, SaysNoWhenTheIterationsRunOutAndStillWritesWhatItHas) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  const Outcome outcome = runner.run("optimize a.g2o --iterations 1 -o b.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.json()["converged"], false);
  EXPECT_EQ(outcome.json()["reason"], "the number of iterations is used up");
  EXPECT_TRUE(runner.exists("b.g2o"));
}

TEST(Optimize, NamesTheVertexWhereTheSystemIsSingular) {
  const CommandRunner runner;
  // Nothing says where vertex 5 is along y, nor how it is turned.
  runner.write("a.g2o",
               "VERTEX_SE2 4 0 0 0\nVERTEX_SE2 5 1 0 0\nFIX 4\n"
               "EDGE_SE2 4 5 2 0 0 1 0 0 0 0 0\n");
  const Outcome outcome = runner.run("optimize a.g2o --algorithm gn --initial-guess none --json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.json()["reason"], "the linear system is singular at vertex 5");
}

TEST(Optimize, RefusesADisconnectedGraphNamingTheSecondPart) {
  const CommandRunner runner;
  const std::string graph = kTriangle + std::string(
                                            "VERTEX_SE2 7 0 0 0\nVERTEX_SE2 8 1 0 0\n"
                                            "EDGE_SE2 7 8 1 0 0 1 0 0 1 0 1\n");
  runner.write("a.g2o", graph);
  expect_refusal(runner.run("optimize a.g2o -o b.g2o"), "a.g2o:7",
                 "vertex 7 begins part 2 of 2 (2 of 5 vertices)");
  EXPECT_FALSE(runner.exists("b.g2o"));
  runner.write("a.g2o", "FIX 0\n" + graph);
  expect_refusal(runner.run("optimize a.g2o"), "a.g2o:8", "vertex 7 begins part 2 of 2");
  runner.write("a.g2o", "FIX 0 8\n" + graph);
  EXPECT_EQ(runner.run("optimize a.g2o").exit_code, 0) << "both parts are held by the file";
}

TEST(Optimize, HoldsAVertexOfEachPartWhenLenient) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle + std::string("VERTEX_SE2 7 0 0 0\nVERTEX_SE2 8 1 0 0\n"
                                                "EDGE_SE2 7 8 2 0 0 1 0 0 1 0 1\n"));
  const Outcome outcome = runner.run("optimize a.g2o --lenient -o b.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["gauge"], "vertices 0, 7 held");
  EXPECT_NE(outcome.err.find("warning"), std::string::npos);
  EXPECT_EQ(runner.read("b.g2o").find("FIX"), std::string::npos);
}

TEST(Optimize, ProjectsIndefiniteInformationWhenLenient) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle + std::string("EDGE_SE2 0 2 2 0 0 1 2 0 1 0 1\n"));
  const Outcome outcome = runner.run("optimize a.g2o --lenient --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["information_projected"], 1);
  EXPECT_NE(outcome.err.find("a.g2o:7"), std::string::npos) << outcome.err;
}

TEST(Optimize, RefusesCubicleWithTheNumberOfIndefiniteMatrices) {
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const Outcome outcome = runner.run("optimize " + shared("pose_graphs/cubicle.g2o"));
  expect_refusal(outcome, LOCOGRAPH_SHARED_DATA "/pose_graphs/cubicle.g2o:5753",
                 "the first of 5021 such among 16869 edges");
}

struct BadInput {
  const char* name;
  std::string text;
  int line;  ///< 0: of the file as a whole
  const char* words;
};

class BadGraph : public testing::TestWithParam<BadInput> {};

TEST_P(BadGraph, IsRefusedInOneLineAndNothingIsWritten) {
  const CommandRunner runner;
  runner.write("bad.g2o", GetParam().text);
  const std::string place =
      "bad.g2o" + (GetParam().line > 0 ? ":" + std::to_string(GetParam().line) : "");
  expect_refusal(runner.run("optimize bad.g2o -o out.g2o"), place, GetParam().words);
  expect_refusal(runner.run("optimize bad.g2o -o out.g2o --json"), place, GetParam().words);
  EXPECT_EQ(runner.files(), 1) << "only the input";
}

const char kPose[] = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n";
const char kTwo[] = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";

INSTANTIATE_TEST_SUITE_P(
    Optimize, BadGraph,
    testing::Values(
        BadInput{"Empty", "", 0, "holds no graph"},
        BadInput{"OnlyComments", "# nothing\n\n", 0, "holds no graph"},
        BadInput{"Binary", std::string("\0\1\2\3\n", 5), 1, "unknown tag"},
        BadInput{"UnknownTag", "VERTEX_SE2 0 0 0 0\n\n  VERTEX_SE9 1 0 0\n", 3,
                 "unknown tag 'VERTEX_SE9'"},
        BadInput{"TruncatedLine", std::string(kTriangle).substr(0, sizeof(kTriangle) - 8), 6, ""},
        BadInput{"TooFewFields", "VERTEX_SE2 0 0 0\n", 1, "expected"},
        BadInput{"TooManyFields", "VERTEX_SE2 0 0 0 0 0\n", 1, "expected"},
        BadInput{"NotANumber", "VERTEX_SE2 0 0 x 0\n", 1, "'x'"},
        BadInput{"Nan", "VERTEX_SE2 0 0 nan 0\n", 1, "nan"},
        BadInput{"Infinity", "VERTEX_SE2 0 0 inf 0\n", 1, "inf"},
        BadInput{"FractionalId", "VERTEX_SE2 0.5 0 0 0\n", 1, "0.5"},
        BadInput{"DanglingId", kTwo + std::string("EDGE_SE2 0 9 1 0 0 1 0 0 1 0 1\n"), 3,
                 "unknown vertex 9"},
        BadInput{"DuplicatedId", kTwo + std::string("VERTEX_SE2 1 0 0 0\n"), 3,
                 "vertex 1 is declared twice, first on line 2"},
        BadInput{"VertexOfAnotherType", kTwo + std::string("EDGE_SE2_XY 0 1 1 0 1 0 1\n"), 3,
                 "vertex 1 is a VERTEX_SE2"},
        BadInput{"EdgeToItself", kTwo + std::string("EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n"), 3,
                 "names vertex 1 twice"},
        BadInput{"IndefiniteInformation", kTwo + std::string("EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n"), 3,
                 "indefinite"},
        BadInput{"NegativeInformation", kTwo + std::string("EDGE_SE2 0 1 1 0 0 -1 0 0 1 0 1\n"), 3,
                 "indefinite"},
        BadInput{"ZeroQuaternion", "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n", 1,
                 "quaternion of length zero"},
        BadInput{"FixOfNothing", kTwo + std::string("FIX 4\n"), 3, "unknown vertex 4"},
        BadInput{"UnknownParameter",
                 kPose + std::string("EDGE_SE3_PRIOR 0 3 0 0 0 0 0 0 1 "
                                     "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 "
                                     "1 0 0 1 0 1\n"),
                 2, "unknown parameter 3"}),
    [](const testing::TestParamInfo<BadInput>& info) { return std::string(info.param.name); });

TEST(Optimize, RefusesAFileThatIsNotThere) {
  const CommandRunner runner;
  expect_refusal(runner.run("optimize none.g2o"), "none.g2o", "cannot be opened");
  expect_refusal(runner.run("optimize ."), ".", "is a folder");
}

TEST(Optimize, RefusesAnOutputItCannotWriteBeforeItStarts) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  expect_refusal(runner.run("optimize a.g2o -o none/b.g2o"), "none/b.g2o", "writable folder");
  expect_refusal(runner.run("optimize a.g2o -o ."), ".", "is a folder");
  EXPECT_EQ(runner.files(), 1);
}

/// Each joint of each configuration but the first elsewhere by up to 0.02 rad; slopes stay.
std::string disturbed_drive(const std::string& text) {
  std::mt19937_64 random(1);
  std::string result;
  int configurations = 0;
  for (const std::string& line : lines(text)) {
    std::istringstream in(line);
    std::vector<std::string> fields;
    for (std::string field; in >> field;) fields.push_back(field);
    if (fields[0] == "VERTEX_CONFIGURATION" && configurations++ > 0) {
      constexpr std::size_t kJoints = 12, kEnd = kJoints + 18;  // after the base
      for (std::size_t k = kJoints; k < kEnd; ++k) {
        fields[k] = std::to_string(std::stod(fields[k]) + uniform(random, -0.02, 0.02));
      }
    }
    for (const std::string& field : fields) result += field + ' ';
    result += '\n';
  }
  return result;
}

TEST(Optimize, BringsADisturbedPlanBackWithTheSlopesThatItHas) {
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan centauro_drive -o drive.g2o --quiet").exit_code, 0);
  runner.write("disturbed.g2o", disturbed_drive(runner.read("drive.g2o")));
  EXPECT_EQ(runner.run("check disturbed.g2o --quiet").exit_code, 1);
  EXPECT_EQ(runner.run("optimize disturbed.g2o -o back.g2o --quiet").exit_code, 0);
  const Outcome checked = runner.run("check back.g2o");
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
}

TEST(Optimize, APlanThatIsNoneIsRefusedWithItsFileAndLine) {
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan centauro_drive -o drive.g2o --quiet").exit_code, 0);
  std::string text = runner.read("drive.g2o");
  const std::size_t at = text.find("VERTEX_CONFIGURATION");
  text.insert(at, "PARAMS_SEGMENT 90 1 14 0 1 rrt_connect\n");
  const std::string line = std::to_string(
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1);
  runner.write("segment.g2o", text);
  expect_refusal(runner.run("optimize segment.g2o"), "segment.g2o:" + line,
                 "segment 1 without those before it");
}

TEST(Optimize, RefusesWrongUsageInOneLine) {
  const CommandRunner runner;
  runner.write("a.g2o", kTriangle);
  for (const char* usage :
       {"optimize", "optimize a.g2o --bogus", "optimize a.g2o b.g2o",
        "optimize a.g2o --algorithm newton", "optimize a.g2o --linear-solver magic",
        "optimize a.g2o --kernel soft", "optimize a.g2o --kernel huber:0",
        "optimize a.g2o --kernel huber:x", "optimize a.g2o --initial-guess lucky",
        "optimize a.g2o --iterations -1", "optimize a.g2o --iterations many",
        "optimize a.g2o --gain 2", "optimize a.g2o --gain nan", "optimize a.g2o --threads 0", "",
        "frobnicate", "--bogus"}) {
    SCOPED_TRACE(usage);
    expect_refusal(runner.run(usage), "", "");
  }
}

}  // namespace
}  // namespace locograph
