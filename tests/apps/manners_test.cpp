#include <apps/command_runner.h>
#include <locograph/apps/progress.h>

namespace locograph {
namespace {

TEST(Manners, AMistypedCommandIsAnsweredWithTheOneThatIsMeant) {
  const CommandRunner runner;
  expect_refusal(runner.run("optmize a.g2o"), "", "did you mean 'optimize'?");
  expect_refusal(runner.run("optmize a.g2o"), "", "unknown command 'optmize'");
  expect_refusal(runner.run("inof a.g2o"), "", "did you mean 'info'?");
  expect_refusal(runner.run("dance"), "", "expected one of optimize, plan");
  EXPECT_EQ(runner.run("dance").err.find("did you mean"), std::string::npos);
}

TEST(Manners, AMistypedOptionIsAnsweredWithTheOneThatIsMeant) {
  const CommandRunner runner;
  expect_refusal(runner.run("optimize a.g2o --itertions 3"), "", "did you mean '--iterations'?");
  expect_refusal(runner.run("plan centauro_drive --ouput=p.g2o"), "", "did you mean '--output'?");
  expect_refusal(runner.run("check p.g2o --torque_limits report"), "",
                 "did you mean '--torque-limits'?");
  expect_refusal(runner.run("info a.g2o b.g2o"), "", "unexpected 'b.g2o'");
}

TEST(Manners, ANumberOutOfRangeIsAnsweredWithTheRange) {
  const CommandRunner runner;
  const auto answer = [&runner](const std::string& arguments) {
    const Outcome outcome = runner.run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    return outcome.err;
  };
  for (const std::string value : {"-1", "nan", "inf", "soon"}) {
    EXPECT_EQ(answer("plan centauro_drive -o p.g2o --timeout=" + value),
              "locograph: --timeout: '" + value +
                  "', expected a number >= 0 (see: locograph plan --help)\n");
  }
  EXPECT_EQ(answer("plan centauro_drive -o p.g2o --threads 0"),
            "locograph: --threads: '0', expected a number > 0 (see: locograph plan --help)\n");
  EXPECT_EQ(answer("check p.g2o --clearance 0.7"),
            "locograph: --clearance: '0.7', expected a number from 0 to 0.5 "
            "(see: locograph check --help)\n");
}

TEST(Manners, AWholeNumberThatIsNoneIsAnsweredWithTheRange) {
  const CommandRunner runner;
  const auto refused = [&runner](const std::string& arguments, const std::string& words) {
    expect_refusal(runner.run(arguments), "", words);
  };
  const std::string plan = "plan centauro_drive -o p.g2o ";
  refused(plan + "--seed -1", "--seed: '-1', expected a whole number from 0 to 4294967295");
  refused(plan + "--seed 4294967296", "expected a whole number from 0 to 4294967295");
  refused(plan + "--seed 1e30", "--seed: '1e30', expected a whole number (see");
  refused("posture go2 --contacts c.xml --seed 99999999999999999999",
          "expected a whole number from 0 to 18446744073709551615");
  for (const std::string until : {"nan", "inf", "-1", "1e300"}) {
    refused("check p.g2o --until " + until,
            "--until: '" + until + "', expected a number from 0 to 1e+06 (see");
  }
  refused("refine p.g2o -o r.g2o --rate 2e5", "--rate: '2e5', expected a number from 0 to 100000");
}

TEST(Manners, ANameThatIsEmptyIsNone) {
  const CommandRunner runner;
  runner.write("a.g2o", "VERTEX_XY 0 0 0\nVERTEX_XY 1 0 0\nEDGE_POINTXY 0 1 1 0 1 0 1\n");
  expect_refusal(runner.run("plan centauro_drive -o ''"), "", "--output: '', expected a name");
  expect_refusal(runner.run("optimize a.g2o -o ''"), "", "--output: '', expected a name");
  expect_refusal(runner.run("check ''"), "", "PLAN: '', expected a name");
}

TEST(Manners, ADashIsStandardInputWhereAGraphIsRead) {
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan centauro_drive -o p.g2o").exit_code, 0);
  const Outcome checked = runner.run("check - < p.g2o");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_EQ(checked.out.rfind("stdin: feasible", 0), 0u) << checked.out;
  EXPECT_EQ(runner.run("info - < p.g2o").exit_code, 0);
  runner.write("r.json", "{}\n");
  expect_refusal(runner.run("plot - -o r.svg < r.json"), "-", "holds nothing to plot");
  expect_refusal(runner.run("check - < /dev/null"), "stdin", "holds no graph");
  // A plan names the file of its scenario, so that has to have one.
  expect_refusal(runner.run("plan - -o q.g2o < p.g2o"), "standard input", "is no scenario");
  expect_refusal(runner.run("check p.g2o --scenario -"), "standard input", "is no scenario");
  EXPECT_FALSE(runner.exists("q.g2o"));
}

TEST(Manners, NothingInAFileReachesTheTerminalAsAControlCharacter) {
  const CommandRunner runner;
  const std::string drive =
      "<scenario version=\"1\" name=\"NAME\">\n<robot model=\"centauro\" "
      "active=\"lower_body\"/>\n</scenario>\n";
  const auto named = [&](const std::string& name) {
    std::string text = drive;
    runner.write("s.xml", text.replace(text.find("NAME"), 4, name));
    return runner.run("plan s.xml -o p.g2o");
  };
  for (const char* name : {"a&#27;[2J", "a\x1b[2J", "a&#10;b", "a\x7f", "a\xc2\x9b"}) {
    expect_refusal(named(name), "s.xml:1", "a control character in name");
  }
  EXPECT_EQ(named("gr\xc3\xb6\xc3\x9f"
                  "er")
                .err.find("control"),
            std::string::npos);
  runner.write("a.g2o", "VERTEX_\x1b[31mRED 0 0 0\n");
  expect_refusal(runner.run("optimize a.g2o"), "a.g2o:1", "VERTEX_\\x1b[31mRED");
  const Outcome info = runner.run("info a.g2o; true");
  EXPECT_EQ((info.out + info.err).find('\x1b'), std::string::npos);
  const std::string robot = "<robot name=\"r\x7fr\"><link name=\"base\"/></robot>\n";
  runner.write("r.urdf", robot);
  const Outcome described = runner.run("info r.urdf --json; true");
  EXPECT_EQ((described.out + described.err).find('\x7f'), std::string::npos);
}

TEST(Manners, AMistypedNameIsAnsweredWithTheOneThatIsMeant) {
  const CommandRunner runner;
  runner.write("a.g2o", "VERTEX_XY 0 0 0\nVERTEX_XY 1 0 0\nEDGE_POINTXY 0 1 1 0 1 0 1\n");
  const auto answered = [&runner](const std::string& arguments, const std::string& place,
                                  const std::string& name) {
    expect_refusal(runner.run(arguments), place, "did you mean '" + name + "'?");
  };
  answered("optimize a.g2o --linear-solver shcur", "", "schur");
  answered("optimize a.g2o --kernel hubre:2", "", "huber");
  answered("optimize a.g2o --algorithm dogelg", "", "dogleg");
  answered("optimize a.g2o --initial-guess spaning-tree", "", "spanning-tree");
  answered("posture centuaro --contacts c.xml", "centuaro", "centauro");
  answered("plan centauro_drvie -o p.g2o", "centauro_drvie", "centauro_drive");
  answered("list solver", "", "solvers");
  runner.write("s.xml",
               "<scenario version=\"1\" name=\"s\">\n<robot model=\"centaur\"/>\n</scenario>");
  answered("plan s.xml -o p.g2o", "s.xml:2", "centauro");
}

TEST(Manners, AnUnknownTagIsAnsweredWithTheOptionsThatHelp) {
  const CommandRunner runner;
  runner.write("a.g2o", "VERTEX_SE9 0 0 0\n");
  expect_refusal(runner.run("optimize a.g2o"), "a.g2o:1", "--plugin LIB.so loads more types");
  expect_refusal(runner.run("optimize a.g2o"), "a.g2o:1", "--lenient leaves out unknown lines");
  // Only options that the command has.
  expect_refusal(runner.run("check a.g2o"), "a.g2o:1", "--plugin");
  EXPECT_EQ(runner.run("check a.g2o").err.find("--lenient"), std::string::npos);
}

TEST(Manners, QuietLeavesOutWarnings) {
  const CommandRunner runner;
  runner.write("a.g2o",
               "VERTEX_XY 0 0 0\nVERTEX_XY 1 0 0\nFIX 0\nEDGE_POINTXY 0 1 1 0 1 0 1\nUNKNOWN 3\n");
  EXPECT_NE(runner.run("optimize a.g2o --lenient").err, "");
  const Outcome quiet = runner.run("optimize a.g2o --lenient --quiet");
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
  EXPECT_NE(quiet.out, "");
}

TEST(Progress, TellsTheShareThatIsDoneAndTheTimeToGo) {
  EXPECT_EQ(progress_line("reading a.g2o", 3.0, 0.25, ""),
            "reading a.g2o [#####---------------] 25 %, 9 s to go");
  EXPECT_EQ(progress_line("refining", 3.0, 0.5, "step 4"),
            "refining [##########----------] 50 %, 3 s to go, step 4");
  EXPECT_EQ(progress_line("refining", 600.0, 0.5, ""),
            "refining [##########----------] 50 %, 10 min to go");
  EXPECT_EQ(progress_line("refining", 4.0, 0.0, ""), "refining [--------------------] 0 %");
}

TEST(Progress, WithoutAShareTellsTheTimeThatHasPassed) {
  EXPECT_EQ(progress_line("checking p.g2o", 4.0, {}, ""), "checking p.g2o, 4 s");
  EXPECT_EQ(progress_line("optimising", 4.0, {}, "iteration 7"), "optimising, 4 s, iteration 7");
}

/// What a terminal shows while the command waits for its input, until these words of a shell end.
std::string on_a_terminal(const CommandRunner& runner, const std::string& wait,
                          const std::string& arguments) {
  runner.write("a.g2o", "VERTEX_XY 0 0 0\nVERTEX_XY 1 0 0\nFIX 0\nEDGE_POINTXY 0 1 1 0 1 0 1\n");
  const std::string line = "cd '" + runner.folder().string() + "' && script -qec \"(" + wait +
                           "; cat a.g2o) | '" LOCOGRAPH_COMMAND "' " + arguments +
                           "\" /dev/null >seen </dev/null";
  EXPECT_EQ(std::system(line.c_str()), 0);
  return runner.read("seen");
}

TEST(Progress, IsShownOnATerminalAndErasedInTheEnd) {
  if (std::system("command -v script >/dev/null") != 0) GTEST_SKIP() << "no script (bsdutils)";
  const CommandRunner runner;
  const std::string seen = on_a_terminal(
      runner, "timeout 600 sh -c 'until grep -q reading seen; do sleep 0.1; done'", "optimize -");
  const std::size_t shown = seen.find("\r\033[Kreading stdin");
  ASSERT_NE(shown, std::string::npos) << seen;
  EXPECT_NE(seen.find("\r\033[K", seen.rfind("reading stdin")), std::string::npos) << seen;
  EXPECT_EQ(on_a_terminal(runner, "sleep 2", "optimize - --quiet").find("reading"),
            std::string::npos);
}

}  // namespace
}  // namespace locograph
