#include <apps/command_runner.h>

namespace locograph {
namespace {

const std::string kBeacons = "'" LOCOGRAPH_SOURCE_DIR "/examples/plugin/beacons.g2o'";

std::string test_plugin(const std::string& name) {
  return LOCOGRAPH_TEST_PLUGINS "/" + name + ".so";
}

TEST(PluginOption, AddsTheTypesOfALibraryFoundByItsBareName) {
  const CommandRunner runner;
  const Outcome without = runner.run("optimize " + kBeacons);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("unknown tag"), std::string::npos) << without.err;

  const Outcome with = runner.run("optimize " + kBeacons + " --plugin range -o out.g2o --json");
  ASSERT_EQ(with.exit_code, 0) << with.err;
  // The file's numbers have nine digits; what is found is exact to them.
  EXPECT_LT(with.json()["final_chi2"].get<double>(), 1e-12);
  EXPECT_EQ(with.json()["edges"], 11);
  const std::string out = runner.read("out.g2o");
  EXPECT_NE(out.find("PARAMS_ANTENNA 0 0.2"), std::string::npos) << out;
  EXPECT_NEAR(std::stod(out.substr(out.find("VERTEX_RANGE_BIAS 2") + 20)), 0.25, 1e-6);
  // What was saved is loaded again, and is as good as before.
  const Outcome again = runner.run("optimize out.g2o --plugin range.so --json");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_LT(again.json()["initial_chi2"].get<double>(), 1e-12);
}

TEST(PluginOption, MayBeGivenManyTimesBeforeTheFileToo) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("info --plugin range --plugin " + test_plugin("toy_plugin") +
                                     " " + kBeacons + " --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["unknown_lines"], 0);
  EXPECT_EQ(outcome.json()["vertices"]["by_tag"]["VERTEX_RANGE_BIAS"], 1);
  EXPECT_EQ(outcome.json()["parameters"]["PARAMS_ANTENNA"], 1);
  const Outcome types = runner.run("list types --plugin range");
  EXPECT_EQ(types.exit_code, 0);
  EXPECT_NE(types.out.find("\nEDGE_BIASED_RANGE\n"), std::string::npos);
}

TEST(PluginOption, RefusesWhatIsNoPlugIn) {
  const CommandRunner runner;
  runner.write("text.so", "not an ELF file\n");
  const std::string other = test_plugin("other_build_plugin"), none = test_plugin("no_entry_point");
  for (const char* command : {"optimize a.g2o", "info a.g2o", "list types", "check a.g2o",
                              "refine a.g2o -o b.g2o", "view a.g2o -o b.html"}) {
    const std::string start = std::string(command) + " --plugin ";
    runner.write("a.g2o", "VERTEX_XY 0 0 0\n");
    expect_refusal(runner.run(start + "./missing.so"), "./missing.so", "does not exist");
    expect_refusal(runner.run(start + "text.so"), "text.so", "cannot be loaded");
    expect_refusal(runner.run(start + "missing"), "", "plug-in 'missing' is not to be found");
    expect_refusal(runner.run(start + none), none, "LOCOGRAPH_PLUGIN");
    expect_refusal(runner.run(start + other), other, "EIGEN_MAX_ALIGN_BYTES 16 instead of 64");
    expect_refusal(runner.run(start + "range --plugin range"), "", "registered twice");
    EXPECT_FALSE(runner.exists("b.g2o"));
  }
}

}  // namespace
}  // namespace locograph
