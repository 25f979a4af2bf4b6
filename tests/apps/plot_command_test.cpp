#include <apps/command_runner.h>
#include <tinyxml2.h>

namespace locograph {
namespace {

bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

#define LOCOGRAPH_NEEDS_GNUPLOT() \
  if (!has_gnuplot()) GTEST_SKIP() << "no gnuplot"

/// Plots a file and returns the SVG, which must be XML with an <svg> root and something drawn.
std::string plot(const CommandRunner& runner, const std::string& file) {
  const Outcome outcome = runner.run("plot " + file + " -o out.svg");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const std::string svg = runner.read("out.svg");
  tinyxml2::XMLDocument xml;
  EXPECT_EQ(xml.Parse(svg.data(), svg.size()), tinyxml2::XML_SUCCESS) << file;
  if (xml.RootElement() == nullptr) return "";
  EXPECT_STREQ(xml.RootElement()->Name(), "svg");
  EXPECT_NE(svg.find("<path"), std::string::npos);
  return svg;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Plot, ConvergenceOfAnOptimisation) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  LOCOGRAPH_NEEDS_SHARED_DATA();
  const CommandRunner runner;
  const Outcome done = runner.run("optimize " + shared("pose_graphs/tinyGrid3D.g2o") + " --json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  runner.write("a.json", done.out);
  const std::string svg = plot(runner, "a.json");
  EXPECT_TRUE(contains(svg, "iteration"));
  EXPECT_TRUE(contains(svg, "chi2 (lower is better)"));
}

TEST(Plot, CycleTimesWithTheirPercentiles) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  nlohmann::json json = {{"horizon", 20}, {"cycle_times", nlohmann::json::array()}};
  for (int i = 1; i <= 100; ++i) json["cycle_times"].push_back(1e-3 * i);
  runner.write("r.json", json.dump());
  const std::string svg = plot(runner, "r.json");
  EXPECT_TRUE(contains(svg, "p50 = 50 ms"));
  EXPECT_TRUE(contains(svg, "p95 = 95 ms"));
  EXPECT_TRUE(contains(svg, "p99 = 99 ms"));
  EXPECT_TRUE(contains(svg, "100 cycles"));
  EXPECT_TRUE(contains(svg, "lower is better"));
}

TEST(Plot, RefineReportsTheTimesOfItsCycles) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan centauro_drive -o p.g2o").exit_code, 0);
  const Outcome refined = runner.run("refine p.g2o -o r.g2o --json");
  ASSERT_EQ(refined.exit_code, 0) << refined.err;
  EXPECT_EQ(refined.json()["cycle_times"].size(), refined.json()["cycles"]);
  runner.write("r.json", refined.out);
  EXPECT_GT(refined.json()["cycles"], 49) << "more than one for each step";
  EXPECT_TRUE(contains(plot(runner, "r.json"),
                       std::to_string(refined.json()["cycles"].get<int>()) + " cycles"));
}

TEST(Plot, ConstraintsOfACheckAndAPlanAgainstItsLimits) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan centauro_drive -o p.g2o").exit_code, 0);
  const Outcome checked = runner.run("check p.g2o --json");
  ASSERT_EQ(checked.exit_code, 0) << checked.err;
  runner.write("c.json", checked.out);
  const std::string bars = plot(runner, "c.json");
  EXPECT_TRUE(contains(bars, "self_collision"));
  EXPECT_TRUE(contains(bars, "velocity_limits"));
  EXPECT_TRUE(contains(bars, "where it holds (green)"));
  EXPECT_FALSE(contains(bars, "NOT feasible"));
  const std::string lines = plot(runner, "p.g2o");
  EXPECT_TRUE(contains(lines, "joint positions"));
  EXPECT_TRUE(contains(lines, "joint velocities"));
  EXPECT_TRUE(contains(lines, "joint jerk"));
  EXPECT_TRUE(contains(lines, "base path"));
  EXPECT_FALSE(contains(lines, "contact forces")) << "a drive states none";
  EXPECT_FALSE(contains(lines, "joint torques"));
  EXPECT_TRUE(contains(lines, "of links to each other"));
  EXPECT_TRUE(contains(lines, "static balance"));
}

TEST(Plot, APlanOfStancesHasNoVelocities) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan standing_up --stances-only -o s.g2o").exit_code, 0);
  const std::string svg = plot(runner, "s.g2o");
  EXPECT_TRUE(contains(svg, "joint positions"));
  EXPECT_TRUE(contains(svg, "base path"));
  EXPECT_TRUE(contains(svg, "contact forces that the plan states"));
  EXPECT_TRUE(contains(svg, "right_hand"));
  EXPECT_TRUE(contains(svg, "joint torques"));
  EXPECT_TRUE(contains(svg, "static balance"));
  EXPECT_FALSE(contains(svg, "joint velocities"));
  EXPECT_FALSE(contains(svg, "joint jerk"));
}

