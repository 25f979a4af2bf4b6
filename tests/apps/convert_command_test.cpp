// `convert` as a user runs it: plans as tables and as JSON, and back.
#include <apps/command_runner.h>

#include <algorithm>
#include <cmath>

#include "apps/standing_plan.h"

namespace locograph {
namespace {

/// The lines of a text that begin with this word.
std::string lines_of(const std::string& text, const std::string& word) {
  std::istringstream in(text);
  std::string found;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(word)) found += line + '\n';
  }
  return found;
}

std::string replaced(std::string text, const std::string& find, const std::string& instead) {
  const std::size_t at = text.find(find);
  EXPECT_NE(at, std::string::npos) << find;
  return at == std::string::npos ? text : text.replace(at, find.size(), instead);
}

/// What `check --json` says of a plan, without what differs from run to run.
nlohmann::json verdict(const CommandRunner& runner, const std::string& plan) {
  nlohmann::json json = runner.run("check " + plan + " --json").json();
  json.erase("time");
  return json;
}

/// A folder with plan.g2o and what it is as a table and as JSON.
class Converted : public CommandRunner {
 public:
  explicit Converted(const PlanText& plan) {
    write("plan.g2o", plan.text());
    convert();
  }
  explicit Converted(const std::string& command) {
    const Outcome outcome = run(command + " -o plan.g2o");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    convert();
  }
  /// What a changed table is refused for.
  void expect_bad_table(const std::string& text, const std::string& line,
                        const std::string& words) const {
    write("bad.csv", text);
    expect_refusal(run("convert bad.csv -o bad.g2o"), "bad.csv" + line, words);
    EXPECT_FALSE(exists("bad.g2o"));
  }
  void expect_bad_json(const std::string& text, const std::string& words) const {
    write("bad.json", text);
    const Outcome outcome = run("convert bad.json -o bad.g2o");
    expect_refusal(outcome, "", "bad.json");
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_FALSE(exists("bad.g2o"));
  }
  nlohmann::json json() const { return nlohmann::json::parse(read("plan.json")); }

 private:
  void convert() const {
    for (const char* output : {"plan.csv", "plan.json"}) {
      const Outcome outcome = run(std::string("convert plan.g2o -o ") + output);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    }
  }
};

TEST(ConvertCommand, ADriveComesBackToTheLastByte) {
  const Converted runner("plan centauro_drive");
  for (const char* input : {"plan.csv", "plan.json"}) {
    ASSERT_EQ(runner.run(std::string("convert ") + input + " -o back.g2o").exit_code, 0);
    EXPECT_EQ(runner.read("back.g2o"), runner.read("plan.g2o")) << input;
  }
  ASSERT_EQ(runner.run("convert plan.csv -o across.json").exit_code, 0);
  EXPECT_EQ(runner.read("across.json"), runner.read("plan.json"));
}

