// The source paper's experiment from cameras alone: CENTAURO drives 4 m along a corridor and sees
// nothing of it beforehand. A first obstacle stands at one wall; a second one appears while the
// robot drives, when its front is still half a metre away. Beside each, the corridor is as wide as
// the robot and 0.2 m. In blocked worlds the first obstacle reaches from wall to wall.
//
//     camera_campaign [--seed N] [--worlds N] [--blocked N] [--voxel M] [--rate HZ]
//
// Two depth cameras are simulated with noise; the planner is shown what perception makes of their
// images, and steps are judged by that. Whether anything was touched, the judge says in the true
// world, where things appear when they do. Passed: at the goal (0.25 m, 0.25 rad) without contact,
// every configuration feasible. Stopped: short of the goal, without contact, with a reason.
// Prints one JSON object.
#include <locograph/check/judge.h>
#include <locograph/common/deadline.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/online/camera_walk.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>

#include <algorithm>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRobotWidth_m = 0.966, kRobotFront_m = 0.6, kSpare_m = 0.2;
constexpr double kWallHeight_m = 1.0, kWallThickness_m = 0.2, kSide_m = 0.3;
constexpr double kSeenAhead_m = 0.5;  // 5 s at 0.1 m/s

struct CampaignOptions {
  std::uint64_t seed = 1;
  int worlds = 20, blocked = 20;
  double voxel_m = 0.05, rate_hz = 30.0;
};

struct Drawn {
  double narrower_m;      ///< how far obstacles reach into the corridor
  double x_1, x_2;        ///< their middles
  double side_1, side_2;  ///< 1: at the left wall, -1: at the right one
  double appears_s;       ///< the second one
};

