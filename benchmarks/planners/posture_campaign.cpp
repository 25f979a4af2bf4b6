// Random sets of contacts within reach: how often the posture solver finds a posture, and how fast.
//
//     posture_campaign [--robot NAME]… [--sets N] [--seed N] [--torque-limits report]
//                      [--restarts N] [--patience N]
//
// Prints one JSON object. Sets are drawn as benchmarks/planners/random_contact_sets.h says, until N
// of them are known to be feasible: the posture they were drawn from passes the whole check. The
// others, of which nobody knows, are solved as well and counted under `unknown`. Found is what the
// check accepts. Times are in seconds, of PostureSolver::solve(); those of
// whole solves are the processor's.
#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <vector>

#include "command_line.h"
#include "planners/random_contact_sets.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

double processor_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
}

Json times(const std::vector<double>& values) {
  return {{"p50", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"max", quantile(values, 1.0)}};
}

struct Tally {
  int sets = 0, solved = 0, restarts = 0, iterations = 0;
  std::vector<double> solved_s, failed_s, build_s, optimise_s, geometry_s, balance_s;
  Json failures = Json::object();

  void add(const PostureResult& result) {
    ++sets;
    solved += result.success();
    (result.success() ? solved_s : failed_s).push_back(result.statistics.total_s);
    restarts += result.statistics.restarts;
    iterations += result.statistics.iterations;
    if (result.success()) {
      build_s.push_back(result.statistics.build_s);
      optimise_s.push_back(result.statistics.optimise_s);
      geometry_s.push_back(result.statistics.geometry_s);
      balance_s.push_back(result.statistics.balance_s);
    } else {
      const std::string worst = result.report.worst().constraint;
      failures[worst] = failures.value(worst, 0) + 1;
    }
  }

  Json json() const {
    return {{"sets", sets},
            {"solved", solved},
            {"success_rate", sets == 0 ? 0.0 : static_cast<double>(solved) / sets},
            {"restarts", restarts},
            {"iterations", iterations},
            {"time_solved", times(solved_s)},
            {"time_failed", times(failed_s)},
            {"of_the_solved",
             {{"build", times(build_s)},
              {"optimise", times(optimise_s)},
              {"geometry", times(geometry_s)},
              {"balance", times(balance_s)}}},
            {"worst_of_the_failed", failures}};
  }
};

Json campaign(const std::string& name, int wanted, std::uint64_t seed, PostureOptions options) {
  const test::PostureRobot robot =
      test::posture_robot(name, LOCOGRAPH_SOURCE_DIR, LOCOGRAPH_SHARED_DATA);
  const PostureSolver solver(robot.robot);
  const Judge judge(robot.robot->robot, posture_world());
  test::ContactSets sets(robot, seed);
  Tally known, unknown;
  while (known.sets < wanted && known.sets + unknown.sets < 20 * wanted) {
    const test::ContactSet set = sets.draw();
    const bool feasible = judge.check(set.drawn, set.stance, options.check).feasible;
    options.seed = static_cast<std::uint64_t>(known.sets + unknown.sets);
    const PostureProblem problem{set.stance, placed_at(robot.model(), robot.home, set.stance)};
    const double before_s = processor_s();
    PostureResult result = solver.solve(problem, options);
    result.statistics.total_s = processor_s() - before_s;
    // The judgement once more, by a judge of our own and all of it.
    if (result.success() &&
        !judge.check(result.configuration, set.stance, options.check).feasible) {
      throw Error("a posture was accepted that the check refuses");
    }
    (feasible ? known : unknown).add(result);
  }
  return {{"robot", name},
          {"joints", robot.model().active_joint_count()},
          {"known_feasible", known.json()},
          {"unknown", unknown.json()}};
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Postures on random contacts", "posture_campaign");
  std::vector<std::string> robots = {"centauro", "coman_plus", "go2", "anymal"};
  int sets = 200;
  std::uint64_t seed = 1;
  std::string torques = "enforce";
  locograph::PostureOptions options;
  app.add_option("--robot", robots).one_of(robots);
  app.add_option("--sets", sets).positive();
  app.add_option("--seed", seed);
  app.add_option("--torque-limits", torques).one_of({"enforce", "report"});
  app.add_option("--restarts", options.max_restarts).not_negative();
  app.add_option("--patience", options.patience).positive();
  return locograph::run_benchmark(app, argc, argv, [&] {
    options.enforce_torque_limits = options.check.enforce_torque_limits = torques == "enforce";
    locograph::Json all = locograph::Json::array();
    for (const std::string& robot : robots) {
      all.push_back(locograph::campaign(robot, sets, seed, options));
    }
    std::cout << locograph::Json{{"seed", seed}, {"torque_limits", torques}, {"robots", all}}.dump(
                     2)
              << '\n';
  });
}