TEST(ConvertCommand, AMotionWithSegmentsComesBackAndIsJudgedAlike) {
  PlanText plan = standing_segments();
  // Numbers that need all their digits, also in time.
  for (PlanText::Configuration& c : plan.configurations) c.time_s += 1.0 / 3.0;
  for (std::string& line : plan.parameters) {
    if (line.starts_with("PARAMS_SEGMENT 20")) {
      line = "PARAMS_SEGMENT 20 0 6 0.33333333333333331 1 \"\"";
    } else if (line.starts_with("PARAMS_SEGMENT 21")) {
      line = "PARAMS_SEGMENT 21 1 8 1.3333333333333333 1 \"by hand\"";
    }
  }
  const Converted runner(plan);
  const nlohmann::json before = verdict(runner, "plan.g2o");
  EXPECT_EQ(before["feasible"], true);
  for (const char* input : {"plan.csv", "plan.json"}) {
    ASSERT_EQ(runner.run(std::string("convert ") + input + " -o back.g2o").exit_code, 0);
    const PlanText back(runner.read("back.g2o"));
    ASSERT_EQ(back.configurations.size(), plan.configurations.size());
    for (std::size_t i = 0; i < plan.configurations.size(); ++i) {
      EXPECT_EQ(back.configurations[i].time_s, plan.configurations[i].time_s);
      EXPECT_EQ(back.configurations[i].stance, plan.configurations[i].stance);
      EXPECT_EQ(back.configurations[i].q, plan.configurations[i].q);
    }
    EXPECT_NE(lines_of(runner.read("back.g2o"), "PARAMS_SEGMENT 21").find("\"by hand\""),
              std::string::npos);
    nlohmann::json after = verdict(runner, "back.g2o");
    // Only the ids of vertices differ: they are counted from 0.
    for (nlohmann::json& violation : after["violations"]) {
      nlohmann::json& id = violation["at_vertex"];
      if (id.is_number()) id = id.get<int>() + 7;
    }
    EXPECT_EQ(after, before) << input;
    // With the edges of a plan: what was a bare motion can be optimised and refined.
    const std::string text = runner.read("back.g2o");
    for (const char* tag : {"EDGE_CONTACT ", "EDGE_JOINT_LIMITS", "EDGE_VELOCITY_LIMITS"}) {
      EXPECT_NE(lines_of(text, tag), "") << tag;
    }
    EXPECT_EQ(lines_of(text, "FIX"), "FIX 0\n");
  }
}

