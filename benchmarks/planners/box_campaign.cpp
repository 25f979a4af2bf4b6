// Boxes at random in a walled corridor: how often the local planner gets the CENTAURO drive past
// them, judged by the judge.
//
//     box_campaign [SEED] [CASES]
//
// Prints one JSON object: a row for each case, then the totals. A case counts as passed when every
// configuration was refined, the judge finds the result feasible, and the base ends within 0.3 m
// of the plan's end along x.
#include <locograph/check/judge.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/plan.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"
#include "planners/box_scenes.h"

namespace locograph {
namespace {

class Campaign : public BoxDrives {
 public:
  nlohmann::ordered_json run(const BoxScene& scene) {
    const World world = world_of(scene, true);
    const Judge judge(task().robot->robot, world);
    const CheckReport before = judge.check(motion(), check_);

    Graph graph = *drive_graph(task(), motion());
    const auto seen = std::make_shared<const WorldSnapshot>(world);
    const WalkReport report =
        walk_plan(graph, [&seen](int executed) { return executed == 0 ? seen : nullptr; }, {});
    const Motion refined = motion_of(graph, plan_of(graph));
    const CheckReport after = judge.check(refined, check_);

    std::vector<double> times;
    for (const CycleReport& cycle : report.cycles) times.push_back(cycle.statistics.total_s);
    std::sort(times.begin(), times.end());
    const auto percentile_ms = [&times](double p) {
      return 1e3 * times[static_cast<std::size_t>(std::ceil(p * times.size())) - 1];
    };
    nlohmann::ordered_json violated = nlohmann::ordered_json::array();
    for (const Violation& v : after.violations) {
      if (v.violated) violated.push_back({{"constraint", v.constraint}, {"worst", v.worst}});
    }
    const double final_x = refined.configurations.back()[0];
    const bool passed = report.success() && after.feasible &&
                        std::abs(final_x - motion().configurations.back()[0]) <= 0.3;
    return {
        {"x", scene.x},
        {"y", scene.y},
        {"side", scene.side},
        {"height", scene.height},
        {"wall", scene.wall},
        {"gap", scene.gap},
        {"original_feasible", before.feasible},
        {"refine_success", report.success()},
        {"reason", report.reason},
        {"configurations", report.configurations},
        {"feasible_cycles", report.feasible_cycles},
        {"feasible", after.feasible},
        {"violated", violated},
        {"passed", passed},
        {"final_x", final_x},
        {"min_clearance_m", after.min_clearance_m.value_or(0.0)},
        {"lateral_slip_m", after.constraint("lateral_slip").worst},
        {"longitudinal_slip_m", after.constraint("longitudinal_slip").worst},
        {"cycle_ms",
         {{"p50", percentile_ms(0.5)}, {"p95", percentile_ms(0.95)}, {"max", 1e3 * times.back()}}}};
  }

 private:
  CheckOptions check_ = {.known = task().end_effectors()};
};

void run(unsigned long long seed, int cases) {
  std::mt19937_64 random(seed);
  Campaign campaign;
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
  const nlohmann::ordered_json result = {{"seed", seed},
                                         {"cases", cases},
                                         {"redrawn", redrawn},
                                         {"original_feasible", count("original_feasible")},
                                         {"refine_success", count("refine_success")},
                                         {"feasible", count("feasible")},
                                         {"passed", count("passed")},
                                         {"rows", rows}};
  std::cout << result.dump(2) << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  unsigned long long seed = 1;
  int cases = 20;
  locograph::OptionParser app("Boxes at random in a walled corridor", "box_campaign");
  app.add_option("SEED", seed, "Of the boxes");
  app.add_option("CASES", cases, "How many").positive();
  return locograph::run_benchmark(app, argc, argv, [&] { locograph::run(seed, cases); });
}
