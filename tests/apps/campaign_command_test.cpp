// `campaign`: many seeds of a scenario, each in a process of its own, and the table of them.
#include <apps/command_runner.h>
#include <apps/shipped_scenario.h>
#include <locograph/apps/campaign_table.h>
#include <locograph/common/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace locograph {
namespace {

constexpr int kFirstRow = 2;  ///< line

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// What `plan --json` prints, as far as a campaign reads it.
Json plan_json(bool success, double total_s, const std::string& reason = "planned") {
  return {{"success", success},
          {"reason", reason},
          {"planner", "tree"},
          {"stances", 5},
          {"vertices_in_tree", 120},
          {"iterations", 300},
          {"duration_s", nullptr},
          {"time", {{"stance_planner", 0.1}, {"transitions", 1.0 / 3.0}, {"total", total_s}}}};
}

TEST(CampaignTable, ComesBackFromItsFileAsItWas) {
  const test::TemporaryFolder folder;
  const CampaignSetting setting{"hall, \"east\".xml", "", "--timeout 1.5"};
  const std::string reason = "refused: \"a\", b\nand more";
  CampaignTable table(setting);
  table.add(campaign_run(plan_json(false, 0.1 + 0.2, reason), 11));
  table.add(campaign_run(plan_json(true, 1e-9), 3));
  CampaignTable read(setting);
  read.read(folder.write("runs.csv", table.csv()));
  EXPECT_EQ(read.csv(), table.csv());
  ASSERT_EQ(read.runs().size(), 2u);
  EXPECT_EQ(read.runs().begin()->first, 3u) << "ordered by seed";
  const CampaignRun& run = read.runs().at(11);
  EXPECT_FALSE(run.solved);
  EXPECT_EQ(run.reason, reason);
  EXPECT_EQ(run.planner, "tree");
  EXPECT_EQ(run.values, table.runs().at(11).values);
  EXPECT_EQ(run.values[0], 0.1 + 0.2);
  EXPECT_FALSE(run.values[7]) << "a duration that the run does not tell";
}

TEST(CampaignTable, QuotesAndLineBreaksAreReadAsOtherProgramsWriteThem) {
  const test::TemporaryFolder folder;
  CampaignTable table({"hall"});
  table.add(campaign_run(plan_json(false, 2.0, "a\nb"), 1));
  table.add(campaign_run(plan_json(true, 2.0), 2));
  std::string text = table.csv();
  for (std::size_t at = 0; (at = text.find("hall", at)) != std::string::npos; at += 6) {
    text.replace(at, 4, "\"hall\"");
  }
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    if (text[at - 1] != 'a') text.insert(at, "\r");
  }
  text.resize(text.size() - 2);  // no line break at the end
  CampaignTable read({"hall"});
  read.read(folder.write("runs.csv", text));
  EXPECT_EQ(read.csv(), table.csv());
}

TEST(CampaignTable, FiguresAreThoseOfTheSolvedRuns) {
  std::vector<CampaignRun> runs;
  for (const double total_s : {3.0, 1.0, 2.0, 6.0}) {
    runs.push_back(campaign_run(plan_json(true, total_s), 0));
  }
  runs.push_back(campaign_run(plan_json(false, 100.0), 0));
  const Json figures = campaign_statistics(runs, 0);
  EXPECT_EQ(figures["mean"], 3.0);
  EXPECT_DOUBLE_EQ(figures["std"].get<double>(), std::sqrt(14.0 / 3.0));
  EXPECT_EQ(figures["p50"], 2.0);
  EXPECT_EQ(figures["p95"], 6.0);
  EXPECT_EQ(figures["max"], 6.0);
  EXPECT_TRUE(campaign_statistics({runs.front()}, 0)["std"].is_null()) << "of one run";
  EXPECT_TRUE(campaign_statistics({runs.back()}, 0)["mean"].is_null()) << "of none";
}

