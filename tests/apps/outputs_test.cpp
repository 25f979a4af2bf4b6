// Where commands write, and what becomes of what was there.
#include <apps/command_runner.h>
#include <sys/stat.h>

namespace locograph {
namespace {

const char kThreeSteps[] =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1.1 0 0\nVERTEX_SE2 2 2 0.1 0\n"
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
    "EDGE_SE2 0 2 2.1 0 0 1 0 0 1 0 1\n";

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    runner.write("in.g2o", kThreeSteps);
    ASSERT_EQ(runner.run("optimize in.g2o -o plain.g2o").exit_code, 0);
    optimised = runner.read("plain.g2o");
  }
  std::filesystem::path path(const std::string& name) const { return runner.folder() / name; }

  CommandRunner runner;
  std::string optimised;
};

TEST_F(Outputs, GoToStandardOutputAndNothingElseDoes) {
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1"}) {
    const Outcome outcome = runner.run(std::string("optimize in.g2o -o ") + name);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out, optimised) << name;
    EXPECT_NE(outcome.err.find("chi2"), std::string::npos) << outcome.err;
  }
}

TEST_F(Outputs, PassThroughPipes) {
  const Outcome outcome = runner.run("optimize in.g2o -o - 2>.log | cat");
  EXPECT_EQ(outcome.out, optimised);
}

TEST_F(Outputs, AreNotMixedWithJson) {
  for (const char* command : {"optimize in.g2o", "plan centauro_drive", "view in.g2o",
                              "posture coman_plus --contacts none.xml"}) {
    expect_refusal(runner.run(std::string(command) + " --json -o -"), "-",
                   "two results on standard output");
  }
  expect_refusal(runner.run("view in.g2o -o - --png /dev/stdout"), "/dev/stdout",
                 "two results on standard output");
}

TEST_F(Outputs, LeaveADeviceADevice) {
  EXPECT_EQ(runner.run("optimize in.g2o -o /dev/null").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(Outputs, ReplaceWhatALinkLeadsToAndKeepItsMode) {
  runner.write("real.g2o", "old");
  ASSERT_EQ(::chmod(path("real.g2o").c_str(), 0640), 0);
  std::filesystem::create_symlink("real.g2o", path("link.g2o"));
  ASSERT_EQ(runner.run("optimize in.g2o -o link.g2o").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.g2o")));
  EXPECT_EQ(runner.read("real.g2o"), optimised);
  struct stat status = {};
  ASSERT_EQ(::stat(path("real.g2o").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(Outputs, SayThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expect_refusal(runner.run("optimize in.g2o -o /dev/full"), "/dev/full",
                 "no space left on device");
  const Outcome info = runner.run("info in.g2o > /dev/full 2>.complaint; cat .complaint");
  EXPECT_EQ(info.out,
            "locograph: standard output: cannot be written: no space left on device, expected room "
            "for it\n");
}

TEST_F(Outputs, LeaveTheOldFileWhereTheNewOneIsTooLarge) {
  runner.write("out.g2o", "old");
  const int before = runner.files();
  const Outcome outcome = runner.run("list types >/dev/null; (ulimit -f 0; '" LOCOGRAPH_COMMAND
                                     "' optimize in.g2o -o out.g2o 2>&1) | cat");
  EXPECT_NE(outcome.out.find("file too large"), std::string::npos) << outcome.out;
  EXPECT_EQ(runner.read("out.g2o"), "old");
  EXPECT_EQ(runner.files(), before);
}

TEST_F(Outputs, RemoveWhatAKilledRunLeft) {
  runner.write(".out.g2o.locograph-abc123", "half");
  ASSERT_EQ(runner.run("optimize in.g2o -o out.g2o").exit_code, 0);
  EXPECT_FALSE(runner.exists(".out.g2o.locograph-abc123"));
}

}  // namespace
}  // namespace locograph
