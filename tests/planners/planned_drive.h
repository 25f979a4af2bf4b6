#pragma once
/// What the tests of the planners share: the shipped drive as a plan, changed at will, and a check.
///
///     Graph graph = planned_drive(centauro_drive(4.0, 0.3));
///     EXPECT_EQ(violated(check_plan(graph, {box("b", {2, 0, 0.25}, {0.5, 0.5, 0.5})})), …);

#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/scenario/scenario.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "check/centauro_on_wheels.h"
#include "common/temporary_folder.h"

namespace locograph {

using test::TemporaryFolder;

/// Robots and scenarios as an installation holds them.
class DataFolder : public TemporaryFolder {
 public:
  DataFolder() {
    const std::filesystem::path source = LOCOGRAPH_SOURCE_DIR;
    std::filesystem::create_directory_symlink(source / "robots", path() / "robots");
    std::filesystem::create_directory_symlink(source / "planners/scenarios", path() / "scenarios");
  }
};

inline Scenario centauro_drive(double distance_m = 4.0, double curvature_1_m = 0.0,
                               int configurations = 50) {
  Scenario scenario = load_scenario("centauro_drive", DataFolder().path());
  scenario.drive->distance_m = distance_m;
  scenario.drive->curvature_1_m = curvature_1_m;
  scenario.drive->configurations = configurations;
  return scenario;
}

/// Nothing when the job ends before the plan is whole.
inline std::optional<Graph> planned_drive(const Scenario& scenario, const JobControl& job) {
  const Task task = task_of(scenario);
  const DrivePlan plan = plan_wheeled_drive(task, job);
  return plan.success() ? drive_graph(task, plan.motion, job) : std::nullopt;
}
inline Graph planned_drive(const Scenario& scenario) { return *planned_drive(scenario, {}); }

/// What stands on the ground z = 0.
inline World world_of(std::vector<Obstacle> obstacles,
                      std::shared_ptr<const octomap::OcTree> map = nullptr) {
  World world;
  world.map = std::move(map);
  world.obstacles = std::move(obstacles);
  world.surfaces = {ground()};
  return world;
}

/// What the shipped scenario knows of the wheels.
inline CheckOptions drive_options() {
  CheckOptions options;
  options.known = centauro_drive().end_effectors;
  return options;
}

/// A step of a motion, which goes on before and after it.
inline CheckReport check_step(const std::shared_ptr<const Robot>& robot, const Motion& step,
                              const World& world) {
  CheckOptions options = drive_options();
  options.starts_at_rest = options.ends_at_rest = false;
  return Judge(robot, world).check(step, options);
}

inline CheckReport check_plan(const Graph& graph, const std::vector<Obstacle>& obstacles = {},
                              std::shared_ptr<const octomap::OcTree> map = nullptr) {
  const Plan plan = plan_of(graph);
  return Judge(plan.robot->robot, world_of(obstacles, std::move(map)))
      .check(motion_of(graph, plan), drive_options());
}

inline void expect_feasible(const CheckReport& report) {
  for (const Violation& v : report.violations) {
    EXPECT_FALSE(v.violated) << v.constraint << ' ' << v.worst << ' ' << v.unit << ", limit "
                             << v.limit << ", at vertex " << v.at_vertex << " and " << v.count - 1
                             << " more: " << v.what;
  }
  EXPECT_TRUE(report.feasible);
}

inline std::vector<Eigen::VectorXd> configurations(const Graph& graph) {
  return motion_of(graph, plan_of(graph)).configurations;
}

}  // namespace locograph