TEST(CampaignTable, HoldsOneRunForASeedAndOnePlanner) {
  CampaignTable table({"hall"});
  table.add(campaign_run(plan_json(true, 1.0), 4));
  EXPECT_THROW(table.add(campaign_run(plan_json(true, 1.0), 4)), Error);
  Json other = plan_json(true, 1.0);
  other["planner"] = "graph";
  EXPECT_THROW(table.add(campaign_run(other, 5)), Error);
  EXPECT_THROW(campaign_run(Json::object(), 5), Error);
}

TEST(CampaignCommand, PrintsOneJsonObjectWithEveryField) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("campaign centauro_drive --runs 3 --seed 7 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["scenario"], "centauro_drive");
  EXPECT_TRUE(json["planner"].is_string());
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["runs"], 3);
  EXPECT_EQ(json["solved"], 3);
  EXPECT_EQ(json["success_rate"], 1.0);
  for (const char* quantity :
       {"planning_time", "transition_time", "iterations", "vertices_in_tree", "stances",
        "whole_body_time", "timing_time", "total_time", "duration_s"}) {
    for (const char* figure : {"mean", "std", "p50", "p95", "max"}) {
      EXPECT_TRUE(json[quantity][figure].is_number()) << quantity << ' ' << figure;
    }
  }
  EXPECT_GT(json["planning_time"]["p50"], 0.0);
  // 4 m at 0.1 m/s in 49 steps, the first and the last of which take twice as long.
  EXPECT_NEAR(json["duration_s"]["mean"].get<double>(), 40.0 * 51 / 49, 1e-9);
  EXPECT_EQ(runner.files(), 0) << "a campaign leaves its table, and nothing without one";
}

