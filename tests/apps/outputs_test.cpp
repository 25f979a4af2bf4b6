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

TEST_F(Outputs, AreNotWrittenOverWhatWasGiven) {
  runner.write("c.xml", "<contacts version=\"1\"/>\n");
  runner.write("s.xml",
               "<scenario version=\"1\" name=\"s\">\n<robot model=\"centauro\" "
               "active=\"lower_body\"/>\n<wheels><wheel link=\"wheel_1\" radius=\"0.078\"/>"
               "</wheels>\n<environment obstacles=\"o.xml\"/>\n<drive distance=\"4\" "
               "speed=\"0.1\" configurations=\"50\"/>\n</scenario>\n");
  runner.write("o.xml", "<obstacles version=\"1\"/>\n");
  std::filesystem::create_symlink("in.g2o", path("link.g2o"));
  std::filesystem::create_hard_link(path("in.g2o"), path("twin.g2o"));
  const auto refused = [&](const std::string& command, const std::string& output,
                           const std::string& input) {
    const std::string before = runner.read(input);
    expect_refusal(runner.run(command + " -o " + output), output, "is an input");
    EXPECT_EQ(runner.read(input), before) << command;
  };
  for (const char* output : {"in.g2o", "./in.g2o", "link.g2o", "twin.g2o"}) {
    refused("optimize in.g2o", output, "in.g2o");
  }
  refused("view in.g2o", "in.g2o", "in.g2o");
  refused("view in.g2o --obstacles o.xml", "o.xml", "o.xml");
  refused("plot in.g2o", "in.g2o", "in.g2o");
  refused("refine in.g2o", "in.g2o", "in.g2o");
  refused("plan s.xml", "s.xml", "s.xml");
  refused("plan s.xml", "o.xml", "o.xml");
  refused("posture centauro --contacts c.xml", "c.xml", "c.xml");
  const std::string scenario = runner.read("s.xml");
  expect_refusal(runner.run("campaign s.xml --runs 1 --csv s.xml"), "s.xml", "is an input");
  EXPECT_EQ(runner.read("s.xml"), scenario);
}

TEST_F(Outputs, AreNotWrittenIntoOneFile) {
  expect_refusal(runner.run("view in.g2o -o x.html --png ./x.html"), "./x.html",
                 "two results in one file");
  expect_refusal(runner.run("plan standing_up --stances-only -o x --tree x"), "x",
                 "two results in one file");
  EXPECT_EQ(runner.run("optimize in.g2o -o x.g2o").exit_code, 0);
  EXPECT_EQ(runner.run("optimize in.g2o -o x.g2o").exit_code, 0) << "an older result is replaced";
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
