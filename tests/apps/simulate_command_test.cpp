// A plan carried out in the physics engine, and what is told of its record.
#include <apps/command_runner.h>

#include <sstream>
#include <vector>

namespace locograph {
namespace {

/// The shipped drive, planned and carried out once for all tests.
class SimulateTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    runner = new CommandRunner;
    std::filesystem::create_directory(runner->folder() / "runs");
    ASSERT_EQ(runner->run("plan centauro_drive -o drive.g2o").exit_code, 0);
    simulated = runner->run("simulate drive.g2o -o runs/r.g2o --csv runs/r.csv --json");
  }
  static void TearDownTestSuite() { delete runner; }

  static inline CommandRunner* runner = nullptr;
  static inline Outcome simulated;
};

std::vector<std::string> text_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool has_part(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(SimulateTest, WritesItsRecordAsAGraph) {
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const nlohmann::json json = simulated.json();
  EXPECT_EQ(json["output"], "runs/r.g2o");
  const std::string text = runner->read("runs/r.g2o");
  EXPECT_TRUE(has_part(text, "PARAMS_PLAN 1 3 recorded"));
  EXPECT_TRUE(has_part(text, "PARAMS_RECORD 6 ../drive.g2o\n"));
  EXPECT_TRUE(has_part(text, "PARAMS_SCENARIO 3 centauro_drive\n"));
  int moments = 0;
  for (const std::string& line : text_lines(text)) {
    moments += line.starts_with("VERTEX_CONFIGURATION ") ? 1 : 0;
  }
  EXPECT_NEAR(moments, json["time_s"].get<double>() / 0.02, 2.0);
}

TEST_F(SimulateTest, WritesATable) {
  const std::vector<std::string> lines = text_lines(runner->read("runs/r.csv"));
  ASSERT_GT(lines.size(), 2U);
  EXPECT_TRUE(lines.front().starts_with("time_s,plan_time_s,stance,base_x,")) << lines.front();
  for (const char* column : {",planned_base_qw,", ",planned_", ",torque_", ",force_"}) {
    EXPECT_TRUE(has_part(lines.front(), column)) << column;
  }
  const auto fields = [](const std::string& line) { return std::ranges::count(line, ','); };
  for (const std::string& line : lines) EXPECT_EQ(fields(line), fields(lines.front()));
}

TEST_F(SimulateTest, InfoTellsWhatTheRecordIs) {
  const Outcome outcome = runner->run("info runs/r.g2o --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json(), told = simulated.json();
  EXPECT_EQ(json["kind"], "record");
  const nlohmann::json& record = json["record"];
  EXPECT_EQ(record["plan"], "drive.g2o");
  EXPECT_EQ(record["plan_is_there"], true);
  EXPECT_NEAR(record["duration_s"], told["time_s"], 0.05);
  // Of every twentieth cycle.
  EXPECT_GT(record["max_base_error_m"], 0.0);
  EXPECT_LE(record["max_base_error_m"], told["max_base_error_m"].get<double>() + 1e-9);
  EXPECT_LE(record["max_joint_error_rad"], told["max_joint_error_rad"].get<double>() + 1e-9);
  EXPECT_LE(record["max_torque_ratio"], told["max_torque_ratio"].get<double>() + 1e-9);
  EXPECT_NE(record["worst_joint"], "");
}

TEST_F(SimulateTest, CheckDoesNotJudgeTheRecord) {
  const Outcome text = runner->run("check runs/r.g2o");
  EXPECT_EQ(text.exit_code, 1);
  EXPECT_TRUE(has_part(text.out, "runs/r.g2o: NOT judged: the record of the plan drive.g2o"))
      << text.out;
  const Outcome outcome = runner->run("check runs/r.g2o --json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.json()["recorded"], true);
  EXPECT_TRUE(outcome.json()["feasible"].is_null());
}

TEST_F(SimulateTest, TheRecordIsNoPlanForOtherCommands) {
  for (const char* command : {"optimize runs/r.g2o -o x.g2o", "refine runs/r.g2o -o x.g2o",
                              "simulate runs/r.g2o", "convert runs/r.g2o -o x.csv"}) {
    expect_refusal(runner->run(command), "runs/r.g2o", "is the record of a plan carried out");
  }
  EXPECT_FALSE(runner->exists("x.g2o"));
}

TEST_F(SimulateTest, TheRecordIsDrawnAndShownWithoutItsPlan) {
  std::filesystem::create_directory(runner->folder() / "away");
  std::filesystem::copy(runner->folder() / "runs/r.g2o", runner->folder() / "away/r.g2o");
  std::filesystem::rename(runner->folder() / "drive.g2o", runner->folder() / "hidden.g2o");
  const Outcome info = runner->run("info away/r.g2o --json");
  EXPECT_EQ(info.json()["record"]["plan_is_there"], false);
  if (std::system("command -v gnuplot >/dev/null 2>&1") == 0) {
    const Outcome plotted = runner->run("plot away/r.g2o -o out.svg");
    EXPECT_EQ(plotted.exit_code, 0) << plotted.err;
    const std::string svg = runner->read("out.svg");
    for (const char* title : {"base, off from the plan", "joints, off from the plan",
                              "contact forces that were measured", "joint torques"}) {
      EXPECT_TRUE(has_part(svg, title)) << title;
    }
  }
  const Outcome viewed = runner->run("view away/r.g2o -o out.html");
  std::filesystem::rename(runner->folder() / "hidden.g2o", runner->folder() / "drive.g2o");
  if (has_part(viewed.err, "the viewer's page is missing")) GTEST_SKIP() << "no viewer";
  EXPECT_EQ(viewed.exit_code, 0) << viewed.err;
  const std::string page = runner->read("out.html");
  for (const char* member : {"\"recorded\":true", "\"reference\":", "\"torques\":", "base off"}) {
    EXPECT_TRUE(has_part(page, member)) << member;
  }
  EXPECT_FALSE(has_part(page, "\"violations\":[{"));
}

TEST_F(SimulateTest, RefusesBadOutputsBeforeItBegins) {
  expect_refusal(runner->run("simulate drive.g2o -o missing/r.g2o"), "missing/r.g2o", "");
  expect_refusal(runner->run("simulate drive.g2o -o drive.g2o"), "drive.g2o", "");
  expect_refusal(runner->run("simulate drive.g2o -o a.g2o --csv a.g2o"), "a.g2o", "");
  EXPECT_FALSE(runner->exists("a.g2o"));
}

TEST_F(SimulateTest, EstimatesByItsSensorsWhereItIs) {
  EXPECT_TRUE(simulated.json()["max_estimate_error_m"].is_null());
  const Outcome outcome = runner->run("simulate drive.g2o --estimate --json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["carried_out"], true) << outcome.json()["reason"];
  EXPECT_GT(outcome.json()["max_estimate_error_m"], 0.0);
  EXPECT_LT(outcome.json()["max_estimate_error_rad"], 0.01);
}

TEST_F(SimulateTest, RefinesOnTheWay) {
  runner->write("box.xml", R"(<obstacles version="1">
  <box name="box" center="2 0 0.25" size="0.5 0.5 0.5"/>
</obstacles>)");
  const Outcome into = runner->run("simulate drive.g2o --obstacles box.xml --json");
  EXPECT_EQ(into.json()["carried_out"], false);
  EXPECT_NE(into.json()["other_link"], "");
  const Outcome past =
      runner->run("simulate drive.g2o --obstacles box.xml --refine -o past.g2o --json");
  EXPECT_EQ(past.exit_code, 0) << past.err;
  const nlohmann::json json = past.json();
  EXPECT_EQ(json["carried_out"], true) << json["reason"];
  EXPECT_EQ(json["refine"]["success"], true) << json["refine"]["reason"];
  EXPECT_GT(json["refine"]["cycles"], 1000);
  EXPECT_EQ(runner->run("info past.g2o --json").json()["kind"], "record");
}

TEST_F(SimulateTest, StopsBeforeAWall) {
  runner->write("wall.xml", R"(<obstacles version="1">
  <box name="wall" center="3 0 0.5" size="0.3 6 1"/>
</obstacles>)");
  const nlohmann::json json =
      runner->run("simulate drive.g2o --obstacles wall.xml --refine --json").json();
  EXPECT_EQ(json["upright"], true);
  EXPECT_EQ(json["reached_goal"], false);
  EXPECT_EQ(json["other_link"], "") << "it does not touch it";
  EXPECT_TRUE(has_part(json["reason"], "wall")) << json["reason"];
}

TEST_F(SimulateTest, CamerasSeeOnlyForRefining) {
  const Outcome outcome = runner->run("simulate drive.g2o --cameras");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(has_part(outcome.err, "--cameras without --refine")) << outcome.err;
}

TEST_F(SimulateTest, TheEndOfAnIncompletePlanIsNotItsGoal) {
  std::string text = runner->read("drive.g2o");
  const std::string mark = "PARAMS_PLAN 1 3";
  text.replace(text.find(mark), mark.size(), mark + " incomplete");
  runner->write("incomplete.g2o", text);
  const nlohmann::json json = runner->run("simulate incomplete.g2o --json").json();
  EXPECT_EQ(json["upright"], true);
  EXPECT_EQ(json["reached_goal"], false);
  EXPECT_EQ(json["carried_out"], false);
  EXPECT_TRUE(has_part(json["reason"], "incomplete")) << json["reason"];
}

TEST_F(SimulateTest, WritesTheRecordUpToAFall) {
  const Outcome fallen = runner->run("simulate drive.g2o --push 3000,1 -o f.g2o --json");
  EXPECT_EQ(fallen.exit_code, 1);
  ASSERT_TRUE(runner->exists("f.g2o")) << fallen.err;
  EXPECT_EQ(fallen.json()["upright"], false);
  const Outcome info = runner->run("info f.g2o --json");
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NEAR(info.json()["record"]["duration_s"], fallen.json()["time_s"], 0.05);
}

TEST(Simulate, CampaignsCarryPlansOutWhereThatIsAskedFor) {
  const CommandRunner runner;
  const Outcome outcome =
      runner.run("campaign centauro_drive --runs 2 --simulate --csv runs.csv --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["carried_out"]["mean"], 1.0);
  EXPECT_LE(outcome.json()["max_torque_ratio"]["max"], 1.0);
  EXPECT_EQ(runner.run("campaign centauro_drive --runs 2 --csv runs.csv").exit_code, 2)
      << "another campaign's table";
  EXPECT_EQ(runner.run("campaign standing_up --runs 1 --simulate --stances-only").exit_code, 2);
}

}  // namespace
}  // namespace locograph
