// Boxes at random in a walled corridor: how often the local planner gets the CENTAURO drive past
// them, judged by the judge.
//
//     box_campaign [SEED] [CASES] [--rate 50] [--iterations 1] [--every 25] [--replan]
//
// Prints one JSON object: a row for each case, then the totals. The window of every n-th cycle is
// judged. With --replan the robot plans on from where it has stopped, and where it has ended beside
// its goal. Cycles as `refine` has them, but for what is asked for: --rate 0 is one cycle for each
// step, --iterations 0 all that a cycle finds. A case counts as passed when every configuration was
// refined, the judge finds the result feasible, and the base ends within 0.3 m of the plan's end
// along x.
#include <locograph/check/judge.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/online/resumed_drive.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/plan.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"
#include "judged_windows.h"
#include "planners/box_scenes.h"

namespace locograph {
namespace {

class Campaign : public BoxDrives {
 public:
  Campaign(double rate_hz, int iterations, int every, bool replan)
      : rate_hz_(rate_hz), iterations_(iterations), every_(every), replan_(replan) {}

  nlohmann::ordered_json run(const BoxScene& scene) {
    const World world = world_of(scene, true);
    const Judge judge(task().robot->robot, world);
    const CheckReport before = judge.check(motion(), check_);

    Graph graph = *drive_graph(task(), motion());
    const auto seen = std::make_shared<const WorldSnapshot>(world);
    WalkOptions options = walk_options_for(plan_of(graph));
    options.rate_hz = rate_hz_;
    options.cycle_iterations = iterations_;
    double resume_s = 0.0;
    if (replan_) {
      options.resume = [&](const Graph& stopped) {
        constexpr double kMost_s = 20.0;
        ResumedPlan resumed =
            resume_drive(stopped, motion(), task(), seen, {.deadline = Deadline::after(kMost_s)});
        resume_s += resumed.total_s;
        return std::move(resumed.graph);
      };
    }
    JudgedWindows windows(graph, judge, check_, every_);
    options.on_cycle = [&](const CycleReport& cycle) { windows.look(cycle); };
    const WalkReport report = walk_plan(
        graph, [&seen](int executed) { return executed == 0 ? seen : nullptr; }, options);
    const Motion refined = motion_of(graph, plan_of(graph));
    const CheckReport after = judge.check(refined, check_);

    std::vector<double> times;
    for (const CycleReport& cycle : report.cycles) times.push_back(cycle.statistics.total_s);
    all_times_.insert(all_times_.end(), times.begin(), times.end());
    nlohmann::ordered_json violated = nlohmann::ordered_json::array();
    for (const Violation& v : after.violations) {
      if (v.violated) violated.push_back({{"constraint", v.constraint}, {"worst", v.worst}});
    }
    const double final_x = refined.configurations.back()[0];
    const bool passed = report.success() && after.feasible &&
                        std::abs(final_x - motion().configurations.back()[0]) <= 0.3;
    return {{"x", scene.x},
            {"y", scene.y},
            {"side", scene.side},
            {"height", scene.height},
            {"wall", scene.wall},
            {"gap", scene.gap},
            {"original_feasible", before.feasible},
            {"refine_success", report.success()},
            {"reason", report.reason},
            {"configurations", report.configurations},
            {"resumed", report.resumed},
            {"resume_s", resume_s},
            {"goal_distance_m", report.goal_distance_m},
            {"time_ratio", refined.time_s.back() / motion().time_s.back()},
            {"feasible_cycles", report.feasible_cycles},
            {"windows_called_feasible", windows.counts().called_feasible},
            {"windows_wrongly_feasible", windows.counts().wrongly_feasible},
            {"refused", windows.counts().refused},
            {"feasible", after.feasible},
            {"violated", violated},
            {"passed", passed},
            {"final_x", final_x},
            {"min_clearance_m", after.min_clearance_m.value_or(0.0)},
            {"lateral_slip_m", after.constraint("lateral_slip").worst},
            {"longitudinal_slip_m", after.constraint("longitudinal_slip").worst},
            {"cycle_ms", in_milliseconds(times)}};
  }

  nlohmann::ordered_json all_cycles() const { return in_milliseconds(all_times_); }

 private:
  static nlohmann::ordered_json in_milliseconds(std::vector<double> times_s) {
    std::sort(times_s.begin(), times_s.end());
    const auto percentile = [&times_s](double p) {
      return 1e3 * times_s[static_cast<std::size_t>(std::ceil(p * times_s.size())) - 1];
    };
    return {{"cycles", times_s.size()},
            {"p50", percentile(0.5)},
            {"p95", percentile(0.95)},
            {"p99", percentile(0.99)},
            {"max", percentile(1.0)}};
  }

  double rate_hz_;
  int iterations_, every_;
  bool replan_;
  std::vector<double> all_times_;
  CheckOptions check_ = {.known = task().end_effectors()};
};

void run(unsigned long long seed, int cases, double rate_hz, int iterations, int every,
         bool replan) {
  std::mt19937_64 random(seed);
  Campaign campaign(rate_hz, iterations, every, replan);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  int redrawn = 0;
  while (static_cast<int>(rows.size()) < cases) {
    const BoxScene scene = draw_box_scene(random);
    if (!campaign.usable(scene)) {
      ++redrawn;
      continue;
    }
    rows.push_back(campaign.run(scene));
    std::cerr << rows.size() << " of " << cases << '\n';
  }
  const auto count = [&rows](const char* field) {
    return std::count_if(rows.begin(), rows.end(), [field](const nlohmann::ordered_json& row) {
      return row[field].get<bool>();
    });
  };
  const auto sum = [&rows](const char* field) {
    int total = 0;
    for (const nlohmann::ordered_json& row : rows) total += row[field].get<int>();
    return total;
  };
  std::vector<double> ratios;
  for (const nlohmann::ordered_json& row : rows) ratios.push_back(row["time_ratio"].get<double>());
  std::ranges::sort(ratios);
  const nlohmann::ordered_json result = {
      {"seed", seed},
      {"cases", cases},
      {"redrawn", redrawn},
      {"rate_hz", rate_hz},
      {"iterations", iterations},
      {"replan", replan},
      {"original_feasible", count("original_feasible")},
      {"refine_success", count("refine_success")},
      {"feasible", count("feasible")},
      {"passed", count("passed")},
      {"time_ratio_median", ratios[ratios.size() / 2]},
      {"time_ratio_most", ratios.back()},
      {"windows_called_feasible", sum("windows_called_feasible")},
      {"windows_wrongly_feasible", sum("windows_wrongly_feasible")},
      {"cycle_ms", campaign.all_cycles()},
      {"rows", rows}};
  std::cout << result.dump(2) << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  unsigned long long seed = 1;
  int cases = 20, iterations = 1, every = 25;
  bool replan = false;
  double rate_hz = 50.0;
  locograph::OptionParser app("Boxes at random in a walled corridor", "box_campaign");
  app.add_option("SEED", seed, "Of the boxes");
  app.add_option("CASES", cases, "How many").positive();
  app.add_option("--rate", rate_hz, "Cycles in a second of the plan; 0: one for each step")
      .not_negative();
  app.add_option("--iterations", iterations, "Of a cycle at most; 0: any number").not_negative();
  app.add_option("--every", every, "Judge the window of every n-th cycle").positive();
  app.add_flag("--replan", replan, "Plan on from where the robot has come to rest");
  return locograph::run_benchmark(
      app, argc, argv, [&] { locograph::run(seed, cases, rate_hz, iterations, every, replan); });
}
