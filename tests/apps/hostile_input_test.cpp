// Files that are broken on purpose, or by a slip of the finger: a clear answer within a second of
// one processor and 200 MB, however absurd the numbers in them.
#include <apps/command_runner.h>
#include <apps/shipped_scenario.h>
#include <fcntl.h>
#include <locograph/common/uniform.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <functional>
#include <random>

#include "plugins/small_robot.h"

namespace locograph {
namespace {

constexpr long kMostKilobytes = 200 * 1024;
/// What ends a command that does not answer: of all processors together far more than the second
/// that it should take, so that the machine changes nothing.
constexpr rlim_t kMostCpu_s = 300, kMostAddresses = rlim_t{4} << 30;

struct MeasuredOutcome : Outcome {
  long kilobytes = 0;  ///< the most memory that it held
};

/// Runs the command with limits on time and memory.
MeasuredOutcome run_limited(const CommandRunner& runner, const std::string& arguments) {
  const std::string line = "cd '" + runner.folder().string() +
                           "' && exec '" LOCOGRAPH_COMMAND "' " + arguments +
                           " >.stdout 2>.stderr </dev/null";
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit cpu{kMostCpu_s, kMostCpu_s}, addresses{kMostAddresses, kMostAddresses};
    ::setrlimit(RLIMIT_CPU, &cpu);
    ::setrlimit(RLIMIT_AS, &addresses);
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  rusage used = {};
  ::wait4(child, &status, 0, &used);
  MeasuredOutcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = runner.read(".stdout");
  outcome.err = runner.read(".stderr");
  outcome.kilobytes = used.ru_maxrss;
  return outcome;
}

/// n times.
std::string repeated(int n, const std::function<std::string(int)>& text) {
  std::string all;
  for (int i = 0; i < n; ++i) all += text(i);
  return all;
}

std::string obstacles(const std::string& elements) {
  return "<obstacles version=\"1\">\n" + elements + "</obstacles>\n";
}

std::string contacts_at(const std::string& position) {
  return "<contacts version=\"1\">\n<contact link=\"l_sole\" kind=\"surface\" position=\"" +
         position +
         "\" normal=\"0 0 1\" half_x=\"0.09\" half_y=\"0.045\" mu=\"0.6\" max_force=\"1000\"/>\n"
         "</contacts>\n";
}

std::string map_header(const std::string& nodes, const std::string& resolution) {
  return "# Octomap OcTree binary file\nid OcTree\nsize " + nodes + "\nres " + resolution +
         "\ndata\n";
}

std::string drive(const std::string& attributes, const std::string& environment = "") {
  return "<scenario version=\"1\" name=\"drive\">\n<robot model=\"centauro\" "
         "active=\"lower_body\"/>\n<wheels>" +
         repeated(4,
                  [](int i) {
                    return "<wheel link=\"wheel_" + std::to_string(i + 1) + "\" radius=\"0.078\"/>";
                  }) +
         "</wheels>\n<environment " + environment + "/>\n<drive " + attributes +
         "/>\n</scenario>\n";
}

const char kCart[] = "PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\nPARAMS_PLAN 1 3\n";
const char kAtRest[] = "VERTEX_CONFIGURATION 0 0 0 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n";

struct HostileCase {
  const char* name;
  std::string file, content;
  std::string arguments;
  std::string place;  ///< that the message begins with
  std::string words;
};

const std::string kPosture = "posture coman_plus --contacts ";
const std::string kLongerThanPaths(5000, 'n');

std::vector<HostileCase> hostile_cases() {
  const std::string plan = kCart + std::string(kAtRest);
  return {
      {"RowsThatTheRobotDoesNotHave", "a.g2o", plan + "EDGE_JOINT_LIMITS 0 9999 0.1 scalar 1\n",
       "optimize a.g2o", "a.g2o:4", "EDGE_JOINT_LIMITS with n = 9999, expected n = 3"},
      {"RowsThatFillTheMemory", "a.g2o", plan + "EDGE_JOINT_LIMITS 0 65536 0.1 scalar 1\n",
       "optimize a.g2o --diagnose", "a.g2o:4",
       "an error of size 65536, expected at most 10000 rows of equal weight"},
      {"RowsWithoutARobot", "a.g2o", "EDGE_JOINT_LIMITS 0 9999 0.1 scalar 1\n",
       "optimize a.g2o --diagnose", "a.g2o:1", "nothing says how large vertex 0 is"},
      {"InformationThatIsNotThere", "a.g2o", "VERTEX_SE2 0 0 0 0\nEDGE_PRIOR_SE2 0 1 2 3 1\n",
       "optimize a.g2o", "a.g2o:2", "too few fields"},
      {"AMillionContactsInAStance", "a.g2o",
       std::string(kCart) +
           "PARAMS_CONTACT 3 0 wheel wheel wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 "
           "free\nPARAMS_STANCE 5 1000000" +
           repeated(1000000, [](int) { return " 3"; }) + "\n" + kAtRest,
       "check a.g2o", "a.g2o:4", "number of contacts 1000000, expected at least one, at most 100"},
      {"AThousandRobots", "a.g2o",
       repeated(1000,
                [](int i) {
                  return "PARAMS_ROBOT " + std::to_string(i) + " cart.urdf cart.srdf floating 0\n";
                }) +
           kAtRest,
       "check a.g2o", "a.g2o:17", "one robot more than 16"},
      {"AConfigurationBeyondAllDistances", "a.g2o",
       std::string(kCart) + "VERTEX_CONFIGURATION 0 0 0 - 1e16 0 0 0 0 0 1 0 0 0\n", "check a.g2o",
       "a.g2o:3", "a base at 1e+16 m, expected at most 1e+06 m"},
      {"ABundleOfAMilliardCameras", "b.txt", "1000000000 1000000000 1000000000\n0 0 1 1\n",
       "optimize b.txt", "b.txt:1", "number of cameras 1000000000"},
      {"ABundleShorterThanItSays", "b.txt", "90000000 90000000 90000000\n0 0 1 1\n",
       "optimize b.txt", "b.txt:1", "too short for 90000000 observations"},
      {"ADeviceAsMap", "c.xml", contacts_at("0 0 0"), kPosture + "c.xml --map /dev/zero",
       "/dev/zero", "is a device, expected an OctoMap file"},
      {"APipeAsMap", "c.xml", contacts_at("0 0 0"), kPosture + "c.xml --map pipe", "pipe",
       "is a pipe, expected an OctoMap file"},
      {"APipeAsObstacles", "s.xml",
       drive("distance=\"4\" speed=\"0.1\" configurations=\"50\"", "obstacles=\"pipe\""),
       "plan s.xml -o p.g2o", "./pipe", "is a pipe, expected an obstacles file"},
      {"AMapOfTinyVoxels", "m.bt", map_header("9", "1e-300"), kPosture + "c.xml --map m.bt",
       "m.bt:4", "unusable resolution, expected res followed by a number of metres from 0.0001"},
      {"AMapOfVoxelsWithoutASize", "m.bt", map_header("9", "nan"), kPosture + "c.xml --map m.bt",
       "m.bt:4", "unusable resolution"},
      {"AMapOfMilliardsOfNodes", "m.bt",
       map_header("18000000000000000000", "0.1") + std::string(2, '\0'),
       kPosture + "c.xml --map m.bt", "m.bt",
       "holds 1 nodes, expected the 18000000000000000000 of its header"},
      {"AContactBeyondAllDistances", "c.xml", contacts_at("0 1e16 0"), kPosture + "c.xml",
       "c.xml:2", "position=\"0 1e16 0\", expected numbers up to 1e+06"},
      {"ThousandsOfContacts", "c.xml",
       "<contacts version=\"1\">\n" +
           repeated(5000,
                    [](int i) {
                      const std::string x = std::to_string(i);
                      return "<contact link=\"l_sole\" kind=\"point\" "
                             "point=\"0 " +
                             x + " 0\" position=\"0 " + x +
                             " 0\" normal=\"0 0 1\" mu=\"0.6\" "
                             "max_force=\"9\"/>\n";
                    }) +
           "</contacts>",
       kPosture + "c.xml", "c.xml:102", "one contact more than 100"},
      {"MillimetresForMetres", "o.xml",
       obstacles("<sphere center=\"0 5 0\" radius=\"0.1\">\n<keyframe time=\"10\" position=\"1e5 "
                 "5 0\"/></sphere>\n"),
       "plan s.xml -o p.g2o", "./o.xml:2", "m/s, expected at most 100 m/s"},
      {"ElementsInElements", "o.xml",
       "<obstacles version=\"1\">" + repeated(100000, [](int) { return "<box>"; }),
       "plan s.xml -o p.g2o", "./o.xml:1", "not well-formed XML (XML_ELEMENT_DEPTH_EXCEEDED)"},
      {"AttributesWithoutEndOfAnObstacle", "o.xml",
       "<obstacles version=\"1\">\n<!-- a=1 --><box\n" +
           repeated(100000, [](int i) { return " a" + std::to_string(i) + "='1'"; }) +
           "/></obstacles>",
       "plan s.xml -o p.g2o", "./o.xml:2", "an element with more than 100 attributes"},
      {"AttributesWithoutEndOfAContact", "c.xml",
       "<contacts version=\"1\">\n<contact" +
           repeated(100000, [](int i) { return " a" + std::to_string(i) + "=\"1\""; }) +
           "/></contacts>",
       kPosture + "c.xml", "c.xml:2", "an element with more than 100 attributes"},
      {"ADriveAroundTheEarth", "s.xml",
       drive("distance=\"4e7\" speed=\"0.1\" configurations=\"50\""), "plan s.xml -o p.g2o",
       "s.xml:5", "distance is 4e+07, expected a number > 0 to 1000"},
      {"ANumberTooLargeInAResult", "r.json",
       "{\"initial_chi2\": 5,\n\"iterations_detail\": [\n{\"chi2\": 1e400}]}",
       "plot r.json -o p.svg", "r.json:3", "'1e400' is not finite"},
      {"ANumberTooLargeInATable", "r.csv", "success,time_s\n1,2.5\n1,1e400\n",
       "plot r.csv -o p.svg", "r.csv:3", "'1e400' is not finite"},
      {"ARobotNamedLongerThanPathsMayBe", "r.urdf", "",
       "posture " + kLongerThanPaths + " --contacts c.xml", kLongerThanPaths,
       "no such robot, expected a URDF file, or a name"},
      {"AModelNamedLongerThanPathsMayBe", "l.xml",
       "<scenario version=\"1\" name=\"l\">\n<robot model=\"" + kLongerThanPaths +
           "\"/>\n</scenario>\n",
       "info l.xml", "l.xml:2", "unknown robot model 'nnn"},
      {"AScenarioNamedLongerThanPathsMayBe", "r.urdf", "", "plan " + kLongerThanPaths + " -o p.g2o",
       kLongerThanPaths, "no such scenario, expected a file, or one of centauro_drive"},
      {"AGraphNamedLongerThanPathsMayBe", "r.urdf", "", "optimize " + kLongerThanPaths,
       kLongerThanPaths, "cannot be opened: file name too long"},
      {"AResultThatEndsInTheMiddle", "r.json", "{\"chi2\":\n [1, 2", "plot r.json -o p.svg",
       "r.json:2", "is not JSON"},
  };
}

class HostileInput : public testing::TestWithParam<HostileCase> {};

TEST_P(HostileInput, IsRefusedAtOnceWithItsPlace) {
  const CommandRunner runner;
  runner.write("cart.urdf", test::kCartUrdf);
  runner.write("cart.srdf", test::kCartSrdf);
  runner.write("c.xml", contacts_at("0 0 0"));
  runner.write("s.xml",
               drive("distance=\"4\" speed=\"0.1\" configurations=\"50\"", "obstacles=\"o.xml\""));
  ASSERT_EQ(::mkfifo((runner.folder() / "pipe").c_str(), 0600), 0);
  runner.write(GetParam().file, GetParam().content);
  const MeasuredOutcome outcome = run_limited(runner, GetParam().arguments);
  std::string place = GetParam().place;
  // Scenarios look for their files beside themselves.
  if (outcome.err.find("locograph: " + place) == std::string::npos && place.starts_with("./")) {
    place = place.substr(2);
  }
  expect_refusal(outcome, place, GetParam().words);
  EXPECT_LT(outcome.kilobytes, kMostKilobytes);
}

INSTANTIATE_TEST_SUITE_P(All, HostileInput, testing::ValuesIn(hostile_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(LargeInput, APlanOfAMillionConfigurationsEndsInItsTime) {
  const CommandRunner runner;
  runner.write("s.xml", drive("distance=\"4\" speed=\"0.1\" configurations=\"1000000\""));
  const MeasuredOutcome outcome = run_limited(runner, "plan s.xml -o p.g2o --timeout 0.3 --json");
  ASSERT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.json()["status"], "deadline");
  EXPECT_EQ(outcome.json()["reason"], "the time allowed is used up (allow more)");
  EXPECT_FALSE(outcome.json()["success"]);
  EXPECT_FALSE(runner.exists("p.g2o"));
  EXPECT_LT(outcome.kilobytes, kMostKilobytes);
}

/// standing_up, with this in its environment as well.
std::string standing_up_among(const std::string& element) {
  return test::with(test::shipped("standing_up"), "</environment>", element + "\n</environment>");
}

TEST(LargeInput, AMapOfOneLeafIsOneBox) {
  const CommandRunner runner;
  runner.write("leaf.bt", map_header("2", "0.05") + std::string("\2\0", 2));
  runner.write("s.xml", standing_up_among("<octomap name=\"hall\" file=\"leaf.bt\"/>"));
  const MeasuredOutcome touched =
      run_limited(runner, "plan s.xml --stances-only -o p.g2o --max-transitions 100 --quiet");
  EXPECT_LE(touched.exit_code, 1);
  EXPECT_EQ(touched.err, "");
  EXPECT_LT(touched.kilobytes, kMostKilobytes);
  runner.write("t.xml", test::with(test::shipped("standing_up"), "<environment ",
                                   "<environment map=\"leaf.bt\" "));
  const MeasuredOutcome avoided =
      run_limited(runner, "plan t.xml --stances-only -o p.g2o --max-transitions 100 --quiet");
  EXPECT_LE(avoided.exit_code, 1);
  EXPECT_EQ(avoided.err, "");
  EXPECT_LT(avoided.kilobytes, kMostKilobytes);
}

TEST(LargeInput, ACloudOfPointsAtRandomEndsInItsTime) {
  const CommandRunner runner;
  const int count = 200000;
  std::mt19937_64 random(1);
  const auto coordinate = [&] { return std::to_string(uniform(random, -10.0, 10.0)); };
  runner.write("scan.pcd",
               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                   std::to_string(count) + "\nHEIGHT 1\nDATA ascii\n" + repeated(count, [&](int) {
                     return coordinate() + ' ' + coordinate() + ' ' + coordinate() + '\n';
                   }));
  runner.write("s.xml", standing_up_among("<cloud name=\"scan\" file=\"scan.pcd\"/>"));
  const MeasuredOutcome outcome =
      run_limited(runner, "plan s.xml --stances-only -o p.g2o --timeout 0.2 --json");
  ASSERT_EQ(outcome.exit_code, 1) << outcome.err;
  const std::string reason = outcome.json()["reason"];
  EXPECT_NE(reason.find("the time allowed is used up"), std::string::npos) << reason;
  EXPECT_EQ(outcome.json()["stances"], 0);
  EXPECT_FALSE(runner.exists("p.g2o")) << "there is no part of a plan";
}

TEST(LargeInput, ATimeoutBeyondAllClocksIsNone) {
  const CommandRunner runner;
  for (const char* seconds : {"1e10", "1e19", "1e300"}) {
    const MeasuredOutcome outcome = run_limited(
        runner,
        std::string("plan standing_up --stances-only -o p.g2o --json --timeout ") + seconds);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  }
}

TEST(LargeInput, AnEdgeOnAHundredThousandVerticesIsReadInTimeThatGrowsWithTheLine) {
  const CommandRunner runner;
  const int count = 100000;
  runner.write(
      "a.g2o",
      "VERTEX_SE2 0 0 0 0\n" +
          repeated(count, [](int i) { return "VERTEX_XY " + std::to_string(i + 1) + " 0 0\n"; }) +
          "EDGE_SE2_LOTSOFXY 0" +
          repeated(count, [](int i) { return " " + std::to_string(i + 1); }) + " || 7\n");
  const MeasuredOutcome outcome = run_limited(runner, "optimize a.g2o");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_LT(outcome.kilobytes, kMostKilobytes);
}

}  // namespace
}  // namespace locograph