TEST(ConvertCommand, TakesWhatMayBeTouchedFromTheScenarioOfAPlanThatDoesNotSayIt) {
  PlanText plan = standing_segments();
  plan.parameters.push_back("PARAMS_SCENARIO 3 standing_up");
  const Converted runner(plan);
  ASSERT_EQ(runner.run("convert plan.json -o back.g2o").exit_code, 0);
  const std::string back = runner.read("back.g2o");
  EXPECT_NE(lines_of(back, "PARAMS_PLACES 22 0 ").find(" surface "), std::string::npos);
  EXPECT_NE(lines_of(back, "EDGE_SURFACE_DISTANCE"), "");
  ASSERT_EQ(runner.run("convert back.g2o -o back.json").exit_code, 0);
  ASSERT_EQ(runner.run("convert back.json -o again.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("again.g2o"), back);
}

TEST(ConvertCommand, TheWrenchesOfAPostureComeBackFromJson) {
  const Converted runner("posture coman_plus --contacts '" LOCOGRAPH_SOURCE_DIR
                         "/examples/posture/coman_plus_wall.xml'");
  ASSERT_EQ(runner.run("convert plan.json -o back.g2o").exit_code, 0);
  const auto components = [&](const std::string& file) {
    const std::string line = lines_of(runner.read(file), "VERTEX_WRENCHES");
    return line.substr(line.find(' ', sizeof "VERTEX_WRENCHES"));
  };
  EXPECT_EQ(components("back.g2o"), components("plan.g2o"));
  const nlohmann::json wrenches = runner.json()["wrenches"];
  ASSERT_EQ(wrenches.size(), 1U);
  for (const auto& [name, wrench] : wrenches[0].items()) EXPECT_EQ(wrench.size(), 6U) << name;
  EXPECT_EQ(verdict(runner, "back.g2o")["feasible"], true);
}

TEST(ConvertCommand, JsonIsLaidOutLikeAJointTrajectory) {
  PlanText plan = standing_segments();
  // A joint at constant acceleration, 0.4 rad/s²: 0, 0.05, 0.2, 0.45, 0.8 rad further.
  const double from = plan.configurations[0].q[7];
  for (std::size_t i = 0; i < 5; ++i) {
    const double time_s = 0.5 * static_cast<double>(i);
    plan.configurations[i].q[7] = from + 0.2 * time_s * time_s;
  }
  const Converted runner(plan);
  const nlohmann::json json = runner.json();
  EXPECT_EQ(json["header"]["frame_id"], "world");
  const std::size_t joints = plan.configurations[0].q.size() - 7;
  EXPECT_EQ(json["joint_names"].size(), joints);
  ASSERT_EQ(json["points"].size(), 5U);
  for (const nlohmann::json& point : json["points"]) {
    EXPECT_EQ(point["positions"].size(), joints);
    EXPECT_EQ(point["velocities"].size(), joints);
    EXPECT_EQ(point["accelerations"].size(), joints);
  }
  EXPECT_EQ(json["points"][3]["time_from_start"]["sec"], 1);
  EXPECT_EQ(json["points"][3]["time_from_start"]["nanosec"], 500000000);
  EXPECT_NEAR(json["points"][1]["velocities"][0].get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(json["points"][0]["accelerations"][0].get<double>(), 0.4, 1e-9);
  // It stands still where its stance changes, and brakes for that.
  EXPECT_EQ(json["points"][2]["velocities"][0], 0.0);
  EXPECT_NEAR(json["points"][1]["accelerations"][0].get<double>(), 2.0, 1e-9);
  EXPECT_EQ(json["points"][0]["velocities"][0], 0.0);
  EXPECT_EQ(json["points"][4]["velocities"][0], 0.0);
  ASSERT_EQ(json["base"].size(), 5U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(json["base"][1]["position"][k], plan.configurations[1].q[k]);
  }
  ASSERT_EQ(json["contacts"].size(), 2U);
  EXPECT_EQ(json["contacts"][0]["to_s"], 1.0);
  EXPECT_EQ(json["contacts"][1]["stance"], 8);
  EXPECT_EQ(json["contacts"][1]["contacts"][0]["link"], "r_sole");
  ASSERT_EQ(json["segments"].size(), 2U);
  EXPECT_EQ(json["segments"][1]["duration_s"], 1.0);
  EXPECT_EQ(json["segments"][1]["planner"], "by hand");
}

TEST(ConvertCommand, TablesMayHaveTheirJointsInAnotherOrder) {
  const Converted runner(standing_segments());
  std::istringstream in(runner.read("plan.csv"));
  std::string swapped;
  for (std::string line; std::getline(in, line);) {
    const std::size_t last = line.rfind(',');
    const std::size_t before = line.rfind(',', last - 1);
    swapped += line.starts_with('#') ? line
                                     : line.substr(0, before) + line.substr(last) +
                                           line.substr(before, last - before);
    swapped += '\n';
  }
  runner.write("swapped.csv", swapped);
  ASSERT_EQ(runner.run("convert swapped.csv -o swapped.g2o").exit_code, 0);
  ASSERT_EQ(runner.run("convert plan.csv -o back.g2o").exit_code, 0);
  EXPECT_EQ(runner.read("swapped.g2o"), runner.read("back.g2o"));
}

TEST(ConvertCommand, RefusesTablesThatAreWrongWithTheirLine) {
  const Converted runner(standing_segments());
  const std::string table = runner.read("plan.csv");
  const int head =
      1 +
      static_cast<int>(std::count(
          table.begin(), table.begin() + static_cast<std::ptrdiff_t>(table.find("time_s")), '\n'));
  const auto line = [&](int below) { return ":" + std::to_string(head + below); };
  const std::string row = "\n0.5,0,6,";
  runner.expect_bad_table(replaced(table, row, "\nnan,0,6,"), line(2), "'nan' is not finite");
  runner.expect_bad_table(replaced(table, row, "\n0.5,0,6,seven,"), line(2), "fields, expected");
  runner.expect_bad_table(replaced(table, row, "\nlate,0,6,"), line(2), "'late' is not a number");
  runner.expect_bad_table(replaced(table, row, "\n1.5,0,6,"), line(3),
                          "the time 1.000000 s after 1.500000 s, expected times that increase");
  runner.expect_bad_table(replaced(table, row, "\n0.5,1,6,"), line(2), "segment '1', expected '0'");
  runner.expect_bad_table(replaced(table, row, "\n0.5,0,60,"), line(2), "unknown parameter 60");
  runner.expect_bad_table(replaced(table, row, "\n0.5 6,0,,"), line(2),
                          "'0.5 6' in a column, expected one number");
  runner.expect_bad_table(replaced(table, "base_z", "height"), line(0), "column 6 is not 'base_z'");
  const std::size_t last = table.find('\n', table.find("time_s")), comma = table.rfind(',', last);
  const std::string joint = table.substr(comma + 1, last - comma - 1);
  runner.expect_bad_table(replaced(table, "," + joint + "\n", ",elbow\n"), line(0),
                          "the joint 'elbow', expected an active joint of the robot");
  runner.expect_bad_table(replaced(table, "," + joint + "\n", "\n"), line(0),
                          "the joint '" + joint + "' is missing");
  runner.expect_bad_table(table.substr(table.find("time_s")), "",
                          "names neither robot nor contacts");
  runner.expect_bad_table(table.substr(0, last + 1), line(0), "no configurations");
  runner.expect_bad_table(replaced(table, "PARAMS_PLAN 1 3", "PARAMS_PLAN 1 9"), ":3",
                          "a plan of format version 9");
}

TEST(ConvertCommand, RefusesJsonThatIsWrongOrContradictsItself) {
  const Converted runner(standing_segments());
  const std::string text = runner.read("plan.json");
  runner.expect_bad_json(text.substr(0, text.size() / 2), "is not JSON");
  runner.expect_bad_json("[]", "is no JSON object");
  const auto changed = [&](const auto& change) {
    nlohmann::json json = runner.json();
    change(json);
    return json.dump(1);
  };
  runner.expect_bad_json(changed([](auto& j) { j["points"][3]["positions"].erase(0); }),
                         "points[3].positions has ");
  runner.expect_bad_json(changed([](auto& j) { j["points"][3]["positions"][0] = nullptr; }),
                         "points[3].positions is null, expected a number");
  runner.expect_bad_json(changed([](auto& j) { j["points"][3]["positions"][0] = 1e7; }),
                         "a joint at ");
  runner.expect_bad_json(changed([](auto& j) { j["joint_names"][0] = "elbow"; }),
                         "joint_names has the joint 'elbow'");
  runner.expect_bad_json(changed([](auto& j) { j["joint_names"][0] = j["joint_names"][1]; }),
                         "a second time");
  runner.expect_bad_json(changed([](auto& j) { j["base"].erase(0); }), "base has 4 elements");
  runner.expect_bad_json(changed([](auto& j) {
                           j["base"][2]["orientation"] = {0, 0, 0, 0};
                         }),
                         "quaternion of length zero");
  runner.expect_bad_json(changed([](auto& j) { j.erase("parameters"); }), "parameters is missing");
  runner.expect_bad_json(changed([](auto& j) { j["time_s"][2] = 1.1; }),
                         "points[2].time_from_start is 1.000000 s");
  runner.expect_bad_json(changed([](auto& j) {
                           j.erase("time_s");
                           j["points"][2]["time_from_start"]["sec"] = 0;
                         }),
                         "expected times that increase");
  runner.expect_bad_json(changed([](auto& j) { j["contacts"][1]["first_point"] = 3; }),
                         "segment 1 is in stance 8");
  runner.expect_bad_json(
      changed([](auto& j) { j["contacts"][0]["contacts"][0]["position"][0] = 9; }),
      "contacts[0] is not what points and parameters say");
  runner.expect_bad_json(changed([](auto& j) { j["segments"][1]["duration_s"] = 0.5; }),
                         "segments[1] is not what points and parameters say");
  runner.expect_bad_json(changed([](auto& j) {
                           j["wrenches"] = std::vector<nlohmann::json>(j["points"].size());
                           j["wrenches"][1]["ghost"] = std::vector<double>(6, 0.0);
                         }),
                         "wrenches[1] has 'ghost', which is no contact of its stance");
  runner.expect_bad_json("{\"points\": " + std::string(100000, '['),
                         "lists and objects lie too deep in each other");
  // A number instead of the second point.
  const std::size_t second = text.find("\n{\"positions\"", text.find("\n{\"positions\"") + 1);
  runner.write("bad.json", text.substr(0, second) + "\n7" + text.substr(text.find(",\n", second)));
  const int line = 2 + static_cast<int>(std::count(
                           text.begin(), text.begin() + static_cast<std::ptrdiff_t>(second), '\n'));
  expect_refusal(runner.run("convert bad.json -o bad.g2o"), "bad.json:" + std::to_string(line),
                 "points[1] is no object");
}

TEST(ConvertCommand, JsonWithoutExactTimesIsAsGoodAsItsNanoseconds) {
  const Converted runner(standing_segments());
  nlohmann::json json = runner.json();
  json.erase("time_s");
  json.erase("segments");
  runner.write("ros.json", json.dump());
  ASSERT_EQ(runner.run("convert ros.json -o back.g2o").exit_code, 0);
  EXPECT_EQ(PlanText(runner.read("back.g2o")).configurations[3].time_s, 1.5);
}

TEST(ConvertCommand, SlopesOfATableAreAllOrNoneAndStandForNothingElse) {
  const Converted runner("plan centauro_drive");
  const std::string table = runner.read("plan.csv");
  std::vector<std::string> lines;
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const auto head = static_cast<std::size_t>(
      std::ranges::find_if(lines, [](const auto& l) { return l.starts_with("time_s"); }) -
      lines.begin());
  const auto split = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream words(line);
    for (std::string field; std::getline(words, field, ',');) fields.push_back(field);
    return fields;
  };
  const std::vector<std::string> names = split(lines[head]);
  const auto first = static_cast<std::size_t>(
      std::ranges::find_if(names, [](const auto& n) { return n.starts_with("d_"); }) -
      names.begin());
  ASSERT_LT(first, names.size());
  // In the seventh row only so many slopes are left, and the position before them may be none.
  const auto with = [&](std::size_t left, bool position) {
    std::vector<std::string> fields = split(lines[head + 7]);
    for (std::size_t i = first + left; i < fields.size(); ++i) fields[i] = "-";
    if (!position) fields[first - 1] = "-";
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::string line = i == head + 7 ? "" : lines[i];
      for (const std::string& field : fields) {
        if (i == head + 7) line += (line.empty() ? "" : ",") + field;
      }
      text += line + '\n';
    }
    return text;
  };
  runner.write("rule.csv", with(0, true));
  EXPECT_EQ(runner.run("convert rule.csv -o rule.g2o").exit_code, 0);
  const std::string line = ":" + std::to_string(head + 8);
  runner.expect_bad_table(with(1, true), line, "'-' is not a number");
  // The slope must not be taken for the position that is missing.
  runner.expect_bad_table(with(1, false), line, "'-' is not a number");
  runner.expect_bad_table(with(0, false), line, "'-' is not a number");
}

TEST(ConvertCommand, WhatItDoesNotConvert) {
  const Converted runner(standing_segments());
  expect_refusal(runner.run("convert plan.g2o -o plan.txt"), "plan.txt", ".g2o, .csv or .json");
  expect_refusal(runner.run("convert plan.g2o -o again.g2o"), "again.g2o", "another one");
  runner.write("words.csv", "");
  expect_refusal(runner.run("convert words.csv -o x.g2o"), "words.csv", "names neither robot");
  ASSERT_EQ(runner.run("plan standing_up --stances-only -o stances.g2o").exit_code, 0);
  expect_refusal(runner.run("convert stances.g2o -o x.csv"), "stances.g2o",
                 "is a plan of stances, which has no motion");
  PlanText at_once = standing_segments();
  std::erase_if(at_once.parameters,
                [](const std::string& line) { return line.starts_with("PARAMS_SEGMENT"); });
  at_once.configurations[3].time_s = at_once.configurations[2].time_s;
  runner.write("at_once.g2o", at_once.text());
  const std::string later = "at_once.g2o:" + std::to_string(at_once.parameters.size() + 4);
  expect_refusal(runner.run("convert at_once.g2o -o x.json"), later,
                 "expected times that increase");
  expect_refusal(runner.run("plot at_once.g2o -o x.svg"), later, "expected times that increase");
}

}  // namespace
}  // namespace locograph