TEST(Plot, APlanWhoseScenarioIsGoneIsDrawnWithoutMargins) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("plan standing_up --stances-only -o s.g2o").exit_code, 0);
  std::string plan = runner.read("s.g2o");
  const std::string name = "PARAMS_SCENARIO 3 standing_up";
  ASSERT_NE(plan.find(name), std::string::npos);
  plan.replace(plan.find(name), name.size(), "PARAMS_SCENARIO 3 ./gone.xml");
  runner.write("s.g2o", plan);
  const Outcome outcome = runner.run("plot s.g2o -o out.svg");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(contains(outcome.err, "without distances and balance: s.g2o:")) << outcome.err;
  EXPECT_TRUE(contains(runner.read("out.svg"), "joint torques"));
  EXPECT_FALSE(contains(runner.read("out.svg"), "static balance"));
}

TEST(Plot, TableOfACampaign) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  runner.write("t.csv",
               "seed,success,reason,time_stance_planner,time_total\r\n0,true,\"planned, well\",1.5,"
               "3\r\n1,false,timeout,9,60\r\n2,true,planned,1.0,2.5\r\n");
  const std::string svg = plot(runner, "t.csv");
  EXPECT_TRUE(contains(svg, "3 runs, 2 solved (66.7 %)"));
  EXPECT_TRUE(contains(svg, "time_total"));
}

TEST(Plot, TableThatTheCampaignCommandWrote) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  ASSERT_EQ(runner.run("campaign centauro_drive --runs 2 --csv t.csv").exit_code, 0);
  const std::string csv = runner.read("t.csv"), solved = ",1,true,planned,";
  const std::size_t at = csv.find(solved);
  ASSERT_NE(at, std::string::npos) << csv;
  std::string failed = csv.substr(csv.rfind('\n', at) + 1);
  failed.replace(failed.find(solved), solved.size(), ",2,false,\"late,\nand \"\"far\"\"\",");
  runner.write("t.csv", csv + failed);
  const std::string svg = plot(runner, "t.csv");
  EXPECT_TRUE(contains(svg, "3 runs, 2 solved (66.7 %)"));
  EXPECT_TRUE(contains(svg, "planning_time"));
  EXPECT_TRUE(contains(svg, "judge_time"));
  EXPECT_FALSE(contains(svg, "duration_s")) << "what was planned takes it, not the planning";
}

TEST(Plot, TextOfAFileIsNeverACommand) {
  LOCOGRAPH_NEEDS_GNUPLOT();
  const CommandRunner runner;
  const std::string evil = "`touch owned` \"); system('touch owned') # ' \\n$END\ntouch";
  const nlohmann::json violation = {{"constraint", evil},
                                    {"unit", "m'\nsystem 'touch owned'"},
                                    {"worst", 0.1},
                                    {"limit", 0.2},
                                    {"violated", false}};
  runner.write("c.json", nlohmann::json({{"violations", {violation}}}).dump());
  plot(runner, "c.json");
  runner.write("o.json", nlohmann::json({{"algorithm", evil},
                                         {"reason", evil},
                                         {"initial_chi2", 4.0},
                                         {"iterations_detail", {{{"chi2", 1.0}}}}})
                             .dump());
  plot(runner, "o.json");
  runner.write("t.csv", "time_`touch owned`'\n1\n2\n");
  plot(runner, "t.csv");
  EXPECT_FALSE(runner.exists("owned"));
}

TEST(Plot, RefusesWhatItCannotDraw) {
  const CommandRunner runner;
  expect_refusal(runner.run("plot none.json -o o.svg"), "none.json", "");
  runner.write("a.json", "{\"x\": 1}");
  expect_refusal(runner.run("plot a.json -o o.svg"), "a.json", "nothing to plot");
  runner.write("b.json", "not JSON");
  expect_refusal(runner.run("plot b.json -o o.svg"), "b.json:1", "not JSON");
  runner.write("c.json", "{\"cycle_times\": []}");
  expect_refusal(runner.run("plot c.json -o o.svg"), "c.json", "no cycle times");
  runner.write("e.csv", "success,time_total\ntrue\n");
  expect_refusal(runner.run("plot e.csv -o o.svg"), "e.csv:2", "1 field, expected 2");
  runner.write("f.csv", "seed\n1\n");
  expect_refusal(runner.run("plot f.csv -o o.svg"), "f.csv", "no column of times");
  runner.write("g.json", "{\"violations\": [5]}");
  expect_refusal(runner.run("plot g.json -o o.svg"), "g.json", "another type");
  expect_refusal(runner.run("plot a.json -o no/o.svg"), "no/o.svg", "");
  EXPECT_FALSE(runner.exists("o.svg"));
}

}  // namespace
}  // namespace locograph