TEST(CampaignCommand, PrintsATableOfFigures) {
  const CommandRunner runner;
  const Outcome outcome = runner.run("campaign centauro_drive --runs 2 --processes 2 --csv t.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_GE(lines.size(), 4u) << outcome.out;
  EXPECT_EQ(lines[0], "centauro_drive: solved 2 of 2 runs (100 %)");
  EXPECT_NE(lines[1].find("mean"), std::string::npos);
  EXPECT_EQ(lines[2].find("planning_time [s]"), 0u);
  EXPECT_EQ(lines[2].size(), lines[1].size());
  EXPECT_EQ(lines.back(), "written: t.csv");
}

TEST(CampaignCommand, SeedsInTheTableAreNotRunAgain) {
  const CommandRunner runner;
  const std::string campaign = "campaign centauro_drive --seed 5 --csv runs.csv --json --runs ";
  ASSERT_EQ(runner.run(campaign + "2").exit_code, 0);
  const std::vector<std::string> two = lines_of(runner.read("runs.csv"));
  ASSERT_EQ(two.size(), 3u);
  EXPECT_EQ(two[0].find("scenario,planner,options,seed,solved,reason,planning_time,"), 0u);
  EXPECT_NE(two[1].find(",5,true,"), std::string::npos) << two[1];
  EXPECT_NE(two[2].find(",6,true,"), std::string::npos) << two[2];

  ASSERT_EQ(runner.run(campaign + "3").exit_code, 0);
  const std::string text = runner.read("runs.csv");
  const std::vector<std::string> three = lines_of(text);
  ASSERT_EQ(three.size(), 4u);
  EXPECT_TRUE(std::ranges::equal(two, std::vector(three.begin(), three.begin() + 3)))
      << "their times would be others";

  const Outcome again = runner.run(campaign + "3");
  EXPECT_EQ(runner.read("runs.csv"), text);
  EXPECT_EQ(again.json()["runs"], 3);
  EXPECT_EQ(runner.run(campaign + "1").json()["runs"], 1) << "only the seeds that were asked for";
  EXPECT_EQ(runner.read("runs.csv"), text) << "the others stay in the table";
}

TEST(CampaignCommand, ATableOfAnotherCampaignIsRefusedWithItsLine) {
  const CommandRunner runner;
  const std::string campaign = "campaign centauro_drive --runs 1 --csv runs.csv";
  ASSERT_EQ(runner.run(campaign).exit_code, 0);
  const std::string good = runner.read("runs.csv");
  const std::string place = "runs.csv:" + std::to_string(kFirstRow);
  expect_refusal(runner.run(campaign + " --timeout 60"), place, "--timeout 60");
  expect_refusal(runner.run(campaign + " --planner other"), place, "'other'");
  std::string other = good;
  other.replace(other.find("centauro_drive"), 14, "slanted_wall");
  runner.write("runs.csv", other);
  expect_refusal(runner.run(campaign), place, "a run with the scenario 'slanted_wall'");
  EXPECT_EQ(runner.read("runs.csv"), other);
}

TEST(CampaignCommand, ATableWithContactsMovedFurtherIsRefusedWithItsLine) {
  const CommandRunner runner;
  const std::string campaign =
      "campaign standing_up --stances-only --runs 1 --timeout 1e-9 --csv runs.csv";
  ASSERT_EQ(runner.run(campaign + " --move-contacts 0.02").exit_code, 0);
  const std::string table = runner.read("runs.csv");
  EXPECT_NE(table.find("--move-contacts 0.02,0,false,"), std::string::npos) << table;
  const std::string place = "runs.csv:" + std::to_string(kFirstRow);
  expect_refusal(runner.run(campaign + " --move-contacts 0.03"), place, "--move-contacts 0.03");
  expect_refusal(runner.run(campaign), place, "--move-contacts 0.02");
  EXPECT_EQ(runner.run(campaign + " --move-contacts 0.02").exit_code, 0);
  EXPECT_EQ(runner.read("runs.csv"), table) << "it is run again";
}

TEST(CampaignCommand, ABrokenTableIsRefusedWithItsLine) {
  const CommandRunner runner;
  const std::string campaign = "campaign centauro_drive --runs 1 --csv runs.csv";
  ASSERT_EQ(runner.run(campaign).exit_code, 0);
  const std::string good = runner.read("runs.csv");
  const std::string row = lines_of(good).back();
  const auto broken = [&](const std::string& text, int line, const std::string& words) {
    runner.write("runs.csv", text);
    expect_refusal(runner.run(campaign), "runs.csv:" + std::to_string(line), words);
    EXPECT_EQ(runner.read("runs.csv"), text) << "it is left as it was";
  };
  const auto with = [&row, &good](const std::string& part, const std::string& replacement) {
    std::string text = row;
    text.replace(text.find(part), part.size(), replacement);
    return good + text + '\n';
  };
  broken("seed,time\n1,2\n", 1, "other columns than a campaign's");
  const std::string older = test::part(good, "", ",judge_time") + '\n';
  broken(older, 1, "the table of an older version, without segments");
  broken(good + "centauro_drive,,,9\n", 3, "4 fields");
  broken(good + row + '\n', 3, "a second run with seed 0");
  broken(with(",0,true,", ",zero,true,"), 3, "the seed 'zero'");
  broken(with(",0,true,", ",1,perhaps,"), 3, "'perhaps' under solved");
  broken(good + row + "fast\n", 3, "fast' under real_time_factor");
  broken(good + row + ",\n", 3, "40 fields, expected 39 as in the header");
  broken(with(",0,true,", ",1,true,\""), 3, "a field whose quote is not closed");
  broken(with("centauro_drive,", "\"centauro_drive\"x,"), 3, "'x' behind a closing quote");
}

TEST(CampaignCommand, AnEmptyFileIsATableWithoutRuns) {
  const CommandRunner runner;
  runner.write("runs.csv", "");
  EXPECT_EQ(runner.run("campaign centauro_drive --runs 1 --csv runs.csv").exit_code, 0);
  EXPECT_EQ(lines_of(runner.read("runs.csv")).size(), 2u);
}

TEST(CampaignCommand, RunsWithoutAPlanAreCountedAndNotMeasured) {
  const CommandRunner runner;
  const std::string campaign = "campaign centauro_drive --runs 2 --timeout 1e-9 --csv runs.csv";
  const Outcome outcome = runner.run(campaign + " --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err << "the campaign is done, whatever was solved";
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["runs"], 2);
  EXPECT_EQ(json["solved"], 0);
  EXPECT_EQ(json["success_rate"], 0.0);
  EXPECT_TRUE(json["planning_time"]["mean"].is_null());
  ASSERT_EQ(json["unsolved"].size(), 1u);
  EXPECT_EQ(json["unsolved"][0]["count"], 2);
  const std::string reason = json["unsolved"][0]["reason"];
  EXPECT_NE(runner.read("runs.csv").find(",1,false," + reason), std::string::npos);
  const std::string words = runner.run(campaign).out;
  EXPECT_EQ(words.find("centauro_drive: solved 0 of 2 runs (0 %)\n"), 0u) << words;
  EXPECT_NE(words.find("not solved: 2 runs: " + reason), std::string::npos) << words;
}

TEST(CampaignCommand, WhatARunRefusesEndsTheCampaignWithTheSameWords) {
  const CommandRunner runner;
  runner.write("hall.bt", "no map");
  runner.write("hall.xml",
               "<scenario version=\"1\" name=\"hall\">\n"
               "  <robot model=\"centauro\" active=\"lower_body\" state=\"home\"/>\n"
               "  <wheels>\n"
               "    <wheel link=\"wheel_1\" radius=\"0.078\"/>\n"
               "    <wheel link=\"wheel_2\" radius=\"0.078\"/>\n"
               "    <wheel link=\"wheel_3\" radius=\"0.078\"/>\n"
               "    <wheel link=\"wheel_4\" radius=\"0.078\"/>\n"
               "  </wheels>\n"
               "  <environment map=\"hall.bt\"/>\n"
               "  <drive distance=\"4\" curvature=\"0\" speed=\"0.1\" configurations=\"50\"/>\n"
               "</scenario>\n");
  const Outcome outcome = runner.run("campaign hall.xml --runs 3 --csv runs.csv");
  expect_refusal(outcome, "", "hall.bt");
  EXPECT_EQ(outcome.err, runner.run("plan hall.xml -o plan.g2o").err);
  EXPECT_FALSE(runner.exists("runs.csv"));
}

TEST(CampaignCommand, RefusesWhatItCannotRun) {
  const CommandRunner runner;
  expect_refusal(runner.run("campaign centauro_drive --runs 0"), "", "--runs");
  expect_refusal(runner.run("campaign centauro_drive"), "", "--runs");
  expect_refusal(runner.run("campaign centauro_drive --runs 1 --processes 0"), "", "--processes");
  expect_refusal(runner.run("campaign centauro_drive --runs 1 --timeout -1"), "", "--timeout");
  expect_refusal(runner.run("campaign centauro_drvie --runs 1"), "centauro_drvie",
                 "did you mean 'centauro_drive'?");
  expect_refusal(runner.run("campaign centauro_drive --runs 2 --seed 4294967295"), "",
                 "2 runs from seed 4294967295 on");
  expect_refusal(runner.run("campaign - --runs 1"), "", "standard input");
  expect_refusal(runner.run("campaign centauro_drive --runs 1 --csv -"), "-", "standard output");
  expect_refusal(runner.run("campaign centauro_drive --runs 1 --csv no/runs.csv"), "no/runs.csv",
                 "no folder");
}

TEST(CampaignCommand, EndsOnASignalWithTheRunsThatHaveEnded) {
  const CommandRunner runner;
  runner.write("tmp/keep", "");
  // SIGTERM, as what a shell runs in the background ignores SIGINT.
  const std::string line =
      "cd '" + runner.folder().string() +
      "' && export TMPDIR=$PWD/tmp && { '" LOCOGRAPH_COMMAND
      "' campaign centauro_drive --runs 100000 --processes 2 --csv runs.csv --json >out 2>err & "
      "job=$!; until [ -s runs.csv ] || ! kill -0 $job; do sleep 0.02; done; kill $job; "
      "wait $job; }";
  const int status = std::system(line.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1) << runner.read("err");
  const nlohmann::json json = nlohmann::json::parse(runner.read("out"));
  EXPECT_EQ(json["interrupted"], true);
  EXPECT_GE(json["runs"], 1);
  EXPECT_EQ(lines_of(runner.read("runs.csv")).size(), json["runs"].get<std::size_t>() + 1);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(runner.folder() / "tmp"),
                          std::filesystem::directory_iterator()),
            1)
      << "a temporary file is left";
}

}  // namespace
}  // namespace locograph