Drawn draw(std::mt19937_64& random, double speed_m_s) {
  Drawn drawn;
  drawn.narrower_m = uniform(random, 0.1, 0.4);
  drawn.x_1 = uniform(random, 1.3, 1.7);
  drawn.x_2 = uniform(random, 2.6, 3.0);
  drawn.side_1 = uniform(random, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  drawn.side_2 = uniform(random, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  drawn.appears_s = (drawn.x_2 - 0.5 * kSide_m - kRobotFront_m - kSeenAhead_m) / speed_m_s -
                    uniform(random, 0.0, 5.0);
  return drawn;
}

Obstacle box(const std::string& name, const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Obstacle obstacle;
  obstacle.name = name;
  obstacle.size = size;
  obstacle.world_from_obstacle.translation() = centre;
  return obstacle;
}

std::vector<Obstacle> obstacles_of(const Drawn& drawn, bool blocked) {
  const double width_m = kRobotWidth_m + kSpare_m + drawn.narrower_m, wall_y = 0.5 * width_m;
  std::vector<Obstacle> obstacles;
  for (const double side : {-1.0, 1.0}) {
    obstacles.push_back(box(side < 0.0 ? "right_wall" : "left_wall",
                            {2.5, side * (wall_y + 0.5 * kWallThickness_m), 0.5 * kWallHeight_m},
                            {9.0, kWallThickness_m, kWallHeight_m}));
  }
  const auto at_wall = [&](const std::string& name, double x, double side, double reach_m) {
    return box(name, {x, side * (wall_y - 0.5 * reach_m), 0.3}, {kSide_m, reach_m, 0.6});
  };
  obstacles.push_back(
      at_wall("first", drawn.x_1, drawn.side_1, blocked ? width_m : drawn.narrower_m));
  if (blocked) return obstacles;
  obstacles.push_back(at_wall("second", drawn.x_2, drawn.side_2, drawn.narrower_m));
  obstacles.back().appears_s = drawn.appears_s;
  return obstacles;
}

class Campaign {
 public:
  explicit Campaign(const CampaignOptions& options)
      : options_(options),
        task_(std::make_shared<const Task>(task_of(load_scenario(
            LOCOGRAPH_SOURCE_DIR "/planners/scenarios/centauro_drive.xml", LOCOGRAPH_SOURCE_DIR)))),
        motion_(plan_wheeled_drive(*task_).motion) {
    check_.known = task_->end_effectors();
  }

  double speed_m_s() const { return motion_.configurations.back()[0] / motion_.time_s.back(); }

  Json run(const Drawn& drawn, bool blocked, std::uint64_t seed) const {
    World truth = task_->world->world();
    truth.obstacles = obstacles_of(drawn, blocked);
    Graph graph = *drive_graph(*task_, motion_);
    PerceptionOptions seeing;
    seeing.map.resolution_m = options_.voxel_m;
    seeing.map.floor_z_m = 0.0;
    Perception perception(task_->robot->robot, task_->cameras, task_->world->world(), seeing);
    SimulatedImagesOptions cameras;
    cameras.rate_hz = options_.rate_hz;
    cameras.begin_s = motion_.time_s.front() - 4.5 / options_.rate_hz;
    cameras.seed = seed;
    SimulatedImages images(task_->robot->robot, truth, task_->cameras, cameras);
    Judging judging;
    judging.robot = task_->robot->robot;
    judging.world = std::make_shared<const WorldSnapshot>(truth);
    judging.task = task_;
    judging.options = check_;
    CameraWalk eyes(graph, judging, perception, images);
    WalkOptions walking;
    walking.planner.fallbacks = camera_fallbacks();
    walking.verify = [&](const Motion& step) { return eyes.check_step(step); };
    const double before_s = processor_seconds();
    const WalkReport report = walk_plan(
        graph, [&](int executed) { return eyes.world_at(executed); }, walking);
    const double walk_s = processor_seconds() - before_s;
    const Motion walked = motion_of(graph, plan_of(graph));
    const CheckReport verdict = Judge(task_->robot->robot, truth).check(walked, check_);
    Json violated = Json::array();
    for (const Violation& violation : verdict.violations) {
      if (violation.violated) {
        violated.push_back({{"constraint", violation.constraint}, {"worst", violation.worst}});
      }
    }
    const bool touched = verdict.constraint("obstacle_distance").violated;
    return {
        {"blocked", blocked},
        {"narrower_m", drawn.narrower_m},
        {"x", {drawn.x_1, drawn.x_2}},
        {"sides", {drawn.side_1, drawn.side_2}},
        {"appears_s", drawn.appears_s},
        {"success", report.success()},
        {"reason", report.reason},
        {"configurations", report.configurations},
        {"goal_distance_m", report.goal_distance_m},
        {"touched", touched},
        {"feasible", verdict.feasible},
        {"violated", violated},
        {"min_clearance_m", verdict.min_clearance_m.value_or(0.0)},
        {"images", perception.images()},
        {"passed", report.success() && verdict.feasible},
        {"stopped", !report.success() && !touched && verdict.feasible && !report.reason.empty()},
        {"processor_s", walk_s}};
  }

 private:
  static double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

  CampaignOptions options_;
  std::shared_ptr<const Task> task_;
  Motion motion_;
  CheckOptions check_;
};

void run(const CampaignOptions& options) {
  std::mt19937_64 random(options.seed);
  const Campaign campaign(options);
  Json rows = Json::array();
  for (int k = 0; k < options.worlds + options.blocked; ++k) {
    const Drawn drawn = draw(random, campaign.speed_m_s());
    rows.push_back(
        campaign.run(drawn, k >= options.worlds, options.seed + static_cast<unsigned>(k)));
    std::cerr << rows.size() << ": " << rows.back().dump() << '\n';
  }
  const auto count = [&rows](bool blocked, const char* field) {
    return std::ranges::count_if(rows, [&](const Json& row) {
      return row["blocked"].get<bool>() == blocked && row[field].get<bool>();
    });
  };
  std::cout << Json{{"seed", options.seed},
                    {"voxel_m", options.voxel_m},
                    {"worlds", options.worlds},
                    {"passed", count(false, "passed")},
                    {"stopped_short", count(false, "stopped")},
                    {"touched", count(false, "touched") + count(true, "touched")},
                    {"blocked", options.blocked},
                    {"blocked_stopped", count(true, "stopped")},
                    {"rows", rows}}
                   .dump(2)
            << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::CampaignOptions options;
  locograph::OptionParser app("CENTAURO sees its way by two depth cameras", "camera_campaign");
  app.add_option("--seed", options.seed, "Of the worlds and of the noise");
  app.add_option("--worlds", options.worlds, "With a way through").not_negative();
  app.add_option("--blocked", options.blocked, "Without one").not_negative();
  app.add_option("--voxel", options.voxel_m, "Of the map [m]").between(0.01, 1.0);
  app.add_option("--rate", options.rate_hz, "Images of each camera [1/s]").between(0.1, 1000.0);
  return locograph::run_benchmark(app, argc, argv, [&] { locograph::run(options); });
}
