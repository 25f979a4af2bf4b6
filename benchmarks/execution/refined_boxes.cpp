// CENTAURO's drive past a box that it comes to know of on the way, in the physics engine: refined a
// second ahead of the robot while a torque controller carries it out.
//
//     refined_boxes [--cases N] [--seed N] [--seen M]
//
// Scenes are those of box_campaign: the walls are known, the box is once the base is within M of
// its middle (or from the start). Prints one JSON object. A case counts as `arrived` when the robot
// is where the plan led, and as `no_contact` when nothing but its wheels has touched anything.
#include <locograph/execution/simulation.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/online/walk_ahead.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "command_line.h"
#include "planners/box_scenes.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  int cases = 50;
  unsigned seed = 1;
  double seen_m = 1.8;
};

Json run(const BoxDrives& drives, const BoxScene& scene, const Options& options, unsigned seed) {
  const Task& task = drives.task();
  const auto walls = std::make_shared<const WorldSnapshot>(drives.world_of(scene, true, false));
  const auto all = std::make_shared<const WorldSnapshot>(drives.world_of(scene, true));
  Judging judging;
  judging.robot = task.robot->robot;
  judging.options.known = task.end_effectors();
  judging.world = walls;
  const auto check_before = step_check(judging);
  judging.world = all;
  const auto check_after = step_check(judging);

  Graph graph = *drive_graph(task, drives.motion());
  WalkOptions walking = walk_options_for(plan_of(graph));
  bool seen = false;
  walking.verify = [&](const Motion& step) { return (seen ? check_after : check_before)(step); };
  std::shared_ptr<const WorldSnapshot> next = walls;
  WalkAhead walk(
      graph, [&](int) { return std::exchange(next, nullptr); }, walking);
  const std::vector<EndEffector> effectors = task.end_effectors();
  const SimulationResult result = simulate(
      *task.robot->robot, effectors, all->world(), drives.motion(),
      {.initial_error_rad = 0.005, .seed = seed, .revise = [&](const SimulationMoment& now) {
         const Eigen::Vector2d off(now.configuration[0] - scene.x, now.configuration[1] - scene.y);
         if (!seen && off.norm() <= options.seen_m) {
           seen = true;
           next = all;
         }
         return walk.at(now.plan_time_s);
       }});
  const WalkReport report = walk.report();
  std::vector<double> cycles;
  for (const CycleReport& cycle : report.cycles) cycles.push_back(cycle.statistics.total_s);
  std::ranges::sort(cycles);
  const auto percentile_ms = [&cycles](double p) {
    return 1e3 * cycles[static_cast<std::size_t>(p * static_cast<double>(cycles.size() - 1))];
  };
  return {{"x", scene.x},
          {"y", scene.y},
          {"side", scene.side},
          {"arrived", report.success() && result.carried_out},
          {"no_contact", result.upright && result.other_link.empty()},
          {"at_rest", report.at_rest},
          {"refine", report.reason},
          {"engine", result.reason},
          {"max_contact_slip_m", result.max_contact_slip_m},
          {"max_base_error_m", result.max_base_error_m},
          {"cycle_ms", {percentile_ms(0.5), percentile_ms(0.99), percentile_ms(1.0)}}};
}

void run(const Options& options) {
  std::mt19937_64 random(options.seed);
  const BoxDrives drives;
  Json rows = Json::array();
  int arrived = 0, no_contact = 0;
  while (static_cast<int>(rows.size()) < options.cases) {
    const BoxScene scene = draw_box_scene(random);
    if (!drives.usable(scene)) continue;
    rows.push_back(run(drives, scene, options, options.seed + static_cast<unsigned>(rows.size())));
    arrived += rows.back()["arrived"].get<bool>() ? 1 : 0;
    no_contact += rows.back()["no_contact"].get<bool>() ? 1 : 0;
    std::cerr << rows.size() << ": " << rows.back().dump() << '\n';
  }
  std::cout << Json({{"seed", options.seed},
                     {"seen_m", options.seen_m},
                     {"cases", rows.size()},
                     {"arrived", arrived},
                     {"no_contact", no_contact},
                     {"rows", rows}})
                   .dump(2)
            << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::Options options;
  locograph::OptionParser app("Boxes that show up before CENTAURO, in the physics engine",
                              "refined_boxes");
  app.add_option("--cases", options.cases, "How many").positive();
  app.add_option("--seed", options.seed, "Of the boxes, and of the starts");
  app.add_option("--seen", options.seen_m, "From the base, when a box gets known [m]").positive();
  return locograph::run_benchmark(app, argc, argv, [&] { locograph::run(options); });
}
