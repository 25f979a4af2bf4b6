#include <apps/command_runner.h>

#include <set>
#include <sstream>

namespace locograph {
namespace {

std::set<std::string> list(const std::string& what) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("list " + what);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  std::set<std::string> names;
  std::istringstream in(outcome.out);
  for (std::string line; std::getline(in, line);) {
    EXPECT_EQ(line.find(' '), std::string::npos) << line;
    EXPECT_TRUE(names.insert(line).second) << line << " twice";
  }
  return names;
}

TEST(List, NamesTheTypesOfGraphFiles) {
  const std::set<std::string> types = list("types");
  for (const char* tag :
       {"VERTEX_SE2", "VERTEX_SE3:QUAT", "VERTEX_XY", "VERTEX_TRACKXYZ", "VERTEX_POINT_XYZ",
        "EDGE_SE2", "EDGE_SE3:QUAT", "EDGE_SE2_XY", "EDGE_SE3_TRACKXYZ", "PARAMS_SE3OFFSET",
        "PARAMS_SE2OFFSET", "PARAMS_CAMERACALIB", "VERTEX_TIME_STEP", "EDGE_DURATION",
        "EDGE_TIME_STEP_LIMITS", "EDGE_VELOCITY_LIMITS_TIMED",
        "EDGE_ACCELERATION_LIMITS_TIMED_SIGNED"}) {
    EXPECT_TRUE(types.count(tag)) << tag;
  }
}

TEST(List, AnUnknownLevelOfVectorInstructionsIsBadInput) {
  const CommandRunner runner;
  setenv("LOCOGRAPH_SIMD", "v9", 1);
  const Outcome outcome = runner.run("list solvers");
  unsetenv("LOCOGRAPH_SIMD");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("LOCOGRAPH_SIMD: no level is called 'v9'"), std::string::npos);
}

TEST(List, EverySolverItNamesCanBeChosen) {
  const CommandRunner runner;
  runner.write("a.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 2 0 0 1 0 0 1 0 1\n");
  for (const std::string& solver : list("solvers")) {
    EXPECT_EQ(runner.run("optimize a.g2o --linear-solver " + solver).exit_code, 0) << solver;
  }
}

TEST(List, EveryKernelItNamesCanBeChosen) {
  const CommandRunner runner;
  runner.write("a.g2o",
               "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1.1 0 0 1 0 0 1 0 1\n");
  for (const std::string& kernel : list("kernels")) {
    EXPECT_EQ(runner.run("optimize a.g2o --kernel " + kernel).exit_code, 0) << kernel;
  }
}

TEST(List, FindsTheRobotsThatComeAlong) {
  for (const char* robot : {"centauro", "coman_plus", "coman_plus_grippers", "go2"}) {
    EXPECT_TRUE(list("robots").count(robot)) << robot;
  }
}

TEST(List, NamesTheScenariosThatComeAlong) {
  EXPECT_TRUE(list("scenarios").count("centauro_drive"));
}

TEST(List, RefusesWhatThereIsNoListOf) {
  const CommandRunner runner;
  expect_refusal(runner.run("list planets"), "", "planets");
  expect_refusal(runner.run("list"), "", "WHAT");
}

TEST(Command, TellsItsVersionAndItsUsage) {
  const CommandRunner runner;
  const Outcome version = runner.run("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.substr(0, 10), "locograph ");
  for (const char* help : {"--help", "optimize --help", "info --help", "list --help"}) {
    const Outcome outcome = runner.run(help);
    EXPECT_EQ(outcome.exit_code, 0) << help;
    EXPECT_NE(outcome.out.find("Usage"), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.err, "");
  }
}

TEST(Command, SaysSoWhenStandardOutputIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const CommandRunner runner;
  const Outcome outcome = runner.run("list types > /dev/full 2>.stderr; echo $?");
  EXPECT_EQ(outcome.out, "2\n");
}

}  // namespace
}  // namespace locograph
