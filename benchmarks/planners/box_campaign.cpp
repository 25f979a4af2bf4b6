// Boxes at random in a walled corridor: how often the local planner gets the CENTAURO drive past
// them, judged by the judge.
//
//     box_campaign [SEED] [CASES]
//
// Prints one JSON object: a row for each case, then the totals. A case counts as passed when every
// configuration was refined, the judge finds the result feasible, and the base ends within 0.3 m
// of the plan's end along x.
#include <locograph/check/judge.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/world/octree.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"

namespace locograph {
namespace {

constexpr double kRobotWidth_m = 0.966;
constexpr double kResolution_m = 0.05;
constexpr double kWallHeight_m = 1.2, kWallThickness_m = 0.2;

struct Scene {
  double x, y, side, height;  ///< of the box, standing on the ground
  double gap;                 ///< between the box and the farther wall
  double wall;                ///< the walls' faces are at y = ±wall
};

Scene draw(std::mt19937_64& random) {
  Scene scene;
  scene.x = uniform(random, 1.4, 2.8);
  scene.y = uniform(random, -0.6, 0.6);
  scene.side = uniform(random, 0.2, 0.7);
  scene.height = uniform(random, 0.3, 1.0);
  scene.gap = kRobotWidth_m + uniform(random, 0.3, 0.6);
  scene.wall = scene.gap + 0.5 * scene.side - std::abs(scene.y);
  return scene;
}

Box box(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Box result;
  result.world_from_box.translation() = centre;
  result.size = size;
  return result;
}

std::shared_ptr<const octomap::OcTree> map_of(const Scene& scene, bool with_walls) {
  std::vector<Box> boxes = {
      box({scene.x, scene.y, 0.5 * scene.height}, {scene.side, scene.side, scene.height})};
  for (const double sign : {-1.0, 1.0}) {
    if (!with_walls) break;
    boxes.push_back(box({2.0, sign * (scene.wall + 0.5 * kWallThickness_m), 0.5 * kWallHeight_m},
                        {8.0, kWallThickness_m, kWallHeight_m}));
  }
  return octree_from_boxes(boxes, kResolution_m);
}

class Campaign {
 public:
  Campaign()
      : task_(task_of(load_scenario(LOCOGRAPH_SOURCE_DIR "/planners/scenarios/centauro_drive.xml",
                                    LOCOGRAPH_SOURCE_DIR))),
        motion_(plan_wheeled_drive(task_).motion) {
    check_.known = task_.end_effectors();
  }

  /// False when the box stands where the robot starts or is to end.
  bool usable(const Scene& scene) const {
    const Judge judge(task_.robot->robot, world_with(map_of(scene, false)));
    for (const Eigen::VectorXd& q :
         {motion_.configurations.front(), motion_.configurations.back()}) {
      if (judge.check(q, motion_.stances.front(), check_)
              .constraint("obstacle_distance")
              .violated) {
        return false;
      }
    }
    return true;
  }

  nlohmann::ordered_json run(const Scene& scene) {
    const World world = world_with(map_of(scene, true));
    const Judge judge(task_.robot->robot, world);
    const CheckReport before = judge.check(motion_, check_);

    Graph graph = *drive_graph(task_, motion_);
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
                        std::abs(final_x - motion_.configurations.back()[0]) <= 0.3;
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
  World world_with(std::shared_ptr<const octomap::OcTree> map) const {
    World world = task_.world->world();
    world.map = std::move(map);
    return world;
  }

  Task task_;
  Motion motion_;
  CheckOptions check_;
};

void run(unsigned long long seed, int cases) {
  std::mt19937_64 random(seed);
  Campaign campaign;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  int redrawn = 0;
  while (static_cast<int>(rows.size()) < cases) {
    const Scene scene = draw(random);
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
